/* SPDX-License-Identifier: BSD-3-Clause */
/* Periodic motions: the public functions. */
#include "curve.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest distance of omega period/(2 pi) from a whole number, beside rounding. */
#define WHOLE 3e-12

static const char *const drive_name[] = {[DRIVES_LOAD] = "load", [DRIVES_BASE] = "base motion", [DRIVES_LIMIT] = "limit"};

static int check_period(tribo_driver *drv, double t, double period)
{
    const int status = tribo_check_number(drv->message, POSITIVE, period, "period = %g", period);
    return status || (t + 0.5 * period > t && t + period > t + 0.5 * period && isfinite(t + period))
               ? status
               : tribo_error(drv->message, TRIBO_ERR_STEP, "period = %g is lost beside t = %.17g", period, t);
}

/* Refuses tables, and harmonics without this period; period = 0: all that depends on time. */
static int check_loads(tribo_driver *drv, double period)
{
    const tribo_system *sys = drv->sys;
    size_t of_kind[] = {0, 0, 0};
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        const struct harmonic *w = &sys->loads.harmonic[k];
        const char *const name = drive_name[w->drives];
        const size_t of = of_kind[w->drives]++;
        const double turns = fabs(w->omega) / FULL_TURN * period, whole = fmax(round(turns), w->omega != 0.0);
        if (w->knots) {
            return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED, "%s[%zu] follows a table, which is not periodic", name, of);
        }
        if (w->count > 0 && w->omega != 0.0 && period == 0.0) {
            return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED,
                               "%s[%zu], omega = %.17g, depends on time: a cycle has the period of the motion alone", name, of,
                               w->omega);
        }
        if (w->count > 0 && !(fabs(turns - whole) <= WHOLE + 4.0 * DBL_EPSILON * whole)) {
            return tribo_error(drv->message, TRIBO_ERR_RANGE,
                               "%s[%zu], omega = %.17g, is not periodic in period = %.17g: %.12g turns", name, of, w->omega,
                               period, turns);
        }
    }
    return TRIBO_OK;
}

/* Refuses static limits with massless degrees of freedom: derivatives lack the jumps of forces at massless springs. */
static int check_friction(tribo_driver *drv)
{
    const size_t i = tribo_system_first_dropping(drv->sys, 0);
    if (drv->sys->expansion.place && i < drv->sys->ncontact) {
        return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED,
                           "periodic motions are found without static limits where degrees of freedom have no mass, and "
                           "ratio[%zu] = %g",
                           i, drv->sys->work.feq[i]);
    }
    return TRIBO_OK;
}

/* Creates the search of drv, unless it has one. Returns a status. */
static int open_search(tribo_driver *drv)
{
    drv->shooting = drv->shooting ? drv->shooting : tribo_shooting_create(drv);
    return drv->shooting
               ? TRIBO_OK
               : tribo_error(drv->message, TRIBO_ERR_MEMORY, "out of memory for periodic motions of %zu degree%s of freedom",
                             drv->sys->ndof, plural(drv->sys->ndof));
}

int tribo_events_find_periodic(tribo_driver *drv, struct wanted *w)
{
    const int status = open_search(drv);
    if (!status) {
        drv->shooting->map.ring = (struct ring){.parts = 1};
    }
    return status ? status : w->find(drv->shooting, w);
}

/* Returns TRIBO_OK if the method of drv finds periodic motions. what: the motions, for a message. */
static int check_method(tribo_driver *drv, const char *what)
{
    return drv->method->find_periodic ? TRIBO_OK
                                      : tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED,
                                                    "method %s finds no %s: take exact, event or auto", drv->method->name, what);
}

int tribo_driver_set_ring(tribo_driver *drv, size_t sectors, size_t order)
{
    if (!drv) {
        return TRIBO_ERR_NULL;
    }
    const size_t n = tribo_system_ndof(drv->sys), contacts = drv->sys->ncontact;
    int status = check_method(drv, "periodic motions");
    if (!status && sectors > 1 && (n % sectors || contacts % sectors)) {
        status = tribo_error(drv->message, TRIBO_ERR_RANGE,
                             "%zu degree%s of freedom and %zu contact%s are not those of equal sectors = %zu", n, plural(n),
                             contacts, plural(contacts), sectors);
    }
    status = status ? status : open_search(drv);
    if (!status) {
        drv->shooting->asked = sectors > 1 ? (struct ring_of){sectors, order % sectors} : (struct ring_of){0, 0};
    }
    return status;
}

