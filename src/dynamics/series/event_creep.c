/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps of method "event" in which planar contacts creep: the direction of the force at a small velocity v relaxes to that of the
 * motion within the time m|v|/limit, and a Taylor series converges over a few such times only.
 *
 * There the directions u = x/|x|, x = limit v, are polynomials of degree NODES - 1, by collocation at the nodes of Radau's
 * formula, the last of which is the end of the step. For |v| -> 0 this damps errors at once (Hairer and Wanner, Solving Ordinary
 * Differential Equations II, IV.5). With u given the motion is that of a linear structure under a load, and its series converges.
 *
 * The unknowns are the angles of u at the nodes; Newton's method solves that x has no part across u, which is regular for v = 0.
 * The derivative follows from the response of x to a constant force. */
#include "event_series.h"
#include "common/layout.h"

#include <string.h>

#define NODES TRIBO_CREEP_NODES

/* Most sliding planar contacts for steps by collocation: Newton's matrices are dense. */
#define MOST_CONTACTS 128

/* Steps by series before longer ones by collocation are tried; after trials that failed, steps of DEAR times their work;
 * trials at once. */
#define PATIENCE 16
#define DEAR 8
#define MOST_TRIALS 3

/* First step tried, in parts of the longest one. */
#define FIRST 0.25

/* A step pays if it is longer than PAYS times the time in which friction would stop a contact, and for more than FEW_CONTACTS
 * contacts, whose matrices are most of the work, times the cube of their ratio. */
#define PAYS 100.0
#define FEW_CONTACTS 32.0

#define MOST_ITERATIONS 10
#define BISECTIONS 60

/* Newton's method ends with a step of ENOUGH times the error allowed of directions and a stray of STRAY_ENOUGH at nodes; fails
 * with a step of TOO_FAR radians, or of more than HEADWAY times the step before. */
#define ENOUGH 1e-2
#define STRAY_ENOUGH 0.1
#define TOO_FAR 1.5
#define HEADWAY 0.5

/* Rate of turn by structure and loads, in units of the highest frequency; faster turns are relaxation. */
#define TURNS 2.0

/* Errors allowed of directions of forces, and of velocities however small. */
#define MOST_OFF 1e-4
#define MOST_STRAY 1e-3

/* A shorter step leaves at most this part of the stray at its start, if the stray is due to the length. */
#define LESS_STRAY 0.5

/* Largest growth of a speed over a step: a small one at its start must not be lost in rounding. */
#define FASTER 100.0

/* Least and largest factors by which lengths of steps change. */
#define GROWS 4.0
#define SHRINKS 0.2

/* Zeros of P_8 - P_7, Legendre's polynomials, on [0, 1]. */
static const double node[NODES] = {0.022479386438712498, 0.11467905316090423, 0.26578982278458947, 0.45284637366944461,
                                   0.64737528288683036,  0.81975930826310764, 0.94373743946307788, 1.0};

/* A step that was tried. */
struct creep_step {
    int good;     /* 1: velocities are right to e->error */
    double next;  /* how long another one may be, after this one or in its place; 0: none can be good */
    double stray; /* how far directions were off where it began; HUGE_VAL: unknown */
};

/* --------------------------------------------------------------------------------------------------------- what it takes */

