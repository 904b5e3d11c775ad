/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_TABLES_H
#define DAMPER_TABLES_H

#include "curve.h"

/* The files of a run: folder, and how their names begin. */
struct tables {
    const char *out, *name;
    FILE *values;
    const char *limit; /* the head of the column of limits */
    size_t motions;   /* found, in tables */
    const char *plot; /* format of pictures */
    FILE *script;     /* that draws them; NULL: none */
};
struct tables open_tables(const struct options *o);
void close_tables(struct tables *t);

/* NAME-what.csv */
FILE *create_table(const struct tables *t, const char *what);
void close_table(const struct tables *t, FILE *file, const char *what);

/* Writes NAME.key and the value to values-NAME.txt. */
void write_result(const struct tables *t, const char *key, double value);

/* A table of motions: its head, and a line for each of a curve. y: the record, with powers and shares of rest of contacts, and
 * outputs; both NULL: without these. */
void write_motion_head(const struct tables *t, FILE *file, const struct damper *d);
void write_motion(FILE *file, const struct motion *m, const double *y, const struct damper *d);
void write_curve(struct tables *t, FILE *file, const struct curve *c, const struct damper *d);

void write_frequencies(const struct tables *t, const struct damper *d, const char *given);

/* Over a band: frequency, amplitudes without friction and with all contacts stuck. */
void write_linear(const struct tables *t, const struct damper *d, const struct range *band);

/* Three periods of the motion that begins with y, with velocity, force, slip and displacement of each contact. */
void write_history(const struct tables *t, struct worker *w, const struct motion *m, const double *y, const char *what);

#endif
