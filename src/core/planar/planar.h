/* SPDX-License-Identifier: BSD-3-Clause */
/* Data of planar contacts: which directions they are, and their clusters.
 *
 *   planar.c          life, settings: clusters, from the operator's groups and the contacts that join them
 *   planar_parts.c    sliding, nearness to stick, blocks of R, static limits
 *   planar_reach.c    reaches: stand-ins for limits that are far beyond forces
 *   planar_force.c    forces
 *   planar_tangent.c  derivatives; forces and derivatives where f_eq is given
 *
 * clusters.h declares what the rest of core calls, parts.h what these files share. */
#ifndef TRIBO_PLANAR_H
#define TRIBO_PLANAR_H

#include "numerics/disc/disc_qp.h"
#include "core/law/law.h"
#include "core/operator/operator.h"

/* Roles of a direction. */
enum { ROLE_SCALAR, ROLE_FIRST, ROLE_SECOND };

/* Directions that R or a planar contact joins, a planar contact among them. They ascend, so that both directions of a contact are
 * neighbours. */
struct cluster {
    size_t size;
    size_t *member; /* [size] */
    double *r;      /* [size][size] R */
    int redundant;  /* R is singular */
};

/* Planar contacts of a context; what it keeps of them from call to call; workspace. Without an operator there are no clusters. */
struct planar {
    size_t count, *first; /* [count] first directions */
    unsigned char *role;  /* [n] */
    double (*own)[3];     /* [count] R of the contact alone: 11, 12, 22 */
    size_t clusters, islands, largest;
    struct cluster *cluster; /* [clusters]; the first has the memory of R and of the members of all */
    size_t *group_of;        /* [n] that of the operator; TRIBO_ALONE for members of clusters */
    struct disc_qp problem;
    size_t *near;              /* [n + 1] places in the cluster of the problem's directions */
    size_t *contact;           /* [n] the contacts there */
    unsigned char *directions; /* [n] of the contact that begins with a direction of the problem: 1, 2; 0: none begins */
    size_t cuts;               /* directions of the problem with a reach below their limit */
    double *y;                 /* [n] solutions, in parts of the reach */
    double *radius;            /* [n] reach = min(limit, radius) */
    double *a;                 /* [n] of the last tribo_balance_tangent, or step */
    double *shift;             /* [n] c of the problem's lenses, in parts of limits */
    double *pull;              /* [n] R f + a without the forces of the problem */
    double *v, *df, *other;    /* [n] workspace */
    double *dlimit;            /* [n] changes of limits that depend on v */
};

/* The most directions of a cluster: its matrix is kept. */
#define TRIBO_CLUSTER_MOST 2048

#endif
