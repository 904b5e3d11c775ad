/* SPDX-License-Identifier: BSD-3-Clause */
/* A phase of a structure without modes, in powers of time: eta'' = -K eta - C~ eta' + constant + Re(g e^{i Omega t}). A phase of
 * less than TRIBO_POWERS_REACH/|lambda| needs few powers, and a decomposition into modes takes much longer; where many contacts
 * slide and stick, most sets of contacts that hold last no longer. */
#include "motion.h"
#include "parts.h"
#include "common/real.h"

#include <math.h>
#include <string.h>

enum { P = TRIBO_POWERS };

/* A term that changes nothing, relative to the sum. */
#define NOTHING 1e-18

double tribo_powers_fastest(const struct modal *h)
{
    double most = tribo_matrix_row_sum(&h->powers->stiffness);
    for (size_t s = h->rests; s < h->rests + h->springs; s++) { /* the trace of the springs */
        most -= tribo_dot(h->on + h->rest[s] * h->modes, h->powers->reach + h->rest[s] * h->modes, h->modes);
    }
    return sqrt(greater(most, 0.0)) + tribo_matrix_row_sum(&h->powers->damping);
}

/* to [modes][columns] -= K eta + C~ rate, K with springs. work [columns]. */
static void pull_back(const struct modal *h, size_t columns, const double *eta, const double *rate, double *to, double *work)
{
    tribo_matrix_add_columns(&h->powers->stiffness, -1.0, columns, eta, to);
    tribo_matrix_add_columns(&h->powers->damping, -1.0, columns, rate, to);
    for (size_t s = h->rests; s < h->rests + h->springs; s++) {
        memset(work, 0, columns * sizeof *work);
        tribo_multiply_add(1, h->modes, columns, 1.0, h->on + h->rest[s] * h->modes, eta, work);
        tribo_multiply_transposed_add(1, h->modes, columns, h->powers->reach + h->rest[s] * h->modes, work, to);
    }
}

void tribo_powers_start(struct exact *x, const double *force)
{
    const struct forced *f = x->h;
    const struct modal *h = f->modal;
    const size_t m = h->modes;
    double *eta = x->power, *rate = eta + m * P, *out = rate + m * P, work;
    memset(rate + m, 0, (P - 1) * m * sizeof *rate);
    memcpy(eta, x->place, m * sizeof *eta);
    memcpy(rate, x->rate, m * sizeof *rate);
    memcpy(rate + m, force, m * sizeof *rate);
    for (size_t at = 0; at < f->harmonics * m; at++) { /* the part of a constant load is in force */
        const double omega = f->forcing[at / m].omega;
        const double complex z = f->g[at] * tribo_part(&x->z, at / m);
        double re = creal(z), im = cimag(z);
        for (size_t k = 1; k < P && omega != 0.0 && f->g[at] != 0.0; k++) {
            const double turn = omega / (double)k, old = re;
            rate[k * m + at % m] += re;
            re = -im * turn;
            im = old * turn;
        }
    }
    for (size_t k = 0; k + 1 < P; k++, eta += m, rate += m) {
        const double part = 1.0 / (double)(k + 1);
        double *next = rate + m;
        pull_back(h, 1, eta, rate, next, &work);
        for (size_t j = 0; j < m; j++) {
            eta[m + j] = part * rate[j];
            next[j] *= part;
        }
    }
    double *turned = out + f->outputs * P;
    memset(out, 0, f->outputs * P * sizeof *out);
    tribo_transpose(P, m, x->power, turned);
    tribo_transpose(P, m, x->power + m * P, turned + m * P);
    for (size_t o = 0; o < f->outputs; o++, out += P) {
        const struct output *w = &f->output[o];
        const double *by_u = o >= f->sliding && f->by_u ? f->by_u + w->contact * f->shapes : NULL;
        tribo_multiply_add(1, m, P, 1.0, w->on_rate, o < f->sliding ? turned + m * P : turned, out);
        tribo_multiply_add(by_u != NULL, m, P, 1.0, by_u, turned + m * P, out);
        for (size_t s = 0; s < f->harmonics; s++) {
            double complex z = (w->cr[s] + w->ci[s] * I) * tribo_part(&x->z, s);
            for (size_t k = 0; k < P && w->size[s] > 0.0; k++) {
                out[k] += creal(z);
                z *= f->forcing[s].omega / (double)(k + 1) * I;
            }
        }
        x->course[o].power = out;
    }
}

void tribo_powers_move(struct exact *x, double tau, int changes)
{
    const struct forced *f = x->h;
    const size_t m = f->modal->modes;
    memset(x->place, 0, f->shapes * sizeof *x->place);
    memset(x->rate, 0, f->shapes * sizeof *x->rate);
    for (size_t k = P; k-- > 1;) {
        for (size_t j = 0; j < m; j++) {
            x->place[j] = (x->place[j] + x->power[k * m + j]) * tau;
            x->rate[j] = (x->rate[j] + x->power[(P + k) * m + j]) * tau;
        }
    }
    if (!changes) {
        tribo_add(x->rate, 1.0, x->power + P * m, m);
    }
    for (size_t s = 0; s < f->harmonics; s++) {
        const double complex turn = f->forcing[s].omega * tau * I, z = tribo_part(&x->z, s);
        const double complex move = turn * tribo_exp_1(turn) * z, rate = f->forcing[s].omega * (z + move) * I;
        for (size_t k = m; k < f->shapes; k++) {
            x->place[k] += creal(f->x[s * f->shapes + k] * move);
            x->rate[k] += creal(f->x[s * f->shapes + k] * rate);
        }
    }
}

void tribo_powers_carry(const struct modal *h, double tau, size_t columns, const double *pull, double *eta, double *rate,
                        double *work, const double *source)
{
    const size_t all = h->modes * columns;
    double *e = work, *u = e + all, *next = u + all, power = 1.0; /* power: tau^(k - 1) */
    memcpy(e, eta, all * sizeof *e);
    memcpy(u, rate, all * sizeof *u);
    memcpy(next, pull, all * sizeof *next);
    memset(eta, 0, all * sizeof *eta);
    for (size_t k = 1; k < P; k++) {
        pull_back(h, columns, e, u, next, next + all);
        if (source) {
            tribo_add(next, power, source + (k - 1) * all, all);
        }
        power *= tau;
        for (size_t j = 0; j < all; j++) {
            e[j] = u[j] * (tau / (double)k);
            u[j] = next[j] * (tau / (double)k);
            eta[j] += e[j];
            rate[j] += u[j];
        }
        memset(next, 0, all * sizeof *next);
        if (!source && tribo_largest(e, all) <= NOTHING * tribo_largest(eta, all) &&
            tribo_largest(u, all) <= NOTHING * tribo_largest(rate, all)) {
            return;
        }
    }
}
