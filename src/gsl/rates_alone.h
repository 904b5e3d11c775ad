/* Accelerations with friction where contacts share no body, block by block of degrees of freedom: all that is found on the way
 * stays in the nearest cache. Each block has contacts of its own, one for each degree of freedom; blocks that are alike have them
 * in common, so that they do not come from memory. */
#ifndef TRIBO_RATES_ALONE_H
#define TRIBO_RATES_ALONE_H

#include "bodies_alone.h"

/* Of the degrees of freedom of a block, [n] each; 0 where there is no contact. */
struct rates_block {
    tribo_context *contacts;
    double *turn;     /* J */
    double *mobility; /* B */
    double *tally;
    double *limit, *epsilon, *r; /* R; of what has no contact 1 */
    int direct;                  /* J is 1 for all */
};

struct rates_alone {
    struct bodies_alone bodies;
    struct rates_block *block; /* [blocks] */
    size_t blocks;
    double *memory, *own; /* what is allocated; of all degrees of freedom what blocks have, one array after the other */
    double *f, *v, *a;    /* [MATRIX_BLOCK] rooms: forces; velocities and accelerations of contacts */
    int fits;             /* rates can be found with the settings of this revision of the system: */
    size_t revision;
};

/* 1, or 0 if out of memory. What failed may be freed too. */
int tribo_rates_create(struct rates_alone *r, const tribo_system *sys);
void tribo_rates_free(struct rates_alone *r);

/* Makes contacts for the settings as they are, if rates can be found with them. It costs as much as some steps. */
void tribo_rates_prepare(struct rates_alone *r, tribo_system *sys);

/* Whether rates can be found, and the settings are those that contacts were made for. */
int tribo_rates_fit(const struct rates_alone *r, const tribo_system *sys);

/* a = accelerations of block k at the time that the bodies have been told, a from its first degree of freedom on, q and u from
 * that of the system; adds what friction dissipates to the power. A status; its message is on the block's contacts. */
int tribo_rates_block(const struct rates_alone *r, const tribo_system *sys, size_t k, const double *q, const double *u, double *a,
                      double *power);

#endif
