/* SPDX-License-Identifier: BSD-3-Clause */
/* The matrix S = M + h/2 C + h^2/4 K of a midpoint step of length h, K with the pressed normals, and its factor. Degrees of
 * freedom without mass enter S only by the stiffness of the other ones (condense.c). */
#ifndef TRIBO_STEP_MATRIX_H
#define TRIBO_STEP_MATRIX_H

#include "dynamics/system/system.h"

struct step_matrix {
    struct matrix s; /* S; no rows once a sparse factor has taken its memory */
    size_t n, below, above;

    /* The factor: a band of rows; for S not symmetric, a band in LAPACK's format; or a sparse factor. */
    double *band;
    int *pivot; /* NULL: symmetric band */
    struct cholesky sparse;

    /* Each contact holds a body of its own to the base, and S is a narrow band: the operator that contacts see, J S^-1 J', would
     * be dense. Bodies that contacts hold are rows and columns taken out of S: a step costs as much as the band has entries, and
     * a new factor where other contacts hold. */
    size_t count;        /* contacts; 0: steps need the operator of contacts */
    size_t *body;        /* [count] the body of a contact; owns the memory of the arrays below */
    size_t *contact;     /* [n] the contact on a body; count: none */
    double *lever, *own; /* [count] its entry of J; S_dd of the body */
    double *push, *move; /* [n] impulses without friction; displacements of held bodies with their bases, in velocities */
    double *noise;       /* [count] error bound of forces by rounding */
    signed char *at;     /* [count] 0: holds; else the sign of its force */
    signed char *held;   /* [n] not 0: a contact holds the body, in the factor; NULL: none */
};

/* Computes S and its factor, with no body held. holds = 0: contacts are not to hold bodies. Returns a status, with a message in
 * the system. Call tribo_step_matrix_free also after an error. */
int tribo_step_matrix_create(struct step_matrix *m, const tribo_system *sys, double h, int holds);
void tribo_step_matrix_free(struct step_matrix *m);

/* x [count][n] = S^-1 x, matrix: struct step_matrix with no body held. Returns 1, or 0 if out of memory, which cannot happen for
 * count = 1. */
int tribo_step_matrix_solve(const void *matrix, size_t count, double *x);

/* A step of length h from velocities u: limits, velocities of bases at its end; changes of velocities, forces. */
struct band_step {
    double h;
    const double *limit, *base, *u;
    double *du, *f;
};

/* du: in, impulses of loads and structure; out, changes of velocities, with forces |f| <= limit for which v = J (u + du) -
 * base is 0 or against f, by bodies held. Returns 1; 0 if count = 0, if contacts are not plain, or if that is not found: then du
 * is as before, and no body held. */
int tribo_step_matrix_hold(struct step_matrix *m, const tribo_system *sys, const struct band_step *s);

#endif
