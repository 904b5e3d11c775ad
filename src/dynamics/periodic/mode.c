/* SPDX-License-Identifier: BSD-3-Clause */
/* Nonlinear modes by the extended periodic motion concept (Krack 2015): M q'' + (C - 2 delta M) q' + K q = J'f without loads in
 * time, periodic with T. Unknowns of the shooting beside x: T and delta; conditions at the beginning of the period: c'y =
 * amplitude, c'y' = 0.
 *
 * A copy of the system, the twin, has the damping C - 2 delta M, and a driver of its own; questions about the mode go to the
 * search of that driver. */
#include "shooting.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* LEAST: amplitude of the first mode of a path from a linear one over that wanted. STEEPEST, FLATTEST: steps of amplitudes of a
 * path, as factors; at most MOST_SHOTS of them. */
#define LEAST 1e-4
#define STEEPEST 4.0
#define FLATTEST 1.02
enum { MOST_SHOTS = 60 };

/* NEARBY: difference of delta, times the period, for the derivative by delta. MOST_GROWTH: largest |delta| T; zeta is at most 1.
 * STRAYS: largest change of a period by a search, as a factor. UNSEEN: |c'y| over the size of a mode below which c'y is at
 * rest. */
#define NEARBY 1e-7
#define MOST_GROWTH 6.3
#define STRAYS 1.3
#define UNSEEN 1e-8

/* -------------------------------------------------------------------------------------------------------------- the twin */

int tribo_shooting_set_damping(struct shooting *s, const tribo_system *like, double factor, double delta)
{
    tribo_system *sys = s->map.sys;
    struct matrix one = {0}, c = {0}, rates = {0};
    const int damped = like->c.rows > 0;
    const int done = tribo_matrix_diagonal(&one, sys->ndof, NULL) &&
                     tribo_matrix_sum(&c, damped ? factor : 0.0, damped ? &like->c : &sys->mass, -2.0 * delta, &sys->mass) &&
                     tribo_matrix_sum(&rates, damped ? factor : 0.0, damped ? &like->damping : &one, -2.0 * delta, &one);
    tribo_matrix_free(&one);
    if (!done) {
        tribo_matrix_free(&c);
        return tribo_error(s->map.drv->message, TRIBO_ERR_MEMORY, "out of memory for a damping matrix");
    }
    tribo_system_put_damping(sys, &c, &rates);
    return s->map.drv->at_work->open(s->map.drv, &s->map.events);
}

/* The unknowns are T/unit[0] and delta/unit[1]. */
static int mode_apply(struct shooting *s, const struct point *p)
{
    const double period = p->unknown[0] * s->extra.unit[0], first = s->extra.first;
    const double delta = p->unknown[1] * s->extra.unit[1];
    if (!(period >= first / STRAYS && period <= first * STRAYS && fabs(delta) * period <= MOST_GROWTH)) {
        return tribo_error(s->map.drv->message, TRIBO_ERR_NO_CONVERGENCE,
                           "no mode was found: from period = %g the search goes to %g, delta = %g", first, period, delta);
    }
    s->map.period = period;
    tribo_period_map_choose(&s->map, s->map.odd);
    return tribo_shooting_set_damping(s, s->mode->like, 1.0, delta);
}

/* Conditions at the beginning: c'y = amplitude and c'y' = 0, the accelerations as at the end. */
static int mode_border(struct shooting *s, struct point *p)
{
    struct period_map *m = &s->map;
    const size_t n = m->n, dofs = m->sys->ndof, count = s->extra.count;
    const double *c = s->mode->c, sign = p->odd ? -1.0 : 1.0, later = NEARBY / m->period;
    const double rate = tribo_dot(c, p->end + dofs, dofs) + tribo_dot(c + dofs, m->variation.acceleration, dofs);
    double *by_period = p->border, *by_growth = by_period + n,
           *row[] = {by_period + count * n, by_period + count * n + n + count};
    double *image = s->guess, *states = s->a, *functional = states + n * n; /* s->step is that of the search */
    tribo_period_map_rate(m, p->end, by_period);
    for (size_t i = 0; i < n; i++) {
        by_period[i] *= sign * m->span / m->period * s->extra.unit[0];
    }
    int status = tribo_period_map_matrix(m, p);
    /* values and rows, in coordinates */
    p->value[0] = tribo_dot(c, p->y, 2 * dofs) - s->mode->amplitude;
    p->value[1] = sign * rate;
    memset(row[0], 0, 2 * (n + count) * sizeof *row[0]);
    for (size_t k = 0; k < 2; k++) {
        memset(functional, 0, n * sizeof *functional);
        memcpy(functional, c, 2 * dofs * sizeof *c);
        status = status || k == 0 ? status
                                  : tribo_driver_pass(m->drv, tribo_variation_rate_row(&m->variation, m->events, c, functional));
        p->value[1] += k ? tribo_dot(functional, p->y, n) - sign * tribo_dot(functional, p->end, n) : 0.0;
        for (size_t i = 0; i < n * n; i++) {
            s->b[i] = i % (n + 1) == 0;
        }
        tribo_energy_norm_state(&m->norm, n, s->b, states);
        tribo_multiply_transposed_add(n, 1, n, functional, states, row[k]);
        const double size = tribo_energy_length(row[k], n);
        for (size_t i = 0; size > 0.0 && i < n; i++) {
            row[k][i] /= size;
        }
        p->value[k] /= size > 0.0 ? size : 1.0;
        if (count > 2 && k == 0 && size > 0.0) { /* the amplitude is an unknown, too */
            row[0][n + 2] = -s->extra.unit[2] / size;
        }
        row[k][n + 1] = k && size > 0.0 ? 2.0 * tribo_dot(c + dofs, p->y + dofs, dofs) * s->extra.unit[1] / size : 0.0;
    }
    /* by delta: a difference */
    memcpy(image, p->x, n * sizeof *image);
    status = status ? status : tribo_shooting_set_damping(s, s->mode->like, 1.0, p->unknown[1] * s->extra.unit[1] + later);
    status = status ? status : tribo_period_map_march(m, m->span, 1, NULL, image);
    for (size_t i = 0; i < n; i++) {
        by_growth[i] = (sign * image[i] - p->image[i]) / later * s->extra.unit[1];
    }
    return status ? status : mode_apply(s, p);
}

