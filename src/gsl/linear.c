/* Linear structures from their matrices: as they are if the mass matrix is diagonal, solved for the accelerations if not, or
 * reduced to their lowest modes. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_blas.h>

#include "hidden.h"
#include "normal_modes.h"
#include "system.h"

/* What a caller gives, and where the text of an error goes. */
struct model {
    size_t ndof, ncontact, nmode;
    struct matrix mass, damping, stiffness, direction;
    char *message;
    size_t size;
};

static int fail(const struct model *m, int status, const char *format, ...)
{
    if (m->message && m->size) {
        va_list args;
        va_start(args, format);
        vsnprintf(m->message, m->size, format, args);
        va_end(args);
    }
    return status;
}

static int no_memory(const struct model *m)
{
    return fail(m, TRIBO_ERR_MEMORY, "out of memory for %zu degrees of freedom and %zu contacts", m->ndof, m->ncontact);
}

static int check(const struct model *m)
{
    const struct {
        const char *name;
        const struct matrix *matrix;
        int symmetric;
    } all[] = {
        {"mass", &m->mass, 1}, {"damping", &m->damping, 0}, {"stiffness", &m->stiffness, 1}, {"direction", &m->direction, 0}};
    for (size_t k = 0; k < 4; k++) {
        size_t i, j;
        double x, y;
        if (!tribo_matrix_flaw(all[k].matrix, all[k].symmetric, &i, &j, &x, &y)) {
            continue;
        }
        if (!isfinite(x)) {
            return fail(m, TRIBO_ERR_NOT_FINITE, "%s[%zu][%zu] = %g is not finite", all[k].name, i, j, x);
        }
        return fail(m, TRIBO_ERR_NOT_SYMMETRIC, "%s[%zu][%zu] = %g, but %s[%zu][%zu] = %g", all[k].name, i, j, x, all[k].name, j,
                    i, y);
    }
    return TRIBO_OK;
}

static int factorize_mass(const struct model *m, struct cholesky *c)
{
    size_t where;
    double pivot;
    switch (tribo_cholesky_create(c, &m->mass, &where, &pivot)) {
    case TRIBO_OK:
        return TRIBO_OK;
    case TRIBO_ERR_INDEFINITE:
        return fail(m, TRIBO_ERR_INDEFINITE, "mass is not positive definite: pivot %g at degree of freedom %zu", pivot, where);
    default:
        return no_memory(m);
    }
}

/* ------------------------------------------------------------------------------------------------------- the three ways */

/* J' [ndof][ncontact], dense. */
static double *transposed_direction(const struct model *m)
{
    double *x = calloc(m->ndof * m->ncontact + 1, sizeof *x);
    for (size_t i = 0; x && i < m->ncontact; i++) {
        for (size_t k = m->direction.first[i]; k < m->direction.first[i + 1]; k++) {
            x[m->direction.col[k] * m->ncontact + i] = m->direction.val[k];
        }
    }
    return x;
}

/* Whether R, of a system whose mass matrix is not diagonal, tells all that it should. */
static int check_operator(const struct model *m, const tribo_system *sys, const double *r)
{
    const size_t n = sys->ndof;
    const struct matrix *b = &sys->response;
    struct hidden where;
    double *x = calloc(m->ncontact * n + 1, sizeof *x);
    for (size_t d = 0; x && d < n; d++) {
        for (size_t k = b->first[d]; k < b->first[d + 1]; k++) {
            x[b->col[k] * n + d] = b->val[k];
        }
    }
    const int hidden = x ? tribo_hidden(&sys->direction, &sys->metric, x, r, &where) : -1;
    free(x);
    if (hidden < 0) {
        return no_memory(m);
    }
    return hidden ? fail(m, TRIBO_ERR_UNSUPPORTED,
                         "mass: contact %zu touches bodies of which one is %g times as light; make the mass matrix diagonal",
                         where.contact, where.spread)
                  : TRIBO_OK;
}

