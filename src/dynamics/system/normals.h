/* SPDX-License-Identifier: BSD-3-Clause */
/* Limits mu N by normal loads N(q) (Yang and Menq 1998). Row n of J is a normal direction:
 *     depth = J_n q - gap,   N = stiffness max(0, depth),   limit of each contact of the normal = mu N,
 * and the bodies get -J_n' N. While the normal is pressed, N is linear in q: the forces of the structure, its limits, and their
 * derivatives in time follow from those of q. Row n has limit 0, and no friction. */
#ifndef TRIBO_NORMALS_H
#define TRIBO_NORMALS_H

#include <stddef.h>

struct tribo_system;

/* A call of tribo_model_set_normal. */
struct normal_input {
    size_t contact, row;
    double mu, stiffness, gap;
};

struct normal {
    size_t row; /* of J */
    double stiffness, gap;
    int pressed;         /* 1: depth > 0 */
    double depth, speed; /* depth and its rate, of the motion that tribo_normals_move was called with last */
    double size;         /* size of the terms of the depth, likewise */
};

struct follower {
    size_t contact, normal; /* normal: index in normals.normal */
    double mu;
    size_t second; /* second direction of a planar contact, which has the same limit; else contact */
};

struct normals {
    size_t count, followers;   /* count 0: all other members are empty */
    struct normal *normal;     /* [count] */
    struct follower *follower; /* [followers] */
    size_t *at, *by;           /* [ncontact] 1 + index of the normal at this row; 1 + index of the follower here; 0: none */
    double *force;             /* [ncontact] workspace; 0 but at the rows of normals */
    double stiffest;           /* bound of what normals and sliding contacts add to omega^2 */
};

/* Takes the inputs [count] of a model for sys, which has its compliance. Returns a status, its message in message. */
int tribo_normals_create(struct tribo_system *sys, size_t count, const struct normal_input *input, char *message);
int tribo_normals_copy(struct tribo_system *to, const struct tribo_system *from); /* 1, or 0 if out of memory */
void tribo_normals_free(struct normals *s);

/* Returns TRIBO_ERR_UNSUPPORTED, with a message in the system, if limit [ncontact] > 0 at a normal, or at a contact that has
 * one. */
int tribo_normals_check_limits(const struct tribo_system *sys, const double *limit);

/* Sets the second directions of planar contacts. Call where settings change. Returns a status. */
int tribo_normals_pair(struct tribo_system *sys);

/* move: sets depth, speed and size by q, u. set: likewise, pressed by depth > 0, and the limits of the contacts at the set
 * time. */
void tribo_normals_move(struct tribo_system *sys, const double *q, const double *u);
void tribo_normals_set(struct tribo_system *sys, const double *q, const double *u);

/* limit, rate [ncontact]: sets those of followers to mu stiffness times depth and speed, < 0 where a contact has lifted off; 0 at
 * normals. */
void tribo_normals_limits(const struct tribo_system *sys, double *limit, double *rate);

/* to [ndof] -= factor B_n stiffness (J_n x - gap) over the normals pressed (all = 1: over all normals); gap = 0: without the
 * gap. */
void tribo_normals_push(const struct tribo_system *sys, int all, int gap, double factor, const double *x, double *to);

#endif
