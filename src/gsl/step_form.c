/* Methods "central/fixed" and "moreau/fixed": the step form of Coulomb's law (tribo_step_force) with fixed steps. No epsilon,
 * contacts at rest stay at rest exactly, and the energy that friction dissipates is that of the discrete motion, -h f'(v +
 * v_end)/2 a step.
 *
 * central/fixed  central differences: velocities half a step apart from positions. Explicit; stable for dt < 2/omega_max. Damping
 * acts on the velocity of half a step before. moreau/fixed   the implicit midpoint rule for the structure, Coulomb's law at the
 * end of the step, the mean of the loads at both ends (Jean and Moreau 1992, theta = 1/2); the structure's part is factorized
 * once for a step length. Stable for any dt. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "driver.h"
#include "hidden.h"
#include "spectrum.h"
#include "../common/real.h"

struct step_form {
    double *u, *a;       /* [ndof] velocity (central: half a step back), acceleration or what a step adds to u */
    double *v, *end, *f; /* [ncontact] velocity before and at the end, force */
    double *base;        /* [ncontact] b at the end */
    int goes_on;         /* end is the velocity that the next step begins with, and load the load */
    signed char *mode;   /* [ncontact] */
    size_t revision;     /* of the system that what follows was prepared for */

    double energy, last; /* central: dissipated up to u; the step before, 0: u is the velocity at t */
    double stable;       /* a step found to be stable; 0: none */
    double *aside;       /* [ncontact] */

    /* moreau, for steps of length h: A = I + h/2 AC + h^2/4 AK in GSL's band format, factorized; A^-1 B; and the contacts that
     * see it */
    double h; /* 0: nothing is prepared */
    size_t below, above;
    double *band;
    unsigned int *pivot;
    double *response; /* [ncontact][ndof] */
    double *limit;    /* [ncontact] */
    double *load;     /* [ndof] at the end */
    tribo_context *contacts;
};

/* ------------------------------------------------------------------------------------------------------------ both */

static void destroy(tribo_driver *drv)
{
    struct step_form *s = drv->own;
    if (s) {
        tribo_destroy(s->contacts);
        free(s->u);
        free(s->mode);
        free(s->band);
        free(s->pivot);
        free(s->response);
        free(s);
    }
}

static int create(tribo_driver *drv)
{
    const size_t n = drv->sys->ndof, c = drv->sys->ncontact;
    struct step_form *s = calloc(1, sizeof *s);
    double *work = calloc(3 * n + 6 * c + 1, sizeof *work);
    drv->own = s;
    if (s) {
        s->u = work;
        s->mode = malloc(c + 1);
    }
    if (!s || !work || !s->mode) {
        free(s ? NULL : work);
        return tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method %s", drv->method->name);
    }
    s->a = work + n;
    s->load = work + 2 * n;
    s->v = work + 3 * n;
    s->end = s->v + c;
    s->f = s->end + c;
    s->limit = s->f + c;
    s->base = s->limit + c;
    s->aside = s->base + c;
    return TRIBO_OK;
}

/* base = b(t), if the base moves at all. */
static void find_base(struct step_form *s, tribo_system *sys, double t)
{
    if (sys->base_harmonics) {
        tribo_system_set_time(sys, t);
        memset(s->base, 0, sys->ncontact * sizeof *s->base);
        tribo_system_loads(sys, 1, 0, 1.0, s->base);
    }
}

/* v = J u - base. */
static void relative(const struct step_form *s, const tribo_system *sys, const double *u, double *v)
{
    for (size_t i = 0; i < sys->ncontact; i++) {
        v[i] = -s->base[i];
    }
    tribo_matrix_multiply_add(&sys->direction, 1.0, u, v);
}

/* v = the velocity that a step begins with, at t. */
static void begin(struct step_form *s, tribo_system *sys, double t, const double *u)
{
    if (s->goes_on) {
        memcpy(s->v, s->end, sys->ncontact * sizeof *s->v);
    } else {
        find_base(s, sys, t);
        relative(s, sys, u, s->v);
    }
}

static double power(const tribo_system *sys, const double *f, const double *before, const double *after)
{
    double sum = 0.0;
    for (size_t i = 0; i < sys->ncontact; i++) {
        sum += 0.5 * f[i] * (before[i] + after[i]);
    }
    return -sys->power * sum;
}

static int grew(tribo_driver *drv, double t)
{
    return tribo_driver_fail(drv, TRIBO_ERR_NOT_FINITE,
                             "at t = %.17g forces are too large: the motion grew without bound, or dt = %g is too long", t,
                             drv->dt);
}

/* The limit that a step goes by is that of its middle. */
static void set_limits(tribo_system *sys, double middle)
{
    if (sys->limits.knots) {
        tribo_system_set_time(sys, middle);
    }
}

