/* Elastic contacts: a slider without mass on a spring. The state says what its force is, compliance f = J w - J follow q, and
 * J u - b with w' = follow q' is the velocity v that it slides with, if all slide: rates of forces f' add C f' to these. A contact
 * with a diagonal C is decided about by itself, and shared compliance makes a box problem of f', min 1/2 f''C f' + v'f':
 *
 *     inside the limit: it holds, and v + C f' = 0
 *     at the limit: it slides if v goes against the force, and holds if v takes the force back inside
 *     at the limit, without velocity: it holds; if v comes to go against the force, that leaves the limit, which is an event
 */
#include "dynamics/system/elastic.h"
#include "stick_slip.h"

#include <math.h>

void tribo_elastic_find(struct stick_slip *m, const tribo_system *sys, const double *q)
{
    tribo_elastic_forces(sys, q, m->work.rate, m->state.spring, m->noise.spring);
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->noise.spring[i] *= TRIBO_SPRING_ALLOWED * TRIBO_SPRING_NOISE * m->noise.factor;
    }
}

void tribo_elastic_start(struct stick_slip *m, const tribo_system *sys, double *y)
{
    if (sys->massless.count == 0) {
        return;
    }
    tribo_elastic_enter(sys, m->state.limit, m->work.rate, m->state.spring, y);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (m->constant.elastic[i]) {
            m->state.slid[i] = (signed char)(m->state.limit[i] > 0.0 ? 0 : 2);
            tribo_stick_slip_set(m, i, m->state.slid[i]);
        }
    }
}

void tribo_elastic_release(const tribo_system *sys, double *y)
{
    if (sys->massless.count) {
        tribo_massless_follow(&sys->massless, y + sys->ndof);
    }
}

/* What an instant knows of contact i before its velocity. */
enum stand { OPEN, INSIDE, AT_LIMIT, STOPPED };

static enum stand stand_of(const struct stick_slip *m, size_t i)
{
    const signed char before = m->state.slip[i];
    const int slid = tribo_slides(m->state.slid[i]);
    const int slides = tribo_slides(before) && m->state.slid[i] == before;
    return before == TRIBO_SLIP_OPEN                                                                               ? OPEN
           : before == TRIBO_SLIP_STUCK && slid                                                                    ? STOPPED
           : slides || i == m->state.reached || fabs(m->state.spring[i]) >= m->state.limit[i] - m->noise.spring[i] ? AT_LIMIT
                                                                                                                   : INSIDE;
}

/* Where contact i, at its limit, slides to if it slides: against its force. */
static signed char against(const struct stick_slip *m, size_t i)
{
    const signed char before = m->state.slip[i];
    return before != 0 && m->state.slid[i] == before
               ? before
               : (signed char)(m->state.spring[i] > 0.0 ? TRIBO_SLIP_BACK : TRIBO_SLIP_FORTH);
}

/* Force and slip of contact i, whose velocity is v if it slides. */
static void place_elastic(struct stick_slip *m, size_t i, double v)
{
    const enum stand stand = stand_of(m, i);
    const signed char direction = against(m, i);
    const int slides = stand == AT_LIMIT && fabs(v) > m->noise.factor * m->noise.velocity[i] && direction * v > 0.0;
    if (stand == OPEN) {
        m->state.spring[i] = 0.0;
        return;
    }
    m->state.spring[i] = stand == INSIDE ? m->state.spring[i] : -direction * m->state.limit[i];
    tribo_stick_slip_set(m, i, (signed char)(slides ? direction : TRIBO_SLIP_STUCK));
}

/* Velocities v [ncontact] become those with the rates of forces that shared compliance makes of them; 0 of contacts that hold. */
static void share_rates(struct stick_slip *m, struct definite *c, double *v)
{
    for (size_t i = 0; i < c->n; i++) {
        const enum stand stand = m->constant.elastic[i] ? stand_of(m, i) : OPEN;
        const signed char direction = against(m, i);
        v[i] = m->constant.elastic[i] ? v[i] : 0.0;
        c->lo[i] = stand == OPEN || (stand == AT_LIMIT && direction > 0) ? 0.0 : -HUGE_VAL;
        c->hi[i] = stand == OPEN || (stand == AT_LIMIT && direction < 0) ? 0.0 : HUGE_VAL;
    }
    tribo_elastic_share_rates(c, v);
}

void tribo_elastic_place(struct stick_slip *m, const tribo_system *sys, double *y)
{
    if (sys->massless.count == 0) {
        return;
    }
    tribo_elastic_find(m, sys, y);
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->work.v[i] = m->constant.elastic[i] ? tribo_stick_slip_find_velocity(m, sys, i, y) : 0.0;
    }
    if (sys->massless.shared) {
        share_rates(m, sys->massless.shared, m->work.v);
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (m->constant.elastic[i]) {
            place_elastic(m, i, m->work.v[i]);
        }
    }
    tribo_elastic_give(sys, m->state.spring, y);
}

void tribo_elastic_hold(struct stick_slip *m, const tribo_system *sys, double *y)
{
    if (sys->massless.count) {
        tribo_elastic_move(sys, m->state.slip, m->state.base, y + sys->ndof, m->state.spring_rate);
    }
}

void tribo_elastic_finish(struct stick_slip *m, const tribo_system *sys)
{
    for (size_t i = 0; sys->massless.count && i < sys->ncontact; i++) {
        m->noise.allowance[i] = m->constant.elastic[i] ? m->noise.spring[i] : m->noise.allowance[i];
        m->state.slid[i] = m->state.slip[i];
    }
}
