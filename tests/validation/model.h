/* SPDX-License-Identifier: BSD-3-Clause */
/* Random linear structures with friction. */
#ifndef TRIBO_TESTS_MODEL_H
#define TRIBO_TESTS_MODEL_H

#include "run.h"

#define DOFS 6
#define CONTACTS 3
#define DIMENSION (2 * DOFS + 1)

/* Row-major; loads and motions of one harmonic each. */
struct model {
    double mass[DOFS * DOFS], damping[DOFS * DOFS], stiffness[DOFS * DOFS], direction[CONTACTS * DOFS];
    double load[2][DOFS], motion[2][CONTACTS], load_omega, motion_omega;
};

/* A full mass matrix, or a diagonal one. */
struct model model_create(struct random *g, int full);

/* The system of a model, loads and all, with Quinn's law, limits of the order of 1 and this epsilon. */
tribo_system *model_system(const struct model *m, int damped, size_t nmode, double epsilon);
void model_finish(const struct model *m, tribo_system *sys, double epsilon);

/* Adds two harmonics to the limits, which take some of them below 0; the amplitudes of the last are c and s [CONTACTS]. */
void model_swing(tribo_system *sys, struct random *g, double *c, double *s);

/* c = a b, a [rows][inner], b [inner][cols]; c = a' b, a [inner][rows]. */
void multiply(size_t rows, size_t inner, size_t cols, const double *a, const double *b, double *c);
void multiply_transposed(size_t rows, size_t inner, size_t cols, const double *a, const double *b, double *c);

/* x' A y, A [DOFS][DOFS]. */
double form(const double *a, const double *x, const double *y);

#endif
