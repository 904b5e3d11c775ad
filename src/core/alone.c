/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts of which no two share a body, without static limits: forces of the balance, and over a step.
 *
 * Outputs stay as they are where a call fails, so v and a are checked before anything is written. Then follow the contacts, chunk
 * by chunk. Arrays of a large scene are far away: kernels do not read 1/R_ii or limits that are equal for all, nor a where all
 * contacts slide. */
#include "common/stream.h"
#include "check.h"
#include "contacts.h"

enum { FEW = 8 * TRIBO_CHUNK }; /* forces of that many contacts stay in the first-level cache */

/* Inputs of a call. find sets the forces f [n] of chunk k, and returns 1 if all its contacts slide. */
struct call {
    int (*find)(const tribo_context *ctx, const struct call *call, size_t k, double *f);
    double holds; /* see struct last */
    const double *v, *a;
    double *feq; /* or NULL */
    double dt;   /* of a step */
    int plain;   /* |a_i| <= TRIBO_PLAIN */
};

TRIBO_SIMD static void alone_find_slips(size_t n, const double *restrict f, const double *restrict limit, double holds,
                                        signed char *restrict slip)
{
    for (size_t i = 0; i < n; i++) {
        slip[i] = tribo_slip_by_force(STORED, f[i], limit[i], holds);
    }
}

/* Ends a call. kept = 1: last.f holds the forces, and slips follow from forces; 0: the deeds hold the slips. */
static void alone_finish(tribo_context *ctx, int kept, double holds)
{
    if (kept) {
        tribo_store_all(ctx);
    } else {
        ctx->last.did.all_stored = 0;
    }
    ctx->last.slips = kept ? SLIPS_IN_FORCES : SLIPS_WRITTEN;
    ctx->last.holds = holds;
    ctx->last.rank = 0;
    ctx->last.linearized = 0;
    ctx->count.skipped += ctx->op->islands;
}

/* Ends a call for the only contact. */
static void put_one(tribo_context *ctx, double force, double holds, double *f)
{
    *ctx->last.f = force;
    if (f) {
        *f = force;
    }
    alone_finish(ctx, 1, holds);
}

/* Finds the forces of all contacts. Those of few are kept. Of many, slips are kept, found while forces are in cache: forces would
 * have to be written to memory, and read again. */
static void alone_find_all(tribo_context *ctx, const struct call *call, double *f)
{
    const int few = ctx->n <= FEW;
    struct stream to;
    tribo_stream_begin(&to, f, ctx->n >= TRIBO_MANY);
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        const struct chunk *chunk = &ctx->follow.chunk[k];
        const size_t n = tribo_chunk_size(ctx, i);
        const double *limit = tribo_chunk_contacts(ctx, i).limit;
        double *force = few ? ctx->last.f + i : tribo_stream_room(&to);
        signed char *slip = ctx->last.did.of + i;
        const int slide = call->find(ctx, call, k, force);
        if (few) {
            tribo_copy(f ? f + i : NULL, force, f ? n : 0);
            continue;
        }
        if (slide && chunk->least > 0.0) {
            tribo_find_directions(n, call->v + i, slip);
        } else {
            alone_find_slips(n, force, limit, call->holds, slip);
        }
        tribo_stream_put(&to, n);
    }
    tribo_stream_end(&to);
    alone_finish(ctx, few, call->holds);
}

/* -------------------------------------------------------------------------------------------------------------- balance */

static int balance_chunk(const tribo_context *ctx, const struct call *call, size_t k, double *f)
{
    const size_t i = k * TRIBO_CHUNK, n = tribo_chunk_size(ctx, i);
    const struct contacts c = tribo_chunk_contacts(ctx, i);
    const double *v = call->v + i, band = tribo_widest_band(ctx, k);
    double room[TRIBO_CHUNK], *feq = call->feq ? call->feq + i : room;
    const int reads = ctx->set.law->uses_feq && (fabs(*v) <= band || tribo_any_in_band(n, v, band)); /* the law reads f_eq */
    if (reads && !call->feq && call->plain && ctx->follow.chunk[k].plain) {
        ctx->set.law->balance(&c, n, v, call->a + i, tribo_inverses(ctx, k), f);
        return 0;
    }
    if (reads || call->feq) {
        tribo_find_feq(ctx, i, n, call->a, feq);
    }
    ctx->set.law->force(&c, n, v, reads ? feq : v, f);
    return ctx->set.law->uses_feq && !reads;
}

