#include "eigen.h"
#include "common/real.h"
#include "linalg.h"

#include <complex.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_linalg.h>

#include "tribo/tribo.h"

/* A takes part as Z T Z': t becomes upper triangular but for blocks of two; a Schur vector is a row of z. */
struct schur {
    size_t n;
    double *t, *z;
};

static double *at(const struct schur *s, size_t i, size_t j)
{
    return s->t + i * s->n + j;
}

/* Where the block begins that ends before end: after a subdiagonal entry that is rounding beside its neighbours. */
static size_t block_begin(const struct schur *s, size_t end)
{
    size_t i = end - 1;
    for (; i > 0; i--) {
        const double size = fabs(*at(s, i - 1, i - 1)) + fabs(*at(s, i, i));
        if (fabs(*at(s, i, i - 1)) <= DBL_EPSILON * size) {
            *at(s, i, i - 1) = 0.0;
            break;
        }
    }
    return i;
}

/* The reflection 1 - u v' that takes (p, q, r) to a multiple of (1, 0, 0). Returns 0 if there is nothing to do. */
static int reflection(double p, double q, double r, double u[3], double v[3])
{
    const double scale = fabs(p) + fabs(q) + fabs(r);
    if (!(fabs(q) + fabs(r) > 0.0)) {
        return 0;
    }
    p /= scale;
    q /= scale;
    r /= scale;
    const double length = sqrt(p * p + q * q + r * r), first = p < 0.0 ? p - length : p + length;
    const double factor = first / (p < 0.0 ? -length : length);
    u[0] = factor;
    u[1] = factor * (q / first);
    u[2] = factor * (r / first);
    v[0] = 1.0;
    v[1] = q / first;
    v[2] = r / first;
    return 1;
}

/* Applies the reflection to neighbouring rows that begin at x, from column first to end - 1. */
static void reflect_rows(double *x, size_t stride, size_t count, size_t first, size_t end, const double *u, const double *v)
{
    double *a = x, *b = x + stride, *c = count > 2 ? b + stride : b;
    const double v2 = count > 2 ? v[2] : 0.0, u2 = count > 2 ? u[2] : 0.0;
    for (size_t j = first; j < end; j++) {
        const double sum = a[j] + v[1] * b[j] + v2 * c[j], last = c[j] - u2 * sum;
        a[j] -= u[0] * sum;
        b[j] -= u[1] * sum;
        c[j] = count > 2 ? last : b[j];
    }
}

/* The same to neighbouring columns from column on, rows 0 to end - 1. */
static void reflect_columns(const struct schur *s, size_t column, size_t count, size_t end, const double *u, const double *v)
{
    for (size_t i = 0; i < end; i++) {
        double *x = at(s, i, column), sum = 0.0;
        for (size_t k = 0; k < count; k++) {
            sum += x[k] * u[k];
        }
        for (size_t k = 0; k < count; k++) {
            x[k] -= sum * v[k];
        }
    }
}

/* First column of (T - shift)(T - conjugate of shift) of a block, up to a factor. The shifts are the eigenvalues of its last two
 * rows, or at times others, so that it does not go round in circles. */
static void first_column(const struct schur *s, size_t begin, size_t end, size_t pass, double *p)
{
    const size_t l = end - 1;
    double x = *at(s, l, l), y = *at(s, l - 1, l - 1), w = *at(s, l, l - 1) * *at(s, l - 1, l);
    if (pass % 10 == 0) {
        const double size = fabs(*at(s, l, l - 1)) + fabs(*at(s, l - 1, l - 2));
        x = y = *at(s, l, l) + 0.75 * size;
        w = -0.4375 * size * size;
    }
    const double first = *at(s, begin, begin), second = *at(s, begin + 1, begin + 1);
    const double r = x - first, q = y - first;
    p[0] = (r * q - w) / *at(s, begin + 1, begin) + *at(s, begin, begin + 1);
    p[1] = second - first - r - q;
    p[2] = *at(s, begin + 2, begin + 1);
}

