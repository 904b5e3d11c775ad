/* A group of contacts that R couples, and the box-constrained quadratic program over those of them that are near stick.
 * Everything is indexed by place in the group. Nothing here allocates, except where it says so.
 *
 *   factor.c          the rows of R, and its factor over the free contacts, whichever way they are kept:
 *   factor_dense.c    as square blocks, kept from call to call and changed row by row
 *   factor_sparse.c   the same for large groups with few entries
 *   factor_graded.c   for light bodies between heavy ones, with twice as many digits
 *   sets.c            which contacts are free and which at a bound, and what makes them change
 *   newton.c          gradients, their rounding, and the step that takes them to zero
 *   box.c             solves the problem
 *   least_squares.c   solves the linear system of the partition coupling
 *   least_norm.c      shares forces among redundant contacts
 * Each calls those above it only. */
#ifndef TRIBO_BOX_H
#define TRIBO_BOX_H

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "common/real.h"

/* Where a contact is: at the lower or upper end of its box, inside and free to move, or not in the problem at all. */
enum { AT_LOWER = -1, FREE = 0, AT_UPPER = 1, AWAY = 2 };

/* Pivots below this, relative to the diagonal, are not trusted without a look at the others. */
#define TRIBO_DOUBTFUL 1e-7

/* Without a choice of pivots, those of a sparse factor below this count as zero. */
#define TRIBO_SPARSE_ZERO 1e-10

/* Pivots of a graded group below this count as zero: those of rows of J that depend on each other up to rounding are, since they
 * go with its square. */
#define TRIBO_GRADED_ZERO 1e-28

/* Redundant contacts of one sparse group whose share is found; of a dense one, all of them. */
#define TRIBO_SPARSE_REDUNDANT 64

struct sparse;

/* What lasts as long as the operator. */
struct group {
    size_t size;
    size_t first;          /* into the operator's members */
    size_t fixed;          /* into the operator's store: scale, terms, r and r_low */
    size_t kept;           /* into the store of what is kept from call to call: x, order, at and the factor */
    double lightest;       /* the smallest scale, that of the largest diagonal entry */
    size_t terms;          /* entries of the fullest row */
    struct sparse *sparse; /* R and the pattern of its factor, if they are sparse */
    int graded;            /* they are kept to twice as many digits */
    int small;             /* solved by small.c where it can */
    double spread;         /* how much the shares of bodies in one entry of R's diagonal differ, at most; that of contact */
    size_t uneven;         /* uneven */
    size_t nullity;        /* size - rank of R: redundant contacts */
};

/* What is kept of a group from call to call, besides arrays. */
struct sets {
    int far;           /* the problem was far in the last call */
    size_t rank;       /* free contacts in the factor, independent of each other, */
    size_t dependents; /* and those that depend on them */
    unsigned inverse_of; /* small groups: the contacts of inverse, by bits */
};

/* Work done so far. */
struct work {
    size_t factorizations, updates;
};

/* L D L' of a sparse group. */
struct sparse_factor {
    double *l, *d; /* [slots]; [size] 1/d, 0 for contacts that are not in the factor */
    double *w;     /* [size] workspace, zero between calls */
    size_t *index; /* [size] where a free contact stands in the problem's order */
};

