/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives of the forces of a cluster by velocities, accelerations and limits: the contacts near stick stay in their places,
 * and Newton's equations along the freedoms that these leave keep them balanced. Forces and derivatives of planar contacts with
 * f_eq given, each of which is a problem alone. */
#include "core/calls.h"

/* Changes of one contact; x: of part v of a slide; epsilon: d(epsilon)/epsilon. */
struct turn {
    double v[2], limit[2], x[2], epsilon;
};

/* Of the contact at i, at v: adds to t->limit the changes of static limits with |v|, and sets t->x. At rest, where |v| has a
 * kink, it grows along `along`, the direction in which the contact begins to slide, or 0. */
static void turn_slide(const tribo_context *ctx, size_t i, const struct slide *s, const double *limit, const double *v,
                       const double *along, struct turn *t)
{
    const int directions = (int)s->directions;
    const double speed = tribo_length(directions, v), *way = speed > 0.0 ? v : along, length = tribo_length(directions, way);
    double faster = 0.0;
    for (size_t k = 0; k < s->directions; k++) {
        faster += (length > 0.0 ? way[k] / length : 0.0) * t->v[k];
    }
    for (size_t k = 0; k < s->directions; k++) {
        t->limit[k] += product(tribo_limit_rate(ctx, i + k, speed), faster);
    }
    for (size_t k = 0; k < s->directions; k++) {
        const double wider = t->limit[k] - product(s->part[k], t->limit[s->far]);
        const double part = s->open || k == s->far ? 0.0 : quotient(wider, limit[s->far]);
        t->x[k] = product(s->part[k], t->v[k]) + product(part, v[k]);
    }
}

/* df [directions] of a contact that is not near stick. */
static void turn_force(const struct law *law, const struct slide *s, const double *limit, const struct turn *t, double *df)
{
    double slope;
    const double *dx = t->x, carried = tribo_planar_carried(law, s->speed, &slope);
    const double along = s->n[0] * dx[0] + s->n[1] * dx[1];
    for (size_t k = 0; k < s->directions; k++) {
        const double turn = s->length > 0.0 ? carried * quotient(dx[k] - s->n[k] * along, s->length) : 0.0;
        const double faster = quotient(s->length > 0.0 ? s->n[k] * along : dx[k], s->epsilon);
        const double grow = slope * (faster - product(product(s->speed, t->epsilon), s->n[k]));
        const double own = product(carried * s->n[k], t->limit[k]);
        df[k] = s->open ? 0.0 : product(limit[k], turn + grow) + own;
    }
}

/* Derivatives of shifts are cut to this. */
#define STEEPEST 1e150

/* Returns the change of direction k of a shift, which is part of those in parts of limits. */
static double turn_shift(const struct law *law, const struct slide *s, const struct turn *t, size_t k, double part, double shift)
{
    const double change = law->relaxes ? 2.0 * quotient(t->x[k], s->epsilon) : 0.0;
    return clamp(product(part, change) - product(shift, t->epsilon), -STEEPEST, STEEPEST);
}

/* move [size] = the change of y by growth, d(limit)/limit, by dshift, and by rhs, the change of pull with limits and shifts
 * fixed. Overwrites rhs. directions: see tribo_planar_turn. */
static void planar_follow(struct disc_qp *p, const unsigned char *directions, const double *growth, const double *dshift,
                          double *rhs, double *move)
{
    double *turn = p->slide, *dy = p->best; /* dy: the part of the change of y that follows shifts */
    for (size_t e = 0; e < p->size; e += p->wide[e]) {
        tribo_disc_drag(p, e, dshift + e, dy + e);
    }
    for (size_t e = 0; e < p->size; e++) {
        rhs[e] += product(growth[e], p->gradient[e]);
        turn[e] = dshift[e] + product(p->shift[e], growth[e]);
    }
    for (size_t e = 0; e < p->size; e += p->wide[e]) {
        tribo_disc_add(p, e, dy, rhs + e);
    }
    tribo_planar_turn(p, directions, turn, rhs);
    tribo_disc_follow(p, rhs, move);
    for (size_t e = 0; e < p->size; e++) {
        move[e] += dy[e];
    }
}

/* df [size] of the contacts of a cluster that are not near stick; of those in the problem, the part of df that follows limits;
 * dshift and growth, the changes of their shifts and of their limits, which may fall with speed, in parts of limits. */
