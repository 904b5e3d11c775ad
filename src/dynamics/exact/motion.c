/* SPDX-License-Identifier: BSD-3-Clause */
#include "motion.h"
#include "common/layout.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* |lambda tau| below which the change of an exponential is computed by tribo_exp_1: a difference would lose digits. */
#define LITTLE 0.1

/* Makes room for twice the terms and shapes of x->h, since the next structure may have more. Returns 0 if out of memory. */
static int motion_reserve(struct exact *x)
{
    const size_t least = x->h->terms > x->h->shapes ? x->h->terms : x->h->shapes, room = 2 * least + TRIBO_POWERS;
    const size_t c = x->sys->ncontact;
    free(x->lot);
    x->room =
        ALLOCATE(ARRAY(x->lot, room / TRIBO_TERMS + 1), ARRAY(x->course, 2 * c), ARRAY(x->way, c), ARRAY(x->steady, c),
                 ARRAY(x->work, room + 2 * x->sys->ndof), ARRAY(x->power, (4 * x->sys->ndof + c) * TRIBO_POWERS),
                 ARRAY(x->z.re, room), ARRAY(x->z.im, room), ARRAY(x->far_e.re, room), ARRAY(x->far_e.im, room),
                 ARRAY(x->move.re, room), ARRAY(x->move.im, room), ARRAY(x->rate_move.re, room), ARRAY(x->rate_move.im, room),
                 ARRAY(x->growth, room), ARRAY(x->growth6, room), ARRAY(x->vel, room), ARRAY(x->jerk, room),
                 ARRAY(x->slopes.rate, room), ARRAY(x->slopes.lead, room), ARRAY(x->slopes.bend, room),
                 ARRAY(x->slopes.rest, room), ARRAY(x->slopes.limit, c), ARRAY(x->slopes.rise, c), ARRAY(x->acc, room),
                 ARRAY(x->drift, room), ARRAY(x->place, room), ARRAY(x->rate, room))
            ? room
            : 0;
    return x->room > 0;
}

void tribo_modal_settle(const struct modal *h, size_t columns, const double *force, double *eta, double *rate, double *vel,
                        double *acc)
{
    if (h->stiff) {
        tribo_follow_settle(h, columns, force, eta, vel, acc);
        return;
    }
    for (size_t k = 0, at = 0; k < h->modes; k++) {
        const double stiff = h->omega2[k], damping = h->damping[k];
        const int drifts = tribo_modal_drifts(h, k);
        for (size_t j = 0; j < columns; j++, at++) {
            acc[at] = drifts ? force[at] : 0.0;
            vel[at] = !drifts && stiff == 0.0 ? force[at] / damping : 0.0;
            eta[at] -= stiff != 0.0 ? force[at] / stiff : 0.0;
            rate[at] -= vel[at];
        }
    }
}

void tribo_modal_split(const struct modal *h, size_t columns, const double *eta, const double *rate, double *zr, double *zi)
{
    const size_t m = h->modes, e = h->exponents;
    if (!h->owner) {
        memset(zr, 0, e * columns * sizeof *zr);
        memset(zi, 0, e * columns * sizeof *zi);
        tribo_multiply_transposed_add(m, e, columns, h->left.ar, eta, zr);
        tribo_multiply_transposed_add(m, e, columns, h->left.br, rate, zr);
        tribo_multiply_transposed_add(m, e, columns, h->left.ai, eta, zi);
        tribo_multiply_transposed_add(m, e, columns, h->left.bi, rate, zi);
        return;
    }
    for (size_t p = 0, at = 0; p < e; p++) {
        const double *q = eta + h->owner[p] * columns, *u = rate + h->owner[p] * columns;
        for (size_t j = 0; j < columns; j++, at++) {
            zr[at] = h->left.ar[p] * q[j] + h->left.br[p] * u[j];
            zi[at] = h->left.ai[p] * q[j] + h->left.bi[p] * u[j];
        }
    }
}

