#include "motion.h"
#include "divided.h"
#include "terms.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* |lambda tau| below which the change of an exponential is computed by tribo_exp_1: a difference would lose digits. */
#define LITTLE 0.1

int tribo_modal_motion_create(struct modal_motion *x, tribo_system *sys, const struct stick_slip *contacts)
{
    const size_t n = sys->ndof;
    double **const by_mode[] = {&x->vel, &x->acc, &x->drift, &x->drift_rate, &x->dq, &x->du, &x->work};
    const size_t modes = sizeof by_mode / sizeof *by_mode, numbers = modes - 1 + 10;
    double *work = malloc((numbers * n + 4 * sys->ncontact + 1) * sizeof *work);
    x->line = malloc((sys->ncontact + 1) * sizeof *x->line);
    for (size_t k = 0; work && k < modes; k++) {
        *by_mode[k] = work + k * n;
    }
    if (!work || !x->line) {
        return 0;
    }
    x->sys = sys;
    x->room_for_steady = work + numbers * n;
    x->push = x->room_for_steady + sys->ncontact;
    x->df = x->push + sys->ncontact;
    x->way = x->df + sys->ncontact;
    memset(x->df, 0, sys->ncontact * sizeof *x->df);
    x->contacts = contacts;
    return 1;
}

void tribo_modal_motion_free(struct modal_motion *x)
{
    free(x->vel);
    free(x->line);
    free(x->lot);
}

int tribo_modal_motion_reserve(struct modal_motion *x, size_t terms)
{
    double **const by_term[] = {&x->far_r, &x->far_i, &x->er, &x->ei, &x->growth, &x->growth6, &x->side};
    const size_t count = sizeof by_term / sizeof *by_term, room = 2 * terms;
    if (terms <= x->room) {
        return 1;
    }
    struct lot *lot = malloc(room / TRIBO_TERMS * sizeof *lot + count * room * sizeof **by_term[0]);
    if (!lot) {
        return 0;
    }
    free(x->lot);
    x->lot = lot;
    x->room = room;
    for (size_t k = 0; k < count; k++) {
        *by_term[k] = (double *)(lot + room / TRIBO_TERMS) + k * room;
    }
    return 1;
}

/* ------------------------------------------------------------------------------------------------------------------- later on */

/* Adds to w of exponent p the part by the resonant harmonic s: z' = lambda z - (i/nu) Re(g e^{i Omega t}), z = 0 at t0. */
static void add_resonance(struct modal_motion *x, size_t p, size_t s, double tau)
{
    const struct modal *h = x->h;
    const double omega = h->forcing[s].omega, nu = h->li[p];
    const double c0 = tribo_harmonic_at_start(x, s).re, s0 = tribo_harmonic_at_start(x, s).im;
    const double gr = h->gr[s * h->modes + h->owner[p]], gi = h->gi[s * h->modes + h->owner[p]];
    const double e = exp(h->lr[p] * tau), er = e * cos(nu * tau), ei = e * sin(nu * tau);
    double zr = 0.0, zi = 0.0;
    for (int conjugate = 0; conjugate < 2; conjugate++) {
        const double side = conjugate ? -1.0 : 1.0;
        const double complex u = tau * tribo_exp_1(tau * (-h->lr[p] + (side * omega - nu) * I));
        const double ur = creal(u), ui = cimag(u);
        /* z += a e^{lambda tau} u, a = g e^{i Omega t0}/2 or the conjugate */
        const double ar = 0.5 * (gr * c0 - gi * s0), ai = 0.5 * side * (gr * s0 + gi * c0);
        const double br = ar * er - ai * ei, bi = ar * ei + ai * er;
        zr += br * ur - bi * ui;
        zi += br * ui + bi * ur;
    }
    const double ct = tribo_harmonic(x, s).re, st = tribo_harmonic(x, s).im, rate = omega * (gr * st + gi * ct) / nu;
    const double complex lambda = h->lr[p] + h->li[p] * I, z = zi / nu - zr / nu * I;
    const double complex z1 = lambda * z - (gr * ct - gi * st) / nu * I, z2 = lambda * z1 + rate * I;
    struct lot *lot = &x->lot[p / TRIBO_TERMS];
    const size_t k = p % TRIBO_TERMS;
    lot->wr[k] += creal(z);
    lot->wi[k] += cimag(z);
    lot->w1r[k] += creal(z1);
    lot->w1i[k] += cimag(z1);
    lot->w2r[k] += creal(z2);
    lot->w2i[k] += cimag(z2);
}

