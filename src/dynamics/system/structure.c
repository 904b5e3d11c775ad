/* SPDX-License-Identifier: BSD-3-Clause */
/* Builds systems from matrices. A diagonal mass matrix is inverted; else accelerations are solved for (M^-1 K, M^-1 C), up to
 * DENSE_MOST degrees of freedom. Larger systems keep their matrices (unsolved). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "delassus.h"
#include "model.h"

static int structure_check(const struct model *m)
{
    const struct {
        const char *name;
        const struct matrix *matrix;
        int symmetric;
    } all[] = {
        {"mass", &m->mass, 1}, {"damping", &m->damping, 0}, {"stiffness", &m->stiffness, 1}, {"direction", &m->direction, 0}};
    for (size_t k = 0; k < 4; k++) {
        size_t i, j;
        double x, y;
        if (!tribo_matrix_flaw(all[k].matrix, all[k].symmetric, &i, &j, &x, &y)) {
            continue;
        }
        if (!isfinite(x)) {
            return tribo_model_fail(m, TRIBO_ERR_NOT_FINITE, "%s[%zu][%zu] = %g is not finite", all[k].name, i, j, x);
        }
        return tribo_model_fail(m, TRIBO_ERR_NOT_SYMMETRIC, "%s[%zu][%zu] = %.17g, but %s[%zu][%zu] = %.17g", all[k].name, i, j,
                                x, all[k].name, j, i, y);
    }
    return TRIBO_OK;
}

/* --------------------------------------------------------------------------------------------------------------- builders */

/* Moves the mass matrix and its factor to the system. */
static void give_mass(struct model *m, tribo_system *sys, struct cholesky *c)
{
    sys->mass = m->mass;
    sys->factor = *c;
    m->mass = (struct matrix){0};
    *c = (struct cholesky){0};
}

static int build_diagonal(struct model *m, tribo_system **sys)
{
    const size_t n = m->ndof;
    struct cholesky c;
    int status = tribo_model_factorize(m, &c);
    if (status) {
        return status;
    }
    double *inverse = malloc(n * sizeof *inverse);
    struct matrix b = {0};
    status = inverse && tribo_matrix_transpose(&b, &m->direction) ? TRIBO_OK : tribo_model_no_memory(m);
    if (!status) {
        for (size_t i = 0; i < n; i++) {
            inverse[i] = 1.0 / tribo_matrix_get(&m->mass, i, i);
        }
        tribo_matrix_scale_rows(&b, inverse);
        tribo_matrix_scale_rows(&m->stiffness, inverse);
        tribo_matrix_scale_rows(&m->damping, inverse);
        status = tribo_system_build(sys, n, m->ncontact, &m->stiffness, &m->damping, &m->direction, &b);
        m->stiffness = m->damping = m->direction = (struct matrix){0};
        status = status ? tribo_model_no_memory(m) : TRIBO_OK;
    }
    if (!status) {
        const struct matrix *j = &(*sys)->direction;
        give_mass(m, *sys, &c);
        status = tribo_set_operator_mass((*sys)->contacts, n, inverse, j->first, j->col, j->val);
        status = status ? tribo_model_fail(m, status, "%s", tribo_message((*sys)->contacts)) : TRIBO_OK;
    }
    free(inverse);
    tribo_cholesky_free(&c);
    return status;
}

/* solved = M^-1 a. Returns 0 if out of memory. */
static int solve_matrix(const struct cholesky *c, const struct matrix *a, struct matrix *solved)
{
    double *x = tribo_matrix_to_dense(a);
    if (x) {
        tribo_half_solve(c, x, a->cols);
        tribo_half_solve_back(c, x, a->cols);
    }
    const int done = x && tribo_matrix_from_dense(solved, a->rows, a->cols, x);
    free(x);
    return done;
}

