/* Method "central/fixed": central differences, velocities half a step apart from displacements. Explicit; stable for dt
 * below 2/omega_max. Damping acts on the velocity of half a step before. few_bodies.c takes the steps of small systems,
 * blockwise.c those of others whose contacts share no body. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "blockwise.h"
#include "few_bodies.h"
#include "dynamics/reduce/spectrum.h"
#include "step_form.h"
#include "common/real.h"
#include "common/zeros.h"

struct central {
    struct step_form common;
    struct few_bodies few;
    struct blockwise alone;
    double *next;  /* [ndof] u at the end of a step in progress */
    double energy; /* dissipated up to u */
    double last;   /* length of the step before; 0: u is the velocity at t */
    double stable; /* a step length known to be stable; 0: none */
};

static void central_destroy(tribo_driver *drv)
{
    struct central *x = drv->own;
    if (x) {
        tribo_step_form_free(&x->common);
        tribo_blockwise_free(&x->alone);
        free(x->next);
        free(x);
    }
}

static int central_create(tribo_driver *drv)
{
    struct central *x = tribo_zeros(1, sizeof *x);
    drv->own = x;
    if (x) {
        x->few.revision = SIZE_MAX;
        x->next = tribo_zeros(drv->sys->ndof, sizeof *x->next);
    }
    if (!x || !x->next || !tribo_step_form_create(&x->common, drv->sys) || !tribo_blockwise_create(&x->alone, drv->sys)) {
        return tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method %s", drv->method->name);
    }
    return TRIBO_OK;
}

/* Makes u_to of u, and adds the work of friction to the energy. Returns a status. */
static int kick(tribo_driver *drv, const struct body_step *k, double *energy)
{
    struct central *x = drv->own;
    struct step_form *s = &x->common;
    tribo_system *sys = drv->sys;
    tribo_step_form_begin(s, sys, k->from, k->u);
    /* velocities without friction, by forces at t and q */
    tribo_system_set_time(sys, k->t);
    memset(s->a, 0, sys->ndof * sizeof *s->a);
    tribo_system_loads(sys, DRIVES_LOAD, 0, 1.0, s->a);
    tribo_matrix_multiply_add(&sys->stiffness, -1.0, k->q, s->a);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, k->u, s->a);
    }
    for (size_t i = 0; i < sys->ndof; i++) {
        k->u_to[i] = k->u[i] + k->time * s->a[i];
    }
    sys->evaluations++;
    tribo_step_form_find_base(s, sys, k->to);
    tribo_step_form_relative(s, sys, k->u_to, s->end);
    if (tribo_system_limits_vary(sys)) {
        tribo_system_set_time(sys, k->t);
    }
    const int status = tribo_step_form_force(s, sys, sys->contacts, k->time);
    if (status == TRIBO_ERR_NOT_FINITE) {
        return tribo_step_form_grew(drv, k->t);
    }
    if (status) {
        return tribo_driver_fail(drv, status, "at t = %.17g: %s", k->t, tribo_message(sys->contacts));
    }
    tribo_matrix_multiply_add(&sys->response, k->time, s->f, k->u_to);
    tribo_get_slip(sys->contacts, s->mode);
    tribo_system_snap(sys, s->mode, s->base, k->u_to);
    tribo_step_form_relative(s, sys, k->u_to, s->end);
    *energy += k->time * tribo_step_form_power(sys, s->f, s->v, s->end);
    return TRIBO_OK;
}

/* Sets velocities and energy of y, half a step ahead of u, to those at t. The next step goes on from u. */
static int synchronise(tribo_driver *drv, double t, double *y)
{
    struct central *x = drv->own;
    struct step_form *s = &x->common;
    const size_t n = drv->sys->ndof;
    const double half = 0.5 * x->last;
    const struct body_step back = {.from = t - half, .t = t, .to = t, .time = half, .q = y, .u = s->u, .u_to = y + n};
    y[2 * n] = x->energy;
    const int status = kick(drv, &back, y + 2 * n);
    if (s->goes_on) {
        tribo_step_form_turn(s);
    }
    return status;
}