/* A group at work: views of what is kept, and workspace. */
struct box_qp {
    /* constant */
    const struct group *group;
    const size_t *member;    /* [size] the contacts, ascending */
    const double *scale;     /* [size] powers of 2 that bring the diagonal of R to between 1/2 and 2 */
    const double *part;      /* [size] of the terms of a gradient that may be rounding; terms so small that forces */
    const double *least;     /* underflow in them */
    const double *r, *r_low; /* [size][size] R, if dense; what rounding left of it, if graded */
    /* kept */
    struct sets *sets;
    double *x;                   /* [size] */
    size_t *order;               /* [size] rank independent free contacts, in the order of the factor, then the dependents */
    signed char *at;             /* [size] */
    double *l, *l_low;           /* [size][size] Cholesky factor of the scaled R over order[0 .. rank); see r */
    struct sparse_factor sparse; /* instead, if R is sparse */
    double *inverse;             /* small groups: [size][size], see small.h */
    /* the problem: min 1/2 x'Rx + q'x, lo <= x <= hi, over the near contacts; the x of the others is given */
    int far;             /* solutions may be as large as they can be told apart */
    size_t *near, count; /* near[0 .. count): the contacts in the problem, ascending; near[count .. size): the others */
    double *q, *lo, *hi;
    double *gradient, *noise; /* R x + q, and what of it may be rounding */
    int twofold;              /* x is kept to twice as many digits */
    double *low;              /* what rounding left of it */
    double *unit;             /* R_ii times the limit, or half the box; of groups with redundant contacts */
    double *terms;            /* size of the gradient's terms where each contact carries what it would alone; of the same */
    signed char *to;          /* workspace */
    double *step, *step_low;  /* workspace, [size]; the latter is what rounding left, if the group is graded */
    double *spare[2];         /* workspace, [size] */
    double *row;              /* the same, zero between calls */
    double *basis;            /* workspace: orthonormal null vectors, [redundant][size] */
    size_t redundant;         /* how many there is room for */
    size_t *held;             /* workspace, [redundant] */
    struct work work;
};

/* The largest force that is told apart at place i: the accelerations that such forces make add up to a number. |R_ij| is at most
 * 2/(scale_i scale_j). */
static inline double tribo_most(const struct box_qp *p, size_t i)
{
    const double each = DBL_MAX / 6.0 / (double)p->group->terms;
    return lesser(each * lesser(p->scale[i] * p->group->lightest, 1.0), TRIBO_FAR);
}

/* What an ill-conditioned factor makes of a number is a number if this part of it is less than TRIBO_FAR. */
#define TRIBO_ROOM 0x1p-64

static inline double tribo_cut(const struct box_qp *p, size_t i, double force)
{
    const double most = tribo_most(p, i);
    return clamp(force, -most, most);
}

/* Rounding of a sum of n terms of size 1 leaves about this; what is smaller counts as zero. */
static inline double tribo_resolution(size_t n)
{
    return 4.0 * (double)(n + 4) * DBL_EPSILON;
}

/* A power of 2 that takes a diagonal entry to between 1/2 and 2, from both sides. */
static inline double tribo_scale(double diagonal)
{
    int e;
    frexp(diagonal, &e);
    return ldexp(1.0, -(e >= 0 ? e / 2 : -((1 - e) / 2)));
}

/* ---- factor */

/* A contact has become free: it enters the factor, or the dependents. Or it no longer is, and leaves. */
void tribo_factor_add(struct box_qp *p, size_t i);
void tribo_factor_remove(struct box_qp *p, size_t i);

/* Factorizes anew, over all contacts that are FREE, which are near. Unless where is NULL, returns the largest entry left over
 * after the independent ones are eliminated, which is rounding unless R is indefinite; negative if a pivot is. *where is whose it
 * is. */
double tribo_factor_rebuild(struct box_qp *p, size_t *where);

/* step = R^-1 step over the independent ones. Entries of the others are left alone. */
void tribo_factor_solve(const struct box_qp *p, double *step);

/* Whether that number of changes, towards that number of free contacts, costs more than a new factor. */
int tribo_factor_many(const struct box_qp *p, size_t changes, size_t free);

void tribo_dense_add(struct box_qp *p, size_t i);
void tribo_dense_remove(struct box_qp *p, size_t i);
double tribo_dense_rebuild(struct box_qp *p, size_t *where);
void tribo_dense_solve(const struct box_qp *p, double *step);

/* Shared by factorizations that choose their pivots. order = the free contacts; returns their number. */
size_t tribo_dense_order(struct box_qp *p);

/* Exchanges the largest pivot of rows k to all - 1 into row k, in l, l_low if graded, and order. Returns 0 if it is at most zero. */
int tribo_dense_pivot(struct box_qp *p, size_t k, size_t all, double zero);

