/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_STUDY_H
#define DAMPER_STUDY_H

#include "model.h"

/* A run. */
struct study {
    const struct options *options;
    struct model *model;
    const struct damper *damper; /* that of the model */
    struct tables *tables;
    size_t gaps; /* points that were not found */
};

/* If the model error is too large, takes twice the modes and empties the tables. Returns 1 if it did. */
int begin_again(struct study *s, double error);

/* Modes and model, before a study: to be shown again where there are more of them. */
void show_model(const struct study *s);

/* The response over the limits at one frequency, the limit of most power, and the motion there. */
void study_limits(struct study *s);

/* The response over a band of frequencies for every limit, and the limit with the least of the largest amplitudes. */
void study_band(struct study *s);

/* Limit k of the geometric series. */
double limit_of(const struct range *limits, size_t k);

/* The motions without friction and with all contacts stuck, beside their closed forms. */
void check_extremes(const struct study *s, double hz);

/* Finds a few points of each curve also with twice the modes, and prints the changes. Returns the model error, or NaN. */
double show_model_error(const struct study *s, const struct curve *c, size_t curves);

/* Some points of a curve by marching: writes the table, prints the differences; or prints why this was not done. */
void check_by_marching(const struct study *s, const struct curve *c);

#endif
