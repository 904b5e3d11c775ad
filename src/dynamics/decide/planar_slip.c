/* Decides, at an instant, which contacts stick and which slide, if there are planar contacts:
 *
 *     contacts whose velocity is nothing beside the tolerance are at rest
 *     find the forces of those at rest, others sliding as they do: min 1/2 f'Rf + a'f over intervals, discs, and ellipses
 *     contacts at rest slide if their force is at its limit and they accelerate by more than rounding, against that force
 *     of others that are at their limit: solve for a moment later, and those that accelerate then slide from here on
 *     an independent set of those at rest holds
 *
 * The problem is convex: each solution decides about all contacts together. */
#include "planar_slip.h"
#include "stick_slip.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A speed below this part of the tolerance is rest. */
#define NOTHING 0.1

/* Rounding of a speed, in parts of the largest one so far. */
#define ROUNDING 1e-14

/* Largest turn of a sliding force, in radians, in the moment looked ahead. */
#define TURN 0.02

void tribo_planar_slip_free(struct planar_slip *p)
{
    if (p) {
        tribo_destroy(p->disc);
        free(p->contact);
        free(p->in_plane);
        free(p->rate);
        free(p);
    }
}

/* --------------------------------------------------------------------------------------------------------- contacts */

static int create_plane(struct stick_slip *m, const tribo_system *sys)
{
    const size_t c = sys->ncontact;
    struct planar_slip *p = m->plane = m->plane ? m->plane : calloc(1, sizeof *p);
    signed char *slip = malloc(c);
    if (p && !p->rate) {
        p->contact = malloc((c / 2) * sizeof *p->contact);
        p->in_plane = malloc(c);
        p->rate = malloc(3 * c * sizeof *p->rate);
    }
    const int room = p && slip && p->contact && p->in_plane && p->rate;
    int status = TRIBO_ERR_MEMORY;
    if (room) {
        tribo_destroy(p->disc);
        p->disc = NULL;
        p->count = 0;
        memset(p->in_plane, 0, c);
        status = tribo_clone(sys->contacts, &p->disc);
    } else {
        tribo_planar_slip_free(p);
        m->plane = NULL;
    }
    if (!status) {
        p->ahead = p->rate + c;
        p->error = p->rate + 2 * c;
        tribo_set_law(p->disc, TRIBO_COULOMB);
        tribo_set_sharing(p->disc, TRIBO_SHARE_PREVIOUS);
        /* slip[i] = TRIBO_SLIP_PLANE for directions of planar contacts: the slip of contacts that all slide */
        double *one = p->rate;
        for (size_t i = 0; i < c; i++) {
            one[i] = 1.0;
        }
        status = tribo_set_limit(p->disc, one);
        status = status ? status : tribo_balance(p->disc, one, one, NULL, one);
        status = status ? status : tribo_get_slip(p->disc, slip);
    }
    for (size_t i = 0; !status && i + 1 < c; i++) {
        /* directions of planar contacts stand in pairs; one without both limits is scalar, or open */
        const double *limit = m->state.limit + i;
        if (slip[i] == TRIBO_SLIP_PLANE && limit[0] > 0.0 && limit[1] > 0.0) {
            p->contact[p->count++] = (struct planar_contact){.at = i, .limit = {limit[0], limit[1]}};
            p->in_plane[i] = 1;
            p->in_plane[i + 1] = 2;
        }
        i += slip[i] == TRIBO_SLIP_PLANE;
    }
    free(slip);
    return status ? tribo_system_fail(sys, status, "%s, of planar contacts", tribo_strerror(status)) : TRIBO_OK;
}

static int slides_in_plane(const struct stick_slip *m, const struct planar_contact *p)
{
    return m->state.slip[p->at] == TRIBO_SLIP_PLANE;
}

static double length(const double *x)
{
    return hypot(x[0], x[1]);
}

/* 1 if the speed of a contact is rounding, or below NOTHING of the tolerance and not growing: a contact that begins to slide
 * beside one that creeps may be slow for many steps. */
