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
    size_t supernodes;        /* runs of columns with the same rows below; */
    size_t *supernode;        /* [size + 1] the first column of each, */
    size_t *member_of;        /* [size] and which a column belongs to */
    double change, rebuild;   /* cost of a change, on average, and of a new factor */
};

/* An order of elimination that keeps L sparse: place [size] by position. 1, or 0 if out of memory. */
int tribo_nested_dissection(const struct csr *r, size_t *place);

/* parent [size]: the elimination tree. */
void tribo_supernodes_find(struct sparse *s, const size_t *parent);

/* l and d anew, over all contacts that are FREE; d is 0 where a pivot counts as zero, and column of l with it, but not the row.
 * Returns the largest entry that is left over there, *who being whose it is. */
double tribo_supernodes_factorize(const struct box_qp *p, size_t *who);

#endif
