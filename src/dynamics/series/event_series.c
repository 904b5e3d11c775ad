#include "event_series.h"

#include <math.h>
#include <string.h>

static void expand_harmonics(struct event *e, double t)
{
    tribo_system *sys = e->sys;
    const size_t h = sys->harmonics;
    tribo_system_set_time(sys, t);
    for (size_t s = 0; s < h; s++) {
        tribo_system_turn(sys, s);
        double c = sys->harmonic[s].cos_t, d = sys->harmonic[s].sin_t;
        for (size_t k = 0; k < e->order + 2; k++) {
            const double rate = sys->harmonic[s].omega / (double)(k + 1), next = -rate * d;
            e->cosine[k * h + s] = c;
            e->sine[k * h + s] = d;
            d = rate * c;
            c = next;
        }
    }
}

/* to += factor times the k-th coefficients of the harmonics that drive loads, bases or limits. */
static void add_harmonics(const struct event *e, enum drives drives, size_t k, double factor, double *to)
{
    for (size_t s = 0; s < e->sys->harmonics; s++) {
        const struct harmonic *w = &e->sys->harmonic[s];
        const double c = factor * e->cosine[k * e->sys->harmonics + s], d = factor * e->sine[k * e->sys->harmonics + s];
        for (size_t i = 0; w->drives == drives && i < w->count; i++) {
            to[w->index[i]] += c * w->cosine[i] + d * w->sine[i];
        }
    }
}

/* Sets the coefficients of limits at the time of the harmonics' expansion. A coefficient of a limit that falls with the speed
 * needs that of the velocity first. */
static void expand_limits(struct event *e)
{
    const tribo_system *sys = e->sys;
    const size_t c = sys->ncontact;
    const int falls = e->events.stick_slip.breakaway.falls;
    e->slide = falls ? e->fall : e->limit;
    e->slide_terms = falls || e->events.stick_slip.plane ? e->order + 1 : e->terms;
    tribo_system_limits(sys, e->limit, e->limit + c);
    for (size_t k = 2; k < e->slide_terms; k++) {
        memset(e->limit + k * c, 0, c * sizeof *e->limit);
        add_harmonics(e, DRIVES_LIMIT, k, 1.0, e->limit + k * c);
    }
}

/* Sets the k-th coefficients of limits of sliding contacts that fall with the speed. */
static void expand_falling(struct event *e, size_t k)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const size_t c = e->sys->ncontact;
    for (size_t i = 0; i < c; i++) {
        double *part = e->part + i;
        if (tribo_slides(m->state.slip[i])) {
            part[k * c] = tribo_breakaway_part(&m->breakaway, i, m->state.slip[i], k, c, e->watch + i, part);
            e->fall[k * c + i] = tribo_breakaway_series(&m->breakaway, i, k, c, e->terms, e->limit + i, part);
        }
    }
}

/* Sets the k-th coefficients of given forces; 0 if all of them are 0. */
static int find_given(struct event *e, size_t k)
{
    const int some = k < e->slide_terms;
    if (some) {
        /* rigid contacts: one that slides, or is just at its limit, follows the limit; others keep their force */
        const struct stick_slip *m = &e->events.stick_slip;
        for (size_t i = 0; i < e->sys->ncontact; i++) {
            const int keeps = k == 0 && m->state.slip[i] == TRIBO_SLIP_STUCK && !m->state.holds[i];
            const double *limit = (m->state.slip[i] ? e->slide : e->limit) + k * e->sys->ncontact,
                         side = tribo_stick_slip_follows(m, i);
            e->room.given[i] = keeps ? m->state.force[i] : side != 0.0 ? side * limit[i] : 0.0;
        }
    }
    return some;
}

/* Sets v = the k-th coefficients of the contacts' velocities. */
static void find_velocities(const struct event *e, size_t k, double *v)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const size_t c = e->sys->ncontact;
    memset(v, 0, c * sizeof *v);
    add_harmonics(e, DRIVES_BASE, k, -1.0, v);
    tribo_system_tables(e->sys, DRIVES_BASE, (int)k, -1.0, 0, c, v);
    tribo_matrix_multiply_add(&e->sys->direction, 1.0, e->u + k * e->sys->ndof, v);
    if (e->sys->compliance.count) {
        tribo_compliance_rates(e->sys, m->state.slip, v, e->room.rate);
        for (size_t i = 0; k < e->order && i < c; i++) {
            e->spring[(k + 1) * c + i] = e->room.rate[i] / (double)(k + 1);
        }
    }
    for (size_t i = 0; k == 0 && i < c; i++) {
        v[i] = m->state.rested[i] ? 0.0 : v[i];
    }
}

/* The k-th coefficients of accelerations by stiffness, damping and loads. */
static void expand_free(struct event *e, size_t k)
{
    const tribo_system *sys = e->sys;
    const size_t n = sys->ndof;
    double *acc = e->room.acceleration;
    memset(acc, 0, n * sizeof *acc);
    add_harmonics(e, DRIVES_LOAD, k, 1.0, acc);
    tribo_matrix_multiply_add(&sys->stiffness, -1.0, e->q + k * n, acc);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, e->u + k * n, acc);
    }
    tribo_system_tables(sys, DRIVES_LOAD, (int)k, 1.0, 0, n, acc);
    if (sys->compliance.count) {
        tribo_matrix_multiply_add(&sys->compliance.pull, 1.0, e->spring + k * sys->ncontact, acc);
    }
}

