/* SPDX-License-Identifier: BSD-3-Clause */
/* Method "event": Coulomb's law on any system, by Taylor series of the motion between events (event_series.h); velocities and
 * forces of contacts are polynomials too. The force of a sliding planar contact turns with its velocity (planar_series.h).
 *
 * Why no event is missed: a step is at most (order + 1)/2 over the highest frequency of structure and loads; there the remainder
 * of the series is less than its last term, which is below the tolerance; and the search on the polynomials skips no zero
 * (first_zero.h). */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "event_series.h"
#include "common/layout.h"
#include "common/real.h"
#include "common/zeros.h"

/* Error of a step of a periodic motion, in parts of the motion: it must not depend on where steps end. */
#define SHARP 1e-13

/* Error of a step without tolerances, in parts of how far values move within the time of the fastest motion. */
#define USUAL 1e-12

static double fastest(const struct event *e)
{
    return e->fastest + e->events.stick_slip.breakaway.steepest;
}

/* Error allowed in values of this size, which move by `moves` within the time of the fastest motion. */
static double tolerated(const struct event *e, double size, double moves)
{
    const tribo_driver *drv = e->drv;
    return drv->abstol > 0.0 ? drv->abstol + drv->reltol * size : greater(USUAL * moves, DBL_MIN);
}

/* Error allowed in a series [order + 1][n] on a step of at most `most`; not below the rounding of its first term. Of a sharp motion
 * relative to the largest term on that step. */
static double wanted(const struct event *e, const double *series, size_t n, double moves, double most)
{
    const double size = tribo_largest(series, n);
    double error = tolerated(e, size, moves), largest = 0.0, power = 1.0;
    for (size_t k = 0; k <= e->order && e->events.sharp && most < HUGE_VAL; k++) {
        largest = greater(largest, power * tribo_largest(series + k * n, n));
        power = lesser(power * most, DBL_MAX);
    }
    error = largest > 0.0 ? lesser(error, SHARP * largest) : error;
    return greater(error, DBL_EPSILON * size);
}

/* Sets moves[] of displacements, velocities and energy within the time of the fastest motion, by the velocities in y and the
 * sizes of the terms of accelerations; not needed with tolerances. */
static void event_find_moves(struct event *e, const double *y)
{
    struct stick_slip *m = &e->events.stick_slip;
    const size_t n = e->sys->ndof;
    const double radian = fastest(e) > 0.0 ? 1.0 / fastest(e) : 1.0;
    if (e->drv->abstol > 0.0) {
        return;
    }
    e->moves[1] = tribo_largest(y + n, n) + radian * tribo_stick_slip_acceleration_size(m, e->sys, y);
    e->moves[0] = tribo_largest(y, n) + radian * e->moves[1];
    e->moves[2] =
        fabs(y[tribo_system_energy(e->sys)]) + radian * tribo_largest(m->state.force, m->constant.contacts) * e->moves[1];
}

/* Length of the step on which the last two terms of all series are below the tolerance. */
static double step_length(const struct event *e)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const size_t n = e->sys->ndof, c = e->sys->ncontact;
    const double most = fastest(e) > 0.0 ? 0.5 * (double)(e->order + 1) / fastest(e) : HUGE_VAL;
    const double q = wanted(e, e->q, n, e->moves[0], most), u = wanted(e, e->u, n, e->moves[1], most),
                 d = wanted(e, e->d, 1, e->moves[2], most);
    const double tolerance = e->events.sharp ? lesser(e->tolerance, SHARP) : e->tolerance;
    double h = most;
    for (size_t k = e->order - 1; k <= e->order; k++) {
        double term = greater(tribo_largest(e->q + k * n, n) / q, greater(tribo_largest(e->u + k * n, n) / u, fabs(e->d[k]) / d));
        for (size_t i = 0; i < c; i++) {
            /* forces of contacts at rest to the same part of their limit, or of what it becomes; and this itself */
            const double rise = e->terms > 1 ? fabs(e->limit[c + i]) * lesser(most, DBL_MAX) : 0.0;
            const double force = tolerance * (greater(e->limit[i], 0.0) + m->constant.swing[i] + rise);
            const double stick = tribo_breakaway_ratio(&m->breakaway, i) * force;
            const double speed = m->plane ? lesser(u, m->plane->error[i]) : u;
            const double scale = m->state.slip[i] == TRIBO_SLIP_STUCK && !tribo_stick_slip_may_part(m, i) ? stick : speed;
            term = m->state.slip[i] == TRIBO_SLIP_OPEN ? term : greater(term, fabs(e->watch[k * c + i]) / scale);
            term = k < e->terms && m->constant.swing[i] > 0.0 ? greater(term, fabs(e->limit[k * c + i]) / force) : term;
        }
        h = term > 0.0 ? lesser(h, pow(term, -1.0 / (double)k)) : h;
    }
    return h;
}

