/* SPDX-License-Identifier: BSD-3-Clause */
/* The force over a time step, and the box problem for laws of the caller's.
 *
 * Coulomb's law at the end of a step, as tribo_step_force gives it, has two errors of first order: a planar contact that turns
 * slides in the direction of the end, and a scalar one that is driven through v = 0 stops there until the step is over.
 * tribo_step_force_mean removes both:
 *
 *     solve at the end of the step: which contacts stick, and R f
 *     planar contacts that slide: in the direction of v + v_end, which is the same problem with v + vfree in the place of vfree
 *     scalar ones that are driven through zero: their limit one way until then, and the other way after
 *     solve again, if there are any
 *
 * A contact is driven through zero if the acceleration at v = 0 without its own force exceeds what its limit can hold. */
#include "calls.h"

/* Inputs of a call. */
struct call {
    struct bounds b;
    double dt, times; /* times: 1/dt; 0 without groups */
    const double *v;
    const size_t *group_of; /* [n] */
    int breaks;             /* limits are static */
    int estimates;          /* sums of R's rows times limits are numbers: they bound what friction can hold */
};

/* Sums of rows and limits up to this have numbers as products. */
#define ESTIMATED 1e150

/* 1 if forces up to limit cannot hold a contact at v, through a row of R with this sum. */
static inline int out_of_reach(double times, double v, double row_sum, double limit)
{
    return fabs(product(v, times)) > row_sum * limit;
}

TRIBO_SIMD static int any_within_reach(size_t n, double times, const double *restrict v, const double *restrict row_sum,
                                       double largest)
{
    int64_t any = 0; /* as wide as a double, for vectors */
    for (size_t i = 0; i < n; i++) {
        any |= out_of_reach(times, v[i], row_sum[i], largest) ? 0 : -1;
    }
    return any != 0;
}

