/* SPDX-License-Identifier: BSD-3-Clause */
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

/* Harder pulls, in units of what friction can hold, count by their direction only. */
#define HARDEST 1e100

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

/* limit [directions] of the contact at i: static ones if it holds, or those by which it slides at v. */
void tribo_planar_limits(const tribo_context *ctx, size_t i, size_t directions, int holds, const double *v, double *limit);

/* Returns the contact at i as laws see it with static limits, which are copied to limit [directions]. */
struct contacts tribo_planar_view(const tribo_context *ctx, size_t i, size_t directions, double *limit);

/* ---- planar_reach.c */

/* The stand-in for the limit of direction i in the problem: at most the limit; where it is less (tribo_planar_cut), the force is
 * within it. */
static inline double tribo_planar_reach(const tribo_context *ctx, size_t i)
{
    return lesser(ctx->follow.contacts.bound[i], ctx->planar->radius[i]);
}
static inline int tribo_planar_cut(const tribo_context *ctx, size_t i)
{
    return ctx->planar->radius[i] < ctx->follow.contacts.bound[i];
}

/* Sets which directions of the problem share a set, and their shift in parts of the reach. */
void tribo_planar_arrange(tribo_context *ctx);

/* Sets the reach of all contacts of the problem by the pulls at them. */
void tribo_planar_estimate(tribo_context *ctx, const struct cluster *g);

/* Widens the reach of forces that come up against it. Returns the number of these contacts. */
size_t tribo_planar_widen(tribo_context *ctx);

/* ---- planar_force.c */

/* Units of force and R in the problem. */
struct unit {
    double force, r;
};
struct unit tribo_planar_units(const tribo_context *ctx);

/* pull [size] += (own blocks of s) shift. */
void tribo_planar_turn(const tribo_context *ctx, const double *shift, double *pull);

#endif
