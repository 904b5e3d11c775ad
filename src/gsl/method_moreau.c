/* Method "moreau/fixed": the implicit midpoint rule for the structure, Coulomb's law over the step, the mean of the
 * loads at both ends (Jean and Moreau 1992, theta = 1/2); the structure's part is factorized once for a step length. Stable for
 * any dt. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "breakaway.h"
#include "hidden.h"
#include "step_form.h"

/* For steps of length h: A = I + h/2 AC + h^2/4 AK in GSL's band format, factorized; A^-1 B; and the contacts that see it. */
struct moreau {
    struct step_form common;
    double h; /* 0: nothing is prepared */
    size_t below, above;
    double *band;
    unsigned int *pivot;
    double *response;         /* [ncontact][ndof] */
    double *limit;            /* [ncontact] */
    double *ratio, *velocity; /* [ncontact] of static limits */
    size_t statics;           /* revision of the system's contacts that these came from; 0: contacts have not got them */
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
        free(m->limit);
        free(m->band);
        free(m->pivot);
        free(m->response);
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
    }
    if (!m || !m->limit || !tribo_step_form_create(&m->common, drv->sys)) {
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
    gsl_matrix_view a = gsl_matrix_view_array(m->band, n, 2 * m->below + m->above + 1);
    gsl_vector_view b = gsl_vector_view_array(x, n);
    const gsl_vector_uint pivot = {n, 1, m->pivot, NULL, 0};
    gsl_linalg_LU_band_svx(m->below, m->above, &a.matrix, &pivot, &b.vector);
}

static int factorize(struct moreau *m, const tribo_system *sys, double h)
{
    const size_t n = sys->ndof;
    m->below = m->above = 0;
    widen(&sys->stiffness, &m->below, &m->above);
    widen(&sys->damping, &m->below, &m->above);
    const size_t width = 2 * m->below + m->above + 1, middle = m->below + m->above;
    free(m->band);
    free(m->pivot);
    m->band = calloc(n * width, sizeof *m->band);
    m->pivot = malloc(n * sizeof *m->pivot);
    if (!m->band || !m->pivot) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the matrix of a step");
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
            return tribo_system_fail(sys, TRIBO_ERR_INDEFINITE,
                                     "the matrix of a step of length %g is singular at degree of freedom %zu", h, i);
        }
    }
    return TRIBO_OK;
}

/* A is diagonal: the operator is that of the bodies one by one. */
static int set_bodies(struct moreau *m, const tribo_system *sys)
{
    const struct matrix *j = &sys->direction;
    double *inverse = calloc(sys->ndof, sizeof *inverse);
    if (!inverse) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the contacts of a step");
    }
    for (size_t i = 0; i < j->rows; i++) {
        for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
            const size_t d = j->col[k];
            inverse[d] = j->val[k] != 0.0 ? m->response[i * sys->ndof + d] / j->val[k] : inverse[d];
        }
    }
    const int status = tribo_set_operator_mass(m->contacts, sys->ndof, inverse, j->first, j->col, j->val);
    free(inverse);
    return status ? tribo_system_fail(sys, status, "in a step, %s", tribo_message(m->contacts)) : TRIBO_OK;
}

/* The operator is r, unless that hides bodies. */
static int set_operator(struct moreau *m, const tribo_system *sys, const double *r, double h)
{
    struct hidden where;
    switch (tribo_hidden(&sys->direction, &sys->mass, m->response, r, &where)) {
    case 0:
        break;
    case 1:
        return m->below || m->above
                   ? tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                       "contact %zu touches bodies of which one gives way %g times as much as the other in steps "
                                       "of %g: take central/fixed, event or exact",
                                       where.contact, where.spread, h)
                   : set_bodies(m, sys);
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
    m->statics = 0;
    const int status =
        planar_of(sys->contacts) ? tribo_clone(sys->contacts, &m->contacts) : tribo_create(&m->contacts, sys->ncontact);
    m->contacts = status ? NULL : m->contacts;
    return !status;
}

/* Prepares steps of length h: the factor, A^-1 B, and a context with the operator J A^-1 B. */
static int prepare(struct moreau *m, const tribo_system *sys, double h)
{
    const size_t n = sys->ndof, c = sys->ncontact;
    m->h = 0.0;
    int status = factorize(m, sys, h);
    if (status) {
        return status;
    }
    free(m->response);
    m->response = tribo_matrix_transpose_to_dense(&sys->response);
    double *r = calloc(c * c + 1, sizeof *r);
    if (!m->response || !r || !make_contacts(m, sys)) {
        free(r);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the contacts of a step");
    }
    for (size_t j = 0; j < c; j++) {
        double *column = m->response + j * n;
        solve(m, n, column);
        for (size_t i = 0; i < c; i++) {
            r[i * c + j] = tribo_matrix_row_dot(&sys->direction, i, column);
        }
    }
    status = set_operator(m, sys, r, h);
    free(r);
    if (status) {
        return status;
    }
    m->h = h;
    m->common.revision = sys->revision;
    return TRIBO_OK;
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
    tribo_set_limit(m->contacts, m->limit);
    if (m->statics != revision) {
        tribo_get_static(sys->contacts, m->ratio, m->velocity);
        tribo_set_static(m->contacts, m->ratio, tribo_system_falls(sys) ? m->velocity : NULL);
        m->statics = revision;
    }
}

static int moreau_step(tribo_driver *drv, double t, double next, double *y)
{
    struct moreau *m = drv->own;
    struct step_form *s = &m->common;
    tribo_system *sys = drv->sys;
    const size_t n = sys->ndof, c = sys->ncontact;
    const double h = next - t;
    double *du = s->a, *u = y + n;
    /* steps of equal length differ by the rounding of time only */
    if (!(fabs(h - m->h) <= 1e-9 * h) || s->revision != sys->revision || planar_changed(m, sys)) {
        const int status = prepare(m, sys, h);
        if (status) {
            return tribo_driver_fail(drv, status, "%s", tribo_message(sys->contacts));
        }
    }
    tribo_step_form_begin(s, sys, t, u);
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
    solve(m, n, du);
    for (size_t i = 0; i < n; i++) {
        s->u[i] = u[i] + du[i];
    }
    tribo_step_form_find_base(s, sys, next);
    tribo_step_form_relative(s, sys, s->u, s->end);
    tribo_step_form_set_limits(sys, t + 0.5 * h);
    take_limits(m, sys);
    const int status = tribo_step_form_force(s, m->contacts, h);
    if (status == TRIBO_ERR_NOT_FINITE) {
        return tribo_step_form_grew(drv, t);
    }
    if (status) {
        return tribo_driver_fail(drv, status, "at t = %.17g: %s", t, tribo_message(m->contacts));
    }
    for (size_t i = 0; i < c; i++) {
        for (size_t d = 0; d < n; d++) {
            s->u[d] += h * s->f[i] * m->response[i * n + d];
        }
    }
    tribo_get_slip(m->contacts, s->mode);
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

const struct method tribo_method_moreau_fixed = {
    "moreau/fixed", WITHOUT_TOLERANCES, create, destroy, moreau_advance, NULL, NULL, NULL};
