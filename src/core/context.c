/* Life of a context, and its settings. */
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "context.h"

#define DEFAULT_EPSILON 1e-6

/* Everything but the operator. One contact more than asked for, so that no array is empty. */
static int allocate(tribo_context *ctx, size_t n)
{
    const size_t m = n + 1;
    ctx->n = n;
    ctx->message = tribo_message_create();
    ctx->limit = calloc(m, sizeof *ctx->limit);
    ctx->width = malloc(m * sizeof *ctx->width);
    ctx->rate = malloc(m * sizeof *ctx->rate);
    ctx->cut_limit = malloc(m * sizeof *ctx->cut_limit);
    ctx->cut_factor = malloc(m * sizeof *ctx->cut_factor);
    ctx->moving = calloc(m, sizeof *ctx->moving);
    ctx->feq = calloc(m, sizeof *ctx->feq);
    ctx->f = calloc(m, sizeof *ctx->f);
    ctx->v = malloc(m * sizeof *ctx->v);
    ctx->chunk = malloc(tribo_chunks(m) * sizeof *ctx->chunk);
    ctx->last.of = calloc(m + tribo_chunks(m), 1);
    ctx->spare.of = calloc(m + tribo_chunks(m), 1);
    ctx->tangent = malloc(m * sizeof *ctx->tangent);
    if (ctx->last.of && ctx->spare.of) {
        ctx->last.stored = (unsigned char *)(ctx->last.of + m);
        ctx->spare.stored = (unsigned char *)(ctx->spare.of + m);
    }
    return ctx->message && ctx->chunk && ctx->last.of && ctx->spare.of && ctx->limit && ctx->width && ctx->rate &&
           ctx->cut_limit && ctx->cut_factor && ctx->moving && ctx->feq && ctx->f && ctx->v && ctx->tangent;
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
    if (!c || !allocate(c, ncontact) || !tribo_operator_diagonal(&c->op, ncontact, NULL)) {
        tribo_destroy(c);
        return TRIBO_ERR_MEMORY;
    }
    c->law = tribo_law(TRIBO_QUINN);
    c->coupling = TRIBO_CONSISTENT;
    c->sharing = TRIBO_SHARE_LEAST;
    for (size_t i = 0; i < ncontact; i++) {
        c->width[i] = DEFAULT_EPSILON;
        c->rate[i] = tribo_rate(DEFAULT_EPSILON);
    }
    for (size_t k = 0; k < tribo_chunks(ncontact); k++) {
        c->chunk[k].least = c->chunk[k].largest = 0.0;
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
    c->op = tribo_operator_share(ctx->op);
    c->memory = (struct memory){0};
    if (!allocate(c, n) || !tribo_memory_copy(&c->memory, &ctx->memory, ctx->op)) {
        tribo_destroy(c);
        return tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for a copy of %zu contacts", n);
    }
    c->linearized = 0;
    tribo_copy(c->limit, ctx->limit, n);
    tribo_copy(c->width, ctx->width, n);
    tribo_copy(c->rate, ctx->rate, n);
    tribo_copy(c->feq, ctx->feq, n);
    tribo_copy(c->f, ctx->f, n);
    memcpy(c->moving, ctx->moving, n);
    memcpy(c->chunk, ctx->chunk, tribo_chunks(n) * sizeof *c->chunk);
    memcpy(c->last.of, ctx->last.of, n);
    memcpy(c->last.stored, ctx->last.stored, tribo_chunks(n));
    tribo_refresh_limits(c);
    c->revision = ctx->revision;
    *copy = c;
    return TRIBO_OK;
}

void tribo_destroy(tribo_context *ctx)
{
    if (!ctx) {
        return;
    }
    tribo_operator_release(ctx->op);
    tribo_memory_free(&ctx->memory);
    free(ctx->message);
    free(ctx->limit);
    free(ctx->width);
    free(ctx->rate);
    free(ctx->cut_limit);
    free(ctx->cut_factor);
    free(ctx->moving);
    free(ctx->feq);
    free(ctx->f);
    free(ctx->v);
    free(ctx->chunk);
    free(ctx->last.of);
    free(ctx->spare.of);
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
