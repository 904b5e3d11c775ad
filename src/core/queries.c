/* What a context tells of its last call, and of itself. */
#include <math.h>

#include "context.h"

int tribo_get_ncontact(const tribo_context *ctx, size_t *ncontact)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!ncontact) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "ncontact is NULL");
    }
    *ncontact = ctx->n;
    return TRIBO_OK;
}

/* The force alone tells: only where a law holds the contact is it less than the limit. (The smooth law never reaches the limit;
 * it counts as holding where |v| < epsilon.) */
static signed char mode_of(const tribo_context *ctx, size_t i)
{
    const double limit = ctx->limit_then[i], f = tribo_force_of(ctx, i);
    return (signed char)(limit > 0.0 ? fabs(f) < ctx->holds * limit ? 0 : f < 0.0 ? 1 : -1 : 2);
}

int tribo_get_modes(const tribo_context *ctx, signed char *mode)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!mode && ctx->n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "mode is NULL");
    }
    if (!ctx->balanced) {
        return tribo_fail(ctx, TRIBO_ERR_STATE,
                          "no tribo_balance or tribo_step_force since the last tribo_solve_box or operator");
    }
    for (size_t i = 0; i < ctx->n; i++) {
        mode[i] = mode_of(ctx, i);
    }
    return TRIBO_OK;
}

static size_t count_stuck(const tribo_context *ctx)
{
    size_t stuck = 0;
    for (size_t i = 0; ctx->balanced && i < ctx->n; i++) {
        stuck += mode_of(ctx, i) == 0;
    }
    return stuck;
}

int tribo_get_count(const tribo_context *ctx, int which, size_t *value)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!value) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "value is NULL");
    }
    const size_t counts[] = {
        [TRIBO_COUNT_STUCK] = which == TRIBO_COUNT_STUCK ? count_stuck(ctx) : 0,
        [TRIBO_COUNT_RANK] = ctx->rank,
        [TRIBO_COUNT_ISLANDS] = ctx->op.islands,
        [TRIBO_COUNT_SOLVES] = ctx->solves,
        [TRIBO_COUNT_SKIPPED] = ctx->skipped,
        [TRIBO_COUNT_FACTORIZATIONS] = ctx->op.problem.work.factorizations,
        [TRIBO_COUNT_UPDATES] = ctx->op.problem.work.updates,
        [TRIBO_COUNT_MEMORY] = ctx->marks,
        [TRIBO_COUNT_REUSED] = ctx->reused,
    };
    if (which < 0 || which >= (int)(sizeof counts / sizeof *counts)) {
        return tribo_fail(ctx, TRIBO_ERR_RANGE, "which = %d is no count", which);
    }
    *value = counts[which];
    return TRIBO_OK;
}

/* In the consistent coupling a stuck contact relaxes at its own 2 N R_ii/epsilon; otherwise v' = -R diag(s) v with s =
 * 2N/epsilon, or half of it for the laws that are dampers near v = 0. The eigenvalues of that are at most the largest s_i R_ii
 * times the largest eigenvalue of D^-1 R, for any set of contacts near stick. */
static double max_rate(const tribo_context *ctx)
{
    double rate = 0.0;
    for (size_t i = 0; i < ctx->n; i++) {
        if (ctx->limit[i] > 0.0) {
            rate = greater(rate, product(ctx->slope[i], ctx->op.diagonal[i]));
        }
    }
    if (!ctx->law->uses_feq) {
        return product(0.5 * rate, ctx->op.growth);
    }
    if (!ctx->law->relaxes) {
        return 0.0;
    }
    return ctx->coupling == TRIBO_PARTITION ? product(rate, ctx->op.growth) : rate;
}

int tribo_get_real(const tribo_context *ctx, int which, double *value)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!value) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "value is NULL");
    }
    if (which == TRIBO_REAL_RESIDUAL) {
        *value = ctx->residual;
        return TRIBO_OK;
    }
    if (which != TRIBO_REAL_MAX_RATE && which != TRIBO_REAL_MAX_STEP) {
        return tribo_fail(ctx, TRIBO_ERR_RANGE, "which = %d is no real quantity", which);
    }
    const int status = tribo_need_operator(ctx);
    if (!status) {
        const double rate = max_rate(ctx);
        *value = which == TRIBO_REAL_MAX_RATE ? rate : rate > 0.0 ? quotient(2.785, rate) : HUGE_VAL;
    }
    return status;
}
