#include "modal_motion.h"
#include "cos_sin.h"
#include "divided.h"
#include "../common/real.h"
#include "../common/simd.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Over a time this short, in terms of the fastest exponent, three terms of a series are all of it. */
#define CLOSE 1e-6

/* Over a time this short, in terms of its exponent, an exponential moves by a small part of itself: by how much is not found as a
 * difference, which would lose digits. */
#define LITTLE 0.1

int tribo_modal_motion_create(struct modal_motion *x, tribo_system *sys, const struct stick_slip *contacts)
{
    const size_t n = sys->ndof;
    double **const by_mode[] = {&x->eta, &x->rate, &x->off,   &x->vel,        &x->acc,
                                &x->now, &x->work, &x->drift, &x->drift_rate, &x->dq};
    double **const by_exponent[] = {&x->zr, &x->zi, &x->wr, &x->wi, &x->w1i, &x->w2r, &x->w2i, &x->growth, &x->growth6};
    const size_t modes = sizeof by_mode / sizeof *by_mode, exponents = sizeof by_exponent / sizeof *by_exponent;
    double *work = malloc(((modes + 2 * exponents) * n + 3 * sys->ncontact + 1) * sizeof *work);
    if (!work) {
        return 0;
    }
    for (size_t k = 0; k < modes; k++) {
        *by_mode[k] = work + k * n;
    }
    for (size_t k = 0; k < exponents; k++) {
        *by_exponent[k] = work + (modes + 2 * k) * n;
    }
    x->sys = sys;
    x->start = work + (modes + 2 * exponents) * n;
    x->ramp = x->start + sys->ncontact;
    x->room_for_steady = x->ramp + sys->ncontact;
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
    double *more = realloc(x->cos_t, 5 * room * sizeof *more);
    if (!more) {
        return 0;
    }
    x->room = room;
    x->cos_t = more;
    x->sin_t = more + room;
    x->cos_0 = more + 2 * room;
    x->sin_0 = more + 3 * room;
    x->side = more + 4 * room;
    return 1;
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
    x->wr[p] += yr;
    x->wi[p] += yi;
    x->w1i[p] += force;
    x->w2r[p] -= nu * force;
    x->w2i[p] += h->lr[p] * force + rate;
}

static void for_resonances(struct modal_motion *x, double tau)
{
    const struct modal *h = x->h;
    for (size_t p = 0; p < h->exponents && h->any_resonant; p++) {
        x->w1i[p] = x->w2r[p] = x->w2i[p] = 0.0;
    }
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
    tribo_turn(h->li[p] * delta, re, im);
    if (h->lr[p] != 0.0) {
        const double size = exp(h->lr[p] * delta);
        *re *= size;
        *im *= size;
    }
}

/* The same where |lambda delta| is tiny. */
static void grow_little(const struct modal *h, size_t p, double delta, double *re, double *im)
{
    const double x = h->lr[p] * delta, y = h->li[p] * delta;
    *re = 1.0 + x + 0.5 * (x * x - y * y);
    *im = y + x * y;
}

/* Turns the harmonics that were at `from` (cosines, sines) on by a time, a little one or not; those of single contacts are what
 * the system's are. */
static void turn_harmonics(struct modal_motion *x, const double *const *from, double delta, int little)
{
    const struct modal *h = x->h;
    for (size_t s = 0; s < h->given; s++) {
        const double angle = h->forcing[s].omega * delta, ct = from[0][s], st = from[1][s];
        double c = 1.0 - 0.5 * angle * angle, d = angle;
        if (!little) {
            tribo_turn(angle, &c, &d);
        }
        x->cos_t[s] = c * ct - d * st;
        x->sin_t[s] = d * ct + c * st;
    }
    for (size_t s = h->given; s < h->harmonics; s++) {
        x->cos_t[s] = x->side[s] * x->cos_t[h->forcing[s].harmonic];
        x->sin_t[s] = x->side[s] * x->sin_t[h->forcing[s].harmonic];
    }
}

/* Lets exponentials that were at `from` (real, imaginary parts) grow for a time, a little one or not. */
static void grow_all(struct modal_motion *x, const double *const *from, double delta, int little)
{
    const struct modal *h = x->h;
    for (size_t p = 0; p < h->exponents; p++) {
        const double zr = from[0][p], zi = from[1][p];
        double er, ei;
        if (little) {
            grow_little(h, p, delta, &er, &ei);
        } else {
            grow(h, p, delta, &er, &ei);
        }
        x->wr[p] = zr * er - zi * ei;
        x->wi[p] = zr * ei + zi * er;
    }
}

/* From t0, or, if that is close, from where it was. Far ones from t0, since what rounding leaves of a late time must not tremble
 * within a phase. */