/* One step of the algorithm on a block of three rows or more. */
static void step(const struct schur *s, size_t begin, size_t end, size_t pass)
{
    double p[3], u[3], v[3];
    first_column(s, begin, end, pass, p);
    for (size_t k = begin; k + 1 < end; k++) {
        const size_t count = end - k > 2 ? 3 : 2;
        if (k > begin) {
            p[0] = *at(s, k, k - 1);
            p[1] = *at(s, k + 1, k - 1);
            p[2] = count > 2 ? *at(s, k + 2, k - 1) : 0.0;
        }
        if (!reflection(p[0], p[1], count > 2 ? p[2] : 0.0, u, v)) {
            continue;
        }
        reflect_rows(at(s, k, 0), s->n, count, k > begin ? k - 1 : k, s->n, u, v);
        reflect_columns(s, k, count, k + 4 < end ? k + 4 : end, u, v);
        reflect_rows(s->z + k * s->n, s->n, count, 0, s->n, u, v);
        for (size_t i = k + 1; k > begin && i < k + count; i++) {
            *at(s, i, k - 1) = 0.0;
        }
    }
}

static int find_schur(const struct schur *s)
{
    size_t passes = 0, pass = 1;
    for (size_t end = s->n; end > 0;) {
        const size_t begin = block_begin(s, end);
        if (end - begin <= 2) {
            end = begin;
            pass = 1;
        } else if (passes++ < 30 * (s->n + 10)) {
            step(s, begin, end, pass++);
        } else {
            return 0;
        }
    }
    return 1;
}

/* x, or a little if it is smaller than that. */
static double complex not_below(double complex x, double least)
{
    return cabs(x) > least ? x : least;
}

/* r [2] = solution of the block of one or two rows from i on less lambda; where that is singular to rounding, of one that is not
 * quite. */
static void solve_block(const struct schur *s, size_t i, size_t rows, double complex lambda, double least, double complex *r)
{
    const double complex a = *at(s, i, i) - lambda;
    if (rows == 1) {
        r[0] /= not_below(a, least);
        return;
    }
    const double complex b = *at(s, i, i + 1), c = *at(s, i + 1, i), d = *at(s, i + 1, i + 1) - lambda;
    const int swap = cabs(c) > cabs(a);
    const double complex p = swap ? c : a, q = swap ? d : b, factor = (swap ? a : c) / p;
    const double complex first = r[swap], second = r[!swap] - factor * first;
    r[1] = second / not_below((swap ? b : d) - factor * q, least);
    r[0] = (first - q * r[1]) / p;
}

/* Solves (T - lambda) y = 0, y [2][n], of which y [begin] to y [end - 1] are known. */
static void solve_up(const struct schur *s, size_t begin, size_t end, double complex lambda, double least, double *y)
{
    const size_t n = s->n;
    for (size_t i = begin; i > 0;) {
        const size_t rows = i > 1 && *at(s, i - 1, i - 2) != 0.0 ? 2 : 1;
        double complex r[2];
        i -= rows;
        for (size_t k = 0; k < rows; k++) {
            double re = 0.0, im = 0.0;
            for (size_t j = i + rows; j < end; j++) {
                re -= *at(s, i + k, j) * y[j];
                im -= *at(s, i + k, j) * y[n + j];
            }
            r[k] = re + im * I;
        }
        solve_block(s, i, rows, lambda, least, r);
        for (size_t k = 0; k < rows; k++) {
            y[i + k] = creal(r[k]);
            y[n + i + k] = cimag(r[k]);
        }
    }
}

/* Eigenvalues of the block of one or two rows at k. */
static void block_values(const struct schur *s, size_t k, size_t rows, double *re, double *im)
{
    im[0] = 0.0;
    re[0] = *at(s, k, k);
    if (rows == 1) {
        return;
    }
    const double d = *at(s, k + 1, k + 1), half = 0.5 * (*at(s, k, k) - d), cross = *at(s, k, k + 1) * *at(s, k + 1, k);
    const double square = half * half + cross, root = sqrt(fabs(square));
    if (square < 0.0) {
        re[0] = re[1] = d + half;
        im[0] = root;
        im[1] = -root;
        return;
    }
    const double far = half < 0.0 ? half - root : half + root;
    im[1] = 0.0;
    re[0] = d + far;
    re[1] = far != 0.0 ? d - cross / far : re[0];
}

