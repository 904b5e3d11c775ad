/* SPDX-License-Identifier: BSD-3-Clause */
/* The matrix S = M + h/2 C + h^2/4 K of a midpoint step of length h, and its factors. Degrees of freedom without mass enter S
 * only by the stiffness of the other ones (condense.c). */
#ifndef TRIBO_STEP_MATRIX_H
#define TRIBO_STEP_MATRIX_H

#include "dynamics/system/system.h"

struct step_matrix {
    const struct matrix *k, *c; /* K and C, of forces: of the system, or in own; no rows: zero */
    struct matrix own[2];
    struct matrix s; /* S; no rows once a sparse factor has taken its memory */
    size_t n, below, above;

    /* The factor: a band as in band.h; for S not symmetric, a band in LAPACK's format; or a sparse factor. */
    double *band;
    int *pivot; /* NULL: symmetric band */
    struct cholesky sparse;
};

/* create: sets k, c and s. factorize: computes the factor; may free s if consumes = 1. Each returns a status, with a message in
 * the system. Call tribo_step_matrix_free also after an error. */
int tribo_step_matrix_create(struct step_matrix *m, const tribo_system *sys, double h);
int tribo_step_matrix_factorize(struct step_matrix *m, const tribo_system *sys, double h, int consumes);
void tribo_step_matrix_free(struct step_matrix *m);

/* x [count][n] = S^-1 x, matrix: struct step_matrix. Returns 1, or 0 if out of memory, which cannot happen for count = 1. */
int tribo_step_matrix_solve(const void *matrix, size_t count, double *x);

/* Returns status, with a message in the system: TRIBO_ERR_INDEFINITE at degree of freedom `where`, or TRIBO_ERR_MEMORY. */
int tribo_step_matrix_fail(const tribo_system *sys, int status, double h, size_t where);

#endif
