#include "matrix.h"
#include "../common/real.h"
#include "../common/simd.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* As in the core: entries (i,j) and (j,i) may differ by rounding of whoever computed them. */
#define ASYMMETRY 1e-10

/* So few rows are multiplied with sooner entry by entry. */
#define FEW_ROWS 4

void tribo_matrix_free(struct matrix *a)
{
    free(a->first);
    free(a->col);
    free(a->val);
    free(a->offset);
    free(a->fast);
    memset(a, 0, sizeof *a);
}

static int create(struct matrix *a, size_t rows, size_t cols, size_t entries)
{
    memset(a, 0, sizeof *a);
    a->rows = rows;
    a->cols = cols;
    a->first = calloc(rows + 2, sizeof *a->first);
    a->col = malloc((entries + 1) * sizeof *a->col);
    a->val = malloc((entries + 1) * sizeof *a->val);
    if (a->first && a->col && a->val) {
        return 1;
    }
    tribo_matrix_free(a);
    return 0;
}

/* Where the diagonal (j - i) of entry (i, j) is counted. */
static size_t diagonal(const struct matrix *a, size_t i, size_t j)
{
    return j + a->rows - i;
}

/* Fills `fast` if that pays: with diagonals if half of their entries are not zero, with all entries if a third of them is not. */
static int speed_up(struct matrix *a)
{
    const size_t entries = a->first[a->rows];
    size_t *place = calloc(a->rows + a->cols + 1, sizeof *place);
    if (!place) {
        tribo_matrix_free(a);
        return 0;
    }
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            place[diagonal(a, i, a->col[k])] = 1;
        }
    }
    size_t diagonals = 0;
    for (size_t d = 0; d < a->rows + a->cols + 1; d++) {
        place[d] = place[d] ? ++diagonals : 0;
    }
    int done = 1;
    if (entries && diagonals * a->rows <= 2 * entries && diagonals <= 16) {
        a->diagonals = diagonals;
        a->offset = malloc(diagonals * sizeof *a->offset);
        a->fast = calloc(diagonals * a->rows, sizeof *a->fast);
        done = a->offset && a->fast;
        for (size_t i = 0; done && i < a->rows; i++) {
            for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
                const size_t d = place[diagonal(a, i, a->col[k])] - 1;
                a->offset[d] = (ptrdiff_t)a->col[k] - (ptrdiff_t)i;
                a->fast[d * a->rows + i] = a->val[k];
            }
        }
    } else if (entries >= a->rows * a->cols / 3) {
        a->fast = tribo_matrix_to_dense(a);
        done = a->fast != NULL;
    }
    free(place);
    if (!done) {
        tribo_matrix_free(a);
    }
    return done;
}

/* With what speeds up products. */
static int finish(struct matrix *a)
{
    if (!speed_up(a)) {
        return 0;
    }
    a->identity = a->rows == a->cols && a->diagonals == 1 && a->offset[0] == 0;
    for (size_t i = 0; a->identity && i < a->rows; i++) {
        a->identity = a->fast[i] == 1.0;
    }
    return 1;
}

