/* Decides, at an instant, which scalar contacts stick and which slide:
 *
 *     contacts without velocity, or with none left in the direction of their slip, are at rest
 *     repeat
 *         find the forces: min 1/2 f'Rf + a'f, with |f| <= limit at rest, and f at its limit where a contact slides
 *         a contact at rest slides if its force is at the limit and its acceleration exceeds rounding
 *         if none does, but some are just at their limit: solve for a moment later; contacts at their limit then slide
 *         if still none does: of the forces that hold all contacts at rest, the one most beyond its limit makes its contact slide
 *         a contact that held by a static limit does not slide yet: in the next round its bound is the limit to slide, and all
 *         contacts that began to slide are at rest again
 *     until no contact begins to slide
 *     an independent set of the contacts at rest holds: it keeps all of them where they are
 *
 * Where R is diagonal, each contact is decided about alone, and from the second step on only contacts close to their limits are
 * looked at. The single contact at rest of a coupled system is decided about alone too: the forces of the others are known, and
 * do not change if it slides. */
#include "stick_slip.h"
#include "common/real.h"

#include <math.h>
#include <string.h>

/* The solver's error for redundant contacts, in units of the noise of accelerations. */
#define CERTAIN 1e3

/* The moment later: the bounds of a contact close to its limit, but not at it, are wider by this part of the limit. */
#define WIDER 0.02

/* The moment later: largest change of a limit, in parts of the largest force. */
#define CHANGES 1e-4

/* --------------------------------------------------------------------------------------------------------- letting go */

/* 1 if acceleration a, in the direction of the slip that the force at its limit resists, exceeds rounding. */
static inline int breaks_away(const struct stick_slip *m, size_t i, signed char direction, double a)
{
    return direction * a > m->noise.acceleration[i];
}

/* Lets contact i slide, or hold by its limit to slide. Returns 1 if another round is needed; 0 if the contact was decided about
 * alone and slides, which changes no other force. */
static size_t let_go(struct stick_slip *m, size_t i, signed char direction)
{
    tribo_stick_slip_let_go(m, i, direction);
    if (m->state.slip[i] == TRIBO_SLIP_STUCK || !tribo_stick_slip_alone(m, i)) {
        return 1;
    }
    m->state.force[i] = -direction * m->state.limit[i];
    return 0;
}

/* The direction in which a contact at its limit slides: against its force; if that is 0, along its acceleration work.v. */
static signed char slip_direction(const struct stick_slip *m, size_t i, double force)
{
    const double against = force != 0.0 ? -force : m->work.v[i];
    return against < 0.0 ? TRIBO_SLIP_BACK : TRIBO_SLIP_FORTH;
}

/* Sets work.v = a + R f for contacts of list [n] that were searched for, f being found last. */
static void find_left(struct stick_slip *m, const tribo_system *sys, size_t n, const size_t *list, const double *a,
                      const double *f)
{
    if (!m->constant.uncoupled && m->work.single == m->constant.contacts) {
        tribo_stick_slip_accelerate(m, sys, a, f, m->work.v);
        return;
    }
    for (size_t k = 0; k < n; k++) {
        const size_t i = list[k];
        m->work.v[i] = (m->constant.uncoupled ? a[i] : m->work.single_a) + m->constant.diagonal[i] * f[i];
    }
}

/* Lets contacts slide by the forces found, and ties those at their limits. Returns the number of contacts that need another
 * round; *ties = number of tied contacts. */
static size_t let_slide(struct stick_slip *m, tribo_system *sys, const double *y, size_t *ties)
{
    struct slip_state *s = &m->state;
    struct slip_work *w = &m->work;
    size_t changes = 0;
    *ties = 0;
    if (m->constant.uncoupled && !(s->dependents && m->constant.base_moves)) {
        w->undecided = w->close;
        w->undecided_count = w->close_count;
    }
    if (w->close_count > 0) {
        find_left(m, sys, w->close_count, w->close, w->a, s->force);
    }
    for (size_t k = 0; k < w->close_count; k++) {
        const size_t i = w->close[k];
        const double room = s->stick[i] - fabs(s->force[i]);
        tribo_stick_slip_find_gain(m, sys, y, i);
        if (room <= (i == s->reached ? TRIBO_CLOSE * s->stick[i] : m->noise.allowance[i] / TRIBO_ALLOWED)) {
            const signed char direction = slip_direction(m, i, s->force[i]);
            const double sure = tribo_stick_slip_must_be_sure(m, i) ? CERTAIN : 1.0;
            s->tied[i] = 1;
            if (room <= 0.0 && breaks_away(m, i, direction, w->v[i] / sure)) {
                changes += let_go(m, i, direction);
            }
            *ties += s->tied[i] != 0;
        }
    }
    return changes;
}

