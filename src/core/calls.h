/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls of core: contacts one by one, groups of contacts that share bodies, static limits; clusters: planar contacts, and the
 * contacts that R couples with them. */
#ifndef TRIBO_CALLS_H
#define TRIBO_CALLS_H

#include "check.h"

/* Bounds of forces; lower NULL: -upper. */
struct bounds {
    const double *lower, *upper;
};

static inline double tribo_lower(const struct bounds *b, size_t i)
{
    return b->lower ? b->lower[i] : -b->upper[i];
}

/* Group g in the workspace. */
static inline struct box_qp *tribo_problem(tribo_context *ctx, size_t g)
{
    return tribo_memory_problem(ctx->op, &ctx->memory, g);
}

/* The force of the contact at place k of a group, as far as the solver resolves it. */
static inline double tribo_carried(const tribo_context *ctx, const struct box_qp *p, size_t k)
{
    const double f = ctx->last.f[p->member[k]];
    return ctx->last.far ? tribo_cut(p, k, f) : f;
}

/* Ends a call in the place of tribo_begin_call and tribo_end_call, where tribo_all_alone. holds: see struct law. */
static inline void tribo_end_alone(tribo_context *ctx, double holds)
{
    ctx->last.rank = 0;
    ctx->last.residual = 0.0;
    ctx->last.linearized = 0;
    ctx->last.slips = SLIPS_IN_FORCES;
    ctx->last.holds = holds;
    ctx->count.skipped += ctx->op->islands;
}

/* ---- alone.c: contacts as if no two shared a body */

/* Returns 1 if the law reads f_eq of a contact of chunk k at v [its size]; 0 for a law with f_eq: all slide with their limits. */
int tribo_any_near(const tribo_context *ctx, size_t k, const double *v);

/* f [n] of contacts that slide at v != 0. */
void tribo_slide(size_t n, const double *restrict v, const double *restrict limit, double *restrict f);

/* The first part of a balance: last.f of contacts that need no solver, and last.feq of these contacts: of all if wanted = 1, else,
 * unless tribo_all_alone, where the law reads f_eq. Finds which contacts of groups are near stick, and lists their groups. plain:
 * |a_i| <= TRIBO_PLAIN. */
void tribo_balance_each(tribo_context *ctx, int plain, int wanted, const double *v, const double *a);

/* tribo_balance after its checks, where n = 1 and tribo_all_alone: takes half the time that any n takes. Returns a status. */
int tribo_balance_one(tribo_context *ctx, int plain, const double *v, const double *a, double *feq, double *f);

/* The first part of a step: last.f = -v/(dt R_ii) within bounds, and its copy f, unless f is NULL. */
void tribo_step_each(tribo_context *ctx, double dt, const double *v, struct bounds b, double *f);

/* ---- balance.c */

/* Begins a call: no group is solved yet. */
void tribo_begin_call(tribo_context *ctx);

/* Adds group g, unless it is TRIBO_ALONE, to those to be solved. */
static inline void tribo_list_group(tribo_context *ctx, size_t g)
{
    struct memory *m = &ctx->memory;
    if (g != TRIBO_ALONE && !m->solved[g]) {
        m->solved[g] = 1;
        m->solved_list[m->nsolved++] = g;
    }
}

/* Puts the contacts of group g in the problem's order, those near stick first; x of the others is set. */
struct box_qp *tribo_collect(tribo_context *ctx, size_t g);

/* Solves the problem of a group, of which near, q, lo and hi are set; a status. */
int tribo_solve_group(tribo_context *ctx, struct box_qp *p);

/* With sharing by previous forces: keeps the forces of groups that the last call did not solve. */
void tribo_keep_forces(tribo_context *ctx);

/* Ends a call on islands without failure: counts those that were not solved, and, with sharing by previous forces, keeps their
 * forces. */
void tribo_end_call(tribo_context *ctx, size_t islands);

/* ---- static.c */

/* A law without stick needs Stribeck velocities where a ratio exceeds 1, a law of the caller no ratio at all; a status. */
int tribo_check_breaking(tribo_context *ctx, const struct law *law, int breaking, const double *ratio);

/* Both directions of a planar contact have the same ratio and velocity; a status. */
int tribo_check_one_ratio(tribo_context *ctx, const double *ratio, const double *velocity, size_t count, const size_t *first);

/* limit [n] of the contacts from i on at v [n]: static near stick, unless |feq| exceeds it; feq NULL: it does not. */
void tribo_find_limits(const tribo_context *ctx, size_t i, size_t n, const double *v, const double *feq, double *limit);

/* The limit by which contact i slides at this speed. */
double tribo_limit_at(const tribo_context *ctx, size_t i, double speed);

/* d(limit)/dv of contact i; 0 without static limits. */
double tribo_limit_rate(const tribo_context *ctx, size_t i, double v);

/* The law's derivatives d [n] of the contacts from i on, of which c is a view, by v, f_eq and the caller's limit. */
void tribo_law_tangents(const tribo_context *ctx, const struct contacts *c, size_t i, size_t n, const double *v,
                        const double *feq, const struct tangents *d);

/* follow.now[i] = limit to slide, at the speed after a step of dt (0: from rest), of each contact of p at its static limit with
 * |f_eq_i| above this limit by more than rounding. Returns the number of these contacts. */
size_t tribo_break_away(tribo_context *ctx, struct box_qp *p, double dt);

/* ---- tangent.c */

/* Changes of all contacts, [n] each; NULL: 0. */
struct change {
    const double *v, *a, *limit;
};

static inline double tribo_entry(const double *x, size_t i)
{
    return x ? x[i] : 0.0;
}

