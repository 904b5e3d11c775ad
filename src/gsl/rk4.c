/* Method "rk4/fixed": the classical Runge-Kutta method in steps of a fixed size. GSL's doubles each step for an estimate of its
 * error, which nobody asks for here, and takes twelve evaluations instead of four. */
#include <stdlib.h>
#include <string.h>

#include "driver.h"
#include "../common/simd.h"

struct rk4 {
    double *k, *sum, *stage; /* [dimension] slope, weighted sum of slopes, state of a stage; of the slope of q, which is the
                                velocity, k has no copy */
};

static void destroy(tribo_driver *drv)
{
    struct rk4 *r = drv->own;
    if (r) {
        free(r->k);
        free(r);
    }
}

static int create(tribo_driver *drv)
{
    const size_t n = tribo_system_dimension(drv->sys);
    struct rk4 *r = calloc(1, sizeof *r);
    drv->own = r;
    if (!r || !(r->k = malloc(3 * n * sizeof *r->k))) {
        return tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method rk4/fixed");
    }
    r->sum = r->k + n;
    r->stage = r->sum + n;
    return TRIBO_OK;
}

/* The first stage goes on from y by the slope k, with which the sum begins. */
TRIBO_SIMD static void first_stage(size_t n, const double *restrict y, double h, const double *restrict k, double *restrict sum,
                                   double *restrict stage)
{
    for (size_t j = 0; j < n; j++) {
        stage[j] = y[j] + h * k[j];
        sum[j] = k[j];
    }
}

TRIBO_SIMD static void next_stage(size_t n, const double *restrict y, double h, const double *restrict k, double *restrict sum,
                                  double *restrict stage)
{
    for (size_t j = 0; j < n; j++) {
        stage[j] = y[j] + h * k[j];
        sum[j] += 2.0 * k[j];
    }
}

TRIBO_SIMD static void finish(size_t n, double h, const double *restrict k, const double *restrict sum,
                              const double *restrict from, double *restrict y)
{
    for (size_t j = 0; j < n; j++) {
        y[j] = from[j] + h * (sum[j] + k[j]);
    }
}

/* Accelerations and power at a stage, into k behind the place of velocities. */
static int evaluate(tribo_driver *drv, double t, const double *y)
{
    const struct rk4 *r = drv->own;
    const size_t n = drv->sys->ndof;
    return tribo_system_rates(drv->sys, t, y, r->k + n, r->k + 2 * n);
}

static int step(tribo_driver *drv, double t, double next, const double *from, double *y)
{
    const struct rk4 *r = drv->own;
    const size_t n = drv->sys->ndof;
    const double h = next - t, node[] = {0.5 * h, 0.5 * h, h};
    if (tribo_system_begin_rates(drv->sys, t, from, r->k + n, r->k + 2 * n)) {
        return tribo_driver_explain(drv, t, h);
    }
    for (int i = 0; i < 3; i++) {
        /* positions first: their slope is the velocity of the stage that ends here */
        (i ? next_stage : first_stage)(n, from, node[i], i ? r->stage + n : from + n, r->sum, r->stage);
        (i ? next_stage : first_stage)(n + 1, from + n, node[i], r->k + n, r->sum + n, r->stage + n);
        if (evaluate(drv, t + node[i], r->stage)) {
            return tribo_driver_explain(drv, t, h);
        }
    }
    finish(n, h / 6.0, r->stage + n, r->sum, from, y);
    finish(n + 1, h / 6.0, r->k + n, r->sum + n, from + n, y + n);
    return tribo_driver_check(drv, y);
}

static int advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    (void)continues;
    return tribo_driver_fixed_steps(drv, t, t1, y, step);
}

const struct method tribo_method_rk4_fixed = {"rk4/fixed", WITHOUT_TOLERANCES, create, destroy, advance, NULL, NULL, NULL};
