#ifndef DAMPER_MOTION_H
#define DAMPER_MOTION_H

#include "damper.h"

/* The steady motion at one limit and one frequency of the load. Powers are means over a period. */
struct motion {
    double limit, hz, amplitude;
    double friction, damped, input; /* power lost to friction, lost to modal damping, and put in by the load */
    size_t periods;                 /* that were integrated to find it */
    int found;                      /* 0: numbers mean nothing, and message says why */
    char message[200];
};

/* One that computes, with a copy of the system: belongs to one thread. */
struct worker {
    const struct damper *d;
    tribo_system *sys;
    tribo_driver *drv; /* "exact"; NULL with contacts in a plane */
    int march;         /* steady motions are found by marching */
    size_t dimension;
    double *limit; /* [contacts] */
    double *c;     /* [2 modes] the displacement where the load acts is c'[q, q'] */
};
struct worker create_worker(const struct damper *d, int march);
void free_worker(struct worker *w);

/* Loads the system for a limit and a frequency. */
void set_point(struct worker *w, double limit, double hz);

/* Numbers in the record of a motion: the state at the beginning of a period, then of each contact the power lost to its friction,
 * then of each contact the share of the period for which it is at rest, then of each output the amplitude and the phase of its
 * first harmonic to the load, in degrees. Marching leaves all but the state 0. */
size_t record_of(const struct damper *d);

/* Finds it from the state guess, or from rest if that is NULL. y out, if found: its record. */
struct motion find_motion(struct worker *w, double limit, double hz, const double *guess, double *y);

#endif
