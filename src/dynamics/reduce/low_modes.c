/* The motions of a reduced structure: its lowest modes, found densely or by Lanczos' method, and static responses to forces at
 * its contacts. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/real.h"
#include "lanczos.h"
#include "dynamics/system/model.h"
#include "normal_modes.h"

/* SHIFT: shift over the mean omega^2 of the degrees of freedom, weighted by mass: far below elastic omega^2, far above rounding
 * in rigid-body motions. If K + shift M is not definite, the shift grows by MORE, below MOST_SHIFT. */
#define SHIFT 1e-9
#define MORE 1e3
#define MOST_SHIFT 1e-3

/* For a singular M, M + SLIGHT K/(mean omega^2) is factored, which is definite if M is semidefinite. */
#define SLIGHT 1e-12

/* The factor of K + shift M must reproduce a mode, with an error of omega^2 up to SAME omega^2 + SAME_SHIFT shift; the second
 * term allows for rounding of the factor. */
#define SAME 1e-5
#define SAME_SHIFT 1e-3

/* A static response is new if its part orthogonal to the other responses is more than OWN times the response beside the modes,
 * and more than ROUNDING times the whole response, the rounding of the parts removed. */
#define OWN 1e-7
#define ROUNDING (16.0 * DBL_EPSILON)

/* Part of the diagonal added to a flexibility that is singular because displacements of contacts depend on each other. */
#define RIDGE 1e-12

/* BATCH: responses of contacts solved at a time. CHECKED: modes checked at a time. */
#define BATCH 16
#define CHECKED 6

/* K + shift M and its factor. */
struct shifted {
    double shift;
    struct cholesky factor;
};

/* ------------------------------------------------------------------------------------------------------------------- messages */

/* Writes the message for a status of tribo_normal_modes, and returns the status. */
static int modes_failed(const struct model *m, int status, const struct doubt *doubt)
{
    switch (status) {
    case TRIBO_OK:
        return TRIBO_OK;
    case TRIBO_ERR_MEMORY:
        return tribo_model_no_memory(m);
    case TRIBO_ERR_NOT_FINITE:
        return tribo_model_fail(m, status, "stiffness over mass overflows");
    case TRIBO_ERR_UNSUPPORTED:
        return tribo_model_fail(
            m, status,
            "omega^2 = %g of mode %zu is hardly more than rounding of the stiffness, which comes to %g: make the stiffest "
            "parts softer, or rigid",
            doubt->omega2, doubt->mode, doubt->noise);
    default:
        return tribo_model_fail(m, status, "omega^2 = %g of mode %zu does not come out pure: reduce the system to fewer modes",
                                doubt->omega2, doubt->mode);
    }
}

static int search_failed(const struct model *m, int status, const struct low_modes *low)
{
    switch (status) {
    case TRIBO_OK:
        return TRIBO_OK;
    case TRIBO_ERR_MEMORY:
        return tribo_model_no_memory(m);
    case TRIBO_ERR_SIZE:
        return tribo_model_fail(m, status, "nmode = %zu, but the mass matrix lets the structure have %zu mode%s only", m->nmode,
                                low->count, plural(low->count));
    default:
        return tribo_model_fail(
            m, status, "nmode = %zu: these modes are not found, or not counted; reduce the system to fewer or more", m->nmode);
    }
}

/* ---------------------------------------------------------------------------------------------------------------- the factors */

/* Returns sum |K_ii| / sum |M_ii|; 1 without stiffness, 0 without mass. */
static double mean_square_frequency(const struct model *m)
{
    double stiffness = 0.0, mass = 0.0;
    for (size_t i = 0; i < m->ndof; i++) {
        stiffness += fabs(tribo_matrix_get(&m->stiffness, i, i));
        mass += fabs(tribo_matrix_get(&m->mass, i, i));
    }
    return !(mass > 0.0) ? 0.0 : stiffness > 0.0 ? greater(stiffness / mass, 1e-200) : 1.0;
}

/* Sets *c = the factor of factor K + other M. Returns a status. */
static int factorize_sum(const struct model *m, double factor, double other, struct cholesky *c, size_t *where)
{
    struct matrix sum;
    double pivot;
    memset(c, 0, sizeof *c);
    if (!tribo_matrix_sum(&sum, factor, &m->stiffness, other, &m->mass)) {
        return TRIBO_ERR_MEMORY;
    }
    return tribo_cholesky_consume(c, &sum, where, &pivot);
}

