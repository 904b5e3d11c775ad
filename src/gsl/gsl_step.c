/* SPDX-License-Identifier: BSD-3-Clause */
/* Systems as GSL sees them, and GSL's steppers as steppers of tribo_dynamics.h, by its public calls only. GSL's error handler
 * ends the program where memory ends or a matrix of an implicit step is singular, and GSL divides by zero where an estimate is
 * zero: each step is prepared so that none of that happens. */
#include "tribo/tribo_gsl.h"

#include "common/layout.h"
#include "common/text.h"
#include "common/real.h"

#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>

/* A pivot of at most this part of the sum of its terms' sizes counts as zero. */
#define LEAST_PIVOT 1e-13

/* Largest entry of a matrix: GSL multiplies by inverses of pivots, which lose all digits beyond. */
#define LARGEST_ENTRY 1e140

/* Implicit Runge-Kutta steps solve their equations to this part of the tolerance, which their estimates of the error leave
 * out. */
#define NEWTON 0.05

/* Changes within a step up to this part of the tolerance are set to 0 for Newton's method; of a tolerance above ROUNDING
 * times the state, this part of ROUNDING times the state. */
#define NEGLIGIBLE 1e-3
#define ROUNDING 1e-6

struct gsl_kind {
    const char *name;
    const gsl_odeiv2_step_type *const *type;
    double stable;   /* step times rate of a sticking contact above which no contact may change within a step; HUGE_VAL: none */
    int newton;      /* 1: an implicit Runge-Kutta method with GSL's Newton iteration */
    int keeps;       /* 1: steps reuse the Jacobian of earlier ones; else they begin with f(t, y), and an implicit one evaluates
                      * the Jacobian before it factorizes */
    size_t matrices; /* matrices I - h c[i] A x J that a step may factorize; 0: explicit */
    const double *c; /* [matrices] */
    size_t stages;   /* rows of A */
    const double *a; /* [stages][stages] A; NULL: 1 */
};

struct gsl_step {
    const struct gsl_kind *kind;
    tribo_system *sys;
    size_t dimension, ncontact;
    int status; /* of the last evaluation */
    gsl_odeiv2_step *step;
    gsl_odeiv2_system guarded;  /* the system with callbacks of this file */
    gsl_odeiv2_control control; /* gives GSL the tolerance, through driver */
    gsl_odeiv2_driver driver;
    const tribo_trial *trial; /* the step in progress */

    /* implicit kinds */
    double *jacobian;  /* [dimension][dimension] the last one, if known */
    double *matrix;    /* [stages dimension][stages dimension] workspace */
    size_t *order;     /* [stages dimension] workspace */
    int known;         /* 1: jacobian is set, and steps may reuse it */
    double *end;       /* [dimension] slope at the end, newton kinds */
    double *force;     /* [ncontact] workspace */
    signed char *mode; /* [2][ncontact] slip at the beginning of a step; workspace */
};

/* ------------------------------------------------------------------------------------------------------------- systems */

/* The status for GSL of an evaluation with this status of tribo: GSL_FAILURE if a shorter step may succeed. */
static int gsl_status(int status)
{
    return !status ? GSL_SUCCESS : status == TRIBO_ERR_NOT_FINITE ? GSL_FAILURE : GSL_EBADFUNC;
}

static int right_hand_side(double t, const double y[], double dydt[], void *params)
{
    return gsl_status(tribo_system_derivative(params, t, y, dydt));
}

static int jacobian(double t, const double y[], double *dfdy, double dfdt[], void *params)
{
    return gsl_status(tribo_system_jacobian(params, t, y, dfdy, dfdt));
}

const gsl_odeiv2_system *tribo_gsl_system(tribo_system *sys)
{
    static const char key;
    gsl_odeiv2_system *s = tribo_system_attached(sys, &key);
    if (s || !sys) {
        return s;
    }
    s = malloc(sizeof *s);
    if (s) {
        *s = (gsl_odeiv2_system){
            .function = right_hand_side, .jacobian = jacobian, .dimension = tribo_system_dimension(sys), .params = sys};
    }
    if (!s || tribo_system_attach(sys, &key, s, free)) {
        free(s);
        tribo_system_set_message(sys, TRIBO_ERR_MEMORY, "out of memory for GSL's view of the system");
        return NULL;
    }
    return s;
}

/* ------------------------------------------------------------------------------------------------------------- memory */

/* Bytes of a header of GSL's: of a vector, a permutation, a state. */
#define HEADER ((size_t)512)

/* 1 if malloc has blocks of bytes [count] at once. volatile: compilers leave out blocks that nothing reads. */
static int has_memory(const size_t *bytes, size_t count)
{
    void *volatile block = malloc(bytes[0]);
    const int enough = block && (count == 1 || has_memory(bytes + 1, count - 1));
    free(block);
    return enough;
}

