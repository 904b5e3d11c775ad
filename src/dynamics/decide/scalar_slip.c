/* How it is decided, at an instant, which scalar contacts stick and which slide:
 *
 *     contacts without velocity, or with none left in the direction of their slip, are at rest
 *     repeat
 *         find the forces: min 1/2 f'Rf + a'f, with |f| <= limit at rest, and f at its limit where a contact slides
 *         contacts at rest slide if their force is at the limit and their acceleration is more than rounding
 *         if none does, but some are just at their limit: solve for a moment later, and contacts at their limit then slide
 *         if still none does: of the forces that hold all at rest, the one most beyond its limit makes its contact slide
 *         one that held by a static limit does not slide yet: the limit by which it slides is its bound from here on, and
 *         others that began to slide are at rest again
 *     until none begins to slide
 *     an independent set of those at rest holds: it keeps all of them where they are
 *
 * Where no contact is coupled with another one, each is decided about alone, and who is not near its limit by its force: all that
 * follows is asked about the others only. So is the only contact at rest of those that are coupled, as the others have their
 * forces whatever it does; and who slides by a decision about it alone is done with. */
#include "stick_slip.h"
#include "common/real.h"

#include <math.h>
#include <string.h>

/* Of redundant contacts the solver may leave this many times the noise of accelerations. */
#define CERTAIN 1e3

/* A contact that is close to its limit, but not at it, does not reach it in a moment: its bounds are wider by this part. */
#define WIDER 0.02

/* --------------------------------------------------------------------------------------------------------- letting go */

/* Nobody is tied as another round begins. Where static limits were lost, all that began to slide while they held are decided
 * about once more, too: the other way they might go, or none. Contacts that are not coupled do not mind. */
static void begin_again(struct stick_slip *m)
{
    memset(m->state.tied, 0, m->constant.contacts);
    for (size_t i = 0; m->work.limit_lost && !m->constant.uncoupled && i < m->constant.contacts; i++) {
        tribo_stick_slip_set(m, i, m->state.rested[i] ? TRIBO_SLIP_STUCK : m->state.slip[i]);
    }
    m->work.limit_lost = 0;
}

/* Whether a contact at rest whose force is at its limit, in `direction` of the slip that it resists, accelerates that way by more
 * than rounding. */
static inline int breaks_away(const struct stick_slip *m, size_t i, signed char direction, double acceleration)
{
    return direction * acceleration > m->noise.acceleration[i];
}

/* Contact i slides, or holds by its other limit. Returns how many have to be decided about once more: none where it was decided
 * about alone and slides, which makes its force known and changes no other one. */
static size_t let_go(struct stick_slip *m, size_t i, signed char direction)
{
    tribo_stick_slip_let_go(m, i, direction);
    if (m->state.slip[i] == TRIBO_SLIP_STUCK || !tribo_stick_slip_alone(m, i)) {
        return 1;
    }
    m->state.force[i] = -direction * m->state.limit[i];
    return 0;
}

/* Where a contact at its limit slides by its force, or, if that is nothing, by its acceleration v. */
static signed char slip_direction(const struct stick_slip *m, size_t i, double force)
{
    return (signed char)(force != 0.0         ? (force > 0.0 ? TRIBO_SLIP_BACK : TRIBO_SLIP_FORTH)
                         : m->work.v[i] < 0.0 ? TRIBO_SLIP_BACK
                                              : TRIBO_SLIP_FORTH);
}

/* Where contacts are not coupled, those that are not close to their limits are decided about, unless they may part. */
static void ask_close(struct stick_slip *m)
{
    if (m->constant.uncoupled && !(m->state.dependents && m->constant.base_moves)) {
        m->work.undecided = m->work.close;
        m->work.undecided_count = m->work.close_count;
    }
}

/* m->work.v = the accelerations that forces f, which were found last, leave at contacts of the list [n] that were searched for;
 * without these forces they are a. */
static void find_left(struct stick_slip *m, const tribo_system *sys, size_t n, const size_t *list, const double *a,
                      const double *f)
{
    const int all = !m->constant.uncoupled && m->work.single == m->constant.contacts;
    for (size_t k = 0; !all && k < n; k++) {
        const size_t i = list[k];
        m->work.v[i] = (m->constant.uncoupled ? a[i] : m->work.single_a) + m->constant.diagonal[i] * f[i];
    }
    if (all) {
        tribo_stick_slip_accelerate(m, sys, a, f, m->work.v);
    }
}

/* Whether contact i, whose force is at its limit but for room, may be said to be there. */
static inline int is_at_limit(const struct stick_slip *m, size_t i, double room)
{
    return room <= (i == m->state.reached ? TRIBO_CLOSE * m->state.stick[i] : m->noise.allowance[i] / TRIBO_ALLOWED);
}

