/* Runs of steps of central differences of at most 4 degrees of freedom and 4 contacts, which may share bodies: all matrices are
 * small squares, and loads, bases and limits are found for all steps of a run at once.
 *
 * Friction over a step is the solution of min 1/2 p'Rp + v'p with |p| <= time limit, where v are the velocities of the
 * contacts without friction and p the impulses. The first guess is that contacts hold and slide as in the step before: its p
 * is the solution if each is within its bounds, and no contact that slides moves in the direction of its friction. Else
 * contacts change between the two as in numerics/box/small.h; if that takes too many rounds, the step is left to the caller. */
#ifndef TRIBO_FEW_BODIES_H
#define TRIBO_FEW_BODIES_H

#include "dynamics/driver.h"
#include "numerics/box/small.h"

/* The most degrees of freedom, and the most contacts. */
enum { FEW = SMALL };

struct few_bodies {
    int fits;        /* 1: runs can be taken with the settings */
    size_t revision; /* of the system to which all of this belongs; SIZE_MAX: none */
    size_t n, c;     /* degrees of freedom, contacts */
    double stiffness[FEW * FEW], damping[FEW * FEW], direction[FEW * FEW], response[FEW * FEW]; /* [n][n], [c][n], [n][c] */
    double r[FEW * FEW], inverse[FEW * FEW], part[FEW]; /* see numerics/box/small.h; of r and inverse [c][c] */
    unsigned inverse_of;
    double tally[FEW];
    struct snap snap[1 << FEW][FEW]; /* [set that holds][snaps] in the order in which they are applied */
    size_t snaps[1 << FEW];
    signed char at[FEW]; /* in the step before: FREE: holds; AT_LOWER, AT_UPPER: slides, with friction -limit, limit */
    /* of the steps of a run: durations over which forces act; lengths, that of the step before the run first; and what acts */
    double time[RUN], h[RUN + 1];
    double load[FEW][RUN], base[FEW][RUN], limit[FEW][RUN];
};

/* A motion between steps: displacements at t and velocities half a step before [ndof], velocities of contacts [ncontact],
 * dissipated energy, and the length of the step before. */
struct few_motion {
    double *q, *u, *v, energy, last;
};

/* Takes the system's settings, if they have changed. Returns fits. */
int tribo_few_take(struct few_bodies *b, tribo_system *sys);

/* Takes steps between the times t [count + 1], count <= RUN. Returns the number of steps taken, after which the motion is finite;
 * if it is less than count, the next step is for others. */
size_t tribo_few_run(struct few_bodies *b, tribo_system *sys, size_t count, const double *t, struct few_motion *m);

#endif
