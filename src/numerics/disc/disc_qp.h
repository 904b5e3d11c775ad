/* The convex quadratic program of contacts that a planar one is among: min 1/2 y's y + pull'y, where the y of each contact is in
 * its lens, or interval, in units of its limit. It knows nothing of friction, and allocates nothing.
 *
 *   lens.c        the set of one contact, and the point of it nearest to another
 *   tangent_qp.c  the way that the places of contacts leave y to go, and Newton's equations along it
 *   interior.c    an interior-point method, which needs no beginning
 *   disc_qp.c     solves the problem
 * Each calls those above it only, and the dense factor of box/. */
#ifndef TRIBO_DISC_QP_H
#define TRIBO_DISC_QP_H

#include "numerics/box/box_qp.h"
#include "lens.h"

/* What a contact's place leaves y to go: its direction, or a direction in the plane. */
struct freedom {
    size_t at;         /* first direction of the contact */
    double tangent[2]; /* the second is 0 for an interval */
    double curvature;  /* of the rim, times what presses against it */
};

#define TRIBO_NEAR_ENOUGH 1e-13

struct disc_qp {
    /* the problem */
    size_t size;          /* directions */
    unsigned char *wide;  /* [size] how many directions the contact that begins with this one has: 1, 2, or 0 if none does */
    double *s;            /* [size][size] */
    double *pull, *shift; /* [size] shift: c of the lenses */
    double near_enough;   /* distances of this part of limits are none: TRIBO_NEAR_ENOUGH where forces are not far from limits */
    double *weight;       /* [size] what tribo_disc_share counts y by */
    /* what is found; in: where to begin */
    double *y;       /* [size] */
    double residual; /* how far y is from the fixed point, at most, in parts of limits */
    /* at y */
    double *gradient, *noise; /* [size] s y + pull, and what of it may be rounding */
    double *gain;             /* [size] 1/(largest eigenvalue of the contact's own block); 1/(2 s_kk) if the block is skew */
    double *to;               /* [size] the point of the set nearest to y - gain gradient, lengths^2 being sum x_k^2/gain_k */
    double *outward;          /* [size] direction from the rim's centre to it, and at the first direction of the contact */
    double *curvature;        /* [size] of the rim, times what presses against it */
    unsigned char *place;     /* [size] LENS_... */
    /* workspace */
    struct freedom *freedom; /* [size] */
    size_t freedoms;
    double *matrix, *step, *spare, *best, *from, *aim, *slide, *press; /* [size][size]; [size], press [2 size] */
    double *diagonal, *share;                                          /* [size] */
    struct group group;
    struct sets sets;
    struct box_qp factor; /* of matrix */
    size_t redundant;     /* its null vectors */
};

/* Room for up to most directions; 1, or 0 if out of memory. */
int tribo_disc_create(struct disc_qp *p, size_t most);
void tribo_disc_free(struct disc_qp *p);

/* Vectors of doubles in a problem, and room for the problem of one planar contact alone. */
enum { TRIBO_DISC_VECTORS = 22, TRIBO_DISC_ALONE = 3 };
struct disc_alone {
    double store[TRIBO_DISC_VECTORS * TRIBO_DISC_ALONE], s[TRIBO_DISC_ALONE * TRIBO_DISC_ALONE];
    double matrix[TRIBO_DISC_ALONE * TRIBO_DISC_ALONE], l[TRIBO_DISC_ALONE * TRIBO_DISC_ALONE];
    double basis[TRIBO_DISC_ALONE * TRIBO_DISC_ALONE];
    unsigned char wide[TRIBO_DISC_ALONE], place[TRIBO_DISC_ALONE];
    signed char at[TRIBO_DISC_ALONE];
    size_t near[TRIBO_DISC_ALONE], order[TRIBO_DISC_ALONE];
    struct freedom freedom[TRIBO_DISC_ALONE];
    struct disc_qp p;
};

/* That problem, s [2][2], in room of the caller's; it begins with y = 0. */
void tribo_disc_alone(struct disc_alone *x, const double *s, const double *pull, const double *shift);

/* Solves the problem from y. 1, or 0 without convergence. */
int tribo_disc_solve(struct disc_qp *p);

/* Where s is singular, of all solutions the one in which the sum of (weight y)^2 is least, to about 1e-8 where the other
 * eigenvalues of s are alike; y is one of them. 1, or 0 without convergence. */
int tribo_disc_share(struct disc_qp *p);

/* ---- tangent_qp.c */

/* gain; once for a problem. */
void tribo_disc_gains(struct disc_qp *p);

/* to [wide] = the point of the set of the contact at i that is nearest to y - gain gradient [wide]; returns its place. */
int tribo_disc_descend(const struct disc_qp *p, size_t i, const double *gradient, double *to);

/* gradient and noise at y. */
void tribo_disc_gradients(struct disc_qp *p);

/* Where y - gain gradient is nearest to the set: to, outward, curvature and place. Returns the farthest that y is from there,
 * in parts of what may be rounding. */
double tribo_disc_places(struct disc_qp *p);

/* Newton's matrix of the freedoms that the places leave. */
void tribo_disc_linearize(struct disc_qp *p);

/* move [size] = the change of y along the freedoms that takes them to balance: rhs [size] is the gradient without it. */
void tribo_disc_follow(struct disc_qp *p, const double *rhs, double *move);

/* move [size] = where s is singular, the way that what pulls along its null vectors takes y: only rims end it, and it goes beyond
 * them. Zero if nothing does. */
void tribo_disc_slide(struct disc_qp *p, const double *rhs, double *move);

/* Factorizes matrix [size][size], symmetric and positive semidefinite. step [size] = matrix^-1 step, the least in norm. */
void tribo_disc_factorize(struct disc_qp *p, size_t size);
void tribo_disc_backsolve(struct disc_qp *p);

/* How the y of a contact that is in its place follows a change of c, the rest of the way being left to its freedoms. */
void tribo_disc_drag(const struct disc_qp *p, size_t i, const double *dshift, double *dy);

/* ---- interior.c */
void tribo_disc_interior(struct disc_qp *p);

#endif
