/* SPDX-License-Identifier: BSD-3-Clause */
/* The finite-element beam of the examples. */
#ifndef TRIBO_TESTS_BEAM_H
#define TRIBO_TESTS_BEAM_H

#include <stdio.h>

#include <gsl/gsl_spmatrix.h>

#include "tribo/tribo_gsl.h"

#define BEAM_DOFS 288
#define BEAM_MODES 12
#define BEAM_STATES (2 * BEAM_MODES + 1)

/* "M.mtx" or "K.mtx": a symmetric Matrix Market file of which the lower triangle is stored. */
gsl_spmatrix *beam_matrix(const char *name);

/* The beam as the example has it: 12 modes, damping ratio 0.002, three contacts on its lower edge, and a load at its tip: without
 * one, or with one of 0.1 N in the first resonance. springs: contacts of this compliance. */
tribo_system *beam_with_springs(double compliance, double limit);
tribo_system *beam_with_contacts(double limit);
tribo_system *beam_with_damper(double limit);
void beam_add_load(tribo_system *sys, double omega);

#endif
