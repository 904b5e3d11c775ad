/* The loop over events that the methods "exact" and "event" share. A method knows the motion while contacts do what they do, a
 * phase; here it is found out when that ends, what comes then, and whether all of it kept to Coulomb's law. */
#ifndef TRIBO_EVENTS_H
#define TRIBO_EVENTS_H

#include "first_zero.h"
#include "signal.h"
#include "dynamics/decide/stick_slip.h"

#define TRIBO_SUSPECTS 8

/* Who goes along with the motion: hears of a phase that has lasted tau and ends at (t, y), before contacts are decided about,
 * and of an event once they are. ends returns a status, its message on the system's context. */
struct company {
    int (*ends)(struct company *c, double tau, double t, const double *y);
    void (*decided)(struct company *c);
};

/* How long the last phase of a kind did, 0: there was none yet; and by how much less or more than the one before. */
struct lasted {
    double time, change;
};

struct events {
    struct stick_slip stick_slip;
    struct first_zero search;

    const struct motion *motion; /* the method's, also of search */
    void *own;

    signed char *shown; /* [ncontact] slip of contacts as the observer saw it last */
    int watched;        /* the last advance had an observer, and kept shown up to date */

    struct company *company; /* NULL: nobody */
    const struct guard *met; /* what ended the phase that ends; NULL: no event did */
    int decided;             /* nothing has moved since contacts were decided about */
    int anew;                /* this run does not continue another one; the method takes note, and clears it */
    int sharp;               /* the motion is followed to rounding, whatever tolerances say */

    struct lasted *lasted; /* [ncontact][5] the phases that began as contact i turned to this slip */
    struct lasted *begun;  /* which of them this phase is; NULL if it began otherwise */

    double credit, paid, since;     /* how many more events there may be, as of when; since when it is being used up */
    double stuck;                   /* how many did so in a row in hardly any time */
    size_t idle;                    /* steps that no event ended since then, */
    double rested;                  /* which is not long ago */
    size_t suspect[TRIBO_SUSPECTS]; /* contacts of the events since credit was full */
    size_t suspects;
};

int tribo_events_create(struct events *e, tribo_driver *drv, const struct motion *motion, void *own);
void tribo_events_free(struct events *e);

/* As advance of struct method. */
int tribo_events_advance(struct events *e, tribo_driver *drv, double *t, double t1, double *y, int continues);

/* The advance of methods that have an open. */
int tribo_events_method(tribo_driver *drv, double *t, double t1, double *y, int continues);

/* The find_periodic of methods that have an open. */
int tribo_events_find_periodic(tribo_driver *drv, double t, double period, double *y);

/* guards.c: what guards of contact i are made of by a motion. */
struct watch {
    void *output;    /* the motion's, velocity or force of the contact */
    double size;     /* bound of |output| */
    double constant; /* limit without the part that the motion adds */
    double least;    /* lower bound of the limit */
    int varies;      /* 1: the motion adds a part */
};

/* For begin. Forgets all guards. */
void tribo_events_clear_guards(struct events *e);

/* Adds a guard of any kind, all of it set. */
void tribo_events_guard(struct events *e, const struct guard *guard);

/* Adds the guards of contact i by its slip: that its velocity keeps its sign; that its force, both ways, keeps below its limit,
 * unless size says so; that a contact at rest which does not hold keeps to its base, both ways. */
void tribo_events_guard_contact(struct events *e, size_t i, const struct watch *w);

/* Adds the guard of the limit of contact i, if it swings or the contact keeps its force: that the limit does not fall to 0,
 * or, of an open contact, does not rise above, or, of one that keeps its force, does not fall to that. */
void tribo_events_guard_limit(struct events *e, size_t i, const struct watch *w);

/* Marks for the decision which contact stops, or has reached its limit, by an event. */
void tribo_events_mark(struct stick_slip *m, const struct guard *event);

/* Takes the size of velocities, and excess and backslip of the driver, from the guards of a phase that lasted `when`. */
void tribo_events_learn(struct events *e, tribo_driver *drv, int brief, double when);

#endif
