/* Square or rectangular matrices in compressed rows: how operators arrive. These allocate. */
#ifndef TRIBO_CSR_H
#define TRIBO_CSR_H

#include <stddef.h>

struct csr {
    size_t n;
    size_t *first, *col; /* first has the memory of all */
    double *val;
};

int tribo_csr_create(struct csr *a, size_t n, size_t entries); /* 1, or 0 if out of memory; first is all 0 */
void tribo_csr_free(struct csr *a);

/* b = a', columns sorted, a being [n][columns]. */
int tribo_csr_transpose(struct csr *b, size_t n, size_t columns, const size_t *rowptr, const size_t *col, const double *val);

/* The entry at (i, j), or NULL. Columns are sorted. */
double *tribo_csr_entry(const struct csr *a, size_t i, size_t j);

/* a = J diag(w) J', columns sorted; t is J'. */
int tribo_csr_product(struct csr *a, size_t n, const struct csr *t, const double *w, const size_t *rowptr, const size_t *col,
                      const double *val);

#endif
