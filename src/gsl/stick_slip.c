/* How it is decided, at an instant:
 *
 *     contacts without velocity, or with none left in the direction of their slip, are at rest
 *     repeat
 *         find the forces: min 1/2 f'Rf + a'f, with |f| <= limit at rest, and f at its limit where a contact slides
 *         contacts at rest slide if their force is at the limit and their acceleration is more than rounding
 *         if none does, but some are just at their limit: solve for a moment later, and contacts at their limit then slide
 *         if still none does: of the forces that hold all at rest, the one most beyond its limit makes its contact slide
 *         one that held by a static limit does not slide yet: the limit by which it slides is its bound from here on
 *     until none begins to slide
 *     an independent set of those at rest holds: it keeps all of them where they are */
#include "stick_slip.h"
#include "../common/real.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Accelerations, and velocities, are known to this part of what they are the sum of. */
#define NOISE 2e-14
#define VELOCITY_NOISE 2e-14

/* Forces may go beyond their limits by so many times their noise, before that is an event: by then it is no noise. */
#define ALLOWED 8.0

/* The moment later, in parts of one over the highest frequency. What has changed by then is far above noise, as a rule, and
 * nearly linear in time. */
#define LOOK_AHEAD 1e-4

/* A force this close to the limit might be taken beyond it by rounding, or in a moment. */
#define CLOSE 0.1

/* A contact that is close to its limit, but not at it, does not reach it in a moment: its bounds are wider by this part. */
#define WIDER 0.02

int tribo_stick_slip_create(struct stick_slip *m, tribo_system *sys)
{
    const size_t c = sys->ncontact + 1, n = sys->ndof;
    memset(m, 0, sizeof *m);
    m->contacts = sys->ncontact;
    m->doubt = 1.0;
    int status = tribo_clone(sys->contacts, &m->box);
    status = status ? status : tribo_clone(sys->contacts, &m->hold);
    double **const by_contact[] = {&m->limit,    &m->limit_rate,  &m->force,   &m->allowance, &m->base,  &m->noise,
                                   &m->diagonal, &m->seen,        &m->parting, &m->excess,    &m->v,     &m->a,
                                   &m->gain,     &m->lo,          &m->hi,      &m->f,         &m->still, &m->swing,
                                   &m->spring,   &m->spring_rate, &m->slack};
    double **const by_dof[] = {&m->acceleration, &m->free, &m->rate, &m->size};
    const size_t contact_arrays = sizeof by_contact / sizeof *by_contact, dof_arrays = sizeof by_dof / sizeof *by_dof;
    double *work = calloc(contact_arrays * c + dof_arrays * n, sizeof *work);
    m->slip = calloc(7, c);
    m->at = malloc(c * sizeof *m->at);
    m->last = malloc(c);
    m->limit = work;
    const int statics = tribo_breakaway_create(&m->breakaway, sys->ncontact);
    if (status || !work || !m->slip || !m->at || !m->last || !statics) {
        tribo_stick_slip_free(m);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s", sys->ncontact, plural(sys->ncontact));
    }
    for (size_t k = 0; k < contact_arrays; k++) {
        *by_contact[k] = work + k * c;
    }
    for (size_t k = 0; k < dof_arrays; k++) {
        *by_dof[k] = work + contact_arrays * c + k * n;
    }
    m->tied = m->slip + c;
    m->before = m->slip + 2 * c;
    m->loose = m->slip + 3 * c;
    m->holds = (unsigned char *)m->slip + 4 * c;
    m->rested = (unsigned char *)m->slip + 5 * c;
    m->slid = m->slip + 6 * c;
    /* these two know directions only */
    tribo_set_planar(m->box, 0, NULL);
    tribo_set_planar(m->hold, 0, NULL);
    m->simple = 1;
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->diagonal[i] = tribo_system_delassus(sys, i, i);
        m->simple &= sys->direction.first[i + 1] - sys->direction.first[i] <= 1;
    }
    size_t islands;
    tribo_get_count(m->box, TRIBO_COUNT_ISLANDS, &islands);
    m->uncoupled = islands == sys->ncontact;
    /* a contact that has reached its limit stays there while others take over */
    tribo_set_sharing(m->box, TRIBO_SHARE_PREVIOUS);
    tribo_set_static(m->box, NULL, NULL);
    tribo_set_static(m->hold, NULL, NULL);
    tribo_set_law(m->hold, TRIBO_COULOMB);
    tribo_set_coupling(m->hold, TRIBO_PARTITION);
    return TRIBO_OK;
}

