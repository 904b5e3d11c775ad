/* SPDX-License-Identifier: BSD-3-Clause */
/* Checks of the parameters of elements. */
#include "element.h"

int tribo_check_element(const double *x, size_t n, size_t stride, int range)
{
    if (!x && n) {
        return TRIBO_ERR_NULL;
    }
    for (size_t i = 0; i < n; i++) {
        const double value = x[i * stride], size = fabs(value);
        if (!isfinite(value)) {
            return TRIBO_ERR_NOT_FINITE;
        }
        if (range != FINITE && value < 0.0) {
            return range == POSITIVE ? TRIBO_ERR_NOT_POSITIVE : TRIBO_ERR_NEGATIVE;
        }
        if (range == POSITIVE && value == 0.0) {
            return TRIBO_ERR_NOT_POSITIVE;
        }
        if (size > ELEMENT_MOST || (size > 0.0 && size < ELEMENT_LEAST && range != FINITE)) {
            return TRIBO_ERR_RANGE;
        }
    }
    return TRIBO_OK;
}
