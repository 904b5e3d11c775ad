/* SPDX-License-Identifier: BSD-3-Clause */
#include "event_series.h"
#include "common/layout.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Sets the k-th coefficients of limits N that fall with the speed: N = limit + (ratio - 1) limit part, part = exp(-|v|/velocity),
 * part' = -|v|' part/velocity. */
static void expand_falling(struct event *e, size_t k)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const struct slip_limits *b = &m->limits;
    const size_t c = e->sys->ncontact;
    for (size_t i = 0; i < c; i++) {
        const double *v = e->watch + i, *limit = e->limit + i;
        double *part = e->part + i, sum = 0.0;
        if (tribo_slides(m->state.slip[i])) {
            for (size_t j = 1; j <= k; j++) {
                sum += (double)j * v[j * c] * part[(k - j) * c];
            }
            part[k * c] = k ? -m->state.slip[i] * sum / ((double)k * b->velocity[i]) : exp(-quotient(fabs(v[0]), b->velocity[i]));
            sum = tribo_series_product(limit, part, c, k, 0, k < e->terms ? k + 1 : e->terms);
            e->fall[k * c + i] = (k < e->terms ? limit[k * c] : 0.0) + (b->ratio[i] - 1.0) * sum;
        }
    }
}

/* Sets v = the k-th coefficients of the contacts' velocities, scale = 1/k!. */
static void find_velocities(const struct event *e, size_t k, double scale, double *v)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const size_t c = e->sys->ncontact;
    memset(v, 0, c * sizeof *v);
    tribo_system_loads(e->sys, DRIVES_BASE, (int)k, -scale, v);
    tribo_matrix_multiply_add(&e->sys->direction, 1.0, e->u + k * e->sys->ndof, v);
    if (e->sys->compliance.count) {
        const double *slide = e->sys->normals.count || m->constant.pairs ? e->room.a : NULL;
        if (slide) {
            tribo_normal_series_slide(e, k, e->room.a);
        }
        if (m->constant.pairs) {
            tribo_pair_series_slide(e, k, v, e->room.a);
        }
        tribo_compliance_rates(e->sys, m->state.slip, slide, 1, v, e->room.rate);
        for (size_t i = 0; k < e->order && i < c; i++) {
            e->force[(k + 1) * c + i] = e->room.rate[i] / (double)(k + 1);
        }
    }
    for (size_t i = 0; k == 0 && i < c; i++) {
        v[i] = m->state.rested[i] ? 0.0 : v[i];
    }
}

/* Sets the k-th coefficients of accelerations and of watch, scale = 1/k!. Returns a status. */
static int expand_forces(struct event *e, size_t k, double scale)
{
    struct stick_slip *m = &e->events.stick_slip;
    tribo_system *sys = e->sys;
    const size_t n = sys->ndof, c = sys->ncontact;
    double *acc = e->room.acceleration, *watch = e->watch + k * c, *base = e->room.base, *held = e->room.held;
    const int given = k < e->slide_terms;
    if (sys->normals.count) {
        tribo_normal_series_expand(e, k);
    }
    find_velocities(e, k, scale, watch);
    tribo_system_smooth(sys, (int)k, scale, e->q + k * n, e->u + k * n, e->force + k * c, acc);
    if (m->limits.falls) {
        expand_falling(e, k);
    }
    int status = TRIBO_OK;
    if (given) {
        /* rigid contacts: one that slides, or is just at its limit, follows the limit; others keep their force */
        for (size_t i = 0; i < c; i++) {
            const int keeps = k == 0 && m->state.slip[i] == TRIBO_SLIP_STUCK && !m->state.holds[i];
            const double *limit = (m->state.slip[i] ? e->slide : e->limit) + k * c, side = tribo_stick_slip_follows(m, i);
            e->room.given[i] = keeps ? m->state.force[i] : side != 0.0 ? side * limit[i] : 0.0;
        }
        status = m->plane ? tribo_planar_series_forces(e, k, watch) : TRIBO_OK;
        tribo_matrix_multiply_add(&sys->response, 1.0, e->room.given, acc);
    }
    memset(base, 0, c * sizeof *base);
    tribo_system_loads(sys, DRIVES_BASE, (int)k + 1, scale, base);
    status = status ? status : tribo_stick_slip_pull(m, sys, base, acc, held);
    status = status || !m->plane ? status : tribo_planar_series_finish(e, k);
    if (status) {
        return status;
    }
    for (size_t i = 0; i < c; i++) {
        if (m->state.slip[i] == TRIBO_SLIP_STUCK && !tribo_stick_slip_may_part(m, i)) {
            const double own = held[i] + (given ? e->room.given[i] : 0.0);
            watch[i] = k == 0 ? m->state.force[i] : tribo_force_is_state(m, i) ? e->force[k * c + i] : own;
        }
    }
    /* contacts at rest must not creep by what rounding leaves in acc */
    return tribo_stick_slip_hold(m, sys, base, acc);
}

