/* SPDX-License-Identifier: BSD-3-Clause */
/* Taylor series of the forces of sliding planar contacts, found coefficient by coefficient with those of the motion.
 *
 * The limit of a contact is weight g, g a series: 1 if the limit is constant. By its weights it has the velocity x = weight v,
 * which is tau^s times a series, with s = 0 where it slides already, and 1 or 2 where it begins to (stick_slip.h); and the
 * direction u = x/|x|, which makes the force -weight g u. Both are taken along the first direction n and its normal t:
 *     |u| = 1   gives the n-part of each coefficient of u from those before,
 *     x = |x| u gives its t-part, if x is known; and the next one of |x|.
 * Where the contact begins to slide x follows from the acceleration, and so from the force itself: then t-parts, tau_k, solve
 *     (S + D_k) tau_k = acceleration along weight t without t-parts - terms of the coefficients before,
 * with S the response of such accelerations to t-parts while contacts at rest are held;
 * D_k = (k + 1)|x_0| for s = 1, and 0 for s = 2.
 * At touch-down g begins with tau^p, p > 0. The force of order k contains u up to order k - p, so that x gives all t-parts if
 * p >= s; for s = 2 and p = 1 t-parts of order k - 1 solve the equation with D_k.
 * For s = 1 the series converges; for s = 2 it is asymptotic: as good as its last terms, which are what a step is chosen by.
 *
 * Or u is given, a polynomial, and only what follows from it is found (event_creep.c). */
#include "event_series.h"
#include "common/layout.h"

#include <float.h>
#include <stdint.h>
#include <string.h>

/* Decimal digits of the largest coefficient; squares have twice as many. At a small speed time is short, and its inverse
 * powers are large. */
#define MOST_DIGITS 100.0

/* Error of a velocity, in parts of the contact's own speed, even if that is far below the tolerance: the direction counts. */
#define PART 1e-4

/* Least orders. */
#define LEAST_ORDER 4.0
#define LEAST_GIVEN (TRIBO_CREEP_NODES + 2.0)

/* Largest sum of the terms of a speed over a step, in units of the speed at its start: else the square of a small speed is
 * lost in rounding, and with it a zero. */
#define FASTER 1e4

/* Makes room for all planar contacts, and for those that begin to slide. Returns 0 if out of memory. */
static int reserve_lines(struct event *e, size_t begins)
{
    struct planar_series *s = &e->planar;
    const size_t terms = e->most_order + 1, count = e->events.stick_slip.plane->count;
    double *series;
    if (s->line && s->room >= count && s->begin_room >= begins) {
        return 1;
    }
    free(s->line);
    const int done =
        ALLOCATE(ARRAY(s->line, count), ARRAY(series, 10 * terms * count), ARRAY(s->begin, begins), ARRAY(s->pivot, begins),
                 ARRAY(s->s, begins * begins), ARRAY(s->lu, begins * begins), ARRAY(s->tau, begins),
                 ARRAY(s->answer, begins * e->sys->ndof), ARRAY(s->held, begins * e->sys->ncontact)) != NULL;
    for (size_t k = 0; done && k < count; k++, series += 10 * terms) {
        s->line[k] = (struct planar_line){.xn = series,
                                          .xt = series + terms,
                                          .un = series + 2 * terms,
                                          .ut = series + 3 * terms,
                                          .speed = series + 4 * terms,
                                          .g = series + 5 * terms,
                                          .fn = series + 6 * terms,
                                          .ft = series + 7 * terms,
                                          .square = series + 8 * terms};
    }
    s->room = count;
    s->begin_room = begins;
    return done;
}

/* (weight t)'J acc, acc [ncontact] = J acc. */
static double planar_series_along(const struct planar_contact *p, const struct planar_line *l, const double *acc)
{
    return p->weight[0] * l->t[0] * acc[p->at] + p->weight[1] * l->t[1] * acc[p->at + 1];
}

/* 1 if contact p slides, and t-parts of its u solve equations with those of others. */
static int is_implicit(const struct stick_slip *m, const struct planar_contact *p)
{
    return tribo_slides_in_plane(m, p) && (size_t)p->begins > p->lag;
}

double tribo_planar_series_brake(const struct event *e, size_t k, double tau)
{
    double size = 0.0;
    for (size_t j = tribo_event_limit_terms(e); j-- > 0;) {
        size = size * tau + fabs(e->planar.line[k].g[j]);
    }
    return e->events.stick_slip.plane->contact[k].brake * size;
}