/* Lists the groups with a contact that friction could hold, chunk by chunk: in a large scene most chunks have none. */
static void find_candidates(tribo_context *ctx, const struct call *c)
{
    const double *row_sum = ctx->op->row_sum, largest = ctx->follow.largest;
    for (size_t i = 0; i < ctx->n; i += TRIBO_CHUNK) {
        const size_t n = tribo_chunk_size(ctx, i);
        const int any = !c->estimates || (largest > 0.0 && any_within_reach(n, c->times, c->v + i, row_sum + i, largest));
        for (size_t j = i; any && j < i + n; j++) {
            if (!(c->estimates && out_of_reach(c->times, c->v[j], row_sum[j], largest))) {
                tribo_list_group(ctx, c->group_of[j]);
            }
        }
    }
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
        const double lo = tribo_lower(&c->b, i), hi = c->b.upper[i], pull = product(c->v[i], c->times);
        double reach = HUGE_VAL;
        if (!all && lo < hi) {
            tribo_row_dot(p, k, p->step, &reach);
        }
        if (lo < hi && !(fabs(pull) > reach)) {
            p->near[p->count++] = k;
            p->lo[k] = ctx->last.far ? tribo_cut(p, k, lo) : lo;
            p->hi[k] = ctx->last.far ? tribo_cut(p, k, hi) : hi;
            p->q[k] = pull;
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
    const struct call c = {b, dt, op->groups ? quotient(1.0, dt) : 0.0, v, group_of, breaks, estimates};
    struct memory *m = &ctx->memory;
    tribo_step_each(ctx, dt, v, b, NULL);
    for (size_t i = 0; breaks && i < ctx->n; i++) {
        const double hold = ctx->follow.hold[i], held = product(op->diagonal[i] * dt, hold), beyond = fabs(v[i]) - held;
        const int alone = !op->groups || op->group_of[i] == TRIBO_ALONE;
        if (alone && tribo_is_scalar(ctx, i) && fabs(ctx->last.f[i]) == hold && beyond > 0.0) {
            ctx->follow.now[i] = tribo_limit_at(ctx, i, beyond);
            ctx->last.f[i] = copysign(ctx->follow.now[i], -v[i]);
        }
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
        m->solved[g] = 0;
        status = status ? status : solve_for(ctx, g, &c, &m->solved[g]);
        if (m->solved[g]) {
            m->solved_list[m->nsolved++] = g;
        }
    }
    return status;
}

/* Finds last.f within bounds with v + dt R f = 0, or pushed against a bound; a status. known: see tribo_clusters_step. */
static int solve_step(tribo_context *ctx, double dt, const double *v, struct bounds b, const signed char *known)
{
    tribo_begin_call(ctx);
    ctx->last.holds = 1.0;
    int status = solve_boxes(ctx, dt, v, b, tribo_group_of(ctx));
    status = status ? status : tribo_clusters_step(ctx, dt, v, known);
    if (!status) {
        tribo_end_call(ctx, tribo_islands(ctx));
        ctx->last.slips = SLIPS_IN_FORCES;
    }
    return status;
}

/* Over a step a contact comes in sliding if its speed exceeds this part of what friction can stop: more than rounding, and so
 * little that stopping it is no load for other contacts. */
#define RESTS 1e-4

/* Sets limits over a step of dt: static, but those to slide of contacts that come in sliding at v [n], or NULL, and do not come
 * to a stop: f [n], or NULL, acts against v. Returns 0, and leaves all limits, if f acts against v at all that come in sliding.
 * Overwrites last.v. */
static int hold_for_step(tribo_context *ctx, double dt, const double *v, const double *f)
{
    double *limit = ctx->last.v; /* workspace */
    int changes = !f;
    for (size_t i = 0, directions; i < ctx->n; i += directions) {
        double stops = 0.0, power = f ? 0.0 : -1.0;
        directions = tribo_directions(ctx, i);
        for (size_t k = i; k < i + directions; k++) {
            stops = greater(stops, product(product(ctx->op->diagonal[k], dt), ctx->follow.hold[k]));
            power += f ? product(f[k], v[k]) : 0.0;
        }
        const double speed = v ? tribo_length((int)directions, v + i) : 0.0;
        const int comes_in = speed > RESTS * stops, slides = comes_in && power < 0.0;
        for (size_t k = i; k < i + directions; k++) {
            limit[k] = slides ? tribo_limit_at(ctx, k, speed) : ctx->follow.hold[k];
        }
        changes |= comes_in && !slides;
    }
    tribo_copy(ctx->follow.now, limit, changes ? ctx->n : 0);
    return changes;
}

/* The force of Coulomb's law at the end of a step. v [n]: velocities at the begin, or NULL; read where limits are static. */
static int step_at_end(tribo_context *ctx, double dt, const double *v, const double *vfree)
{
    const struct bounds b = {NULL, ctx->follow.contacts.limit};
    if (ctx->set.breaking) {
        hold_for_step(ctx, dt, v, NULL);
    }
    const int status = solve_step(ctx, dt, vfree, b, NULL);
    /* A contact that comes in sliding does so until it comes to a stop, and holds there if it can. */
    const int again = !status && ctx->set.breaking && v && hold_for_step(ctx, dt, v, ctx->last.f);
    return again ? solve_step(ctx, dt, vfree, b, NULL) : status;
}

/* Checks the arguments of a step; a status. */
static int step_check(tribo_context *ctx, double dt, const double *vfree, const double *f)
{
    int status = isfinite(dt) && dt > 0.0 ? TRIBO_OK : tribo_check_slowly(ctx, "dt", &dt, TRIBO_NUMBER, POSITIVE);
    status = status ? status : tribo_need_operator(ctx, ctx);
    status = status ? status : tribo_check_finite(ctx, "vfree", vfree, ctx->n);
    return status ? status : tribo_check_output(ctx, "f", f);
}

int tribo_step_force(tribo_context *ctx, double dt, const double *vfree, double *f)
{
    int status = ctx ? step_check(ctx, dt, vfree, f) : TRIBO_ERR_NULL;
    if (!status && tribo_all_alone(ctx)) {
        tribo_step_each(ctx, dt, vfree, (struct bounds){NULL, ctx->follow.contacts.limit}, f);
        tribo_end_alone(ctx, 1.0);
        return TRIBO_OK;
    }
    status = status ? status : step_at_end(ctx, dt, NULL, vfree);
    tribo_copy(f, status ? NULL : ctx->last.f, status ? 0 : ctx->n);
    return status;
}

/* ------------------------------------------------------------------------------------------------------- second order */

/* Finds the second problem of a step: *free [n] in the place of vfree, bounds, and in ctx->spare the directions [n] of slip at
 * the end, or 0. Returns the number of contacts that make it another problem than the first. */
static size_t find_reversals(tribo_context *ctx, double dt, const double *v, const double *vfree, const double **free,
                             struct bounds *b)
{
    double *lower = ctx->last.v, *upper = ctx->last.feq; /* before, upper: R f without the contact's own force */
    signed char *reverses = ctx->spare;
    for (size_t i = 0; i < ctx->n; i++) {
        upper[i] = 0.0;
        reverses[i] = 0;
    }
    for (size_t g = 0; g < ctx->op->groups; g++) {
        struct box_qp *p = tribo_problem(ctx, g);
        for (size_t k = 0; k < p->group->size; k++) {
            p->step[k] = tribo_carried(ctx, p, k);
        }
        for (size_t k = 0; k < p->group->size; k++) {
            upper[p->member[k]] = tribo_row_others(p, k, p->step);
        }
    }
    *free = vfree;
    *b = (struct bounds){lower, upper};
    size_t changes = tribo_clusters_turn(ctx, dt, v, free, upper, reverses);
    for (size_t i = 0; i < ctx->n; i++) {
        const double limit = ctx->set.limit[i], hold = product(ctx->op->diagonal[i], limit), forth = sign(v[i]);
        const double pull = quotient(0.5 * vfree[i] - 0.5 * v[i], 0.5 * dt), against = -forth * (pull + upper[i]);
        const int over = tribo_is_scalar(ctx, i) && limit > 0.0 && against > hold;
        const double stop = over ? quotient(fabs(v[i]), 0.5 * against + 0.5 * hold) : 0.0, part = quotient(stop, 2.0 * dt);
        const int back = over && part < 1.0;
        upper[i] = back ? forth * limit * (1.0 - 2.0 * part) : limit;
        lower[i] = back ? upper[i] : -limit;
        reverses[i] = (signed char)(back ? -forth : reverses[i]);
        changes += (size_t)back;
    }
    return changes;
}

int tribo_step_force_mean(tribo_context *ctx, double dt, const double *v, const double *vfree, double *f)
{
    int status = ctx ? step_check(ctx, dt, vfree, f) : TRIBO_ERR_NULL, changes = 0;
    status = status ? status : tribo_check_finite(ctx, "v", v, ctx->n);
    if (status) {
        return status;
    }
    status = step_at_end(ctx, dt, v, vfree);
    /* Another problem follows planar contacts, and contacts that came in sliding and do not go on that way. */
    const int plane = ctx->plane.count > 0;
    for (size_t i = 0; !status && !ctx->set.breaking && !changes && i < ctx->n; i++) {
        changes = plane || (v[i] != 0.0 && ctx->last.f[i] != sliding(v[i], ctx->set.limit[i]));
    }
    if (changes) {
        struct bounds b;
        const double *free;
        if (find_reversals(ctx, dt, v, vfree, &free, &b)) {
            status = solve_step(ctx, dt, free, b, ctx->spare);
        }
        if (!status) {
            /* Forces do not show the slip of contacts that reverse. */
            tribo_write_slips(ctx);
        }
        for (size_t i = 0; !status && i < ctx->n; i++) {
            ctx->last.slip[i] = ctx->spare[i] ? ctx->spare[i] : ctx->last.slip[i];
        }
    }
    tribo_copy(f, ctx->last.f, status ? 0 : ctx->n);
    return status;
}

/* ------------------------------------------------------------------------------------------------------------ the box */

int tribo_solve_box(tribo_context *ctx, const double *a, const double *lower, const double *upper, double *f)
{
    int status = ctx ? tribo_need_operator(ctx, ctx) : TRIBO_ERR_NULL;
    status = status ? status : tribo_check_finite(ctx, "a", a, ctx->n);
    status = status ? status : tribo_check_finite(ctx, "lower", lower, ctx->n);
    status = status ? status : tribo_check_finite(ctx, "upper", upper, ctx->n);
    double most = 0.0;
    for (size_t i = 0; !status && i < ctx->n; i++) {
        if (lower[i] > upper[i]) {
            return tribo_fail(ctx, TRIBO_ERR_RANGE, "lower[%zu] = %.15g is above upper[%zu] = %.15g", i, lower[i], i, upper[i]);
        }
        most = greater(most, greater(upper[i], -lower[i]));
    }
    status = status ? status : tribo_check_output(ctx, "f", f);
    if (status) {
        return status;
    }
    tribo_begin_call(ctx);
    ctx->last.far = most > TRIBO_ROOM * ctx->op->most;
    status = solve_boxes(ctx, 1.0, a, (struct bounds){lower, upper}, ctx->op->group_of);
    if (!status) {
        tribo_end_call(ctx, ctx->op->islands);
        tribo_copy(f, ctx->last.f, ctx->n);
    }
    return status;
}