/* --------------------------------------------------------------------------------------------------------- guards */

static struct sample value_of(const struct curve *c, double s)
{
    double v0 = 0.0, v1 = 0.0, v2 = 0.0;
    for (size_t k = c->terms; k-- > 0;) {
        v2 = v2 * s + v1;
        v1 = v1 * s + v0;
        v0 = v0 * s + c->term[k * c->stride];
    }
    return (struct sample){v0, v1, 2.0 * v2};
}

/* The two guards of an output follow one another: its value is computed once. */
static void method_event_look(void *own, double tau, size_t guards, struct guard *const *guard)
{
    const struct event *e = own;
    const void *seen = NULL;
    struct sample v = {0.0, 0.0, 0.0};
    for (size_t k = 0; k < guards; k++) {
        struct guard *g = guard[k];
        g->middle = (struct sample){g->offset, 0.0, 0.0};
        if (g->output) {
            v = seen == g->output ? v : value_of(g->output, tau);
            seen = g->output;
            g->middle = (struct sample){g->offset + g->side * v.g, g->side * v.d, g->side * v.e};
        }
        if (g->limit != 0.0) {
            const struct sample limit = value_of(&e->limit_curve[g->contact], tau);
            g->middle.g += g->limit * limit.g;
            g->middle.d += g->limit * limit.d;
            g->middle.e += g->limit * limit.e;
        }
    }
}

static double method_event_bound(void *own, double tau)
{
    struct event *e = own;
    struct first_zero *s = &e->events.search;
    (void)tau;
    for (size_t k = 0; k < s->guards; k++) {
        struct guard *g = &s->guard[k];
        const struct curve *output = g->output, *limit = g->limit != 0.0 ? &e->limit_curve[g->contact] : NULL;
        g->size = fabs(g->offset) + (output ? output->size : 0.0) + (limit ? fabs(g->limit) * limit->size : 0.0);
        g->bend = (output ? output->bend : 0.0) + (limit ? fabs(g->limit) * limit->bend : 0.0);
    }
    return HUGE_VAL;
}

/* Sets curves [count], of neighbouring polynomials from term on, and their bounds over [0, h]. */
static void set_curves(struct curve *curve, size_t count, size_t terms, size_t stride, const double *term, double h)
{
    double power = 1.0, sixth = 1.0; /* of h; the second that of the sixth derivative */
    for (size_t i = 0; i < count; i++) {
        curve[i] = (struct curve){.term = term + i, .terms = terms, .stride = stride};
    }
    for (size_t k = 0; k < terms; k++) {
        const double six = k < 6 ? 0.0 : (double)(k * (k - 1) * (k - 2)) * (double)((k - 3) * (k - 4) * (k - 5)) * sixth;
        for (size_t i = 0; i < count; i++) {
            const double w = fabs(term[k * stride + i]);
            curve[i].size += w * power;
            curve[i].bend += w * six;
        }
        power = lesser(power * h, DBL_MAX);
        sixth = k < 6 ? 1.0 : lesser(sixth * h, DBL_MAX);
    }
}

