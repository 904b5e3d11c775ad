/* SPDX-License-Identifier: BSD-3-Clause */
#include "linear.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "tribo/tribo.h"

/* LAPACK: A = U S V', eigenvectors of a symmetric matrix, and a complex linear system. Matrices column by column. */
void dgesvd_(const char *u_columns, const char *v_rows, const int *rows, const int *cols, double *a, const int *stride,
             double *singular, double *u, const int *u_stride, double *v, const int *v_stride, double *work, const int *size,
             int *info, size_t one, size_t two);
void dsyev_(const char *vectors, const char *triangle, const int *n, double *a, const int *stride, double *values, double *work,
            const int *size, int *info, size_t one, size_t two);
void zgesv_(const int *n, const int *cols, double *a, const int *stride, int *pivot, double *b, const int *next, int *info);

double relative_difference(double a, double b)
{
    return a == b ? 0.0 : fabs(a - b) / fmax(fabs(a), fabs(b));
}

struct linear create_linear(size_t count)
{
    struct linear l = {.count = count, .omega = need_memory(4 * count, sizeof *l.omega)};
    l.cosine = l.omega + count;
    l.sine = l.cosine + count;
    l.measured = l.sine + count;
    l.damping = need_memory(count * count, sizeof *l.damping);
    return l;
}

void free_linear(struct linear *l)
{
    free(l->omega);
    free(l->damping);
}

void find_coupling(struct linear *l)
{
    for (size_t k = 0; k < l->count * l->count; k++) {
        l->coupled = l->coupled || (k / l->count != k % l->count && l->damping[k] != 0.0);
    }
}

/* ---------------------------------------------------------------------------------------------------------- all stuck */

double dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* to [count][count] = B A B' with A [n][n] symmetric and B [count][n]. */
static void project_matrix(const double *a, size_t n, const double *b, size_t count, double *to)
{
    double *force = need_memory(n, sizeof *force);
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < n; k++) {
            force[k] = dot(a + k * n, b + i * n, n);
        }
        for (size_t j = 0; j < count; j++) {
            to[j * count + i] = dot(force, b + j * n, n);
        }
    }
    free(force);
}

struct linear stick(const struct linear *open, const struct contact *contact, size_t contacts, const double *shape)
{
    const size_t n = open->count;
    const int rows = (int)n, cols = (int)contacts, size = 40 * (rows + cols);
    double *k = need_memory((4 * n + contacts + 1) * n + contacts + (size_t)size, sizeof *k), *basis = k + n * n;
    double *vector = basis + n * n, *mode = vector + n * n, *column = mode + n * n, *singular = column + contacts * n;
    double *work = singular + n + contacts;
    int info = 0;
    size_t rank = 0;
    for (size_t i = 0; i < n; i++) {
        k[i * (n + 1)] = open->omega[i] * open->omega[i];
    }
    for (size_t c = 0; c < contacts; c++) {
        const double *row = shape + c * n, stiffness = contact[c].stiffness;
        if (stiffness == 0.0) {
            memcpy(column + c * n, row, n * sizeof *column);
        }
        for (size_t i = 0; stiffness > 0.0 && i < n * n; i++) {
            k[i] += stiffness * row[i / n] * row[i % n];
        }
    }
    /* motions that move no rigid contact: columns of U behind the rank */
    dgesvd_("A", "N", &rows, &cols, column, &rows, singular, basis, &rows, column, &rows, work, &size, &info, 1, 1);
    need(info ? TRIBO_ERR_NO_CONVERGENCE : TRIBO_OK, "motions with all contacts stuck");
    while (rank < contacts && rank < n && singular[rank] > 1e-10 * singular[0]) {
        rank++;
    }
    const size_t count = n - rank;
    const double *held = basis + rank * n;
    struct linear l = create_linear(count);
    const int left = (int)count;
    project_matrix(k, n, held, count, vector);
    if (count > 0) {
        dsyev_("V", "L", &left, vector, &left, l.omega, work, &size, &info, 1, 1);
    }
    need(info ? TRIBO_ERR_NO_CONVERGENCE : TRIBO_OK, "modes with all contacts stuck");
    for (size_t i = 0; i < count; i++) {
        double *m = mode + i * n;
        for (size_t j = 0; j < count * n; j++) {
            m[j % n] += vector[i * count + j / n] * held[j];
        }
        l.omega[i] = sqrt(fmax(l.omega[i], 0.0));
        l.cosine[i] = dot(open->cosine, m, n);
        l.sine[i] = dot(open->sine, m, n);
        l.measured[i] = dot(open->measured, m, n);
    }
    project_matrix(open->damping, n, mode, count, l.damping);
    find_coupling(&l);
    free(k);
    return l;
}

/* ------------------------------------------------------------------------------------------------------------ response */

/* x [count][2]: complex amplitudes of the modes; NaN where the dynamic stiffness is singular. */
static void linear_response(const struct linear *l, double omega, double *x)
{
    const size_t n = l->count;
    for (size_t k = 0; k < n; k++) {
        x[2 * k] = l->cosine[k];
        x[2 * k + 1] = -l->sine[k];
    }
    if (!l->coupled) {
        for (size_t k = 0; k < n; k++) {
            const double re = l->omega[k] * l->omega[k] - omega * omega, im = l->damping[k * (n + 1)] * omega;
            const double size = hypot(re, im), c = re / size, s = im / size, p = x[2 * k], q = x[2 * k + 1];
            x[2 * k] = (c * p + s * q) / size;
            x[2 * k + 1] = (c * q - s * p) / size;
        }
        return;
    }
    double *a = need_memory(2 * n * n, sizeof *a);
    int *pivot = need_memory(n, sizeof *pivot), info;
    const int rows = (int)n, one = 1;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            a[2 * (j * n + i)] = i == j ? l->omega[i] * l->omega[i] - omega * omega : 0.0;
            a[2 * (j * n + i) + 1] = l->damping[i * n + j] * omega;
        }
    }
    zgesv_(&rows, &one, a, &rows, pivot, x, &rows, &info);
    x[0] = info ? (double)NAN : x[0];
    free(a);
    free(pivot);
}

struct scale scale_of(const struct linear *l, double omega)
{
    struct scale s = {0.0, 0.0, 0.0};
    double *x = need_memory(2 * l->count, sizeof *x), re = 0.0, im = 0.0;
    linear_response(l, omega, x);
    for (size_t k = 0; k < l->count; k++) {
        const double q = hypot(x[2 * k], x[2 * k + 1]);
        re += l->measured[k] * x[2 * k];
        im += l->measured[k] * x[2 * k + 1];
        s.norm = hypot(s.norm, hypot(l->omega[k], omega) * q);
        s.power += 0.5 * omega * hypot(l->cosine[k], l->sine[k]) * q;
    }
    s.amplitude = hypot(re, im);
    free(x);
    return s;
}
