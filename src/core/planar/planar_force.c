/* Forces of planar contacts, and of the scalar ones that R couples them with.
 *
 * In units of its limits, y = f/limit, a planar contact slides with y = -n, n being the direction of limit v. Near stick
 * y is in the lens D ∩ (D - c), D being the unit disc and c = 2 |v|/epsilon n, which is kappa in these units; and y minimizes
 * 1/2 y'Sy + pull'y over the lenses and intervals of its cluster, S = limit R limit. Limits that differ make an ellipse: its
 * longer way to the edge of the band, limit epsilon, holds for both directions, so that c points along limit v, as f does where
 * it slides.
 *
 * Force and R come in any units: in S limits and R are parts of the largest ones near stick in the cluster. A limit that is far
 * beyond the force stands back for a reach that is not, see planar_reach.c; c is then kappa/reach. */
#include <float.h>
#include <string.h>

#include "core/context.h"

/* --------------------------------------------------------------------------------------------------------- clusters */

/* Takes the direction at place k into the problem; directions: 1, or of a pair 2 and 0. */
static void planar_force_take(tribo_context *ctx, size_t k, size_t directions, double shift)
{
    struct disc_qp *p = &ctx->plane.problem;
    ctx->plane.shift[p->size] = shift;
    ctx->plane.directions[p->size] = (unsigned char)directions;
    ctx->plane.near[p->size++] = k;
}

/* Takes those directions of the planar contact i, at place k, that have a limit. */
static void take_pair(tribo_context *ctx, size_t k, size_t i, const double *shift)
{
    const double *bound = ctx->follow.contacts.bound + i;
    const int both = bound[0] > 0.0 && bound[1] > 0.0;
    for (size_t d = 0; d < 2; d++) {
        if (bound[d] > 0.0) {
            planar_force_take(ctx, k + d, both ? 2 - 2 * d : 1, shift[d]);
        } else {
            ctx->last.f[i + d] = 0.0;
        }
    }
}

/* Takes scalar contact i at place k if it is near stick. */
static void take_scalar(tribo_context *ctx, size_t k, size_t i, double v)
{
    const struct law *law = ctx->set.law;
    const struct contacts *c = &ctx->follow.contacts;
    if (tribo_scalar_near(law, c, i, v)) {
        planar_force_take(ctx, k, 1, law->relaxes ? 2.0 * quotient(v, tribo_epsilon_of(c, i)) : 0.0);
    } else if (law->uses_feq && ctx->last.did.of[i] == STORED) {
        ctx->last.f[i] = sliding(v, c->limit[i]);
    }
}

/* Takes the planar contact that begins with direction i if it is near stick, or finds its force. */
static void take_planar(tribo_context *ctx, size_t k, size_t i, const double *v)
{
    const struct slide s = tribo_planar_slide(&ctx->follow.contacts, i, v);
    const double turn = ctx->set.law->relaxes ? 2.0 * s.speed : 0.0, shift[2] = {turn * s.n[0], turn * s.n[1]};
    if (!tribo_planar_near(ctx->set.law, &s)) {
        tribo_planar_slide_force(ctx->set.law, &s, ctx->follow.contacts.limit + i, ctx->last.f + i);
        return;
    }
    take_pair(ctx, k, i, shift);
}

int tribo_planar_collect(tribo_context *ctx, const struct cluster *g, const double *v)
{
    struct disc_qp *p = &ctx->plane.problem;
    const size_t *member = ctx->planar->member + g->member;
    p->size = 0;
    for (size_t k = 0; k < g->size; k++) {
        const size_t i = member[k];
        if (ctx->planar->role[i] == ROLE_FIRST) {
            take_planar(ctx, k, i, v + i);
        } else if (ctx->planar->role[i] == ROLE_SCALAR) {
            take_scalar(ctx, k, i, v[i]);
        }
    }
    return p->size > 0;
}

/* What the forces that are given make of a, and a itself: of a cluster's place k. */
static double pull_of(const tribo_context *ctx, const struct cluster *g, size_t k, double a)
{
    const size_t *member = ctx->planar->member + g->member;
    const double *row = ctx->planar->r + g->r + k * g->size;
    double sum = cut(a);
    for (size_t j = 0, e = 0; j < g->size; j++) {
        if (e < ctx->plane.problem.size && ctx->plane.near[e] == j) {
            e++;
        } else if (row[j] != 0.0) {
            const double bound = ctx->follow.contacts.bound[member[j]];
            sum += row[j] * clamp(tribo_force_of(ctx, member[j]), -bound, bound);
        }
    }
    return sum;
}

