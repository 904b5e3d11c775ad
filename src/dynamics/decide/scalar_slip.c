/* SPDX-License-Identifier: BSD-3-Clause */
/* Decides, at an instant, which scalar contacts stick and which slide:
 *
 *     repeat
 *         find the forces: min 1/2 f'Rf + a'f, with |f| <= limit at rest, and f at its limit where a contact slides
 *         a contact at rest slides if its force is at the limit and its acceleration exceeds rounding
 *         if none does, but some are just at their limit: solve for a moment later; contacts at their limit then slide
 *         if still none does: of the forces that hold all contacts at rest, the one most beyond its limit makes its contact slide
 *         a contact that held by a static limit does not slide yet: in the next round its bound is the limit to slide, and all
 *         contacts that began to slide are at rest again
 *     until no contact begins to slide */
#include "stick_slip.h"
#include "common/real.h"

#include <math.h>
#include <string.h>

/* A force this close to its limit, in parts of it, may exceed it by rounding, or in a moment as other contacts begin to
 * slide. */
#define CLOSE 0.1

/* The same if R is diagonal: only rounding may take a force that stands alone beyond its limit. */
#define NEAR 1e-3

/* The solver's error for redundant contacts, in units of the noise of accelerations. */
#define CERTAIN 1e3

/* The moment later: the bounds of a contact close to its limit, but not at it, are wider by this part of the limit. */
#define WIDER 0.02

/* The moment later: largest change of a limit, in parts of the largest force. */
#define CHANGES 1e-4

/* A force beyond a static limit is an event at the allowance of its phase, which may be smaller than that of the end of the
 * phase: the decision takes this part of the latter. */
#define AT_THE_EVENT 0.125

/* ------------------------------------------------------------------------------------------------------------- forces */

/* The force of contact i alone between lo and hi: clamp(-a_i/R_ii, lo, hi); for R_ii = 0 the bound against a. */
static inline double force_alone(const struct stick_slip *m, size_t i, double a, double lo, double hi)
{
    const double r = m->constant.diagonal[i];
    return r > 0.0 ? clamp(-a / r, lo, hi) : a > 0.0 ? lo : a < 0.0 ? hi : clamp(0.0, lo, hi);
}

/* Finds f [ncontact] within work.lo and hi at accelerations a without f, where R is not diagonal. Returns a status. */
static int solve(struct stick_slip *m, const tribo_system *sys, const double *a, double *f)
{
    const struct slip_constant *c = &m->constant;
    const struct matrix *j = &sys->direction;
    const double *lo = m->work.lo, *hi = m->work.hi;
    size_t unknown = 0, i = 0;
    for (size_t k = 0; k < c->contacts; k++) {
        i = lo[k] < hi[k] ? k : i;
        unknown += lo[k] < hi[k];
        f[k] = lo[k];
    }
    if (c->independent && !unknown) {
        return TRIBO_OK;
    }
    if (!c->independent || unknown > 1) { /* contacts that depend on each other start from these forces next time */
        const int status = tribo_solve_box(c->box, a, lo, hi, f);
        return status ? tribo_error(sys->message, status, "at t = %.17g: %s", sys->loads.time, tribo_message(c->box)) : TRIBO_OK;
    }
    double own = a[i];
    f[i] = 0.0;
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        own += j->val[k] * tribo_matrix_row_dot(&sys->response, j->col[k], f);
    }
    f[i] = force_alone(m, i, own, lo[i], hi[i]);
    return TRIBO_OK;
}

/* Finds state.force and lists work.doubt: the contacts that others or their own limits may change in this decision. If R is
 * diagonal these are the contacts at rest near their limits; else all, or none if none is close. Returns a status. */
static int find_forces(struct stick_slip *m, const tribo_system *sys)
{
    const struct slip_constant *c = &m->constant;
    struct slip_state *s = &m->state;
    struct slip_work *w = &m->work;
    const int all = !c->uncoupled;
    const double part = 1.0 - (all ? CLOSE : NEAR), *const stick = s->stick, *const a = w->a;
    double *const force = s->force;
    int status = TRIBO_OK, close = s->dependents && c->base_moves;
    size_t count = 0;
    for (size_t i = 0; all && i < c->contacts; i++) {
        const int searches = tribo_stick_slip_searches(m, i);
        w->hi[i] = searches ? s->stick[i] : c->elastic[i] ? s->spring[i] : -s->slip[i] * s->limit[i];
        w->lo[i] = searches ? -s->stick[i] : w->hi[i];
    }
    if (all) {
        status = solve(m, sys, a, force);
    }
    for (size_t i = 0; i < c->contacts; i++) {
        const int searches = tribo_stick_slip_searches(m, i);
        if (!all) {
            const double own = c->elastic[i] ? s->spring[i] : -s->slip[i] * s->limit[i];
            force[i] = searches ? force_alone(m, i, a[i], -stick[i], stick[i]) : own;
        }
        const int near = searches && (fabs(force[i]) >= part * stick[i] || i == s->reached);
        close |= near;
        if (near || all || !tribo_can_hold(m, i)) {
            w->doubt[count++] = i;
        }
    }
    w->doubts = close ? count : 0;
    return status;
}

