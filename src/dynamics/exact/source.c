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
    double *steady, *ramp;           /* c_0, c_1 */
    double *re, *im;                 /* [SOURCES][harmonics][modes] c of harmonics */
    double *eta, *rate;              /* responses at tau */
    double *zr, *zi;                 /* [SOURCES][exponents] response of exponents */
    double complex *along, *against; /* [exponents + harmonics] responses of an exponent at tau to e^{mu s}/2, its conjugate */
    double complex *at_tau;          /* [exponents + harmonics] e^{mu tau} */
    double *cr, *ci;                 /* [modes][SOURCES][exponents] c of exponents; coupled */
    double *rr, *ii, *ri, *ir;       /* [exponents][SOURCES][exponents] products of re and im of b with re and im of c; coupled */
    double *q, *u;                   /* [ndof] workspace */
    double *unit;                    /* [shapes] workspace */
    double *power;                   /* [TRIBO_POWERS][modes][SOURCES] coefficients of the sources; without modes */
    double *e, *e_rate, *out;        /* [modes][SOURCES], [modes][SOURCES], [4 modes + 1][SOURCES] workspace; without modes */
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

/* Sets c of harmonics, c_0 and c_1 of a source. */
static void find_source(struct response *r, int source)
{
    const struct exact *x = r->x;
    const struct forced *h = x->h;
    const size_t m = h->modal->modes, at = (size_t)source * m;
    if (source == INERTIA) {
        memcpy(r->steady, x->acc, m * sizeof *x->acc);
    } else {
        add_damping(r, x->drift, r->steady + at);
        add_damping(r, x->acc, r->ramp + at);
    }
    for (size_t s = 0; s < h->harmonics; s++) {
        const double omega = h->forcing[s].omega;
        const double complex z = tribo_part(&x->z, h->modal->exponents + s), *response = h->x + s * h->shapes;
        for (int part = 0; part < 2; part++) {
            double *to = (part ? r->im : r->re) + at * h->harmonics + s * m;
            for (size_t k = 0; k < h->shapes; k++) {
                const double complex motion = response[k] * z;
                r->unit[k] = omega * (part ? creal(motion) : -cimag(motion));
                if (source == INERTIA && k < m) {
                    to[k] = -omega * omega * (part ? cimag(motion) : creal(motion));
                }
            }
            if (source == DAMPING) {
                add_damping(r, r->unit, to);
            }
        }
    }
}

/* Sets at_tau; of coupled modes c of exponents, and products of c with b. */
static void find_exponents(struct response *r)
{
    const struct forced *f = r->x->h;
    const struct modal *h = f->modal;
    const size_t m = h->modes, e = h->exponents, wide = SOURCES * e;
    for (size_t q = 0; !h->owner && q < e; q++) {
        const double complex mu = h->lr[q] + h->li[q] * I, z = tribo_part(&r->x->z, q), square = mu * mu;
        for (size_t k = 0; k < m; k++) {
            const double complex motion = (h->rr[q * m + k] - h->ri[q * m + k] * I) * z;
            const double complex c[] = {[INERTIA] = square * motion, [DAMPING] = -(square + h->omega2[k]) * motion};
            for (size_t source = 0; source < SOURCES; source++) {
                r->cr[k * wide + source * e + q] = creal(c[source]);
                r->ci[k * wide + source * e + q] = cimag(c[source]);
            }
        }
    }
    for (size_t q = 0; q < e + f->harmonics; q++) {
        r->at_tau[q] = cexp((f->lr[q] + f->li[q] * I) * r->tau);
    }
    if (!h->owner) {
        tribo_multiply_transposed_add(m, e, wide, h->left.br, r->cr, r->rr);
        tribo_multiply_transposed_add(m, e, wide, h->left.bi, r->ci, r->ii);
        tribo_multiply_transposed_add(m, e, wide, h->left.br, r->ci, r->ri);
        tribo_multiply_transposed_add(m, e, wide, h->left.bi, r->cr, r->ir);
    }
}

