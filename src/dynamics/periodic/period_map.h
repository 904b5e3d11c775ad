/* SPDX-License-Identifier: BSD-3-Clause */
/* The map x -> image over one period, and its derivative. If all drives are odd (loads and bases change sign after half a
 * period), the map to minus the state after half a period replaces it: applied twice it is the map over a period. In a ring the
 * map to the state after a part of the period, turned back by some sectors, replaces it (struct ring). */
#ifndef TRIBO_PERIOD_MAP_H
#define TRIBO_PERIOD_MAP_H

#include "energy_norm.h"
#include "variation.h"

#define FULL_TURN 6.283185307179586 /* radians */

/* Unknowns beside x, at most. */
#define TRIBO_UNKNOWNS 3

/* The map at one point; arrays [n]. y: initial state; x: coordinates of y in the energy norm. */
struct point {
    double *y, *x;
    double *end, *image;          /* end: state after the span; image of x: coordinates of end, or of -end if odd */
    struct derivative derivative; /* d end/d y */
    double unknown[TRIBO_UNKNOWNS], value[TRIBO_UNKNOWNS], *border; /* see struct border (shooting.h) */
    double residual;                                                /* |image - x| */
    double size;                                                    /* largest |x| at the start and at the ends of phases */
    int odd;                                                        /* 1: image is that of -end */
};

/* A ring of equal sectors with x_j+1(t) = x_j(t - lag), sector j + sectors = sector j. */
struct ring {
    size_t sectors;    /* 0: no ring: parts = 1, and the other members are not read */
    size_t step;       /* below sectors: sector j + step after the span = sector j before, times -1 if reversed = 1 */
    size_t parts;      /* of the period, each a span */
    size_t alternates; /* 1: sector j + sectors = minus sector j */
    int reversed;
    double lag;
};

struct period_map {
    struct company company; /* of follow: the first member */
    tribo_driver *drv;
    tribo_system *sys;
    struct events *events;
    size_t n; /* values of a state with perturbations: tribo_system_energy(sys) */
    struct energy_norm norm;
    struct variation variation;
    double *y, *x;          /* [n + 1] a state; [n] coordinates of a state */
    double *probe;          /* [n][columns] initial perturbations */
    size_t columns;         /* n, or fewer if phases are kept */
    double *limit;          /* [2 ncontact] workspace */
    double t, period, span; /* span: length of an integration of the map */
    int alternates;         /* 1: all drives are odd */
    int odd;                /* 1: span = period/2 */
    struct ring ring;       /* span = period/parts if not odd */
    double *turned;         /* [n][n] workspace; NULL before the first ring */
    double size, least;     /* size: largest |x| of this integration so far; motions below `least` are rounding */
    int moved;              /* 1: follow has integrated since prepare */
    size_t halves;          /* half periods integrated since prepare; of a ring, parts */
};

/* Returns the number of periods integrated since prepare. */
static inline double tribo_periods_followed(const struct period_map *m)
{
    return (double)m->halves / (m->ring.sectors ? (double)m->ring.parts : 2.0);
}

/* Returns 1, or 0 if out of memory. Call tribo_period_map_free also after a failure. */
int tribo_period_map_create(struct period_map *m, tribo_driver *drv);
void tribo_period_map_free(struct period_map *m);

/* Each returns a status, its message on the driver. prepare: sets the map for the present system and the guess y. follow:
 * integrates from p->x, first corrected for rounding of contacts at rest and for spring forces above limits, and sets the rest of
 * *p. later: sets *p by a span from m->t + later on, of the motion from y at m->t. complete: sets p->residual = |x(t + period) -
 * x(t)| over the whole period. */
int tribo_period_map_prepare(struct period_map *m, double t, double period, const double *y);
int tribo_period_map_follow(struct period_map *m, struct point *p);
int tribo_period_map_later(struct period_map *m, const double *y, double later, struct point *p);
int tribo_period_map_complete(struct period_map *m, struct point *p);

/* apply: x [n] = D x, D = d image/d x at p. matrix: p->derivative.matrix [n][n] = D, unless it is set. Both return a
 * status, its message on the driver. */
int tribo_period_map_apply(struct period_map *m, const struct point *p, double *x);
int tribo_period_map_matrix(struct period_map *m, struct point *p);

/* x [n] = coordinates of the state after `times` integrations of length `time` from x, with the observer `company`, or NULL.
 * Returns a status, its message on the driver. */
int tribo_period_map_march(struct period_map *m, double time, size_t times, struct company *company, double *x);

/* Integrates from y at m->t for a time `length` with the observer `company`; m->y becomes the state at the end. Returns a status,
 * its message on the driver. */
int tribo_period_map_replay(struct period_map *m, const double *y, double length, struct company *company);

/* *contact = the first elastic contact that touches its limit within the period from y at m->t: the force reaches the limit, and
 * the contact slides in some neighbouring motions only. *contact = ncontact if no contact touches. changed = 1: the system has
 * changed since the motion was found. Returns a status, its message on the driver. */
int tribo_period_map_find_touch(struct period_map *m, const double *y, int changed, size_t *contact);

/* rate [n] = coordinates of the derivative of the state by time at the end of the last integration by follow. */
void tribo_period_map_rate(const struct period_map *m, const double *end, double *rate);

/* Sets m->odd, and m->span = period/2 if odd, else period/parts. odd = 1 is for odd drives only. */
void tribo_period_map_choose(struct period_map *m, int odd);

/* Returns 1 if, half a period later, loads and bases have the opposite sign and limits are the same. Limits that follow the
 * motion are not. */
int tribo_system_is_odd(const tribo_system *sys, double period);

/* to [n][columns] = states y of which sector j is that of sector j + step, times -1 where sign = -1. */
void tribo_ring_turn(const struct period_map *m, size_t step, double sign, size_t columns, const double *y, double *to);

/* x [n] = coordinates of the state of coordinates x turned back as after a span. */
void tribo_period_map_turn(struct period_map *m, double *x);

/* forecast.c: sets x [m->n] = coordinates of the forecast of the state at m->t, m->odd = 1. Sets *done = 0 if there is no
 * forecast: a mode does not oscillate (as without stiffness), or resonates without damping, or x is not finite. Returns a status,
 * its message on the driver. */
int tribo_forecast(struct period_map *m, double *x, int *done);

#endif