static void add_resonances(struct modal_motion *x, double tau)
{
    const struct modal *h = x->h;
    for (size_t s = 0; s < h->harmonics; s++) {
        for (size_t p = 0; p < h->exponents; p++) {
            if (h->resonant[s * h->modes + h->owner[p]]) {
                add_resonance(x, p, s, tau);
            }
        }
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
        const struct harmonic *w = &x->sys->harmonic[s];
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
        const struct harmonic *w = &x->sys->harmonic[s];
        sum += w->drives == DRIVES_LIMIT ? pow(w->omega, 6.0) * hypot(w->cosine[i], w->sine[i]) : 0.0;
    }
    return sum;
}

/* er, ei = w - z: change of the terms from t0 to x->tau. */
static void find_moves(struct modal_motion *x)
{
    const struct modal *h = x->h;
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
            const double complex lambda_tau = x->tau * (x->h->lr[p] + x->h->li[p] * I);
            const struct number z = tribo_term_at_start(x, p);
            const double complex move = (z.re + z.im * I) * lambda_tau * tribo_exp_1(lambda_tau);
            x->er[p] = creal(move);
            x->ei[p] = cimag(move);
        }
    }
}

/* eta and eta' of a mode, or the changes of both since t0. */
struct amplitude {
    double place, rate;
};

/* Returns w' of term p, or, if brief, w' - z' = lambda (w - z). */
static inline struct number change_of_rate(const struct modal_motion *x, size_t p, int brief)
{
    const double lr = x->h->lr[p], li = x->h->li[p], er = x->er[p], ei = x->ei[p];
    return brief ? (struct number){lr * er - li * ei, lr * ei + li * er} : tribo_term_rate(x, p);
}

/* a->place += Re(r (w - z)) of term p; a->rate += Re(r w'), or Re(r (w' - z')) if brief. */
static inline void add_term(const struct modal_motion *x, size_t p, int brief, double rr, double ri, struct amplitude *a)
{
    const struct number rate = change_of_rate(x, p, brief);
    a->place += rr * x->er[p] - ri * x->ei[p];
    a->rate += rr * rate.re - ri * rate.im;
}

/* Adds the motion of the modes to x->dq and x->du. */
static void motion_add_modes(struct modal_motion *x, int brief)
{
    const struct modal *h = x->h;
    const size_t e = h->exponents, harmonics = h->harmonics, modes = h->modes, n = x->sys->ndof;
    double *place = x->work, *rate = place + n, *move = rate + n; /* move: er, Re w', -ei, -Im w', 2n apart */
    find_moves(x);
    if (!h->owner) {
        memset(place, 0, 2 * n * sizeof *place);
        for (size_t p = 0; p < e; p++) {
            const struct number to = change_of_rate(x, p, brief);
            move[p] = x->er[p];
            move[2 * n + p] = to.re;
            move[4 * n + p] = -x->ei[p];
            move[6 * n + p] = -to.im;
        }
        tribo_multiply_transposed_two(e, modes, 1, h->rr, move, 2 * n, place, n);
        tribo_multiply_transposed_two(e, modes, 1, h->ri, move + 4 * n, 2 * n, place, n);
    }
    for (size_t k = 0, p = 0; k < modes; k++) {
        struct amplitude a = {h->owner ? 0.0 : place[k], h->owner ? 0.0 : rate[k]};
        if (x->runs) {
            /* Linear and quadratic part of mode k. */
            const double drift = x->vel[k] + (x->h->drifts[k] ? x->drift_rate[k] : 0.0), acc = x->acc[k], tau = x->tau;
            a.place += tau * (drift + 0.5 * acc * tau);
            a.rate += (brief ? 0.0 : drift) + acc * tau;
        }
        for (; h->owner && p < e && h->owner[p] == k; p++) {
            a.place += x->er[p];
            a.rate += change_of_rate(x, p, brief).re;
        }
        for (size_t s = 0; s < harmonics; s++) {
            add_term(x, e + s, brief, h->xr[s * modes + k], h->xi[s * modes + k], &a);
        }
        place[k] = a.place;
        rate[k] = a.rate;
    }
    tribo_modal_add(h, 1, place, n, x->dq, n, move);
}

