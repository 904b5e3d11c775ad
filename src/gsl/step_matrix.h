/* The matrix A of a step of length h by the midpoint rule, factorized: I + h/2 AC + h^2/4 AK; of an unsolved system M A. Rows of
 * degrees of freedom without mass are those of K. */
#ifndef TRIBO_STEP_MATRIX_H
#define TRIBO_STEP_MATRIX_H

#include "system.h"

/* Either a band in GSL's format, or a sparse factor. */
struct step_matrix {
    size_t below, above;
    double *band;
    unsigned int *pivot;
    struct cholesky sparse; /* of M A */
    double *weight;         /* [ndof] M, if it is to be multiplied with before that solves; or NULL */
};

/* A status, whose message the system keeps. tribo_step_matrix_free takes what failed, too. */
int tribo_step_matrix_factorize(struct step_matrix *m, const tribo_system *sys, double h);
void tribo_step_matrix_free(struct step_matrix *m);

/* x [n] = A^-1 x. */
void tribo_step_matrix_solve(const struct step_matrix *m, size_t n, double *x);

/* Whether A is diagonal. */
int tribo_step_matrix_is_diagonal(const struct step_matrix *m);

/* TRIBO_ERR_INDEFINITE and TRIBO_ERR_MEMORY, and what they say. */
int tribo_step_matrix_singular(const tribo_system *sys, double h, size_t where);
int tribo_step_matrix_no_memory(const tribo_system *sys);

#endif
