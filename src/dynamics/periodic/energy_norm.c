/* SPDX-License-Identifier: BSD-3-Clause */
#include "energy_norm.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Sets natural, phi and psi by the eigenvectors of S'KS, M^-1 = S S'. k [n][n]: workspace. Returns a status. */
static int find_free_modes(struct energy_norm *e, const tribo_system *sys, double *k)
{
    const size_t n = e->n;
    struct matrix own = {0};
    const struct matrix *stiffness = tribo_system_force_matrix(sys, &sys->k, &sys->stiffness, &own);
    if (!stiffness) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the modes of the free structure");
    }
    tribo_matrix_spread(stiffness, k);
    tribo_matrix_free(&own);
    tribo_even_out(n, k);
    int status = tribo_symmetric_eigen_by(&sys->factor, k, n, e->natural, e->phi);
    for (size_t i = 0; i < n; i++) {
        e->natural[i] = sqrt(fabs(e->natural[i]));
    }
    tribo_transpose(n, n, e->phi, k);
    if (sys->mass.rows) {
        tribo_matrix_multiply_all(&sys->mass, n, k, e->psi);
    } else {
        memcpy(e->psi, k, n * n * sizeof *k);
    }
    return status ? tribo_system_fail(sys, status, "modes of the free structure: %s", tribo_strerror(status)) : TRIBO_OK;
}

/* Sets root, G = root root'. Returns a status. */
static int find_root(struct energy_norm *e, const tribo_system *sys)
{
    const struct compliance *g = &sys->compliance;
    const size_t c = g->count;
    for (size_t i = 0; i < c; i++) {
        for (size_t k = 0; k <= i; k++) {
            double sum = tribo_compliance_entry(g, sys->ncontact, g->contact[i], g->contact[k]);
            sum -= tribo_dot(e->root + i * c, e->root + k * c, k);
            e->root[i * c + k] = k < i ? sum / e->root[k * c + k] : sqrt(sum);
        }
    }
    return tribo_dense_finite(e->root, c * c)
               ? TRIBO_OK
               : tribo_system_fail(sys, TRIBO_ERR_INDEFINITE, "the compliance of the contacts is not positive definite");
}

int tribo_energy_norm_create(struct energy_norm *e, const tribo_system *sys)
{
    const size_t n = sys->ndof;
    *e = (struct energy_norm){.n = n, .springs = sys->compliance.count, .scale = 1.0};
    e->phi = calloc(2 * n * n + 3 * n + e->springs * e->springs + 1, sizeof *e->phi);
    double *work = malloc((n * n + 1) * sizeof *work);
    int status =
        e->phi && work ? TRIBO_OK : tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the modes of the free structure");
    if (!status) {
        e->psi = e->phi + n * n;
        e->omega = e->psi + n * n;
        e->natural = e->omega + n;
        e->damping = e->natural + n;
        e->root = e->damping + n;
        status = find_free_modes(e, sys, work);
        status = status ? status : find_root(e, sys);
    }
    free(work);
    return status;
}

void tribo_energy_norm_free(struct energy_norm *e)
{
    free(e->phi);
    memset(e, 0, sizeof *e);
}

void tribo_energy_norm_set_damping(struct energy_norm *e, const tribo_system *sys)
{
    const size_t n = e->n;
    memset(e->damping, 0, n * sizeof *e->damping);
    for (size_t i = 0; sys->damping.rows && i < n; i++) {
        for (size_t m = sys->damping.first[i]; m < sys->damping.first[i + 1]; m++) {
            const double *column = e->phi + sys->damping.col[m] * n, c = sys->damping.val[m];
            for (size_t k = 0; k < n; k++) {
                e->damping[k] += e->psi[k * n + i] * c * column[k];
            }
        }
    }
}

int tribo_energy_norm_is_damped(const struct energy_norm *e)
{
    for (size_t k = 0; k < e->n; k++) {
        if (!(e->damping[k] > 0.0)) {
            return 0;
        }
    }
    return 1;
}

void tribo_energy_norm_set_least(struct energy_norm *e, double least)
{
    for (size_t i = 0; i < e->n; i++) {
        e->omega[i] = greater(e->natural[i], least);
    }
}

/* x [n + n + springs][columns] *= scale, its first n rows also *= omega; divide = 1: divided by these. */
static void scale_rows(const struct energy_norm *e, size_t columns, int divide, double *x)
{
    for (size_t k = 0; k < 2 * e->n + e->springs; k++) {
        const double size = e->scale * (k < e->n ? e->omega[k] : 1.0), factor = divide ? 1.0 / size : size;
        for (size_t j = 0; j < columns; j++) {
            x[k * columns + j] *= factor;
        }
    }
}

void tribo_energy_norm_of(const struct energy_norm *e, size_t columns, const double *y, double *x)
{
    const size_t n = e->n, half = n * columns;
    memset(x, 0, (2 * n + e->springs) * columns * sizeof *x);
    tribo_multiply_add(n, n, columns, 1.0, e->psi, y, x);
    tribo_multiply_add(n, n, columns, 1.0, e->psi, y + half, x + half);
    tribo_multiply_transposed_add(e->springs, e->springs, columns, e->root, y + 2 * half, x + 2 * half);
    scale_rows(e, columns, 0, x);
}

void tribo_energy_norm_state(const struct energy_norm *e, size_t columns, double *x, double *y)
{
    const size_t n = e->n, half = n * columns;
    scale_rows(e, columns, 1, x);
    memset(y, 0, 2 * half * sizeof *y);
    tribo_multiply_add(n, n, columns, 1.0, e->phi, x, y);
    tribo_multiply_add(n, n, columns, 1.0, e->phi, x + half, y + half);
    for (size_t i = e->springs; i-- > 0;) {
        double *f = y + 2 * half + i * columns;
        memcpy(f, x + 2 * half + i * columns, columns * sizeof *f);
        for (size_t k = i + 1; k < e->springs; k++) {
            tribo_add(f, -e->root[k * e->springs + i], y + 2 * half + k * columns, columns);
        }
        for (size_t j = 0; j < columns; j++) {
            f[j] /= e->root[i * e->springs + i];
        }
    }
}

double tribo_energy_length(const double *x, size_t n)
{
    return sqrt(tribo_dot(x, x, n));
}

double tribo_energy_distance(const double *a, const double *b, size_t n)
{
    double square = 0.0;
    for (size_t i = 0; i < n; i++) {
        square += (a[i] - b[i]) * (a[i] - b[i]);
    }
    return sqrt(square);
}