/* Adds harmonic s of bases to x->du and, integrated from t0, to x->dq: contacts that hold follow the bases. */
static void carry(struct modal_motion *x, size_t s)
{
    const struct modal *h = x->h;
    const double omega = h->forcing[s].omega, by = omega != 0.0 ? 1.0 / omega : 0.0;
    const struct number now = tribo_harmonic(x, s), then = tribo_harmonic_at_start(x, s);
    const double c = now.re, d = now.im, dc = by * (c - then.re), dd = by * (d - then.im);
    for (size_t i = 0; i < h->moving; i++) {
        const double yr = h->yr[s * h->moving + i], yi = h->yi[s * h->moving + i];
        x->du[h->dof[i]] += yr * c - yi * d;
        x->dq[h->dof[i]] += yr * dd + yi * dc;
    }
}

/* x->df = -G_AA^-1 (J_A dq - base displacements), A: compliant contacts at rest; forces in `to` = forces in `from` + x->df. */
static void move_springs(struct modal_motion *x, double tau, const double *from, double *to)
{
    const tribo_system *sys = x->sys;
    tribo_matrix_multiply(&sys->direction, x->dq, x->way);
    for (size_t s = 0; sys->base_harmonics && s < x->h->given; s++) {
        const struct harmonic *w = &sys->harmonic[s];
        const struct number now = tribo_harmonic(x, s), then = tribo_harmonic_at_start(x, s);
        for (size_t e = 0; w->drives == DRIVES_BASE && e < w->count; e++) {
            const double c = w->cosine[e], d = w->sine[e];
            x->way[w->index[e]] -=
                w->omega == 0.0 ? c * tau : (c * (now.im - then.im) - d * (now.re - then.re)) / w->omega;
        }
    }
    tribo_compliance_rates(sys, x->contacts->state.slip, x->way, x->df);
    for (size_t k = 0; k < sys->compliance.count; k++) {
        to[2 * sys->ndof + k] = from[2 * sys->ndof + k] + x->df[sys->compliance.contact[k]];
    }
}

void tribo_modal_motion_state(struct modal_motion *x, double tau, const double *from, double *to)
{
    const tribo_system *sys = x->sys;
    const struct modal *h = x->h;
    const size_t n = sys->ndof;
    tribo_modal_motion_go(x, tau);
    /* brief: |lambda| tau is small for all terms; then q', as q, is computed as the value at t0 plus a change */
    const int brief = x->tau * h->quickest < LITTLE && !h->any_resonant && !sys->base_harmonics;
    if (h->moving < n) {
        memset(x->dq, 0, n * sizeof *x->dq);
    }
    if (to != from) {
        memcpy(to, from, tribo_system_size(sys) * sizeof *to);
    }
    for (size_t i = 0; i < h->moving; i++) {
        x->dq[h->dof[i]] = h->y0[i] * tau;
        x->du[h->dof[i]] = brief ? 0.0 : h->y0[i];
    }
    for (size_t s = 0; sys->base_harmonics && s < h->given; s++) {
        if (sys->harmonic[s].drives == DRIVES_BASE) {
            carry(x, s);
        }
    }
    motion_add_modes(x, brief);
    for (size_t i = 0; i < h->moving; i++) {
        to[h->dof[i]] += x->dq[h->dof[i]];
        to[n + h->dof[i]] = (brief ? to[n + h->dof[i]] : 0.0) + x->du[h->dof[i]];
    }
    if (sys->compliance.count) {
        move_springs(x, tau, from, to);
    }
    to[tribo_system_energy(sys)] += tribo_modal_motion_dissipated(x, tau);
}

/* ------------------------------------------------------------------------------------------------------- the start of a phase */

/* Returns J_i q minus the displacement of base i by harmonics of omega != 0. */
static double motion_offset(const tribo_system *sys, size_t i, const double *q)
{
    double sum = tribo_matrix_row_dot(&sys->direction, i, q);
    for (size_t s = 0; s < sys->harmonics; s++) {
        const struct harmonic *w = &sys->harmonic[s];
        for (size_t e = 0; w->drives == DRIVES_BASE && w->omega != 0.0 && e < w->count; e++) {
            sum -= w->index[e] == i ? (w->cosine[e] * w->sin_t - w->sine[e] * w->cos_t) / w->omega : 0.0;
        }
    }
    return sum;
}

