/* SPDX-License-Identifier: BSD-3-Clause */
#include "derivative.h"

#include <stdlib.h>
#include <string.h>

void tribo_derivative_begin(struct derivative *d, struct events *e, const tribo_system *sys)
{
    for (size_t k = 0; k < d->steps; k++) {
        if (d->step[k].phase) {
            d->events->motion->release(d->step[k].phase);
        }
        free(d->step[k].slip);
        free(d->step[k].jump);
    }
    free(d->matrix);
    d->matrix = NULL;
    d->steps = 0;
    d->events = e;
    d->sys = sys;
}

void tribo_derivative_free(struct derivative *d)
{
    tribo_derivative_begin(d, NULL, NULL);
    free(d->step);
}

/* Appends an empty step. Returns NULL if out of memory. */
static struct derivative_step *add_step(struct derivative *d)
{
    if (d->steps == d->room) {
        const size_t room = 2 * d->room + 16;
        struct derivative_step *step = realloc(d->step, room * sizeof *step);
        if (!step) {
            return NULL;
        }
        d->step = step;
        d->room = room;
    }
    memset(d->step + d->steps, 0, sizeof *d->step);
    return d->step + d->steps++;
}

int tribo_derivative_add_phase(struct derivative *d, double tau, const signed char *slip)
{
    const struct motion *motion = d->events->motion;
    struct derivative_step *s = add_step(d);
    int done = s != NULL;
    if (s) {
        s->tau = tau;
        s->slip = tribo_copy_of(slip, d->sys->ncontact, 1, &done);
        s->phase = motion->keep ? motion->keep(d->events->own, tau) : NULL;
    }
    return done && (s->phase || !motion->keep);
}

int tribo_derivative_add_jump(struct derivative *d, const double *row, double slope, const double *column)
{
    const size_t n = tribo_system_energy(d->sys), moved = n - d->sys->ndof;
    struct derivative_step *s = add_step(d);
    double *jump = s ? calloc(n + moved, sizeof *jump) : NULL;
    if (jump) {
        s->jump = jump;
        tribo_add(jump, 1.0 / slope, row, n);
        memcpy(jump + n, column, moved * sizeof *column);
    }
    return jump != NULL;
}

int tribo_derivative_apply(const struct derivative *d, size_t first, size_t columns, double *v)
{
    const size_t n = d->sys->ndof, all = tribo_system_energy(d->sys);
    double *work = malloc((2 * d->sys->ncontact + 1) * columns * sizeof *work);
    int status =
        work ? TRIBO_OK
             : tribo_system_fail(d->sys, TRIBO_ERR_MEMORY, "out of memory for %zu perturbation%s", columns, plural(columns));
    for (size_t k = first; !status && k < d->steps; k++) {
        const struct derivative_step *s = d->step + k;
        if (s->jump) {
            memset(work, 0, columns * sizeof *work);
            tribo_multiply_add(1, all, columns, 1.0, s->jump, v, work);
            tribo_multiply_add(all - n, 1, columns, 1.0, s->jump + all, work, v + n * columns);
            continue;
        }
        if (d->sys->compliance.count) {
            tribo_compliance_perturb(d->sys, s->slip, columns, v, work);
        }
        status = d->events->motion->transition(d->events->own, s->phase, s->tau, columns, v);
    }
    free(work);
    return status;
}

int tribo_derivative_rests(const struct derivative *d)
{
    for (size_t i = 0; i < d->sys->ncontact; i++) {
        size_t k = 0;
        while (k < d->steps && (d->step[k].jump || d->step[k].slip[i] == TRIBO_SLIP_STUCK)) {
            k++;
        }
        if (k == d->steps) {
            return 1;
        }
    }
    return 0;
}
