/* Method "moreau/fixed": the implicit midpoint rule for the structure, Coulomb's law over the step, the mean of the
 * loads at both ends (Jean and Moreau 1992, theta = 1/2); the structure's part is factorized once for a step length. Stable for
 * any dt. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "breakaway.h"
#include "hidden.h"
#include "step_band.h"
#include "step_form.h"

/* For steps of length h: A = I + h/2 AC + h^2/4 AK in GSL's band format, or M + h/2 C + h^2/4 K of an unsolved system, factorized;
 * A^-1 B; and the contacts that see it. */
struct moreau {
    struct step_form common;
    double h;              /* 0: nothing is prepared */
    struct step_band held; /* where the system allows it: then the rest is made when it is first needed */
    int whole;             /* the rest is made */
    size_t below, above;
    double *band;
    unsigned int *pivot;
    struct cholesky sparse;   /* or of M A */
    double *weight;           /* [ndof] M, if it is to be multiplied with before that solves; or NULL */
    double *response;         /* [ncontact][ndof], or NULL: then a step takes a second solve */
    double *push;             /* [ndof] for that */
    double *limit;            /* [ncontact] */
    double *ratio, *velocity; /* [ncontact] of static limits */
    size_t statics;           /* revision of the system's contacts that these came from */
    int breaks, tell;         /* some limits are static; contacts have not got them yet */
    double *load;             /* [ndof] at the end of the step before */
    tribo_context *contacts;
    size_t settings; /* revision of the system's contacts that these came from, if planar ones are among them */
};

static void destroy(tribo_driver *drv)
{
    struct moreau *m = drv->own;
    if (m) {
        tribo_destroy(m->contacts);
        tribo_step_form_free(&m->common);
        tribo_step_band_free(&m->held);
        free(m->limit);
        free(m->band);
        free(m->pivot);
        free(m->weight);
        free(m->response);
        free(m->push);
        tribo_cholesky_free(&m->sparse);
        free(m);
    }
}

static int create(tribo_driver *drv)
{
    const size_t n = drv->sys->ndof, c = drv->sys->ncontact;
    struct moreau *m = calloc(1, sizeof *m);
    drv->own = m;
    if (m) {
        m->limit = calloc(3 * c + n + 1, sizeof *m->limit);
        m->push = calloc(n, sizeof *m->push);
    }
    if (!m || !m->limit || !m->push || !tribo_step_form_create(&m->common, drv->sys)) {
        return tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method %s", drv->method->name);
    }
    m->ratio = m->limit + c;
    m->velocity = m->limit + 2 * c;
    m->load = m->limit + 3 * c;
    return TRIBO_OK;
}

static void widen(const struct matrix *a, size_t *below, size_t *above)
{
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            *below = i > a->col[k] && i - a->col[k] > *below ? i - a->col[k] : *below;
            *above = a->col[k] > i && a->col[k] - i > *above ? a->col[k] - i : *above;
        }
    }
}

static void solve(const struct moreau *m, size_t n, double *x)
{
    if (m->sparse.n) {
        for (size_t i = 0; m->weight && i < n; i++) {
            x[i] *= m->weight[i];
        }
        tribo_cholesky_solve(&m->sparse, 1, x);
        return;
    }
    gsl_matrix_view a = gsl_matrix_view_array(m->band, n, 2 * m->below + m->above + 1);
    gsl_vector_view b = gsl_vector_view_array(x, n);
    const gsl_vector_uint pivot = {n, 1, m->pivot, NULL, 0};
    gsl_linalg_LU_band_svx(m->below, m->above, &a.matrix, &pivot, &b.vector);
}

static int singular(const tribo_system *sys, double h, size_t where)
{
    return tribo_system_fail(sys, TRIBO_ERR_INDEFINITE,
                             "the matrix of a step of length %g is singular at degree of freedom %zu", h, where);
}

static int no_memory(const tribo_system *sys)
{
    return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the matrix of a step");
}

