/* What contacts do at an instant: the limits and bases there, which contacts are at rest, and the acceleration that follows. */
#include "stick_slip.h"
#include "common/real.h"

#include <string.h>

/* Whether contact i slides in a state, and which way. */
static signed char slip_of(struct stick_slip *m, const tribo_system *sys, size_t i, const double *y)
{
    const double v = tribo_stick_slip_find_velocity(m, sys, i, y);
    return (signed char)(fabs(v) <= m->doubt * m->noise[i] ? TRIBO_SLIP_STUCK : v > 0.0 ? TRIBO_SLIP_FORTH : TRIBO_SLIP_BACK);
}

static int presses(const struct stick_slip *m, const tribo_system *sys, size_t i)
{
    return m->swing[i] > 0.0 ? tribo_system_presses(sys, i, m->doubt) : m->limit[i] != 0.0 || m->limit_rate[i] != 0.0;
}

void tribo_stick_slip_update_limits(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    if (m->steady) {
        return;
    }
    const int varies = tribo_system_limits_vary(sys) || m->breakaway.some;
    if (varies) {
        tribo_system_limits(sys, m->limit, m->limit_rate);
    }
    m->steady = !varies;
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (!presses(m, sys, i)) {
            m->limit[i] = m->limit_rate[i] = 0.0;
            tribo_stick_slip_set(m, i, TRIBO_SLIP_OPEN);
        } else if (m->slip[i] == TRIBO_SLIP_OPEN) {
            tribo_stick_slip_set(m, i, slip_of(m, sys, i, y));
        }
        m->limit[i] = greater(m->limit[i], 0.0);
    }
    if (m->breakaway.some) {
        tribo_breakaway_take(&m->breakaway, sys->ncontact, m->limit, m->limit_rate);
    }
}

/* A static limit that is lost does not come back: it must not go with who of those that tie each other is held. */
static int not_unique(const tribo_system *sys, size_t i)
{
    return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                             "contact %zu has a static limit and is tied to others that stop beside it: which of them rest is "
                             "not unique; take central/fixed or moreau/fixed",
                             i);
}

/* Those that have no velocity in the direction of their slip any more rest; returns how many. */
static size_t stop(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    const size_t n = m->contacts;
    const signed char *const slip = m->slip;
    size_t found = 0;
    for (size_t i = 0; i < n; i++) {
        if (tribo_slides(slip[i]) && slip[i] * tribo_stick_slip_find_velocity(m, sys, i, y) <= m->doubt * m->noise[i]) {
            tribo_stick_slip_set(m, i, TRIBO_SLIP_STUCK);
            found++;
        }
    }
    return found;
}

/* Where bases part, a contact that rests by itself goes with them. A limit that falls with the speed is not lost by that. */
static int part(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    int status = TRIBO_OK;
    for (size_t i = 0; !status && i < sys->ncontact; i++) {
        if (m->slip[i] == TRIBO_SLIP_STUCK && !m->holds[i]) {
            tribo_stick_slip_set(m, i, slip_of(m, sys, i, y));
            const int loses = m->rested[i] && !m->breakaway.falls && tribo_breakaway_is_sudden(&m->breakaway, i);
            status = m->slip[i] && loses ? not_unique(sys, i) : TRIBO_OK;
        }
    }
    return status;
}

static void note_rest(size_t n, const signed char *restrict slip, unsigned char *restrict rested)
{
    for (size_t i = 0; i < n; i++) {
        rested[i] = slip[i] == TRIBO_SLIP_STUCK;
    }
}

/* Those that another contact holds from here on are at rest, too. */
int tribo_stick_slip_find_resting(struct stick_slip *m, const tribo_system *sys, double *y)
{
    int status = TRIBO_OK;
    for (size_t found = 1; !status && found;) {
        status = tribo_stick_slip_knows_holds(m) ? TRIBO_OK : tribo_stick_slip_find_holds(m, sys);
        status = status ? status : tribo_stick_slip_hold(m, sys, m->base, y + sys->ndof);
        tribo_elastic_hold(m, sys, y);
        found = status ? 0 : stop(m, sys, y);
    }
    if (!status && m->dependents && m->base_moves) {
        status = part(m, sys, y);
    }
    note_rest(m->contacts, m->slip, m->rested);
    return status;
}

/* ------------------------------------------------------------------------------------------------------------ motion */

/* lo = the limits by which contacts slide at the time set with velocities v: others than those that were last decided with, if
 * they swing, or fall with the speed. */
static void find_sliding_limits(struct stick_slip *m, const tribo_system *sys, const double *v)
{
    tribo_system_limits(sys, m->lo, m->hi);
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->lo[i] = greater(m->lo[i], 0.0);
    }
    if (m->breakaway.some) {
        tribo_breakaway_take(&m->breakaway, sys->ncontact, m->lo, m->hi);
        tribo_breakaway_limits(&m->breakaway, sys->ncontact, m->slip, v, m->lo, m->hi);
    }
}