void tribo_stick_slip_free(struct stick_slip *m)
{
    tribo_destroy(m->box);
    tribo_destroy(m->hold);
    tribo_breakaway_free(&m->breakaway);
    free(m->limit);
    free(m->slip);
    free(m->at);
    free(m->last);
    memset(m, 0, sizeof *m);
}

/* ---------------------------------------------------------------------------------------------------------- rounding */

/* y += amplitudes of the order-th derivatives of loads, or of b. */
static void add_amplitudes(const tribo_system *sys, enum drives drives, int order, double *y)
{
    for (size_t s = 0; s < sys->harmonics; s++) {
        const struct harmonic *w = &sys->harmonic[s];
        const double rate = order ? fabs(w->omega) : 1.0;
        for (size_t k = 0; w->drives == drives && k < w->count; k++) {
            y[w->index[k]] += rate * (fabs(w->cosine[k]) + fabs(w->sine[k]));
        }
    }
}

/* What of the velocities may be rounding, as far as the state tells, and the phase before. */
static void find_noise(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    memset(m->noise, 0, sys->ncontact * sizeof *m->noise);
    add_amplitudes(sys, DRIVES_BASE, 0, m->noise);
    tribo_matrix_add_sizes(&sys->direction, y + sys->ndof, m->noise);
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->noise[i] = VELOCITY_NOISE * greater(m->noise[i], m->seen[i]);
        m->seen[i] = 0.0;
    }
}

/* What of the accelerations of contacts may be rounding, and from that how far their forces may go: sizes of all that they are
 * the sum of. */
void tribo_stick_slip_find_gains(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    if (m->sized) {
        return;
    }
    m->sized = 1;
    memset(m->size, 0, sys->ndof * sizeof *m->size);
    tribo_system_tables(sys, 0, 1.0, m->size);
    for (size_t d = 0; d < sys->ndof; d++) {
        m->size[d] = fabs(m->size[d]);
    }
    add_amplitudes(sys, DRIVES_LOAD, 0, m->size);
    tribo_matrix_add_sizes(&sys->stiffness, y, m->size);
    if (sys->damping.rows) {
        tribo_matrix_add_sizes(&sys->damping, y + sys->ndof, m->size);
    }
    tribo_matrix_add_sizes(&sys->response, m->force, m->size);
    memset(m->gain, 0, sys->ncontact * sizeof *m->gain);
    add_amplitudes(sys, DRIVES_BASE, 1, m->gain);
    tribo_matrix_add_sizes(&sys->direction, m->size, m->gain);
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->gain[i] *= NOISE * m->doubt;
        m->allowance[i] = m->diagonal[i] > 0.0 ? ALLOWED * m->gain[i] / m->diagonal[i] : 0.0;
        m->allowance[i] += TRIBO_LIMIT_NOISE * m->doubt * tribo_breakaway_ratio(&m->breakaway, i) * m->swing[i];
        m->parting[i] = greater(4.0 * m->doubt * m->noise[i], m->gain[i] * m->horizon / LOOK_AHEAD);
    }
}

/* ------------------------------------------------------------------------------------------------------ who is at rest */