/* R = Z'Z, Z [n][ncontact], which is as symmetric and semidefinite as rounding lets it be. */
static int set_operator(const struct model *m, tribo_system *sys, double *z, size_t n)
{
    const size_t c = m->ncontact;
    double *r = calloc(c * c + 1, sizeof *r);
    if (!r) {
        return no_memory(m);
    }
    if (c) {
        gsl_matrix_view rv = gsl_matrix_view_array(r, c, c), zv = gsl_matrix_view_array(z, n, c);
        gsl_blas_dgemm(CblasTrans, CblasNoTrans, 1.0, &zv.matrix, &zv.matrix, 0.0, &rv.matrix);
    }
    int status = m->nmode ? TRIBO_OK : check_operator(m, sys, r);
    if (!status) {
        status = tribo_set_operator_dense(sys->contacts, r);
        status = status ? fail(m, status, "%s", tribo_message(sys->contacts)) : TRIBO_OK;
    }
    free(r);
    return status;
}

/* The system owns the mass matrix and its factor from now on. */
static void give_mass(struct model *m, tribo_system *sys, struct cholesky *c)
{
    sys->metric = m->mass;
    sys->factor = *c;
    m->mass = (struct matrix){0};
    *c = (struct cholesky){0};
}

static int build_diagonal(struct model *m, tribo_system **sys)
{
    const size_t n = m->ndof;
    struct cholesky c;
    int status = factorize_mass(m, &c);
    if (status) {
        return status;
    }
    double *inverse = malloc(n * sizeof *inverse), *entries = transposed_direction(m);
    struct matrix b = {0};
    status = inverse && entries && tribo_matrix_from_dense(&b, n, m->ncontact, entries) ? TRIBO_OK : no_memory(m);
    free(entries);
    for (size_t i = 0; !status && i < n; i++) {
        inverse[i] = 1.0 / tribo_matrix_get(&m->mass, i, i);
    }
    if (!status && !(tribo_matrix_scale_rows(&b, inverse) && tribo_matrix_scale_rows(&m->stiffness, inverse) &&
                     (!m->damping.rows || tribo_matrix_scale_rows(&m->damping, inverse)))) {
        status = no_memory(m);
    }
    if (status) {
        tribo_matrix_free(&b);
    } else {
        status = tribo_system_build(sys, n, m->ncontact, &m->stiffness, &m->damping, &m->direction, &b);
        m->stiffness = m->damping = m->direction = (struct matrix){0};
        status = status ? no_memory(m) : TRIBO_OK;
    }
    if (!status) {
        const struct matrix *j = &(*sys)->direction;
        give_mass(m, *sys, &c);
        status = tribo_set_operator_mass((*sys)->contacts, n, inverse, j->first, j->col, j->val);
        status = status ? fail(m, status, "%s", tribo_message((*sys)->contacts)) : TRIBO_OK;
    }
    free(inverse);
    tribo_cholesky_free(&c);
    return status;
}

/* solved = M^-1 a; zeroed if out of memory. */
static int solve_matrix(const struct cholesky *c, const struct matrix *a, struct matrix *solved)
{
    double *x = tribo_matrix_to_dense(a);
    if (x) {
        tribo_half_solve(c, x, a->cols);
        tribo_half_solve_back(c, x, a->cols);
    }
    const int done = x && tribo_matrix_from_dense(solved, a->rows, a->cols, x);
    free(x);
    return done;
}

static int build_solved(struct model *m, tribo_system **sys)
{
    struct cholesky c;
    int status = factorize_mass(m, &c);
    if (status) {
        return status;
    }
    double *z = transposed_direction(m), *x = transposed_direction(m);
    struct matrix b = {0}, ak = {0}, ac = {0};
    int done = z && x && solve_matrix(&c, &m->stiffness, &ak) && (!m->damping.rows || solve_matrix(&c, &m->damping, &ac));
    if (done && m->ncontact) {
        tribo_half_solve(&c, z, m->ncontact);
        memcpy(x, z, m->ndof * m->ncontact * sizeof *x);
        tribo_half_solve_back(&c, x, m->ncontact);
    }
    done = done && tribo_matrix_from_dense(&b, m->ndof, m->ncontact, x);
    free(x);
    if (!done) {
        free(z);
        tribo_matrix_free(&ak);
        tribo_matrix_free(&ac);
        tribo_cholesky_free(&c);
        return no_memory(m);
    }
    status = tribo_system_build(sys, m->ndof, m->ncontact, &ak, &ac, &m->direction, &b);
    m->direction = (struct matrix){0};
    if (status) {
        free(z);
        tribo_cholesky_free(&c);
        return no_memory(m);
    }
    give_mass(m, *sys, &c);
    (*sys)->elastic = m->stiffness;
    (*sys)->viscous = m->damping;
    m->stiffness = m->damping = (struct matrix){0};
    status = set_operator(m, *sys, z, m->ndof);
    free(z);
    return status;
}