void tribo_modal_join(const struct modal *h, size_t columns, const double *zr, const double *zi, double *eta)
{
    if (!h->owner) {
        tribo_multiply_transposed_add(h->exponents, h->modes, columns, h->rr, zr, eta);
        tribo_multiply_transposed_add(h->exponents, h->modes, columns, h->ri, zi, eta);
    }
    for (size_t p = 0; h->owner && p < h->exponents; p++) {
        for (size_t j = 0; j < columns; j++) {
            eta[h->owner[p] * columns + j] += zr[p * columns + j];
        }
    }
}

/* ------------------------------------------------------------------------------------------------------------------- later on */

/* Adds to w of exponents the parts by resonant harmonics: z' = lambda z - (i/nu) Re(g e^{i Omega t}), z = 0 at t0. */
static void add_resonances(struct exact *x, double tau)
{
    const struct forced *h = x->h;
    const size_t m = h->modal->modes, e = h->modal->exponents;
    for (size_t at = 0; at < h->harmonics * e; at++) {
        const size_t p = at % e, s = at / e, resonance = s * m + h->modal->owner[p];
        if (!h->resonant[resonance]) {
            continue;
        }
        const double omega = h->forcing[s].omega, nu = h->li[p];
        const double complex lambda = h->lr[p] + nu * I, g = h->g[resonance];
        const double complex now = g * tribo_now(x, e + s, 0), then = 0.5 * g * tribo_part(&x->z, e + s);
        const double complex grown = tau * exp(h->lr[p] * tau) * (cos(nu * tau) + sin(nu * tau) * I);
        const double complex sum =
            then * tribo_exp_1(tau * (omega * I - lambda)) + conj(then) * tribo_exp_1(tau * (-omega * I - lambda));
        double complex z = -I / nu * grown * sum;
        for (size_t order = 0; order < 3; order++) {
            tribo_lot(x, p)->re[order][p % TRIBO_TERMS] += creal(z);
            tribo_lot(x, p)->im[order][p % TRIBO_TERMS] += cimag(z);
            z = lambda * z - (order ? -omega * cimag(now) : creal(now)) / nu * I;
        }
    }
}

void tribo_modal_motion_go(struct exact *x, double tau)
{
    if (tau == x->tau) {
        return;
    }
    x->tau = tau;
    if (!x->h->modal->powers) {
        tribo_modal_terms_go(x, tau);
    }
    if (x->h->resonant) {
        add_resonances(x, tau);
    }
}

struct course *tribo_modal_limit_course(const struct exact *x, size_t i, double *mu)
{
    const struct normals *s = &x->sys->normals;
    const struct follower *f = tribo_normals_follower(x->sys, i);
    const struct normal *n = f ? &s->normal[f->normal] : tribo_normals_at(x->sys, i);
    *mu = f ? f->mu : 1.0;
    return n ? &x->course[x->h->holding + (size_t)(n - s->normal)] : x->sys->loads.limits ? &x->course[x->h->limits + i] : NULL;
}

struct sample tribo_modal_motion_limit(struct exact *x, size_t i)
{
    double mu;
    struct course *part = tribo_modal_limit_course(x, i, &mu);
    if (part->tau != x->tau) {
        tribo_course_look(x, part);
    }
    return (struct sample){mu * part->at.g, mu * part->at.d, mu * part->at.e};
}

