/* SPDX-License-Identifier: BSD-3-Clause */
#include "events.h"
#include "common/layout.h"
#include "common/real.h"
#include "numerics/twofold.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Factor of noise for one decision where events make no headway. */
#define DOUBT 10.0

/* Events at once, and again in every time of 1/(16 fastest), before they count as no headway. */
static double most_credit(const struct events *e)
{
    return 32.0 + 8.0 * (double)e->stick_slip.constant.contacts;
}

/* Credit used up in this part of such a time is no headway; MOST_STUCK events in a row without headway end the advance. Some
 * hundred thousand happen where limits swing, and lead on. */
#define HEADWAY 1e-2
#define MOST_STUCK 1e6

/* Steps without events, in less than such a time or than 1e-9 of the advance, that end the advance. Planar contacts that creep,
 * too many for the longer steps of event_creep.h, take some ten thousand. */
#define MOST_IDLE 100000

/* Phases are alike if their lengths differ by at most this part. */
#define ALIKE 0.1

/* Slips from -1 to 3. */
#define SLIPS 5

int tribo_events_create(struct events *e, tribo_driver *drv, const struct motion *motion, void *own)
{
    const size_t c = drv->sys->ncontact;
    e->motion = e->search.motion = motion;
    e->own = e->search.own = own;
    const int status = tribo_stick_slip_create(&e->stick_slip, drv->sys);
    if (status) {
        return status;
    }
    return ALLOCATE(ARRAY(e->lasted, SLIPS * c), ARRAY(e->search.guard, 4 * c), ARRAY(e->search.watched, 4 * c),
                    ARRAY(e->shown, c))
               ? TRIBO_OK
               : tribo_error(drv->sys->message, TRIBO_ERR_MEMORY, "out of memory for the events of %zu contact%s", c, plural(c));
}

void tribo_events_free(struct events *e)
{
    tribo_stick_slip_free(&e->stick_slip);
    free(e->lasted);
}

/* -------------------------------------------------------------------------------------------------------------- events */

/* Gives events all their credit, from t on. */
static void refill_credit(struct events *e, double t)
{
    e->credit = most_credit(e);
    e->since = t;
}

/* Counts an event of a contact against the credit, which grows with time; an error if events make no headway. */
static int count_event(struct events *e, tribo_driver *drv, size_t contact, double t)
{
    const double most = most_credit(e);
    drv->events++;
    e->credit += 16.0 * most * e->fastest * (t - e->paid);
    e->paid = t;
    e->stick_slip.noise.factor = 1.0;
    if (e->credit >= most) {
        refill_credit(e, t);
        e->suspects = 0;
    }
    size_t k = 0;
    while (k < e->suspects && e->suspect[k] != contact) {
        k++;
    }
    if (k == e->suspects && k < TRIBO_SUSPECTS) {
        e->suspect[e->suspects++] = contact;
    }
    e->credit -= 1.0;
    if (e->credit < 0.0) {
        e->stick_slip.noise.factor = DOUBT;
        e->stuck = 16.0 * e->fastest * (t - e->since) < HEADWAY ? e->stuck + most : 0.0;
        refill_credit(e, t);
    }
    if (!(e->stuck > MOST_STUCK)) {
        return TRIBO_OK;
    }
    char text[TRIBO_SUSPECTS * 32] = "";
    for (size_t i = 0, used = 0; i < e->suspects; i++) {
        used += (size_t)snprintf(text + used, sizeof text - used, "%scontact %zu", i ? ", " : "", e->suspect[i]);
    }
    return tribo_error(drv->message, TRIBO_ERR_CHATTER,
                       "events make no headway at t = %.17g (%s): take central/fixed or moreau/fixed, or limits that differ", t,
                       text);
}

/* Counts a step that no event ended. */
static int count_step(struct events *e, tribo_driver *drv, double t, double t1)
{
    if (16.0 * e->fastest * (t - e->rested) >= 1.0 && t - e->rested >= 1e-9 * (t1 - e->begin)) {
        e->rested = t;
        e->idle = 0;
    }
    return ++e->idle <= MOST_IDLE ? TRIBO_OK
                                  : tribo_error(drv->message, TRIBO_ERR_STEP,
                                                "at t = %.17g the step is down to %g, and %d such steps lead nowhere%s", t,
                                                e->when, MOST_IDLE, e->stick_slip.plane ? ": take moreau/fixed" : "");
}