static int factor_failed(const struct model *m, int status, const char *what, size_t where)
{
    return status == TRIBO_ERR_INDEFINITE
               ? tribo_model_fail(m, status, "%s is not positive semidefinite: it shows at degree of freedom %zu", what, where)
           : status == TRIBO_ERR_SIZE ? tribo_model_too_large(m)
           : status
               ? tribo_model_fail(m, status, "out of memory for the factor of %zu degree%s of freedom", m->ndof, plural(m->ndof))
               : TRIBO_OK;
}

static int factorize_shifted(const struct model *m, struct shifted *s)
{
    const double mean = mean_square_frequency(m);
    size_t where = 0;
    int status = TRIBO_ERR_INDEFINITE;
    if (!(mean > 0.0)) {
        return tribo_model_fail(m, TRIBO_ERR_INDEFINITE, "mass is zero");
    }
    for (double part = SHIFT; status == TRIBO_ERR_INDEFINITE && part < MOST_SHIFT; part *= MORE) {
        s->shift = part * mean;
        status = factorize_sum(m, 1.0, s->shift, &s->factor, &where);
    }
    return factor_failed(m, status, "stiffness", where);
}

/* Returns TRIBO_ERR_INDEFINITE, and *where = i, if |M_ij| > sqrt(M_ii M_jj) for an entry; else TRIBO_OK. */
static int check_minors(const struct matrix *mass, size_t *where)
{
    for (size_t i = 0; i < mass->rows; i++) {
        const double own = tribo_matrix_get(mass, i, i);
        *where = i;
        for (size_t k = mass->first[i]; k < mass->first[i + 1]; k++) {
            const double other = tribo_matrix_get(mass, mass->col[k], mass->col[k]);
            if (own < 0.0 || fabs(mass->val[k]) > (1.0 + 1e-9) * sqrt(own) * sqrt(fabs(other))) {
                return TRIBO_ERR_INDEFINITE;
            }
        }
    }
    return TRIBO_OK;
}

/* Returns TRIBO_ERR_INDEFINITE, and the row *where, if M is not semidefinite. For large M only minors of two rows are checked:
 * with a positive definite K the low modes are right whatever M does to the high ones. */
