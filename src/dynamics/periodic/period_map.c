#include "period_map.h"
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

static double period_map_turn(void)
{
    return 2.0 * acos(-1.0);
}

static double period_map_length(const double *x, size_t n)
{
    return sqrt(tribo_dot(x, x, n));
}

static double period_map_distance(const double *a, const double *b, size_t n)
{
    double square = 0.0;
    for (size_t i = 0; i < n; i++) {
        square += (a[i] - b[i]) * (a[i] - b[i]);
    }
    return sqrt(square);
}

void tribo_period_map_coordinates(const struct period_map *m, const double *y, double *x)
{
    tribo_energy_norm_of(&m->norm, 1, y, x);
    for (size_t i = 0; i < m->n; i++) {
        x[i] *= m->scale;
    }
}

/* Sets m->y = the state with the coordinates x [n]. */
static void set_state(struct period_map *m, const double *x)
{
    tribo_energy_norm_state(&m->norm, 1, x, m->y);
    for (size_t i = 0; i < m->n; i++) {
        m->y[i] /= m->scale;
    }
}

/* -------------------------------------------------------------------------------------------------------------- integration */

static struct period_map *of_company(struct company *company)
{
    return (struct period_map *)((char *)company - offsetof(struct period_map, company));
}

static int phase_ends(struct company *company, double tau, double t, const double *y)
{
    struct period_map *m = of_company(company);
    tribo_period_map_coordinates(m, y, m->x);
    m->size = greater(m->size, period_map_length(m->x, m->n));
    return m->variation.company.ends(&m->variation.company, tau, t, y);
}

static void event_decided(struct company *company)
{
    struct period_map *m = of_company(company);
    m->variation.company.decided(&m->variation.company);
}

