/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts that hold, as constraints between degrees of freedom: by J_I q = 0 some of them, the slaves, follow the others.
 *
 * J_I is eliminated as it stands, without masses: in J M^-1 J' the mass of a heavy body is rounded away beside that of a light
 * one, and contacts of the two look dependent. Masses choose the slaves, by complete pivoting of J_I M^-1/2, which keeps the
 * digits of rows and columns of very different size (Demmel and others 1999, Linear Algebra Appl. 299, 21,
 * doi:10.1016/S0024-3795(99)00134-2). */
#ifndef TRIBO_CONSTRAINT_H
#define TRIBO_CONSTRAINT_H

#include "matrix.h"

/* Rows that share degrees of freedom with each other, and with no other row. */
struct tie {
    size_t rows;
    size_t rank;    /* independent rows */
    size_t touched; /* degrees of freedom */
    size_t *order;  /* [rows] places in the caller's list: independent rows, in the order of their pivots, then the others */
    size_t *dof;    /* [touched] the slave of each independent row, in order, then the others */
    size_t stride;  /* touched + rows; touched if only the rank is wanted */
    double *entry;  /* [rows][stride] W J_I beside the slaves, W = (J_I of the slaves)^-1; W from column touched on */
};

struct constraints {
    size_t count, rank; /* of all ties */
    size_t *order;      /* [count] places in the list of rows: rank independent ones, then the others */
    size_t ties;
    struct tie *tie; /* [ties] */
    void *memory[2]; /* of these arrays, and of the arrays of the ties */
};

/* Eliminates the rows row [count] of direction. The diagonal of mass [cols][cols] (no rows: the identity) chooses the slaves.
 * last [count]  Rows that depend on others are those of the largest last, where there is a choice, and rows count as dependent if
 *               they are so to half the digits, as where contacts share forces by J M^-1 J'. NULL: only rounding is 0.
 * Returns 1, or 0 if out of memory. tribo_constraints_free also takes a c that failed. */
int tribo_constraints_create(struct constraints *c, const struct matrix *direction, const struct matrix *mass, const size_t *row,
                             size_t count, const unsigned char *last);
void tribo_constraints_free(struct constraints *c);

/* Returns the number of rows of direction that are independent to half the digits; rows + 1 if out of memory. */
size_t tribo_constraints_rank(const struct matrix *direction, const struct matrix *mass);

/* The following need rank = count and last = NULL. */

/* z [ndof][ndof - count]: q = z y are the displacements with J_I q = 0. Entries are exact where rows tie pairs. Returns 1, or 0
 * if out of memory. */
int tribo_constraints_basis(const struct constraints *c, size_t ndof, struct matrix *z);

/* Adds displacements of slaves with J_I q = b [count] to q [ndof]. */
void tribo_constraints_follow(const struct constraints *c, const double *b, double *q);

/* f [count][columns] = the forces with J_I'f = force [][columns] in all slaves; in all degrees of freedom if Z'force = 0. force
 * has rows for degrees of freedom rows[0] to rows[1] - 1, and is 0 elsewhere. */
void tribo_constraints_react(const struct constraints *c, const size_t *rows, size_t columns, const double *force, double *f);

#endif
