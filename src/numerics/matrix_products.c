/* Products with real matrices. */
#include "matrix.h"
#include "common/real.h"
#include "common/simd.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* y [rows] += factor times rows `begin` and following of A x, all of one block and with all diagonals inside the matrix, from
 * diagonal d on. Three diagonals at a time, so that y is passed over as seldom as can be, but in the order of one after the
 * other. */
static inline void add_diagonals(const struct matrix *a, size_t d, size_t begin, size_t rows, double factor, const double *x,
                                 double *restrict y)
{
    const double *restrict val = a->fast + a->block[begin / MATRIX_BLOCK] + begin % MATRIX_BLOCK, *restrict at = x + begin;
    for (; d + 3 <= a->diagonals; d += 3) {
        const double *restrict u = val + d * MATRIX_BLOCK, *restrict v = u + MATRIX_BLOCK, *restrict w = v + MATRIX_BLOCK;
        const double *restrict p = at + a->offset[d], *restrict q = at + a->offset[d + 1], *restrict r = at + a->offset[d + 2];
        for (size_t i = 0; i < rows; i++) {
            y[i] = ((y[i] + factor * u[i] * p[i]) + factor * v[i] * q[i]) + factor * w[i] * r[i];
        }
    }
    for (; d < a->diagonals; d++) {
        const double *restrict u = val + d * MATRIX_BLOCK, *restrict p = at + a->offset[d];
        for (size_t i = 0; i < rows; i++) {
            y[i] += factor * u[i] * p[i];
        }
    }
}

/* A factor of 1 or -1 is no product, and the compiler knows. */
TRIBO_SIMD static void add_inner_rows(const struct matrix *a, size_t d, size_t begin, size_t rows, double factor, const double *x,
                                      double *restrict y)
{
    if (factor == -1.0) {
        add_diagonals(a, d, begin, rows, -1.0, x, y);
    } else if (factor == 1.0) {
        add_diagonals(a, d, begin, rows, 1.0, x, y);
    } else {
        add_diagonals(a, d, begin, rows, factor, x, y);
    }
}

/* y [rows] = z minus three diagonals val [3][MATRIX_BLOCK], which are multiplied with p, q and r. */
TRIBO_SIMD static void subtract_three(size_t rows, const double *restrict z, const double *restrict val, const double *restrict p,
                                      const double *restrict q, const double *restrict r, double *restrict y)
{
    const double *restrict u = val, *restrict v = val + MATRIX_BLOCK, *restrict w = v + MATRIX_BLOCK;
    for (size_t i = 0; i < rows; i++) {
        y[i] = ((z[i] - u[i] * p[i]) - v[i] * q[i]) - w[i] * r[i];
    }
}

/* The same as add_inner_rows with y = z - A x: chains, which have three diagonals, pass over everything once. */
static void subtract_inner_rows(const struct matrix *a, size_t begin, size_t rows, const double *x, const double *z, double *y)
{
    const double *val = a->fast + a->block[begin / MATRIX_BLOCK] + begin % MATRIX_BLOCK, *at = x + begin;
    const size_t done = a->diagonals < 3 ? 0 : 3;
    if (done) {
        subtract_three(rows, z, val, at + a->offset[0], at + a->offset[1], at + a->offset[2], y);
    } else {
        memcpy(y, z, rows * sizeof *y);
    }
    if (a->diagonals > done) {
        add_inner_rows(a, done, begin, rows, -1.0, x, y);
    }
}

/* The first row, and the one behind the last, all of whose diagonals lie inside the matrix. */
static size_t inner_begin(const struct matrix *a)
{
    return a->offset[0] < 0 ? (size_t)-a->offset[0] : 0;
}

static size_t inner_end(const struct matrix *a)
{
    const ptrdiff_t last = a->offset[a->diagonals - 1], room = (ptrdiff_t)a->cols - last;
    return room < 0 ? 0 : (size_t)room < a->rows ? (size_t)room : a->rows;
}

static size_t product_between(size_t i, size_t least, size_t most)
{
    return i < least ? least : i > most ? most : i;
}

/* The same entry by entry. */
static void add_outer_rows(const struct matrix *a, size_t begin, size_t end, double factor, const double *x, double *y)
{
    for (size_t i = begin; i < end; i++, y++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            *y += factor * a->val[k] * x[a->col[k]];
        }
    }
}

