/* Static friction above kinetic in the plane. Both limits of a planar contact are the same multiple of those by which it slides,
 * so that nothing but a factor changes as it breaks away: it holds while f_eq is within the ellipse of the static limits. Scalar
 * contacts of the same cluster go by the rule of static.c. */
#include <float.h>

#include "core/context.h"

void tribo_planar_limits(const tribo_context *ctx, size_t i, int holds, const double *v, double *limit)
{
    const double speed = tribo_length(2, v);
    for (size_t k = 0; k < 2; k++) {
        limit[k] = holds && ctx->set.breaking == DROPS ? ctx->follow.hold[i + k] : tribo_limit_at(ctx, i + k, speed);
    }
}

struct contacts tribo_planar_view(const tribo_context *ctx, size_t i, double *limit)
{
    struct contacts c = tribo_contacts_from(&ctx->follow.contacts, i);
    if (ctx->set.breaking) {
        tribo_copy(limit, ctx->follow.hold + i, 2);
        c.limit = c.bound = limit;
    }
    return c;
}

/* The planar contact that begins with direction i. */
static void hold_planar(tribo_context *ctx, size_t i, const double *v)
{
    double limit[2];
    const struct contacts c = tribo_planar_view(ctx, i, limit);
    const struct slide s = tribo_planar_slide(&c, 0, v);
    tribo_planar_limits(ctx, i, tribo_planar_near(ctx->set.law, &s), v, ctx->follow.now + i);
}

static void hold_scalar(tribo_context *ctx, size_t i, double v)
{
    ctx->follow.now[i] = ctx->follow.hold[i];
    if (ctx->set.breaking == FALLS || !tribo_scalar_near(ctx->set.law, &ctx->follow.contacts, i, v)) {
        ctx->follow.now[i] = tribo_limit_at(ctx, i, fabs(v));
    }
}

void tribo_planar_hold(tribo_context *ctx, const struct cluster *g, const double *v)
{
    const size_t *member = ctx->planar->member + g->member;
    for (size_t k = 0; k < g->size; k++) {
        const size_t i = member[k];
        if (ctx->planar->role[i] == ROLE_FIRST) {
            hold_planar(ctx, i, v + i);
        } else if (ctx->planar->role[i] == ROLE_SCALAR) {
            hold_scalar(ctx, i, v[i]);
        }
    }
}

/* Of redundant contacts nothing is known better than that, in parts of limits. */
#define DISAGREEMENT 1e-12

/* Whether the contact at e of the problem is pulled at by more than its limits, and rounding: f_eq is y + shift - block^-1
 * gradient there. */
static int pulled_beyond(const struct disc_qp *p, size_t e)
{
    const int plane = p->wide[e] == 2;
    const double *s = p->s + e * (p->size + 1), own[3] = {s[0], plane ? s[1] : 0.0, plane ? s[p->size + 1] : s[0]};
    const struct block b = tribo_block_of(own);
    double feq[2] = {p->gradient[e], plane ? p->gradient[e + 1] : 0.0};
    tribo_planar_push(&b, feq);
    for (size_t k = 0; k < p->wide[e]; k++) {
        feq[k] += p->y[e + k] + p->shift[e + k];
    }
    const double size = tribo_length(2, feq), noise = tribo_length(p->wide[e], p->noise + e);
    const double n[2] = {quotient(feq[0], greater(size, DBL_MIN)), quotient(feq[1], greater(size, DBL_MIN))};
    const double weak = b.small > 16.0 * DBL_EPSILON * b.great ? b.small : b.great;
    const double doubt = fabs(n[0] * b.e[0] + n[1] * b.e[1]) * quotient(noise, b.great) +
                         fabs(n[1] * b.e[0] - n[0] * b.e[1]) * quotient(noise, weak);
    return size - 1.0 > doubt + (p->factor.sets.dependents ? DISAGREEMENT : 8.0 * DBL_EPSILON);
}

/* The velocities that a step of dt leaves to the contacts of the cluster. */
static void find_ends(tribo_context *ctx, const struct cluster *g, double dt, const double *a)
{
    const size_t *member = ctx->planar->member + g->member;
    for (size_t k = 0; k < g->size; k++) {
        ctx->plane.v[member[k]] = product(tribo_planar_others(ctx, g, k, k, 0, a[member[k]]), dt);
    }
}

/* The limits by which the contact at i, of 1 or 2 directions, slides; returns whether they have fallen. */
static int planar_static_let_go(tribo_context *ctx, size_t i, size_t directions)
{
    const double speed = tribo_length((int)directions, ctx->plane.v + i);
    int fallen = 0;
    for (size_t k = i; k < i + directions; k++) {
        ctx->follow.now[k] = tribo_limit_at(ctx, k, speed);
        fallen |= ctx->follow.now[k] < ctx->follow.hold[k];
    }
    return fallen;
}

static int holds(const tribo_context *ctx, size_t i, size_t directions)
{
    size_t count = 0;
    for (size_t k = i; k < i + directions; k++) {
        count += ctx->follow.now[k] == ctx->follow.hold[k];
    }
    return count == directions;
}

size_t tribo_planar_break(tribo_context *ctx, const struct cluster *g, double dt, const double *a)
{
    const struct disc_qp *p = &ctx->plane.problem;
    const size_t *member = ctx->planar->member + g->member;
    size_t broken = 0;
    find_ends(ctx, g, dt, a);
    for (size_t e = 0; e < p->size; e += p->wide[e]) {
        const size_t k = member[ctx->plane.near[e]], i = k - (ctx->planar->role[k] == ROLE_SECOND);
        const size_t directions = ctx->planar->role[k] == ROLE_SCALAR ? 1 : 2;
        if (p->place[e] != LENS_INSIDE && holds(ctx, i, directions) && pulled_beyond(p, e)) {
            broken += (size_t)planar_static_let_go(ctx, i, directions);
        }
    }
    return broken;
}
