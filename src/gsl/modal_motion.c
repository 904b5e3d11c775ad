#include "modal_motion.h"
#include "divided.h"
#include "../common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Over a time this short, in terms of the fastest exponent, three terms of a series are all of it. */
#define CLOSE 1e-6

/* And over one as short as this an exponent is hardly another one. */
#define LITTLE 0.1

int tribo_modal_motion_create(struct modal_motion *x, tribo_system *sys, const struct stick_slip *contacts)
{
    const size_t n = sys->ndof;
    double **const by_mode[] = {&x->eta, &x->rate, &x->off,   &x->vel,        &x->acc,
                                &x->now, &x->work, &x->drift, &x->drift_rate, &x->dq};
    double **const by_exponent[] = {&x->zr, &x->zi, &x->wr, &x->wi, &x->w1r, &x->w1i, &x->w2r, &x->w2i, &x->growth, &x->growth6};
    double *work = malloc((10 * n + 20 * n + 3 * sys->ncontact + 1) * sizeof *work);
    if (!work) {
        return 0;
    }
    for (size_t k = 0; k < 10; k++) {
        *by_mode[k] = work + k * n;
        *by_exponent[k] = work + (10 + 2 * k) * n;
    }
    x->sys = sys;
    x->start = work + 30 * n;
    x->ramp = x->start + sys->ncontact;
    x->steady = x->ramp + sys->ncontact;
    x->contacts = contacts;
    return 1;
}

void tribo_modal_motion_free(struct modal_motion *x)
{
    free(x->eta);
    free(x->cos_t);
}

int tribo_modal_motion_reserve(struct modal_motion *x, size_t harmonics)
{
    const size_t room = harmonics + 1;
    if (room <= x->room) {
        return 1;
    }
    double *more = realloc(x->cos_t, 4 * room * sizeof *more);
    if (!more) {
        return 0;
    }
    x->room = room;
    x->cos_t = more;
    x->sin_t = more + room;
    x->cos_0 = more + 2 * room;
    x->sin_0 = more + 3 * room;
    return 1;
}

/* How many times a harmonic is in what happens: those of limits as many times as the force of their contact follows it. */
static double side_of(const struct modal_motion *x, size_t s)
{
    const size_t contact = x->h->forcing[s].contact;
    return contact < x->sys->ncontact ? tribo_stick_slip_follows(x->contacts, contact) : 1.0;
}

/* ------------------------------------------------------------------------------------------------------------------- later on */

/* Adds what a resonant harmonic does to an exponent, from nothing at t0 on: z' = lambda z - (i/nu) Re(g e^{i Omega t}). */
static void add_resonance(struct modal_motion *x, size_t p, size_t s, double tau)
{
    const struct modal *h = x->h;
    const double omega = h->forcing[s].omega, nu = h->li[p];
    const double c0 = x->cos_0[s], s0 = x->sin_0[s];
    const double gr = h->gr[s * h->modes + h->owner[p]], gi = h->gi[s * h->modes + h->owner[p]];
    const double e = exp(h->lr[p] * tau), er = e * cos(nu * tau), ei = e * sin(nu * tau);
    double zr = 0.0, zi = 0.0;
    for (int conjugate = 0; conjugate < 2; conjugate++) {
        const double side = conjugate ? -1.0 : 1.0;
        const double complex u = tau * tribo_exp_1(tau * (-h->lr[p] + (side * omega - nu) * I));
        const double ur = creal(u), ui = cimag(u);
        /* (g e^{i Omega t0})/2, or its conjugate, times e^{lambda tau} times u */
        const double ar = 0.5 * (gr * c0 - gi * s0), ai = 0.5 * side * (gr * s0 + gi * c0);
        const double br = ar * er - ai * ei, bi = ar * ei + ai * er;
        zr += br * ur - bi * ui;
        zi += br * ui + bi * ur;
    }
    const double yr = zi / nu, yi = -zr / nu; /* times -i/nu */
    const double ct = x->cos_t[s], st = x->sin_t[s];
    const double force = -(gr * ct - gi * st) / nu, rate = omega * (gr * st + gi * ct) / nu;
    const double y1r = h->lr[p] * yr - nu * yi, y1i = h->lr[p] * yi + nu * yr + force;
    x->wr[p] += yr;
    x->wi[p] += yi;
    x->w1r[p] += y1r;
    x->w1i[p] += y1i;
    x->w2r[p] += h->lr[p] * y1r - nu * y1i;
    x->w2i[p] += h->lr[p] * y1i + nu * y1r + rate;
}