double tribo_planar_series_first_stop(const struct stick_slip *m)
{
    double least = HUGE_VAL;
    for (size_t k = 0; k < m->plane->count; k++) {
        const struct planar_contact *p = &m->plane->contact[k];
        const int slides = tribo_slides_in_plane(m, p) && p->begins == SLIDES_ON;
        least = slides ? lesser(least, p->stop) : least;
    }
    return least;
}

/* Sets n and the normal t of a line. */
static void set_direction(struct planar_line *l, double x, double y)
{
    l->n[0] = l->t[1] = x;
    l->n[1] = y;
    l->t[0] = -y;
}

int tribo_planar_series_begin(struct event *e)
{
    struct stick_slip *m = &e->events.stick_slip;
    struct planar_series *s = &e->planar;
    const tribo_system *sys = e->sys;
    const struct planar_contact *all = m->plane->contact;
    const size_t count = m->plane->count, c = sys->ncontact;
    size_t begins = 0;
    for (size_t k = 0; k < count; k++) {
        begins += (size_t)is_implicit(m, &all[k]);
    }
    if (!reserve_lines(e, begins)) {
        return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for series of %zu contact%s in a plane", count,
                           plural(count));
    }
    /* coefficients stay within MOST_DIGITS: their unit of time is that of the first stop, or of the step; given directions and
     * constant limits make no higher powers of it */
    const double unit = s->given > 0.0 ? s->given : tribo_planar_series_first_stop(m),
                 least = s->given > 0.0 ? LEAST_GIVEN : LEAST_ORDER, most = MOST_DIGITS / greater(-log10(unit), 1.0);
    const int bounded = s->given > 0.0 && e->terms == 1;
    e->order = bounded ? e->most_order : (size_t)lesser((double)e->most_order, greater(most, least));
    s->begins = begins;
    for (size_t k = 0, q = 0; q < begins; k++) {
        if (is_implicit(m, &all[k])) {
            set_direction(&s->line[k], all[k].direction[0], all[k].direction[1]);
            s->begin[q++] = k;
        }
    }
    /* answer, held and a column of S: what a unit t-part of beginning contact q does to q'', to holding forces, to accelerations
     * along all t */
    for (size_t q = 0; q < begins; q++) {
        const struct planar_contact *p = &all[s->begin[q]];
        const struct planar_line *l = &s->line[s->begin[q]];
        double *acc = s->answer + q * sys->ndof, *a = e->room.a, *f = e->room.given;
        memset(acc, 0, sys->ndof * sizeof *acc);
        memset(f, 0, c * sizeof *f);
        const double *g = p->lag ? m->state.limit_rate + p->at : p->limit;
        f[p->at] = -g[0] * l->t[0];
        f[p->at + 1] = -g[1] * l->t[1];
        tribo_matrix_multiply_add(&sys->response, 1.0, f, acc);
        const int status = tribo_stick_slip_pull(m, sys, m->constant.still, acc, s->held + q * c);
        if (status) {
            return status;
        }
        tribo_matrix_multiply(&sys->direction, acc, a);
        for (size_t r = 0; r < begins; r++) {
            s->s[r * begins + q] = -planar_series_along(&all[s->begin[r]], &s->line[s->begin[r]], a);
        }
    }
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------- coefficients */

/* Part of coefficient k of |x| u along t that does not have the last coefficients of u and |x|. */
static double before(const struct planar_line *l, size_t k)
{
    return tribo_product_of(l->speed, l->ut, k, 1, k);
}

