/* What a context tells of its last call, and of itself. */
#include <math.h>

#include "check.h"
#include "common/simd.h"

int tribo_get_ncontact(const tribo_context *ctx, size_t *ncontact)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!ncontact) {
        return TRIBO_ERR_NULL;
    }
    *ncontact = ctx->n;
    return TRIBO_OK;
}

/* The force alone tells: only where a law holds the contact is it less than the limit. (The smooth law never reaches the limit;
 * it counts as holding where |v| < epsilon.) */
static inline signed char queries_slip_of(signed char did, double f, double limit, double holds)
{
    const double edge = holds * limit;
    const int open = !(limit > 0.0), stored = (f <= -edge) - (f >= edge), slip = did + (did == STORED) * stored;
    return (signed char)(slip * !open + TRIBO_SLIP_OPEN * open); /* no choice: that is what makes loops of it fast */
}

/* Slips take the place of what contacts did. */
TRIBO_SIMD static void queries_find_slips(size_t n, const double *restrict f, const double *restrict limit, double holds,
                                          signed char *restrict did)
{
    for (size_t i = 0; i < n; i++) {
        did[i] = queries_slip_of(did[i], f[i], limit[i], holds);
    }
}

void tribo_write_slips(tribo_context *ctx)
{
    for (size_t i = 0, k = 0; ctx->last.slips == SLIPS_IN_FORCES && i < ctx->n; i += TRIBO_CHUNK, k++) {
        if (ctx->last.did.stored[k] != NONE_STORED || ctx->follow.chunk[k].least == 0.0) {
            queries_find_slips(tribo_chunk_size(ctx, i), ctx->last.f + i, ctx->follow.contacts.limit + i, ctx->last.holds,
                               ctx->last.did.of + i);
            ctx->last.did.stored[k] = SOME_STORED;
            ctx->last.did.all_stored = 0;
        }
    }
    if (ctx->planar && ctx->last.slips == SLIPS_IN_FORCES) {
        tribo_planar_slips(ctx, ctx->last.did.of);
    }
    ctx->last.slips = ctx->last.slips == NO_SLIPS ? NO_SLIPS : SLIPS_WRITTEN;
}

int tribo_get_slip(const tribo_context *ctx, signed char *slip)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!slip && ctx->n) {
        return TRIBO_ERR_NULL;
    }
    if (ctx->last.slips == NO_SLIPS) {
        return TRIBO_ERR_STATE;
    }
    if (ctx->n) {
        memcpy(slip, ctx->last.did.of, ctx->n);
    }
    if (ctx->last.slips == SLIPS_IN_FORCES) {
        queries_find_slips(ctx->n, ctx->last.f, ctx->follow.contacts.limit, ctx->last.holds, slip);
        if (ctx->planar) {
            tribo_planar_slips(ctx, slip);
        }
    }
    return TRIBO_OK;
}

static size_t count_stuck(const tribo_context *ctx)
{
    size_t stuck = 0;
    for (size_t i = 0; ctx->last.slips == SLIPS_IN_FORCES && i < ctx->n; i++) {
        stuck += queries_slip_of(ctx->last.did.of[i], ctx->last.f[i], ctx->follow.contacts.limit[i], ctx->last.holds) == 0;
    }
    for (size_t k = 0; ctx->planar && ctx->last.slips == SLIPS_IN_FORCES && k < ctx->planar->count; k++) {
        for (size_t i = ctx->planar->first[k]; i < ctx->planar->first[k] + 2; i++) {
            stuck -= queries_slip_of(ctx->last.did.of[i], ctx->last.f[i], ctx->follow.contacts.limit[i], ctx->last.holds) == 0;
            stuck += tribo_planar_slip(ctx, k) == 0;
        }
    }
    for (size_t i = 0; ctx->last.slips == SLIPS_WRITTEN && i < ctx->n; i++) {
        stuck += ctx->last.did.of[i] == 0;
    }
    return stuck;
}

/* 1, or 0 if there is no such count. */
static int find_count(const tribo_context *ctx, int which, size_t *value)
{
    const struct work *work = &ctx->memory.problem.work;
    switch (which) {
    case TRIBO_COUNT_STUCK:
        *value = count_stuck(ctx);
        return 1;
    case TRIBO_COUNT_RANK:
        *value = ctx->last.rank;
        return 1;
    case TRIBO_COUNT_ISLANDS:
        *value = tribo_islands(ctx);
        return 1;
    case TRIBO_COUNT_SOLVES:
        *value = ctx->count.solves;
        return 1;
    case TRIBO_COUNT_SKIPPED:
        *value = ctx->count.skipped;
        return 1;
    case TRIBO_COUNT_FACTORIZATIONS:
        *value = work->factorizations;
        return 1;
    case TRIBO_COUNT_UPDATES:
        *value = work->updates;
        return 1;
    case TRIBO_COUNT_REVERSALS:
        *value = ctx->count.marks;
        return 1;
    case TRIBO_COUNT_REUSED:
        *value = ctx->count.reused;
        return 1;
    case TRIBO_COUNT_PLANAR:
        *value = ctx->planar ? ctx->planar->count : 0;
        return 1;
    case TRIBO_COUNT_SETTINGS:
        *value = ctx->revision;
        return 1;
    default:
        return 0;
    }
}

int tribo_get_count(const tribo_context *ctx, int which, size_t *value)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!value) {
        return TRIBO_ERR_NULL;
    }
    return find_count(ctx, which, value) ? TRIBO_OK : TRIBO_ERR_RANGE;
}

/* In the consistent coupling a stuck contact relaxes at its own 2 N R_ii/epsilon; otherwise v' = -R diag(s) v with s =
 * 2N/epsilon, or half of it for the laws that are dampers near v = 0. The eigenvalues of that are at most the largest s_i R_ii
 * times the largest eigenvalue of D^-1 R, for any set of contacts near stick. */
static double max_rate(const tribo_context *ctx)
{
    double rate = 0.0;
    for (size_t i = 0; i < ctx->n; i++) {
        if (ctx->follow.contacts.limit[i] > 0.0 && !(ctx->planar && ctx->planar->role[i] != ROLE_SCALAR)) {
            rate = greater(rate, product(tribo_steepest_slope(ctx, i), ctx->op->diagonal[i]));
        }
    }
    for (size_t k = 0; ctx->planar && k < ctx->planar->count; k++) {
        rate = greater(rate, tribo_planar_rate(ctx, k));
    }
    if (!ctx->set.law->uses_feq) {
        return product(0.5 * rate, ctx->op->growth);
    }
    if (!ctx->set.law->relaxes) {
        return 0.0;
    }
    return ctx->set.coupling == TRIBO_PARTITION ? product(rate, ctx->op->growth) : rate;
}

int tribo_get_real(const tribo_context *ctx, int which, double *value)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!value) {
        return TRIBO_ERR_NULL;
    }
    if (which == TRIBO_REAL_RESIDUAL) {
        *value = ctx->last.residual;
        return TRIBO_OK;
    }
    if (which != TRIBO_REAL_MAX_RATE && which != TRIBO_REAL_MAX_STEP) {
        return TRIBO_ERR_RANGE;
    }
    if (!tribo_has_operator(ctx)) {
        return TRIBO_ERR_STATE;
    }
    const double rate = max_rate(ctx);
    *value = which == TRIBO_REAL_MAX_RATE ? rate : rate > 0.0 ? quotient(2.785, rate) : HUGE_VAL;
    return TRIBO_OK;
}
