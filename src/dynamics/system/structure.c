/* SPDX-License-Identifier: BSD-3-Clause */
/* Builds systems from matrices. A diagonal mass matrix is inverted; else accelerations are solved for (M^-1 K, M^-1 C), up to
 * DENSE_MOST degrees of freedom. Larger systems keep their matrices (unsolved). */
#include <math.h>
#include <stdlib.h>

#include "delassus.h"
#include "model.h"

int tribo_model_no_memory(const tribo_model *m)
{
    return tribo_error(m->message, TRIBO_ERR_MEMORY, "out of memory for %zu degree%s of freedom and %zu contact%s", m->ndof,
                       plural(m->ndof), m->ncontact, plural(m->ncontact));
}

int tribo_model_too_large(const tribo_model *m)
{
    return tribo_error(m->message, TRIBO_ERR_UNSUPPORTED,
                       "%zu degree%s of freedom are more than the %d that dense matrices are for: build tribo with "
                       "TRIBO_SPARSE=ON, which needs CHOLMOD",
                       m->ndof, plural(m->ndof), DENSE_MOST);
}

int tribo_model_factorize(const tribo_model *m, struct cholesky *c)
{
    size_t where;
    double pivot;
    const int status = tribo_cholesky_create(c, &m->mass, NULL, &where, &pivot);
    return status == TRIBO_ERR_INDEFINITE
               ? tribo_error(m->message, status, "mass is not positive definite: pivot %g at degree of freedom %zu", pivot, where)
           : status == TRIBO_ERR_SIZE ? tribo_model_too_large(m)
                                      : status;
}

void tribo_model_free(tribo_model *m)
{
    tribo_matrix_free(&m->mass);
    tribo_matrix_free(&m->damping);
    tribo_matrix_free(&m->stiffness);
    tribo_matrix_free(&m->direction);
}

int tribo_model_check_symmetric(const tribo_model *m, const char *name, const struct matrix *a, const char *why)
{
    size_t i, j;
    double x, y;
    return a->rows && tribo_matrix_flaw(a, 1, &i, &j, &x, &y)
               ? tribo_error(m->message, TRIBO_ERR_NOT_SYMMETRIC, "%s[%zu][%zu] = %.17g, but %s[%zu][%zu] = %.17g%s", name, i, j,
                             x, name, j, i, y, why)
               : TRIBO_OK;
}

/* --------------------------------------------------------------------------------------------------------------- builders */

static int solve_masses(const void *mass, size_t count, double *x)
{
    return tribo_cholesky_solve(mass, count, x);
}

/* Sets R in the contacts: Z'Z, Z [ndof][ncontact], symmetric, and semidefinite up to rounding; z NULL: J M^-1 J' by the factor
 * of sys. Refuses an R that hides bodies, unless the degrees of freedom are modes. Returns a status. */
static int set_dense_operator(const tribo_model *m, tribo_system *sys, const struct matrix *j, const double *z)
{
    const size_t c = m->ncontact;
    struct hidden where;
    double *r = calloc(c * c + 1, sizeof *r), *own = malloc((j->first[c] + 1) * sizeof *own);
    int done = r && own;
    if (done && z) {
        tribo_multiply_transposed_add(m->ndof, c, c, z, z, r);
        for (size_t i = 0; i < c; i++) {
            for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
                own[k] = tribo_matrix_get(&sys->response, j->col[k], i);
            }
        }
    } else if (done) {
        done = tribo_delassus_by_columns(j, solve_masses, &sys->factor, r, own);
        tribo_even_out(c, r);
    }
    const int hidden = done && !m->nmode ? tribo_hidden(j, &sys->mass, own, r, &where) : 0;
    const int status = done && !hidden ? tribo_set_operator_dense(sys->contacts, r) : TRIBO_ERR_MEMORY;
    free(r);
    free(own);
    return hidden > 0
               ? tribo_error(m->message, TRIBO_ERR_UNSUPPORTED,
                             "mass: contact %zu touches bodies of which one is %g times as light; make the mass matrix diagonal",
                             where.contact, where.spread)
           : done && status ? tribo_error(m->message, status, "%s", tribo_message(sys->contacts))
                            : status;
}

/* Returns 1/M_dd [ndof] of a diagonal M, in memory of the caller's; NULL if M has a factor, or out of memory. */
static double *invert_masses(const tribo_system *sys)
{
    double *inverse = sys->factor.factor || sys->factor.sparse ? NULL : malloc(sys->ndof * sizeof *inverse);
    for (size_t d = 0; inverse && d < sys->ndof; d++) {
        inverse[d] = 1.0 / tribo_matrix_get(&sys->mass, d, d);
    }
    return inverse;
}

/* solved = M^-1 a; inverse: as invert_masses returns. Returns 0 if out of memory. */
static int solve_matrix(const tribo_system *sys, const double *inverse, const struct matrix *a, struct matrix *solved)
{
    if (inverse) {
        const int done = tribo_matrix_copy(solved, a);
        tribo_matrix_scale_rows(solved, inverse);
        return done;
    }
    double *x = sys->factor.factor || sys->factor.sparse ? tribo_matrix_to_dense(a) : NULL;
    if (x) {
        tribo_half_solve(&sys->factor, 0, x, a->cols);
        tribo_half_solve(&sys->factor, 1, x, a->cols);
    }
    const int done = x && tribo_matrix_from_dense(solved, a->rows, a->cols, x);
    free(x);
    return done;
}

