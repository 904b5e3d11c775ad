/* SPDX-License-Identifier: BSD-3-Clause */
/* Groups of contacts that share bodies: calls that solve box problems. */
#ifndef TRIBO_GROUPS_H
#define TRIBO_GROUPS_H

#include "contacts.h"

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

/* With sharing by previous forces: keeps those of groups that were not solved. */
void tribo_remember_forces(tribo_context *ctx);

/* ---- step.c */

/* Finds last.f within bounds with v + dt R f = 0, or pushed against a bound; a status. known [n] or NULL: not 0 for scalar contacts
 * of clusters whose force is in last.f. */
int tribo_solve_step(tribo_context *ctx, double dt, const double *v, struct bounds b, const signed char *known);

/* tribo_step_force without checks. v [n]: velocities at the begin, or NULL; read where limits are static. */
int tribo_step_at_end(tribo_context *ctx, double dt, const double *v, const double *vfree, double *f);

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