/* Sets rank, and the other contacts as dependents. Returns as tribo_factor_rebuild. */
double tribo_dense_end(struct box_qp *p, size_t rank, size_t all, size_t *where);

double tribo_graded_rebuild(struct box_qp *p, size_t *where);
void tribo_graded_solve(const struct box_qp *p, double *step, double *low);

/* Whether q and x, which may be bounded, are of sizes for which there are twice as many digits. */
int tribo_graded_fits(const struct box_qp *p, int bounded);

/* (R x + q)_i, *low being what rounding left of it, and *size the size of R x's terms. */
double tribo_graded_gradient(const struct box_qp *p, size_t i, double *low, double *size);

/* step and step_low = the move of the independent x that takes their gradient to zero. */
void tribo_graded_newton(struct box_qp *p);

/* tribo_null_vector, but for y of the dependents. */
void tribo_graded_null_vector(const struct box_qp *p, size_t d, double *y);

/* |q_i| + sum_j |y_j q_j| over the independent j, y = R^-1 R_.i: the gradient of i follows errors of all q by at most this part of
 * it, since the forces of the independent contacts do. Uses step_low. */
double tribo_graded_terms(const struct box_qp *p, size_t i);

/* x_i + length step_i, its low part kept. */
double tribo_graded_move(struct box_qp *p, size_t i, double length);

void tribo_sparse_add(struct box_qp *p, size_t i);
void tribo_sparse_remove(struct box_qp *p, size_t i);
double tribo_sparse_rebuild(struct box_qp *p, size_t *where);
void tribo_sparse_solve(const struct box_qp *p, double *step);
int tribo_sparse_many(const struct box_qp *p, size_t changes);
double tribo_sparse_dot(const struct box_qp *p, size_t i, const double *x, double *size);
void tribo_sparse_spread(const struct box_qp *p, size_t i, double factor, double *y);

/* Finds the pattern of the factor of a group with these rows (sorted columns, by place): allocates. NULL in *s if a dense one is
 * the better choice: the sparse one would have too many entries, or the group has redundant contacts, or nearly so, and is not
 * too large for a factor that chooses its pivots. 1, or 0 if out of memory. */
struct csr;
int tribo_sparse_create(struct sparse **s, const struct csr *r);
size_t tribo_sparse_slots(const struct sparse *s); /* of the factor */
void tribo_sparse_free(struct sparse *s);

/* ---- rows of R */

/* Row i times x [size]; *size is the sum of the terms' absolute values. */
double tribo_row_dot(const struct box_qp *p, size_t i, const double *x, double *size);

/* The same without the diagonal's term; x is as before in the end. */
double tribo_row_others(const struct box_qp *p, size_t i, double *x);

/* y [size] = factor * row i, at the free contacts. Other entries are left alone. */
void tribo_row_spread(const struct box_qp *p, size_t i, double factor, double *y);

/* ---- sets: which contacts are free */

/* Puts a contact in its place, and changes the factor with it. */
void tribo_box_change(struct box_qp *p, size_t i, signed char to);

/* Puts all contacts in their places in p->to. Returns how many were free, or are now, but not both. */
size_t tribo_box_change_all(struct box_qp *p);

/* Takes contacts into the problem that are near for the first time, and others out of it. keep_bounds: a contact may begin at the
 * bound where it was; otherwise all are free. */
void tribo_box_enter(struct box_qp *p, int keep_bounds);

/* Moves the free x along step, at most by longest times it, and so far that none leaves its box. Returns the contact that met a
 * bound first, or size. */
size_t tribo_box_advance(struct box_qp *p, double longest);

/* What a caller's rounding may do to a must not pit redundant contacts against each other: so much of its unit the gradient of
 * one may have; but not more than so much of its terms, since limits that are never reached say nothing of rounding. */
#define TRIBO_DISAGREEMENT 5e-13
#define TRIBO_DISAGREED_TERMS 5e-9