static int rests(const struct stick_slip *m, const struct planar_contact *p)
{
    const double noise = greater(m->noise.factor * (m->noise.velocity[p->at] + m->noise.velocity[p->at + 1]), ROUNDING * p->most);
    return p->now <= noise || (p->now <= NOTHING * (m->constant.abstol + m->constant.reltol * p->most) && p->now <= p->before);
}

static void set_slip(struct stick_slip *m, const struct planar_contact *p, signed char slip)
{
    tribo_stick_slip_set(m, p->at, slip);
    tribo_stick_slip_set(m, p->at + 1, slip);
}

/* Forces of planar contacts are known for limits that are the same at all times and speeds, at rest and not. */
static int check_limits(const struct stick_slip *m, const tribo_system *sys, size_t planar)
{
    for (size_t i = 0; i < m->constant.contacts; i++) {
        if (tribo_breakaway_ratio(&m->breakaway, i) > 1.0) {
            return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                     "method event knows no static limits beside planar contacts: contact %zu has ratio[%zu] = "
                                     "%g: take moreau/fixed",
                                     i, i, m->breakaway.ratio[i]);
        }
    }
    return !tribo_system_limits_vary(sys)
               ? TRIBO_OK
               : tribo_system_fail(
                     sys, TRIBO_ERR_UNSUPPORTED,
                     "method event knows no limits that change with time beside planar contacts, of which the system has %zu",
                     planar);
}

int tribo_planar_slip_start(struct stick_slip *m, const tribo_system *sys, int continues)
{
    const size_t planar = tribo_system_planar(sys);
    if (!planar) {
        tribo_planar_slip_free(m->plane);
        m->plane = NULL;
    }
    if (!planar || continues) {
        return TRIBO_OK;
    }
    int status = check_limits(m, sys, planar);
    status = status ? status : create_plane(m, sys);
    for (size_t k = 0; !status && k < m->plane->count; k++) {
        set_slip(m, &m->plane->contact[k], TRIBO_SLIP_PLANE); /* whether it is at rest is seen by its speed alone */
        m->plane->contact[k].now = HUGE_VAL;
    }
    return status;
}

/* ----------------------------------------------------------------------------------------------------------- at rest */

/* Brings contacts without speed to rest; returns their number. */
static size_t stop_in_plane(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    size_t found = 0;
    for (size_t k = 0; k < m->plane->count; k++) {
        struct planar_contact *p = &m->plane->contact[k];
        double v[2];
        for (size_t d = 0; d < 2; d++) {
            v[d] = tribo_stick_slip_find_velocity(m, sys, p->at + d, y);
        }
        p->now = length(v);
        p->most = greater(p->most, p->now);
        p->begins = SLIDES_ON;
        if (slides_in_plane(m, p) && rests(m, p)) {
            set_slip(m, p, TRIBO_SLIP_STUCK);
            m->plane->stopped = p->at;
            found++;
        }
    }
    return found;
}

/* An error if a contact at rest depends on others: the forces of these contacts are not unique then. */
static int check_holds(const struct stick_slip *m, const tribo_system *sys)
{
    for (size_t i = 0; m->state.dependents && i < m->constant.contacts; i++) {
        if (m->state.slip[i] == TRIBO_SLIP_STUCK && !m->state.holds[i]) {
            return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                                     "at t = %.17g contact %zu rests by what others hold: method event knows no redundant "
                                     "contacts at rest where some are planar",
                                     sys->time, i);
        }
    }
    return TRIBO_OK;
}

static int find_resting(struct stick_slip *m, const tribo_system *sys, double *y)
{
    int status = TRIBO_OK;
    m->plane->stopped = m->constant.contacts;
    do {
        stop_in_plane(m, sys, y);
        status = tribo_stick_slip_find_resting(m, sys, y);
        status = status ? status : check_holds(m, sys);
    } while (!status && stop_in_plane(m, sys, y));
    return status;
}

/* ------------------------------------------------------------------------------------------------------------ forces */

/* Sets work.lo = forces of sliding contacts, 0 of others, and plane->rate = their rates for accelerations acc [ncontact].
 * Returns the fastest rate of turn of a force. */
