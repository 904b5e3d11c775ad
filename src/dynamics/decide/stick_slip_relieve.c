/* Contacts at rest just at their limits, by the forces that it takes to hold all that are at rest:
 *
 *     those that reached their limits stay there, an independent set of the others holds
 *     if a static limit does not do: all share anew, by least norm, which has room wherever there is some
 *     if that does not do either: whoever a moment later goes the way it is pulled breaks away, all of them together
 *
 * A static limit that is lost does not come back. So as long as any forces within the limits hold all where they are, none is
 * lost; and the solver's own rounding, which may be more than that of the forces, does not decide. */
#include "stick_slip.h"
#include "common/real.h"

#include <math.h>

/* Forces beyond static limits are an event as soon as they are so by the allowance of the phase, which may have been smaller than
 * that of its end: there it has to be decided, by what is more than noise. */
#define AT_THE_EVENT 0.125

/* f = the forces that hold all contacts at rest where they are, the others having theirs. */
static int find_holding_forces(struct stick_slip *m, const tribo_system *sys)
{
    int status = tribo_stick_slip_find_holds(m, sys);
    for (size_t k = 0; m->constant.uncoupled && k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        m->work.f[i] = tribo_stick_slip_balance_alone(m, i, m->work.a[i]);
    }
    if (status || m->constant.uncoupled) {
        return status;
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->work.f[i] = m->state.loose[i] ? m->state.force[i] : 0.0;
    }
    tribo_stick_slip_accelerate(m, sys, m->work.a, m->work.f, m->work.v);
    status = tribo_stick_slip_balance(m, m->work.v, m->work.f);
    return status ? tribo_system_fail(sys, status, "%s", tribo_message(m->constant.hold)) : TRIBO_OK;
}

/* Which contact f takes most beyond its limit; ncontact if none. */
static size_t most_overloaded(const struct stick_slip *m)
{
    size_t worst = m->constant.contacts;
    double most = 1.0;
    for (size_t k = 0; k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        const int sure = tribo_stick_slip_must_be_sure(m, i);
        const double excess = fabs(m->work.f[i]) - m->state.stick[i],
                     allowance = (sure ? AT_THE_EVENT : 1.0) * m->noise.allowance[i];
        if ((sure || m->state.tied[i]) && m->state.holds[i] && excess > most * allowance) {
            worst = i;
            most = excess / allowance;
        }
    }
    return worst;
}

/* Forces by least norm in the place of those that stay where they were, and f from these. */
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

/* Those that break away together; and if there are none, the contact that is overloaded. */
static void let_overloaded_go(struct stick_slip *m, size_t worst, signed char direction)
{
    const int sudden = tribo_breakaway_is_sudden(&m->breakaway, worst);
    int gone = 0;
    for (size_t k = 0; sudden && k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        if (m->work.pulled[i]) {
            tribo_stick_slip_let_go(m, i, m->work.pulled[i]);
            gone = 1;
        }
    }
    if (!gone) {
        tribo_stick_slip_let_go(m, worst, direction);
    }
}

/* f are the forces. */
static void keep_forces(struct stick_slip *m)
{
    for (size_t k = 0; k < m->work.undecided_count; k++) {
        const size_t i = m->work.undecided[k];
        m->state.force[i] = m->state.loose[i] ? m->state.force[i] : clamp(m->work.f[i], -m->state.stick[i], m->state.stick[i]);
        m->noise.excess[i] = m->state.loose[i] ? 0.0 : fabs(m->work.f[i] - m->state.force[i]);
    }
}

int tribo_stick_slip_relieve(struct stick_slip *m, tribo_system *sys, size_t *changes)
{
    int status = find_holding_forces(m, sys);
    size_t worst = most_overloaded(m);
    const signed char direction = worst < m->constant.contacts && m->work.f[worst] > 0.0 ? TRIBO_SLIP_BACK : TRIBO_SLIP_FORTH;
    if (!status && worst < m->constant.contacts && tribo_stick_slip_must_be_sure(m, worst)) {
        status = share_anew(m, sys);
        worst = most_overloaded(m) < m->constant.contacts ? worst : m->constant.contacts;
    }
    if (!status && worst < m->constant.contacts) {
        let_overloaded_go(m, worst, direction);
        *changes = 1;
    } else if (!status) {
        keep_forces(m);
    }
    return status;
}