double tribo_stick_slip_follows(const struct stick_slip *m, size_t i)
{
    if (m->slip[i] == 0) {
        const double ratio = tribo_breakaway_ratio(&m->breakaway, i);
        return m->holds[i] || !m->tied[i] ? 0.0 : m->force[i] > 0.0 ? ratio : -ratio;
    }
    return m->slip[i] == 2 ? 0.0 : -m->slip[i];
}

int tribo_stick_slip_may_part(const struct stick_slip *m, size_t i)
{
    return m->base_moves && m->slip[i] == 0 && !m->holds[i];
}

double tribo_stick_slip_slack(const struct stick_slip *m, size_t i)
{
    return tribo_breakaway_is_sudden(&m->breakaway, i) ? m->allowance[i] : 0.0;
}

double tribo_stick_slip_velocity(const struct stick_slip *m, const tribo_system *sys, size_t i, const double *y)
{
    const struct matrix *j = &sys->direction;
    double v = -m->base[i];
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        v += j->val[k] * y[sys->ndof + j->col[k]];
    }
    return v;
}

static signed char slip_of(const struct stick_slip *m, size_t i, double v)
{
    return (signed char)(fabs(v) <= m->doubt * m->noise[i] ? 0 : v > 0.0 ? 1 : -1);
}

static int presses(const struct stick_slip *m, const tribo_system *sys, size_t i)
{
    return m->swing[i] > 0.0 ? tribo_system_presses(sys, i, m->doubt) : m->limit[i] != 0.0 || m->limit_rate[i] != 0.0;
}

/* Brings limits, and with them which contacts are open, up to the time set. */
static void update_limits(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    if (tribo_system_limits_vary(sys) || m->breakaway.some) {
        tribo_system_limits(sys, m->limit, m->limit_rate);
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (!presses(m, sys, i)) {
            m->limit[i] = m->limit_rate[i] = 0.0;
            m->slip[i] = 2;
        } else if (m->slip[i] == 2) {
            m->slip[i] = slip_of(m, i, tribo_stick_slip_velocity(m, sys, i, y));
        }
        m->limit[i] = greater(m->limit[i], 0.0);
    }
    tribo_breakaway_take(&m->breakaway, sys->ncontact, m->limit, m->limit_rate);
}

/* A static limit that is lost does not come back: it must not go with who of those that tie each other is held. */
static int not_unique(const tribo_system *sys, size_t i)
{
    return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                             "contact %zu has a static limit and is tied to others that stop beside it: which of them rest is "
                             "not unique; take central/fixed or moreau/fixed",
                             i);
}

/* Whoever has no velocity, or none in the direction of its slip any more, is at rest, also those that another contact now holds.
 * But where bases part, a contact that rests by itself goes with them. */