const struct border tribo_mode_border = {.count = 2, .apply = mode_apply, .border = mode_border};

/* -------------------------------------------------------------------------------------------------------------- search */

/* Sets x at s->here = the linear mode of this amplitude, and its period and delta, of the structure with contacts that stick,
 * sticks = 1, or slide: of those that move c'y the one of the frequency nearest to omega; omega = 0: of the lowest one. *found =
 * 0: there is none. Returns a status. */
static int linear_mode(struct shooting *s, int sticks, double amplitude, double omega, double *period, double *delta, int *found)
{
    const tribo_system *sys = s->map.sys;
    const size_t n = sys->ndof, all = s->map.n;
    const double most = tribo_largest(s->map.norm.natural, n), *c = s->mode->c;
    double *states = calloc(n * all + n + 1, sizeof *states), *value = states + n * all, *y = s->step, best = HUGE_VAL;
    *found = 0;
    if (!states) {
        return tribo_error(s->map.drv->message, TRIBO_ERR_MEMORY, "out of memory for linear modes");
    }
    const int status = tribo_driver_pass(s->map.drv, tribo_energy_norm_modes(&s->map.norm, sys, sticks, value, states));
    for (size_t k = 0; !status && k < n; k++) {
        const double *const move = states + k * all, w = sqrt(greater(value[k], 0.0));
        const double part = tribo_dot(c, move, n), swing = w * tribo_dot(c + n, move, n), seen = hypot(part, swing);
        const double size = tribo_energy_length(move, n) * (tribo_energy_length(c, n) + w * tribo_energy_length(c + n, n));
        if (!(w > UNSEEN * most) || !(seen > UNSEEN * size) || !(fabs(w - omega) < best)) {
            continue;
        }
        best = fabs(w - omega);
        *found = 1;
        *period = FULL_TURN / w;
        *delta = 0.0;
        for (size_t d = 0; d < n && sys->c.rows; d++) {
            *delta += 0.5 * move[d] * tribo_matrix_row_dot(&sys->c, d, move);
        }
        for (size_t d = 0; d < all; d++) { /* at the largest c'y */
            y[d] = (d >= n && d < 2 * n ? move[d - n] * w * swing : move[d] * part) * (amplitude / (seen * seen));
        }
        tribo_energy_norm_of(&s->map.norm, 1, y, s->here->x);
    }
    free(states);
    return status;
}

/* Goes from x at s->here, about a mode of the amplitude `reached`, to the amplitude wanted, by steps as large as searches end
 * well, each along the line through the last two modes. known: 1: x is such a mode; 0: the first search finds it. *found = 1:
 * s->here is the mode wanted. Returns a status. */