/* How much gradient an x may have that should have none: rounding, and, of a group with redundant contacts, disagreement. */
static inline double tribo_box_disagreement(const struct box_qp *p, size_t i)
{
    if (!p->group->nullity) {
        return 0.0;
    }
    return p->twofold ? TRIBO_DISAGREEMENT * tribo_graded_terms(p, i)
                      : lesser(TRIBO_DISAGREEMENT * p->unit[i], TRIBO_DISAGREED_TERMS * p->terms[i]);
}

static inline double tribo_box_tolerance(const struct box_qp *p, size_t i)
{
    return p->noise[i] + tribo_box_disagreement(p, i);
}

/* 1 if a pull, which may be negative, is beyond the tolerance of i. */
static inline int tribo_box_pulls(const struct box_qp *p, size_t i, double pull)
{
    return pull > p->noise[i] && pull > tribo_box_tolerance(p, i);
}

/* ---- Newton's method with the sets as they are */

/* Refinement ends with gradients of so much rounding, or the factor is not what it should be. */
#define TRIBO_SETTLED 4.0

/* Chooses whether x is kept to twice as many digits in this call; bounded: lo and hi are set. */
void tribo_box_begin(struct box_qp *p, int bounded);

/* gradient and noise at x. */
void tribo_box_gradients(struct box_qp *p);

/* step = the move of the independent x that takes their gradient to zero; dependent ones stay. */
void tribo_box_newton(struct box_qp *p);

/* The same for the gradient as it stands, which the caller has projected: of a graded group to the digits of a double. */
void tribo_box_downhill(struct box_qp *p);

/* Returns where the step takes x. */
double tribo_box_moved(struct box_qp *p, size_t i);

/* Whether the gradient of the independent x is at most noises times its rounding. */
static inline int tribo_box_settled(const struct box_qp *p, double noises)
{
    for (size_t k = 0; k < p->sets->rank; k++) {
        const size_t i = p->order[k];
        if (!(fabs(p->gradient[i]) <= noises * p->noise[i])) {
            return 0;
        }
    }
    return 1;
}

/* Forgets what rounding left of x: it is known of what a solver found, and of nothing else. */
static inline void tribo_box_forget_low(const struct box_qp *p)
{
    if (p->twofold) {
        memset(p->low, 0, p->group->size * sizeof *p->low);
    }
}

/* ---- the problem */

/* Forces that miss the balance of a contact by more than this part of its limit are no solution. */
#define TRIBO_MISSED 1e-6

/* small.c: solves the problem of a small group. 1, or 0 if another solver is needed. */
int tribo_box_small(struct box_qp *p);

/* Solves the problem from what is kept. 1, or 0 without convergence. */
int tribo_box_solve(struct box_qp *p);

/* What rounding of the gradient of i, and of the x of the free contacts, may add to the gradient of i. Uses spare[0]. */
double tribo_box_doubt(const struct box_qp *p, size_t i);

/* Makes x the one of least norm among all solutions of the problem. */
void tribo_box_share(struct box_qp *p);

/* x = the minimum-norm solution of R x + q = 0 over the near contacts, all of them free. 1, or 0 if there is none: then x is the
 * least-squares one. */
int tribo_box_linear(struct box_qp *p);

/* ---- least norm */

/* y [size] = the null vector of R over the free contacts in which the dependent d moves by 1. Entries of other contacts are left
 * alone. */
void tribo_null_vector(const struct box_qp *p, size_t d, double *y);

/* basis = orthonormal null vectors of R over the free contacts. Returns their number: the dependents', or 0 if there is no room
 * for them. */
size_t tribo_null_basis(struct box_qp *p);

/* Takes the part of y [size] in the span of the first k vectors of basis out of it. */
void tribo_null_project(const struct box_qp *p, size_t k, double *y);

/* x becomes the solution of least norm, up to rounding; contacts at a bound that have no gradient become free. Returns 0 if there
 * is only one. */
int tribo_least_norm(struct box_qp *p);

#endif
