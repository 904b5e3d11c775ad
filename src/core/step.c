/* SPDX-License-Identifier: BSD-3-Clause */
/* The force over a time step, and the box problem for laws of the caller's. */
#include "check.h"
#include "clusters.h"
#include "static.h"

/* The acceleration 1/dt v, cut to a number: times clamp(v, -most, most). */
struct pull {
    double times, most;
};

static inline double step_pull_of(struct pull p, double v)
{
    return p.times * clamp(v, -p.most, p.most);
}

/* Inputs of a call. */
struct call {
    struct bounds b;
    double dt;
    struct pull pull;
    const double *v;
    const size_t *group_of; /* [n] */
    int breaks;             /* limits are static */
    int estimates;          /* sums of R's rows times limits are numbers: they bound what friction can hold */
};

/* Sums of rows and limits up to this have numbers as products. */
#define ESTIMATED 1e150

/* 1 if forces up to limit cannot hold a contact, through a row of R with this sum. */
static inline int out_of_reach(struct pull pull, double v, double row_sum, double limit)
{
    return fabs(step_pull_of(pull, v)) > row_sum * limit;
}

TRIBO_SIMD static int any_within_reach(size_t n, struct pull pull, const double *restrict v, const double *restrict row_sum,
                                       double largest)
{
    int64_t any = 0; /* as wide as a double, for vectors */
    for (size_t i = 0; i < n; i++) {
        any |= out_of_reach(pull, v[i], row_sum[i], largest) ? 0 : -1;
    }
    return any != 0;
}

/* Lists the groups with a contact that friction could hold, chunk by chunk: in a large scene most chunks have none. */
static void find_candidates(tribo_context *ctx, const struct call *c)
{
    const double *row_sum = ctx->op->row_sum;
    const struct chunk *chunk = ctx->follow.chunk;
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        const size_t n = tribo_chunk_size(ctx, i);
        /* at least the largest limit in any group with a contact in the chunk */
        const double before = k > 0 ? chunk[k - 1].largest : 0.0,
                     behind = k + 1 < tribo_chunks(ctx->n) ? chunk[k + 1].largest : 0.0;
        const double around = greater(chunk[k].largest, greater(before, behind));
        const double largest = ctx->op->span < TRIBO_CHUNK ? around : ctx->follow.largest;
        if (c->estimates && (largest == 0.0 || !any_within_reach(n, c->pull, c->v + i, row_sum + i, largest))) {
            continue;
        }
        for (size_t j = i; j < i + n; j++) {
            if (!(c->estimates && out_of_reach(c->pull, c->v[j], row_sum[j], largest))) {
                tribo_list_group(ctx, c->group_of[j]);
            }
        }
    }
}

/* 1 if friction could hold the contact at place k by limits [size]. */
static int within_reach(const struct box_qp *p, size_t k, const struct call *c, const double *limit)
{
    double reach;
    tribo_row_dot(p, k, limit, &reach);
    return !(fabs(step_pull_of(c->pull, c->v[p->member[k]])) > reach);
}

/* Solves the box problem of group g, again while static limits break. A contact with equal bounds has f = bound; a contact with a
 * pull that no friction can hold keeps f. Sets *takes_part = 0 if no other contact is in the group. Returns a status. */
static int solve_for(tribo_context *ctx, size_t g, const struct call *c, unsigned char *takes_part)
{
    struct box_qp *p = tribo_problem(ctx, g);
    const int all = !c->estimates || p->group->small;
    size_t behind = p->group->size, broken = 0;
    int status = TRIBO_OK;
    p->count = 0;
    p->far = ctx->last.far;
    for (size_t k = 0; !all && k < p->group->size; k++) {
        p->step[k] = ctx->follow.contacts.bound[p->member[k]];
    }
    for (size_t k = 0; k < p->group->size; k++) {
        const size_t i = p->member[k];
        const double lo = tribo_lower(&c->b, i), hi = c->b.upper[i];
        if (lo < hi && (all || within_reach(p, k, c, p->step))) {
            p->near[p->count++] = k;
            p->lo[k] = ctx->last.far ? tribo_cut(p, k, lo) : lo;
            p->hi[k] = ctx->last.far ? tribo_cut(p, k, hi) : hi;
            p->q[k] = step_pull_of(c->pull, c->v[i]);
        } else {
            p->near[--behind] = k;
            ctx->last.f[i] = lo < hi ? ctx->last.f[i] : hi;
            p->x[k] = tribo_carried(ctx, p, k);
        }
    }
    *takes_part = p->count > 0;
    if (!*takes_part) {
        return status;
    }
    do {
        status = tribo_solve_group(ctx, p);
        for (size_t e = 0; !status && c->breaks && e < p->count; e++) {
            const size_t k = p->near[e], i = p->member[k];
            ctx->last.feq[i] = cut(p->x[k] - quotient(p->gradient[k], ctx->op->diagonal[i]));
        }
        broken = !status && c->breaks ? tribo_break_away(ctx, p, c->dt) : 0;
        for (size_t e = 0; broken && e < p->count; e++) {
            const size_t k = p->near[e];
            p->hi[k] = ctx->follow.now[p->member[k]];
            p->lo[k] = -p->hi[k];
        }
    } while (broken);
    for (size_t e = 0; !status && e < p->count; e++) {
        const size_t k = p->near[e], i = p->member[k];
        ctx->last.f[i] = clamp(p->x[k], tribo_lower(&c->b, i), c->b.upper[i]);
    }
    return status;
}

