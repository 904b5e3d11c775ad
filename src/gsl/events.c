#include "events.h"
#include "../common/real.h"
#include "../common/twofold.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Where events make no headway, ten times as much is taken for rounding, until it is so many times what it was. */
#define MOST_DOUBT 1e6

/* Events that there may be at once, and again in every time of 1/(16 fastest): some contacts, and some of each. */
static double most_credit(const struct events *e)
{
    return 32.0 + 8.0 * (double)e->stick_slip.contacts;
}

int tribo_events_create(struct events *e, tribo_driver *drv)
{
    tribo_system *sys = drv->sys;
    const int status = tribo_stick_slip_create(&e->stick_slip, sys);
    if (status) {
        return status;
    }
    e->next = malloc(tribo_system_dimension(sys) * sizeof *e->next);
    e->search.guard = malloc((3 * sys->ncontact + 1) * sizeof *e->search.guard);
    if (!e->next || !e->search.guard) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the events of %zu contacts", sys->ncontact);
    }
    drv->excess = drv->backslip = 0.0;
    return TRIBO_OK;
}

void tribo_events_free(struct events *e)
{
    tribo_stick_slip_free(&e->stick_slip);
    free(e->next);
    free(e->search.guard);
}

/* ------------------------------------------------------------------------------------------------------------- guards */

void tribo_events_clear_guards(struct events *e)
{
    e->search.guards = 0;
}

static void append(struct events *e, size_t i, struct guard guard)
{
    guard.contact = i;
    guard.lowest = 0.0;
    e->search.guard[e->search.guards++] = guard;
}

void tribo_events_guard_slip(struct events *e, size_t i, struct guard guard)
{
    const struct stick_slip *m = &e->stick_slip;
    guard.slides = 1;
    guard.allowance = m->doubt * m->noise[i];
    guard.side = m->slip[i];
    append(e, i, guard);
}

static void append_both(struct events *e, size_t i, struct guard guard)
{
    for (int side = -1; side <= 1; side += 2) {
        guard.side = side;
        append(e, i, guard);
    }
}

void tribo_events_guard_stick(struct events *e, size_t i, struct guard guard)
{
    guard.slides = 0;
    guard.allowance = e->stick_slip.allowance[i];
    append_both(e, i, guard);
}

void tribo_events_guard_part(struct events *e, size_t i, struct guard guard)
{
    guard.slides = 1;
    guard.allowance = e->stick_slip.parting[i];
    append_both(e, i, guard);
}

void tribo_events_guard_limit(struct events *e, size_t i, struct guard guard)
{
    const struct stick_slip *m = &e->stick_slip;
    const int keeps = m->slip[i] == 0 && tribo_stick_slip_follows(m, i) == 0.0;
    const double times = m->slip[i] == 2 ? -1.0 : keeps ? tribo_breakaway_ratio(&m->breakaway, i) : 1.0;
    guard.limit *= times;
    guard.offset = times * guard.offset + (keeps ? tribo_stick_slip_slack(m, i) - fabs(m->force[i]) : 0.0);
    guard.slides = 0;
    guard.side = 0.0;
    guard.allowance = keeps ? m->allowance[i] : 2.0 * TRIBO_LIMIT_NOISE * m->doubt * m->swing[i];
    append(e, i, guard);
}

/* -------------------------------------------------------------------------------------------------------------- events */

static int give_up(struct events *e, tribo_driver *drv, double t)
{
    char text[TRIBO_SUSPECTS * 32] = "";
    for (size_t k = 0, used = 0; k < e->suspects; k++) {
        used += (size_t)snprintf(text + used, sizeof text - used, "%scontact %zu", k ? ", " : "", e->suspect[k]);
    }
    return tribo_driver_fail(
        drv, TRIBO_ERR_CHATTER,
        "events make no headway at t = %.17g (%s): take central/fixed or moreau/fixed, or limits that differ", t, text);
}

static void suspect(struct events *e, size_t contact)
{
    for (size_t k = 0; k < e->suspects; k++) {
        if (e->suspect[k] == contact) {
            return;
        }
    }
    if (e->suspects < TRIBO_SUSPECTS) {
        e->suspect[e->suspects++] = contact;
    }
}

/* Counts an event against the credit that has gathered since the last one. */
static int count_event(struct events *e, tribo_driver *drv, const struct guard *event, double t, double fastest)
{
    const double most = most_credit(e);
    struct stick_slip *m = &e->stick_slip;
    drv->events++;
    e->credit += 16.0 * most * fastest * (t - e->paid);
    e->paid = t;
    if (e->credit >= most) {
        e->credit = most;
        e->suspects = 0;
        m->doubt = 1.0;
    }
    suspect(e, event->contact);
    e->credit -= 1.0;
    if (e->credit < 0.0) {
        e->credit = most;
        m->doubt *= 10.0;
    }
    return m->doubt > MOST_DOUBT ? give_up(e, drv, t) : TRIBO_OK;
}

/* What the search has learnt of the size of velocities, and how far the phase strayed from the law. */
static void learn(struct events *e, tribo_driver *drv)
{
    struct stick_slip *m = &e->stick_slip;
    for (size_t k = 0; k < e->search.guards; k++) {
        const struct guard *g = &e->search.guard[k];
        if (g->slides) {
            m->seen[g->contact] = g->size;
            drv->backslip = greater(drv->backslip, g->lowest);
        } else {
            drv->excess = greater(drv->excess, g->lowest + m->excess[g->contact]);
        }
    }
}

