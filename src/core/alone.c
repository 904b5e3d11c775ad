/* Forces of contacts that share no body, where no limit is static: of the balance, and over a step.
 *
 * Since outputs stay as they are where a call fails, all of v and a is read and found good before anything is written. Then come
 * the contacts chunk by chunk. Arrays of a large scene come from far away, and so nothing is read that leaves no choice: 1/R_ii
 * or limits that are the same for all, a where all contacts slide. */
#include "common/stream.h"
#include "check.h"

enum { FEW = 8 * TRIBO_CHUNK }; /* whose forces stay in the first-level cache */

/* What a call is given, and how the forces f [n] of its chunk k are found: returns whether all contacts slide. */
struct call {
    int (*find)(const tribo_context *ctx, const struct call *call, size_t k, double *f);
    double holds; /* see struct last */
    const double *v, *a;
    double *feq; /* or NULL */
    double dt;   /* of a step */
    int plain;   /* a is TRIBO_PLAIN at most */
};

/* ---------------------------------------------------------------------------------------------------------------- calls */

/* Which way a contact slides by its force: that reaches its limit, or the part of it at which the law lets go. */
static inline signed char alone_slip_of(double f, double edge)
{
    const double forth = f <= -edge ? TRIBO_SLIP_FORTH : 0.0, back = f >= edge ? -TRIBO_SLIP_BACK : 0.0;
    return (signed char)(int)(forth - back); /* numbers as wide as f: vectors of them stay whole */
}

TRIBO_SIMD static void alone_find_slips(size_t n, double holds, const double *restrict limit, const double *restrict f,
                                        signed char *restrict slip)
{
    for (size_t i = 0; i < n; i++) {
        slip[i] = alone_slip_of(f[i], holds * limit[i]);
    }
}

TRIBO_SIMD static void find_alike_slips(size_t n, double edge, const double *restrict f, signed char *restrict slip)
{
    for (size_t i = 0; i < n; i++) {
        slip[i] = alone_slip_of(f[i], edge);
    }
}

TRIBO_SIMD static void find_open(size_t n, const double *restrict limit, signed char *restrict slip)
{
    for (size_t i = 0; i < n; i++) {
        slip[i] = (signed char)(limit[i] > 0.0 ? slip[i] : TRIBO_SLIP_OPEN);
    }
}

/* What the contacts of chunk k did, by their forces f [n]. */
static void alone_write_slips(const tribo_context *ctx, double holds, size_t k, const double *f, signed char *slip)
{
    const struct chunk *chunk = &ctx->follow.chunk[k];
    const size_t n = tribo_chunk_size(ctx, k * TRIBO_CHUNK);
    const double *limit = ctx->follow.contacts.limit + k * TRIBO_CHUNK;
    if (chunk->alike) {
        find_alike_slips(n, holds * chunk->largest, f, slip);
        return;
    }
    alone_find_slips(n, holds, limit, f, slip);
    if (chunk->least == 0.0) {
        find_open(n, limit, slip);
    }
}

static void alone_keep_forces(tribo_context *ctx, double holds)
{
    tribo_store_all(ctx);
    ctx->last.slips = SLIPS_IN_FORCES;
    ctx->last.holds = holds;
}

/* What calls have found besides forces. */
static void alone_finish(tribo_context *ctx)
{
    ctx->last.rank = 0;
    ctx->last.linearized = 0;
    ctx->count.skipped += ctx->op->islands;
}

/* The force of the only contact: calls for one do without what many are worth. */
static void put_one(tribo_context *ctx, double force, double holds, double *f)
{
    *ctx->last.f = force;
    if (f) {
        *f = force;
    }
    alone_keep_forces(ctx, holds);
    alone_finish(ctx);
}

/* The forces of a few contacts are kept. */
static void find_few(tribo_context *ctx, const struct call *call, double *f)
{
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        call->find(ctx, call, k, ctx->last.f + i);
        tribo_copy(f ? f + i : NULL, ctx->last.f + i, f ? tribo_chunk_size(ctx, i) : 0);
    }
    alone_keep_forces(ctx, call->holds);
}

/* Those of many would have to be written to memory and read again: what each contact did is written down while its force is at
 * hand. */
static void find_many(tribo_context *ctx, const struct call *call, double *f)
{
    struct stream to;
    tribo_stream_begin(&to, f, ctx->n >= TRIBO_MANY);
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        double *force = tribo_stream_room(&to);
        const int slide = call->find(ctx, call, k, force);
        if (slide && ctx->follow.chunk[k].least > 0.0) {
            tribo_find_directions(tribo_chunk_size(ctx, i), call->v + i, ctx->last.did.of + i);
        } else {
            alone_write_slips(ctx, call->holds, k, force, ctx->last.did.of + i);
        }
        tribo_stream_put(&to, tribo_chunk_size(ctx, i));
    }
    tribo_stream_end(&to);
    ctx->last.did.all_stored = 0;
    ctx->last.slips = SLIPS_WRITTEN;
}

static void alone_find_all(tribo_context *ctx, const struct call *call, double *f)
{
    (ctx->n <= FEW ? find_few : find_many)(ctx, call, f);
    alone_finish(ctx);
}

/* -------------------------------------------------------------------------------------------------------------- balance */

