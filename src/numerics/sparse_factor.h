/* SPDX-License-Identifier: BSD-3-Clause */
/* Factors of sparse symmetric matrices, and their inertia, by CHOLMOD (Chen, Davis, Hager and Rajamanickam 2008, ACM Trans. Math.
 * Softw. 35, 22, doi:10.1145/1391989.1391995). Each factor owns CHOLMOD's state. AMD orders the rows: METIS, CHOLMOD's other
 * choice, ends the program where there is no memory. */
#ifndef TRIBO_SPARSE_FACTOR_H
#define TRIBO_SPARSE_FACTOR_H

#include "matrix.h"

/* A = P' L L' P. */
struct sparse_factor;

/* The inertia of A + E = P' L D L' P, factored without exchange of rows. */
struct inertia {
    size_t negative; /* eigenvalues of A + E below 0 */
    double growth;   /* max_i sum_k |L_ik|^2 |D_k| / |size_i|: E_ij is rounding of growth sqrt(|size_i size_j|) */
};

struct sparse_solver {
    /* Factors the positive definite matrix of the lower triangle of a. spent: NULL, or a, which is then freed as soon as it has
     * been read, before the factor takes its memory; the caller calls tribo_matrix_free in any case. Returns TRIBO_OK,
     * TRIBO_ERR_MEMORY, or TRIBO_ERR_INDEFINITE with the row *where of a pivot that is not positive. */
    int (*create)(struct sparse_factor **factor, const struct matrix *a, struct matrix *spent, size_t *where);

    void (*destroy)(struct sparse_factor *factor); /* takes NULL */

    /* x [count][n] = A^-1 x of count vectors. Returns 1, or 0 if out of memory, which cannot happen for count = 1. */
    int (*solve)(struct sparse_factor *factor, size_t count, double *x);

    /* x [n][cols] = L^-1 P x; back = 1: x = P' L'^-1 x. */
    void (*half_solve)(struct sparse_factor *factor, int back, double *x, size_t cols);

    /* Finds the inertia of the lower triangle of a.
     * like      in  NULL, or the factor of a matrix with entries in the same places, whose order is taken
     * spent     in  as of create
     * size [n]  in  sizes of the terms that the diagonal of A is the sum of
     * Returns TRIBO_OK, TRIBO_ERR_MEMORY, or TRIBO_ERR_INDEFINITE: a pivot is 0 or not finite. */
    int (*inertia)(const struct sparse_factor *like, const struct matrix *a, struct matrix *spent, const double *size,
                   struct inertia *found);
};

/* NULL if the library was built without CHOLMOD. */
extern const struct sparse_solver *const tribo_cholmod;

#endif
