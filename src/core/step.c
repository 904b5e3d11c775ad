/* The force over a time step, and the box-constrained problem for laws of the caller's own. */

#include "check.h"

/* How hard a contact is pulled that would end a step with v, in numbers: times v, up to most. */
struct pull {
    double times, most;
};

static inline double step_pull_of(struct pull p, double v)
{
    return p.times * clamp(v, -p.most, p.most);
}

/* A call: its bounds, and what pulls. */
struct call {
    struct bounds b;
    double dt;
    struct pull pull;
    const double *v;
    const size_t *group_of;
    int all;       /* contacts take part, whatever friction can do against the pull */
    int breaks;    /* limits are static */
    int estimates; /* the pull tells something, and what limits can do against it is found from the sums of R's rows first */
};

/* Sums of rows and limits up to this make numbers of each other. */
#define ESTIMATED 1e150

/* Whether a contact is pulled harder than forces of this limit can hold it, through a row of R with this sum. */
static inline int out_of_reach(struct pull pull, double v, double row_sum, double limit)
{
    return fabs(step_pull_of(pull, v)) > row_sum * limit;
}

TRIBO_SIMD static int any_within_reach(size_t n, struct pull pull, const double *restrict v, const double *restrict row_sum,
                                       double largest)
{
    int64_t any = 0; /* as wide as what is compared */
    for (size_t i = 0; i < n; i++) {
        any |= out_of_reach(pull, v[i], row_sum[i], largest) ? 0 : -1;
    }
    return any != 0;
}

/* At least the largest limit in any group with a contact in chunk k. */
static double largest_around(const tribo_context *ctx, size_t k)
{
    if (ctx->op->span >= TRIBO_CHUNK) {
        return ctx->follow.largest;
    }
    const double before = k > 0 ? ctx->follow.chunk[k - 1].largest : 0.0;
    const double behind = k + 1 < tribo_chunks(ctx->n) ? ctx->follow.chunk[k + 1].largest : 0.0;
    return greater(ctx->follow.chunk[k].largest, greater(before, behind));
}

/* Finds the groups in which a contact may take part, chunk by chunk: in a large scene most have none. */
static void find_candidates(tribo_context *ctx, const struct call *c)
{
    const struct delassus *op = ctx->op;
    const size_t *group_of = c->group_of;
    struct memory *m = &ctx->memory;
    for (size_t i = 0, k = 0; i < ctx->n; i += TRIBO_CHUNK, k++) {
        const size_t n = tribo_chunk_size(ctx, i);
        const double largest = largest_around(ctx, k);
        if (c->estimates && (largest == 0.0 || !any_within_reach(n, c->pull, c->v + i, op->row_sum + i, largest))) {
            continue;
        }
        for (size_t j = i; j < i + n; j++) {
            const size_t g = group_of[j];
            if (g != TRIBO_ALONE && !m->solved[g] && !(c->estimates && out_of_reach(c->pull, c->v[j], op->row_sum[j], largest))) {
                m->solved[g] = 1;
                m->solved_list[m->nsolved++] = g;
            }
        }
    }
}

/* The limits of a group, by place, and what they are at least and at most. */
struct limits {
    double least, largest;
    double *of;
};

static struct limits limits_of(const tribo_context *ctx, const struct box_qp *p)
{
    struct limits l = {TRIBO_FAR, 0.0, p->step};
    for (size_t k = 0; k < p->group->size; k++) {
        l.of[k] = ctx->follow.contacts.bound[p->member[k]];
        l.least = lesser(l.least, l.of[k]);
        l.largest = greater(l.largest, l.of[k]);
    }
    return l;
}

/* Whether friction could hold the contact at place k: limits that are all the same need no look at the row. */
static int within_reach(const tribo_context *ctx, const struct box_qp *p, size_t k, const struct call *c, const struct limits *l)
{
    const double v = c->v[p->member[k]], row_sum = c->estimates ? ctx->op->row_sum[p->member[k]] : 0.0;
    const int may = !c->estimates | !out_of_reach(c->pull, v, row_sum, l->largest);
    const int sure = c->estimates & !out_of_reach(c->pull, v, row_sum, l->least);
    double reach;
    if (may == sure) {
        return may;
    }
    tribo_row_dot(p, k, l->of, &reach);
    return !(fabs(step_pull_of(c->pull, v)) > reach);
}

