/* SPDX-License-Identifier: BSD-3-Clause */
/* Taylor series of a contact in a plane with a spring of compliance c before its slider. While the slider moves along u, |u| = 1,
 * the force f is -L u, L its limit, and
 *     v + c f' = sigma u,   sigma > 0 the speed of the slider.
 * With w the part of v across u,
 *     u' = A across,   c L A = w,   sigma = v'u - c L',   f' = -L' u - w across/c.
 * lag = 0: w of order k gives A of order k.
 * lag = 1, where L(0) = 0 (touch-down), or the time c L(0)/|v| in which f turns is so short that f follows v: n is along v, the
 * term c L(0) A is left out, and w of order k gives A of order k - 1. Steps of lag = 0 would be as short as that time. */
#include "event_series.h"
#include "common/layout.h"
#include "common/real.h"

#include <float.h>
#include <stdlib.h>
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

/* Arrays of a pair with [order + 2] entries. */
#define SERIES 11

int tribo_pair_series_begin(struct event *e)
{
    const struct stick_slip *m = &e->events.stick_slip;
    struct pair_series *s = &e->pairs;
    const size_t terms = e->most_order + 2, count = m->constant.pairs;
    double *series;
    if (count == 0) {
        s->count = 0;
        return TRIBO_OK;
    }
    if (s->count != count) {
        free(s->line);
        s->count = 0;
        if (!ALLOCATE(ARRAY(s->line, count), ARRAY(series, SERIES * terms * count))) {
            return tribo_error(e->sys->message, TRIBO_ERR_MEMORY, "out of memory for series of %zu contact%s in a plane", count,
                               plural(count));
        }
        for (struct pair_line *l = s->line; l < s->line + count; l++, series += SERIES * terms) {
            *l = (struct pair_line){.un = series,
                                    .ut = series + terms,
                                    .a = series + 2 * terms,
                                    .w = series + 3 * terms,
                                    .vn = series + 4 * terms,
                                    .vt = series + 5 * terms,
                                    .sigma = series + 6 * terms,
                                    .limit = series + 7 * terms,
                                    .rise = series + 8 * terms,
                                    .square = series + 9 * terms};
        }
        s->count = count;
    }
    double unit = 1.0; /* time in which a force turns, or its limit ends */
    for (size_t i = 0, k = 0; k < count; i++) {
        if (m->constant.pair[i] == 1) {
            const double speed = hypot(m->state.glide[i], m->state.glide[i + 1]) / tribo_spring_of(m, i);
            const int slides = m->state.slip[i] == TRIBO_SLIP_PLANE && !tribo_follows_velocity(m, i, m->state.glide + i);
            unit = slides ? lesser(unit, m->state.limit[i] / (speed + fabs(m->state.limit_rate[i]))) : unit;
            s->line[k++].at = i;
        }
    }
    e->order = (size_t)lesser((double)e->order, greater(MOST_DIGITS / greater(-log10(unit), 1.0), LEAST_ORDER));
    return TRIBO_OK;
}

/* Sets n, along which the slider moves first: against the force f [2], or along v [2] if l->lag = 1. */
static void set_first(struct pair_line *l, const double *f, const double *v)
{
    const double side = l->lag ? 1.0 : -1.0, *x = l->lag ? v : f, size = hypot(x[0], x[1]);
    l->n[0] = side * x[0] / size;
    l->n[1] = side * x[1] / size;
}

/* Sets u of order k + 1 from A up to order k. */
static void turn_pair(struct pair_line *l, size_t k)
{
    l->un[k + 1] = -tribo_product_of(l->ut, l->a, k, 0, k + 1) / (double)(k + 1);
    l->ut[k + 1] = tribo_product_of(l->un, l->a, k, 0, k + 1) / (double)(k + 1);
}

/* w of order k. */
static double across(const struct pair_line *l, size_t k)
{
    return tribo_product_of(l->un, l->vt, k, 0, k + 1) - tribo_product_of(l->ut, l->vn, k, 0, k + 1);
}

