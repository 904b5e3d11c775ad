/* Method "central/fixed": central differences, velocities half a step apart from positions. Explicit; stable for dt below
 * 2/omega_max. Damping acts on the velocity of half a step before. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "spectrum.h"
#include "step_form.h"
#include "../common/real.h"

struct central {
    struct step_form common;
    double energy, last; /* dissipated up to u; the step before, 0: u is the velocity at t */
    double stable;       /* a step found to be stable; 0: none */
    double *aside;       /* [ncontact] */
};

static void destroy(tribo_driver *drv)
{
    struct central *x = drv->own;
    if (x) {
        tribo_step_form_free(&x->common);
        free(x->aside);
        free(x);
    }
}

static int create(tribo_driver *drv)
{
    struct central *x = calloc(1, sizeof *x);
    drv->own = x;
    if (x) {
        x->aside = calloc(drv->sys->ncontact + 1, sizeof *x->aside);
    }
    if (!x || !x->aside || !tribo_step_form_create(&x->common, drv->sys)) {
        return tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method %s", drv->method->name);
    }
    return TRIBO_OK;
}

/* Takes u, the velocity at the time from, to the one at the time to: forces at t and q, over the time between. Adds to the
 * energy. */
static int kick(tribo_driver *drv, double from, double t, double to, const double *y, double *u, double *energy)
{
    struct central *x = drv->own;
    struct step_form *s = &x->common;
    tribo_system *sys = drv->sys;
    const size_t n = sys->ndof;
    const double time = to - from;
    tribo_step_form_begin(s, sys, from, u);
    tribo_system_set_time(sys, t);
    memset(s->a, 0, n * sizeof *s->a);
    tribo_system_loads(sys, DRIVES_LOAD, 0, 1.0, s->a);
    tribo_matrix_multiply_add(&sys->stiffness, -1.0, y, s->a);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, u, s->a);
    }
    sys->evaluations++;
    for (size_t i = 0; i < n; i++) {
        u[i] += time * s->a[i];
    }
    tribo_step_form_find_base(s, sys, to);
    tribo_step_form_relative(s, sys, u, s->end);
    tribo_step_form_set_limits(sys, t);
    const int status = tribo_step_form_force(s, sys->contacts, time);
    if (status == TRIBO_ERR_NOT_FINITE) {
        return tribo_step_form_grew(drv, t);
    }
    if (status) {
        return tribo_driver_fail(drv, status, "at t = %.17g: %s", t, tribo_message(sys->contacts));
    }
    tribo_matrix_multiply_add(&sys->response, time, s->f, u);
    tribo_get_slip(sys->contacts, s->mode);
    tribo_system_snap(sys, s->mode, s->base, u);
    tribo_step_form_relative(s, sys, u, s->end);
    *energy += time * tribo_step_form_power(sys, s->f, s->v, s->end);
    s->goes_on = 1;
    return TRIBO_OK;
}

/* Velocities and energy of y, from half a step back to t: for those who look. */
static int synchronise(tribo_driver *drv, double t, double *y)
{
    struct central *x = drv->own;
    struct step_form *s = &x->common;
    const size_t n = drv->sys->ndof, bytes = drv->sys->ncontact * sizeof *s->end;
    memcpy(y + n, s->u, n * sizeof *y);
    y[2 * n] = x->energy;
    memcpy(x->aside, s->end, bytes);
    const int status = kick(drv, t - 0.5 * x->last, t, t, y, y + n, y + 2 * n);
    memcpy(s->end, x->aside, bytes);
    return status;
}

static int central_step(tribo_driver *drv, double t, double next, double *y)
{
    struct central *x = drv->own;
    struct step_form *s = &x->common;
    const size_t n = drv->sys->ndof;
    const double h = next - t;
    const int status = kick(drv, t - 0.5 * x->last, t, t + 0.5 * h, y, s->u, &x->energy);
    if (status) {
        return status;
    }
    for (size_t i = 0; i < n; i++) {
        y[i] += h * s->u[i];
    }
    x->last = h;
    if (drv->seen) {
        return synchronise(drv, next, y);
    }
    memcpy(y + n, s->u, n * sizeof *y);
    y[2 * n] = x->energy;
    return TRIBO_OK;
}

/* Refuses steps with which the motion would grow without bound: steps of h are stable while h^2 AK + 2 h AC has no eigenvalue of
 * 4 or more. */
static int check_step(tribo_driver *drv, double h)
{
    struct central *x = drv->own;
    struct step_form *s = &x->common;
    const tribo_system *sys = drv->sys;
    double value, limit = h;
    x->stable = s->revision == sys->revision ? x->stable : 0.0;
    s->revision = sys->revision;
    if (h <= x->stable) {
        return TRIBO_OK;
    }
    int status = tribo_system_highest(sys, 1.0, lesser(2.0 / h, DBL_MAX), &value);
    if (!status && h * sqrt(value) < 2.0) {
        x->stable = h;
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
    struct central *x = drv->own;
    struct step_form *s = &x->common;
    const size_t n = drv->sys->ndof;
    int status = check_step(drv, lesser(drv->dt, t1 - *t));
    if (status) {
        return status;
    }
    if (!continues) {
        memcpy(s->u, y + n, n * sizeof *y);
        x->energy = y[2 * n];
        x->last = 0.0;
        s->goes_on = 0;
    }
    status = tribo_driver_fixed_steps(drv, t, t1, y, central_step);
    return status || drv->seen ? status : synchronise(drv, t1, y);
}

const struct method tribo_method_central_fixed = {
    "central/fixed", WITHOUT_TOLERANCES, create, destroy, central_advance, NULL, NULL, NULL};
