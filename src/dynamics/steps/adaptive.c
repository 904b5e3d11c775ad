/* SPDX-License-Identifier: BSD-3-Clause */
/* Drivers by a stepper of tribo_dynamics.h: the loop that tries steps, accepts them by their errors, and chooses their
 * lengths. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/layout.h"
#include "common/real.h"
#include "dynamics/driver.h"
#include "dynamics/reduce/spectrum.h"

/* The largest step, times the highest frequency of structure and loads: while all contacts rest, an estimate of the error is
 * 0 however long the step is. */
#define LARGEST_STEP 0.1

/* Defaults: tolerances, and the first step as a part of the largest one. */
#define ABSTOL 1e-12
#define RELTOL 1e-8
#define FIRST_STEP 1e-2

/* Tolerance of the velocities of contacts, as a part of epsilon, over which friction changes from one end to the other. */
#define PART_OF_EPSILON 1e-3

/* Most steps rejected while time proceeds by HEADWAY times the largest step. */
#define MOST_REJECTED 2000
#define HEADWAY 1e-3

struct adaptive {
    tribo_stepper stepper;
    void *data;           /* of the stepper */
    struct method method; /* of the stepper's name */
    double h;             /* length of the next step */
    double span;          /* of the advance */
    double since;         /* time from which `rejected` counts */
    size_t rejected;
    double *to, *error, *tolerance; /* [dimension] end of a step; its error; tolerance */

    /* found from the system of revisions structure and revision; SIZE_MAX: not found */
    size_t structure, revision;
    double largest;      /* step, unless the caller sets it */
    double *cap;         /* [ndof] most tolerance of velocities */
    double *band, *rate; /* [ncontact] epsilon; rate at which v relaxes while |v| <= band */
};

static void adaptive_destroy(tribo_driver *drv)
{
    struct adaptive *a = drv->own;
    if (a) {
        if (a->stepper.destroy) {
            a->stepper.destroy(a->data);
        }
        free(a);
    }
}

static void restart(const struct adaptive *a)
{
    if (a->stepper.restart) {
        a->stepper.restart(a->data);
    }
}

/* cap, band and rate, from the limits at the time set. */
static void find_bands(struct adaptive *a, tribo_system *sys)
{
    double *limit = a->rate, fastest = 0.0, bound;
    int law;
    tribo_get_law(sys->contacts, &law);
    tribo_system_rest_limits(sys, limit);
    tribo_get_epsilon(sys->contacts, a->band);
    tribo_get_real(sys->contacts, TRIBO_REAL_MAX_RATE, &bound);
    for (size_t d = 0; d < sys->ndof; d++) {
        a->cap[d] = HUGE_VAL;
    }
    const double most = tribo_largest(limit, sys->ncontact);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (limit[i] > 0.0) {
            /* the force changes by 2 limit_i over epsilon_i: this error of v_i changes it by a small part of the largest limit */
            const double error = law == TRIBO_COULOMB ? HUGE_VAL : PART_OF_EPSILON * a->band[i] * (most / limit[i]);
            const struct matrix *j = &sys->direction;
            double sum = 0.0;
            for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
                sum += fabs(j->val[k]);
            }
            for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
                a->cap[j->col[k]] = lesser(a->cap[j->col[k]], error / sum);
            }
            a->rate[i] = limit[i] / a->band[i] * tribo_system_delassus(sys, i, i);
            fastest = greater(fastest, a->rate[i]);
        }
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        a->rate[i] *= fastest > 0.0 ? bound / fastest : 0.0;
    }
}

/* Keeps the message of a step of h from t that failed with status, in the stepper or in an evaluation of the system; or that
 * failed at any length, with errors of size tolerances if status is TRIBO_OK. */
static int adaptive_fail(tribo_driver *drv, int status, double t, double h, double size)
{
    if (!status) {
        return tribo_error(drv->message, TRIBO_ERR_STEP,
                           "step from t = %.17g failed down to %g: the error is %g times the tolerance", t, h, size);
    }
    if (status == TRIBO_ERR_STEP || status == TRIBO_ERR_NO_CONVERGENCE) {
        return tribo_error(drv->message, TRIBO_ERR_STEP,
                           "step from t = %.17g failed down to %g: the implicit equations have no solution", t, h);
    }
    return drv->sys->status == status
               ? tribo_driver_explain(drv, t, h)
               : tribo_error(drv->message, status, "at t = %.17g, in a step of %g: %s", t, h, tribo_strerror(status));
}

