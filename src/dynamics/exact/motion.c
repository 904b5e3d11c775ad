/* SPDX-License-Identifier: BSD-3-Clause */
#include "motion.h"
#include "terms.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* |lambda tau| below which the change of an exponential is computed by tribo_exp_1: a difference would lose digits. */
#define LITTLE 0.1

int tribo_modal_motion_create(struct modal_motion *x, tribo_system *sys, const struct stick_slip *contacts)
{
    x->sys = sys;
    x->contacts = contacts;
    x->way = malloc((2 * sys->ncontact + 1) * sizeof *x->way);
    x->course = malloc((sys->ncontact + 1) * sizeof *x->course);
    x->steady = x->way ? x->way + sys->ncontact : NULL;
    return x->way && x->course;
}

void tribo_modal_motion_free(struct modal_motion *x)
{
    free(x->lot);
    free(x->way);
    free(x->course);
    tribo_signal_free(&x->velocity);
}

/* Makes room for the terms and shapes of h. Returns 0 if out of memory. */
static int motion_reserve(struct modal_motion *x, const struct forced *h)
{
    double **const array[] = {&x->far_r, &x->far_i, &x->er,         &x->ei,    &x->growth, &x->growth6, &x->vel,
                              &x->acc,   &x->drift, &x->drift_rate, &x->place, &x->rate,   &x->work};
    const size_t arrays = sizeof array / sizeof *array, room = 2 * (h->terms > h->shapes ? h->terms : h->shapes);
    if (2 * x->room >= room) {
        return 1;
    }
    struct lot *lot = malloc((room / TRIBO_TERMS + 1) * sizeof *lot + ((arrays + 9) * room + 2 * x->sys->ndof) * sizeof *x->work);
    if (!lot) {
        return 0;
    }
    free(x->lot);
    x->lot = lot;
    x->room = room;
    for (size_t k = 0; k < arrays; k++) {
        *array[k] = (double *)(lot + room / TRIBO_TERMS + 1) + k * room;
    }
    return 1;
}

/* ------------------------------------------------------------------------------------------------------------------- later on */

/* Adds to w of exponents the parts by resonant harmonics: z' = lambda z - (i/nu) Re(g e^{i Omega t}), z = 0 at t0. */
static void add_resonances(struct modal_motion *x, double tau)
{
    const struct forced *h = x->h;
    for (size_t at = 0; at < h->harmonics * h->exponents; at++) {
        const size_t p = at % h->exponents, s = at / h->exponents, resonance = s * h->modal->modes + h->modal->owner[p];
        if (!h->resonant[resonance]) {
            continue;
        }
        const double omega = h->forcing[s].omega, nu = h->li[p];
        const double complex lambda = h->lr[p] + nu * I, g = h->g[resonance];
        const struct number wave = tribo_harmonic(x, s), start = tribo_harmonic_at_start(x, s);
        const double complex now = g * (wave.re + wave.im * I), then = 0.5 * g * (start.re + start.im * I);
        const double complex e = tau * exp(h->lr[p] * tau) * (cos(nu * tau) + sin(nu * tau) * I);
        const double complex sum =
            then * tribo_exp_1(tau * (omega * I - lambda)) + conj(then) * tribo_exp_1(tau * (-omega * I - lambda));
        const double complex z = -I / nu * e * sum, z1 = lambda * z - creal(now) / nu * I;
        const double complex z2 = lambda * z1 + omega * cimag(now) / nu * I;
        struct lot *lot = &x->lot[p / TRIBO_TERMS];
        const size_t k = p % TRIBO_TERMS;
        lot->wr[k] += creal(z);
        lot->wi[k] += cimag(z);
        lot->w1r[k] += creal(z1);
        lot->w1i[k] += cimag(z1);
        lot->w2r[k] += creal(z2);
        lot->w2i[k] += cimag(z2);
    }
}