static double given_forces(struct stick_slip *m, const tribo_system *sys, const double *y, const double *acc)
{
    double fastest = 0.0;
    for (size_t i = 0; i < m->constant.contacts; i++) {
        m->work.lo[i] = tribo_slides(m->state.slip[i]) ? -m->state.slip[i] * m->state.limit[i] : 0.0;
        m->plane->rate[i] = 0.0;
    }
    for (size_t k = 0; k < m->plane->count; k++) {
        const struct planar_contact *p = &m->plane->contact[k];
        if (slides_in_plane(m, p) && p->begins == SLIDES_ON) {
            const double *limit = p->limit, *a = acc + p->at;
            const double x[2] = {limit[0] * tribo_stick_slip_velocity(m, sys, p->at, y),
                                 limit[1] * tribo_stick_slip_velocity(m, sys, p->at + 1, y)};
            const double size = length(x), n[2] = {x[0] / size, x[1] / size};
            const double turn = (n[0] * limit[1] * a[1] - n[1] * limit[0] * a[0]) / size;
            m->work.lo[p->at] = -limit[0] * n[0];
            m->work.lo[p->at + 1] = -limit[1] * n[1];
            m->plane->rate[p->at] = limit[0] * n[1] * turn;
            m->plane->rate[p->at + 1] = -limit[1] * n[0] * turn;
            fastest = greater(fastest, fabs(turn));
        }
    }
    return fastest;
}

/* Finds forces f [ncontact] at accelerations a without friction: work.lo of sliding contacts, Coulomb's law with limits work.hi
 * for the others. Sets work.v = a + R f. */
static int solve(struct stick_slip *m, const tribo_system *sys, const double *a, double *f)
{
    memset(m->work.rate, 0, sys->ndof * sizeof *m->work.rate);
    memcpy(m->work.v, a, m->constant.contacts * sizeof *a);
    tribo_matrix_multiply_add(&sys->response, 1.0, m->work.lo, m->work.rate);
    tribo_matrix_multiply_add(&sys->direction, 1.0, m->work.rate, m->work.v);
    int status = tribo_set_limit(m->plane->disc, m->work.hi);
    status = status ? status : tribo_balance(m->plane->disc, m->constant.still, m->work.v, NULL, f);
    if (status) {
        return tribo_system_fail(sys, status, "at t = %.17g: %s", sys->time, tribo_message(m->plane->disc));
    }
    tribo_add(f, 1.0, m->work.lo, m->constant.contacts);
    memset(m->work.rate, 0, sys->ndof * sizeof *m->work.rate);
    memcpy(m->work.v, a, m->constant.contacts * sizeof *a);
    tribo_matrix_multiply_add(&sys->response, 1.0, f, m->work.rate);
    tribo_matrix_multiply_add(&sys->direction, 1.0, m->work.rate, m->work.v);
    return TRIBO_OK;
}

static int find_forces(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    given_forces(m, sys, y, m->constant.still);
    for (size_t i = 0; i < m->constant.contacts; i++) {
        m->work.hi[i] = m->state.slip[i] == TRIBO_SLIP_STUCK ? m->state.limit[i] : 0.0;
    }
    return solve(m, sys, m->work.a, m->state.force);
}

/* ------------------------------------------------------------------------------------------------------- letting go */

/* |f/limit| of a planar contact; *noise = its rounding. */
static double share(const struct stick_slip *m, const struct planar_contact *p, const double *f, double *noise)
{
    const double part[2] = {f[p->at] / p->limit[0], f[p->at + 1] / p->limit[1]};
    *noise = greater(m->noise.allowance[p->at], m->noise.allowance[p->at + 1]) / lesser(p->limit[0], p->limit[1]);
    return length(part);
}

