/* Method "rk4/fixed": the classical Runge-Kutta method in steps of a fixed size. GSL's doubles each step for an estimate of its
 * error, which nobody asks for here, and takes twelve evaluations instead of four.
 *
 * From one evaluation follows the state of the next, or of the end, place by place: so where contacts share no body all is done
 * block by block. What neighbours pull at has to stay meanwhile: stages take turns in two places. */
#include <stdlib.h>

#include "driver.h"
#include "rates_alone.h"
#include "../common/simd.h"

struct rk4 {
    struct rates_alone alone;
    double *memory;
    double *k;              /* [ndof] or a block's: accelerations; of the slope of q, which is the velocity, there is no copy */
    double *sum, *stage[2]; /* [dimension] weighted sum of slopes, states of stages */
    double power[4];        /* of the stages: what friction dissipates */
    double time;            /* of the last stage */
    int blockwise;          /* the next step goes block by block */
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
    r->sum = r->k + n;
    r->stage[0] = r->sum + n;
    r->stage[1] = r->stage[0] + n;
    tribo_rates_prepare(&r->alone, drv->sys);
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

TRIBO_SIMD static void finish(size_t n, const double *restrict from, double h, const double *restrict k,
                              const double *restrict sum, double *restrict y)
{
    for (size_t j = 0; j < n; j++) {
        y[j] = from[j] + h * (sum[j] + k[j]);
    }
}

/* An evaluation of a step from `from`: at a time and a state, and the state to, that which follows a time h later by its
 * slopes. */
struct evaluation {
    int number; /* 0 to 3 */
    double t, h;
    const double *from, *at;
    double *to;
};

/* n numbers of the state from place i on, their slopes being k. */
static void proceed(const struct rk4 *r, const struct evaluation *e, size_t i, size_t n, const double *k)
{
    if (e->number == 0) {
        first_stage(n, e->from + i, e->h, k, r->sum + i, e->to + i);
    } else if (e->number < 3) {
        next_stage(n, e->from + i, e->h, k, r->sum + i, e->to + i);
    } else {
        finish(n, e->from + i, e->h, k, r->sum + i, e->to + i);
    }
}

/* Block by block; a status. */
static int evaluate_blocks(struct rk4 *r, tribo_system *sys, const struct evaluation *e)
{
    const size_t n = sys->ndof;
    double *power = &r->power[e->number];
    *power = 0.0;
    tribo_bodies_set_time(&r->alone.bodies, sys, e->t);
    for (size_t k = 0, i = 0; k < r->alone.blocks; k++, i += MATRIX_BLOCK) {
        const size_t count = tribo_bodies_of_block(sys, k);
        const int status = tribo_rates_block(&r->alone, sys, k, e->at, e->at + n, r->k, power);
        if (status) {
            return status;
        }
        proceed(r, e, i, count, e->at + n + i);
        proceed(r, e, n + i, count, r->k);
    }
    return TRIBO_OK;
}

/* All at once. */
static int evaluate_all(struct rk4 *r, tribo_system *sys, const struct evaluation *e)
{
    const size_t n = sys->ndof;
    const int status = (e->number ? tribo_system_rates : tribo_system_begin_rates)(sys, e->t, e->at, r->k, &r->power[e->number]);
    if (!status) {
        proceed(r, e, 0, n, e->at + n);
        proceed(r, e, n, n, r->k);
    }
    return status;
}

/* What cannot be done block by block can all at once, or tells why not. */
static int evaluate(struct rk4 *r, tribo_system *sys, const struct evaluation *e)
{
    if (r->blockwise && evaluate_blocks(r, sys, e) == TRIBO_OK) {
        sys->evaluations++;
        return TRIBO_OK;
    }
    return evaluate_all(r, sys, e);
}

/* The system's contacts are told of the last evaluation, for those who ask them. */
static int tell_contacts(tribo_driver *drv)
{
    struct rk4 *r = drv->own;
    tribo_system *sys = drv->sys;
    const size_t evaluations = sys->evaluations;
    const int status = r->blockwise ? tribo_system_rates(sys, r->time, r->stage[0], r->k, &r->power[3]) : TRIBO_OK;
    sys->evaluations = evaluations;
    return status;
}

static double energy_of(const struct rk4 *r, double h, double from)
{
    const double *p = r->power;
    return from + h / 6.0 * (((p[0] + 2.0 * p[1]) + 2.0 * p[2]) + p[3]);
}

static int step(tribo_driver *drv, double t, double next, const double *from, double *y)
{
    struct rk4 *r = drv->own;
    const double h = next - t;
    const struct evaluation all[] = {{0, t, 0.5 * h, from, from, r->stage[0]},
                                     {1, t + 0.5 * h, 0.5 * h, from, r->stage[0], r->stage[1]},
                                     {2, t + 0.5 * h, h, from, r->stage[1], r->stage[0]},
                                     {3, t + h, h / 6.0, from, r->stage[0], y}};
    int status = TRIBO_OK;
    if (drv->seen) {
        r->blockwise = tribo_rates_fit(&r->alone, drv->sys);
    }
    for (size_t i = 0; !status && i < sizeof all / sizeof *all; i++) {
        status = evaluate(r, drv->sys, &all[i]);
    }
    r->time = t + h;
    y[2 * drv->sys->ndof] = energy_of(r, h, from[2 * drv->sys->ndof]);
    if (status || (drv->seen && tell_contacts(drv))) {
        return tribo_driver_explain(drv, t, h);
    }
    return tribo_driver_check(drv, y);
}

/* So many steps are worth contacts for new settings. */
enum { MANY = 20 };

static int advance(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    static const struct fixed_method method = {step, NULL, 2, {0.5, 1.0}};
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

const struct method tribo_method_rk4_fixed = {"rk4/fixed", WITHOUT_TOLERANCES, create, destroy, advance, NULL, NULL, NULL};
