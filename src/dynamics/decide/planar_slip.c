/* SPDX-License-Identifier: BSD-3-Clause */
/* Decides, at an instant, which contacts stick and which slide, if there are planar contacts:
 *
 *     contacts whose velocity is nothing beside the tolerance are at rest
 *     find the forces of those at rest, others sliding as they do: min 1/2 f'Rf + a'f over intervals, discs, and ellipses
 *     contacts at rest slide if their force is at its limit and they accelerate by more than rounding, against that force
 *     of others that are at their limit: solve for a moment later, and those that accelerate then slide from here on
 *     an independent set of those at rest holds
 *
 * The problem is convex: each solution decides about all contacts together. With static limits the limits at rest are those in
 * the first round; a contact that accelerates there does not slide yet: its limit is that to slide, and all that began to slide
 * are at rest again, until no static limit is lost. */
#include "stick_slip.h"
#include "common/layout.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A speed below this part of the tolerance is rest. */
#define NOTHING 0.1

/* Rounding of a speed, in parts of the largest one so far. */
#define ROUNDING 1e-14

/* Speeds below this part of the largest one have a direction that is partly rounding. */
#define LOST 1e-12

/* A direction is known that turns by at most TURNS_LEFT, in radians, as the speed falls by SETTLED to the part LOST. */
#define SETTLED 1e3
#define TURNS_LEFT 1e-4

/* Largest turn of a sliding force, in radians, in the moment looked ahead. */
#define TURN 0.02

void tribo_planar_slip_free(struct planar_slip *p)
{
    if (p) {
        tribo_destroy(p->disc);
        free(p->contact);
        free(p);
    }
}

/* --------------------------------------------------------------------------------------------------------- contacts */

static double length(const double *x)
{
    return hypot(x[0], x[1]);
}

static void set_slip(struct stick_slip *m, const struct planar_contact *p, signed char slip)
{
    tribo_stick_slip_set(m, p->at, slip);
    tribo_stick_slip_set(m, p->at + 1, slip);
}

/* 1 if the limit of contact i is not the same at all times. */
static int limit_varies(const tribo_system *sys, size_t i)
{
    return tribo_normals_follower(sys, i) || tribo_system_varies_limit(sys, i, i);
}

/* Finds the planar contacts, which slide at first: whether they are at rest is seen by their speed alone. Returns a status. */
static int create_plane(struct stick_slip *m, const tribo_system *sys)
{
    const size_t c = sys->ncontact;
    struct planar_slip *p = m->plane = calloc(1, sizeof *p);
    if (!p || !ALLOCATE(ARRAY(p->contact, c), ARRAY(p->in_plane, c), ARRAY(p->rate, c), ARRAY(p->ahead, c), ARRAY(p->error, c))) {
        return TRIBO_ERR_MEMORY;
    }
    int status = tribo_clone(sys->contacts, &p->disc);
    status = status ? status : tribo_set_sharing(p->disc, TRIBO_SHARE_PREVIOUS);
    status = status ? status : tribo_set_law(p->disc, TRIBO_COULOMB);
    status = status ? status : tribo_system_find_pairs(sys, p->in_plane);
    for (size_t i = 0; !status && i < c; i++) {
        /* directions of planar contacts stand in pairs; one without both limits is scalar, or open */
        const double *limit = m->state.limit + i, *r = m->constant.diagonal + i;
        const int pair = p->in_plane[i] == PAIR_FIRST, varies = pair && (limit_varies(sys, i) || limit_varies(sys, i + 1)),
                  slides = varies || (pair && limit[0] > 0.0 && limit[1] > 0.0);
        if (pair && !slides) {
            p->in_plane[i] = p->in_plane[i + 1] = PAIR_NONE;
        }
        if (slides) {
            const double weight[2] = {varies ? 1.0 : limit[0], varies ? 1.0 : limit[1]};
            p->contact[p->count++] = (struct planar_contact){.at = i,
                                                             .size = 2,
                                                             .weight = {weight[0], weight[1]},
                                                             .varies = varies,
                                                             .brake = greater(weight[0] * r[0], weight[1] * r[1]),
                                                             .now = HUGE_VAL};
            set_slip(m, &p->contact[p->count - 1], m->state.limit[i] > 0.0 ? TRIBO_SLIP_PLANE : TRIBO_SLIP_OPEN);
        }
        i += (size_t)pair;
    }
    p->all = p->count;
    for (size_t i = 0; !status && i < c; i++) {
        if (!p->in_plane[i]) {
            p->contact[p->all++] = (struct planar_contact){.at = i, .size = 1, .weight = {1.0}};
        }
    }
    return status;
}

