/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces of all contacts as if no two shared a body, of the balance and over a step: all there is to a call if no two do, else
 * its first part.
 *
 * Outputs stay as they are where a call fails, so v and a are checked before anything is written. Then follow the contacts, chunk
 * by chunk. Arrays of a large scene are far away: kernels do not read 1/R_ii or limits that are equal for all, nor a where all
 * contacts slide. */
#include "calls.h"
#include "own.h"

/* Inputs of a call. find sets the forces f [n] of chunk k. */
struct call {
    void (*find)(tribo_context *ctx, const struct call *call, size_t k, double *f);
    const double *v, *a;
    double *feq;     /* of a balance: last.feq; NULL: f_eq is not kept, and no two contacts share a body */
    int wanted;      /* f_eq of contacts that slide, too */
    int plain;       /* |a_i| <= TRIBO_PLAIN */
    double dt;       /* of a step */
    struct bounds b; /* of a step */
};

/* ------------------------------------------------------------------------------------------------------------- kernels */

TRIBO_SIMD static int any_in_band(size_t n, const double *v, double band)
{
    int64_t any = 0; /* as wide as a double, for vectors */
    TRIBO_UNROLLED
    for (size_t i = 0; i < n; i++) {
        any |= fabs(v[i]) <= band ? -1 : 0;
    }
    return any != 0;
}

int tribo_any_near(const tribo_context *ctx, size_t k, const double *v)
{
    const struct law *law = ctx->set.law;
    const double widest = ctx->follow.chunk[k].band, band = law->sticks_in_band ? widest : lesser(widest, 0.0);
    return law->uses_feq && (fabs(*v) <= band || any_in_band(tribo_chunk_size(ctx, k * TRIBO_CHUNK), v, band));
}

TRIBO_SIMD void tribo_slide(size_t n, const double *restrict v, const double *restrict limit, double *restrict f)
{
    for (size_t i = 0; i < n; i++) {
        f[i] = sliding(v[i], limit[i]);
    }
}

/* f = -scale v/R_ii within limits. */
TRIBO_SIMD static void stop(size_t n, double scale, const double *restrict v, const double *restrict inverse,
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

TRIBO_SIMD static void feq_alone(size_t n, const double *restrict inverse, const double *restrict a, double *restrict feq)
{
    for (size_t i = 0; i < n; i++) {
        feq[i] = tribo_alone(a[i], inverse[i]);
    }
}

/* --------------------------------------------------------------------------------------------------------------- calls */

/* Sets last.f of all contacts, and its copy f [n], or NULL, chunk by chunk. */
static void find_each(tribo_context *ctx, const struct call *call, double *f)
{
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        call->find(ctx, call, k, ctx->last.f + i);
        tribo_copy(f ? f + i : NULL, ctx->last.f + i, f ? tribo_chunk_size(ctx, i) : 0);
    }
}

/* -------------------------------------------------------------------------------------------------------------- balance */

/* feq [n] of chunk k; 0 of open contacts. */
static void find_feq(const tribo_context *ctx, const struct call *call, size_t k, double *feq)
{
    const size_t i = k * TRIBO_CHUNK, n = tribo_chunk_size(ctx, i);
    if (ctx->follow.chunk[k].plain && (call->plain || tribo_is_within(call->a + i, n, TRIBO_PLAIN))) {
        feq_alone(n, tribo_inverses(ctx, k), call->a + i, feq);
    } else {
        for (size_t j = 0; j < n; j++) {
            feq[j] = tribo_alone_far(call->a[i + j], tribo_inverses(ctx, k)[j]);
        }
    }
    for (size_t j = 0; ctx->follow.chunk[k].least == 0.0 && j < n; j++) {
        feq[j] = ctx->follow.contacts.limit[i + j] > 0.0 ? feq[j] : 0.0;
    }
}

/* Where the law uses f_eq, contacts that are not near stick slide with their limits. */
static void balance_chunk(tribo_context *ctx, const struct call *call, size_t k, double *f)
{
    const size_t i = k * TRIBO_CHUNK, n = tribo_chunk_size(ctx, i);
    const struct law *law = ctx->set.law;
    const struct contacts c = tribo_chunk_contacts(ctx, i);
    const struct delassus *op = ctx->op;
    const int alone = op->islands > op->groups; /* there are contacts in no group */
    const double *v = call->v + i;
    const int near = tribo_any_near(ctx, k, v), reads = near && alone;
    double room[TRIBO_CHUNK], *feq = call->feq ? call->feq + i : room;
    const int finds = reads || (call->wanted && alone);
    if (finds) {
        find_feq(ctx, call, k, feq);
    }
    if (ctx->set.breaking) {
        tribo_find_limits(ctx, i, n, v, reads ? feq : NULL, ctx->follow.now + i);
    }
    if (reads || !law->uses_feq) {
        law->force(&c, n, v, reads ? feq : v, f);
    } else {
        tribo_slide(n, v, c.limit, f);
    }
    if (op->groups) {
        unsigned char *is_near = ctx->last.near + i;
        memset(is_near, 0, n);
        for (size_t j = 0; near && j < n; j++) {
            const double own = law->sticks_in_band ? tribo_epsilon_of(&ctx->follow.contacts, i + j) : 0.0;
            is_near[j] = fabs(v[j]) <= own && ctx->follow.contacts.limit[i + j] > 0.0;
            if (is_near[j]) {
                tribo_list_group(ctx, tribo_group_of(ctx)[i + j]);
            }
        }
    }
}

