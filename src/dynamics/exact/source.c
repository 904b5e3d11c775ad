/* SPDX-License-Identifier: BSD-3-Clause */
/* The response of a phase of method "exact" to a source that is linear in its motion, in closed form: derivatives of the motion
 * by damping and by frequency. With modes the source of mode k is
 *     Re(sum over exponents and harmonics of c e^{mu s}) + c_0 + c_1 s,
 * for the source eta'' with c = lambda^2 r z of an exponent, for the source C~ eta' with c = -(lambda^2 + omega_k^2) r z; and an
 * exponent takes from it z' = lambda z + b c e^{mu s}. */
#include "motion.h"
#include "common/layout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The sources eta'' and C~ eta', and responses to both. */
enum { INERTIA, DAMPING, SOURCES };

/* |mu - lambda| tau from which e^{mu tau} - e^{lambda tau} has nearly all digits. */
#define APART 0.1

/* |z| below which (e^z - 1 - z)/z^2 is a sum of TERMS terms. */
#define NEAR_ZERO 1.0
enum { TERMS = 18 };

/* Sources and responses [SOURCES][modes]. */
struct response {
    const struct exact *x;
    double tau;
    double *steady, *ramp;     /* c_0, c_1 */
    double *eta, *rate;        /* responses at tau */
    double *zr, *zi;           /* [SOURCES][exponents] response of exponents */
    double complex *at_tau;    /* [terms] e^{mu tau}; terms: exponents, then harmonics */
    double *cr, *ci;           /* [modes][SOURCES][terms] c */
    double *rr, *ii, *ri, *ir; /* [exponents][SOURCES][terms] products of re and im of b with re and im of c; coupled */
    double *q, *u;             /* [ndof] workspace */
    double *unit, *part;       /* [shapes], [modes] workspace */
    double *power;             /* [TRIBO_POWERS][modes][SOURCES] coefficients of the sources; without modes */
    double *e, *e_rate, *out;  /* [modes][SOURCES], [modes][SOURCES], [4 modes + 1][SOURCES] workspace; without modes */
};

/* Returns (e^z - 1 - z)/z^2, the integral of (1 - s) e^{z s} over s from 0 to 1. */
static double complex exp_2(double complex z)
{
    double complex sum = 0.0;
    if (cabs(z) > NEAR_ZERO) {
        return (tribo_exp_1(z) - 1.0) / z;
    }
    for (int k = TERMS; k > 0; k--) {
        sum = (1.0 + sum * z) / (k + 1);
    }
    return sum;
}

/* Returns the integral of e^{lambda (tau - s)} e^{mu s} over s from 0 to tau; at_lambda, at_mu: e^{lambda tau}, e^{mu tau}. */
static double complex meet(double complex lambda, double complex mu, double tau, double complex at_lambda, double complex at_mu)
{
    const double complex gap = mu - lambda;
    return (fabs(creal(gap)) + fabs(cimag(gap))) * tau > APART ? (at_mu - at_lambda) / gap
                                                               : tau * at_lambda * tribo_exp_1(gap * tau);
}

/* to [modes] += psi AC q' for q' = sum of the shapes times rate [shapes]. */
static void add_damping(struct response *r, const double *rate, double *to)
{
    const struct forced *h = r->x->h;
    const size_t *to_q = h->within, *of_u = h->modal->within;
    if (r->x->sys->damping.rows) {
        memset(r->q, 0, r->x->sys->ndof * sizeof *r->q);
        tribo_multiply_transposed_add(h->shapes, tribo_modal_wide(to_q), 1, h->phi, rate, r->q + to_q[0]);
        tribo_matrix_multiply(&r->x->sys->damping, r->q, r->u);
        tribo_multiply_add(h->modal->modes, tribo_modal_wide(of_u), 1, 1.0, h->modal->psi, r->u + of_u[0], to);
    }
}