/* What to say of modes that were not found. */
static int modes_failed(const struct model *m, int status, const struct doubt *doubt)
{
    switch (status) {
    case TRIBO_ERR_MEMORY:
        return no_memory(m);
    case TRIBO_ERR_NOT_FINITE:
        return fail(m, status, "stiffness over mass overflows");
    case TRIBO_ERR_UNSUPPORTED:
        return fail(
            m, status,
            "omega^2 = %g of mode %zu is hardly more than rounding of the stiffness, which comes to %g: make the stiffest "
            "parts softer, or rigid",
            doubt->omega2, doubt->mode, doubt->noise);
    default:
        return fail(m, status, "omega^2 = %g of mode %zu does not come out pure: reduce the system to fewer modes", doubt->omega2,
                    doubt->mode);
    }
}

/* The lowest nmode modes: modes [ndof][nmode] with modal mass 1, and omega [nmode]. */
static int find_modes(const struct model *m, double *modes, double *omega)
{
    const struct matrix whole = {0};
    struct cholesky c;
    struct doubt doubt = {0};
    double *phi = malloc(m->nmode * m->ndof * sizeof *phi);
    int status = phi ? factorize_mass(m, &c) : no_memory(m);
    if (!status) {
        status = tribo_normal_modes(&m->stiffness, &whole, &c, m->nmode, omega, phi, &doubt);
        status = status ? modes_failed(m, status, &doubt) : TRIBO_OK;
        tribo_cholesky_free(&c);
    }
    for (size_t j = 0; !status && j < m->nmode; j++) {
        if (omega[j] < 0.0) {
            status =
                fail(m, TRIBO_ERR_INDEFINITE, "stiffness is not positive semidefinite: omega^2 = %g of mode %zu", omega[j], j);
        }
        omega[j] = sqrt(fabs(omega[j]));
        for (size_t i = 0; i < m->ndof; i++) {
            modes[i * m->nmode + j] = phi[j * m->ndof + i];
        }
    }
    free(phi);
    return status;
}

/* a = diag(factor x), or of the squares of x; zeroed if out of memory. */
static int diagonal_matrix(struct matrix *a, const double *x, double factor, int square, size_t n)
{
    double *scale = malloc(n * sizeof *scale);
    int done = scale != NULL && tribo_matrix_identity(a, n);
    for (size_t i = 0; done && i < n; i++) {
        scale[i] = factor * x[i] * (square ? x[i] : 1.0);
    }
    if (!done || !tribo_matrix_scale_rows(a, scale)) {
        *a = (struct matrix){0};
        done = 0;
    }
    free(scale);
    return done;
}

static int build_reduced(struct model *m, tribo_system **sys)
{
    const size_t n = m->ndof, r = m->nmode, c = m->ncontact;
    double *modes = malloc(n * r * sizeof *modes), *omega = malloc(r * sizeof *omega);
    double *j = calloc(c * r + 1, sizeof *j), *z = calloc(c * r + 1, sizeof *z);
    struct matrix kr = {0}, cr = {0}, jr = {0}, br = {0};
    int status = modes && omega && j && z ? find_modes(m, modes, omega) : no_memory(m);
    if (!status) {
        for (size_t i = 0; i < c; i++) {
            for (size_t k = m->direction.first[i]; k < m->direction.first[i + 1]; k++) {
                for (size_t mode = 0; mode < r; mode++) {
                    j[i * r + mode] += m->direction.val[k] * modes[m->direction.col[k] * r + mode];
                }
            }
            for (size_t mode = 0; mode < r; mode++) {
                z[mode * c + i] = j[i * r + mode];
            }
        }
        if (!(diagonal_matrix(&kr, omega, 1.0, 1, r) && tribo_matrix_from_dense(&jr, c, r, j) &&
              tribo_matrix_from_dense(&br, r, c, z))) {
            status = no_memory(m);
        }
    }
    free(j);
    if (!status) {
        status = tribo_system_build(sys, r, c, &kr, &cr, &jr, &br);
        status = status ? no_memory(m) : status;
    } else {
        tribo_matrix_free(&kr);
        tribo_matrix_free(&jr);
        tribo_matrix_free(&br);
    }
    if (status) {
        free(modes);
        free(omega);
        free(z);
        return status;
    }
    (*sys)->given = n;
    (*sys)->modes = modes;
    (*sys)->omega = omega;
    status = set_operator(m, *sys, z, r);
    free(z);
    return status;
}

