/* SPDX-License-Identifier: BSD-3-Clause */
/* What a caller sets: law, limits, epsilon, coupling, sharing; and what follows. Only bounds follow from limits, which change
 * more often than the rest. */
#include "calls.h"

/* ------------------------------------------------------------------------------------------------------- what follows */

/* 1 if epsilon follows limits and operator. */
static int epsilon_follows(const tribo_context *ctx)
{
    return ctx->set.step > 0.0 && ctx->op->diagonal;
}

struct range {
    double least, largest;
};

/* Returns the range of x [n] >= 0, n > 0. Finds it by integers, which compare alike: vectors do that in any order. */
TRIBO_SIMD static struct range range_of(size_t n, const double *restrict x)
{
    int64_t least = INT64_MAX, largest = INT64_MIN;
    struct range r;
    TRIBO_UNROLLED
    for (size_t i = 0; i < n; i++) {
        int64_t bits;
        memcpy(&bits, x + i, sizeof bits);
        least = bits < least ? bits : least;
        largest = bits > largest ? bits : largest;
    }
    memcpy(&r.least, &least, sizeof least);
    memcpy(&r.largest, &largest, sizeof largest);
    return r;
}

/* limit [n] = ratio times the caller's, NULL: 1, but at most what the solver resolves. */
static void cut_limits(tribo_context *ctx, const double *ratio, double *limit)
{
    for (size_t i = 0; i < ctx->n; i++) {
        limit[i] = product(ratio ? ratio[i] : 1.0, ctx->set.limit[i]);
    }
    for (size_t g = 0; g < ctx->op->groups; g++) {
        const struct box_qp *p = tribo_problem(ctx, g);
        for (size_t k = 0; k < p->group->size; k++) {
            limit[p->member[k]] = lesser(limit[p->member[k]], tribo_most(p, k));
        }
    }
}

/* Cuts far limits to what the solver resolves, and the factors so that epsilon and slope are numbers. */
static void cut_far(tribo_context *ctx)
{
    struct contacts *c = &ctx->follow.contacts;
    double *limit = ctx->follow.cut_limit;
    const double *factor = c->follows ? ctx->set.width : ctx->set.rate, far = c->follows ? TRIBO_FAR : 2.0 * TRIBO_FAR;
    cut_limits(ctx, NULL, limit);
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->follow.cut_factor[i] = lesser(factor[i], far / greater(limit[i], 1.0));
    }
    for (size_t k = 0; k < tribo_chunks(ctx->n); k++) {
        ctx->follow.chunk[k].alike = 0;
        ctx->follow.chunk[k].model = k * TRIBO_CHUNK;
    }
    c->bound = limit;
    *(c->follows ? &c->width : &c->rate) = ctx->follow.cut_factor;
}

/* Sets what follows from limits that are static: contacts have those of the last call. */
static void hold_limits(tribo_context *ctx)
{
    struct contacts *c = &ctx->follow.contacts;
    double *rate = ctx->follow.cut_factor, *now = ctx->follow.now;
    cut_limits(ctx, NULL, ctx->follow.cut_limit);
    cut_limits(ctx, ctx->set.ratio, ctx->follow.hold);
    for (size_t i = 0; i < ctx->n; i++) {
        struct chunk *chunk = &ctx->follow.chunk[i / TRIBO_CHUNK];
        const double hold = ctx->follow.hold[i];
        now[i] = hold;
        ctx->follow.hold_width[i] = c->follows ? greater(product(c->width[i], hold), DBL_MIN) : c->width[i];
        rate[i] = c->follows ? quotient(c->rate[i], greater(hold, DBL_MIN)) : c->rate[i];
        rate[i] = lesser(rate[i], 2.0 * TRIBO_FAR / greater(hold, 1.0));
        chunk->largest = i % TRIBO_CHUNK ? greater(chunk->largest, hold) : hold;
    }
    *c = (struct contacts){now, now, ctx->follow.hold_width, rate, ctx->moving, 0, c->scales, 0, 0, c->user};
}

