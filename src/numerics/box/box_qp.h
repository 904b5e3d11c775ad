/* SPDX-License-Identifier: BSD-3-Clause */
/* A group of contacts that R couples, and the box-constrained quadratic program over its contacts near stick. Arrays are indexed
 * by place in the group. Nothing here allocates, unless it says so.
 *
 *   factor.c          rows of R, its null space, and its factor over the free contacts: a square block, kept from call to call
 *                     and changed row by row, or with twice as many digits, for light bodies between heavy ones
 *   factor_sparse.c   the same for large groups with few entries
 *   small.h           solves the problem of up to 4 contacts
 *   box.c             the sets of free contacts and of contacts at a bound, Newton's method, the solution of the problem, its
 *                     share among redundant contacts, and the linear system of the partition coupling */
#ifndef TRIBO_BOX_H
#define TRIBO_BOX_H

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "common/real.h"

/* Places of a contact: at the lower or upper end of its box, inside and free to move, or not in the problem. */
enum { AT_LOWER = -1, FREE = 0, AT_UPPER = 1, AWAY = 2 };

/* A pivot below this part of the diagonal is trusted only as the largest of the remaining ones. */
#define TRIBO_DOUBTFUL 1e-7

/* Pivots of a sparse factor, which does not choose them, below this count as zero. */
#define TRIBO_SPARSE_ZERO 1e-10

/* Pivots of a graded group below this count as zero: the square of rounding, as where rows of J depend on each other. */
#define TRIBO_GRADED_ZERO 1e-28

/* Redundant contacts of a sparse group that share forces, at most; of a dense one, all. */
#define TRIBO_SPARSE_REDUNDANT 64

struct sparse;

/* Constants of a group, of the life of the operator. */
struct group {
    size_t size;
    size_t first;          /* place in the operator's members */
    size_t fixed;          /* place in the operator's store: scale, rounding.part, rounding.least, r and low.r */
    size_t kept;           /* place in the store kept from call to call: x, order, at and the factor */
    double lightest;       /* the smallest scale, that of the largest diagonal entry */
    size_t terms;          /* entries of the fullest row */
    struct sparse *sparse; /* R and the pattern of its factor; NULL if dense */
    struct sparse *made;   /* owned; sparse, or that of an earlier R of the group; NULL: none */
    uint64_t dense_shape;  /* hash of the places of R's entries, if a dense factor is better for them; else 0 */
    int graded;            /* 1: R and its factor have twice as many digits */
    int small;             /* 1: tribo_box_small applies */
    double spread;         /* largest ratio of the shares of bodies in an R_ii, */
    size_t uneven;         /* and its contact i */
    size_t nullity;        /* size - rank of R: redundant contacts */
    int thin;              /* 1: a pivot of R is small */
};

/* Scalars of a group that are kept from call to call. */
struct sets {
    int far;             /* 1: the problem of the last call was far */
    size_t rank;         /* independent free contacts, in the factor */
    size_t dependents;   /* free contacts that depend on the independent ones */
    unsigned inverse_of; /* small groups: bit i is 1 if contact i is in inverse */
};

/* Work done so far. */
struct work {
    size_t factorizations, updates;
};

/* L D L' of a sparse group. */
struct sparse_factor {
    double *l;     /* [slots] */
    double *d;     /* [size] 1/d; 0 for contacts that are not in the factor */
    double *w;     /* [size] workspace, zero between calls */
    size_t *index; /* [size] place of a free contact in order */
};

/* Sizes by which rounding is told from motion. */
struct rounding {
    const double *part;  /* [size] part of the terms of a gradient that may be rounding */
    const double *least; /* [size] terms below which forces underflow */
    double *unit;        /* [size] R_ii times the limit, or half the box; of groups with redundant contacts */
    double *terms;       /* [size] sizes of the gradient's terms with each contact alone at its solution; likewise */
};

/* Low parts of numbers with twice as many digits, of graded groups. */
struct low_parts {
    const double *r;         /* [size][size] */
    double *l;               /* [size][size] */
    double *x;               /* [size] */
    double *gradient, *step; /* [size] workspace */
};