int tribo_planar_slip_start(struct stick_slip *m, const tribo_system *sys, int continues)
{
    const size_t planar = tribo_system_planar(sys);
    if (planar && continues) {
        return TRIBO_OK;
    }
    tribo_planar_slip_free(m->plane);
    m->plane = NULL;
    if (!planar || m->constant.pairs) { /* all planar contacts of the system, if there are pairs */
        return TRIBO_OK;
    }
    /* directions turn by forces that do not depend on the speed */
    const size_t i = tribo_system_first_dropping(sys, 1);
    if (i < m->constant.contacts) {
        return tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                           "method event knows no limits that fall with the speed beside planar contacts: contact %zu has "
                           "ratio[%zu] = %g: take moreau/fixed",
                           i, i, m->limits.ratio[i]);
    }
    const int status = create_plane(m, sys);
    for (size_t k = 0; !status && k < m->plane->count; k++) {
        const size_t at = m->plane->contact[k].at;
        if (tribo_system_varies_limit(sys, at, at + 1)) {
            return tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                               "the limits of both directions of the planar contact %zu change with time, and differ: method "
                               "event takes the same limit in both: take moreau/fixed",
                               at);
        }
    }
    return status ? tribo_error(sys->message, status, "%s, of planar contacts", tribo_strerror(status)) : TRIBO_OK;
}

/* ----------------------------------------------------------------------------------------------------------- at rest */

/* Sets contacts at rest that slide with a speed within rounding, or below NOTHING times the tolerance and not growing. A speed
 * that grows is kept: beside a creeping contact the first steps of a slide are slow. Returns the number set. */
static size_t stop_in_plane(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    size_t found = 0;
    for (size_t k = 0; k < m->plane->count; k++) {
        struct planar_contact *p = &m->plane->contact[k];
        double v[2];
        p->stop = 0.0;
        for (size_t d = 0; d < 2; d++) {
            v[d] = tribo_stick_slip_find_velocity(m, sys, p->at + d, y);
            const double brake = product(p->limit[d], m->constant.diagonal[p->at + d]);
            p->stop = greater(p->stop, brake > 0.0 ? quotient(fabs(v[d]), brake) : TRIBO_FAR);
        }
        p->now = length(v);
        p->most = greater(p->most, p->now);
        for (size_t d = 0; p->now > LOST * p->most && d < 2; d++) {
            p->way[d] = p->weight[d] * v[d] / hypot(p->weight[0] * v[0], p->weight[1] * v[1]);
            p->settled[d] = p->now > SETTLED * LOST * p->most ? p->way[d] : p->settled[d];
        }
        p->begins = SLIDES_ON;
        const double noise =
            greater(m->noise.factor * (m->noise.velocity[p->at] + m->noise.velocity[p->at + 1]), ROUNDING * p->most);
        const double nothing = NOTHING * (m->constant.abstol + m->constant.reltol * p->most);
        if (tribo_slides_in_plane(m, p) && (p->now <= noise || (p->now <= nothing && p->now <= p->before))) {
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
            return tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                               "at t = %.17g contact %zu rests by what others hold: method event knows no redundant "
                               "contacts at rest where some are planar",
                               sys->loads.time, i);
        }
    }
    return TRIBO_OK;
}

