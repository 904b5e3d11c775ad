/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_PLOT_H
#define DAMPER_PLOT_H

#include "tables.h"

/* Pictures of the tables by gnuplot: NAME-plot.gp collects a part for each of them, and stays beside the tables. */

/* Opens NAME-plot.gp; ends the program if gnuplot cannot be run. format: png or svg. */
FILE *open_plots(const struct options *o);

/* Amplitude and power over the limit, of NAME-curve.csv; over frequency for count limits, of NAME-family.csv, NAME-linear.csv
 * and, with best > 0, NAME-best.csv; force of each contact over its displacement in the last period, of NAME-what.csv. */
void plot_curve(const struct tables *t);
void plot_family(const struct tables *t, const double *limit, size_t count, double best);
void plot_loops(const struct tables *t, size_t contacts, double limit, const char *what);

/* Closes NAME-plot.gp and runs it. */
void draw_plots(const struct tables *t);

#endif