int tribo_event_start(struct event *e, double t, const double *y)
{
    tribo_system *sys = e->sys;
    const size_t n = sys->ndof, c = sys->ncontact;
    struct stick_slip *m = &e->events.stick_slip;
    memcpy(e->q, y, n * sizeof *y);
    memcpy(e->u, y + n, n * sizeof *y);
    e->d[0] = y[tribo_system_energy(sys)];
    tribo_compliance_get(sys, y, e->force);
    e->order = e->most_order;
    e->lines.count = m->plane ? m->plane->count : m->constant.pairs;
    const int status = m->plane ? tribo_planar_series_begin(e) : m->constant.pairs ? tribo_pair_series_begin(e) : TRIBO_OK;
    tribo_system_set_time(sys, t);
    /* limits; a coefficient of a limit that falls with the speed needs that of the velocity first */
    const int falls = m->limits.falls;
    double scale = 1.0; /* 1/k! */
    e->slide = falls ? e->fall : e->limit;
    e->slide_terms = falls || m->plane ? e->order + 1 : e->terms;
    tribo_system_limits(sys, e->limit, e->limit + c);
    for (size_t k = 2; k < e->slide_terms; k++) {
        scale /= (double)k;
        memset(e->limit + k * c, 0, c * sizeof *e->limit);
        tribo_system_loads(sys, DRIVES_LIMIT, (int)k, scale, e->limit + k * c);
    }
    return status;
}

/* Coefficient k of the power that contact i dissipates: force times velocity, of a compliant contact that of its slider. */
static double power_of(const struct event *e, size_t i, size_t k)
{
    const signed char slip = e->events.stick_slip.state.slip[i];
    const size_t to = k < e->slide_terms ? k + 1 : e->slide_terms, c = e->sys->ncontact;
    return slip == TRIBO_SLIP_PLANE ? -tribo_series_product(e->force + i, e->watch + i, c, k, 0, k + 1)
           : tribo_slides(slip)     ? slip * tribo_series_product(e->slide + i, e->watch + i, c, k, 0, to)
                                    : 0.0;
}

int tribo_event_series(struct event *e)
{
    const size_t n = e->sys->ndof;
    double scale = 1.0;
    for (size_t k = 0; k <= e->order; k++) {
        const int status = expand_forces(e, k, scale);
        if (status) {
            return status;
        }
        const double part = 1.0 / (double)(k + 1);
        scale *= part;
        for (size_t i = 0; k < e->order && i < n; i++) {
            e->q[(k + 1) * n + i] = part * e->u[k * n + i];
            e->u[(k + 1) * n + i] = part * e->room.acceleration[i];
        }
    }
    e->sys->evaluations += e->order + 1;
    for (size_t k = 0; k < e->order; k++) {
        double power = 0.0;
        for (size_t i = 0; i < e->sys->ncontact; i++) {
            power += e->sys->tally[i] * power_of(e, i, k);
        }
        e->d[k + 1] = power / (double)(k + 1);
    }
    return TRIBO_OK;
}

double tribo_event_work(void *own, size_t i, double tau)
{
    const struct event *e = own;
    double work = 0.0;
    for (size_t k = e->order; k-- > 0;) {
        work = work * tau + power_of(e, i, k) / (double)(k + 1);
    }
    return work * tau;
}

/* Longest step of a periodic motion, in parts of the radius of convergence of the series that perturbations need. */
#define WITHIN 0.7

/* The radius is found from the first coefficient that exceeds LARGEST, since the next ones may overflow. */
#define LARGEST 1e100