/* a = M A, of which the rows of an unsolved system are, and those of others are weighed with diagonal masses. */
static int sum_up(const tribo_system *sys, double h, struct matrix *a)
{
    struct matrix mass = {0}, viscous = {0};
    const int damped = sys->damping.rows > 0;
    int done = sys->unsolved || tribo_matrix_diagonal(&mass, sys->ndof, NULL);
    const struct matrix *first = sys->unsolved ? &sys->mass : &mass;
    done = done && (!damped || tribo_matrix_sum(&viscous, 1.0, first, 0.5 * h, &sys->damping)) &&
           tribo_matrix_sum(a, 1.0, damped ? &viscous : first, 0.25 * h * h, &sys->stiffness);
    tribo_matrix_free(&viscous);
    tribo_matrix_free(&mass);
    return done;
}

/* The sparse factor of M A. TRIBO_ERR_INDEFINITE, with the place, or TRIBO_ERR_NOT_SYMMETRIC if it has none. */
static int factorize_sparsely(struct moreau *m, const tribo_system *sys, double h, size_t *where)
{
    struct matrix a = {0};
    size_t i, j;
    double pivot, x, y;
    if (!sum_up(sys, h, &a)) {
        return TRIBO_ERR_MEMORY;
    }
    if (m->weight) {
        tribo_matrix_scale_rows(&a, m->weight);
    }
    const int lopsided = m->weight && tribo_matrix_flaw(&a, 1, &i, &j, &x, &y); /* an unsolved system's has been looked at */
    const int status = lopsided ? TRIBO_ERR_NOT_SYMMETRIC : tribo_cholesky_create(&m->sparse, &a, where, &pivot);
    tribo_matrix_free(&a);
    if (status) {
        tribo_cholesky_free(&m->sparse);
    }
    return status;
}

static int factorize_unsolved(struct moreau *m, const tribo_system *sys, double h)
{
    size_t where = 0;
    const int status = factorize_sparsely(m, sys, h, &where);
    return status == TRIBO_ERR_INDEFINITE
               ? tribo_system_fail(
                     sys, status, "the matrix of a step of length %g is not positive definite at degree of freedom %zu", h, where)
           : status ? no_memory(sys)
                    : TRIBO_OK;
}

/* A band that holds far more than there is gives way to a sparse factor, where masses are diagonal. */
static int suits_sparse(const struct moreau *m, const tribo_system *sys)
{
    const size_t n = sys->ndof, width = 2 * m->below + m->above + 1;
    return tribo_sparse_available() && sys->mass.rows && tribo_matrix_is_diagonal(&sys->mass) &&
           width > 16 * (sys->stiffness.first[n] / n + 1);
}

/* TRIBO_OK also if there is no such factor: then m->sparse.n is 0. */
static int try_sparse(struct moreau *m, const tribo_system *sys, double h)
{
    size_t where;
    m->weight = malloc(sys->ndof * sizeof *m->weight);
    if (!m->weight) {
        return no_memory(sys);
    }
    for (size_t i = 0; i < sys->ndof; i++) {
        m->weight[i] = tribo_matrix_get(&sys->mass, i, i);
    }
    return factorize_sparsely(m, sys, h, &where) == TRIBO_ERR_MEMORY ? no_memory(sys) : TRIBO_OK;
}

static int factorize_band(struct moreau *m, const tribo_system *sys, double h)
{
    const size_t n = sys->ndof, width = 2 * m->below + m->above + 1, middle = m->below + m->above;
    m->band = calloc(n * width, sizeof *m->band);
    m->pivot = malloc(n * sizeof *m->pivot);
    if (!m->band || !m->pivot) {
        return no_memory(sys);
    }
    const struct matrix *part[] = {&sys->stiffness, &sys->damping};
    const double factor[] = {0.25 * h * h, 0.5 * h};
    for (size_t i = 0; i < n; i++) {
        m->band[i * width + middle] = 1.0;
    }
    for (int p = 0; p < 2; p++) {
        for (size_t i = 0; i < part[p]->rows; i++) {
            for (size_t k = part[p]->first[i]; k < part[p]->first[i + 1]; k++) {
                m->band[part[p]->col[k] * width + middle + i - part[p]->col[k]] += factor[p] * part[p]->val[k];
            }
        }
    }
    gsl_matrix_view a = gsl_matrix_view_array(m->band, n, width);
    gsl_vector_uint pivot = {n, 1, m->pivot, NULL, 0};
    gsl_linalg_LU_band_decomp(n, m->below, m->above, &a.matrix, &pivot);
    for (size_t i = 0; i < n; i++) {
        if (m->band[i * width + middle] == 0.0) {
            return singular(sys, h, i);
        }
    }
    return TRIBO_OK;
}

