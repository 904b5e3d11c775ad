/* SPDX-License-Identifier: BSD-3-Clause */
/* Matrices of a model from GSL's sparse ones. */
#include <stdio.h>
#include <stdlib.h>

#include "tribo/tribo_gsl.h"

typedef int csr_setter(tribo_model *model, const size_t *rowptr, const size_t *col, const double *val);

/* Compressed rows of a: rowptr [rows + 2] all 0, col and val [entries]. place [2][entries]: workspace. */
static void compress_rows(const gsl_spmatrix *a, size_t *place, size_t *rowptr, size_t *col, double *val)
{
    size_t *row = place, *column = place + a->nz;
    for (size_t k = 0, at = 0; k < a->nz; k++) {
        while (!GSL_SPMATRIX_ISCOO(a) && (size_t)a->p[at + 1] <= k) {
            at++;
        }
        const size_t inner = (size_t)a->i[k], outer = GSL_SPMATRIX_ISCOO(a) ? (size_t)a->p[k] : at;
        row[k] = GSL_SPMATRIX_ISCSR(a) ? outer : inner;
        column[k] = GSL_SPMATRIX_ISCSR(a) ? inner : outer;
        rowptr[row[k] + 2]++;
    }
    for (size_t i = 0; i < a->size1; i++) {
        rowptr[i + 2] += rowptr[i + 1];
    }
    for (size_t k = 0; k < a->nz; k++) { /* rowptr[i + 1] goes up to the end of row i */
        const size_t to = rowptr[row[k] + 1]++;
        col[to] = column[k];
        val[to] = a->data[k];
    }
}

static int set_spmatrix(tribo_model *model, const gsl_spmatrix *a, const char *name, size_t rows, csr_setter *set)
{
    const size_t cols = tribo_model_ndof(model);
    char text[160];
    if (!model) {
        return TRIBO_ERR_NULL;
    }
    if (!a) {
        snprintf(text, sizeof text, "%s is NULL", name);
        return tribo_model_refuse(model, TRIBO_ERR_NULL, text);
    }
    if (a->size1 != rows || a->size2 != cols) {
        snprintf(text, sizeof text, "%s is %zu x %zu, not %zu x %zu", name, a->size1, a->size2, rows, cols);
        return tribo_model_refuse(model, TRIBO_ERR_SIZE, text);
    }
    size_t *rowptr = calloc(rows + 2 + 3 * a->nz, sizeof *rowptr), *col = rowptr + rows + 2;
    double *val = malloc((a->nz + 1) * sizeof *val);
    int status = TRIBO_ERR_MEMORY;
    if (rowptr && val) {
        compress_rows(a, col + a->nz, rowptr, col, val);
        status = set(model, rowptr, col, val);
    } else {
        snprintf(text, sizeof text, "out of memory for %s", name);
        tribo_model_refuse(model, status, text);
    }
    free(rowptr);
    free(val);
    return status;
}

int tribo_gsl_model_set_mass(tribo_model *model, const gsl_spmatrix *m)
{
    return set_spmatrix(model, m, "mass", tribo_model_ndof(model), tribo_model_set_mass_csr);
}

int tribo_gsl_model_set_damping(tribo_model *model, const gsl_spmatrix *c)
{
    return set_spmatrix(model, c, "damping", tribo_model_ndof(model), tribo_model_set_damping_csr);
}

int tribo_gsl_model_set_stiffness(tribo_model *model, const gsl_spmatrix *k)
{
    return set_spmatrix(model, k, "stiffness", tribo_model_ndof(model), tribo_model_set_stiffness_csr);
}

int tribo_gsl_model_set_direction(tribo_model *model, const gsl_spmatrix *j)
{
    return set_spmatrix(model, j, "direction", tribo_model_ncontact(model), tribo_model_set_direction_csr);
}
