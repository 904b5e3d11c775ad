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

/* Steps without events in less than such a time that end the advance. Planar contacts that creep, too many for the longer
 * steps of event_creep.h, take some ten thousand. */
#define MOST_IDLE 100000

/* Phases are alike if their lengths differ by at most this part. */
#define ALIKE 0.1

/* Slips from -1 to 3. */
#define SLIPS 5

static void lay_out_events(struct events *e, struct layout *l, const tribo_system *sys)
{
    const size_t c = sys->ncontact;
    e->lasted = tribo_layout_array(l, SLIPS * c, sizeof *e->lasted);
    e->search.guard = tribo_layout_array(l, 3 * c, sizeof *e->search.guard);
    e->search.watched = tribo_layout_array(l, 3 * c, sizeof *e->search.watched);
    e->shown = tribo_layout_array(l, c, sizeof *e->shown);
}

int tribo_events_create(struct events *e, tribo_driver *drv, const struct motion *motion, void *own)
{
    tribo_system *sys = drv->sys;
    e->motion = e->search.motion = motion;
    e->own = e->search.own = own;
    const int status = tribo_stick_slip_create(&e->stick_slip, sys);
    if (status) {
        return status;
    }
    struct layout l = {0};
    lay_out_events(e, &l, sys);
    const int done = tribo_layout_create(&l);
    lay_out_events(e, &l, sys);
    if (!done) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the events of %zu contact%s", sys->ncontact,
                                 plural(sys->ncontact));
    }
    memset(e->lasted, 0, SLIPS * sys->ncontact * sizeof *e->lasted);
    drv->excess = drv->backslip = 0.0;
    return TRIBO_OK;
}

void tribo_events_free(struct events *e)
{
    tribo_planar_slip_free(e->stick_slip.plane);
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
static int count_event(struct events *e, tribo_driver *drv, size_t contact, double t, double fastest)
{
    const double most = most_credit(e);
    drv->events++;
    e->credit += 16.0 * most * fastest * (t - e->paid);
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
        e->stuck = 16.0 * fastest * (t - e->since) < HEADWAY ? e->stuck + most : 0.0;
        refill_credit(e, t);
    }
    if (!(e->stuck > MOST_STUCK)) {
        return TRIBO_OK;
    }
    char text[TRIBO_SUSPECTS * 32] = "";
    for (size_t i = 0, used = 0; i < e->suspects; i++) {
        used += (size_t)snprintf(text + used, sizeof text - used, "%scontact %zu", i ? ", " : "", e->suspect[i]);
    }
    return tribo_driver_fail(
        drv, TRIBO_ERR_CHATTER,
        "events make no headway at t = %.17g (%s): take central/fixed or moreau/fixed, or limits that differ", t, text);
}

/* Counts a step that no event ended. */
static int count_step(struct events *e, tribo_driver *drv, double t, double tau, double fastest)
{
    if (16.0 * fastest * (t - e->rested) >= 1.0) {
        e->rested = t;
        e->idle = 0;
    }
    return ++e->idle <= MOST_IDLE
               ? TRIBO_OK
               : tribo_driver_fail(drv, TRIBO_ERR_STEP, "at t = %.17g the step is down to %g, and %d such steps lead nowhere%s",
                                   t, tau, MOST_IDLE, e->stick_slip.plane ? ": take moreau/fixed" : "");
}

/* Sets search.expected by the phases that began as this one does, if the last two were alike. */
static void expect(struct events *e, const struct guard *event, double when)
{
    if (e->begun && event) {
        *e->begun = (struct lasted){when, fabs(when - e->begun->time)};
    }
    e->begun = event ? e->lasted + SLIPS * event->contact + (e->stick_slip.state.slip[event->contact] + 1) : NULL;
    e->search.expected = e->begun && e->begun->change <= ALIKE * e->begun->time ? e->begun->time : 0.0;
}

/* Begins a run: one that does not continue must not depend on the run before, not even in rounding; for one that continues
 * events are counted on. */
static void forget(struct events *e, double t, int continues)
{
    e->begun = NULL;
    e->search.expected = 0.0;
    e->anew = !continues;
    if (!continues) {
        e->paid = e->rested = t;
        e->idle = e->suspects = 0;
        e->stuck = 0.0;
        refill_credit(e, t);
        memset(e->lasted, 0, SLIPS * e->stick_slip.constant.contacts * sizeof *e->lasted);
    }
}

/* Shows the observer the states at begin + k output, between t and t + tau. */
static int show_between(struct events *e, tribo_driver *drv, double begin, double *shown, double t, double tau, const double *y)
{
    int status = TRIBO_OK;
    const int shows = drv->seen && drv->output > 0.0;
    for (double at; shows && !status && (at = begin + *shown * drv->output) < t + tau; *shown += 1.0) {
        e->motion->state(e->own, greater((at - t) - drv->sys->loads.low, 0.0), y, drv->slope);
        status = tribo_driver_accept(drv, at, drv->slope);
    }
    return status;
}

