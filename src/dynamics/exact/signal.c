/* SPDX-License-Identifier: BSD-3-Clause */
/* A linear combination of the state in a phase of method "exact". */
#include "terms.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* |i Omega - lambda|/|lambda| below which more than half of the digits are lost. */
#define TOO_CLOSE 5e-8

/* Adds place'eta + speed'eta' without the constant part, place, speed [shapes], to a signal with all terms. Terms of a resonant
 * harmonic s of exponent p: z of p in the motion has the part -i/nu times the sum of a (e^{mu tau} - e^{lambda tau})/(mu -
 * lambda) over mu = i Omega, a = g h/2 with the harmonic h at t0, and over the conjugates of mu and a. */
static void add_weights(const struct modal_motion *x, const double *place, const double *speed, struct signal *to)
{
    const struct forced *h = x->h;
    const struct modal *own = h->modal;
    size_t more = h->exponents + h->harmonics;
    for (size_t p = 0; p < h->exponents + h->harmonics; p++) {
        const size_t s = p < h->exponents ? 0 : p - h->exponents;
        const double complex c =
            p < h->exponents ? tribo_modal_weight(own, p, place, speed) : tribo_forced_weight(h, s, 0, place, speed);
        const struct number z = tribo_term_at_start(x, p);
        to->cr[p] += creal(c) * z.re - cimag(c) * z.im;
        to->ci[p] += creal(c) * z.im + cimag(c) * z.re;
        for (size_t r = 0; h->any_resonant && p < h->exponents && r < h->harmonics; r++) {
            const size_t at = r * own->modes + own->owner[p];
            const struct number w = tribo_harmonic_at_start(x, r);
            for (int conjugate = 0; h->resonant[at] && conjugate < 2; conjugate++, more++) {
                const double complex half = 0.5 * h->g[at] * (w.re + w.im * I), a = conjugate ? conj(half) : half;
                const double complex part = -I / h->li[p] * c * a / (to->lr[more] + to->li[more] * I - (h->lr[p] + h->li[p] * I));
                to->cr[more] += creal(part);
                to->ci[more] += cimag(part);
                to->cr[p] -= creal(part);
                to->ci[p] -= cimag(part);
            }
        }
    }
    for (size_t k = 0; k < h->shapes; k++) {
        const double rate = x->vel[k] + (k < own->modes && own->drifts[k] ? x->drift_rate[k] : 0.0);
        to->a[0] += speed[k] * rate;
        to->a[1] += place[k] * rate + speed[k] * x->acc[k];
        to->a[2] += 0.5 * place[k] * x->acc[k];
    }
}

/* Adds all terms of add_weights with c = 0. Returns 0 if a resonance is closer than TOO_CLOSE. */
static int list_terms(const struct modal_motion *x, struct signal *to)
{
    const struct forced *h = x->h;
    for (size_t p = 0; p < h->exponents + h->harmonics; p++) {
        tribo_signal_add(to, 0.0, 0.0, h->lr[p], h->li[p]);
    }
    for (size_t p = 0; h->any_resonant && p < h->exponents; p++) {
        for (size_t s = 0; s < h->harmonics; s++) {
            const double omega = h->forcing[s].omega;
            if (!h->resonant[s * h->modal->modes + h->modal->owner[p]]) {
                continue;
            }
            if (hypot(h->lr[p], fabs(h->li[p]) - fabs(omega)) < TOO_CLOSE * h->size[p]) {
                return 0;
            }
            tribo_signal_add(to, 0.0, 0.0, 0.0, omega);
            tribo_signal_add(to, 0.0, 0.0, 0.0, -omega);
        }
    }
    return 1;
}

int tribo_modal_motion_signal(const struct modal_motion *x, const double *c, double tau, const double *end, struct signal *to)
{
    const struct forced *h = x->h;
    const struct compliance *g = &x->sys->compliance;
    const size_t n = x->sys->ndof, m = h->shapes, f = tribo_system_energy(x->sys);
    const size_t resonances = h->any_resonant ? 2 * h->exponents * h->harmonics : 0;
    double *place = calloc(3 * m + 1, sizeof *place), *speed = place + m, *rate = speed + m, v[4];
    if (!place || !tribo_signal_reserve(to, h->exponents + h->harmonics + resonances, 2)) {
        free(place);
        return tribo_system_fail(x->sys, TRIBO_ERR_MEMORY, "out of memory for %zu exponent%s", h->exponents,
                                 plural(h->exponents));
    }
    if (!list_terms(x, to)) {
        free(place);
        return tribo_system_fail(x->sys, TRIBO_ERR_UNSUPPORTED,
                                 "method exact: a load is in resonance with an undamped mode; method event can do it");
    }
    /* place, speed: derivatives of c'[q, q', f] by eta and eta'; rate: of the part by f', by eta' */
    tribo_multiply_add(m, n, 1, 1.0, h->phi, c, place);
    tribo_multiply_add(m, n, 1, 1.0, h->phi, c + n, speed);
    for (size_t k = 0; k < g->count; k++) {
        const double *on = h->on + g->contact[k] * m;
        const int holds = h->modal->key[g->contact[k]] == 2;
        tribo_add(place, holds ? c[2 * n + k] : 0.0, on, m);
        tribo_add(rate, holds ? c[f + k] : 0.0, on, m);
    }
    to->tau = tau;
    add_weights(x, place, speed, to);
    /* The constant part from the state at the end of the phase; f' has none. */
    tribo_signal_at(to, tau, v);
    to->a[0] += tribo_dot(c, end, f) - v[0];
    memset(place, 0, m * sizeof *place);
    add_weights(x, place, rate, to);
    free(place);
    return TRIBO_OK;
}
