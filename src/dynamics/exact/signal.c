/* SPDX-License-Identifier: BSD-3-Clause */
/* A linear combination of the state in a phase of method "exact". */
#include "motion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* |i Omega - lambda|/|lambda| below which more than half of the digits are lost. */
#define TOO_CLOSE 5e-8

/* Returns the response of mode k to harmonic s, if it is not in h->x; 0 otherwise. */
static double complex resonance(const struct forced *h, size_t s, size_t k)
{
    const size_t at = s * h->modal->modes + k;
    const double omega = h->forcing[s].omega;
    return h->resonant && h->resonant[at] ? h->g[at] / (h->modal->omega2[k] - omega * omega + omega * h->modal->damping[k] * I)
                                          : 0.0;
}

/* Adds place'eta + speed'eta' without the constant part, place, speed [shapes], to a signal with all terms. In the motion the
 * response to a resonant harmonic begins with 0: from the exponents its value at t0 is subtracted. */
static void add_weights(const struct exact *x, const double *place, const double *speed, struct signal *to)
{
    const struct forced *h = x->h;
    const struct modal *own = h->modal;
    const size_t e = own->exponents;
    for (size_t k = 0; own->powers && k <= to->degree; k++) {
        const double *power = x->power + k * own->modes;
        to->a[k] += tribo_dot(place, power, own->modes) + tribo_dot(speed, power + TRIBO_POWERS * own->modes, own->modes);
    }
    for (size_t p = 0; p < e + h->harmonics; p++) {
        double complex z = tribo_part(&x->z, p);
        double complex c = tribo_forced_weight(h, p, place, speed);
        for (size_t s = 0; h->resonant && p < e && s < h->harmonics; s++) {
            const double complex w = resonance(h, s, own->owner[p]) * tribo_part(&x->z, e + s);
            z -= (own->left.ar[p] + own->left.ai[p] * I) * creal(w) -
                 (own->left.br[p] + own->left.bi[p] * I) * h->forcing[s].omega * cimag(w);
        }
        for (size_t k = 0; h->resonant && p >= e && k < own->modes; k++) {
            c += (place[k] + h->li[p] * speed[k] * I) * resonance(h, p - e, k);
        }
        to->c[p] += c * z;
    }
    for (size_t k = 0; !own->powers && k < h->shapes; k++) {
        to->a[0] += speed[k] * x->drift[k];
        to->a[1] += place[k] * x->drift[k] + speed[k] * x->acc[k];
        to->a[2] += 0.5 * place[k] * x->acc[k];
    }
}

/* Adds all terms of add_weights with c = 0. Returns 0 if a resonance is closer than TOO_CLOSE. */
static int list_terms(const struct exact *x, struct signal *to)
{
    const struct forced *h = x->h;
    const size_t e = h->modal->exponents;
    for (size_t p = 0; p < e + h->harmonics; p++) {
        tribo_signal_add(to, 0.0, h->lr[p] + h->li[p] * I);
        for (size_t s = 0; h->resonant && p < e && s < h->harmonics; s++) {
            if (h->resonant[s * h->modal->modes + h->modal->owner[p]] &&
                hypot(h->lr[p], fabs(h->li[p]) - fabs(h->forcing[s].omega)) < TOO_CLOSE * h->size[p]) {
                return 0;
            }
        }
    }
    return 1;
}

int tribo_modal_motion_signal(void *own, const double *c, double tau, const double *end, struct signal *to)
{
    const struct exact *x = own;
    const struct forced *h = x->h;
    const struct compliance *g = &x->sys->compliance;
    const size_t n = x->sys->ndof, m = h->shapes, f = tribo_system_energy(x->sys);
    const size_t terms = h->modal->exponents + h->harmonics;
    double *place = calloc(3 * m + 1, sizeof *place), *speed = place + m, *rate = speed + m, v[4];
    if (!place || !tribo_signal_reserve(to, terms, h->modal->powers ? TRIBO_POWERS - 1 : 2)) {
        free(place);
        return tribo_error(x->sys->message, TRIBO_ERR_MEMORY, "out of memory for %zu term%s", terms, plural(terms));
    }
    if (!list_terms(x, to)) {
        free(place);
        return tribo_error(x->sys->message, TRIBO_ERR_UNSUPPORTED,
                           "method exact: a load is in resonance with an undamped mode; method event can do it");
    }
    /* place, speed: derivatives of c'[q, q', f] by eta and eta'; rate: of the part by f', by eta' */
    tribo_multiply_add(m, tribo_modal_wide(h->within), 1, 1.0, h->phi, c + h->within[0], place);
    tribo_multiply_add(m, tribo_modal_wide(h->within), 1, 1.0, h->phi, c + n + h->within[0], speed);
    for (size_t k = 0; k < g->count; k++) {
        size_t row;
        const double by = tribo_follow_spring(x->sys, h->modal, g->contact[k], &row);
        tribo_add(place, by * c[2 * n + k], h->on + row * m, m);
        tribo_add(rate, by * c[f + k], h->on + row * m, m);
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