/* Sets place and rate of all shapes. */
static void move_shapes(struct exact *x, int brief)
{
    const struct forced *h = x->h;
    const struct modal *own = h->modal;
    const size_t e = own->exponents, shapes = h->shapes;
    for (size_t k = 0; k < shapes; k++) {
        const double acc = x->runs ? x->acc[k] + x->jerk[k] * x->tau / 3.0 : 0.0; /* for the place */
        x->place[k] = x->runs ? x->tau * (x->drift[k] + 0.5 * acc * x->tau) : 0.0;
        x->rate[k] = x->runs ? (brief ? 0.0 : x->drift[k]) + (x->acc[k] + 0.5 * x->jerk[k] * x->tau) * x->tau : 0.0;
    }
    for (size_t p = 0; p < e + h->harmonics; p++) {
        const double complex lambda = h->lr[p] + h->li[p] * I;
        if (p >= e && h->size[p] == 0.0) { /* z_p is constant */
            continue;
        }
        double complex move = tribo_now(x, p, 0) - tribo_part(&x->z, p);
        if (x->tau * h->size[p] < LITTLE && !(h->resonant && p < e)) {
            /* With a load far above the frequency of exponent p, or in a short slip under a limit far above all other forces,
             * this small change of z is the whole motion: a difference would lose digits. */
            move = tribo_part(&x->z, p) * x->tau * lambda * tribo_exp_1(x->tau * lambda);
        }
        const double complex rate = brief ? lambda * move : tribo_now(x, p, 1);
        const double er = creal(move), ei = cimag(move), fr = creal(rate), fi = cimag(rate);
        if (p < e && own->owner) {
            x->place[own->owner[p]] += er;
            x->rate[own->owner[p]] += fr;
        } else if (p < e) {
            x->move.re[p] = er;
            x->move.im[p] = ei;
            x->rate_move.re[p] = fr;
            x->rate_move.im[p] = fi;
        }
        for (size_t k = 0; p >= e && k < shapes; k++) {
            const double complex response = h->x[(p - e) * shapes + k];
            x->place[k] += creal(response) * er - cimag(response) * ei;
            x->rate[k] += creal(response) * fr - cimag(response) * fi;
        }
    }
    if (!own->owner) {
        tribo_modal_join(own, 1, x->move.re, x->move.im, x->place);
        tribo_modal_join(own, 1, x->rate_move.re, x->rate_move.im, x->rate);
    }
}

void tribo_modal_motion_state(void *own, double tau, const double *from, double *to)
{
    struct exact *x = own;
    const tribo_system *sys = x->sys;
    const struct forced *h = x->h;
    const size_t n = sys->ndof, wide = tribo_modal_wide(h->within);
    tribo_modal_motion_go(x, tau);
    /* brief: |lambda| tau is small for all terms; then q', as q, is the value at t0 plus a change. With shapes by bases q' is
     * computed anew: it follows the bases to rounding. */
    const int brief = (h->modal->powers || x->tau * h->quickest < LITTLE) && !h->resonant && h->shapes == h->modal->modes;
    if (h->modal->powers) {
        tribo_powers_move(x, tau, brief);
    } else {
        move_shapes(x, brief);
    }
    if (to != from) {
        memcpy(to, from, tribo_system_size(sys) * sizeof *to);
    }
    memset(to + n, 0, brief ? 0 : n * sizeof *to);
    double *const q = to + h->within[0], *const u = q + n;
    const double *phi = h->phi;
    for (size_t k = 0; k < h->shapes; k++, phi += wide) {
        const double place = x->place[k], rate = x->rate[k];
        for (size_t d = 0; d < wide; d++) {
            q[d] += phi[d] * place;
            u[d] += phi[d] * rate;
        }
    }
    for (size_t k = 0; k < sys->compliance.count; k++) {
        size_t row;
        const double by = tribo_follow_spring(sys, h->modal, sys->compliance.contact[k], &row);
        to[2 * n + k] += by != 0.0 ? by * tribo_dot(h->on + row * h->shapes, x->place, h->shapes) : 0.0;
    }
    to[tribo_system_energy(sys)] += x->events.sharp ? 0.0 : tribo_modal_motion_dissipated(x, tau);
}

/* ------------------------------------------------------------------------------------------------------- the start of a phase */

/* Sets z, growth and growth6 of harmonics at t0, of limits times side; z of a table to its value; slopes.rate, limit and rise;
 * vel, acc, jerk and drift of the shapes beside the modes. After the last term: zeros. */
