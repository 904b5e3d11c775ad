/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks of arguments: loops over arrays, and messages. */
#include "check.h"

TRIBO_SIMD int tribo_all_within(const double *x, size_t n, double most)
{
    const int64_t limit = tribo_size_of(&most);
    int64_t room = 0; /* negative if a difference is */
    TRIBO_UNROLLED
    for (size_t i = 0; i < n; i++) {
        room |= limit - tribo_size_of(x + i);
    }
    return room >= 0;
}

TRIBO_SIMD int tribo_all_unsigned(const double *x, size_t n)
{
    const double most = DBL_MAX;
    const uint64_t limit = (uint64_t)tribo_size_of(&most), sign = (uint64_t)1 << 63;
    uint64_t beyond = 0; /* has the sign bit if an entry has, or its difference */
    TRIBO_UNROLLED
    for (size_t i = 0; i < n; i++) {
        uint64_t bits;
        memcpy(&bits, x + i, sizeof bits);
        beyond |= bits | (limit - bits);
    }
    return !(beyond & sign);
}

int tribo_check_slowly(tribo_context *ctx, const char *name, const double *x, size_t n, int range)
{
    static const int status[] = {
        [FINITE] = TRIBO_ERR_NOT_FINITE, [NONNEGATIVE] = TRIBO_ERR_NEGATIVE, [POSITIVE] = TRIBO_ERR_NOT_POSITIVE};
    static const char *const text[] = {[FINITE] = "not finite", [NONNEGATIVE] = "negative", [POSITIVE] = "not positive"};
    if (!x && n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "%s is NULL", name);
    }
    const int finite = range == FINITE ? TRIBO_OK : tribo_check_slowly(ctx, name, x, n, FINITE);
    for (size_t i = 0; !finite && i < (n == TRIBO_NUMBER ? 1 : n); i++) {
        const int good = range == FINITE        ? isfinite(x[i])
                         : range == NONNEGATIVE ? x[i] >= 0.0
                                                : x[i] > 0.0; /* -0 is not negative */
        if (!good && n == TRIBO_NUMBER) {
            return tribo_fail(ctx, status[range], "%s = %g is %s", name, x[i], text[range]);
        }
        if (!good) {
            return tribo_fail(ctx, status[range], "%s[%zu] = %g is %s", name, i, x[i], text[range]);
        }
    }
    return finite;
}
