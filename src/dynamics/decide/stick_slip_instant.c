/* What contacts do at an instant: limits and bases, which contacts are at rest, and the accelerations that follow. */
#include "stick_slip.h"
#include "common/real.h"

#include <string.h>

/* The slip of contact i by its velocity in y. */
static signed char slip_of(struct stick_slip *m, const tribo_system *sys, size_t i, const double *y)
{
    const double v = tribo_stick_slip_find_velocity(m, sys, i, y), noise = m->noise.factor * m->noise.velocity[i];
    return (signed char)(fabs(v) <= noise ? TRIBO_SLIP_STUCK : v > 0.0 ? TRIBO_SLIP_FORTH : TRIBO_SLIP_BACK);
}

void tribo_stick_slip_update_limits(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    struct slip_state *s = &m->state;
    if (s->steady) {
        return;
    }
    const int varies = tribo_system_limits_vary(sys) || m->breakaway.some;
    if (varies) {
        tribo_system_limits(sys, s->limit, s->limit_rate);
    }
    s->steady = !varies;
    for (size_t i = 0; i < sys->ncontact; i++) {
        const int presses = m->constant.swing[i] > 0.0 ? tribo_system_presses(sys, i, m->noise.factor)
                                                       : s->limit[i] != 0.0 || s->limit_rate[i] != 0.0;
        if (!presses) {
            s->limit[i] = s->limit_rate[i] = 0.0;
            tribo_stick_slip_set(m, i, TRIBO_SLIP_OPEN);
        } else if (s->slip[i] == TRIBO_SLIP_OPEN) {
            tribo_stick_slip_set(m, i, slip_of(m, sys, i, y));
        }
        s->limit[i] = greater(s->limit[i], 0.0);
    }
    if (m->breakaway.some) {
        tribo_breakaway_take(&m->breakaway, sys->ncontact, s->limit, s->limit_rate);
    }
}

/* Brings to rest contacts with no velocity left in the direction of their slip; returns their number. */
static size_t stop_slips(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    const size_t n = m->constant.contacts;
    const signed char *const slip = m->state.slip;
    size_t found = 0;
    for (size_t i = 0; i < n; i++) {
        if (tribo_slides(slip[i]) && !m->constant.elastic[i] &&
            slip[i] * tribo_stick_slip_find_velocity(m, sys, i, y) <= m->noise.factor * m->noise.velocity[i]) {
            tribo_stick_slip_set(m, i, TRIBO_SLIP_STUCK);
            found++;
        }
    }
    return found;
}

/* Where bases part, a contact at rest that does not hold slides by its velocity. An error if that loses a static limit: the loss
 * is irreversible, so it must not depend on the choice of H. */
static int part(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (tribo_stick_slip_depends(m, i)) {
            const int loses = m->state.rested[i] && !m->breakaway.falls && tribo_breakaway_is_sudden(&m->breakaway, i);
            tribo_stick_slip_set(m, i, slip_of(m, sys, i, y));
            if (m->state.slip[i] && loses) {
                return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                         "contact %zu has a static limit and is tied to others that stop beside it: which of "
                                         "them rest is not unique; take central/fixed or moreau/fixed",
                                         i);
            }
        }
    }
    return TRIBO_OK;
}