int tribo_matrix_from_dense(struct matrix *a, size_t rows, size_t cols, const double *entries)
{
    size_t count = 0;
    for (size_t k = 0; k < rows * cols; k++) {
        count += entries[k] != 0.0;
    }
    if (!create(a, rows, cols, count)) {
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
    return finish(a);
}

int tribo_matrix_diagonal(struct matrix *a, size_t n, const double *entries)
{
    if (!create(a, n, n, n)) {
        return 0;
    }
    for (size_t i = 0; i < n; i++) {
        a->first[i + 1] = i + 1;
        a->col[i] = i;
        a->val[i] = entries ? entries[i] : 1.0;
    }
    return finish(a);
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
    if (!create(a, from->rows, from->cols, entries)) {
        return 0;
    }
    memcpy(a->first, from->first, (from->rows + 1) * sizeof *a->first);
    memcpy(a->col, from->col, entries * sizeof *a->col);
    memcpy(a->val, from->val, entries * sizeof *a->val);
    return finish(a);
}

int tribo_matrix_sum(struct matrix *to, double factor, const struct matrix *a, double other, const struct matrix *b)
{
    if (!create(to, a->rows, a->cols, a->first[a->rows] + b->first[b->rows])) {
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
    return finish(to);
}

/* order_out = order_in (NULL: 0, 1, ...), stably sorted by key. start [keys + 1] is workspace. */
static void counting_sort(size_t keys, size_t n, const size_t *key, const size_t *order_in, size_t *order_out, size_t *start)
{
    memset(start, 0, (keys + 1) * sizeof *start);
    for (size_t k = 0; k < n; k++) {
        start[key[k] + 1]++;
    }
    for (size_t k = 0; k < keys; k++) {
        start[k + 1] += start[k];
    }
    for (size_t k = 0; k < n; k++) {
        const size_t from = order_in ? order_in[k] : k;
        order_out[start[key[from]]++] = from;
    }
}

int tribo_matrix_from_triplets(struct matrix *a, size_t rows, size_t cols, size_t n, const size_t *i, const size_t *j,
                               const double *v)
{
    size_t *by_col = malloc((n + 1) * sizeof *by_col), *by_row = malloc((n + 1) * sizeof *by_row);
    size_t *start = malloc(((rows > cols ? rows : cols) + 1) * sizeof *start);
    const int done = by_col && by_row && start && create(a, rows, cols, n);
    if (done) {
        counting_sort(cols, n, j, NULL, by_col, start);
        counting_sort(rows, n, i, by_col, by_row, start);
        for (size_t k = 0; k < n; k++) {
            a->first[i[by_row[k]] + 1] = k + 1;
            a->col[k] = j[by_row[k]];
            a->val[k] = v[by_row[k]];
        }
        for (size_t r = 0; r < rows; r++) {
            a->first[r + 1] = a->first[r + 1] ? a->first[r + 1] : a->first[r];
        }
    } else {
        memset(a, 0, sizeof *a);
    }
    free(by_col);
    free(by_row);
    free(start);
    return done && finish(a);
}

int tribo_matrix_transpose(struct matrix *a, const struct matrix *from)
{
    size_t *row = malloc((from->first[from->rows] + 1) * sizeof *row);
    for (size_t i = 0; row && i < from->rows; i++) {
        for (size_t k = from->first[i]; k < from->first[i + 1]; k++) {
            row[k] = i;
        }
    }
    memset(a, 0, sizeof *a);
    const int done =
        row && tribo_matrix_from_triplets(a, from->cols, from->rows, from->first[from->rows], from->col, row, from->val);
    free(row);
    return done;
}

int tribo_matrix_from_sparse(struct matrix *a, const gsl_spmatrix *m)
{
    const size_t n = m->nz;
    size_t *i = malloc((n + 1) * sizeof *i), *j = malloc((n + 1) * sizeof *j);
    int done = i && j;
    if (done && GSL_SPMATRIX_ISCOO(m)) {
        for (size_t k = 0; k < n; k++) {
            i[k] = (size_t)m->i[k];
            j[k] = (size_t)m->p[k];
        }
    } else if (done) {
        /* compressed: p bounds the entries of each column (CSC) or row (CSR), i has the other index */
        const int by_columns = GSL_SPMATRIX_ISCSC(m);
        size_t *outer = by_columns ? j : i, *inner = by_columns ? i : j, at = 0;
        for (size_t k = 0; k < n; k++) {
            while ((size_t)m->p[at + 1] <= k) {
                at++;
            }
            outer[k] = at;
            inner[k] = (size_t)m->i[k];
        }
    }
    done = done && tribo_matrix_from_triplets(a, m->size1, m->size2, n, i, j, m->data);
    if (!done) {
        memset(a, 0, sizeof *a);
    }
    free(i);
    free(j);
    return done;
}

/* y [rows] += factor times rows `begin` and following of A x, all of whose diagonals lie inside the matrix: three diagonals at a
 * time, so that y is passed over as seldom as can be, but in the order of one after the other. */
TRIBO_SIMD static void add_inner_rows(const struct matrix *a, size_t begin, size_t rows, double factor, const double *x,
                                      double *restrict y)
{
    const double *restrict val = a->fast + begin, *restrict at = x + begin;
    size_t d = 0;
    for (; d + 3 <= a->diagonals; d += 3) {
        const double *restrict u = val + d * a->rows, *restrict v = u + a->rows, *restrict w = v + a->rows;
        const double *restrict p = at + a->offset[d], *restrict q = at + a->offset[d + 1], *restrict r = at + a->offset[d + 2];
        for (size_t i = 0; i < rows; i++) {
            y[i] = ((y[i] + factor * u[i] * p[i]) + factor * v[i] * q[i]) + factor * w[i] * r[i];
        }
    }
    for (; d < a->diagonals; d++) {
        const double *restrict u = val + d * a->rows, *restrict p = at + a->offset[d];
        for (size_t i = 0; i < rows; i++) {
            y[i] += factor * u[i] * p[i];
        }
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

static size_t between(size_t i, size_t least, size_t most)
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
    const size_t first = between(inner_begin(a), begin, end), last = between(inner_end(a), first, end);
    add_outer_rows(a, begin, first, factor, x, y);
    add_inner_rows(a, first, last - first, factor, x, y + (first - begin));
    add_outer_rows(a, last, end, factor, x, y + (last - begin));
}

static double dense_dot(size_t n, const double *restrict val, const double *restrict x)
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
        (end - begin > FEW_ROWS ? add_banded_rows : add_outer_rows)(a, begin, end, factor, x, y);
        return;
    }
    for (size_t i = begin; i < end; i++) {
        y[i - begin] += factor * (a->fast ? dense_dot(a->cols, a->fast + i * a->cols, x) : tribo_matrix_row_dot(a, i, x));
    }
}

void tribo_matrix_add_sizes(const struct matrix *a, const double *x, double *y)
{
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            y[i] += fabs(a->val[k] * x[a->col[k]]);
        }
    }
}

