/* SPDX-License-Identifier: BSD-3-Clause */
#include "linalg.h"
#include "common/layout.h"
#include "common/real.h"
#include "common/simd.h"
#include "lapack.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tribo/tribo.h"

enum { LANES = 8 };

static inline double sum_of_eight(const double *part)
{
    return ((part[0] + part[4]) + (part[1] + part[5])) + ((part[2] + part[6]) + (part[3] + part[7]));
}

/* Returns x_i y_i z_i, or its size; y and z may be NULL. */
static inline double term_of(size_t i, const double *x, const double *y, const double *z, int size)
{
    const double one = y ? x[i] * y[i] : x[i], term = z ? one * z[i] : one;
    return size ? fabs(term) : term;
}

static inline double terms_of_eight(size_t n, const double *restrict x, const double *restrict y, const double *restrict z,
                                    int sizes)
{
    double part[LANES] = {0.0};
    size_t i = 0;
    for (; i + LANES <= n; i += LANES) {
        for (size_t k = 0; k < LANES; k++) {
            part[k] += term_of(i + k, x, y, z, sizes);
        }
    }
    for (size_t k = 0; i < n; i++, k++) {
        part[k] += term_of(i, x, y, z, sizes);
    }
    return sum_of_eight(part);
}

TRIBO_SIMD double tribo_dot_of_eight(size_t n, const double *x, const double *y)
{
    return terms_of_eight(n, x, y, NULL, 0);
}

TRIBO_SIMD double tribo_size_of_eight(size_t n, const double *x, const double *y)
{
    return terms_of_eight(n, x, y, NULL, 1);
}

TRIBO_SIMD double tribo_sum(size_t n, const double *x)
{
    return terms_of_eight(n, x, NULL, NULL, 0);
}

TRIBO_SIMD double tribo_dot_of_three(size_t n, const double *x, const double *y, const double *z)
{
    return terms_of_eight(n, x, y, z, 0);
}

void tribo_add(double *to, double factor, const double *x, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        to[i] += factor * x[i];
    }
}

TRIBO_SIMD int tribo_many_finite(const double *x, size_t n)
{
    int finite = 1;
    for (size_t i = 0; i < n; i++) {
        finite &= isfinite(x[i]) != 0;
    }
    return finite;
}

/* c [n] += f_0 b_0 + f_1 b_1 + f_2 b_2 + f_3 b_3 for the rows b_k of b [4][n]. */
TRIBO_SIMD static void add_four(double *restrict c, const double *restrict b, size_t n, const double *f)
{
    const double f0 = f[0], f1 = f[1], f2 = f[2], f3 = f[3];
    for (size_t j = 0; j < n; j++) {
        c[j] = (((c[j] + f0 * b[j]) + f1 * b[n + j]) + f2 * b[2 * n + j]) + f3 * b[3 * n + j];
    }
}

/* c [4] += factor times the sums of tribo_dot_of_eight for the rows of a [4][n]; four rows side by side, since each sum waits for
 * itself. */
TRIBO_SIMD static void add_four_dots(size_t n, double factor, const double *restrict a, const double *restrict x,
                                     double *restrict c)
{
    enum { ROWS = 4 };
    double part[ROWS][LANES] = {{0.0}};
    size_t i = 0;
    for (; i + LANES <= n; i += LANES) {
        for (size_t k = 0; k < LANES; k++) {
            part[0][k] += a[i + k] * x[i + k];
            part[1][k] += a[n + i + k] * x[i + k];
            part[2][k] += a[2 * n + i + k] * x[i + k];
            part[3][k] += a[3 * n + i + k] * x[i + k];
        }
    }
    for (size_t row = 0; row < ROWS; row++) {
        double *p = part[row];
        for (size_t k = 0; i + k < n; k++) {
            p[k] += a[row * n + i + k] * x[i + k];
        }
        c[row] += factor * sum_of_eight(p);
    }
}

