/* The derivative of a step of method "event" by the state that it begins with. */
#ifndef TRIBO_SERIES_TRANSITION_H
#define TRIBO_SERIES_TRANSITION_H

#include "dynamics/decide/stick_slip.h"

/* How forces of sliding contacts grow with their velocities, by limits that fall: powers of the time since the step began. */
struct slopes {
    size_t terms; /* 0: they do not */
    double *term; /* [terms][ncontact] */
};

/* Accelerations of perturbed states, -P AK q - P AC q' + P B s J q' + P M^-1 J'f, where P takes out what would move contacts that
 * hold, s are the slopes, and f the forces of compliant contacts, f_A' = -G_AA^-1 J_A q'. */
struct series_transition {
    size_t columns;
    unsigned char *holds; /* [ncontact] the contacts that P is for */
    int known;            /* P is known */
    size_t revision;      /* of the system */
    double *project;      /* [ndof][ndof] P, */
    double *stiff, *damp; /* -P AK and -P AC */
    double *q, *u, *next; /* [ndof][columns] terms of the series */
    size_t terms;         /* of slopes that there is room for: */
    double *push;         /* [ndof][ncontact] P B, */
    double *force;        /* [ncontact][columns] */
    double *row;          /* [terms][ncontact][columns] J q' of so many terms of the series, over and over */
    double *pull;         /* [ndof][ncontact] P M^-1 J' of compliant contacts; NULL without these */
    double *spring;       /* [ncontact][columns] terms of f */
};

void tribo_series_transition_free(struct series_transition *x);

/* Moves perturbations v [2 ndof + compliant contacts][columns] of the state by tau, contacts that hold in m being held. columns
 * are the same in every call, and so are the terms of slopes, or 0. Returns a status, its message on the system's context. */
int tribo_series_transition(struct series_transition *x, struct stick_slip *m, const tribo_system *sys,
                            const struct slopes *slopes, double tau, size_t columns, double *v);

#endif
