/* Accelerations with friction where contacts share no body, block by block of degrees of freedom: all that is found on the way
 * stays in the nearest cache. Blocks that are alike are read in one place, so that they do not come from memory.
 *
 * A contact that has a body of its own is told in terms of that: f_eq accelerates it by -a, and so f by -a, but by |B| limit at
 * most, and in the band of a law that relaxes by what goes with the velocity besides. Neither J nor R is left. */
#ifndef TRIBO_RATES_ALONE_H
#define TRIBO_RATES_ALONE_H

#include "bodies_alone.h"

/* Of the degrees of freedom of a block. */
struct rates_block {
    double *mass, *brake; /* see bodies_alone.h */
    double *band, *rate;  /* epsilon and slope, of velocity and acceleration of the body; no contact brakes by 0 */
};

/* Laws inside the band: held and slowed down besides, only slowed down, or only held. Outside all slide, to which the first two
 * lead by themselves: at the edge of the band they brake by 2 |B| limit, or |B| limit. */
enum grip { RELAXES, CREEPS, HOLDS };

/* Times at which loads are known. */
enum { RATES_TIMES = 3 };

struct rates_alone {
    struct bodies_alone bodies;
    struct rates_block *block; /* [blocks] */
    size_t blocks;             /* 0: contacts share bodies */
    size_t reach;              /* no block pulls at one that is farther away */
    double *memory, *own;      /* what is allocated; of all degrees of freedom what blocks have, one array after the other */
    double *load[RATES_TIMES]; /* [ndof] accelerations */
    enum grip grip;
    int fits; /* rates can be found with the settings of this revision of the system: */
    size_t revision;
};

/* 1, or 0 if out of memory. What failed may be freed too. */
int tribo_rates_create(struct rates_alone *r, const tribo_system *sys);
void tribo_rates_free(struct rates_alone *r);

/* Takes the settings as they are, if rates can be found with them. It costs as much as a step. */
void tribo_rates_prepare(struct rates_alone *r, tribo_system *sys);

/* Whether rates can be found, and the settings are those that were taken. */
int tribo_rates_fit(const struct rates_alone *r, const tribo_system *sys);

/* Finds the loads at a time, which from then on is number k, and sets the system's time. */
void tribo_rates_set_time(struct rates_alone *r, tribo_system *sys, size_t k, double t);

/* a = accelerations of block k at time number `time`, a from its first degree of freedom on, q and u from that of the system.
 * Returns what friction dissipates. Nothing is checked: numbers that are not finite make some of a such. */
double tribo_rates_block(struct rates_alone *r, const tribo_system *sys, size_t time, size_t k, const double *q, const double *u,
                         double *a);

#endif
