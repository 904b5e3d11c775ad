/* What the files of src/core share. */
#ifndef TRIBO_INTERNAL_H
#define TRIBO_INTERNAL_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "tribo/tribo.h"

#include "island.h"
#include "law.h"

#define TRIBO_ALONE SIZE_MAX

/* R. Contacts that share no body have only the diagonal; the others stand in groups, the connected parts of R's graph. What a
 * group keeps from call to call stands in pools, group by group; see struct program. */
struct op {
    double *diagonal;                /* [n] R_ii, at least DBL_MIN, which is the limit R_ii -> +0 */
    double row_sum;                  /* max over i of sum_j |R_ij|/R_ii */
    size_t islands;                  /* groups and single contacts */
    size_t groups;                   /* of two contacts and more */
    struct island *group;            /* [groups] */
    size_t *group_of;                /* [n] TRIBO_ALONE if contact i is */
    size_t *touched;                 /* [groups] those solved for in the last call, */
    size_t touches;                  /* so many */
    size_t members, largest, blocks; /* contacts in groups; in the largest; size of the pools r and l */
    size_t basis;                    /* room for null vectors */
    size_t *member;                  /* [members] contacts, ascending within a group */
    double *r, *l;                   /* [blocks] */
    double *scale, *x;               /* [members] */
    double *reach;                   /* [n] sum of |R_ij| N_j: what friction can do to a contact at most */
    int reaches;                     /* reach is that of the limits */
    signed char *at;                 /* [members] */
    size_t *order, *terms;           /* [members] */
    struct program program;          /* workspace of the largest group, with views of one */
};

struct message;

struct tribo_context {
    size_t n;
    const struct law *law;
    int coupling, sharing;
    double step, lambda_dt; /* tribo_set_epsilon_step; step 0: epsilon was given */
    double *given;          /* [n] epsilon as given */
    double *limit, *epsilon, *slope;
    unsigned char *moving; /* [n] reversal memory */
    struct op op;
    double *feq, *f;         /* [n] of the last balance */
    unsigned char *near;     /* [n] contacts near stick in it */
    double *v;               /* [n] its velocities, and the law's derivatives there, after tribo_balance_tangent */
    struct tangent *tangent; /* [n] */
    double *lower;           /* [n] workspace of tribo_step_force */
    int balanced;            /* f is that of a tribo_balance or tribo_step_force, and modes follow from it */
    int linearized;          /* tangent is that of the last balance */
    double holds;            /* a contact holds if |f| is less than this part of the limit */
    double residual;
    size_t rank, solves, reused, skipped, marks;
    struct message *message;
};

/* message.c: keeps the text for tribo_message and returns status. */
int tribo_fail(const tribo_context *ctx, int status, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;
struct message *tribo_message_create(void);

/* check.c: TRIBO_OK, or a failure that names the argument, the first offending contact and its value. */
int tribo_check_finite(const tribo_context *ctx, const char *name, const double *x, size_t n);
int tribo_check_nonnegative(const tribo_context *ctx, const char *name, const double *x, size_t n);
int tribo_check_positive(const tribo_context *ctx, const char *name, const double *x, size_t n);

/* islands.c */
struct rows;

/* Where R is not positive semidefinite. */
struct flaw {
    size_t contact, group; /* how many contacts are coupled there */
    double pivot;          /* relative to the diagonal */
};

/* The operator of rows that are symmetric and finite, with sorted columns; a status. */
int tribo_op_create(struct op *op, const struct rows *a, struct flaw *flaw);
int tribo_op_diagonal(struct op *op, size_t n, const double *r); /* 1s if r is NULL; 1, or 0 if out of memory */
int tribo_op_copy(struct op *to, const struct op *from, size_t n);
void tribo_op_free(struct op *op);

/* Views of group k in op's program. */
struct program *tribo_op_program(struct op *op, size_t k);

/* balance.c: the contacts of group k in the program's order, those with ctx->near first. */
struct program *tribo_collect(tribo_context *ctx, size_t k);

/* memcpy, but fine with NULL for no elements. */
static inline void tribo_copy(double *to, const double *from, size_t n)
{
    if (n) {
        memcpy(to, from, n * sizeof *to);
    }
}

/* context.c: 2 limit/epsilon; epsilon and slope brought up to date with limits, operator and settings; the contacts' data as
 * laws see them. */
double tribo_slope(double limit, double epsilon);
void tribo_refresh(tribo_context *ctx);
struct contacts tribo_contacts(const tribo_context *ctx);
struct contacts tribo_contacts_from(const struct contacts *c, size_t i);

/* Where |v| is at most this, the law reads f_eq. */
static inline double tribo_band(const tribo_context *ctx, size_t i)
{
    return ctx->law->sticks_in_band ? ctx->epsilon[i] : 0.0;
}

#endif
