/* What factor_sparse.c and nested_dissection.c share. */
#ifndef TRIBO_SPARSE_H
#define TRIBO_SPARSE_H

#include <stdint.h>

#include "box_qp.h"
#include "numerics/csr.h"

#define NONE SIZE_MAX

struct sparse {
    struct csr r;             /* by place */
    size_t *position, *place; /* [size] of a place; at a position */
    size_t *column, *row;     /* [size + 1] column j of L has the slots column[j] to column[j + 1] - 1; rows alike */
    size_t *row_of;           /* [slots] rows ascending within a column */
    size_t *column_of, *slot; /* [slots] by rows: the columns, ascending, and the slots */
    double change, rebuild;   /* cost of a change, on average, and of a new factor */
};

/* An order of elimination that keeps L sparse: place [size] by position. 1, or 0 if out of memory. */
int tribo_nested_dissection(const struct csr *r, size_t *place);

#endif