/* Returns TRIBO_OK if the method of drv finds periodic motions, and y is a state at t. what: the motions, for a message. */
static int check_search(tribo_driver *drv, const char *what, double t, const double *y)
{
    int status = check_method(drv, what);
    if (status) {
        return status;
    }
    status = tribo_system_check_state(drv->sys, t, y);
    status = status ? status : tribo_system_take_settings(drv->sys);
    return tribo_driver_pass(drv, status);
}

/* Searches from the caller's state y, which becomes that of the motion found. Returns a status. */
static int search_from(tribo_driver *drv, struct wanted *w, double *y)
{
    w->y = drv->motion ? drv->motion : y;
    if (drv->motion) {
        tribo_system_read_state(drv->sys, y, drv->motion);
    }
    const int status = drv->method->find_periodic(drv, w);
    if (!status && drv->motion) {
        tribo_system_write_state(drv->sys, w->t, drv->motion, y);
    }
    return status;
}

int tribo_driver_find_periodic(tribo_driver *drv, double t, double period, double *y)
{
    if (!drv) {
        return TRIBO_ERR_NULL;
    }
    struct wanted w = {.find = drv->shooting && drv->shooting->asked.sectors ? tribo_shooting_find_ring : tribo_shooting_find,
                       .t = t,
                       .period = period};
    int status = check_search(drv, "periodic motions", t, y);
    status = status ? status : check_period(drv, t, period);
    status = status ? status : check_loads(drv, period);
    status = status ? status : check_friction(drv);
    return status ? status : search_from(drv, &w, y);
}

int tribo_driver_find_cycle(tribo_driver *drv, double t, double *period, double *y)
{
    if (!drv) {
        return TRIBO_ERR_NULL;
    }
    if (!period) {
        return tribo_error(drv->message, TRIBO_ERR_NULL, "period is NULL");
    }
    struct wanted w = {.find = tribo_shooting_find_cycle, .t = t, .period = *period};
    int status = check_search(drv, "cycles", t, y);
    status = status || *period == 0.0 ? status : check_period(drv, t, *period);
    status = status ? status : check_loads(drv, 0.0);
    status = status ? status : check_friction(drv);
    status = status ? status : search_from(drv, &w, y);
    if (!status) {
        *period = w.period;
    }
    return status;
}

/* Sets w for the mode of the amplitude of c'[q, q'], from a guess omega and zeta, and *own = w->c, memory to free also after a
 * failure. Returns TRIBO_OK if the arguments are those of a mode. */
static int check_mode(tribo_driver *drv, const double *c, double amplitude, double omega, double zeta, struct wanted *w,
                      double **own)
{
    const tribo_system *sys = drv->sys;
    const size_t given = tribo_system_ndof(sys), n = sys->ndof;
    int status = tribo_check_numbers(drv->message, 3, (const char *const[]){"amplitude", "omega", "zeta"},
                                     (const double[]){amplitude, omega, zeta});
    status = status ? status : tribo_check_array(drv->message, FINITE, "c", c, 2 * given);
    if (!status && (!(amplitude > 0.0) || omega < 0.0)) {
        status = tribo_error(drv->message, TRIBO_ERR_NOT_POSITIVE, "%s = %g is not positive",
                             amplitude > 0.0 ? "omega" : "amplitude", amplitude > 0.0 ? omega : amplitude);
    }
    status = status ? status : check_friction(drv);
    for (size_t k = 0; !status && k < sys->loads.harmonics; k++) {
        const struct harmonic *h = &sys->loads.harmonic[k];
        if (h->knots || (h->drives == DRIVES_LIMIT && h->omega != 0.0)) {
            status =
                tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED, "modes have limits that do not depend on time, and no tables");
        }
    }
    if (status) {
        return status;
    }
    double *const to = *own = calloc(2 * tribo_system_size(sys) + 2 * given + 1, sizeof *to);
    if (!to) {
        return tribo_error(drv->message, TRIBO_ERR_MEMORY, "out of memory for a mode");
    }
    if (drv->motion) {
        tribo_system_read_combination(sys, c, to);
    } else {
        memcpy(to, c, 2 * n * sizeof *c);
    }
    const int unmoved = tribo_largest(to + 2 * n, 2 * (tribo_system_energy(sys) - 2 * n)) > 0.0;
    if (unmoved || !(tribo_largest(to, 2 * n) > 0.0)) {
        status =
            tribo_error(drv->message, TRIBO_ERR_RANGE, "c %s", unmoved ? "takes in degrees of freedom without mass" : "is 0");
    } else if (sys->normals.count && tribo_largest(to + n, n) > 0.0) {
        status = tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED, "where limits follow the motion c takes displacements only");
    }
    w->period = omega > 0.0 ? FULL_TURN / omega : 0.0;
    w->c = to;
    w->amplitude = amplitude;
    w->delta = zeta * omega;
    return status;
}

