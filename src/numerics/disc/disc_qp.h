/* SPDX-License-Identifier: BSD-3-Clause */
/* The convex quadratic program of coupled contacts, planar ones among them: min 1/2 y's y + pull'y, where the y of each contact
 * lies in its lens, or interval, in units of its limit. Knows no friction, and allocates in tribo_disc_create only.
 *
 *   lens.c        the set of one contact, and its point nearest to another point
 *   tangent_qp.c  the directions in which contacts may move y, and Newton's equations along them
 *   interior.c    an interior-point method, which needs no beginning
 *   disc_qp.c     solves the problem
 * Each calls those above it only, and the factors of box/. */
#ifndef TRIBO_DISC_QP_H
#define TRIBO_DISC_QP_H

#include "common/layout.h"
#include "numerics/box/box_qp.h"

/* ---- lens.c */

/* The set of forces of one contact in units of its limit: the lens of two unit discs D and D - c, |c| < 2, or for one direction
 * the interval that is the same in one dimension. c = 0: the disc itself. */

/* Places of points of the set: inside, on the rim of D, on the rim of D - c, or where the two rims meet. */
enum { LENS_INSIDE, LENS_ON_DISC, LENS_ON_SHIFTED, LENS_AT_CORNER };

/* y = the point of the set nearest to z. Returns its place. directions: 1 or 2. */
int tribo_lens_project(int directions, const double *c, const double *z, double *y);

/* y = the minimum of sum_k weight_k y_k^2/2 - q_k y_k in the set of a contact of two directions, weight > 0. Returns its place.
 * weight = (1, 1): the point nearest to q. */
int tribo_lens_minimize(const double *c, const double *weight, const double *q, double *y);

/* A corner is -c/2 + side height (-c_2, c_1)/|c|. tribo_lens_corner returns the corner nearer to z. */
struct corner {
    double along[2];     /* c/|c| */
    double half, height; /* |c|/2, sqrt(1 - half^2) */
    double side;         /* 1 or -1 */
};
struct corner tribo_lens_corner(const double *c, const double *z);

/* Returns |x|, x [directions]; squares neither overflow nor underflow. */
double tribo_length(int directions, const double *x);

/* Returns the t > 0 with |x + t step| = 1, for |x| < 1. */
double tribo_way_to_rim(int directions, const double *x, const double *step);

/* ---- disc_qp.c */

/* A direction in which the place of a contact lets y move. */
struct freedom {
    size_t at;         /* first direction of the contact */
    size_t row;        /* of Newton's matrix */
    double tangent[2]; /* the second is 0 for an interval */
    double curvature;  /* of the rim, times the pressure on it */
};

/* One of the two discs of a contact, as a constraint of interior.c. */
struct disc {
    size_t at;                  /* first direction of the contact */
    int shifted;                /* 0: D; 1: D - c */
    double x[2];                /* y from its centre */
    double room, press, change; /* (1 - |x|^2)/2, the multiplier, and its change with a step */
};

#define TRIBO_NEAR_ENOUGH 1e-13

/* S by rows: dense, [size][size]; or sparse, entries first_i to first_i+1 - 1 in row i. Rows of one contact have the same
 * columns. */
struct disc_rows {
    struct sparse *pattern;    /* of Newton's matrix, at places of the caller; NULL: dense */
    size_t places;             /* rows of the pattern */
    const size_t *place;       /* [size] those of the directions */
    double *val;               /* entries, columns ascending */
    size_t *first, *col, *own; /* [size + 1]; of entries; [size] entries of the diagonal */
    size_t *slot;              /* entries of the pattern where those of val are */
};

/* The factor of Newton's matrix: row i is that of the freedom at direction i, or at its place in the pattern. */
struct disc_factor {
    double *dense;  /* [size][size] */
    double *matrix; /* dense, or the values of the pattern */
    struct group group;
    struct sets sets;
    struct box_qp qp;
    size_t redundant; /* null vectors */
    double serves;    /* a sparse factor serves steps from residuals below this, with the same freedoms; 0: none. It stays from
                         problem to problem; group.sparse: the pattern that it is of */
};

struct disc_qp {
    /* the problem */
    size_t size;         /* directions */
    unsigned char *wide; /* [size] directions of the contact that begins here: 1 or 2; 0 if none does */
    struct disc_rows s;
    double *pull;       /* [size] */
    double *shift;      /* [size] c of the lenses */
    double near_enough; /* distances below this part of limits are 0: TRIBO_NEAR_ENOUGH, unless forces are far below limits */
    double *weight;     /* [size] weights of y in tribo_disc_share */
    /* the solution; in: the beginning */
    double *y;       /* [size] */
    double residual; /* largest distance of y from the fixed point, in parts of limits */
    /* at y */
    double *gradient;     /* [size] s y + pull */
    double *noise;        /* [size] rounding of gradient */
    double *gain;         /* [size] 1/(largest eigenvalue of the contact's own block); 1/(2 s_kk) if the block is skew */
    double *to;           /* [size] the point of the set nearest to y - gain gradient, for lengths^2 sum x_k^2/gain_k */
    double *outward;      /* [size] direction from the rim's centre to `to` */
    double *curvature;    /* [size] of the rim, times the pressure on it; at the first direction of the contact */
    unsigned char *place; /* [size] LENS_..., likewise */
    /* workspace */
    struct freedom *freedom;                          /* [size] */
    size_t freedoms;                                  /* of Newton's matrix */
    double *step, *spare, *best, *from, *aim, *slide; /* [size] */
    double *kept;                                     /* [3][size] of tribo_disc_share */
    struct disc *disc;                                /* [discs], at most 2 size */
    size_t discs;
    struct disc_factor factor;
    struct room room; /* of all arrays; of one contact alone: store */
};

