/* Life of a context, and its settings. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "internal.h"
#include "../real.h"

#define DEFAULT_EPSILON 1e-6

double tribo_slope(double limit, double epsilon)
{
    return lesser(2.0 * limit / epsilon, DBL_MAX);
}

void tribo_refresh(tribo_context *ctx)
{
    ctx->op.reaches = 0;
    ctx->linearized = 0;
    ctx->revision++;
    for (size_t i = 0; i < ctx->n; i++) {
        const double r = ctx->op.diagonal[i];
        if (ctx->step > 0.0) {
            const double time = ctx->step / ctx->lambda_dt;
            ctx->epsilon[i] = clamp(2.0 * ctx->limit[i] * (r * time), DBL_MIN, DBL_MAX);
            ctx->slope[i] = ctx->limit[i] > 0.0 ? lesser(1.0 / (r * time), DBL_MAX) : 0.0;
        } else {
            ctx->epsilon[i] = ctx->given[i];
            ctx->slope[i] = tribo_slope(ctx->limit[i], ctx->given[i]);
        }
    }
    tribo_refresh_chunks(ctx);
}

/* Everything but the operator. One contact more than asked for, so that no array is empty. */
static int allocate(tribo_context *ctx, size_t n)
{
    const size_t m = n + 1;
    ctx->n = n;
    ctx->message = tribo_message_create();
    ctx->given = malloc(m * sizeof *ctx->given);
    ctx->limit = ctx->limit_then = ctx->limits = calloc(2 * m, sizeof *ctx->limits);
    ctx->epsilon = malloc(m * sizeof *ctx->epsilon);
    ctx->slope = malloc(m * sizeof *ctx->slope);
    ctx->moving = calloc(m, sizeof *ctx->moving);
    ctx->feq = calloc(m, sizeof *ctx->feq);
    ctx->f = calloc(m, sizeof *ctx->f);
    ctx->v = malloc(m * sizeof *ctx->v);
    ctx->lower = malloc(m * sizeof *ctx->lower);
    ctx->chunk = malloc(tribo_chunks(m) * sizeof *ctx->chunk);
    ctx->last.state = calloc(m + tribo_chunks(m), 1);
    ctx->spare.state = calloc(m + tribo_chunks(m), 1);
    ctx->tangent = malloc(m * sizeof *ctx->tangent);
    if (ctx->last.state && ctx->spare.state) {
        ctx->last.kind = ctx->last.state + m;
        ctx->spare.kind = ctx->spare.state + m;
    }
    return ctx->message && ctx->chunk && ctx->last.state && ctx->spare.state && ctx->given && ctx->limits && ctx->epsilon &&
           ctx->slope && ctx->moving && ctx->feq && ctx->f && ctx->v && ctx->lower && ctx->tangent;
}

int tribo_create(tribo_context **ctx, size_t ncontact)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (ncontact >= SIZE_MAX / 64) {
        return TRIBO_ERR_SIZE;
    }
    tribo_context *c = calloc(1, sizeof *c);
    if (!c || !allocate(c, ncontact) || !tribo_op_diagonal(&c->op, ncontact, NULL)) {
        tribo_destroy(c);
        return TRIBO_ERR_MEMORY;
    }
    c->law = tribo_law(TRIBO_QUINN);
    c->kept = 1;
    c->coupling = TRIBO_CONSISTENT;
    c->sharing = TRIBO_SHARE_LEAST;
    for (size_t i = 0; i < ncontact; i++) {
        c->given[i] = DEFAULT_EPSILON;
    }
    tribo_refresh(c);
    *ctx = c;
    return TRIBO_OK;
}