void tribo_multiply_add(size_t rows, size_t inner, size_t cols, double factor, const double *a, const double *b, double *c)
{
    size_t i = 0;
    if (cols == 1 && inner < LANES) {
        for (; i < rows; i++) {
            c[i] += factor * tribo_dot(a + i * inner, b, inner);
        }
        return;
    }
    for (; cols == 1 && i + 4 <= rows; i += 4) {
        add_four_dots(inner, factor, a + i * inner, b, c + i);
    }
    for (; cols > 0 && i < rows; i++) {
        const double *row = a + i * inner;
        size_t k = 0;
        if (cols == 1) {
            c[i] += factor * tribo_dot_of_eight(inner, row, b);
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
    if (cols == 1) {
        tribo_multiply_add(1, rows, inner, 1.0, b, a, c);
        return;
    }
    for (; k + 4 <= rows; k += 4) {
        for (size_t i = 0; i < inner; i++) {
            const double *four = a + k * inner + i, f[] = {four[0], four[inner], four[2 * inner], four[3 * inner]};
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
    if (c->sparse) {
        tribo_cholmod->destroy(c->sparse);
    }
    memset(c, 0, sizeof *c);
}

int tribo_cholesky_create(struct cholesky *c, const struct matrix *a, struct matrix *spent, size_t *where, double *pivot)
{
    const int diagonal = tribo_matrix_is_diagonal(a), rows = (int)a->rows;
    int status = TRIBO_OK, info = 0; /* the row of a pivot that is not positive, plus 1: the pivot stands on the diagonal */
    *c = (struct cholesky){.n = a->rows};
    if (!diagonal && tribo_cholmod && c->n >= SPARSE_LEAST) {
        *pivot = (double)NAN;
        status = tribo_cholmod->create(&c->sparse, a, spent, where);
    } else if (!diagonal && c->n > DENSE_MOST) {
        status = TRIBO_ERR_SIZE;
    } else {
        status = ALLOCATE(ARRAY(c->root, c->n), ARRAY(c->factor, diagonal ? 0 : c->n * c->n)) ? TRIBO_OK : TRIBO_ERR_MEMORY;
        c->factor = diagonal ? NULL : c->factor;
    }
    if (c->factor) {
        tribo_matrix_spread(a, c->factor);
        dpotrf_("U", &rows, c->factor, &rows, &info, 1);
    }
    for (size_t i = 0; c->root && i < c->n; i++) {
        const double own = diagonal ? tribo_matrix_get(a, i, i) : c->factor[i * (c->n + 1)];
        const double d = diagonal || i + 1 == (size_t)info ? own : own * own;
        if (d > 1.0 / DBL_MAX) {
            c->root[i] = sqrt(d);
        } else {
            *where = i;
            *pivot = d;
            tribo_cholesky_free(c);
            status = TRIBO_ERR_INDEFINITE;
        }
    }
    if (spent) {
        tribo_matrix_free(spent);
    }
    return status;
}

int tribo_cholesky_solve(const struct cholesky *c, size_t count, double *x)
{
    if (c->sparse) {
        return tribo_cholmod->solve(c->sparse, count, x);
    }
    for (size_t k = 0; k < count; k++) {
        tribo_half_solve(c, 0, x + k * c->n, 1);
        tribo_half_solve(c, 1, x + k * c->n, 1);
    }
    return 1;
}

void tribo_half_solve(const struct cholesky *c, int back, double *x, size_t cols)
{
    const double one = 1.0;
    const int n = (int)c->n, count = (int)cols;
    if (c->sparse && cols) {
        tribo_cholmod->half_solve(c->sparse, back, x, cols);
    } else if (c->factor && c->n && cols) {
        dtrsm_("R", "U", back ? "T" : "N", "N", &count, &n, &one, c->factor, &n, x, &count, 1, 1, 1, 1);
    }
    for (size_t i = 0; c->root && !c->factor && i < c->n; i++) {
        for (size_t j = 0; j < cols; j++) {
            x[i * cols + j] /= c->root[i];
        }
    }
}

double tribo_lu_create(double *a, size_t n, int *pivot)
{
    const int rows = (int)n;
    double least = HUGE_VAL;
    int info = 0;
    if (n == 0) {
        return HUGE_VAL;
    }
    if (!tribo_lapack_takes(n) || !tribo_dense_finite(a, n * n)) {
        return 0.0;
    }
    dgetrf_(&rows, &rows, a, &rows, pivot, &info);
    for (size_t k = 0; k < n; k++) {
        const double size = fabs(a[k * n + k]);
        least = size < least ? size : least;
    }
    return info == 0 && tribo_dense_finite(a, n * n) ? least : 0.0;
}

void tribo_lu_solve(const double *lu, size_t n, const int *pivot, double *x, size_t cols)
{
    const int rows = (int)n, count = (int)cols;
    const double one = 1.0;
    if (n == 0 || cols == 0) {
        return;
    }
    dtrsm_("R", "U", "N", "N", &count, &rows, &one, lu, &rows, x, &count, 1, 1, 1, 1);
    dtrsm_("R", "L", "N", "U", &count, &rows, &one, lu, &rows, x, &count, 1, 1, 1, 1);
    for (size_t k = n; k-- > 0;) {
        tribo_exchange(x + k * cols, x + (size_t)(pivot[k] - 1) * cols, cols, 1);
    }
}

int tribo_symmetric_eigen(double *a, size_t n, double *values)
{
    enum { BLOCK = 32 };
    if (n == 0) {
        return TRIBO_OK;
    }
    const int rows = (int)n, size = (2 + BLOCK) * rows;
    double *work = tribo_lapack_takes(n) ? malloc((size_t)size * sizeof *work) : NULL;
    int info;
    if (!work) {
        return TRIBO_ERR_MEMORY;
    }
    /* QL from the first column on: where entries of a decrease along the diagonal, small entries of eigenvectors are exact to
     * their own rounding, as residuals in Krylov spaces need. Divide and conquer is exact to rounding of the largest one only. */
    dsyev_("V", "L", &rows, a, &rows, values, work, &size, &info, 1, 1);
    free(work);
    for (size_t k = 0; k < n; k++) {
        size_t most = 0; /* its sign is positive, with every LAPACK */
        for (size_t i = 1; i < n; i++) {
            most = fabs(a[k * n + i]) > fabs(a[k * n + most]) ? i : most;
        }
        const double sign = a[k * n + most] < 0.0 ? -1.0 : 1.0;
        for (size_t i = 0; i < n; i++) {
            a[k * n + i] *= sign;
        }
    }
    return info ? TRIBO_ERR_NO_CONVERGENCE : TRIBO_OK;
}

int tribo_symmetric_eigen_by(const struct cholesky *b, double *a, size_t n, double *values, double *vectors)
{
    tribo_half_solve(b, 0, a, n);
    tribo_transpose(n, n, a, vectors);
    tribo_half_solve(b, 0, vectors, n);
    if (!tribo_dense_finite(vectors, n * n)) {
        return TRIBO_ERR_NOT_FINITE;
    }
    const int status = tribo_symmetric_eigen(vectors, n, values);
    tribo_transpose(n, n, vectors, a);
    tribo_half_solve(b, 1, a, n);
    tribo_transpose(n, n, a, vectors);
    return status;
}

int tribo_eigen(double *a, size_t n, double *re, double *im, double *x)
{
    if (n == 0 || !tribo_dense_finite(a, n * n)) {
        return n ? TRIBO_ERR_NOT_FINITE : TRIBO_OK;
    }
    enum { BLOCK = 32 };
    const int rows = (int)n, one = 1, size = (4 + BLOCK) * rows;
    double *work = tribo_lapack_takes(n) ? malloc((size_t)size * sizeof *work) : NULL;
    int info;
    if (!work) {
        return TRIBO_ERR_MEMORY;
    }
    /* Left eigenvectors of the transpose are the conjugates of the right ones of A. */
    dgeev_(x ? "V" : "N", "N", &rows, a, &rows, re, im, x, &rows, NULL, &one, work, &size, &info, 1, 1);
    free(work);
    for (size_t k = 0; x && info == 0 && k < n; k++) {
        for (size_t i = 0; im[k] < 0.0 && i < n; i++) {
            x[k * n + i] = -x[k * n + i];
        }
    }
    return info ? TRIBO_ERR_NO_CONVERGENCE : TRIBO_OK;
}

int tribo_least_norm_solve(double *a, size_t n, double cut, double *x, size_t *kernel)
{
    const int rows = (int)n, size = 6 * rows + 1;
    double *v = tribo_lapack_takes(n) ? calloc(n * n + 8 * n + 1, sizeof *v) : NULL, unused;
    int info = 1, one = 1;
    size_t zeros = 0;
    if (!v) {
        return 0;
    }
    double *value = v + n * n, *part = value + n, *work = part + n;
    /* By columns a is A' = sum_k value_k u_k v_k': u_k replaces row k of a, and v [n][n] has v_k in column k. */
    if (n && tribo_dense_finite(a, n * n)) {
        dgesvd_("O", "A", &rows, &rows, a, &rows, value, &unused, &one, v, &rows, work, &size, &info, 1, 1);
    }
    tribo_multiply_transposed_add(info ? 0 : n, n, 1, v, x, part);
    for (size_t k = 0; k < n; k++) {
        zeros += !info && value[k] < cut;
        part[k] = info || value[k] < cut ? 0.0 : part[k] / value[k];
        x[k] = info ? (double)NAN : 0.0;
    }
    tribo_multiply_transposed_add(info ? 0 : n, n, 1, a, part, x);
    free(v);
    if (kernel) {
        *kernel = zeros;
    }
    return 1;
}

/* ---------------------------------------------------------------------------------------------------------------- GMRES */

size_t tribo_gmres_room(size_t n, size_t most)
{
    return (most + 1) * (n + most + 4);
}

/* (a, b) = (c a + s b, c b - s a). */
static void rotate_pair(double c, double s, double *a, double *b)
{
    const double x = *a;
    *a = c * x + s * *b;
    *b = c * *b - s * x;
}

/* Makes v_k orthonormal to v_0 ... v_k-1, v [k + 1][n]: v_k = sum_i h_i v_i before. */
static void orthonormalize(size_t n, size_t k, double *v, double *h)
{
    double *last = v + k * n;
    memset(h, 0, (k + 1) * sizeof *h);
    for (int again = 0; again < 2; again++) {
        for (size_t i = 0; i < k; i++) {
            const double part = tribo_dot(v + i * n, last, n);
            h[i] += part;
            tribo_add(last, -part, v + i * n, n);
        }
    }
    h[k] = sqrt(tribo_dot(last, last, n));
    for (size_t i = 0; i < n && h[k] > 0.0; i++) {
        last[i] /= h[k];
    }
}

int tribo_gmres(size_t n, tribo_product *multiply, void *data, double tolerance, size_t most, double *x, double *part,
                double *work)
{
    const size_t rows = most + 1;
    double *v = work, *r = v + rows * n, *c = r + rows * rows, *s = c + rows, *rhs = s + rows; /* r by columns */
    const double size = sqrt(tribo_dot(x, x, n));
    size_t count = 0;
    *part = size > 0.0 ? 1.0 : 0.0;
    rhs[0] = size;
    for (size_t i = 0; i < n; i++) {
        v[i] = size > 0.0 ? x[i] / size : 0.0;
    }
    while (*part > tolerance && count < most) {
        double *h = r + count * rows;
        memcpy(v + (count + 1) * n, v + count * n, n * sizeof *v);
        const int status = multiply(data, v + (count + 1) * n);
        if (status) {
            return status;
        }
        orthonormalize(n, count + 1, v, h);
        for (size_t i = 0; i < count; i++) {
            rotate_pair(c[i], s[i], &h[i], &h[i + 1]);
        }
        const double length = hypot(h[count], h[count + 1]);
        if (!(length > 0.0)) {
            break;
        }
        c[count] = h[count] / length;
        s[count] = h[count + 1] / length;
        h[count] = length;
        rhs[count + 1] = 0.0;
        rotate_pair(c[count], s[count], &rhs[count], &rhs[count + 1]);
        count++;
        *part = fabs(rhs[count]) / size;
    }
    memset(x, 0, n * sizeof *x);
    for (size_t k = count; k-- > 0;) {
        rhs[k] /= r[k * rows + k];
        for (size_t i = 0; i < k; i++) {
            rhs[i] -= r[k * rows + i] * rhs[k];
        }
        tribo_add(x, rhs[k], v + k * n, n);
    }
    return 0;
}