/* Shows the observer the states at begin + k output, within the phase from t on. */
static int show_between(struct events *e, tribo_driver *drv, double t, const double *y)
{
    int status = TRIBO_OK;
    const int shows = drv->seen && drv->output > 0.0;
    for (double at; shows && !status && (at = e->begin + e->outputs * drv->output) < t + e->when; e->outputs += 1.0) {
        e->motion->state(e->own, greater((at - t) - drv->sys->loads.low, 0.0), y, drv->slope);
        status = tribo_driver_accept(drv, at, drv->slope);
    }
    return status;
}

/* The slip of contact i for the observer: a contact that presses without friction, mu = 0, is not open. */
static signed char shown_slip(const struct stick_slip *m, size_t i)
{
    const struct follower *f = m->state.slip[i] == TRIBO_SLIP_OPEN ? tribo_normals_follower(m->constant.sys, i) : NULL;
    return f && m->state.pressed[f->normal] ? TRIBO_SLIP_STUCK : m->state.slip[i];
}

static void set_shown(struct events *e)
{
    for (size_t i = 0; i < e->stick_slip.constant.contacts; i++) {
        e->shown[i] = shown_slip(&e->stick_slip, i);
    }
}

/* Shows the observer each contact whose slip differs from shown[], in ascending order, until it answers anything but 0; the
 * next advance shows the others if it continues. Sets *some = 1 if a contact is shown. Returns a status. */
static int show_changes(struct events *e, tribo_driver *drv, double t, const double *y, int *some)
{
    const struct stick_slip *m = &e->stick_slip;
    int status = TRIBO_OK;
    for (size_t i = 0; i < m->constant.contacts && !status; i++) {
        const signed char from = e->shown[i], to = shown_slip(m, i);
        const int second = (m->plane && m->plane->in_plane[i] == 2) || m->constant.pair[i] == 2;
        e->shown[i] = to;
        if (!second && from != to) {
            const int moment = to == TRIBO_SLIP_OPEN      ? TRIBO_MOMENT_LIFT
                               : from == TRIBO_SLIP_OPEN  ? TRIBO_MOMENT_TOUCH
                               : to == TRIBO_SLIP_STUCK   ? TRIBO_MOMENT_STICK
                               : from == TRIBO_SLIP_STUCK ? TRIBO_MOMENT_SLIP
                                                          : TRIBO_MOMENT_REVERSE;
            *some = 1;
            status = tribo_driver_show(drv, t, y, moment, i);
        }
    }
    return status;
}

static int decide(struct events *e, tribo_system *sys, double t, double *y)
{
    struct stick_slip *m = &e->stick_slip;
    const int status = tribo_stick_slip_decide(m, sys, t, y);
    memset(m->noise.velocity_scale, 0, m->constant.contacts * sizeof *m->noise.velocity_scale);
    e->decided = status == TRIBO_OK;
    return status;
}

/* Accelerations are constant over BRIEF of the time of the fastest motion, if the second derivative of the velocity changes
 * the first one by at most STEADY. */
#define BRIEF 1e-9
#define STEADY 1e-8

/* 1 if a contact stops in such a time, by a limit far above all other forces: the closed motion, which becomes large later,
 * loses that in its rounding. */
static int is_brief(const struct events *e, const tribo_system *sys, double reach)
{
    const struct guard *met = e->search.at_once ? e->met : NULL;
    return met && !e->stick_slip.plane && !e->stick_slip.limits.falls && !sys->compliance.count && !sys->normals.count &&
           e->when * fabs(met->left.e) <= STEADY * fabs(met->left.d) && (!sys->loads.tables || e->when <= BRIEF * reach) &&
           e->when * tribo_system_fastest(sys) <= BRIEF;
}

/* Moves y by a brief phase at constant accelerations, and forgets the shares of redundant contacts: these forces are no guess
 * for the next ones. Returns a status. */
