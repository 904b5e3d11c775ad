/* SPDX-License-Identifier: BSD-3-Clause */
/* The reference systems under Coulomb's law itself, for the methods that have no epsilon. */
#ifndef TRIBO_TESTS_COULOMB_H
#define TRIBO_TESTS_COULOMB_H

#include "run.h"

#define MOST_STATES 257

/* What a run is known to lead to: dissipation between two times, or (before < 0) the state at the end. */
struct reference {
    const char *name;
    tribo_system *(*create)(void);
    double start[2]; /* q_0, q'_0 */
    double before, end;
    double want[4];
    size_t count; /* values known */
};

extern const struct reference references[];
#define REFERENCES 7

/* What a run took. */
struct effort {
    size_t steps, evaluations, events;
};

/* Largest error of the values known, relative for dissipation. effort out, or NULL. */
double reference_error(const struct reference *r, const char *method, double dt, double tolerance, struct effort *effort);

tribo_driver *driver_relative(tribo_system *sys, const char *method, double dt, double abstol, double reltol);

/* One mass, one contact, no load yet. */
tribo_system *block(double mass, double stiffness, double limit);

/* Events and steps as an observer sees them, in order. */
#define MOST_SEEN 4096
struct log {
    size_t dimension, calls, events;
    double t[MOST_SEEN], y[MOST_SEEN][8]; /* at events, the first values of the state */
    double last;
};
int log_event(const tribo_moment *moment, void *log);

#endif