void tribo_modal_motion_go(struct modal_motion *x, double tau)
{
    const double delta = tau - x->tau;
    const int little = fabs(delta) * x->h->quickest < CLOSE && !x->h->any_resonant, on = little && !x->unmoved;
    const double *const wave[] = {on ? x->cos_t : x->cos_0, on ? x->sin_t : x->sin_0};
    const double *const z[] = {on ? x->wr : x->zr, on ? x->wi : x->zi};
    turn_harmonics(x, wave, little ? delta : tau, little);
    grow_all(x, z, little ? delta : tau, little);
    for_resonances(x, tau);
    x->tau = tau;
    x->unmoved = 0;
}

enum { LANES = 4 }; /* side by side, since one sum would wait for itself */

/* sum [LANES] += a r - b i */
static inline void add_products(const double *restrict a, const double *restrict r, const double *restrict b,
                                const double *restrict i, double *restrict sum)
{
    for (size_t k = 0; k < LANES; k++) {
        sum[k] += a[k] * r[k] - b[k] * i[k];
    }
}

/* What n exponentials make of an output, as far as they fill lanes: Re(c w), Re(c lambda w), Re(c lambda^2 w) into sum
 * [3][LANES], which is not of this function, or compilers would take several lots of lanes at once, and sort them first. Returns
 * how many are done. */
TRIBO_SIMD_OF_FOUR static size_t add_lanes(const struct output *c, size_t n, const double *restrict wr, const double *restrict wi,
                                           double *restrict sum)
{
    size_t p = 0;
    for (; p + LANES <= n; p += LANES) {
        add_products(c->cr + p, wr + p, c->ci + p, wi + p, sum);
        add_products(c->c1r + p, wr + p, c->c1i + p, wi + p, sum + LANES);
        add_products(c->c2r + p, wr + p, c->c2i + p, wi + p, sum + 2 * LANES);
    }
    return p;
}

/* The same into v, v', v''. */
static size_t add_most(const struct output *c, size_t n, const double *wr, const double *wi, double *v)
{
    double sum[3][LANES] = {{0.0}};
    const size_t done = add_lanes(c, n, wr, wi, sum[0]);
    for (size_t order = 0; order < 3; order++) {
        v[order] += (sum[order][0] + sum[order][2]) + (sum[order][1] + sum[order][3]);
    }
    return done;
}

/* What resonances add to the derivatives of an output. */
static void add_resonances(const struct modal_motion *x, const struct output *w, double *v)
{
    for (size_t p = 0; p < x->h->exponents; p++) {
        v[1] -= w->ci[p] * x->w1i[p];
        v[2] += w->cr[p] * x->w2r[p] - w->ci[p] * x->w2i[p];
    }
}

struct sample tribo_modal_motion_output(const struct modal_motion *x, const struct output *w, double start, double ramp)
{
    const struct modal *h = x->h;
    const size_t n = h->exponents;
    double v[] = {start + ramp * x->tau, ramp, 0.0};
    for (size_t p = n < LANES ? 0 : add_most(w, n, x->wr, x->wi, v); p < n; p++) {
        const double wr = x->wr[p], wi = x->wi[p];
        v[0] += w->cr[p] * wr - w->ci[p] * wi;
        v[1] += w->c1r[p] * wr - w->c1i[p] * wi;
        v[2] += w->c2r[p] * wr - w->c2i[p] * wi;
    }
    if (h->any_resonant) {
        add_resonances(x, w, v);
    }
    for (size_t s = 0; s < h->harmonics; s++) {
        const double omega = h->forcing[s].omega, ct = x->cos_t[s], st = x->sin_t[s];
        const double re = w->rr[s] * ct - w->ri[s] * st, im = w->rr[s] * st + w->ri[s] * ct;
        v[0] += re;
        v[1] -= omega * im;
        v[2] -= omega * omega * re;
    }
    return (struct sample){v[0], v[1], v[2]};
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
        const double side = fabs(x->side[s]);
        *size += side * w->wave[s];
        *bend += side * w->wave_bend[s];
    }
}

/* By how much the exponential p has moved from t0 to where go() was. With a load far above its frequency the little by which it
 * moves is all of the motion. */
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
        memcpy(to, from, (2 * n + 1) * sizeof *to);
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
    for (size_t k = 0; k < m; k++) {
        x->now[k] = h->constant[k];
    }
    for (size_t o = 0; m > 0 && o < h->outputs; o++) {
        const struct output *out = &h->output[o];
        const double push = o < h->sliding ? x->steady[out->contact] : -offset(sys, out->contact, y);
        for (size_t k = 0; k < m; k++) {
            x->now[k] += push * out->on_rate[k];
        }
    }
}

