/* rk4 in fixed steps, and the methods that choose their steps: the loop that tries steps, measures their errors, and takes them
 * or not. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "driver.h"
#include "spectrum.h"
#include "stepper.h"
#include "../common/real.h"

/* ------------------------------------------------------------------------------------------------- rk4 with fixed steps */

static void destroy_rk4(tribo_driver *drv)
{
    free(drv->own);
}

static int create_rk4(tribo_driver *drv)
{
    drv->own = malloc(5 * tribo_system_dimension(drv->sys) * sizeof(double));
    return drv->own ? TRIBO_OK : tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method rk4/fixed");
}

static int explain(tribo_driver *drv, double t, double h)
{
    return tribo_driver_fail(drv, drv->sys->status, "at t = %.17g, in a step of %g: %s", t, h, tribo_message(drv->sys->contacts));
}

static int rk4_step(tribo_driver *drv, double t, double next, double *y)
{
    const size_t dimension = tribo_system_dimension(drv->sys);
    double *to = drv->own;
    struct step s = {.t = t, .h = next - t, .y = y, .slope = drv->slope, .to = to};
    if (tribo_system_begin_step(drv->sys, t, y, drv->slope) || tribo_rk4_step(drv->sys, &s, to + dimension)) {
        return explain(drv, t, next - t);
    }
    memcpy(y, to, dimension * sizeof *y);
    return TRIBO_OK;
}

static int advance_rk4(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    (void)continues;
    return tribo_driver_fixed_steps(drv, t, t1, y, rk4_step);
}

const struct method tribo_method_rk4_fixed = {"rk4/fixed", WITHOUT_TOLERANCES, create_rk4, destroy_rk4, advance_rk4, NULL};

/* ------------------------------------------------------------------------------------------------------- adaptive steps */

/* While all contacts rest, nothing moves, and an estimate sees no error however long the step: this long in terms of the
 * fastest motion of structure and loads it may be. */
#define LARGEST_STEP 0.1

/* Velocities of contacts are found to this part of epsilon, over which friction changes from one end to the other. */
#define PART_OF_EPSILON 1e-3

struct adaptive {
    const struct stepper *kind;
    void *stepper;
    double h;                             /* the next step */
    double *memory;                       /* all arrays */
    double *to, *error, *end, *tolerance; /* [dimension] */
    int slope_known;                      /* drv->slope is that of the state */

    /* what follows from the system, as it was with these revisions */
    int prepared;
    size_t structure, revision;
    double largest;      /* step by default */
    double *cap;         /* [ndof] on the tolerance of velocities */
    double *band, *rate; /* [ncontact] while |v| is at most band, v relaxes at rate */
};

static void destroy(tribo_driver *drv)
{
    struct adaptive *a = drv->own;
    if (a) {
        a->kind->destroy(a->stepper);
        free(a->memory);
        free(a);
    }
}

static int create(tribo_driver *drv)
{
    const size_t n = tribo_system_dimension(drv->sys), c = drv->sys->ncontact;
    struct adaptive *a = calloc(1, sizeof *a);
    if (a) {
        drv->own = a;
        a->kind = drv->method->with;
        a->stepper = a->kind->create(a->kind, n);
        a->memory = malloc((5 * n + 2 * c) * sizeof *a->memory);
    }
    if (!a || !a->stepper || !a->memory) {
        return tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method %s", drv->method->name);
    }
    a->to = a->memory;
    a->error = a->memory + n;
    a->end = a->memory + 2 * n;
    a->tolerance = a->memory + 3 * n;
    a->cap = a->memory + 4 * n;
    a->band = a->memory + 5 * n;
    a->rate = a->band + c;
    return TRIBO_OK;
}

/* Contact i changes its force by 2 limit_i in epsilon_i: errors of velocities that matter little beside the largest limit. */
static void find_cap(struct adaptive *a, const tribo_system *sys, size_t i, double error)
{
    const struct matrix *j = &sys->direction;
    double sum = 0.0;
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        sum += fabs(j->val[k]);
    }
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        a->cap[j->col[k]] = lesser(a->cap[j->col[k]], error / sum);
    }
}

