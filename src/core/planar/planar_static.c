/* Static friction above kinetic in the plane. Both static limits of a planar contact are the same multiple of those by which it
 * slides, so that only a factor changes as it breaks away: it holds while f_eq is within the ellipse of the static limits. Scalar
 * contacts of a cluster follow the rule of static.c. */
#include "core/static.h"
#include "parts.h"

void tribo_planar_limits(const tribo_context *ctx, size_t i, size_t directions, int holds, const double *v, double *limit)
{
    const double speed = tribo_length((int)directions, v);
    for (size_t k = 0; k < directions; k++) {
        limit[k] = holds && ctx->set.breaking == DROPS ? ctx->follow.hold[i + k] : tribo_limit_at(ctx, i + k, speed);
    }
}

struct contacts tribo_planar_view(const tribo_context *ctx, size_t i, size_t directions, double *limit)
{
    struct contacts c = tribo_contacts_from(&ctx->follow.contacts, i);
    if (ctx->set.breaking) {
        tribo_copy(limit, ctx->follow.hold + i, directions);
        c.limit = c.bound = limit;
    }
    return c;
}

void tribo_planar_hold(tribo_context *ctx, const struct cluster *g, const double *v)
{
    for (size_t k = 0, directions; k < g->size; k += directions) {
        const size_t i = g->member[k];
        double limit[2];
        directions = tribo_directions(ctx, i);
        const struct contacts c = tribo_planar_view(ctx, i, directions, limit);
        const struct slide s = tribo_planar_slide(&c, 0, directions, v + i);
        tribo_planar_limits(ctx, i, directions, tribo_planar_near(ctx->set.law, &s), v + i, ctx->follow.now + i);
    }
}

/* The forces of redundant contacts are known to this part of their limits. */
#define DISAGREEMENT 1e-12

/* 1 if |f_eq| of the contact at e of the problem exceeds its limits by more than rounding; f_eq = y + shift - block^-1
 * gradient. */
static int is_pulled_beyond(const struct disc_qp *p, size_t e)
{
    const struct block b = tribo_block_at(p->s, p->size, e, p->wide[e]);
    double feq[2] = {p->gradient[e], p->wide[e] == 2 ? p->gradient[e + 1] : 0.0};
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

size_t tribo_planar_break(tribo_context *ctx, const struct cluster *g, double dt, const double *a)
{
    const struct disc_qp *p = &ctx->plane.problem;
    const size_t *member = g->member;
    double *now = ctx->follow.now, *end = ctx->plane.v; /* velocities at the end */
    size_t broken = 0;
    for (size_t k = 0; k < g->size; k++) {
        end[member[k]] = product(tribo_planar_others(ctx, g, k, k, 0, a[member[k]]), dt);
    }
    for (size_t e = 0; e < p->size; e += p->wide[e]) {
        const size_t k = member[ctx->plane.near[e]], first = k - (ctx->planar->role[k] == ROLE_SECOND);
        const size_t directions = tribo_directions(ctx, first);
        int holds = 1, falls = 0;
        for (size_t i = first; i < first + directions; i++) {
            holds &= now[i] == ctx->follow.hold[i];
        }
        if (p->place[e] != LENS_INSIDE && holds && is_pulled_beyond(p, e)) {
            const double speed = tribo_length((int)directions, end + first);
            for (size_t i = first; i < first + directions; i++) {
                now[i] = tribo_limit_at(ctx, i, speed);
                falls |= now[i] < ctx->follow.hold[i];
            }
            broken += (size_t)falls;
        }
    }
    return broken;
}