/* Finds coefficients of order k of pair l, compliance c, and those of u of order k + 1, or k if lag = 1. */
static void expand(struct pair_line *l, double c, size_t k)
{
    if (k == 0) {
        l->un[0] = 1.0;
        l->ut[0] = 0.0;
    } else if (l->lag) { /* w_k = w without A_(k - 1), less vn_0 A_(k - 1)/k */
        l->a[k - 1] = 0.0;
        turn_pair(l, k - 1);
        const double known = k > 1 ? tribo_product_of(l->limit, l->a, k, 2, k + 1) : 0.0;
        l->a[k - 1] = (across(l, k) - c * known) / (c * l->limit[1] + l->vn[0] / (double)k);
        turn_pair(l, k - 1);
    }
    l->w[k] = l->fades ? 0.0 : across(l, k);
    l->sigma[k] = tribo_product_of(l->un, l->vn, k, 0, k + 1) + tribo_product_of(l->ut, l->vt, k, 0, k + 1) - c * l->rise[k];
    if (!l->lag) {
        l->a[k] = (l->w[k] / c - tribo_product_of(l->limit, l->a, k, 1, k + 1)) / l->limit[0];
        turn_pair(l, k);
    }
}

/* Component d of u, of order j. */
static double u_of(const struct pair_line *l, size_t d, size_t j)
{
    return d ? l->n[1] * l->un[j] + l->n[0] * l->ut[j] : l->n[0] * l->un[j] - l->n[1] * l->ut[j];
}

void tribo_pair_series_slide(const struct event *e, size_t k, const double *v, double *slide)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const tribo_system *sys = e->sys;
    for (struct pair_line *l = e->pairs.line; l < e->pairs.line + e->pairs.count; l++) {
        const struct follower *f = tribo_normals_follower(sys, l->at);
        const struct normal *n = f ? &sys->normals.normal[f->normal] : NULL;
        const double c = tribo_spring_of(&e->events.stick_slip, l->at), *x = v + l->at;
        const int still = f && m->state.rests[f->normal] && m->state.limit[l->at] == 0.0; /* regardless of rounding */
        l->limit[k] = k == 0                               ? m->state.limit[l->at]
                      : k < e->terms && !(still && k == 1) ? e->limit[k * sys->ncontact + l->at]
                                                           : 0.0;
        l->rise[k] = n && !(still && k == 0)
                         ? f->mu * n->stiffness * tribo_matrix_row_dot(&sys->direction, n->row, e->u + k * sys->ndof)
                         : 0.0;
        if (m->state.slip[l->at] == TRIBO_SLIP_PLANE) {
            if (k == 0) {
                l->fades = l->limit[0] * e->fastest < -FADES * m->state.limit_rate[l->at];
                l->lag = !l->fades && tribo_follows_velocity(m, l->at, x);
                set_first(l, e->spring + l->at, x);
            }
            l->vn[k] = l->n[0] * x[0] + l->n[1] * x[1];
            l->vt[k] = l->n[0] * x[1] - l->n[1] * x[0];
            expand(l, c, k);
            for (size_t d = 0; l->lag && k > 0 && d < 2; d++) { /* u_k is known now */
                double *own = e->spring + k * sys->ncontact + l->at + d;
                *own = 0.0;
                for (size_t j = 0; j <= k; j++) {
                    *own -= l->limit[j] * u_of(l, d, k - j);
                }
            }
            const double along = tribo_product_of(l->w, l->ut, k, 0, k + 1) / c - tribo_product_of(l->rise, l->un, k, 0, k + 1);
            const double side = -tribo_product_of(l->rise, l->ut, k, 0, k + 1) - tribo_product_of(l->w, l->un, k, 0, k + 1) / c;
            slide[l->at] = l->n[0] * along - l->n[1] * side;
            slide[l->at + 1] = l->n[1] * along + l->n[0] * side;
        }
    }
}

double tribo_pair_series_power(const struct event *e, const struct pair_line *l, size_t k)
{
    const int slides = e->events.stick_slip.state.slip[l->at] == TRIBO_SLIP_PLANE;
    return slides ? tribo_product_of(l->limit, l->sigma, k, 0, k + 1) : 0.0;
}

double tribo_pair_series_power_along(const struct event *e, size_t i, size_t k)
{
    double power = 0.0;
    for (const struct pair_line *l = e->pairs.line; l < e->pairs.line + e->pairs.count; l++) {
        for (size_t j = 0; l->at + 1 >= i && l->at <= i && j <= k; j++) {
            double part = 0.0; /* of u_i^2 */
            for (size_t p = 0; p <= k - j; p++) {
                part += u_of(l, i - l->at, p) * u_of(l, i - l->at, k - j - p);
            }
            power += tribo_pair_series_power(e, l, j) * part;
        }
    }
    return power;
}

