/* SPDX-License-Identifier: BSD-3-Clause */
#include "period_map.h"
#include "common/layout.h"
#include "common/real.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* m->least over the least motion by loads and bases: smaller motions are rounding. */
#define LEAST_SIZE 1e-4

/* Number of perturbations that decide whether contacts stop at one time by coincidence. */
#define PROBES 4

/* Least frequency of modes in the norm, also without stiffness, over the frequency of the period. */
#define LEAST_OMEGA 0.1

/* Sizes in [1/LARGE, LARGE] need no scale: squares of these and of far smaller or larger sizes neither underflow nor overflow. */
#define LARGE 1e100

/* Relative change of limits. */
#define NUDGE 1e-7

/* Force of a touch that counts, relative to the largest force of the contact as it begins to slide, and to the terms of a limit
 * that follows. */
#define TOUCH 1e-2

/* The span is followed from this part of it on, where no touch is expected by symmetry. Phases shorter than INSTANT of the
 * period do not count: contacts slide between two events at one time. */
#define LATER 0.381966011250105
#define INSTANT 1e-8

/* -------------------------------------------------------------------------------------------------------------- integration */

static int phase_ends(struct company *company, double tau, double t, const double *y)
{
    struct period_map *m = (struct period_map *)company;
    tribo_energy_norm_of(&m->norm, 1, y, m->x);
    m->size = greater(m->size, tribo_energy_length(m->x, m->n));
    return tribo_variation_phase(&m->variation, tau, t, y);
}

static void event_decided(struct company *company)
{
    tribo_variation_event(&((struct period_map *)company)->variation);
}

static const struct company with_derivative = {phase_ends, event_decided};

/* Integrates m->y from t to end without the driver's observer; the driver's next run is a new one. Returns a status. */
static int period_map_integrate(struct period_map *m, double t, double end, struct company *company)
{
    tribo_driver *drv = m->drv;
    int (*const seen)(const tribo_moment *, void *) = drv->seen;
    const size_t evaluations = m->sys->evaluations;
    const size_t halves = (size_t)greater(round(2.0 * (end - t) / m->period), 1.0);
    m->y[m->n] = 0.0;
    drv->time = t;
    drv->revision = SIZE_MAX;
    int status = tribo_driver_check(drv, m->y);
    if (status) {
        return status;
    }
    drv->seen = NULL;
    memcpy(drv->state, m->y, (m->n + 1) * sizeof *m->y);
    m->events->company = company;
    m->events->sharp = 1;
    status = tribo_events_advance(m->events, drv, &t, end, m->y, 0);
    m->events->company = NULL;
    m->events->sharp = 0;
    drv->seen = seen;
    drv->evaluations += m->sys->evaluations - evaluations;
    m->halves += halves;
    return status ? status : tribo_driver_check(drv, m->y);
}

int tribo_period_map_replay(struct period_map *m, const double *y, double length, struct company *company)
{
    const int status = m->drv->at_work->open(m->drv, &m->events);
    memcpy(m->y, y, m->n * sizeof *y);
    return status ? status : period_map_integrate(m, m->t, m->t + length, company);
}

int tribo_period_map_march(struct period_map *m, double time, size_t times, struct company *company, double *x)
{
    int status = TRIBO_OK;
    tribo_energy_norm_state(&m->norm, 1, x, m->y);
    for (size_t k = 0; !status && k < times; k++) {
        status = period_map_integrate(m, m->t, m->t + time, company);
    }
    tribo_energy_norm_of(&m->norm, 1, m->y, x);
    return status;
}

void tribo_ring_turn(const struct period_map *m, size_t step, double sign, size_t columns, const double *y, double *to)
{
    const struct ring *r = &m->ring;
    const size_t block[] = {m->sys->ndof, m->sys->ndof, m->n - 2 * m->sys->ndof};
    for (size_t b = 0; b < 3; y += block[b] * columns, to += block[b] * columns, b++) {
        const size_t values = block[b] / r->sectors * columns;
        for (size_t i = 0; i < r->sectors * values; i++) {
            const size_t from = i + step * values, wrap = r->sectors * values;
            to[i] = from < wrap ? sign * y[from] : (r->alternates ? -sign : sign) * y[from - wrap];
        }
    }
}

