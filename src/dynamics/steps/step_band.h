/* A step of "moreau/fixed" where every contact holds a body of its own to the base and the matrix of the step, A here and S in
 * step_matrix.h, is a band: the operator that contacts see, J A^-1 J', would be dense, but A itself is not. Contacts that hold
 * are rows and columns taken out of A, so that a step costs as much as the band has entries, and a new factor where other
 * contacts hold. */
#ifndef TRIBO_STEP_BAND_H
#define TRIBO_STEP_BAND_H

#include "dynamics/system/system.h"

struct step_band {
    size_t n, width;     /* n = 0: the system is not of that kind; entries left of the diagonal */
    size_t count;        /* contacts */
    double *a, *l;       /* [n][width + 1] A = M + h/2 C + h^2/4 K, and its factors without who is held (band.h) */
    size_t *body;        /* [count] whom a contact holds */
    size_t *contact;     /* [n] who does that; count: nobody */
    double *lever;       /* [count] its entry of J */
    double *inverse;     /* [count] one over it */
    double *mass;        /* [n] */
    double *push, *move; /* [n] what pushes the bodies; how held ones move */
    double *noise;       /* [count] how much force may be rounding */
    signed char *at;     /* [count] 0: holds; else the sign of its force */
    signed char *held;   /* [n] whether a contact holds the body, in the factor */
    int factored;
};

/* For steps of length h. TRIBO_OK, also if the system is not of that kind; TRIBO_ERR_MEMORY; TRIBO_ERR_INDEFINITE with the place
 * of a pivot that is not positive. Which contacts hold stays as it is. */
int tribo_step_band_create(struct step_band *b, const tribo_system *sys, double h, size_t *where);
void tribo_step_band_free(struct step_band *b);

/* In: du, the impulse of loads and structure in the step, which the velocities u begin; out: how these change, and the
 * forces f, |f| <= limit, with which v = J (u + du) - base is zero or against f. 1; or 0 if that has not been found: then du is
 * as before. */
int tribo_step_band_solve(struct step_band *b, double h, const double *limit, const double *base, const double *u, double *du,
                          double *f);

#endif
