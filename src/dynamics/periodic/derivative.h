/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivative of a motion by its initial state, as steps that move perturbations [n] of the state, n = tribo_system_energy(sys):
 * phases (events.h) and jumps at events. Applied to a few perturbations, or to n units for the matrix. */
#ifndef TRIBO_DERIVATIVE_H
#define TRIBO_DERIVATIVE_H

#include "dynamics/events/events.h"

/* A phase, or a jump [q'', f'] += column (row v)/slope, f: forces of compliant contacts. */
struct derivative_step {
    void *phase; /* of motion->keep; NULL: not kept */
    double tau;
    signed char *slip; /* [ncontact] slip in the phase; NULL: a jump */
    double *jump;      /* row/slope [n], column [n - ndof] */
};

struct derivative {
    struct events *events;
    const tribo_system *sys;
    size_t steps, room;
    struct derivative_step *step;
    double *matrix; /* [n][n] in coordinates of the energy norm (period_map.h); NULL until computed */
};

/* Removes all steps and the matrix; the next steps are of a motion of e. free: takes a zeroed d. */
void tribo_derivative_begin(struct derivative *d, struct events *e, const tribo_system *sys);
void tribo_derivative_free(struct derivative *d);

/* Append the phase of d->events that lasted tau, and a jump: row [n], column [n - ndof]. Both return 0 if out of memory. */
int tribo_derivative_add_phase(struct derivative *d, double tau, const signed char *slip);
int tribo_derivative_add_jump(struct derivative *d, const double *row, double slope, const double *column);

/* Moves perturbations v [n][columns] by the steps from `first` on. Returns a status, its message on the system's context. */
int tribo_derivative_apply(const struct derivative *d, size_t first, size_t columns, double *v);

/* Returns 1 if a contact is at rest in all phases. */
int tribo_derivative_rests(const struct derivative *d);

#endif