/* Returns GSL_SUCCESS if there is memory for a factorization, which allocates a vector of integers. */
static int reserve_factor(struct gsl_step *g)
{
    const size_t bytes = 3 * HEADER + g->dimension * g->kind->stages * sizeof(size_t);
    if (has_memory(&bytes, 1)) {
        return GSL_SUCCESS;
    }
    g->status = tribo_system_set_message(g->sys, TRIBO_ERR_MEMORY, "out of memory for an implicit step");
    return GSL_EBADFUNC;
}

/* ---------------------------------------------------------------------------------------------------------- callbacks */

/* 1 if the force of a contact jumps between the beginning of the step and the last evaluation, and relaxes by more than `stable`
 * within the step, or has rate 0: it does not relax. Open contacts carry nothing, and nearly nothing just before they open and
 * after they close. */
static int passes_a_change(const struct gsl_step *g)
{
    const size_t n = g->ncontact;
    const double *rate = g->trial->rate, part = g->kind->stable;
    int found = 0;
    if (!tribo_system_get_slip(g->sys, g->mode + n)) {
        for (size_t i = 0; i < n; i++) {
            const signed char before = g->mode[i], after = g->mode[n + i];
            found |= before != after && before != TRIBO_SLIP_OPEN && after != TRIBO_SLIP_OPEN &&
                     (rate[i] * g->trial->h > part || rate[i] == 0.0);
        }
    }
    return found;
}

/* GSL factorizes after one of the next two functions, and allocates nothing in between: both end with a check of memory. */
static int guarded_function(double t, const double y[], double dydt[], void *params)
{
    struct gsl_step *g = params;
    g->status = tribo_system_derivative(g->sys, t, y, dydt);
    if (g->status || g->kind->matrices == 0) {
        return gsl_status(g->status);
    }
    if (g->kind->stable < HUGE_VAL && passes_a_change(g)) {
        return GSL_FAILURE;
    }
    if (g->kind->newton) {
        /* Slopes that change a value by less than NEGLIGIBLE of its tolerance are 0 for Newton's method: GSL's takes
         * rounding that does not decrease for divergence. */
        const size_t n = g->dimension / 2;
        const double h = g->trial->h, way = tribo_largest(y, n) + h * tribo_largest(y + n, n);
        tribo_system_get_force(g->sys, g->force);
        const double size[] = {way, way / h, fabs(y[2 * n]) + way * tribo_largest(g->force, g->ncontact)};
        for (size_t i = 0; i <= 2 * n; i++) {
            const double least = NEGLIGIBLE * lesser(g->trial->tolerance[i], ROUNDING * size[i / n]);
            dydt[i] = fabs(dydt[i]) * h < least ? 0.0 : dydt[i];
        }
    }
    return reserve_factor(g);
}

/* 1 if the factors of g->matrix [n][n], which is overwritten, have no pivot that may be rounding: each is compared with the sum
 * of the sizes of its terms, so that scales of rows and columns do not matter. */
static int has_sure_pivots(struct gsl_step *g, size_t n)
{
    double *a = g->matrix;
    gsl_matrix_view view = gsl_matrix_view_array(a, n, n);
    gsl_permutation order = {n, g->order};
    int sign, sure = 1;
    gsl_linalg_LU_decomp(&view.matrix, &order, &sign);
    for (size_t k = 0; k < n; k++) {
        const double size = fabs(a[k * n + k]);
        double sum = size;
        for (size_t j = 0; j < k; j++) {
            sum += fabs(a[k * n + j] * a[j * n + k]);
        }
        sure &= size > LEAST_PIVOT * sum && isfinite(sum);
    }
    return sure;
}

/* Returns 1 if all matrices I - c h A x J of a step are regular. Call reserve_factor before. msbdf has a matrix for each order;
 * within a step its order does not grow, so that matrices of higher orders are not checked. */
static int is_regular(struct gsl_step *g)
{
    const size_t n = g->dimension, stages = g->kind->stages, size = n * stages;
    const size_t order = gsl_odeiv2_step_order(g->step);
    const size_t count = g->kind->keeps && order < g->kind->matrices ? order : g->kind->matrices;
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < stages * stages; k++) { /* blocks of matrix = I - c h A x J */
            const double factor = -g->kind->c[i] * g->trial->h * (g->kind->a ? g->kind->a[k] : 1.0);
            double *to = g->matrix + k / stages * n * size + k % stages * n;
            for (size_t row = 0; row < n; row++) {
                for (size_t column = 0; column < n; column++) {
                    to[row * size + column] = factor * g->jacobian[row * n + column];
                }
                to[row * (size + 1)] += k % (stages + 1) == 0 ? 1.0 : 0.0;
            }
        }
        if (!(tribo_largest(g->matrix, size * size) <= LARGEST_ENTRY) || !has_sure_pivots(g, size)) {
            return 0;
        }
    }
    return 1;
}