/* A step ends where the speed of a planar contact falls to this part: at a small speed the direction turns fast, and a stop is
 * approached in ever shorter steps. */
#define SLOWER 1e-2

static void set_planar_guards(struct event *e)
{
    const struct stick_slip *m = &e->events.stick_slip;
    tribo_planar_series_squares(&e->planar, m, e->watch);
    for (size_t k = 0; k < m->plane->count; k++) {
        const struct planar_contact *p = &m->plane->contact[k];
        const int moves = tribo_slides_in_plane(m, p);
        const double *square = e->planar.line[k].square, limit = greater(p->limit[0], p->limit[1]);
        struct curve *curve = &e->curve[p->at];
        struct guard g = {.contact = p->at, .output = curve, .kind = moves ? SLOWS : HOLDS, .side = moves ? 1.0 : -1.0};
        set_curves(curve, 1, 2 * e->order + 1, 1, square, e->length);
        g.offset = moves ? -SLOWER * SLOWER * square[0] : 0.5 * limit;
        g.allowance = moves ? 0.0 : greater(m->noise.allowance[p->at], m->noise.allowance[p->at + 1]);
        if (moves || curve->size >= 0.5 * limit) {
            e->events.search.guard[e->events.search.guards++] = g;
        }
    }
}

/* Bound of the sum of the sizes of the terms of v_i over the phase. */
static double size_of_velocity(const struct event *e, size_t i)
{
    const struct matrix *j = &e->sys->direction;
    const size_t n = e->sys->ndof;
    double size = 0.0, power = 1.0, lever = 0.0;
    for (size_t d = j->first[i]; d < j->first[i + 1]; d++) {
        lever += fabs(j->val[d]);
    }
    for (size_t k = 0; k <= e->order; k++) {
        size += lever * tribo_largest(e->u + k * n, n) * power;
        power = lesser(power * e->length, DBL_MAX);
    }
    return size;
}

/* Returns 0 if bounds overflow. */
static int set_guards(struct event *e)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const size_t c = m->constant.contacts;
    const int varies = e->terms > 1;
    double all = 0.0;
    e->events.search.guards = 0;
    set_curves(e->curve, c, e->order + 1, c, e->watch, e->length);
    set_curves(e->limit_curve, c, e->terms, c, e->limit, e->length);
    if (m->plane) {
        set_planar_guards(e);
    }
    for (size_t i = 0; i < c; i++) {
        struct curve *curve = &e->curve[i];
        const struct curve *limit = &e->limit_curve[i];
        if (!(m->plane && m->plane->in_plane[i])) {
            curve->size = tribo_stick_slip_may_part(m, i) ? size_of_velocity(e, i) : curve->size;
            const struct watch w = {.output = curve,
                                    .size = curve->size,
                                    .constant = varies ? 0.0 : e->limit[i],
                                    .least = 2.0 * e->limit[i] - limit->size,
                                    .varies = varies};
            tribo_events_guard_contact(&e->events, i, &w);
            tribo_events_guard_limit(&e->events, i, &w);
        }
        all += 0.0 * (curve->size + curve->bend);
    }
    return all == 0.0;
}

/* ------------------------------------------------------------------------------------------------------- the driver */

static void method_event_destroy(tribo_driver *drv)
{
    struct event *e = drv->own;
    if (e) {
        tribo_events_free(&e->events);
        free(e->q);
        tribo_planar_series_free(&e->planar);
        tribo_creep_free(&e->creep);
        free(e);
    }
}

/* Powers of frequencies and of steps stay within MOST_DIGITS decimal digits, half of that with squares of planar series; there
 * are at least LEAST_ORDER terms. */
#define MOST_DIGITS 240.0
#define LEAST_ORDER 4.0

/* The order grows with the digits of the tolerance. */
static size_t best_order(double tolerance, double fastest, double digits)
{
    const double wanted = 10.0 - 1.5 * log10(tolerance);
    return (size_t)(fastest > 0.0 ? greater(lesser(wanted, digits / (1.0 + fabs(log10(fastest)))), LEAST_ORDER) : wanted);
}

