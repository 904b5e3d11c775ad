#include "newton.h"
#include "../common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>

/* A matrix serves while steps differ by no more than this from those that it was made for. */
#define SAME_STEP 0.1

#define MOST_ITERATIONS 12

int tribo_newton_create(struct newton *w, size_t n, size_t stages)
{
    const size_t size = n * stages;
    memset(w, 0, sizeof *w);
    w->n = n;
    w->stages = stages;
    w->matrix = calloc(size, size * sizeof *w->matrix);
    w->jacobian = calloc(n, n * sizeof *w->jacobian);
    w->pivot = malloc(size * sizeof *w->pivot);
    w->residual = malloc((size + 2 * n) * sizeof *w->residual);
    if (!w->matrix || !w->jacobian || !w->pivot || !w->residual) {
        tribo_newton_free(w);
        return 0;
    }
    w->stage = w->residual + size;
    w->by_time = w->stage + n;
    return 1;
}

void tribo_newton_free(struct newton *w)
{
    free(w->matrix);
    free(w->jacobian);
    free(w->pivot);
    free(w->residual);
    memset(w, 0, sizeof *w);
}

/* ------------------------------------------------------------------------------------------------------ linear equations */

static void swap_rows(double *a, size_t n, size_t i, size_t j)
{
    for (size_t k = 0; i != j && k < n; k++) {
        const double x = a[i * n + k];
        a[i * n + k] = a[j * n + k];
        a[j * n + k] = x;
    }
}

/* L U = P A in place, with partial pivoting. 0 if a pivot is zero or not finite. */
static int factorize(double *a, size_t *pivot, size_t n)
{
    for (size_t k = 0; k < n; k++) {
        size_t p = k;
        for (size_t i = k + 1; i < n; i++) {
            p = fabs(a[i * n + k]) > fabs(a[p * n + k]) ? i : p;
        }
        if (a[p * n + k] == 0.0 || !isfinite(a[p * n + k])) {
            return 0;
        }
        pivot[k] = p;
        swap_rows(a, n, k, p);
        for (size_t i = k + 1; i < n; i++) {
            const double factor = a[i * n + k] /= a[k * n + k];
            for (size_t j = k + 1; factor != 0.0 && j < n; j++) {
                a[i * n + j] -= factor * a[k * n + j];
            }
        }
    }
    return 1;
}

static void substitute(const double *a, const size_t *pivot, size_t n, double *x)
{
    for (size_t k = 0; k < n; k++) {
        const double y = x[pivot[k]];
        x[pivot[k]] = x[k];
        x[k] = y;
        for (size_t i = 0; i < k; i++) {
            x[k] -= a[k * n + i] * x[i];
        }
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t j = k + 1; j < n; j++) {
            x[k] -= a[k * n + j] * x[j];
        }
        x[k] /= a[k * n + k];
    }
}

/* ------------------------------------------------------------------------------------------------------------ iteration */

static void find_stage(struct newton *w, size_t i, double h, const double *a, const double *base, const double *k)
{
    memcpy(w->stage, base, w->n * sizeof *base);
    for (size_t j = 0; j < w->stages; j++) {
        for (size_t m = 0; m < w->n; m++) {
            w->stage[m] += h * a[i * w->stages + j] * k[j * w->n + m];
        }
    }
}

static int find_residual(struct newton *w, tribo_system *sys, const double *time, double h, const double *a, const double *base,
                         const double *k)
{
    for (size_t i = 0; i < w->stages; i++) {
        double *r = w->residual + i * w->n;
        find_stage(w, i, h, a, base, k);
        const int status = sys->odeiv2.function(time[i], w->stage, r, sys);
        if (status) {
            return status;
        }
        for (size_t m = 0; m < w->n; m++) {
            r[m] -= k[i * w->n + m];
        }
    }
    return GSL_SUCCESS;
}

static int find_matrix(struct newton *w, tribo_system *sys, const double *time, double h, const double *a, const double *base,
                       const double *k)
{
    const size_t n = w->n, s = w->stages, size = n * s;
    w->h = 0.0;
    for (size_t i = 0; i < s; i++) {
        find_stage(w, i, h, a, base, k);
        const int status = sys->odeiv2.jacobian(time[i], w->stage, w->jacobian, w->by_time, sys);
        if (status) {
            return status;
        }
        for (size_t e = 0; e < n * size; e++) {
            const size_t row = e / size, col = e % size;
            w->matrix[i * n * size + e] =
                (col == i * n + row ? 1.0 : 0.0) - h * a[i * s + col / n] * w->jacobian[row * n + col % n];
        }
    }
    if (!factorize(w->matrix, w->pivot, size)) {
        return GSL_FAILURE;
    }
    w->h = h;
    return GSL_SUCCESS;
}

/* The largest change of y that slopes dk make, in terms of the tolerance. */
static double change(const struct newton *w, double h, const double *dk, const double *tolerance)
{
    double most = 0.0;
    for (size_t i = 0; i < w->stages; i++) {
        for (size_t m = 0; m < w->n; m++) {
            const double x = fabs(h * dk[i * w->n + m]) / tolerance[m];
            most = x <= most ? most : x; /* a NaN stays */
        }
    }
    return most;
}

/* At a kink the matrix is that of one side, and a small change by it says little: how fast changes fall from one to the next
 * does, and where they do not, a new matrix is due. */
int tribo_newton_solve(struct newton *w, tribo_system *sys, const double *time, double h, const double *a, const double *base,
                       const double *tolerance, double *k)
{
    double before = HUGE_VAL;
    int stale = !(fabs(h - w->h) <= SAME_STEP * h);
    for (int it = 0; it < MOST_ITERATIONS; it++) {
        int status = find_residual(w, sys, time, h, a, base, k);
        if (!status && stale) {
            status = find_matrix(w, sys, time, h, a, base, k);
        }
        if (status) {
            w->h = 0.0;
            return status;
        }
        substitute(w->matrix, w->pivot, w->n * w->stages, w->residual);
        for (size_t m = 0; m < w->n * w->stages; m++) {
            k[m] += w->residual[m];
        }
        const double now = change(w, h, w->residual, tolerance), rate = now / before;
        if (!isfinite(now)) {
            break;
        }
        if (now == 0.0 || (it && rate < 1.0 && now * rate <= 0.01 * (1.0 - rate))) {
            return GSL_SUCCESS;
        }
        stale = it && rate > 0.1;
        before = now;
    }
    w->h = 0.0;
    return GSL_FAILURE;
}
