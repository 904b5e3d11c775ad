/* Lanczos' method for the highest eigenvalue, in the metric of the mass matrix, in which AK is symmetric. Contacts at rest can
 * only lower the eigenvalue. */
#include "spectrum.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* The search ends if twice the number of vectors changes the eigenvalue by at most this part, or at MOST_VECTORS vectors. */
#define CLOSE 0.01
#define MOST_VECTORS 1024

struct lanczos {
    const tribo_system *sys;
    double stiffness, damping;
    size_t n;
    double *v, *mv, *before, *next, *m_next; /* [n] vector k; M v; vector k - 1; vector k + 1; M next */
    double *alpha, *beta;                    /* [MOST_VECTORS] diagonals */
};

static void apply_mass(const tribo_system *sys, const double *x, double *y)
{
    memset(y, 0, sys->ndof * sizeof *y);
    tribo_system_add_mass(sys, 1.0, x, y);
}

static void spectrum_apply(const struct lanczos *l, const double *x, double *y)
{
    memset(y, 0, l->n * sizeof *y);
    tribo_matrix_multiply_add(&l->sys->stiffness, l->stiffness, x, y);
    if (l->damping != 0.0) {
        tribo_matrix_multiply_add(&l->sys->damping, l->damping, x, y);
    }
}

/* Sets x [n] = numbers of either sign, 1/2 <= |x_i| <= 1, the same at every call with this seed. */
static void spectrum_scatter(double *x, size_t n, uint64_t seed)
{
    for (size_t i = 0; i < n; i++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        const double part = (double)(seed >> 40) / 16777216.0;
        x[i] = part < 0.5 ? part - 1.0 : part;
    }
}

/* Returns 1 if damping is symmetric: x'M AC y = y'M AC x to rounding, for two pseudo-random x and y. */
static int symmetric_damping(struct lanczos *l)
{
    const tribo_system *sys = l->sys;
    spectrum_scatter(l->v, l->n, 1);
    spectrum_scatter(l->before, l->n, 2);
    double sum[2], size = 0.0;
    for (int k = 0; k < 2; k++) {
        memset(l->next, 0, l->n * sizeof *l->next);
        tribo_matrix_multiply_add(&sys->damping, 1.0, k ? l->v : l->before, l->next);
        apply_mass(sys, l->next, l->m_next);
        sum[k] = tribo_dot(k ? l->before : l->v, l->m_next, l->n);
        for (size_t i = 0; i < l->n; i++) {
            size += fabs(l->m_next[i]);
        }
    }
    return fabs(sum[0] - sum[1]) <= 1e-10 * size;
}

/* Returns the number of eigenvalues above x of the tridiagonal matrix of k rows (Sturm). */
static size_t above(const struct lanczos *l, size_t k, double x)
{
    size_t count = 0;
    double d = 1.0;
    for (size_t i = 0; i < k; i++) {
        const double b = i ? l->beta[i - 1] : 0.0;
        d = l->alpha[i] - x - b * b / d;
        d = d == 0.0 ? DBL_EPSILON : d;
        count += d > 0.0;
    }
    return count;
}

static double highest(const struct lanczos *l, size_t k)
{
    double lo = l->alpha[0], hi = lo;
    for (size_t i = 0; i < k; i++) {
        const double around = (i ? fabs(l->beta[i - 1]) : 0.0) + (i + 1 < k ? fabs(l->beta[i]) : 0.0);
        lo = greater(lo, l->alpha[i]); /* Rayleigh */
        hi = greater(hi, l->alpha[i] + around);
    }
    while (hi - lo > 4.0 * DBL_EPSILON * greater(fabs(lo), fabs(hi))) {
        const double middle = 0.5 * (lo + hi);
        if (!(middle > lo && middle < hi)) {
            break;
        }
        *(above(l, k, middle) ? &lo : &hi) = middle;
    }
    return hi;
}

/* Sets alpha[k], beta[k] and the next Lanczos vector. Returns 0 if the space is exhausted. */
static int spectrum_extend(struct lanczos *l, size_t k, double size)
{
    const size_t n = l->n;
    spectrum_apply(l, l->v, l->next);
    l->alpha[k] = tribo_dot(l->mv, l->next, n);
    for (size_t i = 0; i < n; i++) {
        l->next[i] -= l->alpha[k] * l->v[i] + (k ? l->beta[k - 1] * l->before[i] : 0.0);
    }
    apply_mass(l->sys, l->next, l->m_next);
    const double square = tribo_dot(l->next, l->m_next, n);
    l->beta[k] = square > 0.0 ? sqrt(square) : 0.0;
    if (!(l->beta[k] > 1e-13 * size)) {
        return 0;
    }
    for (size_t i = 0; i < n; i++) {
        l->before[i] = l->v[i];
        l->v[i] = l->next[i] / l->beta[k];
        l->mv[i] = l->m_next[i] / l->beta[k];
    }
    return 1;
}

static double iterate(struct lanczos *l)
{
    const size_t most = l->n < MOST_VECTORS ? l->n : MOST_VECTORS;
    double value = 0.0, last = -HUGE_VAL, size = 0.0;
    spectrum_scatter(l->v, l->n, 3);
    apply_mass(l->sys, l->v, l->mv);
    const double length = sqrt(tribo_dot(l->v, l->mv, l->n));
    for (size_t i = 0; i < l->n; i++) {
        l->v[i] /= length;
        l->mv[i] /= length;
        l->before[i] = 0.0;
    }
    for (size_t k = 1, check = 8; k <= most; k++) {
        const int more = spectrum_extend(l, k - 1, size);
        size = greater(size, fabs(l->alpha[k - 1]) + l->beta[k - 1]);
        if (!more || k == most || k == check) {
            value = highest(l, k);
            const double change = !more || k == l->n ? 0.0 : value - last;
            if (change <= CLOSE * fabs(value)) {
                return value + change;
            }
            last = value;
            check *= 2;
        }
    }
    return value * (1.0 + CLOSE);
}

int tribo_system_highest(const tribo_system *sys, double stiffness, double damping, double *value)
{
    const size_t n = sys->ndof;
    const double bound = stiffness * tribo_matrix_row_sum(&sys->stiffness) + damping * tribo_matrix_row_sum(&sys->damping);
    *value = bound;
    if (bound == 0.0 || !isfinite(bound)) {
        return TRIBO_OK;
    }
    struct lanczos l = {.sys = sys, .stiffness = stiffness / bound, .damping = damping / bound, .n = n};
    double *work = malloc((5 * n + 2 * MOST_VECTORS) * sizeof *work);
    if (!work) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the frequencies of %zu degree%s of freedom", n,
                                 plural(n));
    }
    l.v = work;
    l.mv = work + n;
    l.before = work + 2 * n;
    l.next = work + 3 * n;
    l.m_next = work + 4 * n;
    l.alpha = work + 5 * n;
    l.beta = l.alpha + MOST_VECTORS;
    if (sys->damping.rows == 0 || !symmetric_damping(&l)) {
        l.damping = 0.0;
    }
    *value = bound * greater(iterate(&l), 0.0);
    free(work);
    return TRIBO_OK;
}

int tribo_system_top_frequency(const tribo_system *sys, double *omega)
{
    double square;
    const int status = tribo_system_highest(sys, 1.0, 0.0, &square);
    if (status) {
        return status;
    }
    *omega = sqrt(square);
    for (size_t k = 0; k < sys->harmonics; k++) {
        *omega = greater(*omega, fabs(sys->harmonic[k].omega));
    }
    return TRIBO_OK;
}
