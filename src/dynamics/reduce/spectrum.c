/* SPDX-License-Identifier: BSD-3-Clause */
/* Lanczos' method for the highest eigenvalue, in the metric of the mass matrix, in which AK is symmetric. Contacts at rest can
 * only lower the eigenvalue; normals count as pressed. Of a K that is not symmetric: a bound. */
#include "spectrum.h"
#include "lanczos.h"
#include "common/layout.h"
#include "common/real.h"
#include "numerics/lapack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The search ends if twice the number of vectors changes the eigenvalue by at most this part, or at MOST vectors. */
#define CLOSE 0.01
enum { MOST = 256 };

struct highest {
    const tribo_system *sys;
    double stiffness, damping;
    size_t n;
    double *v, *mv, *next;           /* [n] vector k; M v; vector k + 1 */
    double alpha[MOST], beta[MOST];  /* diagonals of the tridiagonal matrix */
    double values[MOST], work[MOST]; /* workspace */
};

/* Sets mv = M next, v = next, normalized; next = - norm times the v before. Returns the norm of next in M. */
static double advance(struct highest *l)
{
    tribo_matrix_multiply(&l->sys->mass, l->next, l->mv);
    const double square = tribo_dot(l->next, l->mv, l->n), norm = square > 0.0 ? sqrt(square) : 0.0;
    const double part = norm > 0.0 ? 1.0 / norm : 0.0;
    for (size_t i = 0; i < l->n; i++) {
        const double before = l->v[i];
        l->v[i] = part * l->next[i];
        l->mv[i] *= part;
        l->next[i] = -norm * before;
    }
    return norm;
}

static int iterate(struct highest *l, double *value)
{
    const size_t n = l->n, most = n < MOST ? n : MOST;
    double last = -HUGE_VAL, size = 0.0;
    uint64_t seed = 3;
    int status = TRIBO_OK;
    tribo_scatter(&seed, n, l->next);
    advance(l);
    for (size_t k = 1, check = 8; !status && k <= most; k++) {
        tribo_matrix_multiply_add(&l->sys->stiffness, l->stiffness, l->v, l->next);
        if (l->sys->normals.count) {
            tribo_normals_push(l->sys, 1, 0, -l->stiffness, l->v, l->next);
        }
        if (l->damping != 0.0) {
            tribo_matrix_multiply_add(&l->sys->damping, l->damping, l->v, l->next);
        }
        l->alpha[k - 1] = tribo_dot(l->mv, l->next, n);
        tribo_add(l->next, -l->alpha[k - 1], l->v, n);
        l->beta[k - 1] = advance(l);
        const int exhausted = !(l->beta[k - 1] > 1e-13 * size) || k == n;
        size = greater(size, fabs(l->alpha[k - 1]) + l->beta[k - 1]);
        if (exhausted || k == most || k == check) {
            const int rows = (int)k;
            int info = 0;
            memcpy(l->values, l->alpha, k * sizeof *l->values);
            memcpy(l->work, l->beta, k * sizeof *l->work);
            dsterf_(&rows, l->values, l->work, &info);
            status = info ? TRIBO_ERR_NO_CONVERGENCE : TRIBO_OK;
            *value = l->values[k - 1];
            const double change = exhausted ? 0.0 : *value - last;
            if (change <= CLOSE * fabs(*value)) {
                *value += change;
                return status;
            }
            last = *value;
            check *= 2;
        }
    }
    *value *= 1.0 + CLOSE;
    return status;
}

int tribo_system_highest(const tribo_system *sys, double stiffness, double damping, double *value)
{
    const size_t n = sys->ndof;
    const double even = tribo_matrix_row_sum(&sys->stiffness) + sys->normals.stiffest;
    const double bound = stiffness * (even + 2.0 * sys->circulation) + damping * tribo_matrix_row_sum(&sys->damping);
    *value = bound;
    if (bound == 0.0 || !isfinite(bound) || sys->circulation > 0.0) {
        return TRIBO_OK;
    }
    struct highest l = {.sys = sys, .stiffness = stiffness / bound, .damping = damping / bound, .n = n};
    size_t i, j;
    double x, y;
    if (sys->c.rows == 0 || tribo_matrix_flaw(&sys->c, 1, &i, &j, &x, &y)) {
        l.damping = 0.0;
    }
    const int status = ALLOCATE(ARRAY(l.v, n), ARRAY(l.mv, n), ARRAY(l.next, n)) ? iterate(&l, value) : TRIBO_ERR_MEMORY;
    *value = status ? bound : bound * greater(*value, 0.0);
    free(l.v);
    return status ? tribo_error(sys->message, status, "frequencies of %zu degree%s of freedom: %s", n, plural(n),
                                tribo_strerror(status))
                  : TRIBO_OK;
}
