/* A structure's files as PETSc's matrices and vectors. Collective, all of them. */
#ifndef EXAMPLES_PETSC_INPUT_H
#define EXAMPLES_PETSC_INPUT_H

#include <petscmat.h>

/* Reads a square matrix (coordinate, real, symmetric or general; entries given twice are added) and repeats it copies times along
 * the diagonal. Each rank reads its share of the file. Rows come in blocks of 3 where their number allows it. */
PetscErrorCode ReadMatrix(MPI_Comm comm, const char *path, PetscInt copies, Mat *matrix);

/* Reads "row node direction x y z" a line, with directions 1, 2, 3 in turn, and gives each row the coordinate of its node in
 * its own direction. place: a vector that fits the matrix; each copy of the structure stands (0, 0, distance) from the last.
 * Each rank reads the whole file. */
PetscErrorCode ReadPlaces(const char *path, Mat matrix, PetscInt copies, PetscReal distance, Vec *place);

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
