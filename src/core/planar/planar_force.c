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
        struct disc_qp *p = &ctx->plane.problem;
        if (bound[d] > 0.0) {
            ctx->plane.shift[p->size] = shift[d];
            ctx->plane.directions[p->size] = (unsigned char)(both ? 2 - 2 * d : 1);
            ctx->plane.near[p->size++] = k + d;
        } else {
            ctx->last.f[i + d] = 0.0;
        }
    }
}

int tribo_planar_collect(tribo_context *ctx, const struct cluster *g, const double *v)
{
    const struct law *law = ctx->set.law;
    const struct contacts *c = &ctx->follow.contacts;
    ctx->plane.problem.size = 0;
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
    return ctx->plane.problem.size > 0;
}

struct unit tribo_planar_units(const tribo_context *ctx, const struct cluster *g)
{
    struct unit u = {0.0, 0.0};
    for (size_t e = 0; e < ctx->plane.problem.size; e++) {
        const size_t k = ctx->plane.near[e];
        u.force = greater(u.force, tribo_planar_reach(ctx, g->member[k]));
        u.r = greater(u.r, g->r[k * (g->size + 1)]);
    }
    return u;
}

/* Harder pulls, in units of what friction can hold, count by their direction only. */
#define HARDEST 1e100

void tribo_planar_turn(const tribo_context *ctx, const double *shift, double *pull)
{
    const struct disc_qp *p = &ctx->plane.problem;
    const unsigned char *directions = ctx->plane.directions;
    for (size_t e = 0; e < p->size; e += directions[e]) {
        for (size_t k = e; k < e + directions[e]; k++) {
            for (size_t j = e; j < e + directions[e]; j++) {
                pull[k] += p->s[k * p->size + j] * shift[j];
            }
        }
    }
}

/* plane.pull = R f + a of the problem's directions, with the forces of all others. */
static void find_pulls(tribo_context *ctx, const struct cluster *g, const double *a)
{
    const size_t n = ctx->plane.problem.size, *near = ctx->plane.near, *member = g->member;
    for (size_t e = 0; e < n; e++) {
        const double *row = g->r + near[e] * g->size;
        double sum = cut(a[member[near[e]]]);
        for (size_t j = 0, other = 0; j < g->size; j++) {
            const double bound = ctx->follow.contacts.bound[member[j]];
            if (other < n && near[other] == j) {
                other++;
            } else if (row[j] != 0.0) {
                sum += row[j] * clamp(tribo_force_of(ctx, member[j]), -bound, bound);
            }
        }
        ctx->plane.pull[e] = sum;
    }
}

/* Sets the problem of forces in parts of their reach, from plane.pull. */
static void pose_cluster(tribo_context *ctx, const struct cluster *g)
{
    struct disc_qp *p = &ctx->plane.problem;
    const struct unit u = tribo_planar_units(ctx, g);
    const size_t n = p->size, *member = g->member, *near = ctx->plane.near;
    int turned = 0;
    for (size_t e = 0; e < n; e++) {
        p->weight[e] = tribo_planar_reach(ctx, member[near[e]]) / u.force;
        p->y[e] = ctx->plane.y[member[near[e]]];
    }
    for (size_t e = 0; e < n; e++) {
        const double *row = g->r + near[e] * g->size;
        for (size_t j = 0; j < n; j++) {
            const double r = row[near[j]] / u.r;
            p->s[e * n + j] = p->weight[e] * p->weight[j] * (j == e ? greater(r, NEXT_TO_IMMOVABLE) : r);
        }
    }
    for (size_t e = 0; e < n; e += p->wide[e]) {
        const double length = tribo_length(p->wide[e], ctx->plane.pull + e);
        const double size = lesser(quotient(quotient(length, u.r), u.force), HARDEST);
        for (size_t k = e; k < e + p->wide[e]; k++) {
            p->pull[k] = length > 0.0 ? p->weight[k] * (ctx->plane.pull[k] / length) * size : 0.0;
            turned |= p->shift[k] != 0.0;
        }
    }
    if (turned) {
        tribo_planar_turn(ctx, p->shift, p->pull);
    }
}

void tribo_planar_resume(tribo_context *ctx, const struct cluster *g, const double *a)
{
    find_pulls(ctx, g, a);
    tribo_planar_arrange(ctx, g);
    pose_cluster(ctx, g);
}

/* Where a force is far within its reach, distances of this part of the reach are 0. */
#define NEAREST 1e-20

/* No forces are found if one misses its balance by more than this part of its reach. */
#define TOO_FAR 1e-6

/* Solves the problem as it is set; a status. */
static int solve_once(tribo_context *ctx, const struct cluster *g)
{
    struct disc_qp *p = &ctx->plane.problem;
    const size_t *member = g->member, *near = ctx->plane.near;
    p->factor.qp.work.factorizations = 0;
    p->near_enough = ctx->plane.cuts ? NEAREST : TRIBO_NEAR_ENOUGH;
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
                          p->size, plural(p->size), member[near[0]], p->residual);
    }
    ctx->last.residual = greater(ctx->last.residual, p->residual);
    for (size_t e = 0; e < p->size; e++) {
        const size_t i = member[near[e]];
        ctx->plane.y[i] = p->y[e];
        ctx->last.f[i] = p->y[e] * tribo_planar_reach(ctx, i);
    }
    return TRIBO_OK;
}

