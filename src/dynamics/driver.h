/* The interface of a method of integration, and what all methods share. */
#ifndef TRIBO_DRIVER_H
#define TRIBO_DRIVER_H

#include "dynamics/system/system.h"

/* Bits of what a method takes: settings, see tribo_driver_set_step and its neighbours; and systems: unsolved ones too, only those
 * whose contacts are all scalar, only those with mass at all degrees of freedom. */
enum {
    TAKES_STEP = 1,
    TAKES_TOLERANCE = 2,
    TAKES_OUTPUT = 4,
    TAKES_MAX_STEP = 8,
    TAKES_UNSOLVED = 16,
    NEEDS_SCALAR = 32,
    NEEDS_MASS = 64
};

struct events;

struct method {
    const char *name;
    int takes; /* sum of TAKES_... and NEEDS_... */
    int (*create)(tribo_driver *drv);
    void (*destroy)(tribo_driver *drv); /* also after a create that failed */
    /* Advances from *t to t1 > *t. continues = 1: the method's last advance ended at (t, y), and nothing has changed since.
     * Returns a status; on error t and y may be anything: the driver restores the state kept last. */
    int (*advance)(tribo_driver *drv, double *t, double t1, double *y, int continues);
    /* Methods that loop over events (events.h): prepares *events. Other methods: NULL. */
    int (*open)(tribo_driver *drv, struct events **events);
    /* tribo_driver_find_periodic for checked arguments; NULL: TRIBO_ERR_UNSUPPORTED. */
    int (*find_periodic)(tribo_driver *drv, double t, double period, double *y);
};

struct tribo_driver {
    tribo_system *sys;
    const struct method *method, *at_work; /* at_work: the method that tribo_driver_method names */

    /* settings */
    double dt;             /* step, or first step; 0: not set */
    double abstol, reltol; /* abstol 0: not set */
    double output;         /* time between outputs; 0: no outputs */
    double max_step;       /* 0: 0.1 times the shortest 1/omega */
    int (*seen)(const tribo_moment *moment, void *data);
    void *data;

    /* state */
    void *own;                 /* the method's own */
    double *state, *slope;     /* [tribo_system_size] the state kept last; workspace */
    double *motion, *shown;    /* [dimension + compliant contacts] a caller's state, in; out. NULL without an expansion */
    double time;               /* of the state kept last */
    size_t revision;           /* of the system when the last advance ended; SIZE_MAX: the method begins anew */
    struct shooting *shooting; /* the last search; borrowed if free_shooting is NULL */
    void (*free_shooting)(struct shooting *s);
    char *message; /* [TRIBO_MESSAGE] a const driver keeps it, too */

    /* counters */
    size_t steps, rejected, evaluations, jacobians, events, periods, newton;
    size_t rested;           /* degrees of freedom left out, step by step */
    double excess, backslip; /* largest so far; NaN for methods that do not know them */
};

/* Keeps the message and returns status. */
int tribo_driver_fail(const tribo_driver *drv, int status, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* The same for a step h from t in which an evaluation failed, with the system's status and message. */
int tribo_driver_explain(tribo_driver *drv, double t, double h);

/* States y here and in methods are those of tribo_system_size values, see system.h.
 * TRIBO_ERR_NOT_FINITE if a value of y is not finite. */
int tribo_driver_check(tribo_driver *drv, const double *y);

/* Keeps (t, y) as the last good state, to which tribo_driver_advance goes back on any failure. TRIBO_ERR_NOT_FINITE if a value of
 * y is not finite. Every state that a method finds is kept before anything is built on it. */
int tribo_driver_keep(tribo_driver *drv, double t, const double *y);

/* Calls the observer, if there is one, for a state that was kept: kind TRIBO_MOMENT_..., contact SIZE_MAX for a step. Returns
 * TRIBO_ERR_STOPPED if the observer answers anything but 0. */
int tribo_driver_show(tribo_driver *drv, double t, const double *y, int kind, size_t contact);

/* Keeps (t, y), and shows it as a step. */
int tribo_driver_accept(tribo_driver *drv, double t, const double *y);

/* A step from the state at t to that at next, y, all of which it writes and finds finite. */
typedef int tribo_fixed_step(tribo_driver *drv, double t, double next, const double *from, double *y);

/* Takes steps between the times t [count + 1], count <= RUN: y is the state at t[0], and becomes that after the last step.
 * Returns the number of steps taken; after less than count the next one is for tribo_fixed_step. */
typedef size_t tribo_fixed_run(tribo_driver *drv, size_t count, const double *t, double *y);

/* Steps that a run takes at most. */
enum { RUN = 16 };

/* run: steps without an observer, or NULL. */
struct fixed_method {
    tribo_fixed_step *step;
    tribo_fixed_run *run;
};

/* Steps of drv->dt from y, which is the last good state, to t1, the last one shorter where it must be. States are kept as by
 * tribo_driver_keep, but not copied. */
int tribo_driver_fixed_steps(tribo_driver *drv, double *t, double t1, double *y, const struct fixed_method *method);

/* tribo_driver_advance for a state of tribo_system_size values. */
int tribo_driver_advance_motion(tribo_driver *drv, double *t, double t1, double *y);

/* A driver by method, which must live longer, in *drv. Returns what tribo_driver_create returns. */
int tribo_driver_create_method(tribo_driver **drv, tribo_system *sys, const struct method *method);

extern const struct method tribo_method_exact, tribo_method_event, tribo_method_central_fixed, tribo_method_moreau_fixed,
    tribo_method_rk4_fixed;

#endif
