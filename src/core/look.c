/* What a call learns of all contacts before it solves for any. In a large scene most slide, of which the direction is all that
 * there is to know, and reading and writing memory is all that they cost: so every array is passed over as seldom as can be, in
 * chunks that stay in the first-level cache. What a call learns takes the last call's place once v and a are found good. */
#include <float.h>

#include "internal.h"
#include "../real.h"

/* Whether all of v and a is finite: x - x is zero then, and NaN otherwise. Sums side by side, since one would have to be added up
 * in order. And whether any contact is in the band, beyond which laws that ask for f_eq all say the same. */
TRIBO_SIMD static int scan(size_t n, const double *restrict v, const double *restrict a, double band, int *any)
{
    enum { SUMS = 4 };
    double sum[SUMS] = {0.0};
    int64_t in_band = 0; /* as wide as what is compared */
    size_t i = 0;
    for (; i + SUMS <= n; i += SUMS) {
        for (size_t k = 0; k < SUMS; k++) {
            sum[k] += (v[i + k] - v[i + k]) + (a[i + k] - a[i + k]);
        }
    }
    for (; i < n; i++) {
        sum[0] += (v[i] - v[i]) + (a[i] - a[i]);
    }
    for (i = 0; i < n; i++) {
        in_band |= fabs(v[i]) <= band;
    }
    *any = in_band != 0;
    return sum[0] + sum[1] + (sum[2] + sum[3]) == 0.0;
}

TRIBO_SIMD static void find_directions(size_t n, const double *restrict v, unsigned char *restrict state)
{
    for (size_t i = 0; i < n; i++) {
        state[i] = v[i] > 0.0 ? FORTH : BACK;
    }
}

/* The same, and the contacts near stick, |v| <= band, or v = 0 if band is NULL. */
TRIBO_SIMD static void find_near(size_t n, const double *restrict v, const double *restrict band, const double *restrict limit,
                                 unsigned char *restrict state)
{
    if (band) {
        for (size_t i = 0; i < n; i++) {
            state[i] = (fabs(v[i]) <= band[i]) & (limit[i] > 0.0) ? NEAR : v[i] > 0.0 ? FORTH : BACK;
        }
    } else {
        for (size_t i = 0; i < n; i++) {
            state[i] = (v[i] == 0.0) & (limit[i] > 0.0) ? NEAR : v[i] > 0.0 ? FORTH : BACK;
        }
    }
}

/* f_eq of contacts that share no body. */
TRIBO_SIMD static void feq_alone(size_t n, const double *restrict r, const double *restrict limit, const double *restrict a,
                                 double *restrict feq)
{
    for (size_t i = 0; i < n; i++) {
        const double x = clamp(-a[i] / r[i], -DBL_MAX, DBL_MAX);
        feq[i] = limit[i] > 0.0 ? x : 0.0;
    }
}

TRIBO_SIMD static void slide(size_t n, const unsigned char *restrict state, const double *restrict limit, double *restrict f)
{
    for (size_t i = 0; i < n; i++) {
        f[i] = state[i] == FORTH ? -limit[i] : limit[i];
    }
}

TRIBO_SIMD static void slide_alike(size_t n, const unsigned char *restrict state, double limit, double *restrict f)
{
    for (size_t i = 0; i < n; i++) {
        f[i] = state[i] == FORTH ? -limit : limit;
    }
}

TRIBO_SIMD static void mix(size_t n, const unsigned char *restrict state, const double *restrict limit,
                           const double *restrict kept, double *restrict f)
{
    for (size_t i = 0; i < n; i++) {
        f[i] = state[i] <= NEAR ? kept[i] : state[i] == FORTH ? -limit[i] : limit[i];
    }
}

static size_t chunk_size(const tribo_context *ctx, size_t i)
{
    return ctx->n - i < TRIBO_CHUNK ? ctx->n - i : TRIBO_CHUNK;
}