/* 1 if a planar contact accelerates, by work.v, against force f by more than rounding. */
static int leaves(const struct stick_slip *m, const struct planar_contact *p, const double *f)
{
    double against = 0.0, size = 0.0, noise = 0.0;
    for (size_t d = 0; d < 2; d++) {
        against -= f[p->at + d] * m->work.v[p->at + d];
        noise += fabs(f[p->at + d]) * m->noise.acceleration[p->at + d];
        size += fabs(f[p->at + d]);
    }
    return size > 0.0 && against > noise;
}

/* Lets contact p slide against its force. */
static void let_go_in_plane(struct stick_slip *m, struct planar_contact *p, int begins)
{
    double part[2] = {m->state.force[p->at] / p->limit[0], m->state.force[p->at + 1] / p->limit[1]};
    const double size = length(part);
    set_slip(m, p, TRIBO_SLIP_PLANE);
    p->begins = begins;
    p->now = 0.0;
    for (size_t d = 0; d < 2; d++) {
        p->direction[d] = -part[d] / size;
        m->state.force[p->at + d] = -p->limit[d] * p->direction[d];
    }
}

/* 1 if scalar contact i accelerates against force f by more than rounding. */
static int leaves_line(const struct stick_slip *m, size_t i, const double *f)
{
    return f[i] != 0.0 && (f[i] > 0.0 ? -m->work.v[i] : m->work.v[i]) > m->noise.acceleration[i];
}

static void let_go_line(struct stick_slip *m, size_t i)
{
    tribo_stick_slip_set(m, i, m->state.force[i] > 0.0 ? TRIBO_SLIP_BACK : TRIBO_SLIP_FORTH);
    m->state.force[i] = -m->state.slip[i] * m->state.limit[i];
}

static int on_line(const struct stick_slip *m, size_t i)
{
    return !m->plane->in_plane[i] && m->state.slip[i] == TRIBO_SLIP_STUCK;
}

/* Lets contacts at rest slide whose force is at its limit and that accelerate; marks those in state.tied that do not
 * accelerate, and returns their number. */
static size_t break_away(struct stick_slip *m)
{
    size_t ties = 0;
    for (size_t i = 0; i < m->constant.contacts; i++) {
        const double room = m->state.limit[i] - fabs(m->state.force[i]);
        m->state.tied[i] = (signed char)(on_line(m, i) && (room <= m->noise.allowance[i] || i == m->state.reached));
        if (m->state.tied[i] && leaves_line(m, i, m->state.force)) {
            m->state.tied[i] = 0;
            let_go_line(m, i);
        }
        ties += (size_t)m->state.tied[i];
    }
    for (size_t k = 0; k < m->plane->count; k++) {
        struct planar_contact *p = &m->plane->contact[k];
        double noise;
        const double part = share(m, p, m->state.force, &noise);
        m->state.tied[p->at] =
            (signed char)(m->state.slip[p->at] == TRIBO_SLIP_STUCK && (part >= 1.0 - noise || p->at == m->state.reached));
        if (m->state.tied[p->at] && leaves(m, p, m->state.force)) {
            m->state.tied[p->at] = 0;
            let_go_in_plane(m, p, BY_ACCELERATION);
        }
        ties += (size_t)m->state.tied[p->at];
    }
    return ties;
}

/* Sets work.hi = limits of a moment later: for tied contacts at most their forces; full ones for contacts that begin to
 * slide. */
static void set_limits_ahead(struct stick_slip *m)
{
    for (size_t i = 0; i < m->constant.contacts; i++) {
        m->work.hi[i] = m->state.slip[i] != TRIBO_SLIP_STUCK ? 0.0
                        : m->state.tied[i]                   ? lesser(m->state.limit[i], fabs(m->state.force[i]))
                                                             : m->state.limit[i];
    }
    for (size_t k = 0; k < m->plane->count; k++) {
        const struct planar_contact *p = &m->plane->contact[k];
        double noise;
        const double part = m->state.tied[p->at] ? lesser(share(m, p, m->state.force, &noise), 1.0) : 1.0;
        for (size_t d = 0; d < 2 && (m->state.slip[p->at] == TRIBO_SLIP_STUCK || p->begins != SLIDES_ON); d++) {
            m->work.hi[p->at + d] = part * p->limit[d];
        }
    }
}

