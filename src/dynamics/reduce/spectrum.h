/* SPDX-License-Identifier: BSD-3-Clause */
/* Bounds of the highest frequencies of a structure. */
#ifndef TRIBO_SPECTRUM_H
#define TRIBO_SPECTRUM_H

#include "dynamics/system/system.h"

/* Sets *value = an estimate from above, by at most 1%, of the highest eigenvalue of stiffness AK + damping AC; 0 if none is
 * positive. Neglects damping that is not symmetric. Returns TRIBO_OK or TRIBO_ERR_MEMORY, with a message on the context. */
int tribo_system_highest(const tribo_system *sys, double stiffness, double damping, double *value);

#endif