int tribo_stick_slip_find_resting(struct stick_slip *m, const tribo_system *sys, double *y)
{
    int status = TRIBO_OK;
    for (size_t found = 1; !status && found;) {
        status = tribo_stick_slip_find_holds(m, sys);
        status = status ? status : tribo_stick_slip_hold(m, sys, m->base, y + sys->ndof);
        found = 0;
        for (size_t i = 0; !status && i < sys->ncontact; i++) {
            if ((m->slip[i] == 1 || m->slip[i] == -1) && m->slip[i] != slip_of(m, i, tribo_stick_slip_velocity(m, sys, i, y))) {
                m->slip[i] = 0;
                found++;
            }
        }
    }
    for (size_t i = 0; !status && m->dependents && i < sys->ncontact; i++) {
        if (m->slip[i] == 0 && !m->holds[i]) {
            m->slip[i] = slip_of(m, i, tribo_stick_slip_velocity(m, sys, i, y));
            status = m->slip[i] && m->rested[i] && tribo_breakaway_is_sudden(&m->breakaway, i) ? not_unique(sys, i) : TRIBO_OK;
        }
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->rested[i] = m->slip[i] == 0;
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------------- forces */

/* Whether contact i is at rest by a force that is to be found; that of elastic ones is known. */
static int searches(const struct stick_slip *m, const tribo_system *sys, size_t i)
{
    return m->slip[i] == 0 && !tribo_massless_touches(&sys->massless, i);
}

/* f [ncontact] = the solution for accelerations a without friction, within lo and hi. */
static int solve(struct stick_slip *m, const tribo_system *sys, const double *a, double *f)
{
    for (size_t i = 0; m->uncoupled && i < m->contacts; i++) {
        /* one that friction cannot move takes all that it can of any pull */
        const double pull = m->diagonal[i] > 0.0 ? a[i] / m->diagonal[i] : a[i] != 0.0 ? copysign(HUGE_VAL, a[i]) : 0.0;
        f[i] = clamp(-pull, m->lo[i], m->hi[i]);
    }
    const int status = m->uncoupled ? TRIBO_OK : tribo_solve_box(m->box, a, m->lo, m->hi, f);
    return status ? tribo_system_fail(sys, status, "at t = %.17g: %s", sys->time, tribo_message(m->box)) : TRIBO_OK;
}

/* Forces and accelerations, with contacts at rest as they are marked. */
static int find_forces(struct stick_slip *m, tribo_system *sys)
{
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double limit = m->slip[i] == 2 ? 0.0 : m->slip[i] == 0 ? m->stick[i] : m->limit[i];
        m->lo[i] = m->slip[i] == 1 || m->slip[i] == 0 ? -limit : limit;
        m->hi[i] = m->slip[i] == 1 ? -limit : limit;
        if (tribo_massless_touches(&sys->massless, i)) {
            m->lo[i] = m->hi[i] = m->spring[i];
        }
    }
    const int status = solve(m, sys, m->a, m->force);
    memcpy(m->acceleration, m->free, sys->ndof * sizeof *m->free);
    tribo_matrix_multiply_add(&sys->response, 1.0, m->force, m->acceleration);
    return status;
}

/* to = J acceleration - order-th derivative of b. */
void tribo_stick_slip_contact_accelerations(const tribo_system *sys, const double *acceleration, int order, double *to)
{
    memset(to, 0, sys->ncontact * sizeof *to);
    tribo_system_loads(sys, DRIVES_BASE, order, -1.0, to);
    tribo_matrix_multiply_add(&sys->direction, 1.0, acceleration, to);
}

/* A contact that cannot hold slides; but if it held by a static limit, it is decided about once more by the other one. */
static void let_go(struct stick_slip *m, size_t i, signed char direction)
{
    m->slip[i] = tribo_breakaway_lets_go(&m->breakaway, i) ? 0 : direction;
    m->tied[i] = 0;
}

/* A contact at rest whose force is at its limit, in `direction` of the slip that it resists, and accelerates that way by more
 * than rounding, slides. */
static int breaks_away(struct stick_slip *m, size_t i, signed char direction, double acceleration)
{
    if (direction * acceleration <= m->gain[i]) {
        return 0;
    }
    let_go(m, i, direction);
    return 1;
}

/* Where a contact at its limit slides by its force, or, if that is nothing, by its acceleration v. */
static signed char direction_of(const struct stick_slip *m, size_t i, double force)
{
    return (signed char)(force != 0.0 ? (force > 0.0 ? -1 : 1) : m->v[i] < 0.0 ? -1 : 1);
}

/* Who slides by the forces found; and who is tied. Returns how many slide, with how many are tied. */
static size_t let_slide(struct stick_slip *m, tribo_system *sys, const double *y, size_t *ties)
{
    size_t close = 0, changes = 0;
    *ties = 0;
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->tied[i] = 0;
        close += searches(m, sys, i) && fabs(m->force[i]) >= (1.0 - CLOSE) * m->stick[i];
    }
    if (close == 0) {
        return 0;
    }
    tribo_stick_slip_find_gains(m, sys, y);
    tribo_stick_slip_contact_accelerations(sys, m->acceleration, 1, m->v);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double room = m->stick[i] - fabs(m->force[i]);
        const double within = i == m->reached ? CLOSE * m->stick[i] : m->allowance[i] / ALLOWED;
        if (searches(m, sys, i) && room <= within) {
            const signed char direction = direction_of(m, i, m->force[i]);
            m->tied[i] = 1;
            changes += room <= 0.0 && breaks_away(m, i, direction, m->v[i]);
            *ties += m->tied[i] != 0;
        }
    }
    return changes;
}