/* Sets z, growth and growth6 of harmonics at t0, of limits times side; zeros after the last term. */
static void start_harmonics(struct modal_motion *x, tribo_system *sys)
{
    const struct modal *h = x->h;
    const size_t e = h->exponents;
    tribo_modal_terms_clear(x);
    tribo_system_set_time(sys, x->t0);
    for (size_t s = 0; s < h->harmonics; s++) {
        const struct forcing *f = &h->forcing[s];
        const double side = s < h->given ? 1.0 : tribo_stick_slip_follows(x->contacts, f->contact);
        x->side[s] = side;
        tribo_system_turn(sys, f->harmonic);
        tribo_term_begin(x, e + s, side * sys->harmonic[f->harmonic].cos_t, side * sys->harmonic[f->harmonic].sin_t);
        x->growth[e + s] = fabs(side);
        x->growth6[e + s] = h->sixth[e + s] * fabs(side);
    }
}

/* Sets push: steady force of a sliding contact; -(J_i q - displacement of the base + (G f)_i) of a held contact. */
static void find_pushes(struct modal_motion *x, const tribo_system *sys, const double *y)
{
    const struct modal *h = x->h;
    tribo_compliance_give(sys, 1, x->contacts->state.force, x->way);
    for (size_t o = 0; h->modes > 0 && o < h->outputs; o++) {
        const size_t i = h->output[o].contact;
        x->push[o] = o < h->sliding ? x->steady[i] : -motion_offset(sys, i, y) - x->way[i];
    }
}

/* Returns the constant right-hand side of mode k, by contacts and constant loads. K q is not added: for a rigid-body displacement
 * q, K q would be rounding only. */
static double constant_force(const struct modal_motion *x, size_t k)
{
    const struct modal *h = x->h;
    double force = h->constant[k];
    for (size_t o = 0; o < h->outputs; o++) {
        force += x->push[o] * h->output[o].on_rate[k];
    }
    return force;
}

/* Return a = (eta, eta') of mode k at t0 minus a response: to the constant and linear right-hand side; to harmonics. */
static struct amplitude without_linear_part(struct modal_motion *x, size_t k, struct amplitude a)
{
    const struct modal *h = x->h;
    const double force = constant_force(x, k), stiffness = h->omega2[k];
    double vel = 0.0, acc = 0.0;
    if (h->drifts[k]) {
        acc = force;
    } else if (stiffness == 0.0) {
        vel = force / h->damping[k];
    } else {
        vel = h->ramp[k] / stiffness;
        a.place -= force / stiffness;
    }
    x->vel[k] = vel;
    x->acc[k] = acc;
    x->runs |= vel != 0.0 || acc != 0.0 || h->drifts[k];
    a.rate -= vel;
    return a;
}

static struct amplitude without_harmonics(const struct modal_motion *x, size_t k, struct amplitude a)
{
    const struct modal *h = x->h;
    for (size_t s = 0, at = k; s < h->harmonics; s++, at += h->modes) {
        const double xr = h->xr[at], xi = h->xi[at];
        const struct number w = tribo_harmonic_at_start(x, s);
        a.place -= xr * w.re - xi * w.im;
        a.rate += h->forcing[s].omega * (xr * w.im + xi * w.re);
    }
    return a;
}

/* Sets z of all exponents at t0: z = a eta + b eta' of the owner; coupled: z = b (eta' - omega^2 eta/lambda), since b is a left
 * eigenvector. */
static void begin_exponents(struct modal_motion *x)
{
    const struct modal *h = x->h;
    const size_t n = x->sys->ndof, e = h->exponents;
    double *pull = x->work, *r = pull + 2 * n, *i = r + 4 * n;
    if (!h->owner) {
        for (size_t k = 0; k < h->modes; k++) {
            pull[k] = h->omega2[k] * x->drift[k];
            pull[n + k] = x->drift_rate[k];
        }
        memset(r, 0, 8 * n * sizeof *r);
        tribo_multiply_transposed_two(h->modes, e, 1, h->br, pull, n, r, 2 * n);
        tribo_multiply_transposed_two(h->modes, e, 1, h->bi, pull, n, i, 2 * n);
    }
    for (size_t p = 0; p < e; p++) {
        if (h->owner) {
            const double q = x->drift[h->owner[p]], u = x->drift_rate[h->owner[p]];
            tribo_term_begin(x, p, h->ar[p] * q + h->br[p] * u, h->ai[p] * q + h->bi[p] * u);
        } else {
            const double lr = h->lr[p], li = h->li[p], square = lr * lr + li * li;
            tribo_term_begin(x, p, r[2 * n + p] - (lr * r[p] + li * i[p]) / square, i[2 * n + p] - (lr * i[p] - li * r[p]) / square);
        }
    }
}