int tribo_planar_series_forces(struct event *e, size_t k, const double *v)
{
    const struct stick_slip *m = &e->events.stick_slip;
    for (size_t c = 0; c < m->plane->count; c++) {
        const struct planar_contact *p = &m->plane->contact[c];
        struct planar_line *l = &e->planar.line[c];
        const size_t shift = (size_t)p->begins, j = k - shift;
        const size_t lead = shift < p->lag ? shift : p->lag, a = k - lead; /* a: the last order of u in this force */
        const double x[2] = {p->weight[0] * v[p->at], p->weight[1] * v[p->at + 1]}, size = hypot(x[0], x[1]);
        l->g[k] = k < tribo_event_limit_terms(e) ? e->limit[k * e->sys->ncontact + p->at] / p->weight[0] : 0.0;
        if (!tribo_slides_in_plane(m, p)) {
            continue;
        }
        if (k == shift && !is_implicit(m, p) && size > 0.0) {
            set_direction(l, x[0] / size, x[1] / size);
        }
        if (k >= shift) {
            l->xn[j] = l->n[0] * x[0] + l->n[1] * x[1];
            l->xt[j] = j ? l->t[0] * x[0] + l->t[1] * x[1] : 0.0;
        }
        if (k == shift && !(l->xn[0] > 0.0)) {
            return tribo_error(e->sys->message, TRIBO_ERR_CHATTER,
                               "at t = %.17g it is not clear in which direction the planar contact %zu begins to slide",
                               e->sys->loads.time, p->at);
        }
        if (e->planar.given == 0.0 && k >= lead) {
            l->un[a] = a ? -0.5 * (tribo_product_of(l->un, l->un, a, 1, a) + tribo_product_of(l->ut, l->ut, a, 1, a)) : 1.0;
            l->ut[a] = a && shift == lead ? (l->xt[a] - before(l, a)) / l->xn[0] : 0.0;
        }
        if (e->planar.given == 0.0 && k >= shift) {
            l->speed[j] = l->xn[j] - tribo_product_of(l->speed, l->un, j, 0, j);
        }
        const size_t terms = tribo_event_limit_terms(e), to = k < terms ? k + 1 : terms;
        l->fn[k] = tribo_product_of(l->g, l->un, k, lead, to);
        l->ft[k] = tribo_product_of(l->g, l->ut, k, lead, to);
        for (size_t d = 0; d < 2; d++) {
            e->room.given[p->at + d] = -p->weight[d] * (l->n[d] * l->fn[k] + l->t[d] * l->ft[k]);
        }
    }
    return TRIBO_OK;
}

int tribo_planar_series_finish(struct event *e, size_t k)
{
    const tribo_system *sys = e->sys;
    const struct planar_contact *all = e->events.stick_slip.plane->contact;
    struct planar_series *s = &e->planar;
    const size_t n = s->begins;
    const double times = (double)(k + 1);
    double *a = e->room.a;
    if (n == 0 || k == 0) {
        return TRIBO_OK;
    }
    tribo_matrix_multiply(&sys->direction, e->room.acceleration, a);
    tribo_add(a, -1.0, e->room.base, sys->ncontact);
    memcpy(s->lu, s->s, n * n * sizeof *s->s);
    for (size_t q = 0; q < n; q++) {
        const struct planar_contact *p = &all[s->begin[q]];
        const struct planar_line *l = &s->line[s->begin[q]];
        double asked = k > 1 ? l->ut[k - 1] * l->xn[0] + before(l, k - 1) : 0.0;
        if ((size_t)p->begins == p->lag + 1) {
            asked = before(l, k - p->lag);
            s->lu[q * n + q] += times * l->xn[0];
        }
        s->tau[q] = planar_series_along(p, l, a) - times * asked;
        if (k == p->lag) { /* u_0 = n */
            memset(s->lu + q * n, 0, n * sizeof *s->lu);
            s->lu[q * n + q] = 1.0;
            s->tau[q] = 0.0;
        }
    }
    if (!(tribo_lu_create(s->lu, n, s->pivot) > 0.0)) {
        return tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                           "at t = %.17g friction cannot turn the planar contact %zu, which begins to slide", sys->loads.time,
                           all[s->begin[0]].at);
    }
    tribo_lu_solve(s->lu, n, s->pivot, s->tau, 1);
    for (size_t q = 0; q < n; q++) {
        const size_t lag = all[s->begin[q]].lag;
        struct planar_line *l = &s->line[s->begin[q]];
        l->ut[k - lag] = s->tau[q];
        l->ft[k] += l->g[lag] * s->tau[q];
        tribo_add(e->room.acceleration, s->tau[q], s->answer + q * sys->ndof, sys->ndof);
        tribo_add(e->room.held, s->tau[q], s->held + q * sys->ncontact, sys->ncontact);
    }
    return TRIBO_OK;
}

