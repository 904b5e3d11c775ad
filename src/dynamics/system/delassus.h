/* SPDX-License-Identifier: BSD-3-Clause */
/* The operator J A^-1 J' of contacts, for any matrix A. */
#ifndef TRIBO_DELASSUS_H
#define TRIBO_DELASSUS_H

#include "numerics/matrix.h"

/* x [count][j->cols] = A^-1 x for count vectors. Returns 1, or 0 if out of memory. */
typedef int delassus_solve(const void *a, size_t count, double *x);

/* r [j->rows][j->rows] = J A^-1 J', a few rows of J at a time; own as in tribo_hidden. Returns 1, or 0 if out of memory. */
int tribo_delassus_by_columns(const struct matrix *j, delassus_solve *solve, const void *a, double *r, double *own);

/* A heavy body behind a light body, hidden by the rounding of R. */
struct hidden {
    size_t contact; /* contact with the largest spread */
    double spread;  /* ratio of the largest to the smallest share J^2/m in R_ii of `contact` */
};

/* r [ncontact][ncontact] = J X, X = responses of the bodies to contact forces. own [entries of J]: the entry of X of the same
 * contact and degree of freedom. Returns 1 if R hides a body, 0 if not, -1 if out of memory. */
int tribo_hidden(const struct matrix *direction, const struct matrix *mass, const double *own, const double *r,
                 struct hidden *where);

#endif
