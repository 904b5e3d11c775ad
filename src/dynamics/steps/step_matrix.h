/* Factors of the matrix S = M + h/2 C + h^2/4 K of a midpoint step of length h. Degrees of freedom without mass enter S only by
 * the stiffness of the other ones (condense.c). */
#ifndef TRIBO_STEP_MATRIX_H
#define TRIBO_STEP_MATRIX_H

#include "dynamics/system/system.h"

/* of = K or C; with weighed = 1, M^-1 K or M^-1 C. */
struct step_part {
    const struct matrix *of; /* no rows: zero */
    int weighed;
};

struct step_part tribo_step_stiffness(const tribo_system *sys);
struct step_part tribo_step_damping(const tribo_system *sys);

/* A factor of S: a band as in band.h; for S not symmetric, a band in LAPACK's format; or a sparse factor. */
struct step_matrix {
    size_t n, below, above;
    double *band;
    int *pivot; /* NULL: symmetric band */
    struct cholesky sparse;
};

/* Factorizes S. Returns a status, with a message in the system. Call tribo_step_matrix_free also after an error. */
int tribo_step_matrix_factorize(struct step_matrix *m, const tribo_system *sys, double h);
void tribo_step_matrix_free(struct step_matrix *m);

/* x [count][n] = S^-1 x. Returns 1, or 0 if out of memory, which cannot happen for count = 1. */
int tribo_step_matrix_solve(const struct step_matrix *m, size_t count, double *x);

/* has_halves: returns 1 if S = H H' with the H of half_solve: x [n] = H^-1 x, and of half_solve_back: x [n] = H'^-1 x. */
int tribo_step_matrix_has_halves(const struct step_matrix *m);
void tribo_step_matrix_half_solve(const struct step_matrix *m, double *x);
void tribo_step_matrix_half_solve_back(const struct step_matrix *m, double *x);

/* Returns 1 if S is diagonal. */
int tribo_step_matrix_is_diagonal(const struct step_matrix *m);

/* Returns TRIBO_ERR_INDEFINITE, or TRIBO_ERR_MEMORY, with a message in the system. */
int tribo_step_matrix_indefinite(const tribo_system *sys, double h, size_t where);
int tribo_step_matrix_no_memory(const tribo_system *sys);

#endif