int tribo_planar_slip_find_resting(struct stick_slip *m, const tribo_system *sys, double *y)
{
    int status;
    for (size_t k = 0; k < m->plane->all; k++) {
        struct planar_contact *p = &m->plane->contact[k];
        const struct follower *f = tribo_normals_follower(sys, p->at);
        const int rests = f && m->state.rests[f->normal];
        p->before = p->now;
        for (size_t d = 0; d < p->size; d++) {
            p->limit[d] = m->state.limit[p->at + d];
        }
        p->lag = p->limit[0] > 0.0 ? 0 : m->state.limit_rate[p->at] > 0.0 && !rests ? 1 : 2;
    }
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
        m->plane->rate[i] = tribo_slides(m->state.slip[i]) ? -m->state.slip[i] * m->state.limit_rate[i] : 0.0;
    }
    for (size_t k = 0; k < m->plane->count; k++) {
        const struct planar_contact *p = &m->plane->contact[k];
        if (tribo_slides_in_plane(m, p) && p->begins == SLIDES_ON) {
            const double *limit = p->limit, *weight = p->weight, *rise = m->state.limit_rate + p->at, *a = acc + p->at;
            const double x[2] = {weight[0] * tribo_stick_slip_velocity(m, sys, p->at, y),
                                 weight[1] * tribo_stick_slip_velocity(m, sys, p->at + 1, y)};
            const double size = length(x), n[2] = {x[0] / size, x[1] / size};
            const double turn = (n[0] * weight[1] * a[1] - n[1] * weight[0] * a[0]) / size;
            m->work.lo[p->at] = -limit[0] * n[0];
            m->work.lo[p->at + 1] = -limit[1] * n[1];
            m->plane->rate[p->at] = limit[0] * n[1] * turn - rise[0] * n[0];
            m->plane->rate[p->at + 1] = -limit[1] * n[0] * turn - rise[1] * n[1];
            fastest = greater(fastest, fabs(turn));
        }
    }
    return fastest;
}

void tribo_planar_slip_forces(const struct stick_slip *m, const tribo_system *sys, const double *y, double *force)
{
    for (size_t k = 0; k < m->plane->count; k++) {
        const struct planar_contact *p = &m->plane->contact[k];
        const double x[2] = {p->weight[0] * tribo_stick_slip_velocity(m, sys, p->at, y),
                             p->weight[1] * tribo_stick_slip_velocity(m, sys, p->at + 1, y)};
        for (size_t d = 0; d < 2 && tribo_slides_in_plane(m, p); d++) {
            const double way = length(x) > LOST * p->most * greater(p->weight[0], p->weight[1]) ? x[d] / length(x) : p->way[d];
            force[p->at + d] = -m->state.limit[p->at + d] * way;
        }
    }
}

size_t tribo_stick_slip_uncertain(const struct stick_slip *m)
{
    for (size_t k = 0; m->plane && k < m->plane->count; k++) {
        const struct planar_contact *p = &m->plane->contact[k];
        const double turns = fabs(p->way[0] * p->settled[1] - p->way[1] * p->settled[0]);
        if (tribo_slides_in_plane(m, p) && p->now <= LOST * p->most && turns > TURNS_LEFT) {
            return p->at;
        }
    }
    return m->constant.contacts;
}

double tribo_stick_slip_excess(const struct stick_slip *m, size_t i, double lowest)
{
    size_t k = 0;
    while (k < m->plane->count && m->plane->contact[k].at != i) {
        k++;
    }
    const double blunt = k < m->plane->count ? m->plane->contact[k].blunt : 0.0;
    return blunt > 0.0 ? sqrt(2.0 * blunt * greater(lowest, 0.0)) : lowest;
}

