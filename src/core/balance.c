/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces of contacts that share bodies: f_eq and f from z'' = R f + a.
 *
 * The consistent coupling is a box problem. With kappa = slope v inside the band of a law that relaxes, and 0 for the others, the
 * fixed point f_i = clamp(clamp(f_eq,i, -N, N) - kappa_i, -N, N) minimizes 1/2 f'Rf + (a + diag(R) kappa)'f over the contacts
 * near stick, where  kappa > 0: -N <= f <= max(-N, N - kappa);  kappa < 0: min(N, -N - kappa) <= f <= N.
 *
 * A call first finds forces of contacts as if each was alone, which is right for those in no group, and for open and sliding
 * ones; then it solves the groups with a contact near stick. */
#include "calls.h"
#include "own.h"

void tribo_begin_call(tribo_context *ctx)
{
    for (size_t k = 0; k < ctx->memory.nsolved; k++) {
        ctx->memory.solved[ctx->memory.solved_list[k]] = 0;
    }
    ctx->memory.nsolved = 0;
    ctx->last.clusters = 0;
    ctx->last.far = ctx->follow.largest > TRIBO_ROOM * ctx->op->most;
    ctx->last.rank = 0;
    ctx->last.residual = 0.0;
    ctx->last.slips = NO_SLIPS;
    ctx->last.linearized = 0;
}

void tribo_keep_forces(tribo_context *ctx)
{
    for (size_t g = 0; ctx->set.sharing == TRIBO_SHARE_PREVIOUS && g < ctx->op->groups; g++) {
        struct box_qp *p = tribo_problem(ctx, g);
        for (size_t k = 0; !ctx->memory.solved[g] && k < p->group->size; k++) {
            p->x[k] = tribo_carried(ctx, p, k);
            p->at[k] = p->at[k] == FREE ? FREE : AWAY;
        }
    }
}

void tribo_end_call(tribo_context *ctx, size_t islands)
{
    ctx->count.skipped += islands - ctx->memory.nsolved - ctx->last.clusters;
    tribo_keep_forces(ctx);
}

struct box_qp *tribo_collect(tribo_context *ctx, size_t g)
{
    struct box_qp *p = tribo_problem(ctx, g);
    const size_t *member = p->member;
    size_t behind = p->group->size;
    p->count = 0;
    p->far = ctx->last.far;
    for (size_t k = 0; k < p->group->size; k++) {
        if (ctx->last.near[member[k]]) {
            p->near[p->count++] = k;
        } else {
            p->near[--behind] = k;
            p->x[k] = tribo_carried(ctx, p, k);
        }
    }
    return p;
}

/* Returns the part of its limit by which the force at place k misses its balance, beyond an error of the gradient. */
static double missed_part(const tribo_context *ctx, const struct box_qp *p, size_t k, double error)
{
    const double beyond = fabs(p->gradient[k]) - TRIBO_SETTLED * greater(error, DBL_MIN),
                 sure = beyond < 0.0 ? 0.0 : copysign(beyond, p->gradient[k]);
    const double f = clamp(p->x[k], p->lo[k], p->hi[k]);
    const double to = clamp(p->x[k] - quotient(sure, ctx->op->diagonal[p->member[k]]), p->lo[k], p->hi[k]);
    return quotient(fabs(f - to), greater(greater(fabs(p->lo[k]), fabs(p->hi[k])), DBL_MIN));
}

int tribo_solve_group(tribo_context *ctx, struct box_qp *p)
{
    const struct group *g = p->group;
    const struct work before = p->work;
    for (size_t e = 0; g->nullity && e < p->count; e++) {
        const size_t k = p->near[e];
        p->rounding.unit[k] = ctx->op->diagonal[p->member[k]] * (0.5 * p->hi[k] - 0.5 * p->lo[k]);
    }
    ctx->count.solves++;
    const int small = g->small && !p->far && tribo_box_small(p);
    if (!small && !tribo_box_solve(p)) {
        return tribo_fail(ctx, TRIBO_ERR_NO_CONVERGENCE, "no stick set found for the %zu contact%s near stick around contact %zu",
                          p->count, plural(p->count), p->member[p->near[0]]);
    }
    if (g->nullity && ctx->set.sharing == TRIBO_SHARE_LEAST_NORM) {
        tribo_box_share(p);
    }
    ctx->count.reused += p->work.factorizations == before.factorizations && p->work.updates == before.updates;
    ctx->last.rank += p->sets->rank;
    /* Each contact is measured by its own limit and R_ii: heavy bodies count beside the accelerations of light ones. */
    for (size_t e = 0; !small && e < p->count; e++) {
        const size_t k = p->near[e];
        double missed = missed_part(ctx, p, k, p->noise[k]);
        missed = missed > TRIBO_MISSED ? missed_part(ctx, p, k, tribo_box_doubt(p, k)) : missed;
        ctx->last.residual = greater(ctx->last.residual, missed);
        if (!(missed <= TRIBO_MISSED)) {
            return tribo_fail(ctx, TRIBO_ERR_NO_CONVERGENCE,
                              "the forces found miss the balance of contact %zu by %g of its limit", p->member[k], missed);
        }
    }
    return TRIBO_OK;
}

