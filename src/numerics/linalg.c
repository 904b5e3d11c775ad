#include "linalg.h"
#include "common/layout.h"
#include "common/real.h"
#include "common/simd.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_permute_vector.h>

#include "tribo/tribo.h"

double tribo_dot(const double *x, const double *y, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += x[i] * y[i];
    }
    return sum;
}

void tribo_add(double *to, double factor, const double *x, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        to[i] += factor * x[i];
    }
}

TRIBO_SIMD double tribo_sum(size_t n, const double *x)
{
    enum { LANES = 8 }; /* side by side, since one sum would wait for itself */
    double part[LANES] = {0.0}, sum = 0.0;
    size_t i = 0;
    for (; i + LANES <= n; i += LANES) {
        for (size_t k = 0; k < LANES; k++) {
            part[k] += x[i + k];
        }
    }
    for (; i < n; i++) {
        sum += x[i];
    }
    return sum + (((part[0] + part[4]) + (part[1] + part[5])) + ((part[2] + part[6]) + (part[3] + part[7])));
}

double tribo_largest(const double *x, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        most = greater(most, fabs(x[i]));
    }
    return most;
}

/* x - x is zero if x is finite, and NaN otherwise; sums side by side, since one would have to be added up in order. */
TRIBO_SIMD int tribo_dense_finite(const double *x, size_t n)
{
    enum { SUMS = 8 };
    double sum[SUMS] = {0.0};
    size_t i = 0;
    for (; i + SUMS <= n; i += SUMS) {
        for (size_t k = 0; k < SUMS; k++) {
            sum[k] += x[i + k] - x[i + k];
        }
    }
    for (; i < n; i++) {
        sum[0] += x[i] - x[i];
    }
    return sum[0] + sum[1] + (sum[2] + sum[3]) + (sum[4] + sum[5] + (sum[6] + sum[7])) == 0.0;
}

/* c += f[0] b + f[1] (b + n) + ..., four rows of b of length n. */
TRIBO_SIMD static void add_four(double *restrict c, const double *restrict b, size_t n, const double *f)
{
    const double f0 = f[0], f1 = f[1], f2 = f[2], f3 = f[3];
    for (size_t j = 0; j < n; j++) {
        c[j] = (((c[j] + f0 * b[j]) + f1 * b[n + j]) + f2 * b[2 * n + j]) + f3 * b[3 * n + j];
    }
}

/* x'y in eight parts that are added at the end. */
TRIBO_SIMD static double dot_of_eight(size_t n, const double *restrict x, const double *restrict y)
{
    enum { LANES = 8 };
    double part[LANES] = {0.0};
    size_t i = 0;
    for (; i + LANES <= n; i += LANES) {
        for (size_t k = 0; k < LANES; k++) {
            part[k] += x[i + k] * y[i + k];
        }
    }
    for (size_t k = 0; i < n; i++, k++) {
        part[k] += x[i] * y[i];
    }
    return ((part[0] + part[4]) + (part[1] + part[5])) + ((part[2] + part[6]) + (part[3] + part[7]));
}

void tribo_multiply_add(size_t rows, size_t inner, size_t cols, double factor, const double *a, const double *b, double *c)
{
    for (size_t i = 0; i < rows; i++) {
        const double *row = a + i * inner;
        size_t k = 0;
        if (cols == 1) {
            c[i] += factor * dot_of_eight(inner, row, b);
            continue;
        }
        for (; k + 4 <= inner; k += 4) {
            const double f[] = {factor * row[k], factor * row[k + 1], factor * row[k + 2], factor * row[k + 3]};
            if (f[0] != 0.0 || f[1] != 0.0 || f[2] != 0.0 || f[3] != 0.0) {
                add_four(c + i * cols, b + k * cols, cols, f);
            }
        }
        for (; k < inner; k++) {
            tribo_add(c + i * cols, factor * row[k], b + k * cols, cols);
        }
    }
}

