/* SPDX-License-Identifier: BSD-3-Clause */
/* The contacts of a structure, from their file to the matrix J. Collective, all of it; each rank reads the whole file. */
#ifndef EXAMPLES_PETSC_CONTACTS_H
#define EXAMPLES_PETSC_CONTACTS_H

#include <petscmat.h>

/* Contacts as their file has them, the same on all ranks; those of each copy of the structure follow each other. */
typedef struct {
    PetscInt count, room, (*row)[2]; /* [count] rows, counted from 0; the second may be -1, the ground */
    PetscReal *limit;                /* [count] */
} Contacts;

/* Reads "row other limit" a line, with rows that count from 1 and 0 for the ground: v is the velocity of row less that of
 * other. */
PetscErrorCode ReadContacts(const char *path, Mat matrix, PetscInt copies, Contacts *contacts);
PetscErrorCode DestroyContacts(Contacts *contacts);

/* direction: J, a row a contact; limit: a vector over them. */
PetscErrorCode CreateDirection(const Contacts *contacts, Mat matrix, Mat *direction, Vec *limit);

#endif
