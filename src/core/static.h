/* SPDX-License-Identifier: BSD-3-Clause */
/* Static limits: static.c. */
#ifndef TRIBO_STATIC_H
#define TRIBO_STATIC_H

#include "groups.h"

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
 * to a stop: f [n], or NULL, acts against v. Returns 0, and leaves all limits, if f acts against v at all that come in sliding. */
int tribo_hold_for_step(const tribo_context *ctx, double dt, const double *v, const double *f);

/* Gives contacts whose f_eq exceeds the static limit that to slide at the end of a step of dt, or (0) from rest. Returns their
 * number. */
size_t tribo_break_away(tribo_context *ctx, struct box_qp *p, double dt);

/* The same for contacts in no group, by vfree; their forces follow. */
void tribo_break_alone(tribo_context *ctx, double dt, const double *vfree);

#endif
