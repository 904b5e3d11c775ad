/* SPDX-License-Identifier: BSD-3-Clause */
/* Life of a context. */
#include <stdlib.h>

#include "common/layout.h"
#include "calls.h"

#define DEFAULT_EPSILON 1e-6

/* Returns a context of n contacts with the members of like, and copies of its arrays, or zeros if like has none. Each array has
 * room for n + 1 contacts, so that no array is empty. Returns NULL if out of memory. */
static tribo_context *context_allocate(size_t n, const tribo_context *like)
{
    const size_t m = n + 1, chunks = tribo_chunks(m);
    tribo_context *ctx, at = *like;
    double *numbers;
    double **const array[] = {
        &at.set.limit, &at.set.width,        &at.set.rate,          &at.set.ratio,          &at.set.stribeck,      &at.last.f,
        &at.last.feq,  &at.follow.cut_limit, &at.follow.cut_factor, &at.follow.hold,        &at.follow.hold_width, &at.follow.now,
        &at.last.v,    &at.last.tangent.dv,  &at.last.tangent.dfeq, &at.last.tangent.dlimit};
    enum { ARRAYS = sizeof array / sizeof *array };
    /* Each array of n doubles begins a line of cache, an odd number of lines behind the one before: of arrays at distances of a
     * power of two few would stay in cache. */
    const size_t room = TRIBO_LINE * ((n / TRIBO_LINE + 1) | 1);
    if (!ALLOCATE(ARRAY(ctx, 1), ARRAY(numbers, ARRAYS * room + TRIBO_LINE), ARRAY(at.follow.chunk, chunks), ARRAY(at.moving, m),
                  ARRAY(at.last.slip, m), ARRAY(at.last.near, m), ARRAY(at.spare, m))) {
        return NULL;
    }
    for (size_t k = 0; k < ARRAYS; k++) {
        *array[k] = tribo_aligned(numbers) + k * room;
    }
    if (like->set.limit) {
        memcpy(at.set.limit, like->set.limit, ARRAYS * room * sizeof *at.set.limit);
        memcpy(at.follow.chunk, like->follow.chunk, (size_t)((char *)(at.spare + m) - (char *)at.follow.chunk));
    }
    at.n = n;
    at.message[0] = 0;
    return memcpy(ctx, &at, sizeof at);
}

int tribo_create(tribo_context **ctx, size_t ncontact)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (ncontact >= SIZE_MAX / 64) {
        return TRIBO_ERR_SIZE;
    }
    static const tribo_context blank;
    tribo_context *c = context_allocate(ncontact, &blank);
    if (c) {
        c->op = tribo_operator_diagonal(NULL, ncontact, NULL);
    }
    if (!c || !c->op) {
        tribo_destroy(c);
        return TRIBO_ERR_MEMORY;
    }
    c->set.law = tribo_law(TRIBO_QUINN);
    c->set.coupling = TRIBO_CONSISTENT;
    c->set.sharing = TRIBO_SHARE_LEAST_NORM;
    for (size_t i = 0; i < ncontact; i++) {
        c->set.width[i] = DEFAULT_EPSILON;
        c->set.rate[i] = tribo_rate(DEFAULT_EPSILON);
        c->set.ratio[i] = 1.0;
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
    tribo_context *c = context_allocate(ctx->n, ctx);
    if (!c) {
        return TRIBO_ERR_MEMORY;
    }
    c->fixed = 0;
    TRIBO_SHARED_ADD(c->op->references, (size_t)1);
    if (c->pattern) {
        TRIBO_SHARED_ADD(c->pattern->references, (size_t)1);
    }
    c->memory = (struct memory){0};
    c->plane = (struct clusters){0};
    c->renewal = NULL;
    if (!tribo_memory_copy(&c->memory, &ctx->memory, ctx->op) || tribo_clusters_clone(c, ctx)) {
        tribo_destroy(c);
        return TRIBO_ERR_MEMORY;
    }
    tribo_refresh_limits(c);
    tribo_copy(c->follow.now, ctx->follow.now, ctx->n);
    c->revision = ctx->revision;
    *copy = c;
    return TRIBO_OK;
}

void tribo_destroy(tribo_context *ctx)
{
    if (ctx) {
        tribo_operator_release(ctx->op);
        tribo_memory_free(&ctx->memory);
        tribo_clusters_free(&ctx->plane);
        tribo_pattern_release(ctx->pattern);
        tribo_renewal_free(ctx->renewal);
        free(ctx->renewal);
        free(ctx);
    }
}