static void lay_out(struct event *e, struct layout *l, size_t terms)
{
    const size_t n = e->sys->ndof, c = e->sys->ncontact;
    double **const series[] = {&e->watch, &e->limit, &e->fall, &e->part, &e->spring};
    double **const rooms[] = {&e->room.base, &e->room.a, &e->room.given, &e->room.held, &e->room.rate};
    e->q = tribo_layout_array(l, terms * n, sizeof *e->q);
    e->u = tribo_layout_array(l, terms * n, sizeof *e->u);
    e->d = tribo_layout_array(l, terms, sizeof *e->d);
    e->room.acceleration = tribo_layout_array(l, n, sizeof *e->u);
    e->curve = tribo_layout_array(l, c, sizeof *e->curve);
    e->limit_curve = tribo_layout_array(l, c, sizeof *e->limit_curve);
    for (size_t k = 0; k < 5; k++) {
        *series[k] = tribo_layout_array(l, terms * c, sizeof **series[k]);
        *rooms[k] = tribo_layout_array(l, c, sizeof **rooms[k]);
    }
}

/* Takes the driver's tolerances, and makes room for the order by these. */
static int take_tolerances(struct event *e)
{
    const tribo_driver *drv = e->drv;
    if (e->q && e->abstol == drv->abstol) {
        return TRIBO_OK;
    }
    const double tolerance = drv->abstol > 0.0 ? clamp(drv->abstol, 1e-16, 1e-2) : USUAL;
    const size_t order = best_order(tolerance, 0.0, MOST_DIGITS);
    struct layout l = {0};
    double *old = e->q;
    lay_out(e, &l, order + 1);
    const int done = tribo_layout_create(&l);
    lay_out(e, &l, order + 1);
    free(old);
    if (!done) {
        return tribo_system_fail(e->sys, TRIBO_ERR_MEMORY, "out of memory for method event");
    }
    e->abstol = drv->abstol;
    e->known = 0;
    e->tolerance = tolerance;
    e->order = e->most_order = order;
    return TRIBO_OK;
}

/* Takes tolerances, and finds the highest frequency. */
static int method_event_prepare(struct event *e)
{
    const tribo_system *sys = e->sys;
    int status = take_tolerances(e);
    e->events.stick_slip.constant.abstol = e->drv->abstol;
    e->events.stick_slip.constant.reltol = e->drv->abstol > 0.0 ? e->drv->reltol : USUAL;
    if (status || (e->known && e->revision == sys->revision)) {
        return status;
    }
    status = tribo_compliance_check(sys);
    if (status) {
        return status;
    }
    e->fastest = tribo_system_fastest(sys);
    /* planar series and creep need memory for as many terms */
    const size_t order = best_order(e->tolerance, e->fastest, tribo_system_planar(sys) ? 0.5 * MOST_DIGITS : MOST_DIGITS);
    if (order != e->most_order) {
        tribo_planar_series_free(&e->planar);
        tribo_creep_free(&e->creep);
    }
    e->most_order = order;
    e->terms = sys->loads.limit_harmonics ? e->most_order + 1 : sys->loads.limit_tables ? 2 : 1;
    e->revision = sys->revision;
    e->known = 1;
    return TRIBO_OK;
}

static void series_state(void *own, double tau, const double *from, double *to)
{
    const struct event *e = own;
    const size_t n = e->sys->ndof;
    const struct compliance *g = &e->sys->compliance;
    double *energy = to + tribo_system_energy(e->sys);
    (void)from;
    memset(to, 0, tribo_system_size(e->sys) * sizeof *to);
    for (size_t k = e->order + 1; k-- > 0;) {
        for (size_t i = 0; i < n; i++) {
            to[i] = to[i] * tau + e->q[k * n + i];
            to[n + i] = to[n + i] * tau + e->u[k * n + i];
        }
        for (size_t i = 0; i < g->count; i++) {
            to[2 * n + i] = to[2 * n + i] * tau + e->spring[k * e->sys->ncontact + g->contact[i]];
        }
        *energy = *energy * tau + e->d[k];
    }
}

