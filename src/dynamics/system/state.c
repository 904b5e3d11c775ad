/* SPDX-License-Identifier: BSD-3-Clause */
/* States, and linear combinations of states, in the caller's degrees of freedom and in the methods'. */
#include "system.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int expansion_set(tribo_system *sys, struct expansion x)
{
    sys->expansion = x;
    sys->work.motion = malloc((tribo_system_size(sys) + x.follow.rows + 2 * sys->ncontact) * sizeof *sys->work.motion);
    return sys->work.motion != NULL;
}

int tribo_expansion_create(tribo_system *sys, struct expansion *x, const double *slides)
{
    const size_t n = sys->ncontact;
    struct triplets follow = {0}, give = {0}, touch = {0};
    size_t w = x->follow.rows;
    for (size_t k = 0; k < w; k++) {
        tribo_triplets_put_row(&follow, k, &x->follow, k);
        tribo_triplets_put_row(&give, k, &x->give, k);
    }
    for (size_t i = 0; i < n; i++) {
        if (slides && slides[i] > 0.0) {
            tribo_triplets_put_row(&follow, w, &sys->direction, i);
            for (size_t k = 0; k < n; k++) {
                tribo_triplets_put(&give, w, k, tribo_compliance_entry(&sys->compliance, i, k));
            }
            tribo_triplets_put(&touch, i, w++, 1.0);
            x->place[x->dofs] = x->dofs;
            x->dofs++;
        } else if (x->touch.rows) {
            tribo_triplets_put_row(&touch, i, &x->touch, i);
        }
    }
    tribo_matrix_free(&x->follow);
    tribo_matrix_free(&x->give);
    tribo_matrix_free(&x->touch);
    const int done = tribo_triplets_finish(&follow, w, sys->ndof, &x->follow) & tribo_triplets_finish(&give, w, n, &x->give) &
                     tribo_triplets_finish(&touch, n, w, &x->touch);
    const struct expansion made = *x;
    *x = (struct expansion){0};
    return expansion_set(sys, made) && done;
}

int tribo_expansion_copy(tribo_system *to, const tribo_system *from)
{
    const struct expansion *x = &from->expansion;
    struct expansion copy = {.dofs = x->dofs, .sliders = x->sliders};
    int done = 1;
    copy.place = tribo_copy_of(x->place, x->dofs, sizeof *x->place, &done);
    copy.terms = tribo_copy_of(x->terms, from->ndof, sizeof *x->terms, &done);
    done &= tribo_matrix_copy(&copy.follow, &x->follow) & tribo_matrix_copy(&copy.give, &x->give) &
            tribo_matrix_copy(&copy.touch, &x->touch);
    return !x->place || (expansion_set(to, copy) && done);
}

void tribo_expansion_free(struct expansion *x)
{
    free(x->place);
    free(x->terms);
    tribo_matrix_free(&x->follow);
    tribo_matrix_free(&x->give);
    tribo_matrix_free(&x->touch);
    memset(x, 0, sizeof *x);
}

/* Returns the index of the displacement of the caller's degree of freedom d in the caller's state. Velocities of sliders are not
 * in the state. */
static size_t displacement_at(const struct expansion *x, size_t d)
{
    const size_t n = x->dofs - x->sliders;
    return d < n ? d : d + n;
}

void tribo_system_read_state(const tribo_system *sys, const double *y, double *to)
{
    const struct expansion *x = &sys->expansion;
    const size_t n = sys->ndof, caller = x->dofs - x->sliders;
    double *off = sys->work.motion + tribo_system_size(sys), *force = off + (x->dofs - n);
    for (size_t d = 0; d < x->dofs; d++) {
        const size_t k = x->place[d];
        if (k < n) {
            to[k] = y[d];
            to[n + k] = y[caller + d];
        } else {
            off[k - n] = y[displacement_at(x, d)];
        }
    }
    /* f = G^-1 J_w (w - follow q) */
    tribo_matrix_multiply_add(&x->follow, -1.0, to, off);
    tribo_matrix_multiply(&x->touch, off, force);
    tribo_compliance_solve(sys, NULL, 1, force);
    tribo_compliance_put(sys, force, to);
    to[tribo_system_energy(sys)] = y[2 * caller + x->sliders];
}

