/* Method "rk4/fixed": the classical Runge-Kutta method in steps of a fixed size. GSL's doubles each step for an estimate of its
 * error, which nobody asks for here, and takes twelve evaluations instead of four. */
#include <stdlib.h>
#include <string.h>

#include "driver.h"
#include "../common/simd.h"

struct rk4 {
    double *k, *sum, *stage; /* [dimension] slope, weighted sum of slopes, state of a stage */
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

TRIBO_SIMD static void add_stage(size_t n, const double *restrict y, double h, const double *restrict k, double weight,
                                 double *restrict sum, double *restrict stage)
{
    for (size_t j = 0; j < n; j++) {
        stage[j] = y[j] + h * k[j];
        sum[j] += weight * k[j];
    }
}

TRIBO_SIMD static void finish(size_t n, double h, const double *restrict k, const double *restrict sum, double *restrict y)
{
    for (size_t j = 0; j < n; j++) {
        y[j] += h * (sum[j] + k[j]);
    }
}

static int step(tribo_driver *drv, double t, double next, double *y)
{
    const double h = next - t, node[] = {0.5, 0.5, 1.0}, weight[] = {1.0, 2.0, 2.0};
    const struct rk4 *r = drv->own;
    const gsl_odeiv2_system *ode = &drv->sys->odeiv2;
    if (tribo_system_begin_step(drv->sys, t, y, r->k)) {
        return tribo_driver_explain(drv, t, h);
    }
    memset(r->sum, 0, ode->dimension * sizeof *r->sum);
    for (int i = 0; i < 3; i++) {
        add_stage(ode->dimension, y, node[i] * h, r->k, weight[i], r->sum, r->stage);
        if (ode->function(t + node[i] * h, r->stage, r->k, ode->params)) {
            return tribo_driver_explain(drv, t, h);
        }
    }
    finish(ode->dimension, h / 6.0, r->k, r->sum, y);
    return TRIBO_OK;
}

static int advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    (void)continues;
    return tribo_driver_fixed_steps(drv, t, t1, y, step);
}

const struct method tribo_method_rk4_fixed = {"rk4/fixed", WITHOUT_TOLERANCES, create, destroy, advance, NULL, NULL, NULL};
