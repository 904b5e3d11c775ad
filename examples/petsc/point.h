/* SPDX-License-Identifier: BSD-3-Clause */
/* One point of a study: the steady response of a structure, in its lowest modes, by libtribo_gsl. No rank knows of the others. */
#ifndef EXAMPLES_PETSC_POINT_H
#define EXAMPLES_PETSC_POINT_H

#include "contacts.h"
#include "input.h"
#include "tribo/tribo_gsl.h"

typedef struct {
    char mass[PETSC_MAX_PATH_LEN], stiffness[PETSC_MAX_PATH_LEN], contacts[PETSC_MAX_PATH_LEN], out[PETSC_MAX_PATH_LEN];
    PetscReal load, damping, omega[2], scale[2];
    PetscInt load_row, modes, omegas, scales;
} Options;

/* What every rank has for itself. */
typedef struct {
    tribo_system *sys; /* points are computed on copies of it, so that none of them sees what another has left behind */
    size_t rows;
    Contacts contacts;
    double *load;  /* [rows] amplitudes */
    double *shape; /* [2 modes] displacement of the loaded row in each mode; nothing of velocities */
    double *limit; /* [contacts] of a point */
} Study;

/* Reads the files and makes the system. */
PetscErrorCode CreateStudy(Study *study, const Options *options);
PetscErrorCode DestroyStudy(Study *study);

/* The point at one frequency, with the limits of the file times scale: amplitude of the loaded row and energy that friction
 * takes in a period, both NaN where status, TRIBO_ERR_NO_CONVERGENCE, says that no steady motion was found. The same bits
 * whichever rank does it, and whatever it did before. */
PetscErrorCode ComputePoint(const Study *study, double omega, double scale, double *amplitude, double *energy, int *status);

#endif
