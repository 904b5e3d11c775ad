/* SPDX-License-Identifier: BSD-3-Clause */
/* The motion between two events, a phase, as the loop over events and the search for the first event know it: one const table
 * for each method, and `own`, the method's own data, with which all functions are called. */
#ifndef TRIBO_MOTION_H
#define TRIBO_MOTION_H

#include <stddef.h>

struct guard;
struct signal;

/* What moves perturbations [columns] of a phase besides their initial values: column j has q'' += B force + inertia_j q'' +
 * damping_j AC q', q' and q'' of the motion in the phase that ends. force [ncontact][columns]: of rigid contacts, constant.
 * inertia, damping [columns], or both NULL: 0. */
struct source {
    const double *force, *inertia, *damping;
};

struct motion {
    /* Begins a phase at (t, y) that lasts *reach, or lowers *reach, and sets the guards. Returns a status, its message on the
     * system's context. */
    int (*begin)(void *own, double t, const double *y, double *reach);
    /* Sets the middle samples of guards [count] at tau into the phase. */
    void (*look)(void *own, double tau, size_t count, struct guard *const *guard);
    /* Sets size and bend of all guards from tau on; returns the time from which smaller bounds are worth finding. */
    double (*bound)(void *own, double tau);
    /* Sets to = the state at tau into the phase that began with from; to may be from. */
    void (*state)(void *own, double tau, const double *from, double *to);
    /* Returns the data of the phase, which ends after tau, that transition needs later, until release; NULL if out of memory.
     * keep NULL: phases are not kept. */
    void *(*keep)(void *own, double tau);
    void (*release)(void *phase);
    /* Moves perturbations v [2 ndof][columns] of the state by tau in a phase that was kept; in the one that ends if phase is
     * NULL. Projects them first so that contacts at rest stay there. source: NULL, or what moves them in the phase. Returns a
     * status, its message on the system's context. */
    int (*transition)(void *own, const void *phase, double tau, size_t columns, double *v, const struct source *source);
    /* Sets to = c'y, c [2 ndof], in the phase that lasts tau and ends with the state end. Returns a status, likewise. */
    int (*signal)(void *own, const double *c, double tau, const double *end, struct signal *to);
    /* Returns the energy that sliding contact i dissipated in the phase that lasted tau, its force counted once. */
    double (*work)(void *own, size_t i, double tau);
};

#endif
