/* SPDX-License-Identifier: BSD-3-Clause */
/* Quantities of the periodic motion found last. Each call integrates one period again, phase by phase in closed form. */
#include "shooting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Observer of one period: calls `phase` for each phase. */
struct replay {
    struct company company;
    struct period_map *map;
    int (*phase)(struct replay *r, double tau);
    const double *c;      /* coefficients of q, q' (and f, f'), or NULL */
    struct signal signal; /* the combination in the phase */
    double elapsed;       /* time since the start of the period */
    struct extremes extremes;
    double omega, re, im; /* integral of signal e^{-i omega t} */
    double *sum;          /* [ncontact] sum over the phases */
};

static int replay_phase(struct company *company, double tau, double t, const double *y)
{
    struct replay *r = (struct replay *)company;
    const struct events *e = r->map->events;
    int status = r->c ? e->motion->signal(e->own, r->c, tau, y, &r->signal) : TRIBO_OK;
    status = status ? status : r->phase(r, tau);
    (void)t;
    r->elapsed += tau;
    return status;
}

static void replay_event(struct company *company)
{
    (void)company;
}

/* Calls r->phase for each phase of the period. Returns a status. */
static int replay(tribo_driver *drv, struct replay *r)
{
    struct shooting *s = drv->shooting;
    const int unset = tribo_system_take_settings(drv->sys);
    if (unset) {
        return tribo_driver_pass(drv, unset);
    }
    if (!s || !s->found || s->revision != tribo_system_revision(drv->sys)) {
        return tribo_driver_fail(drv, TRIBO_ERR_STATE, "%s: call tribo_driver_find_periodic first",
                                 s && s->found ? "the system has changed since the periodic motion was found"
                                               : "no periodic motion was found");
    }
    r->company = (struct company){replay_phase, replay_event};
    r->map = &s->map;
    r->elapsed = 0.0;
    const int status = tribo_period_map_replay(&s->map, s->best->y, &r->company);
    tribo_signal_free(&r->signal);
    return status && s->map.drv != drv ? tribo_driver_fail(drv, status, "%s", s->map.drv->message) : status;
}

/* Checks the caller's c, coefficients of q and q', and sets r->c. Returns a status. */
static int take_combination(tribo_driver *drv, struct replay *r, const double *c)
{
    const size_t n = tribo_system_ndof(drv->sys);
    for (size_t i = 0; i < 2 * n; i++) {
        if (!isfinite(c[i])) {
            return tribo_driver_fail(drv, TRIBO_ERR_NOT_FINITE, "c[%zu] = %g is not finite", i, c[i]);
        }
    }
    r->c = c;
    if (drv->motion) {
        tribo_system_read_combination(drv->sys, c, drv->motion);
        r->c = drv->motion;
    }
    return TRIBO_OK;
}

/* -------------------------------------------------------------------------------------------------------------- extremes */

static int find_extremes(struct replay *r, double tau)
{
    (void)tau;
    return tribo_signal_extremes(&r->signal, r->map->t + r->elapsed, &r->extremes)
               ? TRIBO_OK
               : tribo_system_fail(r->map->sys, TRIBO_ERR_STEP, "a phase of the period is too fast to be followed");
}

int tribo_driver_period_extremes(tribo_driver *drv, const double *c, double *least, double *most, double *at_least,
                                 double *at_most)
{
    if (!drv) {
        return TRIBO_ERR_NULL;
    }
    if (!c || !least || !most) {
        return tribo_driver_fail(drv, TRIBO_ERR_NULL, "%s is NULL", !c ? "c" : !least ? "least" : "most");
    }
    struct replay r = {.phase = find_extremes, .extremes = {HUGE_VAL, -HUGE_VAL, 0.0, 0.0}};
    int status = take_combination(drv, &r, c);
    status = status ? status : replay(drv, &r);
    if (status) {
        return status;
    }
    *least = r.extremes.least;
    *most = r.extremes.most;
    if (at_least) {
        *at_least = r.extremes.at_least;
    }
    if (at_most) {
        *at_most = r.extremes.at_most;
    }
    return TRIBO_OK;
}

/* -------------------------------------------------------------------------------------------------------------- harmonics */

static int integrate(struct replay *r, double tau)
{
    double re = 0.0, im = 0.0;
    const double angle = r->omega * (r->map->t + r->elapsed), c = cos(angle), d = -sin(angle);
    (void)tau;
    tribo_signal_integrate(&r->signal, r->omega, &re, &im);
    r->re += c * re - d * im;
    r->im += d * re + c * im;
    return TRIBO_OK;
}

int tribo_driver_period_harmonic(tribo_driver *drv, const double *c, size_t k, double *cosine, double *sine)
{
    if (!drv) {
        return TRIBO_ERR_NULL;
    }
    if (!c || !cosine || !sine) {
        return tribo_driver_fail(drv, TRIBO_ERR_NULL, "%s is NULL", !c ? "c" : !cosine ? "cosine" : "sine");
    }
    struct replay r = {.phase = integrate};
    int status = take_combination(drv, &r, c);
    if (!status && drv->shooting) {
        r.omega = 2.0 * acos(-1.0) * (double)k / drv->shooting->map.period;
    }
    status = status ? status : replay(drv, &r);
    if (!status) {
        const double factor = (k ? 2.0 : 1.0) / drv->shooting->map.period;
        *cosine = factor * r.re;
        *sine = k ? -factor * r.im : 0.0;
    }
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- contacts */

static int add_energy(struct replay *r, double tau)
{
    const struct events *e = r->map->events;
    for (size_t i = 0; i < r->map->sys->ncontact; i++) {
        if (tribo_slides(e->stick_slip.state.slip[i])) {
            r->sum[i] += r->map->sys->tally[i] * e->motion->work(e->own, i, tau);
        }
    }
    return TRIBO_OK;
}

static int period_quantities_add_rest(struct replay *r, double tau)
{
    for (size_t i = 0; i < r->map->sys->ncontact; i++) {
        r->sum[i] += r->map->events->stick_slip.state.slip[i] == TRIBO_SLIP_STUCK ? tau / r->map->period : 0.0;
    }
    return TRIBO_OK;
}

/* to [ncontact] = the sums that `phase` adds to r.sum over the period. Returns a status. */
static int sum_up(tribo_driver *drv, const char *name, int (*phase)(struct replay *, double), double *to)
{
    if (!drv) {
        return TRIBO_ERR_NULL;
    }
    if (!to) {
        return tribo_driver_fail(drv, TRIBO_ERR_NULL, "%s is NULL", name);
    }
    const size_t count = drv->sys->ncontact;
    struct replay r = {.phase = phase, .sum = calloc(count + 1, sizeof *to)};
    const int status = r.sum ? replay(drv, &r)
                             : tribo_driver_fail(drv, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s", count, plural(count));
    if (!status) {
        memcpy(to, r.sum, count * sizeof *to);
    }
    free(r.sum);
    return status;
}

int tribo_driver_period_dissipation(tribo_driver *drv, double *energy)
{
    return sum_up(drv, "energy", add_energy, energy);
}

int tribo_driver_period_stick(tribo_driver *drv, double *share)
{
    return sum_up(drv, "share", period_quantities_add_rest, share);
}
