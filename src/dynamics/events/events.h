/* The loop over events that the methods "exact" and "event" share. A method knows the motion while contacts do what they do, a
 * phase; here it is found out when that ends, what comes then, and whether all of it kept to Coulomb's law. */
#ifndef TRIBO_EVENTS_H
#define TRIBO_EVENTS_H

#include "first_zero.h"
#include "signal.h"
#include "dynamics/decide/stick_slip.h"

#define TRIBO_SUSPECTS 8

/* Who goes along with the motion: hears of a phase that has lasted tau and ends at (t, y), before contacts are decided about, and
 * of an event once they are. ends returns a status, its message on the system's context. */
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

    /* the method's own */
    void *motion;
    /* Begins a phase at (t, y) that lasts *reach, or less if *reach becomes less, and sets its guards. Returns a status, its
     * message on the system's context. */
    int (*begin)(void *motion, double t, const double *y, double *reach);
    /* The state at tau into the phase that began with `from`, which `to` may be. */
    void (*state)(void *motion, double tau, const double *from, double *to);
    /* Tells the system of what it knows of t, at which the phase that state was asked for last has ended; NULL: of nothing. */
    void (*arrive)(void *motion, double t);
    /* What transition needs of the phase that ends, until it is released; NULL: phases are not kept. */
    const void *(*keep)(void *motion);
    void (*release)(const void *phase);
    /* Moves perturbations v [2 ndof][columns] of the state to tau into a phase that was kept, or, with NULL, the one that ends;
     * contacts at rest are held in it, and what would move these is taken away first. Returns a status, its message on the
     * system's context. */
    int (*transition)(void *motion, const void *phase, double tau, size_t columns, double *v);
    /* c'y, c [2 ndof], in the phase that lasts tau and ends with the state end. Returns a status, likewise. */
    int (*signal)(void *motion, const double *c, double tau, const double *end, struct signal *to);
    /* The energy that contact i, which slides, dissipated in the phase that lasted tau, if its force is counted once. */
    double (*work)(void *motion, size_t i, double tau);

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

/* The method sets its own, and search.go, .read, .bound and .motion. */
int tribo_events_create(struct events *e, tribo_driver *drv);
void tribo_events_free(struct events *e);

/* As advance of struct method. */
int tribo_events_advance(struct events *e, tribo_driver *drv, double *t, double t1, double *y, int continues);

/* The advance of methods that have an open. */
int tribo_events_method(tribo_driver *drv, double *t, double t1, double *y, int continues);

/* The find_periodic of methods that have an open. */
int tribo_events_find_periodic(tribo_driver *drv, double t, double period, double *y);

/* What a guard watches, in the method's own terms: the value is offset + output, and so many times the limit. */
struct watch {
    void *output;
    double offset, limit;
};

/* For begin: forgets the guards; and adds one of any kind, all set; or one of the velocity of contact i, which slides, or two of
 * its force, which is at rest, or two of its velocity, which may part from its base: of side * output. Or one of its limit:
 * whether the contact lifts off, or touches down, or has its limit fall to the force that it keeps. */
void tribo_events_clear_guards(struct events *e);
void tribo_events_guard(struct events *e, const struct guard *guard);
void tribo_events_guard_slip(struct events *e, size_t i, const struct watch *watch);
void tribo_events_guard_stick(struct events *e, size_t i, const struct watch *watch);
void tribo_events_guard_part(struct events *e, size_t i, const struct watch *watch);
void tribo_events_guard_limit(struct events *e, size_t i, const struct watch *watch);

#endif
