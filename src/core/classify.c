/* SPDX-License-Identifier: BSD-3-Clause */
/* The states of all contacts before groups are solved. In a large scene most contacts slide, and all costs are those of memory:
 * arrays are read once, in chunks that stay in the first-level cache. */
#include "check.h"
#include "contacts.h"
#include "static.h"

TRIBO_SIMD int tribo_any_in_band(size_t n, const double *v, double band)
{
    int64_t any = 0; /* as wide as a double, for vectors */
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

/* did [n]: STORED where limit > 0 and |v| <= band; else the direction of v. */
TRIBO_SIMD static void find_states(size_t n, const double *restrict v, const double *restrict band, const double *restrict limit,
                                   signed char *restrict did)
{
    for (size_t i = 0; i < n; i++) {
        const int near = (fabs(v[i]) <= band[i]) & (limit[i] > 0.0);
        did[i] = (signed char)(near ? STORED : v[i] > 0.0 ? TRIBO_SLIP_FORTH : TRIBO_SLIP_BACK);
    }
}

TRIBO_SIMD static void feq_alone(size_t n, const double *restrict inverse, const double *restrict a, double *restrict feq)
{
    for (size_t i = 0; i < n; i++) {
        feq[i] = tribo_alone(a[i], inverse[i]);
    }
}

void tribo_find_feq(const tribo_context *ctx, size_t i, size_t n, const double *a, double *feq)
{
    const struct chunk *chunk = &ctx->follow.chunk[i / TRIBO_CHUNK];
    const double *inverse = ctx->op->inverse + chunk->like, *limit = ctx->follow.contacts.limit + i;
    if (chunk->plain && tribo_all_plain(a + i, n)) {
        feq_alone(n, inverse, a + i, feq);
    } else {
        for (size_t k = 0; k < n; k++) {
            feq[k] = tribo_alone_far(a[i + k], inverse[k]);
        }
    }
    for (size_t k = 0; chunk->least == 0.0 && k < n; k++) {
        feq[k] = limit[k] > 0.0 ? feq[k] : 0.0;
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

/* f [n] of contacts that slide. */
TRIBO_SIMD static void forces_of_slips(size_t n, const signed char *restrict did, const double *restrict limit,
                                       double *restrict f)
{
    for (size_t i = 0; i < n; i++) {
        f[i] = did[i] == TRIBO_SLIP_FORTH ? -limit[i] : limit[i];
    }
}

TRIBO_SIMD static void find_epsilons(size_t n, const double *restrict width, const double *restrict bound,
                                     double *restrict epsilon)
{
    for (size_t i = 0; i < n; i++) {
        epsilon[i] = tribo_epsilon(1, width[i], bound[i]);
    }
}

const double *tribo_bands(const tribo_context *ctx, size_t i, size_t n, double *room)
{
    static const double none[TRIBO_CHUNK];
    const struct contacts *c = &ctx->follow.contacts;
    if (!ctx->set.law->sticks_in_band || !c->follows) {
        return ctx->set.law->sticks_in_band ? c->width + i : none;
    }
    find_epsilons(n, c->width + i, c->bound + i, room);
    return room;
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

static int check_motion(tribo_context *ctx, const double *v, const double *a)
{
    const int status = tribo_check_finite(ctx, "v", v, ctx->n);
    return status ? status : tribo_check_finite(ctx, "a", a, ctx->n);
}

int tribo_classify(tribo_context *ctx, const double *v, const double *a)
{
    struct deeds now = ctx->spare;
    const int few = !ctx->op->groups && ctx->n <= TRIBO_CHUNK; /* the law is evaluated sooner than states are found */
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
        if (tribo_motion_within(v + i, a + i, DBL_MAX, n) != 3) {
            return check_motion(ctx, v, a);
        }
        const int any = tribo_any_in_band(n, v + i, band);
        now.stored[k] = !any ? NONE_STORED : ctx->op->groups ? SOME_STORED : ALL_STORED;
        if (now.stored[k] == ALL_STORED) {
            memset(now.of + i, STORED, n); /* the law finds which of them slide */
        } else if (now.stored[k] == SOME_STORED) {
            double room[TRIBO_CHUNK];
            find_states(n, v + i, tribo_bands(ctx, i, n, room), ctx->follow.contacts.limit + i, now.of + i);
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
    const int some = ctx->op->islands > ctx->op->groups; /* contacts in no group */
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        const size_t n = tribo_chunk_size(ctx, i);
        const int stored = ctx->last.did.stored[k] == ALL_STORED || (some && ctx->last.did.stored[k] == SOME_STORED);
        const int reads = stored && ctx->set.law->uses_feq;
        if (wanted ? some : reads) {
            tribo_find_feq(ctx, i, n, a, ctx->last.feq + i);
        }
        if (ctx->set.breaking) {
            tribo_find_limits(ctx, i, n, v + i, reads ? ctx->last.feq + i : NULL, ctx->follow.now + i);
        }
        if (stored) {
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
        const signed char *did = ctx->last.did.of + i;
        const double *limit = tribo_chunk_contacts(ctx, i).limit, *kept = ctx->last.f + i;
        if (ctx->last.did.stored[k] == ALL_STORED) {
            memcpy(f + i, kept, n * sizeof *f);
        } else if (ctx->last.did.stored[k] == SOME_STORED) {
            forces_of_states(n, did, limit, kept, f + i);
        } else {
            forces_of_slips(n, did, limit, f + i);
        }
    }
}