void tribo_refresh_chunks(tribo_context *ctx)
{
    struct chunk *c = ctx->chunk;
    for (size_t i = 0; i < ctx->n; i += TRIBO_CHUNK, c++) {
        const size_t n = chunk_size(ctx, i);
        *c = (struct chunk){.widest = -1.0, .limit = ctx->limit[i]};
        for (size_t k = i; k < i + n; k++) {
            c->widest = ctx->limit[k] > 0.0 ? greater(c->widest, ctx->epsilon[k]) : c->widest;
            c->limit = c->limit == ctx->limit[k] ? c->limit : NAN;
            c->alone |= !ctx->op.groups || ctx->op.group_of[k] == TRIBO_ALONE;
        }
    }
}

static int check(const tribo_context *ctx, const double *v, const double *a)
{
    const int status = tribo_check_finite(ctx, "v", v, ctx->n);
    return status ? status : tribo_check_finite(ctx, "a", a, ctx->n);
}

int tribo_look(tribo_context *ctx, const double *v, const double *a)
{
    const struct look look = ctx->spare;
    const struct chunk *c = ctx->chunk;
    unsigned char *kind = look.kind;
    if (!v || !a) {
        const int status = check(ctx, v, a);
        if (status) {
            return status;
        }
    }
    for (size_t i = 0; i < ctx->n; i += TRIBO_CHUNK, c++, kind++) {
        const size_t n = chunk_size(ctx, i);
        int any;
        if (!scan(n, v + i, a + i, ctx->law->sticks_in_band ? c->widest : lesser(c->widest, 0.0), &any)) {
            return check(ctx, v, a);
        }
        *kind = any || !ctx->law->uses_feq ? KEPT : SLIDES;
        if (*kind == SLIDES) {
            find_directions(n, v + i, look.state + i);
        }
    }
    ctx->spare = ctx->last;
    ctx->last = look;
    return TRIBO_OK;
}

void tribo_forces_alone(tribo_context *ctx, const double *v, const double *a, int wanted)
{
    const struct contacts all = tribo_contacts(ctx);
    const struct chunk *c = ctx->chunk;
    unsigned char *kind = ctx->last.kind, *state = ctx->last.state;
    for (size_t i = 0; i < ctx->n; i += TRIBO_CHUNK, c++, kind++) {
        const size_t n = chunk_size(ctx, i);
        const int own = *kind != SLIDES && (c->alone || !ctx->law->uses_feq);
        if (*kind != SLIDES && ctx->op.groups && ctx->law->uses_feq) {
            *kind = MIXED;
            find_near(n, v + i, ctx->law->sticks_in_band ? ctx->epsilon + i : NULL, ctx->limit + i, state + i);
        } else if (*kind != SLIDES) {
            memset(state + i, PLAIN, n);
        }
        if (wanted || own) {
            feq_alone(n, ctx->op.diagonal + i, ctx->limit + i, a + i, ctx->feq + i);
        }
        if (own) {
            const struct contacts some = tribo_contacts_from(&all, i);
            ctx->law->force(&some, n, v + i, ctx->feq + i, ctx->f + i);
        }
    }
}

void tribo_forces(const tribo_context *ctx, double *f)
{
    const struct chunk *c = ctx->chunk;
    const unsigned char *kind = ctx->last.kind, *state = ctx->last.state;
    for (size_t i = 0; i < ctx->n; i += TRIBO_CHUNK, c++, kind++) {
        const size_t n = chunk_size(ctx, i);
        if (*kind == KEPT) {
            tribo_copy(f + i, ctx->f + i, n);
        } else if (*kind == MIXED) {
            mix(n, state + i, ctx->limit + i, ctx->f + i, f + i);
        } else if (isnan(c->limit)) {
            slide(n, state + i, ctx->limit + i, f + i);
        } else {
            slide_alike(n, state + i, c->limit, f + i);
        }
    }
}