static int on_context(tribo_driver *drv, int status)
{
    return status ? tribo_driver_fail(drv, status, "%s", tribo_message(drv->sys->contacts)) : TRIBO_OK;
}

/* Shows the observer the motion between t and t + tau at begin + k dt. */
static int show_between(struct events *e, tribo_driver *drv, double begin, double *shown, double t, double tau, const double *y)
{
    int status = TRIBO_OK;
    for (double at; e->shows_between && drv->seen && !status && (at = begin + *shown * drv->dt) < t + tau; *shown += 1.0) {
        e->state(e->motion, greater((at - t) - drv->sys->low, 0.0), y, drv->slope);
        status = tribo_driver_accept(drv, at, drv->slope, 0);
    }
    return status;
}

/* The time after another tau, and its low part; end if that is all there was. */
static double go_on(tribo_system *sys, double t, double tau, double end)
{
    const struct twofold next = twofold_sum(t, sys->low + tau);
    const int there = tau >= (end - t) - sys->low || next.hi > end || (next.hi == end && next.lo > 0.0);
    tribo_system_set_low(sys, there ? 0.0 : next.lo);
    return there ? end : next.hi;
}

/* Steps that no event ends do so at a number t, if they are long enough for that. */
static double to_a_number(const tribo_system *sys, double t, double reach, double end)
{
    const double next = lesser(t + (sys->low + reach), end), there = (next - t) - sys->low;
    return fabs(there - reach) <= 1e-3 * reach ? there : reach;
}

/* One phase, from (t, y) to its end and the decision there. */
static int phase(struct events *e, tribo_driver *drv, double begin, double *shown, double *t, double t1, double *y,
                 double fastest)
{
    tribo_system *sys = drv->sys;
    const size_t dimension = tribo_system_dimension(sys);
    const double end = lesser(t1, tribo_system_next_kink(sys, *t));
    const struct guard *event = NULL;
    double reach = (end - *t) - sys->low, when = 0.0;
    int status = on_context(drv, e->begin(e->motion, *t, y, &reach));
    if (status) {
        return status;
    }
    reach = to_a_number(sys, *t, reach, end);
    e->search.resolution = DBL_EPSILON * DBL_EPSILON * greater(fabs(*t), reach);
    if (!(reach > e->search.resolution)) {
        return tribo_driver_fail(drv, TRIBO_ERR_STEP, "at t = %.17g the step is down to %g", *t, reach);
    }
    if (!tribo_first_zero(&e->search, reach, &event, &when)) {
        e->state(e->motion, reach, y, e->next);
        status = tribo_driver_check(drv, e->next);
        return status ? status
                      : tribo_driver_fail(drv, TRIBO_ERR_STEP,
                                          "from t = %.17g on the motion is too fast to be followed: given up after %zu looks", *t,
                                          e->search.looks);
    }
    when = event ? lesser(when, reach) : reach;
    status = show_between(e, drv, begin, shown, *t, when, y);
    if (status) {
        return status;
    }
    e->state(e->motion, when, y, e->next);
    status = tribo_driver_check(drv, e->next);
    if (status) {
        return status;
    }
    memcpy(y, e->next, dimension * sizeof *y);
    *t = go_on(sys, *t, when, end);
    e->met = event;
    status = e->company ? on_context(drv, e->company->ends(e->company, when, *t, y)) : TRIBO_OK;
    if (status) {
        return status;
    }
    drv->steps++;
    learn(e, drv);
    sys->evaluations += e->shows_between ? e->search.looks : 0;
    if (event) {
        status = count_event(e, drv, event, *t, fastest);
        if (event->slides) {
            e->stick_slip.slip[event->contact] = 0;
        } else {
            e->stick_slip.reached = event->contact;
        }
    }
    status = status ? status : on_context(drv, tribo_stick_slip_decide(&e->stick_slip, sys, *t, y));
    if (!status && event && e->company) {
        e->company->decided(e->company);
    }
    if (!status) {
        const int shown_now = event || (*t >= t1 && sys->low == 0.0) || !e->shows_between;
        status = shown_now ? tribo_driver_accept(drv, *t, y, event != NULL) : tribo_driver_keep(drv, *t, y);
    }
    return status;
}

int tribo_events_advance(struct events *e, tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    const double begin = *t, fastest = greater(tribo_system_fastest(drv->sys), 1.0 / (t1 - begin));
    double shown = 1.0;
    if (e->shows_between && drv->seen && !(begin + drv->dt > begin && t1 - drv->dt < t1)) {
        return tribo_driver_fail(drv, TRIBO_ERR_STEP, "dt = %g, in which an observer sees the motion, is lost beside t = %.17g",
                                 drv->dt, t1);
    }
    int status = on_context(drv, tribo_stick_slip_start(&e->stick_slip, drv->sys, *t, y, continues));
    e->credit = most_credit(e);
    e->paid = *t;
    e->suspects = 0;
    while (!status && (*t < t1 || drv->sys->low < 0.0)) {
        status = phase(e, drv, begin, &shown, t, t1, y, fastest);
    }
    tribo_system_set_low(drv->sys, 0.0);
    return status;
}

int tribo_events_method(tribo_driver *drv, double *t, double t1, double *y, int continues)
{
    struct events *e;
    const int status = drv->method->open(drv, &e);
    return status ? status : tribo_events_advance(e, drv, t, t1, y, continues);
}
