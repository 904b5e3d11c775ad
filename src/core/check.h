/* Checks of arguments that cost nothing to speak of where all is well; check.c has the words for where it is not. */
#ifndef TRIBO_CHECK_H
#define TRIBO_CHECK_H

#include <float.h>
#include <math.h>

#include "context.h"

static inline int tribo_within(double x, double most)
{
    return isfinite(x) && fabs(x) <= most;
}

static inline int tribo_all_finite(const double *x, size_t n)
{
    return n == 1 ? isfinite(*x) : tribo_all_within(x, n, DBL_MAX);
}

/* The same of numbers that are TRIBO_PLAIN at most. */
static inline int tribo_all_plain(const double *x, size_t n)
{
    return n == 1 ? tribo_within(*x, TRIBO_PLAIN) : tribo_all_within(x, n, TRIBO_PLAIN);
}

/* 1 if all of v is finite, and 2 if all of y is so small; neither is NULL. */
static inline int tribo_motion_within(const double *v, const double *y, double most, size_t n)
{
    return n == 1 ? (isfinite(*v) ? 1 : 0) | (tribo_within(*y, most) ? 2 : 0) : tribo_two_within(v, DBL_MAX, y, most, n);
}

/* TRIBO_OK, or a failure that names the argument, the first offending contact and its value; ctx NULL: that keeps no message. */
static inline int tribo_check_finite(tribo_context *ctx, const char *name, const double *x, size_t n)
{
    return x && tribo_all_finite(x, n) ? TRIBO_OK : tribo_fail_not_finite(ctx, name, x, n);
}

static inline int tribo_has_operator(const tribo_context *ctx)
{
    return ctx->op->diagonal || !ctx->n;
}

static inline int tribo_has_epsilon(const tribo_context *ctx)
{
    return ctx->set.step > 0.0 ? tribo_has_operator(ctx) : 1;
}

/* TRIBO_OK, or a failure that names the call that is missing. */
static inline int tribo_need_operator(tribo_context *ctx)
{
    return tribo_has_operator(ctx) ? TRIBO_OK : tribo_fail_without_operator(ctx);
}

/* The arguments of a step. */
static inline int tribo_check_step(tribo_context *ctx, double dt, const double *vfree, const double *f)
{
    if (!isfinite(dt)) {
        return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "dt = %g is not finite", dt);
    }
    if (dt <= 0.0) {
        return tribo_fail(ctx, TRIBO_ERR_NOT_POSITIVE, "dt = %g is not positive", dt);
    }
    int status = tribo_need_operator(ctx);
    status = status ? status : tribo_check_finite(ctx, "vfree", vfree, ctx->n);
    if (status) {
        return status;
    }
    return !f && ctx->n ? tribo_fail(ctx, TRIBO_ERR_NULL, "f is NULL") : TRIBO_OK;
}

#endif