static void start_harmonics(struct exact *x)
{
    const struct forced *h = x->h;
    const tribo_system *sys = x->sys;
    size_t p = h->modal->exponents;
    tribo_system_set_time(x->sys, x->t0);
    if (sys->loads.limits) {
        memset(x->slopes.limit, 0, sys->ncontact * sizeof *x->slopes.limit);
        memset(x->slopes.rise, 0, sys->ncontact * sizeof *x->slopes.rise);
        tribo_system_loads(sys, DRIVES_LIMIT, 0, 1.0, x->slopes.limit);
        tribo_system_loads(sys, DRIVES_LIMIT, 1, 1.0, x->slopes.rise);
    }
    for (size_t k = h->modal->modes; k < h->shapes; k++) {
        x->acc[k] = x->jerk[k] = 0.0;
        x->vel[k] = x->drift[k] = h->speed[k];
    }
    for (size_t s = 0; s < h->harmonics; s++, p++) {
        const struct forcing *f = &h->forcing[s];
        const struct harmonic *w = &sys->loads.harmonic[f->harmonic];
        const int whole = f->contact == sys->ncontact, base = w->drives == DRIVES_BASE;
        const double side = whole ? 1.0 : tribo_stick_slip_follows(&x->events.stick_slip, f->contact);
        x->z.re[p] = side * w->cos_t;
        x->z.im[p] = side * w->sin_t;
        x->growth[p] = fabs(side);
        x->growth6[p] = h->sixth[p] * fabs(side);
        if (w->knots) {
            x->z.re[p] = side * tribo_system_table(sys, f->harmonic, whole ? 0 : f->contact, &x->slopes.rate[p]);
            x->z.im[p] = 0.0;
            x->slopes.rate[p] *= side;
        }
        if (f->table) {
            x->vel[f->table - 1] = x->drift[f->table - 1] = base ? x->z.re[p] : x->slopes.rate[p];
            x->acc[f->table - 1] = base ? x->slopes.rate[p] : 0.0;
        }
    }
    for (; p < h->terms; p++) {
        x->z.re[p] = x->z.im[p] = x->growth[p] = x->growth6[p] = 0.0;
    }
}

/* force [modes] = the constant right-hand side of the modes: constant loads, steady forces of sliding contacts, and, of
 * contacts that hold, -(J q + G f - displacements of bases) times the force per eta, and of pressed normals by gaps; from place =
 * eta and rate = eta' where limits follow the motion. K q is not added: for a rigid-body
 * displacement q, K q would be rounding only. Sets x->steady: the forces of contacts without harmonics of limits. */
static void find_constant_forces(struct exact *x, const double *y, double *force)
{
    const struct forced *h = x->h;
    const tribo_system *sys = x->sys;
    const struct stick_slip *c = &x->events.stick_slip;
    const int holds = h->holding > h->sliding;
    const size_t m = h->modal->modes;
    for (size_t i = 0; i < sys->ncontact; i++) {
        x->steady[i] = sys->loads.limits ? tribo_stick_slip_follows(c, i) * tribo_system_steady_limit(sys, i) : c->state.force[i];
    }
    for (size_t s = 0; sys->loads.limits && s < sys->loads.harmonics; s++) {
        const struct harmonic *w = &sys->loads.harmonic[s];
        for (size_t i = 0; w->drives == DRIVES_LIMIT && w->omega == 0.0 && !w->knots && i < sys->ncontact; i++) {
            x->steady[i] += tribo_stick_slip_follows(c, i) * w->cosine[i];
        }
    }
    if (h->modal->stiff) {
        tribo_follow_forces(x, y, force);
        return;
    }
    for (size_t k = 0; k < m; k++) {
        force[k] = h->constant[k];
    }
    if (holds) {
        tribo_compliance_give(sys, 1, c->state.force, x->way);
    }
    for (size_t s = 0; holds && s < sys->loads.harmonics; s++) {
        const struct harmonic *w = &sys->loads.harmonic[s];
        for (size_t e = 0; w->drives == DRIVES_BASE && w->omega != 0.0 && e < w->count; e++) {
            x->way[w->index[e]] -= (w->cosine[e] * w->sin_t - w->sine[e] * w->cos_t) / w->omega;
        }
    }
    for (size_t o = 0; o < h->limits; o++) {
        const struct output *out = &h->output[o];
        const size_t i = out->contact;
        const double pressed = o >= h->holding && h->modal->key[i] == KEY_PRESSED ? 1.0 : 0.0;
        const double push = o >= h->holding  ? pressed * sys->normals.normal[o - h->holding].gap
                            : o < h->sliding ? x->steady[i]
                                             : -x->way[i] - tribo_matrix_row_dot(&sys->direction, i, y);
        for (size_t k = 0; k < m; k++) {
            force[k] += push * out->on_rate[k];
        }
    }
}

