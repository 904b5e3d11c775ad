#include "gsl_step.h"
#include "numerics/linalg.h"
#include "common/real.h"

#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

/* A pivot that is this part, or less, of what it is the sum of is taken for rounding. */
#define LEAST_PIVOT 1e-13

/* GSL multiplies by inverses of pivots, which of larger ones have no digits left. */
#define LARGEST_ENTRY 1e140

/* Implicit Runge-Kutta steps solve their equations to this part of the tolerance, since their estimates know nothing of that. */
#define NEWTON 0.05

/* Newton's method takes a change within a step that is this part of the tolerance, or less, for none. */
#define NEGLIGIBLE 1e-3
#define ROUNDING 1e-6 /* of a tolerance that is larger than this part of the state, that part */

struct gsl_step {
    const struct gsl_step_kind *kind;
    tribo_system *sys;
    gsl_odeiv2_step *step;
    gsl_odeiv2_system guarded;  /* what GSL sees of the system */
    gsl_odeiv2_control control; /* GSL asks this one for the tolerance, */
    gsl_odeiv2_driver driver;   /* by way of this one */
    const double *tolerance, *rate;
    double h; /* being tried */

    /* implicit kinds */
    double *jacobian, *matrix; /* [dimension][dimension] the last one, if known; workspace of a factorization */
    int *pivot;
    int known;
    double regular;    /* all matrices of the step h with this Jacobian can be solved with; 0: of none known */
    double *end;       /* [dimension] slope where it ends, newton kinds */
    signed char *mode; /* [2][ncontact] what contacts do where the step begins; workspace */
};

/* ------------------------------------------------------------------------------------------------------------- memory */

struct request {
    size_t blocks, bytes;
};

/* Whether malloc has so much for all of them at once. */
static int memory_for(const struct request *r, size_t count)
{
    int enough = 1;
    void **last = NULL;
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; enough && k < r[i].blocks; k++) {
            void **block = malloc(r[i].bytes);
            enough = block != NULL;
            if (block) {
                *block = last;
                last = block;
            }
        }
    }
    while (last) {
        void **next = *last;
        free(last);
        last = next;
    }
    return enough;
}

/* At least what creating a stepper of GSL takes: headers, vectors, histories of up to 13 vectors, and matrices. */
static int memory_to_create(const struct gsl_step_kind *kind, size_t n)
{
    const size_t size = n * kind->stages, header = 512, vector = header + size * sizeof(double);
    if (size > SIZE_MAX / sizeof(double) / (16 + size)) {
        return 0;
    }
    const struct request all[] = {{24, header}, {40, vector}, {3, 16 * vector}, {kind->matrices ? 3 : 0, size * vector}};
    return memory_for(all, sizeof all / sizeof *all);
}

/* A factorization allocates a vector of integers. */
static int memory_to_factorize(const struct gsl_step *g)
{
    const size_t header = 512;
    const struct request all[] = {{2, header}, {1, header + g->sys->odeiv2.dimension * g->kind->stages * sizeof(size_t)}};
    return memory_for(all, sizeof all / sizeof *all);
}

static int gsl_step_out_of_memory(tribo_system *sys)
{
    sys->status = tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for an implicit step");
    return GSL_EBADFUNC;
}

/* ---------------------------------------------------------------------------------------------------------- callbacks */

/* Open contacts carry nothing, and nearly nothing just before they lift off, or after they have touched down: no jump. */
static int jumps(signed char before, signed char after)
{
    return before != after && before != 2 && after != 2;
}

/* Whether a contact sticks, breaks away or turns between where the step begins and the last evaluation, in a step that is longer
 * than so much beside the time in which it relaxes; one of rate 0 does not relax but jumps. */
static int passes_a_change(const struct gsl_step *g, double part)
{
    const size_t n = g->sys->ncontact;
    if (tribo_get_slip(g->sys->contacts, g->mode + n)) {
        return 0;
    }
    for (size_t i = 0; i < n; i++) {
        if (jumps(g->mode[i], g->mode[n + i]) && (g->rate[i] * g->h > part || g->rate[i] == 0.0)) {
            return 1;
        }
    }
    return 0;
}

/* Where GSL factorizes, one of these two has come before it and nothing allocates in between. */
static int guarded_function(double t, const double y[], double dydt[], void *params)
{
    struct gsl_step *g = params;
    const int status = g->sys->odeiv2.function(t, y, dydt, g->sys);
    if (status) {
        return status;
    }
    if (g->kind->stable < HUGE_VAL && passes_a_change(g, g->kind->stable)) {
        return GSL_FAILURE;
    }
    if (g->kind->newton) {
        /* Slopes that are nothing beside the tolerance, and beside the state, are left out for Newton's method, which as GSL has it takes
         * rounding that does not decrease for divergence. */
        const size_t n = g->sys->ndof;
        const double way = tribo_largest(y, n) + g->h * tribo_largest(y + n, n);
        const double size[] = {way, way / g->h, fabs(y[2 * n]) + way * tribo_largest(g->sys->f, g->sys->ncontact)};
        for (size_t i = 0; i <= 2 * n; i++) {
            const double least = NEGLIGIBLE * lesser(g->tolerance[i], ROUNDING * size[i / n]);
            dydt[i] = fabs(dydt[i]) * g->h < least ? 0.0 : dydt[i];
        }
    }
    return memory_to_factorize(g) ? GSL_SUCCESS : gsl_step_out_of_memory(g->sys);
}

