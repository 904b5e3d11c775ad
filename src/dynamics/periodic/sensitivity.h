/* SPDX-License-Identifier: BSD-3-Clause */
/* Perturbations along the periodic motion found last that are its derivatives by parameters. */
#ifndef TRIBO_SENSITIVITY_H
#define TRIBO_SENSITIVITY_H

#include "shooting.h"

/* An extreme so far, and its derivatives. */
struct extreme {
    double value;
    int corner; /* 1: at an event at which the signal has a corner */
    double *by; /* [columns] */
};

struct second;

/* Observer of a span. */
struct sensitivity {
    struct company company;
    struct period_map *map;
    struct variation variation;
    struct derivative steps; /* of this span */
    struct parameters by;
    size_t columns, n, contacts;
    const int *kind;
    int moves;             /* 1: a kind has inertia or damping */
    const double *c;       /* [n] coefficients of the state; NULL: no extremes */
    struct second *second; /* derivatives of a multiplier, found in the last following; or NULL */
    int last;              /* 1: this is the last following */
    struct extreme least, most;
    double *from, *now;      /* [n + 1] state at the start of the phase; workspace */
    double *start, *end;     /* [n][columns] perturbations at the start; workspace */
    double *moved;           /* [n][columns] perturbations at an extreme */
    double *rise, *moved_by; /* members of by */
    double *way;             /* [contacts][columns] J q + G f of perturbations at the end of the last phase */
    double *force;           /* [contacts][columns] workspace */
    double *energy, *path;   /* [contacts] dissipated energy; [contacts][columns] derivative of the length of slip; or NULL */
    signed char *slip;       /* [contacts] slip in the last phase */
    int begun;               /* 1: there was a phase */
};

/* Finds the derivatives by index [columns] of kinds d->kind, and writes those of extremes, energies and the state, as
 * tribo_driver_period_derivatives. d: columns, kind, c and second are set, the other members are zero; they are freed. The system
 * is that of the motion found. Returns a status, its message on drv. */
int tribo_sensitivity_find(struct sensitivity *d, tribo_driver *drv, const size_t *index, double *extremes, double *energy,
                           double *y);

/* multiplier_derivatives.c: of d->second, after d itself: a phase that lasted tau and ended at (t, y), which returns a status;
 * the decision at an event. */
int tribo_second_phase(struct second *x, double tau, double t, const double *y);
void tribo_second_event(struct second *x);

#endif
