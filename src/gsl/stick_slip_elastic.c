/* Elastic contacts: a slider without mass on a spring. The state says what its force is, compliance f = J w - J follow q, and
 * J u - b with w' = follow q' is the velocity v that it slides with, if it slides. So an instant decides about each by itself:
 *
 *     inside the limit: it holds, and f' = -v/compliance
 *     at the limit: it slides if v goes against the force, and holds if v takes the force back inside
 *     at the limit, without velocity: it holds; if v comes to go against the force, that leaves the limit, which is an event
 */
#include "stick_slip.h"
#include "../common/real.h"

#include <math.h>
#include <string.h>

/* The force is known to this part of what it is the sum of; it may go beyond its limit by so many times that. */
#define FORCE_NOISE 2e-14
#define ALLOWED 8.0

/* J_i x, and the size of its terms. */
static double displaced(const tribo_system *sys, size_t i, const double *x, double *size)
{
    const struct matrix *j = &sys->direction;
    double sum = 0.0;
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        sum += j->val[k] * x[j->col[k]];
        *size += fabs(j->val[k] * x[j->col[k]]);
    }
    return sum;
}

/* spring and slack of all elastic contacts in the places q. */
static void find_springs(struct stick_slip *m, const tribo_system *sys, const double *q)
{
    const struct massless *w = &sys->massless;
    memcpy(m->rate, q, sys->ndof * sizeof *m->rate);
    tribo_massless_follow(w, m->rate);
    for (size_t i = 0; i < sys->ncontact; i++) {
        double size = 0.0;
        if (tribo_massless_touches(w, i)) {
            const double way = displaced(sys, i, q, &size) - displaced(sys, i, m->rate, &size);
            m->spring[i] = way / w->compliance[i];
            m->slack[i] = ALLOWED * FORCE_NOISE * m->doubt * size / w->compliance[i];
        }
    }
}

/* w = follow q + give f */
static void put_places(const struct stick_slip *m, const tribo_system *sys, double *q)
{
    tribo_massless_follow(&sys->massless, q);
    tribo_matrix_multiply_add(&sys->massless.give, 1.0, m->spring, q);
}

void tribo_elastic_start(struct stick_slip *m, const tribo_system *sys, double *y)
{
    const struct massless *w = &sys->massless;
    if (w->count == 0) {
        return;
    }
    find_springs(m, sys, y);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (tribo_massless_touches(w, i)) {
            const double force = clamp(m->spring[i], -m->limit[i], m->limit[i]);
            y[2 * sys->ndof] += sys->tally[i] * force * (m->spring[i] - force) * w->compliance[i];
            m->spring[i] = force;
            m->slid[i] = m->slip[i] = (signed char)(m->limit[i] > 0.0 ? 0 : 2);
        }
    }
    put_places(m, sys, y);
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
        m->slip[i] = 0;
        return;
    }
    const signed char against = (signed char)(m->spring[i] > 0.0 ? -1 : 1);
    const int still = stopped || fabs(v) <= m->doubt * m->noise[i];
    m->spring[i] = -against * limit;
    m->slip[i] = (signed char)(!still && against * v > 0.0 ? against : 0);
}

void tribo_elastic_place(struct stick_slip *m, const tribo_system *sys, double *y)
{
    if (sys->massless.count == 0) {
        return;
    }
    find_springs(m, sys, y);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (tribo_massless_touches(&sys->massless, i)) {
            place(m, i, tribo_stick_slip_velocity(m, sys, i, y));
        }
    }
    put_places(m, sys, y);
}

void tribo_elastic_hold(struct stick_slip *m, const tribo_system *sys, double *y)
{
    const struct massless *w = &sys->massless;
    if (w->count == 0) {
        return;
    }
    tribo_elastic_release(sys, y);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const int holds = tribo_massless_touches(w, i) && m->slip[i] == 0;
        m->spring_rate[i] = holds ? -tribo_stick_slip_velocity(m, sys, i, y) / w->compliance[i] : 0.0;
    }
    tribo_matrix_multiply_add(&w->give, 1.0, m->spring_rate, y + sys->ndof);
}

void tribo_elastic_finish(struct stick_slip *m, const tribo_system *sys)
{
    for (size_t i = 0; sys->massless.count && i < sys->ncontact; i++) {
        m->allowance[i] = tribo_massless_touches(&sys->massless, i) ? m->slack[i] : m->allowance[i];
        m->slid[i] = m->slip[i];
    }
}
