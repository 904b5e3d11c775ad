/* SPDX-License-Identifier: BSD-3-Clause */
/* Products with real matrices. */
#include "linalg.h"
#include "common/real.h"
#include "common/simd.h"
#include "twofold.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* y [rows] += factor times rows begin to begin + rows - 1 of A x. These rows lie in one block, and all diagonals are inside the
 * matrix there. Passes over y once for three diagonals, but adds them one after the other. */
TRIBO_SIMD static void add_diagonals(const struct matrix *a, size_t begin, size_t rows, double factor, const double *x,
                                     double *restrict y)
{
    const double *restrict val = a->fast + a->block[begin / MATRIX_BLOCK] + begin % MATRIX_BLOCK, *restrict at = x + begin;
    size_t d = 0;
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

/* y [end - begin] += factor times rows begin to end - 1 of A x, entry by entry in the order of the diagonals. */
static void add_outer_rows(const struct matrix *a, size_t begin, size_t end, double factor, const double *x, double *y)
{
    for (size_t i = begin; i < end; i++, y++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            *y += factor * a->val[k] * x[a->col[k]];
        }
    }
}

static size_t row_between(ptrdiff_t i, size_t least, size_t most)
{
    return i < (ptrdiff_t)least ? least : i > (ptrdiff_t)most ? most : (size_t)i;
}

void tribo_matrix_add_rows(const struct matrix *a, size_t begin, size_t end, double factor, const double *x, double *y)
{
    if (a->cols >= MATRIX_WIDE && a->first[end] - a->first[begin] == (end - begin) * a->cols) {
        tribo_multiply_add(end - begin, a->cols, 1, factor, a->val + a->first[begin], x, y);
    } else if (!a->diagonals) {
        for (size_t i = begin; i < end; i++) {
            y[i - begin] += factor * tribo_matrix_row_dot(a, i, x);
        }
    } else if (end - begin <= MATRIX_FEW) {
        add_outer_rows(a, begin, end, factor, x, y);
    } else {
        /* All diagonals are inside the matrix in rows first to last - 1. */
        const size_t first = row_between(-a->offset[0], begin, end),
                     last = row_between((ptrdiff_t)a->cols - a->offset[a->diagonals - 1], first, end);
        add_outer_rows(a, begin, first, factor, x, y);
        add_diagonals(a, first, last - first, factor, x, y + (first - begin));
        add_outer_rows(a, last, end, factor, x, y + (last - begin));
    }
}

void tribo_matrix_add_sizes(const struct matrix *a, const double *x, double *y)
{
    for (size_t i = 0; i < a->rows; i++) {
        y[i] += tribo_matrix_row_size(a, i, x);
    }
}

void tribo_matrix_multiply_add(const struct matrix *a, double factor, const double *x, double *y)
{
    if (a->diagonals && a->rows <= MATRIX_FEW) { /* a second call would take as long as the product */
        add_outer_rows(a, 0, a->rows, factor, x, y);
        return;
    }
    for (size_t i = 0; i < a->rows; i += MATRIX_BLOCK) {
        const size_t end = a->rows - i < MATRIX_BLOCK ? a->rows : i + MATRIX_BLOCK;
        tribo_matrix_add_rows(a, i, end, factor, x, y + i);
    }
}

void tribo_matrix_multiply(const struct matrix *a, const double *x, double *y)
{
    memset(y, 0, a->rows * sizeof *y);
    tribo_matrix_multiply_add(a, 1.0, x, y);
}

void tribo_matrix_multiply_all(const struct matrix *a, size_t count, const double *x, double *y)
{
    for (size_t k = 0; k < count; k++) {
        tribo_matrix_multiply(a, x + k * a->cols, y + k * a->rows);
    }
}

/* sum += x y (Ogita, Rump and Oishi 2005, SIAM J. Sci. Comput. 26, 1955, doi:10.1137/030601818). */
static void form_add_product(struct twofold *sum, double x, double y)
{
    const double product = x * y;
    const struct twofold s = twofold_sum(sum->hi, product);
    sum->lo += s.lo + fma(x, y, -product);
    sum->hi = s.hi;
}

double tribo_matrix_form(const struct matrix *a, const double *x, const double *y)
{
    struct twofold all = {0.0, 0.0};
    for (size_t i = 0; i < a->rows; i++) {
        struct twofold row = {0.0, 0.0};
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            form_add_product(&row, a->val[k], y[a->col[k]]);
        }
        form_add_product(&all, x[i], row.hi);
        form_add_product(&all, x[i], row.lo);
    }
    return all.hi + all.lo;
}

void tribo_matrix_roots(const struct matrix *a, const double *terms, double *root)
{
    for (size_t i = 0; i < a->rows; i++) {
        root[i] = sqrt(greater(fabs(tribo_matrix_get(a, i, i)), terms ? terms[i] : 0.0));
    }
}

double tribo_matrix_noise(const struct matrix *a, const double *root, const double *x, const double *y)
{
    double sum = 0.0;
    for (size_t i = 0; i < a->rows; i++) {
        double row = 0.0;
        for (size_t k = a->first[i]; x[i] != 0.0 && k < a->first[i + 1]; k++) {
            row += greater(fabs(a->val[k]), root[i] * root[a->col[k]]) * fabs(y[a->col[k]]);
        }
        sum += row * fabs(x[i]);
    }
    return DBL_EPSILON * sum;
}

int tribo_matrix_congruent(const struct matrix *a, const struct matrix *z, double *to)
{
    struct matrix turned;
    if (!z->rows) {
        tribo_matrix_spread(a, to);
        tribo_even_out(a->rows, to);
        return 1;
    }
    double *x = malloc(2 * z->rows * sizeof *x), *image = x && a->rows ? x + z->rows : x;
    const int done = x && tribo_matrix_transpose(&turned, z);
    for (size_t k = 0; done && k < z->cols; k++) {
        tribo_matrix_get_row(&turned, k, x);
        if (a->rows) {
            tribo_matrix_multiply(a, x, image);
        }
        tribo_matrix_multiply(&turned, image, to + k * z->cols);
    }
    if (done) {
        tribo_even_out(z->cols, to);
        tribo_matrix_free(&turned);
    }
    free(x);
    return done;
}
