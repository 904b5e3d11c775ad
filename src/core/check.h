/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks of arguments. The functions here are inline, and cost next to nothing where all is well; check.c finds the message. A
 * check returns TRIBO_OK, or a failure that names the argument, its first wrong entry and the value; ctx NULL: keeps no
 * message. */
#ifndef TRIBO_CHECK_H
#define TRIBO_CHECK_H

#include <float.h>
#include <math.h>

#include "context.h"

/* |x| as an integer: larger for larger |x|; infinity and NaN are above all numbers. */
static inline int64_t tribo_size_of(const double *x)
{
    int64_t bits;
    memcpy(&bits, x, sizeof bits);
    return bits & INT64_MAX;
}

/* 1 if all |x_i| <= most, which is finite. Raises no floating-point exception, whatever x is. */
int tribo_all_within(const double *x, size_t n, double most);

/* 1 if all x_i are finite and have no sign. */
int tribo_all_unsigned(const double *x, size_t n);

/* Checks that all x_i are finite, and within range; n = TRIBO_NUMBER: x is one number, of which the message has no index. */
enum { FINITE, NONNEGATIVE, POSITIVE };
#define TRIBO_NUMBER SIZE_MAX
int tribo_check_slowly(tribo_context *ctx, const char *name, const double *x, size_t n, int range);

static inline int tribo_within(double x, double most)
{
    return isfinite(x) && fabs(x) <= most;
}

/* 1 if x is no NULL, and all |x_i| <= most. */
static inline int tribo_is_within(const double *x, size_t n, double most)
{
    return x && (n == 1 ? tribo_within(*x, most) : tribo_all_within(x, n, most));
}

static inline int tribo_check_finite(tribo_context *ctx, const char *name, const double *x, size_t n)
{
    return tribo_is_within(x, n, DBL_MAX) ? TRIBO_OK : tribo_check_slowly(ctx, name, x, n, FINITE);
}

static inline int tribo_check_nonnegative(tribo_context *ctx, const char *name, const double *x, size_t n)
{
    return x && tribo_all_unsigned(x, n) ? TRIBO_OK : tribo_check_slowly(ctx, name, x, n, NONNEGATIVE);
}

/* Checks v and a; a status. *plain: |a_i| <= TRIBO_PLAIN. */
static inline int tribo_check_motion(tribo_context *ctx, const double *v, const double *a, int *plain)
{
    const int status = tribo_check_finite(ctx, "v", v, ctx->n);
    *plain = tribo_is_within(a, ctx->n, TRIBO_PLAIN);
    return status || *plain ? status : tribo_check_finite(ctx, "a", a, ctx->n);
}

static inline int tribo_has_operator(const tribo_context *ctx)
{
    return ctx->op->diagonal || !ctx->n;
}

/* Fails if ctx has no operator; note keeps the message. */
static inline int tribo_need_operator(const tribo_context *ctx, tribo_context *note)
{
    return tribo_has_operator(ctx)
               ? TRIBO_OK
               : tribo_fail(note, TRIBO_ERR_STATE,
                            "no operator: call tribo_set_operator_diagonal or another tribo_set_operator_... first");
}

static inline int tribo_check_output(tribo_context *ctx, const char *name, const double *x)
{
    return !x && ctx->n ? tribo_fail(ctx, TRIBO_ERR_NULL, "%s is NULL", name) : TRIBO_OK;
}

#endif
