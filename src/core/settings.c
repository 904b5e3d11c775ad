/* What a caller sets: law, limits, epsilon, coupling, sharing; and what follows from it. Nothing but bounds follows from limits,
 * which change more often than everything else. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "check.h"

/* Whether epsilon follows limits and operator. */
static int epsilon_follows(const tribo_context *ctx)
{
    return ctx->set.step > 0.0 && ctx->op->diagonal;
}

static double largest_of(size_t n, const double *x)
{
    double largest = x[0];
    for (size_t i = 1; i < n; i++) {
        largest = greater(largest, x[i]);
    }
    return largest;
}

/* Compared with the first, so that all are looked at. */
static int even(size_t n, const double *x)
{
    int differ = 0;
    for (size_t i = 1; i < n; i++) {
        differ |= x[i] != x[0];
    }
    return !differ;
}

/* Of the n contacts of the chunk that begins with i. */
static int evenness(const tribo_context *ctx, size_t i, size_t n)
{
    const double *width = ctx->set.width + i, *rate = ctx->set.rate + i;
    if (!even(n, width) || !even(n, rate)) {
        return UNEVEN;
    }
    return i && ctx->follow.chunk[i / TRIBO_CHUNK - 1].even && width[-1] == *width && rate[-1] == *rate ? EVEN_AS_BEFORE : EVEN;
}

/* Whether n numbers are the same as those from like on. */
static int repeats(const double *x, size_t like, size_t i, size_t n)
{
    return memcmp(x + like, x + i, n * sizeof *x) == 0;
}

static double band_of(const struct chunk *chunk, int follows)
{
    if (chunk->largest == 0.0) {
        return -1.0;
    }
    const double widest = follows ? greater(product(chunk->widest, chunk->largest), DBL_MIN) : chunk->widest;
    return widest < TRIBO_FAR ? widest : DBL_MAX;
}

/* Whether a chunk's contacts are as those of the one before, in width and rate, and if they are alike in limit too. */
static inline int settings_goes_on(const struct chunk *chunk)
{
    return chunk->even == EVEN_AS_BEFORE && (!chunk->alike || (chunk[-1].alike && chunk->largest == chunk[-1].largest));
}

void tribo_refresh_limits(tribo_context *ctx)
{
    const int follows = epsilon_follows(ctx);
    ctx->follow.largest = 0.0;
    ctx->follow.contacts =
        (struct contacts){ctx->set.limit, ctx->set.limit, ctx->set.width, ctx->set.rate, ctx->moving, follows, follows, 0};
    if (ctx->set.breaking) {
        tribo_refresh_static(ctx);
    }
    for (size_t k = 0; k < tribo_chunks(ctx->n); k++) {
        struct chunk *chunk = &ctx->follow.chunk[k];
        ctx->follow.largest = greater(ctx->follow.largest, chunk->largest);
        chunk->band = band_of(chunk, follows);
        chunk->alike = !ctx->set.breaking && chunk->even && chunk->least == chunk->largest && chunk->largest > 0.0;
        chunk->model = !ctx->set.breaking && settings_goes_on(chunk) ? chunk[-1].model : k * TRIBO_CHUNK;
    }
    if (!ctx->set.breaking && ctx->follow.largest > lesser(ctx->op->most, TRIBO_FAR / ctx->follow.steepest)) {
        /* Far limits are cut to what the solver tells apart, and the factors to what makes epsilon and slope numbers. */
        struct contacts *c = &ctx->follow.contacts;
        for (size_t i = 0; i < ctx->n; i++) {
            ctx->follow.cut_limit[i] = lesser(ctx->set.limit[i], TRIBO_FAR);
        }
        for (size_t g = 0; g < ctx->op->groups; g++) {
            const struct box_qp *p = tribo_problem(ctx, g);
            for (size_t k = 0; k < p->group->size; k++) {
                ctx->follow.cut_limit[p->member[k]] = lesser(ctx->set.limit[p->member[k]], tribo_most(p, k));
            }
        }
        const double *factor = c->follows ? ctx->set.width : ctx->set.rate, far = c->follows ? TRIBO_FAR : 2.0 * TRIBO_FAR;
        for (size_t i = 0; i < ctx->n; i++) {
            ctx->follow.cut_factor[i] = lesser(factor[i], far / greater(ctx->follow.cut_limit[i], 1.0));
        }
        for (size_t k = 0; k < tribo_chunks(ctx->n); k++) {
            ctx->follow.chunk[k].alike = 0;
            ctx->follow.chunk[k].model = k * TRIBO_CHUNK;
        }
        c->bound = ctx->follow.cut_limit;
        *(c->follows ? &c->width : &c->rate) = ctx->follow.cut_factor;
    }
    ctx->last.linearized = 0;
    ctx->revision++;
}