static int check_mass(const struct model *m, size_t *where)
{
    struct cholesky c;
    int status = check_minors(&m->mass, where);
    if (!status && m->ndof <= DENSE_MOST && !tribo_matrix_is_diagonal(&m->mass)) {
        status = factorize_sum(m, SLIGHT / mean_square_frequency(m), 1.0, &c, where);
        tribo_cholesky_free(&c);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------------------ the modes */

/* Finds the `wanted` lowest modes among combinations of x [count][ndof]. Stiffer motions are unknown here: omega^2 is computed
 * without rounding of the largest entries, by tribo_matrix_form. Returns a status. */
static int find_among(const struct model *m, size_t count, const double *x, size_t wanted, struct reduced *r)
{
    const size_t n = m->ndof;
    struct matrix z = {0}, mass = {0};
    struct cholesky c = {0};
    struct doubt doubt = {0};
    size_t where;
    double pivot, *columns = malloc(count * n * sizeof *columns), *product = malloc(count * count * sizeof *product);
    int done = columns && product;
    if (done) {
        tribo_transpose(count, n, x, columns);
        done = tribo_matrix_from_dense(&z, n, count, columns) && tribo_matrix_congruent(&m->mass, &z, product) &&
               tribo_matrix_from_dense(&mass, count, count, product);
    }
    free(columns);
    free(product);
    int status = done ? tribo_cholesky_create(&c, &mass, &where, &pivot) : TRIBO_ERR_MEMORY;
    status = status ? status : tribo_normal_modes(&m->stiffness, m->terms, &z, &c, wanted, r->omega2, r->phi, &doubt);
    tribo_cholesky_free(&c);
    tribo_matrix_free(&mass);
    tribo_matrix_free(&z);
    for (size_t k = 0; !status && k < wanted; k++) {
        const double *phi = r->phi + k * n;
        r->omega2[k] = r->omega2[k] != 0.0 ? tribo_matrix_form(&m->stiffness, phi, phi) : 0.0;
    }
    r->count = wanted;
    return modes_failed(m, status, &doubt);
}

static int find_densely(const struct model *m, const struct cholesky *mass, struct reduced *r)
{
    const struct matrix whole = {0};
    struct doubt doubt = {0};
    const int status = tribo_normal_modes(&m->stiffness, m->terms, &whole, mass, m->nmode, r->omega2, r->phi, &doubt);
    r->count = m->nmode;
    r->truncation.above = m->nmode < m->ndof ? r->omega2[m->nmode - 1] : HUGE_VAL;
    return modes_failed(m, status, &doubt);
}

/* Sets change [count] = norms in M of (omega^2 + shift) (K + shift M)^-1 M phi - phi, for modes first .. first + count - 1. work
 * [2 count][ndof]. Returns 0 if out of memory. */
static int find_residuals(const struct model *m, const struct shifted *s, const struct reduced *r, size_t first, size_t count,
                          double *work, double *change)
{
    const size_t n = m->ndof;
    const double *phi = r->phi + first * n;
    double *mass = work + count * n;
    tribo_matrix_multiply_all(&m->mass, count, phi, work);
    if (!tribo_cholesky_solve(&s->factor, count, work)) {
        return 0;
    }
    for (size_t k = 0; k < count; k++) {
        for (size_t i = 0; i < n; i++) {
            work[k * n + i] = (r->omega2[first + k] + s->shift) * work[k * n + i] - phi[k * n + i];
        }
    }
    tribo_matrix_multiply_all(&m->mass, count, work, mass);
    for (size_t k = 0; k < count; k++) {
        change[k] = sqrt(fabs(tribo_dot(work + k * n, mass + k * n, n)));
    }
    return 1;
}

/* Checks that rounding moves no mode across low->above, where modes were counted. work [ndof]. Returns a status. */
static int check_gap(const struct model *m, const struct low_modes *low, const struct reduced *r, double *work)
{
    const size_t below = low->below < r->count ? low->below : r->count;
    tribo_matrix_roots(&m->stiffness, NULL, work);
    for (size_t k = below ? below - 1 : 0; k <= below && k < r->count; k++) {
        const double *phi = r->phi + k * m->ndof, distance = low->above - r->omega2[k];
        const double noise = low->growth * tribo_matrix_noise(&m->stiffness, work, phi, phi);
        if (!((k < below ? distance : -distance) > noise)) {
            return TRIBO_ERR_NO_CONVERGENCE;
        }
    }
    return TRIBO_OK;
}

/* Checks that each mode is an eigenvector, by SAME and SAME_SHIFT. work [2 CHECKED][ndof]. Returns a status. */
static int check_residuals(const struct model *m, const struct shifted *s, const struct reduced *r, double *work)
{
    for (size_t first = 0; first < r->count; first += CHECKED) {
        const size_t count = r->count - first < CHECKED ? r->count - first : CHECKED;
        double change[CHECKED];
        if (!find_residuals(m, s, r, first, count, work, change)) {
            return TRIBO_ERR_MEMORY;
        }
        for (size_t k = 0; k < count; k++) {
            const double omega2 = r->omega2[first + k];
            if (!(change[k] * (omega2 + s->shift) <= SAME * omega2 + SAME_SHIFT * s->shift)) {
                return TRIBO_ERR_NO_CONVERGENCE;
            }
        }
    }
    return TRIBO_OK;
}

static int check_modes(const struct model *m, const struct shifted *s, const struct low_modes *low, const struct reduced *r)
{
    double *work = malloc(2 * CHECKED * m->ndof * sizeof *work);
    int status = work ? check_gap(m, low, r, work) : TRIBO_ERR_MEMORY;
    status = status ? status : check_residuals(m, s, r, work);
    free(work);
    return search_failed(m, status, low);
}

static int find_sparsely(const struct model *m, const struct shifted *s, struct reduced *r)
{
    struct low_modes low;
    int status = search_failed(m, tribo_low_modes(&m->stiffness, &m->mass, s->shift, &s->factor, m->nmode, &low), &low);
    status = status ? status : find_among(m, low.count, low.phi, m->nmode, r);
    free(low.phi);
    r->truncation.above = low.below == m->nmode ? low.above : r->omega2[m->nmode - 1];
    return status ? status : check_modes(m, s, &low, r);
}

/* --------------------------------------------------------------------------------------------------------------- contacts */

/* Sets mx [ndof] = M x. Returns the norm of x in M. */
static double low_modes_weigh(const struct model *m, const double *x, double *mx)
{
    memset(mx, 0, m->ndof * sizeof *mx);
    tribo_matrix_multiply_add(&m->mass, 1.0, x, mx);
    const double square = tribo_dot(x, mx, m->ndof);
    return square > 0.0 ? sqrt(square) : 0.0;
}

/* x -= sum of phi_k (phi_k'M x), count phi_k orthonormal in M, twice. Sets mx [ndof] = M x. Returns the norm of x in M. */
static double low_modes_separate(const struct model *m, size_t count, const double *phi, double *x, double *mx)
{
    for (int pass = 0; pass < 2; pass++) {
        low_modes_weigh(m, x, mx);
        for (size_t k = 0; k < count; k++) {
            tribo_add(x, -tribo_dot(phi + k * m->ndof, mx, m->ndof), phi + k * m->ndof, m->ndof);
        }
    }
    return low_modes_weigh(m, x, mx);
}

/* Sets *omega2 = |x'Kx|/norm^2. Returns 1 if *omega2 < shift/2: no stiffness holds x, a static response does not exist. */
static int drifts(const struct model *m, const struct shifted *s, const double *x, double norm, double *omega2)
{
    *omega2 = norm > 0.0 ? fabs(tribo_matrix_form(&m->stiffness, x, x)) / norm / norm : HUGE_VAL;
    return *omega2 < 0.5 * s->shift;
}

/* If x [ndof], orthogonal to the motions, is a drift with a small elastic part, removes the elastic part by inverse iteration.
 * mx [ndof]: workspace. Returns the norm of x in M. */
static double purify(const struct model *m, const struct shifted *s, const struct reduced *r, double *x, double norm, double *mx)
{
    double omega2, before = HUGE_VAL;
    while (drifts(m, s, x, norm, &omega2) && omega2 < 0.25 * before) {
        low_modes_weigh(m, x, mx);
        memset(x, 0, m->ndof * sizeof *x);
        tribo_add(x, s->shift, mx, m->ndof);
        tribo_cholesky_solve(&s->factor, 1, x);
        norm = low_modes_separate(m, r->count, r->phi, x, mx);
        before = omega2;
    }
    return norm;
}

/* x [ndof]: response to a steady force at contact i. Removes its part in the modes, sets row i of missing [ncontact][ncontact] =
 * J x of the rest, and, with TRIBO_STATICS_MASS, appends the new part of the rest to the motions. */
static void add_static(const struct model *m, const struct shifted *s, struct reduced *r, size_t i, double *x, double *mx,
                       double *missing)
{
    const double whole = low_modes_weigh(m, x, mx), before = low_modes_separate(m, m->nmode, r->phi, x, mx);
    for (size_t j = 0; j < m->ncontact; j++) {
        missing[i * m->ncontact + j] = tribo_matrix_row_dot(&m->direction, j, x);
    }
    if (r->residual) {
        memcpy(r->residual + i * m->ndof, x, m->ndof * sizeof *x);
    }
    double norm =
        m->statics == TRIBO_STATICS_MASS ? low_modes_separate(m, r->count - m->nmode, r->phi + m->nmode * m->ndof, x, mx) : 0.0;
    if (norm > greater(OWN * before, ROUNDING * whole)) {
        norm = purify(m, s, r, x, norm, mx);
        for (size_t k = 0; k < m->ndof; k++) {
            r->phi[r->count * m->ndof + k] = x[k] / norm;
        }
        r->count++;
    }
}

/* A force at a contact acts on the modes only, if the rest after deflate is at most this part of the force. */
#define TAKEN 1e-12

/* force [ndof] -= sum of M phi_k (phi_k'force) over the modes, twice; force = 0 if the rest is rounding. mx [ndof]: workspace. */
static void deflate(const struct model *m, const struct reduced *r, double *force, double *mx)
{
    const double whole = tribo_dot(force, force, m->ndof);
    for (int pass = 0; pass < 2; pass++) {
        for (size_t k = 0; k < m->nmode; k++) {
            low_modes_weigh(m, r->phi + k * m->ndof, mx);
            tribo_add(force, -tribo_dot(r->phi + k * m->ndof, force, m->ndof), mx, m->ndof);
        }
    }
    if (!(tribo_dot(force, force, m->ndof) > TAKEN * TAKEN * whole)) {
        memset(force, 0, m->ndof * sizeof *force);
    }
}

/* Removes the effect of shift, except shift^2, from the responses x [count][ndof] of contacts first .. first + count - 1:
 * x += (K + shift M)^-1 shift M x. mx [ndof]: workspace. Returns 0 if out of memory. */
static int unshift(const struct model *m, const struct shifted *s, struct reduced *r, size_t first, size_t count, double *x,
                   double *mx)
{
    const size_t n = m->ndof;
    double *before = r->residual + first * n;
    for (size_t i = 0; i < count; i++) {
        low_modes_separate(m, m->nmode, r->phi, x + i * n, mx);
        memcpy(before + i * n, x + i * n, n * sizeof *x);
        memset(x + i * n, 0, n * sizeof *x);
        tribo_matrix_multiply_add(&m->mass, s->shift, before + i * n, x + i * n);
    }
    const int done = tribo_cholesky_solve(&s->factor, count, x);
    tribo_add(x, 1.0, before, count * n);
    return done;
}

static int add_statics(const struct model *m, const struct shifted *s, struct reduced *r, double *missing)
{
    const size_t n = m->ndof;
    double omega2, *x = malloc((BATCH + 1) * n * sizeof *x);
    int done = x != NULL, status = TRIBO_OK;
    for (size_t first = 0; done && !status && first < m->ncontact; first += BATCH) {
        const size_t count = m->ncontact - first < BATCH ? m->ncontact - first : BATCH;
        memset(x, 0, count * n * sizeof *x);
        for (size_t i = first; i < first + count; i++) {
            for (size_t k = m->direction.first[i]; k < m->direction.first[i + 1]; k++) {
                x[(i - first) * n + m->direction.col[k]] = m->direction.val[k];
            }
            if (r->residual) {
                deflate(m, r, x + (i - first) * n, x + BATCH * n);
            }
        }
        done = tribo_cholesky_solve(&s->factor, count, x) && (!r->residual || unshift(m, s, r, first, count, x, x + BATCH * n));
        for (size_t i = first; done && !status && i < first + count; i++) {
            double *y = x + (i - first) * n;
            if (r->residual && drifts(m, s, y, low_modes_weigh(m, y, x + BATCH * n), &omega2)) {
                status =
                    tribo_model_fail(m, TRIBO_ERR_UNSUPPORTED,
                                     "nmode = %zu leaves out a motion that contact %zu moves and no stiffness holds: take more "
                                     "modes, or TRIBO_STATICS_MASS",
                                     m->nmode, i);
            } else {
                add_static(m, s, r, i, y, x + BATCH * n, missing);
            }
        }
    }
    free(x);
    return done ? status : tribo_model_no_memory(m);
}

/* Makes the motions, with those of add_statics, orthogonal in K. Returns a status. */
static int finish_statics(const struct model *m, struct reduced *r)
{
    const size_t count = r->count;
    double *x = malloc(count * m->ndof * sizeof *x);
    if (!x) {
        return tribo_model_no_memory(m);
    }
    memcpy(x, r->phi, count * m->ndof * sizeof *x);
    const int status = find_among(m, count, x, count, r);
    free(x);
    return status;
}

/* whole [ncontact][ncontact] += the elastic part of the modes, J phi phi'J'/(omega^2 + shift); whole = missing on entry. */
static void add_modes(const struct model *m, const struct shifted *s, const struct reduced *r, double *whole)
{
    const size_t c = m->ncontact;
    for (size_t k = 0; k < m->nmode; k++) {
        for (size_t i = 0; i < c; i++) {
            const double part = r->omega2[k] > 0.0
                                    ? tribo_matrix_row_dot(&m->direction, i, r->phi + k * m->ndof) / (r->omega2[k] + s->shift)
                                    : 0.0;
            for (size_t j = 0; j < c; j++) {
                whole[i * c + j] += part * tribo_matrix_row_dot(&m->direction, j, r->phi + k * m->ndof);
            }
        }
    }
}

/* Sets *part = the largest x'Ax/x'Bx, A [n][n] semidefinite and a part of B, to rounding of the diagonal of B; 1 if B is lost in
 * the rounding of a subtraction, as of rigid-body motions. Overwrites a and b. Returns 0 if out of memory. */
static int largest_part(size_t n, double *a, double *b, double *part)
{
    struct matrix whole = {0};
    struct cholesky c = {0};
    size_t where;
    double pivot, *value = malloc((n + 1) * sizeof *value);
    for (size_t i = 0; i < n; i++) {
        b[i * n + i] += b[i * n + i] > 0.0 ? RIDGE * b[i * n + i] : 1.0;
    }
    int status =
        value && tribo_matrix_from_dense(&whole, n, n, b) ? tribo_cholesky_create(&c, &whole, &where, &pivot) : TRIBO_ERR_MEMORY;
    *part = 1.0;
    if (!status) {
        tribo_half_solve(&c, a, n);
        tribo_transpose(n, n, a, b);
        tribo_half_solve(&c, b, n);
        status = tribo_symmetric_eigen(b, n, value, a);
        *part = status ? 1.0 : clamp(n ? value[n - 1] : 0.0, 0.0, 1.0);
    }
    tribo_cholesky_free(&c);
    tribo_matrix_free(&whole);
    free(value);
    return status != TRIBO_ERR_MEMORY;
}

/* Sets r->flexibility and r->truncation.missing, and adds static motions to r. Returns a status. */
static int find_statics(const struct model *m, const struct shifted *s, struct reduced *r)
{
    const size_t c = m->ncontact;
    double *missing = calloc(2 * c * c + 1, sizeof *missing), *whole = missing + c * c;
    int status = missing ? add_statics(m, s, r, missing) : tribo_model_no_memory(m);
    if (!status && r->flexibility) {
        memcpy(r->flexibility, missing, c * c * sizeof *missing);
        tribo_even_out(c, r->flexibility);
    }
    r->truncation.missing = c > m->nmode ? 1.0 : 0.0;
    if (!status && c <= m->nmode) {
        memcpy(whole, missing, c * c * sizeof *whole);
        add_modes(m, s, r, whole);
        status = largest_part(c, missing, whole, &r->truncation.missing) ? TRIBO_OK : tribo_model_no_memory(m);
    }
    free(missing);
    return status || r->count == m->nmode ? status : finish_statics(m, r);
}

/* ------------------------------------------------------------------------------------------------------------------ calls */

void tribo_reduced_free(struct reduced *r)
{
    free(r->omega2);
    free(r->phi);
    free(r->residual);
}

static int find_lowest_densely(const struct model *m, struct shifted *s, struct reduced *r)
{
    struct cholesky mass;
    int status = m->ndof > DENSE_MOST ? tribo_model_too_large(m) : tribo_model_factorize(m, &mass);
    if (!status) {
        status = find_densely(m, &mass, r);
        tribo_cholesky_free(&mass);
    }
    return status || r->omega2[0] < 0.0 ? status : factorize_shifted(m, s);
}

/* Finds the lowest modes: by Lanczos' method for large structures with few modes, and for singular mass. Returns a status. */
static int find_lowest(const struct model *m, struct shifted *s, struct reduced *r)
{
    const int large = m->ndof > DENSE_MOST || (m->ndof >= SPARSE_LEAST && 4 * m->nmode <= m->ndof);
    size_t where = 0;
    if (!large || !tribo_sparse_available()) {
        const int status = find_lowest_densely(m, s, r);
        if (status != TRIBO_ERR_INDEFINITE || !tribo_sparse_available() || check_mass(m, &where) == TRIBO_ERR_INDEFINITE) {
            return status;
        }
    }
    int status = check_mass(m, &where);
    status = factor_failed(m, status, "mass", where);
    status = status ? status : factorize_shifted(m, s);
    return status ? status : find_sparsely(m, s, r);
}

int tribo_model_find_modes(const struct model *m, struct reduced *r)
{
    const size_t n = m->ndof, most = m->nmode + (m->statics == TRIBO_STATICS_MASS ? m->ncontact : 0);
    struct shifted s = {0.0, {0}};
    memset(r, 0, sizeof *r);
    r->omega2 = malloc(most * sizeof *r->omega2);
    r->phi = malloc(most * n * sizeof *r->phi);
    r->truncation.order = m->statics == TRIBO_STATICS_MASS ? 2.0 : m->statics == TRIBO_STATICS_COMPLIANCE ? 1.0 : 0.0;
    if (m->statics == TRIBO_STATICS_COMPLIANCE) {
        r->residual = calloc(m->ncontact * (n + m->ncontact) + 1, sizeof *r->residual);
        r->flexibility = r->residual ? r->residual + m->ncontact * n : NULL;
    }
    const int done = r->omega2 && r->phi && (r->residual || m->statics != TRIBO_STATICS_COMPLIANCE);
    int status = done ? find_lowest(m, &s, r) : tribo_model_no_memory(m);
    if (!status && r->omega2[0] < 0.0) {
        status = tribo_model_fail(m, TRIBO_ERR_INDEFINITE, "stiffness is not positive semidefinite: omega^2 = %g of mode 0",
                                  r->omega2[0]);
    }
    status = status || m->nmode == n || !m->ncontact ? status : find_statics(m, &s, r);
    r->truncation.shift = r->residual ? 0.0 : s.shift;
    r->truncation.above += r->truncation.shift;
    tribo_cholesky_free(&s.factor);
    return status;
}
