/* SPDX-License-Identifier: BSD-3-Clause */
#include "step_matrix.h"

#include <stdlib.h>

#include "numerics/band.h"
#include "numerics/lapack.h"

int tribo_step_matrix_fail(const tribo_system *sys, int status, double h, size_t where)
{
    return status == TRIBO_ERR_INDEFINITE
               ? tribo_system_fail(
                     sys, status, "the matrix of a step of length %g is not positive definite at degree of freedom %zu", h, where)
           : status ? tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the matrix of a step")
                    : TRIBO_OK;
}

void tribo_step_matrix_free(struct step_matrix *m)
{
    free(m->band);
    free(m->pivot);
    tribo_cholesky_free(&m->sparse);
    tribo_matrix_free(&m->s);
    tribo_matrix_free(&m->own[0]);
    tribo_matrix_free(&m->own[1]);
    *m = (struct step_matrix){0};
}

/* ------------------------------------------------------------------------------------------------------------- the matrix */

int tribo_step_matrix_create(struct step_matrix *m, const tribo_system *sys, double h)
{
    tribo_step_matrix_free(m);
    m->n = sys->ndof;
    m->k = tribo_system_force_matrix(sys, &sys->k, &sys->stiffness, &m->own[0]);
    m->c = tribo_system_force_matrix(sys, &sys->c, &sys->damping, &m->own[1]);
    const struct matrix *const part[] = {m->k, m->c};
    const double factor[] = {0.25 * h * h, 0.5 * h};
    int done = m->k && m->c;
    done = done && (sys->mass.rows ? tribo_matrix_copy(&m->s, &sys->mass) : tribo_matrix_diagonal(&m->s, m->n, NULL));
    for (int p = 0; done && p < 2; p++) {
        struct matrix sum = m->s;
        if (part[p]->rows) {
            done = tribo_matrix_sum(&m->s, 1.0, &sum, factor[p], part[p]);
            tribo_matrix_free(&sum);
        }
    }
    tribo_matrix_widen(&m->s, &m->below, &m->above);
    return tribo_step_matrix_fail(sys, done ? TRIBO_OK : TRIBO_ERR_MEMORY, h, 0);
}

/* ------------------------------------------------------------------------------------------------------------ its factor */

/* Returns 1 if a sparse factor costs less than the band: the band has far more entries than S, or is almost the whole matrix. */
static int suits_sparse(const struct step_matrix *m)
{
    const size_t width = m->below > m->above ? m->below : m->above;
    return tribo_sparse_available() && m->n >= SPARSE_LEAST && (width > 5 * (m->s.first[m->n] / m->n + 1) || 2 * width > m->n);
}

/* Factorizes with exchanges of rows, by LAPACK: S must be regular, but need not be definite. Returns a status. */
static int factorize_lopsided(struct step_matrix *m, size_t *where)
{
    const struct matrix *s = &m->s;
    const size_t n = m->n, width = 2 * m->below + m->above + 1, middle = m->below + m->above;
    m->band = n < INT_MAX && width < INT_MAX ? calloc(n * width, sizeof *m->band) : NULL;
    m->pivot = malloc(n * sizeof *m->pivot);
    if (!m->band || !m->pivot) {
        return TRIBO_ERR_MEMORY;
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = s->first[i]; k < s->first[i + 1]; k++) {
            m->band[s->col[k] * width + middle + i - s->col[k]] = s->val[k];
        }
    }
    const int rows = (int)n, below = (int)m->below, above = (int)m->above, stride = (int)width;
    int info;
    dgbtrf_(&rows, &rows, &below, &above, m->band, &stride, m->pivot, &info);
    *where = info > 0 ? (size_t)info - 1 : n;
    return info > 0 ? TRIBO_ERR_INDEFINITE : TRIBO_OK;
}

int tribo_step_matrix_factorize(struct step_matrix *m, const tribo_system *sys, double h, int consumes)
{
    size_t where = 0, j;
    double x, y;
    int status;
    if (m->c->rows && tribo_matrix_flaw(&m->s, 1, &where, &j, &x, &y)) {
        status = factorize_lopsided(m, &where);
    } else if (suits_sparse(m)) {
        status = tribo_cholesky_create(&m->sparse, &m->s, consumes ? &m->s : NULL, &where, &x);
    } else {
        m->band = malloc(m->n * (m->below + 1) * sizeof *m->band);
        where = m->band ? tribo_band_factorize(&m->s, m->below, NULL, m->band) : 0;
        status = !m->band ? TRIBO_ERR_MEMORY : where < m->n ? TRIBO_ERR_INDEFINITE : TRIBO_OK;
    }
    return tribo_step_matrix_fail(sys, status, h, where);
}

/* ------------------------------------------------------------------------------------------------------------- solutions */

int tribo_step_matrix_solve(const void *matrix, size_t count, double *x)
{
    const struct step_matrix *m = matrix;
    if (m->sparse.n) {
        return tribo_cholesky_solve(&m->sparse, count, x);
    }
    if (m->pivot) {
        const int n = (int)m->n, below = (int)m->below, above = (int)m->above, all = (int)count, stride = 2 * below + above + 1;
        int info;
        dgbtrs_("N", &n, &below, &above, &all, m->band, &stride, m->pivot, x, &n, &info, 1);
        return 1;
    }
    for (size_t k = 0; k < count; k++) {
        tribo_band_solve(m->n, m->below, m->band, x + k * m->n);
    }
    return 1;
}