/* Who slides by the forces found; and who is tied. Returns how many have to be decided about once more, with how many are
 * tied. */
static size_t let_slide(struct stick_slip *m, tribo_system *sys, const double *y, size_t *ties)
{
    size_t changes = 0;
    *ties = 0;
    ask_close(m);
    if (m->work.close_count > 0) {
        find_left(m, sys, m->work.close_count, m->work.close, m->work.a, m->state.force);
    }
    for (size_t k = 0; k < m->work.close_count; k++) {
        const size_t i = m->work.close[k];
        const double room = m->state.stick[i] - fabs(m->state.force[i]);
        tribo_stick_slip_find_gain(m, sys, y, i);
        if (is_at_limit(m, i, room)) {
            const signed char direction = slip_direction(m, i, m->state.force[i]);
            const double sure = tribo_stick_slip_must_be_sure(m, i) ? CERTAIN : 1.0;
            m->state.tied[i] = 1;
            if (room <= 0.0 && breaks_away(m, i, direction, m->work.v[i] / sure)) {
                changes += let_go(m, i, direction);
            }
            *ties += m->state.tied[i] != 0;
        }
    }
    return changes;
}

/* ---------------------------------------------------------------------------------------------------------- look ahead */

/* Limits that change fast beside forces change these by at most this part in the moment that a decision looks ahead. */
#define CHANGES 1e-4

/* The limit of contact i now, and its rate. */
static double limit_now(const struct stick_slip *m, size_t i, double *rate)
{
    *rate = m->state.slip[i] ? m->state.limit_rate[i] : m->state.stick_rate[i];
    return m->state.slip[i] ? m->state.limit[i] : m->state.stick[i];
}

static double limit_ahead(const struct stick_slip *m, size_t i, double moment)
{
    double rate;
    const double now = limit_now(m, i, &rate);
    return m->state.slip[i] == TRIBO_SLIP_OPEN ? 0.0 : greater(now + moment * rate, 0.0);
}

/* How far to look ahead: to the horizon, or less where a limit that counts until then is to change much faster than that. */
static double find_moment(const struct stick_slip *m)
{
    double moment = m->constant.horizon, force = 0.0, rate;
    for (size_t k = 0; k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        force = greater(force, greater(fabs(m->state.force[i]), m->constant.inertia[i] * fabs(m->work.a[i])));
    }
    for (size_t k = 0; k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        const double now = limit_now(m, i, &rate);
        if (m->state.slip[i] != TRIBO_SLIP_OPEN && now <= fabs(m->state.force[i]) + m->constant.horizon * fabs(rate) &&
            moment * fabs(rate) > CHANGES * force) {
            moment = force > 0.0 ? CHANGES * force / fabs(rate) : moment;
        }
    }
    return moment;
}

/* The limits of this instant, where there are static ones. */
static void find_static(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    if (m->breakaway.some) {
        for (size_t i = 0; i < sys->ncontact; i++) {
            m->work.v[i] = m->state.rested[i] ? 0.0 : tribo_stick_slip_velocity(m, sys, i, y);
        }
        tribo_breakaway_limits(&m->breakaway, sys->ncontact, m->state.slip, m->work.v, m->state.limit, m->state.limit_rate);
    }
}

/* How the limits of sliding contacts fall, as they gain speed. */
static void find_falling(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    find_static(m, sys, y);
    tribo_stick_slip_accelerate(m, sys, m->work.a, m->state.force, m->work.v);
    for (size_t k = 0; k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        const double v = m->state.rested[i] ? 0.0 : tribo_stick_slip_velocity(m, sys, i, y);
        m->state.limit_rate[i] += m->state.slip[i] == TRIBO_SLIP_OPEN
                                      ? 0.0
                                      : m->state.slip[i] * m->work.v[i] * tribo_breakaway_slope(&m->breakaway, i, v);
    }
}

static void set_bounds_ahead(struct stick_slip *m, double moment)
{
    for (size_t k = 0; k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        const double limit = limit_ahead(m, i, moment), now = m->state.stick[i], wider = WIDER * now;
        if (m->constant.elastic[i]) {
            m->work.lo[i] = m->work.hi[i] = m->state.spring[i] + moment * m->state.spring_rate[i];
            continue;
        }
        if (m->state.slip[i] != TRIBO_SLIP_STUCK) {
            m->work.lo[i] = m->work.hi[i] = m->state.slip[i] == TRIBO_SLIP_OPEN ? 0.0 : -m->state.slip[i] * limit;
            continue;
        }
        m->work.hi[i] = limit + (!m->state.tied[i] && now - m->state.force[i] < wider ? wider : 0.0);
        m->work.lo[i] = -limit - (!m->state.tied[i] && now + m->state.force[i] < wider ? wider : 0.0);
    }
}