/* In shown[]: a planar contact that stopped and slides again at one instant. */
#define TURNS (-TRIBO_SLIP_PLANE)

/* The moment at which the slip of a contact changes. */
static int kind_of(signed char from, signed char to)
{
    return to == TRIBO_SLIP_OPEN      ? TRIBO_MOMENT_LIFT
           : from == TRIBO_SLIP_OPEN  ? TRIBO_MOMENT_TOUCH
           : to == TRIBO_SLIP_STUCK   ? TRIBO_MOMENT_STICK
           : from == TRIBO_SLIP_STUCK ? TRIBO_MOMENT_SLIP
                                      : TRIBO_MOMENT_REVERSE;
}

/* Shows the observer each contact whose slip differs from shown[], in ascending order, until it answers anything but 0; the
 * next advance shows the others if it continues. Sets *some = 1 if a contact is shown. Returns a status. */
static int show_changes(struct events *e, tribo_driver *drv, double t, const double *y, int *some)
{
    const struct stick_slip *m = &e->stick_slip;
    int status = TRIBO_OK;
    for (size_t i = 0; i < m->constant.contacts && !status; i++) {
        const signed char from = e->shown[i];
        const int second = m->plane && m->plane->in_plane[i] == 2;
        e->shown[i] = m->state.slip[i];
        if (!second && from != m->state.slip[i]) {
            *some = 1;
            status = tribo_driver_show(drv, t, y, kind_of(from, m->state.slip[i]), i);
        }
    }
    return status;
}

/* t + tau, its low part in the system; end if tau reaches it. */
static double time_after(tribo_system *sys, double t, double tau, double end)
{
    const struct twofold next = twofold_sum(t, sys->loads.low + tau);
    const int there = tau >= (end - t) - sys->loads.low || next.hi > end || (next.hi == end && next.lo > 0.0);
    tribo_system_set_low(sys, there ? 0.0 : next.lo);
    return there ? end : next.hi;
}

/* reach, changed by rounding so that t + reach is a double, if reach is long enough for that. */
static double to_a_number(const tribo_system *sys, double t, double reach, double end)
{
    const double next = lesser(t + (sys->loads.low + reach), end), there = (next - t) - sys->loads.low;
    return fabs(there - reach) <= 1e-3 * reach ? there : reach;
}

static int decide(struct events *e, tribo_system *sys, double t, double *y)
{
    struct stick_slip *m = &e->stick_slip;
    const int status = tribo_stick_slip_decide(m, sys, t, y);
    memset(m->noise.velocity_scale, 0, m->constant.contacts * sizeof *m->noise.velocity_scale);
    e->decided = status == TRIBO_OK;
    return status;
}

/* The error of a search given up from (t, y) on: y, the state at t + reach, overflows, or the motion is too fast. */
static int cannot_follow(struct events *e, tribo_driver *drv, double t, double reach, double *y)
{
    e->motion->state(e->own, reach, y, y);
    const int status = tribo_driver_check(drv, y);
    return status ? status
                  : tribo_driver_fail(drv, TRIBO_ERR_STEP,
                                      "from t = %.17g on the motion is too fast to be followed: given up after %zu look%s", t,
                                      e->search.looks, plural(e->search.looks));
}

/* Counts a planar contact that the decision at t has stopped; keeps the state; shows contacts whose slip changed, or the state
 * alone at other events and at the end of the advance. */
static int show_decided(struct events *e, tribo_driver *drv, const struct guard *event, double t, double t1, const double *y,
                        double fastest)
{
    const struct planar_slip *plane = e->stick_slip.plane;
    const int stops = plane && plane->stopped < e->stick_slip.constant.contacts;
    int status = stops ? count_event(e, drv, plane->stopped, t, fastest) : TRIBO_OK, some = 0;
    status = status ? status : tribo_driver_keep(drv, t, y);
    if (status || !drv->seen) {
        return status;
    }
    for (size_t k = 0; plane && k < plane->count; k++) {
        const struct planar_contact *p = &plane->contact[k];
        const int turns = p->begins != SLIDES_ON && e->shown[p->at] == TRIBO_SLIP_PLANE;
        e->shown[p->at] = turns ? TURNS : e->shown[p->at];
    }
    status = show_changes(e, drv, t, y, &some);
    const int seen = !some && (event || stops || (t >= t1 && drv->sys->loads.low == 0.0));
    return seen ? tribo_driver_show(drv, t, y, TRIBO_MOMENT_STEP, SIZE_MAX) : status;
}

/* Accelerations are constant over BRIEF of the time of the fastest motion, if the second derivative of the velocity changes
 * the first one by at most STEADY. */
#define BRIEF 1e-9
#define STEADY 1e-8

/* 1 if a contact stops in such a time, by a limit far above all other forces: the closed motion, which becomes large later,
 * loses that in its rounding. */
