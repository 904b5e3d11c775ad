/* SPDX-License-Identifier: BSD-3-Clause */
/* A text file of lines of one length, each of which has its place whoever writes it, and when: in order on any number of
 * ranks, and what a run that was ended has left behind is told from what is missing. */
#ifndef EXAMPLES_PETSC_RECORDS_H
#define EXAMPLES_PETSC_RECORDS_H

#include <petscsys.h>

typedef struct {
    MPI_File file;
    PetscMPIInt head, width; /* bytes of the first line and of the others, with their ends */
} Records;

/* Opens the file for all ranks; head is its first line and says what the others are: a file with another one is refused.
 * Collective. */
PetscErrorCode OpenRecords(const char *path, const char *head, PetscMPIInt width, Records *records);
PetscErrorCode CloseRecords(Records *records);

/* Whether line k, from 0 on, is there, whole; and writes it: text of less than width bytes. */
PetscErrorCode HasRecord(Records *records, PetscInt k, PetscBool *there);
PetscErrorCode WriteRecord(Records *records, PetscInt k, const char *text);

#endif
