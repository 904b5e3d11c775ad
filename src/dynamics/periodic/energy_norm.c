/* SPDX-License-Identifier: BSD-3-Clause */
#include "energy_norm.h"
#include "common/layout.h"
#include "common/real.h"
#include "numerics/lapack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Stiffness of rigid contacts that stick in linear modes, over the largest one. */
#define FIRM 1e6

int tribo_energy_norm_create(struct energy_norm *e, const tribo_system *sys)
{
    const struct compliance *g = &sys->compliance;
    const size_t n = sys->ndof, c = g->count;
    const int springs = (int)c;
    int info = 0;
    *e = (struct energy_norm){.n = n, .springs = c, .scale = 1.0};
    if (!tribo_lapack_takes(c) || !ALLOCATE(ARRAY(e->phi, n * n), ARRAY(e->psi, n * n), ARRAY(e->root, c * c),
                                            ARRAY(e->natural, n), ARRAY(e->damping, n), ARRAY(e->omega, n))) {
        return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for the modes of the free structure");
    }
    for (size_t k = 0; k < c * c; k++) {
        e->root[k] = k % c <= k / c ? tribo_compliance_entry(g, g->contact[k / c], g->contact[k % c]) : 0.0;
    }
    if (c) {
        dpotrf_("U", &springs, e->root, &springs, &info, 1);
    }
    if (info) {
        return tribo_error(sys->message, TRIBO_ERR_INDEFINITE, "the compliance of the contacts is not positive definite");
    }
    /* eigenvectors of S'KS, M^-1 = S S' */
    tribo_matrix_spread(&sys->k, e->psi);
    tribo_even_out(n, e->psi);
    const int status = tribo_symmetric_eigen_by(&sys->factor, e->psi, n, e->natural, e->phi);
    for (size_t i = 0; i < n; i++) {
        e->natural[i] = sqrt(fabs(e->natural[i]));
    }
    tribo_matrix_multiply_all(&sys->mass, n, e->phi, e->psi);
    return status ? tribo_error(sys->message, status, "modes of the free structure: %s", tribo_strerror(status)) : TRIBO_OK;
}

void tribo_energy_norm_free(struct energy_norm *e)
{
    free(e->phi);
    memset(e, 0, sizeof *e);
}

void tribo_energy_norm_set(struct energy_norm *e, const tribo_system *sys, double least)
{
    const size_t n = e->n;
    e->scale = 1.0;
    e->damped = 1;
    for (size_t k = 0; k < n; k++) {
        e->omega[k] = greater(e->natural[k], least);
        e->damping[k] = 0.0;
        for (size_t i = 0; i < sys->damping.rows; i++) {
            e->damping[k] += e->psi[k * n + i] * tribo_matrix_row_dot(&sys->damping, i, e->phi + k * n);
        }
        e->damped &= e->damping[k] > 0.0;
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
    tribo_multiply_transposed_add(n, n, columns, e->phi, x, y);
    tribo_multiply_transposed_add(n, n, columns, e->phi, x + half, y + half);
    memcpy(y + 2 * half, x + 2 * half, e->springs * columns * sizeof *y);
    tribo_half_solve(&(struct cholesky){.n = e->springs, .factor = e->root}, 1, y + 2 * half, columns);
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

int tribo_energy_norm_modes(const struct energy_norm *e, const tribo_system *sys, int sticks, double *value, double *states)
{
    const struct compliance *g = &sys->compliance;
    const size_t n = e->n, contacts = sys->ncontact, all = 2 * n + e->springs;
    const double most = tribo_largest(e->natural, n);
    double *a = calloc(n * n + 2 * contacts * n + 1, sizeof *a), *shape = a + n * n, *spring = shape + contacts * n;
    if (!a) {
        return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for linear modes");
    }
    for (size_t at = 0; at < contacts * n; at++) {
        shape[at] = spring[at] = tribo_matrix_row_dot(&sys->direction, at / n, e->phi + at % n * n);
    }
    if (g->count) {
        tribo_compliance_solve(sys, NULL, n, spring);
    }
    for (size_t i = 0; i < contacts; i++) {
        const double r = tribo_system_delassus(sys, i, i), firm = r > 0.0 ? FIRM * greater(most * most, 1.0) / r : 0.0;
        const struct normal *normal = tribo_normals_at(sys, i);
        const double stiffness = normal ? normal->stiffness : sticks ? firm : 0.0;
        for (size_t k = 0; k < n; k++) {
            const double own = tribo_is_compliant(g, i) ? sticks * spring[i * n + k] : stiffness * shape[i * n + k];
            spring[i * n + k] = own;
        }
    }
    tribo_multiply_transposed_add(contacts, n, n, shape, spring, a);
    for (size_t k = 0; k < n; k++) {
        a[k * (n + 1)] += e->natural[k] * e->natural[k];
    }
    const int status = tribo_symmetric_eigen(a, n, value);
    memset(states, 0, n * all * sizeof *states);
    for (size_t k = 0; !status && k < n; k++) {
        tribo_multiply_transposed_add(n, n, 1, e->phi, a + k * n, states + k * all);
        for (size_t l = 0; l < e->springs; l++) {
            states[k * all + 2 * n + l] = -tribo_dot(spring + g->contact[l] * n, a + k * n, n);
        }
    }
    free(a);
    return status ? tribo_error(sys->message, status, "linear modes: %s", tribo_strerror(status)) : TRIBO_OK;
}
