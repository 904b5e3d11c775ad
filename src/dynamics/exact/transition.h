/* The derivative of a phase of method "exact" by the state that it begins with. */
#ifndef TRIBO_MODAL_TRANSITION_H
#define TRIBO_MODAL_TRANSITION_H

#include "modal.h"

/* So many numbers of workspace does it take. */
size_t tribo_modal_transition_room(const tribo_system *sys, size_t columns);

/* A phase that has lasted tau: its structure, and e^{lambda tau}, which all perturbations share. */
struct modal_phase {
    const struct modal *h;
    double tau, *im; /* [exponents] */
    double re[];     /* [exponents] */
};

/* NULL if out of memory. tribo_modal_phase_free takes NULL. */
struct modal_phase *tribo_modal_phase_create(const struct modal *h, double tau);
void tribo_modal_phase_free(struct modal_phase *phase);

/* Moves perturbations v [2 ndof][columns] of the state through the phase. */
void tribo_modal_transition(const struct modal_phase *phase, const tribo_system *sys, size_t columns, double *v, double *work);

#endif
