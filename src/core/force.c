/* Forces of contacts whose f_eq is known. */
#include <math.h>

#include "common/stream.h"
#include "check.h"

/* f_eq as laws read it: where it does not matter it need not be finite, nor even be set. */
TRIBO_SIMD static void select_feq(size_t n, const double *restrict v, const double *restrict band, const double *restrict feq,
                                  double *restrict used)
{
    for (size_t i = 0; band && i < n; i++) {
        used[i] = fabs(v[i]) <= band[i] ? feq[i] : 0.0;
    }
    for (size_t i = 0; !band && i < n; i++) {
        used[i] = v[i] == 0.0 ? feq[i] : 0.0;
    }
}

/* The same for the n contacts from i on. */
static void used_feq(const tribo_context *ctx, size_t i, size_t n, const double *v, const double *feq, double *used)
{
    double room[TRIBO_CHUNK];
    const double *band = ctx->set.law->sticks_in_band ? tribo_epsilons(&ctx->follow.contacts, i, n, room) : NULL;
    select_feq(n, v + i, band, feq + i, used);
    if (ctx->planar) {
        /* Planar contacts have rules of their own for f_eq. */
        for (size_t k = 0; k < n; k++) {
            used[k] = ctx->planar->role[i + k] == ROLE_SCALAR ? used[k] : 0.0;
        }
    }
}

TRIBO_SIMD static void cut_all(size_t n, double *x)
{
    for (size_t i = 0; i < n; i++) {
        x[i] = cut(x[i]);
    }
}

/* The same as laws take it, [n]: what the caller has, if all of it is plain; otherwise in room. A law that uses none reads
 * velocities. */
static const double *legible_feq(const tribo_context *ctx, int plain, size_t i, size_t n, const double *v, const double *feq,
                                 double *room)
{
    if (!ctx->set.law->uses_feq) {
        return v + i;
    }
    if (plain) {
        return feq + i;
    }
    used_feq(ctx, i, n, v, feq, room);
    cut_all(n, room);
    return room;
}

static int check_used(const tribo_context *ctx, tribo_context *note, const double *v, const double *feq)
{
    for (size_t i = 0; i < ctx->n; i += TRIBO_CHUNK) {
        double used[TRIBO_CHUNK];
        const size_t n = tribo_chunk_size(ctx, i);
        used_feq(ctx, i, n, v, feq, used);
        for (size_t k = 0; !tribo_all_finite(used, n); k++) {
            if (!isfinite(used[k])) {
                return tribo_fail(note, TRIBO_ERR_NOT_FINITE, "feq[%zu] = %g is not finite", i + k, used[k]);
            }
        }
    }
    return TRIBO_OK;
}

/* plain: f_eq is such that laws take it as it is, wherever that matters or not. note: ctx, or NULL to keep no message. */
static int check_force(const tribo_context *ctx, tribo_context *note, const double *v, const double *feq, int *plain)
{
    const int reads = ctx->set.law->uses_feq, within = v && feq && reads ? tribo_motion_within(v, feq, TRIBO_FAR, ctx->n) : 0;
    int status = tribo_has_epsilon(ctx) ? TRIBO_OK : tribo_fail_without_operator(note);
    status = status || (within & 1) ? status : tribo_check_finite(note, "v", v, ctx->n);
    *plain = !reads || (within & 2);
    if (status || !reads) {
        return status;
    }
    if (!feq && ctx->n) {
        return tribo_fail(note, TRIBO_ERR_NULL, "feq is NULL");
    }
    status = *plain ? TRIBO_OK : check_used(ctx, note, v, feq);
    return status || !ctx->planar ? status : tribo_planar_check_feq(ctx, note, v, feq);
}

/* Forces and derivatives, each of which may be NULL. */
enum { FORCES, BY_V, BY_FEQ, BY_LIMIT, OUTPUTS };

/* What is found of the chunk that begins with i goes on its way; what is read soon is asked for in the meantime. */
static void pass_on(const tribo_context *ctx, size_t i, const double *v, const double *feq, struct stream *out)
{
    enum { AHEAD = 4 * TRIBO_CHUNK };
    for (int k = 0; k < OUTPUTS; k++) {
        tribo_stream_put(&out[k], tribo_chunk_size(ctx, i));
    }
    if (ctx->n < TRIBO_MANY || ctx->n - i < AHEAD + TRIBO_CHUNK) {
        return;
    }
    const struct chunk *chunk = &ctx->follow.chunk[(i + AHEAD) / TRIBO_CHUNK];
    const struct contacts *c = &ctx->follow.contacts;
    const double *array[] = {v, feq, chunk->alike ? NULL : c->limit, chunk->even ? NULL : c->width, chunk->even ? NULL : c->rate};
    for (size_t k = 0; k < sizeof array / sizeof *array; k++) {
        if (array[k]) {
            tribo_expect(array[k] + i + AHEAD, TRIBO_CHUNK * sizeof *v, 0);
        }
    }
}

static void evaluate_chunk(const tribo_context *ctx, const struct contacts *c, size_t i, const double *v, const double *feq,
                           struct stream *out)
{
    const size_t n = tribo_chunk_size(ctx, i);
    double *to[OUTPUTS];
    for (int k = 0; k < OUTPUTS; k++) {
        to[k] = tribo_stream_room(&out[k]);
    }
    if (out[BY_V].to || out[BY_FEQ].to || out[BY_LIMIT].to) {
        tribo_law_tangents(ctx, c, i, n, v, feq, &(struct tangents){to[FORCES], to[BY_V], to[BY_FEQ], to[BY_LIMIT]});
    } else if (out[FORCES].to) {
        ctx->set.law->force(c, n, v, feq, to[FORCES]);
    }
}