void tribo_modal_motion_go(struct modal_motion *x, double tau)
{
    if (tau != x->tau) {
        tribo_modal_terms_go(x, tau);
        if (x->h->any_resonant) {
            add_resonances(x, tau);
        }
    }
}

struct sample tribo_modal_motion_limit(const struct modal_motion *x, size_t i)
{
    struct sample sum = {0.0, 0.0, 0.0};
    for (size_t s = 0; s < x->h->given; s++) {
        const struct harmonic *w = &x->sys->loads.harmonic[s];
        if (w->drives == DRIVES_LIMIT) {
            const struct number now = tribo_harmonic(x, s);
            const double c = w->cosine[i], d = w->sine[i], value = c * now.re + d * now.im;
            sum.g += value;
            sum.d += w->omega * (d * now.re - c * now.im);
            sum.e -= w->omega * w->omega * value;
        }
    }
    return sum;
}

double tribo_modal_motion_limit_bend(const struct modal_motion *x, size_t i)
{
    double sum = 0.0;
    for (size_t s = 0; s < x->h->given; s++) {
        const struct harmonic *w = &x->sys->loads.harmonic[s];
        sum += w->drives == DRIVES_LIMIT ? pow(w->omega, 6.0) * hypot(w->cosine[i], w->sine[i]) : 0.0;
    }
    return sum;
}

/* er, ei = w - z: change of the terms from t0 to x->tau. */
static void find_moves(struct modal_motion *x)
{
    const struct forced *h = x->h;
    const size_t e = h->exponents, terms = e + h->harmonics;
    for (size_t p = 0; p < terms; p++) {
        const struct number then = tribo_term_at_start(x, p), now = tribo_term(x, p);
        x->er[p] = now.re - then.re;
        x->ei[p] = now.im - then.im;
    }
    for (size_t p = h->any_resonant ? e : 0; p < terms; p++) {
        if (x->tau * h->size[p] < LITTLE) {
            /* With a load far above the frequency of exponent p, or in a short slip under a limit far above all other forces,
             * this small change of z is the whole motion: a difference would lose digits. */
            const double complex lambda_tau = x->tau * (h->lr[p] + h->li[p] * I);
            const struct number z = tribo_term_at_start(x, p);
            const double complex move = (z.re + z.im * I) * lambda_tau * tribo_exp_1(lambda_tau);
            x->er[p] = creal(move);
            x->ei[p] = cimag(move);
        }
    }
}

/* Returns w' of term p, or, if brief, w' - z' = lambda (w - z). */
static inline struct number change_of_rate(const struct modal_motion *x, size_t p, int brief)
{
    const double lr = x->h->lr[p], li = x->h->li[p], er = x->er[p], ei = x->ei[p];
    return brief ? (struct number){lr * er - li * ei, lr * ei + li * er} : tribo_term_rate(x, p);
}

/* Sets x->place and x->rate of all shapes. */
static void move_shapes(struct modal_motion *x, int brief)
{
    const struct forced *h = x->h;
    const struct modal *own = h->modal;
    const size_t e = h->exponents, harmonics = h->harmonics, shapes = h->shapes;
    find_moves(x);
    memset(x->place, 0, shapes * sizeof *x->place);
    memset(x->rate, 0, shapes * sizeof *x->rate);
    for (size_t p = 0; p < e && own->owner; p++) {
        x->place[own->owner[p]] += x->er[p];
        x->rate[own->owner[p]] += change_of_rate(x, p, brief).re;
    }
    if (!own->owner) {
        double *re = x->work, *im = re + 2 * e; /* er, Re w'; -ei, -Im w' */
        for (size_t p = 0; p < e; p++) {
            const struct number to = change_of_rate(x, p, brief);
            re[p] = x->er[p];
            re[e + p] = to.re;
            im[p] = -x->ei[p];
            im[e + p] = -to.im;
        }
        tribo_multiply_transposed_two(e, own->modes, 1, own->rr, re, e, x->place, (size_t)(x->rate - x->place));
        tribo_multiply_transposed_two(e, own->modes, 1, own->ri, im, e, x->place, (size_t)(x->rate - x->place));
    }
    for (size_t s = 0; s < harmonics; s++) {
        const struct number rate = change_of_rate(x, e + s, brief);
        const double er = x->er[e + s], ei = x->ei[e + s];
        const double complex *response = h->x + s * shapes;
        for (size_t k = 0; k < shapes; k++) {
            const double xr = creal(response[k]), xi = cimag(response[k]);
            x->place[k] += xr * er - xi * ei;
            x->rate[k] += xr * rate.re - xi * rate.im;
        }
    }
    for (size_t k = 0; x->runs && k < shapes; k++) {
        const double drift = x->vel[k] + (k < own->modes && own->drifts[k] ? x->drift_rate[k] : 0.0), tau = x->tau;
        x->place[k] += tau * (drift + 0.5 * x->acc[k] * tau);
        x->rate[k] += (brief ? 0.0 : drift) + x->acc[k] * tau;
    }
}

