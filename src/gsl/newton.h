/* Newton's method for the stages of an implicit step of y' = f(t, y): slopes k_i = f(t_i, base + h sum_j a_ij k_j). */
#ifndef TRIBO_NEWTON_H
#define TRIBO_NEWTON_H

#include "system.h"

struct newton {
    size_t n, stages;
    double h;       /* that the matrix belongs to; 0: there is none */
    double *matrix; /* [stages n][stages n] factors of I - h a x J */
    size_t *pivot;
    double *residual;         /* [stages][n] */
    double *stage, *jacobian; /* [n], [n][n] */
    double *by_time;          /* [n] */
};

/* 1, or 0 if out of memory; tribo_newton_free takes both. */
int tribo_newton_create(struct newton *w, size_t n, size_t stages);
void tribo_newton_free(struct newton *w);

/* Solves for k [stages][n], in: a guess, to a hundredth of the tolerance of y [n]. The matrix is kept from call to call while it
 * serves. Returns a GSL status: GSL_FAILURE if a shorter step should be tried, in particular where the matrix is singular. */
int tribo_newton_solve(struct newton *w, tribo_system *sys, const double *time, double h, const double *a, const double *base,
                       const double *tolerance, double *k);

#endif
