#include "point.h"

#include <math.h>

#include "tribo_petsc.h"

/* A matrix of PETSc's, which ends here, as one of GSL's. */
static PetscErrorCode Convert(Mat *from, gsl_spmatrix **to)
{
    PetscInt rows, columns;

    PetscFunctionBeginUser;
    PetscCall(MatGetSize(*from, &rows, &columns));
    *to = gsl_spmatrix_alloc((size_t)rows, (size_t)columns);
    PetscCheck(*to, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for a matrix");
    for (PetscInt i = 0; i < rows; i++) {
        PetscInt count;
        const PetscInt *column;
        const PetscScalar *value;
        PetscCall(MatGetRow(*from, i, &count, &column, &value));
        for (PetscInt k = 0; k < count; k++) {
            gsl_spmatrix_set(*to, (size_t)i, (size_t)column[k], PetscRealPart(value[k]));
        }
        PetscCall(MatRestoreRow(*from, i, &count, &column, &value));
    }
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
        PetscCallTribo(tribo_system_expand(s->sys, unit, full), tribo_message(tribo_system_context(s->sys)),
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
    gsl_spmatrix *mass, *stiffness, *direction;
    Vec limit;
    char message[256] = "";

    PetscFunctionBeginUser;
    PetscCall(ReadMatrix(PETSC_COMM_SELF, o->mass, 1, &matrix[0]));
    PetscCall(ReadMatrix(PETSC_COMM_SELF, o->stiffness, 1, &matrix[1]));
    PetscCall(ReadContacts(o->contacts, matrix[0], 1, &s->contacts));
    PetscCall(CreateDirection(&s->contacts, matrix[0], &matrix[2], &limit));
    PetscCall(VecDestroy(&limit));
    PetscCall(Convert(&matrix[0], &mass));
    PetscCall(Convert(&matrix[1], &stiffness));
    PetscCall(Convert(&matrix[2], &direction));
    s->rows = mass->size1;
    PetscCheck((size_t)o->load_row <= s->rows, PETSC_COMM_WORLD, PETSC_ERR_ARG_OUTOFRANGE, "-load_row %" PetscInt_FMT ", of %zu",
               o->load_row, s->rows);
    PetscCallTribo(tribo_system_linear_sparse(&s->sys, mass, NULL, stiffness, direction, modes, message, sizeof message), message,
                   "structure of %zu rows", s->rows);
    PetscCallTribo(tribo_system_set_damping_ratio(s->sys, o->damping), tribo_message(tribo_system_context(s->sys)),
                   "structure of %zu rows", s->rows);
    gsl_spmatrix_free(mass);
    gsl_spmatrix_free(stiffness);
    gsl_spmatrix_free(direction);
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
    PetscCallTribo(tribo_system_add_load(sys, omega, NULL, s->load), tribo_message(contacts), "structure of %zu rows", s->rows);
    PetscCallTribo(tribo_driver_create(&drv, sys, "exact"), tribo_message(contacts), "structure of %zu rows", s->rows);
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