/* The eigenvector of an eigenvalue of the block at k: real part in x [0], imaginary part in x [1], if it is complex. y [2][n] */
static void find_vector(const struct schur *s, size_t k, size_t rows, double complex lambda, double least, const double *balance,
                        double *y, double *x[2])
{
    const size_t n = s->n;
    const size_t parts = cimag(lambda) != 0.0 ? 2 : 1;
    memset(y, 0, 2 * n * sizeof *y);
    y[k] = 1.0;
    if (rows > 1) {
        /* from the row of the block that says more */
        const double complex a = lambda - *at(s, k, k), d = lambda - *at(s, k + 1, k + 1);
        const double b = *at(s, k, k + 1), c = *at(s, k + 1, k);
        const int upper = cabs(a) + fabs(b) > cabs(d) + fabs(c);
        y[k] = upper ? b : creal(d);
        y[k + 1] = upper ? creal(a) : c;
        y[n + k] = upper ? 0.0 : cimag(d);
        y[n + k + 1] = upper ? cimag(a) : 0.0;
    }
    solve_up(s, k, k + rows, lambda, least, y);
    double square = 0.0;
    for (size_t part = 0; part < parts; part++) {
        memset(x[part], 0, n * sizeof **x);
        for (size_t j = 0; j < k + rows; j++) {
            for (size_t i = 0; i < n; i++) {
                x[part][i] += y[part * n + j] * s->z[j * n + i];
            }
        }
        for (size_t i = 0; i < n; i++) {
            x[part][i] *= balance[i];
            square += x[part][i] * x[part][i];
        }
    }
    for (size_t part = 0; part < parts; part++) {
        for (size_t i = 0; i < n; i++) {
            x[part][i] /= sqrt(square);
        }
    }
}

static void find_vectors(const struct schur *s, const double *balance, double *re, double *im, double *x, double *y)
{
    double most = 0.0;
    for (size_t k = 0; k < s->n * s->n; k++) {
        most = greater(most, fabs(s->t[k]));
    }
    for (size_t k = 0, rows; k < s->n; k += rows) {
        rows = k + 1 < s->n && *at(s, k + 1, k) != 0.0 ? 2 : 1;
        block_values(s, k, rows, re + k, im + k);
        for (size_t p = k; p < k + rows && !(im[p] < 0.0); p++) {
            double *to[2] = {x + p * s->n, im[p] > 0.0 ? x + (p + 1) * s->n : NULL};
            find_vector(s, k, rows, re[p] + im[p] * I, DBL_EPSILON * most, balance, y, to);
        }
    }
}

/* t and z from a: upper Hessenberg form. */
static void find_hessenberg(double *a, size_t n, struct schur *s, double *balance, double *work)
{
    gsl_matrix_view h = gsl_matrix_view_array(a, n, n), z = gsl_matrix_view_array(s->z, n, n);
    gsl_vector_view d = gsl_vector_view_array(balance, n), tau = gsl_vector_view_array(work, n);
    gsl_linalg_balance_matrix(&h.matrix, &d.vector);
    gsl_linalg_hessenberg_decomp(&h.matrix, &tau.vector);
    gsl_linalg_hessenberg_unpack(&h.matrix, &tau.vector, &z.matrix);
    gsl_linalg_hessenberg_set_zero(&h.matrix);
    gsl_matrix_transpose(&z.matrix);
    s->t = a;
}

int tribo_eigen(double *a, size_t n, double *re, double *im, double *x)
{
    if (n == 0 || !tribo_dense_finite(a, n * n)) {
        return n ? TRIBO_ERR_NOT_FINITE : TRIBO_OK;
    }
    double *memory = malloc((n * n + 3 * n) * sizeof *memory);
    if (!memory) {
        return TRIBO_ERR_MEMORY;
    }
    double *balance = memory + n * n, *work = balance + n;
    struct schur s = {.n = n, .z = memory};
    find_hessenberg(a, n, &s, balance, work);
    const int found = find_schur(&s);
    if (found) {
        find_vectors(&s, balance, re, im, x, work);
    }
    free(memory);
    return found ? TRIBO_OK : TRIBO_ERR_NO_CONVERGENCE;
}
