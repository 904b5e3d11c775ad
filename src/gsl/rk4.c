/* The classical Runge-Kutta method as a GSL step type without error estimate, so that a step of fixed size takes four
 * evaluations; GSL's own rk4 doubles the step to estimate an error and takes twelve. */
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "rk4.h"
#include "../simd.h"

struct state {
    double *k, *sum, *y; /* slope, weighted sum of slopes, state of a stage */
};

static void release(void *state)
{
    struct state *s = state;
    free(s->k);
    free(s);
}

static void *allocate(size_t dimension)
{
    struct state *s = malloc(sizeof *s);
    double *memory = malloc(3 * dimension * sizeof *memory);
    if (!s || !memory) {
        free(s);
        free(memory);
        return NULL;
    }
    s->k = memory;
    s->sum = memory + dimension;
    s->y = memory + 2 * dimension;
    return s;
}

TRIBO_SIMD static int apply(void *state, size_t dimension, double t, double h, double y[], double yerr[], const double dydt_in[],
                            double dydt_out[], const gsl_odeiv2_system *system)
{
    static const double node[] = {0.0, 0.5, 0.5, 1.0}, weight[] = {1.0, 2.0, 2.0, 1.0};
    const struct state *s = state;
    double *restrict k = s->k, *restrict sum = s->sum, *restrict stage = s->y;
    for (int i = 0; i < 4; i++) {
        int status = GSL_SUCCESS;
        if (i > 0) {
            for (size_t j = 0; j < dimension; j++) {
                stage[j] = y[j] + node[i] * h * k[j];
            }
            status = GSL_ODEIV_FN_EVAL(system, t + node[i] * h, stage, k);
        } else if (dydt_in) {
            memcpy(k, dydt_in, dimension * sizeof *k);
        } else {
            status = GSL_ODEIV_FN_EVAL(system, t, y, k);
        }
        if (status != GSL_SUCCESS) {
            return status;
        }
        for (size_t j = 0; j < dimension; j++) {
            sum[j] = (i ? sum[j] : 0.0) + weight[i] * k[j];
        }
    }
    for (size_t j = 0; j < dimension; j++) {
        y[j] += h / 6.0 * sum[j];
    }
    if (yerr) {
        memset(yerr, 0, dimension * sizeof *yerr);
    }
    return dydt_out ? GSL_ODEIV_FN_EVAL(system, t + h, y, dydt_out) : GSL_SUCCESS;
}

static int set_driver(void *state, const gsl_odeiv2_driver *driver)
{
    (void)state, (void)driver;
    return GSL_SUCCESS;
}

static int reset(void *state, size_t dimension)
{
    (void)state, (void)dimension;
    return GSL_SUCCESS;
}

static unsigned int order(void *state)
{
    (void)state;
    return 4;
}

static const gsl_odeiv2_step_type type = {"rk4/fixed", 1, 0, allocate, apply, set_driver, reset, order, release};

const gsl_odeiv2_step_type *tribo_step_rk4 = &type;
