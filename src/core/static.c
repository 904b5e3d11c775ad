/* SPDX-License-Identifier: BSD-3-Clause */
/* Static friction above kinetic. Laws read the limits follow.now, which each call finds.
 *
 * With a Stribeck velocity the limit is a continuous function N(|v|) of the speed, in every law. Without one it drops at once.
 * Contacts near stick then have the static limit, the others the kinetic one, and
 *
 *     repeat
 *         forces of the box problem
 *         contacts near stick with |f_eq| above their static limit get the kinetic one
 *     until no limit changes
 *
 * All limits change together, so that the order of contacts has no effect. Limits only fall, so that the loop ends. A contact
 * that broke away, and is then held by others, rests with less than the kinetic limit. */

#include "calls.h"

/* The part of the limit that falls with speed. */
static double falling(const tribo_context *ctx, size_t i, double speed)
{
    const double all = ctx->follow.hold[i] - ctx->follow.cut_limit[i];
    return all * exp(-quotient(speed, ctx->set.stribeck[i]));
}

double tribo_limit_at(const tribo_context *ctx, size_t i, double speed)
{
    return ctx->follow.cut_limit[i] + (ctx->set.breaking == FALLS ? falling(ctx, i, speed) : 0.0);
}

double tribo_limit_rate(const tribo_context *ctx, size_t i, double v)
{
    return ctx->set.breaking == FALLS ? copysign(quotient(falling(ctx, i, fabs(v)), ctx->set.stribeck[i]), -v) : 0.0;
}

void tribo_find_limits(const tribo_context *ctx, size_t i, size_t n, const double *v, const double *feq, double *limit)
{
    for (size_t k = 0; k < n; k++) {
        const double hold = ctx->follow.hold[i + k], band = ctx->set.law->sticks_in_band ? ctx->follow.hold_width[i + k] : 0.0;
        const int holds = ctx->set.breaking == DROPS && fabs(v[k]) <= band && !(feq && fabs(feq[k]) > hold);
        limit[k] = holds ? hold : tribo_limit_at(ctx, i + k, fabs(v[k]));
    }
}

size_t tribo_break_away(tribo_context *ctx, struct box_qp *p, double dt)
{
    size_t broken = 0;
    tribo_box_gradients(p);
    for (size_t e = 0; e < p->count; e++) {
        const size_t k = p->near[e], i = p->member[k];
        const double hold = ctx->follow.hold[i], doubt = quotient(tribo_box_tolerance(p, k), ctx->op->diagonal[i]);
        const double beyond = fabs(ctx->last.feq[i]) - hold;
        if (p->at[k] != FREE && ctx->follow.now[i] == hold && beyond > doubt + 4.0 * DBL_EPSILON * hold) {
            ctx->follow.now[i] = tribo_limit_at(ctx, i, product(dt, fabs(p->gradient[k])));
            broken += ctx->follow.now[i] < hold;
        }
    }
    ctx->last.rank -= broken ? p->sets->rank : 0; /* the group will be solved again */
    return broken;
}

/* The law's derivatives are by the limit of this call, which depends on v and on the caller's limit. */
void tribo_law_tangents(const tribo_context *ctx, const struct contacts *c, size_t i, size_t n, const double *v,
                        const double *feq, const struct tangents *d)
{
    ctx->set.law->tangent(c, n, v, feq, d);
    for (size_t k = 0; ctx->set.breaking && k < n; k++) {
        struct contacts one = tribo_contacts_from(c, k);
        struct tangent fixed;
        double ignored;
        one.scales = 0;
        ctx->set.law->tangent(&one, 1, v + k, feq + k, &(struct tangents){&ignored, &fixed.dv, &fixed.dfeq, &fixed.dlimit});
        d->dv[k] += product(fixed.dlimit, tribo_limit_rate(ctx, i + k, v[k]));
        d->dlimit[k] *= one.bound[0] > 0.0 ? quotient(one.bound[0], ctx->follow.cut_limit[i + k]) : 1.0;
    }
}

/* ----------------------------------------------------------------------------------------------------------- settings */

int tribo_check_one_ratio(tribo_context *ctx, const double *ratio, const double *velocity, size_t count, const size_t *first)
{
    for (size_t k = 0; k < count; k++) {
        const size_t i = first[k], j = i + 1;
        const int same = ratio[i] >= ratio[j] && ratio[i] <= ratio[j];
        const double *x = same ? velocity : ratio;
        if (x && (x[i] < x[j] || x[i] > x[j])) {
            const char *name = same ? "velocity" : "ratio";
            return tribo_fail(ctx, TRIBO_ERR_RANGE, "%s[%zu] = %.15g and %s[%zu] = %.15g are of one planar contact, and differ",
                              name, i, x[i], name, j, x[j]);
        }
    }
    return TRIBO_OK;
}

int tribo_check_breaking(tribo_context *ctx, const struct law *law, int breaking, const double *ratio)
{
    if (breaking && law == &tribo_law_own) {
        return tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED, "laws of the caller know no static limits: let the law make its own");
    }
    for (size_t i = 0; breaking == DROPS && !law->uses_feq && i < ctx->n; i++) {
        if (ratio[i] > 1.0) {
            return tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED,
                              "ratio[%zu] = %g needs a velocity by which the limit falls: law %s has no stick", i, ratio[i],
                              law->name);
        }
    }
    return TRIBO_OK;
}

int tribo_set_static(tribo_context *ctx, const double *ratio, const double *velocity)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    int above = 0, status = ratio ? tribo_check_finite(ctx, "ratio", ratio, ctx->n) : TRIBO_OK;
    status = status || !velocity ? status : tribo_check_slowly(ctx, "velocity", velocity, ctx->n, POSITIVE);
    for (size_t i = 0; !status && ratio && i < ctx->n; i++) {
        if (ratio[i] < 1.0) {
            return tribo_fail(ctx, TRIBO_ERR_RANGE, "ratio[%zu] = %.15g is below 1", i, ratio[i]);
        }
        above |= ratio[i] > 1.0;
    }
    const int breaking = !above ? NEVER : velocity ? FALLS : DROPS;
    status = status ? status : tribo_check_breaking(ctx, ctx->set.law, breaking, ratio);
    if (!status && breaking) {
        status = tribo_check_one_ratio(ctx, ratio, velocity, ctx->plane.count, ctx->plane.first);
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
    tribo_take_limits(ctx, ctx->set.limit);
    return TRIBO_OK;
}

int tribo_get_static(const tribo_context *ctx, double *ratio, double *velocity)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    tribo_copy(ratio, ctx->set.ratio, ratio ? ctx->n : 0);
    tribo_copy(velocity, ctx->set.stribeck, velocity ? ctx->n : 0);
    return TRIBO_OK;
}
