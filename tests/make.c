/* SPDX-License-Identifier: BSD-3-Clause */
#include "make.h"

#include <stdio.h>

/* Makes the system, hands the message out, and destroys the model. */
static int finish(tribo_system **sys, tribo_model *model, int status, int reduces, size_t nmode, int statics, char *message,
                  size_t size)
{
    if (!status) {
        status = reduces ? tribo_system_reduce(sys, model, nmode, statics) : tribo_system_create(sys, model);
    }
    if (status && message && size) {
        snprintf(message, size, "%s", model ? tribo_model_message(model) : tribo_strerror(status));
    }
    tribo_model_destroy(model);
    return status;
}

int dense_system(tribo_system **sys, size_t ndof, size_t ncontact, const double *mass, const double *damping,
                 const double *stiffness, const double *direction, size_t nmode, char *message, size_t size)
{
    tribo_model *model = NULL;
    int status = tribo_model_create(&model, ndof, ncontact);
    status = status ? status : tribo_model_set_mass(model, mass);
    status = status || !damping ? status : tribo_model_set_damping(model, damping);
    status = status ? status : tribo_model_set_stiffness(model, stiffness);
    status = status ? status : tribo_model_set_direction(model, direction);
    return finish(sys, model, status, nmode > 0, nmode, TRIBO_STATICS_NONE, message, size);
}

static int make_of(tribo_system **sys, const gsl_spmatrix *mass, const gsl_spmatrix *damping, const gsl_spmatrix *stiffness,
                   const gsl_spmatrix *direction, int reduces, size_t nmode, int statics, char *message, size_t size)
{
    tribo_model *model = NULL;
    int status = tribo_model_create(&model, mass ? mass->size1 : 1, direction ? direction->size1 : 0);
    status = status ? status : tribo_gsl_model_set_mass(model, mass);
    status = status || !damping ? status : tribo_gsl_model_set_damping(model, damping);
    status = status ? status : tribo_gsl_model_set_stiffness(model, stiffness);
    status = status ? status : tribo_gsl_model_set_direction(model, direction);
    return finish(sys, model, status, reduces, nmode, statics, message, size);
}

int sparse_system(tribo_system **sys, const gsl_spmatrix *mass, const gsl_spmatrix *damping, const gsl_spmatrix *stiffness,
                  const gsl_spmatrix *direction, size_t nmode, char *message, size_t size)
{
    return make_of(sys, mass, damping, stiffness, direction, nmode > 0, nmode, TRIBO_STATICS_NONE, message, size);
}

int reduced_system(tribo_system **sys, const gsl_spmatrix *mass, const gsl_spmatrix *stiffness, const gsl_spmatrix *direction,
                   size_t nmode, int static_contacts, char *message, size_t size)
{
    return make_of(sys, mass, NULL, stiffness, direction, 1, nmode, static_contacts, message, size);
}
