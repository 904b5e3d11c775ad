#include "csr.h"
#include "common/layout.h"

#include <stdlib.h>
#include <string.h>

void tribo_csr_free(struct csr *a)
{
    free(a->first);
    memset(a, 0, sizeof *a);
}

static void lay_out_rows(struct csr *a, struct layout *b, size_t entries)
{
    a->first = tribo_layout_array(b, a->n + 1, sizeof *a->first);
    a->col = tribo_layout_array(b, entries + 1, sizeof *a->col);
    a->val = tribo_layout_array(b, entries + 1, sizeof *a->val);
}

int tribo_csr_create(struct csr *a, size_t n, size_t entries)
{
    struct layout b = {0};
    a->n = n;
    lay_out_rows(a, &b, entries);
    if (!tribo_layout_create(&b)) {
        memset(a, 0, sizeof *a);
        return 0;
    }
    lay_out_rows(a, &b, entries);
    memset(a->first, 0, (n + 1) * sizeof *a->first);
    return 1;
}

int tribo_csr_transpose(struct csr *b, size_t n, size_t columns, const size_t *rowptr, const size_t *col, const double *val)
{
    if (!tribo_csr_create(b, columns, rowptr[n])) {
        return 0;
    }
    for (size_t k = 0; k < rowptr[n]; k++) {
        b->first[col[k] + 1]++;
    }
    for (size_t j = 0; j < columns; j++) {
        b->first[j + 1] += b->first[j];
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
            const size_t to = b->first[col[k]]++;
            b->col[to] = i;
            b->val[to] = val[k];
        }
    }
    for (size_t j = columns; j > 0; j--) {
        b->first[j] = b->first[j - 1];
    }
    b->first[0] = 0;
    return 1;
}

double *tribo_csr_entry(const struct csr *a, size_t i, size_t j)
{
    size_t lo = a->first[i], hi = a->first[i + 1];
    while (lo < hi) {
        const size_t mid = lo + (hi - lo) / 2;
        if (a->col[mid] == j) {
            return &a->val[mid];
        }
        if (a->col[mid] < j) {
            lo = mid + 1;
        } else {
            hi = mid;
        }
    }
    return NULL;
}

/* The columns that row i of J diag(w) J' has entries in; t is J'. seen [n] keeps i + 1 for each. With sum [n], adds up
 * the entries too. */
static size_t product_row(size_t i, const struct csr *t, const double *w, const size_t *rowptr, const size_t *col,
                          const double *val, size_t *seen, size_t *column, double *sum)
{
    size_t count = 0;
    for (size_t k = rowptr[i]; k < rowptr[i + 1]; k++) {
        const size_t dof = col[k];
        const double x = val[k] * w[dof];
        for (size_t e = t->first[dof]; x != 0.0 && e < t->first[dof + 1]; e++) {
            const size_t j = t->col[e];
            if (seen[j] != i + 1) {
                seen[j] = i + 1;
                column[count++] = j;
                sum[j] = 0.0;
            }
            sum[j] += x * t->val[e];
        }
    }
    return count;
}

int tribo_csr_product(struct csr *a, size_t n, const struct csr *t, const double *w, const size_t *rowptr, const size_t *col,
                      const double *val)
{
    struct csr unsorted = {0}, work = {0}; /* columns seen; found, and sums in these */
    int done = 0;
    if (tribo_csr_create(&work, n, n)) {
        size_t *seen = work.first, *column = work.col;
        double *sum = work.val;
        size_t entries = 0;
        for (size_t i = 0; i < n; i++) {
            entries += product_row(i, t, w, rowptr, col, val, seen, column, sum);
        }
        memset(seen, 0, n * sizeof *seen);
        if (tribo_csr_create(&unsorted, n, entries)) {
            for (size_t i = 0; i < n; i++) {
                const size_t count = product_row(i, t, w, rowptr, col, val, seen, column, sum);
                const size_t first = unsorted.first[i];
                for (size_t k = 0; k < count; k++) {
                    unsorted.col[first + k] = column[k];
                    unsorted.val[first + k] = sum[column[k]];
                }
                unsorted.first[i + 1] = first + count;
            }
            /* it is symmetric, and transposing sorts */
            done = tribo_csr_transpose(a, n, n, unsorted.first, unsorted.col, unsorted.val);
            tribo_csr_free(&unsorted);
        }
    }
    tribo_csr_free(&work);
    return done;
}
