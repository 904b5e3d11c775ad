/* SPDX-License-Identifier: BSD-3-Clause */
/* Method "event": Coulomb's law on any system, by Taylor series of the motion between events (event_series.h); velocities and
 * forces of contacts are polynomials too. The force of a sliding planar contact turns with its velocity (planar_series.c).
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

/* Error of a step of a periodic motion, in parts of the motion: it must not depend on where steps end. */
#define SHARP 1e-13

/* Error of a step without tolerances, in parts of how far values move within the time of the fastest motion. */
#define USUAL 1e-12

static double fastest(const struct event *e)
{
    return e->fastest + e->events.stick_slip.limits.steepest;
}

/* Error allowed in a series [order + 1][n] that moves by `moves` within the time of the fastest motion, on a step of at most
 * `most`; not below the rounding of its first term. Of a sharp motion relative to the largest term on that step. */
static double wanted(const struct event *e, const double *series, size_t n, double moves, double most)
{
    const tribo_driver *drv = e->drv;
    const double size = tribo_largest(series, n);
    double error = drv->abstol > 0.0 ? drv->abstol + drv->reltol * size : greater(USUAL * moves, DBL_MIN);
    double largest = 0.0, power = 1.0;
    for (size_t k = 0; k <= e->order && e->events.sharp && most < HUGE_VAL; k++) {
        largest = greater(largest, power * tribo_largest(series + k * n, n));
        power = lesser(power * most, DBL_MAX);
    }
    error = largest > 0.0 ? lesser(error, SHARP * largest) : error;
    return greater(error, DBL_EPSILON * size);
}

double tribo_event_length(struct event *e)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const size_t n = e->sys->ndof, c = e->sys->ncontact;
    const double most = fastest(e) > 0.0 ? 0.5 * (double)(e->order + 1) / fastest(e) : HUGE_VAL;
    const double q = wanted(e, e->q, n, e->moves[0], most), u = wanted(e, e->u, n, e->moves[1], most),
                 d = wanted(e, e->d, 1, e->moves[2], most);
    const double tolerance = e->events.sharp ? lesser(e->tolerance, SHARP) : e->tolerance;
    double h = most;
    if (m->plane) {
        tribo_planar_series_errors(e);
    }
    for (size_t k = e->order - 1; k <= e->order; k++) {
        double term = greater(tribo_largest(e->q + k * n, n) / q, greater(tribo_largest(e->u + k * n, n) / u, fabs(e->d[k]) / d));
        for (size_t i = 0; i < c; i++) {
            /* forces of contacts at rest to the same part of their limit, or of what it becomes; and this itself */
            double rise = e->terms > 1 ? fabs(e->limit[c + i]) * lesser(most, DBL_MAX) : 0.0;
            double power = 1.0; /* limits that follow may begin with a higher power of time */
            for (size_t p = 2; e->sys->normals.count && fastest(e) > 0.0 && (p == 2 || rise == 0.0) && p <= e->order; p++) {
                power /= fastest(e);
                rise += fabs(e->limit[p * c + i]) * power / fastest(e);
            }
            const double force = tolerance * (greater(e->limit[i], 0.0) + m->constant.swing[i] + rise);
            const double stick = m->limits.ratio[i] * force;
            const double speed = m->plane ? m->plane->error[i] : u;
            const double scale = m->state.slip[i] == TRIBO_SLIP_STUCK && !tribo_stick_slip_may_part(m, i) ? stick : speed;
            const int turns = m->constant.pair[i] && m->state.slip[i] == TRIBO_SLIP_PLANE;
            term = turns ? greater(term, fabs(e->force[k * c + i]) / force) : term;
            term = m->state.slip[i] == TRIBO_SLIP_OPEN ? term : greater(term, fabs(e->watch[k * c + i]) / scale);
            term = k < e->terms && m->constant.swing[i] > 0.0 ? greater(term, fabs(e->limit[k * c + i]) / force) : term;
        }
        h = term > 0.0 ? lesser(h, pow(term, -1.0 / (double)k)) : h;
    }
    return h;
}

/* --------------------------------------------------------------------------------------------------------- guards */

