/* The box-constrained quadratic program that balance, step force and event decisions share, and the semidefinite linear system
 * of the partition coupling. Dense; matrices row-major; no allocation after tribo_solver_create. */
#ifndef TRIBO_SOLVER_H
#define TRIBO_SOLVER_H

#include <stddef.h>

struct solver {
    size_t capacity;
    /* the problem: G [n][n] positive semidefinite, q, lo, hi [n]; x [n] holds the start, then the solution */
    double *g, *q, *lo, *hi, *x;
    /* of the solution: gradient G x + q, what of it is rounding, and where x is: -1 at lo, +1 at hi, 0 inside */
    double *gradient, *noise;
    signed char *at;
    /* factor of the scaled submatrix of the set: rows in pivot order, the first rank of them independent */
    double *factor, *scale, *step, *rhs;
    size_t *set, size, rank;
    size_t factorizations, updates;
};

int tribo_solver_create(struct solver *s, size_t capacity); /* 1, or 0 if out of memory */
void tribo_solver_free(struct solver *s);

/* min 1/2 x'Gx + q'x, lo <= x <= hi. Returns 1, or 0 without convergence. */
int tribo_solver_box(struct solver *s, size_t n);

/* Factorizes G for tribo_solver_linear, which makes x the minimum-norm solution of G x + q = 0 and returns 1, or 0 if there is
 * none: then x is the least-squares one. */
void tribo_solver_prepare(struct solver *s, size_t n);
int tribo_solver_linear(struct solver *s, size_t n);

/* Rank of G, or -1 if it is indefinite and *where (an index) has the offending pivot *value. */
long tribo_solver_rank(struct solver *s, size_t n, size_t *where, double *value);

#endif