/* The next length of steps, divided by the last one: as in GSL's control, small changes are not made. */
static double next_step(const struct adaptive *a, double size)
{
    const double order = a->stepper.order(a->data);
    if (size > 1.0) {
        return clamp(0.9 * pow(size, -1.0 / order), 0.2, 0.9);
    }
    return size > 0.5 ? 1.0 : size > 0.0 ? clamp(0.9 * pow(size, -1.0 / (order + 1.0)), 1.0, 5.0) : 5.0;
}

/* Takes a step from *t, at most to end. Returns a status. */
static int advance_step(tribo_driver *drv, double *t, double end, double *y)
{
    struct adaptive *a = drv->own;
    const size_t n = tribo_system_dimension(drv->sys);
    double longest = drv->max_step > 0.0 ? drv->max_step : a->largest;
    /* inside a band an explicit method oscillates in steps that are longer than stable, and its error may happen to be 0 */
    for (size_t i = 0; a->stepper.stable > 0.0 && i < drv->sys->ncontact; i++) {
        if (fabs(drv->sys->work.v[i]) <= a->band[i] && a->rate[i] * longest > a->stepper.stable) {
            longest = a->stepper.stable / a->rate[i];
        }
    }
    a->h = lesser(a->h, longest);
    for (;;) {
        const double left = end - *t, h = a->h >= left ? left : lesser(a->h, 0.5 * left); /* leaves no tiny rest */
        if (!(*t + h > *t)) {
            return tribo_error(drv->message, TRIBO_ERR_STEP, "at t = %.17g the step is down to %g", *t, h);
        }
        const tribo_trial trial = {sizeof trial, *t, h, y, drv->slope, a->tolerance, a->rate, a->to, a->error};
        drv->sys->status = TRIBO_OK;
        const int status = a->stepper.step(&trial, a->data);
        const int shorter = status == TRIBO_ERR_STEP || status == TRIBO_ERR_NO_CONVERGENCE || status == TRIBO_ERR_NOT_FINITE;
        if (status && !shorter) {
            return adaptive_fail(drv, status, *t, h, 0.0);
        }
        double size = status ? HUGE_VAL : 0.0; /* the largest error divided by its tolerance */
        for (size_t i = 0; !status && i < n; i++) {
            const int finite = isfinite(a->to[i]) && isfinite(a->error[i]);
            size = greater(size, finite ? fabs(a->error[i]) / a->tolerance[i] : HUGE_VAL);
        }
        if (size <= 1.0) {
            const double next = next_step(a, size) * h;
            a->h = h == a->h ? next : greater(a->h, next);
            *t = h == left ? end : *t + h;
            memcpy(y, a->to, n * sizeof *y);
            return TRIBO_OK;
        }
        drv->rejected++;
        a->rejected++;
        if (*t - a->since > HEADWAY * lesser(a->largest, a->span)) {
            a->since = *t;
            a->rejected = 0;
        } else if (a->rejected > MOST_REJECTED) {
            return tribo_error(drv->message, TRIBO_ERR_STEP, "at t = %.17g steps make no headway, at a length of %g", *t, h);
        }
        a->h = h * (isfinite(size) ? next_step(a, size) : 0.25);
        if (a->h < DBL_EPSILON * greater(fabs(*t), a->span)) {
            return adaptive_fail(drv, status, *t, a->h, size);
        }
    }
}

/* Prepares a step from (t, y): slope, bands, tolerances. The reversal law needs the slope of each accepted state. Returns a
 * status. */