/* Balances chunk k by the law of the caller. Its box stays in tribo_own_box, but if tribo_all_alone, where it gives last.slip. */
static void balance_own(tribo_context *ctx, const struct call *call, size_t k, double *f)
{
    const size_t i = k * TRIBO_CHUNK, n = tribo_chunk_size(ctx, i);
    const struct contacts c = tribo_chunk_contacts(ctx, i);
    const int alone = tribo_all_alone(ctx);
    double room[TRIBO_CHUNK], *feq = call->feq ? call->feq + i : room, space[BOX_ROWS * TRIBO_CHUNK + TRIBO_LINE];
    double *box = alone ? tribo_aligned(space) : tribo_own_box(ctx, i);
    find_feq(ctx, call, k, feq);
    tribo_own_boxes(&c, n, 0, call->v + i, feq, box, f);
    if (alone) {
        tribo_own_slips(ctx, i, call->v + i, box);
    }
    for (size_t j = 0; ctx->op->groups && j < n; j++) {
        ctx->last.near[i + j] = box[j] < box[n + j];
        if (ctx->last.near[i + j]) {
            tribo_list_group(ctx, tribo_group_of(ctx)[i + j]);
        }
    }
}

void tribo_balance_each(tribo_context *ctx, int plain, int wanted, const double *v, const double *a)
{
    find_each(ctx,
              &(const struct call){.find = tribo_is_own(ctx) ? balance_own : balance_chunk,
                                   .v = v,
                                   .a = a,
                                   .feq = wanted || !tribo_all_alone(ctx) ? ctx->last.feq : NULL,
                                   .wanted = wanted,
                                   .plain = plain},
              NULL);
}

int tribo_balance_one(tribo_context *ctx, int plain, const double *v, const double *a, double *feq, double *f)
{
    const struct contacts *c = &ctx->follow.contacts;
    const double inverse = *ctx->op->inverse;
    const double alone = plain && ctx->follow.chunk->plain ? tribo_alone(*a, inverse) : tribo_alone_far(*a, inverse);
    const double balance = *c->limit > 0.0 ? alone : 0.0;
    const int own = tribo_is_own(ctx);
    double force, box[BOX_ROWS];
    if (!own) {
        ctx->set.law->force(c, 1, v, &balance, &force);
    } else if (!tribo_own_boxes(c, 1, 0, v, &balance, box, &force)) {
        tribo_begin_call(ctx);
        return tribo_own_fail(ctx, 0, v);
    }
    tribo_end_alone(ctx, ctx->set.law->holds);
    if (own) {
        *ctx->last.slip = tribo_own_slip(*v, force, *c->limit, box[LOWER], box[UPPER]);
        ctx->last.slips = SLIPS_WRITTEN;
    }
    *ctx->last.f = force;
    tribo_copy(feq, &balance, feq != NULL);
    tribo_copy(f, &force, f != NULL);
    return TRIBO_OK;
}

/* ----------------------------------------------------------------------------------------------------------------- step */

static void step_chunk(tribo_context *ctx, const struct call *call, size_t k, double *f)
{
    const size_t i = k * TRIBO_CHUNK, n = tribo_chunk_size(ctx, i);
    const struct chunk *chunk = &ctx->follow.chunk[k];
    const double *v = call->v + i, dt = call->dt;
    if (call->b.lower) {
        stop_far(n, dt, v, tribo_inverses(ctx, k), &(struct bounds){call->b.lower + i, call->b.upper + i}, f);
        return;
    }
    const double *limit = tribo_chunk_contacts(ctx, i).limit;
    /* Contacts that are faster than reach, none of them open, slide on over dt, by a margin for rounding. */
    const double gain = scaled(chunk->quickest, dt), far = product(1.0000001 * greater(gain, DBL_MIN), chunk->largest);
    const double reach = chunk->least > 0.0 && greater(gain, far) < 0.5 * TRIBO_FAR ? far : DBL_MAX;
    if (!(fabs(*v) <= reach || any_in_band(n, v, reach))) {
        tribo_slide(n, v, limit, f);
    } else if (!chunk->plain || dt < LEAST_STEP || !tribo_is_within(v, n, TRIBO_PLAIN)) {
        stop_far(n, dt, v, tribo_inverses(ctx, k), &(struct bounds){NULL, limit}, f);
    } else {
        stop(n, quotient(1.0, dt), v, tribo_inverses(ctx, k), limit, f);
    }
}

void tribo_step_each(tribo_context *ctx, double dt, const double *v, struct bounds b, double *f)
{
    if (ctx->n == 1 && !b.lower && ctx->follow.chunk->plain && dt >= LEAST_STEP && tribo_within(*v, TRIBO_PLAIN)) {
        *ctx->last.f = clamp(tribo_alone(*v * quotient(1.0, dt), *ctx->op->inverse), -*b.upper, *b.upper);
        tribo_copy(f, ctx->last.f, f != NULL);
        return;
    }
    find_each(ctx, &(const struct call){.find = step_chunk, .v = v, .dt = dt, .b = b}, f);
}
