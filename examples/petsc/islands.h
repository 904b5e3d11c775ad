/* SPDX-License-Identifier: BSD-3-Clause */
/* Which contacts feel each other, and which rank takes them. */
#ifndef EXAMPLES_PETSC_ISLANDS_H
#define EXAMPLES_PETSC_ISLANDS_H

#include <petscmat.h>

#include "tribo/tribo.h"

/* The islands of the contacts dealt to ranks, and this rank's own ones. */
typedef struct {
    PetscInt islands, count; /* of all ranks; contacts of this one */
    PetscInt *number;        /* [count] which contacts these are */
    VecScatter gather;       /* from a vector over all contacts to one over these; in reverse, back */
    Vec end, f;              /* [count] velocities at the end of a step, forces */
    tribo_context *contacts; /* with their operator */
    char where[512];         /* their numbers, for messages */
} Share;

/* Takes operator, the condensed one of all contacts (dense, distributed, the same on any number of ranks), apart into islands,
 * gives each island to the rank that has fewest contacts, and makes there a context with their part of it. like: a vector over
 * all contacts. Collective. */
PetscErrorCode CreateShare(Mat operator, Vec like, Share *share);
PetscErrorCode DestroyShare(Share *share);

#endif