/* x [n][columns] = coordinates of states y, in a ring turned back, or of -y if odd. */
static void find_image(const struct period_map *m, int odd, size_t columns, const double *y, double *x)
{
    if (m->ring.sectors) {
        tribo_ring_turn(m, m->ring.step, m->ring.reversed ? -1.0 : 1.0, columns, y, m->turned);
        y = m->turned;
    }
    tribo_energy_norm_of(&m->norm, columns, y, x);
    for (size_t i = 0; odd && i < m->n * columns; i++) {
        x[i] = -x[i];
    }
}

/* Integrates from m->y and sets *p. Returns a status. */
static int follow_state(struct period_map *m, struct point *p)
{
    const size_t n = m->n;
    memcpy(p->y, m->y, n * sizeof *p->y);
    tribo_energy_norm_of(&m->norm, 1, m->y, p->x);
    tribo_variation_begin(&m->variation, m->events, m->probe, m->columns, &p->derivative);
    m->size = greater(m->least, tribo_energy_length(p->x, n));
    int status = period_map_integrate(m, m->t, m->t + m->span, &m->company);
    status = status ? status : tribo_driver_pass(m->drv, m->variation.status);
    if (status) {
        return status;
    }
    m->moved = 1;
    memcpy(p->end, m->y, n * sizeof *p->end);
    find_image(m, m->odd, 1, m->y, p->image);
    p->residual = tribo_energy_distance(p->image, p->x, n);
    p->size = m->size;
    p->odd = m->odd;
    return m->events->motion->keep ? TRIBO_OK : tribo_period_map_matrix(m, p);
}

/* Moves forces of elastic contacts in m->y that are above their limits at m->t to the limits. */
static void lower_springs(struct period_map *m)
{
    if (m->sys->compliance.count) {
        if (m->sys->normals.count) {
            tribo_system_set_time(m->sys, m->t);
            tribo_normals_set(m->sys, m->y, m->y + m->sys->ndof);
        }
        tribo_get_limit(m->sys->contacts, m->limit);
        tribo_compliance_enter(m->sys, m->limit, m->limit + m->sys->ncontact, m->y);
    }
}

/* Sets m->y = the state of coordinates x, corrected for rounding of velocities at contacts that rest since the last integration,
 * and for spring forces above limits. Returns a status. */
static int enter(struct period_map *m, const double *x)
{
    memcpy(m->x, x, m->n * sizeof *x);
    tribo_energy_norm_state(&m->norm, 1, m->x, m->y);
    int status = TRIBO_OK;
    if (m->moved) {
        struct stick_slip *contacts = &m->events->stick_slip;
        const size_t count = m->sys->ncontact, by = m->ring.sectors ? m->ring.step * (count / m->ring.sectors) : 0;
        signed char *before = (signed char *)m->limit;
        memcpy(before, contacts->state.slip, count);
        for (size_t i = 0; by && i < count; i++) { /* a ring turns x back: contact i has the slip of contact i + by */
            tribo_stick_slip_set(contacts, i, before[(i + by) % count]);
        }
        status = by ? tribo_stick_slip_find_holds(contacts, m->sys) : TRIBO_OK;
        tribo_system_set_time(m->sys, m->t);
        memset(contacts->state.base, 0, count * sizeof *contacts->state.base);
        tribo_system_loads(m->sys, DRIVES_BASE, 0, 1.0, contacts->state.base);
        status = status ? status : tribo_stick_slip_hold(contacts, m->sys, contacts->state.base, m->y + m->sys->ndof);
        status = tribo_driver_pass(m->drv, status);
    }
    lower_springs(m);
    return status;
}

int tribo_period_map_follow(struct period_map *m, struct point *p)
{
    const int status = enter(m, p->x);
    return status ? status : follow_state(m, p);
}

int tribo_period_map_later(struct period_map *m, const double *y, double later, struct point *p)
{
    memcpy(m->y, y, m->n * sizeof *y);
    int status = period_map_integrate(m, m->t, m->t + later, NULL);
    m->t += later;
    status = status ? status : follow_state(m, p);
    m->t -= later;
    return status;
}

void tribo_period_map_rate(const struct period_map *m, const double *end, double *rate)
{
    const size_t n = m->sys->ndof;
    memcpy(m->y, end + n, n * sizeof *m->y);
    memcpy(m->y + n, m->variation.acceleration, n * sizeof *m->y);
    tribo_compliance_put(m->sys, m->variation.spring_rate, m->y);
    tribo_energy_norm_of(&m->norm, 1, m->y, rate);
}

