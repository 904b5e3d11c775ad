/* SPDX-License-Identifier: BSD-3-Clause */
/* The blocks of a chain that this rank owns, and their friction. */
#ifndef EXAMPLES_PETSC_BLOCKS_H
#define EXAMPLES_PETSC_BLOCKS_H

#include <petscdmda.h>

#include "tribo/tribo.h"

/* What a block knows: place, velocity, and the energy that its friction has taken. */
typedef struct {
    PetscScalar u, v, d;
} Block;

/* Some blocks of this rank, few enough that what tribo reads and writes stays in cache, and their contacts. Blocks on the ground
 * share no body: each is an island, and any set of them may have a context of its own. */
enum { TILE = 4096 };
typedef struct {
    PetscInt first, count;
    tribo_context *contacts;
} Tile;

typedef struct {
    DM da;
    PetscInt n, tiles;
    Tile *tile;
    PetscReal limit, alpha, omega, lambda_dt;
    PetscReal h, dt; /* times of a kick */
    PetscLogStage friction;
} Chain;

/* The context of each tile, for steps of dt. */
PetscErrorCode CreateTiles(Chain *chain, PetscReal dt);
PetscErrorCode DestroyTiles(Chain *chain);

/* For TS: from the state at t to its rates, u' = v, v' = a + n f, d' = -f v, with f from Quinn's law. */
PetscErrorCode FindRates(Chain *chain, PetscReal t, Vec state, Vec rates);

/* Central differences: velocities live half a step before places. Takes them over the time h, and the places on by dt. The
 * force is the one that leaves the blocks in Coulomb's law at the end of h. */
PetscErrorCode Kick(Chain *chain, PetscReal t, PetscReal h, PetscReal dt, Vec state);

#endif