/* Sizes of the largest problem. */
struct disc_room {
    size_t size, dense;            /* directions; of dense problems */
    size_t places, entries, slots; /* of sparse problems; entries of S and of the factor */
};

/* Makes room for problems, in the memory of p if it is large enough; p is all 0 at first. Returns 1, or 0 if out of memory: then
 * tribo_disc_free frees p, too. */
int tribo_disc_create(struct disc_qp *p, const struct disc_room *room);
void tribo_disc_free(struct disc_qp *p);

/* Takes over the sparse factor of a problem that was created alike; pattern: that of p in its place. */
void tribo_disc_copy_factor(struct disc_qp *p, const struct disc_qp *from, struct sparse *pattern);

/* Room for the problem of one planar contact. */
struct disc_alone {
    double store[176];
    struct disc_qp p;
};

/* Sets up the problem s [2][2], pull [2], shift [2], beginning with y = 0. */
void tribo_disc_alone(struct disc_alone *x, const double *s, const double *pull, const double *shift);

/* Solves the problem from y. Returns 1, or 0 without convergence. */
int tribo_disc_solve(struct disc_qp *p);

/* y = the solution with the least sum of (weight y)^2, to about 1e-8 where the nonzero eigenvalues of s are alike, for a singular
 * s and a solution y. Returns 1, or 0 without convergence. */
int tribo_disc_share(struct disc_qp *p);

/* ---- tangent_qp.c */

/* Returns the first entry of row i of S. */
static inline size_t tribo_disc_row(const struct disc_qp *p, size_t i)
{
    return p->s.pattern ? p->s.first[i] : i * p->size;
}

/* Returns the entry s_ii; beside it are those of the other direction of the contact. */
static inline size_t tribo_disc_own(const struct disc_qp *p, size_t i)
{
    return p->s.pattern ? p->s.own[i] : i * (p->size + 1);
}

/* Returns the entries of row i. */
static inline size_t tribo_disc_terms(const struct disc_qp *p, size_t i)
{
    return p->s.pattern ? p->s.first[i + 1] - p->s.first[i] : p->size;
}

/* Returns the entry of Newton's matrix at entry e of S. */
static inline double *tribo_disc_entry(const struct disc_qp *p, size_t e)
{
    return &p->factor.matrix[p->s.pattern ? p->s.slot[e] : e];
}

/* sum [wide] += S x in the rows of the contact at i. */
void tribo_disc_add(const struct disc_qp *p, size_t i, const double *x, double *sum);

/* y [size] = S x, size_i [size] = sum_k |s_ik x_k|; neither is x. */
void tribo_disc_multiply(const struct disc_qp *p, const double *x, double *y, double *size);

/* Finds gain, once for a problem. */
void tribo_disc_gains(struct disc_qp *p);

/* to [wide] = the point of the set of the contact at i nearest to y - gain gradient [wide]. Returns its place. */
int tribo_disc_descend(const struct disc_qp *p, size_t i, const double *gradient, double *to);

/* Finds gradient and noise at y. */
void tribo_disc_gradients(struct disc_qp *p);

/* Finds to, outward, curvature and place. Returns the largest distance of y from `to`, in parts of its rounding. */
double tribo_disc_places(struct disc_qp *p);

/* Lists the freedoms of the places. */
void tribo_disc_list(struct disc_qp *p);

/* Sets Newton's matrix of these freedoms. */
void tribo_disc_assemble(struct disc_qp *p);

/* Factors Newton's matrix, symmetric and positive semidefinite. tribo_factor_solve then solves; a dense problem in least norm. */
void tribo_disc_factorize(struct disc_qp *p);

/* Lists, assembles and factors. */
void tribo_disc_linearize(struct disc_qp *p);

/* Adds up to TRIBO_SPARSE_REDUNDANT null vectors of a sparse problem to the factor: tribo_disc_follow takes the least norm. */
void tribo_disc_redundant(struct disc_qp *p);

/* move [size] = the change of y along the freedoms that brings rhs [size], the gradient without it, to 0. */
void tribo_disc_follow(struct disc_qp *p, const double *rhs, double *move);

/* move [size] = for a singular dense S, the descent direction in the null space of S, beyond all rims; 0 if there is none. */
void tribo_disc_slide(struct disc_qp *p, const double *rhs, double *move);

/* dy [wide] = the change of the y of the contact at i with its c, without that along its freedoms. */
void tribo_disc_drag(const struct disc_qp *p, size_t i, const double *dshift, double *dy);

/* ---- interior.c */

/* y = the solution, nearly enough to show the places: the average of room times press is at most the part least of the largest
 * stiffness, or as small as rounding lets it be. */
void tribo_disc_interior(struct disc_qp *p, double least);

#endif