int tribo_period_map_apply(struct period_map *m, const struct point *p, double *x)
{
    if (p->derivative.matrix) {
        memcpy(m->x, x, m->n * sizeof *x);
        memset(x, 0, m->n * sizeof *x);
        tribo_multiply_add(m->n, m->n, 1, 1.0, p->derivative.matrix, m->x, x);
        return TRIBO_OK;
    }
    tribo_energy_norm_state(&m->norm, 1, x, m->y);
    const int status = tribo_driver_pass(m->drv, tribo_derivative_apply(&p->derivative, 0, 1, m->y, NULL));
    find_image(m, p->odd, 1, m->y, x);
    return status;
}

/* Where phases are not kept, variation.v are the perturbations after the span. */
int tribo_period_map_matrix(struct period_map *m, struct point *p)
{
    const size_t n = m->n;
    int status = TRIBO_OK;
    if (p->derivative.matrix) {
        return status;
    }
    double *x = p->derivative.matrix = calloc(n * n, sizeof *x), *v = m->variation.v;
    if (!x) {
        return tribo_error(m->drv->message, TRIBO_ERR_MEMORY, "out of memory for %zu perturbation%s", n, plural(n));
    }
    if (m->events->motion->keep) {
        for (size_t i = 0; i < n; i++) {
            x[i * n + i] = 1.0;
        }
        tribo_energy_norm_state(&m->norm, n, x, v);
        status = tribo_driver_pass(m->drv, tribo_derivative_apply(&p->derivative, 0, n, v, NULL));
    }
    find_image(m, p->odd, n, v, x);
    if (status) {
        free(x);
        p->derivative.matrix = NULL;
    }
    return status;
}

void tribo_period_map_turn(struct period_map *m, double *x)
{
    tribo_energy_norm_state(&m->norm, 1, x, m->y);
    find_image(m, 0, 1, m->y, x);
}

