/* SPDX-License-Identifier: BSD-3-Clause */
#include "event_series.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NODES TRIBO_CREEP_NODES

/* Most sliding planar contacts for steps by collocation: Newton's matrices are dense. */
#define MOST_CONTACTS 128

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

void tribo_creep_free(struct creep *c)
{
    free(c->weight);
    free(c->slides);
    memset(c, 0, sizeof *c);
}

/* --------------------------------------------------------------------------------------------------------- what it takes */

static int reserve(struct event *e, size_t slides)
{
    struct creep *c = &e->creep;
    const size_t contacts = e->events.stick_slip.plane->count, terms = e->most_order + 1, unknowns = slides * NODES;
    if (c->weight && c->contacts >= contacts && c->room >= slides) {
        return TRIBO_OK;
    }
    tribo_creep_free(c);
    const size_t response = 4 * slides * contacts * terms;
    c->weight = malloc((terms * NODES * NODES + response + unknowns * (unknowns + 1) + contacts * NODES) * sizeof *c->weight);
    c->slides = malloc((contacts + unknowns) * sizeof *c->slides);
    if (!c->weight || !c->slides) {
        tribo_creep_free(c);
        return tribo_system_fail(e->sys, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s that creep", slides, plural(slides));
    }
    c->response = c->weight + terms * NODES * NODES;
    c->matrix = c->response + response;
    c->rest = c->matrix + unknowns * unknowns;
    c->angle = c->rest + unknowns;
    c->pivot = (int *)(c->slides + contacts);
    c->contacts = contacts;
    c->room = slides;
    c->terms = terms;
    memset(c->basis, 0, sizeof c->basis);
    for (size_t i = 0; i < NODES; i++) {
        double *b = c->basis[i];
        b[0] = 1.0;
        for (size_t j = 0; j < NODES; j++) { /* times (x - node_j)/(node_i - node_j) */
            for (size_t k = NODES - 1; j != i && k < NODES; k--) {
                b[k] = ((k ? b[k - 1] : 0.0) - node[j] * b[k]) / (node[i] - node[j]);
            }
        }
    }
    /* a force time^k acts as a constant one does, with m! k!/(m + k)! time^(m + k) for time^m */
    for (size_t m = 0; m < c->terms; m++) {
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
    return TRIBO_OK;
}

static size_t count_sliding(const struct stick_slip *m)
{
    size_t count = 0;
    for (size_t k = 0; k < m->plane->count; k++) {
        count += (size_t)tribo_slides_in_plane(m, &m->plane->contact[k]);
    }
    return count;
}

double tribo_creep_least(const struct event *e, const double *y)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const size_t count = count_sliding(m);
    const double part = (double)count / FEW_CONTACTS;
    int begins = 0;
    for (size_t k = 0; k < m->plane->count; k++) {
        begins |= tribo_slides_in_plane(m, &m->plane->contact[k]) && m->plane->contact[k].begins != SLIDES_ON;
    }
    return count == 0 || count > MOST_CONTACTS || begins
               ? HUGE_VAL
               : PAYS * greater(1.0, part * part * part) * tribo_planar_series_first_stop(m, e->sys, y);
}

/* --------------------------------------------------------------------------------------------------------- directions */

/* Fits the polynomial u of contact k through c->angle at the nodes. */
static void fit(struct event *e, size_t k, double h)
{
    const struct creep *c = &e->creep;
    struct planar_line *l = &e->planar.line[k];
    double power = 1.0;
    memset(l->un, 0, (e->order + 1) * sizeof *l->un);
    memset(l->ut, 0, (e->order + 1) * sizeof *l->ut);
    for (size_t p = 0; p < NODES; p++) {
        for (size_t i = 0; i < NODES; i++) {
            l->un[p] += power * c->basis[i][p] * cos(c->angle[k * NODES + i]);
            l->ut[p] += power * c->basis[i][p] * sin(c->angle[k * NODES + i]);
        }
        power /= h;
    }
}

/* Rate of turn of the direction of contact k at the end of the last step. */
static double event_creep_turn_of(const struct event *e, size_t k)
{
    const struct planar_line *l = &e->planar.line[k];
    double un = 0.0, ut = 0.0, dn = 0.0, dt = 0.0;
    for (size_t p = e->order + 1; p-- > 0;) {
        dn = dn * e->length + un;
        dt = dt * e->length + ut;
        un = un * e->length + l->un[p];
        ut = ut * e->length + l->ut[p];
    }
    return un * dt - ut * dn;
}

double tribo_creep_settled(const struct event *e, const double *y, double error)
{
    const struct stick_slip *m = &e->events.stick_slip;
    double length = HUGE_VAL;
    for (size_t k = 0; k < m->plane->count; k++) {
        const struct planar_contact *p = &m->plane->contact[k];
        const double v =
            hypot(tribo_stick_slip_velocity(m, e->sys, p->at, y), tribo_stick_slip_velocity(m, e->sys, p->at + 1, y));
        const double stop = tribo_planar_series_stop(m, e->sys, p, y);
        const double turn = tribo_slides_in_plane(m, p) ? fabs(event_creep_turn_of(e, k)) : 0.0;
        const int follows = turn <= TURNS * e->fastest || turn * stop <= lesser(MOST_STRAY, error / v);
        length = follows ? length : lesser(length, stop);
    }
    return length;
}

/* ------------------------------------------------------------------------------------------------------------ response */

/* to [terms][2 contacts] += factor times the series of x. */
static void add_series(const struct event *e, double factor, double *to)
{
    const struct planar_slip *plane = e->events.stick_slip.plane;
    for (size_t k = 0; k <= e->order; k++) {
        for (size_t i = 0; i < 2 * plane->count; i++) {
            const struct planar_contact *p = &plane->contact[i / 2];
            to[k * 2 * plane->count + i] += factor * p->limit[i % 2] * e->watch[k * e->sys->ncontact + p->at + i % 2];
        }
    }
}

/* c->response of all that slide, as a difference to the motion without their friction. */
static int find_response(struct event *e, size_t slides)
{
    struct creep *c = &e->creep;
    const size_t row = 2 * e->events.stick_slip.plane->count, bytes = (e->order + 1) * sizeof(double);
    for (size_t s = 0; s < slides; s++) {
        memset(e->planar.line[c->slides[s]].un, 0, bytes);
        memset(e->planar.line[c->slides[s]].ut, 0, bytes);
    }
    int status = tribo_event_series(e);
    memset(c->response, 0, 2 * slides * c->terms * row * sizeof *c->response);
    for (size_t s = 0; !status && s < 2 * slides; s++) {
        add_series(e, -1.0, c->response + s * c->terms * row);
    }
    for (size_t s = 0; !status && s < 2 * slides; s++) {
        struct planar_line *l = &e->planar.line[c->slides[s / 2]];
        l->un[0] = l->n[s % 2];
        l->ut[0] = l->t[s % 2];
        status = tribo_event_series(e);
        l->un[0] = l->ut[0] = 0.0;
        add_series(e, 1.0, c->response + s * c->terms * row);
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------------- Newton */

/* w = u turned by a right angle, along the axes, at node i of the s-th sliding contact. */
static void across(const struct event *e, size_t s, size_t i, double *w)
{
    const size_t k = e->creep.slides[s];
    const struct planar_line *l = &e->planar.line[k];
    const double cosine = cos(e->creep.angle[k * NODES + i]), sine = sin(e->creep.angle[k * NODES + i]);
    for (size_t d = 0; d < 2; d++) {
        w[d] = cosine * l->t[d] - sine * l->n[d];
    }
}

/* to [NODES][NODES] = response of x along `axis` of all contacts to a force along axis `from` of the sliding ones. */
static void add_response(const struct event *e, size_t from, size_t axis, double h, double (*to)[NODES])
{
    const struct creep *c = &e->creep;
    const size_t row = 2 * e->events.stick_slip.plane->count;
    double power = 1.0;
    memset(to, 0, NODES * sizeof *to);
    for (size_t m = 0; m <= e->order; m++) {
        const double r = power * c->response[(from * c->terms + m) * row + axis];
        for (size_t j = 0; r != 0.0 && j < NODES * NODES; j++) {
            to[j / NODES][j % NODES] += r * c->weight[m * NODES * NODES + j];
        }
        power *= h;
    }
}

/* One step of Newton's method; returns its size, HUGE_VAL if there is none. */
static double improve(struct event *e, size_t slides, double h)
{
    struct creep *c = &e->creep;
    const size_t unknowns = slides * NODES;
    for (size_t s = 0; s < slides * slides; s++) {
        /* block (a, b): derivative of the part of x_a across u_a by the angles of contact b */
        const size_t a = s / slides;
        const size_t b = s % slides;
        double from[NODES][2], to[NODES][2], part[NODES][NODES];
        for (size_t i = 0; i < NODES; i++) {
            across(e, b, i, from[i]);
            across(e, a, i, to[i]);
            memset(e->creep.matrix + (a * NODES + i) * unknowns + b * NODES, 0, NODES * sizeof *e->creep.matrix);
        }
        for (size_t d = 0; d < 4; d++) {
            add_response(e, 2 * b + d / 2, 2 * e->creep.slides[a] + d % 2, h, part);
            for (size_t j = 0; j < NODES; j++) {
                double *row = e->creep.matrix + (a * NODES + j) * unknowns + b * NODES;
                for (size_t i = 0; i < NODES; i++) {
                    row[i] += to[j][d % 2] * part[j][i] * from[i][d / 2];
                }
            }
        }
    }
    /* rest = x across u; less x along u on the diagonal */
    for (size_t at = 0; at < unknowns; at++) {
        const size_t k = c->slides[at / NODES], j = at % NODES;
        const struct planar_line *l = &e->planar.line[k];
        const double cosine = cos(c->angle[k * NODES + j]), sine = sin(c->angle[k * NODES + j]);
        const double xn = tribo_planar_series_value(l->xn, e->order, node[j] * h);
        const double xt = tribo_planar_series_value(l->xt, e->order, node[j] * h);
        c->rest[at] = xt * cosine - xn * sine;
        c->matrix[at * unknowns + at] -= xn * cosine + xt * sine;
    }
    if (!(tribo_lu_create(c->matrix, unknowns, c->pivot) > 0.0)) {
        return HUGE_VAL;
    }
    tribo_lu_solve(c->matrix, unknowns, c->pivot, c->rest, 1);
    for (size_t s = 0; s < unknowns; s++) {
        c->angle[c->slides[s / NODES] * NODES + s % NODES] -= c->rest[s];
    }
    return tribo_largest(c->rest, unknowns);
}

/* Error of directions allowed over a step, by the error of velocities that forces make of it. */
static double allowed(const struct event *e, size_t k, double h, double error)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const struct planar_contact *p = &m->plane->contact[k];
    const double r = greater(p->limit[0] * m->constant.diagonal[p->at], p->limit[1] * m->constant.diagonal[p->at + 1]);
    return lesser(MOST_OFF, error * (double)(NODES + 1) / (r * h));
}

/* A step ends where |x| has fallen to this part (method_event.c): a smaller x need not have the direction of u. */
#define LEFT 1e-2

/* x along u and across u at tau. */
static void take_parts(const struct event *e, size_t k, double tau, double *along, double *across)
{
    const struct planar_line *l = &e->planar.line[k];
    const double xn = tribo_planar_series_value(l->xn, e->order, tau), xt = tribo_planar_series_value(l->xt, e->order, tau);
    const double un = tribo_planar_series_value(l->un, NODES - 1, tau), ut = tribo_planar_series_value(l->ut, NODES - 1, tau);
    *along = un * xn + ut * xt;
    *across = un * xt - ut * xn;
}

/* The time in which friction would stop contact k, |x| being size. */
static double stop_of(const struct event *e, size_t k, double size)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const struct planar_contact *p = &m->plane->contact[k];
    const double n = p->limit[0] * p->limit[0] * m->constant.diagonal[p->at],
                 t = p->limit[1] * p->limit[1] * m->constant.diagonal[p->at + 1];
    return size / greater(n, t);
}

/* Stray: velocity across u at tau in a step of length h, in units of its error allowed. Friction takes it away at once, or the
 * part of it that it can take in such a step. */
static double find_stray(const struct event *e, size_t k, double h, double tau, double error)
{
    const struct planar_contact *p = &e->events.stick_slip.plane->contact[k];
    double along, across;
    take_parts(e, k, tau, &along, &across);
    const double size = greater(hypot(along, across), LEFT * e->planar.line[k].xn[0]);
    const double gone = fabs(across) / size * lesser(1.0, h / stop_of(e, k, size));
    return gone / lesser(MOST_STRAY, error * lesser(p->limit[0], p->limit[1]) / size);
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
    return along > 0.0 || fabs(across) < 0.5 * LEFT * e->planar.line[k].xn[0];
}

/* h, halved until the speed over the step is at most FASTER times that at its start. */
static double find_slow_part(const struct event *e, size_t k, double h)
{
    const struct planar_line *l = &e->planar.line[k];
    double part = h;
    for (size_t i = 0; i < NODES; i++) {
        while (hypot(tribo_planar_series_value(l->xn, e->order, node[i] * part),
                     tribo_planar_series_value(l->xt, e->order, node[i] * part)) > FASTER * l->xn[0]) {
            part *= 0.5;
        }
    }
    return part;
}

/* Error of a step, between nodes, in units of that allowed; HUGE_VAL if the contact does not slide along u. That of directions is
 * the last power between nodes. */
static double find_defect(const struct event *e, size_t k, double h, double error)
{
    const struct planar_line *l = &e->planar.line[k];
    double most = 2.0 * pow(0.25 * h, NODES - 1) * hypot(l->un[NODES - 1], l->ut[NODES - 1]) / allowed(e, k, h, error);
    for (size_t i = 0; i < NODES; i++) {
        most = greater(most, find_stray(e, k, h, 0.5 * h * (node[i] + (i ? node[i - 1] : 0.0)), error));
    }
    return is_with(e, k, h) ? most : HUGE_VAL;
}

static int find_angles(struct event *e, size_t slides, double h, double error, int *found)
{
    struct creep *c = &e->creep;
    double most = MOST_OFF, before = TOO_FAR;
    for (size_t s = 0; s < slides; s++) {
        most = lesser(most, allowed(e, c->slides[s], h, error));
    }
    for (int iteration = 0; iteration < MOST_ITERATIONS; iteration++) {
        for (size_t s = 0; s < slides; s++) {
            fit(e, c->slides[s], h);
        }
        const int status = tribo_event_series(e);
        if (status) {
            return status;
        }
        const double step = improve(e, slides, h);
        double stray = 0.0;
        for (size_t j = 0; j < slides * NODES; j++) {
            stray = greater(stray, find_stray(e, c->slides[j / NODES], h, node[j % NODES] * h, error));
        }
        *found = step <= ENOUGH * most && stray <= STRAY_ENOUGH;
        if (*found || !(step < before)) {
            return TRIBO_OK;
        }
        before = HEADWAY * step;
    }
    return TRIBO_OK;
}

int tribo_creep_expand(struct event *e, double t, const double *y, double h, double error, struct creep_step *step)
{
    struct creep *c = &e->creep;
    const size_t slides = count_sliding(&e->events.stick_slip);
    int status = reserve(e, slides), found = 0;
    if (status) {
        return status;
    }
    /* slides: the planar contacts that slide */
    const struct stick_slip *m = &e->events.stick_slip;
    for (size_t k = 0, count = 0; k < m->plane->count; k++) {
        if (tribo_slides_in_plane(m, &m->plane->contact[k])) {
            e->creep.slides[count++] = k;
        }
    }
    for (size_t s = 0; s < slides; s++) {
        /* guess: directions go on turning at their rate */
        const size_t k = c->slides[s];
        const double turn = event_creep_turn_of(e, k);
        for (size_t i = 0; i < NODES; i++) {
            e->creep.angle[k * NODES + i] = fabs(turn * h) < 1.0 ? turn * h * node[i] : 0.0;
        }
    }
    e->planar.given = 1;
    status = tribo_event_start(e, t, y);
    status = status ? status : find_response(e, slides);
    status = status ? status : find_angles(e, slides, h, error, &found);
    e->planar.given = 0;
    step->good = 0;
    step->next = SHRINKS * h;
    if (!status && found) {
        /* A contact that creeps may start in another direction than its equation asks for, at any length of the step: stray is no
         * reason for shorter steps then. */
        double defect = 0.0, slow = h, stray = 0.0;
        for (size_t s = 0; s < slides; s++) {
            const size_t k = c->slides[s];
            const double begins = find_stray(e, k, h, 0.0, error);
            stray = h > PAYS * stop_of(e, k, e->planar.line[k].xn[0]) ? greater(stray, begins) : stray;
            defect = greater(defect, greater(begins, find_defect(e, k, h, error)));
            slow = lesser(slow, find_slow_part(e, k, h));
        }
        const int stays = stray > 1.0 && stray > LESS_STRAY * step->stray;
        step->good = defect <= 1.0 && slow == h;
        step->next = stays ? 0.0 : slow < h ? slow : h * lesser(greater(0.8 * pow(defect, -1.0 / NODES), SHRINKS), GROWS);
        step->stray = stray;
    }
    return status;
}
