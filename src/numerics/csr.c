/* SPDX-License-Identifier: BSD-3-Clause */
#include "csr.h"

int tribo_csr_transpose(struct csr *b, size_t n, size_t columns, const size_t *rowptr, const size_t *col, const double *val)
{
    const int done = b->first ? 1 : tribo_csr_create(b, columns, rowptr[n]);
    if (done) {
        memset(b->first, 0, (columns + 2) * sizeof *b->first);
        tribo_rows_transpose(n, columns, rowptr, col, val, b->first, b->col, b->val);
    }
    return done;
}

double *tribo_csr_entry(const struct csr *a, size_t i, size_t j)
{
    const size_t at = tribo_rows_find(a->first, a->col, i, j);
    return at == SIZE_MAX ? NULL : &a->val[at];
}

/* a = the places of the entries of J J', columns ascending; mark [n] is workspace. Returns 1, or 0 if out of memory. */
static int find_product(struct csr *a, size_t *mark, const struct csr *t, const size_t *rowptr, const size_t *col, size_t n)
{
    struct csr unsorted;
    size_t room = 0;
    for (size_t i = 0; i < n; i++) {
        size_t terms = 0;
        for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
            terms += t->first[col[k] + 1] - t->first[col[k]];
        }
        room += terms < n ? terms : n;
        mark[i] = n;
    }
    if (!tribo_csr_create(&unsorted, n, room)) {
        return 0;
    }
    for (size_t i = 0; i < n; i++) {
        size_t end = unsorted.first[i];
        for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
            for (size_t e = t->first[col[k]]; e < t->first[col[k] + 1]; e++) {
                unsorted.col[end] = t->col[e];
                end += mark[t->col[e]] != i;
                mark[t->col[e]] = i;
            }
        }
        unsorted.first[i + 1] = end;
    }
    /* The product is symmetric: its transpose is the product with columns ascending. */
    const int done = tribo_csr_transpose(a, n, n, unsorted.first, unsorted.col, unsorted.val);
    tribo_csr_free(&unsorted);
    return done;
}

int tribo_csr_product(struct csr *a, size_t *next, const struct csr *t, const double *w, const size_t *rowptr, const size_t *col,
                      const double *val, size_t n)
{
    if (!a->first && !find_product(a, next, t, rowptr, col, n)) {
        return 0;
    }
    memcpy(next, a->first, n * sizeof *next); /* next[j]: place of entry (j, i) in row i of the loop */
    memset(a->val, 0, a->first[n] * sizeof *a->val);
    for (size_t i = 0; i < n; i++) {
        for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
            const double x = val[k] * w[col[k]];
            for (size_t e = t->first[col[k]]; x != 0.0 && e < t->first[col[k] + 1]; e++) {
                a->val[next[t->col[e]]] += x * t->val[e];
            }
        }
        for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
            next[a->col[e]]++;
        }
    }
    return 1;
}
