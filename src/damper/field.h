/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_FIELD_H
#define DAMPER_FIELD_H

#include "tables.h"

/* Writes NAME-what.vtk, legacy format of VTK: displacements of the whole structure in the motion that begins with y, at phases in
 * degrees of the loads' period. Points are the nodes that have a row, in ascending order; vectors are named
 * displacement_PHASE. */
void write_field(const struct tables *t, const struct structure *s, const struct list *phases, struct worker *w,
                 const struct motion *m, const double *y, const char *what);

#endif