int tribo_driver_find_mode(tribo_driver *drv, const double *c, double amplitude, double *omega, double *zeta, double *y)
{
    if (!drv) {
        return TRIBO_ERR_NULL;
    }
    if (!c || !omega || !zeta) {
        return tribo_error(drv->message, TRIBO_ERR_NULL, "%s is NULL", !c ? "c" : !omega ? "omega" : "zeta");
    }
    struct wanted w = {.find = tribo_shooting_find_mode};
    double *own = NULL;
    int status = check_search(drv, "modes", 0.0, y);
    status = status ? status : check_mode(drv, c, amplitude, *omega, *zeta, &w, &own);
    status = status ? status : search_from(drv, &w, y);
    if (!status) {
        *omega = FULL_TURN / w.period;
        *zeta = w.delta / *omega;
    }
    free(own);
    return status;
}

/* Returns TRIBO_OK if the members of the curve are those of a curve of drv. */
static int check_curve(tribo_driver *drv, const tribo_curve *curve, const double *period)
{
    const tribo_system *sys = drv->sys;
    const int mode = curve->motion == TRIBO_MOTION_MODE, kind = curve->parameter;
    const int bounded = kind == TRIBO_PARAMETER_FREQUENCY || mode;
    if (curve->size != sizeof *curve) {
        return tribo_error(drv->message, TRIBO_ERR_SIZE, "curve->size is not sizeof(tribo_curve)");
    }
    const int finite = tribo_check_numbers(drv->message, 5, (const char *const[]){"least", "most", "step", "amplitude", "period"},
                                           (const double[]){curve->least, curve->most, curve->step, curve->amplitude, *period});
    if (finite) {
        return finite;
    }
    if (mode && !curve->c) {
        return tribo_error(drv->message, TRIBO_ERR_NULL, "curve->c is NULL");
    }
    if (curve->motion < TRIBO_MOTION_PERIODIC || curve->motion > TRIBO_MOTION_MODE) {
        return tribo_error(drv->message, TRIBO_ERR_RANGE, "motion = %d is no TRIBO_MOTION_...", curve->motion);
    }
    if (kind < TRIBO_PARAMETER_LIMIT || kind > TRIBO_PARAMETER_BASES) {
        return tribo_error(drv->message, TRIBO_ERR_RANGE, "parameter = %d is no TRIBO_PARAMETER_...", kind);
    }
    if (mode != (kind == TRIBO_PARAMETER_AMPLITUDE)) {
        return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED, "modes are followed over their amplitude, other motions are not");
    }
    if (curve->motion == TRIBO_MOTION_CYCLE && kind == TRIBO_PARAMETER_FREQUENCY) {
        return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED, "cycles have no frequency of loads");
    }
    if (kind == TRIBO_PARAMETER_LIMIT && curve->index >= sys->ncontact) {
        return tribo_error(drv->message, TRIBO_ERR_RANGE, "there is no contact %zu", curve->index);
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        const struct follower *f = tribo_normals_follower(sys, i);
        const int one = kind == TRIBO_PARAMETER_LIMIT && i == curve->index && (f || tribo_normals_at(sys, i));
        if (one || (kind == TRIBO_PARAMETER_LIMITS && f && f->mu > 0.0)) {
            return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED, "the limit of contact %zu follows the motion", i);
        }
    }
    const int low = !(bounded ? curve->least > 0.0 : curve->least >= 0.0);
    return low                  ? tribo_error(drv->message, TRIBO_ERR_NOT_POSITIVE, "least = %g is %s", curve->least,
                             bounded ? "not positive" : "negative")
           : curve->step == 0.0 ? tribo_error(drv->message, TRIBO_ERR_NOT_POSITIVE, "step is 0")
                                : TRIBO_OK;
}

