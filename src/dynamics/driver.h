/* SPDX-License-Identifier: BSD-3-Clause */
/* The interface of integration methods, and functions shared by all methods. */
#ifndef TRIBO_DRIVER_H
#define TRIBO_DRIVER_H

#include "dynamics/system/system.h"

/* Bits of `takes`. TAKES_STEP to TAKES_MAX_STEP: settings accepted, see tribo_driver_set_step and the functions after it.
 * TAKES_UNSOLVED: unsolved systems accepted. NEEDS_SCALAR: scalar contacts only. NEEDS_MASS: no massless degrees of freedom.
 * TAKES_PAIRS: contacts in a plane on springs accepted. */
enum {
    TAKES_STEP = 1,
    TAKES_TOLERANCE = 2,
    TAKES_OUTPUT = 4,
    TAKES_MAX_STEP = 8,
    TAKES_UNSOLVED = 16,
    NEEDS_SCALAR = 32,
    NEEDS_MASS = 64,
    TAKES_PAIRS = 128
};

struct events;
struct shooting;
struct track;

/* A periodic motion that is looked for: by find, with the data of the search. period, y: of the guess, then of the motion. */
struct wanted {
    int (*find)(struct shooting *s, struct wanted *w);
    double t, period;
    double *y;               /* methods' state, unchanged by errors */
    const double *c;         /* modes: [2 ndof] coefficients of q and q', as methods have them */
    struct track *curve;     /* curves: see curve.h; else NULL */
    double amplitude, delta; /* modes: of c'[q, q'], in; half the damping that they lose per mass, of the guess, then found */
};

struct method {
    const char *name;
    int takes;                          /* sum of TAKES_... and NEEDS_... */
    int (*create)(tribo_driver *drv);   /* NULL: none needed */
    void (*destroy)(tribo_driver *drv); /* called also after create failed */
    /* Advances (*t, y) to t1 > *t. continues = 1: the last advance ended at (t, y), and settings and system are unchanged.
     * Returns a status; after an error the driver restores the last kept state, so t and y may have any value. */
    int (*advance)(tribo_driver *drv, double *t, double t1, double *y, int continues);
    /* Methods with a loop over events (events.h): prepares *events. NULL: other methods. */
    int (*open)(tribo_driver *drv, struct events **events);
    /* Finds a periodic motion, with checked arguments; returns what w->find returns. NULL: TRIBO_ERR_UNSUPPORTED. */
    int (*find_periodic)(tribo_driver *drv, struct wanted *w);
};

/* Contacts that a method takes, as `scalar` of tribo_system_check_contacts. */
static inline int tribo_method_scalar(const struct method *m)
{
    return m->takes & NEEDS_SCALAR ? 1 : m->takes & TAKES_PAIRS ? -1 : 0;
}

/* The data of the methods that auto takes, event and exact, each created at first use. */
struct choice {
    void *own[2];
    int refused; /* 1: exact has refused the system of this revision */
    size_t revision;
};

struct tribo_driver {
    tribo_system *sys;
    const struct method *method, *at_work; /* at_work: the method with the data `own`; differs from method in auto */

    /* settings */
    double dt;             /* step, or first step of adaptive methods; 0: not set */
    double abstol, reltol; /* abstol = 0: not set */
    double output;         /* time between outputs; 0: no outputs */
    double max_step;       /* largest step; 0: 0.1/omega of the highest frequency omega */
    int (*seen)(const tribo_moment *moment, void *data);
    void *data;

    /* state */
    void *own;                 /* data of the method at work */
    struct choice choice;      /* of method auto */
    double *state, *slope;     /* [tribo_system_size] last kept state; workspace */
    double *motion, *shown;    /* [dimension] methods' state, at most as long; caller's state. NULL without an expansion */
    double time;               /* time of `state` */
    size_t revision;           /* tribo_system_revision after the last advance; SIZE_MAX: the next starts from scratch */
    struct shooting *shooting; /* last search of a periodic motion, or NULL */
    char *message;             /* [TRIBO_MESSAGE] also written for a const driver */

    /* counters */
    size_t steps, rejected, evaluations, jacobians, events, periods, newton;
    size_t rested;           /* sum over the steps of the degrees of freedom at rest that a step skips */
    double excess, backslip; /* largest values so far, of methods with TAKES_OUTPUT */
};

/* Returns status and message of the system, for a failed evaluation in a step h from t. */
int tribo_driver_explain(tribo_driver *drv, double t, double h);

/* Returns status; if it is an error, the message of the system becomes that of the driver. */
int tribo_driver_pass(const tribo_driver *drv, int status);

/* Returns TRIBO_ERR_NOT_FINITE if a value of y is not finite. States y here and in methods are methods' states,
 * [tribo_system_size], see system.h. */
int tribo_driver_check(tribo_driver *drv, const double *y);

/* Keeps (t, y), which was checked, as the last good state, restored by tribo_driver_advance after an error. Methods keep every
 * computed state before any further use. */
void tribo_driver_keep(tribo_driver *drv, double t, const double *y);

/* Calls the observer, if any, for a kept state: kind TRIBO_MOMENT_..., contact SIZE_MAX for a step. Returns TRIBO_ERR_STOPPED if
 * the observer returns a value other than 0. */
int tribo_driver_show(tribo_driver *drv, double t, const double *y, int kind, size_t contact);

/* Checks and keeps (t, y), and calls the observer for a step. Returns a status. */
int tribo_driver_accept(tribo_driver *drv, double t, const double *y);

/* *drv = new driver with a method that must outlive the driver. Returns what tribo_driver_create returns. */
int tribo_driver_create_method(tribo_driver **drv, tribo_system *sys, const struct method *method);

/* periodic/shooting.c */
void tribo_shooting_free(struct shooting *s);

extern const struct method tribo_method_exact, tribo_method_event, tribo_method_central_fixed, tribo_method_moreau_fixed,
    tribo_method_rk4_fixed;

#endif