void tribo_modal_motion_state(struct modal_motion *x, double tau, const double *from, double *to)
{
    const tribo_system *sys = x->sys;
    const struct forced *h = x->h;
    const size_t n = sys->ndof;
    double *moves = x->work;
    tribo_modal_motion_go(x, tau);
    /* brief: |lambda| tau is small for all terms; then q', as q, is the value at t0 plus a change. With shapes by bases q' is
     * computed anew: it follows the bases to rounding. */
    const int brief = x->tau * h->quickest < LITTLE && !h->any_resonant && h->shapes == h->modal->modes;
    move_shapes(x, brief);
    if (to != from) {
        memcpy(to, from, tribo_system_size(sys) * sizeof *to);
    }
    memset(moves, 0, 2 * n * sizeof *moves);
    for (size_t k = 0; h->sparse && k < h->shapes; k++) {
        for (size_t d = h->begin[k]; d < h->end[k]; d++) {
            moves[d] += h->phi[k * n + d] * x->place[k];
            moves[n + d] += h->phi[k * n + d] * x->rate[k];
        }
    }
    if (!h->sparse) {
        tribo_multiply_transposed_two(h->shapes, n, 1, h->phi, x->place, (size_t)(x->rate - x->place), moves, n);
    }
    for (size_t k = 0; k < h->moving; k++) {
        const size_t d = h->dof[k];
        to[d] += moves[d];
        to[n + d] = (brief ? to[n + d] : 0.0) + moves[n + d];
    }
    for (size_t k = 0; k < sys->compliance.count; k++) {
        const size_t i = sys->compliance.contact[k];
        to[2 * n + k] += h->modal->key[i] == 2 ? tribo_dot(h->on + i * h->shapes, x->place, h->shapes) : 0.0;
    }
    to[tribo_system_energy(sys)] += tribo_modal_motion_dissipated(x, tau);
}

/* ------------------------------------------------------------------------------------------------------- the start of a phase */

/* Sets z, growth and growth6 of harmonics at t0, of limits times side; zeros after the last term. */
static void start_harmonics(struct modal_motion *x)
{
    const struct forced *h = x->h;
    const size_t e = h->exponents;
    tribo_modal_terms_clear(x);
    tribo_system_set_time(x->sys, x->t0);
    for (size_t s = 0; s < h->harmonics; s++) {
        const struct forcing *f = &h->forcing[s];
        const struct harmonic *w = &x->sys->loads.harmonic[f->harmonic];
        const double side = s < h->given ? 1.0 : tribo_stick_slip_follows(x->contacts, f->contact);
        tribo_system_turn(x->sys, f->harmonic);
        tribo_term_begin(x, e + s, side * w->cos_t, side * w->sin_t);
        x->growth[e + s] = fabs(side);
        x->growth6[e + s] = h->sixth[e + s] * fabs(side);
    }
}

