/* SPDX-License-Identifier: BSD-3-Clause */
#include "matrix.h"
#include "common/layout.h"
#include "common/real.h"
#include "common/simd.h"
#include "csr.h"
#include "linalg.h"
#include "twofold.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Entries (i, j) and (j, i) may differ by this part of their size: rounding of the program that computed them. */
#define ASYMMETRY 1e-10

/* Diagonals that a matrix is stored by, at most. */
enum { MOST_DIAGONALS = 16 };

void tribo_matrix_free(struct matrix *a)
{
    if (a->first) {
        free(a->first);
        free(a->offset);
    }
    *a = (struct matrix){0};
}

static int matrix_create(struct matrix *a, size_t rows, size_t cols, size_t entries)
{
    struct csr own;
    const int done = tribo_csr_create(&own, rows, entries);
    *a = done ? (struct matrix){.rows = rows, .cols = cols, .first = own.first, .col = own.col, .val = own.val}
              : (struct matrix){0};
    return done;
}

static size_t blocks_of(const struct matrix *a)
{
    return (a->rows + MATRIX_BLOCK - 1) / MATRIX_BLOCK;
}

/* Fills fast from val. A block equal to the block before is not stored twice: less memory to read. */
static void fill_blocks(struct matrix *a)
{
    const size_t size = a->diagonals * MATRIX_BLOCK;
    size_t used = (size_t)(tribo_aligned(a->fast) - a->fast);
    for (size_t b = 0; b < blocks_of(a); b++) {
        double *to = a->fast + used;
        const size_t begin = b * MATRIX_BLOCK, end = begin + MATRIX_BLOCK < a->rows ? begin + MATRIX_BLOCK : a->rows;
        memset(to, 0, size * sizeof *to);
        for (size_t i = begin; i < end; i++) {
            size_t d = 0;
            for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
                while (a->offset[d] != (ptrdiff_t)a->col[k] - (ptrdiff_t)i) {
                    d++;
                }
                to[d * MATRIX_BLOCK + i - begin] = a->val[k];
            }
        }
        const int same = b > 0 && memcmp(a->fast + a->block[b - 1], to, size * sizeof *to) == 0;
        a->block[b] = same ? a->block[b - 1] : used;
        used += same ? 0 : size;
    }
}

/* Adds the diagonals to complete rows, unless they are too many, or more than half empty. Returns 1, or 0 with a freed if out of
 * memory. */
static int matrix_finish(struct matrix *a)
{
    ptrdiff_t offset[MOST_DIAGONALS + 1];
    size_t count = 0;
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; count <= MOST_DIAGONALS && k < a->first[i + 1]; k++) {
            const ptrdiff_t d = (ptrdiff_t)a->col[k] - (ptrdiff_t)i;
            size_t at = 0;
            while (at < count && offset[at] < d) {
                at++;
            }
            if (at == count || offset[at] != d) {
                memmove(offset + at + 1, offset + at, (count - at) * sizeof *offset);
                offset[at] = d;
                count++;
            }
        }
    }
    a->diagonals = count <= MOST_DIAGONALS && count * a->rows <= 2 * a->first[a->rows] ? count : 0;
    if (a->diagonals && a->rows > MATRIX_FEW) {
        if (!ALLOCATE(ARRAY(a->offset, a->diagonals), ARRAY(a->block, blocks_of(a)),
                      ARRAY(a->fast, blocks_of(a) * a->diagonals * MATRIX_BLOCK + TRIBO_LINE))) {
            tribo_matrix_free(a);
            return 0;
        }
        memcpy(a->offset, offset, a->diagonals * sizeof *offset);
        fill_blocks(a);
    }
    return 1;
}

int tribo_matrix_from_dense(struct matrix *a, size_t rows, size_t cols, const double *entries)
{
    size_t count = 0;
    for (size_t k = 0; k < rows * cols; k++) {
        count += entries[k] != 0.0;
    }
    if (!matrix_create(a, rows, cols, count)) {
        return 0;
    }
    size_t k = 0;
    for (size_t i = 0; i < rows; i++) {
        for (size_t j = 0; j < cols; j++) {
            if (entries[i * cols + j] != 0.0) {
                a->col[k] = j;
                a->val[k++] = entries[i * cols + j];
            }
        }
        a->first[i + 1] = k;
    }
    return matrix_finish(a);
}

