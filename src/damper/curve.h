/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_CURVE_H
#define DAMPER_CURVE_H

#include "motion.h"

/* Steady motions over the frequency of the load at one limit, or over the limit at one frequency. */
struct sample {
    double x; /* Hz, or the logarithm of the limit */
    struct motion motion;
    double *y; /* [record] the record, if it was found */
    int asked; /* 1: given by the user; 0: added */
};

struct curve {
    int over_limit; /* else over the frequency */
    double fixed;   /* the other one */
    struct sample *sample;
    size_t count;  /* ascending in x, or in the order of a followed curve */
    size_t record; /* numbers in the record of a motion */
};

/* Adds a sample at x; a sample that is there already becomes asked if asked is 1. */
void ask_sample(struct curve *c, double x, int asked);

/* Finds the motions from left to right, each from the motion of a neighbour; then adds samples where the curve bends or a motion
 * was not found, until neighbours differ from a chord by at most the tolerance, relative. */
void find_curve(struct curve *c, struct worker *w, double tolerance);

/* Finds the motion at x, if needed by samples between x and its neighbours. Returns NULL if it is not found. The sample keeps its
 * address until the next one is added. */
const struct sample *reach_sample(struct curve *c, struct worker *w, double x);

/* The sample with the largest amplitude, or the largest power lost to friction, or the motion that more modes change most: contacts
 * slip by the least, and friction still takes a good part of the power. NULL if none was found. */
enum quantity { AMPLITUDE, POWER, SENSITIVITY };
const struct sample *largest_of(const struct curve *c, enum quantity of);

/* Finds the largest amplitude to rounding, by more samples at each top that is within the tolerance of the largest. */
void find_largest(struct curve *c, struct worker *w, double tolerance);

/* chosen [most > 0] out: samples that were asked for and found, spread over the curve. Returns their number. */
size_t spread_samples(const struct curve *c, size_t most, const struct sample **chosen);

/* 1 if the motion was searched; after an interruption some were not. */
int searched(const struct sample *s);

/* Follows c around folds over the band, from the lower or the upper end (--follow). Adds samples in the order of the curve: a
 * special point has asked = 0 and its kind as the message; if the following fails, the last sample is one that was not found. */
void follow_curve(struct curve *c, struct worker *w);

/* The number of motions that were searched and not found. */
size_t gaps_of(const struct curve *c);

#endif