/* Null vectors of R. */
struct null_space {
    double *basis;    /* [redundant][size] workspace: orthonormal null vectors */
    size_t redundant; /* vectors that there is room for */
    size_t *held;     /* [redundant] workspace */
};

/* The problem of a group: views of arrays kept from call to call, and workspace. */
struct box_qp {
    /* constant */
    const struct group *group;
    const size_t *member; /* [size] the contacts, ascending */
    const double *scale;  /* [size] powers of 2: scale_i^2 R_ii is between 1/2 and 2 */
    const double *r;      /* [size][size] R, if dense */
    struct rounding rounding;
    /* kept */
    struct sets *sets;
    double *x;                   /* [size] */
    size_t *order;               /* [size] rank independent free contacts, in the order of the factor, then the dependents */
    signed char *at;             /* [size] places */
    double *l;                   /* [size][size] Cholesky factor of the scaled R over order[0 .. rank); see factor.c */
    struct low_parts low;        /* of r, l, x, gradient and step */
    struct sparse_factor sparse; /* in the place of l, if R is sparse */
    double *inverse;             /* [size][size] small groups: see small.h */
    /* the problem: min 1/2 x'Rx + q'x, lo <= x <= hi, over the near contacts; the x of the others is given */
    int far;                  /* 1: forces may be so large that products overflow */
    size_t *near, count;      /* near[0 .. count): the contacts in the problem, ascending; near[count .. size): the others */
    double *q, *lo, *hi;      /* [size] */
    double *gradient, *noise; /* [size] R x + q, and its rounding */
    int twofold;              /* 1: x = x + low.x */
    signed char *to;          /* [size] workspace: places */
    double *step;             /* [size] workspace */
    double *spare[2];         /* [size] workspace */
    double *row;              /* [size] workspace, zero between calls */
    struct null_space null;
    struct work work;
};

/* Returns the largest force of contact i: accelerations by such forces are finite, since |R_ij| <= 2/(scale_i scale_j). */
static inline double tribo_most(const struct box_qp *p, size_t i)
{
    const double each = DBL_MAX / 6.0 / (double)p->group->terms;
    return lesser(each * lesser(p->scale[i] * p->group->lightest, 1.0), TRIBO_FAR);
}

/* An ill-conditioned factor makes a number of x if TRIBO_ROOM x is less than TRIBO_FAR. */
#define TRIBO_ROOM 0x1p-64

static inline double tribo_cut(const struct box_qp *p, size_t i, double force)
{
    const double most = tribo_most(p, i);
    return clamp(force, -most, most);
}

/* Returns the rounding of a sum of n terms of size 1; a smaller sum counts as zero. */
static inline double tribo_resolution(size_t n)
{
    return 4.0 * (double)(n + 4) * DBL_EPSILON;
}

/* Returns a power of 2, s, with s^2 diagonal between 1/2 and 2. */
static inline double tribo_scale(double diagonal)
{
    int e;
    frexp(diagonal, &e);
    return ldexp(1.0, -(e >= 0 ? e / 2 : -((1 - e) / 2)));
}

/* ---- factor */

/* at_i = to; takes contact i into the factor or the dependents, or out of them, if that changes. */
void tribo_box_change(struct box_qp *p, size_t i, signed char to);

/* Factorizes anew over all FREE contacts, which are near. where not NULL: returns the largest entry left after elimination of the
 * independent contacts, rounding unless R is indefinite, negative if a pivot is, and its contact *where; else 0. */
double tribo_factor_rebuild(struct box_qp *p, size_t *where);

/* step = R^-1 step over the independent contacts, 0 for the dependents; of least norm over both for `vectors` of the basis, else
 * 0. Leaves the other entries. p->far: step is of any size. */
void tribo_factor_solve(const struct box_qp *p, size_t vectors, double *step);

/* Of a graded group: step + low = R^-1 (step + low), 0 for the dependents. */
void tribo_graded_solve(const struct box_qp *p, double *step, double *low);

/* Returns 1 if q and x have sizes that twice as many digits allow. bounded: x is within lo and hi. */
int tribo_graded_fits(const struct box_qp *p, int bounded);

