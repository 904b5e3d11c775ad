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

#include <stdint.h>
#include <stdlib.h>
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

/* --------------------------------------------------------------------------------------------------- contacts in planes */

/* Arrays of coefficients of a line. */
#define SERIES 9

int tribo_lines_reserve(struct event *e, size_t begins)
{
    struct lines *s = &e->lines;
    const size_t terms = e->most_order + 2, count = s->count;
    double *x;
    if (s->line && s->room >= count && s->begin_room >= begins) {
        return TRIBO_OK;
    }
    free(s->line);
    s->room = count;
    s->begin_room = begins;
    if (!ALLOCATE(ARRAY(s->line, count), ARRAY(x, SERIES * terms * count), ARRAY(s->begin, begins), ARRAY(s->pivot, begins),
                  ARRAY(s->s, begins * begins), ARRAY(s->lu, begins * begins), ARRAY(s->tau, begins),
                  ARRAY(s->answer, begins * e->sys->ndof), ARRAY(s->held, begins * e->sys->ncontact))) {
        return tribo_error(e->sys->message, TRIBO_ERR_MEMORY, "out of memory for series of %zu contact%s in a plane", count,
                           plural(count));
    }
    for (struct line *l = s->line; l < s->line + count; l++) {
        double **const series[SERIES - 1] = {&l->xn, &l->xt, &l->un, &l->ut, &l->speed, &l->g, &l->a, &l->square};
        for (size_t k = 0; k < SERIES - 1; k++, x += terms) {
            *series[k] = x;
        }
        x += terms; /* square has twice as many */
    }
    return TRIBO_OK;
}

void tribo_line_set_direction(struct line *l, double x, double y)
{
    l->n[0] = l->t[1] = x;
    l->n[1] = y;
    l->t[0] = -y;
}

void tribo_line_force(const struct line *l, size_t k, size_t from, size_t to, double *f)
{
    const double along = tribo_product_of(l->g, l->un, k, from, to), across = tribo_product_of(l->g, l->ut, k, from, to);
    for (size_t d = 0; d < 2; d++) {
        f[d] = -l->weight[d] * (l->n[d] * along + l->t[d] * across);
    }
}