static void method_event_look(void *own, double tau, size_t guards, struct guard *const *guard)
{
    const struct event *e = own;
    for (size_t k = 0; k < guards; k++) {
        struct guard *g = guard[k];
        g->middle = (struct sample){g->offset, 0.0, 0.0};
        if (g->output) {
            tribo_curve_add(g->output, tau, g->side, &g->middle);
        }
        if (g->limit != 0.0) {
            tribo_curve_add(&e->limit_curve[g->contact], tau, g->limit, &g->middle);
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

/* Returns 0 if bounds overflow. */
static int set_guards(struct event *e)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const size_t c = m->constant.contacts;
    const struct matrix *j = &e->sys->direction;
    const int varies = e->terms > 1;
    double all = 0.0, speed = 0.0, power = 1.0; /* speed: sum of the sizes of the terms of u; power: of length */
    for (size_t k = 0; m->constant.base_moves && k <= e->order; k++) {
        speed += tribo_largest(e->u + k * e->sys->ndof, e->sys->ndof) * power;
        power = lesser(power * e->length, DBL_MAX);
    }
    e->events.search.guards = 0;
    tribo_curves_bound(e->curve, c, e->order + 1, c, e->watch, e->length);
    tribo_curves_bound(e->limit_curve, c, tribo_event_limit_terms(e), c, e->limit, e->length);
    if (m->plane) {
        tribo_planar_series_guards(e);
    } else {
        tribo_pair_series_guards(e);
    }
    for (size_t i = 0; i < c; i++) {
        struct curve *curve = &e->curve[i];
        const struct curve *limit = &e->limit_curve[i];
        if (!(m->plane && m->plane->in_plane[i]) && !m->constant.pair[i]) {
            if (tribo_stick_slip_may_part(m, i)) { /* bound of the sum of the sizes of the terms of v_i */
                curve->size = 0.0;
                for (size_t d = j->first[i]; d < j->first[i + 1]; d++) {
                    curve->size += fabs(j->val[d]) * speed;
                }
            }
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

static void free_series(struct event *e)
{
    free(e->q);
    free(e->lines.line);
    e->lines = (struct lines){0};
    free(e->creep.weight);
    e->creep = (struct creep){0};
}

static void method_event_destroy(tribo_driver *drv)
{
    struct event *e = drv->own;
    if (e) {
        tribo_events_free(&e->events);
        free_series(e);
        free(e);
    }
}

/* The order grows with the digits of the tolerance. Powers of frequencies and of steps stay within MOST_DIGITS decimal digits,
 * half of that with squares of planar series; there are at least LEAST_ORDER terms. */
#define MOST_DIGITS 240.0
#define LEAST_ORDER 4.0

/* Takes the driver's tolerances; finds the highest frequency; makes room for the order that follows. */
static int method_event_prepare(struct event *e)
{
    const tribo_system *sys = e->sys;
    const double abstol = e->drv->abstol;
    const size_t n = sys->ndof, c = sys->ncontact, planes = tribo_system_planar(sys);
    e->events.stick_slip.constant.abstol = abstol;
    e->events.stick_slip.constant.reltol = abstol > 0.0 ? e->drv->reltol : USUAL;
    if (e->q && e->abstol == abstol && e->revision == sys->revision && e->planes == planes) {
        return TRIBO_OK;
    }
    const int status = tribo_compliance_check(sys);
    if (status) {
        return status;
    }
    e->abstol = abstol;
    e->revision = sys->revision;
    e->planes = planes;
    e->tolerance = abstol > 0.0 ? clamp(abstol, 1e-16, 1e-2) : USUAL;
    e->fastest = tribo_system_fastest(sys);
    const double digits = planes ? 0.5 * MOST_DIGITS : MOST_DIGITS, best = 10.0 - 1.5 * log10(e->tolerance);
    const double most = e->fastest > 0.0 ? greater(digits / (1.0 + fabs(log10(e->fastest))), LEAST_ORDER) : HUGE_VAL;
    e->order = e->most_order = (size_t)lesser(best, most);
    e->terms = sys->loads.limits > sys->loads.limit_tables || sys->normals.count ? e->order + 1 : sys->loads.limits ? 2 : 1;
    free_series(e);
    const size_t terms = e->order + 1;
    return ALLOCATE(ARRAY(e->q, terms * n), ARRAY(e->u, terms * n), ARRAY(e->d, terms), ARRAY(e->room.acceleration, n),
                    ARRAY(e->curve, c), ARRAY(e->limit_curve, c), ARRAY(e->watch, terms * c), ARRAY(e->limit, terms * c),
                    ARRAY(e->fall, terms * c), ARRAY(e->part, terms * c), ARRAY(e->force, terms * c), ARRAY(e->room.base, c),
                    ARRAY(e->room.a, c), ARRAY(e->room.given, c), ARRAY(e->room.held, c), ARRAY(e->room.rate, c))
               ? TRIBO_OK
               : tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for method event");
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
            to[2 * n + i] = to[2 * n + i] * tau + e->force[k * e->sys->ncontact + g->contact[i]];
        }
        *energy = *energy * tau + e->d[k];
    }
}

/* Longest step with planar series, over the highest frequency: squares do not cancel. */
#define LONGEST 3.0

static int method_event_begin(void *own, double t, const double *y, double *reach)
{
    struct event *e = own;
    struct stick_slip *m = &e->events.stick_slip;
    const size_t n = e->sys->ndof;
    const double most = fastest(e) > 0.0 ? lesser(*reach, LONGEST / fastest(e)) : *reach;
    double length = 0.0;
    tribo_stick_slip_press(m, e->sys);
    if (!(e->drv->abstol > 0.0)) {
        /* by velocities and sizes of the terms of accelerations */
        const double radian = fastest(e) > 0.0 ? 1.0 / fastest(e) : 1.0;
        e->moves[1] = tribo_largest(y + n, n) + radian * tribo_stick_slip_acceleration_size(m, e->sys, y);
        e->moves[0] = tribo_largest(y, n) + radian * e->moves[1];
        double force = tribo_largest(m->state.force, m->constant.contacts);
        for (size_t k = 0; k < e->sys->normals.followers; k++) { /* what limits that follow may become */
            const struct follower *f = &e->sys->normals.follower[k];
            const struct normal *normal = &e->sys->normals.normal[f->normal];
            const struct matrix *j = &e->sys->direction;
            for (size_t d = j->first[normal->row]; d < j->first[normal->row + 1]; d++) {
                force = greater(force, f->mu * normal->stiffness * fabs(j->val[d]) * e->moves[0]);
            }
        }
        e->moves[2] = fabs(y[tribo_system_energy(e->sys)]) + radian * force * e->moves[1];
    }
    e->error = wanted(e, y + n, n, e->moves[1], HUGE_VAL);
    int status = m->plane ? tribo_creep_begin(e, t, y, most, &length) : TRIBO_OK;
    const int creeps = length != 0.0;
    const double whole = *reach;
    if (!status && !creeps) {
        status = tribo_event_start(e, t, y);
        status = status ? status : tribo_event_series(e);
    }
    if (status) {
        return status;
    }
    for (int overflows = 1; overflows; e->order = overflows ? e->order / 2 : e->order) {
        if (!creeps) {
            length = tribo_event_length(e);
            length = m->plane ? tribo_planar_series_shorten(e, lesser(length, most)) : tribo_pair_series_shorten(e, length, most);
        }
        if ((double)(e->order + 1) < DBL_EPSILON * fabs(t + whole) * e->fastest) {
            length = 0.0; /* steps that frequencies allow are lost in the rounding of the end: it is never reached */
        }
        *reach = lesser(length, whole);
        /* bounds over a time of the structure's: what is rounding must not depend on where the run is to end */
        e->length = fastest(e) > 0.0 ? greater(*reach, lesser(length, 1.0 / fastest(e))) : *reach;
        overflows = !set_guards(e);
        if (overflows && (creeps || !e->planes || (double)e->order < 2.0 * LEAST_ORDER)) { /* else squares overflow */
            return tribo_error(e->sys->message, TRIBO_ERR_NOT_FINITE,
                               "at t = %.17g derivatives of the motion overflow: it grows without bound, or is too fast", t);
        }
    }
    return TRIBO_OK;
}

static int series_signal(void *own, const double *c, double tau, const double *end, struct signal *to)
{
    const struct event *e = own;
    const struct compliance *g = &e->sys->compliance;
    const size_t n = e->sys->ndof, count = e->sys->ncontact;
    (void)end;
    if (!tribo_signal_reserve(to, 0, e->order)) {
        return tribo_error(e->sys->message, TRIBO_ERR_MEMORY, "out of memory for %zu power%s", e->order, plural(e->order));
    }
    to->tau = tau;
    for (size_t k = 0; k <= e->order; k++) {
        to->a[k] = tribo_dot(c, e->q + k * n, n) + tribo_dot(c + n, e->u + k * n, n);
        for (size_t i = 0; i < g->count; i++) {
            const double *f = e->force + k * count + g->contact[i], next = k < e->order ? (double)(k + 1) * f[count] : 0.0;
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
        return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for method event");
    }
    e->drv = drv;
    e->sys = sys;
    return tribo_events_create(&e->events, drv, &motion_in_series, e);
}

/* Refuses limits that follow the motion beside limits that fall with the speed. */
static int open_events(tribo_driver *drv, struct events **events)
{
    struct event *e = drv->own;
    const tribo_system *sys = e->sys;
    const size_t dropping = sys->normals.count ? tribo_system_first_dropping(sys, 1) : sys->ncontact;
    int status = TRIBO_OK;
    *events = &e->events;
    if (dropping < sys->ncontact) {
        status = tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                             "contact %zu has a limit that falls with the speed, which method event does not know beside limits "
                             "that follow normal loads, as of contact %zu: take central/fixed or moreau/fixed",
                             dropping, sys->normals.follower[0].contact);
    }
    return tribo_driver_pass(drv, status ? status : method_event_prepare(e));
}

const struct method tribo_method_event = {"event",
                                          TAKES_TOLERANCE | TAKES_OUTPUT | TAKES_PAIRS,
                                          method_event_create,
                                          method_event_destroy,
                                          tribo_events_method,
                                          open_events,
                                          tribo_events_find_periodic};
