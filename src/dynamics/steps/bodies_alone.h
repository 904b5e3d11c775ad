/* Steps of central differences where contacts share no body: each acts on one degree of freedom of its own, so that a step needs
 * no solver, and goes block by block of degrees of freedom through everything that is to be done. Blocks at rest are left out.
 *
 * A step looks only at blocks that are awake. All are when settings have changed or a motion begins; always are those on which
 * something acts that depends on time; and for the next step are those at which a block pulls that has moved. Blocks are taken in
 * their order, so that the energy is the same sum.
 *
 * A block left out cannot move. Before it was, a step looked at it, which began and ended with no velocity, so that both arrays
 * that steps write in turn have it where it is; and |a| <= |B| limit held for each of its rows at the end of that step. Its a
 * depends on places and velocities of blocks that pull at it, none of which has moved in that step or since, and on a load that
 * is constant: a is the same to the last bit, and so are limits, and bases stand still. The next step would begin with u = 0,
 * which becomes h a without friction and 0 with it: |h a| <= h |B| limit for every h, since rounding is monotonic. So it adds 0
 * to the place and to the energy, and leaves the block where it was. That a step of one length did not move the block would not
 * do: lengths differ by rounding, and |a| and |B| limit may be as close. */
#ifndef TRIBO_BODIES_ALONE_H
#define TRIBO_BODIES_ALONE_H

#include "dynamics/system/system.h"

struct body_rows {
    const double *mass, *brake; /* of the degrees of freedom of a block */
};

struct bodies_alone {
    size_t *body;                 /* [ncontact] degree of freedom; NULL: contacts share bodies */
    double *turn;                 /* [ncontact] J_i there */
    double *mass;                 /* [ndof] times how often the energy counts the contact; 0 without contact */
    double *brake;                /* [ndof] by what the contact can slow it down in a unit of time: |B| limit */
    struct body_rows *rows;       /* [blocks] where these two are read */
    double *before, *after;       /* [ndof] velocities of the bases at both ends of a step, 0 where there are none */
    double *load;                 /* [ndof] accelerations */
    double *room;                 /* [ncontact] */
    size_t blocks, skipped;       /* degrees of freedom left out, step by step, so far */
    size_t *first, *pulled;       /* block k pulls at blocks pulled[first[k]] to pulled[first[k + 1] - 1] */
    unsigned char *driven;        /* [blocks] load, base or limits depend on time: never at rest */
    unsigned char *loaded;        /* [blocks] there is a load */
    unsigned char *awake, *wakes; /* [blocks] 1: this step still has to look at it, the next one looks at it; else 0 */
    size_t *still, stills;        /* those that this step has looked at, and that have not moved */
    int goes_on;                  /* after is what the next step begins with */
    int fits;                     /* the settings are such that steps can be taken */
    size_t revision;              /* of the system */
};

/* A step: velocities u at the time from become those at to, by the forces at t and q over `time`, and q moves on with them for
 * h. These come from lengths of steps: what two times are apart is known only to their rounding. */
struct body_step {
    double from, t, to, time, h;
    const double *q, *u;
    double *q_to, *u_to; /* [ndof] which hold what the step before last left there, if that did go on */
};

/* 1, or 0 if out of memory. What failed may be freed too. */
int tribo_bodies_create(struct bodies_alone *b, const tribo_system *sys);
void tribo_bodies_free(struct bodies_alone *b);

/* Whether steps can be taken with the settings as they are; all blocks are awake then, and what steps go on from is forgotten. */
int tribo_bodies_begin(struct bodies_alone *b, tribo_system *sys);

/* How many degrees of freedom block k has. */
static inline size_t tribo_bodies_of_block(const tribo_system *sys, size_t k)
{
    const size_t left = sys->ndof - k * MATRIX_BLOCK;
    return left < MATRIX_BLOCK ? left : MATRIX_BLOCK;
}

/* Sets the system's time, and finds the loads. */
void tribo_bodies_set_time(struct bodies_alone *b, tribo_system *sys, double t);

/* a = the accelerations of block k without friction at the time set, a from its first degree of freedom on, q and u from that of
 * the system. */
void tribo_bodies_accelerate(const struct bodies_alone *b, const tribo_system *sys, size_t k, const double *q, const double *u,
                             double *a);

/* Adds what friction dissipates to the energy. 0 if the motion is no longer finite, else 1. */
int tribo_bodies_step(struct bodies_alone *b, tribo_system *sys, const struct body_step *s, double *energy);

#endif