void tribo_line_turn_force(const struct event *e, size_t c, size_t k, const struct perturbed *p, double *force)
{
    const struct line *l = &e->lines.line[c];
    const size_t grows = tribo_normals_follower(e->sys, l->at) ? p->columns : 0; /* columns of g, which else is 0 */
    double power = 1.0;
    for (size_t j = 0; j <= k && j <= e->order; j++, power *= p->tau) {
        const double *f = e->force + j * e->sys->ncontact + l->at, *g = tribo_turn_of(e, p, p->g, k - j, c);
        const double turned[2] = {-f[1] * l->weight[0] / l->weight[1], f[0] * l->weight[1] / l->weight[0]};
        for (size_t d = 0; d < 2; d++) {
            double *to = force + (l->at + d) * p->columns;
            tribo_add(to, l->follows && j == 0 ? 0.0 : power * turned[d], tribo_turn_of(e, p, p->z, k - j, c), p->columns);
            tribo_add(to, -power * l->weight[d] * tribo_line_along(l, d, j), g, grows);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ rigid planar contacts */

/* (weight t)'J acc, acc [ncontact] = J acc. */
static double planar_series_along(const struct planar_contact *p, const struct line *l, const double *acc)
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
    const double size = tribo_series_size(e->lines.line[k].g, 1, tribo_event_limit_terms(e) - 1, tau);
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

/* Sets answer, held and the columns of S: what a unit t-part of each beginning contact does to q'', to holding forces, to
 * accelerations along all t. Returns a status. */
static int find_answers(struct event *e)
{
    struct stick_slip *m = &e->events.stick_slip;
    struct lines *s = &e->lines;
    const tribo_system *sys = e->sys;
    const struct planar_contact *all = m->plane->contact;
    const size_t begins = s->begins, c = sys->ncontact;
    for (size_t q = 0; q < begins; q++) {
        const struct planar_contact *p = &all[s->begin[q]];
        const struct line *l = &s->line[s->begin[q]];
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

int tribo_planar_series_begin(struct event *e)
{
    struct stick_slip *m = &e->events.stick_slip;
    struct lines *s = &e->lines;
    const struct planar_contact *all = m->plane->contact;
    const size_t count = s->count;
    size_t begins = 0;
    for (size_t k = 0; k < count; k++) {
        begins += (size_t)is_implicit(m, &all[k]);
    }
    const int status = tribo_lines_reserve(e, begins);
    if (status) {
        return status;
    }
    /* coefficients stay within MOST_DIGITS: their unit of time is that of the first stop, or of the step; given directions and
     * constant limits make no higher powers of it */
    const double unit = s->given > 0.0 ? s->given : tribo_planar_series_first_stop(m),
                 least = s->given > 0.0 ? LEAST_GIVEN : LEAST_ORDER, most = MOST_DIGITS / greater(-log10(unit), 1.0);
    const int bounded = s->given > 0.0 && e->terms == 1;
    e->order = bounded ? e->most_order : (size_t)lesser((double)e->most_order, greater(most, least));
    s->begins = begins;
    for (size_t k = 0, q = 0; k < count; k++) {
        struct line *l = &s->line[k];
        const int implicit = is_implicit(m, &all[k]);
        l->at = all[k].at;
        l->follows = 0;
        l->weight[0] = all[k].weight[0];
        l->weight[1] = all[k].weight[1];
        l->asymptotic = implicit && all[k].begins == BY_FORCE;
        if (implicit) {
            tribo_line_set_direction(l, all[k].direction[0], all[k].direction[1]);
            s->begin[q++] = k;
        }
    }
    return find_answers(e);
}

/* ------------------------------------------------------------------------------------------------------- coefficients */

/* Part of coefficient k of |x| u along t that does not have the last coefficients of u and |x|. */
static double before(const struct line *l, size_t k)
{
    return tribo_product_of(l->speed, l->ut, k, 1, k);
}

int tribo_planar_series_forces(struct event *e, size_t k, double *v)
{
    const struct stick_slip *m = &e->events.stick_slip;
    for (size_t c = 0; c < m->plane->count; c++) {
        const struct planar_contact *p = &m->plane->contact[c];
        struct line *l = &e->lines.line[c];
        const size_t shift = (size_t)p->begins, j = k - shift;
        const size_t lead = shift < p->lag ? shift : p->lag, a = k - lead; /* a: the last order of u in this force */
        const double x[2] = {p->weight[0] * v[p->at], p->weight[1] * v[p->at + 1]}, size = hypot(x[0], x[1]);
        l->g[k] = k < tribo_event_limit_terms(e) ? e->limit[k * e->sys->ncontact + p->at] / p->weight[0] : 0.0;
        if (!tribo_slides_in_plane(m, p)) {
            continue;
        }
        if (k == shift && !is_implicit(m, p) && size > 0.0) {
            tribo_line_set_direction(l, x[0] / size, x[1] / size);
        }
        if (k < shift) {
            v[p->at] = v[p->at + 1] = 0.0;
        } else {
            l->xn[j] = l->n[0] * x[0] + l->n[1] * x[1];
            l->xt[j] = j ? l->t[0] * x[0] + l->t[1] * x[1] : 0.0;
        }
        if (k == shift && !(l->xn[0] > 0.0)) {
            return tribo_error(e->sys->message, TRIBO_ERR_CHATTER,
                               "at t = %.17g it is not clear in which direction the planar contact %zu begins to slide",
                               e->sys->loads.time, p->at);
        }
        if (e->lines.given == 0.0 && k >= lead) {
            l->un[a] = a ? -0.5 * (tribo_product_of(l->un, l->un, a, 1, a) + tribo_product_of(l->ut, l->ut, a, 1, a)) : 1.0;
            l->ut[a] = a && shift == lead ? (l->xt[a] - before(l, a)) / l->xn[0] : 0.0;
        }
        if (e->lines.given == 0.0 && k >= shift) {
            l->speed[j] = l->xn[j] - tribo_product_of(l->speed, l->un, j, 0, j);
        }
        const size_t terms = tribo_event_limit_terms(e), to = k < terms ? k + 1 : terms;
        double *force = e->force + k * e->sys->ncontact + p->at;
        tribo_line_force(l, k, lead, to, force);
        memcpy(e->room.given + p->at, force, 2 * sizeof *force);
    }
    return TRIBO_OK;
}

int tribo_planar_series_finish(struct event *e, size_t k)
{
    const tribo_system *sys = e->sys;
    const struct planar_contact *all = e->events.stick_slip.plane->contact;
    struct lines *s = &e->lines;
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
        const struct line *l = &s->line[s->begin[q]];
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
        struct line *l = &s->line[s->begin[q]];
        l->ut[k - lag] = s->tau[q];
        for (size_t d = 0; d < 2; d++) {
            e->force[k * sys->ncontact + l->at + d] -= l->weight[d] * l->t[d] * l->g[lag] * s->tau[q];
        }
        tribo_add(e->room.acceleration, s->tau[q], s->answer + q * sys->ndof, sys->ndof);
        tribo_add(e->room.held, s->tau[q], s->held + q * sys->ncontact, sys->ncontact);
    }
    return TRIBO_OK;
}

/* ------------------------------------------------------------------------------------------------------- perturbations */

/* The direction u turns by z, du = z r with r the normal of u. With |x| u = x
 *     |x| z = r'(weight dv),
 * from which each term of z follows; of contacts that begin to slide by the equation of their t-parts, with S. The force turns
 * by -weight g du, and grows by -weight u dg. */

/* w [columns] += term k of r'(weight dv) of contact c, with coefficients of r from `from` on. */
static void add_sideways(const struct event *e, size_t c, const struct perturbed *p, size_t k, size_t from, double *w)
{
    const struct planar_contact *contact = &e->events.stick_slip.plane->contact[c];
    double power = pow(p->tau, (double)from);
    for (size_t j = from; j <= k && j <= e->order; j++, power *= p->tau) {
        const double *v = p->v + (k - j) % p->rows * e->sys->ncontact * p->columns;
        for (size_t i = contact->at; i < contact->at + 2; i++) {
            const double part = contact->weight[i - contact->at] * tribo_line_across(&e->lines.line[c], i - contact->at, j);
            tribo_add(w, power * part, v + i * p->columns, p->columns);
        }
    }
}

/* w [columns] += factor times term k of |x| z of contact c, with coefficients of |x| from `from` on. */
static void add_turned(const struct event *e, size_t c, const struct perturbed *p, size_t k, size_t from, double factor,
                       double *w)
{
    const struct planar_slip *plane = e->events.stick_slip.plane;
    for (size_t j = from; j <= k && j + (size_t)plane->contact[c].begins <= e->order; j++) {
        tribo_add(w, factor * pow(p->tau, (double)j) * e->lines.line[c].speed[j], tribo_turn_of(e, p, p->z, k - j, c),
                  p->columns);
    }
}

void tribo_planar_series_turn(const struct event *e, size_t k, const struct perturbed *p, double *force)
{
    const struct stick_slip *m = &e->events.stick_slip;
    const struct planar_slip *plane = m->plane;
    memset(force, 0, e->sys->ncontact * p->columns * sizeof *force);
    for (size_t c = 0; c < plane->count; c++) {
        const struct planar_contact *contact = &plane->contact[c];
        const struct line *l = &e->lines.line[c];
        double *z = tribo_turn_of(e, p, p->z, k, c);
        memset(z, 0, p->columns * sizeof *z);
        tribo_event_perturb_limit(e, contact->at, p->q, p->columns, tribo_turn_of(e, p, p->g, k, c));
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
        tribo_line_turn_force(e, c, k, p, force);
    }
}

int tribo_planar_series_turn_finish(struct event *e, size_t k, const struct perturbed *p, double *u)
{
    const tribo_system *sys = e->sys;
    const struct planar_slip *plane = e->events.stick_slip.plane;
    struct lines *s = &e->lines;
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
                const double side = contact->weight[d] * tribo_line_across(&s->line[c], d, 0) * sys->direction.val[at];
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
        memcpy(tribo_turn_of(e, p, p->z, k, s->begin[q]), w, p->columns * sizeof *w);
        for (size_t d = 0; d < sys->ndof; d++) {
            tribo_add(u + d * p->columns, part * s->answer[q * sys->ndof + d], w, p->columns);
        }
    }
    return TRIBO_OK;
}

/* -------------------------------------------------------------------------------------------------------------- guards */

void tribo_planar_series_guards(struct event *e)
{
    const struct stick_slip *m = &e->events.stick_slip;
    for (size_t c = 0; c < m->plane->count; c++) {
        struct planar_contact *p = &m->plane->contact[c];
        struct line *l = &e->lines.line[c];
        struct curve *curve = &e->curve[p->at];
        const int moves = tribo_slides_in_plane(m, p);
        const size_t last = e->order - (moves ? (size_t)p->begins : 0);
        const double ratio = m->limits.ratio[p->at], square_ratio = ratio * ratio;
        /* the guard of a contact at rest, (limit^2 - |f|^2)/2 divided by reference, is in units of forces */
        const double most = ratio * e->limit_curve[p->at].size, least = 2.0 * ratio * p->limit[0] - most;
        const double reference = p->varies ? tribo_series_reference(least, most) : ratio;
        const double half = p->half = 0.5 * greater(p->weight[0], p->weight[1]) / reference;
        if (p->varies) {
            p->blunt = reference > least ? reference : 0.0;
            tribo_events_guard_limit(&e->events, p->at, &(struct watch){.varies = 1});
        }
        if (m->state.slip[p->at] == TRIBO_SLIP_OPEN) {
            continue;
        }
        for (size_t k = 0; !moves && k <= e->order; k++) {
            const double *force = e->watch + k * m->constant.contacts + p->at;
            l->xn[k] = force[0] / p->weight[0];
            l->xt[k] = force[1] / p->weight[1];
        }
        for (size_t k = 0; k <= 2 * e->order; k++) { /* terms of the square are not small where those of x end */
            const double square = tribo_series_square(l->xn, 1, k, last) + tribo_series_square(l->xt, 1, k, last);
            const double limit = moves || !p->varies ? 0.0 : square_ratio * tribo_series_square(l->g, 1, k, last);
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
            const double own = PART * e->lines.line[c].xn[0] / greater(p->weight[0], p->weight[1]);
            plane->error[p->at] = plane->error[p->at + 1] = lesser(e->error, own);
        }
    }
}

double tribo_planar_series_shorten(const struct event *e, double h)
{
    const struct stick_slip *m = &e->events.stick_slip;
    for (size_t c = 0; c < m->plane->count && h > 0.0; c++) {
        const struct planar_contact *p = &m->plane->contact[c];
        const struct line *l = &e->lines.line[c];
        if (!tribo_slides_in_plane(m, p)) {
            continue;
        }
        const size_t last = e->order - (size_t)p->begins;
        const double xn = tribo_series_value(l->xn, last, h), xt = tribo_series_value(l->xt, last, h), size = hypot(xn, xt);
        const double off =
            hypot(tribo_series_value(l->un, e->order, h) - xn / size, tribo_series_value(l->ut, e->order, h) - xt / size);
        const double sum = tribo_series_size(l->xn, 1, last, h) + tribo_series_size(l->xt, 1, last, h);
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