double tribo_planar_series_power(const struct event *e, size_t k)
{
    const struct stick_slip *m = &e->events.stick_slip;
    double power = 0.0;
    for (size_t c = 0; c < m->plane->count; c++) {
        const struct planar_contact *p = &m->plane->contact[c];
        const struct planar_line *l = &e->planar.line[c];
        const size_t j = k - (size_t)p->begins;
        if (tribo_slides_in_plane(m, p) && k >= (size_t)p->begins) {
            power += e->sys->tally[p->at] *
                     (tribo_product_of(l->fn, l->xn, j, 0, j + 1) + tribo_product_of(l->ft, l->xt, j, 0, j + 1));
        }
    }
    return power;
}

double tribo_planar_series_power_along(const struct event *e, size_t i, size_t k)
{
    const struct stick_slip *m = &e->events.stick_slip;
    double power = 0.0;
    for (size_t c = 0; c < m->plane->count; c++) {
        const struct planar_contact *p = &m->plane->contact[c];
        const struct planar_line *l = &e->planar.line[c];
        const size_t d = i - p->at, shift = (size_t)p->begins;
        if (d < 2 && tribo_slides_in_plane(m, p)) {
            for (size_t j = 0; j + shift <= k; j++) {
                const double x = l->n[d] * l->xn[j] + l->t[d] * l->xt[j];
                power += x * (l->n[d] * l->fn[k - shift - j] + l->t[d] * l->ft[k - shift - j]);
            }
        }
    }
    return power;
}

/* ------------------------------------------------------------------------------------------------------- perturbations */

/* The direction u turns by z, du = z r with r the normal of u. With |x| u = x
 *     |x| z = r'(weight dv),
 * from which each term of z follows; of contacts that begin to slide by the equation of their t-parts, with S. The force turns
 * by -weight g du, and grows by -weight u dg. */

size_t tribo_planar_series_terms(const struct event *e, size_t most)
{
    const struct planar_contact *all = e->events.stick_slip.plane->contact;
    for (size_t q = 0; q < e->planar.begins; q++) {
        most = all[e->planar.begin[q]].begins == BY_FORCE ? e->order : most;
    }
    return most;
}

/* Component d of the coefficient j of r. */
static double normal_of(const struct planar_line *l, size_t d, size_t j)
{
    return l->t[d] * l->un[j] - l->n[d] * l->ut[j];
}

/* w [columns] += term k of r'(weight dv) of contact c, with coefficients of r from `from` on. */
static void add_sideways(const struct event *e, size_t c, const struct planar_turns *p, size_t k, size_t from, double *w)
{
    const struct planar_contact *contact = &e->events.stick_slip.plane->contact[c];
    double power = pow(p->tau, (double)from);
    for (size_t j = from; j <= k && j <= e->order; j++, power *= p->tau) {
        const double *v = p->v + (k - j) % p->rows * e->sys->ncontact * p->columns;
        for (size_t i = contact->at; i < contact->at + 2; i++) {
            const double part = contact->weight[i - contact->at] * normal_of(&e->planar.line[c], i - contact->at, j);
            tribo_add(w, power * part, v + i * p->columns, p->columns);
        }
    }
}

/* w [columns] += factor times term k of |x| z of contact c, with coefficients of |x| from `from` on. */
static void add_turned(const struct event *e, size_t c, const struct planar_turns *p, size_t k, size_t from, double factor,
                       double *w)
{
    const struct planar_slip *plane = e->events.stick_slip.plane;
    for (size_t j = from; j <= k && j + (size_t)plane->contact[c].begins <= e->order; j++) {
        const double *z = p->z + ((k - j) % p->rows * plane->count + c) * p->columns;
        tribo_add(w, factor * pow(p->tau, (double)j) * e->planar.line[c].speed[j], z, p->columns);
    }
}

