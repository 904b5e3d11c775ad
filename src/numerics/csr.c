/* SPDX-License-Identifier: BSD-3-Clause */
#include "csr.h"

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

int tribo_csr_product(struct csr *a, size_t n, const struct csr *t, const double *w, const size_t *rowptr, const size_t *col,
                      const double *val)
{
    struct csr unsorted = {0};
    size_t room = 0, *place = calloc(n + 1, sizeof *place); /* of entry (i, j), plus 1; at most first[i] if there is none yet */
    for (size_t i = 0; i < n; i++) {
        size_t terms = 0;
        for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
            terms += t->first[col[k] + 1] - t->first[col[k]];
        }
        room += terms < n ? terms : n;
    }
    int done = place && tribo_csr_create(&unsorted, n, room);
    for (size_t i = 0; done && i < n; i++) {
        size_t end = unsorted.first[i];
        for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
            const double x = val[k] * w[col[k]];
            for (size_t e = t->first[col[k]]; x != 0.0 && e < t->first[col[k] + 1]; e++) {
                const size_t j = t->col[e];
                if (place[j] <= unsorted.first[i]) {
                    unsorted.col[end] = j;
                    unsorted.val[end] = 0.0;
                    place[j] = ++end;
                }
                unsorted.val[place[j] - 1] += x * t->val[e];
            }
        }
        unsorted.first[i + 1] = end;
    }
    /* The product is symmetric: its transpose is the product with columns ascending. */
    done = done && tribo_csr_transpose(a, n, n, unsorted.first, unsorted.col, unsorted.val);
    tribo_csr_free(&unsorted);
    free(place);
    return done;
}