/* For a singular matrix returns GSL_FAILURE, for which GSL fails the step: a shorter one has other matrices. */
static int guarded_jacobian(double t, const double y[], double *dfdy, double dfdt[], void *params)
{
    struct gsl_step *g = params;
    const size_t n = g->dimension;
    double sum = 0.0;
    g->status = tribo_system_jacobian(g->sys, t, y, dfdy, dfdt);
    if (g->status) {
        return gsl_status(g->status);
    }
    for (size_t i = 0; i < n; i++) {
        sum += dfdt[i] - dfdt[i];
    }
    tribo_system_get_slip(g->sys, g->mode);
    memcpy(g->jacobian, dfdy, n * n * sizeof *dfdy);
    g->known = g->kind->keeps;
    const int status = reserve_factor(g);
    return status ? status : sum != 0.0 || !is_regular(g) ? GSL_FAILURE : GSL_SUCCESS;
}

static int tell_tolerance(void *state, const double y, const double dydt, const double h, const size_t i, double *level)
{
    const struct gsl_step *g = state;
    (void)y, (void)dydt, (void)h;
    *level = (g->kind->newton ? NEWTON : 1.0) * g->trial->tolerance[i];
    return GSL_SUCCESS;
}

/* ------------------------------------------------------------------------------------------------------------- steppers */

static void gsl_step_destroy(void *data)
{
    struct gsl_step *g = data;
    gsl_odeiv2_step_free(g->step);
    free(g);
}

/* NULL if out of memory. */
static struct gsl_step *gsl_step_create(const struct gsl_kind *kind, tribo_system *sys)
{
    static const gsl_odeiv2_control_type tolerance = {.name = "tribo", .errlevel = tell_tolerance};
    const size_t n = tribo_system_dimension(sys), c = tribo_system_ncontact(sys), size = kind->matrices ? n * kind->stages : 0;
    struct gsl_step *g, first = {.kind = kind, .sys = sys, .dimension = n, .ncontact = c};
    void *const memory = ALLOCATE(ARRAY(g, 1), ARRAY(first.jacobian, size ? n * n : 0), ARRAY(first.matrix, size * size),
                                  ARRAY(first.order, size), ARRAY(first.end, n), ARRAY(first.force, c), ARRAY(first.mode, 2 * c));
    /* memory of GSL's own: headers, vectors, histories of up to 13 vectors, and matrices */
    const size_t length = n * kind->stages, vector = HEADER + length * sizeof(double);
    const size_t bytes[] = {24 * HEADER, 40 * vector, 48 * vector, 3 * length * vector};
    if (!memory || length > SIZE_MAX / sizeof(double) / (100 + 3 * length) || !has_memory(bytes, kind->matrices ? 4 : 3)) {
        free(memory);
        return NULL;
    }
    *g = first;
    g->guarded = (gsl_odeiv2_system){.function = guarded_function, .jacobian = guarded_jacobian, .dimension = n, .params = g};
    g->control = (gsl_odeiv2_control){.type = &tolerance, .state = g};
    g->driver.c = &g->control;
    g->step = gsl_odeiv2_step_alloc(*kind->type, n);
    gsl_odeiv2_step_set_driver(g->step, &g->driver);
    return g;
}

static void gsl_step_restart(void *data)
{
    struct gsl_step *g = data;
    gsl_odeiv2_step_reset(g->step);
    g->known = 0;
}

static int gsl_step_try(const tribo_trial *x, void *data)
{
    struct gsl_step *g = data;
    fenv_t callers;
    int status = GSL_SUCCESS;
    memcpy(x->to, x->y, g->dimension * sizeof *x->to);
    g->trial = x;
    g->status = TRIBO_OK;
    feholdexcept(&callers);
    if (g->kind->matrices) {
        status = reserve_factor(g);
        if (!status && g->known && !is_regular(g)) {
            gsl_step_restart(g); /* after a restart GSL calls guarded_jacobian before it factorizes */
        }
    }
    if (!status) {
        status = gsl_odeiv2_step_apply(g->step, x->t, x->h, x->to, x->error, g->kind->keeps ? NULL : x->slope,
                                       g->kind->newton ? g->end : NULL, &g->guarded);
    }
    if (!status && g->kind->newton) {
        /* The estimate by half steps misses a force that jumps before or after all stages, and a contact that breaks away
         * after them: adds the difference to the trapezoidal rule by slopes at both ends. */
        const signed char *before = g->mode, *after = g->mode + g->ncontact;
        const int evaluated = !tribo_system_get_slip(g->sys, g->mode + g->ncontact);
        int jumps = 0;
        for (size_t i = 0; evaluated && i < g->ncontact; i++) {
            jumps |= before[i] != after[i] || before[i] == TRIBO_SLIP_STUCK;
        }
        for (size_t i = 0; jumps && i < g->dimension; i++) {
            x->error[i] = fabs(x->error[i]) + fabs(0.5 * x->h * (x->slope[i] + g->end[i]) - (x->to[i] - x->y[i]));
        }
    }
    fesetenv(&callers);
    return !status ? TRIBO_OK : g->status ? g->status : TRIBO_ERR_STEP;
}

