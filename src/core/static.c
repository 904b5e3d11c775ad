/* Static friction above kinetic: the limits by which contacts go are then found in every call, and stand in now.
 *
 * With a Stribeck velocity the limit is a continuous function N(|v|) of the speed, which takes the limit's place in every law.
 * Without one it drops at once. Then contacts near stick have the static limit, the others the kinetic one, and
 *
 *     repeat
 *         forces from the problem with bounds
 *         those near stick whose f_eq is beyond the static limit have the kinetic one from here on
 *     until there are none
 *
 * all of them together, so that the order of contacts does not matter. Limits only fall, so that this ends. A contact that has
 * broken away and that the others now hold rests with less than the kinetic limit, as it may. planar_static.c is this in the
 * plane. */
#include "context.h"

/* N(|v|), and its derivative by |v|. */
static double limit_at(const tribo_context *ctx, size_t i, double speed, double *rate)
{
    const double slide = ctx->follow.cut_limit[i], hold = ctx->follow.hold[i], scale = ctx->set.stribeck[i];
    if (ctx->set.breaking != FALLS) {
        *rate = 0.0;
        return slide;
    }
    const double more = (hold - slide) * exp(-quotient(speed, scale));
    *rate = quotient(-more, scale);
    return slide + more;
}

double tribo_limit_at(const tribo_context *ctx, size_t i, double speed)
{
    double ignored;
    return limit_at(ctx, i, speed, &ignored);
}

double tribo_limit_rate(const tribo_context *ctx, size_t i, double v)
{
    double rate = 0.0;
    if (ctx->set.breaking) {
        limit_at(ctx, i, fabs(v), &rate);
    }
    return copysign(1.0, v) * rate;
}

static int near_stick(const tribo_context *ctx, size_t i, double v)
{
    return fabs(v) <= (ctx->set.law->sticks_in_band ? ctx->follow.hold_width[i] : 0.0);
}

void tribo_find_limits(const tribo_context *ctx, size_t i, size_t n, const double *v, const double *feq, double *limit)
{
    for (size_t k = 0; k < n; k++) {
        const double hold = ctx->follow.hold[i + k];
        const int holds = ctx->set.breaking == DROPS && near_stick(ctx, i + k, v[k]) && !(feq && fabs(feq[k]) > hold);
        limit[k] = holds ? hold : tribo_limit_at(ctx, i + k, fabs(v[k]));
    }
}

/* Over a step a contact rests if its speed is this part of what friction can stop: more than rounding, and so little that what
 * it takes to stop it is no load for others. */
#define RESTS 1e-4

/* Whether contact i, of 1 or 2 directions, comes into a step with a velocity that counts. */
static int comes_sliding(const tribo_context *ctx, double dt, size_t i, size_t directions, const double *v)
{
    double stops = 0.0;
    for (size_t k = i; k < i + directions; k++) {
        stops = greater(stops, product(product(ctx->op->diagonal[k], dt), ctx->follow.hold[k]));
    }
    return tribo_length((int)directions, v + i) > RESTS * stops;
}

/* Whether f does not act against v. */
static int turns(size_t directions, const double *v, const double *f)
{
    double power = 0.0;
    for (size_t k = 0; k < directions; k++) {
        power += product(f[k], v[k]);
    }
    return !(power < 0.0);
}

static size_t directions_of(const tribo_context *ctx, size_t i)
{
    return ctx->planar && ctx->planar->role[i] == ROLE_FIRST ? 2 : 1;
}

int tribo_any_turns(const tribo_context *ctx, double dt, const double *v, const double *f)
{
    for (size_t i = 0, directions; i < ctx->n; i += directions) {
        directions = directions_of(ctx, i);
        if (comes_sliding(ctx, dt, i, directions, v) && turns(directions, v + i, f + i)) {
            return 1;
        }
    }
    return 0;
}

void tribo_hold_for_step(const tribo_context *ctx, double dt, const double *v, const double *f)
{
    tribo_copy(ctx->follow.now, ctx->follow.hold, ctx->n);
    for (size_t i = 0, directions; v && i < ctx->n; i += directions) {
        directions = directions_of(ctx, i);
        const int slides = comes_sliding(ctx, dt, i, directions, v) && !(f && turns(directions, v + i, f + i));
        const double speed = tribo_length((int)directions, v + i);
        for (size_t k = i; slides && k < i + directions; k++) {
            ctx->follow.now[k] = tribo_limit_at(ctx, k, speed);
        }
    }
}

void tribo_hold(const tribo_context *ctx, const struct box_qp *p)
{
    for (size_t e = 0; ctx->set.breaking == DROPS && e < p->count; e++) {
        const size_t i = p->member[p->near[e]];
        ctx->follow.now[i] = ctx->follow.hold[i];
    }
}

/* Whether the contact at place k is pulled at by more than its static limit, and rounding. */
static int breaks(const tribo_context *ctx, const struct box_qp *p, size_t k)
{
    const size_t i = p->member[k];
    const double hold = ctx->follow.hold[i], doubt = quotient(tribo_box_tolerance(p, k), ctx->op->diagonal[i]);
    return p->at[k] != FREE && ctx->follow.now[i] == hold && fabs(ctx->last.feq[i]) - hold > doubt + 4.0 * DBL_EPSILON * hold;
}

