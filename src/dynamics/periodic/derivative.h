/* Derivative of a motion by its initial state, as steps that move perturbations [n] of the state, n = tribo_system_energy(sys):
 * phases (events.h) and jumps at events. Applied to a few perturbations, or to n units for the matrix. */
#ifndef TRIBO_DERIVATIVE_H
#define TRIBO_DERIVATIVE_H

#include "dynamics/events/events.h"

/* A phase of length tau; or, with jumps > 0, phase NULL and tau 0, the jumps at an event. */
struct derivative_step {
    void *phase;
    double tau;
    size_t first, jumps; /* first: index in `number` of the rows and columns of the jumps */
};

struct derivative {
    size_t users;
    struct events *events;
    const tribo_system *sys;
    size_t steps, room;
    struct derivative_step *step;
    signed char *slip; /* [room][ncontact] slip in each phase */
    size_t numbers, number_room;
    double *number;      /* for each step of jumps: rows [jumps][n], then columns [ndof][jumps] */
    unsigned char *rests; /* [ncontact] 1: the contact is at rest in all phases */
    double *matrix;      /* [n][n] in coordinates of the energy norm (period_map.h); NULL until computed */
};

/* Returns a derivative without steps, users = 1, or NULL if out of memory. tribo_derivative_free: frees d for the last user. */
struct derivative *tribo_derivative_create(struct events *e, const tribo_system *sys);
void tribo_derivative_free(struct derivative *d);

/* Removes all steps and the matrix. */
void tribo_derivative_clear(struct derivative *d);

/* Appends the phase of d->events that lasted tau. Appends jumps of q'' at an event: (velocities of v) += column row v, row
 * [jumps][n], column [ndof][jumps]. Both return 0 if out of memory. */
int tribo_derivative_add_phase(struct derivative *d, double tau, const signed char *slip);
int tribo_derivative_add_jumps(struct derivative *d, size_t jumps, const double *row, const double *column);

/* Moves perturbations v [n][columns] by the steps from `first` on. Returns a status, its message on the system's context. */
int tribo_derivative_apply(const struct derivative *d, size_t first, size_t columns, double *v);

/* Returns 1 if a contact is at rest in all phases. */
int tribo_derivative_rests(const struct derivative *d);

#endif