int tribo_driver_follow_curve(tribo_driver *drv, const tribo_curve *curve, double t, double *period, double *y,
                              int (*seen)(const tribo_curve_point *point, void *data), void *data)
{
    if (!drv) {
        return TRIBO_ERR_NULL;
    }
    if (!curve || !period) {
        return tribo_error(drv->message, TRIBO_ERR_NULL, "%s is NULL", curve ? "period" : "curve");
    }
    struct track c = {.ask = curve, .seen = seen, .data = data};
    struct wanted w = {.find = tribo_shooting_follow_curve, .t = t, .period = *period, .curve = &c};
    int status = check_search(drv, "curves", t, y);
    status = status ? status : check_curve(drv, curve, period);
    double *own = NULL, *from = calloc(2 * tribo_system_dimension(drv->sys) + 1, sizeof *from);
    if (!status && !from) {
        status = tribo_error(drv->message, TRIBO_ERR_MEMORY, "out of memory for a curve");
    } else if (!status && curve->motion == TRIBO_MOTION_MODE) {
        status = check_mode(drv, curve->c, curve->amplitude, *period > 0.0 ? FULL_TURN / *period : 0.0, 0.0, &w, &own);
    } else if (!status) {
        const int cycle = curve->motion == TRIBO_MOTION_CYCLE;
        status = cycle && *period == 0.0 ? TRIBO_OK : check_period(drv, t, *period);
        status = status ? status : check_loads(drv, cycle ? 0.0 : *period);
        status = status ? status : check_friction(drv);
    }
    if (!status) {
        memcpy(from, y, tribo_system_dimension(drv->sys) * sizeof *y);
        status = search_from(drv, &w, from);
    }
    if (c.points) {
        memcpy(y, c.shown, tribo_system_dimension(drv->sys) * sizeof *y);
        *period = w.period;
    }
    free(c.knot->z);
    free(own);
    free(from);
    return status;
}

/* Sets *s = the search of drv. Returns TRIBO_OK if drv is not NULL, the search has found a motion, and missing is NULL; missing:
 * name of an argument that is NULL. */
static int get_found(const tribo_driver *drv, const char *missing, struct shooting **s)
{
    if (!drv || missing) {
        return drv ? tribo_error(drv->message, TRIBO_ERR_NULL, "%s is NULL", missing) : TRIBO_ERR_NULL;
    }
    *s = drv->shooting && drv->shooting->found ? drv->shooting->told : NULL;
    if (!*s) {
        return tribo_error(drv->message, TRIBO_ERR_STATE, "no periodic motion was found: call tribo_driver_find_periodic first");
    }
    if ((*s)->map.ring.sectors) {
        *s = drv->shooting;
        return tribo_ring_find_flow(*s);
    }
    return TRIBO_OK;
}

int tribo_driver_get_freedom(const tribo_driver *drv, size_t *freedom)
{
    struct shooting *s = NULL;
    const int status = get_found(drv, freedom ? NULL : "freedom", &s);
    return status ? status : tribo_shooting_freedom(s, freedom);
}

int tribo_driver_get_multipliers(const tribo_driver *drv, double *re, double *im)
{
    struct shooting *s = NULL;
    int status = get_found(drv, !re ? "re" : !im ? "im" : NULL, &s);
    if (!status && s->flow->derivative.torn < s->map.sys->ncontact) {
        return tribo_error(drv->message, TRIBO_ERR_UNSUPPORTED,
                           "contact %zu and contact %zu stop or break away at one instant, or are a contact and its normal that "
                           "just touches: which of them is first may change the motion, and it has no multipliers",
                           s->flow->derivative.torn, s->flow->derivative.other);
    }
    if (!status) {
        status = tribo_shooting_check_touches(s, "multipliers");
        status = status && s->map.drv != drv ? tribo_error(drv->message, status, "%s", s->map.drv->message) : status;
    }
    return status ? status : tribo_shooting_multipliers(s, re, im);
}
