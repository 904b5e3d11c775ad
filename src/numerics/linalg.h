/* Dense matrices and their factors. */
#ifndef TRIBO_LINALG_H
#define TRIBO_LINALG_H

#include "matrix.h"
#include "sparse_factor.h"

/* x'y; the largest |x_i|; to += factor x; 1 if no x is an infinity or a NaN. All [n]. */
double tribo_dot(const double *x, const double *y, size_t n);
double tribo_largest(const double *x, size_t n);
void tribo_add(double *to, double factor, const double *x, size_t n);
int tribo_dense_finite(const double *x, size_t n);

/* The sum of x [n], in eight parts that are added at the end. */
double tribo_sum(size_t n, const double *x);

/* tribo_dense_finite without a call where there are few. */
static inline int tribo_few_finite(const double *x, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; n < 8 && i < n; i++) {
        sum += x[i] - x[i];
    }
    return n < 8 ? sum == 0.0 : tribo_dense_finite(x, n);
}

/* c [rows][cols] += factor a b, a [rows][inner], b [inner][cols], skipping zeros of a, of which diagonal operators have many;
 * c [inner][cols] += a'b, b [rows][cols]; to [cols][rows] = the transpose of a [rows][cols]. */
void tribo_multiply_add(size_t rows, size_t inner, size_t cols, double factor, const double *a, const double *b, double *c);
void tribo_multiply_transposed_add(size_t rows, size_t inner, size_t cols, const double *a, const double *b, double *c);
void tribo_transpose(size_t rows, size_t cols, const double *a, double *to);

/* The same with two b and two c, one after the other from b + next_b and c + next_c on: a is read once if cols is 1. */
void tribo_multiply_two(size_t rows, size_t inner, size_t cols, const double *a, const double *b, size_t next_b, double *c,
                        size_t next_c);
void tribo_multiply_transposed_two(size_t rows, size_t inner, size_t cols, const double *a, const double *b, size_t next_b,
                                   double *c, size_t next_c);

/* a [n][n], symmetric but for rounding, becomes exactly so. */
void tribo_even_out(size_t n, double *a);

/* Matrices that are not diagonal are factored as sparse ones from SPARSE_LEAST rows on, if the library can do that; if not, dense
 * ones may have DENSE_MOST. */
#define SPARSE_LEAST 200
#define DENSE_MOST 3000

/* A^-1 = S S'. Dense: S = P' L'^-1 from P A P' = L L', with L in the lower triangle of factor. A diagonal A has only root, a
 * sparse one neither. */
struct cholesky {
    size_t n; /* 0: the identity */
    double *factor;
    size_t *pivot; /* [n] P exchanges row k and row pivot[k] >= k, for k = 0, 1, ... */
    double *root;  /* [n] the diagonal of L; has the memory of all three */
    struct sparse_factor *sparse;
};

/* Returns TRIBO_OK, TRIBO_ERR_MEMORY, TRIBO_ERR_SIZE (more than DENSE_MOST rows), or TRIBO_ERR_INDEFINITE with the place of a
 * pivot that is not positive, and its value, NaN if that is not known. */
int tribo_cholesky_create(struct cholesky *c, const struct matrix *a, size_t *where, double *pivot);
int tribo_cholesky_consume(struct cholesky *c, struct matrix *a, size_t *where, double *pivot); /* and frees a, error or not */
int tribo_cholesky_copy(struct cholesky *c, const struct cholesky *from);                       /* 1, or 0 if out of memory */
void tribo_cholesky_free(struct cholesky *c);

/* The row of A that the k-th pivot belongs to, of a factor with root. */
size_t tribo_cholesky_row(const struct cholesky *c, size_t k);

/* count vectors x [count][n] = A^-1 x. 1, or 0 if out of memory, which does not happen to a single one. */
int tribo_cholesky_solve(const struct cholesky *c, size_t count, double *x);

/* x [n][cols] = S' x, and x = S x; one after the other they solve A y = x. */
void tribo_half_solve(const struct cholesky *c, double *x, size_t cols);
void tribo_half_solve_back(const struct cholesky *c, double *x, size_t cols);

/* Factors of a [n][n] with its columns exchanged, in place; pivot [n]. Returns the smallest pivot's size: 0 if a is singular, or
 * not finite, and then there are no factors. */
double tribo_lu_create(double *a, size_t n, int *pivot);

/* x [n][cols] = A^-1 x. */
void tribo_lu_solve(const double *lu, size_t n, const int *pivot, double *x, size_t cols);

/* Eigenvalues (ascending) and orthonormal eigenvectors (columns) of a symmetric a [n][n], which is overwritten. Returns TRIBO_OK,
 * TRIBO_ERR_MEMORY, TRIBO_ERR_NO_CONVERGENCE. */
int tribo_symmetric_eigen(double *a, size_t n, double *values, double *vectors);

#endif
