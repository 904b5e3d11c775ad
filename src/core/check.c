/* Checks of arguments. */
#include <math.h>

#include "context.h"

/* x - x is zero if x is finite, and NaN otherwise; sums side by side, since one would have to be added up in order. */
TRIBO_SIMD int tribo_all_finite(const double *x, size_t n)
{
    enum { SUMS = 8 };
    double sum[SUMS] = {0.0}, all = 0.0;
    size_t i = 0;
    for (; i < n % SUMS; i++) {
        all += x[i] - x[i];
    }
    if (n < SUMS) {
        return all == 0.0;
    }
    for (; i < n; i += SUMS) {
        for (size_t k = 0; k < SUMS; k++) {
            sum[k] += x[i + k] - x[i + k];
        }
    }
    return all + (sum[0] + sum[1] + (sum[2] + sum[3]) + (sum[4] + sum[5] + (sum[6] + sum[7]))) == 0.0;
}

int tribo_check_finite(const tribo_context *ctx, const char *name, const double *x, size_t n)
{
    if (!x && n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "%s is NULL", name);
    }
    if (!tribo_all_finite(x, n)) { /* only now the culprit is looked for */
        size_t i = 0;
        while (isfinite(x[i])) {
            i++;
        }
        return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "%s[%zu] = %g is not finite", name, i, x[i]);
    }
    return TRIBO_OK;
}

TRIBO_SIMD static int none_negative(const double *x, size_t n)
{
    int64_t any = 0; /* as wide as what is compared */
    for (size_t i = 0; i < n; i++) {
        any |= x[i] < 0.0 ? -1 : 0;
    }
    return !any;
}

int tribo_check_nonnegative(const tribo_context *ctx, const char *name, const double *x, size_t n)
{
    const int status = tribo_check_finite(ctx, name, x, n);
    if (status || none_negative(x, n)) {
        return status;
    }
    size_t i = 0;
    while (!(x[i] < 0.0)) {
        i++;
    }
    return tribo_fail(ctx, TRIBO_ERR_NEGATIVE, "%s[%zu] = %g is negative", name, i, x[i]);
}

int tribo_check_positive(const tribo_context *ctx, const char *name, const double *x, size_t n)
{
    const int status = tribo_check_finite(ctx, name, x, n);
    if (status) {
        return status;
    }
    for (size_t i = 0; i < n; i++) {
        if (x[i] <= 0.0) {
            return tribo_fail(ctx, TRIBO_ERR_NOT_POSITIVE, "%s[%zu] = %g is not positive", name, i, x[i]);
        }
    }
    return TRIBO_OK;
}

int tribo_fail_without_operator(const tribo_context *ctx)
{
    return tribo_fail(ctx, TRIBO_ERR_STATE,
                      "no operator: call tribo_set_operator_diagonal or another tribo_set_operator_... first");
}
