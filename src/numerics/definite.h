/* SPDX-License-Identifier: BSD-3-Clause */
/* A symmetric matrix A, diagonal or dense, positive definite over the rows with a_ii > 0. All other rows are 0, and belong to no
 * set. */
#ifndef TRIBO_DEFINITE_H
#define TRIBO_DEFINITE_H

#include <stddef.h>

struct definite {
    size_t n;
    double *own;     /* [n] a_ii */
    double *matrix;  /* [n][n] A; NULL if A is diagonal, and inverse, factor and index are empty */
    double *inverse; /* [n][n] A^-1 over the rows with a_ii > 0 */
    double *factor;  /* [held][held] workspace: lower Cholesky factor of A over the rows of a set */
    size_t held;     /* number of these rows */
    size_t *index;   /* [held] these rows */
    double *x;       /* [n] workspace */
    void *memory;    /* of all arrays */
};

/* A = a [n][n] with the diagonal own [n]; a NULL: A is diagonal. Returns TRIBO_OK, TRIBO_ERR_MEMORY, or TRIBO_ERR_INDEFINITE with
 * the row of a pivot that is rounding. tribo_definite_free takes a zeroed d, too. */
int tribo_definite_create(struct definite *d, size_t n, const double *own, const double *a, size_t *where);
void tribo_definite_free(struct definite *d);

/* x_S = A_SS^-1 x_S, x [n][columns], over the set S of rows with skip [n] 0 (all rows: NULL); x = 0 outside S. */
void tribo_definite_solve(struct definite *d, const signed char *skip, size_t columns, double *x);

/* y [n][columns] += A x. */
void tribo_definite_multiply_add(const struct definite *d, size_t columns, const double *x, double *y);

/* x [n] = |A^-1| x. */
void tribo_definite_solve_sizes(struct definite *d, double *x);

#endif