int tribo_clone(const tribo_context *ctx, tribo_context **copy)
{
    if (!ctx || !copy) {
        return TRIBO_ERR_NULL;
    }
    const size_t n = ctx->n;
    tribo_context *c = malloc(sizeof *c);
    if (!c) {
        return tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for a copy of %zu contacts", n);
    }
    *c = *ctx;
    memset(&c->op, 0, sizeof c->op);
    if (!allocate(c, n) || !tribo_op_copy(&c->op, &ctx->op, n)) {
        tribo_destroy(c);
        return tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for a copy of %zu contacts", n);
    }
    c->linearized = 0;
    tribo_copy(c->given, ctx->given, n);
    tribo_copy(c->limit, ctx->limit, n);
    if (ctx->limit_then != ctx->limit) {
        c->limit_then = c->limits + n + 1;
        tribo_copy(c->limit_then, ctx->limit_then, n);
    }
    tribo_copy(c->epsilon, ctx->epsilon, n);
    tribo_copy(c->slope, ctx->slope, n);
    tribo_copy(c->feq, ctx->feq, n);
    tribo_copy(c->f, ctx->f, n);
    memcpy(c->moving, ctx->moving, n);
    memcpy(c->chunk, ctx->chunk, tribo_chunks(n) * sizeof *c->chunk);
    memcpy(c->last.state, ctx->last.state, n);
    memcpy(c->last.kind, ctx->last.kind, tribo_chunks(n));
    *copy = c;
    return TRIBO_OK;
}

void tribo_destroy(tribo_context *ctx)
{
    if (!ctx) {
        return;
    }
    tribo_op_free(&ctx->op);
    free(ctx->message);
    free(ctx->given);
    free(ctx->limits);
    free(ctx->epsilon);
    free(ctx->slope);
    free(ctx->moving);
    free(ctx->feq);
    free(ctx->f);
    free(ctx->v);
    free(ctx->lower);
    free(ctx->chunk);
    free(ctx->last.state);
    free(ctx->spare.state);
    free(ctx->tangent);
    free(ctx);
}

size_t tribo_revision(const tribo_context *ctx)
{
    return ctx ? ctx->revision : 0;
}

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
    return ctx ? copy_out(ctx, "epsilon", ctx->epsilon, epsilon) : TRIBO_ERR_NULL;
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

int tribo_get_count(const tribo_context *ctx, int which, size_t *value)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!value) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "value is NULL");
    }
    size_t stuck = 0;
    for (size_t i = 0; ctx->balanced && i < ctx->n; i++) {
        stuck += mode_of(ctx, i) == 0;
    }
    const size_t counts[] = {
        [TRIBO_COUNT_STUCK] = stuck,
        [TRIBO_COUNT_RANK] = ctx->rank,
        [TRIBO_COUNT_ISLANDS] = ctx->op.islands,
        [TRIBO_COUNT_SOLVES] = ctx->solves,
        [TRIBO_COUNT_SKIPPED] = ctx->skipped,
        [TRIBO_COUNT_FACTORIZATIONS] = ctx->op.program.work.factorizations,
        [TRIBO_COUNT_UPDATES] = ctx->op.program.work.updates,
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
 * 2N/epsilon, or half of it for the laws that are dampers near v = 0, and a row sum bounds the eigenvalues. */
static double max_rate(const tribo_context *ctx)
{
    double rate = 0.0;
    for (size_t i = 0; i < ctx->n; i++) {
        if (ctx->limit[i] > 0.0) {
            rate = greater(rate, ctx->slope[i] * ctx->op.diagonal[i]);
        }
    }
    if (!ctx->law->uses_feq) {
        return 0.5 * rate * ctx->op.row_sum;
    }
    if (!ctx->law->relaxes) {
        return 0.0;
    }
    return ctx->coupling == TRIBO_PARTITION ? rate * ctx->op.row_sum : rate;
}

int tribo_get_real(const tribo_context *ctx, int which, double *value)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!value) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "value is NULL");
    }
    switch (which) {
    case TRIBO_REAL_RESIDUAL:
        *value = ctx->residual;
        return TRIBO_OK;
    case TRIBO_REAL_MAX_RATE:
        *value = max_rate(ctx);
        return TRIBO_OK;
    case TRIBO_REAL_MAX_STEP: {
        const double rate = max_rate(ctx);
        *value = rate > 0.0 ? 2.785 / rate : HUGE_VAL;
        return TRIBO_OK;
    }
    default:
        return tribo_fail(ctx, TRIBO_ERR_RANGE, "which = %d is no real quantity", which);
    }
}