/* ---------------------------------------------------------------------------------------------------------- look ahead */

/* The limit of contact i now, and its rate. */
static double limit_now(const struct slip_state *s, size_t i, double *rate)
{
    *rate = s->slip[i] ? s->limit_rate[i] : s->stick_rate[i];
    return s->slip[i] ? s->limit[i] : s->stick[i];
}

static double limit_ahead(const struct slip_state *s, size_t i, double moment)
{
    double rate;
    const double now = limit_now(s, i, &rate);
    return s->slip[i] == TRIBO_SLIP_OPEN ? 0.0 : greater(now + moment * rate, 0.0);
}

/* The time to look ahead: the horizon, or less where a limit that is close to a force changes by more than CHANGES of the
 * largest force. */
static double find_moment(const struct stick_slip *m)
{
    const struct slip_state *s = &m->state;
    const struct slip_work *w = &m->work;
    const double horizon = m->constant.horizon;
    double moment = horizon, force = 0.0, rate;
    for (size_t k = 0; k < w->undecided_count; k++) {
        const size_t i = w->undecided[k];
        force = greater(force, greater(fabs(s->force[i]), m->constant.inertia[i] * fabs(w->a[i])));
    }
    for (size_t k = 0; force > 0.0 && k < w->undecided_count; k++) {
        const size_t i = w->undecided[k];
        const double now = limit_now(s, i, &rate);
        if (s->slip[i] != TRIBO_SLIP_OPEN && now <= fabs(s->force[i]) + horizon * fabs(rate) &&
            moment * fabs(rate) > CHANGES * force) {
            moment = CHANGES * force / fabs(rate);
        }
    }
    return moment;
}

/* Sets the limits at the velocities of y, if there are static limits. */
static void find_static(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    if (m->breakaway.some) {
        for (size_t i = 0; i < sys->ncontact; i++) {
            m->work.v[i] = m->state.rested[i] ? 0.0 : tribo_stick_slip_velocity(m, sys, i, y);
        }
        tribo_breakaway_limits(&m->breakaway, sys->ncontact, m->state.slip, m->work.v, m->state.limit, m->state.limit_rate);
    }
}

/* Sets the bounds of forces a moment later. */
static void set_bounds_ahead(struct stick_slip *m, double moment)
{
    const struct slip_state *s = &m->state;
    for (size_t k = 0; k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        const double limit = limit_ahead(s, i, moment), now = s->stick[i], wider = WIDER * now;
        double *lo = &m->work.lo[i], *hi = &m->work.hi[i];
        if (m->constant.elastic[i]) {
            *lo = *hi = s->spring[i] + moment * s->spring_rate[i];
        } else if (s->slip[i] != TRIBO_SLIP_STUCK) {
            *lo = *hi = s->slip[i] == TRIBO_SLIP_OPEN ? 0.0 : -s->slip[i] * limit;
        } else {
            *hi = limit + (!s->tied[i] && now - s->force[i] < wider ? wider : 0.0);
            *lo = -limit - (!s->tied[i] && now + s->force[i] < wider ? wider : 0.0);
        }
    }
}

/* Lets contacts slide by the forces of a moment later. A contact that stays tied is marked 1, or 2 if it goes back inside; one
 * that would lose a static limit is marked in work.pulled instead. */
