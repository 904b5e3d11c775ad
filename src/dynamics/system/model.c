/* SPDX-License-Identifier: BSD-3-Clause */
#include "delassus.h"
#include "model.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

int tribo_model_fail(const struct model *m, int status, const char *format, ...)
{
    if (m->message && m->size) {
        va_list args;
        va_start(args, format);
        vsnprintf(m->message, m->size, format, args);
        va_end(args);
    }
    return status;
}

int tribo_model_no_memory(const struct model *m)
{
    return tribo_model_fail(m, TRIBO_ERR_MEMORY, "out of memory for %zu degree%s of freedom and %zu contact%s", m->ndof,
                            plural(m->ndof), m->ncontact, plural(m->ncontact));
}

int tribo_model_too_large(const struct model *m)
{
    return tribo_model_fail(m, TRIBO_ERR_UNSUPPORTED,
                            "%zu degree%s of freedom are more than the %d that dense matrices are for: build tribo with "
                            "TRIBO_SPARSE=ON, which needs CHOLMOD",
                            m->ndof, plural(m->ndof), DENSE_MOST);
}

int tribo_model_factorize(const struct model *m, struct cholesky *c)
{
    size_t where;
    double pivot;
    switch (tribo_cholesky_create(c, &m->mass, &where, &pivot)) {
    case TRIBO_OK:
        return TRIBO_OK;
    case TRIBO_ERR_INDEFINITE:
        return tribo_model_fail(m, TRIBO_ERR_INDEFINITE, "mass is not positive definite: pivot %g at degree of freedom %zu",
                                pivot, where);
    case TRIBO_ERR_SIZE:
        return tribo_model_too_large(m);
    default:
        return tribo_model_no_memory(m);
    }
}

int tribo_model_give_operator(const struct model *m, tribo_system *sys, const double *r, const double *own)
{
    struct hidden where;
    const int hidden = own ? tribo_hidden(&sys->direction, &sys->mass, own, r, &where) : 0;
    if (hidden) {
        return hidden < 0 ? tribo_model_no_memory(m)
                          : tribo_model_fail(m, TRIBO_ERR_UNSUPPORTED,
                                             "mass: contact %zu touches bodies of which one is %g times as light; make the mass "
                                             "matrix diagonal",
                                             where.contact, where.spread);
    }
    const int status = tribo_set_operator_dense(sys->contacts, r);
    return status ? tribo_model_fail(m, status, "%s", tribo_message(sys->contacts)) : TRIBO_OK;
}

/* Returns own [entries of J], own[k] = B_di for entry k in row i, column d of J. NULL if out of memory. */
static double *own_responses(const tribo_system *sys)
{
    const struct matrix *j = &sys->direction;
    double *own = malloc((j->first[j->rows] + 1) * sizeof *own);
    for (size_t i = 0; own && i < j->rows; i++) {
        for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
            own[k] = tribo_matrix_get(&sys->response, j->col[k], i);
        }
    }
    return own;
}

int tribo_model_set_operator(const struct model *m, tribo_system *sys, const double *z, size_t n)
{
    const size_t c = m->ncontact;
    double *r = calloc(c * c + 1, sizeof *r), *own = m->nmode ? NULL : own_responses(sys);
    int status = r && (own || m->nmode) ? TRIBO_OK : tribo_model_no_memory(m);
    if (!status) {
        tribo_multiply_transposed_add(n, c, c, z, z, r);
    }
    status = status ? status : tribo_model_give_operator(m, sys, r, own);
    free(r);
    free(own);
    return status;
}
