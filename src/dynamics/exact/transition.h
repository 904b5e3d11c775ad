/* The derivative of the end state of a phase of method "exact" by the start state. */
#ifndef TRIBO_MODAL_TRANSITION_H
#define TRIBO_MODAL_TRANSITION_H

#include "modal.h"

/* Returns the doubles of workspace needed. */
size_t tribo_modal_transition_room(const tribo_system *sys, size_t columns);

/* A phase of length tau: structure h, and re + i im = e^{lambda tau} for all perturbations. */
struct modal_phase {
    const struct modal *h;
    double tau, *im; /* [exponents] */
    double re[];     /* [exponents] */
};

/* Returns NULL if out of memory. tribo_modal_phase_free takes NULL. */
struct modal_phase *tribo_modal_phase_create(const struct modal *h, double tau);
void tribo_modal_phase_free(struct modal_phase *phase);

/* Moves perturbations v [2 ndof + compliance.count][columns] of the state from the start of the phase to the end. */
void tribo_modal_transition(const struct modal_phase *phase, const tribo_system *sys, size_t columns, double *v, double *work);

#endif
