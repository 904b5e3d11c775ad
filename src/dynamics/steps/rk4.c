/* SPDX-License-Identifier: BSD-3-Clause */
/* Method "rk4/fixed": the classical Runge-Kutta method in steps of a fixed size, four evaluations a step. (GSL's takes twelve: it
 * doubles each step to estimate its error.) */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "blockwise.h"
#include "common/simd.h"
#include "fixed_steps.h"
#include "numerics/linalg.h"

enum { STAGES = 4 };

struct rk4 {
    struct blockwise alone;
    double *memory;            /* of the arrays, which begin on a line of the cache: 0.89 of the time of 32 bodies */
    double *k;                 /* [ndof] accelerations of the last evaluation: with the velocities, the slope */
    double *sum;               /* [ndof] weighted sum of accelerations */
    double *stage[STAGES - 1]; /* [2 ndof] states of the second evaluation and the following */
    double time;               /* of the last evaluation */
    int blockwise;             /* 1: evaluations go block by block */
};

static void rk4_destroy(tribo_driver *drv)
{
    struct rk4 *r = drv->own;
    if (r) {
        tribo_blockwise_free(&r->alone);
        free(r->memory);
        free(r);
    }
}

static int rk4_create(tribo_driver *drv)
{
    const size_t n = drv->sys->ndof;
    struct rk4 *r = calloc(1, sizeof *r);
    drv->own = r;
    if (!r || !(r->memory = malloc((8 * n + TRIBO_LINE) * sizeof *r->memory)) || !tribo_blockwise_create(&r->alone, drv->sys)) {
        return tribo_error(drv->sys->message, TRIBO_ERR_MEMORY, "out of memory for method rk4/fixed");
    }
    r->k = tribo_aligned(r->memory);
    r->sum = r->k + n;
    for (size_t s = 0; s < STAGES - 1; s++) {
        r->stage[s] = r->sum + n + s * 2 * n;
    }
    r->alone.revision = SIZE_MAX;
    return TRIBO_OK;
}

/* The next state from q and u, by velocities v and accelerations a of the one before. The sum begins with a at the first
 * state. */
TRIBO_SIMD static void next_stage(size_t n, double h, int first, const double *restrict from, const double *v,
                                  const double *restrict a, double *restrict sum, double *restrict to)
{
    const double *restrict u = from + n;
    double *restrict to_u = to + n;
    for (size_t i = 0; i < n; i++) {
        to[i] = from[i] + h * v[i];
        to_u[i] = u[i] + h * a[i];
        sum[i] = first ? a[i] : sum[i] + 2.0 * a[i];
    }
}

/* The end of the step: h is a sixth of it, v[k] are the velocities of the states between, a the last accelerations. */
TRIBO_SIMD static void last_stage(size_t n, double h, const double *restrict from, double *const *stage, const double *restrict a,
                                  const double *restrict sum, double *restrict to)
{
    const double *restrict u = from + n, *restrict v_1 = stage[0] + n, *restrict v_2 = stage[1] + n, *restrict v_3 = stage[2] + n;
    double *restrict to_u = to + n;
    for (size_t i = 0; i < n; i++) {
        to[i] = from[i] + h * (((u[i] + 2.0 * v_1[i]) + 2.0 * v_2[i]) + v_3[i]);
        to_u[i] = u[i] + h * (sum[i] + a[i]);
    }
}

/* A step of h to y, block by block or not. Returns a status; the message is that of the system if an evaluation failed. */
static int take_step(tribo_driver *drv, double t, double h, const double *from, double *y, int blockwise)
{
    struct rk4 *r = drv->own;
    tribo_system *sys = drv->sys;
    const size_t n = sys->ndof;
    const double part[STAGES] = {0.0, 0.5, 0.5, 1.0};
    double power[STAGES];
    for (size_t s = 0; s < STAGES; s++) {
        const double *at = s ? r->stage[s - 1] : from;
        r->time = t + part[s] * h;
        if (blockwise) {
            tribo_blockwise_rates(&r->alone, sys, r->time, at, r->k, &power[s]);
        } else if (tribo_system_rates(sys, r->time, at, s == 0, r->k, &power[s])) {
            return tribo_driver_explain(drv, t, h);
        }
        if (s + 1 < STAGES) {
            next_stage(n, part[s + 1] * h, s == 0, from, at + n, r->k, r->sum, r->stage[s]);
        } else {
            last_stage(n, h / 6.0, from, r->stage, r->k, r->sum, y);
        }
    }
    y[2 * n] = from[2 * n] + h / 6.0 * (((power[0] + 2.0 * power[1]) + 2.0 * power[2]) + power[3]);
    return tribo_driver_check(drv, y);
}

/* Evaluates the contacts at the last evaluation of a step that went block by block, for queries of the system. */
static int tell_contacts(tribo_driver *drv, double t, double h)
{
    struct rk4 *r = drv->own;
    const size_t evaluations = drv->sys->evaluations;
    double power;
    const int status = r->blockwise ? tribo_system_rates(drv->sys, r->time, r->stage[STAGES - 2], 0, r->k, &power) : TRIBO_OK;
    drv->sys->evaluations = evaluations;
    return status ? tribo_driver_explain(drv, t, h) : TRIBO_OK;
}

static int rk4_step(tribo_driver *drv, double t, double next, const double *from, double *y)
{
    struct rk4 *r = drv->own;
    const double h = next - t;
    r->blockwise = r->alone.fits && r->alone.revision == tribo_system_revision(drv->sys); /* an observer may change that */
    /* the system says what is wrong with a motion that is not finite */
    const int done = r->blockwise && take_step(drv, t, h, from, y, 1) == TRIBO_OK;
    const int status = done ? TRIBO_OK : take_step(drv, t, h, from, y, 0);
    return status || !drv->seen ? status : tell_contacts(drv, t, h);
}

static int rk4_advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    struct rk4 *r = drv->own;
    (void)continues;
    if (r->alone.revision != tribo_system_revision(drv->sys)) {
        tribo_blockwise_take_law(&r->alone, drv->sys);
    }
    const int status = tribo_driver_fixed_steps(drv, t, t1, y, rk4_step, NULL);
    return status || drv->seen ? status : tell_contacts(drv, *t, drv->dt);
}

const struct method tribo_method_rk4_fixed = {
    .name = "rk4/fixed", .takes = TAKES_STEP | NEEDS_MASS, .create = rk4_create, .destroy = rk4_destroy, .advance = rk4_advance};
