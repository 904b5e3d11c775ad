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
 * the force, see planar_reach.c; c is then kappa/reach. */
#include "core/check.h"
#include "core/static.h"
#include "parts.h"

/* ---------------------------------------------------------------------------------------------------------- problems */

/* Takes the directions of contact i, at place k of its cluster, that have a limit into the problem. */
static void take_contact(tribo_context *ctx, size_t k, size_t i, size_t directions, const double *shift)
{
    const double *bound = ctx->follow.contacts.bound + i;
    const int both = directions == 2 && bound[0] > 0.0 && bound[1] > 0.0;
    for (size_t d = 0; d < directions; d++) {
        struct disc_qp *p = &ctx->planar->problem;
        if (bound[d] > 0.0) {
            ctx->planar->shift[p->size] = shift[d];
            ctx->planar->directions[p->size] = (unsigned char)(both ? 2 - 2 * d : 1);
            ctx->planar->contact[p->size] = i + d;
            ctx->planar->near[p->size++] = k + d;
        } else {
            ctx->last.f[i + d] = 0.0;
        }
    }
}

/* Sets the directions of a cluster's problem, the contacts near stick at v. Returns 1 if there are any. */
static int planar_collect(tribo_context *ctx, const struct cluster *g, const double *v)
{
    const struct law *law = ctx->set.law;
    const struct contacts *c = &ctx->follow.contacts;
    ctx->planar->problem.size = 0;
    for (size_t k = 0, directions; k < g->size; k += directions) {
        const size_t i = g->member[k];
        directions = tribo_directions(ctx, i);
        const struct slide s = tribo_planar_slide(c, i, directions, v + i);
        const double turn = law->relaxes ? 2.0 * s.speed : 0.0, shift[2] = {turn * s.n[0], turn * s.n[1]};
        if (tribo_planar_near(law, &s)) {
            take_contact(ctx, k, i, directions, shift);
        } else {
            tribo_planar_slide_force(law, &s, c->limit + i, ctx->last.f + i);
        }
    }
    return ctx->planar->problem.size > 0;
}

struct unit tribo_planar_units(const tribo_context *ctx)
{
    struct unit u = {0.0, 0.0};
    for (size_t e = 0; e < ctx->planar->problem.size; e++) {
        u.force = greater(u.force, tribo_planar_reach(ctx, ctx->planar->contact[e]));
        u.r = greater(u.r, ctx->op->diagonal[ctx->planar->contact[e]]);
    }
    return u;
}

void tribo_planar_turn(const tribo_context *ctx, const double *shift, double *pull)
{
    const struct disc_qp *p = &ctx->planar->problem;
    const unsigned char *directions = ctx->planar->directions;
    for (size_t e = 0; e < p->size; e += directions[e]) {
        for (size_t k = e; k < e + directions[e]; k++) {
            for (size_t j = e; j < e + directions[e]; j++) {
                pull[k] += p->s[k * p->size + j] * shift[j];
            }
        }
    }
}

/* pull = R f + a of the problem's directions, with the forces of all others. */
static void find_pulls(tribo_context *ctx, const struct cluster *g, const double *a)
{
    const size_t n = ctx->planar->problem.size, *near = ctx->planar->near, *member = g->member;
    for (size_t e = 0; e < n; e++) {
        const double *row = g->r + near[e] * g->size;
        double sum = cut(a[ctx->planar->contact[e]]);
        for (size_t j = 0, other = 0; j < g->size; j++) {
            const double bound = ctx->follow.contacts.bound[member[j]];
            if (other < n && near[other] == j) {
                other++;
            } else if (row[j] != 0.0) {
                sum += row[j] * clamp(ctx->last.f[member[j]], -bound, bound);
            }
        }
        ctx->planar->pull[e] = sum;
    }
}

