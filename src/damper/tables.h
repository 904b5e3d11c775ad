/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_TABLES_H
#define DAMPER_TABLES_H

#include "curve.h"
#include "structure.h"

/* The files of a run: folder, and how their names begin. */
struct tables {
    const char *out, *name;
    FILE *values;
    const char *limit; /* the head of the column of limits */
    int followed;      /* 1: tables of curves have a column `stable` (--follow) */
    size_t motions;    /* found, in tables */
    const char *plot;  /* format of pictures */
    FILE *script;      /* NAME-plot.gp, which draws them; NULL: none */
};
struct tables open_tables(const struct options *o);
void close_tables(struct tables *t);

/* The file NAME-what.ending. */
FILE *create_table(const struct tables *t, const char *what, const char *ending);
void close_table(const struct tables *t, FILE *file, const char *what, const char *ending);

/* Writes NAME.key and the value to values-NAME.txt. */
void write_result(const struct tables *t, const char *key, double value);

/* A table of motions: its head, and a line for a motion. y: the record, with powers and shares of rest of contacts, and outputs;
 * y and d NULL: without these. */
void write_motion_head(const struct tables *t, FILE *file, const struct damper *d);
void write_motion(FILE *file, const struct motion *m, const double *y, const struct damper *d);

/* NAME-what.csv: the motions of curves, a blank line between curves. */
void write_curves(struct tables *t, const char *what, const struct curve *c, size_t count, const struct damper *d);

void write_frequencies(const struct tables *t, const struct damper *d, const char *given);

/* Over a band: frequency, amplitudes without friction and with all contacts stuck. */
void write_linear(const struct tables *t, const struct damper *d, const struct range *band);

/* NAME-what.csv: three periods of the motion that begins with y, with velocity, force, slip and displacement of each contact. */
void write_history(const struct tables *t, struct worker *w, const struct motion *m, const double *y, const char *what);

/* NAME-what.vtk, legacy format of VTK: displacements of the whole structure in that motion, at phases in degrees of the loads'
 * period. Points are the nodes that have a row, in ascending order; vectors are named displacement_PHASE. */
void write_field(const struct tables *t, const struct structure *s, const struct list *phases, struct worker *w,
                 const struct motion *m, const double *y, const char *what);

/* Pictures of the tables by gnuplot. */

/* Opens NAME-plot.gp; ends the program if gnuplot cannot be run. */
void open_plots(struct tables *t);

/* Amplitude and power over the limit, of NAME-curve.csv; amplitude over frequency for count limits, of NAME-family.csv,
 * NAME-linear.csv and, with best > 0, NAME-best.csv; frequency and damping ratio over the amplitude, of NAME-backbone.csv; force
 * of each contact over its displacement in the last period, of NAME-what.csv. */
void plot_curve(const struct tables *t);
void plot_family(const struct tables *t, const double *limit, size_t count, double best);
void plot_backbone(const struct tables *t);
void plot_loops(const struct tables *t, size_t contacts, double limit, const char *what);

/* Closes NAME-plot.gp and runs it. */
void draw_plots(const struct tables *t);

#endif