/* --------------------------------------------------------------------------------------------------------- central */

/* Takes u, the velocity at the time from, to the one at the time to: forces at t and q, over the time between. Adds to the
 * energy. */
static int kick(tribo_driver *drv, double from, double t, double to, const double *y, double *u, double *energy)
{
    struct step_form *s = drv->own;
    tribo_system *sys = drv->sys;
    const size_t n = sys->ndof;
    const double time = to - from;
    begin(s, sys, from, u);
    tribo_system_set_time(sys, t);
    memset(s->a, 0, n * sizeof *s->a);
    tribo_system_loads(sys, 0, 0, 1.0, s->a);
    tribo_matrix_multiply_add(&sys->stiffness, -1.0, y, s->a);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, u, s->a);
    }
    sys->evaluations++;
    for (size_t i = 0; i < n; i++) {
        u[i] += time * s->a[i];
    }
    find_base(s, sys, to);
    relative(s, sys, u, s->end);
    set_limits(sys, t);
    const int status = tribo_step_force(sys->contacts, time, s->end, s->f);
    if (status == TRIBO_ERR_NOT_FINITE) {
        return grew(drv, t);
    }
    if (status) {
        return tribo_driver_fail(drv, status, "at t = %.17g: %s", t, tribo_message(sys->contacts));
    }
    tribo_matrix_multiply_add(&sys->response, time, s->f, u);
    tribo_get_modes(sys->contacts, s->mode);
    tribo_system_snap(sys, s->mode, s->base, u);
    relative(s, sys, u, s->end);
    *energy += time * power(sys, s->f, s->v, s->end);
    s->goes_on = 1;
    return TRIBO_OK;
}

/* Velocities and energy of y, from half a step back to t: for those who look. */
static int synchronise(tribo_driver *drv, double t, double *y)
{
    struct step_form *s = drv->own;
    const size_t n = drv->sys->ndof, bytes = drv->sys->ncontact * sizeof *s->end;
    memcpy(y + n, s->u, n * sizeof *y);
    y[2 * n] = s->energy;
    memcpy(s->aside, s->end, bytes);
    const int status = kick(drv, t - 0.5 * s->last, t, t, y, y + n, y + 2 * n);
    memcpy(s->end, s->aside, bytes);
    return status;
}

static int central_step(tribo_driver *drv, double t, double next, double *y)
{
    struct step_form *s = drv->own;
    const size_t n = drv->sys->ndof;
    const double h = next - t;
    const int status = kick(drv, t - 0.5 * s->last, t, t + 0.5 * h, y, s->u, &s->energy);
    if (status) {
        return status;
    }
    for (size_t i = 0; i < n; i++) {
        y[i] += h * s->u[i];
    }
    s->last = h;
    if (drv->seen) {
        return synchronise(drv, next, y);
    }
    memcpy(y + n, s->u, n * sizeof *y);
    y[2 * n] = s->energy;
    return TRIBO_OK;
}

/* Refuses steps with which the motion would grow without bound: steps of h are stable while h^2 AK + 2 h AC has no eigenvalue of
 * 4 or more. */
static int check_step(tribo_driver *drv, double h)
{
    struct step_form *s = drv->own;
    const tribo_system *sys = drv->sys;
    double value, limit = h;
    s->stable = s->revision == sys->revision ? s->stable : 0.0;
    s->revision = sys->revision;
    if (h <= s->stable) {
        return TRIBO_OK;
    }
    int status = tribo_system_highest(sys, 1.0, lesser(2.0 / h, DBL_MAX), &value);
    if (!status && h * sqrt(value) < 2.0) {
        s->stable = h;
        return TRIBO_OK;
    }
    /* the eigenvalue over h^2 falls with h, so that this comes down to the largest step that is stable */
    while (!status && 2.0 / sqrt(value) < 0.9999 * limit) {
        limit = 2.0 / sqrt(value);
        status = tribo_system_highest(sys, 1.0, 2.0 / limit, &value);
    }
    return status ? tribo_driver_fail(drv, status, "%s", tribo_message(sys->contacts))
                  : tribo_driver_fail(drv, TRIBO_ERR_STEP,
                                      "central differences are unstable in steps of %g: dt must be below %.4g", h, limit);
}

static int central_advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    struct step_form *s = drv->own;
    const size_t n = drv->sys->ndof;
    int status = check_step(drv, lesser(drv->dt, t1 - *t));
    if (status) {
        return status;
    }
    if (!continues) {
        memcpy(s->u, y + n, n * sizeof *y);
        s->energy = y[2 * n];
        s->last = 0.0;
        s->goes_on = 0;
    }
    status = tribo_driver_fixed_steps(drv, t, t1, y, central_step);
    return status || drv->seen ? status : synchronise(drv, t1, y);
}

