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
#include <stdlib.h>
#include <string.h>

/* Rounding of the length of a force in a plane, in parts of its limit. */
#define PAIR_NOISE 4e-16

void tribo_elastic_find(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    tribo_compliance_get(sys, y, m->state.spring);
    tribo_compliance_noise(sys, y, m->noise.spring);
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->noise.spring[i] += m->constant.elastic[i] ? TRIBO_LIMIT_NOISE * m->constant.swing[i] : 0.0;
        m->noise.spring[i] += m->constant.pair[i] ? PAIR_NOISE * m->state.limit[i] : 0.0;
        m->noise.spring[i] *= TRIBO_SPRING_ALLOWED * m->noise.factor;
    }
}

double tribo_spring_of(const struct stick_slip *m, size_t i)
{
    return m->constant.sys->compliance.own[i];
}

int tribo_elastic_pair(struct stick_slip *m, const tribo_system *sys)
{
    const struct compliance *g = &sys->compliance;
    const double *own = g->own, *limit = m->state.limit;
    unsigned char *pair = m->constant.pair;
    memset(pair, PAIR_NONE, sys->ncontact);
    m->constant.pairs = 0;
    int status = g->count ? tribo_system_find_pairs(sys, pair) : TRIBO_OK;
    for (size_t i = 0; !status && i < sys->ncontact; i++) {
        const int first = pair[i] == PAIR_FIRST;
        m->constant.pairs += (size_t)first;
        if (first && (g->factor || !(own[i] > 0.0) || own[i] != own[i + 1] || limit[i] != limit[i + 1])) {
            status = tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                                 "contact %zu has a direction beside it in its plane: method event takes both with the same "
                                 "compliance and limit, each on springs of its own, or no contact with compliance",
                                 i);
        }
    }
    return status;
}

void tribo_elastic_start(struct stick_slip *m, const tribo_system *sys, double *y)
{
    if (sys->compliance.count == 0) {
        return;
    }
    tribo_compliance_get(sys, y, m->state.spring);
    for (size_t i = 0; i < sys->ncontact; i++) {
        double *f = m->state.spring + i, size = m->constant.pair[i] == PAIR_FIRST ? hypot(f[0], f[1]) : 0.0;
        const double limit = m->state.limit[i];
        if (size > limit) {
            y[tribo_system_energy(sys)] += sys->tally[i] * limit * (size - limit) * sys->compliance.own[i];
            f[0] *= limit / size;
            f[1] *= limit / size;
        }
    }
    tribo_compliance_put(sys, m->state.spring, y);
    tribo_compliance_enter(sys, m->state.limit, m->state.spring, y);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (m->constant.elastic[i]) {
            m->state.slid[i] = (signed char)(m->state.limit[i] > 0.0 ? 0 : 2);
            tribo_stick_slip_set(m, i, m->state.slid[i]);
        }
    }
}

/* A force turns at once if it does so in this part of the horizon, and the square of that part times the angle to turn by is at
 * most LEAST: the velocity changes by the same part of 1e-8. */
#define AT_ONCE 0.01
#define LEAST 1e-8

/* A limit changes slowly if it does so by less than itself in this number of the times in which the force turns. */
#define SLOW 64.0

int tribo_follows_velocity(const struct stick_slip *m, size_t i, const double *v)
{
    const struct slip_state *s = &m->state;
    const double c = tribo_spring_of(m, i), speed = hypot(v[0], v[1]), part = c * s->limit[i] / (m->constant.horizon * speed);
    if (s->limit[i] == 0.0 || !(part <= AT_ONCE && SLOW * c * fabs(s->limit_rate[i]) <= speed)) {
        return s->limit[i] == 0.0;
    }
    const double angle = hypot(s->spring[i] / s->limit[i] + v[0] / speed, s->spring[i + 1] / s->limit[i] + v[1] / speed);
    return part * part * angle <= LEAST;
}

/* u [2] = direction in which the slider of the contact in a plane with first direction i moves: against the force, or along v [2]
 * if the force follows that; 0 if both are 0. */
static void find_way(const struct stick_slip *m, size_t i, const double *v, double *u)
{
    const double *f = m->state.spring + i, speed = hypot(v[0], v[1]);
    const double force = tribo_follows_velocity(m, i, v) ? 0.0 : hypot(f[0], f[1]);
    for (size_t d = 0; d < 2; d++) {
        u[d] = force > 0.0 ? -f[d] / force : speed > 0.0 ? v[d] / speed : 0.0;
    }
}

/* Decides about the contact in a plane with first direction i: its slider moves along u, if its speed v'u - c limit' is more than
 * rounding. */
static void place_pair(struct stick_slip *m, const tribo_system *sys, const double *y, size_t i)
{
    struct slip_state *s = &m->state;
    double *f = s->spring + i, u[2];
    const double v[2] = {tribo_stick_slip_find_velocity(m, sys, i, y), tribo_stick_slip_find_velocity(m, sys, i + 1, y)};
    const int open = s->slip[i] == TRIBO_SLIP_OPEN, moved = s->slid[i] == TRIBO_SLIP_PLANE;
    const int stopped = s->slip[i] == TRIBO_SLIP_STUCK && moved;
    const int at_limit = moved || i == s->reached || hypot(f[0], f[1]) >= s->limit[i] - m->noise.spring[i];
    find_way(m, i, v, u);
    for (size_t d = 0; d < 2; d++) {
        f[d] = open ? 0.0 : at_limit ? -s->limit[i] * u[d] : f[d];
    }
    const double along = u[0] * v[0] + u[1] * v[1] - sys->compliance.own[i] * s->limit_rate[i];
    const double noise = m->noise.factor * (m->noise.velocity[i] + m->noise.velocity[i + 1]);
    const int slides = !stopped && at_limit && along > noise;
    const signed char slip = (signed char)(open ? TRIBO_SLIP_OPEN : slides ? TRIBO_SLIP_PLANE : TRIBO_SLIP_STUCK);
    tribo_stick_slip_set(m, i, slip);
    tribo_stick_slip_set(m, i + 1, slip);
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
        if (m->constant.pair[i]) {
            if (m->constant.pair[i] == PAIR_FIRST) {
                place_pair(m, sys, y, i);
            }
            side[i] = 0;
            v[i] = g->lo[i] = g->hi[i] = 0.0;
            continue;
        }
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
        if (elastic[i] && !m->constant.pair[i] && s->slip[i] != TRIBO_SLIP_OPEN) {
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
        if (m->constant.pair[i] == PAIR_SECOND && m->state.slip[i] == TRIBO_SLIP_PLANE) {
            const double *v = m->state.glide + i - 1;
            double u[2];
            find_way(m, i - 1, v, u);
            const double w = (u[0] * v[1] - u[1] * v[0]) / sys->compliance.own[i];
            slide[i - 1] = -m->state.limit_rate[i] * u[0] + w * u[1];
            slide[i] = -m->state.limit_rate[i] * u[1] - w * u[0];
        }
    }
    tribo_compliance_rates(sys, m->state.slip, sys->normals.count || m->constant.pairs ? slide : NULL, 1, m->state.glide,
                           m->state.spring_rate);
}
