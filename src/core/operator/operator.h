/* The operator R of z'' = R f + a as it is kept: its diagonal, and the groups of contacts that it couples. */
#ifndef TRIBO_OPERATOR_H
#define TRIBO_OPERATOR_H

#include <float.h>
#include <stdint.h>

#include "tribo/tribo.h"

#include "../box/box.h"

#define TRIBO_ALONE SIZE_MAX

/* R_ii = 0 is taken as this: the limit R_ii -> +0. */
#define TRIBO_IMMOVABLE DBL_MIN

/* R. Contacts that share no body have only the diagonal; the others stand in groups, the connected parts of R's graph. */
struct delassus {
    double *diagonal;      /* [n] R_ii, at least TRIBO_IMMOVABLE; NULL: there is no operator yet */
    double growth;         /* at least the largest eigenvalue of D^-1 R, D being the diagonal */
    size_t islands;        /* groups and single contacts */
    size_t groups;         /* of two contacts and more */
    double most;           /* the smallest tribo_most of their contacts; TRIBO_FAR if there is no group */
    struct group *group;   /* [groups] */
    size_t *group_of;      /* [n] TRIBO_ALONE if contact i is */
    unsigned char *solved; /* [groups] solved for in the last call */
    size_t *solved_list;   /* [groups] which these are, */
    size_t nsolved;        /* so many */
    size_t largest;        /* contacts in the largest group */
    double *store;         /* [stored] what groups keep from call to call, group by group */
    size_t stored;
    size_t basis;          /* room for null vectors */
    size_t *member;        /* [n] the contacts of the groups, ascending, one group after the other */
    double *row_sum;       /* [n] of |R_ij|; -1 for contacts in no group */
    double largest_sum;    /* of these */
    size_t span;           /* from the first contact of a group to its last, at most */
    struct box_qp problem; /* workspace of the largest group, with views of one */
};

struct csr;

/* Where R is not positive semidefinite. */
struct flaw {
    size_t contact, group; /* how many contacts are coupled there */
    double pivot;          /* relative to the diagonal */
};

/* What the rows of R = J diag(w) J' came from; t is J'. */
struct inertia {
    const double *w;
    const size_t *rowptr, *col;
    const double *val;
    const struct csr *t;
};

/* The operator of rows that are symmetric and finite, with sorted columns; a status. from: NULL if not known. */
int tribo_operator_create(struct delassus *op, const struct csr *a, const struct inertia *from, struct flaw *flaw);
int tribo_operator_diagonal(struct delassus *op, size_t n, const double *r); /* r NULL: not set yet; 1, or 0 if out of memory */
int tribo_operator_copy(struct delassus *to, const struct delassus *from, size_t n);
void tribo_operator_free(struct delassus *op); /* what is left is no operator */

/* Views of group k in op's workspace. */
struct box_qp *tribo_operator_problem(struct delassus *op, size_t k);

/* What group k keeps will soon be looked at: groups may be far from each other. */
void tribo_operator_expect(const struct delassus *op, size_t k);

#endif
