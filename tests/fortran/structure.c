/* SPDX-License-Identifier: BSD-3-Clause */
#include "structure.h"

#define MOST_ROWS 16
#define MOST_ENTRIES 64

typedef int set_full(tribo_model *model, const double *a);
typedef int set_rows(tribo_model *model, const size_t *rowptr, const size_t *col, const double *val);

static int set_matrix(tribo_model *model, const struct structure *s, size_t rows, const double *a, set_full *full,
                      set_rows *sparse)
{
    if (!s->sparse) {
        return full(model, a);
    }
    size_t rowptr[MOST_ROWS + 1] = {0}, col[MOST_ENTRIES], entries = 0;
    double val[MOST_ENTRIES];
    for (size_t i = 0; i < rows; i++) {
        for (size_t j = 0; j < s->ndof; j++) {
            if (a[i * s->ndof + j] != 0.0) {
                col[entries] = j;
                val[entries++] = a[i * s->ndof + j];
            }
        }
        rowptr[i + 1] = entries;
    }
    return sparse(model, rowptr, col, val);
}

int structure_system(tribo_system **sys, const struct structure *s, size_t nmode, int statics)
{
    tribo_model *m = NULL;
    int status = tribo_model_create(&m, s->ndof, s->ncontact);
    status = status ? status : set_matrix(m, s, s->ndof, s->mass, tribo_model_set_mass, tribo_model_set_mass_csr);
    if (!status && s->damping) {
        status = set_matrix(m, s, s->ndof, s->damping, tribo_model_set_damping, tribo_model_set_damping_csr);
    }
    status = status ? status : set_matrix(m, s, s->ndof, s->stiffness, tribo_model_set_stiffness, tribo_model_set_stiffness_csr);
    status =
        status ? status : set_matrix(m, s, s->ncontact, s->direction, tribo_model_set_direction, tribo_model_set_direction_csr);
    if (!status) {
        status = nmode ? tribo_system_reduce(sys, m, nmode, statics) : tribo_system_create(sys, m);
    }
    tribo_model_destroy(m);
    return status;
}
