/* SPDX-License-Identifier: BSD-3-Clause */
/* Elastic contacts: the state contains their forces f. The velocity of the slider is v + G f', v = J q' - b; f' solves the box
 * problem min 1/2 f''G f' + v'f':
 *
 *     inside the limit: the contact rests, and v + G f' = 0
 *     at the limit: |f|' <= limit'; it slides if v + G f' points against the force, and rests if v takes the force back inside
 *     at the limit, without velocity: it rests; where v begins to point against the force, the force leaves the limit: an event
 *     at touch-down, f = limit = 0: |f'| <= limit'
 */
#include "stick_slip.h"

#include <math.h>

void tribo_elastic_find(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    tribo_compliance_get(sys, y, m->state.spring);
    tribo_compliance_noise(sys, y, m->noise.spring);
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->noise.spring[i] += m->constant.elastic[i] ? TRIBO_LIMIT_NOISE * m->constant.swing[i] : 0.0;
        m->noise.spring[i] *= TRIBO_SPRING_ALLOWED * m->noise.factor;
    }
}

void tribo_elastic_start(struct stick_slip *m, const tribo_system *sys, double *y)
{
    if (sys->compliance.count == 0) {
        return;
    }
    tribo_compliance_enter(sys, m->state.limit, m->state.spring, y);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (m->constant.elastic[i]) {
            m->state.slid[i] = (signed char)(m->state.limit[i] > 0.0 ? 0 : 2);
            tribo_stick_slip_set(m, i, m->state.slid[i]);
        }
    }
}

void tribo_elastic_place(struct stick_slip *m, const tribo_system *sys, double *y)
{
    const unsigned char *elastic = m->constant.elastic;
    struct slip_state *s = &m->state;
    const struct compliance *g = &sys->compliance;
    double *v = m->work.v;              /* velocities of the contacts that slide */
    signed char *side = m->work.pulled; /* [ncontact] at the limit: direction to slide, against the force; else 0 */
    tribo_elastic_find(m, sys, y);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const int open = !elastic[i] || s->slip[i] == TRIBO_SLIP_OPEN;
        const int stopped = s->slip[i] == TRIBO_SLIP_STUCK && tribo_slides(s->slid[i]);
        const int slides = tribo_slides(s->slip[i]) && s->slid[i] == s->slip[i];
        const int at_limit = slides || i == s->reached || fabs(s->spring[i]) >= s->limit[i] - m->noise.spring[i];
        const int against = slides ? s->slip[i] : s->spring[i] > 0.0 ? TRIBO_SLIP_BACK : TRIBO_SLIP_FORTH;
        side[i] = (signed char)(at_limit && !open && !stopped ? against : 0);
        s->spring[i] = open ? 0.0 : stopped || at_limit ? -against * s->limit[i] : s->spring[i];
        v[i] = elastic[i] ? tribo_stick_slip_find_velocity(m, sys, i, y) : 0.0;
        const int both = side[i] && s->limit[i] == 0.0; /* touch-down */
        g->lo[i] = open ? 0.0 : both || side[i] > 0 ? -s->limit_rate[i] : -TRIBO_UNBOUNDED;
        g->hi[i] = open ? 0.0 : both || side[i] < 0 ? s->limit_rate[i] : TRIBO_UNBOUNDED;
    }
    tribo_compliance_share(g, v);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (elastic[i] && s->slip[i] != TRIBO_SLIP_OPEN) {
            if (side[i] && s->limit[i] == 0.0) {
                side[i] = (signed char)(v[i] > 0.0 ? TRIBO_SLIP_FORTH : TRIBO_SLIP_BACK);
            }
            const int slides = side[i] * v[i] > m->noise.factor * m->noise.velocity[i];
            tribo_stick_slip_set(m, i, (signed char)(slides ? side[i] : TRIBO_SLIP_STUCK));
        }
    }
    tribo_compliance_put(sys, s->spring, y);
}

void tribo_elastic_move(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    double *slide = m->work.f;
    for (size_t i = 0; sys->compliance.count && i < sys->ncontact; i++) {
        const int elastic = m->constant.elastic[i];
        m->state.glide[i] = elastic ? tribo_stick_slip_velocity(m, sys, i, y) : 0.0;
        slide[i] = elastic && tribo_slides(m->state.slip[i]) ? -m->state.slip[i] * m->state.limit_rate[i] : 0.0;
    }
    tribo_compliance_rates(sys, m->state.slip, sys->normals.count ? slide : NULL, 1, m->state.glide, m->state.spring_rate);
}
