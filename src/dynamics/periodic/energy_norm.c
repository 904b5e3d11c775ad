#include "energy_norm.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* k [n][n] = K, made symmetric. Returns 0 if out of memory. */
static int dense_stiffness(const tribo_system *sys, double *k)
{
    const size_t n = sys->ndof;
    const int scaled = !sys->k.rows && sys->mass.rows;
    double *entries = tribo_matrix_to_dense(sys->k.rows ? &sys->k : &sys->stiffness);
    for (size_t i = 0; entries && i < n; i++) {
        const double mass = scaled ? tribo_matrix_get(&sys->mass, i, i) : 1.0;
        for (size_t j = 0; j < n; j++) {
            entries[i * n + j] *= mass;
        }
    }
    for (size_t i = 0; entries && i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            k[i * n + j] = 0.5 * (entries[i * n + j] + entries[j * n + i]);
        }
    }
    free(entries);
    return entries != NULL;
}

/* Sets psi = phi'M. */
static void energy_norm_weigh(struct energy_norm *e, const tribo_system *sys)
{
    const size_t n = e->n;
    double *mode = e->omega; /* workspace here: not set yet */
    tribo_transpose(n, n, e->phi, e->psi);
    for (size_t k = 0; k < n; k++) {
        memcpy(mode, e->psi + k * n, n * sizeof *mode);
        memset(e->psi + k * n, 0, n * sizeof *mode);
        tribo_system_add_mass(sys, 1.0, mode, e->psi + k * n);
    }
}

/* Sets natural, phi and psi by the eigenvectors of S'KS, M^-1 = S S'. k [n][n]: workspace. Returns a status. */
static int find(struct energy_norm *e, const tribo_system *sys, double *k)
{
    const size_t n = e->n;
    if (!dense_stiffness(sys, k)) {
        return TRIBO_ERR_MEMORY;
    }
    tribo_half_solve(&sys->factor, k, n);
    tribo_transpose(n, n, k, e->psi);
    tribo_half_solve(&sys->factor, e->psi, n);
    if (!tribo_dense_finite(e->psi, n * n)) {
        return TRIBO_ERR_NOT_FINITE;
    }
    const int status = tribo_symmetric_eigen(e->psi, n, e->natural, e->phi);
    if (status) {
        return status;
    }
    tribo_half_solve_back(&sys->factor, e->phi, n);
    energy_norm_weigh(e, sys);
    for (size_t i = 0; i < n; i++) {
        e->natural[i] = sqrt(fabs(e->natural[i]));
    }
    return TRIBO_OK;
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
    return tribo_dense_finite(e->root, c * c) ? TRIBO_OK : TRIBO_ERR_NOT_FINITE;
}

int tribo_energy_norm_create(struct energy_norm *e, const tribo_system *sys)
{
    const size_t n = sys->ndof;
    *e = (struct energy_norm){.n = n, .springs = sys->compliance.count};
    e->phi = calloc(2 * n * n + 3 * n + e->springs * e->springs + 1, sizeof *e->phi);
    double *work = malloc((n * n + 1) * sizeof *work);
    int status = TRIBO_ERR_MEMORY;
    if (e->phi && work) {
        e->psi = e->phi + n * n;
        e->omega = e->psi + n * n;
        e->natural = e->omega + n;
        e->damping = e->natural + n;
        e->root = e->damping + n;
        status = find(e, sys, work);
        status = status ? status : find_root(e, sys);
    }
    free(work);
    return status ? tribo_system_fail(sys, status, "%s",
                                      status == TRIBO_ERR_MEMORY ? "out of memory for the modes of the free structure"
                                                                 : "stiffness over mass overflows")
                  : TRIBO_OK;
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

static void scale_rows(const struct energy_norm *e, size_t columns, int divide, double *rows)
{
    for (size_t k = 0; k < e->n; k++) {
        const double factor = divide ? 1.0 / e->omega[k] : e->omega[k];
        for (size_t j = 0; j < columns; j++) {
            rows[k * columns + j] *= factor;
        }
    }
}

void tribo_energy_norm_of(const struct energy_norm *e, size_t columns, const double *y, double *x)
{
    const size_t n = e->n, half = n * columns;
    memset(x, 0, 2 * half * sizeof *x);
    tribo_multiply_add(n, n, columns, 1.0, e->psi, y, x);
    tribo_multiply_add(n, n, columns, 1.0, e->psi, y + half, x + half);
    scale_rows(e, columns, 0, x);
    /* root' f */
    for (size_t i = 0; i < e->springs; i++) {
        memset(x + 2 * half + i * columns, 0, columns * sizeof *x);
        for (size_t k = i; k < e->springs; k++) {
            tribo_add(x + 2 * half + i * columns, e->root[k * e->springs + i], y + 2 * half + k * columns, columns);
        }
    }
}

void tribo_energy_norm_state(const struct energy_norm *e, size_t columns, const double *x, double *y)
{
    const size_t n = e->n, half = n * columns;
    memset(y, 0, 2 * half * sizeof *y);
    memcpy(y + half, x, half * sizeof *y);
    scale_rows(e, columns, 1, y + half);
    tribo_multiply_add(n, n, columns, 1.0, e->phi, y + half, y);
    memset(y + half, 0, half * sizeof *y);
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