static int factorize(struct moreau *m, const tribo_system *sys, double h)
{
    free(m->band);
    free(m->pivot);
    free(m->weight);
    tribo_cholesky_free(&m->sparse);
    m->band = m->weight = NULL;
    m->pivot = NULL;
    m->below = m->above = 0;
    if (sys->unsolved) {
        return factorize_unsolved(m, sys, h);
    }
    widen(&sys->stiffness, &m->below, &m->above);
    widen(&sys->damping, &m->below, &m->above);
    const int status = suits_sparse(m, sys) ? try_sparse(m, sys, h) : TRIBO_OK;
    return status || m->sparse.n ? status : factorize_band(m, sys, h);
}

/* A is diagonal: the operator is that of the bodies one by one. */
static int set_bodies(struct moreau *m, const tribo_system *sys, const double *own)
{
    const struct matrix *j = &sys->direction;
    double *inverse = calloc(sys->ndof, sizeof *inverse);
    if (!inverse) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the contacts of a step");
    }
    for (size_t i = 0; i < j->rows; i++) {
        for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
            const size_t d = j->col[k];
            inverse[d] = j->val[k] != 0.0 ? own[k] / j->val[k] : inverse[d];
        }
    }
    const int status = tribo_set_operator_mass(m->contacts, sys->ndof, inverse, j->first, j->col, j->val);
    free(inverse);
    return status ? tribo_system_fail(sys, status, "in a step, %s", tribo_message(m->contacts)) : TRIBO_OK;
}

/* The operator is r, unless that hides bodies; own as in hidden.h. */
static int set_operator(struct moreau *m, const tribo_system *sys, const double *r, const double *own, double h)
{
    struct hidden where;
    switch (tribo_hidden(&sys->direction, &sys->mass, own, r, &where)) {
    case 0:
        break;
    case 1:
        return m->below || m->above || m->sparse.n
                   ? tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                       "contact %zu touches bodies of which one gives way %g times as much as the other in steps "
                                       "of %g: %s",
                                       where.contact, where.spread, h,
                                       sys->unsolved ? "reduce the system" : "take central/fixed, event or exact")
                   : set_bodies(m, sys, own);
    default:
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the contacts of a step");
    }
    const int status = tribo_set_operator_dense(m->contacts, r);
    return status ? tribo_system_fail(sys, status, "in steps of %g, %s", h, tribo_message(m->contacts)) : TRIBO_OK;
}

static size_t planar_of(const tribo_context *contacts)
{
    size_t planar = 0;
    return contacts && !tribo_get_count(contacts, TRIBO_COUNT_PLANAR, &planar) ? planar : 0;
}

/* Whether the system's contacts may have become planar, or others than before. */
static int planar_changed(const struct moreau *m, const tribo_system *sys)
{
    return (planar_of(sys->contacts) || planar_of(m->contacts)) && m->settings != tribo_revision(sys->contacts);
}

/* Contacts of its own, planar where the system's are. */
static int make_contacts(struct moreau *m, const tribo_system *sys)
{
    if (m->contacts && !planar_of(sys->contacts) && !planar_of(m->contacts)) {
        return 1;
    }
    tribo_destroy(m->contacts);
    m->contacts = NULL;
    m->settings = tribo_revision(sys->contacts);
    m->tell = 1;
    const int status =
        planar_of(sys->contacts) ? tribo_clone(sys->contacts, &m->contacts) : tribo_create(&m->contacts, sys->ncontact);
    m->contacts = status ? NULL : m->contacts;
    return !status;
}

/* A^-1 B is kept unless it is more than a fifth of a sparse factor: then a step is one solve. */
static int keeps_response(const struct moreau *m, const tribo_system *sys)
{
    return !m->sparse.sparse || sys->ncontact * sys->ndof <= tribo_sparse_factor_entries(m->sparse.sparse) / 5;
}

