/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks of the parameters of elements. */
#include "element.h"

#include "common/exponent.h"

/* Returns 1 if all x [n][numbers] are in their ranges; 0 also for a -0 that is not FINITE. Compares bits as integers, which have
 * the order of the numbers >= 0: no exception is raised. */
TRIBO_SIMD static int all_in_range(const double *x, size_t n, size_t numbers, const int *range)
{
    enum { ROWS = 8, LENGTH = ROWS * ELEMENT_NUMBERS };
    const uint64_t sign = (uint64_t)1 << 63, most = tribo_bits(ELEMENT_MOST);
    uint64_t mask[LENGTH], least[LENGTH], zero[LENGTH], beyond = 0; /* beyond has the sign bit if an entry is out of range */
    for (size_t k = 0; k < ROWS * numbers; k++) {
        const int is = range[k % numbers];
        mask[k] = is == FINITE ? ~sign : ~(uint64_t)0;
        least[k] = is == FINITE ? 0 : tribo_bits(ELEMENT_LEAST);
        zero[k] = is == NONNEGATIVE ? sign : 0;
    }
    for (size_t i = 0, length; i < n * numbers; i += length) {
        length = n * numbers - i < ROWS * numbers ? n * numbers - i : ROWS * numbers;
        for (size_t k = 0; k < length; k++) {
            uint64_t bits;
            memcpy(&bits, x + i + k, sizeof bits);
            bits &= mask[k];
            beyond |= bits | (most - bits) | ((bits - least[k]) & ~((bits - 1) & zero[k]));
        }
    }
    return !(beyond & sign);
}

int tribo_check_elements(const double *x, size_t n, size_t numbers, const int *range)
{
    if (!x && n) {
        return TRIBO_ERR_NULL;
    }
    const int all = all_in_range(x, n, numbers, range);
    for (size_t i = 0; !all && i < n; i++, x += numbers) {
        for (size_t k = 0; k < numbers; k++) {
            const double least = range[k] == FINITE ? -ELEMENT_MOST : ELEMENT_LEAST;
            const int inside = isgreaterequal(x[k], least) & islessequal(x[k], ELEMENT_MOST); /* no exceptions */
            if (!inside && (x[k] != 0.0 || range[k] == POSITIVE)) {
                return !isfinite(x[k])                       ? TRIBO_ERR_NOT_FINITE
                       : range[k] == FINITE                  ? TRIBO_ERR_RANGE
                       : x[k] <= 0.0 && range[k] == POSITIVE ? TRIBO_ERR_NOT_POSITIVE
                       : x[k] < 0.0                          ? TRIBO_ERR_NEGATIVE
                                                             : TRIBO_ERR_RANGE;
            }
        }
    }
    return TRIBO_OK;
}
