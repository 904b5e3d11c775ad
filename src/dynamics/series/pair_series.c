/* SPDX-License-Identifier: BSD-3-Clause */
/* Taylor series of a contact in a plane with a spring of compliance c before its slider. While the slider moves along u, |u| = 1,
 * the force f is -L u, L its limit, and
 *     v + c f' = sigma u,   sigma > 0 the speed of the slider.
 * L, sigma and A are g, speed and a of struct line, v is xn and xt; u' = A r, r the normal of u. The part of order k along t
 * gives u of order k + 1, that along n sigma of order k.
 * follows = 1 where L(0) = 0 (touch-down), or where f turns in so short a time c L(0)/|v| that f follows v: n is along v, the
 * term c L(0) A is left out, and order k gives u of order k. Steps of follows = 0 would be as short as that time. */
#include "event_series.h"
#include "common/real.h"

#include <string.h>

/* Time before lift-off, in units of 1 over the highest frequency, in which the force is too small for its direction to count:
 * there A becomes infinite, and steps ever shorter. */
#define FADES 1e-7

/* Decimal digits of the largest coefficient, and the least order. */
#define MOST_DIGITS 100.0
#define LEAST_ORDER 4.0

/* Longest step of a periodic motion, in units of the time c L/sigma in which perturbations across u fade. */
#define FADING 3.0

/* Largest sum of the terms of a force at rest over a step, in units of the limit: else the limit is lost in the rounding of the
 * square of the force. */
#define BEYOND 100.0

/* Error of a velocity that the force follows, in parts of it. */
#define LAGS 1e-13

int tribo_pair_series_begin(struct event *e)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const int status = tribo_lines_reserve(e, 0);
    if (status) {
        return status;
    }
    double unit = 1.0; /* time in which a force turns, or its limit ends */
    for (size_t i = 0, k = 0; k < e->lines.count; i++) {
        if (m->constant.pair[i] == 1) {
            const double speed = hypot(m->state.glide[i], m->state.glide[i + 1]) / tribo_spring_of(m, i);
            const int slides = m->state.slip[i] == TRIBO_SLIP_PLANE && !tribo_follows_velocity(m, i, m->state.glide + i);
            struct line *l = &e->lines.line[k++];
            unit = slides ? lesser(unit, m->state.limit[i] / (speed + fabs(m->state.limit_rate[i]))) : unit;
            l->at = i;
            l->weight[0] = l->weight[1] = 1.0;
            l->asymptotic = 0;
        }
    }
    e->order = (size_t)lesser((double)e->order, greater(MOST_DIGITS / greater(-log10(unit), 1.0), LEAST_ORDER));
    return TRIBO_OK;
}

/* Sets u of order k + 1 (follows = 1: k), A of one order less and speed of order k by the equation of order k; c: compliance. */
static void expand(struct line *l, double c, size_t k)
{
    const size_t at = l->follows ? k : k + 1, from = l->follows;
    const double times = c * (double)(k + 1);
    if (k == 0) {
        l->un[0] = 1.0;
        l->ut[0] = 0.0;
    }
    if (at > 0) {
        l->un[at] = -0.5 * (tribo_product_of(l->un, l->un, at, 1, at) + tribo_product_of(l->ut, l->ut, at, 1, at));
        l->ut[at] = 0.0;
        const double turned = times * tribo_product_of(l->g, l->ut, k + 1, from, k + 2);
        const double rest = l->xt[k] - tribo_product_of(l->speed, l->ut, k, 0, k) - turned;
        l->ut[at] = l->fades ? 0.0 : rest / (times * l->g[from] + (l->follows ? l->speed[0] : 0.0));
        l->a[at - 1] = 0.0;
        for (size_t j = 1; j <= at; j++) {
            l->a[at - 1] += (double)j * (l->un[at - j] * l->ut[j] - l->ut[at - j] * l->un[j]);
        }
    }
    const double turned = times * tribo_product_of(l->g, l->un, k + 1, from, k + 2);
    l->speed[k] = l->xn[k] - tribo_product_of(l->speed, l->un, k, 0, k) - turned;
}