/* Sets M^-1 K, M^-1 C and, in the place of J', M^-1 J' of sys; sets R. Returns a status. */
static int solve_by_masses(const tribo_model *m, tribo_system *sys, const struct matrix *j)
{
    struct matrix turned = sys->response;
    sys->response = (struct matrix){0};
    double *inverse = invert_masses(sys), *z = NULL;
    const int done = solve_matrix(sys, inverse, &turned, &sys->response) &&
                     solve_matrix(sys, inverse, &sys->k, &sys->stiffness) &&
                     (!sys->c.rows || solve_matrix(sys, inverse, &sys->c, &sys->damping));
    int status = TRIBO_ERR_MEMORY;
    if (done && inverse && !m->nmode) {
        status = tribo_set_operator_mass(sys->contacts, m->ndof, inverse, j->first, j->col, j->val);
        status = status ? tribo_error(m->message, status, "%s", tribo_message(sys->contacts)) : TRIBO_OK;
    } else if (done && (z = tribo_matrix_to_dense(&turned)) != NULL) {
        tribo_half_solve(&sys->factor, 0, z, m->ncontact);
        status = set_dense_operator(m, sys, j, z);
    }
    tribo_matrix_free(&turned);
    free(inverse);
    free(z);
    return status;
}

int tribo_model_build_massive(tribo_model *m, const double *soft, tribo_system **sys)
{
    const int diagonal = tribo_matrix_is_diagonal(&m->mass), unsolved = !diagonal && m->ndof > DENSE_MOST;
    int status = TRIBO_OK;
    if (unsolved && !tribo_cholmod) {
        return tribo_model_too_large(m);
    }
    if (unsolved) {
        static const char why[] =
            ": where accelerations are not solved for, with many degrees of freedom and a mass matrix that is "
            "not diagonal, it must be symmetric";
        status = tribo_model_check_symmetric(m, "damping", &m->damping, why);
        status = status ? status : tribo_model_check_symmetric(m, "stiffness", &m->stiffness, why);
    }
    status = status ? status : tribo_system_build(sys, m->ndof, m->ncontact);
    status = status ? status : tribo_create(&(*sys)->contacts, m->ncontact);
    status = status ? status : tribo_model_factorize(m, &(*sys)->factor);
    if (status) {
        return status;
    }
    tribo_system *s = *sys;
    s->unsolved = unsolved;
    s->mass = m->mass;
    s->k = m->stiffness;
    s->c = m->damping;
    s->direction = m->direction;
    m->mass = m->stiffness = m->damping = m->direction = (struct matrix){0};
    struct matrix rigid = {0}; /* J with empty rows of soft contacts */
    struct triplets rows = {0};
    for (size_t i = 0; i < m->ncontact; i++) {
        if (!(soft && soft[i] > 0.0)) {
            tribo_triplets_put_row(&rows, i, &s->direction, i);
        }
    }
    if (!tribo_triplets_finish(&rows, m->ncontact, m->ndof, &rigid) || !tribo_matrix_transpose(&s->response, &rigid)) {
        status = TRIBO_ERR_MEMORY;
    } else if (unsolved) {
        status = set_dense_operator(m, s, &rigid, NULL);
        tribo_cholesky_free(&s->factor);
    } else {
        status = solve_by_masses(m, s, &rigid);
    }
    tribo_matrix_free(&rigid);
    return status;
}

int tribo_model_build(tribo_model *m, tribo_system **sys)
{
    tribo_system *s = NULL;
    struct matrix mirror = {0}, odd = {0}, rates = {0};
    size_t i, j;
    double x, y;
    const int circulates = tribo_matrix_flaw(&m->stiffness, 1, &i, &j, &x, &y);
    int status = tribo_model_check_symmetric(m, "mass", &m->mass, "");
    if (!status && m->nmode) {
        status = tribo_model_check_symmetric(m, "stiffness", &m->stiffness,
                                             ": modes for a reduction are those of a symmetric stiffness");
    }
    if (!status) {
        status = m->nmode ? tribo_model_reduce(m, &s) : tribo_model_condense(m, &s);
        if (!status && circulates) { /* the row sum bounds the norm of M^-1 (K - K')/2, antisymmetric in the metric of M */
            double *inverse = invert_masses(s);
            const int done = tribo_matrix_transpose(&mirror, &s->k) && tribo_matrix_sum(&odd, 0.5, &s->k, -0.5, &mirror) &&
                             solve_matrix(s, inverse, &odd, &rates);
            free(inverse);
            s->circulation = tribo_matrix_row_sum(&rates);
            status = done ? TRIBO_OK : TRIBO_ERR_MEMORY;
        }
        status = status ? status : tribo_normals_create(s, m->normals, m->normal, m->message);
    }
    tribo_matrix_free(&mirror);
    tribo_matrix_free(&odd);
    tribo_matrix_free(&rates);
    tribo_model_free(m);
    if (status) {
        tribo_system_destroy(s);
        return status == TRIBO_ERR_MEMORY ? tribo_model_no_memory(m) : status;
    }
    *sys = s;
    return TRIBO_OK;
}