static void settings_changed(tribo_context *ctx)
{
    ctx->last.linearized = 0;
    ctx->revision++;
}

void tribo_refresh_limits(tribo_context *ctx)
{
    const int follows = epsilon_follows(ctx), fixed = !ctx->set.breaking;
    ctx->follow.largest = 0.0;
    ctx->follow.contacts = (struct contacts){
        ctx->set.limit, ctx->set.limit, ctx->set.width, ctx->set.rate, ctx->moving, follows, follows, 0, 0, &ctx->set.user};
    if (ctx->set.breaking) {
        hold_limits(ctx);
    }
    for (size_t k = 0; k < tribo_chunks(ctx->n); k++) {
        struct chunk *chunk = &ctx->follow.chunk[k];
        const double *width = ctx->set.width + k * TRIBO_CHUNK, *rate = ctx->set.rate + k * TRIBO_CHUNK;
        const double widest = follows ? greater(product(chunk->widest, chunk->largest), DBL_MIN) : chunk->widest;
        ctx->follow.largest = greater(ctx->follow.largest, chunk->largest);
        chunk->band = chunk->largest == 0.0 ? -1.0 : widest < TRIBO_FAR ? widest : DBL_MAX;
        chunk->alike = fixed && chunk->even && chunk->least == chunk->largest && chunk->largest > 0.0;
        const int even = fixed && k > 0 && chunk->even && chunk[-1].even && width[0] == width[-1] && rate[0] == rate[-1];
        const int goes_on = even && (!chunk->alike || (chunk[-1].alike && chunk->largest == chunk[-1].largest));
        chunk->model = goes_on ? chunk[-1].model : k * TRIBO_CHUNK;
    }
    if (fixed && ctx->follow.largest > lesser(ctx->op->most, TRIBO_FAR / ctx->follow.steepest)) {
        cut_far(ctx);
    }
    settings_changed(ctx);
}

void tribo_refresh(tribo_context *ctx)
{
    const struct delassus *op = ctx->op;
    const int follows = epsilon_follows(ctx);
    const double time = follows ? quotient(ctx->set.step, ctx->set.lambda_dt) : 0.0;
    double *width = ctx->set.width, *rate = ctx->set.rate;
    /* epsilon = 2 limit R_ii time. What friction cannot move does not relax. */
    for (size_t i = 0; follows && i < ctx->n; i++) {
        const double half = greater(product(op->diagonal[i], time), DBL_MIN);
        width[i] = 2.0 * half;
        rate[i] = op->diagonal[i] > TRIBO_IMMOVABLE ? 1.0 / half : 0.0;
    }
    tribo_clusters_refresh(ctx, follows, time);
    ctx->follow.steepest = 1.0;
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        struct chunk *chunk = &ctx->follow.chunk[k];
        const size_t n = tribo_chunk_size(ctx, i), before = k > 0 ? chunk[-1].like : 0;
        const struct range w = range_of(n, width + i), r = range_of(n, rate + i);
        chunk->widest = w.largest;
        chunk->even = w.least == w.largest && r.least == r.largest;
        ctx->follow.steepest = greater(ctx->follow.steepest, follows ? w.largest : r.largest);
        if (op->diagonal) {
            chunk->quickest = range_of(n, op->diagonal + i).largest;
            chunk->plain = range_of(n, op->inverse + i).largest <= TRIBO_PLAIN;
            chunk->like = memcmp(op->inverse + before, op->inverse + i, n * sizeof *op->inverse) == 0 ? before : i;
        }
    }
    tribo_refresh_limits(ctx);
}

/* Sets *to = *from; a status. */
static int settings_answer(const int *from, int *to)
{
    if (!from || !to) {
        return TRIBO_ERR_NULL;
    }
    *to = *from;
    return TRIBO_OK;
}

/* --------------------------------------------------------------------------------------------------------------- law */