/* Makes room for sliding contacts; finds basis and weight. Returns 0 if out of memory. */
static int reserve(struct event *e)
{
    struct creep *c = &e->creep;
    const size_t terms = e->most_order + 1, slides = c->count, unknowns = slides * NODES;
    if (c->room >= slides) {
        return 1;
    }
    free(c->weight);
    c->room = 0;
    if (!ALLOCATE(ARRAY(c->weight, terms * NODES * NODES), ARRAY(c->response, 4 * slides * slides * terms),
                  ARRAY(c->matrix, unknowns * unknowns), ARRAY(c->rest, unknowns), ARRAY(c->angle, unknowns),
                  ARRAY(c->u, 2 * unknowns), ARRAY(c->slides, slides), ARRAY(c->pivot, unknowns))) {
        return 0;
    }
    c->room = slides;
    for (size_t i = 0; i < NODES; i++) {
        double *b = memset(c->basis[i], 0, sizeof c->basis[i]);
        b[0] = 1.0;
        for (size_t j = 0; j < NODES; j++) { /* times (x - node_j)/(node_i - node_j) */
            for (size_t k = NODES - 1; j != i && k < NODES; k--) {
                b[k] = ((k ? b[k - 1] : 0.0) - node[j] * b[k]) / (node[i] - node[j]);
            }
        }
    }
    /* a force time^k acts as a constant one does, with m! k!/(m + k)! time^(m + k) for time^m */
    for (size_t m = 0; m < terms; m++) {
        for (size_t j = 0; j < NODES; j++) {
            double *w = c->weight + (m * NODES + j) * NODES, part = pow(node[j], (double)m);
            memset(w, 0, NODES * sizeof *w);
            for (size_t k = 0; k < NODES; k++) {
                for (size_t i = 0; i < NODES; i++) {
                    w[i] += part * c->basis[i][k];
                }
                part *= node[j] * (double)(k + 1) / (double)(m + k + 1);
            }
        }
    }
    return 1;
}

/* Sets c->count. Returns the least length of a step that pays: much longer than the time in which friction would stop a contact;
 * HUGE_VAL if none can pay. */
static double find_least(const struct stick_slip *m, struct creep *c)
{
    int begins = 0;
    c->count = 0;
    for (size_t k = 0; k < m->plane->count; k++) {
        const struct planar_contact *p = &m->plane->contact[k];
        c->count += (size_t)tribo_slides_in_plane(m, p);
        begins |= tribo_slides_in_plane(m, p) && p->begins != SLIDES_ON;
    }
    const double part = (double)c->count / FEW_CONTACTS;
    return c->count == 0 || c->count > MOST_CONTACTS || begins
               ? HUGE_VAL
               : PAYS * greater(1.0, part * part * part) * tribo_planar_series_first_stop(m);
}

/* --------------------------------------------------------------------------------------------------------- directions */

/* Returns the shortest time to a stop over the contacts with a direction that still turns too fast for an error of velocities
 * below e->error; HUGE_VAL if there is none. */
static double find_settled(const struct event *e)
{
    const struct stick_slip *m = &e->events.stick_slip;
    double length = HUGE_VAL;
    for (size_t k = 0; k < m->plane->count; k++) {
        const struct planar_contact *p = &m->plane->contact[k];
        const struct line *l = &e->lines.line[k];
        double un = 0.0, ut = 0.0, dn = 0.0, dt = 0.0; /* u and its rate at the end of the last step */
        for (size_t j = tribo_slides_in_plane(m, p) ? e->order + 1 : 0; j-- > 0;) {
            dn = dn * e->length + un;
            dt = dt * e->length + ut;
            un = un * e->length + l->un[j];
            ut = ut * e->length + l->ut[j];
        }
        const double turn = fabs(un * dt - ut * dn);
        const int follows = turn <= TURNS * e->fastest || turn * p->stop <= lesser(MOST_STRAY, e->error / p->now);
        length = follows ? length : lesser(length, p->stop);
    }
    return length;
}

/* x along n and along t at tau. */
static void find_velocity(const struct event *e, size_t k, double tau, double *x)
{
    x[0] = tribo_series_value(e->lines.line[k].xn, e->order, tau);
    x[1] = tribo_series_value(e->lines.line[k].xt, e->order, tau);
}

/* ------------------------------------------------------------------------------------------------------------ response */

/* to [terms][2 slides] += factor times the series of x. */
static void add_series(const struct event *e, double factor, double *to)
{
    const size_t slides = e->creep.count;
    for (size_t s = 0; s < slides; s++) {
        const struct line *l = &e->lines.line[e->creep.slides[s]];
        for (size_t k = 0; k <= e->order; k++) {
            to[2 * (k * slides + s)] += factor * l->xn[k];
            to[2 * (k * slides + s) + 1] += factor * l->xt[k];
        }
    }
}