int tribo_matrix_diagonal(struct matrix *a, size_t n, const double *entries)
{
    if (!matrix_create(a, n, n, n)) {
        return 0;
    }
    for (size_t i = 0; i < n; i++) {
        a->first[i + 1] = i + 1;
        a->col[i] = i;
        a->val[i] = entries ? entries[i] : 1.0;
    }
    return matrix_finish(a);
}

void tribo_matrix_get_row(const struct matrix *a, size_t i, double *x)
{
    memset(x, 0, a->cols * sizeof *x);
    tribo_matrix_add_row(a, i, 1.0, x);
}

void *tribo_copy_of(const void *from, size_t count, size_t size, int *done)
{
    void *to = from ? malloc(count * size + 1) : NULL;
    if (to) {
        memcpy(to, from, count * size);
    }
    *done &= to || !from;
    return to;
}

int tribo_matrix_copy(struct matrix *a, const struct matrix *from)
{
    if (!from->first) {
        *a = (struct matrix){0};
        return 1;
    }
    const size_t entries = from->first[from->rows];
    if (!matrix_create(a, from->rows, from->cols, entries)) {
        return 0;
    }
    memcpy(a->first, from->first, (from->rows + 1) * sizeof *a->first);
    memcpy(a->col, from->col, entries * sizeof *a->col);
    memcpy(a->val, from->val, entries * sizeof *a->val);
    return matrix_finish(a);
}

int tribo_matrix_sum(struct matrix *to, double factor, const struct matrix *a, double other, const struct matrix *b)
{
    if (!matrix_create(to, a->rows, a->cols, a->first[a->rows] + b->first[b->rows])) {
        return 0;
    }
    size_t count = 0;
    for (size_t i = 0; i < a->rows; i++) {
        size_t k = a->first[i], l = b->first[i];
        while (k < a->first[i + 1] || l < b->first[i + 1]) {
            const size_t j = k < a->first[i + 1] ? a->col[k] : a->cols, m = l < b->first[i + 1] ? b->col[l] : b->cols;
            const double x = j <= m ? factor * a->val[k++] : 0.0, y = m <= j ? other * b->val[l++] : 0.0;
            to->col[count] = j < m ? j : m;
            to->val[count++] = x + y;
        }
        to->first[i + 1] = count;
    }
    return matrix_finish(to);
}

int tribo_matrix_transpose(struct matrix *a, const struct matrix *from)
{
    const size_t entries = from->first[from->rows];
    if (!matrix_create(a, from->cols, from->rows, entries)) {
        return 0;
    }
    tribo_rows_transpose(from->rows, from->cols, from->first, from->col, from->val, a->first, a->col, a->val);
    return matrix_finish(a);
}

void tribo_triplets_put(struct triplets *t, size_t i, size_t j, double v)
{
    if (v != 0.0 && t->count == t->room && !t->failed) {
        const size_t room = 2 * t->room + 64;
        struct triplet *more = realloc(t->entry, room * sizeof *more);
        t->failed = !more;
        t->entry = more ? more : t->entry;
        t->room = more ? room : t->room;
    }
    if (v != 0.0 && !t->failed) {
        t->entry[t->count++] = (struct triplet){i, j, v};
    }
}

void tribo_triplets_put_row(struct triplets *t, size_t row, const struct matrix *a, size_t i)
{
    for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
        tribo_triplets_put(t, row, a->col[e], a->val[e]);
    }
}

int tribo_triplets_finish(struct triplets *t, size_t rows, size_t cols, struct matrix *to)
{
    struct matrix by_column = {0};
    int done = !t->failed && matrix_create(&by_column, cols, rows, t->count);
    if (done) {
        size_t *next = by_column.first + 1; /* next[c]: place of the next entry of column c */
        for (size_t k = 0; k < t->count; k++) {
            next[t->entry[k].col + 1]++;
        }
        for (size_t c = 0; c < cols; c++) {
            next[c + 1] += next[c];
        }
        for (size_t k = 0; k < t->count; k++) {
            const size_t at = next[t->entry[k].col]++;
            by_column.col[at] = t->entry[k].row;
            by_column.val[at] = t->entry[k].value;
        }
        done = tribo_matrix_transpose(to, &by_column);
    }
    tribo_matrix_free(&by_column);
    free(t->entry);
    *t = (struct triplets){0};
    return done;
}

