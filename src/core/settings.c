/* What a caller sets: law, limits, epsilon, coupling, sharing. */
#include <math.h>
#include <string.h>

#include "context.h"

int tribo_set_law(tribo_context *ctx, int law)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const struct law *l = tribo_law(law);
    if (!l) {
        return tribo_fail(ctx, TRIBO_ERR_RANGE, "law = %d is none of the %d laws", law, tribo_law_count());
    }
    ctx->law = l;
    ctx->linearized = 0;
    ctx->revision++;
    memset(ctx->moving, 0, ctx->n);
    return TRIBO_OK;
}

int tribo_get_law(const tribo_context *ctx, int *law)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!law) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "law is NULL");
    }
    *law = ctx->law->id;
    return TRIBO_OK;
}

/* Where limits are set: those of the last balance stay, for its modes. */
static double *new_limits(tribo_context *ctx)
{
    if (ctx->limit_then == ctx->limit) {
        ctx->limit = ctx->limits + (ctx->limit == ctx->limits ? ctx->n + 1 : 0);
    }
    return ctx->limit;
}

int tribo_set_limit(tribo_context *ctx, const double *limit)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const int status = tribo_check_nonnegative(ctx, "limit", limit, ctx->n);
    if (status) {
        return status;
    }
    tribo_copy(new_limits(ctx), limit, ctx->n);
    tribo_refresh(ctx);
    return TRIBO_OK;
}

int tribo_set_limit_all(tribo_context *ctx, double limit)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!isfinite(limit)) {
        return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "limit = %g is not finite", limit);
    }
    if (limit < 0.0) {
        return tribo_fail(ctx, TRIBO_ERR_NEGATIVE, "limit = %g is negative", limit);
    }
    double *each = new_limits(ctx);
    for (size_t i = 0; i < ctx->n; i++) {
        each[i] = limit;
    }
    tribo_refresh(ctx);
    return TRIBO_OK;
}

static int copy_out(const tribo_context *ctx, const char *name, const double *from, double *to)
{
    if (!to && ctx->n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "%s is NULL", name);
    }
    tribo_copy(to, from, ctx->n);
    return TRIBO_OK;
}

int tribo_get_limit(const tribo_context *ctx, double *limit)
{
    return ctx ? copy_out(ctx, "limit", ctx->limit, limit) : TRIBO_ERR_NULL;
}

int tribo_get_epsilon(const tribo_context *ctx, double *epsilon)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const int status = tribo_need_epsilon(ctx);
    return status ? status : copy_out(ctx, "epsilon", ctx->epsilon, epsilon);
}

int tribo_set_epsilon(tribo_context *ctx, const double *epsilon)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const int status = tribo_check_positive(ctx, "epsilon", epsilon, ctx->n);
    if (status) {
        return status;
    }
    tribo_copy(ctx->given, epsilon, ctx->n);
    ctx->step = 0.0;
    tribo_refresh(ctx);
    return TRIBO_OK;
}

static int check_scalar(const tribo_context *ctx, const char *name, double x)
{
    if (!isfinite(x)) {
        return tribo_fail(ctx, TRIBO_ERR_NOT_FINITE, "%s = %g is not finite", name, x);
    }
    if (x <= 0.0) {
        return tribo_fail(ctx, TRIBO_ERR_NOT_POSITIVE, "%s = %g is not positive", name, x);
    }
    return TRIBO_OK;
}

int tribo_set_epsilon_all(tribo_context *ctx, double epsilon)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const int status = check_scalar(ctx, "epsilon", epsilon);
    if (status) {
        return status;
    }
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->given[i] = epsilon;
    }
    ctx->step = 0.0;
    tribo_refresh(ctx);
    return TRIBO_OK;
}

int tribo_set_epsilon_step(tribo_context *ctx, double dt, double lambda_dt)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    int status = check_scalar(ctx, "dt", dt);
    if (!status) {
        status = check_scalar(ctx, "lambda_dt", lambda_dt);
    }
    if (status) {
        return status;
    }
    ctx->step = dt;
    ctx->lambda_dt = lambda_dt;
    tribo_refresh(ctx);
    return TRIBO_OK;
}

int tribo_set_coupling(tribo_context *ctx, int coupling)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (coupling != TRIBO_CONSISTENT && coupling != TRIBO_PARTITION) {
        return tribo_fail(ctx, TRIBO_ERR_RANGE, "coupling = %d is neither TRIBO_CONSISTENT nor TRIBO_PARTITION", coupling);
    }
    ctx->coupling = coupling;
    ctx->linearized = 0;
    ctx->revision++;
    return TRIBO_OK;
}

int tribo_get_coupling(const tribo_context *ctx, int *coupling)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!coupling) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "coupling is NULL");
    }
    *coupling = ctx->coupling;
    return TRIBO_OK;
}

int tribo_set_sharing(tribo_context *ctx, int sharing)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (sharing != TRIBO_SHARE_LEAST && sharing != TRIBO_SHARE_LAST) {
        return tribo_fail(ctx, TRIBO_ERR_RANGE, "sharing = %d is neither TRIBO_SHARE_LEAST nor TRIBO_SHARE_LAST", sharing);
    }
    ctx->sharing = sharing;
    ctx->linearized = 0;
    ctx->revision++;
    return TRIBO_OK;
}

int tribo_get_sharing(const tribo_context *ctx, int *sharing)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!sharing) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "sharing is NULL");
    }
    *sharing = ctx->sharing;
    return TRIBO_OK;
}