/* Splits the motion from y on into the response to the right-hand side and exponentials. */
static void split_motion(struct modal_motion *x, tribo_system *sys, const double *y)
{
    const struct modal *h = x->h;
    start_harmonics(x, sys);
    /* steady: forces of contacts without harmonics of limits */
    double *steady = x->room_for_steady;
    for (size_t i = 0; sys->limit_harmonics && i < sys->ncontact; i++) {
        double limit = sys->given_limit[i];
        for (size_t s = 0; s < sys->harmonics; s++) {
            const struct harmonic *w = &sys->harmonic[s];
            limit += w->drives == DRIVES_LIMIT && w->omega == 0.0 ? w->cosine[i] : 0.0;
        }
        steady[i] = tribo_stick_slip_follows(x->contacts, i) * limit;
    }
    x->steady = sys->limit_harmonics ? steady : x->contacts->state.force;
    find_pushes(x, sys, y);
    x->runs = 0;
    tribo_modal_amplitudes(h, 1, y, sys->ndof, x->drift, sys->ndof, x->work);
    for (size_t k = 0; k < h->modes; k++) {
        const struct amplitude at = {x->drift[k], x->drift_rate[k]};
        const struct amplitude a = without_harmonics(x, k, without_linear_part(x, k, at));
        x->drift[k] = a.place;
        x->drift_rate[k] = a.rate;
    }
    begin_exponents(x);
}

/* Adds the resonant harmonics, Omega within RESONANCE of |lambda|, to the bounds of exponent p. */
static void bound_resonances(struct modal_motion *x, size_t p)
{
    const struct modal *h = x->h;
    for (size_t s = 0; s < h->harmonics; s++) {
        const size_t at = s * h->modes + h->owner[p];
        if (h->resonant[at]) {
            const double force = hypot(h->gr[at], h->gi[at]) / h->li[p];
            x->growth[p] += force * x->longest;
            x->growth6[p] += h->sixth[p] * force * (x->longest + 6.1 / h->size[p]);
        }
    }
}

void tribo_modal_motion_bound(struct modal_motion *x, double tau)
{
    const struct modal *h = x->h;
    for (size_t p = 0; p < h->exponents; p++) {
        const struct number z = tribo_term_at_start(x, p);
        const double rate = h->lr[p], growth = rate == 0.0 ? 1.0 : exp(rate * (rate > 0.0 ? x->longest : tau));
        x->growth[p] = tribo_modal_magnitude(z.re, z.im) * growth;
        x->growth6[p] = h->sixth[p] * x->growth[p];
        if (h->any_resonant) {
            bound_resonances(x, p);
        }
    }
}

double tribo_modal_motion_start(struct modal_motion *x, const struct modal *h, double t, const double *y, double longest)
{
    x->h = h;
    x->t0 = t;
    split_motion(x, x->sys, y);
    /* w = z at t0; resonances change only w' and w'' there. */
    tribo_modal_terms_rest(x);
    if (x->h->any_resonant) {
        add_resonances(x, 0.0);
    }
    /* The bounds hold for longest; at most 1/growth if an exponent grows, and 16/fastest with resonances. */
    const double last = h->growth > 0.0 ? lesser(longest, 1.0 / h->growth) : longest;
    x->longest = h->any_resonant ? lesser(last, 16.0 / h->fastest) : last;
    tribo_modal_motion_bound(x, 0.0);
    if (x->sys->limit_harmonics) {
        /* The linear part of the velocities of sliding contacts. */
        const struct stick_slip *m = x->contacts;
        for (size_t o = 0; o < x->h->sliding; o++) {
            const size_t i = x->h->output[o].contact;
            struct course c = {.output = &x->h->output[o]};
            tribo_course_begin(x, &c, 1, tribo_stick_slip_first_velocity(m, x->sys, i, y));
            x->line[i] = c.line;
        }
    }
    return x->longest;
}