void tribo_system_add_velocities(const tribo_system *sys, const double *y, double *v)
{
    const struct expansion *x = &sys->expansion;
    const size_t n = sys->ndof, caller = x->dofs - x->sliders;
    double *off = sys->work.motion + tribo_system_size(sys);
    for (size_t d = 0; d < caller; d++) {
        if (x->place[d] >= n) {
            off[x->place[d] - n] = y[caller + d];
        }
    }
    tribo_matrix_multiply_add(&x->follow, -1.0, sys->work.motion + n, off);
    tribo_matrix_multiply_add(&x->touch, 1.0, off, v);
}

/* A displacement w is a rounded 0 if less than ROUNDING times the sum of the sizes of its terms. */
#define ROUNDING (16.0 * DBL_EPSILON)

void tribo_system_write_state(tribo_system *sys, double t, const double *from, double *y)
{
    const struct expansion *x = &sys->expansion;
    const size_t n = sys->ndof, caller = x->dofs - x->sliders, without = x->dofs - n;
    double *force = sys->work.motion + tribo_system_size(sys) + without, *v = force + sys->ncontact;
    for (int rate = 0; rate < 2; rate++) {
        const double *q = from + (rate ? n : 0);
        if (!rate) {
            tribo_compliance_get(sys, from, force);
        } else if (without > x->sliders) {
            memset(v, 0, sys->ncontact * sizeof *v);
            tribo_system_set_time(sys, t);
            tribo_normals_move(sys, from, from + n);
            tribo_system_loads(sys, DRIVES_BASE, 0, -1.0, v);
            tribo_matrix_multiply_add(&sys->direction, 1.0, q, v);
            tribo_compliance_move(sys, from, v, force); /* force: f' */
        }
        for (size_t d = 0; d < (rate ? caller : x->dofs); d++) {
            const size_t k = x->place[d], w = k - n;
            double *to = y + (rate ? caller + d : displacement_at(x, d));
            *to = k < n ? q[k] : tribo_matrix_row_dot(&x->follow, w, q) + tribo_matrix_row_dot(&x->give, w, force);
            if (k >= n &&
                fabs(*to) < ROUNDING * (tribo_matrix_row_size(&x->follow, w, q) + tribo_matrix_row_size(&x->give, w, force))) {
                *to = 0.0;
            }
        }
    }
    y[2 * caller + x->sliders] = from[tribo_system_energy(sys)];
}

void tribo_system_add_part(const tribo_system *sys, size_t d, double part, double *q, double *f)
{
    const struct expansion *x = &sys->expansion;
    const size_t k = x->place ? x->place[d] : d, w = k - sys->ndof;
    if (k < sys->ndof) {
        q[k] += part;
        return;
    }
    tribo_matrix_add_row(&x->follow, w, part, q);
    tribo_matrix_add_row(&x->give, w, part, f);
}

void tribo_system_read_combination(const tribo_system *sys, const double *c, double *to)
{
    const struct compliance *g = &sys->compliance;
    const size_t n = sys->ndof, caller = tribo_system_ndof(sys);
    double *force = sys->work.put_limit;
    memset(to, 0, 2 * n * sizeof *to);
    for (size_t rate = 0; rate < 2; rate++) {
        memset(force, 0, sys->ncontact * sizeof *force);
        for (size_t d = 0; d < caller; d++) {
            tribo_system_add_part(sys, d, c[d + rate * caller], to + rate * n, force);
        }
        for (size_t i = 0; i < g->count; i++) {
            to[2 * n + rate * g->count + i] = force[g->contact[i]];
        }
    }
}