int tribo_period_map_complete(struct period_map *m, struct point *p)
{
    if (!p->odd) {
        return TRIBO_OK;
    }
    memcpy(m->y, p->end, m->n * sizeof *m->y);
    const int status = period_map_integrate(m, m->t + m->span, m->t + m->period, NULL);
    tribo_energy_norm_of(&m->norm, 1, m->y, m->x);
    p->residual = tribo_energy_distance(m->x, p->x, m->n);
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- touches
 * An elastic contact touches its limit where the force reaches the limit, and the contact slides in some neighbouring motions,
 * but not in others, as where sliders come to rest in the course of time: the map has no derivative. With limits times 1 - NUDGE
 * and 1 + NUDGE the contact begins to slide at different times in a span. A touch counts if the sums of |forces| at these times
 * differ by more than TOUCH of the usual force of the contact: where a normal only just presses the sums differ by less, and
 * forces are smooth. */

/* Observer of a span. */
struct slides {
    struct company company;
    const struct events *events;
    double instant;
    double *sum, *most;    /* [ncontact] sum and maximum of |forces| as contacts begin to slide */
    unsigned char *before; /* [ncontact] 1: slides in the phase before */
};

static int slides_phase(struct company *company, double tau, double t, const double *y)
{
    struct slides *s = (struct slides *)company;
    const struct stick_slip *m = &s->events->stick_slip;
    (void)t;
    (void)y;
    for (size_t i = 0; tau > s->instant && i < m->constant.contacts; i++) {
        const unsigned char now = tribo_slides(m->state.slip[i]) || m->state.slip[i] == TRIBO_SLIP_PLANE;
        const double force = now && !s->before[i] ? fabs(m->state.force[i]) : 0.0;
        s->sum[i] += force;
        s->most[i] = greater(s->most[i], force);
        s->before[i] = now;
    }
    return TRIBO_OK;
}

/* Sets the limits of elastic contacts to factor times limit [ncontact], and mu of their followers to factor times mu
 * [followers]; the revision of the system stays, and the caller sets factor 1 in the end. Adds to slides, or NULL, what happens
 * within a span from the state y at m->t on. Returns a status, its message on the driver. */
static int count_slides(struct period_map *m, double factor, const double *limit, const double *mu, const double *y,
                        struct slides *slides)
{
    tribo_system *sys = m->sys;
    struct normals *s = &sys->normals;
    for (size_t i = 0; i < sys->ncontact; i++) {
        sys->loads.given_limit[i] = (tribo_is_compliant(&sys->compliance, i) ? factor : 1.0) * limit[i];
    }
    for (size_t k = 0; k < s->followers; k++) {
        s->follower[k].mu = (tribo_is_compliant(&sys->compliance, s->follower[k].contact) ? factor : 1.0) * mu[k];
    }
    tribo_set_limit(sys->contacts, sys->loads.given_limit);
    sys->loads.time = NAN;
    sys->structure += s->followers > 0; /* structures have mu */
    const int status = slides ? m->drv->at_work->open(m->drv, &m->events) : TRIBO_OK;
    if (slides) {
        memcpy(m->y, y, m->n * sizeof *y);
        tribo_system_set_time(sys, m->t);
        lower_springs(m);
    }
    return status || !slides ? status : period_map_integrate(m, m->t, m->t + m->span, &slides->company);
}

int tribo_period_map_find_touch(struct period_map *m, const double *y, int changed, size_t *contact)
{
    tribo_system *sys = m->sys;
    const size_t c = sys->ncontact;
    *contact = c;
    if (!sys->compliance.count || changed) {
        return !sys->compliance.count
                   ? TRIBO_OK
                   : tribo_error(m->drv->message, TRIBO_ERR_STATE,
                                 "the system has elastic contacts, and has changed since the periodic motion was found");
    }
    const double t = m->t;
    double *later = NULL, *limit, *mu;
    struct slides less = {.company = {slides_phase, NULL}, .events = m->events, .instant = INSTANT * m->period}, more = less;
    if (!ALLOCATE(ARRAY(later, m->n + 1), ARRAY(limit, c), ARRAY(mu, sys->normals.followers), ARRAY(less.sum, c),
                  ARRAY(less.most, c), ARRAY(more.sum, c), ARRAY(more.most, c), ARRAY(less.before, c), ARRAY(more.before, c))) {
        return tribo_error(m->drv->message, TRIBO_ERR_MEMORY, "out of memory for the motions beside a motion");
    }
    int status = tribo_period_map_replay(m, y, LATER * m->span, NULL);
    memcpy(later, m->y, m->n * sizeof *later);
    memcpy(limit, sys->loads.given_limit, c * sizeof *limit);
    for (size_t k = 0; k < sys->normals.followers; k++) {
        mu[k] = sys->normals.follower[k].mu;
    }
    m->t += LATER * m->span;
    status = status ? status : count_slides(m, 1.0 - NUDGE, limit, mu, later, &less);
    status = status ? status : count_slides(m, 1.0 + NUDGE, limit, mu, later, &more);
    count_slides(m, 1.0, limit, mu, NULL, NULL);
    m->t = t;
    for (size_t k = 0; !status && k < sys->compliance.count; k++) {
        const size_t i = sys->compliance.contact[k];
        const struct follower *f = tribo_normals_follower(sys, i);
        const struct normal *n = f ? &sys->normals.normal[f->normal] : NULL;
        const double usual = greater(greater(less.most[i], more.most[i]), n ? f->mu * n->stiffness * n->size : 0.0);
        *contact = *contact == c && fabs(less.sum[i] - more.sum[i]) > TOUCH * usual ? i : *contact;
    }
    free(later);
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- preparation */

int tribo_system_is_odd(const tribo_system *sys, double period)
{
    if (sys->normals.count) {
        return 0;
    }
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        const struct harmonic *w = &sys->loads.harmonic[k];
        const double order = round(fabs(w->omega) * period / FULL_TURN);
        if (w->count > 0 && fmod(order, 2.0) != (w->drives == DRIVES_LIMIT ? 0.0 : 1.0)) {
            return 0;
        }
    }
    return 1;
}

/* Returns the least motion by all loads and bases in the norm, from |psi amplitude| with components over max(omega of mode, omega
 * of load); from amplitude/sqrt(R_ii) of bodies that follow a base, and amplitude/(omega sqrt(G_ii)) of stretched springs. */
static double least_motion(struct period_map *m)
{
    const size_t n = m->sys->ndof;
    double size = 0.0;
    for (size_t s = 0; s < 2 * m->sys->loads.harmonics; s++) {
        const struct harmonic *w = &m->sys->loads.harmonic[s / 2];
        const double *amplitude = s % 2 ? w->sine : w->cosine;
        for (size_t d = 0; w->drives == DRIVES_LOAD && d < n; d++) {
            double load = 0.0;
            for (size_t k = 0; k < w->count; k++) {
                load += m->norm.psi[d * n + w->index[k]] * amplitude[k];
            }
            size = hypot(size, load / greater(m->norm.omega[d], fabs(w->omega)));
        }
        for (size_t k = 0; w->drives == DRIVES_BASE && k < w->count; k++) {
            const size_t i = w->index[k];
            const double r = tribo_system_delassus(m->sys, i, i);
            size = r > 0.0 ? hypot(size, amplitude[k] / sqrt(r)) : size;
            if (tribo_is_compliant(&m->sys->compliance, i) && w->omega != 0.0) {
                size = hypot(size, amplitude[k] / (w->omega * sqrt(m->sys->compliance.own[i])));
            }
        }
    }
    return size;
}

int tribo_period_map_prepare(struct period_map *m, double t, double period, const double *y)
{
    m->halves = 0;
    m->turned = m->turned || !m->ring.sectors ? m->turned : calloc(m->n * m->n + 1, sizeof *m->turned);
    int status = m->turned || !m->ring.sectors ? m->drv->at_work->open(m->drv, &m->events)
                                               : tribo_error(m->drv->message, TRIBO_ERR_MEMORY, "out of memory for a ring");
    if (!status && !m->norm.phi) {
        status = tribo_driver_pass(m->drv, tribo_energy_norm_create(&m->norm, m->sys));
        if (status) {
            tribo_energy_norm_free(&m->norm);
        }
    }
    if (status) {
        return status;
    }
    m->t = t;
    m->period = period;
    m->moved = 0;
    m->alternates = tribo_system_is_odd(m->sys, period);
    tribo_period_map_choose(m, m->alternates && !m->ring.sectors);
    tribo_energy_norm_set(&m->norm, m->sys, LEAST_OMEGA * FULL_TURN / period);
    /* size of the motion: the larger of least and the guess y */
    const double least = least_motion(m);
    tribo_energy_norm_of(&m->norm, 1, y, m->x);
    const double size = greater(least, tribo_largest(m->x, m->n));
    if (size > 0.0 && !(size >= 1.0 / LARGE && size <= LARGE)) {
        m->norm.scale = ldexp(1.0, -(int)clamp(logb(size), -1000.0, 1000.0));
    }
    m->least = LEAST_SIZE * (m->norm.scale * least);
    /* probes: n of unit coordinates, or a few, without any symmetry, if phases are kept */
    m->columns = m->events->motion->keep && m->n > PROBES ? PROBES : m->n;
    double *const x = m->variation.v;
    for (size_t i = 0; i < m->n * m->columns; i++) {
        x[i] = m->columns == m->n ? i % (m->n + 1) == 0 : sin(1.0 + (double)(i * i));
    }
    tribo_energy_norm_state(&m->norm, m->columns, x, m->probe);
    return TRIBO_OK;
}

void tribo_period_map_choose(struct period_map *m, int odd)
{
    m->odd = odd;
    m->span = odd ? 0.5 * m->period : m->period / (double)m->ring.parts;
}

/* -------------------------------------------------------------------------------------------------------------- life */

int tribo_period_map_create(struct period_map *m, tribo_driver *drv)
{
    const size_t n = tribo_system_energy(drv->sys);
    *m = (struct period_map){.company = with_derivative, .drv = drv, .sys = drv->sys, .n = n, .ring = {.parts = 1}};
    return ALLOCATE(ARRAY(m->y, n + 1), ARRAY(m->x, n), ARRAY(m->probe, n * n), ARRAY(m->limit, 2 * drv->sys->ncontact)) &&
           tribo_variation_create(&m->variation, drv->sys, n);
}

void tribo_period_map_free(struct period_map *m)
{
    tribo_energy_norm_free(&m->norm);
    tribo_variation_free(&m->variation);
    free(m->turned);
    free(m->y);
    memset(m, 0, sizeof *m);
}
