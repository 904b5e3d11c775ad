/* What the files of planar share. */
#ifndef TRIBO_PARTS_H
#define TRIBO_PARTS_H

#include "core/clusters.h"

/* ---- planar_parts.c */

/* A contact of a cluster in motion, in units in which the direction with the longer way to the edge of its band has limit 1. */
struct slide {
    size_t directions;
    int open;
    size_t far;     /* that direction, 0 or 1 */
    double part[2]; /* limits; of a scalar contact, the second is 0 */
    double x[2];    /* part v */
    double n[2];    /* x/|x|, or 0 */
    double length;  /* |x| */
    double epsilon; /* |x| from which the contact slides */
    double speed;   /* length/epsilon */
};
struct slide tribo_planar_slide(const struct contacts *c, size_t i, size_t directions, const double *v);

/* 1 if the force of a contact depends on f_eq. */
int tribo_planar_near(const struct law *law, const struct slide *s);

/* Returns the part of its limit that a contact carries which is not near stick, along n; slope: its derivative by speed. */
double tribo_planar_carried(const struct law *law, double speed, double *slope);

/* f [directions] of a contact that is not near stick. */
void tribo_planar_slide_force(const struct law *law, const struct slide *s, const double *limit, double *f);

/* R_ii = 0 is the limit of R_ii from above: in parts of the largest R_ii it is this. */
#define NEXT_TO_IMMOVABLE 1e-200

/* A symmetric block 11, 12, 22 by its eigenvalues, at least 0, and the direction of the greater one. */
struct block {
    double great, small;
    double e[2];
};
struct block tribo_block_of(const double *own);

/* The block of the contact at place k of a matrix r [size][size]. */
struct block tribo_block_at(const double *r, size_t size, size_t k, size_t directions);

/* x = -block^-1 x, far away where friction moves nothing, or the block is singular. */
void tribo_planar_push(const struct block *b, double *x);

/* Returns R f + a at place k of a cluster, without the forces of the directions from place from on. */
double tribo_planar_others(const tribo_context *ctx, const struct cluster *g, size_t k, size_t from, size_t directions, double a);

/* ---- planar_reach.c */

/* The stand-in for the limit of direction i in the problem: at most the limit; where it is less (tribo_planar_cut), the force is
 * within it. */
static inline double tribo_planar_reach(const tribo_context *ctx, size_t i)
{
    return lesser(ctx->follow.contacts.bound[i], ctx->plane.radius[i]);
}
static inline int tribo_planar_cut(const tribo_context *ctx, size_t i)
{
    return ctx->plane.radius[i] < ctx->follow.contacts.bound[i];
}

/* Sets which directions of the problem share a set, and their shift in parts of the reach. */
void tribo_planar_arrange(tribo_context *ctx, const struct cluster *g);

/* Sets the reach of all contacts of the problem by the pulls at them. */
void tribo_planar_estimate(tribo_context *ctx, const struct cluster *g);

/* Widens the reach of forces that come up against it. Returns the number of these contacts. */
size_t tribo_planar_widen(tribo_context *ctx, const struct cluster *g);

/* ---- planar_force.c */

/* Sets the directions of a cluster's problem, the contacts near stick at v. Returns 1 if there are any. */
int tribo_planar_collect(tribo_context *ctx, const struct cluster *g, const double *v);

/* Sets the problem of the last call, at a. */
void tribo_planar_resume(tribo_context *ctx, const struct cluster *g, const double *a);

/* Units of force and R in the problem. */
struct unit {
    double force, r;
};
struct unit tribo_planar_units(const tribo_context *ctx, const struct cluster *g);

/* pull [size] += (own blocks of s) shift. */
void tribo_planar_turn(const tribo_context *ctx, const double *shift, double *pull);

/* A planar contact with f_eq given: limits, law and motion. */
struct given {
    double limit[2];
    struct contacts c; /* of its two directions */
    struct slide s;
    int near;
};

/* Sets what is given of planar contact k at v [2], feq [2]. */
void tribo_planar_given(const tribo_context *ctx, size_t k, const double *v, const double *feq, struct given *g);

/* Near stick: x->p.y = the point of the lens nearest to feq - kappa in the norm of the contact's block, in parts of limits.
 * Returns 1, or 0 without convergence. */
int tribo_planar_given_near(const tribo_context *ctx, size_t k, const struct given *g, const double *feq, struct disc_alone *x);

/* ---- planar_parts.c, where limits are static */

/* limit [directions] of the contact at i: static ones if it holds, or those by which it slides at v. */
void tribo_planar_limits(const tribo_context *ctx, size_t i, size_t directions, int holds, const double *v, double *limit);

/* Returns the contact at i as laws see it with static limits, which are copied to limit [directions]. */
struct contacts tribo_planar_view(const tribo_context *ctx, size_t i, size_t directions, double *limit);

/* Gives contacts of a cluster near stick at v their static limits, the others those by which they slide. */
void tribo_planar_hold(tribo_context *ctx, const struct cluster *g, const double *v);

/* Gives contacts that the solution cannot hold the limits by which they slide at the end of a step of dt, or (0) from rest.
 * Returns their number. a [n]: accelerations without friction. */
size_t tribo_planar_break(tribo_context *ctx, const struct cluster *g, double dt, const double *a);

/* The change of the limit of direction i in parts of the limit. */
static inline double tribo_limit_growth(const tribo_context *ctx, const struct change *d, size_t i)
{
    const double limit = ctx->follow.contacts.limit[i];
    return limit > 0.0 ? quotient(tribo_entry(d->limit, i), limit) : 0.0;
}

#endif