void tribo_pair_series_guards(struct event *e)
{
    struct stick_slip *m = &e->events.stick_slip;
    const size_t c = m->constant.contacts;
    for (struct pair_line *l = e->pairs.line; l < e->pairs.line + e->pairs.count; l++) {
        const int slides = m->state.slip[l->at] == TRIBO_SLIP_PLANE;
        struct curve *curve = &e->curve[l->at];
        struct guard g = {.contact = l->at, .output = curve, .kind = slides ? SLIDES : HOLDS, .side = slides ? 1.0 : -1.0};
        if (m->state.slip[l->at] == TRIBO_SLIP_OPEN) {
            continue;
        }
        const double most = tribo_normals_follower(e->sys, l->at) ? e->limit_curve[l->at].size : l->limit[0];
        const double reference = tribo_series_reference(2.0 * l->limit[0] - most, most);
        for (size_t k = 0; k <= 2 * e->order; k++) {
            const size_t from = k < e->order ? 0 : k - e->order, to = k < e->order ? k + 1 : e->order + 1;
            const double *f = e->spring + l->at;
            const double square = slides ? 0.0
                                         : tribo_series_product(f, f, c, k, from, to) +
                                               tribo_series_product(f + 1, f + 1, c, k, from, to) -
                                               tribo_product_of(l->limit, l->limit, k, from, to);
            l->square[k] = slides ? (k <= e->order ? l->sigma[k] : 0.0) : 0.5 * square / reference;
        }
        tribo_curves_bound(curve, 1, 2 * e->order + 1, 1, l->square, e->length);
        g.allowance = slides ? m->noise.factor * (m->noise.velocity[l->at] + m->noise.velocity[l->at + 1])
                             : greater(m->noise.allowance[l->at], m->noise.allowance[l->at + 1]);
        e->events.search.guard[e->events.search.guards++] = g;
    }
}

size_t tribo_pair_series_terms(const struct event *e, size_t most)
{
    for (const struct pair_line *l = e->pairs.line; l < e->pairs.line + e->pairs.count; l++) {
        const int slides = e->events.stick_slip.state.slip[l->at] == TRIBO_SLIP_PLANE;
        most = slides && l->lag && !(l->limit[1] > 0.0) ? e->order : most;
    }
    return most;
}

/* The sum of the sizes of the terms of a series x at h, its coefficients stride doubles apart. */
static double pair_size(const double *x, size_t stride, size_t powers, double h)
{
    double sum = 0.0;
    for (size_t k = powers + 1; k-- > 0;) {
        sum = sum * h + fabs(x[k * stride]);
    }
    return sum;
}

/* The sum of the terms of a force by h, in units of that of its limit. */
static double pair_reach(const struct event *e, const struct pair_line *l, double h)
{
    const double *f = e->spring + l->at, limit = pair_size(l->limit, 1, e->order, h);
    const size_t c = e->sys->ncontact;
    return (pair_size(f, c, e->order, h) + pair_size(f + 1, c, e->order, h)) / limit;
}

/* The error of the velocity v by h, in parts of it, where a force that is not 0 is along v: it lags behind by c L A/|v|. 1/c is
 * at most fastest^2 times the mass. */
static double pair_lag(const struct event *e, const struct pair_line *l, double h)
{
    const double c = tribo_spring_of(&e->events.stick_slip, l->at) / l->vn[0] * e->fastest;
    const double turn = hypot(tribo_series_value(l->un, e->order, h) - 1.0, tribo_series_value(l->ut, e->order, h));
    return c * c * l->limit[0] * pair_size(l->limit, 1, e->order, h) * turn;
}

double tribo_pair_series_shorten(const struct event *e, double h, double most)
{
    const struct stick_slip *m = &e->events.stick_slip;
    h = e->pairs.count ? lesser(h, most) : h;
    for (struct pair_line *l = e->pairs.line; l < e->pairs.line + e->pairs.count; l++) {
        while (m->state.slip[l->at] == TRIBO_SLIP_STUCK && l->limit[0] > 0.0 && h > 0.0 && !(pair_reach(e, l, h) <= BEYOND)) {
            h *= 0.5;
        }
        if (m->state.slip[l->at] != TRIBO_SLIP_PLANE || l->fades) {
            continue;
        }
        while (l->lag && h > 0.0 && !(pair_lag(e, l, h) <= LAGS)) {
            h *= 0.8;
        }
        if (!e->events.sharp) {
            continue;
        }
        const double slides = tribo_spring_of(m, l->at) * l->limit[0];
        h = l->sigma[0] * h > FADING * slides && !l->lag ? FADING * slides / l->sigma[0] : h;
        size_t power = l->lag; /* with which the limit changes */
        while (power < e->order && l->limit[power] == 0.0) {
            power++;
        }
        h = tribo_series_within(l->limit + power, e->order - power, l->square, h);
        while (h > 0.0 && !(fabs(hypot(tribo_series_value(l->un, e->order, h), tribo_series_value(l->ut, e->order, h)) - 1.0) <=
                            TRIBO_STRAIGHT)) {
            h *= 0.8;
        }
    }
    return h;
}