static void for_resonances(struct modal_motion *x, double tau)
{
    const struct modal *h = x->h;
    for (size_t s = 0; s < h->harmonics && h->any_resonant; s++) {
        for (size_t p = 0; p < h->exponents; p++) {
            if (h->resonant[s * h->modes + h->owner[p]]) {
                add_resonance(x, p, s, tau);
            }
        }
    }
}

/* e^{lambda delta} of an exponent. */
static void grow(const struct modal *h, size_t p, double delta, double *re, double *im)
{
    const double size = h->lr[p] != 0.0 ? exp(h->lr[p] * delta) : 1.0, angle = h->li[p] * delta;
    const double c = cos(angle), s = sin(angle); /* at once, where the compiler can */
    *re = size * c;
    *im = size * s;
}

/* The same where |lambda delta| is tiny. */
static void grow_little(const struct modal *h, size_t p, double delta, double *re, double *im)
{
    const double x = h->lr[p] * delta, y = h->li[p] * delta;
    *re = 1.0 + x + 0.5 * (x * x - y * y);
    *im = y + x * y;
}

/* From t0, or, if that is close, from where it was. */
void tribo_modal_motion_go(struct modal_motion *x, double tau)
{
    const struct modal *h = x->h;
    const double delta = tau - x->tau;
    const int close = fabs(delta) * x->fastest < CLOSE && !h->any_resonant;
    const double *cos_from = close ? x->cos_t : x->cos_0, *sin_from = close ? x->sin_t : x->sin_0;
    for (size_t s = 0; s < h->harmonics; s++) {
        const double angle = h->forcing[s].omega * (close ? delta : tau);
        /* far ones from t0, since what rounding leaves of a late time must not tremble within a phase */
        const double c = close ? 1.0 - 0.5 * angle * angle : cos(angle), d = close ? angle : sin(angle);
        const double ct = cos_from[s], st = sin_from[s];
        x->cos_t[s] = c * ct - d * st;
        x->sin_t[s] = d * ct + c * st;
    }
    for (size_t p = 0; p < h->exponents; p++) {
        const double lr = h->lr[p], li = h->li[p], zr = close ? x->wr[p] : x->zr[p], zi = close ? x->wi[p] : x->zi[p];
        double er, ei;
        (close ? grow_little : grow)(h, p, close ? delta : tau, &er, &ei);
        const double wr = zr * er - zi * ei, wi = zr * ei + zi * er;
        const double w1r = lr * wr - li * wi, w1i = lr * wi + li * wr;
        x->wr[p] = wr;
        x->wi[p] = wi;
        x->w1r[p] = w1r;
        x->w1i[p] = w1i;
        x->w2r[p] = lr * w1r - li * w1i;
        x->w2i[p] = lr * w1i + li * w1r;
    }
    for_resonances(x, tau);
    x->tau = tau;
}

struct sample tribo_modal_motion_output(const struct modal_motion *x, const struct output *w, double start, double ramp)
{
    double v0 = start + ramp * x->tau, v1 = ramp, v2 = 0.0;
    for (size_t p = 0; p < x->h->exponents; p++) {
        v0 += w->cr[p] * x->wr[p] - w->ci[p] * x->wi[p];
        v1 += w->cr[p] * x->w1r[p] - w->ci[p] * x->w1i[p];
        v2 += w->cr[p] * x->w2r[p] - w->ci[p] * x->w2i[p];
    }
    for (size_t s = 0; s < x->h->harmonics; s++) {
        const double omega = x->h->forcing[s].omega, ct = x->cos_t[s], st = x->sin_t[s];
        const double re = w->rr[s] * ct - w->ri[s] * st, im = -w->rr[s] * st - w->ri[s] * ct;
        v0 += re;
        v1 += omega * im;
        v2 -= omega * omega * re;
    }
    return (struct sample){v0, v1, v2};
}