/* Who slides by the forces of a moment later; the others that are tied, and then fewer, stay so, or go back inside. */
static int look_ahead(struct stick_slip *m, tribo_system *sys, const double *y, size_t *ties, size_t *changes)
{
    for (size_t k = 0; k < m->work.undecided_count; k++) {
        if (tribo_stick_slip_searches(m, m->work.undecided[k])) {
            tribo_stick_slip_find_gain(m, sys, y, m->work.undecided[k]);
        }
    }
    if (m->breakaway.falls) {
        find_falling(m, sys, y);
    }
    const double moment = find_moment(m);
    tribo_stick_slip_find_rate(m, sys, y);
    tribo_stick_slip_contact_accelerations(sys, m->work.rate, 2, m->work.v);
    for (size_t k = 0; k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        m->work.v[i] = m->work.a[i] + moment * m->work.v[i];
    }
    set_bounds_ahead(m, moment);
    const int status = tribo_stick_slip_solve(m, sys, m->work.v, m->work.f);
    if (status) {
        return status;
    }
    find_left(m, sys, m->work.undecided_count, m->work.undecided, m->work.v, m->work.f);
    for (size_t k = 0; k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        m->work.pulled[i] = 0;
        const double limit = limit_ahead(m, i, moment), room = limit - fabs(m->work.f[i]);
        if (tribo_stick_slip_searches(m, i) && room >= 0.0) {
            const signed char direction = slip_direction(m, i, m->work.f[i]);
            const int may = !tribo_breakaway_is_sudden(&m->breakaway, i);
            const int goes = room <= 0.0 && breaks_away(m, i, direction, m->work.v[i]);
            m->work.pulled[i] = (signed char)(goes && !may && m->state.tied[i] ? direction : 0);
            if (goes && may) {
                *ties -= m->state.tied[i] != 0;
                *changes += let_go(m, i, direction);
            }
            m->state.tied[i] = (signed char)(!m->state.tied[i] ? 0 : room > m->noise.allowance[i] ? 2 : 1);
        }
    }
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------ decision */

/* Who is at rest at (t, y), and how all contacts go on without friction. A status. */
static int find_instant(struct stick_slip *m, tribo_system *sys, double t, double *y)
{
    tribo_stick_slip_begin_decision(m, sys, t);
    tribo_stick_slip_update_limits(m, sys, y);
    tribo_elastic_place(m, sys, y);
    const int status = tribo_stick_slip_find_resting(m, sys, y);
    find_static(m, sys, y);
    if (!status) {
        tribo_elastic_move(m, sys, y);
        tribo_stick_slip_find_free(m, sys, t, y);
        tribo_stick_slip_forget_gains(m);
        m->work.undecided = m->constant.all;
        m->work.undecided_count = m->constant.contacts;
    }
    return status;
}

/* *changes = how many have to be decided about once more. A status. */
static int go_round(struct stick_slip *m, tribo_system *sys, const double *y, size_t *changes)
{
    size_t ties;
    int status = tribo_stick_slip_find_forces(m, sys);
    *changes = status ? 0 : let_slide(m, sys, y, &ties);
    if (!status && !*changes && (ties || (m->state.dependents && m->constant.base_moves))) {
        status = look_ahead(m, sys, y, &ties, changes);
    }
    if (!status && !*changes && ties) {
        status = tribo_stick_slip_relieve(m, sys, changes);
    }
    if (*changes) {
        begin_again(m);
    }
    return status;
}

/* Those that broke away, and are held after all, hold by their static limits again. */
static void restore_static(struct stick_slip *m, const tribo_system *sys, const double *y, int status)
{
    if (!status) {
        tribo_stick_slip_find_gains(m, sys, y);
    }
    for (size_t i = 0; i < m->constant.contacts; i++) {
        m->state.tied[i] = (signed char)(tribo_breakaway_restore(&m->breakaway, i) ? 0 : m->state.tied[i]);
    }
}

int tribo_stick_slip_decide(struct stick_slip *m, tribo_system *sys, double t, double *y)
{
    int status = find_instant(m, sys, t, y);
    for (size_t changes = 1; !status && changes;) {
        status = go_round(m, sys, y, &changes);
    }
    m->state.reached = m->constant.contacts;
    if (m->breakaway.some) {
        restore_static(m, sys, y, status);
    }
    if (!status) {
        tribo_elastic_finish(m, sys);
    }
    return status || tribo_stick_slip_knows_holds(m) ? status : tribo_stick_slip_find_holds(m, sys);
}
