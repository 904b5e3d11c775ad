/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_MARCH_H
#define DAMPER_MARCH_H

#include "motion.h"

/* Ends the program if a period of this frequency would take too many steps. */
void check_steps(const struct damper *d, double hz);

/* Finds the steady motion by time integration, the law being that of the context: runs from y until the motion
 * repeats itself. y [record] out: the record of the motion. */
struct motion march(struct worker *w, double limit, double hz, double *y);

/* The driver that does: set to this limit and frequency. */
tribo_driver *create_marcher(struct worker *w, double limit, double hz);

#endif
