/* The Taylor series of the motion of driver "event": while the modes of the contacts last it is smooth, and its coefficients
 * follow from the equations of motion, one product with the structure's matrices and one solve for the held contacts an order. */
#ifndef TRIBO_EVENT_SERIES_H
#define TRIBO_EVENT_SERIES_H

#include "event_creep.h"
#include "dynamics/events/events.h"
#include "planar_series.h"
#include "series_transition.h"

struct event {
    tribo_driver *drv;
    tribo_system *sys;
    struct events events;
    size_t order, most_order; /* that of a phase, and what there is room for */
    double tolerance, abstol; /* relative; that of the driver as it was taken */
    double fastest;           /* bound on the frequencies of the motion, but for what falling friction makes grow */
    size_t revision;
    double moves[3];                 /* of q, u and d within the time of the fastest motion; where abstol is not set */
    double length;                   /* of the step, and what bounds hold for */
    double *q, *u;                   /* [order + 1][ndof] coefficients of the powers of time */
    double *watch;                   /* [order + 1][ncontact] velocities of sliding contacts, forces of those at rest */
    double *limit;                   /* [order + 1][ncontact] limits, below 0 where a contact has lifted off; */
    size_t terms;                    /* so many rows of them are not zero */
    double *slide;                   /* [order + 1][ncontact] limits to slide: these, unless they fall with the speed; */
    size_t slide_terms;              /* so many rows */
    double *fall, *part;             /* [order + 1][ncontact] room for such that fall, and exp(-|v|/velocity) */
    double *slope;                   /* [order + 1][ncontact] room for how such forces grow with the velocity */
    double *d;                       /* [order + 1] dissipated energy */
    double *size, *bend;             /* [ncontact] bounds of what is watched, and of its sixth derivative; */
    double *limit_size, *limit_bend; /* [ncontact] the same of limits */
    double *cosine, *sine;           /* [order + 2][harmonics] coefficients of cos(omega t) and sin(omega t) */
    double *acceleration, *base, *a, *given, *held;
    struct planar_series planar;
    struct creep creep;
    double *spring, *rate; /* [order + 1][ncontact] coefficients of forces of compliant contacts; [ncontact] of their rates */
    struct series_transition perturbed;
};

/* Coefficients of the motion from (t, y) on. Returns a status. Done in two parts: what is known of it at the start, and then the
 * series, again and again as directions of sliding forces are given. */
int tribo_event_start(struct event *e, double t, const double *y);
int tribo_event_series(struct event *e);
int tribo_event_expand(struct event *e, double t, const double *y);

/* e->slope, of limits that fall, after that. */
void tribo_event_slopes(struct event *e);

/* What the limit of contact i, which slides, has done against its velocity at tau: energy. */
double tribo_event_work(void *own, size_t i, double tau);

#endif
