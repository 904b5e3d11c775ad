/* Planar contacts of a context: which directions they are, and the clusters that they stand in.
 *
 *   planar.c          life: clusters of directions, from the operator's groups and the contacts that join them
 *   planar_parts.c    what forces are made of: sliding, nearness to stick, blocks of R
 *   planar_reach.c    how far a force of a problem of a cluster reaches
 *   planar_force.c    forces: sliding ones, and the problems of clusters
 *   planar_static.c   which of them break away, where limits are static
 *   planar_tangent.c  their derivatives
 */
#ifndef TRIBO_PLANAR_H
#define TRIBO_PLANAR_H

#include "numerics/disc/disc_qp.h"
#include "core/law/law.h"
#include "core/operator/operator.h"

/* What a direction is. */
enum { ROLE_SCALAR, ROLE_FIRST, ROLE_SECOND };

/* Directions that R or a planar contact joins, a planar contact among them. They are ascending, so that the two directions of a
 * contact are neighbours. */
struct cluster {
    size_t size;
    size_t member; /* first of them */
    size_t r;      /* first entry of [size][size] */
    int redundant; /* R is singular */
};

/* Constant; clones have it in common. The clusters are there if there is an operator. */
struct planar {
    size_t references;
    size_t count, *first; /* [count] contacts */
    unsigned char *role;  /* [n] */
    double (*own)[3];     /* [count] R of the contact alone: 11, 12, 22 */
    size_t clusters, islands, largest;
    struct cluster *cluster; /* [clusters] */
    size_t *member;
    double *r;
    size_t *group_of; /* [n] that of the operator, but TRIBO_ALONE for members of clusters */
};

/* What a context keeps from call to call, and its workspace. */
struct plane {
    struct disc_qp problem;
    size_t *near;              /* [largest] places of the directions in the problem */
    unsigned char *directions; /* [largest] of the contact that begins with one of them: 2, 1, or 0 if none does */
    size_t cuts;               /* directions in the problem with a reach below their limit */
    double *y;                 /* [n] what was found, in parts of the reach */
    double *radius;            /* [n] the reach of a contact's problem is that, or its limit if that is less */
    double *v, *a;             /* [n] of the last tribo_balance_tangent */
    double *shift;             /* [largest] c of the lenses of the problem, in parts of limits */
    double *pull;              /* [largest] R f + a without the forces of the problem */
    double *unit, *df, *other; /* [n] workspace; the first is zero between calls */
    double *dlimit;            /* [n] how limits change that follow v */
    size_t solved;             /* clusters, in the last call */
};

/* Of a cluster with more directions than this no matrix is kept. */
#define TRIBO_CLUSTER_MOST 2048

struct planar *tribo_planar_share(struct planar *planar); /* NULL is fine here and below */
void tribo_planar_release(struct planar *planar);
int tribo_plane_create(struct plane *plane, const struct planar *planar, size_t n); /* 1, or 0 if out of memory */
void tribo_plane_free(struct plane *plane);

/* A contact in motion, in units in which the direction with the longer way to the edge of its band has limit 1. */
struct slide {
    int open;
    size_t far;     /* that direction, 0 or 1 */
    double part[2]; /* limits, in these units */
    double x[2];    /* part v */
    double n[2];    /* its direction, or 0 */
    double length;  /* |x| */
    double epsilon; /* the length at which the contact slides */
    double speed;   /* length/epsilon */
};
/* The law of a planar contact whose f_eq is given: its limits there, and its motion. */
struct given {
    double limit[2];
    struct contacts c; /* of its two directions */
    struct slide s;
    int near;
};

struct slide tribo_planar_slide(const struct contacts *c, size_t i, const double *v);

/* Whether the force of a contact is not known from its velocity alone. */
int tribo_planar_near(const struct law *law, const struct slide *s);

/* The same for a scalar contact at v. */
int tribo_scalar_near(const struct law *law, const struct contacts *c, size_t i, double v);

/* R_ii = 0 is the limit of R_ii from above: in parts of the largest R_ii it is this. */
#define NEXT_TO_IMMOVABLE 1e-200

/* A symmetric block 11, 12, 22 by its eigenvalues, and the direction of the greater one. */
struct block {
    double great, small; /* >= 0 */
    double e[2];
};
struct block tribo_block_of(const double *own);

/* x = -block^-1 x. What friction cannot move, in a direction of its own or because the two are one, goes far away. */
void tribo_planar_push(const struct block *b, double *x);

/* What part of its limit a contact carries that is not near stick, counted along n, and how that follows speed. */
double tribo_planar_carried(const struct law *law, double speed, double *slope);

#endif