/* Sets x->steady: the forces of contacts without harmonics of limits. */
static void find_steady(struct modal_motion *x)
{
    const tribo_system *sys = x->sys;
    memcpy(x->steady, x->contacts->state.force, sys->ncontact * sizeof *x->steady);
    for (size_t i = 0; sys->loads.limit_harmonics && i < sys->ncontact; i++) {
        double limit = sys->loads.given_limit[i];
        for (size_t s = 0; s < sys->loads.harmonics; s++) {
            const struct harmonic *w = &sys->loads.harmonic[s];
            limit += w->drives == DRIVES_LIMIT && w->omega == 0.0 ? w->cosine[i] : 0.0;
        }
        x->steady[i] = tribo_stick_slip_follows(x->contacts, i) * limit;
    }
}

/* force [modes] = the constant right-hand side of the modes: constant loads, steady forces of sliding contacts, and, of
 * contacts that hold, -(J q + G f - displacements of bases) times the force per eta. K q is not added: for a rigid-body
 * displacement q, K q would be rounding only. */
static void find_constant_forces(struct modal_motion *x, const double *y, double *force)
{
    const struct forced *h = x->h;
    const tribo_system *sys = x->sys;
    const size_t m = h->modal->modes;
    memcpy(force, h->constant, m * sizeof *force);
    tribo_compliance_give(sys, 1, x->contacts->state.force, x->way);
    tribo_matrix_multiply_add(&sys->direction, 1.0, y, x->way);
    for (size_t s = 0; sys->loads.base_harmonics && s < sys->loads.harmonics; s++) {
        const struct harmonic *w = &sys->loads.harmonic[s];
        const struct number z = tribo_harmonic_at_start(x, s);
        for (size_t e = 0; w->drives == DRIVES_BASE && w->omega != 0.0 && e < w->count; e++) {
            x->way[w->index[e]] -= (w->cosine[e] * z.im - w->sine[e] * z.re) / w->omega;
        }
    }
    for (size_t o = 0; o < h->outputs; o++) {
        const struct output *out = &h->output[o];
        const double push = o < h->sliding ? x->steady[out->contact] : -x->way[out->contact];
        for (size_t k = 0; k < m; k++) {
            force[k] += push * out->on_rate[k];
        }
    }
}

/* Sets vel and acc, and drift and drift_rate from eta and eta': without the responses to the constant and linear right-hand side
 * force [modes], and to harmonics. */
static void split_amplitudes(struct modal_motion *x, const double *force)
{
    const struct forced *h = x->h;
    const struct modal *own = h->modal;
    x->runs = h->steady;
    for (size_t k = 0; k < h->shapes; k++) {
        x->vel[k] = x->acc[k] = 0.0;
    }
    for (size_t k = 0; k < own->modes; k++) {
        const double stiffness = own->omega2[k];
        double place = x->drift[k], rate = x->drift_rate[k];
        if (own->drifts[k]) {
            x->acc[k] = force[k];
        } else if (stiffness == 0.0) {
            x->vel[k] = force[k] / own->damping[k];
        } else {
            x->vel[k] = h->ramp[k] / stiffness;
            place -= force[k] / stiffness;
        }
        rate -= x->vel[k];
        for (size_t s = 0; s < h->harmonics; s++) {
            const double xr = creal(h->x[s * h->shapes + k]), xi = cimag(h->x[s * h->shapes + k]);
            const struct number w = tribo_harmonic_at_start(x, s);
            place -= xr * w.re - xi * w.im;
            rate += h->forcing[s].omega * (xr * w.im + xi * w.re);
        }
        x->runs |= x->vel[k] != 0.0 || x->acc[k] != 0.0 || own->drifts[k];
        x->drift[k] = place;
        x->drift_rate[k] = rate;
    }
    if (h->steady) {
        x->vel[h->shapes - 1] = 1.0;
    }
}

/* Sets z of all exponents at t0: z = a eta + b eta' of the owner; coupled: z = b (eta' - omega^2 eta/lambda), since b is a left
 * eigenvector. */
