#include "step_matrix.h"

#include <stdlib.h>

#include "numerics/band.h"
#include "numerics/lapack.h"

int tribo_step_matrix_indefinite(const tribo_system *sys, double h, size_t where)
{
    return tribo_system_fail(sys, TRIBO_ERR_INDEFINITE,
                             "the matrix of a step of length %g is not positive definite at degree of freedom %zu", h, where);
}

int tribo_step_matrix_no_memory(const tribo_system *sys)
{
    return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the matrix of a step");
}

void tribo_step_matrix_free(struct step_matrix *m)
{
    free(m->band);
    free(m->pivot);
    tribo_cholesky_free(&m->sparse);
    *m = (struct step_matrix){0};
}

int tribo_step_matrix_is_diagonal(const struct step_matrix *m)
{
    return !m->below && !m->above && !m->sparse.n;
}

/* ------------------------------------------------------------------------------------------------------------- the matrix */

struct step_part tribo_step_stiffness(const tribo_system *sys)
{
    return sys->k.rows ? (struct step_part){&sys->k, 0} : (struct step_part){&sys->stiffness, !sys->unsolved};
}

struct step_part tribo_step_damping(const tribo_system *sys)
{
    return sys->c.rows ? (struct step_part){&sys->c, 0} : (struct step_part){&sys->damping, !sys->unsolved};
}

/* a += factor b. Returns 0 if out of memory. */
static int add(struct matrix *a, double factor, const struct matrix *b)
{
    struct matrix sum;
    if (b->rows == 0) {
        return 1;
    }
    const int done = tribo_matrix_sum(&sum, 1.0, a, factor, b);
    tribo_matrix_free(a);
    *a = sum;
    return done;
}

/* a = M a for diagonal M. Returns 0 if out of memory. */
static int step_matrix_weigh(struct matrix *a, const struct matrix *mass)
{
    double *factor = malloc((a->rows + 1) * sizeof *factor);
    for (size_t i = 0; factor && i < a->rows; i++) {
        factor[i] = tribo_matrix_get(mass, i, i);
    }
    if (factor) {
        tribo_matrix_scale_rows(a, factor);
    }
    free(factor);
    return factor != NULL;
}

/* a = S. Adds weighed parts to the identity, multiplies by M, then adds the other parts. Returns 0 if out of memory; then a is
 * zeroed. */
static int step_matrix_sum_up(const tribo_system *sys, double h, struct matrix *a)
{
    const struct step_part k = tribo_step_stiffness(sys), c = tribo_step_damping(sys);
    const double of_k = 0.25 * h * h, of_c = 0.5 * h;
    const int weighed = !sys->mass.rows || (k.weighed && k.of->rows) || (c.weighed && c.of->rows);
    int done = weighed ? tribo_matrix_diagonal(a, sys->ndof, NULL) : tribo_matrix_copy(a, &sys->mass);
    done = done && (!k.weighed || add(a, of_k, k.of)) && (!c.weighed || add(a, of_c, c.of));
    done = done && (!weighed || !sys->mass.rows || step_matrix_weigh(a, &sys->mass));
    done = done && (k.weighed || add(a, of_k, k.of)) && (c.weighed || add(a, of_c, c.of));
    if (!done) {
        tribo_matrix_free(a);
    }
    return done;
}

/* ------------------------------------------------------------------------------------------------------------ its factor */

/* Returns 1 if a sparse factor costs less than the band: the band has far more entries than a, or is almost the whole matrix. */
static int suits_sparse(const struct step_matrix *m, const struct matrix *a)
{
    const size_t width = m->below > m->above ? m->below : m->above;
    return tribo_sparse_available() && m->n >= SPARSE_LEAST && (width > 5 * (a->first[m->n] / m->n + 1) || 2 * width > m->n);
}

static int factorize_band(struct step_matrix *m, const struct matrix *a, size_t *where)
{
    const size_t n = m->n, width = m->below;
    double *band = calloc(n * (width + 1), sizeof *band);
    m->band = malloc(n * (width + 1) * sizeof *m->band);
    int status = band && m->band ? TRIBO_OK : TRIBO_ERR_MEMORY;
    if (!status) {
        tribo_band_add(band, width, a, 1.0, NULL);
        *where = tribo_band_factorize(n, width, band, NULL, m->band);
        status = *where < n ? TRIBO_ERR_INDEFINITE : TRIBO_OK;
    }
    free(band);
    return status;
}

/* Factorizes with exchanges of rows, by LAPACK: a must be regular, but need not be definite. Returns a status. */
static int factorize_lopsided(struct step_matrix *m, const struct matrix *a, size_t *where)
{
    const size_t n = m->n, width = 2 * m->below + m->above + 1, middle = m->below + m->above;
    m->band = n < INT_MAX && width < INT_MAX ? calloc(n * width, sizeof *m->band) : NULL;
    m->pivot = malloc(n * sizeof *m->pivot);
    if (!m->band || !m->pivot) {
        return TRIBO_ERR_MEMORY;
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = a->first[i]; k < a->first[i + 1]; k++) {
            m->band[a->col[k] * width + middle + i - a->col[k]] = a->val[k];
        }
    }
    const int rows = (int)n, below = (int)m->below, above = (int)m->above, stride = (int)width;
    int info;
    dgbtrf_(&rows, &rows, &below, &above, m->band, &stride, m->pivot, &info);
    *where = info > 0 ? (size_t)info - 1 : n;
    return info > 0 ? TRIBO_ERR_INDEFINITE : TRIBO_OK;
}

int tribo_step_matrix_factorize(struct step_matrix *m, const tribo_system *sys, double h)
{
    struct matrix a;
    size_t where = 0, j;
    double x, y;
    tribo_step_matrix_free(m);
    if (!step_matrix_sum_up(sys, h, &a)) {
        return tribo_step_matrix_no_memory(sys);
    }
    m->n = sys->ndof;
    tribo_matrix_widen(&a, &m->below, &m->above);
    const int lopsided = tribo_step_damping(sys).of->rows && tribo_matrix_flaw(&a, 1, &where, &j, &x, &y);
    const int status = lopsided              ? factorize_lopsided(m, &a, &where)
                       : suits_sparse(m, &a) ? tribo_cholesky_consume(&m->sparse, &a, &where, &x)
                                             : factorize_band(m, &a, &where);
    tribo_matrix_free(&a);
    return status == TRIBO_ERR_INDEFINITE ? tribo_step_matrix_indefinite(sys, h, where)
           : status                       ? tribo_step_matrix_no_memory(sys)
                                          : TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------- solutions */

int tribo_step_matrix_solve(const struct step_matrix *m, size_t count, double *x)
{
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

int tribo_step_matrix_has_halves(const struct step_matrix *m)
{
    return !m->pivot;
}

void tribo_step_matrix_half_solve(const struct step_matrix *m, double *x)
{
    if (m->sparse.n) {
        tribo_half_solve(&m->sparse, x, 1);
    } else {
        tribo_band_half_solve(m->n, m->below, m->band, x);
    }
}

void tribo_step_matrix_half_solve_back(const struct step_matrix *m, double *x)
{
    if (m->sparse.n) {
        tribo_half_solve_back(&m->sparse, x, 1);
    } else {
        tribo_band_half_solve_back(m->n, m->below, m->band, x);
    }
}
