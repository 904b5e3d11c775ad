/* SPDX-License-Identifier: BSD-3-Clause */
#include "vtk.h"

#include <stdio.h>

enum { NO_CONTACT = 3 }; /* beside what tribo_get_slip says */

/* All of a vector on the first rank; nothing on the others. */
static PetscErrorCode Gather(Vec from, Vec *all, const PetscScalar **value)
{
    VecScatter scatter;

    PetscFunctionBeginUser;
    PetscCall(VecScatterCreateToZero(from, &scatter, all));
    PetscCall(VecScatterBegin(scatter, from, *all, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecScatterEnd(scatter, from, *all, INSERT_VALUES, SCATTER_FORWARD));
    PetscCall(VecScatterDestroy(&scatter));
    PetscCall(VecGetArrayRead(*all, value));
    PetscFunctionReturn(0);
}

/* Three values a point: of the nodes, and of the nodes that the contacts are on. */
static void WriteVectors(FILE *file, PetscInt nodes, const PetscScalar *value, const Contacts *c)
{
    for (PetscInt k = 0; k < nodes + c->count; k++) {
        const PetscScalar *at = value + 3 * (k < nodes ? k : c->row[k - nodes][0] / 3);
        fprintf(file, "%.9g %.9g %.9g\n", (double)PetscRealPart(at[0]), (double)PetscRealPart(at[1]),
                (double)PetscRealPart(at[2]));
    }
}

/* One value a point: nothing for nodes. */
static void WriteScalars(FILE *file, PetscInt nodes, double nothing, const PetscScalar *value, PetscInt contacts)
{
    for (PetscInt k = 0; k < nodes + contacts; k++) {
        fprintf(file, "%.9g\n", k < nodes ? nothing : (double)PetscRealPart(value[k - nodes]));
    }
}

PetscErrorCode WriteVtk(const char *path, Vec place, Vec q, const Contacts *c, Vec f, Vec slip)
{
    const Vec from[4] = {place, q, f, slip};
    const PetscScalar *value[4];
    Vec all[4];
    PetscInt rows;

    PetscFunctionBeginUser;
    for (int i = 0; i < 4; i++) {
        PetscCall(Gather(from[i], &all[i], &value[i]));
    }
    PetscCall(VecGetLocalSize(all[0], &rows));
    if (rows > 0) {
        const PetscInt nodes = rows / 3;
        const int points = (int)(nodes + c->count);
        FILE *file = fopen(path, "w");
        PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s cannot be written", path);
        fprintf(file, "# vtk DataFile Version 3.0\nstructure with friction contacts\nASCII\nDATASET POLYDATA\nPOINTS %d double\n",
                points);
        WriteVectors(file, nodes, value[0], c);
        fprintf(file, "VERTICES %d %d\n", points, 2 * points);
        for (int k = 0; k < points; k++) {
            fprintf(file, "1 %d\n", k);
        }
        fprintf(file, "POINT_DATA %d\nVECTORS displacement double\n", points);
        WriteVectors(file, nodes, value[1], c);
        fprintf(file, "SCALARS friction double\nLOOKUP_TABLE default\n");
        WriteScalars(file, nodes, 0.0, value[2], c->count);
        fprintf(file, "SCALARS slip double\nLOOKUP_TABLE default\n");
        WriteScalars(file, nodes, NO_CONTACT, value[3], c->count);
        PetscCheck(!ferror(file) && !fclose(file), PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s could not be written", path);
    }
    for (int i = 0; i < 4; i++) {
        PetscCall(VecRestoreArrayRead(all[i], &value[i]));
        PetscCall(VecDestroy(&all[i]));
    }
    PetscFunctionReturn(0);
}
