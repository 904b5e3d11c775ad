/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces of planar contacts, and of the scalar ones that R couples with them.
 *
 * In units of its limits, y = f/limit, a planar contact slides with y = -n, n being the direction of limit v. Near stick y is in
 * the lens D ∩ (D - c), D being the unit disc and c = 2 |v|/epsilon n, which is kappa in these units; and y minimizes
 * 1/2 y'Sy + pull'y over the lenses and intervals of its cluster, S = limit R limit. Limits that differ make an ellipse: its
 * longer way to the edge of the band, limit epsilon, holds for both directions, so that c points along limit v, as f does where
 * it slides.
 *
 * In S, limits and R are parts of the largest ones near stick in the cluster. A reach stands in for a limit that is far beyond
 * the force, see below; c is then kappa/reach. */
#include "core/calls.h"

/* -------------------------------------------------------------------------------------------------------- parts of R */

/* x = -block^-1 x, far away where friction moves nothing, or the block is singular. */
static void push_back(const struct block *b, double *x)
{
    const double *e = b->e, along = e[0] * x[0] + e[1] * x[1], across = e[0] * x[1] - e[1] * x[0];
    const int lost = b->small <= 16.0 * DBL_EPSILON * b->great && fabs(across) <= 1e-12 * (fabs(x[0]) + fabs(x[1]));
    const double first = quotient(-along, greater(b->great, TRIBO_IMMOVABLE));
    const double second = lost ? 0.0 : quotient(-across, greater(b->small, TRIBO_IMMOVABLE));
    x[0] = cut(e[0] * first - e[1] * second);
    x[1] = cut(e[1] * first + e[0] * second);
}

/* ---------------------------------------------------------------------------------------------------------- problems */

/* Takes the directions of contact i, at place k of its cluster, that have a limit into the problem. */
static void take_contact(tribo_context *ctx, size_t k, size_t i, const double *shift)
{
    struct clusters *c = &ctx->plane;
    const double *bound = ctx->follow.contacts.bound + i;
    const size_t directions = tribo_directions(ctx, i);
    const int both = directions == 2 && bound[0] > 0.0 && bound[1] > 0.0;
    for (size_t d = 0; d < directions; d++) {
        if (bound[d] > 0.0) {
            c->shift[c->problem.size] = shift[d];
            c->directions[c->problem.size] = (unsigned char)(both ? 2 - 2 * d : 1);
            c->contact[c->problem.size] = i + d;
            c->index[k + d] = c->problem.size;
            c->near[c->problem.size++] = k + d;
        } else {
            ctx->last.f[i + d] = 0.0;
        }
    }
}

/* Begins a problem of a cluster without directions. */
static void begin_problem(struct clusters *c, const struct cluster *g)
{
    c->problem.size = 0;
    for (size_t k = 0; k < g->size; k++) {
        c->index[k] = TRIBO_ALONE;
    }
}

/* Sets the directions of a cluster's problem, the contacts near stick at v, and the forces of the others. begins: static limits
 * are those of the contacts near stick, and the others have the limits by which they slide. Returns 1 if there are any near
 * stick. */
static int planar_collect(tribo_context *ctx, const struct cluster *g, const double *v, int begins)
{
    const struct law *law = ctx->set.law;
    begin_problem(&ctx->plane, g);
    for (size_t k = 0; k < g->size; k += tribo_directions(ctx, g->member[k])) {
        const size_t i = g->member[k];
        const struct slide s = tribo_planar_slide(ctx, i, v + i);
        const int near = tribo_planar_near(law, &s);
        if (begins && ctx->set.breaking) {
            tribo_planar_limits(ctx, i, near, v + i, ctx->follow.now + i);
        }
        const double turn = law->relaxes ? 2.0 * s.speed : 0.0, shift[2] = {turn * s.n[0], turn * s.n[1]};
        if (near) {
            take_contact(ctx, k, i, shift);
        } else {
            tribo_planar_slide_force(law, &s, ctx->follow.contacts.limit + i, ctx->last.f + i);
        }
    }
    return ctx->plane.problem.size > 0;
}

void tribo_planar_turn(const struct disc_qp *p, const unsigned char *directions, const double *shift, double *pull)
{
    for (size_t e = 0; e < p->size; e += directions[e]) {
        for (size_t k = e; k < e + directions[e]; k++) {
            const double *row = p->s.val + tribo_disc_own(p, k) - (k - e);
            for (size_t j = e; j < e + directions[e]; j++) {
                pull[k] += row[j - e] * shift[j];
            }
        }
    }
}