void tribo_pair_series_slide(const struct event *e, size_t k, const double *v, double *slide)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const tribo_system *sys = e->sys;
    for (struct line *l = e->lines.line; l < e->lines.line + e->lines.count; l++) {
        const struct follower *f = tribo_normals_follower(sys, l->at);
        const struct normal *n = f ? &sys->normals.normal[f->normal] : NULL;
        const double *x = v + l->at;
        const int still = f && m->state.rests[f->normal] && m->state.limit[l->at] == 0.0; /* regardless of rounding */
        l->g[0] = m->state.limit[l->at];
        l->g[k + 1] =
            still && k == 0 ? 0.0
            : n ? f->mu * n->stiffness / (double)(k + 1) * tribo_matrix_row_dot(&sys->direction, n->row, e->u + k * sys->ndof)
            : k + 1 < e->terms ? e->limit[(k + 1) * sys->ncontact + l->at]
                               : 0.0;
        if (m->state.slip[l->at] != TRIBO_SLIP_PLANE) {
            continue;
        }
        if (k == 0) {
            l->fades = l->g[0] * e->fastest < -FADES * m->state.limit_rate[l->at];
            l->follows = !l->fades && tribo_follows_velocity(m, l->at, x);
            l->asymptotic = l->follows && !(l->g[1] > 0.0);
            const double *along = l->follows ? x : e->force + l->at;
            const double side = l->follows ? 1.0 : -1.0, size = hypot(along[0], along[1]);
            tribo_line_set_direction(l, side * along[0] / size, side * along[1] / size);
        }
        l->xn[k] = l->n[0] * x[0] + l->n[1] * x[1];
        l->xt[k] = l->n[0] * x[1] - l->n[1] * x[0];
        expand(l, tribo_spring_of(m, l->at), k);
        if (l->follows && k > 0) { /* u_k is known by this order */
            tribo_line_force(l, k, 0, k + 1, e->force + k * sys->ncontact + l->at);
        }
        tribo_line_force(l, k + 1, l->follows, k + 2, slide + l->at);
        slide[l->at] *= (double)(k + 1);
        slide[l->at + 1] *= (double)(k + 1);
    }
}

void tribo_pair_series_guards(struct event *e)
{
    struct stick_slip *m = &e->events.stick_slip;
    const size_t c = m->constant.contacts;
    for (struct line *l = e->lines.line; l < e->lines.line + e->lines.count; l++) {
        const int slides = m->state.slip[l->at] == TRIBO_SLIP_PLANE;
        struct curve *curve = &e->curve[l->at];
        struct guard g = {.contact = l->at, .output = curve, .kind = slides ? SLIDES : HOLDS, .side = slides ? 1.0 : -1.0};
        if (m->state.slip[l->at] == TRIBO_SLIP_OPEN) {
            continue;
        }
        const double most = tribo_normals_follower(e->sys, l->at) ? e->limit_curve[l->at].size : l->g[0];
        const double reference = tribo_series_reference(2.0 * l->g[0] - most, most);
        for (size_t k = 0; !slides && k <= 2 * e->order; k++) {
            const double *f = e->force + l->at;
            const double square = tribo_series_square(f, c, k, e->order) + tribo_series_square(f + 1, c, k, e->order);
            l->square[k] = 0.5 * (square - tribo_series_square(l->g, 1, k, e->order)) / reference;
        }
        tribo_curves_bound(curve, 1, (slides ? 1 : 2) * e->order + 1, 1, slides ? l->speed : l->square, e->length);
        g.allowance = slides ? m->noise.factor * (m->noise.velocity[l->at] + m->noise.velocity[l->at + 1])
                             : greater(m->noise.allowance[l->at], m->noise.allowance[l->at + 1]);
        e->events.search.guard[e->events.search.guards++] = g;
    }
}

/* The error of the velocity v by h, in parts of it, where a force that is not 0 is along v: it lags behind by c L A/|v|. 1/c is
 * at most fastest^2 times the mass. */
static double pair_lag(const struct event *e, const struct line *l, double h)
{
    const double c = tribo_spring_of(&e->events.stick_slip, l->at) / l->xn[0] * e->fastest;
    const double turn = hypot(tribo_series_value(l->un, e->order, h) - 1.0, tribo_series_value(l->ut, e->order, h));
    return c * c * l->g[0] * tribo_series_size(l->g, 1, e->order, h) * turn;
}