/* Takes a law; a status. */
static int put_law(tribo_context *ctx, const struct law *law)
{
    const int status = tribo_check_breaking(ctx, law, ctx->set.breaking, ctx->set.ratio);
    if (!status) {
        ctx->set.law = law;
        memset(ctx->moving, 0, ctx->n);
        settings_changed(ctx);
    }
    return status;
}

int tribo_set_law(tribo_context *ctx, int law)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const struct law *l = tribo_law(law);
    return l ? put_law(ctx, l) : tribo_fail(ctx, TRIBO_ERR_RANGE, "law = %d is none of the %d laws", law, tribo_law_count());
}

int tribo_set_user_law(tribo_context *ctx,
                       int (*law)(size_t first, size_t n, int derivatives, const double *v, const double *limit,
                                  const double *epsilon, double *box, void *data),
                       void *data)
{
    if (!ctx || !law) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "law is NULL");
    }
    int status = tribo_plane_check_coupling(ctx, &tribo_law_own, ctx->set.coupling, ctx->plane.count, ctx->plane.first);
    status = status ? status : put_law(ctx, &tribo_law_own);
    if (!status) {
        ctx->set.user = (struct user_law){law, data};
    }
    return status;
}

int tribo_get_law(const tribo_context *ctx, int *law)
{
    return settings_answer(ctx ? &ctx->set.law->id : NULL, law);
}

/* ------------------------------------------------------------------------------------------------------------ limits */

void tribo_take_limits(tribo_context *ctx, const double *limit)
{
    for (size_t i = 0; i < ctx->n; i += TRIBO_CHUNK) {
        const size_t n = tribo_chunk_size(ctx, i);
        if (limit != ctx->set.limit) {
            memcpy(ctx->set.limit + i, limit + i, n * sizeof *limit);
        }
        const struct range r = range_of(n, limit + i);
        ctx->follow.chunk[i / TRIBO_CHUNK].least = r.least;
        ctx->follow.chunk[i / TRIBO_CHUNK].largest = r.largest;
    }
    tribo_refresh_limits(ctx);
}

int tribo_set_limit(tribo_context *ctx, const double *limit)
{
    const int status = ctx ? tribo_check_nonnegative(ctx, "limit", limit, ctx->n) : TRIBO_ERR_NULL;
    if (!status) {
        tribo_write_slips(ctx);
        tribo_take_limits(ctx, limit);
    }
    return status;
}

int tribo_set_normal_load(tribo_context *ctx, const double *mu, const double *load)
{
    int status = ctx ? tribo_check_nonnegative(ctx, "mu", mu, ctx->n) : TRIBO_ERR_NULL;
    status = status ? status : tribo_check_finite(ctx, "load", load, ctx->n);
    if (status) {
        return status;
    }
    tribo_write_slips(ctx);
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->set.limit[i] = product(greater(load[i], 0.0), mu[i]);
    }
    tribo_take_limits(ctx, ctx->set.limit);
    return TRIBO_OK;
}

int tribo_set_limit_all(tribo_context *ctx, double limit)
{
    const int status = ctx ? tribo_check_slowly(ctx, "limit", &limit, TRIBO_NUMBER, NONNEGATIVE) : TRIBO_ERR_NULL;
    if (!status) {
        tribo_write_slips(ctx);
        for (size_t i = 0; i < ctx->n; i++) {
            ctx->set.limit[i] = limit;
        }
        tribo_take_limits(ctx, ctx->set.limit);
    }
    return status;
}

int tribo_get_limit(const tribo_context *ctx, double *limit)
{
    if (!ctx || (!limit && ctx->n)) {
        return TRIBO_ERR_NULL;
    }
    tribo_copy(limit, ctx->set.limit, ctx->n);
    return TRIBO_OK;
}

/* ----------------------------------------------------------------------------------------------------------- epsilon */