void tribo_refresh(tribo_context *ctx)
{
    ctx->group_of = ctx->planar && ctx->op->diagonal ? ctx->planar->group_of : ctx->op->group_of;
    if (epsilon_follows(ctx)) {
        /* epsilon = 2 limit R_ii time. What friction cannot move does not relax. */
        const double time = quotient(ctx->set.step, ctx->set.lambda_dt);
        for (size_t i = 0; i < ctx->n; i++) {
            const double half = greater(product(ctx->op->diagonal[i], time), DBL_MIN);
            ctx->set.width[i] = 2.0 * half;
            ctx->set.rate[i] = ctx->op->diagonal[i] > TRIBO_IMMOVABLE ? 1.0 / half : 0.0;
        }
        for (size_t k = 0; ctx->planar && k < ctx->planar->count; k++) {
            /* A planar contact has one epsilon for all directions: for R_ii stands the largest eigenvalue of its own block. */
            const double *own = ctx->planar->own[k], turned[2] = {0.5 * own[0] - 0.5 * own[2], own[1]};
            const double largest = 0.5 * own[0] + 0.5 * own[2] + tribo_length(2, turned),
                         half = greater(product(largest, time), DBL_MIN);
            for (size_t i = ctx->planar->first[k]; i < ctx->planar->first[k] + 2; i++) {
                ctx->set.width[i] = 2.0 * half;
                ctx->set.rate[i] = largest > TRIBO_IMMOVABLE ? 1.0 / half : 0.0;
            }
        }
    }
    const double *factor = epsilon_follows(ctx) ? ctx->set.width : ctx->set.rate;
    ctx->follow.steepest = 1.0;
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        const size_t n = tribo_chunk_size(ctx, i);
        ctx->follow.chunk[k].widest = largest_of(n, ctx->set.width + i);
        ctx->follow.chunk[k].even = evenness(ctx, i, n);
        ctx->follow.steepest = greater(ctx->follow.steepest, largest_of(n, factor + i));
    }
    const struct delassus *op = ctx->op;
    for (size_t i = 0, k = 0; op->diagonal && i < ctx->n; i += TRIBO_CHUNK, k++) {
        struct chunk *chunk = &ctx->follow.chunk[k];
        const size_t n = tribo_chunk_size(ctx, i), before = k > 0 ? chunk[-1].like : 0;
        chunk->quickest = largest_of(n, op->diagonal + i);
        chunk->plain = largest_of(n, op->inverse + i) <= TRIBO_PLAIN;
        chunk->like = repeats(op->inverse, before, i, n) ? before : i;
    }
    tribo_refresh_limits(ctx);
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
    const int status = tribo_check_breaking(ctx, l, ctx->set.breaking, ctx->set.ratio);
    if (status) {
        return status;
    }
    ctx->set.law = l;
    ctx->last.linearized = 0;
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
        return TRIBO_ERR_NULL;
    }
    *law = ctx->set.law->id;
    return TRIBO_OK;
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
    tribo_write_slips(ctx);
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        const size_t n = tribo_chunk_size(ctx, i);
        tribo_take_limits(n, limit + i, ctx->set.limit + i, &ctx->follow.chunk[k]);
    }
    tribo_refresh_limits(ctx);
    return TRIBO_OK;
}

