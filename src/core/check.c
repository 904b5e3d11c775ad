/* Checks of arguments: loops over arrays, and messages. */
#include "check.h"

/* |x| as an integer: larger for larger |x|; infinity and NaN are above all numbers. */
static inline int64_t check_size_of(const double *x)
{
    int64_t bits;
    memcpy(&bits, x, sizeof bits);
    return bits & INT64_MAX;
}

TRIBO_SIMD int tribo_all_within(const double *x, size_t n, double most)
{
    const int64_t limit = check_size_of(&most);
    int64_t room = 0; /* negative if a difference is */
    TRIBO_UNROLLED
    for (size_t i = 0; i < n; i++) {
        room |= limit - check_size_of(x + i);
    }
    return room >= 0;
}

TRIBO_SIMD int tribo_two_within(const double *x, double most_x, const double *y, double most_y, size_t n)
{
    const int64_t limit_x = check_size_of(&most_x), limit_y = check_size_of(&most_y);
    int64_t room_x = 0, room_y = 0;
    TRIBO_UNROLLED
    for (size_t i = 0; i < n; i++) {
        room_x |= limit_x - check_size_of(x + i);
        room_y |= limit_y - check_size_of(y + i);
    }
    return (room_x >= 0 ? 1 : 0) | (room_y >= 0 ? 2 : 0);
}

int tribo_fail_not_finite(tribo_context *ctx, const char *name, const double *x, size_t n)
{
    if (!x && n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "%s is NULL", name);
    }
    for (size_t i = 0; i < n; i++) {
        if (!isfinite(x[i])) {
            return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "%s[%zu] = %g is not finite", name, i, x[i]);
        }
    }
    return TRIBO_OK;
}

/* 1 if all x_i are finite and have no sign. */
TRIBO_SIMD static int check_all_positive(const double *x, size_t n)
{
    const double most = DBL_MAX;
    const uint64_t limit = (uint64_t)check_size_of(&most), sign = (uint64_t)1 << 63;
    uint64_t beyond = 0; /* has the sign bit if an entry has, or its difference */
    TRIBO_UNROLLED
    for (size_t i = 0; i < n; i++) {
        uint64_t bits;
        memcpy(&bits, x + i, sizeof bits);
        beyond |= bits | (limit - bits);
    }
    return !(beyond & sign);
}

/* -0 is not negative. */
int tribo_check_nonnegative(tribo_context *ctx, const char *name, const double *x, size_t n)
{
    if (x && check_all_positive(x, n)) {
        return TRIBO_OK;
    }
    const int status = tribo_fail_not_finite(ctx, name, x, n);
    for (size_t i = 0; !status && i < n; i++) {
        if (x[i] < 0.0) {
            return tribo_fail(ctx, TRIBO_ERR_NEGATIVE, "%s[%zu] = %g is negative", name, i, x[i]);
        }
    }
    return status;
}

int tribo_check_positive(tribo_context *ctx, const char *name, const double *x, size_t n)
{
    const int status = tribo_check_finite(ctx, name, x, n);
    for (size_t i = 0; !status && i < n; i++) {
        if (x[i] <= 0.0) {
            return tribo_fail(ctx, TRIBO_ERR_NOT_POSITIVE, "%s[%zu] = %g is not positive", name, i, x[i]);
        }
    }
    return status;
}

int tribo_check_one_positive(tribo_context *ctx, const char *name, double x)
{
    if (!isfinite(x)) {
        return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "%s = %g is not finite", name, x);
    }
    return x > 0.0 ? TRIBO_OK : tribo_fail(ctx, TRIBO_ERR_NOT_POSITIVE, "%s = %g is not positive", name, x);
}

int tribo_fail_without_operator(tribo_context *ctx)
{
    return tribo_fail(ctx, TRIBO_ERR_STATE,
                      "no operator: call tribo_set_operator_diagonal or another tribo_set_operator_... first");
}
