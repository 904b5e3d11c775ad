/* A group of contacts that R couples, and the box-constrained quadratic program over those of them that are near stick.
 * Everything is indexed by place in the island. Nothing here allocates, except where it says so.
 *
 *   dense.c     factor of R over the free contacts, kept from call to call and changed row by row
 *   sparse.c    the same for large islands with few entries
 *   graded.c    the same for light bodies between heavy ones, with twice as many digits
 *   box.c       which contacts are free and which at a bound: the program itself, and the linear system of the partition coupling
 *   split.c     the share of redundant contacts */
#ifndef TRIBO_ISLAND_H
#define TRIBO_ISLAND_H

#include <float.h>
#include <stddef.h>

#include "../real.h"

/* Where a contact is: at the lower or upper end of its box, inside and free to move, or not in the program at all. */
enum { AT_LOWER = -1, FREE = 0, AT_UPPER = 1, AWAY = 2 };

/* Pivots below this, relative to the diagonal, are not trusted without a look at the others. */
#define TRIBO_DOUBTFUL 1e-7

/* Without a choice of pivots, those of a sparse factor below this count as zero. */
#define TRIBO_SPARSE_ZERO 1e-10

/* Pivots of a graded island below this count as zero: those of rows of J that depend on each other up to rounding are, since they
 * go with its square. */
#define TRIBO_GRADED_ZERO 1e-28

/* Redundant contacts of one sparse island whose share is found; of a dense one, all of them. */
#define TRIBO_SPARSE_REDUNDANT 64

struct sparse;

/* What lasts as long as the operator. */
struct island {
    size_t size;
    size_t kept;           /* into the store: what the program below says is kept */
    double lightest;       /* the smallest scale, that of the largest diagonal entry */
    size_t terms;          /* entries of the fullest row */
    int far;               /* what program.far was in the last call */
    struct sparse *sparse; /* R and its factor, if they are sparse */
    int graded;            /* they are kept to twice as many digits */
    size_t nullity;        /* size - rank of R: redundant contacts */
    size_t rank;           /* now: free contacts in the factor, independent of each other, */
    size_t dependents;     /* and those that depend on them */
};

/* Work done so far. */
struct work {
    size_t factorizations, updates;
};

/* An island at work: views of what is kept, and workspace. */
struct program {
    struct island *island;
    /* kept, side by side */
    double *x;       /* [size] */
    size_t *member;  /* [size] the contacts, ascending */
    size_t *order;   /* [size] rank independent free contacts, in the order of the factor, then the dependents */
    signed char *at; /* [size] */
    size_t *terms;   /* [size] entries of R in a row */
    double *scale;   /* [size] powers of 2 that bring the diagonal of R to between 1/2 and 2 */
    double *r;       /* [size][size], if dense */
    double *l;       /* [size][size] Cholesky factor of the scaled R over order[0 .. rank), if dense */
    double *r_low;   /* [size][size] what rounding left of R, if graded */
    double *l_low;   /* [size][size] and of the factor */
    /* the program: min 1/2 x'Rx + q'x, lo <= x <= hi, over the near contacts; the x of the others is given */
    int far;             /* solutions may be as large as they can be told apart */
    size_t *near, count; /* near[0 .. count): the contacts in the program, ascending; near[count .. size): the others */
    double *q, *lo, *hi;
    double *gradient, *noise; /* R x + q, and what of it may be rounding */
    int twofold;              /* x is kept to twice as many digits */
    double *low;              /* what rounding left of it */
    double pull;              /* then, the largest q */
    double *first;            /* the size of the terms of the gradient that the call began with */
    double *unit;             /* R_ii times the limit, or half the box; of islands with redundant contacts */
    signed char *to;          /* workspace */
    double *step, *step_low;  /* workspace, [size]; the latter is what rounding left, if the island is graded */
    double *spare[2];         /* workspace, [size] */
    double *row;              /* the same, zero between calls */
    double *basis;            /* workspace: orthonormal null vectors, [redundant][size] */
    size_t redundant;         /* how many there is room for */
    size_t *held;             /* workspace, [redundant] */
    struct work work;
};

/* The largest force that is told apart at place i: the accelerations that such forces make add up to a number. |R_ij| is at most
 * 2/(scale_i scale_j). */
static inline double tribo_most(const struct program *p, size_t i)
{
    const double each = DBL_MAX / 6.0 / (double)p->island->terms;
    return lesser(each * lesser(p->scale[i] * p->island->lightest, 1.0), TRIBO_FAR);
}

/* What an ill-conditioned factor makes of a number is a number if this part of it is less than TRIBO_FAR. */
#define TRIBO_ROOM 0x1p-64

static inline double tribo_cut(const struct program *p, size_t i, double force)
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
double tribo_scale(double diagonal);

/* ---- factor */

/* A contact has become free: it enters the factor, or the dependents. Or it no longer is, and leaves. */
void tribo_factor_add(struct program *p, size_t i);
void tribo_factor_remove(struct program *p, size_t i);

