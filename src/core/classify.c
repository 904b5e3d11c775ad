/* What a call learns of all contacts before it solves for any. In a large scene most slide, of which the direction is all that
 * there is to know, and reading and writing memory is all that they cost: so every array is passed over as seldom as can be, in
 * chunks that stay in the first-level cache. What a call learns takes the last call's place once v and a are found good. */
#include "check.h"

/* Whether any contact is in the band, beyond which laws that ask for f_eq all say the same. */
TRIBO_SIMD int tribo_any_in_band(size_t n, const double *v, double band)
{
    int64_t any = 0; /* as wide as what is compared */
    TRIBO_UNROLLED
    for (size_t i = 0; i < n; i++) {
        any |= fabs(v[i]) <= band ? -1 : 0;
    }
    return any != 0;
}

TRIBO_SIMD void tribo_find_directions(size_t n, const double *restrict v, signed char *restrict did)
{
    for (size_t i = 0; i < n; i++) {
        did[i] = v[i] > 0.0 ? TRIBO_SLIP_FORTH : TRIBO_SLIP_BACK;
    }
}

/* did [n]: STORED where |v| <= band, v = 0 if band is NULL, and the contact is not open; else the direction of v. */
TRIBO_SIMD static void find_states(size_t n, const double *restrict v, const double *restrict band, const double *restrict limit,
                                   signed char *restrict did)
{
    for (size_t i = 0; band && i < n; i++) {
        const int near = (fabs(v[i]) <= band[i]) & (limit[i] > 0.0);
        did[i] = (signed char)(near ? STORED : v[i] > 0.0 ? TRIBO_SLIP_FORTH : TRIBO_SLIP_BACK);
    }
    for (size_t i = 0; !band && i < n; i++) {
        const int near = (v[i] == 0.0) & (limit[i] > 0.0);
        did[i] = (signed char)(near ? STORED : v[i] > 0.0 ? TRIBO_SLIP_FORTH : TRIBO_SLIP_BACK);
    }
}

/* f_eq of contacts that share no body. */
TRIBO_SIMD static void feq_alone(size_t n, const double *restrict inverse, const double *restrict a, double *restrict feq)
{
    for (size_t i = 0; i < n; i++) {
        feq[i] = tribo_alone(a[i], inverse[i]);
    }
}

static void feq_alone_far(size_t n, const double *inverse, const double *a, double *feq)
{
    for (size_t i = 0; i < n; i++) {
        feq[i] = tribo_alone_far(a[i], inverse[i]);
    }
}

TRIBO_SIMD static void no_feq_if_open(size_t n, const double *restrict limit, double *restrict feq)
{
    for (size_t i = 0; i < n; i++) {
        feq[i] = limit[i] > 0.0 ? feq[i] : 0.0;
    }
}

void tribo_find_feq(const tribo_context *ctx, size_t i, size_t n, const double *a, double *feq)
{
    const struct chunk *chunk = &ctx->follow.chunk[i / TRIBO_CHUNK];
    const double *inverse = ctx->op->inverse + chunk->like;
    if (chunk->plain && tribo_all_plain(a + i, n)) {
        feq_alone(n, inverse, a + i, feq);
    } else {
        feq_alone_far(n, inverse, a + i, feq);
    }
    if (chunk->least == 0.0) {
        no_feq_if_open(n, ctx->follow.contacts.limit + i, feq);
    }
}

/* f [n]: the limit against the slip, or kept where did is STORED. */
TRIBO_SIMD static void forces_of_states(size_t n, const signed char *restrict did, const double *restrict limit,
                                        const double *restrict kept, double *restrict f)
{
    for (size_t i = 0; i < n; i++) {
        const double slides = did[i] == TRIBO_SLIP_FORTH ? -limit[i] : limit[i];
        f[i] = did[i] == STORED ? kept[i] : slides;
    }
}