/* Sets c_0, c_1, and c of all terms; of coupled modes, products of c with b. */
static void find_sources(struct response *r)
{
    const struct exact *x = r->x;
    const struct forced *f = x->h;
    const struct modal *h = f->modal;
    const size_t m = h->modes, e = h->exponents, terms = e + f->harmonics, wide = SOURCES * terms;
    memcpy(r->steady, x->acc, m * sizeof *x->acc);
    add_damping(r, x->drift, r->steady + m);
    add_damping(r, x->acc, r->ramp + m);
    for (size_t q = 0; q < terms; q++) {
        const double complex mu = f->lr[q] + f->li[q] * I, z = tribo_part(&x->z, q), square = mu * mu;
        const double complex *response = f->x + (q - (q < e ? q : e)) * f->shapes;
        const size_t first = q < e && h->owner ? h->owner[q] : 0, end = q < e && h->owner ? first + 1 : m;
        r->at_tau[q] = cexp(mu * r->tau);
        for (size_t k = first; k < end; k++) {
            const double complex unit = q >= e ? response[k] : h->owner ? 1.0 : h->rr[q * m + k] - h->ri[q * m + k] * I;
            const double complex motion = unit * z, inertia = square * motion, damping = -(square + h->omega2[k]) * motion;
            const size_t to = k * wide + q;
            r->cr[to + INERTIA * terms] = creal(inertia);
            r->ci[to + INERTIA * terms] = cimag(inertia);
            if (q < e) { /* C~ eta' = -eta'' - omega^2 eta in a free motion */
                r->cr[to + DAMPING * terms] = creal(damping);
                r->ci[to + DAMPING * terms] = cimag(damping);
            }
        }
        for (int part = 0; q >= e && part < 2; part++) {
            for (size_t k = 0; k < f->shapes; k++) {
                const double complex rate = mu * response[k] * z;
                r->unit[k] = part ? cimag(rate) : creal(rate);
            }
            memset(r->part, 0, m * sizeof *r->part);
            add_damping(r, r->unit, r->part);
            for (size_t k = 0; k < m; k++) {
                (part ? r->ci : r->cr)[k * wide + DAMPING * terms + q] = r->part[k];
            }
        }
    }
    if (!h->owner) {
        tribo_multiply_transposed_add(m, e, wide, h->left.br, r->cr, r->rr);
        tribo_multiply_transposed_add(m, e, wide, h->left.bi, r->ci, r->ii);
        tribo_multiply_transposed_add(m, e, wide, h->left.br, r->ci, r->ri);
        tribo_multiply_transposed_add(m, e, wide, h->left.bi, r->cr, r->ir);
    }
}

/* Sets the responses of exponent p at tau to both sources. */
static void respond_exponent(struct response *r, size_t p)
{
    const struct forced *f = r->x->h;
    const struct modal *h = f->modal;
    const double complex own = h->lr[p] + h->li[p] * I;
    const size_t m = h->modes, e = h->exponents, terms = e + f->harmonics;
    const size_t first = h->owner ? h->owner[p] : 0, end = h->owner ? first + 1 : m;
    const double complex steady = r->tau * tribo_exp_1(own * r->tau), ramp = r->tau * r->tau * exp_2(own * r->tau);
    double complex sum[SOURCES] = {0.0}, b = 0.0;
    for (size_t k = first; k < end; k++) {
        const size_t of = h->owner ? p : k * e + p;
        b = h->left.br[of] + h->left.bi[of] * I;
        for (size_t source = 0; source < SOURCES; source++) {
            sum[source] += b * (r->steady[source * m + k] * steady + r->ramp[source * m + k] * ramp);
        }
    }
    for (size_t q = 0; q < terms; q++) {
        if (q < e && h->owner && h->owner[q] != first) {
            continue;
        }
        /* half of c e^{mu s}, and half of its conjugate */
        const double complex mu = f->lr[q] + f->li[q] * I;
        const double complex along = 0.5 * meet(own, mu, r->tau, r->at_tau[p], r->at_tau[q]);
        const double complex against = 0.5 * meet(own, conj(mu), r->tau, r->at_tau[p], conj(r->at_tau[q]));
        for (size_t source = 0; source < SOURCES; source++) {
            const size_t at = ((h->owner ? first : p) * SOURCES + source) * terms + q;
            if (h->owner) {
                const double complex c = r->cr[at] + r->ci[at] * I;
                sum[source] += b * (c * along + conj(c) * against);
            } else {
                sum[source] += (r->rr[at] - r->ii[at] + (r->ri[at] + r->ir[at]) * I) * along;
                sum[source] += (r->rr[at] + r->ii[at] + (r->ir[at] - r->ri[at]) * I) * against;
            }
        }
    }
    for (size_t source = 0; source < SOURCES; source++) {
        r->zr[source * e + p] = creal(sum[source]);
        r->zi[source * e + p] = cimag(sum[source]);
    }
}

/* Sets the responses of modes to a source by those of exponents. */
static void respond_modes(struct response *r, size_t source)
{
    const struct forced *f = r->x->h;
    const struct modal *h = f->modal;
    const size_t m = h->modes, e = h->exponents;
    const double t = r->tau;
    double *eta = r->eta + source * m, *rate = r->rate + source * m, *zr = r->zr + source * e, *zi = r->zi + source * e;
    const double *steady = r->steady + source * m, *ramp = r->ramp + source * m;
    tribo_modal_join(h, 1, zr, zi, eta);
    for (size_t p = 0; p < e; p++) {
        const double re = zr[p];
        zr[p] = h->lr[p] * re - h->li[p] * zi[p];
        zi[p] = h->lr[p] * zi[p] + h->li[p] * re;
    }
    tribo_modal_join(h, 1, zr, zi, rate);
    for (size_t k = 0; k < m; k++) {
        if (!tribo_modal_drifts(h, k)) {
            continue;
        }
        eta[k] += t * t * (0.5 * steady[k] + t / 6.0 * ramp[k]);
        rate[k] += t * (steady[k] + 0.5 * t * ramp[k]);
        for (size_t s = 0; s < f->harmonics; s++) {
            const size_t at = (k * SOURCES + source) * (e + f->harmonics) + e + s;
            const double complex c = r->cr[at] + r->ci[at] * I, turn = f->forcing[s].omega * t * I;
            eta[k] += t * t * creal(c * exp_2(turn));
            rate[k] += t * creal(c * tribo_exp_1(turn));
        }
    }
}