void tribo_matrix_multiply_add(const struct matrix *a, double factor, const double *x, double *y)
{
    for (size_t i = 0; i < a->rows; i += MATRIX_BLOCK) {
        const size_t end = a->rows - i < MATRIX_BLOCK ? a->rows : i + MATRIX_BLOCK;
        tribo_matrix_add_rows(a, i, end, factor, x, y + i);
    }
}

void tribo_matrix_multiply(const struct matrix *a, const double *x, double *y)
{
    for (size_t i = 0; i < a->rows; i += MATRIX_BLOCK) {
        const size_t end = a->rows - i < MATRIX_BLOCK ? a->rows : i + MATRIX_BLOCK;
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

/* to += row i of A Z. */
static void add_row(const struct matrix *a, const struct matrix *z, size_t i, double *to)
{
    for (size_t k = row_begin(a, i); k < row_end(a, i); k++) {
        const size_t j = a->rows ? a->col[k] : i;
        const double x = a->rows ? a->val[k] : 1.0;
        for (size_t e = row_begin(z, j); e < row_end(z, j); e++) {
            to[z->rows ? z->col[e] : j] += z->rows ? x * z->val[e] : x;
        }
    }
}

int tribo_matrix_congruent(const struct matrix *a, const struct matrix *z, double *to)
{
    const size_t n = z->rows ? z->rows : a->rows, m = z->rows ? z->cols : n;
    double *row = malloc((m + 1) * sizeof *row);
    if (!row) {
        return 0;
    }
    memset(to, 0, m * m * sizeof *to);
    for (size_t i = 0; i < n; i++) {
        memset(row, 0, m * sizeof *row);
        add_row(a, z, i, row);
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
    free(row);
    return 1;
}

double *tribo_matrix_to_dense(const struct matrix *a)
{
    double *dense = calloc(a->rows * a->cols + 1, sizeof *dense);
    for (size_t i = 0; dense && i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            dense[i * a->cols + a->col[k]] = a->val[k];
        }
    }
    return dense;
}

double *tribo_matrix_transpose_to_dense(const struct matrix *a)
{
    double *dense = calloc(a->rows * a->cols + 1, sizeof *dense);
    for (size_t i = 0; dense && i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            dense[a->col[k] * a->rows + i] = a->val[k];
        }
    }
    return dense;
}

void tribo_matrix_scale_rows(struct matrix *a, const double *factor)
{
    a->identity = 0;
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            a->val[k] *= factor[i];
        }
        for (size_t d = 0; d < a->diagonals; d++) {
            a->fast[d * a->rows + i] *= factor[i];
        }
        for (size_t j = 0; a->fast && !a->diagonals && j < a->cols; j++) {
            a->fast[i * a->cols + j] *= factor[i];
        }
    }
}

double tribo_matrix_get(const struct matrix *a, size_t i, size_t j)
{
    size_t lo = a->first[i], hi = a->first[i + 1];
    while (lo < hi) {
        const size_t mid = lo + (hi - lo) / 2;
        if (a->col[mid] < j) {
            lo = mid + 1;
        } else {
            hi = mid;
        }
    }
    return lo < a->first[i + 1] && a->col[lo] == j ? a->val[lo] : 0.0;
}

/* What entry (i, j) is to be seen beside: its own size, or that of the diagonal. */
static double size_at(const struct matrix *a, size_t i, size_t j, double own)
{
    return greater(own, sqrt(fabs(tribo_matrix_get(a, i, i))) * sqrt(fabs(tribo_matrix_get(a, j, j))));
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
            if (*value != *mirror && fabs(*value - *mirror) > ASYMMETRY * size_at(a, i, j, greater(fabs(*value), fabs(*mirror)))) {
                return 1;
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
