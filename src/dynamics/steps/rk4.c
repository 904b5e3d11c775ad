/* Method "rk4/fixed": the classical Runge-Kutta method in steps of a fixed size. GSL's doubles each step for an estimate of its
 * error, which nobody asks for here, and takes twelve evaluations instead of four.
 *
 * From one evaluation follows the state of the next, or of the end, place by place. Where contacts share no body all is done
 * block by block, and an evaluation follows the one before as closely as can be, as soon as this has left behind what pulls at a
 * block: what is written is read again while it is near. */
#include <math.h>
#include <stdlib.h>

#include "dynamics/driver.h"
#include "numerics/linalg.h"
#include "rates_alone.h"
#include "common/simd.h"

enum { STAGES = 4 };

struct rk4 {
    struct rates_alone alone;
    double *memory;
    double *k;   /* [ndof] or a block's: accelerations; of the slope of q, which is the velocity, there is no copy */
    double *sum; /* [ndof] weighted sum of accelerations */
    double *stage[STAGES - 1]; /* [2 ndof] states of the second evaluation and the following */
    double power[STAGES];      /* what friction dissipates */
    double time;               /* of the last evaluation */
    int blockwise;             /* the next step goes block by block */
};

static void destroy(tribo_driver *drv)
{
    struct rk4 *r = drv->own;
    if (r) {
        tribo_rates_free(&r->alone);
        free(r->memory);
        free(r);
    }
}

static int create(tribo_driver *drv)
{
    const size_t n = tribo_system_dimension(drv->sys);
    struct rk4 *r = calloc(1, sizeof *r);
    drv->own = r;
    if (!r || !(r->memory = malloc((4 * n + TRIBO_LINE) * sizeof *r->memory)) || !tribo_rates_create(&r->alone, drv->sys)) {
        return tribo_system_fail(drv->sys, TRIBO_ERR_MEMORY, "out of memory for method rk4/fixed");
    }
    r->k = tribo_aligned(r->memory);
    r->sum = r->k + drv->sys->ndof;
    for (size_t s = 0; s < STAGES - 1; s++) {
        r->stage[s] = r->sum + drv->sys->ndof + s * 2 * drv->sys->ndof;
    }
    tribo_rates_prepare(&r->alone, drv->sys);
    return TRIBO_OK;
}

/* From q and u the second state, by the accelerations a, with which the sum begins. */
TRIBO_SIMD static void first_stage(size_t n, double h, const double *restrict q, const double *restrict u,
                                   const double *restrict a, double *restrict sum, double *restrict to_q, double *restrict to_u)
{
    for (size_t i = 0; i < n; i++) {
        to_q[i] = q[i] + h * u[i];
        to_u[i] = u[i] + h * a[i];
        sum[i] = a[i];
    }
}

/* From q and u the third or fourth, by the velocities v and accelerations of the last one. */
TRIBO_SIMD static void next_stage(size_t n, double h, const double *restrict q, const double *restrict u,
                                  const double *restrict v, const double *restrict a, double *restrict sum, double *restrict to_q,
                                  double *restrict to_u)
{
    for (size_t i = 0; i < n; i++) {
        to_q[i] = q[i] + h * v[i];
        to_u[i] = u[i] + h * a[i];
        sum[i] += 2.0 * a[i];
    }
}

/* The end of the step, v_1 to v_3 being the velocities of the states between, and a the accelerations of the last one. */
TRIBO_SIMD static void rk4_finish(size_t n, double h, const double *restrict q, const double *restrict u,
                                  const double *restrict v_1, const double *restrict v_2, const double *restrict v_3,
                                  const double *restrict sum, const double *restrict a, double *restrict to_q,
                                  double *restrict to_u)
{
    for (size_t i = 0; i < n; i++) {
        to_q[i] = q[i] + h * (((u[i] + 2.0 * v_1[i]) + 2.0 * v_2[i]) + v_3[i]);
        to_u[i] = u[i] + h * (sum[i] + a[i]);
    }
}

/* An evaluation of a step from `from`: at a time, which has a number, and a state, and the state to, that which follows a time h
 * later by its slopes. */
struct evaluation {
    size_t number, time;
    double t, h;
    const double *from, *at;
    double *to;
};

/* n degrees of freedom from i on, their accelerations being a. */
static void rk4_proceed(const struct rk4 *r, size_t ndof, const struct evaluation *e, size_t i, size_t n, const double *a)
{
    const double *q = e->from + i, *u = q + ndof, *v = e->at + ndof + i;
    double *sum = r->sum + i, *to_q = e->to + i, *to_u = to_q + ndof;
    if (e->number == 0) {
        first_stage(n, e->h, q, u, a, sum, to_q, to_u);
    } else if (e->number < STAGES - 1) {
        next_stage(n, e->h, q, u, v, a, sum, to_q, to_u);
    } else {
        rk4_finish(n, e->h, q, u, r->stage[0] + ndof + i, r->stage[1] + ndof + i, v, sum, a, to_q, to_u);
    }
}

