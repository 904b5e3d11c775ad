/* Square or rectangular matrices in compressed rows: how operators arrive. These allocate. */
#ifndef TRIBO_ROWS_H
#define TRIBO_ROWS_H

#include <stddef.h>

struct rows {
    size_t n;
    size_t *first, *col;
    double *val;
};

int tribo_rows_create(struct rows *a, size_t n, size_t entries); /* 1, or 0 if out of memory; first is all 0 */
void tribo_rows_free(struct rows *a);

/* b = a', columns sorted, a being [n][columns]. */
int tribo_rows_transpose(struct rows *b, size_t n, size_t columns, const size_t *rowptr, const size_t *col, const double *val);

/* The entry at (i, j), or NULL. Columns are sorted. */
double *tribo_rows_entry(const struct rows *a, size_t i, size_t j);

/* a = J diag(w) J', columns sorted; t is J'. */
int tribo_rows_product(struct rows *a, size_t n, const struct rows *t, const double *w, const size_t *rowptr, const size_t *col,
                       const double *val);

#endif