/* Sets the problem of forces in parts of their reach, from pull. */
static void pose_cluster(tribo_context *ctx, const struct cluster *g)
{
    struct disc_qp *p = &ctx->planar->problem;
    const struct unit u = tribo_planar_units(ctx);
    const size_t n = p->size, *contact = ctx->planar->contact, *near = ctx->planar->near;
    int turned = 0;
    for (size_t e = 0; e < n; e++) {
        p->weight[e] = tribo_planar_reach(ctx, contact[e]) / u.force;
        p->y[e] = ctx->planar->y[contact[e]];
    }
    for (size_t e = 0; e < n; e++) {
        const double *row = g->r + near[e] * g->size;
        for (size_t j = 0; j < n; j++) {
            const double r = row[near[j]] / u.r;
            p->s[e * n + j] = p->weight[e] * p->weight[j] * (j == e ? greater(r, NEXT_TO_IMMOVABLE) : r);
        }
    }
    for (size_t e = 0; e < n; e += p->wide[e]) {
        const double length = tribo_length(p->wide[e], ctx->planar->pull + e);
        const double size = lesser(quotient(quotient(length, u.r), u.force), HARDEST);
        for (size_t k = e; k < e + p->wide[e]; k++) {
            p->pull[k] = length > 0.0 ? p->weight[k] * (ctx->planar->pull[k] / length) * size : 0.0;
            turned |= p->shift[k] != 0.0;
        }
    }
    if (turned) {
        tribo_planar_turn(ctx, p->shift, p->pull);
    }
}

const size_t *tribo_cluster_resume(tribo_context *ctx, size_t q, size_t *size)
{
    struct disc_qp *p = &ctx->planar->problem;
    const struct cluster *g = &ctx->planar->cluster[q];
    *size = g->size;
    if (planar_collect(ctx, g, ctx->last.v)) {
        find_pulls(ctx, g, ctx->planar->a);
        tribo_planar_arrange(ctx);
        pose_cluster(ctx, g);
        tribo_disc_gains(p);
        tribo_disc_gradients(p);
        tribo_disc_places(p);
        tribo_disc_linearize(p);
    }
    return g->member;
}

/* Where a force is far within its reach, distances of this part of the reach are 0. */
#define NEAREST 1e-20

/* No forces are found if one misses its balance by more than this part of its reach. */
#define TOO_FAR 1e-6

