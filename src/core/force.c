/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces, and their derivatives, of contacts whose f_eq is given; the reversal memory. */
#include <math.h>

#include "calls.h"
#include "own.h"

/* 1 if the force of contact i, at v [n], depends on f_eq: elsewhere feq need not be finite, nor set. */
static int reads_feq(const tribo_context *ctx, size_t i, const double *v)
{
    const double band = ctx->set.law->sticks_in_band ? tribo_epsilon_of(&ctx->follow.contacts, i) : 0.0;
    return tribo_is_scalar(ctx, i) ? fabs(v[i]) <= band : tribo_plane_reads_feq(ctx, i, v);
}

/* Checks v, and feq where forces depend on it; a status. *plain: laws take feq as it is. note: ctx, or NULL to keep no
 * message. */
static inline int check_force(const tribo_context *ctx, tribo_context *note, const double *v, const double *feq, int *plain)
{
    int status = ctx->set.step > 0.0 ? tribo_need_operator(ctx, note) : TRIBO_OK; /* of epsilon */
    status = status ? status : tribo_check_finite(note, "v", v, ctx->n);
    *plain = !ctx->set.law->uses_feq || tribo_is_within(feq, ctx->n, TRIBO_FAR);
    if (status || *plain) {
        return status;
    }
    if (!feq && ctx->n) {
        return tribo_fail(note, TRIBO_ERR_NULL, "feq is NULL");
    }
    for (size_t i = 0; i < ctx->n; i++) {
        if (!isfinite(feq[i]) && reads_feq(ctx, i, v)) {
            return tribo_fail(note, TRIBO_ERR_NOT_FINITE, "feq[%zu] = %g is not finite", i, feq[i]);
        }
    }
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------ forces */

/* Outputs, each of which may be NULL. */
enum { FORCES, BY_V, BY_FEQ, BY_LIMIT, OUTPUTS };

/* Sets the outputs of contacts, all as if they were scalar. Laws that do not use f_eq get velocities. */
static void find_outputs(const tribo_context *ctx, int plain, const double *v, const double *feq, double *const *out)
{
    const int derivatives = out[BY_V] || out[BY_FEQ] || out[BY_LIMIT];
    const int whole = plain && !ctx->set.breaking && !derivatives;
    const int may_slide = ctx->set.law->uses_feq && !tribo_is_own(ctx) && !derivatives;
    const double *given = ctx->set.law->uses_feq ? feq : v;
    for (size_t i = 0, n; i < ctx->n; i += n) {
        double room[TRIBO_CHUNK], limit[TRIBO_CHUNK], unwanted[OUTPUTS][TRIBO_CHUNK], *to[OUTPUTS];
        const struct chunk *chunk = &ctx->follow.chunk[i / TRIBO_CHUNK];
        n = tribo_chunk_size(ctx, i);
        /* Forces of chunks that are alike are one loop: the first memory of a loop takes long to arrive. */
        while (whole && i + n < ctx->n && chunk->alike && chunk[1].alike && chunk[1].model == chunk->model) {
            n += tribo_chunk_size(ctx, i + n);
            chunk++;
        }
        for (size_t k = 0; !plain && k < n; k++) {
            room[k] = reads_feq(ctx, i + k, v) ? cut(feq[i + k]) : 0.0;
        }
        const double *used = plain ? given + i : room;
        struct contacts c = tribo_chunk_contacts(ctx, i);
        if (ctx->set.breaking) {
            tribo_find_limits(ctx, i, n, v + i, used, limit);
            c.limit = c.bound = limit;
        }
        for (int k = 0; k < OUTPUTS; k++) {
            to[k] = out[k] ? out[k] + i : unwanted[k];
        }
        if (derivatives) {
            tribo_law_tangents(ctx, &c, i, n, v + i, used, &(struct tangents){to[FORCES], to[BY_V], to[BY_FEQ], to[BY_LIMIT]});
        } else if (may_slide && !chunk->alike && chunk->band >= 0.0 && !tribo_any_near(ctx, i / TRIBO_CHUNK, v + i)) {
            tribo_slide(n, v + i, c.limit, to[FORCES]); /* reads neither f_eq nor widths */
        } else if (out[FORCES]) {
            ctx->set.law->force(&c, n, v + i, used, to[FORCES]);
        }
    }
}

/* 1 if the law of the caller failed, or gave no number for one of the outputs. */
static int own_failed(const tribo_context *ctx, double *const *out)
{
    int failed = out[BY_LIMIT] && !tribo_all_within(out[BY_LIMIT], ctx->n, DBL_MAX);
    for (int k = FORCES; k < BY_LIMIT; k++) {
        failed |= out[k] && tribo_own_failed(ctx, out[k]);
    }
    return failed;
}

int tribo_force(const tribo_context *ctx, const double *v, const double *feq, double *f)
{
    int plain;
    const int status = ctx ? check_force(ctx, NULL, v, feq, &plain) : TRIBO_ERR_NULL;
    if (status || (!f && ctx->n)) {
        return status ? status : TRIBO_ERR_NULL;
    }
    if (ctx->n == 1 && plain && !ctx->set.breaking) {
        ctx->set.law->force(&ctx->follow.contacts, 1, v, ctx->set.law->uses_feq ? feq : v, f);
        return tribo_is_own(ctx) && !isfinite(*f) ? TRIBO_ERR_CALLBACK : TRIBO_OK;
    }
    double *const out[OUTPUTS] = {f, NULL, NULL, NULL};
    find_outputs(ctx, plain, v, feq, out);
    return tribo_is_own(ctx) && own_failed(ctx, out) ? TRIBO_ERR_CALLBACK : tribo_plane_force(ctx, v, feq, out);
}

int tribo_find_tangents(const tribo_context *ctx, int pairs, const double *v, const double *feq, double *const *out)
{
    int plain;
    const int status = ctx ? check_force(ctx, NULL, v, feq, &plain) : TRIBO_ERR_NULL;
    if (status) {
        return status;
    }
    if (!pairs && ctx->plane.count && (out[BY_V] || out[BY_FEQ] || out[BY_LIMIT])) {
        return TRIBO_ERR_UNSUPPORTED;
    }
    find_outputs(ctx, plain, v, feq, out);
    if (tribo_is_own(ctx) && own_failed(ctx, out)) {
        return TRIBO_ERR_CALLBACK;
    }
    /* [n] become [n][2]: scalar contacts have nothing beside their own derivative. */
    for (int k = BY_V; pairs && k < OUTPUTS; k++) {
        for (size_t i = out[k] ? ctx->n : 0; i-- > 0;) {
            const double own = out[k][i];
            out[k][2 * i] = own;
            out[k][2 * i + 1] = 0.0;
        }
    }
    return tribo_plane_force(ctx, v, feq, out);
}

int tribo_force_tangent(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv, double *df_dfeq,
                        double *df_dlimit)
{
    return tribo_find_tangents(ctx, 0, v, feq, (double *const[OUTPUTS]){f, df_dv, df_dfeq, df_dlimit});
}

int tribo_accept(tribo_context *ctx, const double *v, const double *feq)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!ctx->set.law->remembers) {
        return tribo_check_finite(ctx, "v", v, ctx->n);
    }
    int ignored;
    const int status = check_force(ctx, ctx, v, feq, &ignored);
    if (status) {
        return status;
    }
    ctx->last.linearized = 0;
    for (size_t i = 0; i < ctx->n; i++) {
        const unsigned char before = ctx->moving[i];
        double limit = ctx->set.limit[i];
        if (!tribo_is_scalar(ctx, i)) {
            continue;
        }
        if (ctx->set.breaking) {
            tribo_find_limits(ctx, i, 1, v + i, feq + i, &limit);
        }
        if (fabs(v[i]) > tribo_epsilon_of(&ctx->follow.contacts, i)) {
            ctx->moving[i] = 1;
        } else if (fabs(feq[i]) <= limit) {
            ctx->moving[i] = 0;
        }
        ctx->count.marks += ctx->moving[i] != before;
    }
    return TRIBO_OK;
}
