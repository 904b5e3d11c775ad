/* SPDX-License-Identifier: BSD-3-Clause */
#include "input.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 1025 };

/* A file, and what its head says; entries are counted as the lines announce them. */
typedef struct {
    const char *path;
    FILE *file;
    PetscInt rows, announced;
    PetscBool symmetric;
    long begin; /* of the entries */
} Source;

/* Entries of this rank, in the order of the file, mirrored ones too. */
typedef struct {
    PetscInt count, room, *row, *column;
    PetscScalar *value;
} Entries;

static PetscErrorCode ReadHead(Source *s)
{
    char line[LINE] = "", symmetry[16] = "";
    long rows, columns, announced;

    PetscFunctionBeginUser;
    PetscCheck(fgets(line, LINE, s->file), PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s is empty", s->path);
    for (char *c = line; *c; c++) {
        *c = (char)tolower((unsigned char)*c);
    }
    PetscCheck(sscanf(line, "%%%%matrixmarket matrix coordinate real %15s", symmetry) == 1 &&
                   (!strcmp(symmetry, "symmetric") || !strcmp(symmetry, "general")),
               PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
               "%s: expected \"%%%%MatrixMarket matrix coordinate real symmetric\" (or general), found \"%.80s\"", s->path, line);
    s->symmetric = (PetscBool)!strcmp(symmetry, "symmetric");
    do {
        PetscCheck(fgets(line, LINE, s->file), PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s ends before its sizes", s->path);
    } while (line[0] == '%');
    PetscCheck(sscanf(line, "%ld %ld %ld", &rows, &columns, &announced) == 3 && rows > 0 && rows == columns && announced >= 0,
               PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "%s: these are no sizes of a square matrix: \"%.80s\"", s->path, line);
    s->rows = (PetscInt)rows;
    s->announced = (PetscInt)announced;
    s->begin = ftell(s->file);
    PetscFunctionReturn(0);
}

/* Goes to where this rank's share of the lines begins, and tells where it ends: a line belongs to whom its first byte does. */
static PetscErrorCode FindShare(MPI_Comm comm, const Source *s, long *end)
{
    PetscMPIInt rank, size;
    int c = '\n';

    PetscFunctionBeginUser;
    PetscCallMPI(MPI_Comm_rank(comm, &rank));
    PetscCallMPI(MPI_Comm_size(comm, &size));
    PetscCheck(!fseek(s->file, 0, SEEK_END), PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s cannot be read", s->path);
    const long bytes = ftell(s->file) - s->begin, share = bytes / size;
    *end = rank + 1 < size ? s->begin + (rank + 1) * share : s->begin + bytes;
    PetscCheck(!fseek(s->file, s->begin + rank * share - 1, SEEK_SET), PETSC_COMM_SELF, PETSC_ERR_FILE_READ, "%s cannot be read",
               s->path);
    do {
        c = getc(s->file);
    } while (c != '\n' && c != EOF);
    PetscFunctionReturn(0);
}

static PetscErrorCode AddEntry(Entries *e, PetscInt row, PetscInt column, PetscScalar value)
{
    PetscFunctionBeginUser;
    if (e->count == e->room) {
        e->room = 2 * e->room + 1024;
        PetscCall(PetscRealloc((size_t)e->room * sizeof *e->row, &e->row));
        PetscCall(PetscRealloc((size_t)e->room * sizeof *e->column, &e->column));
        PetscCall(PetscRealloc((size_t)e->room * sizeof *e->value, &e->value));
    }
    e->row[e->count] = row;
    e->column[e->count] = column;
    e->value[e->count++] = value;
    PetscFunctionReturn(0);
}

/* Reads this rank's share of the entries, and sees that those of all ranks are as many as announced. */
static PetscErrorCode ReadEntries(MPI_Comm comm, const Source *s, PetscInt copies, Entries *e)
{
    PetscInt64 lines = 0, all;
    char line[LINE];
    long end = 0;

    PetscFunctionBeginUser;
    PetscCall(FindShare(comm, s, &end));
    while (ftell(s->file) < end && fgets(line, LINE, s->file)) {
        char *at = line;
        const long row = strtol(at, &at, 10), column = strtol(at, &at, 10);
        char *last = at;
        const double value = strtod(at, &last);
        if (strspn(line, " \t\r\n") == strlen(line)) {
            continue;
        }
        PetscCheck(last != at && row >= 1 && row <= s->rows && column >= 1 && column <= (s->symmetric ? row : s->rows),
                   PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
                   "%s: this is no entry of a %s matrix of %" PetscInt_FMT " rows: %.80s", s->path,
                   s->symmetric ? "symmetric (lower triangle)" : "general", s->rows, line);
        lines++;
        for (PetscInt k = 0; k < copies; k++) {
            const PetscInt i = k * s->rows + (PetscInt)row - 1, j = k * s->rows + (PetscInt)column - 1;
            PetscCall(AddEntry(e, i, j, value));
            if (s->symmetric && i != j) {
                PetscCall(AddEntry(e, j, i, value));
            }
        }
    }
    PetscCall(MPIU_Allreduce(&lines, &all, 1, MPIU_INT64, MPI_SUM, comm));
    PetscCheck(all == s->announced, comm, PETSC_ERR_FILE_UNEXPECTED,
               "%s announces %" PetscInt_FMT " entries and has %" PetscInt64_FMT, s->path, s->announced, all);
    PetscFunctionReturn(0);
}

PetscErrorCode ReadMatrix(MPI_Comm comm, const char *path, PetscInt copies, Mat *matrix)
{
    Source s = {.path = path};
    Entries e = {0};

    PetscFunctionBeginUser;
    s.file = fopen(path, "r");
    PetscCheck(s.file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s cannot be opened", path);
    PetscCall(ReadHead(&s));
    PetscCall(ReadEntries(comm, &s, copies, &e));
    fclose(s.file);
    PetscCall(MatCreate(comm, matrix));
    PetscCall(MatSetSizes(*matrix, PETSC_DECIDE, PETSC_DECIDE, copies * s.rows, copies * s.rows));
    PetscCall(MatSetBlockSize(*matrix, s.rows % 3 ? 1 : 3));
    PetscCall(MatSetType(*matrix, MATAIJ));
    PetscCall(MatSetPreallocationCOO(*matrix, e.count, e.row, e.column));
    PetscCall(MatSetValuesCOO(*matrix, e.value, INSERT_VALUES));
    PetscCall(PetscFree(e.row));
    PetscCall(PetscFree(e.column));
    PetscCall(PetscFree(e.value));
    PetscFunctionReturn(0);
}

PetscErrorCode ReadPlaces(const char *path, Mat matrix, PetscInt copies, PetscReal distance, Vec *place)
{
    PetscInt rows, first, end, expected = 0;
    char line[LINE];

    PetscFunctionBeginUser;
    PetscCall(MatCreateVecs(matrix, place, NULL));
    PetscCall(MatGetSize(matrix, &rows, NULL));
    PetscCall(MatGetOwnershipRange(matrix, &first, &end));
    rows /= copies;
    FILE *file = fopen(path, "r");
    PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s cannot be opened", path);
    while (fgets(line, LINE, file)) {
        long row, node;
        int direction;
        double at[3];
        if (line[0] == '#') {
            continue;
        }
        PetscCheck(sscanf(line, "%ld %ld %d %lf %lf %lf", &row, &node, &direction, &at[0], &at[1], &at[2]) == 6 &&
                       row == expected + 1 && direction == expected % 3 + 1,
                   PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED, "%s: expected \"%" PetscInt_FMT " node %d x y z\", found: %.80s",
                   path, expected + 1, (int)(expected % 3 + 1), line);
        for (PetscInt k = 0, i = expected; k < copies; k++, i += rows) {
            if (i >= first && i < end) {
                PetscCall(
                    VecSetValue(*place, i, at[direction - 1] + (direction == 3 ? (PetscReal)k * distance : 0.0), INSERT_VALUES));
            }
        }
        expected++;
    }
    fclose(file);
    PetscCheck(expected == rows, PETSC_COMM_SELF, PETSC_ERR_FILE_UNEXPECTED,
               "%s has %" PetscInt_FMT " rows, and the matrix %" PetscInt_FMT, path, expected, rows);
    PetscCall(VecAssemblyBegin(*place));
    PetscCall(VecAssemblyEnd(*place));
    PetscFunctionReturn(0);
}
