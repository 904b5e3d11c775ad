/* SPDX-License-Identifier: BSD-3-Clause */
/* The operator R of z'' = R f + a: its diagonal, and groups of contacts that it couples. */
#ifndef TRIBO_OPERATOR_H
#define TRIBO_OPERATOR_H

#include <float.h>
#include <stdint.h>

#include "tribo/tribo.h"

#include "common/layout.h"
#include "numerics/box/box_qp.h"
#include "numerics/csr.h"

#define TRIBO_ALONE SIZE_MAX

/* R_ii = 0 is taken as this: the limit R_ii -> +0. */
#define TRIBO_IMMOVABLE DBL_MIN

/* R: the diagonal of all contacts, and groups, the connected parts of R's graph of two contacts and more. Constant, and shared by
 * clones. */
struct delassus {
    size_t references;            /* contexts */
    double *diagonal;             /* [n] R_ii, at least TRIBO_IMMOVABLE; NULL: there is no operator yet */
    double *inverse;              /* [n] 1/R_ii, in the memory of diagonal */
    double growth;                /* at least the largest eigenvalue of D^-1 R, D = diag(R) */
    size_t islands;               /* groups and single contacts */
    size_t groups;                /* of two contacts and more */
    double most;                  /* the least tribo_most of their contacts; TRIBO_FAR without groups */
    size_t *group_of;             /* [n] or TRIBO_ALONE */
    struct group *group;          /* [groups] */
    size_t *member;               /* [n] contacts of groups, group by group, ascending */
    double *row_sum;              /* [n] sum_j |R_ij|; -1 for contacts in no group */
    struct room rooms[2];         /* memory of the four arrays above; of fixed */
    size_t laid_out;              /* groups that the first of these holds */
    double largest_sum;           /* of these */
    size_t largest;               /* contacts in the largest group */
    double *fixed;                /* [fixed_size] R and what goes with it, group by group */
    size_t fixed_size, kept_size; /* of fixed, and of the store of a memory */
    size_t basis;                 /* room for null vectors */
};

/* What a context keeps of groups from call to call, and workspace. */
struct memory {
    unsigned char *solved; /* [groups] 1: in the last call */
    size_t *solved_list;   /* [nsolved] these */
    size_t nsolved;
    struct sets *sets;     /* [groups] */
    double *store;         /* [kept_size] group by group */
    struct box_qp problem; /* workspace of the largest group, with views of one group */
    struct room rooms[2];  /* memory of all but the basis; of the basis */
};

/* Intermediate results of making an operator. */
struct drafts {
    struct csr t, a;  /* J' or R', and R; columns ascend */
    double *diagonal; /* [n] of R; owns the memory of x and place */
    double *x;        /* [2 n] workspace */
    size_t *place;    /* [4 n + 1] workspace */
};

/* R = J diag(w) J' by rows of J; t = J'. */
struct inertia {
    const double *w;
    const size_t *rowptr, *col;
    const double *val;
    const struct csr *t;
};

/* Makes an operator and its memory of d->a, symmetric and finite, and its diagonal; a status. from may be NULL. note keeps the
 * message of a failure. *op, *m: NULL and empty, or replaced: their memory is used again. After a failure release both. */
int tribo_operator_create(struct delassus **op, struct memory *m, struct drafts *d, const struct inertia *from,
                          tribo_context *note);

/* Returns an operator without groups, in the memory of spent unless spent is NULL; r NULL: not set yet; NULL if out of memory. */
struct delassus *tribo_operator_diagonal(struct delassus *spent, size_t n, const double *r);

/* Counts a context less, the last of which frees the operator; NULL is fine. */
void tribo_operator_release(struct delassus *op);

/* Copies a memory. Returns 1, or 0 if out of memory. */
int tribo_memory_copy(struct memory *to, const struct memory *from, const struct delassus *op);
void tribo_memory_free(struct memory *m);

/* Returns 1 if a group of size contacts has a sparse factor, unless its entries are too many. thin: a pivot of R is small. */
int tribo_prefers_sparse(size_t size, int thin);

/* Empties a memory, but for its rooms. */
static inline void tribo_memory_clear(struct memory *m)
{
    *m = (struct memory){.rooms = {m->rooms[0], m->rooms[1]}};
}

/* Returns the problem with views of group k. */
struct box_qp *tribo_memory_problem(const struct delassus *op, struct memory *m, size_t k);

#endif
