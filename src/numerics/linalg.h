/* SPDX-License-Identifier: BSD-3-Clause */
/* Dense matrices and their factors. */
#ifndef TRIBO_LINALG_H
#define TRIBO_LINALG_H

#include <math.h>

#include "common/real.h"
#include "matrix.h"
#include "sparse_factor.h"

/* to += factor x. */
void tribo_add(double *to, double factor, const double *x, size_t n);

/* Returns 1 if no x_i is an infinity or a NaN. few: without a call. */
int tribo_many_finite(const double *x, size_t n);
static inline int tribo_dense_finite(const double *x, size_t n)
{
    const int few = n < 8;
    size_t i = 0;
    while (few && i < n && isfinite(x[i])) {
        i++;
    }
    return few ? i == n : tribo_many_finite(x, n);
}

/* Return sum x_i and sum x_i y_i z_i, summed in eight parts. */
double tribo_sum(size_t n, const double *x);
double tribo_dot_of_three(size_t n, const double *x, const double *y, const double *z);

/* c [rows][cols] += factor a b, for a [rows][inner] and b [inner][cols]. Skips groups of four zeros in a. */
void tribo_multiply_add(size_t rows, size_t inner, size_t cols, double factor, const double *a, const double *b, double *c);

/* c [inner][cols] += a'b, for a [rows][inner] and b [rows][cols]. Skips groups of four zeros in a. */
void tribo_multiply_transposed_add(size_t rows, size_t inner, size_t cols, const double *a, const double *b, double *c);

/* to [cols][rows] = a', for a [rows][cols]. */
void tribo_transpose(size_t rows, size_t cols, const double *a, double *to);

/* a [n][n] = (a + a')/2. */
void tribo_even_out(size_t n, double *a);

/* Matrices that are not diagonal have sparse factors from SPARSE_LEAST rows on. Without CHOLMOD all factors are dense, of
 * DENSE_MOST rows at most. */
#define SPARSE_LEAST 200
#define DENSE_MOST 3000

/* A^-1 = S S'. Dense: S = L'^-1 from A = L L'. Diagonal: root alone. Sparse: sparse alone. */
struct cholesky {
    size_t n;       /* 0: A is the identity */
    double *factor; /* [n][n] L in the lower triangle */
    double *root;   /* [n] the diagonal of L; owns the memory of both */
    struct sparse_factor *sparse;
};

/* Factors A. spent: NULL, or a, which is freed, also after an error. Returns TRIBO_OK, TRIBO_ERR_MEMORY, TRIBO_ERR_SIZE (dense,
 * more than DENSE_MOST rows), or TRIBO_ERR_INDEFINITE with the row *where and the value *pivot of a pivot that is not positive;
 * NaN if the value is unknown. */
int tribo_cholesky_create(struct cholesky *c, const struct matrix *a, struct matrix *spent, size_t *where, double *pivot);

void tribo_cholesky_free(struct cholesky *c);

/* x [count][n] = A^-1 x of count vectors. Returns 1, or 0 if out of memory, which cannot happen for count = 1. */
int tribo_cholesky_solve(const struct cholesky *c, size_t count, double *x);

/* x [n][cols] = S' x; back = 1: x = S x. */
void tribo_half_solve(const struct cholesky *c, int back, double *x, size_t cols);

/* Factors a [n][n] in place with exchanges pivot [n]. Returns the smallest |pivot|; 0 if a is singular or not finite: then there
 * are no factors. */
double tribo_lu_create(double *a, size_t n, int *pivot);

/* x [n][cols] = A^-1 x. */
void tribo_lu_solve(const double *lu, size_t n, const int *pivot, double *x, size_t cols);

/* values [n] = eigenvalues, ascending, of a symmetric a [n][n]; a = orthonormal eigenvectors, in rows. Returns TRIBO_OK,
 * TRIBO_ERR_MEMORY, TRIBO_ERR_NO_CONVERGENCE. */
int tribo_symmetric_eigen(double *a, size_t n, double *values);

/* The same of A x = value B x, B by its factor b: vectors [n][n], in rows, orthonormal in B. Overwrites a. Returns also
 * TRIBO_ERR_NOT_FINITE: A/B overflows. */
int tribo_symmetric_eigen_by(const struct cholesky *b, double *a, size_t n, double *values, double *vectors);

/* Eigenvalues and eigenvectors of a general real matrix.
 * a [n][n]      in, overwritten
 * re, im [n]    out  eigenvalues; of a complex pair the one with im > 0 first, its conjugate next
 * x [n][n]      out  eigenvectors of length 1: row k of a real eigenvalue k; of a pair k, k + 1 the real part in row k and the
 *                    imaginary part in row k + 1. Nearly parallel eigenvectors may be anything. NULL: none.
 * Returns TRIBO_OK, TRIBO_ERR_MEMORY, TRIBO_ERR_NOT_FINITE (a), TRIBO_ERR_NO_CONVERGENCE. */
int tribo_eigen(double *a, size_t n, double *re, double *im, double *x);

/* x [n] = the shortest y that minimizes |a y - x|, with singular values of a [n][n] below cut taken as zero. Overwrites a.
 * kernel  out, or NULL   the number of singular values below cut
 * Returns 1, or 0 if out of memory. x is NaN if a is not finite. */
int tribo_least_norm_solve(double *a, size_t n, double cut, double *x, size_t *kernel);

/* ---- GMRES (Saad and Schultz 1986): solves A x = b by products A x alone */

/* x [n] = A x. Returns a status. */
typedef int tribo_product(void *data, double *x);

/* Returns the doubles of workspace for a space of `most` dimensions. */
size_t tribo_gmres_room(size_t n, size_t most);

/* x [n] = the y with the smallest |x - A y| in the Krylov space of at most `most` dimensions; *part = |x - A y| / |x|, at most
 * tolerance unless the space is too small. Returns TRIBO_OK, or the status of a product that failed. */
int tribo_gmres(size_t n, tribo_product *multiply, void *data, double tolerance, size_t most, double *x, double *part,
                double *work);

#endif
