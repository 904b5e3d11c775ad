/* Life of a context, and its settings. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "context.h"

#define DEFAULT_EPSILON 1e-6

/* The bounds of the solver, which are the limits unless one of them is beyond what can be told apart. */
static void find_bounds(tribo_context *ctx)
{
    ctx->largest = 0.0;
    for (size_t k = 0; k < tribo_chunks(ctx->n); k++) {
        ctx->largest = greater(ctx->largest, ctx->chunk[k].largest);
    }
    if (ctx->largest <= ctx->op.most) {
        ctx->bound = ctx->limit;
        return;
    }
    ctx->bound = ctx->bounds;
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->bound[i] = lesser(ctx->limit[i], TRIBO_FAR);
    }
    for (size_t g = 0; g < ctx->op.groups; g++) {
        const struct box_qp *p = tribo_operator_problem(&ctx->op, g);
        for (size_t k = 0; k < p->group->size; k++) {
            ctx->bound[p->member[k]] = lesser(ctx->limit[p->member[k]], tribo_most(p, k));
        }
    }
}

static void take_given(tribo_context *ctx)
{
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->epsilon[i] = ctx->given[i];
        ctx->slope[i] = tribo_slope(ctx->bound[i], ctx->given[i]);
    }
}

/* epsilon = 2 limit R_ii time, with a slope that knows nothing of the limit. What friction cannot move does not relax. */
static void follow_step(tribo_context *ctx)
{
    const double time = quotient(ctx->step, ctx->lambda_dt);
    for (size_t i = 0; i < ctx->n; i++) {
        const double width = greater(product(ctx->op.diagonal[i], time), DBL_MIN), slope = 1.0 / width;
        const double limit = lesser(ctx->bound[i], 0.5 * TRIBO_FAR * lesser(slope, 1.0));
        ctx->epsilon[i] = greater(2.0 * width * limit, DBL_MIN);
        ctx->slope[i] = limit > 0.0 && ctx->op.diagonal[i] > TRIBO_IMMOVABLE ? slope : 0.0;
    }
}

void tribo_refresh(tribo_context *ctx)
{
    ctx->op.reaches = 0;
    ctx->linearized = 0;
    ctx->revision++;
    tribo_refresh_limits(ctx);
    find_bounds(ctx);
    if (ctx->step > 0.0 && ctx->op.diagonal) {
        follow_step(ctx);
    } else {
        take_given(ctx);
    }
    tribo_refresh_widths(ctx);
}

/* Everything but the operator. One contact more than asked for, so that no array is empty. */
static int allocate(tribo_context *ctx, size_t n)
{
    const size_t m = n + 1;
    ctx->n = n;
    ctx->message = tribo_message_create();
    ctx->given = malloc(m * sizeof *ctx->given);
    ctx->limit = ctx->limit_then = ctx->limits = calloc(2 * m, sizeof *ctx->limits);
    ctx->bounds = malloc(m * sizeof *ctx->bounds);
    ctx->epsilon = malloc(m * sizeof *ctx->epsilon);
    ctx->slope = malloc(m * sizeof *ctx->slope);
    ctx->moving = calloc(m, sizeof *ctx->moving);
    ctx->feq = calloc(m, sizeof *ctx->feq);
    ctx->f = calloc(m, sizeof *ctx->f);
    ctx->v = malloc(m * sizeof *ctx->v);
    ctx->chunk = malloc(tribo_chunks(m) * sizeof *ctx->chunk);
    ctx->last.state = calloc(m + tribo_chunks(m), 1);
    ctx->spare.state = calloc(m + tribo_chunks(m), 1);
    ctx->tangent = malloc(m * sizeof *ctx->tangent);
    if (ctx->last.state && ctx->spare.state) {
        ctx->last.kind = ctx->last.state + m;
        ctx->spare.kind = ctx->spare.state + m;
    }
    return ctx->message && ctx->chunk && ctx->last.state && ctx->spare.state && ctx->given && ctx->limits && ctx->bounds &&
           ctx->epsilon && ctx->slope && ctx->moving && ctx->feq && ctx->f && ctx->v && ctx->tangent;
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
    if (!c || !allocate(c, ncontact)) {
        tribo_destroy(c);
        return TRIBO_ERR_MEMORY;
    }
    c->op.most = TRIBO_FAR;
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
    c->owner = NULL;
    memset(&c->op, 0, sizeof c->op);
    if (!allocate(c, n) || !tribo_operator_copy(&c->op, &ctx->op, n)) {
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
    c->bound = ctx->bound == ctx->limit ? c->limit : c->bounds;
    tribo_copy(c->bound, ctx->bound, n);
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
    tribo_operator_free(&ctx->op);
    free(ctx->message);
    free(ctx->given);
    free(ctx->limits);
    free(ctx->bounds);
    free(ctx->epsilon);
    free(ctx->slope);
    free(ctx->moving);
    free(ctx->feq);
    free(ctx->f);
    free(ctx->v);
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

int tribo_set_owner(tribo_context *ctx, const char *owner)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    ctx->owner = owner;
    return TRIBO_OK;
}

int tribo_fail_without_operator(const tribo_context *ctx)
{
    return tribo_fail(ctx, TRIBO_ERR_STATE,
                      "no operator: call tribo_set_operator_diagonal or another tribo_set_operator_... first");
}