/* What the contacts ask of velocities and steps, with the limits that they have. */
static void find_bands(struct adaptive *a, tribo_system *sys)
{
    double *limit = a->rate, most = 0.0, fastest = 0.0, bound;
    int law;
    tribo_get_law(sys->contacts, &law);
    tribo_get_limit(sys->contacts, limit);
    tribo_get_epsilon(sys->contacts, a->band);
    tribo_get_real(sys->contacts, TRIBO_REAL_MAX_RATE, &bound);
    for (size_t d = 0; d < sys->ndof; d++) {
        a->cap[d] = HUGE_VAL;
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        most = greater(most, limit[i]);
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (limit[i] > 0.0) {
            find_cap(a, sys, i, law == TRIBO_COULOMB ? HUGE_VAL : PART_OF_EPSILON * a->band[i] * (most / limit[i]));
            a->rate[i] = limit[i] / a->band[i] * tribo_system_delassus(sys, i, i);
            fastest = greater(fastest, a->rate[i]);
        }
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        a->rate[i] *= fastest > 0.0 ? bound / fastest : 0.0;
    }
}

/* Brings all that up to date that follows from the system. */
static int prepare(struct adaptive *a, tribo_driver *drv)
{
    tribo_system *sys = drv->sys;
    const size_t revision = tribo_system_revision(sys);
    if (!a->prepared || a->structure != sys->revision) {
        double fastest;
        const int status = tribo_system_top_frequency(sys, &fastest);
        if (status) {
            return tribo_driver_fail(drv, status, "%s", tribo_message(sys->contacts));
        }
        a->largest = fastest > 0.0 ? LARGEST_STEP / fastest : HUGE_VAL;
    }
    if (!a->prepared || a->revision != revision) {
        find_bands(a, sys);
    }
    a->structure = sys->revision;
    a->revision = revision;
    a->prepared = 1;
    return TRIBO_OK;
}

/* The longest step from here, sys->v being the velocities of the contacts: where one is about to stick, an explicit method jumps
 * about in its band if a step is longer than is stable, and now and then its estimate happens to see nothing. */
static double longest(const struct adaptive *a, const tribo_driver *drv)
{
    const tribo_system *sys = drv->sys;
    double h = drv->max_step > 0.0 ? drv->max_step : a->largest;
    for (size_t i = 0; a->kind->stable < HUGE_VAL && i < sys->ncontact; i++) {
        if (fabs(sys->v[i]) <= a->band[i] && a->rate[i] * h > a->kind->stable) {
            h = a->kind->stable / a->rate[i];
        }
    }
    return h;
}

static double largest(const double *x, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        most = greater(most, fabs(x[i]));
    }
    return most;
}

/* Displacements, velocities and the energy, each relative to the largest of their kind. A status: no step is short enough for an
 * error below rounding. */
static int find_tolerance(const struct adaptive *a, tribo_driver *drv, double t, const double *y)
{
    const size_t n = drv->sys->ndof, dimension = 2 * n + 1;
    const double q = drv->abstol + drv->reltol * largest(y, n), u = drv->abstol + drv->reltol * largest(y + n, n);
    for (size_t d = 0; d < n; d++) {
        a->tolerance[d] = q;
        a->tolerance[n + d] = lesser(u, a->cap[d]);
    }
    a->tolerance[2 * n] = drv->abstol + drv->reltol * fabs(y[2 * n]);
    for (size_t i = 0; i < dimension; i++) {
        if (a->tolerance[i] < DBL_EPSILON * fabs(y[i])) {
            return tribo_driver_fail(drv, TRIBO_ERR_STEP, "at t = %.17g no step is so short that y[%zu] = %g is found to %g", t,
                                     i, y[i], a->tolerance[i]);
        }
    }
    return TRIBO_OK;
}

/* The largest error in terms of the tolerance; not finite if one is not. */
static double size_of(const struct adaptive *a, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        const double x = fabs(a->error[i]) / a->tolerance[i];
        most = x <= most ? most : x;
    }
    return most;
}

