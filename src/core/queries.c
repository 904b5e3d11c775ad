/* SPDX-License-Identifier: BSD-3-Clause */
/* Answers about a context and its last call. */
#include "calls.h"
#include "own.h"

int tribo_get_ncontact(const tribo_context *ctx, size_t *ncontact)
{
    if (!ctx || !ncontact) {
        return TRIBO_ERR_NULL;
    }
    *ncontact = ctx->n;
    return TRIBO_OK;
}

/* -------------------------------------------------------------------------------------------------------------- slips */

/* Returns the slip of a contact by its force f: it is stuck if |f| < holds limit. (The smooth law never reaches the limit; it
 * holds where |v| < epsilon.) */
static inline signed char slip_by_force(double f, double limit, double holds)
{
    const double edge = holds * limit;
    const double forth = f <= -edge ? TRIBO_SLIP_FORTH : 0.0, back = f >= edge ? -TRIBO_SLIP_BACK : 0.0;
    return (signed char)(int)(limit > 0.0 ? forth - back
                                          : TRIBO_SLIP_OPEN); /* doubles, as wide as f: vectors of them stay whole */
}

/* slip [n] of the last call, which has slips. */
TRIBO_SIMD static void put_slips(const tribo_context *ctx, signed char *slip)
{
    const double *f = ctx->last.f, *limit = ctx->follow.contacts.limit, holds = ctx->last.holds;
    if (ctx->last.slips == SLIPS_WRITTEN) {
        memcpy(slip, ctx->last.slip, ctx->n);
        return;
    }
    TRIBO_APART
    for (size_t i = 0; i < ctx->n; i++) {
        slip[i] = slip_by_force(f[i], limit[i], holds);
    }
    for (size_t i = 0; ctx->plane.count && i < ctx->n; i++) {
        slip[i] = tribo_is_scalar(ctx, i) ? slip[i] : tribo_plane_slip(ctx, i);
    }
}

void tribo_write_slips(tribo_context *ctx)
{
    if (ctx->last.slips == SLIPS_IN_FORCES) {
        put_slips(ctx, ctx->last.slip);
        ctx->last.slips = SLIPS_WRITTEN;
    }
}

int tribo_get_slip(const tribo_context *ctx, signed char *slip)
{
    if (!ctx || (!slip && ctx->n)) {
        return TRIBO_ERR_NULL;
    }
    if (ctx->last.slips == NO_SLIPS) {
        return TRIBO_ERR_STATE;
    }
    if (ctx->n) {
        put_slips(ctx, slip);
    }
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------ numbers */

int tribo_get_count(const tribo_context *ctx, int which, size_t *value)
{
    if (!ctx || !value) {
        return TRIBO_ERR_NULL;
    }
    const struct work *work = &ctx->memory.problem.work;
    const struct last *last = &ctx->last;
    size_t values[] = {[TRIBO_COUNT_STUCK] = 0,
                       [TRIBO_COUNT_RANK] = last->rank,
                       [TRIBO_COUNT_ISLANDS] = tribo_islands(ctx),
                       [TRIBO_COUNT_SOLVES] = ctx->count.solves,
                       [TRIBO_COUNT_SKIPPED] = ctx->count.skipped,
                       [TRIBO_COUNT_FACTORIZATIONS] = work->factorizations,
                       [TRIBO_COUNT_UPDATES] = work->updates,
                       [TRIBO_COUNT_REVERSALS] = ctx->count.marks,
                       [TRIBO_COUNT_REUSED] = ctx->count.reused,
                       [TRIBO_COUNT_PLANAR] = ctx->plane.count,
                       [TRIBO_COUNT_SETTINGS] = ctx->revision,
                       [TRIBO_COUNT_VALUES] = tribo_operator_values(ctx)};
    if (which < 0 || (size_t)which >= sizeof values / sizeof *values) {
        return TRIBO_ERR_RANGE;
    }
    for (size_t i = 0; which == TRIBO_COUNT_STUCK && last->slips != NO_SLIPS && i < ctx->n; i++) {
        const int slip = last->slips == SLIPS_WRITTEN ? last->slip[i]
                         : tribo_is_scalar(ctx, i)    ? slip_by_force(last->f[i], ctx->follow.contacts.limit[i], last->holds)
                                                      : tribo_plane_slip(ctx, i);
        values[TRIBO_COUNT_STUCK] += slip == TRIBO_SLIP_STUCK;
    }
    *value = values[which];
    return TRIBO_OK;
}

int tribo_get_real(const tribo_context *ctx, int which, double *value)
{
    if (!ctx || !value) {
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
    /* In the consistent coupling a stuck contact relaxes at its own 2 N R_ii/epsilon; otherwise v' = -R diag(s) v with s =
     * 2N/epsilon, or half of it for laws that are dampers near v = 0. The eigenvalues of R diag(s), for any set of contacts near
     * stick, are at most the largest s_i R_ii times the largest eigenvalue of D^-1 R. */
    const struct contacts *c = &ctx->follow.contacts;
    const struct law *law = ctx->set.law;
    const int own = law->uses_feq && ctx->set.coupling == TRIBO_CONSISTENT, of_caller = tribo_is_own(ctx);
    double rate = tribo_plane_rate(ctx);
    for (size_t i = 0; !of_caller && i < ctx->n; i++) {
        if (c->limit[i] > 0.0 && tribo_is_scalar(ctx, i)) {
            const double steepest = ctx->set.breaking ? c->rate[i] * ctx->follow.hold[i] : tribo_slope_of(c, i);
            rate = greater(rate, product(steepest, ctx->op->diagonal[i]));
        }
    }
    rate = law->relaxes ? rate : law->uses_feq ? 0.0 : 0.5 * rate;
    rate = own ? rate : product(rate, ctx->op->growth);
    if (of_caller && tribo_own_rate(ctx, &rate)) {
        return TRIBO_ERR_CALLBACK;
    }
    /* The fourth-order Runge-Kutta method is stable for rate dt <= 2.785. */
    *value = which == TRIBO_REAL_MAX_RATE ? rate : rate > 0.0 ? quotient(2.785, rate) : HUGE_VAL;
    return TRIBO_OK;
}