/* Returns R f + a at place k of a cluster, without the forces at places own to own + count - 1; others = 1: also without the
 * forces of the problem. */
static double pull_at(const tribo_context *ctx, const struct cluster *g, size_t k, size_t own, size_t count, int others)
{
    double sum = cut(ctx->plane.a[g->member[k]]);
    for (size_t e = g->r.first[k]; e < g->r.first[k + 1]; e++) {
        const size_t j = g->r.col[e], i = g->member[j];
        const double bound = ctx->follow.contacts.bound[i];
        if (!(j >= own && j < own + count) && !(others && ctx->plane.index[j] != TRIBO_ALONE)) {
            sum += g->r.val[e] * clamp(ctx->last.f[i], -bound, bound);
        }
    }
    return sum;
}

/* Sets pull = R f + a of the problem's directions, with the forces of all others. Returns an estimate of the largest
 * f_k sqrt(R_kk), with f_k = |pull_k|/R_kk + |shift_k| limit_k, at most limit_k. */
static double find_pulls(tribo_context *ctx, const struct cluster *g)
{
    const struct clusters *c = &ctx->plane;
    const double *bound = ctx->follow.contacts.bound, *r = ctx->op->diagonal;
    double most = 0.0;
    for (size_t e = 0; e < c->problem.size; e++) {
        const size_t i = c->contact[e];
        c->pull[e] = pull_at(ctx, g, c->near[e], 0, 0, 1);
        const double force = lesser(quotient(fabs(c->pull[e]), r[i]) + product(fabs(c->shift[e]), bound[i]), bound[i]);
        most = greater(most, product(force, sqrt(r[i])));
    }
    return most;
}

/* ------------------------------------------------------------------------------------------------------------ reaches
 * Reaches of planar contacts and of the scalar ones beside them. In parts of a limit that is far beyond the pull at a contact, a
 * force has no digits. The force is then looked for within a smaller disc, a reach. If it lies inside, it is the solution for the
 * limit, too, since the problem is convex; else all reaches grow.
 *
 * A direction of a planar contact is loose if its force is such a small part of its limit that the other direction has its whole
 * limit, to the last digit. Then both are intervals, each with a reach. Else both have one reach, if both limits exceed it, or
 * none. */

/* A reach is this factor times the largest force that the pulls would make of one. */
#define AMPLE 1e3

/* A direction is loose if its reach is below BESIDE times its limit. */
#define BESIDE 1e-8

/* Largest part that the curved limit of the other direction adds to the stiffness of a loose direction. */
#define STRAIGHT 1e-12

/* 1 if a direction of a planar contact is loose, of limits bound and reaches radius. */
static int is_apart(const double *bound, const double *radius)
{
    return radius[0] < BESIDE * bound[0] || radius[1] < BESIDE * bound[1];
}

/* Sets S of the problem. */
static void pose_rows(struct clusters *c, const struct cluster *g)
{
    struct disc_qp *p = &c->problem;
    size_t end = 0;
    p->s.pattern = g->pattern;
    p->s.places = g->size;
    p->s.place = c->near;
    memset(p->s.val, 0, (g->pattern ? 0 : p->size * p->size) * sizeof *p->s.val);
    for (size_t e = 0; e < p->size; e++) {
        for (size_t t = g->r.first[c->near[e]]; t < g->r.first[c->near[e] + 1]; t++) {
            const size_t j = c->index[g->r.col[t]];
            if (j != TRIBO_ALONE) {
                const double r = g->r.val[t] / c->unit_r;
                const size_t at = g->pattern ? end : e * p->size + j;
                p->s.val[at] = p->weight[e] * p->weight[j] * (j == e ? greater(r, NEXT_TO_IMMOVABLE) : r);
                if (g->pattern) {
                    p->s.col[end] = j;
                    p->s.slot[end] = t;
                    p->s.own[e] = j == e ? end : p->s.own[e];
                    p->s.first[e + 1] = ++end;
                }
            }
        }
    }
}