/* Without tables: does nothing. Sets lead, bend and rest by the ramps of tables; adds to force [modes] the forces by values of
 * tables, without K~ (tribo_follow_forces has them); subtracts the forces by damping of eta' = lead, and by inertia of eta'' =
 * bend and rest. Of bases, places are quadratic in time. */
static void lead_tables(struct exact *x, double *force)
{
    const struct forced *h = x->h;
    const struct modal *own = h->modal;
    const size_t m = own->modes;
    double *lead = x->slopes.lead, *bend = x->slopes.bend, *ramp = x->slopes.rest;
    if (!x->sys->loads.tables) {
        return;
    }
    memset(lead, 0, m * sizeof *lead);
    memset(bend, 0, m * sizeof *bend);
    memset(ramp, 0, m * sizeof *ramp);
    for (size_t s = 0; s < h->harmonics; s++) {
        const double rate = x->slopes.rate[own->exponents + s], value = x->z.re[own->exponents + s];
        const int base = x->sys->loads.harmonic[h->forcing[s].harmonic].drives == DRIVES_BASE;
        for (size_t k = 0; h->forcing[s].table && k < m; k++) {
            const double re = creal(h->g[s * m + k]), im = cimag(h->g[s * m + k]);
            force[k] += own->stiff ? 0.0 : value * (base ? im : re);
            ramp[k] += base ? value * re + rate * im : rate * re;
            bend[k] += base && own->omega2[k] != 0.0 ? rate * re / own->omega2[k] : 0.0;
        }
    }
    for (size_t k = 0; x->sys->loads.bases && k < m; k++) {
        ramp[k] -= own->coupling ? tribo_dot(own->coupling + k * m, bend, m) : own->damping[k] * bend[k];
    }
    tribo_multiply_add(own->stiff ? m : 0, m, 1, 1.0, own->give, ramp, lead);
    for (size_t k = 0; k < m; k++) {
        lead[k] += !own->stiff && own->omega2[k] != 0.0 ? ramp[k] / own->omega2[k] : 0.0;
    }
    for (size_t k = 0; k < m; k++) {
        const int drifts = tribo_modal_drifts(own, k), held = own->omega2[k] != 0.0;
        ramp[k] -= own->stiff ? tribo_dot(own->stiff + k * m, lead, m) : 0.0;
        ramp[k] = held ? 0.0 : ramp[k] / (drifts ? 1.0 : own->damping[k]);
        force[k] -= own->coupling ? tribo_dot(own->coupling + k * m, lead, m) : own->damping[k] * lead[k];
        force[k] -= held ? bend[k] : drifts ? 0.0 : ramp[k];
    }
}

/* Sets vel, acc, jerk and drift of the modes, and subtracts from place = eta and rate = eta' the responses to the constant and
 * linear right-hand side force [modes], and to harmonics. */
static void split_amplitudes(struct exact *x, const double *force)
{
    const struct forced *h = x->h;
    const struct modal *own = h->modal;
    const int tables = x->sys->loads.tables > 0;
    tribo_modal_settle(own, 1, force, x->place, x->rate, x->vel, x->acc);
    x->runs = h->steady || tables;
    for (size_t k = 0; k < own->modes; k++) {
        const int drifts = tribo_modal_drifts(own, k);
        x->jerk[k] = 0.0;
        if (x->runs && own->omega2[k] != 0.0) {
            x->vel[k] += (own->stiff ? h->constant[k] : h->ramp[k] / own->omega2[k]) + (tables ? x->slopes.lead[k] : 0.0);
            x->rate[k] -= x->vel[k];
        }
        if (tables) {
            x->jerk[k] = drifts ? x->slopes.rest[k] : 0.0;
            x->acc[k] += drifts ? 0.0 : x->slopes.rest[k] + x->slopes.bend[k];
        }
        for (size_t s = 0; s < h->harmonics; s++) {
            const double xr = creal(h->x[s * h->shapes + k]), xi = cimag(h->x[s * h->shapes + k]);
            const double c = x->z.re[own->exponents + s], d = x->z.im[own->exponents + s];
            x->place[k] -= xr * c - xi * d;
            x->rate[k] += h->forcing[s].omega * (xr * d + xi * c);
        }
        x->drift[k] = x->vel[k] + (drifts ? x->rate[k] : 0.0);
        x->runs |= x->vel[k] != 0.0 || drifts;
    }
}

