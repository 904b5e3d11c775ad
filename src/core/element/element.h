/* SPDX-License-Identifier: BSD-3-Clause */
/* Elements: friction laws with a state, without a context. Checks of their arrays; chunks of elements with a column for each
 * number, for loops that become vectors. */
#ifndef TRIBO_ELEMENT_H
#define TRIBO_ELEMENT_H

#include "core/check.h"

/* TRIBO_ERR_SIZE where arrays of n elements are larger than memory. */
static inline int element_check_size(size_t n)
{
    return n >= SIZE_MAX / 128 ? TRIBO_ERR_SIZE : TRIBO_OK;
}

enum { ELEMENT_NUMBERS = 6 }; /* of an element, at most */

/* Sizes of the numbers for which the formulas of elements with exponential functions neither overflow nor divide by 0. */
#define ELEMENT_LEAST 1e-30
#define ELEMENT_MOST 1e30

/* Checks x [n][numbers]; range [numbers]: POSITIVE: within [ELEMENT_LEAST, ELEMENT_MOST]; NONNEGATIVE: 0, too; FINITE: of either
 * sign. Returns TRIBO_ERR_NULL, TRIBO_ERR_NOT_FINITE, TRIBO_ERR_NEGATIVE, TRIBO_ERR_NOT_POSITIVE, TRIBO_ERR_RANGE. */
int tribo_check_elements(const double *x, size_t n, size_t numbers, const int *range);

static inline int tribo_check_element(const double *x, size_t n, int range)
{
    return tribo_check_elements(x, n, 1, &range);
}

/* column [numbers] = the numbers of n <= TRIBO_CHUNK elements, x [n][numbers]. */
static inline void element_columns(const double *x, size_t n, size_t numbers, double (*column)[TRIBO_CHUNK])
{
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < numbers; k++) {
            column[k][i] = x[numbers * i + k];
        }
    }
}

#endif
