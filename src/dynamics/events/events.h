/* SPDX-License-Identifier: BSD-3-Clause */
/* The loop over events of the methods "exact" and "event": phase after phase of the method's motion, each until its first
 * event, and the decision there. */
#ifndef TRIBO_EVENTS_H
#define TRIBO_EVENTS_H

#include "first_zero.h"
#include "signal.h"
#include "dynamics/decide/stick_slip.h"

#define TRIBO_SUSPECTS 8

/* An observer of phases. ends: a phase that lasted tau has ended at (t, y), before the decision; returns a status, its message
 * on the system's context. decided: the decision at an event is done; or NULL. */
struct company {
    int (*ends)(struct company *c, double tau, double t, const double *y);
    void (*decided)(struct company *c);
};

/* Length of the last phase of a kind, 0 if there was none, and its difference to the one before. */
struct lasted {
    double time, change;
};

struct events {
    struct stick_slip stick_slip;
    struct first_zero search;
    const struct motion *motion; /* the method's, also of search */
    void *own;                   /* the motion's */

    signed char *shown;      /* [ncontact] slip as shown to the observer last */
    int watched;             /* 1: the last advance had an observer, and kept shown up to date */
    struct company *company; /* NULL: none */
    const struct guard *met; /* the guard that ended the phase; NULL: none */
    double when;             /* length of the phase */
    int brief;               /* 1: the phase had constant accelerations */
    int decided;             /* 1: no motion since the last decision */
    int anew;                /* 1: the run does not continue another one; read and cleared by the method */
    int sharp;               /* 1: the motion is followed to rounding, regardless of tolerances */

    struct lasted *lasted; /* [ncontact][5] phases that began as contact i turned to this slip */
    struct lasted *begun;  /* the entry of this phase; NULL if it began otherwise */

    double fastest; /* highest frequency; 1/(length of the advance) if there is none */
    double begin;   /* time at the start of the advance; the next output is at begin + outputs drv->output */
    double outputs;

    double credit;                  /* number of events that may follow at once */
    double paid;                    /* time of the last event */
    double since;                   /* time of the last full credit */
    double stuck;                   /* events in a row without headway */
    size_t idle;                    /* steps without event since rested */
    double rested;                  /* time, at most 1/(16 fastest) ago */
    size_t suspect[TRIBO_SUSPECTS]; /* [suspects] contacts of the events since the credit was full */
    size_t suspects;
};

int tribo_events_create(struct events *e, tribo_driver *drv, const struct motion *motion, void *own);
void tribo_events_free(struct events *e);

/* As advance of struct method. */
int tribo_events_advance(struct events *e, tribo_driver *drv, double *t, double t1, double *y, int continues);

/* The advance of methods that have an open. */
int tribo_events_method(tribo_driver *drv, double *t, double t1, double *y, int continues);

/* The find_periodic of methods that have an open. */
int tribo_events_find_periodic(tribo_driver *drv, struct wanted *w);

/* guards.c, for begin of a motion, which sets search.guards = 0 first: what guards of contact i are made of. */
struct watch {
    void *output;    /* the motion's, velocity or force of the contact */
    double size;     /* bound of |output| */
    double constant; /* limit without the part that the motion adds */
    double least;    /* lower bound of the limit */
    int varies;      /* 1: the motion adds a part */
};

/* Adds the guards of contact i by its slip: that its velocity keeps its sign; that its force, both ways, keeps below its limit,
 * unless size says so; that a contact at rest which does not hold keeps to its base, both ways. */
void tribo_events_guard_contact(struct events *e, size_t i, const struct watch *w);

/* Adds the guard of the limit L of contact i, if L varies: L > 0 of a closed contact, L < 0 of an open contact, L > |f| of a
 * contact with constant f. A normal has the guard of L = N, N < 0 where it is open; the contacts of a normal have none of L. A
 * contact at rest with a force f that follows L has the guard 2 L > L(0) - |f(0)|: f has turned, and is at L again. */
void tribo_events_guard_limit(struct events *e, size_t i, const struct watch *w);

/* Takes the size of velocities, and excess and backslip of the driver, from the guards of the phase that ended. */
void tribo_events_learn(struct events *e, tribo_driver *drv);

#endif
