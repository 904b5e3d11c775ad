/* SPDX-License-Identifier: BSD-3-Clause */
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

#endif