/* ---------------------------------------------------------------------------------------------------------- look ahead */

static double limit_ahead(const struct stick_slip *m, size_t i)
{
    const double now = m->slip[i] ? m->limit[i] : m->stick[i], rate = m->slip[i] ? m->limit_rate[i] : m->stick_rate[i];
    return m->slip[i] == 2 ? 0.0 : greater(now + m->horizon * rate, 0.0);
}

/* The limits of this instant, where there are static ones. */
static void find_static(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    if (m->breakaway.some) {
        for (size_t i = 0; i < sys->ncontact; i++) {
            m->v[i] = m->rested[i] ? 0.0 : tribo_stick_slip_velocity(m, sys, i, y);
        }
        tribo_breakaway_limits(&m->breakaway, sys->ncontact, m->slip, m->v, m->limit, m->limit_rate);
    }
}

/* How the limits of sliding contacts fall, as they gain speed. */
static void find_falling(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    find_static(m, sys, y);
    tribo_stick_slip_contact_accelerations(sys, m->acceleration, 1, m->v);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double v = m->rested[i] ? 0.0 : tribo_stick_slip_velocity(m, sys, i, y);
        m->limit_rate[i] += m->slip[i] == 2 ? 0.0 : m->slip[i] * m->v[i] * tribo_breakaway_slope(&m->breakaway, i, v);
    }
}

static void set_bounds_ahead(struct stick_slip *m, const tribo_system *sys)
{
    for (size_t i = 0; i < m->contacts; i++) {
        const double limit = limit_ahead(m, i), now = m->stick[i], wider = WIDER * now;
        if (tribo_massless_touches(&sys->massless, i)) {
            m->lo[i] = m->hi[i] = m->spring[i] + m->horizon * m->spring_rate[i];
            continue;
        }
        if (m->slip[i] != 0) {
            m->lo[i] = m->hi[i] = m->slip[i] == 2 ? 0.0 : -m->slip[i] * limit;
            continue;
        }
        m->hi[i] = limit + (!m->tied[i] && now - m->force[i] < wider ? wider : 0.0);
        m->lo[i] = -limit - (!m->tied[i] && now + m->force[i] < wider ? wider : 0.0);
    }
}

/* rate = the rate of q'' while the forces of contacts at rest are what they are. */
void tribo_stick_slip_find_rate(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    memset(m->rate, 0, sys->ndof * sizeof *m->rate);
    tribo_system_loads(sys, DRIVES_LOAD, 1, 1.0, m->rate);
    tribo_matrix_multiply_add(&sys->stiffness, -1.0, y + sys->ndof, m->rate);
    if (sys->damping.rows) {
        tribo_matrix_multiply_add(&sys->damping, -1.0, m->acceleration, m->rate);
    }
}

