/* SPDX-License-Identifier: BSD-3-Clause */
/* Series of normal loads that follow the motion, and of limits that follow these: while a normal is pressed both are linear in
 * the displacements. */
#include "event_series.h"
#include "common/real.h"

#include <string.h>

void tribo_normal_series_expand(struct event *e, size_t k)
{
    const tribo_system *sys = e->sys;
    double *limit = e->limit + k * sys->ncontact;
    for (size_t i = 0; i < sys->normals.count; i++) {
        const struct normal *n = &sys->normals.normal[i];
        const double depth = tribo_matrix_row_dot(&sys->direction, n->row, e->q + k * sys->ndof) - (k ? 0.0 : n->gap);
        const double sure = n->pressed ? greater(depth, 0.0) : lesser(depth, 0.0); /* on its side, by the decision */
        limit[n->row] = n->stiffness * (k ? depth : sure);
    }
    for (size_t i = 0; i < sys->normals.followers; i++) {
        const struct follower *f = &sys->normals.follower[i];
        limit[f->contact] = limit[f->second] = f->mu * limit[sys->normals.normal[f->normal].row];
    }
}

void tribo_normal_series_slide(const struct event *e, size_t k, double *slide)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const tribo_system *sys = e->sys;
    memset(slide, 0, sys->ncontact * sizeof *slide);
    for (size_t i = 0; i < sys->normals.followers; i++) {
        const struct follower *f = &sys->normals.follower[i];
        const struct normal *n = &sys->normals.normal[f->normal];
        if (tribo_slides(m->state.slip[f->contact])) {
            slide[f->contact] = -m->state.slip[f->contact] * f->mu * n->stiffness *
                                tribo_matrix_row_dot(&sys->direction, n->row, e->u + k * sys->ndof);
        }
    }
}

void tribo_normal_series_perturb(const struct event *e, size_t columns, const double *x, double *to)
{
    const tribo_system *sys = e->sys;
    const struct matrix *j = &sys->direction;
    const struct normals *s = &sys->normals;
    memset(to, 0, sys->ncontact * columns * sizeof *to);
    for (size_t k = 0; k < s->count; k++) {
        const struct normal *n = s->normal + k;
        for (size_t d = j->first[n->row]; n->pressed && d < j->first[n->row + 1]; d++) {
            tribo_add(to + n->row * columns, -n->stiffness * j->val[d], x + j->col[d] * columns, columns);
        }
    }
    for (size_t k = 0; k < s->followers; k++) {
        const struct follower *f = s->follower + k;
        const signed char slip = e->events.stick_slip.state.slip[f->contact];
        const double *normal = to + s->normal[f->normal].row * columns;
        tribo_add(to + f->contact * columns, tribo_slides(slip) ? slip * f->mu : 0.0, normal, columns);
    }
}

void tribo_event_perturb_limit(const struct event *e, size_t i, const double *q, size_t columns, double *g)
{
    const struct follower *f = tribo_normals_follower(e->sys, i);
    const struct normal *n = f ? &e->sys->normals.normal[f->normal] : NULL;
    const struct matrix *j = &e->sys->direction;
    memset(g, 0, columns * sizeof *g);
    for (size_t d = n ? j->first[n->row] : 0; n && n->pressed && d < j->first[n->row + 1]; d++) {
        tribo_add(g, f->mu * n->stiffness * j->val[d], q + j->col[d] * columns, columns);
    }
}