static void begin_exponents(struct modal_motion *x)
{
    const struct modal *h = x->h->modal;
    const size_t m = h->modes, e = h->exponents;
    double *pull = x->work, *r = pull + 2 * m, *i = r + 2 * e;
    if (!h->owner) {
        for (size_t k = 0; k < m; k++) {
            pull[k] = h->omega2[k] * x->drift[k];
            pull[m + k] = x->drift_rate[k];
        }
        memset(r, 0, 4 * e * sizeof *r);
        tribo_multiply_transposed_two(m, e, 1, h->br, pull, m, r, e);
        tribo_multiply_transposed_two(m, e, 1, h->bi, pull, m, i, e);
    }
    for (size_t p = 0; p < e; p++) {
        if (h->owner) {
            const double q = x->drift[h->owner[p]], u = x->drift_rate[h->owner[p]];
            tribo_term_begin(x, p, h->ar[p] * q + h->br[p] * u, h->ai[p] * q + h->bi[p] * u);
        } else {
            const double lr = h->lr[p], li = h->li[p], square = lr * lr + li * li;
            tribo_term_begin(x, p, r[e + p] - (lr * r[p] + li * i[p]) / square, i[e + p] - (lr * i[p] - li * r[p]) / square);
        }
    }
}

void tribo_modal_motion_bound(struct modal_motion *x, double tau)
{
    const struct forced *h = x->h;
    for (size_t p = 0; p < h->exponents; p++) {
        const struct number z = tribo_term_at_start(x, p);
        const double rate = h->lr[p], growth = rate == 0.0 ? 1.0 : exp(rate * (rate > 0.0 ? x->longest : tau));
        x->growth[p] = tribo_modal_magnitude(z.re, z.im) * growth;
        x->growth6[p] = h->sixth[p] * x->growth[p];
        for (size_t s = 0; h->any_resonant && s < h->harmonics; s++) {
            /* Resonant harmonics, Omega within RESONANCE of |lambda|. */
            const size_t at = s * h->modal->modes + h->modal->owner[p];
            const double force = h->resonant[at] ? cabs(h->g[at]) / h->li[p] : 0.0;
            x->growth[p] += force * x->longest;
            x->growth6[p] += h->sixth[p] * force * (x->longest + 6.1 / h->size[p]);
        }
    }
}

int tribo_modal_motion_start(struct modal_motion *x, const struct forced *h, double t, const double *y, double *longest)
{
    const size_t n = x->sys->ndof, m = h->modal->modes;
    if (!motion_reserve(x, h) ||
        (x->sys->loads.limit_harmonics && !tribo_signal_reserve(&x->velocity, h->exponents + h->harmonics, 1))) {
        return 0;
    }
    x->h = h;
    x->t0 = t;
    start_harmonics(x);
    find_steady(x);
    find_constant_forces(x, y, x->work);
    for (size_t k = 0; k < m; k++) {
        x->drift[k] = x->drift_rate[k] = 0.0;
        for (size_t d = h->begin[k]; h->sparse && d < h->end[k]; d++) {
            x->drift[k] += h->modal->psi[d * m + k] * y[d];
            x->drift_rate[k] += h->modal->psi[d * m + k] * y[n + d];
        }
    }
    if (!h->sparse) {
        tribo_multiply_transposed_two(n, m, 1, h->modal->psi, y, n, x->drift, (size_t)(x->drift_rate - x->drift));
    }
    split_amplitudes(x, x->work);
    begin_exponents(x);
    /* w = z at t0; resonances change only w' and w'' there. */
    tribo_modal_terms_rest(x);
    if (h->any_resonant) {
        add_resonances(x, 0.0);
    }
    /* The bounds hold for longest; at most 1/growth if an exponent grows, and 16/fastest with resonances. */
    const double last = h->growth > 0.0 ? lesser(*longest, 1.0 / h->growth) : *longest;
    x->longest = *longest = h->any_resonant ? lesser(last, 16.0 / h->fastest) : last;
    tribo_modal_motion_bound(x, 0.0);
    return 1;
}