int tribo_get_epsilon(const tribo_context *ctx, double *epsilon)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (ctx->set.step > 0.0 && !tribo_has_operator(ctx)) {
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

/* Sets epsilon [n]; count TRIBO_NUMBER: all have the first; a status. */
static int put_epsilon(tribo_context *ctx, const double *epsilon, size_t count)
{
    const int status = tribo_check_slowly(ctx, "epsilon", epsilon, count, POSITIVE);
    for (size_t i = 0; !status && i < ctx->n; i++) {
        ctx->set.width[i] = epsilon[count == TRIBO_NUMBER ? 0 : i];
        ctx->set.rate[i] = tribo_rate(ctx->set.width[i]);
    }
    if (!status) {
        ctx->set.step = 0.0;
        tribo_refresh(ctx);
    }
    return status;
}

int tribo_set_epsilon(tribo_context *ctx, const double *epsilon)
{
    return ctx ? put_epsilon(ctx, epsilon, ctx->n) : TRIBO_ERR_NULL;
}

int tribo_set_epsilon_all(tribo_context *ctx, double epsilon)
{
    return ctx ? put_epsilon(ctx, &epsilon, TRIBO_NUMBER) : TRIBO_ERR_NULL;
}

int tribo_set_epsilon_step(tribo_context *ctx, double dt, double lambda_dt)
{
    int status = ctx ? tribo_check_slowly(ctx, "dt", &dt, TRIBO_NUMBER, POSITIVE) : TRIBO_ERR_NULL;
    status = status ? status : tribo_check_slowly(ctx, "lambda_dt", &lambda_dt, TRIBO_NUMBER, POSITIVE);
    if (!status) {
        ctx->set.step = dt;
        ctx->set.lambda_dt = lambda_dt;
        tribo_refresh(ctx);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------------ choices */

/* Fails unless choice is 0 or 1, which have these names; a status. */
static int check_choice(tribo_context *ctx, const char *name, int choice, const char *names)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    return choice == 0 || choice == 1 ? TRIBO_OK : tribo_fail(ctx, TRIBO_ERR_RANGE, "%s = %d is neither %s", name, choice, names);
}

int tribo_set_coupling(tribo_context *ctx, int coupling)
{
    int status = check_choice(ctx, "coupling", coupling, "TRIBO_CONSISTENT nor TRIBO_PARTITION");
    status = status ? status : tribo_plane_check_coupling(ctx, ctx->set.law, coupling, ctx->plane.count, ctx->plane.first);
    if (!status) {
        ctx->set.coupling = coupling;
        settings_changed(ctx);
    }
    return status;
}

int tribo_get_coupling(const tribo_context *ctx, int *coupling)
{
    return settings_answer(ctx ? &ctx->set.coupling : NULL, coupling);
}

int tribo_set_sharing(tribo_context *ctx, int sharing)
{
    const int status = check_choice(ctx, "sharing", sharing, "TRIBO_SHARE_LEAST_NORM nor TRIBO_SHARE_PREVIOUS");
    if (!status) {
        ctx->set.sharing = sharing;
        settings_changed(ctx);
    }
    return status;
}

int tribo_get_sharing(const tribo_context *ctx, int *sharing)
{
    return settings_answer(ctx ? &ctx->set.sharing : NULL, sharing);
}

/* --------------------------------------------------------------------------------------------------------- all of them */

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
    const int status = tribo_clusters_copy(ctx, from);
    if (status) {
        return status;
    }
    if (ctx->set.law != from->set.law) {
        memset(ctx->moving, 0, ctx->n);
    }
    const struct settings own = ctx->set, *s = &from->set;
    const size_t n = ctx->n;
    tribo_copy(own.limit, s->limit, (size_t)(own.stribeck - own.limit) + n); /* and the arrays between these two */
    memcpy(ctx->follow.chunk, from->follow.chunk, tribo_chunks(n) * sizeof *ctx->follow.chunk);
    ctx->set = (struct settings){s->law,    s->coupling, s->sharing,  s->step,   s->lambda_dt, own.limit,
                                 own.width, own.rate,    s->breaking, own.ratio, own.stribeck, s->user};
    tribo_refresh(ctx);
    return TRIBO_OK;
}