/* Sets the problem of a group: its contacts in the problem's order, those that take part first. Contacts whose bounds leave no
 * choice do not, nor do those of Coulomb's law that are out of reach. */
static struct box_qp *pose(tribo_context *ctx, size_t g, const struct call *c)
{
    struct box_qp *p = tribo_problem(ctx, g);
    const int all = c->all || p->group->small;
    const struct limits l = all ? (struct limits){0} : limits_of(ctx, p);
    size_t behind = p->group->size;
    p->count = 0;
    p->far = ctx->last.far;
    for (size_t k = 0; k < p->group->size; k++) {
        const size_t i = p->member[k];
        const double lo = tribo_lower(&c->b, i), hi = c->b.upper[i];
        if (lo < hi && (all || within_reach(ctx, p, k, c, &l))) {
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
    return p;
}

/* Where limits are static: which contacts of a group break away. Returns how many, with their new bounds. */
static size_t step_let_go(tribo_context *ctx, struct box_qp *p, double dt)
{
    for (size_t e = 0; e < p->count; e++) {
        const size_t k = p->near[e], i = p->member[k];
        ctx->last.feq[i] = cut(p->x[k] - quotient(p->gradient[k], ctx->op->diagonal[i]));
    }
    const size_t broken = tribo_break_away(ctx, p, dt);
    for (size_t e = 0; broken && e < p->count; e++) {
        const size_t k = p->near[e];
        p->hi[k] = ctx->follow.now[p->member[k]];
        p->lo[k] = -p->hi[k];
    }
    return broken;
}

/* Solves for the contacts of a group that take part; there are some. */
static int solve_for(tribo_context *ctx, struct box_qp *p, const struct call *c)
{
    const struct bounds *b = &c->b;
    int status;
    do {
        status = tribo_solve_group(ctx, p);
    } while (!status && c->breaks && step_let_go(ctx, p, c->dt));
    for (size_t e = 0; !status && e < p->count; e++) {
        const size_t k = p->near[e], i = p->member[k];
        ctx->last.f[i] = clamp(p->x[k], tribo_lower(b, i), b->upper[i]);
    }
    return status;
}

/* Solves for all contacts, but for clusters. */
static inline int solve_boxes(tribo_context *ctx, double dt, const double *v, struct bounds b, const size_t *group_of)
{
    const int breaks = !b.lower && ctx->set.breaking, all = b.lower || breaks;
    const int estimates = !all && ctx->follow.largest < ESTIMATED && ctx->op->largest_sum < ESTIMATED;
    const double times = ctx->op->groups ? quotient(1.0, dt) : 0.0;
    const struct call c = {b, dt, {times, TRIBO_FAR / greater(times, 1.0)}, v, group_of, all, breaks, estimates};
    /* A small group that is all there is takes as long to solve as to be found to slide. */
    const int one = ctx->op->groups == 1 && ctx->op->group->small && ctx->op->group->size == ctx->n && *group_of == 0;
    struct memory *m = &ctx->memory;
    tribo_store_all(ctx);
    for (size_t i = 0, k = 0; !one && i < ctx->n; i += TRIBO_CHUNK, k++) {
        tribo_stop_alone(ctx, k, dt, v + i, tribo_bounds_from(&b, i), ctx->last.f + i);
    }
    if (breaks) {
        tribo_break_alone(ctx, dt, v);
    }
    if (one) {
        m->solved_list[m->nsolved++] = 0;
    } else if (ctx->op->groups) {
        find_candidates(ctx, &c);
    }
    /* Solves for the groups that are candidates, of which those stay that a contact takes part in; after a failure none of the rest.
     */
    const size_t candidates = m->nsolved;
    int status = TRIBO_OK;
    m->nsolved = 0;
    for (size_t k = 0; k < candidates; k++) {
        const size_t g = m->solved_list[k];
        if (k + 2 < candidates) {
            tribo_memory_expect(ctx->op, m, m->solved_list[k + 2]);
        }
        struct box_qp *p = status ? NULL : pose(ctx, g, &c);
        m->solved[g] = p && p->count > 0;
        if (m->solved[g]) {
            m->solved_list[m->nsolved++] = g;
            status = solve_for(ctx, p, &c);
        }
    }
    return status;
}

static inline void hand_out(tribo_context *ctx, double *f)
{
    ctx->count.skipped += ctx->op->islands - ctx->memory.nsolved;
    tribo_remember_forces(ctx);
    tribo_copy(f, ctx->last.f, ctx->n);
}

/* Solves for all contacts, which are scalar. */
static int box_all(tribo_context *ctx, double dt, const double *v, struct bounds b, double *f)
{
    const int status = solve_boxes(ctx, dt, v, b, ctx->op->group_of);
    if (!status) {
        hand_out(ctx, f);
    }
    return status;
}

int tribo_solve_step(tribo_context *ctx, double dt, const double *v, struct bounds b, const signed char *known, double *f)
{
    if (!ctx->planar) {
        return box_all(ctx, dt, v, b, f);
    }
    int status = solve_boxes(ctx, dt, v, b, ctx->group_of);
    status = status ? status : tribo_planar_step(ctx, dt, v, known);
    if (!status) {
        hand_out(ctx, f);
    }
    return status;
}

/* With the limits that contacts have for now. */
static int step_once(tribo_context *ctx, double dt, const double *vfree, double *f)
{
    const struct bounds b = {NULL, ctx->follow.contacts.limit};
    tribo_begin_call(ctx);
    return ctx->planar ? tribo_solve_step(ctx, dt, vfree, b, NULL, f) : box_all(ctx, dt, vfree, b, f);
}

/* Where limits are static: whoever slides does so until it comes to a stop, and holds there if it can. */
static int step_from(tribo_context *ctx, double dt, const double *v, const double *vfree, double *f)
{
    double *first = ctx->last.v;
    tribo_hold_for_step(ctx, dt, v, NULL);
    const int status = step_once(ctx, dt, vfree, v ? first : f);
    if (status || !v) {
        return status;
    }
    if (!tribo_any_turns(ctx, dt, v, first)) {
        tribo_copy(f, first, ctx->n);
        return TRIBO_OK;
    }
    tribo_hold_for_step(ctx, dt, v, first);
    return step_once(ctx, dt, vfree, f);
}

int tribo_step_at_end(tribo_context *ctx, double dt, const double *v, const double *vfree, double *f)
{
    const int status = ctx->set.breaking ? step_from(ctx, dt, v, vfree, f) : step_once(ctx, dt, vfree, f);
    if (!status) {
        ctx->last.slips = SLIPS_IN_FORCES;
        ctx->last.holds = 1.0;
    }
    return status;
}

int tribo_step_force(tribo_context *ctx, double dt, const double *vfree, double *f)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    const int status = tribo_check_step(ctx, dt, vfree, f);
    if (!status && tribo_all_alone(ctx)) {
        return tribo_step_alone(ctx, dt, vfree, f);
    }
    return status ? status : tribo_step_at_end(ctx, dt, NULL, vfree, f);
}

int tribo_solve_box(tribo_context *ctx, const double *a, const double *lower, const double *upper, double *f)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    int status = tribo_need_operator(ctx);
    status = status ? status : tribo_check_finite(ctx, "a", a, ctx->n);
    status = status ? status : tribo_check_finite(ctx, "lower", lower, ctx->n);
    status = status ? status : tribo_check_finite(ctx, "upper", upper, ctx->n);
    if (status) {
        return status;
    }
    double most = 0.0;
    for (size_t i = 0; i < ctx->n; i++) {
        if (lower[i] > upper[i]) {
            return tribo_fail(ctx, TRIBO_ERR_RANGE, "lower[%zu] = %g is above upper[%zu] = %g", i, lower[i], i, upper[i]);
        }
        most = greater(most, greater(upper[i], -lower[i]));
    }
    if (!f && ctx->n) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "f is NULL");
    }
    tribo_begin_call(ctx);
    ctx->last.far = most > TRIBO_ROOM * ctx->op->most;
    return box_all(ctx, 1.0, a, (struct bounds){lower, upper}, f);
}