/* Factorizes anew, over all contacts that are FREE, which are near. Unless where is NULL, returns the largest entry left over
 * after the independent ones are eliminated, which is rounding unless R is indefinite; negative if a pivot is. *where is whose it
 * is. */
double tribo_factor_rebuild(struct program *p, size_t *where);

/* step = R^-1 step over the independent ones. Entries of the others are left alone. */
void tribo_factor_solve(const struct program *p, double *step);

/* Whether so many changes, towards so many free contacts, cost more than a new factor. */
int tribo_factor_many(const struct program *p, size_t changes, size_t free);

void tribo_dense_add(struct program *p, size_t i);
void tribo_dense_remove(struct program *p, size_t i);
double tribo_dense_rebuild(struct program *p, size_t *where);
void tribo_dense_solve(const struct program *p, double *step);

/* What factorizations that choose their pivots share: the free contacts, in p->order; symmetric exchange of rows and columns k
 * and other > k in the lower triangle l, columns before k included; what elimination has left of the rows from k on. */
size_t tribo_dense_order(struct program *p);
void tribo_dense_exchange(const struct program *p, double *l, size_t all, size_t k, size_t other);
double tribo_dense_leftover(const struct program *p, size_t k, size_t all, size_t *where);

double tribo_graded_rebuild(struct program *p, size_t *where);
void tribo_graded_solve(const struct program *p, double *step, double *low);

/* Whether q and x, which may be bounded, are of sizes for which there are twice as many digits. */
int tribo_graded_fits(const struct program *p, int bounded);

/* (R x + q)_i, *low being what rounding left of it, and *size the size of R x's terms. */
double tribo_graded_gradient(const struct program *p, size_t i, double *low, double *size);

/* step and step_low = the move of the independent x that takes their gradient to zero. */
void tribo_graded_newton(struct program *p);

/* tribo_null_vector, but for y of the dependents. */
void tribo_graded_null_vector(const struct program *p, size_t d, double *y);

/* x_i + length step_i, its low part kept. */
double tribo_graded_move(struct program *p, size_t i, double length);

void tribo_sparse_add(struct program *p, size_t i);
void tribo_sparse_remove(struct program *p, size_t i);
double tribo_sparse_rebuild(struct program *p, size_t *where);
void tribo_sparse_solve(const struct program *p, double *step);
int tribo_sparse_many(const struct program *p, size_t changes);
double tribo_sparse_dot(const struct program *p, size_t i, const double *x, double *size);
void tribo_sparse_spread(const struct program *p, size_t i, double factor, double *y);

/* Prepares the factor of an island with these rows (sorted columns, by place): allocates. NULL in *s if a dense one is the better
 * choice: the sparse one would have too many entries, or the island has redundant contacts, or nearly so, and is not too large
 * for a factor that chooses its pivots. 1, or 0 if out of memory. */
struct rows;
int tribo_sparse_create(struct sparse **s, const struct rows *r);
int tribo_sparse_clone(struct sparse **s, const struct sparse *from); /* NULL for NULL */
void tribo_sparse_free(struct sparse *s);

/* ---- rows of R */

/* Row i times x [size]; *size is the sum of the terms' absolute values. */
double tribo_row_dot(const struct program *p, size_t i, const double *x, double *size);

/* The same without the diagonal's term; x is as before in the end. */
double tribo_row_others(const struct program *p, size_t i, double *x);

/* y [size] = factor * row i, at the free contacts. Other entries are left alone. */
void tribo_row_spread(const struct program *p, size_t i, double factor, double *y);

/* ---- program */

/* gradient and noise at x. */
void tribo_box_gradient(struct program *p);

/* Solves the program from what is kept. 1, or 0 without convergence. */
int tribo_box_solve(struct program *p);

/* Of all solutions of the program, x becomes the one of least norm. */
void tribo_box_share(struct program *p);

/* x = the minimum-norm solution of R x + q = 0 over the near contacts, all of them free. 1, or 0 if there is none: then x is the
 * least-squares one. */
int tribo_box_linear(struct program *p);

/* One contact changes its place, and the factor with it. */
void tribo_box_change(struct program *p, size_t i, signed char to);

/* Moves the free x along step, at most by longest times it, and so far that none leaves its box. Returns who met a bound first,
 * or size. */
size_t tribo_box_advance(struct program *p, double longest);

/* How much gradient an x may have that should have none. */
double tribo_box_tolerance(const struct program *p, size_t i);

/* ---- split */

/* y [size] = the null vector of R over the free contacts in which the dependent d moves by 1. Entries of other contacts are left
 * alone. */
void tribo_null_vector(const struct program *p, size_t d, double *y);

/* basis = orthonormal null vectors of R over the free contacts. Returns their number: the dependents', or 0 if there is no room
 * for them. */
size_t tribo_null_basis(struct program *p);

/* Takes the part of y [size] in the span of the first k vectors of basis out of it. */
void tribo_project(const struct program *p, size_t k, double *y);

/* x becomes the solution of least norm, up to rounding; contacts at a bound that have no gradient become free. Returns 0 if there
 * is only one. */
int tribo_split(struct program *p);

#endif