/* Whether all contacts of a chunk and of the one before are alike. */
static inline int force_goes_on(const struct chunk *chunk)
{
    return chunk->alike && chunk[-1].alike && chunk->model == chunk[-1].model;
}

static void force_evaluate(const tribo_context *ctx, int plain, const double *v, const double *feq, double *const *out)
{
    const int only_f = out[FORCES] && !out[BY_V] && !out[BY_FEQ] && !out[BY_LIMIT];
    if (only_f && plain && !ctx->set.breaking && ctx->n < TRIBO_MANY) {
        /* Forces where laws take f_eq as it is. Chunks that are alike are one loop: memory is far away where a loop begins. */
        double *f = out[FORCES];
        for (size_t i = 0, n; i < ctx->n; i += n) {
            const struct contacts c = tribo_chunk_contacts(ctx, i);
            n = tribo_chunk_size(ctx, i);
            while (i + n < ctx->n && force_goes_on(&ctx->follow.chunk[(i + n) / TRIBO_CHUNK])) {
                n += tribo_chunk_size(ctx, i + n);
            }
            ctx->set.law->force(&c, n, v + i, legible_feq(ctx, 1, i, n, v, feq, NULL), f + i);
        }
    } else {
        struct stream to[OUTPUTS];
        for (int k = 0; k < OUTPUTS; k++) {
            tribo_stream_begin(&to[k], out[k], ctx->n >= TRIBO_MANY);
        }
        for (size_t i = 0; i < ctx->n; i += TRIBO_CHUNK) {
            double room[TRIBO_CHUNK], limit[TRIBO_CHUNK];
            const size_t n = tribo_chunk_size(ctx, i);
            const double *used = legible_feq(ctx, plain, i, n, v, feq, room);
            struct contacts c = tribo_chunk_contacts(ctx, i);
            if (ctx->set.breaking) {
                tribo_find_limits(ctx, i, n, v + i, used, limit);
                c.limit = c.bound = limit;
            }
            evaluate_chunk(ctx, &c, i, v + i, used, to);
            pass_on(ctx, i, v, plain ? feq : NULL, to);
        }
        for (int k = 0; k < OUTPUTS; k++) {
            tribo_stream_end(&to[k]);
        }
    }
}

int tribo_force(const tribo_context *ctx, const double *v, const double *feq, double *f)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    int plain;
    const int status = check_force(ctx, NULL, v, feq, &plain);
    if (status) {
        return status;
    }
    if (!f && ctx->n) {
        return TRIBO_ERR_NULL;
    }
    if (ctx->n == 1 && plain && !ctx->set.breaking) {
        *f = ctx->set.law->force_of_one(&ctx->follow.contacts, *v, ctx->set.law->uses_feq ? *feq : 0.0);
        return TRIBO_OK;
    }
    force_evaluate(ctx, plain, v, feq, (double *const[OUTPUTS]){f, NULL, NULL, NULL});
    return ctx->planar ? tribo_planar_force(ctx, v, feq, f) : TRIBO_OK;
}

int tribo_force_tangent(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv, double *df_dfeq,
                        double *df_dlimit)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    int plain;
    const int status = check_force(ctx, NULL, v, feq, &plain);
    if (status) {
        return status;
    }
    if (ctx->planar && (df_dv || df_dfeq || df_dlimit)) {
        return TRIBO_ERR_UNSUPPORTED;
    }
    force_evaluate(ctx, plain, v, feq, (double *const[OUTPUTS]){f, df_dv, df_dfeq, df_dlimit});
    return ctx->planar && f ? tribo_planar_force(ctx, v, feq, f) : TRIBO_OK;
}

/* block [n][2] of n numbers that begin it: a scalar contact has nothing beside its own derivative. */
static void force_spread(size_t n, double *block)
{
    for (size_t i = n; block && i-- > 0;) {
        const double own = block[i];
        block[2 * i] = own;
        block[2 * i + 1] = 0.0;
    }
}

int tribo_force_tangent_planar(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv,
                               double *df_dfeq, double *df_dlimit)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    int plain;
    int status = check_force(ctx, NULL, v, feq, &plain);
    if (status) {
        return status;
    }
    force_evaluate(ctx, plain, v, feq, (double *const[OUTPUTS]){f, df_dv, df_dfeq, df_dlimit});
    force_spread(ctx->n, df_dv);
    force_spread(ctx->n, df_dfeq);
    force_spread(ctx->n, df_dlimit);
    status = ctx->planar && f ? tribo_planar_force(ctx, v, feq, f) : TRIBO_OK;
    return status || !ctx->planar ? status : tribo_planar_blocks(ctx, v, feq, df_dv, df_dfeq, df_dlimit);
}

static double limit_near(const tribo_context *ctx, size_t i, double v, double feq)
{
    double limit = ctx->set.limit[i];
    if (ctx->set.breaking) {
        tribo_find_limits(ctx, i, 1, &v, &feq, &limit);
    }
    return limit;
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
        if (ctx->planar && ctx->planar->role[i] != ROLE_SCALAR) {
            continue;
        }
        if (fabs(v[i]) > tribo_epsilon_of(&ctx->follow.contacts, i)) {
            ctx->moving[i] = 1;
        } else if (fabs(feq[i]) <= limit_near(ctx, i, v[i], feq[i])) {
            ctx->moving[i] = 0;
        }
        ctx->count.marks += ctx->moving[i] != before;
    }
    return TRIBO_OK;
}
