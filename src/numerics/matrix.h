/* SPDX-License-Identifier: BSD-3-Clause */
/* Real matrices in compressed rows, and, for chains and diagonal matrices, the same entries by diagonals, with which products are
 * two to three times as fast. */
#ifndef TRIBO_MATRIX_H
#define TRIBO_MATRIX_H

#include <math.h>
#include <stddef.h>

/* Rows of a block: products, and loops that go with them, pass over blocks, which stay in the first-level cache. */
enum { MATRIX_BLOCK = 128 };

/* Matrices of at most MATRIX_FEW rows are multiplied entry by entry, and have no blocks. */
enum { MATRIX_FEW = 4 };

struct matrix {
    size_t rows, cols;
    size_t *first; /* [rows + 1] row i has the entries first[i] to first[i + 1] - 1; owns the memory of col and val */
    size_t *col;   /* columns, ascending in each row */
    double *val;
    size_t diagonals;  /* diagonals that hold all entries; 0: too many, or mostly empty */
    ptrdiff_t *offset; /* [diagonals] j - i, ascending; NULL if rows are few; owns the memory of block and fast */
    size_t *block;     /* [blocks] places in fast; equal neighbouring blocks share one place */
    double *fast;      /* [places][diagonals][MATRIX_BLOCK] entries by diagonals */
};

/* Entries in any order, collected one by one. */
struct triplets {
    size_t count, room;
    struct triplet {
        size_t row, col;
        double value;
    } * entry;
    int failed; /* 1: out of memory */
};

/* Appends the entry (i, j), unless v is 0. */
void tribo_triplets_put(struct triplets *t, size_t i, size_t j, double v);

/* Appends row i of a as a part of row `row`. */
void tribo_triplets_put_row(struct triplets *t, size_t row, const struct matrix *a, size_t i);

/* to [rows][cols] = the matrix of the entries; frees t. Returns 1, or 0 if out of memory, also in an earlier call. */
int tribo_triplets_finish(struct triplets *t, size_t rows, size_t cols, struct matrix *to);

/* Each returns 1, or 0 with a zeroed if out of memory. tribo_matrix_free takes a zeroed a. */
int tribo_matrix_from_dense(struct matrix *a, size_t rows, size_t cols, const double *entries);
int tribo_matrix_diagonal(struct matrix *a, size_t n, const double *entries); /* NULL: ones */
int tribo_matrix_copy(struct matrix *a, const struct matrix *from);
int tribo_matrix_transpose(struct matrix *a, const struct matrix *from);
int tribo_matrix_sum(struct matrix *to, double factor, const struct matrix *a, double other, const struct matrix *b);

/* Returns a copy of count objects of size bytes, or NULL for NULL. Sets *done = 0 if out of memory. */
void *tribo_copy_of(const void *from, size_t count, size_t size, int *done);

void tribo_matrix_free(struct matrix *a);

/* y += |A| |x|. */
void tribo_matrix_add_sizes(const struct matrix *a, const double *x, double *y);

/* Columns from which rows without zeros are multiplied by tribo_multiply_add. */
enum { MATRIX_WIDE = 32 };

/* Return x'y, and |x|'|y|, summed in eight parts. In linalg.c. */
double tribo_dot_of_eight(size_t n, const double *x, const double *y);
double tribo_size_of_eight(size_t n, const double *x, const double *y);

/* Returns x'y. A call for a few numbers takes longer than their sum. */
static inline double tribo_dot(const double *x, const double *y, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; n < 8 && i < n; i++) {
        sum += x[i] * y[i];
    }
    return n < 8 ? sum : tribo_dot_of_eight(n, x, y);
}

/* Returns (A x)_i. */
static inline double tribo_matrix_row_dot(const struct matrix *a, size_t i, const double *x)
{
    double sum = 0.0;
    for (size_t k = a->first[i], end = a->first[i + 1]; k < end; k++) {
        sum += a->val[k] * x[a->col[k]];
    }
    return sum;
}

