/* SPDX-License-Identifier: BSD-3-Clause */
/* A step of "moreau/fixed" where each contact holds a body of its own to the base, and the matrix S of the step
 * (step_matrix.h) is a band. The operator that contacts see, J S^-1 J', would be dense. Here bodies that contacts hold are
 * rows and columns taken out of S: a step costs as much as the band has entries, and a new factor where other contacts hold. */
#ifndef TRIBO_STEP_BAND_H
#define TRIBO_STEP_BAND_H

#include "step_matrix.h"

struct step_band {
    size_t n, width;        /* degrees of freedom; 0: the system is not of that kind. Entries left of the diagonal */
    size_t count;           /* contacts */
    const struct matrix *s; /* S */
    double *l;              /* [n][width + 1] its factor without held bodies (band.h) */
    size_t *body;           /* [count] the body of a contact */
    size_t *contact;        /* [n] the contact on a body; count: none */
    double *lever;          /* [count] its entry of J */
    double *push, *move;    /* [n] impulses without friction; displacements of held bodies with their bases, in velocities */
    double *own;            /* [count] S_dd of the body */
    double *noise;          /* [count] error bound of forces by rounding */
    signed char *at;        /* [count] 0: holds; else the sign of its force */
    signed char *held;      /* [n] 1: a contact holds the body, in the factor */
    int factored;           /* 1: l belongs to held */
};

/* A step of length h from velocities u: limits, velocities of bases at its end; changes of velocities, forces. */
struct band_step {
    double h;
    const double *limit, *base, *u;
    double *du, *f;
};

/* Prepares steps with the S of m, which must outlive b. TRIBO_OK, also if the system is not of that kind (n = 0);
 * TRIBO_ERR_MEMORY; TRIBO_ERR_INDEFINITE with the place of a pivot that is not positive. Keeps `at`. */
int tribo_step_band_create(struct step_band *b, const tribo_system *sys, const struct step_matrix *m, size_t *where);
void tribo_step_band_free(struct step_band *b);

/* du: in, impulses of loads and structure; out, changes of velocities, with forces |f| <= limit for which v = J (u + du) -
 * base is 0 or against f. Returns 1; 0 if that is not found: then du is as before. */
int tribo_step_band_solve(struct step_band *b, const struct band_step *s);

#endif
