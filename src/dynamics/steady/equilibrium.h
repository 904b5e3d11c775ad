/* SPDX-License-Identifier: BSD-3-Clause */
/* Steady sliding: bases move at constant velocities, contacts slide or rest, and q' = 0. The equilibrium q, and small motions x
 * about it,
 *     M x'' + (C - J'(df/dv) J) x' + (K - J'(df/dq)) x = 0,   J_H x = 0,   H: the rigid contacts at rest. */
#ifndef TRIBO_EQUILIBRIUM_H
#define TRIBO_EQUILIBRIUM_H

#include "dynamics/system/system.h"

struct equilibrium {
    tribo_system *sys;        /* a copy of the caller's, without loads that depend on time */
    char *message;            /* [TRIBO_MESSAGE] of the caller's system */
    tribo_context *probe;     /* Coulomb's law, with the settings of the contacts */
    const signed char *given; /* [ncontact] as in tribo_system_equilibrium, or NULL */
    double friction, speed;   /* factors of limits and coefficients of friction; of base velocities */
    double *y;                /* [tribo_system_size] state by which sliders, and J q of contacts at rest, are known */
    signed char *slip;        /* [ncontact] TRIBO_SLIP_... */
    unsigned char *pair;      /* [ncontact] PAIR_... */
    double *base, *limit;     /* [ncontact] velocities; limits at high speed, 0 of followers */
    double *unit;             /* [ncontact] force of a contact that slides; of a follower per depth of its normal */
    double *slope;            /* [ncontact][ncontact] df/dv of contacts that slide; of followers per depth */
    double *hold;             /* [ncontact] J q + G f of contacts at rest */
    unsigned char *pressed;   /* [normals] 1: the normal presses */
    double *depth, *lift;     /* [normals] of the equilibrium; lift: - depth of a normal that does not press, else 0 */
    double *load;             /* [ndof] constant load, a force */
    size_t modes;             /* number of displacements that contacts at rest allow */
    double *shape;            /* [ndof][modes] these, orthonormal in M */
    double *q, *f;            /* [ndof] the equilibrium; [ncontact] forces, of rigid contacts at rest 0 */
    double *residual;         /* [ndof] workspace */
    double *way, *force;      /* [ncontact][ndof + 1] workspace */
    double *moved;            /* [ndof][modes] workspace */
    double *matrix, *scale;   /* [modes][modes], [modes] factors of the stiffness with all normals pressed */
    int *pivot;               /* [modes] */
};

/* Creates e for sys, the caller's; y: the caller's state, NULL: zeros. Returns a status, its message in sys.
 * tribo_equilibrium_free takes an e that failed. */
int tribo_equilibrium_create(struct equilibrium *e, tribo_system *sys, const signed char *given, const double *y);
void tribo_equilibrium_free(struct equilibrium *e);

/* Finds slip, pressed, depth, q and f. Returns a status, its message in e->message. */
int tribo_equilibrium_find(struct equilibrium *e);

/* a [modes][modes] = shape'(K - J'(df/dq)) shape. Returns 1 if a is symmetric. */
int tribo_equilibrium_stiffness(const struct equilibrium *e, double *a);

/* a [modes][modes] = shape'(C - J'(df/dv) J) shape. Returns 0 if there is no damping. */
int tribo_equilibrium_damping(const struct equilibrium *e, double *a);

/* 1 if contact i slides. */
static inline int tribo_equilibrium_slides(const struct equilibrium *e, size_t i)
{
    return e->slip[i] != TRIBO_SLIP_STUCK && e->slip[i] != TRIBO_SLIP_OPEN;
}

/* Exponents of small motions: x is proportional to e^(lambda t). */
struct exponents {
    size_t count;    /* of exponents with im >= 0; im > 0 stands for a pair */
    double *re, *im; /* [count] largest re first, then largest im */
    int undamped;    /* 1: no damping, lambda^2 = - square */
    double *square;  /* [2][modes] real and imaginary parts of the squares of undamped motions */
};

/* Finds the exponents of the equilibrium found last; free(x->re) frees them, also after an error. Returns a status, its message
 * in e->message. */
int tribo_equilibrium_exponents(const struct equilibrium *e, struct exponents *x);

#endif