/* Returns (|A| |x|)_i. */
static inline double tribo_matrix_row_size(const struct matrix *a, size_t i, const double *x)
{
    double sum = 0.0;
    for (size_t k = a->first[i], end = a->first[i + 1]; k < end; k++) {
        sum += fabs(a->val[k] * x[a->col[k]]);
    }
    return sum;
}

/* x [cols] += factor times row i of A. */
static inline void tribo_matrix_add_row(const struct matrix *a, size_t i, double factor, double *x)
{
    for (size_t k = a->first[i], end = a->first[i + 1]; k < end; k++) {
        x[a->col[k]] += factor * a->val[k];
    }
}

/* Sets x [cols] = row i of A. */
void tribo_matrix_get_row(const struct matrix *a, size_t i, double *x);

/* y [end - begin] = z + factor times rows begin to end - 1 of A x; z [end - begin]: y, or no part of y. The rows lie in one
 * block. */
void tribo_matrix_add_rows(const struct matrix *a, size_t begin, size_t end, double factor, const double *x, const double *z,
                           double *y);

/* y = A x. */
void tribo_matrix_multiply(const struct matrix *a, const double *x, double *y);

/* y += factor A x. */
void tribo_matrix_multiply_add(const struct matrix *a, double factor, const double *x, double *y);

/* to [rows][columns] += factor A x, x [cols][columns]. */
void tribo_matrix_add_columns(const struct matrix *a, double factor, size_t columns, const double *x, double *to);

/* to [cols][columns] += factor A'x, x [rows][columns]. */
void tribo_matrix_add_transposed(const struct matrix *a, double factor, size_t columns, const double *x, double *to);

/* y [count][rows] = A x of count vectors x [count][cols]. */
void tribo_matrix_multiply_all(const struct matrix *a, size_t count, const double *x, double *y);

/* Returns x'Ay, summed with twice as many digits: a form may be far smaller than its terms. */
double tribo_matrix_form(const struct matrix *a, const double *x, const double *y);

/* root_i = sqrt(max(|a_ii|, terms_i)), all [rows]; terms: sizes of the terms of which a_ii is the sum, or NULL. */
void tribo_matrix_roots(const struct matrix *a, const double *terms, double *root);

/* Returns a bound on the error of x'Ay if entry a_ij has the error DBL_EPSILON max(|a_ij|, root_i root_j): it may be a sum of
 * terms of the size of a_ii and a_jj. */
double tribo_matrix_noise(const struct matrix *a, const double *root, const double *x, const double *y);

/* to [z->cols][z->cols] = Z'AZ of a symmetric A, exactly symmetric. Z without rows: the identity. Returns 1, or 0 if out of
 * memory. */
int tribo_matrix_congruent(const struct matrix *a, const struct matrix *z, double *to);

/* dense [rows][cols] = A. */
void tribo_matrix_spread(const struct matrix *a, double *dense);

/* Returns A [rows][cols] in memory of the caller's, or NULL if out of memory. */
double *tribo_matrix_to_dense(const struct matrix *a);

/* Multiplies row i by factor[i]. */
void tribo_matrix_scale_rows(struct matrix *a, const double *factor);

/* Returns 1 and the place and value of an entry that is not finite, or, if symmetric = 1, of an entry that differs from its
 * mirror image; 0 if there is none. */
int tribo_matrix_flaw(const struct matrix *a, int symmetric, size_t *i, size_t *j, double *value, double *mirror);

/* Returns 1 if all entries off the diagonal are 0. */
int tribo_matrix_is_diagonal(const struct matrix *a);

/* Returns max_i sum_j |a_ij|, which no eigenvalue exceeds; 0 without rows. */
double tribo_matrix_row_sum(const struct matrix *a);

/* Returns the entry (i, j). */
double tribo_matrix_get(const struct matrix *a, size_t i, size_t j);

#endif