struct unit tribo_planar_units(const tribo_context *ctx, const struct cluster *g)
{
    const size_t *member = ctx->planar->member + g->member;
    struct unit u = {0.0, 0.0};
    for (size_t e = 0; e < ctx->plane.problem.size; e++) {
        const size_t k = ctx->plane.near[e];
        u.force = greater(u.force, tribo_planar_reach(ctx, member[k]));
        u.r = greater(u.r, ctx->planar->r[g->r + k * (g->size + 1)]);
    }
    return u;
}

/* Of what pulls harder than anything that friction could do about it, in units of that, only the direction matters. */
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

/* The problem of forces in parts of their reach, from pull_of. */
static void pose_cluster(tribo_context *ctx, const struct cluster *g)
{
    struct disc_qp *p = &ctx->plane.problem;
    const struct unit u = tribo_planar_units(ctx, g);
    const size_t n = p->size, *member = ctx->planar->member + g->member, *near = ctx->plane.near;
    int turned = 0;
    for (size_t e = 0; e < n; e++) {
        p->weight[e] = tribo_planar_reach(ctx, member[near[e]]) / u.force;
        p->y[e] = ctx->plane.y[member[near[e]]];
    }
    for (size_t e = 0; e < n; e++) {
        const double *row = ctx->planar->r + g->r + near[e] * g->size;
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

static void find_pulls(tribo_context *ctx, const struct cluster *g, const double *a)
{
    for (size_t e = 0; e < ctx->plane.problem.size; e++) {
        const size_t k = ctx->plane.near[e];
        ctx->plane.pull[e] = pull_of(ctx, g, k, a[ctx->planar->member[g->member + k]]);
    }
}

void tribo_planar_resume(tribo_context *ctx, const struct cluster *g, const double *a)
{
    find_pulls(ctx, g, a);
    tribo_planar_arrange(ctx, g);
    pose_cluster(ctx, g);
}

/* Where forces are far within their reach, distances of this part of it are none. */
#define NEAREST 1e-20

/* Forces that miss their balance by more than this part of a reach are none. */
#define TOO_FAR 1e-6

static int planar_force_solve(tribo_context *ctx, const struct cluster *g)
{
    struct disc_qp *p = &ctx->plane.problem;
    const size_t *member = ctx->planar->member + g->member, *near = ctx->plane.near;
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

/* Until all forces are within their reach; where limits are static, until no contact breaks away. */
static int solve_all(tribo_context *ctx, const struct cluster *g, double dt, const double *a)
{
    int status;
    do {
        find_pulls(ctx, g, a);
        tribo_planar_estimate(ctx, g);
        do {
            tribo_planar_arrange(ctx, g);
            pose_cluster(ctx, g);
            status = planar_force_solve(ctx, g);
        } while (!status && ctx->plane.cuts && tribo_planar_widen(ctx, g));
    } while (!status && ctx->set.breaking && tribo_planar_break(ctx, g, dt, a));
    ctx->plane.solved++;
    ctx->last.rank += status ? 0 : ctx->plane.problem.factor.sets.rank;
    return status;
}

/* Where planar contacts join islands there are fewer of them; and those that clusters solve for are not skipped. */
static void count_skipped(tribo_context *ctx)
{
    ctx->count.skipped += ctx->planar->islands;
    ctx->count.skipped -= ctx->op->islands + ctx->plane.solved;
}

/* The forces of planar contacts are stored, whatever they did. */
static void store_planar(tribo_context *ctx)
{
    struct deeds *did = &ctx->last.did;
    for (size_t k = 0; k < ctx->planar->count; k++) {
        for (size_t i = ctx->planar->first[k]; i < ctx->planar->first[k] + 2; i++) {
            unsigned char *stored = &did->stored[i / TRIBO_CHUNK];
            did->of[i] = STORED;
            *stored = *stored == NONE_STORED ? SOME_STORED : *stored;
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------- f_eq */

static double scalar_feq(const tribo_context *ctx, const struct cluster *g, size_t k, double a)
{
    return quotient(-tribo_planar_others(ctx, g, k, k, 1, a), ctx->planar->r[g->r + k * (g->size + 1)]);
}

static void planar_feq(const tribo_context *ctx, const struct cluster *g, size_t k, const double *a, double *feq)
{
    const double *r = ctx->planar->r + g->r + k * (g->size + 1), own[3] = {r[0], r[1], r[g->size + 1]};
    feq[0] = tribo_planar_others(ctx, g, k, k, 2, a[0]);
    feq[1] = tribo_planar_others(ctx, g, k + 1, k, 2, a[1]);
    const struct block block = tribo_block_of(own);
    tribo_planar_push(&block, feq);
}

void tribo_planar_feq(tribo_context *ctx, const double *a)
{
    const struct planar *c = ctx->planar;
    const double *limit = ctx->set.limit;
    for (size_t q = 0; q < c->clusters; q++) {
        const struct cluster *g = &c->cluster[q];
        for (size_t k = 0; k < g->size; k++) {
            const size_t i = c->member[g->member + k];
            double *feq = ctx->last.feq + i;
            if (c->role[i] == ROLE_SCALAR) {
                *feq = limit[i] > 0.0 ? scalar_feq(ctx, g, k, a[i]) : 0.0;
            } else if (c->role[i] == ROLE_FIRST && (limit[i] > 0.0 || limit[i + 1] > 0.0)) {
                planar_feq(ctx, g, k, a + i, feq);
            } else if (c->role[i] == ROLE_FIRST) {
                feq[0] = feq[1] = 0.0;
            }
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------ calls */

/* What the law says to the f_eq of a scalar contact. */
static void scalar_laws(tribo_context *ctx, const struct cluster *g, const double *v, const double *a)
{
    const size_t *member = ctx->planar->member + g->member;
    for (size_t e = 0; ctx->set.law->remembers && e < ctx->plane.problem.size; e++) {
        const size_t i = member[ctx->plane.near[e]];
        if (ctx->planar->role[i] == ROLE_SCALAR) {
            const struct contacts c = tribo_contacts_from(&ctx->follow.contacts, i);
            ctx->last.feq[i] = scalar_feq(ctx, g, ctx->plane.near[e], a[i]);
            ctx->set.law->force(&c, 1, v + i, ctx->last.feq + i, ctx->plane.v + i);
        }
    }
    for (size_t e = 0; ctx->set.law->remembers && e < ctx->plane.problem.size; e++) {
        const size_t i = member[ctx->plane.near[e]];
        ctx->last.f[i] = ctx->planar->role[i] == ROLE_SCALAR ? ctx->plane.v[i] : ctx->last.f[i];
    }
}

int tribo_planar_balance(tribo_context *ctx, const double *v, const double *a)
{
    int status = TRIBO_OK;
    store_planar(ctx);
    ctx->plane.solved = 0;
    for (size_t k = 0; !status && k < ctx->planar->clusters; k++) {
        const struct cluster *g = &ctx->planar->cluster[k];
        if (ctx->set.breaking) {
            tribo_planar_hold(ctx, g, v);
        }
        if (tribo_planar_collect(ctx, g, v)) {
            status = solve_all(ctx, g, 0.0, a);
            scalar_laws(ctx, g, v, a);
        }
    }
    count_skipped(ctx);
    return status;
}

/* All contacts of a cluster whose force is not known. */
static int collect_free(tribo_context *ctx, const struct cluster *g, const signed char *known)
{
    struct disc_qp *p = &ctx->plane.problem;
    const size_t *member = ctx->planar->member + g->member;
    const double *limit = ctx->set.limit, none[2] = {0.0, 0.0};
    p->size = 0;
    for (size_t k = 0; k < g->size; k++) {
        const size_t i = member[k];
        const int role = ctx->planar->role[i];
        if (role == ROLE_FIRST) {
            take_pair(ctx, k, i, none);
        } else if (role == ROLE_SCALAR && limit[i] > 0.0 && !(known && known[i])) {
            planar_force_take(ctx, k, 1, 0.0);
        }
    }
    return p->size > 0;
}

int tribo_planar_step(tribo_context *ctx, double dt, const double *v, const signed char *known)
{
    int status = TRIBO_OK;
    ctx->plane.solved = 0;
    for (size_t k = 0; !status && k < ctx->planar->clusters; k++) {
        const struct cluster *g = &ctx->planar->cluster[k];
        const size_t *member = ctx->planar->member + g->member;
        for (size_t j = 0; j < g->size; j++) {
            ctx->plane.a[member[j]] = quotient(v[member[j]], dt);
        }
        if (collect_free(ctx, g, known)) {
            status = solve_all(ctx, g, dt, ctx->plane.a);
        }
    }
    count_skipped(ctx);
    return status;
}

double tribo_planar_feels(const tribo_context *ctx, const struct cluster *g, size_t k, int own)
{
    return tribo_planar_others(ctx, g, k, k, own ? 0 : 1, 0.0);
}

/* ------------------------------------------------------------------------------------------------ f_eq that is given */

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

int tribo_planar_check_feq(const tribo_context *ctx, tribo_context *note, const double *v, const double *feq)
{
    for (size_t k = 0; k < ctx->planar->count; k++) {
        double limit[2];
        const size_t i = ctx->planar->first[k];
        const struct contacts c = tribo_planar_view(ctx, i, limit);
        const struct slide s = tribo_planar_slide(&c, 0, v + i);
        for (size_t j = i; tribo_planar_near(ctx->set.law, &s) && j < i + 2; j++) {
            if (!isfinite(feq[j])) {
                return tribo_fail(note, TRIBO_ERR_NOT_FINITE, "feq[%zu] = %g is not finite", j, feq[j]);
            }
        }
    }
    return TRIBO_OK;
}

/* Whether f_eq is beyond the limits. */
static int beyond(const double *limit, const double *feq)
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
    g->c = tribo_planar_view(ctx, i, g->limit);
    g->s = tribo_planar_slide(&g->c, 0, v);
    g->near = tribo_planar_near(ctx->set.law, &g->s);
    if (ctx->set.breaking) {
        tribo_planar_limits(ctx, i, g->near && !beyond(g->limit, feq), v, g->limit);
    }
}

int tribo_planar_force(const tribo_context *ctx, const double *v, const double *feq, double *f)
{
    const double none[2] = {0.0, 0.0};
    for (size_t k = 0; k < ctx->planar->count; k++) {
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

/* ----------------------------------------------------------------------------------------------------------- queries */

signed char tribo_planar_slip(const tribo_context *ctx, size_t k)
{
    const size_t i = ctx->planar->first[k];
    const double *limit = ctx->follow.contacts.limit + i, *f = ctx->last.f + i, rounding = 8.0 * DBL_EPSILON;
    if (!(limit[0] > 0.0 || limit[1] > 0.0)) {
        return TRIBO_SLIP_OPEN;
    }
    const double y[2] = {limit[0] > 0.0 ? quotient(f[0], limit[0]) : 0.0, limit[1] > 0.0 ? quotient(f[1], limit[1]) : 0.0};
    return tribo_length(2, y) >= ctx->last.holds * (1.0 - rounding) ? TRIBO_SLIP_PLANE : 0;
}

void tribo_planar_slips(const tribo_context *ctx, signed char *slip)
{
    for (size_t k = 0; k < ctx->planar->count; k++) {
        const signed char own = tribo_planar_slip(ctx, k);
        for (size_t i = ctx->planar->first[k]; i < ctx->planar->first[k] + 2; i++) {
            slip[i] = (signed char)(ctx->follow.contacts.limit[i] > 0.0 ? own : TRIBO_SLIP_OPEN);
        }
    }
}

double tribo_planar_rate(const tribo_context *ctx, size_t k)
{
    double limit[2];
    const struct contacts c = tribo_planar_view(ctx, ctx->planar->first[k], limit);
    const double *own = ctx->planar->own[k], none[2] = {0.0, 0.0};
    const struct slide s = tribo_planar_slide(&c, 0, none);
    const double far = s.part[0] == 1.0 ? c.bound[0] : c.bound[1];
    if (s.open) {
        return 0.0;
    }
    const double a = product(s.part[0], product(s.part[0], own[0])), b = product(s.part[0], product(s.part[1], own[1]));
    const double d = product(s.part[1], product(s.part[1], own[2]));
    const double turned[2] = {0.5 * a - 0.5 * d, b};
    return product(2.0 * quotient(far, s.epsilon), 0.5 * a + 0.5 * d + tribo_length(2, turned));
}
