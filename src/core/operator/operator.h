/* The operator R of z'' = R f + a as it is kept: its diagonal, and the groups of contacts that it couples. */
#ifndef TRIBO_OPERATOR_H
#define TRIBO_OPERATOR_H

#include <float.h>
#include <stdint.h>

#include "tribo/tribo.h"

#include "numerics/box/box_qp.h"

#define TRIBO_ALONE SIZE_MAX

/* R_ii = 0 is taken as this: the limit R_ii -> +0. */
#define TRIBO_IMMOVABLE DBL_MIN

/* R. Contacts that share no body have only the diagonal; the others stand in groups, the connected parts of R's graph. It does
 * not change once it is made, and contexts that are clones of each other have one in common. */
struct delassus {
    size_t references;            /* contexts */
    double *diagonal;             /* [n] R_ii, at least TRIBO_IMMOVABLE; NULL: there is no operator yet */
    double *inverse;              /* [n] 1/R_ii, in the same piece of memory */
    double growth;                /* at least the largest eigenvalue of D^-1 R, D being the diagonal */
    size_t islands;               /* groups and single contacts */
    size_t groups;                /* of two contacts and more */
    double most;                  /* the smallest tribo_most of their contacts; TRIBO_FAR if there is no group */
    size_t *group_of;             /* [n] TRIBO_ALONE if contact i is; has the memory of the next three as well */
    struct group *group;          /* [groups] */
    size_t *member;               /* [n] the contacts of the groups, ascending, one group after the other */
    double *row_sum;              /* [n] of |R_ij|; -1 for contacts in no group */
    double largest_sum;           /* of these */
    size_t span;                  /* from the first contact of a group to its last, at most */
    size_t largest;               /* contacts in the largest group */
    double *fixed;                /* rows of R and what goes with them, group by group */
    size_t fixed_size, kept_size; /* of fixed, and of the store of a memory */
    size_t basis;                 /* room for null vectors */
};

/* What a context keeps of the groups from call to call, and its workspace. */
struct memory {
    unsigned char *solved; /* [groups] solved for in the last call */
    size_t *solved_list;   /* [nsolved] which these are */
    size_t nsolved;
    struct sets *sets;     /* [groups] */
    double *store;         /* [kept_size] group by group; has the memory of all but the basis */
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

/* Makes an operator of rows that are symmetric and finite, with sorted columns and this diagonal [n], and the memory that goes
 * with it; a status. from: NULL if not known. */
int tribo_operator_create(struct delassus **op, struct memory *m, const struct csr *a, const double *diagonal,
                          const struct inertia *from, struct flaw *flaw);
int tribo_operator_diagonal(struct delassus **op, size_t n, const double *r); /* r NULL: not set yet; 1, or 0 if out of memory */

/* One context more, or less, has it: the last one that gives it up frees it. NULL is fine. */
struct delassus *tribo_operator_share(struct delassus *op);
void tribo_operator_release(struct delassus *op);

/* A memory of its own that remembers the same; 1, or 0 if out of memory. */
int tribo_memory_copy(struct memory *to, const struct memory *from, const struct delassus *op);
void tribo_memory_free(struct memory *m);

/* Views of group k in the workspace. */
struct box_qp *tribo_memory_problem(const struct delassus *op, struct memory *m, size_t k);

/* What is kept of group k will soon be looked at: groups may be far from each other. */
void tribo_memory_expect(const struct delassus *op, const struct memory *m, size_t k);

#endif
