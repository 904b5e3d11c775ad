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
    double *factor;  /* [held][held] lower Cholesky factor of A over index */
    size_t held;     /* rows of the set solved for last */
    size_t *index;   /* [held] these rows */
    double *x;       /* [n] workspace */
    double *q;       /* [n] see tribo_definite_box; lo, hi, f alike */
    double *lo, *hi; /* [n] */
    double *f;       /* [n] */
    signed char *at; /* [n] places of the rows found last by tribo_definite_box: 0 inside, -1 at lo, 1 at hi */
    signed char *to; /* [n] workspace */
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

/* f = the minimum of 1/2 f'Af + q'f, lo <= f <= hi, arrays of d. Bounds may be infinite, and are 0 where a_ii = 0. */
void tribo_definite_box(struct definite *d);

#endif