void tribo_stick_slip_turn(const struct stick_slip *m, const tribo_system *sys, const double *y, const double *times, double *row)
{
    for (size_t k = 0; m->plane && k < m->plane->count; k++) {
        const struct planar_contact *p = &m->plane->contact[k];
        const double *limit = m->state.limit + p->at;
        const double v[2] = {p->weight[0] * tribo_stick_slip_velocity(m, sys, p->at, y),
                             p->weight[1] * tribo_stick_slip_velocity(m, sys, p->at + 1, y)};
        const double size = length(v);
        if (tribo_slides_in_plane(m, p) && size > 0.0) {
            const double aside[2] = {-v[1] / size, v[0] / size};
            const double push = limit[0] * aside[0] * times[p->at] + limit[1] * aside[1] * times[p->at + 1];
            for (size_t d = 0; d < 2; d++) {
                tribo_matrix_add_row(&sys->direction, p->at + d, -push * aside[d] * p->weight[d] / size, row);
            }
        }
    }
}

void tribo_stick_slip_hold_by_forces(const struct stick_slip *m, size_t i, const double *force, double *by_force,
                                     double *by_limit)
{
    const double ratio = m->limits.ratio[i];
    for (size_t k = 0; m->plane && k < m->plane->count; k++) {
        const struct planar_contact *p = &m->plane->contact[k];
        for (size_t d = 0; p->at == i && d < 2; d++) {
            by_force[i + d] = -2.0 * p->half * force[i + d] / (p->weight[d] * p->weight[d]);
            *by_limit = p->varies ? 2.0 * p->half * ratio * ratio * m->state.limit[i] : 0.0;
        }
    }
}

/* Finds forces f [ncontact] at accelerations a without friction: work.lo of sliding contacts, Coulomb's law with limits work.hi
 * for the others. Sets work.v = a + R f. */
