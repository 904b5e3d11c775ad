/* SPDX-License-Identifier: BSD-3-Clause */
/* The Taylor series of the motion of method "event". Between events the motion is smooth; its coefficients follow from the
 * equations of motion, by one product with the structure's matrices and one solve for the holding contacts an order. */
#ifndef TRIBO_EVENT_SERIES_H
#define TRIBO_EVENT_SERIES_H

#include "event_creep.h"
#include "dynamics/events/events.h"
#include "planar_series.h"

/* Workspace. */
struct event_room {
    double *acceleration; /* [ndof] */
    double *base;         /* [ncontact], as the others */
    double *a;
    double *given;
    double *held;
    double *rate;
};

/* A polynomial in time, an output of guards: term[k stride], k < terms; bounds, over the phase, of the sum of the sizes of its
 * terms, and of that of its sixth derivative. */
struct curve {
    const double *term;
    size_t terms, stride;
    double size, bend;
};

struct event {
    tribo_driver *drv;
    tribo_system *sys;
    struct events events;
    size_t order;              /* of the series of a phase */
    size_t most_order;         /* room */
    double tolerance;          /* relative */
    double abstol;             /* that of the driver when tolerance was found */
    double fastest;            /* bound of the frequencies of the motion, without growth by falling friction */
    size_t revision;           /* of the system that fastest is of */
    int known;                 /* 1: fastest and most_order are those of revision and tolerance */
    double moves[3];           /* change of q, u and d within the time of the fastest motion; if abstol = 0 */
    double length;             /* of the step, and of the interval of bounds */
    double *q, *u;             /* [order + 1][ndof] coefficients of the powers of time of displacements and velocities */
    double *watch;             /* [order + 1][ncontact] velocities of sliding contacts, forces of contacts at rest */
    double *limit;             /* [order + 1][ncontact] limits, below 0 where a contact has lifted off */
    size_t terms;              /* number of rows of limit that are not zero */
    double *slide;             /* [order + 1][ncontact] limits to slide: limit, or fall */
    size_t slide_terms;        /* number of rows of slide that are not zero */
    double *fall, *part;       /* [order + 1][ncontact] limits that fall with the speed; exp(-|v|/velocity) */
    double *d;                 /* [order + 1] dissipated energy */
    double *spring;            /* [order + 1][ncontact] forces of compliant contacts */
    struct curve *curve;       /* [ncontact] watch; squares of planar contacts */
    struct curve *limit_curve; /* [ncontact] limit */
    struct event_room room;
    struct planar_series planar;
    struct creep creep;
};

/* Finds the coefficients of the motion from (t, y) on: first those known at the start, then the series, which collocation
 * repeats with other directions of sliding forces; or both. Returns a status. */
int tribo_event_start(struct event *e, double t, const double *y);
int tribo_event_series(struct event *e);
int tribo_event_expand(struct event *e, double t, const double *y);

/* Energy that sliding contact i dissipates until tau; own: struct event. */
double tribo_event_work(void *own, size_t i, double tau);

/* Moves perturbations v [2 ndof + compliant contacts][columns] of the state by tau in the phase. As transition of struct motion. */
int tribo_event_transition(void *own, const void *phase, double tau, size_t columns, double *v);

#endif
