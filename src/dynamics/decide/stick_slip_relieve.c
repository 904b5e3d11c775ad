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
    for (size_t k = 0; m->uncoupled && k < m->asks; k++) {
        const size_t i = m->asked[k];
        m->f[i] = tribo_stick_slip_balance_alone(m, i, m->a[i]);
    }
    if (status || m->uncoupled) {
        return status;
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->f[i] = m->loose[i] ? m->force[i] : 0.0;
    }
    tribo_stick_slip_accelerate(m, sys, m->a, m->f, m->v);
    status = tribo_stick_slip_balance(m, m->v, m->f);
    return status ? tribo_system_fail(sys, status, "%s", tribo_message(m->hold)) : TRIBO_OK;
}

/* Which contact f takes most beyond its limit; ncontact if none. */
static size_t most_overloaded(const struct stick_slip *m)
{
    size_t worst = m->contacts;
    double most = 1.0;
    for (size_t k = 0; k < m->asks; k++) {
        const size_t i = m->asked[k];
        const int sure = tribo_stick_slip_must_be_sure(m, i);
        const double excess = fabs(m->f[i]) - m->stick[i], allowance = (sure ? AT_THE_EVENT : 1.0) * m->allowance[i];
        if ((sure || m->tied[i]) && m->holds[i] && excess > most * allowance) {
            worst = i;
            most = excess / allowance;
        }
    }
    return worst;
}

/* Forces by least norm in the place of those that stay where they were, and f from these. */
static int share_anew(struct stick_slip *m, tribo_system *sys)
{
    tribo_set_sharing(m->box, TRIBO_SHARE_LEAST_NORM);
    const int status = tribo_stick_slip_find_forces(m, sys);
    tribo_set_sharing(m->box, TRIBO_SHARE_PREVIOUS);
    for (size_t k = 0; k < m->asks; k++) {
        const size_t i = m->asked[k];
        const double room = m->stick[i] - fabs(m->force[i]);
        m->tied[i] = tribo_stick_slip_searches(m, i) && room <= m->allowance[i];
    }
    return status ? status : find_holding_forces(m, sys);
}

/* Those that break away together; and if there are none, the contact that is overloaded. */
static void let_overloaded_go(struct stick_slip *m, size_t worst, signed char direction)
{
    const int sudden = tribo_breakaway_is_sudden(&m->breakaway, worst);
    int gone = 0;
    for (size_t k = 0; sudden && k < m->asks; k++) {
        const size_t i = m->asked[k];
        if (m->pulled[i]) {
            tribo_stick_slip_let_go(m, i, m->pulled[i]);
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
    for (size_t k = 0; k < m->asks; k++) {
        const size_t i = m->asked[k];
        m->force[i] = m->loose[i] ? m->force[i] : clamp(m->f[i], -m->stick[i], m->stick[i]);
        m->excess[i] = m->loose[i] ? 0.0 : fabs(m->f[i] - m->force[i]);
    }
}

int tribo_stick_slip_relieve(struct stick_slip *m, tribo_system *sys, size_t *changes)
{
    int status = find_holding_forces(m, sys);
    size_t worst = most_overloaded(m);
    const signed char direction = worst < m->contacts && m->f[worst] > 0.0 ? TRIBO_SLIP_BACK : TRIBO_SLIP_FORTH;
    if (!status && worst < m->contacts && tribo_stick_slip_must_be_sure(m, worst)) {
        status = share_anew(m, sys);
        worst = most_overloaded(m) < m->contacts ? worst : m->contacts;
    }
    if (!status && worst < m->contacts) {
        let_overloaded_go(m, worst, direction);
        *changes = 1;
    } else if (!status) {
        keep_forces(m);
    }
    return status;
}