/* Evaluation e of block k; returns whether what it writes is finite, of the last one. */
static int evaluate_block(struct rk4 *r, const tribo_system *sys, const struct evaluation *e, size_t k)
{
    const size_t ndof = sys->ndof, i = k * MATRIX_BLOCK, n = tribo_bodies_of_block(sys, k);
    r->power[e->number] += tribo_rates_block(&r->alone, sys, e->time, k, e->at, e->at + ndof, r->k);
    rk4_proceed(r, ndof, e, i, n, r->k);
    return e->number < STAGES - 1 || (tribo_dense_finite(e->to + i, n) && tribo_dense_finite(e->to + ndof + i, n));
}

/* All evaluations. Each goes `lag` blocks behind the one before, which by then has written all that pulls at the block.
 * What is not finite on the way is not so at the end: returns whether all is finite there. */
static int evaluate_blocks(struct rk4 *r, tribo_system *sys, const struct evaluation *all)
{
    const size_t blocks = r->alone.blocks, lag = r->alone.reach;
    int finite = 1;
    for (size_t s = 0; s < STAGES; s++) {
        r->power[s] = 0.0;
        if (s == 0 || all[s].time != all[s - 1].time) {
            tribo_rates_set_time(&r->alone, sys, all[s].time, all[s].t);
        }
    }
    for (size_t front = 0; finite && front < blocks + (STAGES - 1) * lag; front++) {
        for (size_t s = 0; s < STAGES && s * lag <= front; s++) {
            const size_t k = front - s * lag;
            finite &= k >= blocks || evaluate_block(r, sys, &all[s], k);
        }
    }
    sys->evaluations += STAGES;
    return finite;
}

/* Each evaluation for all degrees of freedom at once; a status. */
static int evaluate_all(struct rk4 *r, tribo_system *sys, const struct evaluation *all)
{
    int status = TRIBO_OK;
    for (size_t s = 0; !status && s < STAGES; s++) {
        const struct evaluation *e = &all[s];
        status = (s ? tribo_system_rates : tribo_system_begin_rates)(sys, e->t, e->at, r->k, &r->power[s]);
        rk4_proceed(r, sys->ndof, e, 0, status ? 0 : sys->ndof, r->k);
    }
    return status;
}

/* The system's contacts are told of the last evaluation, for those who ask them. */
static int tell_contacts(tribo_driver *drv)
{
    struct rk4 *r = drv->own;
    tribo_system *sys = drv->sys;
    const size_t evaluations = sys->evaluations;
    const int status =
        r->blockwise ? tribo_system_rates(sys, r->time, r->stage[STAGES - 2], r->k, &r->power[STAGES - 1]) : TRIBO_OK;
    sys->evaluations = evaluations;
    return status;
}

static double energy_of(const struct rk4 *r, double h, double from)
{
    const double *p = r->power;
    return from + h / 6.0 * (((p[0] + 2.0 * p[1]) + 2.0 * p[2]) + p[3]);
}

/* What cannot be done block by block can all at once, or tells why not. */
static int rk4_evaluate(tribo_driver *drv, const struct evaluation *all, double h, const double *from, double *y)
{
    struct rk4 *r = drv->own;
    const size_t place = 2 * drv->sys->ndof;
    if (r->blockwise && evaluate_blocks(r, drv->sys, all)) {
        y[place] = energy_of(r, h, from[place]);
        if (isfinite(y[place])) {
            return TRIBO_OK;
        }
    }
    const int status = evaluate_all(r, drv->sys, all);
    y[place] = energy_of(r, h, from[place]);
    return status ? tribo_driver_explain(drv, all[0].t, h) : tribo_driver_check(drv, y);
}

static int step(tribo_driver *drv, double t, double next, const double *from, double *y)
{
    struct rk4 *r = drv->own;
    const double h = next - t;
    const struct evaluation all[STAGES] = {{0, 0, t, 0.5 * h, from, from, r->stage[0]},
                                           {1, 1, t + 0.5 * h, 0.5 * h, from, r->stage[0], r->stage[1]},
                                           {2, 1, t + 0.5 * h, h, from, r->stage[1], r->stage[2]},
                                           {3, 2, t + h, h / 6.0, from, r->stage[2], y}};
    if (drv->seen) {
        r->blockwise = tribo_rates_fit(&r->alone, drv->sys);
    }
    r->time = t + h;
    const int status = rk4_evaluate(drv, all, h, from, y);
    if (!status && drv->seen && tell_contacts(drv)) {
        return tribo_driver_explain(drv, t, h);
    }
    return status;
}

/* An advance of more than this many steps is worth taking new settings. */
enum { MANY = 20 };

static int advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    static const struct fixed_method method = {step, NULL};
    struct rk4 *r = drv->own;
    (void)continues;
    if (t1 - *t > MANY * drv->dt && !tribo_rates_fit(&r->alone, drv->sys)) {
        tribo_rates_prepare(&r->alone, drv->sys);
    }
    r->blockwise = tribo_rates_fit(&r->alone, drv->sys);
    const int status = tribo_driver_fixed_steps(drv, t, t1, y, &method);
    if (!status && !drv->seen && tell_contacts(drv)) {
        return tribo_driver_explain(drv, *t, drv->dt);
    }
    return status;
}

const struct method tribo_method_rk4_fixed = {"rk4/fixed", TAKES_STEP, create, destroy, advance, NULL, NULL, NULL};
