/* Elastic contacts: a slider without mass on a spring. The state says what its force is, compliance f = J w - J follow q, and
 * J u - b with w' = follow q' is the velocity v that it slides with, if it slides. So an instant decides about each by itself:
 *
 *     inside the limit: it holds, and f' = -v/compliance
 *     at the limit: it slides if v goes against the force, and holds if v takes the force back inside
 *     at the limit, without velocity: it holds; if v comes to go against the force, that leaves the limit, which is an event
 */
#include "dynamics/system/elastic.h"
#include "stick_slip.h"

#include <math.h>

/* The force is known to this part of what it is the sum of; it may go beyond its limit by so many times that. */
#define FORCE_NOISE 2e-14
#define ALLOWED 8.0

void tribo_elastic_find(struct stick_slip *m, const tribo_system *sys, const double *q)
{
    tribo_elastic_forces(sys, q, m->rate, m->spring, m->slack);
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->slack[i] *= ALLOWED * FORCE_NOISE * m->doubt;
    }
}

void tribo_elastic_start(struct stick_slip *m, const tribo_system *sys, double *y)
{
    if (sys->massless.count == 0) {
        return;
    }
    tribo_elastic_enter(sys, m->limit, m->rate, m->spring, y);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (m->elastic[i]) {
            m->slid[i] = (signed char)(m->limit[i] > 0.0 ? 0 : 2);
            tribo_stick_slip_set(m, i, m->slid[i]);
        }
    }
}

void tribo_elastic_release(const tribo_system *sys, double *y)
{
    if (sys->massless.count) {
        tribo_massless_follow(&sys->massless, y + sys->ndof);
    }
}

/* Force and slip of contact i, whose velocity is v if it slides. */
static void place(struct stick_slip *m, size_t i, double v)
{
    const signed char before = m->slip[i];
    const int stopped = before == 0 && (m->slid[i] == 1 || m->slid[i] == -1);
    const int slides = before == 1 || before == -1;
    const double limit = m->limit[i];
    if (before == 2) {
        m->spring[i] = 0.0;
        return;
    }
    if (slides && m->slid[i] == before) {
        m->spring[i] = -before * limit;
    } else if (i != m->reached && !stopped && fabs(m->spring[i]) < limit - m->slack[i]) {
        tribo_stick_slip_set(m, i, 0);
        return;
    }
    const signed char against = (signed char)(m->spring[i] > 0.0 ? -1 : 1);
    const int still = stopped || fabs(v) <= m->doubt * m->noise[i];
    m->spring[i] = -against * limit;
    tribo_stick_slip_set(m, i, (signed char)(!still && against * v > 0.0 ? against : 0));
}

void tribo_elastic_place(struct stick_slip *m, const tribo_system *sys, double *y)
{
    if (sys->massless.count == 0) {
        return;
    }
    tribo_elastic_find(m, sys, y);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (m->elastic[i]) {
            place(m, i, tribo_stick_slip_find_velocity(m, sys, i, y));
        }
    }
    tribo_elastic_give(sys, m->spring, y);
}

void tribo_elastic_hold(struct stick_slip *m, const tribo_system *sys, double *y)
{
    if (sys->massless.count) {
        tribo_elastic_move(sys, m->slip, m->base, y + sys->ndof, m->spring_rate);
    }
}

void tribo_elastic_finish(struct stick_slip *m, const tribo_system *sys)
{
    for (size_t i = 0; sys->massless.count && i < sys->ncontact; i++) {
        m->allowance[i] = m->elastic[i] ? m->slack[i] : m->allowance[i];
        m->slid[i] = m->slip[i];
    }
}