/* c->response of all that slide, as a difference to the motion without their friction. */
static int find_response(struct event *e)
{
    struct creep *c = &e->creep;
    const size_t terms = e->order + 1, slides = c->count, each = 2 * slides * terms;
    for (size_t s = 0; s < slides; s++) {
        memset(e->lines.line[c->slides[s]].un, 0, terms * sizeof(double));
        memset(e->lines.line[c->slides[s]].ut, 0, terms * sizeof(double));
    }
    memset(c->response, 0, 2 * slides * each * sizeof *c->response);
    int status = tribo_event_series(e);
    for (size_t s = 0; !status && s < 2 * slides; s++) {
        add_series(e, -1.0, c->response + s * each);
    }
    for (size_t s = 0; !status && s < 2 * slides; s++) {
        const struct line *l = &e->lines.line[c->slides[s / 2]];
        double *u = s % 2 ? l->ut : l->un;
        u[0] = 1.0;
        status = tribo_event_series(e);
        u[0] = 0.0;
        add_series(e, 1.0, c->response + s * each);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------------- Newton */

/* One step of Newton's method; returns its size, HUGE_VAL if there is none. */
static double improve(struct event *e, double h)
{
    struct creep *c = &e->creep;
    const size_t slides = c->count, unknowns = slides * NODES;
    for (size_t s = 0; s < slides * slides; s++) {
        /* block (a, b): derivative of the part of x_a across u_a by the angles of contact b; part: of x_a along n and t to a
         * force along n, then along t, of contact b */
        const size_t a = s / slides, b = s % slides;
        double part[4][NODES * NODES] = {{0.0}}, power = 1.0;
        for (size_t m = 0; m <= e->order; m++) {
            const double *weight = c->weight + m * NODES * NODES;
            for (size_t d = 0; d < 4; d++) {
                const double r = power * c->response[2 * (((2 * b + d / 2) * (e->order + 1) + m) * slides + a) + d % 2];
                for (size_t j = 0; r != 0.0 && j < NODES * NODES; j++) {
                    part[d][j] += r * weight[j];
                }
            }
            power *= h;
        }
        for (size_t j = 0; j < NODES * NODES; j++) {
            const size_t row = a * NODES + j / NODES, column = b * NODES + j % NODES;
            const double *to = c->u + 2 * row, *from = c->u + 2 * column;
            c->matrix[row * unknowns + column] =
                from[1] * (to[1] * part[0][j] - to[0] * part[1][j]) - from[0] * (to[1] * part[2][j] - to[0] * part[3][j]);
        }
    }
    /* rest = x across u; less x along u on the diagonal */
    for (size_t at = 0; at < unknowns; at++) {
        const double *u = c->u + 2 * at;
        double x[2];
        find_velocity(e, c->slides[at / NODES], node[at % NODES] * h, x);
        c->rest[at] = x[1] * u[0] - x[0] * u[1];
        c->matrix[at * unknowns + at] -= x[0] * u[0] + x[1] * u[1];
    }
    if (!(tribo_lu_create(c->matrix, unknowns, c->pivot) > 0.0)) {
        return HUGE_VAL;
    }
    tribo_lu_solve(c->matrix, unknowns, c->pivot, c->rest, 1);
    tribo_add(c->angle, -1.0, c->rest, unknowns);
    return tribo_largest(c->rest, unknowns);
}

/* Error of directions allowed over a step, by the error of velocities that forces make of it. */
static double allowed(const struct event *e, size_t k, double h)
{
    return lesser(MOST_OFF, e->error * (double)(NODES + 1) / (tribo_planar_series_brake(e, k, h) * h));
}

/* x along u and across u at tau. */
static void take_parts(const struct event *e, size_t k, double tau, double *along, double *across)
{
    const struct line *l = &e->lines.line[k];
    const double un = tribo_series_value(l->un, NODES - 1, tau), ut = tribo_series_value(l->ut, NODES - 1, tau);
    double x[2];
    find_velocity(e, k, tau, x);
    *along = un * x[0] + ut * x[1];
    *across = un * x[1] - ut * x[0];
}

/* The time in which friction would stop planar contact p, |x| being size. */
static double stop_of(const struct planar_contact *p, double size)
{
    return quotient(size, p->brake * greater(p->limit[0], p->limit[1]));
}

/* Stray: velocity across u at tau in a step of length h, in units of its error allowed. Friction takes it away at once, or the
 * part of it that it can take in such a step. */
static double find_stray(const struct event *e, size_t k, double h, double tau)
{
    const struct planar_contact *p = &e->events.stick_slip.plane->contact[k];
    double along, across;
    take_parts(e, k, tau, &along, &across);
    const double size = greater(hypot(along, across), TRIBO_SLOWER * e->lines.line[k].xn[0]);
    const double gone = fabs(across) / size * lesser(1.0, h / stop_of(p, size));
    return gone / lesser(MOST_STRAY, e->error * lesser(p->weight[0], p->weight[1]) / size);
}

/* 1 if the contact slides along u, or stops before it does not. */
static int is_with(const struct event *e, size_t k, double h)
{
    double along, across, from = 0.0, to = 0.0;
    take_parts(e, k, 0.0, &along, &across);
    if (!(along > 0.0)) {
        return 0;
    }
    for (size_t i = 0; i < NODES && along > 0.0; i++) {
        from = to;
        to = node[i] * h;
        take_parts(e, k, to, &along, &across);
    }
    for (int i = 0; i < BISECTIONS && along <= 0.0; i++) {
        const double middle = 0.5 * (from + to);
        take_parts(e, k, middle, &along, &across);
        *(along > 0.0 ? &from : &to) = middle;
        along = 0.0;
    }
    return along > 0.0 || fabs(across) < 0.5 * TRIBO_SLOWER * e->lines.line[k].xn[0];
}

/* Iterates directions of sliding contacts at the nodes of a step of length h until their series satisfies the equation of
 * directions there; sets *found = 1 if it does. Returns a status. */
static int find_angles(struct event *e, double h, int *found)
{
    const struct creep *c = &e->creep;
    double most = MOST_OFF, before = TOO_FAR;
    for (size_t s = 0; s < c->count; s++) {
        most = lesser(most, allowed(e, c->slides[s], h));
    }
    for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
        for (size_t s = 0; s < c->count; s++) { /* u at the nodes by angle; un and ut fitted to that */
            struct line *l = &e->lines.line[c->slides[s]];
            double power = 1.0;
            memset(l->un, 0, (e->order + 1) * sizeof *l->un);
            memset(l->ut, 0, (e->order + 1) * sizeof *l->ut);
            for (size_t p = 0; p < NODES; p++) {
                for (size_t i = 0; i < NODES; i++) {
                    double *u = c->u + 2 * (s * NODES + i);
                    u[0] = cos(c->angle[s * NODES + i]);
                    u[1] = sin(c->angle[s * NODES + i]);
                    l->un[p] += power * c->basis[i][p] * u[0];
                    l->ut[p] += power * c->basis[i][p] * u[1];
                }
                power /= h;
            }
        }
        const int status = tribo_event_series(e);
        if (status) {
            return status;
        }
        const double step = improve(e, h);
        double stray = 0.0;
        for (size_t j = 0; j < c->count * NODES; j++) {
            stray = greater(stray, find_stray(e, c->slides[j / NODES], h, node[j % NODES] * h));
        }
        *found = step <= ENOUGH * most && stray <= STRAY_ENOUGH;
        if (*found || !(step < before)) {
            return TRIBO_OK;
        }
        before = HEADWAY * step;
    }
    return TRIBO_OK;
}

/* Sets step->good if the series of a step of length h is within the allowed error, and the length of the next step. */
static void judge(const struct event *e, double h, struct creep_step *step)
{
    double defect = 0.0, slow = h, stray = 0.0;
    for (size_t s = 0; s < e->creep.count; s++) {
        const size_t k = e->creep.slides[s];
        const struct line *l = &e->lines.line[k];
        const double begins = find_stray(e, k, h, 0.0);
        /* A contact that creeps may start in another direction than its equation asks for, at any length of the step: stray is no
         * reason for shorter steps then. */
        stray = h > PAYS * stop_of(&e->events.stick_slip.plane->contact[k], l->xn[0]) ? greater(stray, begins) : stray;
        /* the error between nodes, in units of that allowed; that of directions is the last power between nodes */
        const double last = 2.0 * pow(0.25 * h, NODES - 1) * hypot(l->un[NODES - 1], l->ut[NODES - 1]) / allowed(e, k, h);
        defect = greater(defect, is_with(e, k, h) ? greater(begins, last) : HUGE_VAL);
        for (size_t i = 0; i < NODES; i++) {
            double x[2];
            defect = greater(defect, find_stray(e, k, h, 0.5 * h * (node[i] + (i ? node[i - 1] : 0.0))));
            for (find_velocity(e, k, node[i] * slow, x); hypot(x[0], x[1]) > FASTER * l->xn[0];) {
                slow *= 0.5;
                find_velocity(e, k, node[i] * slow, x);
            }
        }
    }
    const int stays = stray > 1.0 && stray > LESS_STRAY * step->stray;
    step->good = defect <= 1.0 && slow == h;
    step->next = stays ? 0.0 : slow < h ? slow : h * lesser(greater(0.8 * pow(defect, -1.0 / NODES), SHRINKS), GROWS);
    step->stray = stray;
}

/* Finds the series of the motion from (t, y) on for a step of length h, and judges it. Returns a status. */
static int creep_expand(struct event *e, double t, const double *y, double h, struct creep_step *step)
{
    struct creep *c = &e->creep;
    const struct stick_slip *m = &e->events.stick_slip;
    int found = 0;
    if (!reserve(e)) {
        return tribo_error(e->sys->message, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s that creep", c->count,
                           plural(c->count));
    }
    for (size_t k = 0, s = 0; s < c->count; k++) {
        if (tribo_slides_in_plane(m, &m->plane->contact[k])) {
            c->slides[s++] = k;
        }
    }
    memset(c->angle, 0, c->count * NODES * sizeof *c->angle);
    e->lines.given = h;
    int status = tribo_event_start(e, t, y);
    status = status ? status : find_response(e);
    status = status ? status : find_angles(e, h, &found);
    e->lines.given = 0.0;
    step->good = 0;
    step->next = SHRINKS * h;
    if (!status && found) {
        judge(e, h, step);
    }
    return status;
}

int tribo_creep_begin(struct event *e, double t, const double *y, double most, double *length)
{
    struct creep *c = &e->creep;
    const double least = find_least(&e->events.stick_slip, c), last = c->length;
    const size_t before = e->sys->evaluations;
    /* at once where such steps just became shorter than least */
    c->wait = e->events.anew ? PATIENCE : last > 0.0 && !(last > least) ? 0 : c->wait;
    if (e->events.anew || !(least < most)) {
        c->length = 0.0;
        c->waited = 0;
    }
    e->events.anew = 0;
    *length = 0.0;
    if (e->events.sharp || !(least < most) || (!(c->length > least) && c->waited++ < c->wait)) {
        return TRIBO_OK;
    }
    const double first = c->length > least ? c->length : lesser(FIRST * most, find_settled(e));
    struct creep_step step = {0, lesser(most, first), HUGE_VAL};
    for (int trial = 0; *length == 0.0 && step.next > least && trial < MOST_TRIALS; trial++) {
        const double h = step.next;
        const int status = creep_expand(e, t, y, h, &step);
        if (status) {
            return status;
        }
        const double right = tribo_event_length(e);
        *length = step.good && right >= h ? h : 0.0;
        step.next = step.good && right < h ? 0.9 * right : step.next;
    }
    c->length = *length > 0.0 ? step.next : 0.0;
    c->length = *length == most ? greater(c->length, last) : c->length;
    c->wait = *length > 0.0 ? PATIENCE : DEAR * (e->sys->evaluations - before) / (e->most_order + 1);
    c->waited = 0;
    return TRIBO_OK;
}