/* A run of the motion in y and u, if the system is small: velocities of y are set by synchronise. */
static size_t central_run(tribo_driver *drv, size_t count, const double *t, double *y)
{
    struct central *x = drv->own;
    struct step_form *s = &x->common;
    tribo_system *sys = drv->sys;
    if (!x->few.fits) {
        return 0;
    }
    if (!s->goes_on) {
        tribo_step_form_find_base(s, sys, t[0] - 0.5 * x->last);
        tribo_step_form_relative(s, sys, s->u, s->end);
    }
    struct few_motion m = {y, s->u, s->end, x->energy, x->last};
    const size_t taken = tribo_few_run(&x->few, sys, count, t, &m);
    s->goes_on = 1;
    x->last = m.last;
    y[2 * sys->ndof] = x->energy = m.energy;
    sys->evaluations += taken;
    return taken;
}

static void take_settings(struct central *x, tribo_system *sys)
{
    if (!tribo_few_take(&x->few, sys)) {
        tribo_blockwise_take(&x->alone, sys);
    }
}

/* A step by few_bodies.c, block by block, or by one problem of all contacts. The first two leave velocities of y to synchronise. */
static int central_step(tribo_driver *drv, double t, double next, const double *from, double *y)
{
    struct central *x = drv->own;
    struct step_form *s = &x->common;
    const size_t n = drv->sys->ndof;
    const double times[] = {t, next}, h = next - t;
    if (drv->seen && x->few.revision != tribo_system_revision(drv->sys)) {
        take_settings(x, drv->sys); /* the observer has changed them */
    }
    if (drv->seen && x->few.fits) {
        memcpy(y, from, n * sizeof *y);
        if (central_run(drv, 1, times, y)) {
            return synchronise(drv, next, y);
        }
    }
    const struct body_step k = {t - 0.5 * x->last, t, t + 0.5 * h, 0.5 * (x->last + h), h, from, s->u, y, x->next};
    const int alone = !x->few.fits && x->alone.fits;
    double energy = x->energy;
    int status = TRIBO_OK;
    if (alone) {
        drv->sys->evaluations++;
        if (!tribo_blockwise_step(&x->alone, drv->sys, &k, &energy) || !isfinite(energy)) {
            return tribo_step_form_grew(drv, t);
        }
        drv->rested = x->alone.skipped;
    } else {
        status = kick(drv, &k, &energy);
        for (size_t i = 0; !status && i < n; i++) {
            y[i] = from[i] + h * k.u_to[i];
            y[n + i] = k.u_to[i];
        }
    }
    y[2 * n] = x->energy = energy;
    status = status || alone ? status : tribo_driver_check(drv, y);
    if (status) {
        return status;
    }
    s->goes_on = !alone;
    x->next = s->u;
    s->u = k.u_to;
    x->last = h;
    return drv->seen ? synchronise(drv, next, y) : TRIBO_OK;
}

/* TRIBO_ERR_STEP if steps of h are unstable: they are stable while h^2 AK + 2 h AC has no eigenvalue of 4 or more. */
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
    /* the eigenvalue over h^2 falls with h: limit descends to the largest stable step */
    while (!status && 2.0 / sqrt(value) < 0.9999 * limit) {
        limit = 2.0 / sqrt(value);
        status = tribo_system_highest(sys, 1.0, 2.0 / limit, &value);
    }
    return status ? tribo_driver_fail(drv, status, "%s", tribo_system_message(sys))
                  : tribo_driver_fail(drv, TRIBO_ERR_STEP,
                                      "central differences are unstable in steps of %g: dt must be below %.4g", h, limit);
}

static int central_advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    static const struct fixed_method method = {central_step, central_run};
    struct central *x = drv->own;
    struct step_form *s = &x->common;
    const size_t n = drv->sys->ndof;
    const double begin = *t;
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
    take_settings(x, drv->sys);
    tribo_step_form_start(s, drv->sys);
    status = tribo_driver_fixed_steps(drv, t, t1, y, &method);
    if (status && *t > begin && !drv->seen) {
        memcpy(drv->state + n, s->u, n * sizeof *y);
    }
    return status || drv->seen ? status : synchronise(drv, t1, y);
}

const struct method tribo_method_central_fixed = {.name = "central/fixed",
                                                  .takes = TAKES_STEP | NEEDS_MASS,
                                                  .create = central_create,
                                                  .destroy = central_destroy,
                                                  .advance = central_advance};
