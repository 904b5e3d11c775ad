/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_MOTION_H
#define DAMPER_MOTION_H

#include "damper.h"

/* The steady motion at one limit and one frequency of the load. Powers are means over a period. */
struct motion {
    double limit, hz, amplitude;
    double friction, damped, input; /* lost to friction, lost to damping, put in by the loads */
    size_t periods;                 /* that were integrated to find it */
    int found;                      /* 0: numbers mean nothing, and message says why */
    int stable;                     /* points of followed curves: 1: stable, 0: unstable, -1: special, or not known */
    char message[200];              /* an error; if found: a warning, the kind of a special point, or empty */
};

/* One that computes, with a copy of the system: belongs to one thread. */
struct worker {
    const struct damper *d;
    tribo_system *sys;
    double at;             /* value of --limits that sys is made for, with normal directions */
    tribo_driver *drv;     /* "auto"; NULL with a normal direction of a contact in a plane */
    tribo_driver *marcher; /* of driver_at; NULL: none */
    int march;             /* steady motions are found by marching */
    size_t dimension;
    double *limit; /* [rows] */
    double *each;  /* [rows] workspace: a quantity of each contact */
    double *c;     /* [2 modes] workspace: coefficients of a signal c'[q, q'], those of q' are 0 */
};
struct worker create_worker(const struct damper *d, int march);
void free_worker(struct worker *w);

/* Loads the system for a limit and a frequency. */
void set_point(struct worker *w, double limit, double hz);

/* A driver for a limit and a frequency, which belongs to the worker: drv if there is one, else one that marches. */
tribo_driver *driver_at(struct worker *w, double limit, double hz);

/* Finds it from the state guess, or from rest if that is NULL. y out, if found: its record. */
struct motion find_motion(struct worker *w, double limit, double hz, const double *guess, double *y);

/* Sets m->found = 1 with status 0, else m->message to the error of w->drv. */
void set_outcome(struct motion *m, int status, const struct worker *w);

/* Measures the periodic motion that w->drv found last, or the point of a curve during its callback, of frequency m->hz: sets
 * amplitude and powers of m and the record y behind the state, except shares for which contacts have lifted off. Returns a
 * status. */
int measure_motion(struct worker *w, struct motion *m, double *y);

/* Follows the motion for a period 1/hz from the state in the record y, after set_point with this hz; sets shares of the period
 * for which contacts have lifted off in y. Returns a status. */
int measure_openings(struct worker *w, double hz, double *y);

/* Motions that are found by themselves, each by a worker of its own; guess as above. Sets motion. */
struct task {
    const struct damper *d;
    int march;
    double limit, hz;
    const double *guess;
    struct motion motion;
};
void run_tasks(size_t threads, struct task *task, size_t count);

/* By time integration, the law being that of the context (march.c). */

/* Ends the program if a period of this frequency would take too many steps. */
void check_steps(const struct damper *d, double hz);

/* Runs from y until the motion repeats itself. y [record] out: the record of the motion. */
struct motion march(struct worker *w, double limit, double hz, double *y);

/* The driver that does: set to this limit and frequency. */
tribo_driver *create_marcher(struct worker *w, double limit, double hz);

#endif
