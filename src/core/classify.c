/* What a call learns of all contacts before it solves for any. In a large scene most slide, of which the direction is all that
 * there is to know, and reading and writing memory is all that they cost: so every array is passed over as seldom as can be, in
 * chunks that stay in the first-level cache. What a call learns takes the last call's place once v and a are found good. */
#include "context.h"

/* Whether any contact is in the band, beyond which laws that ask for f_eq all say the same. */
TRIBO_SIMD static int any_in_band(size_t n, const double *v, double band)
{
    int64_t any = 0; /* as wide as what is compared */
    for (size_t i = 0; i < n; i++) {
        any |= fabs(v[i]) <= band ? -1 : 0;
    }
    return any != 0;
}

TRIBO_SIMD static void find_directions(size_t n, const double *restrict v, unsigned char *restrict state)
{
    for (size_t i = 0; i < n; i++) {
        state[i] = v[i] > 0.0 ? FORTH : BACK;
    }
}

/* The same, and contacts near stick if all have one band: BACK, NEAR and FORTH count 0, 1, 2. */
TRIBO_SIMD static void find_states(size_t n, const double *restrict v, double band, unsigned char *restrict state)
{
    for (size_t i = 0; i < n; i++) {
        state[i] = (unsigned char)((v[i] > band) + (v[i] >= -band));
    }
}

/* The same with each contact's own band, or 0 if band is NULL, and open ones are not near stick. */
TRIBO_SIMD static void find_near(size_t n, const double *restrict v, const double *restrict band, const double *restrict limit,
                                 unsigned char *restrict state)
{
    for (size_t i = 0; band && i < n; i++) {
        const int near = (fabs(v[i]) <= band[i]) & (limit[i] > 0.0);
        state[i] = (unsigned char)(near | (((v[i] > 0.0) & !near) << 1));
    }
    for (size_t i = 0; !band && i < n; i++) {
        const int near = (v[i] == 0.0) & (limit[i] > 0.0);
        state[i] = (unsigned char)(near | (((v[i] > 0.0) & !near) << 1));
    }
}

/* f_eq of contacts that share no body. */
TRIBO_SIMD static void feq_alone(size_t n, const double *restrict r, const double *restrict a, double *restrict feq)
{
    for (size_t i = 0; i < n; i++) {
        feq[i] = quotient(-a[i], r[i]);
    }
}

TRIBO_SIMD static void no_feq_if_open(size_t n, const double *restrict limit, double *restrict feq)
{
    for (size_t i = 0; i < n; i++) {
        feq[i] = limit[i] > 0.0 ? feq[i] : 0.0;
    }
}

/* The same for chunk k, which begins with contact i; 0 for open ones. */
static inline void find_feq(tribo_context *ctx, size_t k, size_t i, size_t n, const double *a)
{
    feq_alone(n, ctx->op.diagonal + i, a + i, ctx->feq + i);
    if (ctx->chunk[k].least == 0.0) {
        no_feq_if_open(n, ctx->limit + i, ctx->feq + i);
    }
}

TRIBO_SIMD static void force_of_slips(size_t n, const unsigned char *restrict state, const double *restrict limit,
                                      double *restrict f)
{
    for (size_t i = 0; i < n; i++) {
        f[i] = state[i] == FORTH ? -limit[i] : limit[i];
    }
}

TRIBO_SIMD static void force_of_alike_slips(size_t n, const unsigned char *restrict state, double limit, double *restrict f)
{
    for (size_t i = 0; i < n; i++) {
        f[i] = state[i] == FORTH ? -limit : limit;
    }
}

/* The chunk after next will soon be read, or written. */
static void expect(const tribo_context *ctx, const double *x, size_t i, int written)
{
    if (ctx->n - i > 2 * TRIBO_CHUNK) {
        tribo_expect(x + i + 2 * TRIBO_CHUNK, tribo_chunk_size(ctx, i + 2 * TRIBO_CHUNK) * sizeof *x, written);
    }
}

enum { LANES = 4 }; /* side by side, since one would have to be found in order */

TRIBO_SIMD static void find_limits(size_t n, const double *limit, struct chunk *chunk)
{
    double least[LANES], largest[LANES];
    size_t i = 0;
    for (size_t k = 0; k < LANES; k++) {
        least[k] = largest[k] = limit[0];
    }
    for (; i + LANES <= n; i += LANES) {
        for (size_t k = 0; k < LANES; k++) {
            least[k] = lesser(least[k], limit[i + k]);
            largest[k] = greater(largest[k], limit[i + k]);
        }
    }
    for (; i < n; i++) {
        least[0] = lesser(least[0], limit[i]);
        largest[0] = greater(largest[0], limit[i]);
    }
    chunk->least = lesser(lesser(least[0], least[1]), lesser(least[2], least[3]));
    chunk->largest = greater(greater(largest[0], largest[1]), greater(largest[2], largest[3]));
}