/* Solves the problem as it is set; a status. */
static int solve_once(tribo_context *ctx, const struct cluster *g)
{
    struct disc_qp *p = &ctx->planar->problem;
    const size_t *contact = ctx->planar->contact;
    p->factor.qp.work.factorizations = 0;
    p->near_enough = ctx->planar->cuts ? NEAREST : TRIBO_NEAR_ENOUGH;
    int done = tribo_disc_solve(p);
    if (done && g->redundant && ctx->set.sharing == TRIBO_SHARE_LEAST_NORM) {
        done = tribo_disc_share(p);
    }
    ctx->count.solves++;
    ctx->count.reused += p->factor.qp.work.factorizations == 0;
    ctx->memory.problem.work.factorizations += p->factor.qp.work.factorizations;
    if (!done || p->residual > TOO_FAR) {
        return tribo_fail(ctx, TRIBO_ERR_NO_CONVERGENCE,
                          "no forces found for the %zu direction%s near stick around contact %zu: %g of a limit is missing",
                          p->size, plural(p->size), contact[0], p->residual);
    }
    ctx->last.residual = greater(ctx->last.residual, p->residual);
    for (size_t e = 0; e < p->size; e++) {
        const size_t i = contact[e];
        ctx->planar->y[i] = p->y[e];
        ctx->last.f[i] = p->y[e] * tribo_planar_reach(ctx, i);
    }
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------- static limits
 * Both static limits of a planar contact are the same multiple of those by which it slides, so that only a factor changes as it
 * breaks away: it holds while f_eq is within the ellipse of the static limits. Scalar contacts of a cluster follow the rule of
 * static.c. */

/* Gives contacts of a cluster near stick at v their static limits, the others those by which they slide. */
static void planar_hold(tribo_context *ctx, const struct cluster *g, const double *v)
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

/* Gives contacts that the solution cannot hold the limits by which they slide at the end of a step of dt, or (0) from rest.
 * Returns their number. a [n]: accelerations without friction. */
static size_t planar_break(tribo_context *ctx, const struct cluster *g, double dt, const double *a)
{
    const struct disc_qp *p = &ctx->planar->problem;
    const size_t *member = g->member;
    double *now = ctx->follow.now, *end = ctx->planar->v; /* velocities at the end */
    size_t broken = 0;
    for (size_t k = 0; k < g->size; k++) {
        end[member[k]] = product(tribo_planar_others(ctx, g, k, k, 0, a[member[k]]), dt);
    }
    for (size_t e = 0; e < p->size; e += p->wide[e]) {
        const size_t k = ctx->planar->contact[e], first = k - (ctx->planar->role[k] == ROLE_SECOND);
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

/* Solves until all forces are within their reach, and no static limit breaks; a status. */
static int solve_cluster(tribo_context *ctx, const struct cluster *g, double dt, const double *a)
{
    int status;
    do {
        find_pulls(ctx, g, a);
        tribo_planar_estimate(ctx, g);
        do {
            tribo_planar_arrange(ctx);
            pose_cluster(ctx, g);
            status = solve_once(ctx, g);
        } while (!status && ctx->planar->cuts && tribo_planar_widen(ctx));
    } while (!status && ctx->set.breaking && planar_break(ctx, g, dt, a));
    ctx->last.clusters++;
    ctx->last.rank += status ? 0 : ctx->planar->problem.factor.sets.rank;
    return status;
}

/* ------------------------------------------------------------------------------------------------------------- f_eq */

/* feq [directions] of the contact at place k of a cluster, with a [directions]; 0 if it is open. */
static void contact_feq(const tribo_context *ctx, const struct cluster *g, size_t k, size_t directions, const double *a,
                        double *feq)
{
    const struct block block = tribo_block_at(g->r, g->size, k, directions);
    double x[2] = {0.0, 0.0}, most = 0.0;
    for (size_t d = 0; d < directions; d++) {
        x[d] = tribo_planar_others(ctx, g, k + d, k, directions, a[d]);
        most = greater(most, ctx->set.limit[g->member[k + d]]);
    }
    tribo_planar_push(&block, x);
    for (size_t d = 0; d < directions; d++) {
        feq[d] = most > 0.0 ? x[d] : 0.0;
    }
}

void tribo_clusters_feq(tribo_context *ctx, const double *a)
{
    for (size_t q = 0; ctx->planar && q < ctx->planar->clusters; q++) {
        const struct cluster *g = &ctx->planar->cluster[q];
        for (size_t k = 0; k < g->size; k += tribo_directions(ctx, g->member[k])) {
            const size_t i = g->member[k];
            contact_feq(ctx, g, k, tribo_directions(ctx, i), a + i, ctx->last.feq + i);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------ calls */

/* Forces by the law of scalar contacts in the problem, from their f_eq, all of which are found before any force changes. */
static void scalar_laws(tribo_context *ctx, const struct cluster *g, const double *v, const double *a)
{
    const size_t *near = ctx->planar->near, n = ctx->planar->problem.size;
    for (size_t e = 0; e < n; e++) {
        const size_t i = ctx->planar->contact[e];
        if (tribo_is_scalar(ctx, i)) {
            contact_feq(ctx, g, near[e], 1, a + i, ctx->last.feq + i);
        }
    }
    for (size_t e = 0; e < n; e++) {
        const size_t i = ctx->planar->contact[e];
        if (tribo_is_scalar(ctx, i)) {
            const struct contacts c = tribo_contacts_from(&ctx->follow.contacts, i);
            ctx->set.law->force(&c, 1, v + i, ctx->last.feq + i, ctx->last.f + i);
        }
    }
}

int tribo_clusters_balance(tribo_context *ctx, const double *v, const double *a)
{
    int status = TRIBO_OK;
    if (!ctx->planar) {
        return status;
    }
    for (size_t k = 0; !status && k < ctx->planar->clusters; k++) {
        const struct cluster *g = &ctx->planar->cluster[k];
        if (ctx->set.breaking) {
            planar_hold(ctx, g, v);
        }
        if (planar_collect(ctx, g, v)) {
            status = solve_cluster(ctx, g, 0.0, a);
            if (ctx->set.law->remembers) {
                scalar_laws(ctx, g, v, a);
            }
        }
    }
    return status;
}

int tribo_clusters_step(tribo_context *ctx, double dt, const double *v, const signed char *known)
{
    const double none[2] = {0.0, 0.0};
    int status = TRIBO_OK;
    if (!ctx->planar) {
        return status;
    }
    for (size_t q = 0; !status && q < ctx->planar->clusters; q++) {
        const struct cluster *g = &ctx->planar->cluster[q];
        ctx->planar->problem.size = 0;
        for (size_t k = 0, directions; k < g->size; k += directions) {
            const size_t i = g->member[k];
            directions = tribo_directions(ctx, i);
            for (size_t d = i; d < i + directions; d++) {
                ctx->planar->a[d] = quotient(v[d], dt);
            }
            if (directions == 2 || !(known && known[i])) {
                take_contact(ctx, k, i, directions, none);
            }
        }
        if (ctx->planar->problem.size) {
            status = solve_cluster(ctx, g, dt, ctx->planar->a);
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
    const size_t first = i - (ctx->planar->role[i] == ROLE_SECOND);
    const int open = !(ctx->follow.contacts.limit[i] > 0.0);
    return open ? TRIBO_SLIP_OPEN : reaches_limits(ctx, first) ? TRIBO_SLIP_PLANE : TRIBO_SLIP_STUCK;
}

void tribo_plane_slips(const tribo_context *ctx, signed char *slip)
{
    for (size_t i = 0; tribo_plane_count(ctx) && i < ctx->n; i++) {
        slip[i] = tribo_is_scalar(ctx, i) ? slip[i] : tribo_plane_slip(ctx, i);
    }
}

size_t tribo_clusters_turn(tribo_context *ctx, double dt, const double *v, const double **vfree, double *feels,
                           signed char *reverses)
{
    double *turned = ctx->planar ? ctx->planar->v : NULL;
    const double *free = *vfree;
    size_t changes = 0;
    for (size_t q = 0; ctx->planar && q < ctx->planar->clusters; q++) {
        const struct cluster *g = &ctx->planar->cluster[q];
        for (size_t k = 0, directions; k < g->size; k += directions) {
            const size_t i = g->member[k];
            double forward = 0.0; /* v_end'v */
            directions = tribo_directions(ctx, i);
            for (size_t d = 0; d < directions; d++) {
                feels[i + d] = tribo_planar_others(ctx, g, k + d, k, directions == 1 ? 1 : 0, 0.0);
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

double tribo_plane_rate(const tribo_context *ctx)
{
    const double none[2] = {0.0, 0.0};
    double rate = 0.0;
    for (size_t k = 0; k < tribo_plane_count(ctx); k++) {
        double limit[2];
        const struct contacts c = tribo_planar_view(ctx, ctx->planar->first[k], 2, limit);
        const double *own = ctx->planar->own[k];
        const struct slide s = tribo_planar_slide(&c, 0, 2, none);
        const double weighed[3] = {product(s.part[0], product(s.part[0], own[0])), product(s.part[0], product(s.part[1], own[1])),
                                   product(s.part[1], product(s.part[1], own[2]))};
        const double far = s.part[0] == 1.0 ? c.bound[0] : c.bound[1];
        if (!s.open) {
            rate = greater(rate, product(2.0 * quotient(far, s.epsilon), tribo_block_of(weighed).great));
        }
    }
    return rate;
}