size_t tribo_break_away(tribo_context *ctx, const struct box_qp *p, double dt)
{
    size_t broken = 0;
    for (size_t e = 0; e < p->count; e++) {
        const size_t k = p->near[e], i = p->member[k];
        if (breaks(ctx, p, k)) {
            ctx->follow.now[i] = tribo_limit_at(ctx, i, product(dt, fabs(p->gradient[k])));
            broken += ctx->follow.now[i] < ctx->follow.hold[i];
        }
    }
    ctx->last.rank -= broken ? p->sets->rank : 0; /* they will be solved for once more */
    return broken;
}

void tribo_break_alone(tribo_context *ctx, double dt, const double *vfree)
{
    for (size_t i = 0; i < ctx->n; i++) {
        const double hold = ctx->follow.hold[i], held = product(ctx->op->diagonal[i] * dt, hold), beyond = fabs(vfree[i]) - held;
        const int alone = !ctx->op->groups || ctx->op->group_of[i] == TRIBO_ALONE;
        const int scalar = !ctx->planar || ctx->planar->role[i] == ROLE_SCALAR;
        if (alone && scalar && fabs(ctx->last.f[i]) == hold && beyond > 0.0) {
            ctx->follow.now[i] = tribo_limit_at(ctx, i, beyond);
            ctx->last.f[i] = copysign(ctx->follow.now[i], -vfree[i]);
        }
    }
}

/* What a law says of a given limit becomes what it says of the caller's, and of v on which that limit depends. */
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

void tribo_refresh_static(tribo_context *ctx)
{
    struct contacts *c = &ctx->follow.contacts;
    double *rate = ctx->follow.cut_factor;
    /* Limits to slide and to stick, as far as the solver tells them apart. */
    for (size_t i = 0; i < ctx->n; i++) {
        ctx->follow.cut_limit[i] = lesser(ctx->set.limit[i], TRIBO_FAR);
        ctx->follow.hold[i] = product(ctx->set.ratio[i], ctx->set.limit[i]);
    }
    for (size_t g = 0; g < ctx->op->groups; g++) {
        const struct box_qp *p = tribo_problem(ctx, g);
        for (size_t k = 0; k < p->group->size; k++) {
            const size_t i = p->member[k];
            ctx->follow.cut_limit[i] = lesser(ctx->follow.cut_limit[i], tribo_most(p, k));
            ctx->follow.hold[i] = lesser(ctx->follow.hold[i], tribo_most(p, k));
        }
    }
    for (size_t i = 0; i < ctx->n; i++) {
        const double hold = ctx->follow.hold[i];
        ctx->follow.hold_width[i] = c->follows ? greater(product(c->width[i], hold), DBL_MIN) : c->width[i];
        rate[i] = c->follows ? quotient(c->rate[i], greater(hold, DBL_MIN)) : c->rate[i];
        rate[i] = lesser(rate[i], 2.0 * TRIBO_FAR / greater(hold, 1.0));
    }
    tribo_copy(ctx->follow.now, ctx->follow.hold, ctx->n);
    const double *now = ctx->follow.now;
    *c = (struct contacts){now, now, ctx->follow.hold_width, rate, ctx->moving, 0, c->scales, 0};
    for (size_t i = 0; i < ctx->n; i++) {
        struct chunk *chunk = &ctx->follow.chunk[i / TRIBO_CHUNK];
        chunk->largest = i % TRIBO_CHUNK ? greater(chunk->largest, now[i]) : now[i];
    }
}

int tribo_refuse_static(tribo_context *ctx, const char *who)
{
    for (size_t i = 0; ctx->set.breaking && i < ctx->n; i++) {
        if (ctx->set.ratio[i] > 1.0) {
            return tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED, "%s static limits, and ratio[%zu] = %g", who, i, ctx->set.ratio[i]);
        }
    }
    return TRIBO_OK;
}

int tribo_check_one_ratio(tribo_context *ctx, const double *ratio, const double *velocity, size_t count, const size_t *first)
{
    for (size_t k = 0; k < count; k++) {
        const size_t i = first[k];
        if (ratio[i] < ratio[i + 1] || ratio[i] > ratio[i + 1]) {
            return tribo_fail(ctx, TRIBO_ERR_RANGE, "ratio[%zu] = %g and ratio[%zu] = %g are of one planar contact, and differ",
                              i, ratio[i], i + 1, ratio[i + 1]);
        }
        if (velocity && (velocity[i] < velocity[i + 1] || velocity[i] > velocity[i + 1])) {
            return tribo_fail(ctx, TRIBO_ERR_RANGE,
                              "velocity[%zu] = %g and velocity[%zu] = %g are of one planar contact, and differ", i, velocity[i],
                              i + 1, velocity[i + 1]);
        }
    }
    return TRIBO_OK;
}

int tribo_check_breaking(tribo_context *ctx, const struct law *law, int breaking, const double *ratio)
{
    for (size_t i = 0; breaking == DROPS && !law->uses_feq && i < ctx->n; i++) {
        if (ratio[i] > 1.0) {
            return tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED,
                              "ratio[%zu] = %g needs a velocity by which the limit falls: law %s has no stick", i, ratio[i],
                              law->name);
        }
    }
    return TRIBO_OK;
}
