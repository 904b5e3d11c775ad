/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TRIBO_TESTS_SQUEAL_H
#define TRIBO_TESTS_SQUEAL_H

#include "tribo/tribo_dynamics.h"

/* Mode coupling, after Hoffmann and others (2002): m = 1, springs 11 at 150 degrees and 20 at 30 degrees, normal stiffness 11 in
 * y, preload 10, on a belt of this speed; damping [2] of both masses' directions is `damped`. */
tribo_system *squeal(double belt, double mu, double damped);

#endif