void tribo_multiply_transposed_add(size_t rows, size_t inner, size_t cols, const double *a, const double *b, double *c)
{
    size_t k = 0;
    for (; k + 4 <= rows; k += 4) {
        const double *four = a + k * inner;
        if (cols == 1) {
            add_four(c, four, inner, b + k);
            continue;
        }
        for (size_t i = 0; i < inner; i++) {
            const double f[] = {four[i], four[inner + i], four[2 * inner + i], four[3 * inner + i]};
            if (f[0] != 0.0 || f[1] != 0.0 || f[2] != 0.0 || f[3] != 0.0) {
                add_four(c + i * cols, b + k * cols, cols, f);
            }
        }
    }
    for (; k < rows; k++) {
        for (size_t i = 0; i < inner; i++) {
            tribo_add(c + i * cols, a[k * inner + i], b + k * cols, cols);
        }
    }
}

void tribo_multiply_two(size_t rows, size_t inner, size_t cols, const double *a, const double *b, size_t next_b, double *c,
                        size_t next_c)
{
    for (size_t i = 0; cols == 1 && i < rows; i++) {
        c[i] += dot_of_eight(inner, a + i * inner, b);
        c[next_c + i] += dot_of_eight(inner, a + i * inner, b + next_b);
    }
    for (size_t k = 0; cols != 1 && k < 2; k++) {
        tribo_multiply_add(rows, inner, cols, 1.0, a, b + k * next_b, c + k * next_c);
    }
}

void tribo_multiply_transposed_two(size_t rows, size_t inner, size_t cols, const double *a, const double *b, size_t next_b,
                                   double *c, size_t next_c)
{
    const size_t part = cols == 1 ? 4 : rows;
    for (size_t i = 0; i < rows; i += part) {
        for (size_t k = 0; k < 2; k++) {
            const size_t count = rows - i < part ? rows - i : part;
            tribo_multiply_transposed_add(count, inner, cols, a + i * inner, b + k * next_b + i * cols, c + k * next_c);
        }
    }
}

void tribo_transpose(size_t rows, size_t cols, const double *a, double *to)
{
    for (size_t i = 0; i < rows; i++) {
        for (size_t j = 0; j < cols; j++) {
            to[j * rows + i] = a[i * cols + j];
        }
    }
}

void tribo_even_out(size_t n, double *a)
{
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < i; j++) {
            a[i * n + j] = a[j * n + i] = 0.5 * (a[i * n + j] + a[j * n + i]);
        }
    }
}

void tribo_cholesky_free(struct cholesky *c)
{
    free(c->root);
    tribo_sparse_factor_free(c->sparse);
    memset(c, 0, sizeof *c);
}

static void lay_out_cholesky(struct cholesky *c, struct layout *l, int diagonal)
{
    c->root = tribo_layout_array(l, c->n, sizeof *c->root);
    c->order = tribo_layout_array(l, c->n, sizeof *c->order);
    c->factor = diagonal ? NULL : tribo_layout_array(l, c->n * c->n, sizeof *c->factor);
}

/* 0 if out of memory: then c has none. */
static int create_cholesky(struct cholesky *c, size_t n, int diagonal)
{
    struct layout l = {0};
    *c = (struct cholesky){.n = n};
    lay_out_cholesky(c, &l, diagonal);
    if (!tribo_layout_create(&l)) {
        *c = (struct cholesky){0};
        return 0;
    }
    lay_out_cholesky(c, &l, diagonal);
    return 1;
}

int tribo_cholesky_copy(struct cholesky *c, const struct cholesky *from)
{
    if (!from->root) {
        *c = (struct cholesky){.n = from->n};
        return tribo_sparse_factor_copy(&c->sparse, from->sparse);
    }
    if (!create_cholesky(c, from->n, !from->factor)) {
        return 0;
    }
    memcpy(c->root, from->root, from->n * sizeof *c->root);
    memcpy(c->order, from->order, from->n * sizeof *c->order);
    if (from->factor) {
        memcpy(c->factor, from->factor, from->n * from->n * sizeof *c->factor);
    }
    return 1;
}

