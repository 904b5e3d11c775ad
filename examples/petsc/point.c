/* SPDX-License-Identifier: BSD-3-Clause */
#include "point.h"

#include <math.h>

#include "tribo_petsc.h"

/* A setter of tribo_model for compressed rows. */
typedef int SetRows(tribo_model *model, const size_t *rowptr, const size_t *col, const double *val);

/* Hands a matrix of PETSc's, which ends here, to the model. */
static PetscErrorCode Convert(Mat *from, tribo_model *model, SetRows *set)
{
    PetscInt rows, count;
    MatInfo info;
    size_t *rowptr, *col, entries = 0;
    double *val;

    PetscFunctionBeginUser;
    PetscCall(MatGetSize(*from, &rows, NULL));
    PetscCall(MatGetInfo(*from, MAT_LOCAL, &info));
    PetscCall(PetscMalloc3((size_t)rows + 1, &rowptr, (size_t)info.nz_used + 1, &col, (size_t)info.nz_used + 1, &val));
    rowptr[0] = 0;
    for (PetscInt i = 0; i < rows; i++) {
        const PetscInt *column;
        const PetscScalar *value;
        PetscCall(MatGetRow(*from, i, &count, &column, &value));
        for (PetscInt k = 0; k < count; k++) {
            if (value[k] != 0.0) {
                col[entries] = (size_t)column[k];
                val[entries++] = PetscRealPart(value[k]);
            }
        }
        PetscCall(MatRestoreRow(*from, i, &count, &column, &value));
        rowptr[i + 1] = entries;
    }
    PetscCallTribo(set(model, rowptr, col, val), tribo_model_message(model), "matrix of %zu rows", (size_t)rows);
    PetscCall(PetscFree3(rowptr, col, val));
    PetscCall(MatDestroy(from));
    PetscFunctionReturn(0);
}

static PetscErrorCode FindShape(Study *s, size_t row)
{
    const size_t modes = tribo_system_ndof(s->sys);
    double *unit, *full;

    PetscFunctionBeginUser;
    PetscCall(PetscMalloc2(modes, &unit, s->rows, &full));
    for (size_t k = 0; k < modes; k++) {
        for (size_t i = 0; i < modes; i++) {
            unit[i] = i == k ? 1.0 : 0.0;
        }
        PetscCallTribo(tribo_system_expand(s->sys, unit, full), tribo_system_message(s->sys),
                       "structure of %zu rows", s->rows);
        s->shape[k] = full[row];
    }
    PetscCall(PetscFree2(unit, full));
    PetscFunctionReturn(0);
}

PetscErrorCode CreateStudy(Study *s, const Options *o)
{
    const size_t modes = (size_t)o->modes;
    Mat matrix[3];
    tribo_model *model;
    PetscInt rows;
    Vec limit;

    PetscFunctionBeginUser;
    PetscCall(ReadMatrix(PETSC_COMM_SELF, o->mass, 1, &matrix[0]));
    PetscCall(ReadMatrix(PETSC_COMM_SELF, o->stiffness, 1, &matrix[1]));
    PetscCall(ReadContacts(o->contacts, matrix[0], 1, &s->contacts));
    PetscCall(CreateDirection(&s->contacts, matrix[0], &matrix[2], &limit));
    PetscCall(VecDestroy(&limit));
    PetscCall(MatGetSize(matrix[0], &rows, NULL));
    s->rows = (size_t)rows;
    PetscCheck((size_t)o->load_row <= s->rows, PETSC_COMM_WORLD, PETSC_ERR_ARG_OUTOFRANGE, "-load_row %" PetscInt_FMT ", of %zu",
               o->load_row, s->rows);
    PetscCallTribo(tribo_model_create(&model, s->rows, (size_t)s->contacts.count), "no model", "structure of %zu rows", s->rows);
    PetscCall(Convert(&matrix[0], model, tribo_model_set_mass_csr));
    PetscCall(Convert(&matrix[1], model, tribo_model_set_stiffness_csr));
    PetscCall(Convert(&matrix[2], model, tribo_model_set_direction_csr));
    PetscCallTribo(tribo_system_reduce(&s->sys, model, modes, TRIBO_STATICS_NONE), tribo_model_message(model),
                   "structure of %zu rows", s->rows);
    tribo_model_destroy(model);
    PetscCallTribo(tribo_system_set_damping_ratio(s->sys, o->damping), tribo_system_message(s->sys),
                   "structure of %zu rows", s->rows);
    PetscCall(PetscCalloc3(s->rows, &s->load, 2 * modes, &s->shape, s->contacts.count, &s->limit));
    s->load[o->load_row - 1] = o->load;
    PetscCall(FindShape(s, (size_t)o->load_row - 1));
    PetscFunctionReturn(0);
}

