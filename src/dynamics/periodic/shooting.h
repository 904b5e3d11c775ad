/* SPDX-License-Identifier: BSD-3-Clause */
/* Shooting: the search for a fixed point x = image(x) of the period map. */
#ifndef TRIBO_SHOOTING_H
#define TRIBO_SHOOTING_H

#include "period_map.h"
#include "common/imaginary.h"

struct shooting;

/* Unknowns beside x, of which the map depends, and as many conditions value_k = 0. Both functions return a status, its message
 * on the driver. Of a point p: p->unknown [count] in; p->value [count], and p->border, the columns d image/d unknown_k [n] and
 * then the rows d value_k/d(x, unknown) [n + count], by border. */
struct border {
    size_t count; /* 0: none, the other members are not read */
    /* Sets the map for p->unknown; TRIBO_ERR_NO_CONVERGENCE: beyond their range. */
    int (*apply)(struct shooting *s, const struct point *p);
    /* Sets value and border of p, which the map followed last; s->step stays: shorter steps are parts of it. */
    int (*border)(struct shooting *s, struct point *p);
    double unit[TRIBO_UNKNOWNS]; /* an unknown in its own unit over p->unknown */
    double first;                /* an unknown period as the search begins */
};

struct track;

/* A mode that is searched (mode.c). c [2 ndof]: coefficients of q and q'; x [2 n]: workspace. like: system of the caller. */
struct mode {
    const tribo_system *like;
    const double *c;
    double *x;
    double amplitude;
};

/* The system of modes, of a curve, or of the sectors of a ring that move differently, and its driver. */
struct twin {
    tribo_system *sys;
    tribo_driver *drv;
};

/* A ring, see tribo_driver_set_ring; sectors = 0: none. */
struct ring_of {
    size_t sectors, order;
};

struct shooting {
    struct period_map map;
    struct border extra;
    struct point point[2];
    struct point *here, *there; /* current point; end of the step */
    struct point beside;        /* of curve_border: at another value of the parameter; border is not set */
    struct point *flow;         /* here, or there at another time of the motion found: has its multipliers */
    double *a, *b;              /* [n + TRIBO_UNKNOWNS][n + TRIBO_UNKNOWNS], [n][n] workspace; a owns the memory of all arrays */
    double *space;              /* workspace of tribo_gmres */
    double *step, *guess;       /* [n + TRIBO_UNKNOWNS], [n] */
    double ratio;               /* left_along(there)/left_along(here) of the step */
    double rate;                /* ratio of the last step if it was good, else 0 */
    double stride;              /* spans extrapolated at once; 0: Newton's steps */
    size_t spans;               /* spans of the equation solved in a Krylov space */
    int preconditions;          /* 1: that equation is I - D times (I - F)^-1 from the right, apply_free */
    double before;              /* residual before the last step */
    double nearest;             /* least residual/size so far */
    int found;
    size_t revision;       /* of the system when the motion was found */
    size_t touches;        /* contact of check_touches, of the motion found: ncontact if none touches; SIZE_MAX: not yet known */
    struct mode *mode;     /* of the search of a mode; else NULL */
    struct track *curve;   /* of the curve that is followed; else NULL */
    struct twin twin;      /* of this driver */
    struct ring_of asked;  /* by tribo_driver_set_ring */
    struct ring_of whole;  /* ring of which twin.sys has the first sectors */
    struct shooting *told; /* the search that has the motion found: this one, or that of twin.drv */
};

/* Returns NULL if out of memory. */
struct shooting *tribo_shooting_create(tribo_driver *drv);

/* Sets re, im [tribo_system_dimension - 1] = multipliers of the motion found; *freedom = dimension of its family. */
int tribo_shooting_multipliers(struct shooting *s, double *re, double *im);
int tribo_shooting_freedom(struct shooting *s, size_t *freedom);

/* vector [2][n] = right and left eigenvector u, w of D = d image/d x at s->here for multiplier `which`, w'u = 1; *lambda = its
 * eigenvalue. room: workspace [2 n^2 + 2 tribo_system_dimension]. Returns a status; TRIBO_ERR_UNSUPPORTED: the multiplier is
 * repeated, or 0. */
int tribo_shooting_vectors(struct shooting *s, size_t which, double complex *vector, double complex *lambda, double *room);