/* Sets work.v of the contacts in doubt = their accelerations a + R f. */
static void accelerate_doubtful(struct stick_slip *m, const tribo_system *sys, const double *a, const double *f)
{
    if (!m->constant.uncoupled) {
        tribo_stick_slip_accelerate(m, sys, a, f, m->work.v);
        return;
    }
    for (size_t k = 0; k < m->work.doubts; k++) {
        const size_t i = m->work.doubt[k];
        m->work.v[i] = a[i] + m->constant.diagonal[i] * f[i];
    }
}

/* --------------------------------------------------------------------------------------------------------- letting go */

/* Lets contact i slide; if it held by a static limit, lowers that instead, and the next round decides about it. Returns 1 if
 * another round is needed; 0 if the contact slides, and R is diagonal: that changes no other force. */
static size_t let_go(struct stick_slip *m, size_t i, signed char direction)
{
    struct slip_state *s = &m->state;
    const int again = tribo_drops(m, i) && !m->limits.falls;
    if (again) {
        tribo_limits_set_stick(m, i, 1.0);
    }
    tribo_stick_slip_set(m, i, again ? TRIBO_SLIP_STUCK : direction);
    s->force[i] = again ? s->force[i] : -direction * s->limit[i];
    s->tied[i] = 0;
    m->work.limit_lost |= again;
    return again || !m->constant.uncoupled;
}

/* 1 if contact i would lose a static limit and forces at rest are not unique. */
static int must_be_sure(const struct stick_slip *m, size_t i)
{
    return m->state.dependents && tribo_drops(m, i);
}

/* The direction in which contact i slides that is at its limit by `force`, if `part` of its acceleration work.v exceeds
 * rounding: against the force; if the force is 0, along the acceleration. 0 if the contact stays. */
static signed char leaves(const struct stick_slip *m, size_t i, double force, double part)
{
    const double a = part * m->work.v[i], against = force != 0.0 ? -force : a;
    const signed char direction = against < 0.0 ? TRIBO_SLIP_BACK : TRIBO_SLIP_FORTH;
    return (signed char)(direction * a > m->noise.acceleration[i] ? direction : 0);
}

/* Lets contacts slide by the forces found, and ties those at their limits. Returns the number of contacts that need another
 * round; *ties = number of tied contacts. */
static size_t let_slide(struct stick_slip *m, const tribo_system *sys, const double *y, size_t *ties)
{
    struct slip_state *s = &m->state;
    size_t changes = 0;
    int found = 0; /* 1: work.v are the accelerations by the forces */
    *ties = 0;
    for (size_t k = 0; k < m->work.doubts; k++) {
        const size_t i = m->work.doubt[k];
        if (tribo_stick_slip_searches(m, i)) {
            const double room = s->stick[i] - fabs(s->force[i]);
            tribo_stick_slip_find_gain(m, sys, y, i);
            s->tied[i] = room <= (i == s->reached ? CLOSE * s->stick[i] : m->noise.allowance[i] / TRIBO_ALLOWED);
            if (s->tied[i] && room <= 0.0) {
                if (!found) { /* before any contact of this round lets go */
                    accelerate_doubtful(m, sys, m->work.a, s->force);
                    found = 1;
                }
                const signed char direction = leaves(m, i, s->force[i], must_be_sure(m, i) ? 1.0 / CERTAIN : 1.0);
                changes += direction ? let_go(m, i, direction) : 0;
            }
            *ties += s->tied[i] != 0;
        }
    }
    return changes;
}

/* ---------------------------------------------------------------------------------------------------------- look ahead */

/* The limit of contact i a moment later. */
static double limit_ahead(const struct slip_state *s, size_t i, double moment)
{
    return greater(s->slip[i] ? s->limit[i] + moment * s->limit_rate[i] : s->stick[i] + moment * s->stick_rate[i], 0.0);
}

