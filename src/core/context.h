/* What the files of src/core share. */
#ifndef TRIBO_CONTEXT_H
#define TRIBO_CONTEXT_H

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "tribo/tribo.h"

#include "operator/operator.h"
#include "law/law.h"
#include "../common/compiler.h"
#include "../common/real.h"

struct message;

/* Contacts that are looked at together: few enough that in a large scene most chunks have none near stick, and all that is read
 * of them stays in the first-level cache. */
#define TRIBO_CHUNK 128

/* What of a chunk's contacts changes with settings only. */
struct chunk {
    double widest;         /* epsilon; negative if all are open */
    double least, largest; /* limit */
};

static inline size_t tribo_chunks(size_t n)
{
    return (n + TRIBO_CHUNK - 1) / TRIBO_CHUNK;
}

/* What a call finds of a contact: it slides towards v < 0, is near stick, or slides towards v > 0. An open one slides. */
enum { BACK, NEAR, FORTH };

/* All contacts of a chunk slide; or perhaps not; or that does not matter, since ctx->f holds all their forces. */
enum { SLIDES, MIXED, KEPT };

struct look {
    unsigned char *state; /* [n] */
    unsigned char *kind;  /* [chunks] in the same piece of memory */
};

struct tribo_context {
    size_t n;
    const char *owner; /* of the operator; NULL: the caller */
    const struct law *law;
    int coupling, sharing;
    double step, lambda_dt; /* tribo_set_epsilon_step; step 0: epsilon was given */
    double *given;          /* [n] epsilon as given */
    double *limit, *epsilon, *slope;
    double *bound;         /* [n] limits as the solver takes them: the same array, or, if one is beyond op.most, bounds */
    double *bounds;        /* [n] */
    double largest;        /* limit */
    double *limit_then;    /* [n] limits of the last balance: the same array, or the other of limits */
    double *limits;        /* [2][n + 1] */
    unsigned char *moving; /* [n] reversal memory */
    struct operator op;
    struct chunk *chunk;     /* [chunks] */
    struct look last, spare; /* of the last balance; room for the next */
    int kept;                /* f holds all forces, and last has not been asked; otherwise f holds those of contacts NEAR */
    double *feq, *f;         /* [n] of the last balance */
    double *v;               /* [n] its velocities, and the law's derivatives there, after tribo_balance_tangent */
    struct tangent *tangent; /* [n] */
    int balanced;            /* forces are those of a tribo_balance or tribo_step_force, and modes follow from it */
    int linearized;          /* tangent is that of the last balance */
    int far;                 /* a limit or a bound of the last call is so large that solutions may be beyond op.most */
    double holds;            /* a contact holds if |f| is less than this part of the limit */
    double residual;
    size_t rank, solves, reused, skipped, marks;
    size_t revision; /* counts changes of settings and operator */
    struct message *message;
};

/* message.c: keeps the text for tribo_message and returns status. */
int tribo_fail(const tribo_context *ctx, int status, const char *format, ...)
#if defined(TRIBO_GNU_C)
    __attribute__((format(printf, 3, 4)))
#endif
    ;
struct message *tribo_message_create(void);

/* Contacts of the chunk that begins with i. */
static inline size_t tribo_chunk_size(const tribo_context *ctx, size_t i)
{
    return ctx->n - i < TRIBO_CHUNK ? ctx->n - i : TRIBO_CHUNK;
}

/* check.c */
int tribo_all_finite(const double *x, size_t n);

/* TRIBO_OK, or a failure that names the argument, the first offending contact and its value. */
int tribo_check_finite(const tribo_context *ctx, const char *name, const double *x, size_t n);
int tribo_check_nonnegative(const tribo_context *ctx, const char *name, const double *x, size_t n);
int tribo_check_positive(const tribo_context *ctx, const char *name, const double *x, size_t n);

/* TRIBO_OK, or a failure that tells which call is missing: there is no operator, or none that epsilon could follow. */
int tribo_fail_without_operator(const tribo_context *ctx); /* context.c */

static inline int tribo_need_operator(const tribo_context *ctx)
{
    return ctx->op.diagonal || !ctx->n ? TRIBO_OK : tribo_fail_without_operator(ctx);
}

static inline int tribo_need_epsilon(const tribo_context *ctx)
{
    return ctx->step > 0.0 ? tribo_need_operator(ctx) : TRIBO_OK;
}

/* look.c: limits of the chunks, and then their epsilon, brought up to date with settings. */
void tribo_refresh_limits(tribo_context *ctx);
void tribo_refresh_widths(tribo_context *ctx);

/* Checks v and a, and finds who is near stick; a status, and on failure all is as after the last call. */
int tribo_classify(tribo_context *ctx, const double *v, const double *a);

/* f of contacts that need no solver, where ctx->f is to hold it, and their f_eq, or that of all contacts if wanted, as if all
 * were alone. */
void tribo_forces_alone(tribo_context *ctx, const double *v, const double *a, int wanted);

/* How many contacts from *i on are near stick, where *i becomes the first before end that is: 0 if there is none. */
size_t tribo_next_near(const unsigned char *state, size_t *i, size_t end);

/* The forces of all contacts, f [n], while limits are those of the balance; or of one. */
void tribo_forces(const tribo_context *ctx, double *f);

static inline double tribo_force_of(const tribo_context *ctx, size_t i)
{
    const int state = ctx->kept ? NEAR : ctx->last.state[i];
    return state == NEAR ? ctx->f[i] : state == FORTH ? -ctx->limit_then[i] : ctx->limit_then[i];
}

/* The force of the contact at place k of a group as the solver takes it. */
static inline double tribo_carried(const tribo_context *ctx, const struct box_qp *p, size_t k)
{
    const double f = tribo_force_of(ctx, p->member[k]);
    return ctx->far ? tribo_cut(p, k, f) : f;
}

/* balance.c: what calls that find forces have in common. Begins one: nothing is solved yet. */
void tribo_begin_call(tribo_context *ctx);

/* Finds the groups with a contact near stick among those from i to end. */
void tribo_find_near_groups(tribo_context *ctx, size_t i, size_t end);

/* Solves the problem of a group; q, lo and hi are set. */
int tribo_solve_group(tribo_context *ctx, struct box_qp *p);

/* Keeps forces for shares that go on from them, also in groups that no solver saw. */
void tribo_remember_forces(tribo_context *ctx);

/* The contacts of group k in the problem's order, those near stick first. */
struct box_qp *tribo_collect(tribo_context *ctx, size_t k);

/* memcpy, but fine with NULL for no elements. */
static inline void tribo_copy(double *to, const double *from, size_t n)
{
    if (n) {
        memcpy(to, from, n * sizeof *to);
    }
}

/* context.c: epsilon and slope brought up to date with limits, operator and settings. */
void tribo_refresh(tribo_context *ctx);

/* The contacts as laws see them, and those from i on. */
static inline struct contacts tribo_contacts(const tribo_context *ctx)
{
    return (struct contacts){ctx->limit, ctx->epsilon, ctx->slope, ctx->moving, ctx->step > 0.0 ? 1.0 : 0.0};
}

static inline struct contacts tribo_contacts_from(const struct contacts *c, size_t i)
{
    return (struct contacts){c->limit + i, c->epsilon + i, c->slope + i, c->moving + i, c->follows};
}

/* Where |v| is at most this, the law reads f_eq. */
static inline double tribo_band(const tribo_context *ctx, size_t i)
{
    return ctx->law->sticks_in_band ? ctx->epsilon[i] : 0.0;
}

#endif
