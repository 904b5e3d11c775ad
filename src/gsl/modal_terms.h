/* The terms of a modal motion: exponentials and harmonics, with two derivatives. */
#ifndef TRIBO_MODAL_TERMS_H
#define TRIBO_MODAL_TERMS_H

#include "modal_motion.h"

/* Zeros for what stands after the last term: in the last of those that are done side by side, before terms are set. */
void tribo_modal_terms_clear(struct modal_motion *x);

/* w = z at t0; or at t0 + tau, without resonances. */
void tribo_modal_terms_rest(struct modal_motion *x);
void tribo_modal_terms_go(struct modal_motion *x, double tau);

#endif