/* The time to look ahead: the horizon, or less where a limit that is close to a force changes by more than CHANGES of the
 * largest force. */
static double find_moment(const struct stick_slip *m)
{
    const struct slip_state *s = &m->state;
    const double horizon = m->constant.horizon;
    double moment = horizon, force = 0.0;
    if (!tribo_system_limits_vary(m->constant.sys) && !m->limits.falls) {
        return horizon;
    }
    for (size_t i = 0; i < m->constant.contacts; i++) {
        force = greater(force, greater(fabs(s->force[i]), m->constant.inertia[i] * fabs(m->work.a[i])));
    }
    for (size_t i = 0; force > 0.0 && i < m->constant.contacts; i++) {
        const double rate = fabs(s->slip[i] ? s->limit_rate[i] : s->stick_rate[i]);
        const int close = (s->slip[i] ? s->limit[i] : s->stick[i]) <= fabs(s->force[i]) + horizon * rate;
        moment = close && moment * rate > CHANGES * force ? CHANGES * force / rate : moment;
    }
    return moment;
}

/* Lets contacts slide by the forces of a moment later. A contact that stays tied is marked 1, or 2 if it goes back inside; one
 * that would lose a static limit is marked in work.pulled instead. */
static int look_ahead(struct stick_slip *m, const tribo_system *sys, const double *y, size_t *ties, size_t *changes)
{
    struct slip_state *s = &m->state;
    struct slip_work *w = &m->work;
    if (m->limits.falls) {
        tribo_stick_slip_accelerate(m, sys, w->a, s->force, w->v);
        tribo_limits_fall(m, sys, y, w->v);
    }
    const double moment = find_moment(m);
    tribo_stick_slip_find_rate(m, sys, y);
    tribo_stick_slip_contact_accelerations(sys, w->rate, 2, w->v);
    memset(w->pulled, 0, m->constant.contacts);
    for (size_t k = 0; k < w->doubts; k++) {
        const size_t i = w->doubt[k];
        const double limit = limit_ahead(s, i, moment), now = s->stick[i], wider = s->tied[i] ? 0.0 : WIDER * now;
        if (tribo_stick_slip_searches(m, i)) {
            w->hi[i] = limit + (now - s->force[i] < wider ? wider : 0.0);
            w->lo[i] = -limit - (now + s->force[i] < wider ? wider : 0.0);
        } else {
            w->lo[i] = w->hi[i] = m->constant.elastic[i] ? s->spring[i] + moment * s->spring_rate[i] : -s->slip[i] * limit;
        }
        w->v[i] = w->a[i] + moment * w->v[i];
        w->f[i] = force_alone(m, i, w->v[i], w->lo[i], w->hi[i]);
    }
    const int status = m->constant.uncoupled ? TRIBO_OK : solve(m, sys, w->v, w->f);
    if (status) {
        return status;
    }
    accelerate_doubtful(m, sys, w->v, w->f);
    for (size_t k = 0; k < w->doubts; k++) {
        const size_t i = w->doubt[k];
        const double room = limit_ahead(s, i, moment) - fabs(w->f[i]);
        if (tribo_stick_slip_searches(m, i) && room >= 0.0) {
            const signed char direction = (signed char)(room <= 0.0 ? leaves(m, i, w->f[i], 1.0) : 0);
            const int sudden = tribo_drops(m, i);
            w->pulled[i] = (signed char)(sudden && s->tied[i] ? direction : 0);
            if (direction && !sudden) {
                *ties -= s->tied[i] != 0;
                *changes += let_go(m, i, direction);
            }
            s->tied[i] = (signed char)(!s->tied[i] ? 0 : room > m->noise.allowance[i] ? 2 : 1);
        }
    }
    return TRIBO_OK;
}

/* --------------------------------------------------------------------------------------------------------------- relief
 * Contacts at rest just at their limits, decided about by the forces that hold all contacts at rest:
 *
 *     contacts that reached their limits keep their forces, and an independent set of the others holds
 *     if a static limit is exceeded: the forces of all by least norm, which leave room wherever there is some
 *     if it is exceeded by these too: all contacts in work.pulled break away together
 *
 * A static limit that is lost does not come back. So no static limit is lost as long as any forces within the limits hold all
 * contacts where they are; the solver's own rounding, which may exceed that of the forces, does not decide. */