int tribo_set_normal_load(tribo_context *ctx, const double *mu, const double *load)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    int status = tribo_check_nonnegative(ctx, "mu", mu, ctx->n);
    status = status ? status : tribo_check_finite(ctx, "load", load, ctx->n);
    if (status) {
        return status;
    }
    tribo_write_slips(ctx);
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        const size_t n = tribo_chunk_size(ctx, i);
        double limit[TRIBO_CHUNK];
        for (size_t j = 0; j < n; j++) {
            limit[j] = product(greater(load[i + j], 0.0), mu[i + j]);
        }
        tribo_take_limits(n, limit, ctx->set.limit + i, &ctx->follow.chunk[k]);
    }
    tribo_refresh_limits(ctx);
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
    tribo_write_slips(ctx);
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->set.limit[i] = limit;
    }
    for (size_t k = 0; k < tribo_chunks(ctx->n); k++) {
        ctx->follow.chunk[k].least = ctx->follow.chunk[k].largest = limit;
    }
    tribo_refresh_limits(ctx);
    return TRIBO_OK;
}

int tribo_get_limit(const tribo_context *ctx, double *limit)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!limit && ctx->n) {
        return TRIBO_ERR_NULL;
    }
    tribo_copy(limit, ctx->set.limit, ctx->n);
    return TRIBO_OK;
}

int tribo_get_epsilon(const tribo_context *ctx, double *epsilon)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!tribo_has_epsilon(ctx)) {
        return TRIBO_ERR_STATE;
    }
    if (!epsilon && ctx->n) {
        return TRIBO_ERR_NULL;
    }
    for (size_t i = 0; i < ctx->n; i++) {
        epsilon[i] = tribo_epsilon_of(&ctx->follow.contacts, i);
    }
    return TRIBO_OK;
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
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->set.width[i] = epsilon[i];
        ctx->set.rate[i] = tribo_rate(epsilon[i]);
    }
    ctx->set.step = 0.0;
    tribo_refresh(ctx);
    return TRIBO_OK;
}

static int check_scalar(tribo_context *ctx, const char *name, double x)
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
        ctx->set.width[i] = epsilon;
        ctx->set.rate[i] = tribo_rate(epsilon);
    }
    ctx->set.step = 0.0;
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
    ctx->set.step = dt;
    ctx->set.lambda_dt = lambda_dt;
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
    if (coupling == TRIBO_PARTITION && ctx->planar) {
        return tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED, "the partition coupling knows no planar contacts, and contact %zu is one",
                          ctx->planar->first[0]);
    }
    ctx->set.coupling = coupling;
    ctx->last.linearized = 0;
    ctx->revision++;
    return TRIBO_OK;
}

int tribo_get_coupling(const tribo_context *ctx, int *coupling)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!coupling) {
        return TRIBO_ERR_NULL;
    }
    *coupling = ctx->set.coupling;
    return TRIBO_OK;
}

int tribo_set_sharing(tribo_context *ctx, int sharing)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (sharing != TRIBO_SHARE_LEAST_NORM && sharing != TRIBO_SHARE_PREVIOUS) {
        return tribo_fail(ctx, TRIBO_ERR_RANGE, "sharing = %d is neither TRIBO_SHARE_LEAST_NORM nor TRIBO_SHARE_PREVIOUS",
                          sharing);
    }
    ctx->set.sharing = sharing;
    ctx->last.linearized = 0;
    ctx->revision++;
    return TRIBO_OK;
}

int tribo_get_sharing(const tribo_context *ctx, int *sharing)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!sharing) {
        return TRIBO_ERR_NULL;
    }
    *sharing = ctx->set.sharing;
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------ static limits */

/* Where a ratio is above 1, or n; either of ratio and velocity may be NULL. */
static int settings_check_static(tribo_context *ctx, const double *ratio, const double *velocity, size_t *above)
{
    int status = ratio ? tribo_check_finite(ctx, "ratio", ratio, ctx->n) : TRIBO_OK;
    status = status || !velocity ? status : tribo_check_positive(ctx, "velocity", velocity, ctx->n);
    *above = ctx->n;
    for (size_t i = 0; !status && ratio && i < ctx->n; i++) {
        if (ratio[i] < 1.0) {
            return tribo_fail(ctx, TRIBO_ERR_RANGE, "ratio[%zu] = %g is below 1", i, ratio[i]);
        }
        *above = *above == ctx->n && ratio[i] > 1.0 ? i : *above;
    }
    return status;
}

