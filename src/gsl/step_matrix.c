#include "step_matrix.h"

#include <stdlib.h>

#include <gsl/gsl_linalg.h>

int tribo_step_matrix_singular(const tribo_system *sys, double h, size_t where)
{
    return tribo_system_fail(sys, TRIBO_ERR_INDEFINITE, "the matrix of a step of length %g is singular at degree of freedom %zu",
                             h, where);
}

int tribo_step_matrix_no_memory(const tribo_system *sys)
{
    return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the matrix of a step");
}

void tribo_step_matrix_free(struct step_matrix *m)
{
    free(m->band);
    free(m->pivot);
    free(m->weight);
    tribo_cholesky_free(&m->sparse);
    *m = (struct step_matrix){0};
}

int tribo_step_matrix_is_diagonal(const struct step_matrix *m)
{
    return !m->below && !m->above && !m->sparse.n;
}

void tribo_step_matrix_solve(const struct step_matrix *m, size_t n, double *x)
{
    if (m->sparse.n) {
        for (size_t i = 0; m->weight && i < n; i++) {
            x[i] *= m->weight[i];
        }
        tribo_cholesky_solve(&m->sparse, 1, x);
        return;
    }
    gsl_matrix_view a = gsl_matrix_view_array(m->band, n, 2 * m->below + m->above + 1);
    gsl_vector_view b = gsl_vector_view_array(x, n);
    const gsl_vector_uint pivot = {n, 1, m->pivot, NULL, 0};
    gsl_linalg_LU_band_svx(m->below, m->above, &a.matrix, &pivot, &b.vector);
}

/* ------------------------------------------------------------------------------------------------------- sparse factors */

/* a = M A, of which the rows of an unsolved system are, and those of others are weighed with diagonal masses. */
static int sum_up(const tribo_system *sys, double h, struct matrix *a)
{
    struct matrix mass = {0}, viscous = {0};
    const int damped = sys->damping.rows > 0;
    int done = sys->unsolved || tribo_matrix_diagonal(&mass, sys->ndof, NULL);
    const struct matrix *first = sys->unsolved ? &sys->mass : &mass;
    done = done && (!damped || tribo_matrix_sum(&viscous, 1.0, first, 0.5 * h, &sys->damping)) &&
           tribo_matrix_sum(a, 1.0, damped ? &viscous : first, 0.25 * h * h, &sys->stiffness);
    tribo_matrix_free(&viscous);
    tribo_matrix_free(&mass);
    return done;
}

/* The sparse factor of M A. TRIBO_ERR_INDEFINITE, with the place, or TRIBO_ERR_NOT_SYMMETRIC if it has none. */
static int factorize_sparsely(struct step_matrix *m, const tribo_system *sys, double h, size_t *where)
{
    struct matrix a = {0};
    size_t i, j;
    double pivot, x, y;
    if (!sum_up(sys, h, &a)) {
        return TRIBO_ERR_MEMORY;
    }
    if (m->weight) {
        tribo_matrix_scale_rows(&a, m->weight);
    }
    const int lopsided = m->weight && tribo_matrix_flaw(&a, 1, &i, &j, &x, &y); /* an unsolved system's has been looked at */
    const int status = lopsided ? TRIBO_ERR_NOT_SYMMETRIC : tribo_cholesky_create(&m->sparse, &a, where, &pivot);
    tribo_matrix_free(&a);
    if (status) {
        tribo_cholesky_free(&m->sparse);
    }
    return status;
}

static int factorize_unsolved(struct step_matrix *m, const tribo_system *sys, double h)
{
    size_t where = 0;
    const int status = factorize_sparsely(m, sys, h, &where);
    return status == TRIBO_ERR_INDEFINITE
               ? tribo_system_fail(
                     sys, status, "the matrix of a step of length %g is not positive definite at degree of freedom %zu", h, where)
           : status ? tribo_step_matrix_no_memory(sys)
                    : TRIBO_OK;
}

/* A band that holds far more than there is gives way to a sparse factor, where masses are diagonal. */
static int suits_sparse(const struct step_matrix *m, const tribo_system *sys)
{
    const size_t n = sys->ndof, width = 2 * m->below + m->above + 1;
    return tribo_sparse_available() && sys->massless.count == 0 && sys->mass.rows && tribo_matrix_is_diagonal(&sys->mass) &&
           width > 16 * (sys->stiffness.first[n] / n + 1);
}

/* TRIBO_OK also if there is no such factor: then m->sparse.n is 0. */
static int try_sparse(struct step_matrix *m, const tribo_system *sys, double h)
{
    size_t where;
    m->weight = malloc(sys->ndof * sizeof *m->weight);
    if (!m->weight) {
        return tribo_step_matrix_no_memory(sys);
    }
    for (size_t i = 0; i < sys->ndof; i++) {
        m->weight[i] = tribo_matrix_get(&sys->mass, i, i);
    }
    return factorize_sparsely(m, sys, h, &where) == TRIBO_ERR_MEMORY ? tribo_step_matrix_no_memory(sys) : TRIBO_OK;
}

/* --------------------------------------------------------------------------------------------------------------- bands */

/* Adds factor a to the band, rows of what has mass or of what has none. */
static void add_band(struct step_matrix *m, const tribo_system *sys, const struct matrix *a, double factor, int with_mass)
{
    const size_t width = 2 * m->below + m->above + 1, middle = m->below + m->above;
    for (size_t i = 0; i < a->rows; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1] && tribo_has_mass(&sys->massless, i) == with_mass; k++) {
            m->band[a->col[k] * width + middle + i - a->col[k]] += factor * a->val[k];
        }
    }
}

static int factorize_band(struct step_matrix *m, const tribo_system *sys, double h)
{
    const size_t n = sys->ndof, width = 2 * m->below + m->above + 1, middle = m->below + m->above;
    m->band = calloc(n * width, sizeof *m->band);
    m->pivot = malloc(n * sizeof *m->pivot);
    if (!m->band || !m->pivot) {
        return tribo_step_matrix_no_memory(sys);
    }
    for (size_t i = 0; i < n; i++) {
        m->band[i * width + middle] = tribo_has_mass(&sys->massless, i) ? 1.0 : 0.0;
    }
    add_band(m, sys, &sys->stiffness, 0.25 * h * h, 1);
    add_band(m, sys, &sys->damping, 0.5 * h, 1);
    if (sys->massless.count) {
        add_band(m, sys, &sys->elastic, 1.0, 0);
    }
    gsl_matrix_view a = gsl_matrix_view_array(m->band, n, width);
    gsl_vector_uint pivot = {n, 1, m->pivot, NULL, 0};
    gsl_linalg_LU_band_decomp(n, m->below, m->above, &a.matrix, &pivot);
    for (size_t i = 0; i < n; i++) {
        if (m->band[i * width + middle] == 0.0) {
            return tribo_step_matrix_singular(sys, h, i);
        }
    }
    return TRIBO_OK;
}

int tribo_step_matrix_factorize(struct step_matrix *m, const tribo_system *sys, double h)
{
    tribo_step_matrix_free(m);
    if (sys->unsolved) {
        return factorize_unsolved(m, sys, h);
    }
    tribo_matrix_widen(&sys->stiffness, &m->below, &m->above);
    tribo_matrix_widen(&sys->damping, &m->below, &m->above);
    if (sys->massless.count) {
        tribo_matrix_widen(&sys->elastic, &m->below, &m->above);
    }
    const int status = suits_sparse(m, sys) ? try_sparse(m, sys, h) : TRIBO_OK;
    return status || m->sparse.n ? status : factorize_band(m, sys, h);
}