/* As tribo_cholesky_create; spent as tribo_sparse_factor_create has it. */
static int factorize(struct cholesky *c, const struct matrix *a, struct matrix *spent, size_t *where, double *pivot)
{
    const int diagonal = tribo_matrix_is_diagonal(a);
    memset(c, 0, sizeof *c);
    c->n = a->rows;
    if (!diagonal && tribo_sparse_available() && c->n >= SPARSE_LEAST) {
        *pivot = NAN;
        return tribo_sparse_factor_create(&c->sparse, a, spent, where);
    }
    if (!diagonal && c->n > DENSE_MOST) {
        return TRIBO_ERR_SIZE;
    }
    if (!create_cholesky(c, a->rows, diagonal)) {
        return TRIBO_ERR_MEMORY;
    }
    if (diagonal) {
        for (size_t i = 0; i < c->n; i++) {
            c->order[i] = i;
        }
    } else {
        tribo_matrix_spread(a, c->factor);
        gsl_matrix_view m = gsl_matrix_view_array(c->factor, c->n, c->n);
        gsl_permutation p = {c->n, c->order};
        gsl_linalg_pcholesky_decomp(&m.matrix, &p);
    }
    for (size_t i = 0; i < c->n; i++) {
        const double d = diagonal ? tribo_matrix_get(a, i, i) : c->factor[i * c->n + i];
        if (!(d > 1.0 / DBL_MAX)) { /* looked at first, since neither roots nor quotients may raise exceptions */
            *where = c->order[i];
            *pivot = d;
            tribo_cholesky_free(c);
            return TRIBO_ERR_INDEFINITE;
        }
        c->root[i] = sqrt(d);
    }
    return TRIBO_OK;
}

int tribo_cholesky_create(struct cholesky *c, const struct matrix *a, size_t *where, double *pivot)
{
    return factorize(c, a, NULL, where, pivot);
}

int tribo_cholesky_consume(struct cholesky *c, struct matrix *a, size_t *where, double *pivot)
{
    const int status = factorize(c, a, a, where, pivot);
    tribo_matrix_free(a);
    return status;
}

int tribo_cholesky_solve(const struct cholesky *c, size_t count, double *x)
{
    if (c->sparse) {
        return tribo_sparse_factor_solve(c->sparse, count, x);
    }
    for (size_t k = 0; k < count; k++) {
        tribo_half_solve(c, x + k * c->n, 1);
        tribo_half_solve_back(c, x + k * c->n, 1);
    }
    return 1;
}

static void divide_by_root(const struct cholesky *c, double *x, size_t cols)
{
    for (size_t i = 0; i < c->n; i++) {
        for (size_t j = 0; j < cols; j++) {
            x[i * cols + j] /= c->root[i];
        }
    }
}

void tribo_half_solve(const struct cholesky *c, double *x, size_t cols)
{
    if (c->sparse) {
        tribo_sparse_factor_half_solve(c->sparse, x, cols);
        return;
    }
    if (c->factor && cols) {
        gsl_permutation p = {c->n, c->order};
        gsl_matrix_view l = gsl_matrix_view_array(c->factor, c->n, c->n), b = gsl_matrix_view_array(x, c->n, cols);
        for (size_t j = 0; j < cols; j++) {
            gsl_vector_view column = gsl_matrix_column(&b.matrix, j);
            gsl_permute_vector(&p, &column.vector);
        }
        gsl_blas_dtrsm(CblasLeft, CblasLower, CblasNoTrans, CblasUnit, 1.0, &l.matrix, &b.matrix);
    }
    divide_by_root(c, x, cols);
}

void tribo_half_solve_back(const struct cholesky *c, double *x, size_t cols)
{
    if (c->sparse) {
        tribo_sparse_factor_half_solve_back(c->sparse, x, cols);
        return;
    }
    divide_by_root(c, x, cols);
    if (c->factor && cols) {
        gsl_permutation p = {c->n, c->order};
        gsl_matrix_view l = gsl_matrix_view_array(c->factor, c->n, c->n), b = gsl_matrix_view_array(x, c->n, cols);
        gsl_blas_dtrsm(CblasLeft, CblasLower, CblasTrans, CblasUnit, 1.0, &l.matrix, &b.matrix);
        for (size_t j = 0; j < cols; j++) {
            gsl_vector_view column = gsl_matrix_column(&b.matrix, j);
            gsl_permute_vector_inverse(&p, &column.vector);
        }
    }
}