static void add_banded_rows(const struct matrix *a, size_t begin, size_t end, double factor, const double *x, double *y)
{
    const size_t first = product_between(inner_begin(a), begin, end), last = product_between(inner_end(a), first, end);
    add_outer_rows(a, begin, first, factor, x, y);
    add_inner_rows(a, 0, first, last - first, factor, x, y + (first - begin));
    add_outer_rows(a, last, end, factor, x, y + (last - begin));
}

static double product_dense_dot(size_t n, const double *restrict val, const double *restrict x)
{
    double sum = 0.0;
    for (size_t j = 0; j < n; j++) {
        sum += val[j] * x[j];
    }
    return sum;
}

void tribo_matrix_add_rows(const struct matrix *a, size_t begin, size_t end, double factor, const double *x, double *y)
{
    if (a->diagonals) {
        (end - begin > MATRIX_FEW ? add_banded_rows : add_outer_rows)(a, begin, end, factor, x, y);
        return;
    }
    for (size_t i = begin; i < end; i++) {
        y[i - begin] += factor * (a->fast ? product_dense_dot(a->cols, a->fast + i * a->cols, x) : tribo_matrix_row_dot(a, i, x));
    }
}

static void subtract_outer_rows(const struct matrix *a, size_t begin, size_t end, const double *x, const double *z, double *y)
{
    for (size_t i = begin; i < end; i++, y++, z++) {
        *y = *z;
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            *y -= a->val[k] * x[a->col[k]];
        }
    }
}

void tribo_matrix_subtract_rows(const struct matrix *a, size_t begin, size_t end, const double *x, const double *z, double *y)
{
    const int banded = a->diagonals && end - begin > MATRIX_FEW;
    const size_t first = banded ? product_between(inner_begin(a), begin, end) : end,
                 last = banded ? product_between(inner_end(a), first, end) : end;
    if (!banded && a->fast && !a->diagonals) {
        for (size_t i = begin; i < end; i++) {
            y[i - begin] = z[i - begin] - product_dense_dot(a->cols, a->fast + i * a->cols, x);
        }
        return;
    }
    subtract_outer_rows(a, begin, first, x, z, y);
    if (last > first) {
        subtract_inner_rows(a, first, last - first, x, z + (first - begin), y + (first - begin));
    }
    subtract_outer_rows(a, last, end, x, z + (last - begin), y + (last - begin));
}

void tribo_matrix_add_sizes(const struct matrix *a, const double *x, double *y)
{
    for (size_t i = 0; i < a->rows; i++) {
        y[i] += tribo_matrix_row_size(a, i, x);
    }
}

void tribo_matrix_multiply_add(const struct matrix *a, double factor, const double *x, double *y)
{
    if (tribo_matrix_is_small(a)) {
        tribo_matrix_add_few(a, factor, x, y);
        return;
    }
    for (size_t i = 0; i < a->rows; i += MATRIX_BLOCK) {
        const size_t end = a->rows - i < MATRIX_BLOCK ? a->rows : i + MATRIX_BLOCK;
        tribo_matrix_add_rows(a, i, end, factor, x, y + i);
    }
}

void tribo_matrix_multiply(const struct matrix *a, const double *x, double *y)
{
    const size_t rows = a->rows;
    if (a->identity) {
        memmove(y, x, rows * sizeof *y);
        return;
    }
    if (tribo_matrix_is_small(a)) {
        for (size_t i = 0; i < rows; i++) {
            y[i] = tribo_matrix_row_dot(a, i, x);
        }
        return;
    }
    for (size_t i = 0; i < rows; i += MATRIX_BLOCK) {
        const size_t end = rows - i < MATRIX_BLOCK ? rows : i + MATRIX_BLOCK;
        memset(y + i, 0, (end - i) * sizeof *y);
        tribo_matrix_add_rows(a, i, end, 1.0, x, y + i);
    }
}

const double *tribo_matrix_image(const struct matrix *a, const double *x, double *room)
{
    if (a->identity) {
        return x;
    }
    tribo_matrix_multiply(a, x, room);
    return room;
}

