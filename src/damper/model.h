/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_MODEL_H
#define DAMPER_MODEL_H

#include "tables.h"

/* The reduced structure, and the same with twice the modes, by which the model error is found. */
struct model {
    const struct options *options;
    const struct structure *structure;
    struct damper damper, finer;
    int whole; /* the modes are all that the structure has: there is no finer one */
};

/* Keeps --modes of them, or as many as the answer needs; ends the program if there is nothing to compute with. */
struct model create_model(const struct options *o, const struct structure *s);

/* Takes twice the modes if the error is too large and --modes does not fix them. Returns 1 if it did. */
int take_more_modes(struct model *m, double error);
void free_model(struct model *m);

/* A point, and its changes with twice the modes. */
struct point {
    double limit, hz;
    const struct curve *curve; /* NULL: of none */
    size_t sample;             /* of the curve */
    double amplitude;          /* relative change */
    double power;              /* change of the power lost to friction, by the input power */
    int compared;              /* 0: not found with both, and changes are 0 */
    int between;               /* 1: at a limit that the user has not given; not in the model error */
};

/* The larger of both changes; 0 of a point between. */
double change_of(const struct point *p);

/* Finds the points with both numbers of modes, unless m is whole. */
void compare_models(const struct model *m, size_t threads, struct point *point, size_t count);

/* Bounds the error: MARGIN times the largest change of the points, and of frequencies and amplitudes with all contacts stuck.
 * NaN if no point was compared. */
double model_error(const struct model *m, const struct point *point, size_t count);

/* Prints the number of modes and the bound of missing displacements; prints the model error. */
void report_model(const struct tables *t, const struct model *m);
void report_error(const struct tables *t, const struct model *m, const struct point *point, size_t count);

#endif