static void own_changes(const tribo_context *ctx, const struct cluster *g, const struct change *d, double *df, double *dshift,
                        double *growth)
{
    const struct contacts *c = &ctx->follow.contacts;
    const struct disc_qp *p = &ctx->plane.problem;
    const size_t *near = ctx->plane.near;
    for (size_t k = 0, e = 0, behind = 0, directions; k < g->size; k += directions) {
        const size_t i = g->member[k];
        const struct slide s = tribo_planar_slide(ctx, i, ctx->last.v + i);
        struct turn t = {{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}, 0.0};
        double along[2] = {0.0, 0.0};
        directions = s.directions;
        for (; behind < p->size && near[behind] < k + directions; behind++) {
            const int slips = p->place[behind - (p->wide[behind] == 0)] == LENS_ON_DISC;
            const size_t j = near[behind] - k;
            along[j] = slips ? quotient(p->gradient[behind], tribo_plane_reach(ctx, i + j)) : 0.0;
        }
        for (size_t j = 0; j < directions; j++) {
            t.v[j] = tribo_entry(d->v, i + j);
            t.limit[j] = tribo_limit_change(ctx, d, i + j);
        }
        t.epsilon = s.open || !c->follows ? 0.0 : quotient(t.limit[s.far], c->limit[i + s.far]);
        turn_slide(ctx, i, &s, c->limit + i, ctx->last.v + i, along, &t);
        turn_force(ctx->set.law, &s, c->limit + i, &t, df + k);
        for (; e < behind; e++) {
            const size_t j = near[e] - k;
            const int far = tribo_plane_cut(ctx, i + j);
            const double part = far ? quotient(c->bound[i + j], ctx->plane.radius[i + j]) : 1.0;
            dshift[e] = turn_shift(ctx->set.law, &s, &t, j, part, p->shift[e]);
            growth[e] = quotient(t.limit[j], c->limit[i + j]);
            df[k + j] = far ? 0.0 : product(p->y[e], t.limit[j]);
        }
    }
}

/* Returns sum_j r_kj x_j without j = other. */
static double cluster_row_product(const struct csr *r, size_t k, const double *x, size_t other)
{
    double sum = 0.0;
    for (size_t e = r->first[k]; e < r->first[k + 1]; e++) {
        sum += r->col[e] == other ? 0.0 : product(r->val[e], x[r->col[e]]);
    }
    return sum;
}

double tribo_cluster_others(const tribo_context *ctx, size_t q, size_t k, const double *df)
{
    return cluster_row_product(&ctx->plane.cluster[q].r, k, df, k);
}

void tribo_cluster_product(tribo_context *ctx, size_t q, const struct change *d, double *df)
{
    const struct clusters *c = &ctx->plane;
    struct disc_qp *p = &ctx->plane.problem;
    const struct cluster *g = &c->cluster[q];
    double *dshift = p->from, *rhs = p->noise, *move = p->aim;
    own_changes(ctx, g, d, df, dshift, c->growth);
    for (size_t e = 0; e < p->size; e++) {
        const double sum = cut(tribo_entry(d->a, c->contact[e])) + cluster_row_product(&g->r, c->near[e], df, SIZE_MAX);
        rhs[e] = p->weight[e] * quotient(quotient(cut(sum), c->unit_r), c->unit_force);
    }
    if (p->size) {
        planar_follow(p, c->directions, c->growth, dshift, rhs, move);
    }
    for (size_t e = 0; e < p->size; e++) {
        df[c->near[e]] += product(tribo_plane_reach(ctx, c->contact[e]), move[e]);
    }
}

/* ------------------------------------------------------------------------------------------------ f_eq that is given */

/* Planar contact k with f_eq given. */
struct given {
    size_t i; /* first direction */
    double limit[2];
    struct contacts c; /* of its two directions */
    struct slide s;
    int near;
    struct disc_alone x; /* its problem, near stick */
};

/* y [2] = f_eq in parts of limits. Returns |y|. */
static double feq_parts(const double *limit, const double *feq, double *y)
{
    for (int d = 0; d < 2; d++) {
        y[d] = limit[d] > 0.0 ? quotient(cut(feq[d]), limit[d]) : 0.0;
    }
    return tribo_length(2, y);
}

/* Near stick: y of the problem = the point of the lens nearest to feq - kappa in the norm of the contact's block, own [2][2], in
 * parts of limits. Returns 1, or 0 without convergence. */
static int given_near(const struct law *law, struct given *g, const double *own, const double *feq)
{
    const double *bound = g->c.bound, force = greater(bound[0], bound[1]), r = greater(own[0], own[3]);
    const double turn = law->relaxes ? 2.0 * g->s.speed : 0.0, shift[2] = {turn * g->s.n[0], turn * g->s.n[1]};
    double aim[2], m[4], pull[2];
    const double length = feq_parts(bound, feq, aim);
    for (int k = 0; k < 4; k++) {
        const double part = k == 1 || k == 2 ? own[k] / r : greater(own[k] / r, NEXT_TO_IMMOVABLE);
        m[k] = bound[k / 2] / force * (bound[k % 2] / force) * part;
    }
    for (int d = 0; d < 2; d++) {
        aim[d] = (length > HARDEST ? aim[d] / length * HARDEST : aim[d]) - shift[d];
    }
    for (int d = 0; d < 2; d++) {
        pull[d] = -(m[2 * d] * aim[0] + m[2 * d + 1] * aim[1]);
    }
    tribo_disc_alone(&g->x, m, pull, shift);
    memcpy(g->x.p.y, aim, sizeof aim);
    return tribo_disc_solve(&g->x.p);
}

