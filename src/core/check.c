/* Checks of arguments. The loops have no early exit, so that they vectorize; the culprit is looked for only after. */
#include <float.h>
#include <math.h>

#include "internal.h"

int tribo_check_finite(const tribo_context *ctx, const char *name, const double *x, size_t n)
{
    if (!x && n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "%s is NULL", name);
    }
    int bad = 0;
    for (size_t i = 0; i < n; i++) {
        bad |= !(fabs(x[i]) <= DBL_MAX);
    }
    if (bad) {
        size_t i = 0;
        while (isfinite(x[i])) {
            i++;
        }
        return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "%s[%zu] = %g is not finite", name, i, x[i]);
    }
    return TRIBO_OK;
}

int tribo_check_nonnegative(const tribo_context *ctx, const char *name, const double *x, size_t n)
{
    const int status = tribo_check_finite(ctx, name, x, n);
    if (status) {
        return status;
    }
    for (size_t i = 0; i < n; i++) {
        if (x[i] < 0.0) {
            return tribo_fail(ctx, TRIBO_ERR_NEGATIVE, "%s[%zu] = %g is negative", name, i, x[i]);
        }
    }
    return TRIBO_OK;
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
