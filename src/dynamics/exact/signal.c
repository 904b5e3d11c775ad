/* A linear combination of the state in a phase of method "exact". */
#include "terms.h"

#include <math.h>
#include <string.h>

/* |omega^2 - Omega^2 + i Omega damping|/omega^2 below which more than half of the digits are lost. */
#define TOO_CLOSE 1e-7

/* Returns the index in compliance.contact of the p-th compliant contact at rest. */
static size_t spring_index(const struct modal_motion *x, size_t p)
{
    const size_t contact = x->h->output[x->h->outputs - x->h->held.springs + p].contact;
    size_t i = 0;
    while (x->sys->compliance.contact[i] != contact) {
        i++;
    }
    return i;
}

/* *place, *speed = derivatives of c'[q, q', f, f'] by eta_k and eta_k'. */
static void weights(const struct modal_motion *x, const double *c, size_t k, double *place, double *speed)
{
    const struct modal *h = x->h;
    const size_t n = x->sys->ndof;
    *place = *speed = 0.0;
    for (size_t p = 0; p < h->held.springs; p++) {
        const double rate = h->output[h->outputs - h->held.springs + p].on_rate[k];
        const double *of = c + 2 * n + spring_index(x, p);
        *place += rate * of[0];
        *speed += rate * of[x->sys->compliance.count];
    }
    for (size_t i = 0; i < h->moving; i++) {
        *place += h->phi[k * h->moving + i] * c[h->dof[i]];
        *speed += h->phi[k * h->moving + i] * c[n + h->dof[i]];
    }
}

/* *xr + i *xi = response of mode k to harmonic s, also if resonant. In the motion a resonant response is part of the exponents,
 * which avoids the small divisor. */
static void response(const struct modal_motion *x, size_t s, size_t k, double *xr, double *xi)
{
    const struct modal *h = x->h;
    const size_t at = s * h->modes + k;
    *xr = h->xr[at];
    *xi = h->xi[at];
    if (h->resonant[at]) {
        const double omega = h->forcing[s].omega, re = h->omega2[k] - omega * omega, im = omega * h->damping[k];
        const double square = re * re + im * im;
        *xr = (h->gr[at] * re + h->gi[at] * im) / square;
        *xi = (h->gi[at] * re - h->gr[at] * im) / square;
    }
}

/* *zr + i *zi = z of exponent p at t0 minus the resonant responses at t0. */
static void exponent(const struct modal_motion *x, size_t p, double *zr, double *zi)
{
    const struct modal *h = x->h;
    const struct number z = tribo_term_at_start(x, p);
    *zr = z.re;
    *zi = z.im;
    for (size_t s = 0; s < h->harmonics && h->any_resonant; s++) {
        const size_t k = h->owner[p];
        const double omega = h->forcing[s].omega;
        double xr, xi;
        if (h->resonant[s * h->modes + k]) {
            response(x, s, k, &xr, &xi);
            const struct number w = tribo_harmonic_at_start(x, s);
            const double q = xr * w.re - xi * w.im, u = -omega * (xr * w.im + xi * w.re);
            *zr -= h->ar[p] * q + h->br[p] * u;
            *zi -= h->ai[p] * q + h->bi[p] * u;
        }
    }
}

/* Returns 1 if a resonance is closer than TOO_CLOSE. */
static int too_close(const struct modal_motion *x)
{
    const struct modal *h = x->h;
    for (size_t at = 0; at < h->harmonics * h->modes && h->any_resonant; at++) {
        const size_t k = at % h->modes;
        const double omega = h->forcing[at / h->modes].omega, re = h->omega2[k] - omega * omega, im = omega * h->damping[k];
        if (h->resonant[at] && hypot(re, im) < TOO_CLOSE * fabs(h->omega2[k])) {
            return 1;
        }
    }
    return 0;
}

/* *cr + i *ci += (place + speed lambda) r z, the part by exponent p of a mode with eta = Re(r z). */
static void add_exponent(const struct modal_motion *x, size_t p, double place, double speed, double rr, double ri, double *cr,
                         double *ci)
{
    const struct modal *h = x->h;
    const double fr = place + speed * h->lr[p], fi = speed * h->li[p];
    double r, i;
    exponent(x, p, &r, &i);
    const double zr = rr * r - ri * i, zi = rr * i + ri * r;
    *cr += fr * zr - fi * zi;
    *ci += fr * zi + fi * zr;
}

static void add_exponents(const struct modal_motion *x, const double *c, struct signal *to)
{
    const struct modal *h = x->h;
    for (size_t p = 0; p < h->exponents; p++) {
        double cr = 0.0, ci = 0.0, place, speed;
        for (size_t k = h->owner ? h->owner[p] : 0; k < (h->owner ? h->owner[p] + 1 : h->modes); k++) {
            weights(x, c, k, &place, &speed);
            add_exponent(x, p, place, speed, h->owner ? 1.0 : h->rr[p * h->modes + k],
                         h->owner ? 0.0 : h->ri[p * h->modes + k], &cr, &ci);
        }
        tribo_signal_add(to, cr, ci, h->lr[p], h->li[p]);
    }
}

