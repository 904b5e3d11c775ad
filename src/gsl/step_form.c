/* Methods "central/fixed" and "moreau/fixed": the step form of Coulomb's law (tribo_step_force) with fixed steps. No epsilon,
 * contacts at rest stay at rest exactly, and the energy that friction dissipates is that of the discrete motion, -h f'(v +
 * v_end)/2 a step.
 *
 * central/fixed  central differences: velocities half a step apart from positions. Explicit; stable for dt < 2/omega_max. Damping
 * acts on the velocity of half a step before. moreau/fixed   the implicit midpoint rule for the structure, Coulomb's law at the
 * end of the step (Jean and Moreau 1992, theta = 1/2); the structure's part is factorized once for a step length. Stable for any
 * dt. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "driver.h"

struct step_form {
    double *u, *a;        /* [ndof] velocity (central: half a step back), acceleration or what a step adds to u */
    double *v, *free, *f; /* [ncontact] velocity before, velocity at the end without friction, force */
    signed char *mode;    /* [ncontact] */
    double energy;        /* central: dissipated up to u */
    double last;          /* central: the step before; 0: u is the velocity at t */

    /* moreau, for steps of length h: A = I + h/2 AC + h^2/4 AK in GSL's band format, factorized; A^-1 B; and the contacts that
     * see it */
    double h;
    size_t below, above;
    double *band;
    unsigned int *pivot;
    double *response; /* [ncontact][ndof] */
    double *limit;    /* [ncontact] */
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
    double *work = malloc((2 * n + 4 * c + 1) * sizeof *work);
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
    s->v = work + 2 * n;
    s->free = s->v + c;
    s->f = s->free + c;
    s->limit = s->f + c;
    return TRIBO_OK;
}

/* v = J u - b(t). */
static void relative(tribo_system *sys, double t, const double *u, double *v)
{
    tribo_system_set_time(sys, t);
    memset(v, 0, sys->ncontact * sizeof *v);
    tribo_system_loads(sys, 1, 0, -1.0, v);
    tribo_matrix_multiply_add(&sys->direction, 1.0, u, v);
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
    return tribo_driver_fail(drv, TRIBO_ERR_NOT_FINITE, "the motion grew without bound before t = %.17g: is dt = %g too long?", t,
                             drv->dt);
}

/* The limit that a step goes by is that of its middle. */
static void set_limits(tribo_system *sys, double middle)
{
    if (sys->limits.knots) {
        tribo_system_set_time(sys, middle);
    }
}

/* Fails if the motion is not finite any more. */
static int check_motion(tribo_driver *drv, double t, const double *y)
{
    double sum = 0.0;
    for (size_t i = 0; i < 2 * drv->sys->ndof; i++) {
        sum += fabs(y[i]);
    }
    return isfinite(sum) ? TRIBO_OK : grew(drv, t);
}

/* --------------------------------------------------------------------------------------------------------- central */

/* Takes u, the velocity at begin, to the one at end: forces at t and q, over the time between. Adds to the energy. */
static int kick(tribo_driver *drv, double begin, double t, double end, const double *y, double *u, double *energy)
{
    struct step_form *s = drv->own;
    tribo_system *sys = drv->sys;
    const size_t n = sys->ndof;
    const double time = end - begin;
    relative(sys, begin, u, s->v);
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
    relative(sys, end, u, s->free);
    set_limits(sys, t);
    const int status = tribo_step_force(sys->contacts, time, s->free, s->f);
    if (status == TRIBO_ERR_NOT_FINITE) {
        return grew(drv, t);
    }
    if (status) {
        return tribo_driver_fail(drv, status, "at t = %.17g: %s", t, tribo_message(sys->contacts));
    }
    tribo_matrix_multiply_add(&sys->response, time, s->f, u);
    tribo_get_modes(sys->contacts, s->mode);
    tribo_system_project(sys, s->mode, end, u);
    relative(sys, end, u, s->free);
    *energy += time * power(sys, s->f, s->v, s->free);
    return TRIBO_OK;
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
    memcpy(y + n, s->u, n * sizeof *y);
    y[2 * n] = s->energy;
    return check_motion(drv, next, y);
}

static int central_advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    struct step_form *s = drv->own;
    const size_t n = drv->sys->ndof;
    if (!continues) {
        memcpy(s->u, y + n, n * sizeof *y);
        s->energy = y[2 * n];
        s->last = 0.0;
    }
    int status = tribo_driver_fixed_steps(drv, t, t1, y, central_step);
    if (!status) {
        /* the velocity at t1 is half a step on */
        memcpy(y + n, s->u, n * sizeof *y);
        y[2 * n] = s->energy;
        status = s->last > 0.0 ? kick(drv, t1 - 0.5 * s->last, t1, t1, y, y + n, y + 2 * n) : TRIBO_OK;
    }
    return status;
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

/* Prepares steps of length h: the factor, A^-1 B, and a context with the operator J A^-1 B, made symmetric by the contacts'
 * weights. */
static int prepare(struct step_form *s, const tribo_system *sys, double h)
{
    const size_t n = sys->ndof, c = sys->ncontact;
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
    status = tribo_set_operator_dense(s->contacts, r);
    free(r);
    s->h = h;
    return status ? tribo_system_fail(sys, status, "%s", tribo_message(s->contacts)) : TRIBO_OK;
}

static int moreau_step(tribo_driver *drv, double t, double next, double *y)
{
    struct step_form *s = drv->own;
    tribo_system *sys = drv->sys;
    const size_t n = sys->ndof, c = sys->ncontact;
    const double h = next - t;
    double *du = s->a, *u = y + n;
    /* steps of equal length differ by the rounding of time only */
    if (!(fabs(h - s->h) <= 1e-9 * h)) {
        const int status = prepare(s, sys, h);
        if (status) {
            return tribo_driver_fail(drv, status, "%s", tribo_message(sys->contacts));
        }
    }
    relative(sys, t, u, s->v);
    tribo_system_set_time(sys, t + 0.5 * h);
    memset(du, 0, n * sizeof *du);
    for (size_t i = 0; i < n; i++) {
        s->u[i] = y[i] + 0.5 * h * u[i];
    }
    tribo_system_loads(sys, 0, 0, h, du);
    tribo_matrix_multiply_add(&sys->stiffness, -h, s->u, du);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -h, u, du);
    }
    sys->evaluations++;
    solve(s, n, du);
    for (size_t i = 0; i < n; i++) {
        s->u[i] = u[i] + du[i];
    }
    relative(sys, next, s->u, s->free);
    set_limits(sys, t + 0.5 * h);
    tribo_get_limit(sys->contacts, s->limit);
    for (size_t i = 0; i < c; i++) {
        s->limit[i] *= tribo_system_weight(sys, i);
    }
    tribo_set_limit(s->contacts, s->limit);
    const int status = tribo_step_force(s->contacts, h, s->free, s->f);
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
    tribo_system_project(sys, s->mode, next, s->u);
    relative(sys, next, s->u, s->free);
    for (size_t i = 0; i < n; i++) {
        y[i] += 0.5 * h * (u[i] + s->u[i]);
        u[i] = s->u[i];
    }
    y[2 * n] += h * power(sys, s->f, s->v, s->free);
    return check_motion(drv, next, y);
}

static int moreau_advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    (void)continues;
    return tribo_driver_fixed_steps(drv, t, t1, y, moreau_step);
}

const struct method tribo_method_central_fixed = {"central/fixed", 0, create, destroy, central_advance, NULL};
const struct method tribo_method_moreau_fixed = {"moreau/fixed", 0, create, destroy, moreau_advance, NULL};
