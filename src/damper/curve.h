#ifndef DAMPER_CURVE_H
#define DAMPER_CURVE_H

#include "motion.h"

/* Steady motions over the frequency of the load at one limit, or over the limit at one frequency. */
struct sample {
    double x; /* Hz, or the logarithm of the limit */
    struct motion motion;
    double *y; /* [record] the record, if it was found */
    int asked; /* one of those that the user wanted; others were added */
};

struct curve {
    int over_limit; /* else over the frequency */
    double fixed;   /* the other one */
    struct sample *sample;
    size_t count, room; /* ascending in x */
    size_t record; /* numbers in the record of a motion */
};

struct curve create_curve(int over_limit, double fixed, size_t record);
void free_curve(struct curve *c);

/* Adds a place where a motion is to be found; one that is there already is asked for. */
void ask_sample(struct curve *c, double x, int asked);

/* Finds the motions from left to right, each from a neighbour's; then more of them wherever the curve bends or was not found,
 * until neighbours differ from a chord by no more than the tolerance, relative. */
void find_curve(struct curve *c, struct worker *w, double tolerance);

/* Finds the motion at x, with more of them on the way there if it takes that; NULL if it is not found. The sample stays where it
 * is until the next one is added. */
const struct sample *reach_sample(struct curve *c, struct worker *w, double x);

/* The sample with the largest amplitude; NULL if none was found. */
const struct sample *largest_of(const struct curve *c);

/* Finds the largest amplitude to rounding: more samples about every top that may be it, samples being off by the tolerance. */
void find_largest(struct curve *c, struct worker *w, double tolerance);

/* At most so many of the samples that were asked for and found, spread over the curve, into chosen [most]; returns how many. */
size_t spread_samples(const struct curve *c, size_t most, const struct sample **chosen);

/* Whether it was found, or not: after an interruption there are others. */
int looked_for(const struct sample *s);

/* How many were looked for and not found. */
size_t gaps_of(const struct curve *c);

#endif
