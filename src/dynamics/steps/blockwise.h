/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps and rates of systems whose contacts share no body: each contact acts on a degree of freedom of its own, so that
 * friction needs no solver. Work goes block by block of MATRIX_BLOCK degrees of freedom, whose numbers stay in the nearest
 * cache.
 *
 * A step of central differences looks only at blocks that are awake. Awake are: all blocks at the first step and after a change
 * of settings; in every step, blocks with a load, a base or a limit that depends on time; after a step in which block k moved,
 * all blocks from the first to the last one that displacements or velocities of block k accelerate. Blocks are taken in their
 * order, so that the energy is the same sum.
 *
 * A block that is left out cannot move. In the step before, it began and ended with velocity 0, and |a| <= |B| limit held for
 * each of its rows. None of the blocks that accelerate it has moved; load, limits and bases are constant: a is the
 * same to the last bit. A step begins with u = 0, which becomes h a without friction and 0 with it: |h a| <= h |B| limit for
 * every h, since rounding is monotonic. Both arrays of states, which steps write by turns, hold the same displacement. It is not
 * enough that a step of one length did not move the block: lengths differ by rounding. */
#ifndef TRIBO_BLOCKWISE_H
#define TRIBO_BLOCKWISE_H

#include "dynamics/system/system.h"

struct blockwise {
    size_t *body;           /* [ncontact] degree of freedom of each contact; owns all memory; NULL: contacts share bodies */
    double *turn;           /* [ncontact] entry of J there */
    double *mass;           /* [ndof] tally J/B: the power of friction is mass a u; 0 without contact */
    double *brake;          /* [ndof] |B| limit: the largest acceleration by friction */
    double *band, *rate;    /* [ndof] epsilon/|J|; slope of the law inside the band, see tribo_blockwise_take_law */
    double grip;            /* 1: contacts inside the band oppose the acceleration, up to the limit; 0: they do not */
    double *before, *after; /* [ndof] velocities of the bases at both ends of a step */
    double *load, when;     /* [ndof] accelerations by loads at the time `when`; NaN: not computed */
    double *room;           /* [ncontact] workspace */
    size_t blocks;
    size_t *first, *last;         /* [blocks] block k accelerates no blocks before first[k] or after last[k] */
    unsigned char *driven;        /* [blocks] 1: a load, base or limit depends on time */
    unsigned char *awake, *wakes; /* [blocks] 1: awake in this step, not yet done; in the next step */
    int fits;                     /* 1: steps, or rates, can be taken with the settings */
    size_t revision;              /* of the system to which settings and fits belong */
};

/* A step of central differences: velocities u at the time `from` become u_to at the time `to`, by the forces at t and q over the
 * duration `time`; q_to = q + h u_to. time and h are given, since differences of times are known only to rounding. */
struct body_step {
    double from, t, to, time, h;
    const double *q, *u;
    double *q_to, *u_to; /* [ndof] with blockwise steps: the arrays that q and u were in the step before */
};

/* 1, or 0 if out of memory. tribo_blockwise_free frees what failed, too. */
int tribo_blockwise_create(struct blockwise *b, const tribo_system *sys);
void tribo_blockwise_free(struct blockwise *b);

/* Takes the system's settings for steps, and wakes all blocks. */
void tribo_blockwise_take(struct blockwise *b, tribo_system *sys);

/* Takes the system's settings for rates; they fit if bases and limits are constant and the law is none of the smooth ones. Costs
 * as much as an evaluation. */
void tribo_blockwise_take_law(struct blockwise *b, tribo_system *sys);

/* Adds the work of friction to *energy, the number of degrees of freedom left out to *rested. Returns 0 if the motion is not
 * finite. */
int tribo_blockwise_step(struct blockwise *b, tribo_system *sys, const struct body_step *s, double *energy, size_t *rested);

/* a [ndof] = accelerations with friction at t and y, *power = what friction dissipates. Checks nothing: a state that is not
 * finite makes some of a so. */
void tribo_blockwise_rates(struct blockwise *b, tribo_system *sys, double t, const double *y, double *a, double *power);

#endif