/* matrix = I - h A x J, row by row, as GSL has it. */
static void fill_matrix(const struct gsl_step *g, double h)
{
    const size_t n = g->sys->odeiv2.dimension, stages = g->kind->stages, size = n * stages;
    for (size_t k = 0; k < stages; k++) {
        for (size_t m = 0; m < stages; m++) {
            const double factor = -h * (g->kind->a ? g->kind->a[k * stages + m] : 1.0);
            for (size_t i = 0; i < n; i++) {
                double *row = g->matrix + (k * n + i) * size + m * n;
                for (size_t j = 0; j < n; j++) {
                    row[j] = factor * g->jacobian[i * n + j];
                }
                row[i] += k == m ? 1.0 : 0.0;
            }
        }
    }
}

/* Whether all pivots are more than rounding: each beside the sum of the sizes that it is the sum of, so that scales of rows and
 * columns do not matter. */
static int pivots_are_sure(const double *lu, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        double sum = fabs(lu[i * n + i]);
        for (size_t k = 0; k < i; k++) {
            sum += fabs(lu[i * n + k] * lu[k * n + i]);
        }
        if (!(fabs(lu[i * n + i]) > LEAST_PIVOT * sum && isfinite(sum))) {
            return 0;
        }
    }
    return 1;
}

/* Whether GSL can solve with all matrices of a step h. Of msbdf, whose factor is that of its order, only the orders that there
 * are so far: an order grows from one step to the next only. */
static int is_regular(struct gsl_step *g)
{
    const size_t size = g->sys->odeiv2.dimension * g->kind->stages;
    const size_t order = gsl_odeiv2_step_order(g->step);
    const size_t count = g->kind->type == &gsl_odeiv2_step_msbdf && order < g->kind->matrices ? order : g->kind->matrices;
    for (size_t i = 0; i < count && g->h != g->regular; i++) {
        fill_matrix(g, g->kind->c[i] * g->h);
        if (tribo_largest(g->matrix, size * size) > LARGEST_ENTRY || !(tribo_lu_create(g->matrix, size, g->pivot) > 0.0) ||
            !pivots_are_sure(g->matrix, size)) {
            return 0;
        }
    }
    g->regular = g->kind->type == &gsl_odeiv2_step_msbdf ? 0.0 : g->h;
    return 1;
}

/* GSL takes any status as a reason to fail the step, and a shorter one has other matrices. */
static int guarded_jacobian(double t, const double y[], double *dfdy, double dfdt[], void *params)
{
    struct gsl_step *g = params;
    const size_t n = g->sys->odeiv2.dimension;
    const int status = g->sys->odeiv2.jacobian(t, y, dfdy, dfdt, g->sys);
    if (status) {
        return status;
    }
    tribo_get_slip(g->sys->contacts, g->mode);
    memcpy(g->jacobian, dfdy, n * n * sizeof *dfdy);
    g->known = 1;
    g->regular = 0.0;
    if (!tribo_dense_finite(dfdt, n) || !is_regular(g)) {
        return GSL_FAILURE;
    }
    return memory_to_factorize(g) ? GSL_SUCCESS : gsl_step_out_of_memory(g->sys);
}

static int tell_tolerance(void *state, const double y, const double dydt, const double h, const size_t i, double *level)
{
    const struct gsl_step *g = state;
    (void)y, (void)dydt, (void)h;
    *level = (g->kind->newton ? NEWTON : 1.0) * g->tolerance[i];
    return GSL_SUCCESS;
}

/* ------------------------------------------------------------------------------------------------------------- steppers */

void tribo_gsl_step_destroy(struct gsl_step *g)
{
    if (g) {
        gsl_odeiv2_step_free(g->step);
        free(g->jacobian);
        free(g->matrix);
        free(g->pivot);
        free(g->end);
        free(g->mode);
        free(g);
    }
}

static int create_workspace(struct gsl_step *g)
{
    const size_t n = g->sys->odeiv2.dimension, size = n * g->kind->stages;
    g->guarded.function = guarded_function;
    g->guarded.jacobian = guarded_jacobian;
    g->guarded.params = g;
    g->jacobian = calloc(n, n * sizeof *g->jacobian);
    g->matrix = calloc(size, size * sizeof *g->matrix);
    g->pivot = calloc(size, sizeof *g->pivot);
    g->end = calloc(n, sizeof *g->end);
    g->mode = calloc(2 * g->sys->ncontact + 1, sizeof *g->mode);
    return g->jacobian && g->matrix && g->pivot && g->end && g->mode;
}

