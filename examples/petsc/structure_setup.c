/* SPDX-License-Identifier: BSD-3-Clause */
/* What is done once: matrices, the solver of a step, and the contacts' condensed operator. */
#include "structure.h"
#include "tribo_petsc.h"

/* Copy k has its load a k-th of a period later: a wave that runs around them. */
static PetscErrorCode CreateLoad(Structure *s, const Options *o)
{
    PetscInt rows, here, most;

    PetscFunctionBeginUser;
    PetscCall(MatGetSize(s->mass, &rows, NULL));
    PetscCheck(o->load_row <= rows / o->copies, PETSC_COMM_WORLD, PETSC_ERR_ARG_OUTOFRANGE,
               "-load_row %" PetscInt_FMT ", of %" PetscInt_FMT, o->load_row, rows / o->copies);
    PetscCall(MatGetOwnershipRange(s->mass, &here, &most));
    for (PetscInt k = 0; k < o->copies; k++) {
        const PetscInt row = k * (rows / o->copies) + o->load_row - 1;
        const PetscReal phase = -2.0 * PETSC_PI * (PetscReal)k / (PetscReal)o->copies;
        if (row >= here && row < most) {
            PetscCall(VecSetValue(s->load[0], row, o->load * PetscCosReal(phase), INSERT_VALUES));
            PetscCall(VecSetValue(s->load[1], row, o->load * PetscSinReal(phase), INSERT_VALUES));
            PetscCall(VecSetValue(s->shape, row, k == 0 ? 1.0 : 0.0, INSERT_VALUES));
        }
    }
    const Vec all[3] = {s->load[0], s->load[1], s->shape};
    for (int i = 0; i < 3; i++) {
        PetscCall(VecAssemblyBegin(all[i]));
        PetscCall(VecAssemblyEnd(all[i]));
    }
    PetscFunctionReturn(0);
}

static PetscErrorCode CreateSolver(Structure *s, const Options *o)
{
    MatNullSpace rigid;
    Mat a;
    PC pc;

    PetscFunctionBeginUser;
    PetscCall(MatDuplicate(s->mass, MAT_COPY_VALUES, &a));
    PetscCall(MatAXPY(a, 0.25 * s->h * s->h + 0.5 * s->h * o->damping, s->stiffness, UNKNOWN_NONZERO_PATTERN));
    PetscCall(MatSetOption(a, MAT_SPD, PETSC_TRUE));
    if (s->place) { /* what a multigrid method must know of an elastic body */
        PetscCall(MatNullSpaceCreateRigidBody(s->place, &rigid));
        PetscCall(MatSetNearNullSpace(a, rigid));
        PetscCall(MatNullSpaceDestroy(&rigid));
    }
    PetscCall(KSPCreate(PETSC_COMM_WORLD, &s->solver));
    PetscCall(KSPSetOperators(s->solver, a, a));
    PetscCall(KSPSetType(s->solver, KSPPREONLY));
    PetscCall(KSPGetPC(s->solver, &pc));
    PetscCall(PCSetType(pc, PCCHOLESKY));
    PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
    PetscCall(KSPSetTolerances(s->solver, 1e-12, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
    PetscCall(KSPSetErrorIfNotConverged(s->solver, PETSC_TRUE));
    PetscCall(KSPSetFromOptions(s->solver));
    PetscCall(MatDestroy(&a));
    PetscFunctionReturn(0);
}

/* The condensed operator, by one solve a contact, and the contacts of this rank with their limits. */
static PetscErrorCode CondenseContacts(Structure *s, Vec limit)
{
    const PetscScalar *own;
    Mat transpose, forces, operator;

    PetscFunctionBeginUser;
    PetscCall(MatTranspose(s->direction, MAT_INITIAL_MATRIX, &transpose));
    PetscCall(MatConvert(transpose, MATDENSE, MAT_INITIAL_MATRIX, &forces));
    PetscCall(MatDuplicate(forces, MAT_DO_NOT_COPY_VALUES, &s->response));
    PetscCall(KSPMatSolve(s->solver, forces, s->response));
    PetscCall(MatMatMult(s->direction, s->response, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &operator));
    PetscCall(CreateShare(operator, limit, &s->share));
    PetscCall(VecScatterBegin(s->share.gather, limit, s->share.end, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecScatterEnd(s->share.gather, limit, s->share.end, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecGetArrayRead(s->share.end, &own));
    PetscCallTribo(tribo_set_limit(s->share.contacts, own), tribo_message(s->share.contacts), "contacts:%s", s->share.where);
    PetscCall(VecRestoreArrayRead(s->share.end, &own));
    PetscCall(MatDestroy(&transpose));
    PetscCall(MatDestroy(&forces));
    PetscCall(MatDestroy(&operator));
    PetscFunctionReturn(0);
}

PetscErrorCode CreateStructure(Structure *s, const Options *o)
{
    Vec limit;

    PetscFunctionBeginUser;
    PetscCall(ReadMatrix(PETSC_COMM_WORLD, o->mass, o->copies, &s->mass));
    PetscCall(ReadMatrix(PETSC_COMM_WORLD, o->stiffness, o->copies, &s->stiffness));
    PetscCall(ReadContacts(o->contacts, s->mass, o->copies, &s->contacts));
    PetscCall(CreateDirection(&s->contacts, s->mass, &s->direction, &limit));
    if (o->places[0]) {
        PetscCall(ReadPlaces(o->places, s->mass, o->copies, o->distance, &s->place));
    }
    Vec *const structure[] = {&s->q, &s->u, &s->load[0], &s->load[1], &s->shape, &s->force, &s->change};
    Vec *const contact[] = {&s->v, &s->end, &s->f};
    for (int i = 0; i < 7; i++) {
        PetscCall(MatCreateVecs(s->mass, structure[i], NULL));
    }
    for (int i = 0; i < 3; i++) {
        PetscCall(VecDuplicate(limit, contact[i]));
    }
    PetscCall(PetscLogStageRegister("friction", &s->friction));
    PetscCall(CreateLoad(s, o));
    PetscCall(CreateSolver(s, o));
    PetscCall(CondenseContacts(s, limit));
    PetscCall(VecDestroy(&limit));
    PetscFunctionReturn(0);
}

PetscErrorCode DestroyStructure(Structure *s)
{
    Vec *const vector[] = {&s->q,     &s->u,      &s->load[0], &s->load[1], &s->shape, &s->place,
                           &s->force, &s->change, &s->v,       &s->end,     &s->f};
    Mat *const matrix[] = {&s->mass, &s->stiffness, &s->direction, &s->response};

    PetscFunctionBeginUser;
    for (int i = 0; i < 11; i++) {
        PetscCall(VecDestroy(vector[i]));
    }
    for (int i = 0; i < 4; i++) {
        PetscCall(MatDestroy(matrix[i]));
    }
    PetscCall(KSPDestroy(&s->solver));
    PetscCall(DestroyShare(&s->share));
    PetscCall(DestroyContacts(&s->contacts));
    PetscFunctionReturn(0);
}