void tribo_planar_series_turn(const struct event *e, size_t k, const struct planar_turns *p, double *force)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const struct planar_slip *plane = m->plane;
    memset(force, 0, e->sys->ncontact * p->columns * sizeof *force);
    for (size_t c = 0; c < plane->count; c++) {
        const struct planar_contact *contact = &plane->contact[c];
        const struct planar_line *l = &e->planar.line[c];
        double *z = p->z + (k % p->rows * plane->count + c) * p->columns;
        memset(z, 0, p->columns * sizeof *z);
        tribo_event_perturb_limit(e, contact->at, p->q, p->columns, p->g + (k % p->rows * plane->count + c) * p->columns);
        if (!tribo_slides_in_plane(m, contact)) {
            continue;
        }
        if (contact->begins == SLIDES_ON) {
            add_sideways(e, c, p, k, 0, z);
            add_turned(e, c, p, k, 1, -1.0, z);
            for (size_t j = 0; j < p->columns; j++) {
                z[j] /= l->speed[0];
            }
        }
        double power = 1.0;
        for (size_t j = 0; j <= k && j <= e->order; j++, power *= p->tau) {
            const size_t at = ((k - j) % p->rows * plane->count + c) * p->columns;
            for (size_t d = 0; d < 2; d++) {
                const double turns = l->t[d] * l->fn[j] - l->n[d] * l->ft[j], grows = l->n[d] * l->un[j] + l->t[d] * l->ut[j];
                double *to = force + (contact->at + d) * p->columns;
                tribo_add(to, -power * contact->weight[d] * turns, p->z + at, p->columns);
                tribo_add(to, -power * contact->weight[d] * grows, p->g + at, contact->varies ? p->columns : 0);
            }
        }
    }
}

int tribo_planar_series_turn_finish(struct event *e, size_t k, const struct planar_turns *p, double *u)
{
    const tribo_system *sys = e->sys;
    const struct planar_slip *plane = e->events.stick_slip.plane;
    struct planar_series *s = &e->planar;
    const size_t n = s->begins;
    const double part = p->tau / (double)(k + 1);
    memcpy(s->lu, s->s, n * n * sizeof *s->s);
    for (size_t q = 0; q < n; q++) {
        const size_t c = s->begin[q];
        const struct planar_contact *contact = &plane->contact[c];
        double *w = p->w + q * p->columns;
        memset(w, 0, p->columns * sizeof *w);
        for (size_t d = 0; d < 2; d++) {
            const size_t i = contact->at + d;
            for (size_t at = sys->direction.first[i]; at < sys->direction.first[i + 1]; at++) {
                const double side = contact->weight[d] * normal_of(&s->line[c], d, 0) * sys->direction.val[at];
                tribo_add(w, side, u + sys->direction.col[at] * p->columns, p->columns);
            }
        }
        add_sideways(e, c, p, k + 1, 1, w);
        if (contact->begins == BY_ACCELERATION) {
            add_turned(e, c, p, k, 1, -p->tau, w);
            s->lu[q * n + q] += (double)(k + 1) * s->line[c].speed[0];
        } else if (k > 0) {
            add_turned(e, c, p, k - 1, 0, -p->tau * p->tau, w);
        }
        for (size_t j = 0; j < p->columns; j++) {
            w[j] /= part;
        }
    }
    if (n > 0 && !(tribo_lu_create(s->lu, n, s->pivot) > 0.0)) {
        return tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                           "at t = %.17g the planar contact %zu begins to slide, and motions beside this one leave it at once",
                           sys->loads.time, plane->contact[s->begin[0]].at);
    }
    tribo_lu_solve(s->lu, n, s->pivot, p->w, p->columns);
    for (size_t q = 0; q < n; q++) {
        const double *w = p->w + q * p->columns;
        memcpy(p->z + (k % p->rows * plane->count + s->begin[q]) * p->columns, w, p->columns * sizeof *w);
        for (size_t d = 0; d < sys->ndof; d++) {
            tribo_add(u + d * p->columns, part * s->answer[q * sys->ndof + d], w, p->columns);
        }
    }
    return TRIBO_OK;
}

/* -------------------------------------------------------------------------------------------------------------- guards */

/* Returns the limit at rest by which the guard of a contact at rest, (limit^2 - |f|^2)/2 divided by it, is in units of forces:
 * the least one of the step, not below a part of the largest one. Sets blunt. */
static double find_reference(const struct event *e, struct planar_contact *p)
{
    const double ratio = e->events.stick_slip.limits.ratio[p->at];
    const double most = ratio * e->limit_curve[p->at].size, least = 2.0 * ratio * p->limit[0] - most;
    const double reference = tribo_series_reference(least, most);
    p->blunt = reference > least ? reference : 0.0;
    return reference;
}