/* Longest step with planar series, over the highest frequency: squares do not cancel. */
#define LONGEST 3.0

static double longest(const struct event *e, double most)
{
    return fastest(e) > 0.0 ? lesser(most, LONGEST / fastest(e)) : most;
}

/* Largest sum of the terms of a speed over a step, in units of the speed at its start: else the square of a small speed is
 * lost in rounding, and with it a zero. */
#define FASTER 1e4

/* 1 if no speed exceeds that on a step of length h. */
static int speeds_tell(const struct event *e, double h)
{
    const struct planar_slip *plane = e->events.stick_slip.plane;
    int tell = 1;
    for (size_t c = 0; c < plane->count; c++) {
        const struct planar_line *l = &e->planar.line[c];
        const size_t last = e->order - (size_t)plane->contact[c].begins;
        double sum = 0.0;
        for (size_t k = last + 1; k-- > 0;) {
            sum = sum * h + fabs(l->xn[k]) + fabs(l->xt[k]);
        }
        tell &= !tribo_slides_in_plane(&e->events.stick_slip, &plane->contact[c]) || sum <= FASTER * l->xn[0];
    }
    return tell;
}

static double planar_length(struct event *e, double most)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const double error = wanted(e, e->u, e->sys->ndof, e->moves[1], HUGE_VAL);
    tribo_planar_series_errors(&e->planar, m, m->plane->error);
    double h = lesser(step_length(e), longest(e, most));
    while ((!(tribo_planar_series_defect(&e->planar, m, h, error) <= 1.0) || !speeds_tell(e, h)) && h > 0.0) {
        h *= 0.8;
    }
    return h;
}

/* Steps by series before longer ones by collocation are tried; after trials that failed, steps of DEAR times their work;
 * trials at once. */
#define PATIENCE 16
#define DEAR 8
#define MOST_TRIALS 3

/* First step tried, in parts of the longest one. */
#define FIRST 0.25

/* Tries steps with directions by collocation, of length h first, all longer than least. *length = length of the step whose
 * velocities are right to `error`; 0 if none is. */
static int try_creep(struct event *e, double t, const double *y, double h, double least, double error, double *length)
{
    struct stick_slip *m = &e->events.stick_slip;
    struct creep_step step = {0, h, HUGE_VAL};
    for (int trial = 0; *length == 0.0 && step.next > least && trial < MOST_TRIALS; trial++) {
        h = step.next;
        const int status = tribo_creep_expand(e, t, y, h, error, &step);
        if (status) {
            return status;
        }
        tribo_planar_series_errors(&e->planar, m, m->plane->error);
        const double most = step_length(e);
        *length = step.good && most >= h ? h : 0.0;
        step.next = step.good && most < h ? 0.9 * most : step.next;
    }
    e->creep.length = *length > 0.0 ? step.next : 0.0;
    return TRIBO_OK;
}

/* Tries steps by collocation if contacts creep, after `wait` other steps, but at once where such steps just became shorter than
 * least; *length = 0 if none is good. most: longest step. */
static int creep(struct event *e, double t, const double *y, double most, double *length)
{
    struct creep *c = &e->creep;
    const double least = tribo_creep_least(e, y), last = c->length;
    const size_t before = e->sys->evaluations;
    c->wait = e->events.anew ? PATIENCE : last > 0.0 && !(last > least) ? 0 : c->wait;
    if (e->events.anew || !(least < most)) {
        c->length = 0.0;
        c->waited = 0;
    }
    e->events.anew = 0;
    *length = 0.0;
    if (!(least < most) || (!(c->length > least) && c->waited++ < c->wait)) {
        return TRIBO_OK;
    }
    const double speed = tribo_largest(y + e->sys->ndof, e->sys->ndof);
    const double error = greater(tolerated(e, speed, e->moves[1]), DBL_EPSILON * speed);
    const double first = lesser(most, c->length > least ? c->length : lesser(FIRST * most, tribo_creep_settled(e, y, error)));
    if (!(first > least)) {
        c->length = 0.0;
        return TRIBO_OK;
    }
    const int status = try_creep(e, t, y, first, least, error, length);
    c->length = *length == most ? greater(c->length, last) : c->length;
    c->wait = *length > 0.0 ? PATIENCE : DEAR * (e->sys->evaluations - before) / (e->most_order + 1);
    c->waited = 0;
    return status;
}