double tribo_series_within(const double *x, size_t powers, double *inverse, double h)
{
    double term = 0.0;
    inverse[0] = 1.0; /* the series of x_0/x */
    for (size_t k = 1; k <= powers && !(term > LARGEST); k++) {
        inverse[k] = -tribo_product_of(x, inverse, k, 1, k + 1) / x[0];
        term = fabs(inverse[k]);
        if ((k + 2 > powers && term > 0.0) || term > LARGEST) {
            h = lesser(h, WITHIN * pow(term, -1.0 / (double)k));
        }
    }
    return h;
}

/* Limits of a step that are below this part of the largest one do not make the guard of a contact at rest larger. */
#define LEAST_PART 1e-3

double tribo_series_reference(double least, double most)
{
    return greater(greater(least, LEAST_PART * most), DBL_MIN);
}

/* ------------------------------------------------------------------------------------------------------- perturbations */

/* Most terms; a series of exponentials over a step has far less. */
#define MOST_TERMS 400

/* p->next += part times the terms of order k - 1 of the source, if any. */
static void add_source(struct event *e, size_t k, double part, const struct perturbed *p)
{
    const struct source *s = p->source;
    const size_t n = e->sys->ndof, c = p->columns;
    if (s && k == 1) {
        tribo_matrix_add_columns(&e->sys->response, part, c, s->force, p->next);
    }
    if (!s || !s->inertia || k > e->order) {
        return;
    }
    memset(p->drag, 0, n * sizeof *p->drag);
    if (e->sys->damping.rows) {
        tribo_matrix_multiply(&e->sys->damping, e->u + (k - 1) * n, p->drag);
    }
    for (size_t at = 0; at < n * c; at++) {
        const double acceleration = (double)k * e->u[k * n + at / c];
        p->next[at] += part * p->power * (s->inertia[at % c] * acceleration + s->damping[at % c] * p->drag[at / c]);
    }
}

/* p->next += part times the terms of order k - 1 of accelerations by limits N that fall, from terms of v: dN/d|v| = (limit -
 * N)/velocity. */
static void perturb_falling(const struct event *e, size_t k, double part, const struct perturbed *p)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const size_t c = e->sys->ncontact, each = c * p->columns;
    double power = 1.0;
    memset(p->force, 0, each * sizeof *p->force);
    for (size_t j = 0; j < k && j <= e->order; j++) {
        const double *fall = e->fall + j * c, *limit = e->limit + j * c, *from = p->v + (k - 1 - j) % p->rows * each;
        for (size_t i = 0; i < c; i++) {
            const double slope = tribo_slides(m->state.slip[i]) ? (fall[i] - limit[i]) / m->limits.velocity[i] : 0.0;
            tribo_add(p->force + i * p->columns, power * slope, from + i * p->columns, p->columns);
        }
        power *= p->tau;
    }
    tribo_matrix_add_columns(&e->sys->response, part, p->columns, p->force, p->next);
}

/* Sets the terms of order k from those before. Returns a status. */
static int find_term(struct event *e, size_t k, const struct perturbed *p)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const tribo_system *sys = e->sys;
    const size_t n = sys->ndof, c = sys->ncontact, half = n * p->columns, each = c * p->columns;
    const double part = p->tau / (double)k;
    double *v = p->v + (k - 1) % p->rows * each;
    memset(p->next, 0, half * sizeof *p->next);
    tribo_matrix_add_columns(&sys->stiffness, -part, p->columns, p->q, p->next);
    tribo_matrix_add_columns(&sys->damping, -part, p->columns, p->u, p->next);
    memset(v, 0, each * sizeof *v);
    tribo_matrix_add_columns(&sys->direction, 1.0, p->columns, p->u, v);
    if (sys->normals.count) {
        tribo_normal_series_perturb(e, p->columns, p->q, p->force);
        tribo_matrix_add_columns(&sys->response, part, p->columns, p->force, p->next);
        tribo_normal_series_perturb(e, p->columns, p->u, p->force);
    }
    if (sys->compliance.count) {
        tribo_matrix_add_columns(&sys->compliance.pull, part, p->columns, p->spring, p->next);
        tribo_compliance_rates(sys, m->state.slip, sys->normals.count ? p->force : NULL, p->columns, v, p->spring);
        for (size_t i = 0; i < each; i++) {
            p->spring[i] *= part;
        }
    }
    if (m->limits.falls) {
        perturb_falling(e, k, part, p);
    }
    if (m->constant.pairs) {
        tribo_pair_series_turn(e, k - 1, p);
    }
    add_source(e, k, part, p);
    if (m->plane) {
        tribo_planar_series_turn(e, k - 1, p, p->force);
        tribo_matrix_add_columns(&sys->response, part, p->columns, p->force, p->next);
    }
    for (size_t i = 0; i < half; i++) {
        p->q[i] = part * p->u[i];
    }
    if (m->constant.pairs) {
        tribo_pair_series_force(e, k, p, p->spring);
    }
    memset(p->u, 0, half * sizeof *p->u);
    tribo_multiply_add(n, n, p->columns, 1.0, p->project, p->next, p->u);
    return m->plane ? tribo_planar_series_turn_finish(e, k - 1, p, p->u) : TRIBO_OK;
}

