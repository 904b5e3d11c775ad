/* SPDX-License-Identifier: BSD-3-Clause */
/* Matrices in compressed rows: row i has the entries first[i] to first[i + 1] - 1. */
#ifndef TRIBO_CSR_H
#define TRIBO_CSR_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/layout.h"

struct csr {
    size_t n;      /* rows */
    size_t *first; /* [n + 1]; owns the memory of all three arrays */
    size_t *col;
    double *val;
};

static inline void tribo_csr_free(struct csr *a)
{
    free(a->first);
    *a = (struct csr){0};
}

/* Allocates a of n rows with room for entries; first is all 0. Returns 1, or 0 if out of memory. */
static inline int tribo_csr_create(struct csr *a, size_t n, size_t entries)
{
    *a = (struct csr){0};
    if (!ALLOCATE(ARRAY(a->first, n + 2), ARRAY(a->col, entries + 1), ARRAY(a->val, entries + 1))) {
        return 0;
    }
    a->n = n;
    return 1;
}

/* b = a', columns ascending, for a [n][columns]. b is empty, or a transpose with as many columns and entries: then b keeps its
 * memory. Returns 1, or 0 if out of memory. */
int tribo_csr_transpose(struct csr *b, size_t n, size_t columns, const size_t *rowptr, const size_t *col, const double *val);

/* Returns the entry at (i, j), or NULL. Columns ascend. */
double *tribo_csr_entry(const struct csr *a, size_t i, size_t j);

/* a = J diag(w) J', columns ascending, for J [n][t->n] in compressed rows and t = J'; next [n + 1] is workspace. a is empty, or a
 * product of a J with the same rowptr and col: then a keeps its memory and places. Returns 1, or 0 if out of memory. */
int tribo_csr_product(struct csr *a, size_t *next, const struct csr *t, const double *w, const size_t *rowptr, const size_t *col,
                      const double *val, size_t n);

/* Returns the place of entry (i, j) in col, or SIZE_MAX. Columns ascend. */
static inline size_t tribo_rows_find(const size_t *first, const size_t *col, size_t i, size_t j)
{
    size_t lo = first[i], hi = first[i + 1];
    while (lo < hi) {
        const size_t mid = lo + (hi - lo) / 2;
        if (col[mid] < j) {
            lo = mid + 1;
        } else {
            hi = mid;
        }
    }
    return lo < first[i + 1] && col[lo] == j ? lo : SIZE_MAX;
}

/* Fills to_first [cols + 2], all 0, to_col and to_val with the transpose of a matrix [rows][cols]. */
static inline void tribo_rows_transpose(size_t rows, size_t cols, const size_t *first, const size_t *col, const double *val,
                                        size_t *to_first, size_t *to_col, double *to_val)
{
    size_t *next = to_first + 1; /* next[j]: place of the next entry of row j; at the end, the begin of row j + 1 */
    for (size_t k = 0; k < first[rows]; k++) {
        next[col[k] + 1]++;
    }
    for (size_t j = 0; j < cols; j++) {
        next[j + 1] += next[j];
    }
    for (size_t i = 0; i < rows; i++) {
        for (size_t k = first[i]; k < first[i + 1]; k++) {
            to_col[next[col[k]]] = i;
            to_val[next[col[k]]++] = val[k];
        }
    }
}

#endif