/* The force of contact i, which does not hold, at the time that limits were found for: one that rests by itself keeps its force,
 * or follows its limit. */
static double own_force(const struct stick_slip *m, size_t i)
{
    const double follows = m->slip[i] == TRIBO_SLIP_STUCK && m->swing[i] > 0.0 ? tribo_stick_slip_follows(m, i) : 0.0;
    if (m->slip[i] != TRIBO_SLIP_STUCK) {
        return m->slip[i] == TRIBO_SLIP_OPEN ? 0.0 : -m->slip[i] * m->lo[i];
    }
    if (follows != 0.0) {
        return follows * (m->breakaway.some ? m->breakaway.kinetic[i] : m->lo[i]);
    }
    return m->elastic[i] ? m->spring[i] : m->force[i];
}

int tribo_stick_slip_acceleration(struct stick_slip *m, tribo_system *sys, double t, const double *y, double *acceleration,
                                  double *force)
{
    tribo_system_free_motion(sys, t, y, acceleration, m->v, m->own_a);
    if (sys->massless.count) {
        tribo_elastic_find(m, sys, y);
    }
    find_sliding_limits(m, sys, m->v);
    for (size_t i = 0; i < sys->ncontact; i++) {
        force[i] = m->loose[i] ? own_force(m, i) : 0.0;
    }
    tribo_matrix_multiply_add(&sys->response, 1.0, force, acceleration);
    tribo_stick_slip_contact_accelerations(sys, acceleration, 1, m->v);
    const int status = tribo_stick_slip_balance(m, m->v, m->f);
    tribo_matrix_multiply_add(&sys->response, 1.0, m->f, acceleration);
    for (size_t i = 0; i < sys->ncontact; i++) {
        force[i] += m->f[i];
    }
    return status ? tribo_system_fail(sys, status, "%s", tribo_message(m->hold)) : TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------ decision */

/* b(t), which is zero throughout where no base moves. */
static void find_base(struct stick_slip *m, const tribo_system *sys)
{
    if (tribo_system_bases_move(sys)) {
        memset(m->base, 0, sys->ncontact * sizeof *m->base);
        tribo_system_loads(sys, DRIVES_BASE, 0, 1.0, m->base);
    }
}

void tribo_stick_slip_begin_decision(struct stick_slip *m, tribo_system *sys, double t, double *y)
{
    if (!tribo_system_is_at(sys, t)) {
        tribo_system_set_time(sys, t);
    }
    find_base(m, sys);
    memset(m->tied, 0, sys->ncontact);
    tribo_elastic_release(sys, y);
}

/* What contacts do in a state that nothing is known of. */
static void start_anew(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    memset(m->force, 0, sys->ncontact * sizeof *m->force);
    tribo_stick_slip_forget_gains(m);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const signed char slip = slip_of(m, sys, i, y);
        const int rests = slip == 0 || tribo_stick_slip_is_faint(m, sys, y, i);
        tribo_stick_slip_set(m, i, (signed char)(m->limit[i] == 0.0 ? TRIBO_SLIP_OPEN : rests ? TRIBO_SLIP_STUCK : slip));
        m->rested[i] = 0;
    }
}

void tribo_stick_slip_forget_shares(struct stick_slip *m)
{
    if (!m->independent && !m->uncoupled) {
        tribo_solve_box(m->box, m->still, m->still, m->still, m->f);
    }
}

void tribo_stick_slip_start(struct stick_slip *m, tribo_system *sys, double t, double *y, int continues)
{
    tribo_system_set_time(sys, t);
    tribo_system_limits(sys, m->limit, m->limit_rate);
    tribo_breakaway_start(&m->breakaway, sys, m->rate, m->v);
    m->stick = m->breakaway.some ? m->breakaway.stick : m->limit;
    m->stick_rate = m->breakaway.some ? m->breakaway.stick_rate : m->limit_rate;
    memset(m->base, 0, sys->ncontact * sizeof *m->base);
    find_base(m, sys);
    tribo_stick_slip_find_scales(m, sys);
    memset(m->seen, 0, sys->ncontact * sizeof *m->seen);
    m->doubt = 1.0;
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->swing[i] = tribo_system_swing(sys, i);
    }
    if (!continues) {
        start_anew(m, sys, y);
        tribo_stick_slip_forget_shares(m);
        tribo_elastic_start(m, sys, y);
    }
    m->fresh = m->hold_differs = 1;
    m->steady = 0;
    m->reached = m->contacts;
    m->base_moves = sys->base_tables > 0;
    for (size_t k = 0; k < sys->harmonics; k++) {
        m->base_moves |= sys->harmonic[k].drives == DRIVES_BASE && sys->harmonic[k].count > 0;
    }
}
