/* SPDX-License-Identifier: BSD-3-Clause */
#include "islands.h"

#include "tribo_petsc.h"

/* Entries of the operator are known to this, relative to the diagonal: contacts that share no more do not feel each other. */
static const PetscReal NOTHING = 1e-14;

/* Numbers the islands, in the order of their first contacts, by following who feels whom. r [n][n], island [n] out. */
static PetscErrorCode FindIslands(PetscInt n, const PetscScalar *r, PetscInt *island, PetscInt *islands)
{
    PetscInt *stack, top = 0;

    PetscFunctionBeginUser;
    PetscCall(PetscMalloc1(n, &stack));
    *islands = 0;
    for (PetscInt i = 0; i < n; i++) {
        island[i] = -1;
    }
    for (PetscInt i = 0; i < n; i++) {
        if (island[i] >= 0) {
            continue;
        }
        island[i] = (*islands)++;
        for (stack[top++] = i; top > 0;) {
            const PetscInt k = stack[--top];
            for (PetscInt j = 0; j < n; j++) {
                if (island[j] < 0 &&
                    PetscAbsScalar(r[k * n + j]) > NOTHING * PetscSqrtReal(PetscAbsScalar(r[k * n + k] * r[j * n + j]))) {
                    island[j] = island[i];
                    stack[top++] = j;
                }
            }
        }
    }
    PetscCall(PetscFree(stack));
    PetscFunctionReturn(0);
}

/* The rank of each island: all ranks find the same. owner [islands] out. */
static PetscErrorCode DealIslands(PetscInt n, const PetscInt *island, PetscInt islands, PetscInt *owner)
{
    PetscMPIInt size;
    PetscInt *members, *load;

    PetscFunctionBeginUser;
    PetscCallMPI(MPI_Comm_size(PETSC_COMM_WORLD, &size));
    PetscCall(PetscCalloc2(islands, &members, size, &load));
    for (PetscInt i = 0; i < n; i++) {
        members[island[i]]++;
    }
    for (PetscInt k = 0; k < islands; k++) {
        owner[k] = 0;
        for (PetscInt rank = 1; rank < size; rank++) {
            owner[k] = load[rank] < load[owner[k]] ? rank : owner[k];
        }
        load[owner[k]] += members[k];
    }
    PetscCall(PetscFree2(members, load));
    PetscFunctionReturn(0);
}

/* Which contacts are here, for messages: as many of them as there is room for. */
static PetscErrorCode NameContacts(Share *s)
{
    size_t used;

    PetscFunctionBeginUser;
    PetscCall(PetscStrcpy(s->where, ""));
    for (PetscInt i = 0; i < s->count; i++) {
        PetscCall(PetscStrlen(s->where, &used));
        if (used + 32 > sizeof s->where) {
            PetscCall(PetscStrcat(s->where, " ..."));
            break;
        }
        PetscCall(PetscSNPrintf(s->where + used, sizeof s->where - used, " %" PetscInt_FMT, s->number[i]));
    }
    PetscFunctionReturn(0);
}

/* The context of this rank's contacts. Solvers leave r symmetric to their tolerance only: tribo gets the mean of both halves, and
 * zeros between islands. */
static PetscErrorCode CreateContacts(Share *s, PetscInt n, const PetscScalar *r, const PetscInt *island)
{
    double *own;

    PetscFunctionBeginUser;
    PetscCall(PetscCalloc1((size_t)s->count * (size_t)s->count, &own));
    for (PetscInt i = 0; i < s->count; i++) {
        for (PetscInt j = 0; j < s->count; j++) {
            const PetscInt a = s->number[i], b = s->number[j];
            own[i * s->count + j] = island[a] == island[b] ? 0.5 * PetscRealPart(r[a * n + b] + r[b * n + a]) : 0.0;
        }
    }
    PetscCheck(!tribo_create(&s->contacts, (size_t)s->count), PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for contacts");
    PetscCallTribo(tribo_set_operator_dense(s->contacts, own), tribo_message(s->contacts), "contacts:%s", s->where);
    PetscCall(PetscFree(own));
    PetscFunctionReturn(0);
}

/* All of the operator on every rank, by rows. */
static PetscErrorCode GatherOperator(Mat operator, PetscInt n, Mat **whole, const PetscScalar **r)
{
    IS all;

    PetscFunctionBeginUser;
    PetscCall(ISCreateStride(PETSC_COMM_SELF, n, 0, 1, &all));
    PetscCall(MatCreateSubMatrices(operator, 1, &all, &all, MAT_INITIAL_MATRIX, whole));
    PetscCall(MatDenseGetArrayRead((*whole)[0], r));
    PetscCall(ISDestroy(&all));
    PetscFunctionReturn(0);
}

PetscErrorCode CreateShare(Mat operator, Vec like, Share *s)
{
    const PetscScalar *r;
    PetscInt n, *island, *owner;
    PetscMPIInt rank;
    Mat *whole;
    IS mine;

    PetscFunctionBeginUser;
    PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
    PetscCall(VecGetSize(like, &n));
    PetscCall(GatherOperator(operator, n, &whole, &r));
    PetscCall(PetscMalloc2(n, &island, n, &owner));
    PetscCall(PetscMalloc1(n, &s->number));
    PetscCall(FindIslands(n, r, island, &s->islands));
    PetscCall(DealIslands(n, island, s->islands, owner));
    s->count = 0;
    for (PetscInt i = 0; i < n; i++) {
        if (owner[island[i]] == rank) {
            s->number[s->count++] = i;
        }
    }
    PetscCall(NameContacts(s));
    PetscCall(CreateContacts(s, n, r, island));
    PetscCall(ISCreateGeneral(PETSC_COMM_SELF, s->count, s->number, PETSC_COPY_VALUES, &mine));
    PetscCall(VecCreateSeq(PETSC_COMM_SELF, s->count, &s->end));
    PetscCall(VecDuplicate(s->end, &s->f));
    PetscCall(VecScatterCreate(like, mine, s->end, NULL, &s->gather));
    PetscCall(ISDestroy(&mine));
    PetscCall(MatDenseRestoreArrayRead(whole[0], &r));
    PetscCall(MatDestroySubMatrices(1, &whole));
    PetscCall(PetscFree2(island, owner));
    PetscFunctionReturn(0);
}

PetscErrorCode DestroyShare(Share *s)
{
    PetscFunctionBeginUser;
    tribo_destroy(s->contacts);
    PetscCall(PetscFree(s->number));
    PetscCall(VecScatterDestroy(&s->gather));
    PetscCall(VecDestroy(&s->end));
    PetscCall(VecDestroy(&s->f));
    PetscFunctionReturn(0);
}