/* Finds work.f = the forces that hold all contacts at rest, those that do not hold having state.force. Returns a status. */
static int find_forces_at_rest(struct stick_slip *m, const tribo_system *sys)
{
    double *f = m->work.f;
    const int status = tribo_stick_slip_find_holds(m, sys);
    for (size_t i = 0; i < m->constant.contacts; i++) {
        f[i] = m->state.loose[i] ? m->state.force[i] : 0.0;
    }
    tribo_stick_slip_accelerate(m, sys, m->work.a, f, m->work.v);
    return status ? status : tribo_stick_slip_balance(m, m->work.v, f);
}

/* The contact that work.f takes most beyond its limit; ncontact if none. */
static size_t most_overloaded(const struct stick_slip *m)
{
    const struct slip_state *s = &m->state;
    size_t worst = m->constant.contacts;
    double most = 1.0;
    for (size_t i = 0; i < m->constant.contacts; i++) {
        const int sure = must_be_sure(m, i);
        const double excess = fabs(m->work.f[i]) - s->stick[i], allowance = (sure ? AT_THE_EVENT : 1.0) * m->noise.allowance[i];
        if ((sure || s->tied[i]) && s->holds[i] && excess > most * allowance) {
            worst = i;
            most = excess / allowance;
        }
    }
    return worst;
}

/* Takes the forces that hold all contacts at rest, or lets contacts slide and sets *changes = 1. Returns a status. */
static int relieve(struct stick_slip *m, const tribo_system *sys, size_t *changes)
{
    struct slip_state *s = &m->state;
    const struct slip_work *w = &m->work;
    const size_t none = m->constant.contacts;
    int status = find_forces_at_rest(m, sys), gone = 0;
    size_t worst = most_overloaded(m);
    const signed char direction = worst < none && w->f[worst] > 0.0 ? TRIBO_SLIP_BACK : TRIBO_SLIP_FORTH;
    if (!status && worst < none && must_be_sure(m, worst)) { /* by least norm, which ties contacts anew */
        tribo_set_sharing(m->constant.box, TRIBO_SHARE_LEAST_NORM);
        status = find_forces(m, sys);
        tribo_set_sharing(m->constant.box, TRIBO_SHARE_PREVIOUS);
        for (size_t i = 0; i < none; i++) {
            s->tied[i] = tribo_stick_slip_searches(m, i) && s->stick[i] - fabs(s->force[i]) <= m->noise.allowance[i];
        }
        status = status ? status : find_forces_at_rest(m, sys);
        worst = most_overloaded(m) < none ? worst : none;
    }
    if (status) {
        return status;
    }
    const int sudden = worst < none && tribo_drops(m, worst);
    for (size_t i = 0; i < none; i++) {
        if (worst == none) { /* work.f are the forces */
            const double force = s->loose[i] ? s->force[i] : clamp(w->f[i], -s->stick[i], s->stick[i]);
            m->noise.excess[i] = s->loose[i] ? 0.0 : fabs(w->f[i] - force);
            s->force[i] = force;
        } else if (sudden && w->pulled[i]) {
            let_go(m, i, w->pulled[i]);
            gone = 1;
        }
    }
    if (worst < none && !gone) {
        let_go(m, worst, direction);
    }
    *changes = worst < none ? 1 : *changes;
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------ decision */

int tribo_scalar_slip_settle(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    struct slip_state *s = &m->state;
    int status = TRIBO_OK;
    for (size_t changes = 1, ties; !status && changes;) {
        status = find_forces(m, sys);
        changes = status ? 0 : let_slide(m, sys, y, &ties);
        if (!status && !changes && (ties || (s->dependents && m->constant.base_moves))) {
            status = look_ahead(m, sys, y, &ties, &changes);
        }
        if (!status && !changes && ties) {
            status = relieve(m, sys, &changes);
        }
        if (changes) {
            memset(s->tied, 0, m->constant.contacts);
            for (size_t i = 0; m->work.limit_lost && i < m->constant.contacts; i++) {
                tribo_stick_slip_set(m, i, s->rested[i] ? TRIBO_SLIP_STUCK : s->slip[i]); /* slips while the lost limits held */
            }
            m->work.limit_lost = 0;
        }
    }
    if (m->limits.differ && !status) {
        tribo_stick_slip_find_gains(m, sys, y);
        for (size_t i = 0; i < m->constant.contacts; i++) {
            /* a contact that broke away, and is held by others after all, has its static limit again */
            const double lowered = s->stick[i];
            tribo_limits_set_stick(m, i, m->limits.ratio[i]);
            s->tied[i] = (signed char)(lowered < s->stick[i] ? 0 : s->tied[i]);
        }
    }
    return status;
}
