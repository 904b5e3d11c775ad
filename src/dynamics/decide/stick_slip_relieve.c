/* Contacts at rest just at their limits, decided about by the forces that hold all contacts at rest:
 *
 *     contacts that reached their limits keep their forces, and an independent set of the others holds
 *     if a static limit is exceeded: the forces of all by least norm, which leave room wherever there is some
 *     if it is exceeded by these too: all contacts in work.pulled break away together
 *
 * A static limit that is lost does not come back. So no static limit is lost as long as any forces within the limits hold all
 * contacts where they are; the solver's own rounding, which may exceed that of the forces, does not decide. */
#include "stick_slip.h"
#include "common/real.h"

#include <math.h>

/* A force beyond a static limit is an event at the allowance of its phase, which may be smaller than that of the end of the
 * phase: the decision takes this part of the latter. */
#define AT_THE_EVENT 0.125

/* Finds work.f = the forces that hold all contacts at rest, those that do not hold having state.force. */
static int find_holding_forces(struct stick_slip *m, const tribo_system *sys)
{
    double *f = m->work.f;
    int status = tribo_stick_slip_find_holds(m, sys);
    if (m->constant.uncoupled) {
        for (size_t k = 0; k < m->work.undecided_count; k++) {
            const size_t i = m->work.undecided[k];
            f[i] = tribo_stick_slip_balance_alone(m, i, m->work.a[i]);
        }
        return status;
    }
    if (status) {
        return status;
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        f[i] = m->state.loose[i] ? m->state.force[i] : 0.0;
    }
    tribo_stick_slip_accelerate(m, sys, m->work.a, f, m->work.v);
    status = tribo_stick_slip_balance(m, m->work.v, f);
    return status ? tribo_system_fail(sys, status, "%s", tribo_message(m->constant.hold)) : TRIBO_OK;
}

/* The contact that work.f takes most beyond its limit; ncontact if none. */
static size_t most_overloaded(const struct stick_slip *m)
{
    const struct slip_state *s = &m->state;
    size_t worst = m->constant.contacts;
    double most = 1.0;
    for (size_t k = 0; k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        const int sure = tribo_stick_slip_must_be_sure(m, i);
        const double excess = fabs(m->work.f[i]) - s->stick[i], allowance = (sure ? AT_THE_EVENT : 1.0) * m->noise.allowance[i];
        if ((sure || s->tied[i]) && s->holds[i] && excess > most * allowance) {
            worst = i;
            most = excess / allowance;
        }
    }
    return worst;
}

/* Finds the forces by least norm, ties contacts by these, and finds work.f. */
static int share_anew(struct stick_slip *m, tribo_system *sys)
{
    tribo_set_sharing(m->constant.box, TRIBO_SHARE_LEAST_NORM);
    const int status = tribo_stick_slip_find_forces(m, sys);
    tribo_set_sharing(m->constant.box, TRIBO_SHARE_PREVIOUS);
    for (size_t k = 0; k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        const double room = m->state.stick[i] - fabs(m->state.force[i]);
        m->state.tied[i] = tribo_stick_slip_searches(m, i) && room <= m->noise.allowance[i];
    }
    return status ? status : find_holding_forces(m, sys);
}

int tribo_stick_slip_relieve(struct stick_slip *m, tribo_system *sys, size_t *changes)
{
    struct slip_state *s = &m->state;
    const struct slip_work *w = &m->work;
    const size_t none = m->constant.contacts;
    int status = find_holding_forces(m, sys), gone = 0;
    size_t worst = most_overloaded(m);
    const signed char direction = worst < none && w->f[worst] > 0.0 ? TRIBO_SLIP_BACK : TRIBO_SLIP_FORTH;
    if (!status && worst < none && tribo_stick_slip_must_be_sure(m, worst)) {
        status = share_anew(m, sys);
        worst = most_overloaded(m) < none ? worst : none;
    }
    if (status) {
        return status;
    }
    const int sudden = worst < none && tribo_breakaway_is_sudden(&m->breakaway, worst);
    for (size_t k = 0; k < w->undecided_count; k++) {
        const size_t i = w->undecided[k];
        if (worst == none) { /* work.f are the forces */
            const double force = s->loose[i] ? s->force[i] : clamp(w->f[i], -s->stick[i], s->stick[i]);
            m->noise.excess[i] = s->loose[i] ? 0.0 : fabs(w->f[i] - force);
            s->force[i] = force;
        } else if (sudden && w->pulled[i]) {
            tribo_stick_slip_let_go(m, i, w->pulled[i]);
            gone = 1;
        }
    }
    if (worst < none && !gone) {
        tribo_stick_slip_let_go(m, worst, direction);
    }
    *changes = worst < none ? 1 : *changes;
    return TRIBO_OK;
}