/* Integrates m->y from t to end without the driver's observer; the driver's next run is a new one. Returns a status. */
static int period_map_integrate(struct period_map *m, double t, double end, struct company *company)
{
    tribo_driver *drv = m->drv;
    int (*const seen)(const tribo_moment *, void *) = drv->seen;
    const size_t evaluations = m->sys->evaluations, halves = end - t < 0.75 * m->period ? 1 : 2;
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

int tribo_period_map_replay(struct period_map *m, const double *y, struct company *company)
{
    const int status = m->drv->method->open(m->drv, &m->events);
    memcpy(m->y, y, m->n * sizeof *y);
    return status ? status : period_map_integrate(m, m->t, m->t + m->period, company);
}

int tribo_period_map_march(struct period_map *m, size_t periods, double *x)
{
    int status = TRIBO_OK;
    set_state(m, x);
    for (size_t k = 0; !status && k < periods; k++) {
        status = period_map_integrate(m, m->t, m->t + m->period, NULL);
    }
    tribo_period_map_coordinates(m, m->y, x);
    return status;
}

/* Removes rounding of velocities from m->y at contacts that rest since the last integration. Returns a status. */
static int hold_still(struct period_map *m)
{
    struct stick_slip *contacts = &m->events->stick_slip;
    tribo_system_set_time(m->sys, m->t);
    memset(contacts->state.base, 0, m->sys->ncontact * sizeof *contacts->state.base);
    tribo_system_loads(m->sys, DRIVES_BASE, 0, 1.0, contacts->state.base);
    const int status = tribo_stick_slip_hold(contacts, m->sys, contacts->state.base, m->y + m->sys->ndof);
    return status ? tribo_driver_fail(m->drv, status, "%s", tribo_system_message(m->sys)) : TRIBO_OK;
}

static void set_image(int odd, size_t count, double *x)
{
    for (size_t i = 0; odd && i < count; i++) {
        x[i] = -x[i];
    }
}

static int no_room(const struct period_map *m)
{
    return tribo_driver_fail(m->drv, TRIBO_ERR_MEMORY, "out of memory for %zu perturbation%s", m->n, plural(m->n));
}

static int on_driver(const struct period_map *m, int status)
{
    return status ? tribo_driver_fail(m->drv, status, "%s", tribo_system_message(m->sys)) : TRIBO_OK;
}

/* Sets p->derivative = one without steps and with users = 1. Returns 0 if out of memory. */
static int renew(struct period_map *m, struct point *p)
{
    if (p->derivative && p->derivative->users == 1) {
        tribo_derivative_clear(p->derivative);
        return 1;
    }
    tribo_derivative_free(p->derivative);
    p->derivative = tribo_derivative_create(m->events, m->sys);
    return p->derivative != NULL;
}

/* Sets p->derivative->matrix from v [n][n], the final perturbations of initial unit coordinates. Returns a status. */
static int keep_matrix(struct period_map *m, const struct point *p, const double *v)
{
    double *matrix = malloc(m->n * m->n * sizeof *matrix);
    if (!matrix) {
        return no_room(m);
    }
    tribo_energy_norm_of(&m->norm, m->n, v, matrix);
    set_image(p->odd, m->n * m->n, matrix);
    p->derivative->matrix = matrix;
    return TRIBO_OK;
}

int tribo_period_map_follow(struct period_map *m, struct point *p)
{
    const size_t n = m->n;
    if (!renew(m, p)) {
        return no_room(m);
    }
    set_state(m, p->x);
    int status = m->moved ? hold_still(m) : TRIBO_OK;
    if (m->sys->compliance.count) {
        tribo_get_limit(m->sys->contacts, m->limit);
        tribo_compliance_enter(m->sys, m->limit, m->limit + m->sys->ncontact, m->y);
    }
    memcpy(p->y, m->y, n * sizeof *p->y);
    tribo_period_map_coordinates(m, m->y, p->x);
    tribo_variation_begin(&m->variation, m->probe, p->derivative);
    m->size = greater(m->least, period_map_length(p->x, n));
    status = status ? status : period_map_integrate(m, m->t, m->t + m->span, &m->company);
    status = status ? status : on_driver(m, m->variation.status);
    if (status) {
        return status;
    }
    m->moved = 1;
    memcpy(p->end, m->y, n * sizeof *p->end);
    tribo_period_map_coordinates(m, m->y, p->image);
    set_image(m->odd, n, p->image);
    p->residual = period_map_distance(p->image, p->x, n);
    p->size = m->size;
    p->odd = m->odd;
    p->torn = m->variation.torn;
    p->other = m->variation.other;
    return m->events->motion->keep ? TRIBO_OK : keep_matrix(m, p, m->variation.v);
}

int tribo_period_map_apply(struct period_map *m, const struct point *p, double *x)
{
    tribo_energy_norm_state(&m->norm, 1, x, m->y);
    const int status = on_driver(m, tribo_derivative_apply(p->derivative, 0, 1, m->y));
    tribo_energy_norm_of(&m->norm, 1, m->y, x);
    set_image(p->odd, m->n, x);
    return status;
}

/* v [n][n] = states, in columns, with unit vectors as coordinates. work [n][n]. */
static void set_units(const struct period_map *m, double *work, double *v)
{
    memset(work, 0, m->n * m->n * sizeof *work);
    for (size_t i = 0; i < m->n; i++) {
        work[i * m->n + i] = 1.0;
    }
    tribo_energy_norm_state(&m->norm, m->n, work, v);
}

int tribo_period_map_matrix(struct period_map *m, const struct point *p, const double **matrix)
{
    int status = TRIBO_OK;
    if (!p->derivative->matrix) {
        double *v = malloc(2 * m->n * m->n * sizeof *v);
        if (!v) {
            return no_room(m);
        }
        set_units(m, v + m->n * m->n, v);
        status = on_driver(m, tribo_derivative_apply(p->derivative, 0, m->n, v));
        status = status ? status : keep_matrix(m, p, v);
        free(v);
    }
    *matrix = p->derivative->matrix;
    return status;
}

int tribo_period_map_complete(struct period_map *m, struct point *p, double *residual)
{
    *residual = p->residual;
    if (!m->odd) {
        return TRIBO_OK;
    }
    memcpy(m->y, p->end, m->n * sizeof *m->y);
    const int status = period_map_integrate(m, m->t + m->span, m->t + m->period, NULL);
    tribo_period_map_coordinates(m, m->y, m->x);
    *residual = period_map_distance(m->x, p->x, m->n);
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- preparation */

/* Returns 1 if, half a period later, loads and bases have the opposite sign and limits are the same. */
static int is_odd(const tribo_system *sys, double period)
{
    for (size_t k = 0; k < sys->harmonics; k++) {
        const struct harmonic *w = &sys->harmonic[k];
        const double order = round(fabs(w->omega) * period / period_map_turn());
        if (w->count > 0 && fmod(order, 2.0) != (w->drives == DRIVES_LIMIT ? 0.0 : 1.0)) {
            return 0;
        }
    }
    return 1;
}

/* Returns the least motion by a load in the norm: |psi amplitude| with components over max(omega of mode, omega of load). */
static double size_of_load(struct period_map *m, const struct harmonic *w, const double *amplitude)
{
    double size = 0.0;
    memset(m->x, 0, m->n * sizeof *m->x);
    /* x += psi amplitude: the load in the modes */
    for (size_t d = 0; d < m->sys->ndof; d++) {
        for (size_t k = 0; k < w->count; k++) {
            m->x[d] += m->norm.psi[d * m->sys->ndof + w->index[k]] * amplitude[k];
        }
    }
    for (size_t d = 0; d < m->sys->ndof; d++) {
        size = hypot(size, m->x[d] / greater(m->norm.omega[d], fabs(w->omega)));
    }
    return size;
}

/* The same for a base: amplitude/sqrt(R_ii) of bodies that follow the base, amplitude/(omega sqrt(G_ii)) of stretched springs. */
static double size_of_base(const struct period_map *m, const struct harmonic *w, const double *amplitude)
{
    double size = 0.0;
    for (size_t k = 0; k < w->count; k++) {
        const double r = tribo_system_delassus(m->sys, w->index[k], w->index[k]);
        const int elastic = tribo_is_compliant(&m->sys->compliance, w->index[k]) && w->omega != 0.0;
        size = r > 0.0 ? hypot(size, amplitude[k] / sqrt(r)) : size;
        size = elastic ? hypot(size, amplitude[k] / (w->omega * sqrt(m->sys->compliance.own[w->index[k]]))) : size;
    }
    return size;
}

/* Returns the least motion by all loads and bases in the norm. */
static double least_motion(struct period_map *m)
{
    double size = 0.0;
    for (size_t k = 0; k < m->sys->harmonics; k++) {
        const struct harmonic *w = &m->sys->harmonic[k];
        if (w->drives == DRIVES_LOAD) {
            size = hypot(size, hypot(size_of_load(m, w, w->cosine), size_of_load(m, w, w->sine)));
        } else if (w->drives == DRIVES_BASE) {
            size = hypot(size, hypot(size_of_base(m, w, w->cosine), size_of_base(m, w, w->sine)));
        }
    }
    return size;
}

/* Sets m->probe: all n unit perturbations, or, if phases are kept, at most PROBES without any symmetry. Returns a status. */
static int prepare_probes(struct period_map *m)
{
    const size_t columns = m->events->motion->keep && m->n > PROBES ? PROBES : m->n;
    if (!m->variation.v && !tribo_variation_create(&m->variation, m->events, m->sys, columns)) {
        return no_room(m);
    }
    m->probe = m->probe ? m->probe : malloc(m->n * columns * sizeof *m->probe);
    double *x = malloc(m->n * m->n * sizeof *x);
    if (!m->probe || !x) {
        free(x);
        return no_room(m);
    }
    if (columns == m->n) {
        set_units(m, x, m->probe);
    } else {
        for (size_t i = 0; i < m->n * columns; i++) {
            x[i] = sin(1.0 + (double)(i * i));
        }
        tribo_energy_norm_state(&m->norm, columns, x, m->probe);
    }
    free(x);
    return TRIBO_OK;
}

int tribo_period_map_prepare(struct period_map *m, double t, double period, const double *y)
{
    m->halves = 0;
    m->moved = 0;
    int status = m->drv->method->open(m->drv, &m->events);
    if (!status && !m->norm.phi) {
        status = on_driver(m, tribo_energy_norm_create(&m->norm, m->sys));
        if (status) {
            tribo_energy_norm_free(&m->norm);
        }
    }
    if (!status && m->period != period) {
        tribo_energy_norm_set_least(&m->norm, LEAST_OMEGA * period_map_turn() / period);
        m->period = period;
        status = prepare_probes(m);
    }
    if (status) {
        m->period = 0.0;
        return status;
    }
    tribo_energy_norm_set_damping(&m->norm, m->sys);
    m->t = t;
    tribo_period_map_choose(m, is_odd(m->sys, period));
    /* size of the motion: the larger of least and the guess y */
    const double least = least_motion(m);
    double size = least;
    m->scale = 1.0;
    tribo_period_map_coordinates(m, y, m->x);
    for (size_t i = 0; i < m->n; i++) {
        size = greater(size, fabs(m->x[i]));
    }
    /* scale: a power of two that brings very small and very large motions to ordinary size */
    m->scale = size > 0.0 && !(size >= 1.0 / LARGE && size <= LARGE) ? ldexp(1.0, -(int)clamp(logb(size), -1000.0, 1000.0)) : 1.0;
    m->least = LEAST_SIZE * (m->scale * least);
    return TRIBO_OK;
}

void tribo_period_map_choose(struct period_map *m, int odd)
{
    m->odd = odd;
    m->span = odd ? 0.5 * m->period : m->period;
}

/* -------------------------------------------------------------------------------------------------------------- life */

int tribo_period_map_create(struct period_map *m, tribo_driver *drv)
{
    const size_t n = tribo_system_energy(drv->sys);
    *m = (struct period_map){.drv = drv, .sys = drv->sys, .n = n, .company = {phase_ends, event_decided}};
    m->y = malloc((2 * n + 2 * drv->sys->ncontact + 2) * sizeof *m->y);
    if (m->y) {
        m->x = m->y + n + 1;
        m->limit = m->x + n + 1;
    }
    return m->y != NULL;
}

void tribo_period_map_free(struct period_map *m)
{
    tribo_energy_norm_free(&m->norm);
    tribo_variation_free(&m->variation);
    free(m->probe);
    free(m->y);
    memset(m, 0, sizeof *m);
}