/* Sets the problem of forces in parts of their reach, from pull: which directions share a set, its shift, and all else. */
static void pose_cluster(tribo_context *ctx, const struct cluster *g)
{
    struct clusters *c = &ctx->plane;
    struct disc_qp *p = &c->problem;
    const size_t n = p->size, *contact = c->contact;
    const double *bound = ctx->follow.contacts.bound, *radius = c->radius;
    c->unit_force = c->unit_r = 0.0;
    for (size_t e = 0; e < n; e++) {
        c->unit_force = greater(c->unit_force, tribo_plane_reach(ctx, contact[e]));
        c->unit_r = greater(c->unit_r, ctx->op->diagonal[contact[e]]);
    }
    c->cuts = 0;
    for (size_t e = 0; e < n; e++) {
        const size_t i = contact[e], first = i - (c->directions[e] == 0);
        const int cut_off = tribo_plane_cut(ctx, i), single = c->directions[e] == 1 || is_apart(bound + first, radius + first);
        p->wide[e] = single ? 1 : c->directions[e];
        p->shift[e] = cut_off ? product(quotient(bound[i], radius[i]), c->shift[e]) : c->shift[e];
        p->weight[e] = tribo_plane_reach(ctx, i) / c->unit_force;
        p->y[e] = quotient(c->y[i], tribo_plane_reach(ctx, i));
        c->cuts += (size_t)cut_off;
    }
    pose_rows(c, g);
    for (size_t e = 0; e < n; e += p->wide[e]) {
        const double length = tribo_length(p->wide[e], c->pull + e);
        const double size = lesser(quotient(quotient(length, c->unit_r), c->unit_force), HARDEST);
        for (size_t k = e; k < e + p->wide[e]; k++) {
            p->pull[k] = length > 0.0 ? p->weight[k] * (c->pull[k] / length) * size : 0.0;
        }
    }
    tribo_planar_turn(p, c->directions, p->shift, p->pull);
}

/* Sets the reaches of the problem's directions to most/sqrt(R_kk), most > 0, as far as limits exceed them. */
static void set_reaches(tribo_context *ctx, double most)
{
    const struct clusters *c = &ctx->plane;
    for (size_t e = 0; e < c->problem.size; e += c->directions[e]) {
        const size_t i = c->contact[e], directions = c->directions[e];
        const double *bound = ctx->follow.contacts.bound + i;
        double radius[2] = {0.0, 0.0};
        for (size_t k = 0; k < directions; k++) {
            radius[k] = most < TRIBO_FAR ? greater(quotient(most, sqrt(ctx->op->diagonal[i + k])), DBL_MIN) : HUGE_VAL;
        }
        const int pair = directions == 2 && !is_apart(bound, radius);
        for (size_t k = 0; k < directions; k++) {
            const double own = pair ? greater(radius[0], radius[1]) : radius[k],
                         least = pair ? lesser(bound[0], bound[1]) : bound[k];
            c->radius[i + k] = own < least ? own : HUGE_VAL;
        }
    }
}

/* 1 if a force of the problem is at its reach, or on the rim of its limit where that bends so much that the other direction
 * cannot be loose. */
static int is_beyond_reach(const tribo_context *ctx)
{
    const struct clusters *c = &ctx->plane;
    const struct disc_qp *p = &c->problem;
    for (size_t e = 0, first = 0; e < p->size; e++) {
        first = p->wide[e] ? e : first;
        const size_t other = p->wide[e] != 1 ? e : c->directions[e] == 2 ? e + 1 : c->directions[e] == 0 ? e - 1 : e;
        const size_t j = c->contact[other];
        const double part =
            other != e && tribo_plane_cut(ctx, j) ? tribo_plane_reach(ctx, j) / ctx->follow.contacts.bound[j] : 0.0;
        const int bends = fabs(p->gradient[e]) * part * part > STRAIGHT * p->s.val[tribo_disc_own(p, other)];
        if (p->place[first] != LENS_INSIDE && (bends || tribo_plane_cut(ctx, c->contact[e]))) {
            return 1;
        }
    }
    return 0;
}

/* ------------------------------------------------------------------------------------------------------- static limits
 * Both static limits of a planar contact are the same multiple of those by which it slides, so that only a factor changes as it
 * breaks away: it holds while f_eq is within the ellipse of the static limits. Scalar contacts of a cluster follow the rule of
 * static.c. */

/* The forces of redundant contacts are known to this part of their limits. */
#define DISAGREEMENT 1e-12

/* 1 if |f_eq| of the contact at e of the problem exceeds its limits by more than rounding; f_eq = y + shift - block^-1
 * gradient. */