/* Finds f in last.f of the contacts in groups by group_of [n], and in none; a status. */
static int solve_boxes(tribo_context *ctx, double dt, const double *v, struct bounds b, const size_t *group_of)
{
    const struct delassus *op = ctx->op;
    const int breaks = !b.lower && ctx->set.breaking;
    const int estimates = !b.lower && !breaks && ctx->follow.largest < ESTIMATED && op->largest_sum < ESTIMATED;
    const double times = op->groups ? quotient(1.0, dt) : 0.0;
    const struct call c = {b, dt, {times, TRIBO_FAR / greater(times, 1.0)}, v, group_of, breaks, estimates};
    struct memory *m = &ctx->memory;
    tribo_step_each(ctx, dt, v, b);
    if (breaks) {
        tribo_break_alone(ctx, dt, v);
    }
    if (op->groups) {
        find_candidates(ctx, &c);
    }
    /* Groups stay in the list if a contact takes part; after a failure none does. */
    const size_t candidates = m->nsolved;
    int status = TRIBO_OK;
    m->nsolved = 0;
    for (size_t k = 0; k < candidates; k++) {
        const size_t g = m->solved_list[k];
        if (k + 2 < candidates) {
            tribo_memory_expect(op, m, m->solved_list[k + 2]);
        }
        m->solved[g] = 0;
        status = status ? status : solve_for(ctx, g, &c, &m->solved[g]);
        if (m->solved[g]) {
            m->solved_list[m->nsolved++] = g;
        }
    }
    return status;
}

/* Ends a problem of a number of islands; a status. */
static int end_problem(tribo_context *ctx, size_t islands, int status)
{
    if (!status) {
        ctx->count.skipped += islands - ctx->memory.nsolved - ctx->last.clusters;
        tribo_remember_forces(ctx);
    }
    return status;
}

int tribo_solve_step(tribo_context *ctx, double dt, const double *v, struct bounds b, const signed char *known)
{
    tribo_begin_call(ctx);
    ctx->last.holds = 1.0;
    const int status = solve_boxes(ctx, dt, v, b, ctx->group_of);
    return end_problem(ctx, tribo_islands(ctx), status ? status : tribo_clusters_step(ctx, dt, v, known));
}

int tribo_step_at_end(tribo_context *ctx, double dt, const double *v, const double *vfree, double *f)
{
    const struct bounds b = {NULL, ctx->follow.contacts.limit};
    if (ctx->set.breaking) {
        tribo_hold_for_step(ctx, dt, v, NULL);
    }
    int status = tribo_solve_step(ctx, dt, vfree, b, NULL);
    /* A contact that comes in sliding does so until it comes to a stop, and holds there if it can. */
    if (!status && ctx->set.breaking && v && tribo_hold_for_step(ctx, dt, v, ctx->last.f)) {
        status = tribo_solve_step(ctx, dt, vfree, b, NULL);
    }
    if (!status) {
        tribo_copy(f, ctx->last.f, ctx->n);
        ctx->last.slips = SLIPS_IN_FORCES;
    }
    return status;
}

int tribo_step_force(tribo_context *ctx, double dt, const double *vfree, double *f)
{
    const int status = ctx ? tribo_check_step(ctx, dt, vfree, f) : TRIBO_ERR_NULL;
    if (!status && tribo_all_alone(ctx)) {
        return tribo_step_alone(ctx, dt, vfree, f);
    }
    return status ? status : tribo_step_at_end(ctx, dt, NULL, vfree, f);
}

int tribo_solve_box(tribo_context *ctx, const double *a, const double *lower, const double *upper, double *f)
{
    int status = ctx ? tribo_need_operator(ctx) : TRIBO_ERR_NULL;
    status = status ? status : tribo_check_finite(ctx, "a", a, ctx->n);
    status = status ? status : tribo_check_finite(ctx, "lower", lower, ctx->n);
    status = status ? status : tribo_check_finite(ctx, "upper", upper, ctx->n);
    double most = 0.0;
    for (size_t i = 0; !status && i < ctx->n; i++) {
        if (lower[i] > upper[i]) {
            return tribo_fail(ctx, TRIBO_ERR_RANGE, "lower[%zu] = %g is above upper[%zu] = %g", i, lower[i], i, upper[i]);
        }
        most = greater(most, greater(upper[i], -lower[i]));
    }
    status = status ? status : tribo_check_output(ctx, "f", f);
    if (status) {
        return status;
    }
    tribo_begin_call(ctx);
    ctx->last.far = most > TRIBO_ROOM * ctx->op->most;
    status = end_problem(ctx, ctx->op->islands, solve_boxes(ctx, 1.0, a, (struct bounds){lower, upper}, ctx->op->group_of));
    tribo_copy(f, ctx->last.f, status ? 0 : ctx->n);
    return status;
}