/* Sets the responses of a structure without modes: sources and responses are powers of time. */
static void respond_powers(struct response *r)
{
    const struct exact *x = r->x;
    const struct forced *f = x->h;
    const size_t m = f->modal->modes;
    double part = 1.0; /* 1/k! */
    for (size_t k = 0; k < TRIBO_POWERS; k++) {
        const double *rate = x->power + (TRIBO_POWERS + k) * m;
        memset(r->unit, 0, f->shapes * sizeof *r->unit);
        memcpy(r->unit, rate, m * sizeof *rate);
        for (size_t s = 0; s < f->harmonics; s++) {
            const double complex turn = f->forcing[s].omega * I;
            double complex z = part * turn * tribo_part(&x->z, s);
            for (size_t j = 0; j < k; j++) {
                z *= turn;
            }
            for (size_t l = m; l < f->shapes; l++) {
                r->unit[l] += creal(f->x[s * f->shapes + l] * z);
            }
        }
        memset(r->steady, 0, m * sizeof *r->steady);
        add_damping(r, r->unit, r->steady);
        for (size_t l = 0; l < m; l++) {
            r->power[(k * m + l) * SOURCES + INERTIA] = k + 1 < TRIBO_POWERS ? (double)(k + 1) * rate[m + l] : 0.0;
            r->power[(k * m + l) * SOURCES + DAMPING] = r->steady[l];
        }
        part /= (double)(k + 1);
    }
    tribo_powers_carry(f->modal, r->tau, SOURCES, r->out, r->e, r->e_rate, r->out + m * SOURCES, r->power);
    tribo_transpose(m, SOURCES, r->e, r->eta);
    tribo_transpose(m, SOURCES, r->e_rate, r->rate);
}

int tribo_modal_source(const struct exact *x, double tau, size_t columns, const struct source *source, double *eta, double *rate)
{
    const struct forced *f = x->h;
    const struct modal *h = f->modal;
    const size_t m = h->modes, e = h->exponents, powers = h->powers ? SOURCES * m : 0, terms = h->powers ? 0 : e + f->harmonics;
    const size_t products = h->owner ? 0 : SOURCES * e * terms;
    if (f->resonant) {
        return tribo_error(x->sys->message, TRIBO_ERR_UNSUPPORTED,
                           "method exact: a load is in resonance with an undamped mode; method event can do it");
    }
    struct response r = {.x = x, .tau = tau};
    if (!ALLOCATE(ARRAY(r.steady, SOURCES * m), ARRAY(r.ramp, SOURCES * m), ARRAY(r.eta, SOURCES * m), ARRAY(r.rate, SOURCES * m),
                  ARRAY(r.zr, SOURCES * e), ARRAY(r.zi, SOURCES * e), ARRAY(r.at_tau, terms), ARRAY(r.cr, SOURCES * m * terms),
                  ARRAY(r.ci, SOURCES * m * terms), ARRAY(r.rr, products), ARRAY(r.ii, products), ARRAY(r.ri, products),
                  ARRAY(r.ir, products), ARRAY(r.q, x->sys->ndof), ARRAY(r.u, x->sys->ndof), ARRAY(r.part, m),
                  ARRAY(r.unit, f->shapes), ARRAY(r.power, TRIBO_POWERS * powers), ARRAY(r.e, powers), ARRAY(r.e_rate, powers),
                  ARRAY(r.out, 4 * powers + SOURCES))) {
        return tribo_error(x->sys->message, TRIBO_ERR_MEMORY, "out of memory for derivatives of %zu mode%s", m, plural(m));
    }
    if (h->powers) {
        respond_powers(&r);
    } else {
        find_sources(&r);
        for (size_t p = 0; p < e; p++) {
            respond_exponent(&r, p);
        }
        respond_modes(&r, INERTIA);
        respond_modes(&r, DAMPING);
    }
    for (size_t at = 0; at < m * columns; at++) {
        const size_t k = at / columns, j = at % columns;
        eta[at] += source->inertia[j] * r.eta[k] + source->damping[j] * r.eta[m + k];
        rate[at] += source->inertia[j] * r.rate[k] + source->damping[j] * r.rate[m + k];
    }
    free(r.steady);
    return TRIBO_OK;
}