static int solve_discs(struct stick_slip *m, const tribo_system *sys, const double *a, double *f)
{
    tribo_stick_slip_accelerate(m, sys, a, m->work.lo, m->work.v);
    int status = tribo_set_limit(m->plane->disc, m->work.hi);
    status = status ? status : tribo_balance(m->plane->disc, m->constant.still, m->work.v, NULL, f);
    if (status) {
        return tribo_error(sys->message, status, "at t = %.17g: %s", sys->loads.time, tribo_message(m->plane->disc));
    }
    tribo_add(f, 1.0, m->work.lo, m->constant.contacts);
    tribo_stick_slip_accelerate(m, sys, a, f, m->work.v);
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------- letting go */

/* |f/limit|, 1 for a limit of 0; *noise = its rounding. */
static double share(const struct stick_slip *m, const struct planar_contact *p, const double *f, double *noise)
{
    double sum = p->lag > 0 ? 1.0 : 0.0, allowance = 0.0, least = HUGE_VAL;
    for (size_t d = 0; p->lag == 0 && d < p->size; d++) {
        sum = hypot(sum, f[p->at + d] / p->limit[d]);
        allowance = greater(allowance, m->noise.allowance[p->at + d]);
        least = lesser(least, p->limit[d]);
    }
    *noise = allowance / least;
    return sum;
}

/* 1 if a contact accelerates, by work.v, against force f, or without a force, by more than rounding. */
static int accelerates(const struct stick_slip *m, const struct planar_contact *p, const double *f)
{
    const int pushes = tribo_largest(f + p->at, p->size) > 0.0;
    double against = 0.0, noise = 0.0;
    for (size_t i = p->at; i < p->at + p->size; i++) {
        const double part = pushes ? f[i] : -m->work.v[i];
        against -= part * m->work.v[i];
        noise += fabs(part) * m->noise.acceleration[i];
    }
    return against > noise;
}

/* Lets a contact slide against its force; by work.v at a limit of 0. */
static void let_slide_against(struct stick_slip *m, struct planar_contact *p, int begins)
{
    double *f = m->state.force + p->at, part[2] = {0.0};
    for (size_t d = 0; d < p->size; d++) {
        part[d] = p->lag == 0 ? f[d] / p->limit[d] : -p->weight[d] * m->work.v[p->at + d];
    }
    if (p->size == 1) {
        tribo_stick_slip_set(m, p->at, part[0] > 0.0 ? TRIBO_SLIP_BACK : TRIBO_SLIP_FORTH);
        f[0] = -m->state.slip[p->at] * p->limit[0];
        return;
    }
    const double size = length(part);
    set_slip(m, p, TRIBO_SLIP_PLANE);
    p->begins = begins;
    p->now = 0.0;
    for (size_t d = 0; d < 2; d++) {
        p->direction[d] = p->way[d] = p->settled[d] = -part[d] / size;
        f[d] = -p->limit[d] * p->direction[d];
    }
}

/* 1 if the force that holds planar contact p a moment h later, at forces f and accelerations work.v, is beyond the tangent to the
 * limit curve at its present force. A force that turns along the curve is not: curvature is of second order. */
static int goes_beyond(const struct stick_slip *m, const tribo_system *sys, const struct planar_contact *p, const double *f,
                       double h)
{
    double r[2][2], beyond = 0.0, noise = 0.0;
    for (size_t d = 0; d < 2; d++) {
        r[d][0] = tribo_system_delassus(sys, p->at + d, p->at);
        r[d][1] = tribo_system_delassus(sys, p->at + d, p->at + 1);
    }
    const double *v = m->work.v + p->at, determinant = r[0][0] * r[1][1] - r[0][1] * r[1][0];
    const double lacks[2] = {(r[0][1] * v[1] - r[1][1] * v[0]) / determinant, (r[1][0] * v[0] - r[0][0] * v[1]) / determinant};
    for (size_t d = 0; p->lag == 0 && d < 2; d++) {
        const double force = m->state.force[p->at + d], part = force / (p->limit[d] * p->limit[d]);
        const double rises = h * m->state.stick_rate[p->at + d] / p->limit[d] * force;
        beyond += part * (f[p->at + d] + lacks[d] - force - rises);
        noise += fabs(part) * m->noise.allowance[p->at + d];
    }
    return p->lag > 0 || beyond > noise;
}

/* Lets tied contacts slide by the forces of a moment later. work.v: accelerations. Returns a status. */
static int look_ahead_in_plane(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    const struct planar_contact *end = m->plane->contact + m->plane->all;
    const double turn = given_forces(m, sys, y, m->work.v),
                 h = lesser(m->constant.horizon, turn > 0.0 ? TURN / turn : m->constant.horizon);
    tribo_stick_slip_find_rate(m, sys, y);
    tribo_stick_slip_contact_accelerations(sys, m->work.rate, 2, m->work.v);
    for (size_t i = 0; i < m->constant.contacts; i++) {
        m->plane->ahead[i] = m->work.a[i] + h * m->work.v[i];
        m->work.lo[i] += h * m->plane->rate[i];
    }
    for (const struct planar_contact *p = m->plane->contact; p < end; p++) {
        /* limits of a moment later: of tied contacts at most their forces; the full limit where sliding in a plane begins */
        const int counts = m->state.slip[p->at] == TRIBO_SLIP_STUCK || p->begins != SLIDES_ON;
        double noise;
        const double part = !counts ? 0.0 : m->state.tied[p->at] ? lesser(share(m, p, m->state.force, &noise), 1.0) : 1.0;
        for (size_t d = 0; d < p->size; d++) {
            const double rise =
                m->state.slip[p->at] == TRIBO_SLIP_STUCK ? m->state.stick_rate[p->at + d] : m->state.limit_rate[p->at + d];
            m->work.hi[p->at + d] = greater(part * p->limit[d] + (counts ? h * rise : 0.0), 0.0);
        }
    }
    const int status = solve_discs(m, sys, m->plane->ahead, m->work.f);
    for (struct planar_contact *p = m->plane->contact; !status && p < end; p++) {
        if (m->state.tied[p->at] && accelerates(m, p, m->work.f) && (p->size == 1 || goes_beyond(m, sys, p, m->work.f, h))) {
            let_slide_against(m, p, BY_FORCE);
        }
    }
    return status;
}

/* Lets planar or scalar contact p break away: its limit is that to slide, and contacts that rested are at rest again. */
static void let_break(struct stick_slip *m, struct planar_contact *p)
{
    for (size_t d = 0; d < p->size; d++) {
        tribo_limits_set_stick(m, p->at + d, 1.0);
    }
    m->work.limit_lost = 1;
}

/* One round: finds the forces, and contacts that slide or, with work.limit_lost = 1, lose static limits. *ties = number of
 * contacts at their limits that a moment later decides about. Returns a status. */
static int settle_once(struct stick_slip *m, const tribo_system *sys, const double *y, size_t *ties)
{
    struct slip_state *s = &m->state;
    struct planar_contact *reached = NULL;
    size_t changes = 0;
    *ties = 0;
    m->work.limit_lost = 0;
    for (size_t i = 0; i < m->constant.contacts; i++) {
        m->work.hi[i] = s->slip[i] == TRIBO_SLIP_STUCK ? s->stick[i] : 0.0;
    }
    given_forces(m, sys, y, m->constant.still);
    int status = solve_discs(m, sys, m->work.a, s->force);
    if (status) {
        return status;
    }
    tribo_stick_slip_find_gains(m, sys, y);
    for (size_t k = 0; k < m->plane->all; k++) {
        struct planar_contact *const p = m->plane->contact + k;
        /* at its limit; slides if it accelerates, else is tied */
        double noise;
        for (size_t d = 0; s->slip[p->at] == TRIBO_SLIP_STUCK && d < p->size; d++) {
            p->limit[d] = s->stick[p->at + d];
        }
        if (s->slip[p->at] == TRIBO_SLIP_STUCK && (share(m, p, s->force, &noise) >= 1.0 - noise || p->at == s->reached)) {
            const int leaves = accelerates(m, p, s->force), drops = tribo_drops(m, p->at);
            s->tied[p->at] = !leaves && !drops;
            *ties += (size_t)s->tied[p->at];
            reached = !leaves && drops && p->at == s->reached ? p : reached;
            changes += (size_t)leaves;
            if (leaves && drops) {
                let_break(m, p);
            } else if (leaves) {
                let_slide_against(m, p, BY_ACCELERATION);
            }
        }
    }
    if (reached && !changes) { /* rounding of others hides its acceleration, but not the force that ended the phase */
        let_break(m, reached);
    }
    return TRIBO_OK;
}

int tribo_planar_slip_settle(struct stick_slip *m, const tribo_system *sys, const double *y)
{
    struct slip_state *s = &m->state;
    size_t ties = 0;
    int status = settle_once(m, sys, y, &ties);
    while (!status && m->work.limit_lost) {
        for (size_t i = 0; i < m->constant.contacts; i++) {
            tribo_stick_slip_set(m, i, s->rested[i] ? TRIBO_SLIP_STUCK : s->slip[i]);
        }
        status = settle_once(m, sys, y, &ties);
    }
    status = status || !ties ? status : look_ahead_in_plane(m, sys, y);
    memset(s->tied, 0, m->constant.contacts);
    for (size_t k = 0; m->limits.differ && k < m->plane->all; k++) {
        struct planar_contact *const p = m->plane->contact + k;
        for (size_t d = 0; d < p->size; d++) {
            /* a contact that broke away, and is held by others after all, has its static limit again */
            tribo_limits_set_stick(m, p->at + d, m->limits.ratio[p->at + d]);
            p->limit[d] = s->limit[p->at + d];
        }
    }
    status = status ? status : tribo_stick_slip_find_holds(m, sys);
    return status ? status : check_holds(m, sys);
}
