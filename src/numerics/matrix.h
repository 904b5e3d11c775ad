/* Real matrices as the right-hand sides multiply with them: compressed rows, and beside them, where that is faster, full
 * diagonals (chains, diagonal matrices) or all entries. */
#ifndef TRIBO_MATRIX_H
#define TRIBO_MATRIX_H

#include <math.h>
#include <stddef.h>

/* Products with matrices, and what goes with them, are done in blocks of so many rows, which stay in the first-level cache. */
enum { MATRIX_BLOCK = 128 };

/* So few rows are multiplied with sooner entry by entry, and have no blocks. */
enum { MATRIX_FEW = 4 };

struct matrix {
    size_t rows, cols;
    size_t *first, *col; /* row i: entries first[i] to first[i+1] - 1, columns ascending; first has the memory of all three */
    double *val;
    size_t diagonals;  /* number of full ones; 0 if `fast` has none, or all entries */
    ptrdiff_t *offset; /* of these, and all that follows: NULL if rows are few */
    size_t *block;     /* of diagonals: where in `fast` each block of rows stands; such as are equal stand in one place */
    double *fast;      /* [blocks that differ][diagonals][MATRIX_BLOCK] or [rows][cols] or NULL */
    int identity;      /* multiplying with it changes nothing */
};

/* All return 1, or 0 if out of memory. The results are zeroed on failure; tribo_matrix_free takes those too. */
int tribo_matrix_from_dense(struct matrix *a, size_t rows, size_t cols, const double *entries);
int tribo_matrix_from_triplets(struct matrix *a, size_t rows, size_t cols, size_t n, const size_t *i, const size_t *j,
                               const double *v);
int tribo_matrix_diagonal(struct matrix *a, size_t n, const double *entries); /* NULL: ones */
int tribo_matrix_copy(struct matrix *a, const struct matrix *from);
int tribo_matrix_transpose(struct matrix *a, const struct matrix *from);
int tribo_matrix_sum(struct matrix *to, double factor, const struct matrix *a, double other, const struct matrix *b);

/* A copy of count things of size bytes each, NULL for NULL. *done becomes 0 if out of memory. */
void *tribo_copy_of(const void *from, size_t count, size_t size, int *done);

void tribo_matrix_free(struct matrix *a);

/* y += |A| |x|, entry by entry. */
void tribo_matrix_add_sizes(const struct matrix *a, const double *x, double *y);

/* Row i of A times x. */
static inline double tribo_matrix_row_dot(const struct matrix *a, size_t i, const double *x)
{
    double sum = 0.0;
    for (size_t k = a->first[i], end = a->first[i + 1]; k < end; k++) {
        sum += a->val[k] * x[a->col[k]];
    }
    return sum;
}

/* The same of absolute values. */
static inline double tribo_matrix_row_size(const struct matrix *a, size_t i, const double *x)
{
    double sum = 0.0;
    for (size_t k = a->first[i], end = a->first[i + 1]; k < end; k++) {
        sum += fabs(a->val[k] * x[a->col[k]]);
    }
    return sum;
}

/* y [end - begin] += factor times rows begin to end - 1 of A x, which are of one block. */
void tribo_matrix_add_rows(const struct matrix *a, size_t begin, size_t end, double factor, const double *x, double *y);

/* The same with y = z - A x, z [end - begin] apart from y. */
void tribo_matrix_subtract_rows(const struct matrix *a, size_t begin, size_t end, const double *x, const double *z, double *y);

/* Whether a matrix has so few rows that a call would take as long as they do; and then, y += factor A x. */
static inline int tribo_matrix_is_small(const struct matrix *a)
{
    return a->rows <= MATRIX_FEW && a->cols <= 4 * MATRIX_FEW;
}

static inline void tribo_matrix_add_few(const struct matrix *a, double factor, const double *x, double *y)
{
    for (size_t i = 0; a->diagonals && i < a->rows; i++) {
        for (size_t k = a->first[i], end = a->first[i + 1]; k < end; k++) {
            y[i] += factor * a->val[k] * x[a->col[k]];
        }
    }
    for (size_t i = 0; !a->diagonals && i < a->rows; i++) {
        y[i] += factor * tribo_matrix_row_dot(a, i, x);
    }
}

/* y = A x. */
void tribo_matrix_multiply(const struct matrix *a, const double *x, double *y);

/* A x, which is x itself or stands in room [rows]. */
const double *tribo_matrix_image(const struct matrix *a, const double *x, double *room);

/* y += factor A x. */
void tribo_matrix_multiply_add(const struct matrix *a, double factor, const double *x, double *y);

/* count vectors y [count][rows] = A x, x [count][cols]: the matrix is read once for some of them. */
void tribo_matrix_multiply_all(const struct matrix *a, size_t count, const double *x, double *y);

/* x'Ay, rounded only at the end: a form may be far smaller than its terms. */
double tribo_matrix_form(const struct matrix *a, const double *x, const double *y);

/* What rounding of the entries of a square A may do to x'Ay: an entry is known to DBL_EPSILON of itself, or of the geometric mean
 * of its two diagonal entries, since it may have come out of sums of that size. root [rows] has the roots of the diagonal, of
 * absolute values, as tribo_matrix_roots finds them. */
void tribo_matrix_roots(const struct matrix *a, double *root);
double tribo_matrix_noise(const struct matrix *a, const double *root, const double *x, const double *y);

/* to [z->cols][z->cols] = Z'AZ of a symmetric A, exactly symmetric. Of a and z, one that has no rows is the identity. 0 if out of
 * memory. */
int tribo_matrix_congruent(const struct matrix *a, const struct matrix *z, double *to);

/* dense [rows][cols] = the entries; the same in memory that the caller frees, or NULL if there is none. */
void tribo_matrix_spread(const struct matrix *a, double *dense);
double *tribo_matrix_to_dense(const struct matrix *a);

/* The same of the transpose: [cols][rows]. */
double *tribo_matrix_transpose_to_dense(const struct matrix *a);

/* Leaves nothing of a symmetric matrix but the lower triangle, and gives back the memory of the rest. */
void tribo_matrix_keep_lower(struct matrix *a);

/* Multiplies row i by factor[i]. */
void tribo_matrix_scale_rows(struct matrix *a, const double *factor);

/* Finds an entry that is not finite, or, with symmetric, one that differs from its mirror image: 1 and its place and values, or
 * 0. */
int tribo_matrix_flaw(const struct matrix *a, int symmetric, size_t *i, size_t *j, double *value, double *mirror);

/* Raises below and above to how many diagonals to either side of the main one A has entries on. */
void tribo_matrix_widen(const struct matrix *a, size_t *below, size_t *above);

/* 1 if no entry is off the diagonal. */
int tribo_matrix_is_diagonal(const struct matrix *a);
/* The largest sum of a row's absolute values: no eigenvalue is larger. 0 without rows. */
double tribo_matrix_row_sum(const struct matrix *a);
double tribo_matrix_get(const struct matrix *a, size_t i, size_t j);

#endif