/* r [ncontact][ncontact] = J A^-1 B, and own as in hidden.h; x [ndof] is workspace. b = B'. */
static void find_operator(struct moreau *m, const tribo_system *sys, const struct matrix *b, double *x, double *r, double *own)
{
    const size_t n = sys->ndof, c = sys->ncontact;
    const struct matrix *direction = &sys->direction;
    for (size_t j = 0; j < c; j++) {
        memset(x, 0, n * sizeof *x);
        for (size_t k = b->first[j]; k < b->first[j + 1]; k++) {
            x[b->col[k]] = b->val[k];
        }
        solve(m, n, x);
        for (size_t i = 0; i < c; i++) {
            r[i * c + j] = tribo_matrix_row_dot(direction, i, x);
        }
        for (size_t k = direction->first[j]; k < direction->first[j + 1]; k++) {
            own[k] = x[direction->col[k]];
        }
        if (m->response) {
            memcpy(m->response + j * n, x, n * sizeof *x);
        }
    }
}

/* The factor, A^-1 B, and a context with the operator J A^-1 B. */
static int prepare_whole(struct moreau *m, const tribo_system *sys, double h)
{
    const size_t c = sys->ncontact;
    struct matrix b = {0};
    int status = factorize(m, sys, h);
    if (status) {
        return status;
    }
    const int keeps = keeps_response(m, sys);
    free(m->response);
    m->response = keeps ? malloc((c * sys->ndof + 1) * sizeof *m->response) : NULL;
    double *r = calloc(c * c + 1, sizeof *r), *own = malloc((sys->direction.first[c] + 1) * sizeof *own);
    if (r && own && (m->response || !keeps) && make_contacts(m, sys) && tribo_matrix_transpose(&b, &sys->response)) {
        find_operator(m, sys, &b, m->push, r, own);
        status = set_operator(m, sys, r, own, h);
    } else {
        status = tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the contacts of a step");
    }
    tribo_matrix_free(&b);
    free(r);
    free(own);
    m->whole = !status;
    return status;
}

/* u += h A^-1 B f. */
static void push(struct moreau *m, const tribo_system *sys, double h, const double *f, double *u)
{
    const size_t n = sys->ndof;
    for (size_t i = 0; m->response && i < sys->ncontact; i++) {
        for (size_t d = 0; d < n; d++) {
            u[d] += h * f[i] * m->response[i * n + d];
        }
    }
    if (!m->response) {
        memset(m->push, 0, n * sizeof *m->push);
        tribo_matrix_multiply_add(&sys->response, h, f, m->push);
        solve(m, n, m->push);
        tribo_add(u, 1.0, m->push, n);
    }
}

/* Prepares steps of length h. */
static int prepare(struct moreau *m, const tribo_system *sys, double h)
{
    size_t where = 0;
    m->h = 0.0;
    m->whole = 0;
    m->held.n = 0;
    int status = planar_of(sys->contacts) ? TRIBO_OK : tribo_step_band_create(&m->held, sys, h, &where);
    status = status == TRIBO_ERR_INDEFINITE ? singular(sys, h, where)
             : status                       ? no_memory(sys)
             : m->held.n                    ? TRIBO_OK
                                            : prepare_whole(m, sys, h);
    if (!status) {
        m->h = h;
        m->common.revision = sys->revision;
    }
    return status;
}

static void find_load(struct moreau *m, tribo_system *sys, double t)
{
    tribo_system_set_time(sys, t);
    memset(m->load, 0, sys->ndof * sizeof *m->load);
    tribo_system_loads(sys, DRIVES_LOAD, 0, 1.0, m->load);
}

static void take_limits(struct moreau *m, const tribo_system *sys)
{
    const size_t revision = tribo_revision(sys->contacts);
    tribo_get_limit(sys->contacts, m->limit);
    if (m->statics != revision) {
        m->statics = revision;
        m->breaks = 0;
        m->tell = 1;
        tribo_get_static(sys->contacts, m->ratio, m->velocity);
        for (size_t i = 0; i < sys->ncontact; i++) {
            m->breaks |= m->ratio[i] > 1.0;
        }
    }
}

static void give_limits(struct moreau *m, const tribo_system *sys)
{
    tribo_set_limit(m->contacts, m->limit);
    if (m->tell) {
        tribo_set_static(m->contacts, m->ratio, tribo_system_falls(sys) ? m->velocity : NULL);
        m->tell = 0;
    }
}

