/* SPDX-License-Identifier: BSD-3-Clause */
/* A pile of blocks on a belt, light ones between heavy ones: R is tridiagonal and badly scaled. For the test and for the bench.
 */
#ifndef TRIBO_TESTS_PILE_H
#define TRIBO_TESTS_PILE_H

#include "tribo/tribo_gsl.h"

#define PILE_BLOCKS 50
#define PILE_STATES (2 * PILE_BLOCKS + 1)
#define PILE_TIME 20.0

/* Even blocks have mass 1, odd ones 1/ratio, each with a spring to the ground; contact i is below block i, contact 0 on the belt,
 * which moves with sin(t/2). Limits fall from 0.5 at the bottom: evenly, so that heavy blocks that slide accelerate alike and
 * nothing but higher derivatives tells which contacts go on to slide, or unevenly. Returns a status. */
int pile_create(tribo_system **sys, double ratio, int even);

/* The state at PILE_TIME, from rest. rk4/fixed: Quinn's law with lambda dt = 1. Returns the driver's status. */
int pile_run(double ratio, int even, const char *method, int coupling, double dt, double tolerance, double *y);

/* Largest error of displacements, and of velocities of heavy blocks. */
double pile_distance(const double *y, const double *want);

#endif
