/* SPDX-License-Identifier: BSD-3-Clause */
/* All that a guard means beside its course in time: which contacts have it, and the size of rounding by its samples. Another kind
 * of event is added here, in the enum of first_zero.h, and where phase of events.c marks an event for the decision. */
#include "events.h"
#include "common/real.h"

#include <math.h>

/* offset + side w->output + times the part of the limit that the motion adds */
static void append(struct events *e, size_t i, int kind, double side, double times, double offset, double allowance,
                   const struct watch *w)
{
    struct guard *g = &e->search.guard[e->search.guards++]; /* samples, size and bend are the search's and the motion's */
    g->contact = i;
    g->kind = kind;
    g->side = side;
    g->output = side != 0.0 ? w->output : NULL;
    g->offset = offset;
    g->limit = w->varies ? times : 0.0;
    g->allowance = allowance;
    g->lowest = g->right.g = 0.0;
}

/* Force beyond its limit with which contact i holds: the allowance, if its limit drops as it breaks away. */
static double margin_of(const struct stick_slip *m, size_t i)
{
    return tribo_drops(m, i) ? m->noise.allowance[i] : 0.0;
}

void tribo_events_guard_contact(struct events *e, size_t i, const struct watch *w)
{
    struct stick_slip *m = &e->stick_slip;
    if (m->state.slip[i] == TRIBO_SLIP_OPEN) {
        m->noise.velocity_scale[i] = w->size; /* for the decision when it touches down */
    } else if (tribo_slides(m->state.slip[i])) {
        append(e, i, SLIDES, m->state.slip[i], 0.0, 0.0, m->noise.factor * m->noise.velocity[i], w);
    } else if (m->state.holds[i]) {
        const double ratio = m->limits.ratio[i], margin = margin_of(m, i);
        for (double side = -1.0; w->size >= ratio * w->least + margin && side <= 1.0; side += 2.0) {
            append(e, i, HOLDS, side, ratio, ratio * w->constant + margin, m->noise.allowance[i], w);
        }
    } else if (tribo_stick_slip_may_part(m, i)) {
        append(e, i, SLIDES, -1.0, 0.0, 0.0, m->noise.parting[i], w);
        append(e, i, SLIDES, 1.0, 0.0, 0.0, m->noise.parting[i], w);
    }
}

void tribo_events_guard_limit(struct events *e, size_t i, const struct watch *w)
{
    const struct stick_slip *m = &e->stick_slip;
    const int keeps = m->state.slip[i] == TRIBO_SLIP_STUCK && tribo_stick_slip_follows(m, i) == 0.0;
    const double ratio = m->limits.ratio[i], swing = m->constant.swing[i];
    const struct normal *normal = tribo_normals_at(m->constant.sys, i);
    /* slack: ratio L - |f| of a contact at rest, constant while f follows the limit L; f changes its sign at ratio L = slack */
    const double slack = m->state.slip[i] == TRIBO_SLIP_STUCK && !keeps ? m->state.stick[i] - fabs(m->state.force[i]) : 0.0;
    if (w->varies && !m->state.holds[i] && slack > m->noise.allowance[i]) {
        append(e, i, HOLDS, 0.0, 2.0 * ratio, 2.0 * ratio * w->constant - slack, m->noise.allowance[i], w);
    }
    if (m->state.holds[i] || !(keeps ? w->varies : swing > 0.0) || (!keeps && tribo_normals_follower(m->constant.sys, i))) {
        return;
    }
    if (keeps) {
        append(e, i, HOLDS, 0.0, ratio, ratio * w->constant + (margin_of(m, i) - fabs(m->state.force[i])), m->noise.allowance[i],
               w);
    } else {
        const int open = normal ? !normal->pressed : m->state.slip[i] == TRIBO_SLIP_OPEN;
        const double side = open ? -1.0 : 1.0;
        append(e, i, HOLDS, 0.0, side, side * w->constant, 2.0 * TRIBO_LIMIT_NOISE * m->noise.factor * swing, w);
    }
}

void tribo_events_learn(struct events *e, tribo_driver *drv)
{
    struct stick_slip *m = &e->stick_slip;
    for (size_t k = 0; k < e->search.guards; k++) {
        const struct guard *g = &e->search.guard[k];
        if (g->kind == SLIDES) {
            m->noise.velocity_scale[g->contact] = e->brief ? fabs(g->left.g) + e->when * fabs(g->left.d) : g->size;
            drv->backslip = greater(drv->backslip, g->lowest);
        } else if (g->kind == HOLDS) {
            const double lowest = m->plane ? tribo_stick_slip_excess(m, g->contact, g->lowest) : g->lowest;
            drv->excess = greater(drv->excess, lowest + m->noise.excess[g->contact]);
        }
    }
}