static double gsl_step_order(void *data)
{
    const struct gsl_step *g = data;
    return (double)gsl_odeiv2_step_order(g->step);
}

/* ---------------------------------------------------------------------------------------------------------------- kinds */

#define ROOT_3 1.7320508075688772935
static const double halves[2] = {1.0, 0.5}, middle[2] = {0.5, 0.25};
static const double gauss[4] = {0.25, 0.25 - ROOT_3 / 6, 0.25 + ROOT_3 / 6, 0.25};
static const double sequence[8] = {1.0 / 2, 1.0 / 6, 1.0 / 10, 1.0 / 14, 1.0 / 22, 1.0 / 34, 1.0 / 50, 1.0 / 70};
static const double bdf[5] = {1.0, 2.0 / 3, 6.0 / 11, 12.0 / 25, 60.0 / 137};

static const struct gsl_kind kinds[] = {
    {"rk2", &gsl_odeiv2_step_rk2, .stable = 2.5, .stages = 1},
    {"rk4", &gsl_odeiv2_step_rk4, .stable = 5.5, .stages = 1},
    {"rkf45", &gsl_odeiv2_step_rkf45, .stable = 3.6, .stages = 1},
    {"rkck", &gsl_odeiv2_step_rkck, .stable = 3.7, .stages = 1},
    {"rk8pd", &gsl_odeiv2_step_rk8pd, .stable = 5.1, .stages = 1},
    {"rk1imp", &gsl_odeiv2_step_rk1imp, HUGE_VAL, 1, 0, 2, halves, 1, NULL},
    {"rk2imp", &gsl_odeiv2_step_rk2imp, HUGE_VAL, 1, 0, 2, middle, 1, NULL},
    {"rk4imp", &gsl_odeiv2_step_rk4imp, HUGE_VAL, 1, 0, 2, halves, 2, gauss},
    {"bsimp", &gsl_odeiv2_step_bsimp, 0.1, 0, 0, 8, sequence, 1, NULL},
    {"msadams", &gsl_odeiv2_step_msadams, .stable = 0.5, .stages = 1},
    {"msbdf", &gsl_odeiv2_step_msbdf, HUGE_VAL, 0, 1, 5, bdf, 1, NULL},
};

int tribo_gsl_stepper_count(void)
{
    return (int)(sizeof kinds / sizeof *kinds);
}

const char *tribo_gsl_stepper_name(int stepper)
{
    return stepper >= 0 && stepper < tribo_gsl_stepper_count() ? kinds[stepper].name : NULL;
}

int tribo_gsl_driver_create(tribo_driver **drv, tribo_system *sys, const char *stepper)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    if (!drv || !stepper) {
        return tribo_system_set_message(sys, TRIBO_ERR_NULL, drv ? "stepper is NULL" : "drv is NULL");
    }
    const struct gsl_kind *kind = kinds, *const end = kinds + tribo_gsl_stepper_count();
    while (kind < end && !tribo_same_name(kind->name, stepper)) {
        kind++;
    }
    if (kind == end) {
        char text[200];
        int used = snprintf(text, sizeof text, "stepper \"%.20s\" is unknown; GSL has ", stepper);
        for (kind = kinds; kind < end; kind++) {
            used += snprintf(text + used, sizeof text - (size_t)used, "%s%s", kind > kinds ? ", " : "", kind->name);
        }
        return tribo_system_set_message(sys, TRIBO_ERR_NAME, text);
    }
    struct gsl_step *g = gsl_step_create(kind, sys);
    const tribo_stepper table = {.size = sizeof table,
                                 .name = kind->name,
                                 .stable = kind->matrices ? 0.0 : kind->stable,
                                 .takes_slope = !kind->keeps,
                                 .step = gsl_step_try,
                                 .order = gsl_step_order,
                                 .restart = gsl_step_restart,
                                 .destroy = gsl_step_destroy};
    const int status = g ? tribo_driver_create_stepper(drv, sys, &table, g)
                         : tribo_system_set_message(sys, TRIBO_ERR_MEMORY, "out of memory for a stepper of GSL");
    if (g && status) {
        gsl_step_destroy(g);
    }
    return status;
}
