/* Contacts that hold, as constraints between degrees of freedom: J_I q = 0 makes some of them, the slaves, follow the others.
 *
 * J_I is eliminated as it stands. No mass enters its entries, so that the contact between a light and a heavy body is as
 * independent of that between the light one and the ground as if both weighed the same; in J M^-1 J' the heavy one is rounded
 * away. Masses only say which degree of freedom follows: of those that a contact ties together, the one that is lightest for
 * what it moves (complete pivoting of J_I M^-1/2, by which rows and columns of very different size keep their digits: Demmel and
 * others 1999, Linear Algebra Appl. 299, 21, doi:10.1016/S0024-3795(99)00134-2). */
#ifndef TRIBO_CONSTRAINT_H
#define TRIBO_CONSTRAINT_H

#include "matrix.h"

/* Rows that share degrees of freedom with each other, and with no other row. */
struct tie {
    size_t rows, rank; /* how many they are; how many of them are independent */
    size_t touched;    /* degrees of freedom */
    size_t *order;     /* [rows] places in the caller's list: independent rows, in the order of their pivots, and others */
    size_t *dof;       /* [touched] the slaves, one for each independent row, in order, and others */
    double *entry;     /* [rows][touched] in these orders; L and U of the slaves, and U^-1 L^-1 of the rest of independent rows */
};

struct constraints {
    size_t count, rank; /* of all ties */
    size_t *order;      /* [count] places in the list of rows: rank independent ones, and others */
    size_t ties;
    struct tie *tie;
    double *work;    /* [count] */
    void *memory[2]; /* of these, and of the ties' arrays */
};

/* For the rows of direction that row [count] names. mass [cols][cols] (no rows: the identity) gives its diagonal.
 * last [count]  Rows of which some must be left out, since they depend on others, are rather those where last is greater. What
 *               follows from others to half the digits counts as dependent, as where contacts share forces by J M^-1 J'.
 *               NULL: all should be independent, and only rounding is zero.
 * Returns 1, or 0 if out of memory. tribo_constraints_free takes what failed too. */
int tribo_constraints_create(struct constraints *c, const struct matrix *direction, const struct matrix *mass, const size_t *row,
                             size_t count, const unsigned char *last);
void tribo_constraints_free(struct constraints *c);

/* How many rows of direction are independent, to half the digits; more than there are rows if out of memory. */
size_t tribo_constraints_rank(const struct matrix *direction, const struct matrix *mass);

/* The following is for rank = count, and last = NULL. */

/* z [ndof][ndof - count]: q = z y are the displacements that the constraints allow. Where they tie pairs, its entries are exact.
 * 0 if out of memory. */
int tribo_constraints_basis(const struct constraints *c, size_t ndof, struct matrix *z);

/* Adds to q [ndof] displacements of slaves with J_I q = b. b [count]. */
void tribo_constraints_follow(const struct constraints *c, const double *b, double *q);

/* The forces f [count] with J_I'f = force [ndof] in all slaves; in all degrees of freedom, if force has no power in what the
 * constraints allow (Z'force = 0). */
void tribo_constraints_react(const struct constraints *c, const double *force, double *f);

#endif
