/* The operator J A^-1 J' of contacts whose forces a matrix A spreads. */
#ifndef TRIBO_DELASSUS_H
#define TRIBO_DELASSUS_H

#include "numerics/matrix.h"

/* x [j->cols] = row i of J; what x has where that row has entries goes into own, as in hidden.h. */
void tribo_delassus_put_row(const struct matrix *j, size_t i, double *x);
void tribo_delassus_note_own(const struct matrix *j, size_t i, const double *x, double *own);

/* count vectors x [count][j->cols] = A^-1 x. 1, or 0 if out of memory. */
typedef int delassus_solve(const void *a, size_t count, double *x);

/* r [j->rows][j->rows] = J X with X = A^-1 J', some rows of J at a time, and own as in hidden.h; X is x [j->rows][j->cols], or,
 * with NULL, is not kept. 1, or 0 if out of memory. */
int tribo_delassus_by_columns(const struct matrix *j, delassus_solve *solve, const void *a, double *x, double *r, double *own);

#endif
