#ifndef DAMPER_MODEL_H
#define DAMPER_MODEL_H

#include "tables.h"

/* The reduced structure, and the same with twice the modes, which shows what more of them change. */
struct model {
    const struct options *options;
    const struct structure *structure;
    struct damper damper, finer;
    int whole; /* the modes are all that the structure has: there is no finer one */
};

/* Keeps --modes of them, or as many as the answer needs; ends the program if there is nothing to compute with. */
struct model create_model(const struct options *o, const struct structure *s);

/* Takes twice the modes, if the error is too large and their number is free; returns whether it did. */
int take_more_modes(struct model *m, double error);
void free_model(struct model *m);

/* A point of a curve, and how much of it changes with twice the modes. */
struct point {
    double limit, hz;
    double amplitude; /* relative change */
    double power;     /* of the power lost to friction, beside all that the load puts in */
    int compared;     /* 0: not found with both, and changes are 0 */
};

/* Finds the points of m with both numbers of modes, on so many threads, if there are two. */
void compare_models(const struct model *m, size_t threads, struct point *point, size_t count);

/* Twice the largest change: bounds the error if each doubling of the modes halves it. NaN if no point was compared. */
double model_error(const struct point *point, size_t count);

/* Says how many modes there are and what they lack, and how much more of them change at those points. */
void report_model(const struct tables *t, const struct model *m);
void report_error(const struct tables *t, const struct model *m, const struct point *point, size_t count);

#endif
