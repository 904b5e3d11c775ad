/* Functions for module tribo_dynamics beside those of tribo_dynamics.h: sizes by pure functions, and systems from the matrices of
 * Fortran's type tribo_sparse. */
#include <stdio.h>
#include <stdlib.h>

#include "dynamics.h"

static const char *plural(size_t n)
{
    return n == 1 ? "" : "s";
}

size_t tribo_fortran_ndof(const struct tribo_held *held)
{
    return held ? tribo_system_ndof(held->sys) : 0;
}

size_t tribo_fortran_dimension(const struct tribo_held *held)
{
    return held ? tribo_system_dimension(held->sys) : 0;
}

size_t tribo_fortran_ncontact(const struct tribo_held *held)
{
    return held ? tribo_system_ncontact(held->sys) : 0;
}

size_t tribo_fortran_given(const struct tribo_held *held)
{
    return held ? (size_t)held->given : 0;
}

typedef int csr_setter(tribo_model *model, const size_t *rowptr, const size_t *col, const double *val);

/* Hands the matrix, whose indices are of another type, to the model. */
static int set_rows(tribo_model *model, const struct tribo_rows *a, const char *name, size_t rows, csr_setter *set)
{
    char text[160];
    if (a->rows != rows || a->columns != tribo_model_ndof(model)) {
        snprintf(text, sizeof text, "%s is %zu x %zu, not %zu x %zu", name, a->rows, a->columns, rows, tribo_model_ndof(model));
        return tribo_model_refuse(model, TRIBO_ERR_SIZE, text);
    }
    const size_t entries = (size_t)a->first[a->rows];
    size_t *first = malloc((a->rows + 1 + entries) * sizeof *first), *col = first + a->rows + 1;
    if (!first) {
        return tribo_model_refuse(model, TRIBO_ERR_MEMORY, "out of memory for a matrix");
    }
    for (size_t i = 0; i <= a->rows; i++) {
        first[i] = (size_t)a->first[i];
    }
    for (size_t k = 0; k < entries; k++) {
        col[k] = (size_t)a->col[k];
    }
    const int status = set(model, first, col, a->val);
    free(first);
    return status;
}

/* A model; message: why there is none. */
static int begin_model(tribo_model **model, size_t ndof, size_t ncontact, char *message, size_t size)
{
    const int status = tribo_model_create(model, ndof, ncontact);
    if (status && size) {
        snprintf(message, size, "%zu degree%s of freedom and %zu contact%s: %s", ndof, plural(ndof), ncontact, plural(ncontact),
                 tribo_strerror(status));
    }
    return status;
}

/* Makes the system, hands the message out, and destroys the model. */
static int finish_system(tribo_system **sys, tribo_model *model, int status, int reduces, size_t nmode, int statics,
                         char *message, size_t size)
{
    if (!status) {
        status = reduces ? tribo_system_reduce(sys, model, nmode, statics) : tribo_system_create(sys, model);
    }
    if (status && size && model) {
        snprintf(message, size, "%s", tribo_model_message(model));
    }
    tribo_model_destroy(model);
    return status;
}

static int make_system(tribo_system **sys, const struct tribo_rows *mass, const struct tribo_rows *damping,
                       const struct tribo_rows *stiffness, const struct tribo_rows *direction, int reduces, size_t nmode,
                       int statics, char *message, size_t size)
{
    tribo_model *model = NULL;
    int status = begin_model(&model, mass->rows, direction->rows, message, size);
    status = status ? status : set_rows(model, mass, "mass", mass->rows, tribo_model_set_mass_csr);
    status = status || !damping ? status : set_rows(model, damping, "damping", mass->rows, tribo_model_set_damping_csr);
    status = status ? status : set_rows(model, stiffness, "stiffness", mass->rows, tribo_model_set_stiffness_csr);
    status = status ? status : set_rows(model, direction, "direction", direction->rows, tribo_model_set_direction_csr);
    return finish_system(sys, model, status, reduces, nmode, statics, message, size);
}

int tribo_fortran_dense(tribo_system **sys, size_t ndof, size_t ncontact, const double *mass, const double *damping,
                        const double *stiffness, const double *direction, size_t nmode, char *message, size_t size)
{
    tribo_model *model = NULL;
    int status = begin_model(&model, ndof, ncontact, message, size);
    status = status ? status : tribo_model_set_mass(model, mass);
    status = status || !damping ? status : tribo_model_set_damping(model, damping);
    status = status ? status : tribo_model_set_stiffness(model, stiffness);
    status = status ? status : tribo_model_set_direction(model, direction);
    return finish_system(sys, model, status, nmode > 0, nmode, TRIBO_STATICS_NONE, message, size);
}

int tribo_fortran_linear(tribo_system **sys, const struct tribo_rows *mass, const struct tribo_rows *damping,
                         const struct tribo_rows *stiffness, const struct tribo_rows *direction, size_t nmode, char *message,
                         size_t size)
{
    return make_system(sys, mass, damping, stiffness, direction, nmode > 0, nmode, TRIBO_STATICS_NONE, message, size);
}

int tribo_fortran_reduced(tribo_system **sys, const struct tribo_rows *mass, const struct tribo_rows *stiffness,
                          const struct tribo_rows *direction, size_t nmode, int static_contacts, char *message, size_t size)
{
    return make_system(sys, mass, NULL, stiffness, direction, 1, nmode, static_contacts, message, size);
}