/* Who slides by the forces of a moment later; the others that are tied stay so, or go back inside. */
static int look_ahead(struct stick_slip *m, tribo_system *sys, const double *y, size_t *changes)
{
    tribo_stick_slip_find_gains(m, sys, y);
    if (m->breakaway.falls) {
        find_falling(m, sys, y);
    }
    tribo_stick_slip_find_rate(m, sys, y);
    tribo_stick_slip_contact_accelerations(sys, m->rate, 2, m->v);
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->v[i] = m->a[i] + m->horizon * m->v[i];
    }
    set_bounds_ahead(m, sys);
    const int status = solve(m, sys, m->v, m->f);
    if (status) {
        return status;
    }
    memset(m->rate, 0, sys->ndof * sizeof *m->rate);
    tribo_matrix_multiply_add(&sys->response, 1.0, m->f, m->rate);
    tribo_matrix_multiply_add(&sys->direction, 1.0, m->rate, m->v);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double limit = limit_ahead(m, i), room = limit - fabs(m->f[i]);
        if (searches(m, sys, i) && room >= 0.0) {
            const signed char direction = direction_of(m, i, m->f[i]);
            const int may = !tribo_breakaway_is_sudden(&m->breakaway, i);
            const int leaves = may && room <= 0.0 && breaks_away(m, i, direction, m->v[i]);
            *changes += (size_t)leaves;
            m->tied[i] = (signed char)(leaves || !m->tied[i] ? 0 : room > m->allowance[i] ? 2 : 1);
        }
    }
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------ overload */

/* f = the forces that hold all contacts at rest where they are, the others having theirs. */
static int find_holding_forces(struct stick_slip *m, const tribo_system *sys)
{
    int status = tribo_stick_slip_find_holds(m, sys);
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->v[i] = m->loose[i] ? m->force[i] : 0.0;
    }
    memcpy(m->rate, m->free, sys->ndof * sizeof *m->rate);
    tribo_matrix_multiply_add(&sys->response, 1.0, m->v, m->rate);
    tribo_stick_slip_contact_accelerations(sys, m->rate, 1, m->v);
    status = status ? status : tribo_stick_slip_balance(m, m->v, m->f);
    return status ? tribo_system_fail(sys, status, "%s", tribo_message(m->hold)) : TRIBO_OK;
}

/* Of a light body between heavy ones the acceleration may be nothing but rounding, also where a contact on it lets go, or goes
 * back inside its limit. Then the forces tell that it takes to hold all that are at rest: if they go beyond the limits, the
 * contact that is most overloaded slides; and otherwise these are the forces. */
static int relieve(struct stick_slip *m, const tribo_system *sys, size_t *changes)
{
    const int status = find_holding_forces(m, sys);
    size_t worst = sys->ncontact;
    double most = 1.0;
    for (size_t i = 0; !status && i < sys->ncontact; i++) {
        const double excess = fabs(m->f[i]) - m->stick[i];
        if (m->tied[i] && m->holds[i] && excess > most * m->allowance[i]) {
            worst = i;
            most = excess / m->allowance[i];
        }
    }
    if (worst < sys->ncontact) {
        let_go(m, worst, m->f[worst] > 0.0 ? -1 : 1);
        *changes = 1;
        return status;
    }
    for (size_t i = 0; !status && i < sys->ncontact; i++) {
        m->force[i] = m->loose[i] ? m->force[i] : clamp(m->f[i], -m->stick[i], m->stick[i]);
        m->excess[i] = m->loose[i] ? 0.0 : fabs(m->f[i] - m->force[i]);
    }
    memcpy(m->acceleration, m->free, sys->ndof * sizeof *m->free);
    tribo_matrix_multiply_add(&sys->response, 1.0, m->force, m->acceleration);
    return status;
}

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

int tribo_stick_slip_acceleration(struct stick_slip *m, tribo_system *sys, double t, const double *y, double *acceleration)
{
    tribo_system_free_motion(sys, t, y, acceleration, m->v, m->a);
    if (sys->massless.count) {
        tribo_elastic_find(m, sys, y);
    }
    find_sliding_limits(m, sys, m->v);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double rests = tribo_massless_touches(&sys->massless, i) ? m->spring[i] : m->force[i];
        m->f[i] = !m->loose[i] || m->slip[i] == 2 ? 0.0 : m->slip[i] == 0 ? rests : -m->slip[i] * m->lo[i];
    }
    tribo_matrix_multiply_add(&sys->response, 1.0, m->f, acceleration);
    tribo_stick_slip_contact_accelerations(sys, acceleration, 1, m->v);
    const int status = tribo_stick_slip_balance(m, m->v, m->f);
    tribo_matrix_multiply_add(&sys->response, 1.0, m->f, acceleration);
    return status ? tribo_system_fail(sys, status, "%s", tribo_message(m->hold)) : TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------------ decision */