struct gsl_step *tribo_gsl_step_create(const struct gsl_step_kind *kind, tribo_system *sys)
{
    static const gsl_odeiv2_control_type tolerance = {.name = "tribo", .errlevel = tell_tolerance};
    struct gsl_step *g = calloc(1, sizeof *g);
    if (!g) {
        return NULL;
    }
    g->kind = kind;
    g->sys = sys;
    g->guarded = sys->odeiv2;
    g->control = (gsl_odeiv2_control){&tolerance, g};
    g->driver.c = &g->control;
    if ((kind->matrices && !create_workspace(g)) || !memory_to_create(kind, sys->odeiv2.dimension)) {
        tribo_gsl_step_destroy(g);
        return NULL;
    }
    g->step = gsl_odeiv2_step_alloc(*kind->type, sys->odeiv2.dimension);
    gsl_odeiv2_step_set_driver(g->step, &g->driver);
    return g;
}

void tribo_gsl_step_restart(struct gsl_step *g)
{
    gsl_odeiv2_step_reset(g->step);
    g->known = 0;
}

/* Whether a contact sticks at either end of the step, or slides back at one and forth at the other. */
static int has_stuck(const struct gsl_step *g)
{
    const size_t n = g->sys->ncontact;
    int found = 0;
    if (!tribo_get_slip(g->sys->contacts, g->mode + n)) {
        for (size_t i = 0; i < n; i++) {
            found |= g->mode[i] != g->mode[n + i] || g->mode[i] == TRIBO_SLIP_STUCK;
        }
    }
    return found;
}

static int gsl_step_apply(struct gsl_step *g, double t, const double *slope, double *to, double *error)
{
    if (g->kind->matrices && !memory_to_factorize(g)) {
        return gsl_step_out_of_memory(g->sys);
    }
    if (g->known && !is_regular(g)) {
        tribo_gsl_step_restart(g); /* which makes it ask for another Jacobian before it factorizes */
    }
    return gsl_odeiv2_step_apply(g->step, t, g->h, to, error, g->kind->takes_slope ? slope : NULL,
                                 g->kind->newton ? g->end : NULL, &g->guarded);
}

int tribo_gsl_step_try(struct gsl_step *g, double t, double h, const double *y, const double *slope, const double *tolerance,
                       const double *rate, double *to, double *error)
{
    fenv_t callers;
    memcpy(to, y, g->sys->odeiv2.dimension * sizeof *to);
    g->h = h;
    g->tolerance = tolerance;
    g->rate = rate;
    feholdexcept(&callers);
    const int status = gsl_step_apply(g, t, slope, to, error);
    if (!status && g->kind->newton) {
        /* Half steps see nothing of a force that jumps before or after all of their stages, nor of a contact that breaks away after them;
         * slopes at both ends do. */
        const int jumps = has_stuck(g);
        for (size_t i = 0; jumps && i < g->sys->odeiv2.dimension; i++) {
            error[i] = fabs(error[i]) + fabs(0.5 * g->h * (slope[i] + g->end[i]) - (to[i] - y[i]));
        }
    }
    fesetenv(&callers);
    return status;
}

double tribo_gsl_step_order(const struct gsl_step *g)
{
    return (double)gsl_odeiv2_step_order(g->step);
}

/* ---------------------------------------------------------------------------------------------------------------- kinds */

#define ROOT_3 1.7320508075688772935
static const double halves[] = {1.0, 0.5}, middle[] = {0.5, 0.25};
static const double gauss[] = {0.25, 0.25 - ROOT_3 / 6, 0.25 + ROOT_3 / 6, 0.25};
static const double sequence[] = {1.0 / 2, 1.0 / 6, 1.0 / 10, 1.0 / 14, 1.0 / 22, 1.0 / 34, 1.0 / 50, 1.0 / 70};
static const double bdf[] = {1.0, 2.0 / 3, 6.0 / 11, 12.0 / 25, 60.0 / 137};

#define EXPLICIT(id, stable) const struct gsl_step_kind tribo_kind_##id = {&gsl_odeiv2_step_##id, stable, 1, 0, 0, NULL, 1, NULL};
#define IMPLICIT(id, stable, slope, newton, c, stages, a)                                                                        \
    const struct gsl_step_kind tribo_kind_##id = {&gsl_odeiv2_step_##id, stable, slope,  newton,                                 \
                                                  sizeof c / sizeof *c,  c,      stages, a};

EXPLICIT(rk2, 2.5)
EXPLICIT(rk4, 5.5)
EXPLICIT(rkf45, 3.6)
EXPLICIT(rkck, 3.7)
EXPLICIT(rk8pd, 5.1)
EXPLICIT(msadams, 0.5)
IMPLICIT(rk1imp, HUGE_VAL, 1, 1, halves, 1, NULL)
IMPLICIT(rk2imp, HUGE_VAL, 1, 1, middle, 1, NULL)
IMPLICIT(rk4imp, HUGE_VAL, 1, 1, halves, 2, gauss)
IMPLICIT(bsimp, 0.1, 1, 0, sequence, 1, NULL)
IMPLICIT(msbdf, HUGE_VAL, 0, 0, bdf, 1, NULL)