static int go_brief(struct stick_slip *m, tribo_system *sys, double t, double tau, double *y)
{
    const size_t n = sys->ndof;
    const int status = tribo_stick_slip_acceleration(m, sys, t, y, m->work.acceleration, m->state.force);
    for (size_t i = 0; i < n; i++) {
        y[n + i] += 0.5 * tau * m->work.acceleration[i];
        y[i] += tau * y[n + i];
    }
    for (size_t i = 0; i < m->constant.contacts; i++) {
        const double power = m->state.slip[i] ? -m->state.force[i] * tribo_stick_slip_velocity(m, sys, i, y) : 0.0;
        y[tribo_system_energy(sys)] += sys->tally[i] * tau * power;
    }
    for (size_t i = 0; i < n; i++) {
        y[n + i] += 0.5 * tau * m->work.acceleration[i];
    }
    tribo_stick_slip_forget_shares(m);
    return status;
}

/* Moves (t, y) to the end of a phase: until e->met, or, with e->met = NULL, `end` or the end that the method sets. Returns a
 * status. */
static int travel(struct events *e, tribo_driver *drv, double *t, double end, double *y)
{
    tribo_system *sys = drv->sys;
    double reach = (end - *t) - sys->loads.low;
    int status = tribo_driver_pass(drv, e->motion->begin(e->own, *t, y, &reach));
    if (status) {
        return status;
    }
    /* rounded so that t + reach is a double, if reach is long enough for that */
    const double even = (lesser(*t + (sys->loads.low + reach), end) - *t) - sys->loads.low;
    reach = fabs(even - reach) <= 1e-3 * reach ? even : reach;
    e->search.resolution = DBL_EPSILON * DBL_EPSILON * greater(fabs(*t), reach);
    if (!(reach > e->search.resolution)) {
        return tribo_error(drv->message, TRIBO_ERR_STEP, "at t = %.17g the step is down to %g", *t, reach);
    }
    if (!tribo_first_zero(&e->search, reach, &e->met, &e->when)) {
        e->motion->state(e->own, reach, y, y);
        status = tribo_driver_check(drv, y); /* an error if y overflows */
        return status ? status
                      : tribo_error(drv->message, TRIBO_ERR_STEP,
                                    "from t = %.17g on the motion is too fast to be followed: given up after %zu look%s", *t,
                                    e->search.looks, plural(e->search.looks));
    }
    e->when = e->met ? lesser(e->when, reach) : reach;
    status = show_between(e, drv, *t, y);
    if (status) {
        return status;
    }
    e->brief = is_brief(e, sys, reach);
    e->motion->state(e->own, e->when, y, e->brief ? drv->slope : y);
    status = e->brief ? tribo_driver_pass(drv, go_brief(&e->stick_slip, sys, *t, e->when, y)) : TRIBO_OK;
    status = status ? status : tribo_driver_check(drv, y);
    if (status) {
        return status;
    }
    const struct twofold next = twofold_sum(*t, sys->loads.low + e->when);
    const int there = e->when >= (end - *t) - sys->loads.low || next.hi > end || (next.hi == end && next.lo > 0.0);
    *t = there ? end : next.hi;
    tribo_system_set_low(sys, there ? 0.0 : next.lo);
    tribo_system_set_time(sys, *t);
    return TRIBO_OK;
}

/* Moves (t, y) to the end of one phase, and decides there. Shows the observer each contact with another slip than before, or the
 * state alone if there is none. After an error y is undefined: the driver keeps the state before the advance. */