/* What loads and structure do to the velocities in a step, but for the inverse of A; s->u is where half of a step leads to. */
static void find_push(struct moreau *m, tribo_system *sys, double t, double next, const double *y, double *du)
{
    struct step_form *s = &m->common;
    const size_t n = sys->ndof;
    const double h = next - t, *u = y + n;
    if (!s->goes_on) {
        find_load(m, sys, t);
    }
    for (size_t i = 0; i < n; i++) {
        s->u[i] = y[i] + 0.5 * h * u[i];
        du[i] = 0.5 * h * m->load[i];
    }
    find_load(m, sys, next);
    for (size_t i = 0; i < n; i++) {
        du[i] += 0.5 * h * m->load[i];
    }
    tribo_matrix_multiply_add(&sys->stiffness, -h, s->u, du);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -h, u, du);
    }
    sys->evaluations++;
}

/* The forces of the step, which contacts slide, and the velocity s->u at its end: from the operator that contacts see. */
static int respond_whole(struct moreau *m, const tribo_system *sys, double h, const double *u, double *du)
{
    struct step_form *s = &m->common;
    const size_t n = sys->ndof;
    solve(m, n, du);
    for (size_t i = 0; i < n; i++) {
        s->u[i] = u[i] + du[i];
    }
    tribo_step_form_relative(s, sys, s->u, s->end);
    give_limits(m, sys);
    const int status = tribo_step_form_force(s, m->contacts, h);
    if (status) {
        return status;
    }
    push(m, sys, h, s->f, s->u);
    tribo_get_slip(m->contacts, s->mode);
    return TRIBO_OK;
}

/* The same in the band; 0 if that is not the way, or has not led to the end. */
static int respond_in_band(struct moreau *m, const tribo_system *sys, double h, const double *u, double *du)
{
    struct step_form *s = &m->common;
    if (!m->held.n || m->breaks || !tribo_step_band_solve(&m->held, h, m->limit, s->base, u, du, s->f)) {
        return 0;
    }
    for (size_t i = 0; i < sys->ndof; i++) {
        s->u[i] = u[i] + du[i];
    }
    memcpy(s->mode, m->held.at, sys->ncontact);
    return 1;
}

static int respond(struct moreau *m, const tribo_system *sys, double h, const double *u, double *du)
{
    if (respond_in_band(m, sys, h, u, du)) {
        return tribo_dense_finite(m->common.f, sys->ncontact) ? TRIBO_OK : TRIBO_ERR_NOT_FINITE;
    }
    const int status = m->whole ? TRIBO_OK : prepare_whole(m, sys, h);
    return status ? status : respond_whole(m, sys, h, u, du);
}

static int moreau_step(tribo_driver *drv, double t, double next, double *y)
{
    struct moreau *m = drv->own;
    struct step_form *s = &m->common;
    tribo_system *sys = drv->sys;
    const size_t n = sys->ndof;
    const double h = next - t;
    double *u = y + n;
    /* steps of equal length differ by the rounding of time only */
    if (!(fabs(h - m->h) <= 1e-9 * h) || s->revision != sys->revision || planar_changed(m, sys)) {
        const int status = prepare(m, sys, h);
        if (status) {
            return tribo_driver_fail(drv, status, "%s", tribo_message(sys->contacts));
        }
    }
    tribo_step_form_begin(s, sys, t, u);
    find_push(m, sys, t, next, y, s->a);
    tribo_step_form_find_base(s, sys, next);
    tribo_step_form_set_limits(sys, t + 0.5 * h);
    take_limits(m, sys);
    const int status = respond(m, sys, h, u, s->a);
    if (status == TRIBO_ERR_NOT_FINITE) {
        return tribo_step_form_grew(drv, t);
    }
    if (status) {
        return tribo_driver_fail(drv, status, "at t = %.17g: %s", t, tribo_message(m->whole ? m->contacts : sys->contacts));
    }
    tribo_system_snap(sys, s->mode, s->base, s->u);
    tribo_step_form_relative(s, sys, s->u, s->end);
    s->goes_on = 1;
    for (size_t i = 0; i < n; i++) {
        y[i] += 0.5 * h * (u[i] + s->u[i]);
        u[i] = s->u[i];
    }
    y[2 * n] += h * tribo_step_form_power(sys, s->f, s->v, s->end);
    return TRIBO_OK;
}

static int moreau_advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    struct moreau *m = drv->own;
    struct step_form *s = &m->common;
    s->goes_on = continues && s->goes_on;
    return tribo_driver_fixed_steps(drv, t, t1, y, moreau_step);
}

const struct method tribo_method_moreau_fixed = {"moreau/fixed", WITHOUT_TOLERANCES, create, destroy, moreau_advance, NULL, NULL};
