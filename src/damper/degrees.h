/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_DEGREES_H
#define DAMPER_DEGREES_H

#include <stddef.h>

/* A degree of freedom of a structure. */
struct degree {
    double at[3];
    int direction;          /* 1, 2, 3 for x, y, z */
    size_t row, node, line; /* as in the file */
};

/* The degrees of freedom, in the order of their rows, which the caller frees. A file name.dof is CalculiX's: a line
 * "node.direction" for each row, and the nodes' places are in its input, name.inp beside it. In others each line is "row node
 * direction x y z". Ends the program, naming file, line and value, if anything is wrong. */
struct degree *read_degrees(const char *path, size_t *count);

#endif