/* Returns TRIBO_OK; TRIBO_ERR_UNSUPPORTED if the force of an elastic contact only touches its limit in the motion found, so that
 * the motion has no `what`; or another status. The message is on the driver. */
int tribo_shooting_check_touches(struct shooting *s, const char *what);

/* Largest residual over size of a motion that is found. */
#define TRIBO_PERIODIC 1e-10

/* Returns 1 if the residual is at most part of the size, which is finite. */
int tribo_point_is_closed(const struct point *p, double part);

/* Searches from s->here, x and unknown; the result is s->here. Returns a status, its message on the driver; the motion is found
 * if tribo_point_is_closed(s->here, TRIBO_PERIODIC). */
int tribo_shooting_search(struct shooting *s);

/* Searches from s->here, with an unknown period about `period`. *closed = 1 if the search ends at a closed motion. Returns a
 * status: not that of a search that fails. */
int tribo_shooting_try(struct shooting *s, double period, int *closed);

/* x [n + count] = the tangent: the shortest solution of the bordered equation at s->here with right-hand side 0, but 1 for the
 * last condition. Returns a status. */
int tribo_shooting_tangent(struct shooting *s, double *x);

/* Exchanges here and there. */
void tribo_shooting_turn(struct shooting *s);

/* Returns TRIBO_ERR_NO_CONVERGENCE with a message of the residual over size of the nearest motion. */
int tribo_shooting_fails(const struct shooting *s, double residual);

/* Marks the motion s->here, y, as found: w->y, w->period and the questions about it. */
void tribo_shooting_keep(struct shooting *s, struct wanted *w);

/* Sets s->flow, the point that has the multipliers of s->here. Returns a status. */
int tribo_shooting_find_flow(struct shooting *s);

/* The find of struct wanted: tribo_driver_find_periodic, tribo_driver_find_cycle (cycle.c), tribo_driver_find_mode (mode.c), with
 * arguments already checked. */
int tribo_shooting_find(struct shooting *s, struct wanted *w);
int tribo_shooting_find_cycle(struct shooting *s, struct wanted *w);
int tribo_shooting_find_mode(struct shooting *s, struct wanted *w);
int tribo_shooting_follow_curve(struct shooting *s, struct wanted *w);

/* Borders of cycles (cycle.c) and modes (mode.c): unknowns T/unit[0], of modes also delta/unit[1]; more unknowns may follow. */
extern const struct border tribo_cycle_border, tribo_mode_border;

/* mode.c: sets the twin of s: a copy of its system, steady = 1: without loads and bases that change in time, and its driver.
 * Returns a status. */
int tribo_shooting_create_twin(struct shooting *s, int steady);

/* drive: creates the driver and the search of s->twin.sys, and returns a status; leave: s has no twin then. */
int tribo_shooting_drive_twin(struct shooting *s);
void tribo_shooting_leave_twin(struct shooting *s);

/* ring.c. find_ring: the find of a motion of the ring s->asked. find_flow: sets s->flow for multipliers of the whole ring, of
 * which s->told has the motion. Both return a status. fold_combination: to = the coefficients c [2 ndof + 2 springs] for the
 * twin; without an expansion [2 ndof]. */
int tribo_shooting_find_ring(struct shooting *s, struct wanted *w);
int tribo_ring_find_flow(struct shooting *s);
void tribo_ring_fold_combination(const struct shooting *s, const double *c, double *to);

/* mode.c: sets the damping of the twin that s searches to factor times that of `like`, less 2 delta M. Returns a status. */
int tribo_shooting_set_damping(struct shooting *s, const tribo_system *like, double factor, double delta);

/* Follows p with its unknowns; conditions count in the residual, which is HUGE_VAL beyond the range of the unknowns. Returns a
 * status. */
int tribo_shooting_follow(struct shooting *s, struct point *p);

/* Returns TRIBO_OK if drv is not NULL, missing is NULL, and the system is that of the motion found; missing: name of an argument
 * that is NULL. *c: NULL, or coefficients of q, q' of the caller's, which become those of the methods' state: [2 ndof + 2
 * springs] with those of f and f', or without an expansion [2 ndof]. */
int tribo_shooting_ready(tribo_driver *drv, const char *missing, const double **c);

/* x [n][columns] = (I - D)^-1 x, D = d image/d x of the motion found. Returns a status. */
int tribo_shooting_solve(struct shooting *s, size_t columns, double *x);

#endif