void tribo_planar_series_guards(struct event *e)
{
    const struct stick_slip *m = &e->events.stick_slip;
    for (size_t c = 0; c < m->plane->count; c++) {
        struct planar_contact *p = &m->plane->contact[c];
        struct planar_line *l = &e->planar.line[c];
        struct curve *curve = &e->curve[p->at];
        const int moves = tribo_slides_in_plane(m, p);
        const size_t last = e->order - (moves ? (size_t)p->begins : 0);
        const double ratio = m->limits.ratio[p->at], square_ratio = ratio * ratio;
        const double half = 0.5 * greater(p->weight[0], p->weight[1]) / (p->varies ? find_reference(e, p) : ratio);
        if (p->varies) {
            tribo_events_guard_limit(&e->events, p->at, &(struct watch){.varies = 1});
        }
        p->half = half;
        if (m->state.slip[p->at] == TRIBO_SLIP_OPEN) {
            continue;
        }
        for (size_t k = 0; !moves && k <= e->order; k++) {
            const double *force = e->watch + k * m->constant.contacts + p->at;
            l->xn[k] = force[0] / p->weight[0];
            l->xt[k] = force[1] / p->weight[1];
        }
        for (size_t k = 0; k <= 2 * e->order; k++) { /* terms of the square are not small where those of x end */
            const size_t from = k < last ? 0 : k - last, to = k < last ? k + 1 : last + 1;
            const double square = tribo_product_of(l->xn, l->xn, k, from, to) + tribo_product_of(l->xt, l->xt, k, from, to);
            const double limit = moves || !p->varies ? 0.0 : square_ratio * tribo_product_of(l->g, l->g, k, from, to);
            l->square[k] = moves ? square : half * (square - limit);
        }
        tribo_curves_bound(curve, 1, 2 * e->order + 1, 1, l->square, e->length);
        struct guard g = {.contact = p->at, .output = curve, .kind = moves ? SLOWS : HOLDS, .side = moves ? 1.0 : -1.0};
        g.allowance = moves ? 0.0 : greater(m->noise.allowance[p->at], m->noise.allowance[p->at + 1]);
        g.offset = moves ? -TRIBO_SLOWER * TRIBO_SLOWER * l->square[0] : p->varies ? 0.0 : square_ratio * half;
        g.offset += tribo_drops(m, p->at) ? g.allowance : 0.0; /* a static limit is lost for more than rounding only */
        if (moves || p->varies || curve->size >= g.offset) {
            e->events.search.guard[e->events.search.guards++] = g;
        }
    }
}

void tribo_planar_series_errors(struct event *e)
{
    const struct planar_slip *plane = e->events.stick_slip.plane;
    for (size_t i = 0; i < e->sys->ncontact; i++) {
        plane->error[i] = e->error;
    }
    for (size_t c = 0; c < plane->count; c++) {
        const struct planar_contact *p = &plane->contact[c];
        if (tribo_slides_in_plane(&e->events.stick_slip, p) && p->begins == SLIDES_ON) {
            const double own = PART * e->planar.line[c].xn[0] / greater(p->weight[0], p->weight[1]);
            plane->error[p->at] = plane->error[p->at + 1] = lesser(e->error, own);
        }
    }
}

double tribo_planar_series_shorten(const struct event *e, double h)
{
    const struct stick_slip *m = &e->events.stick_slip;
    for (size_t c = 0; c < m->plane->count && h > 0.0; c++) {
        const struct planar_contact *p = &m->plane->contact[c];
        const struct planar_line *l = &e->planar.line[c];
        if (!tribo_slides_in_plane(m, p)) {
            continue;
        }
        const size_t last = e->order - (size_t)p->begins;
        const double xn = tribo_series_value(l->xn, last, h), xt = tribo_series_value(l->xt, last, h), size = hypot(xn, xt);
        const double off =
            hypot(tribo_series_value(l->un, e->order, h) - xn / size, tribo_series_value(l->ut, e->order, h) - xt / size);
        double sum = 0.0;
        for (size_t k = last + 1; k-- > 0;) {
            sum = sum * h + fabs(l->xn[k]) + fabs(l->xt[k]);
        }
        h = e->events.sharp ? tribo_series_within(l->speed, last, l->square, h) : h;
        if ((e->events.sharp && !(off <= TRIBO_STRAIGHT)) ||
            !(off * tribo_planar_series_brake(e, c, h) * h / (double)(e->order + 1) <= m->plane->error[p->at] &&
              sum <= FASTER * l->xn[0])) {
            h *= 0.8;
            c = SIZE_MAX; /* from the first contact on */
        }
    }
    return h;
}
