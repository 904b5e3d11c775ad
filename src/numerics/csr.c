/* SPDX-License-Identifier: BSD-3-Clause */
#include "csr.h"

#include <string.h>

int tribo_csr_transpose(struct csr *b, size_t n, size_t columns, const size_t *rowptr, const size_t *col, const double *val)
{
    const int done = tribo_csr_create(b, columns, rowptr[n]);
    if (done) {
        tribo_rows_transpose(n, columns, rowptr, col, val, b->first, b->col, b->val);
    }
    return done;
}

double *tribo_csr_entry(const struct csr *a, size_t i, size_t j)
{
    const size_t at = tribo_rows_find(a->first, a->col, i, j);
    return at == SIZE_MAX ? NULL : &a->val[at];
}

/* Adds up row i of J diag(w) J', t = J': lists its columns in work->col, returns their number, and leaves entry (i, j) in
 * work->val[j]. work->first [n] is i + 1 where j is listed, less elsewhere. */
static size_t product_row(size_t i, const struct csr *t, const double *w, const size_t *rowptr, const size_t *col,
                          const double *val, struct csr *work)
{
    size_t count = 0;
    for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
        const size_t dof = col[k];
        const double x = val[k] * w[dof];
        for (size_t e = t->first[dof]; x != 0.0 && e < t->first[dof + 1]; e++) {
            const size_t j = t->col[e];
            if (work->first[j] != i + 1) {
                work->first[j] = i + 1;
                work->col[count++] = j;
                work->val[j] = 0.0;
            }
            work->val[j] += x * t->val[e];
        }
    }
    return count;
}

int tribo_csr_product(struct csr *a, size_t n, const struct csr *t, const double *w, const size_t *rowptr, const size_t *col,
                      const double *val)
{
    struct csr unsorted = {0}, work;
    size_t entries = 0;
    if (!tribo_csr_create(&work, n, n)) {
        return 0;
    }
    for (size_t i = 0; i < n; i++) {
        entries += product_row(i, t, w, rowptr, col, val, &work);
    }
    memset(work.first, 0, n * sizeof *work.first);
    int done = tribo_csr_create(&unsorted, n, entries);
    for (size_t i = 0; done && i < n; i++) {
        const size_t count = product_row(i, t, w, rowptr, col, val, &work), first = unsorted.first[i];
        for (size_t k = 0; k < count; k++) {
            unsorted.col[first + k] = work.col[k];
            unsorted.val[first + k] = work.val[work.col[k]];
        }
        unsorted.first[i + 1] = first + count;
    }
    /* The product is symmetric: its transpose is the product with columns ascending. */
    done = done && tribo_csr_transpose(a, n, n, unsorted.first, unsorted.col, unsorted.val);
    tribo_csr_free(&unsorted);
    tribo_csr_free(&work);
    return done;
}
