/* SPDX-License-Identifier: BSD-3-Clause */
#include "records.h"

/* Reads bytes at a place; fewer where the file ends. */
static PetscErrorCode ReadAt(Records *r, MPI_Offset at, char *text, PetscMPIInt bytes, PetscMPIInt *found)
{
    MPI_Status status;

    PetscFunctionBeginUser;
    PetscCallMPI(MPI_File_read_at(r->file, at, text, bytes, MPI_CHAR, &status));
    PetscCallMPI(MPI_Get_count(&status, MPI_CHAR, found));
    PetscFunctionReturn(0);
}

/* Writes text as a line of so many bytes, filled up by blanks. */
static PetscErrorCode WriteAt(Records *r, MPI_Offset at, const char *text, PetscMPIInt bytes)
{
    char *line;
    size_t length;

    PetscFunctionBeginUser;
    PetscCall(PetscStrlen(text, &length));
    PetscCheck(length < (size_t)bytes, PETSC_COMM_SELF, PETSC_ERR_ARG_SIZ, "a line of %zu characters does not fit: %s", length,
               text);
    PetscCall(PetscMalloc1(bytes, &line));
    PetscCall(PetscArraycpy(line, text, length));
    for (PetscMPIInt i = (PetscMPIInt)length; i < bytes; i++) {
        line[i] = i == bytes - 1 ? '\n' : ' ';
    }
    PetscCallMPI(MPI_File_write_at(r->file, at, line, bytes, MPI_CHAR, MPI_STATUS_IGNORE));
    PetscCall(PetscFree(line));
    PetscFunctionReturn(0);
}

PetscErrorCode OpenRecords(const char *path, const char *head, PetscMPIInt width, Records *r)
{
    char *line;
    size_t length;
    PetscMPIInt rank, found = 0;
    PetscBool same;

    PetscFunctionBeginUser;
    PetscCallMPI(MPI_Comm_rank(PETSC_COMM_WORLD, &rank));
    PetscCheck(MPI_File_open(PETSC_COMM_WORLD, path, MPI_MODE_CREATE | MPI_MODE_RDWR, MPI_INFO_NULL, &r->file) == MPI_SUCCESS,
               PETSC_COMM_WORLD, PETSC_ERR_FILE_OPEN, "%s cannot be opened", path);
    PetscCall(PetscStrlen(head, &length));
    r->head = (PetscMPIInt)length + 1;
    r->width = width;
    if (rank == 0) {
        PetscCall(PetscCalloc1(length + 1, &line));
        PetscCall(ReadAt(r, 0, line, (PetscMPIInt)length, &found));
        PetscCall(PetscStrcmp(line, head, &same));
        PetscCheck(found == 0 || same, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
                   "%s holds other results, and is left as it is: it begins with\n%s\nand not with\n%s", path, line, head);
        PetscCall(WriteAt(r, 0, head, r->head));
        PetscCall(PetscFree(line));
    }
    PetscCallMPI(MPI_Barrier(PETSC_COMM_WORLD));
    PetscFunctionReturn(0);
}

PetscErrorCode CloseRecords(Records *r)
{
    PetscFunctionBeginUser;
    PetscCallMPI(MPI_File_close(&r->file));
    PetscFunctionReturn(0);
}

PetscErrorCode HasRecord(Records *r, PetscInt k, PetscBool *there)
{
    char *line;
    PetscMPIInt found;

    PetscFunctionBeginUser;
    PetscCall(PetscMalloc1(r->width, &line));
    PetscCall(ReadAt(r, r->head + (MPI_Offset)k * r->width, line, r->width, &found));
    *there = (PetscBool)(found == r->width && line[r->width - 1] == '\n');
    for (PetscMPIInt i = 0; *there && i < r->width - 1; i++) {
        *there = (PetscBool)(line[i] >= ' ' && line[i] <= '~');
    }
    PetscCall(PetscFree(line));
    PetscFunctionReturn(0);
}

PetscErrorCode WriteRecord(Records *r, PetscInt k, const char *text)
{
    PetscFunctionBeginUser;
    PetscCall(WriteAt(r, r->head + (MPI_Offset)k * r->width, text, r->width));
    PetscFunctionReturn(0);
}