/* ---------------------------------------------------------------------------------------------------------- moreau */

static void widen(const struct matrix *a, size_t *below, size_t *above)
{
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            *below = i > a->col[k] && i - a->col[k] > *below ? i - a->col[k] : *below;
            *above = a->col[k] > i && a->col[k] - i > *above ? a->col[k] - i : *above;
        }
    }
}

static void solve(const struct step_form *s, size_t n, double *x)
{
    gsl_matrix_view a = gsl_matrix_view_array(s->band, n, 2 * s->below + s->above + 1);
    gsl_vector_view b = gsl_vector_view_array(x, n);
    const gsl_vector_uint pivot = {n, 1, s->pivot, NULL, 0};
    gsl_linalg_LU_band_svx(s->below, s->above, &a.matrix, &pivot, &b.vector);
}

static int factorize(struct step_form *s, const tribo_system *sys, double h)
{
    const size_t n = sys->ndof;
    s->below = s->above = 0;
    widen(&sys->stiffness, &s->below, &s->above);
    widen(&sys->damping, &s->below, &s->above);
    const size_t width = 2 * s->below + s->above + 1, middle = s->below + s->above;
    free(s->band);
    free(s->pivot);
    s->band = calloc(n * width, sizeof *s->band);
    s->pivot = malloc(n * sizeof *s->pivot);
    if (!s->band || !s->pivot) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the matrix of a step");
    }
    const struct matrix *part[] = {&sys->stiffness, &sys->damping};
    const double factor[] = {0.25 * h * h, 0.5 * h};
    for (size_t i = 0; i < n; i++) {
        s->band[i * width + middle] = 1.0;
    }
    for (int p = 0; p < 2; p++) {
        for (size_t i = 0; i < part[p]->rows; i++) {
            for (size_t k = part[p]->first[i]; k < part[p]->first[i + 1]; k++) {
                s->band[part[p]->col[k] * width + middle + i - part[p]->col[k]] += factor[p] * part[p]->val[k];
            }
        }
    }
    gsl_matrix_view a = gsl_matrix_view_array(s->band, n, width);
    gsl_vector_uint pivot = {n, 1, s->pivot, NULL, 0};
    gsl_linalg_LU_band_decomp(n, s->below, s->above, &a.matrix, &pivot);
    for (size_t i = 0; i < n; i++) {
        if (s->band[i * width + middle] == 0.0) {
            return tribo_system_fail(sys, TRIBO_ERR_INDEFINITE,
                                     "the matrix of a step of length %g is singular at degree of freedom %zu", h, i);
        }
    }
    return TRIBO_OK;
}

/* A is diagonal: the operator is that of the bodies one by one. */
static int set_bodies(struct step_form *s, const tribo_system *sys)
{
    const struct matrix *j = &sys->direction;
    double *inverse = calloc(sys->ndof, sizeof *inverse);
    if (!inverse) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the contacts of a step");
    }
    for (size_t i = 0; i < j->rows; i++) {
        for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
            const size_t d = j->col[k];
            inverse[d] = j->val[k] != 0.0 ? s->response[i * sys->ndof + d] / j->val[k] : inverse[d];
        }
    }
    const int status = tribo_set_operator_mass(s->contacts, sys->ndof, inverse, j->first, j->col, j->val);
    free(inverse);
    return status ? tribo_system_fail(sys, status, "in a step, %s", tribo_message(s->contacts)) : TRIBO_OK;
}

/* The operator is r, unless that hides bodies. */
static int set_operator(struct step_form *s, const tribo_system *sys, const double *r, double h)
{
    struct hidden where;
    switch (tribo_hidden(&sys->direction, &sys->metric, s->response, r, &where)) {
    case 0:
        break;
    case 1:
        return s->below || s->above
                   ? tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                       "contact %zu touches bodies of which one gives way %g times as much as the other in steps "
                                       "of %g: take central/fixed, event or exact",
                                       where.contact, where.spread, h)
                   : set_bodies(s, sys);
    default:
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the contacts of a step");
    }
    const int status = tribo_set_operator_dense(s->contacts, r);
    return status ? tribo_system_fail(sys, status, "in steps of %g, %s", h, tribo_message(s->contacts)) : TRIBO_OK;
}

/* Prepares steps of length h: the factor, A^-1 B, and a context with the operator J A^-1 B, made symmetric by the contacts'
 * weights. */
