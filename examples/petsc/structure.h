/* SPDX-License-Identifier: BSD-3-Clause */
/* A structure with friction contacts, distributed over the ranks. */
#ifndef EXAMPLES_PETSC_STRUCTURE_H
#define EXAMPLES_PETSC_STRUCTURE_H

#include <petscksp.h>

#include "contacts.h"
#include "input.h"
#include "islands.h"

typedef struct {
    char mass[PETSC_MAX_PATH_LEN], stiffness[PETSC_MAX_PATH_LEN], contacts[PETSC_MAX_PATH_LEN], places[PETSC_MAX_PATH_LEN];
    char vtk[PETSC_MAX_PATH_LEN];
    PetscReal load, omega, damping, distance;
    PetscInt load_row, copies, every;
} Options;

/* M q'' + B K q' + K q = p + J'f, v = J q'. With A = M + (h^2/4 + h B/2) K a step is
 *   u_end = u + A^-1 (h p - h K (q + (h/2 + B) u)) + h A^-1 J' f,   q_end = q + h (u + u_end)/2,
 * so that contacts end it at J u_free + h R f, with the condensed operator R = J A^-1 J'. */
typedef struct {
    Mat mass, stiffness, direction, response; /* direction: J; response: A^-1 J', dense */
    KSP solver;
    PetscReal h, dissipated;
    Vec q, u, load[2], shape, place; /* p = load[0] sin + load[1] cos; shape: 1 at the load's row; place: may be NULL */
    Vec force, change;               /* work of the structure's size */
    Contacts contacts;               /* as the file has them */
    Vec v, end, f;                   /* of all contacts: velocities before and after a step, forces */
    Share share;                     /* those of this rank */
    PetscLogStage friction;
} Structure;

PetscErrorCode CreateStructure(Structure *structure, const Options *options);
PetscErrorCode DestroyStructure(Structure *structure);

#endif