/* Sets watch of contacts at rest to their forces. */
static void watch_forces(const struct event *e, size_t k, int given, double *watch)
{
    const struct stick_slip *m = &e->events.stick_slip;
    for (size_t i = 0; i < e->sys->ncontact; i++) {
        if (m->state.slip[i] == TRIBO_SLIP_STUCK && !tribo_stick_slip_may_part(m, i)) {
            const double spring = e->spring[k * e->sys->ncontact + i], own = e->room.held[i] + (given ? e->room.given[i] : 0.0);
            const double found = m->constant.elastic[i] ? spring : own;
            watch[i] = k == 0 ? m->state.force[i] : found;
        }
    }
}

/* Sets the k-th coefficients of accelerations and of watch. Returns a status. */
static int expand_forces(struct event *e, size_t k)
{
    struct stick_slip *m = &e->events.stick_slip;
    tribo_system *sys = e->sys;
    double *acc = e->room.acceleration, *watch = e->watch + k * sys->ncontact;
    expand_free(e, k);
    find_velocities(e, k, watch);
    if (m->breakaway.falls) {
        expand_falling(e, k);
    }
    const int given = find_given(e, k);
    int status = given && m->plane ? tribo_planar_series_forces(&e->planar, m, sys, k, watch, e->room.given) : TRIBO_OK;
    if (status) {
        return status;
    }
    if (given) {
        tribo_matrix_multiply_add(&sys->response, 1.0, e->room.given, acc);
    }
    /* k-th coefficients: base = accelerations of the bases, a = accelerations of the contacts against them */
    const size_t c = e->sys->ncontact;
    memset(e->room.base, 0, c * sizeof *e->room.base);
    add_harmonics(e, DRIVES_BASE, k + 1, (double)(k + 1), e->room.base);
    tribo_system_tables(sys, DRIVES_BASE, (int)k + 1, (double)(k + 1), 0, c, e->room.base);
    for (size_t i = 0; i < c; i++) {
        e->room.a[i] = -e->room.base[i];
    }
    tribo_matrix_multiply_add(&e->sys->direction, 1.0, e->room.acceleration, e->room.a);
    status = tribo_stick_slip_balance(m, e->room.a, e->room.held);
    if (status) {
        return tribo_system_fail(sys, status, "%s", tribo_message(m->constant.hold));
    }
    tribo_matrix_multiply_add(&sys->response, 1.0, e->room.held, acc);
    status = m->plane ? tribo_planar_series_finish(&e->planar, m, sys, k, e->room.base, acc, e->room.held) : TRIBO_OK;
    if (status) {
        return status;
    }
    watch_forces(e, k, given, watch);
    /* contacts at rest must not creep by what rounding leaves in acc */
    return tribo_stick_slip_hold(m, sys, e->room.base, acc);
}

int tribo_event_start(struct event *e, double t, const double *y)
{
    tribo_system *sys = e->sys;
    const size_t n = sys->ndof;
    struct stick_slip *m = &e->events.stick_slip;
    memcpy(e->q, y, n * sizeof *y);
    memcpy(e->u, y + n, n * sizeof *y);
    e->d[0] = y[tribo_system_energy(sys)];
    tribo_compliance_get(sys, y, e->spring);
    const int status =
        m->plane ? tribo_planar_series_begin(&e->planar, e->most_order, m, sys, y, e->room.a, e->room.given) : TRIBO_OK;
    e->order = m->plane ? e->planar.order : e->most_order;
    expand_harmonics(e, t);
    expand_limits(e);
    return status;
}

/* The k-th coefficient of the power of sliding contact i, limit times velocity. */
static double power_of(const struct event *e, size_t i, size_t k)
{
    const size_t c = e->sys->ncontact;
    double power = 0.0;
    for (size_t j = 0; j <= k && j < e->slide_terms; j++) {
        power += e->slide[j * c + i] * e->watch[(k - j) * c + i];
    }
    return e->events.stick_slip.state.slip[i] * power;
}

int tribo_event_series(struct event *e)
{
    const size_t n = e->sys->ndof;
    for (size_t k = 0; k <= e->order; k++) {
        const int status = expand_forces(e, k);
        if (status) {
            return status;
        }
        const double part = 1.0 / (double)(k + 1);
        for (size_t i = 0; k < e->order && i < n; i++) {
            e->q[(k + 1) * n + i] = part * e->u[k * n + i];
            e->u[(k + 1) * n + i] = part * e->room.acceleration[i];
        }
    }
    e->sys->evaluations += e->order + 1;
    const struct stick_slip *m = &e->events.stick_slip;
    for (size_t k = 0; k < e->order; k++) {
        double power = m->plane ? tribo_planar_series_power(&e->planar, m, e->sys, k) : 0.0;
        for (size_t i = 0; i < e->sys->ncontact; i++) {
            power += tribo_slides(m->state.slip[i]) ? e->sys->tally[i] * power_of(e, i, k) : 0.0;
        }
        e->d[k + 1] = power / (double)(k + 1);
    }
    return TRIBO_OK;
}

int tribo_event_expand(struct event *e, double t, const double *y)
{
    const int status = tribo_event_start(e, t, y);
    return status ? status : tribo_event_series(e);
}

/* N(|v|) = limit + (ratio - 1) limit exp(-|v|/velocity): its slope is (limit - N)/velocity. */
void tribo_event_slopes(struct event *e)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const size_t c = e->sys->ncontact;
    for (size_t k = 0; k <= e->order; k++) {
        for (size_t i = 0; i < c; i++) {
            const double more = e->fall[k * c + i] - e->limit[k * c + i];
            e->slope[k * c + i] = tribo_slides(m->state.slip[i]) ? more / m->breakaway.velocity[i] : 0.0;
        }
    }
}

double tribo_event_work(void *own, size_t i, double tau)
{
    const struct event *e = own;
    double work = 0.0;
    for (size_t k = e->order; k-- > 0;) {
        work = work * tau + power_of(e, i, k) / (double)(k + 1);
    }
    return work * tau;
}