void tribo_modal_motion_bound(struct exact *x, double tau)
{
    const struct forced *h = x->h;
    for (size_t p = 0; p < h->modal->exponents; p++) {
        const double rate = h->lr[p], growth = rate == 0.0 ? 1.0 : exp(rate * (rate > 0.0 ? x->longest : tau));
        x->growth[p] = tribo_modal_magnitude(x->z.re[p], x->z.im[p]) * growth;
        x->growth6[p] = lesser(h->sixth[p] * x->growth[p], DBL_MAX);
        for (size_t s = 0; h->resonant && s < h->harmonics; s++) {
            /* Resonant harmonics, Omega within RESONANCE of |lambda|. */
            const size_t at = s * h->modal->modes + h->modal->owner[p];
            const double force = h->resonant[at] ? cabs(h->g[at]) / h->li[p] : 0.0;
            x->growth[p] += force * x->longest;
            x->growth6[p] += h->sixth[p] * force * (x->longest + 6.1 / h->size[p]);
        }
    }
}

int tribo_modal_motion_start(struct exact *x, double t, const double *y, double *longest)
{
    const struct forced *h = x->h;
    const struct modal *own = h->modal;
    const size_t wide = tribo_modal_wide(own->within);
    const int varies = tribo_system_limits_vary(x->sys);
    if ((x->room < h->terms || x->room < h->shapes) && !motion_reserve(x)) {
        return 0;
    }
    for (size_t k = 0; varies && k < 2; k++) {
        if (!tribo_signal_reserve(&x->factor[k], own->exponents + h->harmonics, 3)) {
            return 0;
        }
    }
    x->t0 = t;
    x->tau = x->far = 0.0;
    start_harmonics(x);
    const double *const q = y + own->within[0], *const u = q + x->sys->ndof, *psi = own->psi;
    for (size_t k = 0; k < own->modes; k++, psi += wide) {
        x->place[k] = tribo_dot(psi, q, wide);
        x->rate[k] = tribo_dot(psi, u, wide);
    }
    find_constant_forces(x, y, x->work);
    if (own->powers) {
        x->runs = 0;
        x->longest = *longest = lesser(*longest, TRIBO_POWERS_REACH / h->quickest);
        double power = 1.0, sixth = 1.0;
        for (size_t k = 0; k < TRIBO_POWERS; k++) {
            x->growth[k] = power;
            x->growth6[k] = k < 6 ? 0.0 : (double)(k * (k - 1) * (k - 2) * (k - 3) * (k - 4) * (k - 5)) * sixth;
            power = lesser(power * x->longest, DBL_MAX);
            sixth = k < 6 ? 1.0 : lesser(sixth * x->longest, DBL_MAX);
        }
        tribo_powers_start(x, x->work);
        return 1;
    }
    lead_tables(x, x->work);
    split_amplitudes(x, x->work);
    tribo_modal_split(own, 1, x->place, x->rate, x->z.re, x->z.im);
    if (own->stiff) {
        tribo_follow_drift(own, 1, x->z.re, x->z.im, x->drift);
    }
    /* w = z at t0; resonances change only w' and w'' there. */
    tribo_modal_terms_rest(h->terms, x->room, h->lr, x->far_e.re, x->z.re, x->lot);
    if (h->resonant) {
        add_resonances(x, 0.0);
    }
    /* The bounds hold for longest; at most 1/growth if an exponent grows, and 16/Omega with resonances. */
    const double last = h->growth > 0.0 ? lesser(*longest, 1.0 / h->growth) : *longest;
    x->longest = *longest = h->resonant ? lesser(last, 16.0 / h->resonates) : last;
    tribo_modal_motion_bound(x, 0.0);
    return 1;
}