static int look_ahead(struct stick_slip *m, tribo_system *sys, const double *y, size_t *ties, size_t *changes)
{
    struct slip_state *s = &m->state;
    struct slip_work *w = &m->work;
    for (size_t k = 0; k < w->undecided_count; k++) {
        if (tribo_stick_slip_searches(m, w->undecided[k])) {
            tribo_stick_slip_find_gain(m, sys, y, w->undecided[k]);
        }
    }
    if (m->breakaway.falls) { /* rates of limits, as sliding contacts gain speed */
        find_static(m, sys, y);
        tribo_stick_slip_accelerate(m, sys, w->a, s->force, w->v);
        for (size_t k = 0; k < w->undecided_count; k++) {
            const size_t i = w->undecided[k];
            const double v = s->rested[i] ? 0.0 : tribo_stick_slip_velocity(m, sys, i, y);
            s->limit_rate[i] +=
                s->slip[i] == TRIBO_SLIP_OPEN ? 0.0 : s->slip[i] * w->v[i] * tribo_breakaway_slope(&m->breakaway, i, v);
        }
    }
    const double moment = find_moment(m);
    tribo_stick_slip_find_rate(m, sys, y);
    tribo_stick_slip_contact_accelerations(sys, w->rate, 2, w->v);
    for (size_t k = 0; k < w->undecided_count; k++) {
        const size_t i = w->undecided[k];
        w->v[i] = w->a[i] + moment * w->v[i];
    }
    set_bounds_ahead(m, moment);
    const int status = tribo_stick_slip_solve(m, sys, w->v, w->f);
    if (status) {
        return status;
    }
    find_left(m, sys, w->undecided_count, w->undecided, w->v, w->f);
    for (size_t k = 0; k < w->undecided_count; k++) {
        const size_t i = w->undecided[k];
        const double room = limit_ahead(s, i, moment) - fabs(w->f[i]);
        w->pulled[i] = 0;
        if (tribo_stick_slip_searches(m, i) && room >= 0.0) {
            const signed char direction = slip_direction(m, i, w->f[i]);
            const int may = !tribo_breakaway_is_sudden(&m->breakaway, i);
            const int goes = room <= 0.0 && breaks_away(m, i, direction, w->v[i]);
            w->pulled[i] = (signed char)(goes && !may && s->tied[i] ? direction : 0);
            if (goes && may) {
                *ties -= s->tied[i] != 0;
                *changes += let_go(m, i, direction);
            }
            s->tied[i] = (signed char)(!s->tied[i] ? 0 : room > m->noise.allowance[i] ? 2 : 1);
        }
    }
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------ decision */

/* One round; *changes = the number of contacts that need another one. */
static int go_round(struct stick_slip *m, tribo_system *sys, const double *y, size_t *changes)
{
    struct slip_state *s = &m->state;
    size_t ties;
    int status = tribo_stick_slip_find_forces(m, sys);
    *changes = status ? 0 : let_slide(m, sys, y, &ties);
    if (!status && !*changes && (ties || (s->dependents && m->constant.base_moves))) {
        status = look_ahead(m, sys, y, &ties, changes);
    }
    if (!status && !*changes && ties) {
        status = tribo_stick_slip_relieve(m, sys, changes);
    }
    if (*changes) {
        memset(s->tied, 0, m->constant.contacts);
        for (size_t i = 0; m->work.limit_lost && !m->constant.uncoupled && i < m->constant.contacts; i++) {
            tribo_stick_slip_set(m, i, s->rested[i] ? TRIBO_SLIP_STUCK : s->slip[i]); /* slips while the lost limits held */
        }
        m->work.limit_lost = 0;
    }
    return status;
}

int tribo_stick_slip_decide(struct stick_slip *m, tribo_system *sys, double t, double *y)
{
    tribo_stick_slip_begin_decision(m, sys, t);
    tribo_stick_slip_update_limits(m, sys, y);
    tribo_elastic_place(m, sys, y);
    int status = tribo_stick_slip_find_resting(m, sys, y);
    find_static(m, sys, y);
    if (!status) {
        tribo_elastic_move(m, sys, y);
        tribo_stick_slip_find_free(m, sys, t, y);
        tribo_stick_slip_forget_gains(m);
        m->work.undecided = m->constant.all;
        m->work.undecided_count = m->constant.contacts;
    }
    for (size_t changes = 1; !status && changes;) {
        status = go_round(m, sys, y, &changes);
    }
    m->state.reached = m->constant.contacts;
    if (m->breakaway.some && !status) {
        tribo_stick_slip_find_gains(m, sys, y);
    }
    for (size_t i = 0; m->breakaway.some && i < m->constant.contacts; i++) {
        /* a contact that broke away, and is held by others after all, has its static limit again */
        m->state.tied[i] = (signed char)(tribo_breakaway_restore(&m->breakaway, i) ? 0 : m->state.tied[i]);
    }
    if (!status) {
        tribo_elastic_finish(m, sys);
    }
    return status || tribo_stick_slip_knows_holds(m) ? status : tribo_stick_slip_find_holds(m, sys);
}
