/* The derivative of a motion by the state that it began with, as the steps in which perturbations of the state move: phases
 * (events.h) and jumps at events. It is applied to a few perturbations, or to all, which makes a matrix. */
#ifndef TRIBO_DERIVATIVE_H
#define TRIBO_DERIVATIVE_H

#include "dynamics/events/events.h"

/* A phase, or, with phase NULL and no tau, jumps. */
struct derivative_step {
    void *phase;
    double tau;
    size_t first, jumps; /* first: where rows and columns of the jumps are in number */
};

struct derivative {
    size_t users;
    struct events *events;
    const tribo_system *sys;
    size_t steps, room;
    struct derivative_step *step;
    signed char *slip; /* [room][ncontact] in the phases */
    size_t numbers, number_room;
    double *number;      /* [jumps][2 ndof] rows and [ndof][jumps] columns of jumps */
    unsigned char *rests; /* [ncontact] 1: the contact is at rest in all phases */
    double *matrix;      /* [2 ndof][2 ndof] once it is found: in coordinates of the energy norm (period_map.h), else NULL */
};

/* Without steps, for one user; NULL if out of memory. tribo_derivative_free takes NULL, and lets other users keep theirs. */
struct derivative *tribo_derivative_create(struct events *e, const tribo_system *sys);
void tribo_derivative_free(struct derivative *d);

/* Removes all steps and the matrix. */
void tribo_derivative_clear(struct derivative *d);

/* Adds the phase of d->events that has lasted tau; and jumps of q'' of an event, column [ndof][jumps] times row
 * [jumps][2 ndof] times perturbation, all rows before all columns. Return 0 if out of memory. */
int tribo_derivative_add_phase(struct derivative *d, double tau, const signed char *slip);
int tribo_derivative_add_jumps(struct derivative *d, size_t jumps, const double *row, const double *column);

/* Moves perturbations v [2 ndof][columns] by the steps from `first` on. Returns a status, its message on the system's context. */
int tribo_derivative_apply(const struct derivative *d, size_t first, size_t columns, double *v);

/* 1 if a contact is at rest in all phases. */
int tribo_derivative_rests(const struct derivative *d);

#endif