int tribo_balance_alone(tribo_context *ctx, const double *v, const double *a, double *feq, double *f)
{
    const int within = v && a ? tribo_motion_within(v, a, TRIBO_PLAIN, ctx->n) : 0, plain = within & 2;
    int status = within & 1 ? TRIBO_OK : tribo_check_finite(ctx, "v", v, ctx->n);
    status = status || plain ? status : tribo_check_finite(ctx, "a", a, ctx->n);
    if (status) {
        return status;
    }
    const double holds = ctx->set.law->holds;
    if (ctx->n == 1) {
        const struct contacts *c = &ctx->follow.contacts;
        const double inverse = *ctx->op->inverse;
        const double balance = plain && ctx->follow.chunk->plain ? tribo_alone(*a, inverse) : tribo_alone_far(*a, inverse);
        double force;
        ctx->set.law->force(c, 1, v, &balance, &force);
        if (feq) {
            *feq = *c->limit > 0.0 ? balance : 0.0;
        }
        put_one(ctx, force, holds, f);
    } else {
        alone_find_all(ctx, &(const struct call){balance_chunk, holds, v, a, feq, 0.0, plain}, f);
    }
    ctx->last.residual = 0.0;
    return TRIBO_OK;
}

/* ----------------------------------------------------------------------------------------------------------------- step */

/* f = -scale v/R_ii within limits. */
TRIBO_SIMD static void alone_stop(size_t n, double scale, const double *restrict v, const double *restrict inverse,
                                  const double *restrict limit, double *restrict f)
{
    for (size_t i = 0; i < n; i++) {
        f[i] = clamp(tribo_alone(v[i] * scale, inverse[i]), -limit[i], limit[i]);
    }
}

#define LEAST_STEP (1.0 / TRIBO_PLAIN)

/* The same within any bounds, and where products might overflow, or 1/dt. */
static void stop_far(size_t n, double dt, const double *v, const double *inverse, const struct bounds *b, double *f)
{
    const double scale = quotient(1.0, dt);
    for (size_t i = 0; i < n; i++) {
        const double a = dt < LEAST_STEP ? quotient(v[i], dt) : scaled(v[i], scale);
        f[i] = clamp(tribo_alone_far(a, inverse[i]), tribo_lower(b, i), b->upper[i]);
    }
}

void tribo_stop_alone(const tribo_context *ctx, size_t k, double dt, const double *v, struct bounds b, double *f)
{
    const size_t n = tribo_chunk_size(ctx, k * TRIBO_CHUNK);
    const struct chunk *chunk = &ctx->follow.chunk[k];
    if (b.lower || !chunk->plain || dt < LEAST_STEP || !tribo_all_plain(v, n)) {
        stop_far(n, dt, v, tribo_inverses(ctx, k), &b, f);
    } else {
        alone_stop(n, quotient(1.0, dt), v, tribo_inverses(ctx, k), b.upper, f);
    }
}

TRIBO_SIMD static void alone_slide(size_t n, const double *restrict v, const double *restrict limit, double *restrict f)
{
    for (size_t i = 0; i < n; i++) {
        f[i] = sliding(v[i], limit[i]);
    }
}

static int step_chunk(const tribo_context *ctx, const struct call *call, size_t k, double *f)
{
    const size_t i = k * TRIBO_CHUNK, n = tribo_chunk_size(ctx, i);
    const struct chunk *chunk = &ctx->follow.chunk[k];
    const double *limit = tribo_chunk_contacts(ctx, i).limit;
    /* Contacts that are faster than reach, none of them open, slide on over dt, by a margin for rounding. */
    const double far = product(1.0000001 * greater(product(chunk->quickest, call->dt), DBL_MIN), chunk->largest);
    const double *v = call->v + i, reach = chunk->least > 0.0 && far < TRIBO_FAR ? far : DBL_MAX;
    if (fabs(*v) <= reach || tribo_any_in_band(n, v, reach)) {
        tribo_stop_alone(ctx, k, call->dt, v, (struct bounds){NULL, limit}, f);
        return 0;
    }
    alone_slide(n, v, limit, f);
    return 1;
}

int tribo_step_alone(tribo_context *ctx, double dt, const double *v, double *f)
{
    if (ctx->n == 1) {
        const struct bounds b = {NULL, ctx->follow.contacts.limit};
        double force;
        if (ctx->follow.chunk->plain && dt >= LEAST_STEP && tribo_within(*v, TRIBO_PLAIN)) {
            force = clamp(tribo_alone(*v * quotient(1.0, dt), *ctx->op->inverse), -*b.upper, *b.upper);
        } else {
            stop_far(1, dt, v, ctx->op->inverse, &b, &force);
        }
        put_one(ctx, force, 1.0, f);
    } else {
        alone_find_all(ctx, &(const struct call){.find = step_chunk, .holds = 1.0, .v = v, .dt = dt}, f);
    }
    return TRIBO_OK;
}