/* f [n] of contacts that slide; same: all have the first limit. */
TRIBO_SIMD static void forces_of_slips(size_t n, const signed char *restrict did, const double *restrict limit, int same,
                                       double *restrict f)
{
    const double one = *limit;
    for (size_t i = 0; same && i < n; i++) {
        f[i] = did[i] == TRIBO_SLIP_FORTH ? -one : one;
    }
    for (size_t i = 0; !same && i < n; i++) {
        f[i] = did[i] == TRIBO_SLIP_FORTH ? -limit[i] : limit[i];
    }
}

/* The chunk after next will soon be read, or written. */
static void classify_expect(const tribo_context *ctx, const double *x, size_t i, int written)
{
    if (ctx->n - i > 2 * TRIBO_CHUNK) {
        tribo_expect(x + i + 2 * TRIBO_CHUNK, tribo_chunk_size(ctx, i + 2 * TRIBO_CHUNK) * sizeof *x, written);
    }
}

/* Each of the first with its partner in the second half. */
static inline void fold(size_t half, double *least, double *largest)
{
    for (size_t k = 0; k < half; k++) {
        least[k] = lesser(least[k], least[k + half]);
        largest[k] = greater(largest[k], largest[k + half]);
    }
}

/* Of a whole chunk, half upon half: one after the other they would have to be looked at in order. */
TRIBO_SIMD static void classify_find_bounds(const double *x, struct chunk *chunk)
{
    enum { HALF = TRIBO_CHUNK / 2, FEW = 8 };
    double least[HALF], largest[HALF];
    for (size_t k = 0; k < HALF; k++) {
        least[k] = lesser(x[k], x[k + HALF]);
        largest[k] = greater(x[k], x[k + HALF]);
    }
    fold(HALF / 2, least, largest);
    fold(HALF / 4, least, largest);
    fold(FEW, least, largest);
    for (size_t k = 1; k < FEW; k++) {
        least[0] = lesser(least[0], least[k]);
        largest[0] = greater(largest[0], largest[k]);
    }
    chunk->least = least[0];
    chunk->largest = largest[0];
}

void tribo_take_limits(size_t n, const double *from, double *to, struct chunk *chunk)
{
    enum { FEW = 16 };
    double whole[TRIBO_CHUNK];
    memcpy(to, from, n * sizeof *to);
    if (n < FEW) {
        /* Few limits are looked at one by one. */
        chunk->least = chunk->largest = from[0];
        for (size_t i = 1; i < n; i++) {
            chunk->least = lesser(chunk->least, from[i]);
            chunk->largest = greater(chunk->largest, from[i]);
        }
    } else if (n < TRIBO_CHUNK) {
        memcpy(whole, from, n * sizeof *whole);
        for (size_t k = n; k < TRIBO_CHUNK; k++) {
            whole[k] = from[0];
        }
        classify_find_bounds(whole, chunk);
    } else {
        classify_find_bounds(from, chunk);
    }
}

TRIBO_SIMD static void find_epsilons(size_t n, const double *restrict width, const double *restrict bound,
                                     double *restrict epsilon)
{
    for (size_t i = 0; i < n; i++) {
        epsilon[i] = tribo_epsilon(1, width[i], bound[i]);
    }
}

const double *tribo_epsilons(const struct contacts *c, size_t i, size_t n, double *room)
{
    if (!c->follows) {
        return c->width + i;
    }
    find_epsilons(n, c->width + i, c->bound + i, room);
    return room;
}

static int check_motion(tribo_context *ctx, const double *v, const double *a)
{
    const int status = tribo_check_finite(ctx, "v", v, ctx->n);
    return status ? status : tribo_check_finite(ctx, "a", a, ctx->n);
}

void tribo_store_all(tribo_context *ctx)
{
    if (!ctx->last.did.all_stored) {
        memset(ctx->last.did.of, STORED, ctx->n);
        memset(ctx->last.did.stored, ALL_STORED, tribo_chunks(ctx->n));
        ctx->last.did.all_stored = 1;
    }
}