static int begin_step(tribo_driver *drv, double t, const double *y)
{
    struct adaptive *a = drv->own;
    const size_t n = drv->sys->ndof, dimension = tribo_system_dimension(drv->sys);
    double *slope = drv->slope;
    int law;
    tribo_get_law(drv->sys->contacts, &law);
    if (a->stepper.takes_slope || law == TRIBO_QUINN_REVERSAL) {
        memcpy(slope, y + n, n * sizeof *slope);
        if (tribo_system_rates(drv->sys, t, y, 1, slope + n, slope + 2 * n)) {
            return tribo_driver_explain(drv, t, a->h);
        }
    }
    if (tribo_system_limits_vary(drv->sys)) {
        find_bands(a, drv->sys);
    }
    /* tolerances relative to the largest displacement, the largest velocity, and the energy; no step has an error below
     * rounding */
    const double q = drv->abstol + drv->reltol * tribo_largest(y, n), u = drv->abstol + drv->reltol * tribo_largest(y + n, n);
    for (size_t d = 0; d < n; d++) {
        a->tolerance[d] = q;
        a->tolerance[n + d] = lesser(u, a->cap[d]);
    }
    a->tolerance[2 * n] = drv->abstol + drv->reltol * fabs(y[2 * n]);
    for (size_t i = 0; i < dimension; i++) {
        if (a->tolerance[i] < DBL_EPSILON * fabs(y[i])) {
            return tribo_error(drv->message, TRIBO_ERR_STEP, "at t = %.17g no step is so short that y[%zu] = %g is found to %g",
                               t, i, y[i], a->tolerance[i]);
        }
    }
    return TRIBO_OK;
}

static int adaptive_advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    struct adaptive *a = drv->own;
    tribo_system *sys = drv->sys;
    int status = TRIBO_OK;
    if (a->structure != sys->revision) {
        double square;
        status = tribo_system_highest(sys, 1.0, 0.0, &square);
        if (status) {
            return tribo_driver_pass(drv, status);
        }
        const double fastest = greater(sqrt(square), tribo_system_load_frequency(sys));
        a->largest = fastest > 0.0 ? LARGEST_STEP / fastest : HUGE_VAL;
        a->structure = sys->revision;
    }
    if (a->revision != tribo_system_revision(sys)) {
        find_bands(a, sys);
        a->revision = tribo_system_revision(sys);
    }
    if (!continues) {
        restart(a);
        a->h = drv->dt > 0.0 ? drv->dt : FIRST_STEP * lesser(a->largest, t1 - *t);
    }
    a->since = *t;
    a->span = t1 - *t;
    a->rejected = 0;
    while (!status && *t < t1) {
        const double kink = tribo_system_next_kink(sys, *t);
        status = begin_step(drv, *t, y);
        status = status ? status : advance_step(drv, t, lesser(t1, kink), y);
        if (*t == kink) {
            restart(a);
        }
        if (!status) {
            status = tribo_driver_accept(drv, *t, y);
            drv->steps += !status || status == TRIBO_ERR_STOPPED;
        }
    }
    return status;
}

int tribo_driver_create_stepper(tribo_driver **drv, tribo_system *sys, const tribo_stepper *stepper, void *data)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (!drv || !stepper) {
        return tribo_error(sys->message, TRIBO_ERR_NULL, "%s is NULL", drv ? "stepper" : "drv");
    }
    if (stepper->size < sizeof *stepper) {
        return tribo_error(sys->message, TRIBO_ERR_SIZE, "stepper->size = %zu is below %zu", stepper->size, sizeof *stepper);
    }
    const char *missing = !stepper->name ? "name" : !stepper->step ? "step" : !stepper->order ? "order" : NULL;
    if (missing) {
        return tribo_error(sys->message, TRIBO_ERR_NULL, "stepper->%s is NULL", missing);
    }
    const size_t n = tribo_system_dimension(sys), c = sys->ncontact;
    struct adaptive *a, new = {.stepper = *stepper, .data = data, .structure = SIZE_MAX, .revision = SIZE_MAX};
    if (!ALLOCATE(ARRAY(a, 1), ARRAY(new.to, n), ARRAY(new.error, n), ARRAY(new.tolerance, n), ARRAY(new.cap, n),
                  ARRAY(new.band, c), ARRAY(new.rate, c))) {
        return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for stepper %.20s", stepper->name);
    }
    new.method = (struct method){.name = stepper->name,
                                 .takes = TAKES_STEP | TAKES_TOLERANCE | TAKES_MAX_STEP | NEEDS_MASS,
                                 .destroy = adaptive_destroy,
                                 .advance = adaptive_advance};
    *a = new;
    const int status = tribo_driver_create_method(drv, sys, &a->method);
    if (status) {
        free(a);
        return status;
    }
    (*drv)->own = a;
    (*drv)->abstol = ABSTOL;
    (*drv)->reltol = RELTOL;
    return TRIBO_OK;
}