/* y [3][rows] = A x for three vectors. */
static void multiply_three(const struct matrix *a, const double *restrict x, double *restrict y)
{
    const size_t n = a->cols, rows = a->rows;
    for (size_t i = 0; i < rows; i++) {
        double s0 = 0.0, s1 = 0.0, s2 = 0.0;
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            const double val = a->val[k], *from = x + a->col[k];
            s0 += val * from[0];
            s1 += val * from[n];
            s2 += val * from[2 * n];
        }
        y[i] = s0;
        y[rows + i] = s1;
        y[2 * rows + i] = s2;
    }
}

void tribo_matrix_multiply_all(const struct matrix *a, size_t count, const double *x, double *y)
{
    size_t k = 0;
    for (; k + 3 <= count; k += 3) {
        multiply_three(a, x + k * a->cols, y + k * a->rows);
    }
    for (; k < count; k++) {
        tribo_matrix_multiply(a, x + k * a->cols, y + k * a->rows);
    }
}

/* A sum and what was rounded off it. */
struct sum {
    double high, low;
};

/* sum += x y (Ogita, Rump and Oishi 2005, SIAM J. Sci. Comput. 26, 1955, doi:10.1137/030601818). */
static void add_product(struct sum *sum, double x, double y)
{
    const double product = x * y, high = sum->high + product, part = high - sum->high;
    sum->low += ((sum->high - (high - part)) + (product - part)) + fma(x, y, -product);
    sum->high = high;
}

double tribo_matrix_form(const struct matrix *a, const double *x, const double *y)
{
    struct sum all = {0.0, 0.0};
    for (size_t i = 0; i < a->rows; i++) {
        struct sum row = {0.0, 0.0};
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            add_product(&row, a->val[k], y[a->col[k]]);
        }
        add_product(&all, x[i], row.high);
        add_product(&all, x[i], row.low);
    }
    return all.high + all.low;
}

void tribo_matrix_roots(const struct matrix *a, double *root)
{
    for (size_t i = 0; i < a->rows; i++) {
        root[i] = sqrt(fabs(tribo_matrix_get(a, i, i)));
    }
}

double tribo_matrix_noise(const struct matrix *a, const double *root, const double *x, const double *y)
{
    double sum = 0.0;
    for (size_t i = 0; i < a->rows; i++) {
        double row = 0.0;
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            row += greater(fabs(a->val[k]), root[i] * root[a->col[k]]) * fabs(y[a->col[k]]);
        }
        sum += row * fabs(x[i]);
    }
    return DBL_EPSILON * sum;
}

/* The entries of a row, of which the identity has one. */
static size_t row_begin(const struct matrix *a, size_t i)
{
    return a->rows ? a->first[i] : i;
}

static size_t row_end(const struct matrix *a, size_t i)
{
    return a->rows ? a->first[i + 1] : i + 1;
}

int tribo_matrix_congruent(const struct matrix *a, const struct matrix *z, double *to)
{
    const size_t n = z->rows ? z->rows : a->rows, m = z->rows ? z->cols : n;
    enum { SHORT = 16 };
    double few[SHORT], *more = m > SHORT ? malloc(m * sizeof *more) : NULL, *row = more ? more : few;
    if (m > SHORT && !more) {
        return 0;
    }
    memset(to, 0, m * m * sizeof *to);
    for (size_t i = 0; i < n; i++) {
        memset(row, 0, m * sizeof *row);
        /* to += row i of A Z. */
        for (size_t k = row_begin(a, i); k < row_end(a, i); k++) {
            const size_t j = a->rows ? a->col[k] : i;
            const double x = a->rows ? a->val[k] : 1.0;
            for (size_t e = row_begin(z, j); e < row_end(z, j); e++) {
                row[z->rows ? z->col[e] : j] += z->rows ? x * z->val[e] : x;
            }
        }
        for (size_t e = row_begin(z, i); e < row_end(z, i); e++) {
            double *at = to + (z->rows ? z->col[e] : i) * m;
            const double x = z->rows ? z->val[e] : 1.0;
            for (size_t j = 0; j < m; j++) {
                at[j] += x * row[j];
            }
        }
    }
    for (size_t i = 0; i < m; i++) {
        for (size_t j = 0; j < i; j++) {
            to[i * m + j] = to[j * m + i] = 0.5 * (to[i * m + j] + to[j * m + i]);
        }
    }
    free(more);
    return 1;
}