/* Sets p->project. Returns a status. */
static int find_projection(struct event *e, const struct perturbed *p)
{
    struct stick_slip *m = &e->events.stick_slip;
    const size_t n = e->sys->ndof;
    int status = TRIBO_OK;
    for (size_t j = 0; !status && j < n; j++) {
        memset(p->next, 0, n * sizeof *p->next);
        p->next[j] = 1.0;
        status = tribo_stick_slip_project(m, e->sys, m->constant.still, p->next);
        for (size_t i = 0; i < n; i++) {
            p->project[i * n + j] = p->next[i];
        }
    }
    return status;
}

int tribo_event_transition(void *own, const void *phase, double tau, size_t columns, double *v, const struct source *source)
{
    struct event *e = own;
    struct stick_slip *m = &e->events.stick_slip;
    const struct compliance *g = &e->sys->compliance;
    const size_t n = e->sys->ndof, half = n * columns, each = e->sys->ncontact * columns;
    const size_t lines = e->lines.count * columns;
    struct perturbed p = {
        .columns = columns, .rows = m->limits.falls || lines ? e->order + 2 : 1, .tau = tau, .power = 1.0, .source = source};
    if (!ALLOCATE(ARRAY(p.project, n * n), ARRAY(p.q, half), ARRAY(p.u, half), ARRAY(p.next, half), ARRAY(p.spring, each),
                  ARRAY(p.force, each), ARRAY(p.v, p.rows * each), ARRAY(p.z, p.rows * lines), ARRAY(p.g, p.rows * lines),
                  ARRAY(p.w, lines), ARRAY(p.drag, n))) {
        return tribo_error(e->sys->message, TRIBO_ERR_MEMORY, "out of memory for %zu perturbation%s", columns, plural(columns));
    }
    (void)phase;
    tribo_stick_slip_press(m, e->sys);
    int status = find_projection(e, &p);
    memcpy(p.q, v, half * sizeof *v);
    tribo_multiply_add(n, n, columns, 1.0, p.project, v + half, p.u);
    memcpy(v + half, p.u, half * sizeof *v);
    for (size_t k = 0; k < g->count; k++) {
        memcpy(p.spring + g->contact[k] * columns, v + 2 * half + k * columns, columns * sizeof *v);
    }
    if (m->constant.pairs) {
        tribo_pair_series_force(e, 0, &p, p.spring);
    }
    for (size_t k = 0; k < g->count; k++) {
        memcpy(v + 2 * half + k * columns, p.spring + g->contact[k] * columns, columns * sizeof *v);
    }
    size_t most = MOST_TERMS;
    for (size_t k = 0; k < e->lines.count; k++) {
        most = e->lines.line[k].asymptotic ? e->order : most;
    }
    for (size_t k = 1, small = 0; !status && small < 2 && k < most; k++) {
        status = find_term(e, k, &p);
        tribo_add(v, 1.0, p.q, 2 * half); /* q and u */
        for (size_t i = 0; i < g->count; i++) {
            tribo_add(v + 2 * half + i * columns, 1.0, p.spring + g->contact[i] * columns, columns);
        }
        const int adds = tribo_largest(p.q, half) > DBL_EPSILON * tribo_largest(v, half) ||
                         tribo_largest(p.u, half) > DBL_EPSILON * tribo_largest(v + half, half);
        small = adds || (source && k <= e->order) ? 0 : small + 1;
        p.power *= tau;
    }
    free(p.project);
    return status;
}