/* Returns kappa of contact i near stick, f = f_eq - kappa within its bounds: the shift by the law of the caller, or slope v. */
static double shift_at(const tribo_context *ctx, const double *v, size_t i)
{
    const double slide = ctx->set.law->relaxes ? tribo_slope_of(&ctx->follow.contacts, i) * v[i] : 0.0;
    return tribo_is_own(ctx) ? tribo_own_at(ctx, SHIFT, i) : slide;
}

/* Solves for the contacts of a group near stick, again while static limits break; a status.
 * f_eq = f + kappa - (R f + a + diag(R) kappa)/R_ii. */
static int solve_consistent(tribo_context *ctx, struct box_qp *p, const double *v, const double *a)
{
    const struct contacts *c = &ctx->follow.contacts;
    const int own = tribo_is_own(ctx);
    int status;
    for (size_t e = 0; ctx->set.breaking == DROPS && e < p->count; e++) {
        ctx->follow.now[p->member[p->near[e]]] = ctx->follow.hold[p->member[p->near[e]]];
    }
    do {
        for (size_t e = 0; e < p->count; e++) {
            const size_t k = p->near[e], i = p->member[k];
            const double limit = c->bound[i], kappa = shift_at(ctx, v, i);
            p->lo[k] = own           ? clamp(tribo_own_at(ctx, LOWER, i), -limit, limit)
                       : kappa < 0.0 ? lesser(limit, -limit - kappa)
                                     : -limit;
            p->hi[k] = own           ? clamp(tribo_own_at(ctx, UPPER, i), -limit, limit)
                       : kappa > 0.0 ? greater(-limit, limit - kappa)
                                     : limit;
            p->q[k] = cut(a[i]) + (own ? product(ctx->op->diagonal[i], kappa) : ctx->op->diagonal[i] * kappa);
        }
        status = tribo_solve_group(ctx, p);
        for (size_t e = 0; !status && e < p->count; e++) {
            const size_t k = p->near[e], i = p->member[k];
            /* The gradient of a free contact is rounding, of which a large group would gather too much. */
            const double beyond = p->at[k] == FREE ? 0.0 : quotient(p->gradient[k], ctx->op->diagonal[i]);
            ctx->last.feq[i] = cut(p->x[k] + shift_at(ctx, v, i) - beyond);
        }
    } while (!status && ctx->set.breaking && tribo_break_away(ctx, p, 0.0));
    return status;
}

static int solve_partition(tribo_context *ctx, struct box_qp *p, const double *v, const double *a)
{
    const struct work before = p->work;
    for (size_t e = 0; e < p->count; e++) {
        const size_t k = p->near[e], i = p->member[k];
        p->q[k] = cut(a[i]);
        p->rounding.unit[k] = ctx->op->diagonal[i] * ctx->follow.contacts.bound[i];
    }
    ctx->count.solves++;
    int consistent = tribo_box_linear(p);
    ctx->count.reused += p->work.factorizations == before.factorizations && p->work.updates == before.updates;
    for (size_t e = 0; e < p->count; e++) {
        const size_t k = p->near[e], i = p->member[k];
        const double off = fabs(quotient(p->gradient[k], ctx->op->diagonal[i]));
        ctx->last.residual = greater(ctx->last.residual, quotient(off, greater(ctx->follow.contacts.limit[i], DBL_MIN)));
        p->hi[k] = ctx->follow.contacts.limit[i];
        p->lo[k] = -p->hi[k];
        consistent &= missed_part(ctx, p, k, p->noise[k]) <= TRIBO_MISSED;
        ctx->last.feq[i] = p->x[k];
        if (ctx->set.breaking) {
            tribo_find_limits(ctx, i, 1, v + i, ctx->last.feq + i, ctx->follow.now + i);
        }
    }
    ctx->last.rank += p->sets->rank;
    return consistent ? TRIBO_OK
                      : tribo_fail(ctx, TRIBO_ERR_INCONSISTENT,
                                   "no f_eq balances the %zu contact%s near stick around contact %zu: rank %zu, and a is outside "
                                   "its range",
                                   p->count, plural(p->count), p->member[p->near[0]], p->sets->rank);
}

