/* SPDX-License-Identifier: BSD-3-Clause */
/* The context: what the caller set, what follows from it, what the last call found. */
#ifndef TRIBO_CONTEXT_H
#define TRIBO_CONTEXT_H

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "tribo/tribo.h"

#include "core/operator/operator.h"
#include "core/law/law.h"
#include "core/planar/planar.h"
#include "common/text.h"
#include "common/real.h"
#include "common/simd.h"

/* Properties of the contacts of a chunk that change with settings only. */
struct chunk {
    double least, largest; /* limit */
    double widest;         /* width */
    double band;           /* at least the largest epsilon of contacts that are not open; negative if all are open */
    double quickest;       /* R_ii */
    size_t like;           /* first contact of the first chunk with the same 1/R_ii: kernels read these, which are in cache */
    int plain;             /* 1/R_ii <= TRIBO_PLAIN */
    int even;              /* all have the same width and rate */
    int alike;             /* and the same limit > 0 */
    size_t model;          /* first contact of the first chunk with the same widths and rates, and limits if alike; see like */
};

static inline size_t tribo_chunks(size_t n)
{
    return (n + TRIBO_CHUNK - 1) / TRIBO_CHUNK;
}

/* Slips of the last call: unknown; to be found from forces and limits; in last.slip. */
enum { NO_SLIPS, SLIPS_IN_FORCES, SLIPS_WRITTEN };

/* Static limits: there are none; they drop to the limit as slip begins; they fall with speed. */
enum { NEVER, DROPS, FALLS };

/* What the caller set. */
struct settings {
    const struct law *law;
    int coupling, sharing;
    double step, lambda_dt; /* of tribo_set_epsilon_step; step 0: epsilon was given */
    double *limit;          /* [n] */
    double *width, *rate;   /* [n] of epsilon, see law.h */
    int breaking;           /* NEVER, ... */
    double *ratio;          /* [n] static limit / limit */
    double *stribeck;       /* [n] velocity scale; 0 unless FALLS */
    struct user_law user;   /* of the caller's law */
};

/* What follows from settings and operator. */
struct following {
    struct contacts contacts;        /* [n] as laws see them */
    double *cut_limit, *cut_factor;  /* [n] if limits are far: limits that the solver resolves, widths or rates that go with them;
                                        if limits are static: limits to slide, rates */
    double *hold, *hold_width, *now; /* [n] if limits are static: these; epsilon; the limits of the last call */
    double largest, steepest;        /* largest limit; largest factor of the limit in epsilon or slope, at least 1 */
    struct chunk *chunk;             /* [chunks] */
};

/* What the last call found. */
struct last {
    double *feq, *f;         /* [n] */
    signed char *slip;       /* [n] TRIBO_SLIP_... of SLIPS_WRITTEN */
    unsigned char *near;     /* [n] 1: the last tribo_balance found contacts of groups near stick */
    double *v;               /* [n] velocities of the last tribo_balance_tangent */
    struct tangents tangent; /* [n] derivatives of the law there; f: NULL */
    int slips;               /* NO_SLIPS, ... */
    double holds;            /* a contact is stuck if |f| < holds limit */
    int linearized;          /* tangent is that of the last call */
    int far;                 /* limits or bounds are so large that solutions may exceed op->most */
    double residual;
    size_t rank;
    size_t clusters; /* solved */
};

/* Before install: the new operator of a context. After install, which exchanges the two: the operator that the context had; the
 * next update overwrites that operator with a new one. */
struct renewal {
    struct delassus *op;
    struct memory memory;
    struct clusters plane;
    struct drafts drafts; /* of the new operator */
};

/* Places of the entries of the caller's J (tribo_set_operator_mass) or R (tribo_set_operator_csr). Shared by clones. */
struct pattern {
    size_t references;    /* contexts */
    size_t ndof, *rowptr; /* rowptr [n + 1] */
    size_t *col;          /* [rowptr[n]] */
    double *inverse_mass; /* [ndof]; of J */
};

/* Forms of operators. */
enum { FORM_NONE, FORM_DIAGONAL, FORM_DENSE, FORM_ROWS, FORM_MASS, FORM_CALLBACK };

/* Sums since tribo_create. */
struct counters {
    size_t solves, reused, skipped, marks;
};

struct tribo_context {
    size_t n;
    int fixed; /* the operator cannot be changed */
    int form;  /* FORM_... of the operator */
    struct settings set;
    struct following follow;
    struct delassus *op;     /* shared by clones */
    struct memory memory;    /* of groups, from call to call */
    struct pattern *pattern; /* of FORM_ROWS and FORM_MASS, else NULL */
    struct renewal *renewal; /* of the last tribo_update_operator; NULL: none */
    struct clusters plane;
    unsigned char *moving; /* [n] reversal memory */
    struct last last;
    signed char *spare; /* [n] workspace */
    struct counters count;
    size_t revision; /* changes of settings and operator */
    char message[240];
};

/* status.c: keeps the text for tribo_message, unless ctx is NULL, and returns status. */
int tribo_fail(tribo_context *ctx, int status, const char *format, ...)
#if defined(TRIBO_GNU_C)
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* settings.c: updates what follows from limits; from all settings and the operator. */
void tribo_refresh_limits(tribo_context *ctx);
void tribo_refresh(tribo_context *ctx);

/* operator/input.c: counts a context less, the last of which frees the pattern; frees what is in r. NULL is fine. */
void tribo_pattern_release(struct pattern *p);
void tribo_renewal_free(struct renewal *r);

/* operator/input.c: returns the number of values that tribo_update_operator reads. */
size_t tribo_operator_values(const tribo_context *ctx);

/* Sets limits to limit [n], which may be those of ctx, and all that follows from them. */
void tribo_take_limits(tribo_context *ctx, const double *limit);

/* queries.c: writes slips. Call before limits change. */
void tribo_write_slips(tribo_context *ctx);

/* Contacts of the chunk that begins with contact i. */
static inline size_t tribo_chunk_size(const tribo_context *ctx, size_t i)
{
    return tribo_chunk_from(ctx->n, i);
}

/* The contacts of the chunk that begins with contact i, as laws see them. */
static inline struct contacts tribo_chunk_contacts(const tribo_context *ctx, size_t i)
{
    const struct chunk *chunk = &ctx->follow.chunk[i / TRIBO_CHUNK];
    const struct contacts *c = &ctx->follow.contacts;
    const size_t limits = chunk->alike ? chunk->model : i;
    return (struct contacts){c->limit + limits,
                             c->bound + limits,
                             c->width + chunk->model,
                             c->rate + chunk->model,
                             c->moving + i,
                             c->follows,
                             c->scales,
                             chunk->alike,
                             i,
                             c->user};
}

/* 1/R_ii of the contacts of chunk k. */
static inline const double *tribo_inverses(const tribo_context *ctx, size_t k)
{
    return ctx->op->inverse + ctx->follow.chunk[k].like;
}

/* 1 if no contact is coupled, planar or has a static limit. */
static inline int tribo_all_alone(const tribo_context *ctx)
{
    return !ctx->op->groups && !ctx->plane.count && !ctx->set.breaking;
}

/* memcpy, for which NULL is fine if n is 0. */
static inline void tribo_copy(double *to, const double *from, size_t n)
{
    if (n) {
        memcpy(to, from, n * sizeof *to);
    }
}

#endif