/* ------------------------------------------------------------------------------------------------------- perturbations */

/* With u turned by z, du = z across, and the limit L + dL,
 *     c L z' + c A dL = across'dv - v'u z,   df = -u dL - L across z. */

/* Component d of across, of order j. */
static double across_of(const struct pair_line *l, size_t d, size_t j)
{
    return d ? u_of(l, 0, j) : -u_of(l, 1, j);
}

void tribo_pair_series_turn(const struct event *e, size_t k, const struct pair_turns *p, const double *q, const double *v)
{
    const tribo_system *sys = e->sys;
    const size_t columns = p->columns, each = e->pairs.count * columns, all = sys->ncontact * columns;
    for (size_t s = 0; s < e->pairs.count; s++) {
        const struct pair_line *l = &e->pairs.line[s];
        const double c = tribo_spring_of(&e->events.stick_slip, l->at);
        double *g = p->g + k % p->rows * each + s * columns;
        tribo_event_perturb_limit(e, l->at, q, columns, g);
        if (e->events.stick_slip.state.slip[l->at] != TRIBO_SLIP_PLANE) {
            continue;
        }
        const size_t to = l->lag ? k : k + 1;
        double *z = p->z + to % p->rows * each + s * columns, power = 1.0;
        memset(z, 0, columns * sizeof *z);
        for (size_t j = 0; !l->fades && j <= k && j <= e->order; j++, power *= p->tau) {
            const double *turned = p->z + (k - j) % p->rows * each + s * columns;
            for (size_t d = 0; d < 2; d++) {
                const double *dv = v + (k - j) % p->rows * all + (l->at + d) * columns;
                tribo_add(z, power * across_of(l, d, j), dv, columns);
            }
            tribo_add(z, -power * c * (l->lag && j == e->order ? 0.0 : l->a[j]), p->g + (k - j) % p->rows * each + s * columns,
                      columns);
            tribo_add(z, l->lag && j == 0 ? 0.0 : -power * (l->sigma[j] + c * l->rise[j]), turned, columns);
            if (j > l->lag) {
                const double *before = p->z + (k + 1 - j) % p->rows * each + s * columns;
                tribo_add(z, -power / p->tau * c * l->limit[j] * (double)(k + 1 - j), before, columns);
            }
        }
        const double by =
            l->lag ? c * l->limit[1] * (double)k + l->sigma[0] + c * l->rise[0] : c * l->limit[0] * (double)(k + 1) / p->tau;
        for (size_t i = 0; i < columns; i++) {
            z[i] /= by;
        }
    }
}

void tribo_pair_series_force(const struct event *e, size_t k, const struct pair_turns *p, const double *q, double *force)
{
    const size_t columns = p->columns, each = e->pairs.count * columns;
    for (size_t s = 0; s < e->pairs.count; s++) {
        const struct pair_line *l = &e->pairs.line[s];
        double *f = force + l->at * columns, power = 1.0;
        if (e->events.stick_slip.state.slip[l->at] != TRIBO_SLIP_PLANE) {
            continue;
        }
        tribo_event_perturb_limit(e, l->at, q, columns, p->g + k % p->rows * each + s * columns);
        if (k == 0 && !l->lag) { /* z by the part of the force across u */
            double *z = p->z + s * columns;
            for (size_t i = 0; i < columns; i++) {
                z[i] = -(across_of(l, 0, 0) * f[i] + across_of(l, 1, 0) * f[columns + i]) / l->limit[0];
            }
        }
        memset(f, 0, 2 * columns * sizeof *f);
        for (size_t j = 0; j <= k && j <= e->order; j++, power *= p->tau) {
            const size_t at = (k - j) % p->rows * each + s * columns;
            for (size_t d = 0; d < 2; d++) {
                double turns = 0.0; /* L across */
                for (size_t i = 0; i <= j; i++) {
                    turns += l->limit[i] * across_of(l, d, j - i);
                }
                tribo_add(f + d * columns, -power * u_of(l, d, j), p->g + at, columns);
                tribo_add(f + d * columns, l->lag && j == 0 ? 0.0 : -power * turns, p->z + at, columns);
            }
        }
    }
}