/* Finds the forces of all contacts, and f_eq where laws read it; plain, wanted: see tribo_balance_each. */
static int balance_all(tribo_context *ctx, int plain, int wanted, const double *v, const double *a)
{
    int status = TRIBO_OK;
    tribo_begin_call(ctx);
    tribo_balance_each(ctx, plain, wanted, v, a);
    if (tribo_is_own(ctx) && tribo_own_failed(ctx, ctx->last.f)) {
        return tribo_own_fail(ctx, 0, v);
    }
    for (size_t k = 0; k < ctx->memory.nsolved; k++) {
        struct box_qp *p = tribo_collect(ctx, ctx->memory.solved_list[k]);
        const int one = ctx->set.coupling == TRIBO_PARTITION ? solve_partition(ctx, p, v, a) : solve_consistent(ctx, p, v, a);
        if (one == TRIBO_ERR_NO_CONVERGENCE) {
            return one;
        }
        status = one ? one : status;
        for (size_t e = 0; tribo_is_own(ctx) && e < p->count; e++) {
            const size_t i = p->member[p->near[e]];
            ctx->last.f[i] =
                clamp(ctx->last.feq[i] - tribo_own_at(ctx, SHIFT, i), tribo_own_at(ctx, LOWER, i), tribo_own_at(ctx, UPPER, i));
        }
        /* The law's forces of the contacts near stick, neighbours at once. */
        for (size_t e = 0, run; !tribo_is_own(ctx) && e < p->count; e += run) {
            const size_t i = p->member[p->near[e]];
            const struct contacts c = tribo_contacts_from(&ctx->follow.contacts, i);
            for (run = 1; e + run < p->count && p->member[p->near[e + run]] == i + run;) {
                run++;
            }
            ctx->set.law->force(&c, run, v + i, ctx->last.feq + i, ctx->last.f + i);
        }
    }
    return status ? status : tribo_clusters_balance(ctx, v, a);
}

int tribo_balance(tribo_context *ctx, const double *v, const double *a, double *feq, double *f)
{
    int plain, status = ctx ? tribo_need_operator(ctx, ctx) : TRIBO_ERR_NULL;
    status = status ? status : tribo_check_motion(ctx, v, a, &plain);
    if (status) {
        return status;
    }
    if (ctx->n == 1 && tribo_all_alone(ctx)) {
        return tribo_balance_one(ctx, plain, v, a, feq, f);
    }
    status = balance_all(ctx, plain, feq != NULL, v, a);
    if (status && status != TRIBO_ERR_INCONSISTENT) {
        return status;
    }
    tribo_end_call(ctx, tribo_islands(ctx));
    ctx->last.slips = tribo_is_own(ctx) ? SLIPS_WRITTEN : SLIPS_IN_FORCES;
    ctx->last.holds = ctx->set.law->holds;
    for (size_t i = 0; tribo_is_own(ctx) && !tribo_all_alone(ctx) && i < ctx->n; i += TRIBO_CHUNK) {
        tribo_own_slips(ctx, i, v + i, tribo_own_box(ctx, i));
    }
    /* f_eq of the contacts of groups that no solution has: all, or those that were not near stick; 0 for open ones. */
    for (size_t g = 0; feq && g < ctx->op->groups; g++) {
        struct box_qp *p = tribo_problem(ctx, g);
        const size_t size = p->group->size;
        for (size_t k = 0; k < size; k++) {
            p->step[k] = tribo_carried(ctx, p, k);
        }
        for (size_t k = 0; k < size; k++) {
            const size_t i = p->member[k];
            if (!(ctx->memory.solved[g] && ctx->last.near[i])) {
                const double balance = quotient(-(cut(a[i]) + tribo_row_others(p, k, p->step)), ctx->op->diagonal[i]);
                ctx->last.feq[i] = ctx->follow.contacts.limit[i] > 0.0 ? balance : 0.0;
            }
        }
    }
    for (size_t q = 0; feq && q < ctx->plane.clusters; q++) {
        tribo_cluster_feq(ctx, q);
    }
    tribo_copy(feq, ctx->last.feq, feq && feq != ctx->last.feq ? ctx->n : 0);
    tribo_copy(f, ctx->last.f, f ? ctx->n : 0);
    return status;
}
