/* The derivative of a step of method "event" by the state that it begins with. */
#ifndef TRIBO_SERIES_TRANSITION_H
#define TRIBO_SERIES_TRANSITION_H

#include "dynamics/decide/stick_slip.h"

/* Derivatives of sliding forces by their velocities, of limits that fall, in powers of the time since the step began. */
struct slopes {
    size_t terms; /* 0: they do not */
    double *term; /* [terms][ncontact] */
};

/* Accelerations of perturbed states, -P AK q - P AC q' + P B s J q' + P M^-1 J'f. P projects onto accelerations that leave
 * holding contacts at rest; s: slopes; f: forces of compliant contacts, f_A' = -G_AA^-1 J_A q'. */
struct series_transition {
    size_t columns;       /* of perturbations */
    unsigned char *holds; /* [ncontact] the holding contacts of P */
    int known;            /* 1: P is known */
    size_t revision;      /* of the system */
    double *project;      /* [ndof][ndof] P */
    double *stiff, *damp; /* [ndof][ndof] -P AK and -P AC */
    double *q, *u, *next; /* [ndof][columns] terms of the series */
    size_t terms;         /* room for terms of slopes */
    double *push;         /* [ndof][ncontact] P B */
    double *force;        /* [ncontact][columns] */
    double *row;          /* [terms][ncontact][columns] J q' of the last terms of the series, cyclically */
    double *pull;         /* [ndof][ncontact] P M^-1 J' of compliant contacts; NULL without these */
    double *spring;       /* [ncontact][columns] terms of f */
};

void tribo_series_transition_free(struct series_transition *x);

/* Moves perturbations v [2 ndof + compliant contacts][columns] of the state by tau, with the holding contacts of m held. columns
 * is the same in every call; slopes->terms too, or 0. Returns a status, its message on the system's context. */
int tribo_series_transition(struct series_transition *x, struct stick_slip *m, const tribo_system *sys,
                            const struct slopes *slopes, double tau, size_t columns, double *v);

#endif