/* The change of the limit of contact i; 0 for open ones, which stay open. */
static inline double tribo_limit_change(const tribo_context *ctx, const struct change *d, size_t i)
{
    return ctx->set.limit[i] > 0.0 ? tribo_entry(d->limit, i) : 0.0;
}

/* ---- clusters: without planar contacts functions have no effect, and return TRIBO_OK or 0 */

/* 1 if contact i is no direction of a planar contact. */
static inline int tribo_is_scalar(const tribo_context *ctx, size_t i)
{
    return !ctx->plane.count || ctx->plane.role[i] == ROLE_SCALAR;
}

/* Directions of the contact that begins with direction i. */
static inline size_t tribo_directions(const tribo_context *ctx, size_t i)
{
    return tribo_is_scalar(ctx, i) ? 1 : 2;
}

/* Returns [n]: number of the group of contact i, or TRIBO_ALONE. For an operator with groups. */
static inline const size_t *tribo_group_of(const tribo_context *ctx)
{
    return ctx->plane.count ? ctx->plane.group_of : ctx->op->group_of;
}

/* The first direction of the contact with direction i. */
static inline size_t tribo_first_direction(const tribo_context *ctx, size_t i)
{
    return i - (ctx->plane.role[i] == ROLE_SECOND);
}

/* Single contacts, and connected ones counted as one, joined by R or by planar contacts. */
static inline size_t tribo_islands(const tribo_context *ctx)
{
    return ctx->plane.count && ctx->op->diagonal ? ctx->plane.islands : ctx->op->islands;
}

/* The stand-in for the limit of direction i in the problem: at most the limit. cut: 1 where it is less; then the force is within
 * it. */
static inline double tribo_plane_reach(const tribo_context *ctx, size_t i)
{
    return lesser(ctx->follow.contacts.bound[i], ctx->plane.radius[i]);
}

static inline int tribo_plane_cut(const tribo_context *ctx, size_t i)
{
    return ctx->plane.radius[i] < ctx->follow.contacts.bound[i];
}

/* ---- planar.c */

/* Makes count planar contacts of ctx, and their clusters for an operator and its memory; a status. *c is empty, or was replaced:
 * its memory is used again. After a failure free *c. */
int tribo_clusters_make(struct clusters *c, tribo_context *ctx, size_t count, const size_t *first, const struct delassus *op,
                        struct memory *m);

/* Gives ctx the planar contacts of from; these and their last solutions, clone having the operator and memory, and no clusters. A
 * status; after a failure ctx has what it had. */
int tribo_clusters_copy(tribo_context *ctx, const tribo_context *from);
int tribo_clusters_clone(tribo_context *clone, const tribo_context *from);

/* Copies the last solution of clusters of the same directions [n]. */
void tribo_clusters_keep(struct clusters *to, const struct clusters *from, size_t n);

/* Frees what is in clusters, which may be empty. */
void tribo_clusters_free(struct clusters *c);

/* Fails if law is of the caller or coupling is TRIBO_PARTITION, and count > 0; a status. */
int tribo_plane_check_coupling(tribo_context *ctx, const struct law *law, int coupling, size_t count, const size_t *first);

/* If epsilon follows the operator: sets widths and rates of planar contacts; time as in tribo_refresh. */
void tribo_clusters_refresh(tribo_context *ctx, int follows, double time);

/* ---- planar_force.c */

/* Forces of clusters in last.f, where those of all others are known; of the balance, and over a step; a status.
 * known [n] or NULL: known[i] != 0 if last.f[i] is the force of scalar contact i. */
int tribo_clusters_balance(tribo_context *ctx, const double *v, const double *a);
int tribo_clusters_step(tribo_context *ctx, double dt, const double *vfree, const signed char *known);

/* last.feq = f_eq of the contacts of cluster q in the last balance; 0 of open ones. */
void tribo_cluster_feq(tribo_context *ctx, size_t q);

/* After a step: sets feels [n] = (R f)_i without the term of f_i, for contacts of clusters. Of planar contacts that slide: sets
 * reverses = TRIBO_SLIP_PLANE, and *vfree = an array with v + vfree where v'(v at the end) > 0. Returns the number of these
 * contacts. */
size_t tribo_clusters_turn(tribo_context *ctx, double dt, const double *v, const double **vfree, double *feels,
                           signed char *reverses);

/* slip of direction i of a planar contact in the last call. */
signed char tribo_plane_slip(const tribo_context *ctx, size_t i);

/* The largest rate at which a planar contact relaxes. */
double tribo_plane_rate(const tribo_context *ctx);

/* Linearizes cluster q at the last tribo_balance_tangent. Returns its contacts [size]. */
const size_t *tribo_cluster_resume(tribo_context *ctx, size_t q, size_t *size);

/* ---- planar_tangent.c */

/* df [size] of cluster q, which was resumed last: forces that f_eq balances. */
void tribo_cluster_product(tribo_context *ctx, size_t q, const struct change *d, double *df);

/* Returns sum_j R_kj df_j over the places j of cluster q without k. */
double tribo_cluster_others(const tribo_context *ctx, size_t q, size_t k, const double *df);

/* 1 if the force of the planar contact with direction i depends on f_eq, at v [n]. */
int tribo_plane_reads_feq(const tribo_context *ctx, size_t i, const double *v);

/* force.c: out [4] = f of all contacts from v and f_eq, and its derivatives by v, f_eq and limit, [n], or if pairs = 1 [n][2];
 * each may be NULL; a status. */
int tribo_find_tangents(const tribo_context *ctx, int pairs, const double *v, const double *feq, double *const *out);

/* out [4] = f of planar contacts from v and f_eq, and its derivatives by v, f_eq and limit, [n][2]; each may be NULL; a
 * status. */
int tribo_plane_force(const tribo_context *ctx, const double *v, const double *feq, double *const *out);

#endif
