/* SPDX-License-Identifier: BSD-3-Clause */
/* The force over a step to second order. Coulomb's law at the end of a step, as tribo_step_force gives it, has two errors of
 * first order: a planar contact that turns slides in the direction of the end, and a scalar one that is driven through v = 0
 * stops there until the step is over.
 *
 *     solve at the end of the step: which contacts stick, and R f
 *     planar contacts that slide: in the direction of v + v_end, which is the same problem with v + vfree in the place of vfree
 *     scalar ones that are driven through zero: their limit one way until then, and the other way after
 *     solve again, if there are any
 *
 * A contact is driven through zero if the acceleration at v = 0 without its own force exceeds what its limit can hold. */
#include "check.h"
#include "clusters.h"

struct step {
    double dt;
    const double *v, *vfree;
    const double *free;    /* [n] vfree of the second problem */
    signed char *reverses; /* [n] direction of slip at the end, or 0 */
    double *lower, *upper; /* [n] bounds of the second problem; before, upper: R f without the contact's own force */
    size_t changes;
};

/* Finds the second problem. */
static void look_at_all(tribo_context *ctx, struct step *s)
{
    for (size_t i = 0; i < ctx->n; i++) {
        s->upper[i] = 0.0;
        s->reverses[i] = 0;
    }
    for (size_t g = 0; g < ctx->op->groups; g++) {
        struct box_qp *p = tribo_problem(ctx, g);
        for (size_t k = 0; k < p->group->size; k++) {
            p->step[k] = tribo_carried(ctx, p, k);
        }
        for (size_t k = 0; k < p->group->size; k++) {
            s->upper[p->member[k]] = tribo_row_others(p, k, p->step);
        }
    }
    s->changes = tribo_clusters_turn(ctx, s->dt, s->v, &s->free, s->upper, s->reverses);
    for (size_t i = 0; i < ctx->n; i++) {
        const double limit = ctx->set.limit[i], hold = product(ctx->op->diagonal[i], limit), forth = sign(s->v[i]);
        const double free = quotient(0.5 * s->vfree[i] - 0.5 * s->v[i], 0.5 * s->dt), against = -forth * (free + s->upper[i]);
        const int over = tribo_is_scalar(ctx, i) && limit > 0.0 && against > hold;
        const double stop = over ? quotient(fabs(s->v[i]), 0.5 * against + 0.5 * hold) : 0.0, part = quotient(stop, 2.0 * s->dt);
        const int back = over && part < 1.0;
        s->upper[i] = back ? forth * limit * (1.0 - 2.0 * part) : limit;
        s->lower[i] = back ? s->upper[i] : -limit;
        s->reverses[i] = (signed char)(back ? -forth : s->reverses[i]);
        s->changes += (size_t)back;
    }
}

/* 1 if a contact that came in sliding does not go on that way. */
TRIBO_SIMD static int any_slip_ends(size_t n, const double *restrict v, const double *restrict f, const double *restrict limit)
{
    int64_t any = 0; /* as wide as a double, for vectors */
    for (size_t i = 0; i < n; i++) {
        any |= ((v[i] != 0.0) & (f[i] != sliding(v[i], limit[i]))) ? -1 : 0;
    }
    return any != 0;
}

int tribo_step_force_mean(tribo_context *ctx, double dt, const double *v, const double *vfree, double *f)
{
    int status = ctx ? tribo_check_step(ctx, dt, vfree, f) : TRIBO_ERR_NULL;
    status = status ? status : tribo_check_finite(ctx, "v", v, ctx->n);
    if (status || ctx->set.breaking) {
        return status ? status : tribo_step_at_end(ctx, dt, v, vfree, f);
    }
    const int plane = tribo_plane_count(ctx) > 0;
    struct step s = {dt, v, vfree, vfree, ctx->spare, ctx->last.v, ctx->last.feq, 0};
    status = tribo_solve_step(ctx, dt, vfree, (struct bounds){NULL, ctx->set.limit}, NULL);
    if (status) {
        return status;
    }
    if (plane || any_slip_ends(ctx->n, v, ctx->last.f, ctx->set.limit)) {
        look_at_all(ctx, &s);
    }
    if (s.changes) {
        status = tribo_solve_step(ctx, dt, s.free, (struct bounds){s.lower, s.upper}, s.reverses);
    }
    if (status) {
        return status;
    }
    tribo_copy(f, ctx->last.f, ctx->n);
    ctx->last.slips = SLIPS_IN_FORCES;
    if (s.changes || plane) {
        /* Forces do not show the slip of contacts that reverse. */
        tribo_write_slips(ctx);
        for (size_t i = 0; i < ctx->n; i++) {
            ctx->last.slip[i] = s.reverses[i] ? s.reverses[i] : ctx->last.slip[i];
        }
    }
    return TRIBO_OK;
}