/* Adds harmonic s: response of the modes, velocities by bases, and f' of compliant contacts at rest. */
static void add_harmonic(const struct modal_motion *x, const double *c, size_t s, struct signal *to)
{
    const struct modal *h = x->h;
    const size_t n = x->sys->ndof;
    const double omega = h->forcing[s].omega;
    double re = 0.0, im = 0.0;
    for (size_t k = 0; k < h->modes; k++) {
        double place, speed, xr, xi;
        response(x, s, k, &xr, &xi);
        weights(x, c, k, &place, &speed);
        re += place * xr - speed * omega * xi;
        im += place * xi + speed * omega * xr;
    }
    for (size_t i = 0; s < h->given && i < h->moving; i++) {
        const double yr = h->yr[s * h->moving + i], yi = h->yi[s * h->moving + i], place = c[h->dof[i]], speed = c[n + h->dof[i]];
        re += speed * yr + (omega != 0.0 ? place * yi / omega : 0.0);
        im += speed * yi - (omega != 0.0 ? place * yr / omega : 0.0);
    }
    for (size_t p = 0; s < h->given && p < h->held.springs; p++) {
        const double fr = h->held.fr[s * h->held.springs + p], fi = h->held.fi[s * h->held.springs + p], *of = c + 2 * n + spring_index(x, p);
        const double speed = of[x->sys->compliance.count], place = omega != 0.0 ? of[0] / omega : 0.0;
        re += speed * fr + place * fi;
        im += speed * fi - place * fr;
    }
    const struct number w = tribo_harmonic_at_start(x, s);
    tribo_signal_add(to, re * w.re - im * w.im, re * w.im + im * w.re, 0.0, omega);
}

static void add_powers(const struct modal_motion *x, const double *c, double *a)
{
    const struct modal *h = x->h;
    for (size_t k = 0; k < h->modes; k++) {
        double place, speed;
        const double rate = x->vel[k] + (h->drifts[k] ? x->drift_rate[k] : 0.0);
        weights(x, c, k, &place, &speed);
        a[1] += place * rate + speed * x->acc[k];
        a[2] += 0.5 * place * x->acc[k];
    }
    for (size_t i = 0; i < h->moving; i++) {
        a[1] += c[h->dof[i]] * h->y0[i];
    }
    for (size_t p = 0; p < h->held.springs; p++) {
        a[1] += c[2 * x->sys->ndof + spring_index(x, p)] * h->held.f0[p];
    }
}

/* Returns c'[q, q', f, f'] at the end of the phase, t0 + tau. Overwrites x->way and x->push. */
static double value_at_end(const struct modal_motion *x, const double *c, double tau, const double *end)
{
    const tribo_system *sys = x->sys;
    const size_t f = tribo_system_energy(sys);
    double value = tribo_dot(c, end, f);
    if (x->h->held.springs) {
        memset(x->way, 0, sys->ncontact * sizeof *x->way);
        tribo_system_add_base_at(sys, x->t0 + tau, -1.0, x->way);
        tribo_matrix_multiply_add(&sys->direction, 1.0, end + sys->ndof, x->way);
        tribo_compliance_rates(sys, x->contacts->state.slip, x->way, x->push);
        for (size_t p = 0; p < x->h->held.springs; p++) {
            const size_t i = spring_index(x, p);
            value += c[f + i] * x->push[sys->compliance.contact[i]];
        }
    }
    return value;
}

int tribo_modal_motion_signal(const struct modal_motion *x, const double *c, double tau, const double *end, struct signal *to)
{
    const struct modal *h = x->h;
    double v[3];
    if (too_close(x)) {
        return tribo_system_fail(x->sys, TRIBO_ERR_UNSUPPORTED,
                                 "method exact: a load is in resonance with an undamped mode; method event can do it");
    }
    if (!tribo_signal_reserve(to, h->exponents + h->harmonics, 2)) {
        return tribo_system_fail(x->sys, TRIBO_ERR_MEMORY, "out of memory for %zu exponent%s", h->exponents,
                                 plural(h->exponents));
    }
    to->tau = tau;
    add_exponents(x, c, to);
    for (size_t s = 0; s < h->harmonics; s++) {
        add_harmonic(x, c, s, to);
    }
    add_powers(x, c, to->a);
    /* a[0] from the state at the end of the phase */
    tribo_signal_at(to, tau, v);
    to->a[0] = value_at_end(x, c, tau, end) - v[0];
    return TRIBO_OK;
}