/* Amplitude of the loaded row, and what all contacts dissipate, in the motion that the driver has found. */
static PetscErrorCode Measure(const Study *s, tribo_driver *drv, double *amplitude, double *energy)
{
    double least, most, *each;

    PetscFunctionBeginUser;
    PetscCall(PetscMalloc1(s->contacts.count, &each));
    PetscCallTribo(tribo_driver_period_extremes(drv, s->shape, &least, &most, NULL, NULL), tribo_driver_message(drv),
                   "structure of %zu rows", s->rows);
    PetscCallTribo(tribo_driver_period_dissipation(drv, each), tribo_driver_message(drv), "structure of %zu rows", s->rows);
    *amplitude = 0.5 * (most - least);
    *energy = 0.0;
    for (PetscInt i = 0; i < s->contacts.count; i++) {
        *energy += each[i];
    }
    PetscCall(PetscFree(each));
    PetscFunctionReturn(0);
}

/* On a copy of the system, and from rest. */
PetscErrorCode ComputePoint(const Study *s, double omega, double scale, double *amplitude, double *energy, int *status)
{
    const double period = 2.0 * PETSC_PI / omega;
    double *y;
    tribo_system *sys;
    tribo_driver *drv;

    PetscFunctionBeginUser;
    PetscCheck(!tribo_system_clone(s->sys, &sys), PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for a copy of the structure");
    tribo_context *contacts = tribo_system_context(sys);
    for (PetscInt i = 0; i < s->contacts.count; i++) {
        s->limit[i] = scale * s->contacts.limit[i];
    }
    PetscCallTribo(tribo_set_limit(contacts, s->limit), tribo_message(contacts), "structure of %zu rows", s->rows);
    PetscCallTribo(tribo_system_add_load(sys, omega, NULL, s->load), tribo_system_message(sys), "structure of %zu rows", s->rows);
    PetscCallTribo(tribo_driver_create(&drv, sys, "exact"), tribo_system_message(sys), "structure of %zu rows", s->rows);
    PetscCall(PetscCalloc1(tribo_system_dimension(sys), &y));
    *amplitude = *energy = NAN;
    *status = tribo_driver_find_periodic(drv, 0.0, period, y);
    if (*status == TRIBO_OK) {
        PetscCall(Measure(s, drv, amplitude, energy));
    } else {
        PetscCheck(*status == TRIBO_ERR_NO_CONVERGENCE, PETSC_COMM_SELF, PETSC_ERR_LIB, "tribo, omega %g, scale %g: %s", omega,
                   scale, tribo_driver_message(drv));
    }
    PetscCall(PetscFree(y));
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    PetscFunctionReturn(0);
}

PetscErrorCode DestroyStudy(Study *s)
{
    PetscFunctionBeginUser;
    PetscCall(DestroyContacts(&s->contacts));
    PetscCall(PetscFree3(s->load, s->shape, s->limit));
    tribo_system_destroy(s->sys);
    PetscFunctionReturn(0);
}
