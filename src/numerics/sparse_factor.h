/* Factors of sparse symmetric matrices, by CHOLMOD (Chen, Davis, Hager and Rajamanickam 2008, ACM Trans. Math. Softw. 35, 22,
 * doi:10.1145/1391989.1391995), and how many of their eigenvalues are negative. Each factor has CHOLMOD's state for itself, and
 * rows are ordered by AMD: METIS, which CHOLMOD would take at times, ends the program where there is no memory. */
#ifndef TRIBO_SPARSE_FACTOR_H
#define TRIBO_SPARSE_FACTOR_H

#include "matrix.h"

/* A = P' L L' P. */
struct sparse_factor;

/* 0: the library has been built without CHOLMOD, and the calls below return TRIBO_ERR_UNSUPPORTED. */
int tribo_sparse_available(void);

/* The factor of a positive definite matrix a, of which the lower triangle counts. spent is NULL; or a once more, if nobody needs
 * it any longer: it is freed as soon as it has been read, before the factor takes its memory. tribo_matrix_free of it is fine
 * afterwards, and needed if an error came first. Returns TRIBO_OK, TRIBO_ERR_MEMORY, TRIBO_ERR_UNSUPPORTED, or
 * TRIBO_ERR_INDEFINITE with the row where it shows. */
int tribo_sparse_factor_create(struct sparse_factor **factor, const struct matrix *a, struct matrix *spent, size_t *where);
int tribo_sparse_factor_copy(struct sparse_factor **factor, const struct sparse_factor *from); /* 1, or 0 if out of memory */
void tribo_sparse_factor_free(struct sparse_factor *factor);
size_t tribo_sparse_factor_entries(const struct sparse_factor *factor);

/* count vectors x [count][n] = A^-1 x. 1, or 0 if out of memory, which does not happen to a single one. */
int tribo_sparse_factor_solve(struct sparse_factor *factor, size_t count, double *x);

/* x [n][cols] = L^-1 P x, and x = P' L'^-1 x. */
void tribo_sparse_factor_half_solve(struct sparse_factor *factor, double *x, size_t cols);
void tribo_sparse_factor_half_solve_back(struct sparse_factor *factor, double *x, size_t cols);

/* The inertia of a matrix that may be indefinite, from A + E = P' L D L' P without exchange of rows. */
struct inertia {
    size_t negative; /* eigenvalues of A + E below 0 */
    double growth;   /* the largest sum of |L_ik|^2 |D_k| beside |size_i|: E_ij is rounding of growth sqrt(|size_i size_j|) */
};

/* like      in  the factor of a matrix with the same places of entries, which saves the search for an order, or NULL
 * spent     in  as above
 * size [n]  in  what the diagonal of A has come out of
 * Returns TRIBO_OK, TRIBO_ERR_MEMORY, TRIBO_ERR_UNSUPPORTED, or TRIBO_ERR_INDEFINITE: a pivot is zero, or no number. */
int tribo_sparse_inertia(const struct sparse_factor *like, const struct matrix *a, struct matrix *spent, const double *size,
                         struct inertia *found);

#endif
