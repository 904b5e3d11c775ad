/* SPDX-License-Identifier: BSD-3-Clause */
/* Systems of matrices in one call, for what tests of Fortran are compared with. */
#ifndef TRIBO_TEST_STRUCTURE_H
#define TRIBO_TEST_STRUCTURE_H

#include "tribo/tribo_dynamics.h"

/* Matrices by rows, without zeros where sparse is set; damping may be NULL. */
struct structure {
    size_t ndof, ncontact;
    const double *mass, *damping, *stiffness, *direction;
    int sparse;
};

/* The system of all degrees of freedom, or, with nmode > 0, of the lowest modes and the static responses of the contacts as
 * tribo_system_reduce has them. Returns the status of the call that failed first. */
int structure_system(tribo_system **sys, const struct structure *s, size_t nmode, int statics);

#endif