double tribo_widest_band(const tribo_context *ctx, size_t k)
{
    const double band = ctx->follow.chunk[k].band;
    return ctx->set.law->sticks_in_band ? band : lesser(band, 0.0);
}

int tribo_classify(tribo_context *ctx, const double *v, const double *a)
{
    struct deeds now = ctx->spare;
    const int few = !ctx->op->groups && ctx->n <= TRIBO_CHUNK; /* whose laws are asked sooner than what they do is found */
    if (!v || !a || few || !ctx->set.law->uses_feq) {
        const int status = check_motion(ctx, v, a);
        if (!status) {
            tribo_store_all(ctx);
        }
        return status;
    }
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        const size_t n = tribo_chunk_size(ctx, i);
        const double band = tribo_widest_band(ctx, k);
        classify_expect(ctx, v, i, 0);
        classify_expect(ctx, a, i, 0);
        if (tribo_motion_within(v + i, a + i, DBL_MAX, n) != 3) {
            return check_motion(ctx, v, a);
        }
        const int any = tribo_any_in_band(n, v + i, band);
        now.stored[k] = !any ? NONE_STORED : ctx->op->groups ? SOME_STORED : ALL_STORED;
        if (now.stored[k] == ALL_STORED) {
            memset(now.of + i, STORED, n); /* the law finds which of them slide */
        } else if (now.stored[k] == SOME_STORED) {
            double room[TRIBO_CHUNK];
            const double *own = ctx->set.law->sticks_in_band ? tribo_epsilons(&ctx->follow.contacts, i, n, room) : NULL;
            find_states(n, v + i, own, ctx->follow.contacts.limit + i, now.of + i);
        } else {
            tribo_find_directions(n, v + i, now.of + i);
        }
    }
    now.all_stored = 0;
    ctx->spare = ctx->last.did;
    ctx->last.did = now;
    return TRIBO_OK;
}

void tribo_forces_alone(tribo_context *ctx, const double *v, const double *a, int wanted)
{
    const int some = ctx->op->islands > ctx->op->groups;
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        const size_t n = tribo_chunk_size(ctx, i);
        const int asked = ctx->last.did.stored[k] == ALL_STORED || (some && ctx->last.did.stored[k] == SOME_STORED);
        if (wanted ? some : asked && ctx->set.law->uses_feq) {
            tribo_find_feq(ctx, i, n, a, ctx->last.feq + i);
        }
        if (ctx->set.breaking) {
            const int known = asked && ctx->set.law->uses_feq;
            tribo_find_limits(ctx, i, n, v + i, known ? ctx->last.feq + i : NULL, ctx->follow.now + i);
        }
        if (asked) {
            const struct contacts c = tribo_contacts_from(&ctx->follow.contacts, i);
            ctx->set.law->force(&c, n, v + i, ctx->last.feq + i, ctx->last.f + i);
        }
    }
}

void tribo_forces(const tribo_context *ctx, double *f)
{
    if (ctx->last.did.all_stored) {
        tribo_copy(f, ctx->last.f, ctx->n);
        return;
    }
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        const size_t n = tribo_chunk_size(ctx, i);
        classify_expect(ctx, f, i, 1);
        const signed char *did = ctx->last.did.of + i;
        const double *limit = ctx->follow.contacts.limit + i, *kept = ctx->last.f + i;
        if (ctx->last.did.stored[k] == ALL_STORED) {
            memcpy(f + i, kept, n * sizeof *f);
        } else if (ctx->last.did.stored[k] == SOME_STORED) {
            forces_of_states(n, did, limit, kept, f + i);
        } else {
            forces_of_slips(n, did, limit, !(ctx->follow.chunk[k].least < ctx->follow.chunk[k].largest), f + i);
        }
    }
}