void tribo_matrix_spread(const struct matrix *a, double *dense)
{
    for (size_t i = 0; i < a->rows; i++) {
        tribo_matrix_get_row(a, i, dense + i * a->cols);
    }
}

double *tribo_matrix_to_dense(const struct matrix *a)
{
    double *dense = malloc((a->rows * a->cols + 1) * sizeof *dense);
    if (dense) {
        tribo_matrix_spread(a, dense);
    }
    return dense;
}

void tribo_matrix_scale_rows(struct matrix *a, const double *factor)
{
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            a->val[k] *= factor[i];
        }
    }
    if (a->fast) {
        fill_blocks(a);
    }
}

double tribo_matrix_get(const struct matrix *a, size_t i, size_t j)
{
    const size_t at = a->first[i + 1] - a->first[i] == a->cols ? a->first[i] + j : tribo_rows_find(a->first, a->col, i, j);
    return at == SIZE_MAX ? 0.0 : a->val[at];
}

int tribo_matrix_flaw(const struct matrix *a, int symmetric, size_t *row, size_t *column, double *value, double *mirror)
{
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            const size_t j = a->col[k];
            *row = i;
            *column = j;
            *value = a->val[k];
            *mirror = symmetric ? tribo_matrix_get(a, j, i) : a->val[k];
            if (!isfinite(*value)) {
                return 1;
            }
            if (*value != *mirror) {
                const double own = greater(fabs(*value), fabs(*mirror));
                const double roots = sqrt(fabs(tribo_matrix_get(a, i, i))) * sqrt(fabs(tribo_matrix_get(a, j, j)));
                if (fabs(*value - *mirror) > ASYMMETRY * greater(own, roots)) {
                    return 1;
                }
            }
        }
    }
    return 0;
}

int tribo_matrix_is_diagonal(const struct matrix *a)
{
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            if (a->col[k] != i && a->val[k] != 0.0) {
                return 0;
            }
        }
    }
    return 1;
}

double tribo_matrix_row_sum(const struct matrix *a)
{
    double most = 0.0;
    for (size_t i = 0; i < a->rows; i++) {
        double sum = 0.0;
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            sum += fabs(a->val[k]);
        }
        most = sum > most ? sum : most;
    }
    return most;
}

/* ------------------------------------------------------------------------------------------------------------- products */

/* y [rows] = z + factor times rows begin to begin + rows - 1 of A x; z [rows]: y, or no part of y. These rows lie in one block,
 * and all diagonals are inside the matrix there. Passes over y once for three diagonals, but adds them one after the other. */
TRIBO_SIMD static void add_diagonals(const struct matrix *a, size_t begin, size_t rows, double factor, const double *x,
                                     const double *z, double *y)
{
    const double *val = a->fast + a->block[begin / MATRIX_BLOCK] + begin % MATRIX_BLOCK, *at = x + begin;
    size_t d = 0;
    for (; d + 3 <= a->diagonals; d += 3, z = y) {
        const double *u = val + d * MATRIX_BLOCK, *v = u + MATRIX_BLOCK, *w = v + MATRIX_BLOCK;
        const double *p = at + a->offset[d], *q = at + a->offset[d + 1], *r = at + a->offset[d + 2];
        TRIBO_APART
        for (size_t i = 0; i < rows; i++) {
            y[i] = ((z[i] + factor * u[i] * p[i]) + factor * v[i] * q[i]) + factor * w[i] * r[i];
        }
    }
    for (; d < a->diagonals; d++, z = y) {
        const double *u = val + d * MATRIX_BLOCK, *p = at + a->offset[d];
        TRIBO_APART
        for (size_t i = 0; i < rows; i++) {
            y[i] = z[i] + factor * u[i] * p[i];
        }
    }
}

/* y [end - begin] = z + factor times rows begin to end - 1 of A x, in the order of the diagonals. Sums are in y: with a sum in a
 * local variable GCC takes two entries at a time as a vector, which is slower. */
static void add_outer_rows(const struct matrix *a, size_t begin, size_t end, double factor, const double *x, const double *z,
                           double *y)
{
    for (size_t i = begin, k = a->first[i]; i < end; i++, y++) {
        *y = *z++;
        for (const size_t next = a->first[i + 1]; k < next; k++) {
            *y += factor * a->val[k] * x[a->col[k]];
        }
    }
}

static size_t row_between(ptrdiff_t i, size_t least, size_t most)
{
    return i < (ptrdiff_t)least ? least : i > (ptrdiff_t)most ? most : (size_t)i;
}

