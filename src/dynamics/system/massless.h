/* Degrees of freedom without mass, which the stiffness holds: sliders of elastic contacts, and whatever a model leaves without
 * mass. With w for these and q for the others, they follow by K_ww w = J_w'f - K_wq q:
 *     w = follow q + give f.
 * Contacts that touch any are elastic, and give way by C f, C = J_w K_ww^-1 J_w' positive definite over the elastic contacts: the
 * forces follow from the state alone. */
#ifndef TRIBO_MASSLESS_H
#define TRIBO_MASSLESS_H

#include "numerics/definite.h"
#include "numerics/matrix.h"

struct massless {
    size_t count;               /* 0: there are none, and the rest is empty */
    unsigned char *is;          /* [ndof] */
    struct matrix follow, give; /* [ndof][ndof] and [ndof][ncontact], of which only rows of w have entries */
    double *compliance;         /* [ncontact] C_ii, 0: a rigid contact */
    struct definite *shared;    /* C, if it is not diagonal; else NULL */
    double stiffest;            /* omega^2 is no larger, whichever contacts hold */
    double own, added;          /* the largest of one degree of freedom if no contact holds; and what the spring of */
    size_t tightest;            /* this contact adds to that of one, more than others */
};

/* 1, or 0 if out of memory. tribo_massless_free takes what failed too. */
int tribo_massless_copy(struct massless *to, const struct massless *from, size_t ndof, size_t ncontact);
void tribo_massless_free(struct massless *m);

/* Whether contact i is elastic: then its force is known from the state. */
static inline int tribo_massless_touches(const struct massless *m, size_t i)
{
    return m->count && m->compliance[i] > 0.0;
}

static inline int tribo_has_mass(const struct massless *m, size_t d)
{
    return m->count == 0 || !m->is[d];
}

/* x [ndof]: w = follow q, what follows from q if contacts have no force. */
void tribo_massless_follow(const struct massless *m, double *x);

#endif