static int balance_chunk(const tribo_context *ctx, const struct call *call, size_t k, double *f)
{
    const size_t i = k * TRIBO_CHUNK, n = tribo_chunk_size(ctx, i);
    const struct contacts c = tribo_chunk_contacts(ctx, i);
    const double *v = call->v + i;
    double room[TRIBO_CHUNK], *feq = call->feq ? call->feq + i : room;
    /* Whether the law reads f_eq of a contact of chunk k, of which v is the first. */
    const double band = tribo_widest_band(ctx, k);
    const int reads = ctx->set.law->uses_feq && (fabs(*v) <= band || tribo_any_in_band(n, v, band));
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

/* f_eq NULL: nobody asks for it. */
static double balance_one(const tribo_context *ctx, double v, double a, int plain, double *feq)
{
    const struct contacts *c = &ctx->follow.contacts;
    const double inverse = *ctx->op->inverse;
    const double balance = plain && ctx->follow.chunk->plain ? tribo_alone(a, inverse) : tribo_alone_far(a, inverse);
    if (feq) {
        *feq = *c->limit > 0.0 ? balance : 0.0;
    }
    return ctx->set.law->force_of_one(c, v, balance);
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
        put_one(ctx, balance_one(ctx, *v, *a, plain, feq), holds, f);
    } else {
        alone_find_all(ctx, &(const struct call){balance_chunk, holds, v, a, feq, 0.0, plain}, f);
    }
    ctx->last.residual = 0.0;
    return TRIBO_OK;
}

/* ----------------------------------------------------------------------------------------------------------------- step */

/* What stops contacts, scale being 1/dt, within bounds. */
TRIBO_SIMD static void alone_stop(size_t n, double scale, const double *restrict v, const double *restrict inverse,
                                  const double *lower, const double *upper, double *restrict f)
{
    for (size_t i = 0; lower && i < n; i++) {
        f[i] = clamp(tribo_alone(v[i] * scale, inverse[i]), lower[i], upper[i]);
    }
    for (size_t i = 0; !lower && i < n; i++) {
        f[i] = clamp(tribo_alone(v[i] * scale, inverse[i]), -upper[i], upper[i]);
    }
}

TRIBO_SIMD static void stop_alike(size_t n, double scale, const double *restrict v, const double *restrict inverse, double limit,
                                  double *restrict f)
{
    for (size_t i = 0; i < n; i++) {
        f[i] = clamp(tribo_alone(v[i] * scale, inverse[i]), -limit, limit);
    }
}

#define LEAST_STEP (1.0 / TRIBO_PLAIN)

/* The same where products might be no numbers, or 1/dt. */
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
    const double *inverse = tribo_inverses(ctx, k), scale = quotient(1.0, dt);
    if (!chunk->plain || dt < LEAST_STEP || !tribo_all_plain(v, n)) {
        stop_far(n, dt, v, inverse, &b, f);
    } else if (chunk->alike && !b.lower && b.upper == ctx->follow.contacts.limit + k * TRIBO_CHUNK) {
        stop_alike(n, scale, v, inverse, chunk->largest, f);
    } else {
        alone_stop(n, scale, v, inverse, b.lower, b.upper, f);
    }
}

/* Contacts that are faster, none of them open, slide on over dt, by a margin for rounding. */
static double reach_of(const struct chunk *chunk, double dt)
{
    const double reach = product(1.0000001 * greater(product(chunk->quickest, dt), DBL_MIN), chunk->largest);
    return chunk->least > 0.0 && reach < TRIBO_FAR ? reach : DBL_MAX;
}

TRIBO_SIMD static void slide(const struct contacts *c, size_t n, const double *restrict v, double *restrict f)
{
    const double *limit = c->limit, one = *limit;
    for (size_t i = 0; c->alike && i < n; i++) {
        f[i] = sliding(v[i], one);
    }
    for (size_t i = 0; !c->alike && i < n; i++) {
        f[i] = sliding(v[i], limit[i]);
    }
}

static int step_chunk(const tribo_context *ctx, const struct call *call, size_t k, double *f)
{
    const size_t i = k * TRIBO_CHUNK, n = tribo_chunk_size(ctx, i);
    const struct contacts c = tribo_chunk_contacts(ctx, i);
    const double *v = call->v + i, reach = reach_of(&ctx->follow.chunk[k], call->dt);
    if (fabs(*v) <= reach || tribo_any_in_band(n, v, reach)) {
        tribo_stop_alone(ctx, k, call->dt, v, (struct bounds){NULL, ctx->follow.contacts.limit + i}, f);
        return 0;
    }
    slide(&c, n, v, f);
    return 1;
}

static double step_one(const tribo_context *ctx, double dt, double v)
{
    const struct bounds b = {NULL, ctx->follow.contacts.limit};
    double f;
    if (ctx->follow.chunk->plain && dt >= LEAST_STEP && tribo_within(v, TRIBO_PLAIN)) {
        return clamp(tribo_alone(v * quotient(1.0, dt), *ctx->op->inverse), -*b.upper, *b.upper);
    }
    stop_far(1, dt, &v, ctx->op->inverse, &b, &f);
    return f;
}

int tribo_step_alone(tribo_context *ctx, double dt, const double *v, double *f)
{
    if (ctx->n == 1) {
        put_one(ctx, step_one(ctx, dt, *v), 1.0, f);
    } else {
        alone_find_all(ctx, &(const struct call){.find = step_chunk, .holds = 1.0, .v = v, .dt = dt}, f);
    }
    return TRIBO_OK;
}
