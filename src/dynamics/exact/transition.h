/* The derivative of a phase of method "exact" by the state that it begins with. */
#ifndef TRIBO_MODAL_TRANSITION_H
#define TRIBO_MODAL_TRANSITION_H

#include "modal.h"

/* So many numbers of workspace does it take. */
size_t tribo_modal_transition_room(const tribo_system *sys, size_t columns);

/* Moves perturbations v [2 ndof][columns] of the state by tau. */
void tribo_modal_transition(const struct modal *h, const tribo_system *sys, double tau, size_t columns, double *v, double *work);

#endif