static void model_free(struct model *m)
{
    tribo_matrix_free(&m->mass);
    tribo_matrix_free(&m->damping);
    tribo_matrix_free(&m->stiffness);
    tribo_matrix_free(&m->direction);
}

/* Builds the system from the model, whose matrices it frees. */
static int build(tribo_system **sys, struct model *m)
{
    tribo_system *s = NULL;
    int status = check(m);
    if (!status) {
        status = m->nmode                             ? build_reduced(m, &s)
                 : tribo_matrix_is_diagonal(&m->mass) ? build_diagonal(m, &s)
                                                      : build_solved(m, &s);
    }
    model_free(m);
    if (status) {
        tribo_system_destroy(s);
        return status;
    }
    *sys = s;
    return TRIBO_OK;
}

static int check_sizes(const struct model *m, int damped)
{
    if (m->ndof == 0 || m->ndof > (size_t)1 << 24 || m->ncontact > (size_t)1 << 24) {
        return fail(m, TRIBO_ERR_SIZE, "%zu degrees of freedom and %zu contacts", m->ndof, m->ncontact);
    }
    if (m->nmode > m->ndof) {
        return fail(m, TRIBO_ERR_SIZE, "nmode = %zu is more than the %zu degrees of freedom", m->nmode, m->ndof);
    }
    if (m->nmode && damped) {
        return fail(m, TRIBO_ERR_UNSUPPORTED, "damping of a reduced system is set by tribo_system_set_damping_ratio");
    }
    return TRIBO_OK;
}

int tribo_system_linear(tribo_system **sys, size_t ndof, size_t ncontact, const double *mass, const double *damping,
                        const double *stiffness, const double *direction, size_t nmode, char *message, size_t size)
{
    struct model m = {ndof, ncontact, nmode, .message = message, .size = size};
    if (!sys || !mass || !stiffness || (!direction && ncontact)) {
        return fail(&m, TRIBO_ERR_NULL, "%s is NULL", !sys ? "sys" : !mass ? "mass" : !stiffness ? "stiffness" : "direction");
    }
    const int status = check_sizes(&m, damping != NULL);
    if (status) {
        return status;
    }
    if (!tribo_matrix_from_dense(&m.mass, ndof, ndof, mass) || !tribo_matrix_from_dense(&m.stiffness, ndof, ndof, stiffness) ||
        !tribo_matrix_from_dense(&m.direction, ncontact, ndof, direction) ||
        (damping && !tribo_matrix_from_dense(&m.damping, ndof, ndof, damping))) {
        model_free(&m);
        return no_memory(&m);
    }
    return build(sys, &m);
}

static int check_square(const struct model *m, const char *name, const gsl_spmatrix *a, size_t rows)
{
    if (a && (a->size1 != rows || a->size2 != m->ndof)) {
        return fail(m, TRIBO_ERR_SIZE, "%s is %zu x %zu, not %zu x %zu", name, a->size1, a->size2, rows, m->ndof);
    }
    return TRIBO_OK;
}