int tribo_plane_reads_feq(const tribo_context *ctx, size_t i, const double *v)
{
    const size_t first = tribo_first_direction(ctx, i);
    const struct slide s = tribo_planar_slide(ctx, first, v + first);
    return tribo_planar_near(ctx->set.law, &s);
}

/* Sets the derivatives out [3] by v, f_eq and the limits of the caller, [n][2] each, or NULL, of a contact at v [2]; static
 * limits follow |v|, too. */
static void given_columns(const tribo_context *ctx, struct given *g, const double *v, double *const *out)
{
    static const unsigned char both[2] = {2, 0};
    const struct law *law = ctx->set.law;
    const double *bound = g->c.bound, *set = ctx->set.breaking ? ctx->follow.cut_limit + g->i : g->c.limit;
    struct disc_qp *p = &g->x.p;
    double along[2] = {0.0, 0.0};
    if (g->near) {
        tribo_disc_gradients(p);
        tribo_disc_places(p);
        tribo_disc_linearize(p);
    }
    for (size_t d = 0; g->near && p->place[0] == LENS_ON_DISC && d < 2; d++) {
        along[d] = bound[d] > 0.0 ? quotient(p->gradient[d], bound[d]) : 0.0;
    }
    for (size_t column = 0; column < 6; column++) {
        double unit[6] = {0.0}, df[2];
        unit[column] = column < 4 || ctx->set.limit[g->i + column - 4] > 0.0;
        struct turn t = {{unit[0], unit[1]}, {unit[4], unit[5]}, {0.0, 0.0}, 0.0};
        t.epsilon = g->c.scales && !g->s.open ? quotient(t.limit[g->s.far], set[g->s.far]) : 0.0;
        for (size_t d = 0; d < 2 && ctx->set.breaking; d++) {
            const double part = set[d] > 0.0 ? quotient(g->c.limit[d], set[d]) : 0.0;
            t.limit[d] = product(part, t.limit[d]);
        }
        turn_slide(ctx, g->i, &g->s, g->c.limit, v, along, &t);
        if (g->near) {
            double dshift[2], growth[2], off[2], rhs[2], move[2];
            for (size_t d = 0; d < 2; d++) {
                dshift[d] = turn_shift(law, &g->s, &t, d, 1.0, p->shift[d]);
                growth[d] = bound[d] > 0.0 ? quotient(t.limit[d], bound[d]) : 0.0;
                off[d] = bound[d] > 0.0 ? p->y[d] * growth[d] - quotient(unit[2 + d], bound[d]) : 0.0;
            }
            for (size_t d = 0; d < 2; d++) {
                rhs[d] = p->s.val[2 * d] * off[0] + p->s.val[2 * d + 1] * off[1];
            }
            planar_follow(p, both, growth, dshift, rhs, move);
            for (size_t d = 0; d < 2; d++) {
                df[d] = product(bound[d], move[d]) + p->y[d] * t.limit[d];
            }
        } else {
            turn_force(law, &g->s, g->c.limit, &t, df);
        }
        for (size_t d = 0; out[column / 2] && d < 2; d++) {
            out[column / 2][2 * (g->i + d) + column % 2] = df[d];
        }
    }
}

int tribo_plane_force(const tribo_context *ctx, const double *v, const double *feq, double *const *out)
{
    for (size_t k = 0; k < ctx->plane.count; k++) {
        const size_t i = ctx->plane.first[k];
        double f[2], y[2];
        struct given g = {.i = i, .c = tribo_contacts_from(&ctx->follow.contacts, i), .s = tribo_planar_slide(ctx, i, v + i)};
        g.near = tribo_planar_near(ctx->set.law, &g.s);
        if (ctx->set.breaking) {
            const int holds = g.near && feq_parts(ctx->follow.hold + i, feq + i, y) <= 1.0;
            tribo_planar_limits(ctx, i, holds, v + i, g.limit);
            g.c.limit = g.c.bound = g.limit;
        }
        if (!g.near) {
            tribo_planar_slide_force(ctx->set.law, &g.s, g.c.limit, f);
        } else if (!given_near(ctx->set.law, &g, ctx->plane.own[k], feq + i)) {
            return TRIBO_ERR_NO_CONVERGENCE;
        }
        for (size_t d = 0; g.near && d < 2; d++) {
            const double held = cut(feq[i + d]) - g.x.p.shift[d] * g.c.bound[d];
            f[d] = g.x.p.place[0] == LENS_INSIDE && g.c.bound[d] > 0.0 ? held : g.x.p.y[d] * g.c.bound[d];
        }
        if (out[1] || out[2] || out[3]) {
            given_columns(ctx, &g, v + i, out + 1);
        }
        tribo_copy(out[0] ? out[0] + i : NULL, f, out[0] ? 2 : 0);
    }
    return TRIBO_OK;
}

int tribo_force_tangent_planar(const tribo_context *ctx, const double *v, const double *feq, double *f, double *df_dv,
                               double *df_dfeq, double *df_dlimit)
{
    return tribo_find_tangents(ctx, 1, v, feq, (double *const[4]){f, df_dv, df_dfeq, df_dlimit});
}
