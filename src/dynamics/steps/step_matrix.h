/* The matrix S = M + h/2 C + h^2/4 K of a step of length h by the midpoint rule, factorized. It knows degrees of freedom without
 * mass by what stiffness they have. */
#ifndef TRIBO_STEP_MATRIX_H
#define TRIBO_STEP_MATRIX_H

#include "dynamics/system/system.h"

/* K or C; if weighed, M^-1 times that. */
struct step_part {
    const struct matrix *of; /* no rows: zero */
    int weighed;
};

struct step_part tribo_step_stiffness(const tribo_system *sys);
struct step_part tribo_step_damping(const tribo_system *sys);

/* The factor of S: a band as in band.h; if S is not symmetric, a band in the format of LAPACK; or a sparse factor. */
struct step_matrix {
    size_t n, below, above;
    double *band;
    int *pivot; /* NULL: the band is symmetric */
    struct cholesky sparse;
};

/* Returns a status, with the message of the system. tribo_step_matrix_free frees what failed, too. */
int tribo_step_matrix_factorize(struct step_matrix *m, const tribo_system *sys, double h);
void tribo_step_matrix_free(struct step_matrix *m);

/* x [count][n] = S^-1 x. 1, or 0 if out of memory, which does not happen if count is 1. */
int tribo_step_matrix_solve(const struct step_matrix *m, size_t count, double *x);

/* 1 if S = H H' for the H of the next two functions: x [n] = H^-1 x, and x = H'^-1 x. */
int tribo_step_matrix_has_halves(const struct step_matrix *m);
void tribo_step_matrix_half_solve(const struct step_matrix *m, double *x);
void tribo_step_matrix_half_solve_back(const struct step_matrix *m, double *x);

/* 1 if S is diagonal. */
int tribo_step_matrix_is_diagonal(const struct step_matrix *m);

/* TRIBO_ERR_INDEFINITE and TRIBO_ERR_MEMORY, with their messages. */
int tribo_step_matrix_indefinite(const tribo_system *sys, double h, size_t where);
int tribo_step_matrix_no_memory(const tribo_system *sys);

#endif