/* 1 if the force that holds planar contact p a moment later, at forces f and accelerations work.v, is beyond the tangent to the
 * limit curve at its present force. A force that turns along the curve is not: curvature is of second order. */
static int goes_beyond(const struct stick_slip *m, const tribo_system *sys, const struct planar_contact *p, const double *f)
{
    double r[2][2] = {{0.0}}, beyond = 0.0, noise = 0.0;
    const struct matrix *j = &sys->direction;
    for (size_t d = 0; d < 2; d++) {
        for (size_t e = j->first[p->at + d]; e < j->first[p->at + d + 1]; e++) {
            r[d][0] += j->val[e] * tribo_matrix_get(&sys->response, j->col[e], p->at);
            r[d][1] += j->val[e] * tribo_matrix_get(&sys->response, j->col[e], p->at + 1);
        }
    }
    const double *v = m->work.v + p->at, determinant = r[0][0] * r[1][1] - r[0][1] * r[1][0];
    const double lacks[2] = {(r[0][1] * v[1] - r[1][1] * v[0]) / determinant, (r[1][0] * v[0] - r[0][0] * v[1]) / determinant};
    for (size_t d = 0; d < 2; d++) {
        const double part = m->state.force[p->at + d] / (p->limit[d] * p->limit[d]);
        beyond += part * (f[p->at + d] + lacks[d] - m->state.force[p->at + d]);
        noise += fabs(part) * m->noise.allowance[p->at + d];
    }
    return beyond > noise;
}

/* Lets tied contacts slide by the forces of a moment later. */
static int look_ahead_in_plane(struct stick_slip *m, tribo_system *sys, const double *y)
{
    tribo_stick_slip_contact_accelerations(sys, tribo_stick_slip_find_acceleration(m, sys), 1, m->work.f);
    const double turn = given_forces(m, sys, y, m->work.f),
                 h = lesser(m->constant.horizon, turn > 0.0 ? TURN / turn : m->constant.horizon);
    tribo_stick_slip_find_rate(m, sys, y);
    tribo_stick_slip_contact_accelerations(sys, m->work.rate, 2, m->work.v);
    for (size_t i = 0; i < m->constant.contacts; i++) {
        m->plane->ahead[i] = m->work.a[i] + h * m->work.v[i];
        m->work.lo[i] += h * m->plane->rate[i];
    }
    set_limits_ahead(m);
    const int status = solve(m, sys, m->plane->ahead, m->work.f);
    for (size_t i = 0; !status && i < m->constant.contacts; i++) {
        if (m->state.tied[i] && on_line(m, i) && leaves_line(m, i, m->work.f)) {
            let_go_line(m, i);
        }
    }
    for (size_t k = 0; !status && k < m->plane->count; k++) {
        struct planar_contact *p = &m->plane->contact[k];
        if (m->state.tied[p->at] && leaves(m, p, m->work.f) && goes_beyond(m, sys, p, m->work.f)) {
            let_go_in_plane(m, p, BY_FORCE);
        }
    }
    return status;
}

int tribo_planar_slip_decide(struct stick_slip *m, tribo_system *sys, double t, double *y)
{
    for (size_t k = 0; k < m->plane->count; k++) {
        m->plane->contact[k].before = m->plane->contact[k].now;
    }
    tribo_stick_slip_begin_decision(m, sys, t);
    int status = find_resting(m, sys, y);
    if (!status) {
        tribo_stick_slip_find_free(m, sys, t, y);
        status = find_forces(m, sys, y);
    }
    if (status) {
        return status;
    }
    tribo_stick_slip_forget_gains(m);
    tribo_stick_slip_find_gains(m, sys, y);
    const size_t ties = break_away(m);
    status = ties ? look_ahead_in_plane(m, sys, y) : TRIBO_OK;
    m->state.reached = m->constant.contacts;
    memset(m->state.tied, 0, m->constant.contacts);
    status = status ? status : tribo_stick_slip_find_holds(m, sys);
    return status ? status : check_holds(m, sys);
}