void tribo_stick_slip_begin_decision(struct stick_slip *m, tribo_system *sys, double t, double *y)
{
    tribo_system_set_time(sys, t);
    memset(m->base, 0, sys->ncontact * sizeof *m->base);
    tribo_system_loads(sys, DRIVES_BASE, 0, 1.0, m->base);
    memset(m->tied, 0, sys->ncontact);
    tribo_elastic_release(sys, y);
    find_noise(m, sys, y);
}

int tribo_stick_slip_decide(struct stick_slip *m, tribo_system *sys, double t, double *y)
{
    tribo_stick_slip_begin_decision(m, sys, t, y);
    update_limits(m, sys, y);
    tribo_elastic_place(m, sys, y);
    int status = tribo_stick_slip_find_resting(m, sys, y);
    find_static(m, sys, y);
    if (!status) {
        tribo_elastic_hold(m, sys, y);
        tribo_system_free_motion(sys, t, y, m->free, m->v, m->a);
        m->sized = 0;
        memset(m->allowance, 0, sys->ncontact * sizeof *m->allowance);
        memset(m->excess, 0, sys->ncontact * sizeof *m->excess);
    }
    for (size_t changes = 1; !status && changes;) {
        size_t ties;
        status = find_forces(m, sys);
        changes = status ? 0 : let_slide(m, sys, y, &ties);
        if (!status && !changes && (ties || (m->dependents && m->base_moves))) {
            status = look_ahead(m, sys, y, &changes);
        }
        if (!status && !changes && ties) {
            status = relieve(m, sys, &changes);
        }
    }
    m->reached = m->contacts;
    if (m->breakaway.some && !status) {
        tribo_stick_slip_find_gains(m, sys, y);
    }
    for (size_t i = 0; m->breakaway.some && i < m->contacts; i++) {
        m->tied[i] = (signed char)(tribo_breakaway_restore(&m->breakaway, i) ? 0 : m->tied[i]);
    }
    if (!status) {
        tribo_elastic_finish(m, sys);
    }
    return status ? status : tribo_stick_slip_find_holds(m, sys);
}

void tribo_stick_slip_start(struct stick_slip *m, tribo_system *sys, double t, double *y, int continues)
{
    tribo_system_set_time(sys, t);
    tribo_system_limits(sys, m->limit, m->limit_rate);
    tribo_breakaway_start(&m->breakaway, sys, m->rate, m->v);
    m->stick = m->breakaway.some ? m->breakaway.stick : m->limit;
    m->stick_rate = m->breakaway.some ? m->breakaway.stick_rate : m->limit_rate;
    memset(m->base, 0, sys->ncontact * sizeof *m->base);
    tribo_system_loads(sys, DRIVES_BASE, 0, 1.0, m->base);
    find_noise(m, sys, y);
    for (size_t i = 0; !continues && i < sys->ncontact; i++) {
        m->slip[i] = (signed char)(m->limit[i] == 0.0 ? 2 : slip_of(m, i, tribo_stick_slip_velocity(m, sys, i, y)));
        m->rested[i] = 0;
    }
    if (!continues) {
        tribo_elastic_start(m, sys, y);
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        m->swing[i] = tribo_system_swing(sys, i);
    }
    m->fresh = 1;
    m->doubt = 1.0;
    m->reached = m->contacts;
    m->base_moves = 0;
    for (size_t k = 0; k < sys->harmonics; k++) {
        m->base_moves |= sys->harmonic[k].drives == DRIVES_BASE && sys->harmonic[k].count > 0;
    }
    const double most = tribo_system_fastest(sys) + m->breakaway.steepest;
    m->horizon = LOOK_AHEAD / (most > 0.0 ? most : 1.0);
}