static int method_event_begin(void *own, double t, const double *y, double *reach)
{
    struct event *e = own;
    const int planar = e->events.stick_slip.plane != NULL;
    double length = 0.0;
    event_find_moves(e, y);
    int status = planar ? creep(e, t, y, longest(e, *reach), &length) : TRIBO_OK;
    if (!status && length == 0.0) {
        status = tribo_event_expand(e, t, y);
        length = status ? 0.0 : planar ? planar_length(e, *reach) : step_length(e);
    }
    if (status) {
        return status;
    }
    if ((double)(e->order + 1) < DBL_EPSILON * fabs(t + *reach) * e->fastest) {
        length = 0.0; /* steps that frequencies allow are lost in the rounding of the end: it is never reached */
    }
    *reach = lesser(length, *reach);
    /* bounds over a time of the structure's: what is rounding must not depend on where the run is to end */
    e->length = fastest(e) > 0.0 ? greater(*reach, lesser(length, 1.0 / fastest(e))) : *reach;
    return set_guards(e)
               ? TRIBO_OK
               : tribo_system_fail(e->sys, TRIBO_ERR_NOT_FINITE,
                                   "at t = %.17g derivatives of the motion overflow: it grows without bound, or is too fast", t);
}

static int series_signal(void *own, const double *c, double tau, const double *end, struct signal *to)
{
    const struct event *e = own;
    const struct compliance *g = &e->sys->compliance;
    const size_t n = e->sys->ndof, count = e->sys->ncontact;
    (void)end;
    if (!tribo_signal_reserve(to, 0, e->order)) {
        return tribo_system_fail(e->sys, TRIBO_ERR_MEMORY, "out of memory for %zu power%s", e->order, plural(e->order));
    }
    to->tau = tau;
    for (size_t k = 0; k <= e->order; k++) {
        to->a[k] = tribo_dot(c, e->q + k * n, n) + tribo_dot(c + n, e->u + k * n, n);
        for (size_t i = 0; i < g->count; i++) {
            const double *f = e->spring + k * count + g->contact[i], next = k < e->order ? (double)(k + 1) * f[count] : 0.0;
            to->a[k] += c[2 * n + i] * f[0] + c[2 * n + g->count + i] * next;
        }
    }
    return TRIBO_OK;
}

static const struct motion motion_in_series = {.begin = method_event_begin,
                                               .look = method_event_look,
                                               .bound = method_event_bound,
                                               .state = series_state,
                                               .transition = tribo_event_transition,
                                               .signal = series_signal,
                                               .work = tribo_event_work};

static int method_event_create(tribo_driver *drv)
{
    tribo_system *sys = drv->sys;
    struct event *e = tribo_zeros(1, sizeof *e);
    drv->own = e;
    if (!e) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for method event");
    }
    e->drv = drv;
    e->sys = sys;
    const int status = tribo_events_create(&e->events, drv, &motion_in_series, e);
    return status ? status : take_tolerances(e);
}

static int open_events(tribo_driver *drv, struct events **events)
{
    struct event *e = drv->own;
    const int status = method_event_prepare(e);
    *events = &e->events;
    return tribo_driver_pass(drv, status);
}

const struct method tribo_method_event = {
    "event",     TAKES_TOLERANCE | TAKES_OUTPUT, method_event_create, method_event_destroy, tribo_events_method,
    open_events, tribo_events_find_periodic};