static int phase(struct events *e, tribo_driver *drv, double *t, double t1, double *y)
{
    struct stick_slip *m = &e->stick_slip;
    const double end = drv->sys->loads.tables ? lesser(t1, tribo_system_next_kink(drv->sys, *t)) : t1;
    e->decided = 0;
    int status = travel(e, drv, t, end, y), some = 0, stops = 0;
    status = status || !e->company ? status : tribo_driver_pass(drv, e->company->ends(e->company, e->when, *t, y));
    if (status) {
        return status;
    }
    const struct guard *event = e->met && e->met->kind != SLOWS ? e->met : NULL;
    drv->steps++;
    tribo_events_learn(e, drv);
    if (event) {
        status = count_event(e, drv, event->contact, *t);
        if (event->kind == SLIDES) {
            tribo_stick_slip_set(m, event->contact, TRIBO_SLIP_STUCK);
        } else {
            m->state.reached = event->contact;
        }
    } else if (*t < end) {
        status = count_step(e, drv, *t, t1);
    }
    status = status ? status : tribo_driver_pass(drv, decide(e, drv->sys, *t, y));
    if (e->begun && event) {
        *e->begun = (struct lasted){e->when, fabs(e->when - e->begun->time)};
    }
    /* a zero is expected as in the phases that began as the next one does, if the last two were alike */
    e->begun = event ? e->lasted + SLIPS * event->contact + (m->state.slip[event->contact] + 1) : NULL;
    e->search.expected = e->begun && e->begun->change <= ALIKE * e->begun->time ? e->begun->time : 0.0;
    stops = !status && m->plane && m->plane->stopped < m->constant.contacts;
    if (!status && (event || stops) && e->company && e->company->decided) {
        e->company->decided(e->company);
    }
    if (!status && m->plane) {
        status = stops ? count_event(e, drv, m->plane->stopped, *t) : TRIBO_OK;
        for (size_t i = 0; drv->seen && i < m->constant.contacts; i++) {
            const int slides = m->state.slip[i] == TRIBO_SLIP_PLANE && e->shown[i] == TRIBO_SLIP_PLANE;
            /* differs from TRIBO_SLIP_PLANE if the contact stopped, and slides again at one instant */
            e->shown[i] = slides && m->state.rested[i] ? -TRIBO_SLIP_PLANE : e->shown[i];
        }
    }
    if (status) {
        return status;
    }
    tribo_driver_keep(drv, *t, y); /* finite: a decision takes only rounding out of y */
    status = drv->seen ? show_changes(e, drv, *t, y, &some) : TRIBO_OK;
    const int seen = drv->seen && !some && (event || stops || (*t >= t1 && drv->sys->loads.low == 0.0));
    return seen && !status ? tribo_driver_show(drv, *t, y, TRIBO_MOMENT_STEP, SIZE_MAX) : status;
}

int tribo_events_advance(struct events *e, tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    struct stick_slip *m = &e->stick_slip;
    const size_t contacts = m->constant.contacts;
    const double fastest = tribo_system_fastest(drv->sys);
    e->fastest = fastest > 0.0 ? fastest : 1.0 / (t1 - *t);
    e->begin = *t;
    e->outputs = 1.0;
    if (drv->seen && drv->output > 0.0 && !(*t + drv->output > *t && t1 - drv->output < t1)) {
        return tribo_error(drv->message, TRIBO_ERR_STEP, "output every %g is below what time resolves at t = %.17g", drv->output,
                           t1);
    }
    if (!e->watched) {
        set_shown(e);
    }
    e->watched = drv->seen != NULL;
    int status = tribo_stick_slip_start(m, drv->sys, *t, y, continues), some;
    if (!status && !(continues && e->decided)) {
        status = decide(e, drv->sys, *t, y);
    }
    status = tribo_driver_pass(drv, status);
    e->begun = NULL;
    e->search.expected = 0.0;
    e->anew = !continues;
    if (!continues) { /* nothing depends on the run before, not even in rounding */
        e->paid = e->rested = *t;
        e->idle = e->suspects = 0;
        e->stuck = 0.0;
        refill_credit(e, *t);
        memset(e->lasted, 0, SLIPS * contacts * sizeof *e->lasted);
        set_shown(e);
    } else if (!status && drv->seen) {
        tribo_driver_keep(drv, *t, y);
        status = show_changes(e, drv, *t, y, &some);
    }
    while (!status && (*t < t1 || drv->sys->loads.low < 0.0)) {
        status = phase(e, drv, t, t1, y);
    }
    tribo_system_set_low(drv->sys, 0.0);
    return status;
}

int tribo_events_method(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    struct events *e;
    const int status = drv->at_work->open(drv, &e);
    return status ? status : tribo_events_advance(e, drv, t, t1, y, continues);
}
