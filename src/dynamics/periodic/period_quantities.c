/* SPDX-License-Identifier: BSD-3-Clause */
/* Quantities of the periodic motion found last. Each call integrates one period again, phase by phase in closed form. */
#include "shooting.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Observer of one period: quantities of a combination c, or of contacts. */
struct replay {
    struct company company;
    struct period_map *map;
    const double *c; /* coefficients of q, q' (and f, f'), or NULL */
    double elapsed;  /* time since the start of the period */
    int seeks;       /* 1: extremes of the combination; 0: its integral */
    struct extremes extremes;
    double omega, re, im;  /* integral of the combination times e^{-i omega t} */
    double *energy, *rest; /* [ncontact] dissipated energy; part of the period at rest; or NULL */
};

static int replay_phase(struct company *company, double tau, double t, const double *y)
{
    struct replay *r = (struct replay *)company;
    const struct events *e = r->map->events;
    const double begin = r->map->t + r->elapsed;
    struct signal signal = {0};
    int status = r->c ? e->motion->signal(e->own, r->c, tau, y, &signal) : TRIBO_OK;
    (void)t;
    if (!status && r->c && !r->seeks) {
        double re = 0.0, im = 0.0;
        const double cosine = cos(r->omega * begin), sine = sin(r->omega * begin);
        tribo_signal_integrate(&signal, r->omega, &re, &im);
        r->re += cosine * re + sine * im;
        r->im += cosine * im - sine * re;
    } else if (!status && r->c && !tribo_signal_extremes(&signal, begin, &r->extremes)) {
        status = tribo_error(r->map->sys->message, TRIBO_ERR_STEP, "a phase of the period is too fast to be followed");
    }
    for (size_t i = 0; !r->c && i < r->map->sys->ncontact; i++) {
        const signed char slip = e->stick_slip.state.slip[i];
        if (r->energy && slip != TRIBO_SLIP_STUCK && slip != TRIBO_SLIP_OPEN) {
            r->energy[i] += r->map->sys->tally[i] * e->motion->work(e->own, i, tau);
        } else if (r->rest && slip == TRIBO_SLIP_STUCK) {
            r->rest[i] += tau / r->map->period;
        }
    }
    tribo_signal_free(&signal);
    r->elapsed += tau;
    return status;
}

static const struct company quantities = {replay_phase, NULL};

int tribo_shooting_ready(tribo_driver *drv, const char *missing, const double **c)
{
    struct shooting *s = drv ? drv->shooting : NULL;
    if (!drv || missing) {
        return drv ? tribo_error(drv->message, TRIBO_ERR_NULL, "%s is NULL", missing) : TRIBO_ERR_NULL;
    }
    int status = tribo_check_array(drv->message, FINITE, "c", *c, 2 * tribo_system_ndof(drv->sys));
    if (!status && *c && drv->motion) {
        tribo_system_read_combination(drv->sys, *c, drv->motion);
        *c = drv->motion;
    }
    status = status ? status : tribo_driver_pass(drv, tribo_system_take_settings(drv->sys));
    return status ? status
           : s && s->found && s->revision == tribo_system_revision(drv->sys)
               ? TRIBO_OK
               : tribo_error(drv->message, TRIBO_ERR_STATE, "%s: call tribo_driver_find_periodic first",
                             s && s->found ? "the system has changed since the periodic motion was found"
                                           : "no periodic motion was found");
}

/* Observes the period of the motion found, with coefficients c of q and q' or NULL. missing: name of an argument that is NULL.
 * Returns a status. */
static int replay(tribo_driver *drv, struct replay *r, const char *missing, const double *c, size_t order)
{
    const int unready = tribo_shooting_ready(drv, missing, &c);
    if (unready) {
        return unready;
    }
    const struct shooting *s = drv->shooting->told;
    r->c = c;
    r->company = quantities;
    r->map = &drv->shooting->told->map;
    r->omega = FULL_TURN * (double)order / s->map.period;
    if (c && s->map.ring.sectors) {
        tribo_ring_fold_combination(drv->shooting, c, s->a);
        r->c = s->a;
    }
    const int status = tribo_period_map_replay(r->map, s->here->y, s->map.period, &r->company);
    return status && s->map.drv != drv ? tribo_error(drv->message, status, "%s", s->map.drv->message) : status;
}

int tribo_driver_period_extremes(tribo_driver *drv, const double *c, double *least, double *most, double *at_least,
                                 double *at_most)
{
    struct replay r = {.seeks = 1, .extremes = {HUGE_VAL, -HUGE_VAL, 0.0, 0.0}};
    const int status = replay(drv, &r, !c ? "c" : !least ? "least" : !most ? "most" : NULL, c, 0);
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

int tribo_driver_period_harmonic(tribo_driver *drv, const double *c, size_t k, double *cosine, double *sine)
{
    struct replay r = {0};
    const int status = replay(drv, &r, !c ? "c" : !cosine ? "cosine" : !sine ? "sine" : NULL, c, k);
    if (!status) {
        const double factor = (k ? 2.0 : 1.0) / drv->shooting->told->map.period;
        *cosine = factor * r.re;
        *sine = k ? -factor * r.im : 0.0;
    }
    return status;
}

/* to [ncontact] = the quantity of contacts, of r->energy or r->rest, *sum. Returns a status. */
static int sum_up(tribo_driver *drv, struct replay *r, const char *name, double **sum, double *to)
{
    const size_t count = drv ? drv->sys->ncontact : 0;
    *sum = to ? calloc(count + 1, sizeof *to) : NULL;
    const int status = *sum || !to
                           ? replay(drv, r, to ? NULL : name, NULL, 0)
                           : tribo_error(drv->message, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s", count, plural(count));
    for (size_t i = 0; !status && i < count; i++) { /* sectors of a ring that the twin has not are as those that it has */
        to[i] = (*sum)[i % drv->shooting->told->map.sys->ncontact];
    }
    free(*sum);
    return status;
}

int tribo_driver_period_dissipation(tribo_driver *drv, double *energy)
{
    struct replay r = {0};
    return sum_up(drv, &r, "energy", &r.energy, energy);
}

int tribo_driver_period_stick(tribo_driver *drv, double *share)
{
    struct replay r = {0};
    const int status = sum_up(drv, &r, "share", &r.rest, share);
    for (size_t i = 0; !status && i < drv->sys->ncontact; i++) {
        share[i] = lesser(share[i], 1.0); /* of phases that sum up to the period but for rounding */
    }
    return status;
}
