/* SPDX-License-Identifier: BSD-3-Clause */
/* Files that CalculiX writes for *FREQUENCY, SOLVER=MATRIXSTORAGE: matrices name.sti and name.mas, degrees of freedom name.dof;
 * and its input name.inp, which has the coordinates of the nodes. */
#ifndef DAMPER_CALCULIX_H
#define DAMPER_CALCULIX_H

#include "degrees.h"
#include "entries.h"
#include "lines.h"

/* A matrix: lines "row column value" without a head, each pair of rows once, and all of the diagonal. */
void read_calculix_matrix(const char *path, const struct rows *rows, struct entries *all);

/* A line "node.direction". */
struct degree read_calculix_degree(struct lines *l, size_t row);

/* Finds the places of degrees of freedom in the input that belongs to the .dof file of this path. */
void find_calculix_places(const char *path, struct degree *dof, size_t count);

#endif