TRIBO_SIMD static double widest_of(size_t n, const double *restrict limit, const double *restrict epsilon)
{
    double widest[LANES] = {-1.0, -1.0, -1.0, -1.0};
    size_t i = 0;
    for (; i + LANES <= n; i += LANES) {
        for (size_t k = 0; k < LANES; k++) {
            const double e = limit[i + k] > 0.0 ? epsilon[i + k] : -1.0;
            widest[k] = greater(widest[k], e);
        }
    }
    for (; i < n; i++) {
        widest[0] = limit[i] > 0.0 ? greater(widest[0], epsilon[i]) : widest[0];
    }
    return greater(greater(widest[0], widest[1]), greater(widest[2], widest[3]));
}

void tribo_refresh_limits(tribo_context *ctx)
{
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        find_limits(tribo_chunk_size(ctx, i), ctx->limit + i, &ctx->chunk[k]);
    }
}

void tribo_refresh_widths(tribo_context *ctx)
{
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        ctx->chunk[k].widest = widest_of(tribo_chunk_size(ctx, i), ctx->limit + i, ctx->epsilon + i);
    }
}

static int check_motion(const tribo_context *ctx, const double *v, const double *a)
{
    const int status = tribo_check_finite(ctx, "v", v, ctx->n);
    return status ? status : tribo_check_finite(ctx, "a", a, ctx->n);
}

size_t tribo_next_near(const unsigned char *state, size_t *i, size_t end)
{
    const unsigned char *found = memchr(state + *i, NEAR, end - *i);
    size_t n = 0;
    *i = found ? (size_t)(found - state) : end;
    while (*i + n < end && state[*i + n] == NEAR) {
        n++;
    }
    return n;
}

/* Of the contacts in the widest band those that are near stick. */
static void narrow(const tribo_context *ctx, const double *v, size_t i, size_t end, unsigned char *state)
{
    for (size_t n; (n = tribo_next_near(state, &i, end)) > 0; i += n) {
        find_near(n, v + i, ctx->law->sticks_in_band ? ctx->epsilon + i : NULL, ctx->limit + i, state + i);
    }
}

int tribo_classify(tribo_context *ctx, const double *v, const double *a)
{
    const struct look look = ctx->spare;
    const int few = !ctx->op.groups && ctx->n <= TRIBO_CHUNK; /* whose laws are asked sooner than what they do is found */
    if (!v || !a || few || !ctx->law->uses_feq) {
        const int status = check_motion(ctx, v, a);
        ctx->kept = status ? ctx->kept : 1;
        return status;
    }
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        const size_t n = tribo_chunk_size(ctx, i);
        const double band = ctx->law->sticks_in_band ? ctx->chunk[k].widest : lesser(ctx->chunk[k].widest, 0.0);
        expect(ctx, v, i, 0);
        expect(ctx, a, i, 0);
        if (!tribo_all_finite(v + i, n) || !tribo_all_finite(a + i, n)) {
            return check_motion(ctx, v, a);
        }
        const int any = any_in_band(n, v + i, band);
        look.kind[k] = !any ? SLIDES : ctx->op.groups ? MIXED : KEPT;
        if (look.kind[k] == KEPT) {
            memset(look.state + i, NEAR, n); /* or not: the law will tell */
        } else if (look.kind[k] == MIXED) {
            find_states(n, v + i, band, look.state + i);
            narrow(ctx, v, i, i + n, look.state);
        } else {
            find_directions(n, v + i, look.state + i);
        }
    }
    ctx->spare = ctx->last;
    ctx->last = look;
    ctx->kept = 0;
    return TRIBO_OK;
}

void tribo_forces_alone(tribo_context *ctx, const double *v, const double *a, int wanted)
{
    const struct contacts all = tribo_contacts(ctx);
    const int some = ctx->op.islands > ctx->op.groups;
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        const size_t n = tribo_chunk_size(ctx, i);
        const int asked = ctx->kept || (some && ctx->last.kind[k] != SLIDES);
        if (wanted || (asked && ctx->law->uses_feq)) {
            find_feq(ctx, k, i, n, a);
        }
        if (asked) {
            const struct contacts c = tribo_contacts_from(&all, i);
            ctx->law->force(&c, n, v + i, ctx->feq + i, ctx->f + i);
        }
    }
}

void tribo_forces(const tribo_context *ctx, double *f)
{
    if (ctx->kept) {
        tribo_copy(f, ctx->f, ctx->n);
        return;
    }
    const unsigned char *state = ctx->last.state;
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        const size_t n = tribo_chunk_size(ctx, i);
        expect(ctx, f, i, 1);
        if (ctx->last.kind[k] == KEPT) {
            tribo_copy(f + i, ctx->f + i, n);
        } else if (ctx->chunk[k].least < ctx->chunk[k].largest) {
            force_of_slips(n, state + i, ctx->limit + i, f + i);
        } else {
            force_of_alike_slips(n, state + i, ctx->chunk[k].largest, f + i);
        }
        for (size_t j = i, near; ctx->last.kind[k] == MIXED && (near = tribo_next_near(state, &j, i + n)) > 0; j += near) {
            tribo_copy(f + j, ctx->f + j, near);
        }
    }
}