static int build_solved(struct model *m, tribo_system **sys)
{
    struct cholesky c;
    int status = tribo_model_factorize(m, &c);
    if (status) {
        return status;
    }
    double *z = tribo_matrix_transpose_to_dense(&m->direction), *x = tribo_matrix_transpose_to_dense(&m->direction);
    struct matrix b = {0}, ak = {0}, ac = {0};
    int done = z && x && solve_matrix(&c, &m->stiffness, &ak) && (!m->damping.rows || solve_matrix(&c, &m->damping, &ac));
    if (done && m->ncontact) {
        tribo_half_solve(&c, z, m->ncontact);
        memcpy(x, z, m->ndof * m->ncontact * sizeof *x);
        tribo_half_solve_back(&c, x, m->ncontact);
    }
    done = done && tribo_matrix_from_dense(&b, m->ndof, m->ncontact, x);
    free(x);
    if (!done) {
        free(z);
        tribo_matrix_free(&ak);
        tribo_matrix_free(&ac);
        tribo_cholesky_free(&c);
        return tribo_model_no_memory(m);
    }
    status = tribo_system_build(sys, m->ndof, m->ncontact, &ak, &ac, &m->direction, &b);
    m->direction = (struct matrix){0};
    if (status) {
        free(z);
        tribo_cholesky_free(&c);
        return tribo_model_no_memory(m);
    }
    give_mass(m, *sys, &c);
    (*sys)->k = m->stiffness;
    (*sys)->c = m->damping;
    m->stiffness = m->damping = (struct matrix){0};
    status = tribo_model_set_operator(m, *sys, z, m->ndof);
    free(z);
    return status;
}

static int solve_masses(const void *mass, size_t count, double *x)
{
    return tribo_cholesky_solve(mass, count, x);
}

static int check_unsolved(const struct model *m)
{
    size_t i, j;
    double x, y;
    if (!tribo_sparse_available()) {
        return tribo_model_too_large(m);
    }
    if (m->damping.rows && tribo_matrix_flaw(&m->damping, 1, &i, &j, &x, &y)) {
        return tribo_model_fail(
            m, TRIBO_ERR_NOT_SYMMETRIC,
            "damping[%zu][%zu] = %.17g, but damping[%zu][%zu] = %.17g: with more than %d degrees of freedom and a "
            "mass matrix that is not diagonal it must be symmetric",
            i, j, x, j, i, y, DENSE_MOST);
    }
    return TRIBO_OK;
}

/* Keeps the matrices; the factor of the mass matrix exists only while R is computed. Returns a status. */
static int build_unsolved(struct model *m, tribo_system **sys)
{
    struct cholesky c = {0};
    struct matrix b = {0};
    const size_t n = m->ndof, contacts = m->ncontact;
    int status = check_unsolved(m);
    status = status ? status : tribo_model_factorize(m, &c);
    if (status) {
        return status;
    }
    double *r = calloc(contacts * contacts + 1, sizeof *r), *own = malloc((m->direction.first[contacts] + 1) * sizeof *own);
    int done = r && own && tribo_delassus_by_columns(&m->direction, solve_masses, &c, NULL, r, own) &&
               tribo_matrix_transpose(&b, &m->direction);
    if (done) {
        tribo_even_out(contacts, r);
        done = tribo_system_build(sys, n, contacts, &m->stiffness, &m->damping, &m->direction, &b) == TRIBO_OK;
        m->stiffness = m->damping = m->direction = (struct matrix){0};
    }
    tribo_cholesky_free(&c);
    status = done ? TRIBO_OK : tribo_model_no_memory(m);
    if (!status) {
        (*sys)->unsolved = 1;
        give_mass(m, *sys, &c);
        status = tribo_model_give_operator(m, *sys, r, own);
    }
    free(r);
    free(own);
    return status;
}

void tribo_model_free(struct model *m)
{
    tribo_matrix_free(&m->mass);
    tribo_matrix_free(&m->damping);
    tribo_matrix_free(&m->stiffness);
    tribo_matrix_free(&m->direction);
}

int tribo_model_build_massive(struct model *m, tribo_system **sys)
{
    return tribo_matrix_is_diagonal(&m->mass) ? build_diagonal(m, sys)
           : m->ndof <= DENSE_MOST            ? build_solved(m, sys)
                                              : build_unsolved(m, sys);
}

int tribo_model_build(struct model *m, tribo_system **sys)
{
    tribo_system *s = NULL;
    int status = structure_check(m);
    if (!status) {
        status = m->nmode ? tribo_model_reduce(m, &s) : tribo_model_condense(m, &s);
    }
    tribo_model_free(m);
    if (status) {
        tribo_system_destroy(s);
        return status;
    }
    *sys = s;
    return TRIBO_OK;
}