/* Contacts that a holding contact keeps at rest come to rest too. */
int tribo_stick_slip_find_resting(struct stick_slip *m, const tribo_system *sys, double *y)
{
    int status = TRIBO_OK;
    for (size_t found = 1; !status && found;) {
        status = tribo_stick_slip_knows_holds(m) ? TRIBO_OK : tribo_stick_slip_find_holds(m, sys);
        status = status ? status : tribo_stick_slip_hold(m, sys, m->state.base, y + sys->ndof);
        found = status ? 0 : stop_slips(m, sys, y);
    }
    if (!status && m->state.dependents && m->constant.base_moves) {
        status = part(m, sys, y);
    }
    const size_t n = m->constant.contacts;
    const signed char *restrict slip = m->state.slip;
    unsigned char *restrict rested = m->state.rested;
    for (size_t i = 0; i < n; i++) {
        rested[i] = slip[i] == TRIBO_SLIP_STUCK;
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------------ motion */

int tribo_stick_slip_acceleration(struct stick_slip *m, tribo_system *sys, double t, const double *y, double *acceleration,
                                  double *force)
{
    const struct slip_state *s = &m->state;
    const size_t c = sys->ncontact;
    double *limit = m->work.lo; /* those of (t, y): they swing, or fall with the speed */
    tribo_system_free_motion(sys, t, y, acceleration, m->work.v, m->work.own_a);
    if (sys->compliance.count) {
        tribo_elastic_find(m, sys, y);
    }
    tribo_system_limits(sys, limit, m->work.hi);
    for (size_t i = 0; i < c; i++) {
        limit[i] = greater(limit[i], 0.0);
    }
    if (m->breakaway.some) {
        tribo_breakaway_take(&m->breakaway, c, limit, m->work.hi);
        tribo_breakaway_limits(&m->breakaway, c, s->slip, m->work.v, limit, m->work.hi);
    }
    for (size_t i = 0; i < c; i++) {
        const double follows = m->constant.swing[i] > 0.0 ? tribo_stick_slip_follows(m, i) : 0.0;
        force[i] = !s->loose[i]                     ? 0.0
                   : s->slip[i] == TRIBO_SLIP_OPEN  ? 0.0
                   : s->slip[i] != TRIBO_SLIP_STUCK ? -s->slip[i] * limit[i]
                   : follows != 0.0                 ? follows * (m->breakaway.some ? m->breakaway.kinetic[i] : limit[i])
                   : m->constant.elastic[i]         ? s->spring[i]
                                                    : s->force[i];
    }
    tribo_matrix_multiply_add(&sys->response, 1.0, force, acceleration);
    tribo_stick_slip_contact_accelerations(sys, acceleration, 1, m->work.v);
    const int status = tribo_stick_slip_balance(m, m->work.v, m->work.f);
    tribo_matrix_multiply_add(&sys->response, 1.0, m->work.f, acceleration);
    for (size_t i = 0; i < c; i++) {
        force[i] += m->work.f[i];
    }
    return status ? tribo_system_fail(sys, status, "%s", tribo_message(m->constant.hold)) : TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------ decision */

/* Sets state.base = b(t). It stays zero if no base moves. */
static void find_base(struct stick_slip *m, const tribo_system *sys)
{
    if (tribo_system_bases_move(sys)) {
        memset(m->state.base, 0, sys->ncontact * sizeof *m->state.base);
        tribo_system_loads(sys, DRIVES_BASE, 0, 1.0, m->state.base);
    }
}

void tribo_stick_slip_begin_decision(struct stick_slip *m, tribo_system *sys, double t)
{
    if (!tribo_system_is_at(sys, t)) {
        tribo_system_set_time(sys, t);
    }
    find_base(m, sys);
    memset(m->state.tied, 0, sys->ncontact);
}

void tribo_stick_slip_forget_shares(struct stick_slip *m)
{
    const double *still = m->constant.still;
    if (!m->constant.independent && !m->constant.uncoupled) {
        tribo_solve_box(m->constant.box, still, still, still, m->work.f);
    }
}

void tribo_stick_slip_start(struct stick_slip *m, tribo_system *sys, double t, double *y, int continues)
{
    struct slip_constant *k = &m->constant;
    struct slip_state *s = &m->state;
    const size_t c = sys->ncontact;
    tribo_system_set_time(sys, t);
    tribo_system_limits(sys, s->limit, s->limit_rate);
    tribo_breakaway_start(&m->breakaway, sys, m->work.rate, m->work.v);
    s->stick = m->breakaway.some ? m->breakaway.stick : s->limit;
    s->stick_rate = m->breakaway.some ? m->breakaway.stick_rate : s->limit_rate;
    memset(s->base, 0, c * sizeof *s->base);
    find_base(m, sys);
    tribo_stick_slip_find_scales(m, sys);
    memset(m->noise.velocity_scale, 0, c * sizeof *m->noise.velocity_scale);
    m->noise.factor = 1.0;
    for (size_t i = 0; i < c; i++) {
        k->swing[i] = tribo_system_swing(sys, i);
    }
    if (!continues) {
        memset(s->force, 0, c * sizeof *s->force);
        tribo_stick_slip_forget_gains(m);
        for (size_t i = 0; i < c; i++) {
            const signed char slip = slip_of(m, sys, i, y);
            const int rests = slip == 0 || tribo_stick_slip_is_faint(m, sys, y, i);
            tribo_stick_slip_set(m, i, (signed char)(s->limit[i] == 0.0 ? TRIBO_SLIP_OPEN : rests ? TRIBO_SLIP_STUCK : slip));
            s->rested[i] = 0;
        }
        tribo_stick_slip_forget_shares(m);
        tribo_elastic_start(m, sys, y);
    }
    s->fresh = s->hold_differs = 1;
    s->steady = 0;
    s->reached = c;
    k->base_moves = sys->base_tables > 0;
    for (size_t i = 0; i < sys->harmonics; i++) {
        k->base_moves |= sys->harmonic[i].drives == DRIVES_BASE && sys->harmonic[i].count > 0;
    }
}
