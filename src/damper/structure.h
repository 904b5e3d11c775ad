/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_STRUCTURE_H
#define DAMPER_STRUCTURE_H

#include <stddef.h>

#include "contact.h"
#include "degrees.h"
#include "matrix.h"

/* A structure from a finite-element program. */
struct structure {
    size_t ndof;
    struct sparse mass, stiffness, damping; /* damping: no rows if there is none */
    struct degree *dof;                     /* [ndof] in the order of the rows */
};

/* Reads matrices and degrees of freedom; ends the program, naming file, line and value, if anything is wrong with them. */
struct structure read_structure(const char *mass, const char *stiffness, const char *dofs);
void free_structure(struct structure *s);

/* Prints a line about empty rows of the stiffness: bodies held by contacts only, or a part left out by mistake. */
void report_loose_rows(const struct structure *s, const char *stiffness);

/* The row of a place; ends the program if the structure has none there. */
size_t find_degree(const struct structure *s, const struct place *p);

/* Frequencies in Hz from a file, at most room of them, into hz; returns their number. */
size_t read_frequencies(const char *path, double *hz, size_t room);

#endif