/* The forces of contacts but for harmonics of limits that they follow. */
static const double *find_steady_forces(const struct modal_motion *x, const tribo_system *sys)
{
    double *steady = x->room_for_steady;
    for (size_t i = 0; sys->limit_harmonics && i < sys->ncontact; i++) {
        double limit = sys->given_limit[i];
        for (size_t s = 0; s < sys->harmonics; s++) {
            const struct harmonic *w = &sys->harmonic[s];
            limit += w->drives == DRIVES_LIMIT && w->omega == 0.0 ? w->cosine[i] : 0.0;
        }
        steady[i] = tribo_stick_slip_follows(x->contacts, i) * limit;
    }
    return sys->limit_harmonics ? steady : x->contacts->force;
}

/* The harmonics at t0, those of limits as many times as the force of their contact follows them. */
static void start_harmonics(struct modal_motion *x, tribo_system *sys)
{
    const struct modal *h = x->h;
    tribo_system_set_time(sys, x->t0);
    for (size_t s = 0; s < h->harmonics; s++) {
        const struct forcing *f = &h->forcing[s];
        const double side = s < h->given ? 1.0 : tribo_stick_slip_follows(x->contacts, f->contact);
        x->side[s] = side;
        tribo_system_turn(sys, f->harmonic);
        x->cos_0[s] = side * sys->harmonic[f->harmonic].cos_t;
        x->sin_0[s] = side * sys->harmonic[f->harmonic].sin_t;
    }
}

/* Amplitudes of eta at t0. */
static void find_amplitudes(struct modal_motion *x, const double *y)
{
    const struct modal *h = x->h;
    const double *velocity = y + x->sys->ndof;
    for (size_t k = 0; k < h->modes; k++) {
        const double *psi = h->psi + k * h->moving;
        double q = 0.0, u = 0.0;
        for (size_t i = 0; i < h->moving; i++) {
            q += psi[i] * y[h->dof[i]];
            u += psi[i] * velocity[h->dof[i]];
        }
        x->eta[k] = q;
        x->rate[k] = u;
    }
}

/* What the constant part of the right-hand side, and what of it grows with time, make of mode k. */
static void find_course(struct modal_motion *x, size_t k)
{
    const struct modal *h = x->h;
    const double force = x->now[k], stiffness = h->omega2[k];
    x->off[k] = x->vel[k] = x->acc[k] = 0.0;
    if (h->drifts[k]) {
        x->acc[k] = force;
    } else if (stiffness == 0.0) {
        x->vel[k] = force / h->damping[k];
    } else {
        x->vel[k] = h->ramp[k] / stiffness;
        x->off[k] = force / stiffness;
    }
}

/* What damping of that makes of a mode with stiffness. */
static void correct_course(struct modal_motion *x, size_t k)
{
    const struct modal *h = x->h;
    const size_t m = h->modes;
    if (h->omega2[k] != 0.0) {
        x->off[k] -= (h->coupling ? tribo_dot(h->coupling + k * m, x->vel, m) : h->damping[k] * x->vel[k]) / h->omega2[k];
    }
}

/* What all of that, and harmonics, do not explain of mode k at t0. */
static void find_rest(struct modal_motion *x, size_t k)
{
    const struct modal *h = x->h;
    double q = x->off[k], u = x->vel[k];
    for (size_t s = 0; s < h->harmonics; s++) {
        const double xr = h->xr[s * h->modes + k], xi = h->xi[s * h->modes + k];
        q += xr * x->cos_0[s] - xi * x->sin_0[s];
        u -= h->forcing[s].omega * (xr * x->sin_0[s] + xi * x->cos_0[s]);
    }
    x->drift[k] = x->eta[k] - q;
    x->drift_rate[k] = x->rate[k] - u;
}

/* Splits the motion into what the right-hand side makes of it and exponentials. */
static void split_motion(struct modal_motion *x, tribo_system *sys, const double *y)
{
    const struct modal *h = x->h;
    const size_t m = h->modes;
    start_harmonics(x, sys);
    x->steady = find_steady_forces(x, sys);
    find_amplitudes(x, y);
    find_constant(x, sys, y);
    for (size_t k = 0; k < m; k++) {
        find_course(x, k);
    }
    for (size_t k = 0; k < m; k++) {
        correct_course(x, k);
        find_rest(x, k);
    }
    for (size_t p = 0; p < h->exponents; p++) {
        if (h->owner) {
            const double q = x->drift[h->owner[p]], u = x->drift_rate[h->owner[p]];
            x->zr[p] = h->ar[p] * q + h->br[p] * u;
            x->zi[p] = h->ai[p] * q + h->bi[p] * u;
        } else {
            x->zr[p] = tribo_dot(h->ar + p * m, x->drift, m) + tribo_dot(h->br + p * m, x->drift_rate, m);
            x->zi[p] = tribo_dot(h->ai + p * m, x->drift, m) + tribo_dot(h->bi + p * m, x->drift_rate, m);
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
    x->unmoved = 1;
    x->longest = longest_phase(h, longest);
    tribo_modal_motion_bound(x, 0.0);
    return x->longest;
}
