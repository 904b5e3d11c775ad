/* SPDX-License-Identifier: BSD-3-Clause */
/* The pattern of a sparse factor, of factor_sparse.c and nested_dissection.c. */
#ifndef TRIBO_SPARSE_H
#define TRIBO_SPARSE_H

#include <stdint.h>

#include "box_qp.h"
#include "numerics/csr.h"

#define NONE SIZE_MAX

struct sparse {
    struct csr r;      /* R by places */
    size_t *position;  /* [size] of a place */
    size_t *place;     /* [size] of a position */
    size_t *column;    /* [size + 1] column j of L has the slots column[j] to column[j + 1] - 1 */
    size_t *row_of;    /* [slots] rows, ascending in a column */
    size_t *row;       /* [size + 1] row k of L has the entries row[k] to row[k + 1] - 1 of: */
    size_t *column_of; /* [slots] columns, ascending in a row */
    size_t *slot;      /* [slots] slots */
};

/* place [size] = an order of elimination that keeps L sparse. Returns 1, or 0 if out of memory. */
int tribo_nested_dissection(const struct csr *r, size_t *place);

#endif
