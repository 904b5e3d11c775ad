/* Runs of steps of central differences of a few degrees of freedom on a few contacts, which may share bodies: all matrices are
 * small squares, and what acts from outside is found for many steps at once.
 *
 * Friction over a step is the solution of a problem with bounds, min 1/2 p'Rp + v'p with |p| <= time limit, where v are the
 * velocities without friction and p the impulses. Contacts mostly do what they did in the step before: the p that goes with this
 * is the solution if every p is within its bounds and no velocity at the end is towards the friction that goes with it. Where
 * it is not, contacts change their places as in box.c; where this takes long, the step is left to those who can do all.
 * That R is far from singular makes the solution unique, and inverses over any set of contacts at rest good to rounding. */
#ifndef TRIBO_FEW_BODIES_H
#define TRIBO_FEW_BODIES_H

#include "dynamics/driver.h"

/* The most degrees of freedom, and the most contacts, that are few. */
enum { FEW = 4 };

/* What the velocity of degree of freedom `to` is while the contact rests: (base - rest u)/turn. No rounding is left. */
struct few_snap {
    size_t contact, to;
    double turn, rest[FEW];
};

/* What contacts did in a step. */
struct few_slip {
    unsigned resting; /* whose friction held, by bits */
    double side[FEW]; /* of the others: the sign of friction, else 0 */
};

struct few_bodies {
    int fits;        /* the settings are such that runs can be taken */
    size_t revision; /* of the system that this is about; SIZE_MAX: none */
    size_t n, c;     /* degrees of freedom, contacts */
    double stiffness[FEW][FEW], damping[FEW][FEW], direction[FEW][FEW], response[FEW][FEW], r[FEW][FEW];
    double inverse[1 << FEW][FEW][FEW]; /* of R over sets of contacts, by bits: 0 elsewhere */
    double limit[FEW], tally[FEW];
    struct few_snap snap[1 << FEW][FEW]; /* of sets of contacts at rest, by bits: in this order, */
    size_t snaps[1 << FEW];              /* so many */
    struct few_slip slip;                /* of the step before */
    /* by steps of a run: the times for which velocities go on, and those at which they are known then; the lengths, that of the
     * step before the run first; and what acts */
    double time[RUN], to[RUN], h[RUN + 1];
    double load[FEW][RUN], base[FEW][RUN], limits[FEW][RUN];
};

/* A motion as central differences leave it between steps: places, velocities [ndof], those of the contacts, what friction has
 * dissipated, and the length of the step before. */
struct few_motion {
    double *q, *u, *v, energy, last;
};

/* What steps carry on, apart from other memory: compilers keep it in registers. */
struct few_carried {
    double q[FEW], u[FEW], v[FEW], energy;
    struct few_slip slip;
};

/* What of a system there is, and of which sizes. */
struct few_parts {
    size_t n, c;
    int damped, bases, vary;
};

/* few_steps.c: the first steps of a run, as many of count as can be taken, for which all that acts is found. Returns how many. */
size_t tribo_few_steps(const struct few_bodies *b, struct few_parts has, size_t count, struct few_carried *m);

/* Takes over settings that have changed. Returns whether runs can be taken with them. */
int tribo_few_take(struct few_bodies *b, tribo_system *sys);

/* Takes steps between the times t [count + 1], count <= RUN. Returns the number of steps taken, after which the motion is finite;
 * if it is less than count, the next step is for others. */
size_t tribo_few_run(struct few_bodies *b, tribo_system *sys, size_t count, const double *t, struct few_motion *m);

#endif