struct sample tribo_modal_motion_limit(const struct modal_motion *x, size_t i)
{
    struct sample sum = {0.0, 0.0, 0.0};
    for (size_t s = 0; s < x->h->given; s++) {
        const struct harmonic *w = &x->sys->harmonic[s];
        if (w->drives == DRIVES_LIMIT) {
            const double c = w->cosine[i], d = w->sine[i], value = c * x->cos_t[s] + d * x->sin_t[s];
            sum.g += value;
            sum.d += w->omega * (d * x->cos_t[s] - c * x->sin_t[s]);
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

void tribo_modal_motion_line(const struct modal_motion *x, const struct output *w, int of_velocity, double now, double *start,
                             double *ramp)
{
    const struct modal *h = x->h;
    *start = now;
    *ramp = w->ramp;
    for (size_t p = 0; p < h->exponents; p++) {
        *start -= w->cr[p] * x->zr[p] - w->ci[p] * x->zi[p];
    }
    for (size_t s = 0; s < h->harmonics; s++) {
        *start -= w->rr[s] * x->cos_0[s] - w->ri[s] * x->sin_0[s];
    }
    for (size_t k = 0; k < h->modes; k++) {
        *ramp += w->on_rate[k] * (of_velocity ? x->acc[k] : x->vel[k]);
    }
}

void tribo_modal_motion_output_bounds(const struct modal_motion *x, const struct output *w, double *size, double *bend)
{
    const struct modal *h = x->h;
    *size = *bend = 0.0;
    for (size_t p = 0; p < h->exponents; p++) {
        *bend += w->bend[p] * x->growth6[p];
        *size += w->size[p] * x->growth[p];
    }
    for (size_t s = 0; s < h->harmonics; s++) {
        const double side = fabs(side_of(x, s));
        *size += side * w->wave[s];
        *bend += side * w->wave_bend[s];
    }
}

/* By how much an exponent has moved where go() was. In a time short beside its own it moves by little of what it is, which with a
 * load far above its frequency is all that there is. */
static double complex moved(const struct modal_motion *x, size_t p)
{
    const double complex lambda_tau = x->tau * (x->h->lr[p] + x->h->li[p] * I), z = x->zr[p] + x->zi[p] * I;
    if (x->tau * x->h->size[p] < LITTLE && !x->h->any_resonant) {
        return z * lambda_tau * tribo_exp_1(lambda_tau);
    }
    return x->wr[p] + x->wi[p] * I - z;
}

/* By how much eta has changed (into now), and eta' (into work) where go() was. */
static void amplitudes(struct modal_motion *x)
{
    const struct modal *h = x->h;
    const size_t m = h->modes, e = h->exponents;
    for (size_t k = 0; k < m; k++) {
        const double drift = h->drifts[k] ? x->drift_rate[k] : 0.0;
        x->now[k] = x->tau * (x->vel[k] + drift + 0.5 * x->acc[k] * x->tau);
        x->work[k] = x->vel[k] + x->acc[k] * x->tau + drift;
    }
    for (size_t p = 0; h->owner && p < e; p++) {
        x->now[h->owner[p]] += creal(moved(x, p));
        x->work[h->owner[p]] += h->lr[p] * x->wr[p] - h->li[p] * x->wi[p];
    }
    for (size_t p = 0; !h->owner && p < e; p++) {
        const double complex z = moved(x, p);
        for (size_t k = 0; k < m; k++) {
            const double rr = h->rr[k * e + p], ri = h->ri[k * e + p];
            x->now[k] += rr * creal(z) - ri * cimag(z);
            x->work[k] += rr * (h->lr[p] * x->wr[p] - h->li[p] * x->wi[p]) - ri * (h->lr[p] * x->wi[p] + h->li[p] * x->wr[p]);
        }
    }
    for (size_t s = 0; s < h->harmonics; s++) {
        const double omega = h->forcing[s].omega, ct = x->cos_t[s], st = x->sin_t[s];
        for (size_t k = 0; k < m; k++) {
            const double xr = h->xr[s * m + k], xi = h->xi[s * m + k];
            x->now[k] += xr * (ct - x->cos_0[s]) - xi * (st - x->sin_0[s]);
            x->work[k] -= omega * (xr * st + xi * ct);
        }
    }
}

void tribo_modal_motion_state(struct modal_motion *x, double tau, const double *from, double *to)
{
    const tribo_system *sys = x->sys;
    const struct modal *h = x->h;
    const size_t n = sys->ndof;
    tribo_modal_motion_go(x, tau);
    amplitudes(x);
    memset(x->dq, 0, n * sizeof *x->dq);
    if (to != from) {
        memcpy(to, from, tribo_system_dimension(sys) * sizeof *to);
    }
    for (size_t i = 0; i < h->moving; i++) {
        double dq = h->y0[i] * tau, u = h->y0[i];
        for (size_t s = 0; s < h->given; s++) {
            const double omega = h->forcing[s].omega, yr = h->yr[s * h->moving + i], yi = h->yi[s * h->moving + i];
            u += yr * x->cos_t[s] - yi * x->sin_t[s];
            dq += omega != 0.0 ? (yr * (x->sin_t[s] - x->sin_0[s]) + yi * (x->cos_t[s] - x->cos_0[s])) / omega : 0.0;
        }
        x->dq[h->dof[i]] = dq;
        to[n + h->dof[i]] = u;
    }
    for (size_t k = 0; k < h->modes; k++) {
        const double *phi = h->phi + k * h->moving, change = x->now[k];
        for (size_t i = 0; i < h->moving; i++) {
            x->dq[h->dof[i]] += phi[i] * change;
            to[n + h->dof[i]] += phi[i] * x->work[k];
        }
    }
    for (size_t i = 0; i < h->moving; i++) {
        to[h->dof[i]] += x->dq[h->dof[i]];
    }
    to[2 * n] += tribo_modal_motion_dissipated(x, tau);
}

/* ------------------------------------------------------------------------------------------------------- the start of a phase */

/* J_i q, less what harmonics of the base have moved it by. */
static double offset(const tribo_system *sys, size_t i, const double *q)
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

/* now = the constant part of the right-hand side at t0: by forces that slide, by where contacts hold, by constant loads. The
 * stiffness of the whole has no part in it: what it makes of a rigid-body displacement would be its rounding. */
static void find_constant(struct modal_motion *x, const tribo_system *sys, const double *y)
{
    const struct modal *h = x->h;
    const size_t m = h->modes;
    memcpy(x->now, h->drag, m * sizeof *x->now);
    for (size_t o = 0; o < h->outputs; o++) {
        const struct output *out = &h->output[o];
        const double push = o < h->sliding ? x->steady[out->contact] : -offset(sys, out->contact, y);
        for (size_t k = 0; k < m; k++) {
            x->now[k] += push * out->on_rate[k];
        }
    }
    for (size_t s = 0; s < h->given; s++) {
        for (size_t k = 0; h->forcing[s].omega == 0.0 && k < m; k++) {
            x->now[k] += h->gr[s * m + k];
        }
    }
}

/* The forces of contacts but for harmonics of limits that they follow. */
static void find_steady_forces(struct modal_motion *x, const tribo_system *sys)
{
    memcpy(x->steady, x->contacts->force, sys->ncontact * sizeof *x->steady);
    for (size_t i = 0; sys->limit_harmonics && i < sys->ncontact; i++) {
        double limit = sys->given_limit[i];
        for (size_t s = 0; s < sys->harmonics; s++) {
            const struct harmonic *w = &sys->harmonic[s];
            limit += w->drives == DRIVES_LIMIT && w->omega == 0.0 ? w->cosine[i] : 0.0;
        }
        x->steady[i] = tribo_stick_slip_follows(x->contacts, i) * limit;
    }
}

/* Amplitudes of eta at t0, split into what the right-hand side makes of it and exponentials. */
static void split_motion(struct modal_motion *x, tribo_system *sys, const double *y)
{
    const struct modal *h = x->h;
    const size_t n = sys->ndof, m = h->modes;
    tribo_system_set_time(sys, x->t0);
    for (size_t s = 0; s < h->harmonics; s++) {
        const struct forcing *f = &h->forcing[s];
        const double side = side_of(x, s);
        x->cos_0[s] = side * sys->harmonic[f->harmonic].cos_t;
        x->sin_0[s] = side * sys->harmonic[f->harmonic].sin_t;
    }
    for (size_t k = 0; k < m; k++) {
        const double *psi = h->psi + k * h->moving;
        double q = 0.0, u = 0.0;
        for (size_t i = 0; i < h->moving; i++) {
            q += psi[i] * y[h->dof[i]];
            u += psi[i] * y[n + h->dof[i]];
        }
        x->eta[k] = q;
        x->rate[k] = u;
    }
    find_steady_forces(x, sys);
    find_constant(x, sys, y);
    for (size_t k = 0; k < m; k++) {
        const double force = x->now[k];
        x->off[k] = x->vel[k] = x->acc[k] = 0.0;
        if (h->drifts[k]) {
            x->acc[k] = force;
        } else if (h->omega2[k] == 0.0) {
            x->vel[k] = force / h->damping[k];
        } else {
            x->vel[k] = h->ramp[k] / h->omega2[k];
            x->off[k] = force / h->omega2[k];
        }
    }
    for (size_t k = 0; k < m; k++) {
        if (h->omega2[k] != 0.0) {
            x->off[k] -= (h->coupling ? tribo_dot(h->coupling + k * m, x->vel, m) : h->damping[k] * x->vel[k]) / h->omega2[k];
        }
    }
    for (size_t k = 0; k < m; k++) {
        double q = x->off[k], u = x->vel[k];
        for (size_t s = 0; s < h->harmonics; s++) {
            const double xr = h->xr[s * m + k], xi = h->xi[s * m + k];
            q += xr * x->cos_0[s] - xi * x->sin_0[s];
            u -= h->forcing[s].omega * (xr * x->sin_0[s] + xi * x->cos_0[s]);
        }
        x->now[k] = x->eta[k] - q;
        x->work[k] = x->rate[k] - u;
        x->drift[k] = x->now[k];
        x->drift_rate[k] = x->work[k];
    }
    for (size_t p = 0; p < h->exponents; p++) {
        if (h->owner) {
            const double q = x->now[h->owner[p]], u = x->work[h->owner[p]];
            x->zr[p] = h->ar[p] * q + h->br[p] * u;
            x->zi[p] = h->ai[p] * q + h->bi[p] * u;
        } else {
            x->zr[p] = tribo_dot(h->ar + p * m, x->now, m) + tribo_dot(h->br + p * m, x->work, m);
            x->zi[p] = tribo_dot(h->ai + p * m, x->now, m) + tribo_dot(h->bi + p * m, x->work, m);
        }
    }
}

/* The part of the velocities of sliding contacts that is linear in time. */
static void find_lines(struct modal_motion *x, const double *y)
{
    const struct stick_slip *m = x->contacts;
    for (size_t o = 0; o < x->h->sliding; o++) {
        const size_t i = x->h->output[o].contact;
        const double v = m->rested[i] ? 0.0 : tribo_stick_slip_velocity(m, x->sys, i, y);
        tribo_modal_motion_line(x, &x->h->output[o], 1, v, &x->start[i], &x->ramp[i]);
    }
}

/* How long the bounds of a phase can hold: for good, unless something grows. */
static double longest_phase(const struct modal *h, double longest)
{
    for (size_t p = 0; p < h->exponents; p++) {
        longest = h->lr[p] > 0.0 ? lesser(longest, 1.0 / h->lr[p]) : longest;
    }
    return h->any_resonant ? lesser(longest, 16.0 / h->fastest) : longest;
}

void tribo_modal_motion_bound(struct modal_motion *x, double tau)
{
    const struct modal *h = x->h;
    for (size_t p = 0; p < h->exponents; p++) {
        const double lambda = h->size[p], time = h->lr[p] > 0.0 ? x->longest : tau;
        x->growth[p] = hypot(x->zr[p], x->zi[p]) * (h->lr[p] != 0.0 ? exp(h->lr[p] * time) : 1.0);
        x->growth6[p] = x->growth[p];
        for (size_t s = 0; s < h->harmonics && h->any_resonant; s++) {
            const size_t at = s * h->modes + h->owner[p];
            if (h->resonant[at]) {
                const double force = hypot(h->gr[at], h->gi[at]) / h->li[p];
                /* the frequencies are within RESONANCE of each other */
                x->growth[p] += force * x->longest;
                x->growth6[p] += force * (x->longest + 6.1 / lambda);
            }
        }
    }
}

double tribo_modal_motion_start(struct modal_motion *x, const struct modal *h, double t, const double *y, double longest)
{
    x->h = h;
    x->t0 = t;
    split_motion(x, x->sys, y);
    if (x->sys->limit_harmonics) {
        find_lines(x, y);
    }
    x->tau = 0.0;
    x->fastest = h->fastest;
    for (size_t s = 0; s < h->harmonics; s++) {
        x->fastest = greater(x->fastest, fabs(h->forcing[s].omega));
        x->cos_t[s] = x->cos_0[s];
        x->sin_t[s] = x->sin_0[s];
    }
    memcpy(x->wr, x->zr, h->exponents * sizeof *x->wr);
    memcpy(x->wi, x->zi, h->exponents * sizeof *x->wi);
    x->longest = longest_phase(h, longest);
    tribo_modal_motion_bound(x, 0.0);
    return x->longest;
}
