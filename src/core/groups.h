/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls of core: contacts one by one, groups of contacts that share bodies, static limits. */
#ifndef TRIBO_GROUPS_H
#define TRIBO_GROUPS_H

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

/* ---- alone.c: contacts as if no two shared a body */

/* tribo_balance and tribo_step_force where tribo_all_alone. feq and f of the balance may be NULL. */
int tribo_balance_alone(tribo_context *ctx, const double *v, const double *a, double *feq, double *f);
int tribo_step_alone(tribo_context *ctx, double dt, const double *v, double *f);

/* The first part of a balance: last.f of contacts that need no solver, and f_eq where the law reads it, or of all such contacts
 * if wanted. Finds which contacts of groups are near stick, and lists their groups. */
void tribo_balance_each(tribo_context *ctx, const double *v, const double *a, int wanted);

/* The first part of a step: last.f = -v/(dt R_ii) within bounds. */
void tribo_step_each(tribo_context *ctx, double dt, const double *v, struct bounds b);

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

/* Ends a call on islands without failure: counts those that were not solved, and, with sharing by previous forces, keeps their
 * forces. */
void tribo_end_call(tribo_context *ctx, size_t islands);

/* ---- static.c */

/* A law without stick needs Stribeck velocities where a ratio exceeds 1; a status. */
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

/* Sets limits over a step of dt: static, but those to slide of contacts that come in sliding at v [n], or NULL, and do not come
 * to a stop: f [n], or NULL, acts against v. Returns 0, and leaves all limits, if f acts against v at all that come in sliding.
 * Overwrites last.v. */
int tribo_hold_for_step(tribo_context *ctx, double dt, const double *v, const double *f);

/* follow.now[i] = limit to slide, at the speed after a step of dt (0: from rest), of each contact of p at its static limit with
 * |f_eq_i| above this limit by more than rounding. Returns the number of these contacts. */
size_t tribo_break_away(tribo_context *ctx, struct box_qp *p, double dt);

/* The same for contacts in no group, by vfree; their forces follow. */
void tribo_break_alone(tribo_context *ctx, double dt, const double *vfree);

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

#endif