static int is_brief(const struct events *e, const tribo_system *sys, const struct guard *event, double reach, double when)
{
    const int simple = !e->stick_slip.plane && !e->stick_slip.breakaway.falls && !sys->compliance.count;
    const int even = event && e->search.at_once && when * fabs(event->left.e) <= STEADY * fabs(event->left.d);
    return simple && even && (!sys->loads.tables || when <= BRIEF * reach) && when * tribo_system_fastest(sys) <= BRIEF;
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

/* Moves y to the end of a phase, and the method's motion too. Returns a status. */
static int go(struct events *e, tribo_driver *drv, int brief, double t, double when, double *y)
{
    e->motion->state(e->own, when, y, brief ? drv->slope : y);
    const int status = brief ? tribo_driver_pass(drv, go_brief(&e->stick_slip, drv->sys, t, when, y)) : TRIBO_OK;
    return status ? status : tribo_driver_check(drv, y);
}

/* One phase, from (t, y) to its end and the decision there. After an error y is undefined: the driver has kept the state
 * before. */
static int phase(struct events *e, tribo_driver *drv, double begin, double *shown, double *t, double t1, double *y,
                 double fastest)
{
    tribo_system *sys = drv->sys;
    const double end = lesser(t1, tribo_system_next_kink(sys, *t));
    const struct guard *event = NULL;
    double reach = (end - *t) - sys->loads.low, when = 0.0;
    e->decided = 0;
    int status = tribo_driver_pass(drv, e->motion->begin(e->own, *t, y, &reach));
    if (status) {
        return status;
    }
    reach = to_a_number(sys, *t, reach, end);
    e->search.resolution = DBL_EPSILON * DBL_EPSILON * greater(fabs(*t), reach);
    if (!(reach > e->search.resolution)) {
        return tribo_driver_fail(drv, TRIBO_ERR_STEP, "at t = %.17g the step is down to %g", *t, reach);
    }
    if (!tribo_first_zero(&e->search, reach, &event, &when)) {
        return cannot_follow(e, drv, *t, reach, y);
    }
    when = event ? lesser(when, reach) : reach;
    status = show_between(e, drv, begin, shown, *t, when, y);
    if (status) {
        return status;
    }
    const int brief = is_brief(e, sys, event, reach, when);
    status = go(e, drv, brief, *t, when, y);
    if (status) {
        return status;
    }
    *t = time_after(sys, *t, when, end);
    if (e->motion->arrive) {
        e->motion->arrive(e->own, *t);
    }
    e->met = event;
    status = e->company ? tribo_driver_pass(drv, e->company->ends(e->company, when, *t, y)) : TRIBO_OK;
    if (status) {
        return status;
    }
    drv->steps++;
    tribo_events_learn(e, drv, brief, when);
    event = event && event->kind != SLOWS ? event : NULL;
    if (event) {
        status = count_event(e, drv, event->contact, *t, fastest);
        tribo_events_mark(&e->stick_slip, event);
    } else if (*t < end) {
        status = count_step(e, drv, *t, when, fastest);
    }
    status = status ? status : tribo_driver_pass(drv, decide(e, sys, *t, y));
    expect(e, event, when);
    if (!status && event && e->company) {
        e->company->decided(e->company);
    }
    return status ? status : show_decided(e, drv, event, *t, t1, y, fastest);
}

int tribo_events_advance(struct events *e, tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    const double begin = *t, own = tribo_system_fastest(drv->sys), fastest = own > 0.0 ? own : 1.0 / (t1 - begin);
    double shown = 1.0;
    if (drv->seen && drv->output > 0.0 && !(begin + drv->output > begin && t1 - drv->output < t1)) {
        return tribo_driver_fail(drv, TRIBO_ERR_STEP, "output every %g is below what time resolves at t = %.17g", drv->output,
                                 t1);
    }
    if (!e->watched) {
        memcpy(e->shown, e->stick_slip.state.slip, drv->sys->ncontact);
    }
    e->watched = drv->seen != NULL;
    tribo_stick_slip_start(&e->stick_slip, drv->sys, *t, y, continues);
    int status = tribo_planar_slip_start(&e->stick_slip, drv->sys, continues);
    if (!status && !(continues && e->decided)) {
        status = decide(e, drv->sys, *t, y);
    }
    status = tribo_driver_pass(drv, status);
    forget(e, *t, continues);
    if (!continues) {
        memcpy(e->shown, e->stick_slip.state.slip, drv->sys->ncontact);
    } else if (!status && drv->seen) {
        int some;
        status = tribo_driver_keep(drv, *t, y);
        status = status ? status : show_changes(e, drv, *t, y, &some);
    }
    while (!status && (*t < t1 || drv->sys->loads.low < 0.0)) {
        status = phase(e, drv, begin, &shown, t, t1, y, fastest);
    }
    tribo_system_set_low(drv->sys, 0.0);
    tribo_system_forget_time(drv->sys); /* others find harmonics anew */
    return status;
}

int tribo_events_method(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    struct events *e;
    const int status = drv->at_work->open(drv, &e);
    return status ? status : tribo_events_advance(e, drv, t, t1, y, continues);
}
