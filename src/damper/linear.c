/* SPDX-License-Identifier: BSD-3-Clause */
#include "linear.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "tribo/tribo.h"

/* LAPACK: A P = Q R, columns of Q, eigenvectors of a symmetric matrix, and a complex linear system. Matrices column by column. */
void dgeqp3_(const int *rows, const int *cols, double *a, const int *stride, int *pivot, double *tau, double *work,
             const int *size, int *info);
void dorgqr_(const int *rows, const int *cols, const int *count, double *a, const int *stride, const double *tau, double *work,
             const int *size, int *info);
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

/* Orthonormal motions [returned][n] that move no rigid contact, in basis [n][n] from *first on. */
static size_t held_motions(size_t n, size_t contacts, const double *shape, const double *stiffness, double *basis, double **first)
{
    enum { BLOCK = 32 };
    const int rows = (int)n, size = BLOCK * ((int)n + 1);
    double *tau = need_memory(n + (size_t)size, sizeof *tau), *work = tau + n;
    double *column = need_memory(n * contacts, sizeof *column);
    int *pivot = need_memory(contacts, sizeof *pivot), cols = 0, info = 0, least = 0, rank = 0;
    for (size_t c = 0; c < contacts; c++) {
        if (stiffness[c] == 0.0) {
            memcpy(column + n * (size_t)cols++, shape + c * n, n * sizeof *column);
        }
    }
    if (cols > 0) {
        const int room = 3 * cols + 1 + BLOCK * (cols + 1);
        double *more = need_memory((size_t)room, sizeof *more);
        dgeqp3_(&rows, &cols, column, &rows, pivot, tau, more, &room, &info);
        free(more);
        least = rows < cols ? rows : cols;
        while (rank < least && fabs(column[(size_t)rank * (n + 1)]) > 1e-10 * fabs(column[0])) {
            rank++;
        }
        memcpy(basis, column, (size_t)least * n * sizeof *basis);
    }
    dorgqr_(&rows, &rows, &least, basis, &rows, tau, work, &size, &info);
    free(tau);
    free(column);
    free(pivot);
    *first = basis + (size_t)rank * n;
    return n - (size_t)rank;
}

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* Stiffness [count][count] of motions [count][n], of the structure and of the springs: LAPACK's lower triangle. */
static void project_stiffness(const struct linear *open, size_t contacts, const double *shape, const double *stiffness,
                              const double *motion, size_t count, double *to)
{
    const size_t n = open->count;
    double *force = need_memory(n, sizeof *force);
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < n; k++) {
            force[k] = open->omega[k] * open->omega[k] * motion[i * n + k];
        }
        for (size_t c = 0; c < contacts; c++) {
            const double spring = stiffness[c] > 0.0 ? stiffness[c] * dot(shape + c * n, motion + i * n, n) : 0.0;
            for (size_t k = 0; spring != 0.0 && k < n; k++) {
                force[k] += spring * shape[c * n + k];
            }
        }
        for (size_t j = 0; j <= i; j++) {
            to[j * count + i] = dot(force, motion + j * n, n);
        }
    }
    free(force);
}

/* Damping, loads and measured place of the modes mode [l->count][open->count]. */
static void project_linear(const struct linear *open, const double *mode, struct linear *l)
{
    const size_t n = open->count;
    double *force = need_memory(n, sizeof *force);
    for (size_t i = 0; i < l->count; i++) {
        l->cosine[i] = dot(open->cosine, mode + i * n, n);
        l->sine[i] = dot(open->sine, mode + i * n, n);
        l->measured[i] = dot(open->measured, mode + i * n, n);
        for (size_t k = 0; k < n; k++) {
            force[k] = dot(open->damping + k * n, mode + i * n, n);
        }
        for (size_t j = 0; j < l->count; j++) {
            l->damping[j * l->count + i] = dot(force, mode + j * n, n);
        }
    }
    free(force);
    find_coupling(l);
}

struct linear stick(const struct linear *open, size_t contacts, const double *shape, const double *stiffness)
{
    const size_t n = open->count;
    double *basis = need_memory(n * n, sizeof *basis), *held;
    const size_t count = held_motions(n, contacts, shape, stiffness, basis, &held);
    const int rows = (int)count, size = 34 * (rows + 1);
    struct linear l = create_linear(count);
    double *vector = need_memory(count * count, sizeof *vector), *mode = need_memory(count * n, sizeof *mode);
    double *work = need_memory((size_t)size, sizeof *work);
    int info = 0;
    project_stiffness(open, contacts, shape, stiffness, held, count, vector);
    if (count > 0) {
        dsyev_("V", "L", &rows, vector, &rows, l.omega, work, &size, &info, 1, 1);
    }
    need(info ? TRIBO_ERR_NO_CONVERGENCE : TRIBO_OK, "modes with all contacts stuck");
    for (size_t i = 0; i < count; i++) {
        l.omega[i] = sqrt(fmax(l.omega[i], 0.0));
        for (size_t k = 0; k < count * n; k++) {
            mode[i * n + k % n] += vector[i * count + k / n] * held[k];
        }
    }
    project_linear(open, mode, &l);
    free(basis);
    free(vector);
    free(mode);
    free(work);
    return l;
}

/* ------------------------------------------------------------------------------------------------------------ response */

/* x [count][2]: complex amplitudes of the modes; NaN where the dynamic stiffness is singular. */
static void respond(const struct linear *l, double omega, double *x)
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
    respond(l, omega, x);
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

double linear_amplitude(const struct linear *l, double omega)
{
    return scale_of(l, omega).amplitude;
}
