/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks of the parameters of elements. */
#include "element.h"

/* 1 if x is in its range. No comparison raises an exception. */
static int in_range(double x, int range)
{
    const double least = range == FINITE ? -ELEMENT_MOST : ELEMENT_LEAST;
    return (isgreaterequal(x, least) & islessequal(x, ELEMENT_MOST)) | ((x == 0.0) & (range != POSITIVE));
}

int tribo_check_elements(const double *x, size_t n, size_t numbers, const int *range)
{
    if (!x && n) {
        return TRIBO_ERR_NULL;
    }
    for (size_t i = 0; i < n; i++, x += numbers) {
        int all = 1;
        for (size_t k = 0; k < numbers; k++) {
            all &= in_range(x[k], range[k]);
        }
        for (size_t k = 0; !all && k < numbers; k++) {
            if (!in_range(x[k], range[k])) {
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