static int prepare(struct step_form *s, const tribo_system *sys, double h)
{
    const size_t n = sys->ndof, c = sys->ncontact;
    s->h = 0.0;
    int status = factorize(s, sys, h);
    if (status) {
        return status;
    }
    free(s->response);
    s->response = calloc(c * n + 1, sizeof *s->response);
    double *r = calloc(c * c + 1, sizeof *r);
    if (!s->contacts && tribo_create(&s->contacts, c)) {
        s->contacts = NULL;
    }
    if (!s->response || !r || !s->contacts) {
        free(r);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the contacts of a step");
    }
    for (size_t d = 0; d < n; d++) {
        for (size_t k = sys->response.first[d]; k < sys->response.first[d + 1]; k++) {
            s->response[sys->response.col[k] * n + d] = sys->response.val[k];
        }
    }
    for (size_t j = 0; j < c; j++) {
        double *column = s->response + j * n;
        solve(s, n, column);
        for (size_t i = 0; i < c; i++) {
            double sum = 0.0;
            for (size_t k = sys->direction.first[i]; k < sys->direction.first[i + 1]; k++) {
                sum += sys->direction.val[k] * column[sys->direction.col[k]];
            }
            r[i * c + j] = sum / tribo_system_weight(sys, j);
        }
    }
    status = set_operator(s, sys, r, h);
    free(r);
    if (status) {
        return status;
    }
    s->h = h;
    s->revision = sys->revision;
    return TRIBO_OK;
}

static void find_load(struct step_form *s, tribo_system *sys, double t)
{
    tribo_system_set_time(sys, t);
    memset(s->load, 0, sys->ndof * sizeof *s->load);
    tribo_system_loads(sys, 0, 0, 1.0, s->load);
}

static int moreau_step(tribo_driver *drv, double t, double next, double *y)
{
    struct step_form *s = drv->own;
    tribo_system *sys = drv->sys;
    const size_t n = sys->ndof, c = sys->ncontact;
    const double h = next - t;
    double *du = s->a, *u = y + n;
    /* steps of equal length differ by the rounding of time only */
    if (!(fabs(h - s->h) <= 1e-9 * h) || s->revision != sys->revision) {
        const int status = prepare(s, sys, h);
        if (status) {
            return tribo_driver_fail(drv, status, "%s", tribo_message(sys->contacts));
        }
    }
    begin(s, sys, t, u);
    if (!s->goes_on) {
        find_load(s, sys, t);
    }
    for (size_t i = 0; i < n; i++) {
        s->u[i] = y[i] + 0.5 * h * u[i];
        du[i] = 0.5 * h * s->load[i];
    }
    find_load(s, sys, next);
    for (size_t i = 0; i < n; i++) {
        du[i] += 0.5 * h * s->load[i];
    }
    tribo_matrix_multiply_add(&sys->stiffness, -h, s->u, du);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -h, u, du);
    }
    sys->evaluations++;
    solve(s, n, du);
    for (size_t i = 0; i < n; i++) {
        s->u[i] = u[i] + du[i];
    }
    find_base(s, sys, next);
    relative(s, sys, s->u, s->end);
    set_limits(sys, t + 0.5 * h);
    tribo_get_limit(sys->contacts, s->limit);
    for (size_t i = 0; i < c; i++) {
        s->limit[i] *= tribo_system_weight(sys, i);
    }
    tribo_set_limit(s->contacts, s->limit);
    const int status = tribo_step_force(s->contacts, h, s->end, s->f);
    if (status == TRIBO_ERR_NOT_FINITE) {
        return grew(drv, t);
    }
    if (status) {
        return tribo_driver_fail(drv, status, "at t = %.17g: %s", t, tribo_message(s->contacts));
    }
    for (size_t i = 0; i < c; i++) {
        s->f[i] /= tribo_system_weight(sys, i);
        for (size_t d = 0; d < n; d++) {
            s->u[d] += h * s->f[i] * s->response[i * n + d];
        }
    }
    tribo_get_modes(s->contacts, s->mode);
    tribo_system_snap(sys, s->mode, s->base, s->u);
    relative(s, sys, s->u, s->end);
    s->goes_on = 1;
    for (size_t i = 0; i < n; i++) {
        y[i] += 0.5 * h * (u[i] + s->u[i]);
        u[i] = s->u[i];
    }
    y[2 * n] += h * power(sys, s->f, s->v, s->end);
    return TRIBO_OK;
}

static int moreau_advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    struct step_form *s = drv->own;
    s->goes_on = continues && s->goes_on;
    return tribo_driver_fixed_steps(drv, t, t1, y, moreau_step);
}

const struct method tribo_method_central_fixed = {"central/fixed", 0, create, destroy, central_advance, NULL};
const struct method tribo_method_moreau_fixed = {"moreau/fixed", 0, create, destroy, moreau_advance, NULL};