/* Why a step failed however short it was. */
static int give_up(tribo_driver *drv, int gsl_status, double t, double h, double size)
{
    if (gsl_status && drv->sys->status) {
        return explain(drv, t, h);
    }
    if (gsl_status) {
        return tribo_driver_fail(drv, TRIBO_ERR_STEP,
                                 "step from t = %.17g failed down to %g: the implicit equations have no solution", t, h);
    }
    return tribo_driver_fail(drv, TRIBO_ERR_STEP, "step from t = %.17g failed down to %g: the error is %g times the tolerance", t,
                             h, size);
}

/* A step from *t, at most to end. */
static int advance_step(tribo_driver *drv, double *t, double end, double *y)
{
    struct adaptive *a = drv->own;
    const size_t n = tribo_system_dimension(drv->sys);
    struct step s = {
        .t = *t, .y = y, .slope = drv->slope, .tolerance = a->tolerance, .to = a->to, .error = a->error, .end = a->end};
    a->h = lesser(a->h, longest(a, drv));
    for (;;) {
        const double left = end - *t;
        s.h = a->h >= left ? left : lesser(a->h, 0.5 * left); /* no tiny rest */
        if (!(*t + s.h > *t)) {
            return tribo_driver_fail(drv, TRIBO_ERR_STEP, "at t = %.17g the step is down to %g", *t, s.h);
        }
        const int status = a->kind->attempt(a->stepper, drv->sys, &s);
        if (status == GSL_EBADFUNC) {
            return explain(drv, *t, s.h);
        }
        const double size = status ? HUGE_VAL : size_of(a, n);
        if (size <= 1.0) {
            const double growth = a->kind->accept(a->stepper, &s, size);
            a->h = s.h == a->h ? growth * s.h : greater(a->h, growth * s.h);
            *t = s.h == left ? end : *t + s.h;
            memcpy(y, a->to, n * sizeof *y);
            if (s.ends) {
                memcpy(drv->slope, a->end, n * sizeof *y);
            }
            a->slope_known = s.ends;
            return TRIBO_OK;
        }
        drv->rejected++;
        a->h = s.h * (status || !isfinite(size) ? 0.25 : lesser(a->kind->reject(a->stepper, size), 0.9));
        if (!(*t + a->h > *t)) {
            return give_up(drv, status, *t, a->h, size);
        }
    }
}

/* What a step from (t, y) has to know. */
static int begin_step(tribo_driver *drv, double t, const double *y)
{
    struct adaptive *a = drv->own;
    int law;
    tribo_get_law(drv->sys->contacts, &law);
    if ((!a->slope_known || law == TRIBO_QUINN_REVERSAL) && tribo_system_begin_step(drv->sys, t, y, drv->slope)) {
        return tribo_driver_fail(drv, drv->sys->status, "at t = %.17g: %s", t, tribo_message(drv->sys->contacts));
    }
    if (drv->sys->limits.knots) {
        find_bands(a, drv->sys);
    }
    return find_tolerance(a, drv, t, y);
}

static int advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    struct adaptive *a = drv->own;
    int status = prepare(a, drv);
    if (!continues) {
        a->kind->restart(a->stepper);
        a->h = drv->dt;
        a->slope_known = 0;
    }
    while (!status && *t < t1) {
        status = begin_step(drv, *t, y);
        status = status ? status : advance_step(drv, t, lesser(t1, tribo_system_next_kink(drv->sys, *t)), y);
        if (!status) {
            status = tribo_driver_accept(drv, *t, y, 0);
            drv->steps += !status || status == TRIBO_ERR_STOPPED;
        }
    }
    return status;
}

#define ADAPTIVE(id)                                                                                                             \
    const struct method tribo_method_##id = {#id, WITH_LARGEST_STEP, create, destroy, advance, &tribo_stepper_##id};
ADAPTIVE(rk2)
ADAPTIVE(rk4)
ADAPTIVE(rkf45)
ADAPTIVE(rkck)
ADAPTIVE(rk8pd)
ADAPTIVE(rk1imp)
ADAPTIVE(rk2imp)
ADAPTIVE(rk4imp)
ADAPTIVE(msbdf)