int tribo_set_static(tribo_context *ctx, const double *ratio, const double *velocity)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    size_t above = ctx->n;
    int status = settings_check_static(ctx, ratio, velocity, &above);
    const int breaking = above == ctx->n ? NEVER : velocity ? FALLS : DROPS;
    status = status ? status : tribo_check_breaking(ctx, ctx->set.law, breaking, ratio);
    if (!status && breaking && ctx->planar) {
        status = tribo_check_one_ratio(ctx, ratio, velocity, ctx->planar->count, ctx->planar->first);
    }
    if (status) {
        return status;
    }
    tribo_write_slips(ctx);
    ctx->set.breaking = breaking;
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->set.ratio[i] = breaking ? ratio[i] : 1.0;
        ctx->set.stribeck[i] = breaking == FALLS ? velocity[i] : 0.0;
    }
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        tribo_take_limits(tribo_chunk_size(ctx, i), ctx->set.limit + i, ctx->follow.now + i, &ctx->follow.chunk[k]);
    }
    tribo_refresh_limits(ctx);
    return TRIBO_OK;
}

int tribo_get_static(const tribo_context *ctx, double *ratio, double *velocity)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    for (size_t i = 0; ratio && i < ctx->n; i++) {
        ratio[i] = ctx->set.breaking ? ctx->set.ratio[i] : 1.0;
    }
    for (size_t i = 0; velocity && i < ctx->n; i++) {
        velocity[i] = ctx->set.breaking == FALLS ? ctx->set.stribeck[i] : 0.0;
    }
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------ all of them */

/* The planar contacts of from, if ctx has others. */
static int copy_planar(tribo_context *ctx, const tribo_context *from)
{
    const size_t count = from->planar ? from->planar->count : 0, *first = count ? from->planar->first : NULL;
    const size_t now = ctx->planar ? ctx->planar->count : 0;
    struct planar *planar;
    struct plane plane;
    if (count == now && (!count || memcmp(first, ctx->planar->first, count * sizeof *first) == 0)) {
        return TRIBO_OK;
    }
    const int status = tribo_planar_prepare(ctx, count, first, ctx->op, &ctx->memory, &planar, &plane);
    if (!status) {
        tribo_planar_install(ctx, planar, &plane);
    }
    return status;
}

int tribo_copy_settings(tribo_context *ctx, const tribo_context *from)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!from) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "from is NULL");
    }
    if (from->n != ctx->n) {
        return tribo_fail(ctx, TRIBO_ERR_SIZE, "from has %zu contact%s, but ctx %zu contact%s", from->n, plural(from->n), ctx->n,
                          plural(ctx->n));
    }
    tribo_write_slips(ctx);
    const int status = copy_planar(ctx, from);
    if (status) {
        return status;
    }
    if (ctx->set.law != from->set.law) {
        memset(ctx->moving, 0, ctx->n);
    }
    struct settings *to = &ctx->set;
    const struct settings *s = &from->set;
    tribo_copy(to->width, s->width, ctx->n);
    tribo_copy(to->rate, s->rate, ctx->n);
    if (s->breaking) {
        tribo_copy(to->ratio, s->ratio, ctx->n);
        tribo_copy(to->stribeck, s->stribeck, ctx->n);
    }
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        tribo_take_limits(tribo_chunk_size(ctx, i), s->limit + i, to->limit + i, &ctx->follow.chunk[k]);
    }
    *to = (struct settings){s->law,    s->coupling, s->sharing,  s->step,   s->lambda_dt, to->limit,
                            to->width, to->rate,    s->breaking, to->ratio, to->stribeck};
    tribo_refresh(ctx);
    return TRIBO_OK;
}