static void exchange_rows(double *a, size_t cols, size_t i, size_t j)
{
    for (size_t k = 0; i != j && k < cols; k++) {
        const double x = a[i * cols + k];
        a[i * cols + k] = a[j * cols + k];
        a[j * cols + k] = x;
    }
}

/* Row i -= factor times row k, columns first to cols - 1. */
static void subtract_row(double *a, size_t cols, size_t first, size_t i, double factor, size_t k)
{
    double *restrict to = a + i * cols;
    const double *restrict from = a + k * cols;
    for (size_t j = first; factor != 0.0 && j < cols; j++) {
        to[j] -= factor * from[j];
    }
}

double tribo_lu_create(double *a, size_t n, size_t *pivot)
{
    double least = HUGE_VAL;
    for (size_t k = 0; k < n; k++) {
        pivot[k] = k;
        for (size_t i = k + 1; i < n; i++) {
            pivot[k] = fabs(a[i * n + k]) > fabs(a[pivot[k] * n + k]) ? i : pivot[k];
        }
        exchange_rows(a, n, k, pivot[k]);
        const double size = fabs(a[k * n + k]);
        least = size < least ? size : least;
        if (!(size > 0.0)) {
            return 0.0;
        }
        for (size_t i = k + 1; i < n; i++) {
            a[i * n + k] /= a[k * n + k];
            subtract_row(a, n, k + 1, i, a[i * n + k], k);
        }
    }
    return least;
}

void tribo_lu_solve(const double *lu, size_t n, const size_t *pivot, double *x, size_t cols)
{
    for (size_t k = 0; k < n; k++) {
        exchange_rows(x, cols, k, pivot[k]);
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < i; k++) {
            subtract_row(x, cols, 0, i, lu[i * n + k], k);
        }
    }
    for (size_t i = n; i-- > 0;) {
        for (size_t k = i + 1; k < n; k++) {
            subtract_row(x, cols, 0, i, lu[i * n + k], k);
        }
        for (size_t j = 0; j < cols; j++) {
            x[i * cols + j] /= lu[i * n + i];
        }
    }
}

/* By the rotation that leaves nothing off the diagonal (Golub and Van Loan, Matrix Computations, 8.5.2), which knows a small
 * eigenvalue of a graded matrix to rounding of itself. */
static void rotate_two(const double *a, double *values, double *vectors)
{
    const double gap = 0.5 * a[3] - 0.5 * a[0], shared = fabs(a[1]), cot = shared > 0.0 ? quotient(fabs(gap), shared) : 0.0;
    const double size = shared > 0.0 ? 1.0 / (cot + hypot(1.0, cot)) : 0.0, t = (gap >= 0.0) == (a[1] >= 0.0) ? size : -size;
    const double c = 1.0 / hypot(1.0, t);
    const double first = a[0] - t * a[1], second = a[3] + t * a[1];
    const size_t low = first <= second ? 0 : 1, high = 1 - low;
    values[low] = first;
    values[high] = second;
    vectors[low] = vectors[2 + high] = c;
    vectors[high] = t * c;
    vectors[2 + low] = -t * c;
}

int tribo_symmetric_eigen(double *a, size_t n, double *values, double *vectors)
{
    if (n == 2) {
        rotate_two(a, values, vectors);
        return 1;
    }
    if (n == 1) {
        values[0] = a[0];
        vectors[0] = 1.0;
    }
    if (n <= 1) {
        return 1;
    }
    /* gsl_eigen_symmv_alloc would abort if there were no memory */
    double *memory = malloc(4 * n * sizeof *memory);
    if (!memory) {
        return 0;
    }
    gsl_eigen_symmv_workspace work = {n, memory, memory + n, memory + 2 * n, memory + 3 * n};
    gsl_matrix_view m = gsl_matrix_view_array(a, n, n), v = gsl_matrix_view_array(vectors, n, n);
    gsl_vector_view e = gsl_vector_view_array(values, n);
    gsl_eigen_symmv(&m.matrix, &e.vector, &v.matrix, &work);
    gsl_eigen_symmv_sort(&e.vector, &v.matrix, GSL_EIGEN_SORT_VAL_ASC);
    free(memory);
    return 1;
}