/* Returns (R x + q)_i, its low part *low, and *size = sum_j |R_ij x_j|. */
double tribo_graded_gradient(const struct box_qp *p, size_t i, double *low, double *size);

/* Returns |q_i| + sum_j |y_j q_j| over the independent j, y = R^-1 R_.i: relative errors of q move gradient_i by at most this
 * times them. Uses low.step. */
double tribo_graded_terms(const struct box_qp *p, size_t i);

/* Returns x_i + length step_i; its low part goes to low.x. */
double tribo_graded_move(struct box_qp *p, size_t i, double length);

/* What a contact is that enters the factor. UNDECIDED: its pivot is small, and the factor invalid. */
enum { UNDECIDED, DEPENDENT, INDEPENDENT };

/* order_at = i. */
static inline void tribo_box_order(struct box_qp *p, size_t at, size_t i)
{
    p->order[at] = i;
    if (p->group->sparse) {
        p->sparse.index[i] = at;
    }
}

int tribo_sparse_enter(struct box_qp *p, size_t i);
void tribo_sparse_leave(struct box_qp *p, size_t i);
double tribo_sparse_rebuild(struct box_qp *p, size_t *where);
void tribo_sparse_solve(const struct box_qp *p, double *step);
double tribo_sparse_dot(const struct box_qp *p, size_t i, const double *x, double *size);

/* Allocates the pattern of the factor of R = r (columns ascending, by place). *s = NULL if a dense factor is better: the sparse
 * one would have too many entries. Returns 1, or 0 if out of memory. */
struct csr;
int tribo_sparse_create(struct sparse **s, const struct csr *r);
size_t tribo_sparse_slots(const struct sparse *s);

/* Returns R by places, columns ascending. Its values may be changed. */
struct csr *tribo_sparse_rows(struct sparse *s);
void tribo_sparse_free(struct sparse *s);

/* ---- rows of R */

/* Returns sum_j R_ij x_j, and *size = sum_j |R_ij x_j|. */
double tribo_row_dot(const struct box_qp *p, size_t i, const double *x, double *size);

/* Returns the number of entries of row i; *val: these, *col: their columns, NULL: 0, 1, ... */
size_t tribo_row_entries(const struct box_qp *p, size_t i, const size_t **col, const double **val);

/* Returns the sum without j = i. Leaves x as it was. */
double tribo_row_others(const struct box_qp *p, size_t i, double *x);

/* y [size] = the null vector of R over the free contacts with y_d = 1, d a dependent. Leaves the entries of other contacts. */
void tribo_null_vector(const struct box_qp *p, size_t d, double *y);

/* basis = orthonormal null vectors of R over the free contacts. Returns their number: dependents, or 0 if there is no room. */
size_t tribo_null_basis(struct box_qp *p);

/* y [size] -= the projection of x [size], which may be y, to the first vectors of basis. */
void tribo_null_project(const struct box_qp *p, size_t vectors, const double *x, double *y);

/* ---- the problem */

/* Largest gradient of a solution, in parts of its rounding; more shows an inexact factor. */
#define TRIBO_SETTLED 4.0

/* Finds gradient and noise at x. */
void tribo_box_gradients(struct box_qp *p);

/* Returns the gradient of i that counts as zero. */
double tribo_box_tolerance(const struct box_qp *p, size_t i);

/* Forces that miss the balance of a contact by more than this part of its limit are no solution. */
#define TRIBO_MISSED 1e-6

/* Solves the problem of a small group to rounding, which is not far; noise is not set. Returns 1, or 0 if tribo_box_solve is
 * needed. */
int tribo_box_small(struct box_qp *p);

/* Solves the problem from the sets and the x of the last call. Returns 1, or 0 without convergence. */
int tribo_box_solve(struct box_qp *p);

/* Returns the rounding of gradient_i, that of the free x included. Uses spare[0]. */
double tribo_box_doubt(const struct box_qp *p, size_t i);

/* x = the solution of the problem of least norm. */
void tribo_box_share(struct box_qp *p);

/* x = the solution of R x + q = 0 of least norm over the near contacts, all of them free. Returns 1, or 0 if there is none: then
 * x is the least-squares solution. */
int tribo_box_linear(struct box_qp *p);

#endif
