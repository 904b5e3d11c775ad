/* Two-mass pile of blocks on a belt: light ones between heavy ones, so that R is tridiagonal and badly scaled. For the test and for
 * the bench. */
#ifndef TRIBO_TESTS_PILE_H
#define TRIBO_TESTS_PILE_H

#include "tribo/tribo_gsl.h"

#define PILE_BLOCKS 50
#define PILE_STATES (2 * PILE_BLOCKS + 1)

/* Even blocks have mass 1, odd ones 1/ratio. Each has a spring to the ground; contact i is below block i, contact 0 on the belt, which
 * moves with sin(t/2). Limits fall from 0.5 at the bottom, as weights above would make them. Returns a status; law Quinn. */
int pile_create(tribo_system **sys, double ratio);

/* Largest error of the displacements and of the heavy blocks' velocities. */
double pile_distance(const double *y, const double *want);

#endif