void tribo_matrix_add_rows(const struct matrix *a, size_t begin, size_t end, double factor, const double *x, const double *z,
                           double *y)
{
    if (a->cols >= MATRIX_WIDE && a->first[end] - a->first[begin] == (end - begin) * a->cols) {
        memmove(y, z, (end - begin) * sizeof *y);
        tribo_multiply_add(end - begin, a->cols, 1, factor, a->val + a->first[begin], x, y);
    } else if (!a->diagonals) {
        for (size_t i = begin; i < end; i++) {
            y[i - begin] = z[i - begin] + factor * tribo_matrix_row_dot(a, i, x);
        }
    } else if (end - begin <= MATRIX_FEW) {
        add_outer_rows(a, begin, end, factor, x, z, y);
    } else {
        /* All diagonals are inside the matrix in rows first to last - 1. */
        const size_t first = row_between(-a->offset[0], begin, end),
                     last = row_between((ptrdiff_t)a->cols - a->offset[a->diagonals - 1], first, end);
        add_outer_rows(a, begin, first, factor, x, z, y);
        add_diagonals(a, first, last - first, factor, x, z + (first - begin), y + (first - begin));
        add_outer_rows(a, last, end, factor, x, z + (last - begin), y + (last - begin));
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
        add_outer_rows(a, 0, a->rows, factor, x, y, y);
        return;
    }
    for (size_t i = 0; i < a->rows; i += MATRIX_BLOCK) {
        const size_t end = a->rows - i < MATRIX_BLOCK ? a->rows : i + MATRIX_BLOCK;
        tribo_matrix_add_rows(a, i, end, factor, x, y + i, y + i);
    }
}

void tribo_matrix_multiply(const struct matrix *a, const double *x, double *y)
{
    static const double zeros[MATRIX_FEW];
    if (a->diagonals && a->rows <= MATRIX_FEW) {
        add_outer_rows(a, 0, a->rows, 1.0, x, zeros, y);
        return;
    }
    memset(y, 0, a->rows * sizeof *y);
    tribo_matrix_multiply_add(a, 1.0, x, y);
}

TRIBO_SIMD void tribo_matrix_add_columns(const struct matrix *a, double factor, size_t columns, const double *x, double *to)
{
    if (columns == 1) {
        tribo_matrix_multiply_add(a, factor, x, to);
        return;
    }
    for (size_t i = 0; i < a->rows; i++) {
        double *restrict row = to + i * columns;
        size_t k = a->first[i];
        for (; k + 3 <= a->first[i + 1]; k += 3) {
            const double f = factor * a->val[k], g = factor * a->val[k + 1], h = factor * a->val[k + 2];
            const double *restrict p = x + a->col[k] * columns, *restrict q = x + a->col[k + 1] * columns;
            const double *restrict r = x + a->col[k + 2] * columns;
            for (size_t j = 0; j < columns; j++) {
                row[j] = ((row[j] + f * p[j]) + g * q[j]) + h * r[j];
            }
        }
        for (; k < a->first[i + 1]; k++) {
            const double f = factor * a->val[k], *restrict p = x + a->col[k] * columns;
            for (size_t j = 0; j < columns; j++) {
                row[j] += f * p[j];
            }
        }
    }
}

void tribo_matrix_add_transposed(const struct matrix *a, double factor, size_t columns, const double *x, double *to)
{
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            tribo_add(to + a->col[k] * columns, factor * a->val[k], x + i * columns, columns);
        }
    }
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
    const size_t n = z->rows ? z->cols : a->rows;
    double *row = malloc((n + 1) * sizeof *row); /* of A Z */
    if (!z->rows) {
        tribo_matrix_spread(a, to);
    }
    memset(to, 0, z->rows ? n * n * sizeof *to : 0);
    for (size_t i = 0; row && i < z->rows; i++) {
        const int moves = z->first[i] < z->first[i + 1];
        memset(row, 0, moves ? n * sizeof *row : 0);
        for (size_t k = a->first[i]; moves && k < a->first[i + 1]; k++) {
            tribo_matrix_add_row(z, a->col[k], a->val[k], row);
        }
        for (size_t k = z->first[i]; k < z->first[i + 1]; k++) {
            tribo_add(to + z->col[k] * n, z->val[k], row, n);
        }
    }
    tribo_even_out(n, to);
    free(row);
    return row != NULL;
}