int tribo_system_linear_sparse(tribo_system **sys, const gsl_spmatrix *mass, const gsl_spmatrix *damping,
                               const gsl_spmatrix *stiffness, const gsl_spmatrix *direction, size_t nmode, char *message,
                               size_t size)
{
    struct model m = {.nmode = nmode, .message = message, .size = size};
    if (!sys || !mass || !stiffness || !direction) {
        return fail(&m, TRIBO_ERR_NULL, "%s is NULL", !sys ? "sys" : !mass ? "mass" : !stiffness ? "stiffness" : "direction");
    }
    m.ndof = mass->size1;
    m.ncontact = direction->size1;
    int status = check_sizes(&m, damping != NULL);
    status = status ? status : check_square(&m, "mass", mass, m.ndof);
    status = status ? status : check_square(&m, "damping", damping, m.ndof);
    status = status ? status : check_square(&m, "stiffness", stiffness, m.ndof);
    status = status ? status : check_square(&m, "direction", direction, m.ncontact);
    if (status) {
        return status;
    }
    if (!tribo_matrix_from_sparse(&m.mass, mass) || !tribo_matrix_from_sparse(&m.stiffness, stiffness) ||
        !tribo_matrix_from_sparse(&m.direction, direction) || (damping && !tribo_matrix_from_sparse(&m.damping, damping))) {
        model_free(&m);
        return no_memory(&m);
    }
    return build(sys, &m);
}

/* ---------------------------------------------------------------------------------------------------- loads and modes */

void tribo_system_accelerate(const tribo_system *sys, const double *force, double *to)
{
    if (sys->modes) {
        for (size_t j = 0; j < sys->ndof; j++) {
            to[j] = 0.0;
        }
        for (size_t i = 0; i < sys->given; i++) {
            for (size_t j = 0; j < sys->ndof; j++) {
                to[j] += sys->modes[i * sys->ndof + j] * force[i];
            }
        }
        return;
    }
    memcpy(to, force, sys->ndof * sizeof *to);
    if (sys->factor.factor) {
        tribo_half_solve(&sys->factor, to, 1);
        tribo_half_solve_back(&sys->factor, to, 1);
    }
    for (size_t i = 0; !sys->factor.factor && !sys->loads_accelerate && i < sys->ndof; i++) {
        to[i] *= 1.0 / tribo_matrix_get(&sys->metric, i, i);
    }
}

static int only_reduced(const tribo_system *sys)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    return sys->modes ? TRIBO_OK : tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED, "the system is not reduced to modes");
}

int tribo_system_set_damping_ratio(tribo_system *sys, double zeta)
{
    const int status = only_reduced(sys);
    if (status) {
        return status;
    }
    if (!isfinite(zeta)) {
        return tribo_system_fail(sys, TRIBO_ERR_NOT_FINITE, "zeta = %g is not finite", zeta);
    }
    if (zeta < 0.0) {
        return tribo_system_fail(sys, TRIBO_ERR_NEGATIVE, "zeta = %g is negative", zeta);
    }
    struct matrix damping;
    if (!diagonal_matrix(&damping, sys->omega, 2.0 * zeta, 0, sys->ndof)) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the damping of %zu modes", sys->ndof);
    }
    tribo_matrix_free(&sys->damping);
    sys->damping = damping;
    sys->revision++;
    free(sys->dense);
    sys->dense = NULL;
    return TRIBO_OK;
}

int tribo_system_get_frequencies(const tribo_system *sys, double *omega)
{
    const int status = only_reduced(sys);
    if (status) {
        return status;
    }
    if (!omega) {
        return tribo_system_fail(sys, TRIBO_ERR_NULL, "omega is NULL");
    }
    memcpy(omega, sys->omega, sys->ndof * sizeof *omega);
    return TRIBO_OK;
}

int tribo_system_expand(const tribo_system *sys, const double *reduced, double *full)
{
    const int status = only_reduced(sys);
    if (status) {
        return status;
    }
    if (!reduced || !full) {
        return tribo_system_fail(sys, TRIBO_ERR_NULL, "%s is NULL", reduced ? "full" : "reduced");
    }
    for (size_t i = 0; i < sys->given; i++) {
        double sum = 0.0;
        for (size_t j = 0; j < sys->ndof; j++) {
            sum += sys->modes[i * sys->ndof + j] * reduced[j];
        }
        full[i] = sum;
    }
    return TRIBO_OK;
}
