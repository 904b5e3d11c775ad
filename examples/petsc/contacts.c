/* SPDX-License-Identifier: BSD-3-Clause */
#include "contacts.h"

#include <stdio.h>

enum { LINE = 1025 };

static PetscErrorCode AddContact(Contacts *c, PetscInt row, PetscInt other, PetscReal limit)
{
    PetscFunctionBeginUser;
    if (c->count == c->room) {
        c->room = 2 * c->room + 64;
        PetscCall(PetscRealloc((size_t)c->room * sizeof *c->row, &c->row));
        PetscCall(PetscRealloc((size_t)c->room * sizeof *c->limit, &c->limit));
    }
    c->row[c->count][0] = row;
    c->row[c->count][1] = other;
    c->limit[c->count++] = limit;
    PetscFunctionReturn(0);
}

PetscErrorCode ReadContacts(const char *path, Mat matrix, PetscInt copies, Contacts *c)
{
    char line[LINE];
    PetscInt rows;

    PetscFunctionBeginUser;
    PetscCall(MatGetSize(matrix, &rows, NULL));
    rows /= copies;
    FILE *file = fopen(path, "r");
    PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s cannot be opened", path);
    while (fgets(line, LINE, file)) {
        long row, other;
        double limit;
        if (line[0] == '#') {
            continue;
        }
        PetscCheck(
            sscanf(line, "%ld %ld %lf", &row, &other, &limit) == 3 && row >= 1 && row <= rows && other >= 0 && other <= rows,
            PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
            "%s: expected \"row other limit\", rows being 1 to %" PetscInt_FMT " (other: or 0), found: %.80s", path, rows, line);
        PetscCall(AddContact(c, (PetscInt)row - 1, (PetscInt)other - 1, limit));
    }
    fclose(file);
    const PetscInt once = c->count;
    for (PetscInt k = once; k < copies * once; k++) {
        const PetscInt row = c->row[k - once][0] + rows, other = c->row[k - once][1];
        PetscCall(AddContact(c, row, other < 0 ? other : other + rows, c->limit[k - once]));
    }
    PetscFunctionReturn(0);
}

PetscErrorCode DestroyContacts(Contacts *c)
{
    PetscFunctionBeginUser;
    PetscCall(PetscFree(c->row));
    PetscCall(PetscFree(c->limit));
    PetscFunctionReturn(0);
}

PetscErrorCode CreateDirection(const Contacts *c, Mat matrix, Mat *direction, Vec *limit)
{
    PetscInt columns, here, first, end;

    PetscFunctionBeginUser;
    PetscCall(MatGetSize(matrix, &columns, NULL));
    PetscCall(MatGetLocalSize(matrix, &here, NULL));
    PetscCall(
        MatCreateAIJ(PetscObjectComm((PetscObject)matrix), PETSC_DECIDE, here, c->count, columns, 2, NULL, 2, NULL, direction));
    PetscCall(MatCreateVecs(*direction, NULL, limit));
    PetscCall(MatGetOwnershipRange(*direction, &first, &end));
    for (PetscInt i = first; i < end; i++) {
        PetscCall(MatSetValue(*direction, i, c->row[i][0], 1.0, ADD_VALUES));
        if (c->row[i][1] >= 0) {
            PetscCall(MatSetValue(*direction, i, c->row[i][1], -1.0, ADD_VALUES));
        }
        PetscCall(VecSetValue(*limit, i, c->limit[i], INSERT_VALUES));
    }
    PetscCall(MatAssemblyBegin(*direction, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(*direction, MAT_FINAL_ASSEMBLY));
    PetscCall(VecAssemblyBegin(*limit));
    PetscCall(VecAssemblyEnd(*limit));
    PetscFunctionReturn(0);
}
