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

/* Contacts that are looked at together: few enough that in a large scene most chunks have none near stick, and all that is read
 * of them stays in the first-level cache. */
#define TRIBO_CHUNK 128

/* What of a chunk's contacts changes with settings only. */
struct chunk {
    double widest; /* epsilon; negative if all are open */
    double limit;  /* of all, or NaN if they differ */
    int alone;     /* one shares no body */
};

/* What the last call knows of a contact: near stick, or sliding towards v > 0 or v < 0, which is all that there is to know; or
 * nothing. And where the forces of a chunk are: in ctx->f, or at the limits, or some here and some there. */
enum { PLAIN, NEAR, FORTH, BACK };
enum { KEPT, SLIDES, MIXED };

static inline size_t tribo_chunks(size_t n)
{
    return (n + TRIBO_CHUNK - 1) / TRIBO_CHUNK;
}

struct look {
    unsigned char *state; /* [n] */
    unsigned char *kind;  /* [chunks], in the same piece of memory */
};

struct tribo_context {
    size_t n;
    const struct law *law;
    int coupling, sharing;
    double step, lambda_dt; /* tribo_set_epsilon_step; step 0: epsilon was given */
    double *given;          /* [n] epsilon as given */
    double *limit, *epsilon, *slope;
    unsigned char *moving; /* [n] reversal memory */
    struct op op;
    struct chunk *chunk;     /* [chunks] */
    struct look last, spare; /* of the last balance; room for the next */
    double *feq, *f;         /* [n] of the last balance; f only of contacts that are PLAIN or NEAR */
    double *v;               /* [n] its velocities, and the law's derivatives there, after tribo_balance_tangent */
    struct tangent *tangent; /* [n] */
    double *lower;           /* [n] workspace of tribo_step_force */
    int balanced;            /* forces are those of a tribo_balance or tribo_step_force, and modes follow from it */
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

/* look.c: what depends on settings, brought up to date. */
void tribo_refresh_chunks(tribo_context *ctx);

/* Checks v and a, and finds the chunks that slide; a status, and on failure nothing is changed. Then finds the contacts near stick
 * in the others, and, as if they were alone, f of contacts that need no solver, and f_eq of those, or of all if wanted. */
int tribo_look(tribo_context *ctx, const double *v, const double *a);
void tribo_forces_alone(tribo_context *ctx, const double *v, const double *a, int wanted);

/* The forces of all contacts, f [n], or of one. */
void tribo_forces(const tribo_context *ctx, double *f);

static inline double tribo_force_of(const tribo_context *ctx, size_t i)
{
    const int state = ctx->last.state[i];
    return state <= NEAR ? ctx->f[i] : state == FORTH ? -ctx->limit[i] : ctx->limit[i];
}

/* balance.c: the contacts of group k in the program's order, those near stick first. */
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
