/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_STUDY_H
#define DAMPER_STUDY_H

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

/* Finds the points with both numbers of modes, unless m is whole. */
void compare_models(const struct model *m, size_t threads, struct point *point, size_t count);

/* Error over change with twice the modes: up to 2.2 on beams and plates of 5 to 20 modes. */
#define MARGIN 2.5

/* Returns the end of a printed model error: ": again with these" if take_more_modes is to take the finer modes, ": take more
 * --modes" if only the user can, "" if `error` is small. */
const char *advice(const struct model *m, double error);

/* Writes frequencies, prints the number of modes and the bound of missing displacements; prints the model error, which is
 * returned: MARGIN times the largest change of the points, and of frequencies and amplitudes with all contacts stuck; NaN if no
 * point was compared. */
void report_model(const struct tables *t, const struct model *m);
double report_error(const struct tables *t, const struct model *m, const struct point *point, size_t count);

/* A run. */
struct study {
    const struct options *options;
    struct model *model;
    const struct damper *damper; /* that of the model */
    struct tables *tables;
    size_t gaps;       /* points that were not found */
    char nothing[200]; /* why curves of --follow have no point; else empty */
};

/* At one frequency: the response over the limits, the limit of most power, and the motion there. Over a band of frequencies: the
 * response for every limit, and the limit with the least of the largest amplitudes. With more modes where the model error is too
 * large. */
void run_study(struct study *s);

/* Curves at these fixed values, over the limits at a frequency, or over the band at a limit; [count], freed by free_curves. */
struct curve *run_curves(const struct study *s, int over_limit, const double *fixed, size_t count);
void free_curves(struct curve *c, size_t count);

/* Of curves [count] without a motion that was found: the first message; "not looked for" if there is none. */
const char *first_message(const struct curve *c, size_t count);

/* The limit between low and high where the value is least, to that part of it, for a value that falls and then rises; *least is
 * the value. values: value [count] out, of limit [count]; a few at a time, for those to share the work. */
double find_least(double low, double high, double part,
                  void (*values)(void *data, const double *limit, double *value, size_t count), void *data, double *least);

/* Limit k of the geometric series. */
double limit_of(const struct range *limits, size_t k);

/* Of the curve over the limits: its table on the terminal; then the limit of most power, or the motion at the only limit, and the
 * table of the curve. */
void print_limits(struct study *s, const struct curve *c);
void study_limits(struct study *s, struct curve *c);

/* Of the curves over the band [count]: their table; then the best limit. */
void write_family(struct study *s, const struct curve *c, size_t count);
void study_band(struct study *s, const struct curve *c, size_t count);

/* Prints limit, frequency and amplitude of the folds of followed curves c [count], and the largest change of the frequencies
 * with twice the modes. */
void report_folds(const struct study *s, const struct curve *c, size_t count);

/* Frequency and damping ratio of a mode over the amplitude: table, picture, results, and their changes with twice the modes. */
void study_backbone(struct study *s);

/* Steady sliding, and the cycle of contacts on belts: history, results, and their changes with twice the modes. */
void study_cycle(struct study *s);

/* The motions without friction and with all contacts stuck, beside their closed forms. */
void check_extremes(const struct study *s, double hz);

/* Finds a few points of each curve also with twice the modes, and prints the changes. Returns the model error, or NaN. */
double show_model_error(const struct study *s, const struct curve *c, size_t curves);

/* Some points of a curve by marching: writes the table, prints the differences; or prints why this was not done. */
void check_by_marching(const struct study *s, const struct curve *c);

#endif
