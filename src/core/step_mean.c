/* The force over a step to second order. Coulomb's law at the end of a step, which tribo_step_force gives, has two faults of
 * first order: a planar contact that turns slides in the direction of the end, and a scalar one that is driven through v = 0
 * stops there until the step is over.
 *
 *     solve at the end of the step: which contacts stick, and what the others feel
 *     planar contacts that slide: in the direction of v + v_end, which is the same problem with v + vfree in the place of vfree
 *     scalar ones that are driven through zero: their limit one way until then, and the other way after
 *     solve again, if there are any
 *
 * A contact is driven through zero if what it feels there is more than its limit can hold. */
#include "check.h"

struct step {
    double dt;
    const double *v, *vfree;
    signed char *reverses; /* [n] direction of slip at the end, or 0 */
    double *lower, *upper; /* [n] of the second problem */
    double *free;          /* [n] the same, if there are planar contacts */
    size_t changes;
};

/* feels: R f without the contact's own force. */
static void look_at_scalar(tribo_context *ctx, struct step *s, size_t i, double feels)
{
    const double limit = ctx->set.limit[i], hold = product(ctx->op->diagonal[i], limit), forth = sign(s->v[i]);
    const double free = quotient(0.5 * s->vfree[i] - 0.5 * s->v[i], 0.5 * s->dt), against = -forth * (free + feels);
    if (!(limit > 0.0) || !(against > hold)) {
        return;
    }
    const double part = quotient(quotient(fabs(s->v[i]), 0.5 * against + 0.5 * hold), 2.0 * s->dt);
    if (part < 1.0) {
        s->lower[i] = s->upper[i] = forth * limit * (1.0 - 2.0 * part);
        s->reverses[i] = (signed char)-forth;
        s->changes++;
    }
}

static void look_at_clusters(tribo_context *ctx, struct step *s)
{
    const struct planar *c = ctx->planar;
    for (size_t q = 0; q < c->clusters; q++) {
        const struct cluster *g = &c->cluster[q];
        for (size_t k = 0; k < g->size; k++) {
            const size_t i = c->member[g->member + k];
            if (c->role[i] == ROLE_SCALAR) {
                look_at_scalar(ctx, s, i, tribo_planar_feels(ctx, g, k, 0));
            }
        }
    }
    for (size_t k = 0; k < c->count; k++) {
        const size_t i = c->first[k];
        if (tribo_planar_slip(ctx, k) == TRIBO_SLIP_PLANE) {
            s->reverses[i] = s->reverses[i + 1] = TRIBO_SLIP_PLANE;
        }
    }
    for (size_t q = 0; q < c->clusters; q++) {
        const struct cluster *g = &c->cluster[q];
        for (size_t k = 0; k < g->size; k++) {
            const size_t i = c->member[g->member + k];
            if (c->role[i] == ROLE_FIRST && s->reverses[i]) {
                /* Planar contact at place k of a cluster: one that turns back within the step keeps the direction of its end. */
                double forward = 0.0;
                for (size_t d = 0; d < 2; d++) {
                    const double end = s->vfree[i + d] + product(tribo_planar_feels(ctx, g, k + d, 1), s->dt);
                    forward += product(end, s->v[i + d]);
                }
                for (size_t d = 0; forward > 0.0 && d < 2; d++) {
                    s->free[i + d] = s->v[i + d] + s->vfree[i + d];
                }
                s->changes += forward > 0.0;
            }
        }
    }
}

/* Whether a contact that came in sliding does not go on that way. */
TRIBO_SIMD static int any_slip_ends(size_t n, const double *restrict v, const double *restrict f, const double *restrict limit)
{
    int64_t any = 0; /* as wide as what is compared */
    for (size_t i = 0; i < n; i++) {
        any |= ((v[i] != 0.0) & (f[i] != sliding(v[i], limit[i]))) ? -1 : 0;
    }
    return any != 0;
}

/* Forces do not tell the slip of contacts that reverse. */
static void step_mean_write_slips(tribo_context *ctx, const struct step *s)
{
    tribo_write_slips(ctx);
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->last.did.of[i] = s->reverses[i] ? s->reverses[i] : ctx->last.did.of[i];
    }
}

static int solve_both(tribo_context *ctx, struct step *s, double *f)
{
    int status = tribo_solve_step(ctx, s->dt, s->vfree, (struct bounds){NULL, ctx->set.limit}, NULL, s->lower);
    if (status) {
        return status;
    }
    ctx->last.holds = 1.0;
    if (ctx->planar || any_slip_ends(ctx->n, s->v, ctx->last.f, ctx->set.limit)) {
        for (size_t i = 0; i < ctx->n; i++) {
            s->upper[i] = ctx->set.limit[i];
            s->lower[i] = -s->upper[i];
            s->reverses[i] = 0;
            if (!(ctx->op->groups && ctx->op->group_of[i] != TRIBO_ALONE) &&
                !(ctx->planar && ctx->planar->role[i] != ROLE_SCALAR)) {
                look_at_scalar(ctx, s, i, 0.0);
            }
        }
        for (size_t g = 0; g < ctx->op->groups; g++) {
            if (ctx->group_of[ctx->op->member[ctx->op->group[g].first]] != TRIBO_ALONE) {
                struct box_qp *p = tribo_problem(ctx, g);
                const size_t size = p->group->size;
                for (size_t k = 0; k < size; k++) {
                    p->step[k] = tribo_carried(ctx, p, k);
                }
                for (size_t k = 0; k < size; k++) {
                    look_at_scalar(ctx, s, p->member[k], tribo_row_others(p, k, p->step));
                }
            }
        }
        if (ctx->planar) {
            tribo_copy(s->free, s->vfree, ctx->n);
            look_at_clusters(ctx, s);
        }
    }
    if (!s->changes) {
        tribo_copy(f, ctx->last.f, ctx->n);
    } else {
        tribo_begin_call(ctx);
        status =
            tribo_solve_step(ctx, s->dt, ctx->planar ? s->free : s->vfree, (struct bounds){s->lower, s->upper}, s->reverses, f);
    }
    return status;
}

int tribo_step_force_mean(tribo_context *ctx, double dt, const double *v, const double *vfree, double *f)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    int status = tribo_check_step(ctx, dt, vfree, f);
    status = status ? status : tribo_check_finite(ctx, "v", v, ctx->n);
    if (status || ctx->set.breaking) {
        return status ? status : tribo_step_at_end(ctx, dt, v, vfree, f);
    }
    struct step s = {dt, v, vfree, ctx->spare.of, ctx->last.v, ctx->last.feq, ctx->plane.v, 0};
    tribo_begin_call(ctx);
    status = solve_both(ctx, &s, f);
    if (!status) {
        ctx->last.slips = SLIPS_IN_FORCES;
    }
    if (!status && (s.changes || ctx->planar)) {
        step_mean_write_slips(ctx, &s);
    }
    return status;
}
