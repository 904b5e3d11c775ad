/* SPDX-License-Identifier: BSD-3-Clause */
/* Data of planar contacts: which directions they are, and their clusters.
 *
 *   planar.c          one contact alone; life, settings: clusters, from the operator's groups and the contacts that join them
 *   planar_force.c    forces
 *   planar_tangent.c  derivatives; forces and derivatives where f_eq is given
 *
 * core/calls.h declares what the rest of core calls. */
#ifndef TRIBO_PLANAR_H
#define TRIBO_PLANAR_H

#include "numerics/disc/disc_qp.h"
#include "core/law/law.h"
#include "core/operator/operator.h"
#include "numerics/csr.h"

/* Roles of a direction. */
enum { ROLE_SCALAR, ROLE_FIRST, ROLE_SECOND };

/* Directions that R or a planar contact joins, a planar contact among them. They ascend, so that both directions of a contact are
 * neighbours. */
struct cluster {
    size_t size;
    size_t *member;         /* [size] */
    struct csr r;           /* R by places; rows of one contact have the same columns */
    struct sparse *pattern; /* of the factor; NULL: dense */
    struct sparse *made;    /* of r, owned; NULL: none was made */
    int dense;              /* 1: a dense factor is better for entries at the places of r */
    int redundant;          /* R is singular */
};

/* Planar contacts of a context; what it keeps of them from call to call; workspace. Without an operator there are no clusters. */
struct clusters {
    size_t count, *first; /* [count] first directions */
    unsigned char *role;  /* [n] */
    double (*own)[4];     /* [count] R of the contact alone, [2][2] */
    size_t clusters, islands;
    struct cluster *cluster; /* [clusters] */
    size_t laid_out;         /* clusters that there is room for */
    size_t *members;         /* [n] of all clusters */
    struct room rooms[4];    /* memory of the arrays but cluster; of cluster; of struct parts; of rows on the way */
    size_t *group_of;        /* [n] that of the operator; TRIBO_ALONE for members of clusters */
    struct disc_qp problem;
    size_t *near;              /* [n + 1] places in the cluster of the problem's directions */
    size_t *contact;           /* [n] the contacts there */
    size_t *index;             /* [n] the problem's direction at a place of its cluster, or TRIBO_ALONE */
    unsigned char *directions; /* [n] of the contact that begins with a direction of the problem: 1, 2; 0: none begins */
    double unit_force, unit_r; /* of the problem */
    size_t cuts;               /* directions of the problem with a reach below their limit */
    double *y;                 /* [n] forces of the last solution */
    double *radius;            /* [n] reach = min(limit, radius) */
    double *a;                 /* [n] of the last balance, or step */
    double *shift;             /* [n] c of the problem's lenses, in parts of limits */
    double *pull;              /* [n] R f + a without the forces of the problem */
    double *v, *df;            /* [n] workspace */
    double *growth;            /* [n] d(limit)/limit of the problem's directions */
};

/* ---- planar.c */

/* A contact of a cluster in motion, in units in which the direction with the longer way to the edge of its band has limit 1. */
struct slide {
    size_t directions;
    int open;
    size_t far;     /* that direction, 0 or 1 */
    double bound;   /* its limit; where limits are static, the largest */
    double part[2]; /* limits; of a scalar contact, the second is 0 */
    double x[2];    /* part v */
    double n[2];    /* x/|x|, or 0 */
    double length;  /* |x| */
    double epsilon; /* |x| from which the contact slides */
    double speed;   /* length/epsilon */
};
/* The contact at i, at v [directions]. Its static limits are the same multiple of those by which it slides, so that only bound
 * depends on which of both it has. */
struct slide tribo_planar_slide(const tribo_context *ctx, size_t i, const double *v);

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

/* The block of a contact, on the diagonal of a symmetric matrix, by its eigenvalues, at least 0, and the direction of the greater
 * one. */
struct block {
    double great, small;
    double e[2];
};
/* Returns the block [[first_0, first_1], [first_1, *second]]; second NULL: the contact has one direction, R = first_0. */
struct block tribo_block_of(const double *first, const double *second);

/* Returns the block of the contact at place k of a cluster. */
struct block tribo_cluster_block(const struct cluster *g, size_t k, size_t directions);

/* limit [directions] of the contact at i: static ones if it holds, or those by which it slides at v. */
void tribo_planar_limits(const tribo_context *ctx, size_t i, int holds, const double *v, double *limit);

/* ---- planar_force.c */

/* pull [size] += (own blocks of s) shift; directions [size] of the contacts that begin there. */
void tribo_planar_turn(const struct disc_qp *p, const unsigned char *directions, const double *shift, double *pull);

#endif