/* Sets the responses of exponent p at tau to both sources: to c_0, c_1, harmonics, and exponents. */
static void respond_exponent(struct response *r, size_t p)
{
    const struct forced *f = r->x->h;
    const struct modal *h = f->modal;
    const double complex own = h->lr[p] + h->li[p] * I;
    const size_t m = h->modes, e = h->exponents, first = h->owner ? h->owner[p] : 0, end = h->owner ? first + 1 : m;
    const double complex steady = r->tau * tribo_exp_1(own * r->tau), ramp = r->tau * r->tau * exp_2(own * r->tau);
    for (size_t q = 0; q < e + f->harmonics; q++) {
        const double complex mu = f->lr[q] + f->li[q] * I;
        if (q >= e || !h->owner || h->owner[q] == first) {
            r->along[q] = 0.5 * meet(own, mu, r->tau, r->at_tau[p], r->at_tau[q]);
            r->against[q] = 0.5 * meet(own, conj(mu), r->tau, r->at_tau[p], conj(r->at_tau[q]));
        }
    }
    for (size_t source = 0; source < SOURCES; source++) {
        double complex sum = 0.0, b = 0.0;
        for (size_t k = first; k < end; k++) {
            const size_t of = h->owner ? p : k * e + p;
            double complex part = r->steady[source * m + k] * steady + r->ramp[source * m + k] * ramp;
            for (size_t s = 0; s < f->harmonics; s++) {
                const size_t to = (source * f->harmonics + s) * m + k;
                const double complex c = r->re[to] + r->im[to] * I;
                part += c * r->along[e + s] + conj(c) * r->against[e + s];
            }
            b = h->left.br[of] + h->left.bi[of] * I;
            sum += b * part;
        }
        for (size_t q = 0; q < e; q++) {
            const double complex mu = h->lr[q] + h->li[q] * I, square = mu * mu;
            const size_t to = (p * SOURCES + source) * e + q;
            if (!h->owner) {
                sum += (r->rr[to] - r->ii[to] + (r->ri[to] + r->ir[to]) * I) * r->along[q];
                sum += (r->rr[to] + r->ii[to] + (r->ir[to] - r->ri[to]) * I) * r->against[q];
            } else if (h->owner[q] == first) {
                const double complex c = (source == INERTIA ? square : -(square + h->omega2[first])) * tribo_part(&r->x->z, q);
                sum += b * c * r->along[q];
                sum += b * conj(c) * r->against[q];
            }
        }
        r->zr[source * e + p] = creal(sum);
        r->zi[source * e + p] = cimag(sum);
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
            const size_t at = (source * f->harmonics + s) * m + k;
            const double complex c = r->re[at] + r->im[at] * I, turn = f->forcing[s].omega * t * I;
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
    const size_t m = h->modes, loads = SOURCES * f->harmonics * m, powers = h->powers ? SOURCES * m : 0;
    const size_t e = h->exponents, each = h->owner ? 0 : SOURCES * e;
    if (f->resonant) {
        return tribo_error(x->sys->message, TRIBO_ERR_UNSUPPORTED,
                           "method exact: a load is in resonance with an undamped mode; method event can do it");
    }
    struct response r = {.x = x, .tau = tau};
    if (!ALLOCATE(ARRAY(r.steady, SOURCES * m), ARRAY(r.ramp, SOURCES * m), ARRAY(r.eta, SOURCES * m), ARRAY(r.rate, SOURCES * m),
                  ARRAY(r.re, loads), ARRAY(r.im, loads), ARRAY(r.zr, SOURCES * e), ARRAY(r.zi, SOURCES * e),
                  ARRAY(r.at_tau, e + f->harmonics), ARRAY(r.along, e + f->harmonics), ARRAY(r.against, e + f->harmonics),
                  ARRAY(r.cr, m * each), ARRAY(r.ci, m * each), ARRAY(r.rr, e * each), ARRAY(r.ii, e * each),
                  ARRAY(r.ri, e * each), ARRAY(r.ir, e * each), ARRAY(r.q, x->sys->ndof), ARRAY(r.u, x->sys->ndof),
                  ARRAY(r.unit, f->shapes), ARRAY(r.power, TRIBO_POWERS * powers), ARRAY(r.e, powers), ARRAY(r.e_rate, powers),
                  ARRAY(r.out, 4 * powers + SOURCES))) {
        return tribo_error(x->sys->message, TRIBO_ERR_MEMORY, "out of memory for derivatives of %zu mode%s", m, plural(m));
    }
    if (h->powers) {
        respond_powers(&r);
    } else {
        find_exponents(&r);
        find_source(&r, INERTIA);
        find_source(&r, DAMPING);
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
