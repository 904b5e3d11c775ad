/* Coulomb's law itself, for the event-located drivers: which contacts stick, which way the others slide, and what changes that.
 */
#ifndef TRIBO_MODES_H
#define TRIBO_MODES_H

#include "driver.h"
#include "search.h"

struct modes {
    tribo_context *judge; /* a clone of the system's context under Coulomb's law */
    tribo_context *hold;  /* another one, that finds the forces of the contacts that hold, and only theirs, as f_eq for v = 0 */
    signed char *mode;    /* [ncontact] 0 at rest, +1 and -1 sliding in that direction, 2 open */
    double *limit, *limit_rate; /* [ncontact] */
    unsigned char *holds; /* [ncontact] 1: at rest, and needed to keep the contacts at rest where they are; the other ones rest by
                             themselves */
    double *force;        /* [ncontact] after tribo_modes_decide: friction */
    double *acceleration; /* [ndof] and q'' */
    double *v, *a;        /* [ncontact] relative velocity, and acceleration without friction */
    double *base, *noise; /* [ncontact] b(t); what of v may be rounding */
    double *diagonal;     /* [ncontact] R_ii */
    double *rate, *lo, *hi; /* [ncontact] workspace */
    double *slope;          /* [ncontact] rate of a, if any contact is weak */
    double *jerk, *size;   /* [ORDERS][ndof], [1 + ORDERS][ndof] workspace: derivatives of the acceleration; their parts' sizes */
    signed char *weak;     /* [ncontact] at rest just at its limit: 1 and staying there, 2 going back inside */
    unsigned char *rested; /* [ncontact] 1: was at rest when last decided about: its velocity starts from zero */
    double *recent;        /* [patience] times of the last events */
    int uncoupled;         /* R is diagonal */
    int simple;            /* no contact has more than one degree of freedom */
    size_t contacts;
    double *still;       /* [ncontact] zeros */
    signed char *before; /* [ncontact] what find_holds saw last */
    int fresh;           /* it saw nothing yet */
    size_t *at;          /* [ncontact] workspace of find_holds, and for as many as room contacts at rest: */
    size_t room, *order;
    double *block;
    unsigned char *last;
    size_t patience, events;
};

/* TRIBO_OK or a failure with its message on the system's context. tribo_modes_free takes what failed too. */
int tribo_modes_create(struct modes *m, tribo_system *sys);
void tribo_modes_free(struct modes *m);

/* Takes limits from the system, and, unless it continues, the modes from the state: contacts whose velocity is zero to rounding
 * are at rest. */
int tribo_modes_start(struct modes *m, tribo_system *sys, double t, double *y, int continues);

/* Decides about the contacts at rest: min 1/2 f'Rf + a'f, |f| <= limit, says which hold and which slide off; the same problem for
 * the rates of the forces does so for those that are just at their limit. Sets mode, holds, force and acceleration. */
int tribo_modes_decide(struct modes *m, tribo_system *sys, double t, double *y);

/* f of the contacts that hold, R_II f_I = -a_I; zero for the others. */
int tribo_modes_balance(struct modes *m, const double *a, double *f);

/* Takes what is not zero in J x - base for the contacts at rest out of x [ndof]. */
int tribo_modes_hold(struct modes *m, const tribo_system *sys, const double *base, double *x);

/* v_i in a state, at the time that tribo_modes_decide was last called for. */
double tribo_modes_velocity(const struct modes *m, const tribo_system *sys, size_t i, const double *y);

/* A phase has ended at (t, y), where search left off: with an event, or without (NULL). Brings the velocities of
 * contacts at rest to zero and decides anew. Counts events; fails if there have been too many of them in too short a time,
 * shortest being the structure's shortest. The message of a failure is on the driver. */
int tribo_modes_proceed(struct modes *m, tribo_driver *drv, const struct search *search, const struct guard *event, double t,
                        double *y, double shortest);

#endif