/* Solves until all forces are within their reach, and no static limit breaks; a status. */
static int solve_cluster(tribo_context *ctx, const struct cluster *g, double dt, const double *a)
{
    int status;
    do {
        find_pulls(ctx, g, a);
        tribo_planar_estimate(ctx, g);
        do {
            tribo_planar_arrange(ctx, g);
            pose_cluster(ctx, g);
            status = solve_once(ctx, g);
        } while (!status && ctx->plane.cuts && tribo_planar_widen(ctx, g));
    } while (!status && ctx->set.breaking && tribo_planar_break(ctx, g, dt, a));
    ctx->plane.solved++;
    ctx->last.rank += status ? 0 : ctx->plane.problem.factor.sets.rank;
    return status;
}

/* Corrects the islands skipped: planar contacts join some, and clusters that are solved are not skipped. */
static void count_skipped(tribo_context *ctx)
{
    ctx->count.skipped += ctx->planar->islands;
    ctx->count.skipped -= ctx->op->islands + ctx->plane.solved;
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
    const size_t *near = ctx->plane.near, n = ctx->plane.problem.size;
    for (size_t e = 0; e < n; e++) {
        const size_t i = g->member[near[e]];
        if (tribo_is_scalar(ctx, i)) {
            contact_feq(ctx, g, near[e], 1, a + i, ctx->last.feq + i);
        }
    }
    for (size_t e = 0; e < n; e++) {
        const size_t i = g->member[near[e]];
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
    for (size_t i = 0; i < ctx->n; i++) {
        unsigned char *stored = &ctx->last.did.stored[i / TRIBO_CHUNK];
        if (!tribo_is_scalar(ctx, i)) {
            ctx->last.did.of[i] = STORED;
            *stored = *stored == NONE_STORED ? SOME_STORED : *stored;
        }
    }
    ctx->plane.solved = 0;
    for (size_t k = 0; !status && k < ctx->planar->clusters; k++) {
        const struct cluster *g = &ctx->planar->cluster[k];
        if (ctx->set.breaking) {
            tribo_planar_hold(ctx, g, v);
        }
        if (tribo_planar_collect(ctx, g, v)) {
            status = solve_cluster(ctx, g, 0.0, a);
            if (ctx->set.law->remembers) {
                scalar_laws(ctx, g, v, a);
            }
        }
    }
    count_skipped(ctx);
    return status;
}

int tribo_clusters_step(tribo_context *ctx, double dt, const double *v, const signed char *known)
{
    const double none[2] = {0.0, 0.0};
    int status = TRIBO_OK;
    if (!ctx->planar) {
        return status;
    }
    ctx->plane.solved = 0;
    for (size_t q = 0; !status && q < ctx->planar->clusters; q++) {
        const struct cluster *g = &ctx->planar->cluster[q];
        ctx->plane.problem.size = 0;
        for (size_t k = 0, directions; k < g->size; k += directions) {
            const size_t i = g->member[k];
            directions = tribo_directions(ctx, i);
            for (size_t d = i; d < i + directions; d++) {
                ctx->plane.a[d] = quotient(v[d], dt);
            }
            if (directions == 2 || !(known && known[i])) {
                take_contact(ctx, k, i, directions, none);
            }
        }
        if (ctx->plane.problem.size) {
            status = solve_cluster(ctx, g, dt, ctx->plane.a);
        }
    }
    count_skipped(ctx);
    return status;
}

void tribo_clusters_feel(const tribo_context *ctx, double *feels)
{
    for (size_t q = 0; ctx->planar && q < ctx->planar->clusters; q++) {
        const struct cluster *g = &ctx->planar->cluster[q];
        for (size_t k = 0; k < g->size; k++) {
            if (tribo_is_scalar(ctx, g->member[k])) {
                feels[g->member[k]] = tribo_planar_others(ctx, g, k, k, 1, 0.0);
            }
        }
    }
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

size_t tribo_clusters_turn(tribo_context *ctx, double dt, const double *v, const double *vfree, signed char *reverses,
                           const double **free)
{
    const struct planar *c = ctx->planar;
    size_t changes = 0;
    *free = vfree;
    for (size_t q = 0; c && q < c->clusters; q++) {
        const struct cluster *g = &c->cluster[q];
        for (size_t k = 0; k < g->size; k++) {
            const size_t i = g->member[k];
            if (c->role[i] == ROLE_FIRST && reaches_limits(ctx, i)) {
                double forward = 0.0; /* v_end'v */
                for (size_t d = 0; d < 2; d++) {
                    const double end = vfree[i + d] + product(tribo_planar_others(ctx, g, k + d, k, 0, 0.0), dt);
                    forward += product(end, v[i + d]);
                }
                reverses[i] = tribo_plane_slip(ctx, i);
                reverses[i + 1] = tribo_plane_slip(ctx, i + 1);
                changes += forward > 0.0;
                if (changes && *free == vfree) {
                    tribo_copy(ctx->plane.v, vfree, ctx->n);
                    *free = ctx->plane.v;
                }
                for (size_t d = i; forward > 0.0 && d < i + 2; d++) {
                    ctx->plane.v[d] = v[d] + vfree[d];
                }
            }
        }
    }
    return changes;
}

/* ------------------------------------------------------------------------------------------------ f_eq that is given */

/* 1 if f_eq is beyond the limits. */
static int is_beyond(const double *limit, const double *feq)
{
    double y[2];
    for (int d = 0; d < 2; d++) {
        y[d] = limit[d] > 0.0 ? quotient(cut(feq[d]), limit[d]) : 0.0;
    }
    return tribo_length(2, y) > 1.0;
}

void tribo_planar_given(const tribo_context *ctx, size_t k, const double *v, const double *feq, struct given *g)
{
    const size_t i = ctx->planar->first[k];
    g->c = tribo_planar_view(ctx, i, 2, g->limit);
    g->s = tribo_planar_slide(&g->c, 0, 2, v);
    g->near = tribo_planar_near(ctx->set.law, &g->s);
    if (ctx->set.breaking) {
        tribo_planar_limits(ctx, i, 2, g->near && !is_beyond(g->limit, feq), v, g->limit);
    }
}

int tribo_planar_given_near(const tribo_context *ctx, size_t k, const struct given *g, const double *feq, struct disc_alone *x)
{
    const double *own = ctx->planar->own[k], r = greater(own[0], own[2]), turn = ctx->set.law->relaxes ? 2.0 * g->s.speed : 0.0;
    const double *bound = g->c.bound, force = greater(bound[0], bound[1]);
    const double weight[2] = {bound[0] / force, bound[1] / force}, across = weight[0] * weight[1] * (own[1] / r);
    const double m[4] = {weight[0] * weight[0] * greater(own[0] / r, NEXT_TO_IMMOVABLE), across, across,
                         weight[1] * weight[1] * greater(own[2] / r, NEXT_TO_IMMOVABLE)};
    const double shift[2] = {turn * g->s.n[0], turn * g->s.n[1]};
    double aim[2], pull[2];
    for (int d = 0; d < 2; d++) {
        aim[d] = bound[d] > 0.0 ? quotient(cut(feq[d]), bound[d]) : 0.0;
    }
    const double length = tribo_length(2, aim);
    for (int d = 0; d < 2; d++) {
        aim[d] = (length > HARDEST ? aim[d] / length * HARDEST : aim[d]) - shift[d];
    }
    for (int d = 0; d < 2; d++) {
        pull[d] = -(m[2 * d] * aim[0] + m[2 * d + 1] * aim[1]);
    }
    tribo_disc_alone(x, m, pull, shift);
    memcpy(x->p.y, aim, sizeof aim);
    return tribo_disc_solve(&x->p);
}

int tribo_plane_check_feq(const tribo_context *ctx, tribo_context *note, const double *v, const double *feq)
{
    for (size_t k = 0; k < tribo_plane_count(ctx); k++) {
        double limit[2];
        const size_t i = ctx->planar->first[k];
        const struct contacts c = tribo_planar_view(ctx, i, 2, limit);
        const struct slide s = tribo_planar_slide(&c, 0, 2, v + i);
        for (size_t j = i; tribo_planar_near(ctx->set.law, &s) && j < i + 2; j++) {
            if (!isfinite(feq[j])) {
                return tribo_fail(note, TRIBO_ERR_NOT_FINITE, "feq[%zu] = %g is not finite", j, feq[j]);
            }
        }
    }
    return TRIBO_OK;
}

int tribo_plane_force(const tribo_context *ctx, const double *v, const double *feq, double *f)
{
    const double none[2] = {0.0, 0.0};
    for (size_t k = 0; k < tribo_plane_count(ctx); k++) {
        const size_t i = ctx->planar->first[k];
        struct given g;
        struct disc_alone x;
        tribo_planar_given(ctx, k, v + i, feq ? feq + i : none, &g);
        if (!g.near) {
            tribo_planar_slide_force(ctx->set.law, &g.s, g.c.limit, f + i);
        } else if (!tribo_planar_given_near(ctx, k, &g, feq + i, &x)) {
            return TRIBO_ERR_NO_CONVERGENCE;
        } else {
            for (size_t d = 0; d < 2; d++) {
                const double held = cut(feq[i + d]) - x.p.shift[d] * g.c.bound[d];
                f[i + d] = x.p.place[0] == LENS_INSIDE && g.c.bound[d] > 0.0 ? held : x.p.y[d] * g.c.bound[d];
            }
        }
    }
    return TRIBO_OK;
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