static int follow_path(struct shooting *s, double period, double delta, double reached, int known, int *found)
{
    const size_t n = s->map.n;
    const double wanted = s->mode->amplitude;
    double factor = STEEPEST, *x = s->mode->x, *before = x + n, at = 0.0; /* before: mode of the amplitude `at`; at first 0 */
    int status = TRIBO_OK, begun = known;
    *found = 0;
    memcpy(x, s->here->x, n * sizeof *x);
    for (int shots = 0; !status && !*found && factor > FLATTEST && shots < MOST_SHOTS; shots++) {
        const double step = wanted >= reached ? lesser(reached * factor, wanted) : greater(reached / factor, wanted);
        const double next = begun ? step : reached;
        for (size_t i = 0; i < n; i++) {
            s->here->x[i] = x[i] + (x[i] - before[i]) * ((next - reached) / (reached - at));
        }
        const double size = tribo_energy_length(s->here->x, n);
        s->mode->amplitude = next;
        s->extra.unit[0] = period / size;
        s->extra.unit[1] = 1.0 / (period * size);
        s->here->unknown[0] = size;
        s->here->unknown[1] = delta / s->extra.unit[1];
        status = tribo_shooting_try(s, period, found);
        if (*found) { /* a mode, which need not be that wanted */
            for (size_t i = 0; i < n; i++) {
                before[i] = begun ? x[i] : 0.0;
                x[i] = s->here->x[i];
            }
            at = begun ? reached : 0.0;
            period = s->here->unknown[0] * s->extra.unit[0];
            delta = s->here->unknown[1] * s->extra.unit[1];
            factor = begun ? lesser(factor * factor, STEEPEST) : factor;
            *found = next == wanted;
            reached = next;
        } else {
            factor = begun ? sqrt(lesser(factor, greater(next / reached, reached / next))) : 0.0;
        }
        begun = 1;
    }
    s->mode->amplitude = wanted;
    return status;
}

void tribo_shooting_leave_twin(struct shooting *s)
{
    tribo_driver_destroy(s->twin.drv);
    tribo_system_destroy(s->twin.sys);
    s->twin = (struct twin){NULL, NULL};
}

int tribo_shooting_create_twin(struct shooting *s, int steady)
{
    tribo_driver *drv = s->map.drv;
    tribo_shooting_leave_twin(s);
    const int status = tribo_driver_pass(drv, tribo_system_clone(drv->sys, &s->twin.sys));
    if (status) {
        return status;
    }
    if (steady) {
        tribo_loads_keep_constant(s->twin.sys);
    }
    return tribo_shooting_drive_twin(s);
}

int tribo_shooting_drive_twin(struct shooting *s)
{
    const tribo_driver *drv = s->map.drv;
    const int status = tribo_driver_create(&s->twin.drv, s->twin.sys, drv->at_work->name);
    if (status) {
        return tribo_error(drv->message, status, "%s", tribo_system_message(s->twin.sys));
    }
    s->twin.drv->shooting = tribo_shooting_create(s->twin.drv);
    return s->twin.drv->shooting ? TRIBO_OK : tribo_error(drv->message, TRIBO_ERR_MEMORY, "out of memory for a search");
}

int tribo_shooting_find_mode(struct shooting *s, struct wanted *w)
{
    const size_t n = s->map.n;
    const double guess = w->period;
    int found = 0, status = tribo_shooting_create_twin(s, 1);
    s->found = 0;
    s->told = s;
    if (status) {
        return status;
    }
    struct shooting *t = s->twin.drv->shooting;
    struct mode mode = {s->map.sys, w->c, calloc(2 * n, sizeof *mode.x), w->amplitude};
    t->mode = &mode;
    t->extra = tribo_mode_border;
    status = mode.x ? tribo_period_map_prepare(&t->map, w->t, guess > 0.0 ? guess : 1.0, w->y)
                    : tribo_error(t->map.drv->message, TRIBO_ERR_MEMORY, "out of memory for a mode");
    const double of_guess = tribo_dot(w->c, w->y, 2 * t->map.sys->ndof);
    if (!status && guess > 0.0 && of_guess > 0.0) {
        tribo_energy_norm_of(&t->map.norm, 1, w->y, t->here->x);
        status = follow_path(t, guess, w->delta, of_guess, 1, &found);
    }
    for (int sticks = 1; !status && !found && sticks >= 0; sticks--) {
        const double from = sticks ? LEAST * w->amplitude : w->amplitude / LEAST;
        double period = 0.0, delta = 0.0;
        int moves;
        status = linear_mode(t, sticks, from, guess > 0.0 ? FULL_TURN / guess : 0.0, &period, &delta, &moves);
        status = status || !moves ? status : follow_path(t, period, delta, from, 0, &found);
    }
    if (!status && !found) {
        status =
            tribo_error(t->map.drv->message, TRIBO_ERR_NO_CONVERGENCE,
                        "no mode was found: neither from the guess, nor from linear modes with contacts that stick or slide");
    }
    status = status ? status : tribo_period_map_complete(&t->map, t->here);
    if (!status && !tribo_point_is_closed(t->here, TRIBO_PERIODIC)) {
        status = tribo_shooting_fails(t, t->here->residual / t->here->size);
    }
    status = status ? status : tribo_shooting_find_flow(t);
    if (!status) {
        w->delta = t->here->unknown[1] * t->extra.unit[1];
        tribo_shooting_keep(t, w);
        s->found = 1;
        s->revision = tribo_system_revision(s->map.sys);
        s->told = t;
    } else {
        tribo_error(s->map.drv->message, status, "%s", tribo_driver_message(t->map.drv));
    }
    s->map.drv->newton += t->map.drv->newton;
    s->map.drv->periods += (size_t)ceil(tribo_periods_followed(&t->map));
    t->mode = NULL;
    free(mode.x);
    return status;
}