double tribo_pair_series_shorten(const struct event *e, double h, double most)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const size_t c = e->sys->ncontact;
    h = e->lines.count ? lesser(h, most) : h;
    for (struct line *l = e->lines.line; l < e->lines.line + e->lines.count; l++) {
        const double *f = e->force + l->at;
        while (m->state.slip[l->at] == TRIBO_SLIP_STUCK && l->g[0] > 0.0 && h > 0.0 &&
               !((tribo_series_size(f, c, e->order, h) + tribo_series_size(f + 1, c, e->order, h)) /
                     tribo_series_size(l->g, 1, e->order, h) <=
                 BEYOND)) {
            h *= 0.5;
        }
        if (m->state.slip[l->at] != TRIBO_SLIP_PLANE || l->fades) {
            continue;
        }
        while (l->follows && h > 0.0 && !(pair_lag(e, l, h) <= LAGS)) {
            h *= 0.8;
        }
        if (!e->events.sharp) {
            continue;
        }
        const double slides = tribo_spring_of(m, l->at) * l->g[0];
        h = l->speed[0] * h > FADING * slides && !l->follows ? FADING * slides / l->speed[0] : h;
        size_t power = l->follows; /* with which the limit changes */
        while (power < e->order && l->g[power] == 0.0) {
            power++;
        }
        h = tribo_series_within(l->g + power, e->order - power, l->square, h);
        while (h > 0.0 && !(fabs(hypot(tribo_series_value(l->un, e->order, h), tribo_series_value(l->ut, e->order, h)) - 1.0) <=
                            TRIBO_STRAIGHT)) {
            h *= 0.8;
        }
    }
    return h;
}

/* ------------------------------------------------------------------------------------------------------- perturbations */

/* With u turned by z, du = z r, and the limit L + dL,
 *     c L z' + c A dL = r'dv - v'u z,   df = -u dL - L z r. */

void tribo_pair_series_turn(const struct event *e, size_t k, const struct perturbed *p)
{
    const size_t columns = p->columns, all = e->sys->ncontact * columns;
    for (size_t s = 0; s < e->lines.count; s++) {
        const struct line *l = &e->lines.line[s];
        const double c = tribo_spring_of(&e->events.stick_slip, l->at);
        tribo_event_perturb_limit(e, l->at, p->q, columns, tribo_turn_of(e, p, p->g, k, s));
        if (e->events.stick_slip.state.slip[l->at] != TRIBO_SLIP_PLANE) {
            continue;
        }
        double *z = tribo_turn_of(e, p, p->z, l->follows ? k : k + 1, s), power = 1.0;
        memset(z, 0, columns * sizeof *z);
        for (size_t j = 0; !l->fades && j <= k && j <= e->order; j++, power *= p->tau) {
            for (size_t d = 0; d < 2; d++) {
                const double *dv = p->v + (k - j) % p->rows * all + (l->at + d) * columns;
                tribo_add(z, power * tribo_line_across(l, d, j), dv, columns);
            }
            tribo_add(z, -power * c * (l->follows && j == e->order ? 0.0 : l->a[j]), tribo_turn_of(e, p, p->g, k - j, s),
                      columns);
            tribo_add(z, l->follows && j == 0 ? 0.0 : -power * (l->speed[j] + c * (double)(j + 1) * l->g[j + 1]),
                      tribo_turn_of(e, p, p->z, k - j, s), columns);
            if (j > l->follows) {
                const double *before = tribo_turn_of(e, p, p->z, k + 1 - j, s);
                tribo_add(z, -power / p->tau * c * l->g[j] * (double)(k + 1 - j), before, columns);
            }
        }
        const double times = c * (double)(k + 1), by = l->follows ? times * l->g[1] + l->speed[0] : times * l->g[0] / p->tau;
        for (size_t i = 0; i < columns; i++) {
            z[i] /= by;
        }
    }
}

void tribo_pair_series_force(const struct event *e, size_t k, const struct perturbed *p, double *force)
{
    const size_t columns = p->columns;
    for (size_t s = 0; s < e->lines.count; s++) {
        const struct line *l = &e->lines.line[s];
        double *f = force + l->at * columns, *z = tribo_turn_of(e, p, p->z, k, s);
        if (e->events.stick_slip.state.slip[l->at] != TRIBO_SLIP_PLANE) {
            continue;
        }
        tribo_event_perturb_limit(e, l->at, p->q, columns, tribo_turn_of(e, p, p->g, k, s));
        for (size_t i = 0; k == 0 && !l->follows && i < columns; i++) { /* z by the part of the force across u */
            z[i] = -(tribo_line_across(l, 0, 0) * f[i] + tribo_line_across(l, 1, 0) * f[columns + i]) / l->g[0];
        }
        memset(f, 0, 2 * columns * sizeof *f);
        tribo_line_turn_force(e, s, k, p, force);
    }
}