static int is_pulled_beyond(const struct disc_qp *p, size_t e)
{
    const double *own = p->s.val + tribo_disc_own(p, e), *second = p->wide[e] == 2 ? p->s.val + tribo_disc_own(p, e + 1) : NULL;
    const struct block b = tribo_block_of(own, second);
    double feq[2] = {p->gradient[e], p->wide[e] == 2 ? p->gradient[e + 1] : 0.0};
    push_back(&b, feq);
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

/* Gives contacts that the solution cannot hold the limits by which they slide at the end of a step of dt, or (0) from rest.
 * Returns their number. */
static size_t planar_break(tribo_context *ctx, const struct cluster *g, double dt)
{
    const struct disc_qp *p = &ctx->plane.problem;
    double *now = ctx->follow.now, *end = ctx->plane.v; /* velocities at the end */
    size_t broken = 0;
    for (size_t k = 0; k < g->size; k++) {
        end[g->member[k]] = product(pull_at(ctx, g, k, 0, 0, 0), dt);
    }
    for (size_t e = 0; e < p->size; e += p->wide[e]) {
        const size_t first = tribo_first_direction(ctx, ctx->plane.contact[e]), behind = first + tribo_directions(ctx, first);
        int holds = p->place[e] != LENS_INSIDE, falls = 0;
        for (size_t i = first; i < behind; i++) {
            holds &= now[i] == ctx->follow.hold[i];
        }
        holds = holds && is_pulled_beyond(p, e);
        for (size_t i = first; holds && i < behind; i++) {
            now[i] = tribo_limit_at(ctx, i, tribo_length((int)(behind - first), end + first));
            falls |= now[i] < ctx->follow.hold[i];
        }
        broken += (size_t)falls;
    }
    return broken;
}

/* Where a force is far within its reach, distances of this part of the reach are 0. */
#define NEAREST 1e-20

/* No forces are found if one misses its balance by more than this part of its reach. */
#define TOO_FAR 1e-6

/* Solves until all forces are within their reach, and no static limit breaks; a status. */
static int solve_cluster(tribo_context *ctx, const struct cluster *g, double dt)
{
    struct clusters *c = &ctx->plane;
    struct disc_qp *p = &c->problem;
    const struct work *work = &p->factor.qp.work;
    ctx->last.clusters++;
    do {
        double most = product(AMPLE, find_pulls(ctx, g));
        for (size_t e = 0; !(most > 0.0) && e < p->size; e++) {
            c->y[c->contact[e]] = 0.0;
        }
        for (int beyond = 1; beyond; most = product(AMPLE, most)) {
            set_reaches(ctx, most > 0.0 ? most : TRIBO_FAR);
            pose_cluster(ctx, g);
            p->factor.qp.work.factorizations = 0;
            p->near_enough = c->cuts ? NEAREST : TRIBO_NEAR_ENOUGH;
            int done = tribo_disc_solve(p);
            if (done && g->redundant && ctx->set.sharing == TRIBO_SHARE_LEAST_NORM) {
                done = tribo_disc_share(p);
            }
            ctx->count.solves++;
            ctx->count.reused += work->factorizations == 0;
            ctx->memory.problem.work.factorizations += work->factorizations;
            if (!done || p->residual > TOO_FAR) {
                return tribo_fail(
                    ctx, TRIBO_ERR_NO_CONVERGENCE,
                    "no forces found for the %zu direction%s near stick around contact %zu: %g of a limit is missing", p->size,
                    plural(p->size), c->contact[0], p->residual);
            }
            ctx->last.residual = greater(ctx->last.residual, p->residual);
            for (size_t e = 0; e < p->size; e++) {
                const size_t i = c->contact[e];
                c->y[i] = ctx->last.f[i] = p->y[e] * tribo_plane_reach(ctx, i);
            }
            beyond = c->cuts && is_beyond_reach(ctx);
        }
    } while (ctx->set.breaking && planar_break(ctx, g, dt));
    ctx->last.rank += p->factor.sets.rank;
    return TRIBO_OK;
}

const size_t *tribo_cluster_resume(tribo_context *ctx, size_t q, size_t *size)
{
    struct disc_qp *p = &ctx->plane.problem;
    const struct cluster *g = &ctx->plane.cluster[q];
    *size = g->size;
    if (planar_collect(ctx, g, ctx->last.v, 0)) {
        find_pulls(ctx, g);
        pose_cluster(ctx, g);
        tribo_disc_gains(p);
        tribo_disc_gradients(p);
        tribo_disc_places(p);
        tribo_disc_linearize(p);
        tribo_disc_redundant(p);
    }
    return g->member;
}

/* ------------------------------------------------------------------------------------------------------------- f_eq */

void tribo_cluster_feq(tribo_context *ctx, size_t q)
{
    const struct cluster *g = &ctx->plane.cluster[q];
    for (size_t k = 0, directions; k < g->size; k += directions) {
        const size_t i = g->member[k];
        directions = tribo_directions(ctx, i);
        const struct block block = tribo_cluster_block(g, k, directions);
        double x[2] = {0.0, 0.0}, most = 0.0;
        for (size_t d = 0; d < directions; d++) {
            x[d] = pull_at(ctx, g, k + d, k, directions, 0);
            most = greater(most, ctx->set.limit[i + d]);
        }
        push_back(&block, x);
        for (size_t d = 0; d < directions; d++) {
            ctx->last.feq[i + d] = most > 0.0 ? x[d] : 0.0;
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------ calls */

int tribo_clusters_balance(tribo_context *ctx, const double *v, const double *a)
{
    const struct clusters *c = &ctx->plane;
    int status = TRIBO_OK;
    tribo_copy(c->a, a, c->count ? ctx->n : 0);
    for (size_t q = 0; !status && q < ctx->plane.clusters; q++) {
        const struct cluster *g = &c->cluster[q];
        if (!planar_collect(ctx, g, v, 1)) {
            continue;
        }
        status = solve_cluster(ctx, g, 0.0);
        /* Laws with a memory set the forces of scalar contacts from f_eq. */
        if (ctx->set.law->remembers) {
            tribo_cluster_feq(ctx, q);
        }
        for (size_t e = 0; ctx->set.law->remembers && e < c->problem.size; e++) {
            const size_t i = c->contact[e];
            const struct contacts at = tribo_contacts_from(&ctx->follow.contacts, i);
            if (tribo_is_scalar(ctx, i)) {
                ctx->set.law->force(&at, 1, v + i, ctx->last.feq + i, ctx->last.f + i);
            }
        }
    }
    return status;
}

int tribo_clusters_step(tribo_context *ctx, double dt, const double *v, const signed char *known)
{
    const double none[2] = {0.0, 0.0};
    int status = TRIBO_OK;
    for (size_t q = 0; !status && q < ctx->plane.clusters; q++) {
        const struct cluster *g = &ctx->plane.cluster[q];
        begin_problem(&ctx->plane, g);
        for (size_t k = 0; k < g->size; k++) {
            ctx->plane.a[g->member[k]] = quotient(v[g->member[k]], dt);
        }
        for (size_t k = 0; k < g->size; k += tribo_directions(ctx, g->member[k])) {
            if (!(known && known[g->member[k]] && tribo_is_scalar(ctx, g->member[k]))) {
                take_contact(ctx, k, g->member[k], none);
            }
        }
        if (ctx->plane.problem.size) {
            status = solve_cluster(ctx, g, dt);
        }
    }
    return status;
}

/* Rounding of the length of a force in parts of its limit. */
#define ROUNDING (8.0 * DBL_EPSILON)

/* 1 if the force of the planar contact at i reaches its limits. */
static int reaches_limits(const tribo_context *ctx, size_t i)
{
    const double *limit = ctx->follow.contacts.limit + i, *f = ctx->last.f + i;
    const double y[2] = {limit[0] > 0.0 ? quotient(f[0], limit[0]) : 0.0, limit[1] > 0.0 ? quotient(f[1], limit[1]) : 0.0};
    return tribo_length(2, y) >= ctx->last.holds * (1.0 - ROUNDING);
}

signed char tribo_plane_slip(const tribo_context *ctx, size_t i)
{
    const size_t first = tribo_first_direction(ctx, i);
    const int open = !(ctx->follow.contacts.limit[i] > 0.0);
    return open ? TRIBO_SLIP_OPEN : reaches_limits(ctx, first) ? TRIBO_SLIP_PLANE : TRIBO_SLIP_STUCK;
}

size_t tribo_clusters_turn(tribo_context *ctx, double dt, const double *v, const double **vfree, double *feels,
                           signed char *reverses)
{
    double *turned = ctx->plane.v;
    const double *free = *vfree;
    size_t changes = 0;
    for (size_t q = 0; q < ctx->plane.clusters; q++) {
        const struct cluster *g = &ctx->plane.cluster[q];
        for (size_t k = 0, directions; k < g->size; k += directions) {
            const size_t i = g->member[k];
            double forward = 0.0; /* v_end'v */
            directions = tribo_directions(ctx, i);
            for (size_t d = 0; d < directions; d++) {
                ctx->plane.a[i + d] = 0.0;
                feels[i + d] = pull_at(ctx, g, k + d, k, directions == 1, 0);
                forward += product(free[i + d] + product(feels[i + d], dt), v[i + d]);
            }
            if (directions == 1 || !reaches_limits(ctx, i)) {
                continue;
            }
            if (forward > 0.0 && changes++ == 0) {
                tribo_copy(turned, free, ctx->n);
                *vfree = turned;
            }
            for (size_t d = i; d < i + 2; d++) {
                reverses[d] = tribo_plane_slip(ctx, d);
                turned[d] = forward > 0.0 ? v[d] + free[d] : turned[d];
            }
        }
    }
    return changes;
}
