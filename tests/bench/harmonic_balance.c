/* SPDX-License-Identifier: BSD-3-Clause */
#include "harmonic_balance.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_fft_halfcomplex.h>
#include <gsl/gsl_fft_real.h>
#include <gsl/gsl_linalg.h>

#include "../../src/damper/output.h"

typedef double complex z;

/* Residuals, in terms of the largest velocity without friction: of a solution, and of one that leads to a steeper law. */
#define EXACT 1e-9
#define NEAR 1e-3

/* Steps of Newton's method at most, how short they may get; how much steeper the law, to begin with and at least. */
#define MOST 12
#define LEAST 1e-2
#define STEEPER 0.3
#define SLOWEST 0.97

/* Of a motion x(t) = Re(sum over h of X_h e^{i h omega t}), h = 1, 3, 5 ... 2 H - 1, contact by contact: X[c*H + k], h = 2 k + 1.
 * Friction is odd in the velocity, and so is the load half a period later: even harmonics are zero. */
struct harmonic_balance {
    const struct model *m;
    size_t harmonics, samples; /* H */
    double omega, limit, epsilon, fastest;
    z *v, *trial, *good; /* [CONTACTS*H] velocities; those tried, those to go back to, */
    z *f, *free;         /* forces, and velocities without friction */
    z *response;         /* [H][CONTACTS][CONTACTS] velocities by forces */
    z *slope;            /* [CONTACTS][2 H] Fourier coefficients of df/dv, of e^{2 i k omega t} */
    double *time, *bend; /* [samples] */
    size_t steps;        /* of Newton's method, in all */
    gsl_matrix *jacobian;
    gsl_vector *residual, *step;
    gsl_permutation *order;
};

struct harmonic_balance *balance_create(const struct model *m, size_t highest)
{
    struct harmonic_balance *b = need_memory(1, sizeof *b);
    const size_t harmonics = (highest + 1) / 2, n = CONTACTS * harmonics;
    *b = (struct harmonic_balance){.m = m, .harmonics = harmonics, .samples = 256};
    while (b->samples < 16 * highest) {
        b->samples *= 2;
    }
    b->v = need_memory(5 * n + CONTACTS * n + CONTACTS * 2 * harmonics, sizeof *b->v);
    b->trial = b->v + n;
    b->good = b->trial + n;
    b->f = b->good + n;
    b->free = b->f + n;
    b->response = b->free + n;
    b->slope = b->response + CONTACTS * n;
    b->time = need_memory(2 * b->samples, sizeof *b->time);
    b->bend = b->time + b->samples;
    b->jacobian = gsl_matrix_alloc(2 * n, 2 * n);
    b->residual = gsl_vector_alloc(2 * n);
    b->step = gsl_vector_alloc(2 * n);
    b->order = gsl_permutation_alloc(2 * n);
    return b;
}

void balance_free(struct harmonic_balance *b)
{
    free(b->v);
    free(b->time);
    gsl_matrix_free(b->jacobian);
    gsl_vector_free(b->residual);
    gsl_vector_free(b->step);
    gsl_permutation_free(b->order);
    free(b);
}

/* ------------------------------------------------------------------------------------------------------- the structure */

static double frequency_of(const struct harmonic_balance *b, size_t k)
{
    return b->omega * (double)(2 * k + 1);
}

/* Displacement of a mode by a force of harmonic k on it. */
static z receptance(const struct harmonic_balance *b, size_t mode, size_t k)
{
    const double w = frequency_of(b, k);
    return 1.0 / (b->m->beam.stiffness[mode] - w * w + I * w * b->m->beam.damping[mode]);
}

static void find_structure(struct harmonic_balance *b)
{
    const struct modal *s = &b->m->beam;
    const size_t nh = b->harmonics;
    memset(b->free, 0, CONTACTS * nh * sizeof *b->free);
    memset(b->response, 0, CONTACTS * CONTACTS * nh * sizeof *b->response);
    for (size_t k = 0; k < nh; k++) {
        for (size_t mode = 0; mode < MODES; mode++) {
            const z velocity = I * frequency_of(b, k) * receptance(b, mode, k);
            for (size_t c = 0; c < CONTACTS; c++) {
                if (k == 0) {
                    b->free[c * nh] += s->j[c][mode] * velocity * -I * s->load[mode]; /* sin = Re(-i e^{i omega t}) */
                }
                for (size_t d = 0; d < CONTACTS; d++) {
                    b->response[(k * CONTACTS + c) * CONTACTS + d] += s->j[c][mode] * velocity * s->j[d][mode];
                }
            }
        }
    }
}

/* -------------------------------------------------------------------------------------------------- friction in time */

/* time = the motion of which x [H] are the harmonics. */
static void to_time(const struct harmonic_balance *b, const z *x)
{
    const size_t n = b->samples;
    memset(b->time, 0, n * sizeof *b->time);
    for (size_t k = 0; k < b->harmonics; k++) {
        const size_t h = 2 * k + 1;
        b->time[h] = 0.5 * (double)n * creal(x[k]);
        b->time[n - h] = 0.5 * (double)n * cimag(x[k]);
    }
    gsl_fft_halfcomplex_radix2_inverse(b->time, 1, n);
}

/* Mean of a signal times e^{-i h omega t}, after its transformation. */
static z coefficient(const struct harmonic_balance *b, const double *signal, size_t h)
{
    const size_t n = b->samples;
    return (signal[h] + (h ? I * signal[n - h] : 0.0)) / (double)n;
}

/* f of the velocities v, and the slopes if they are wanted. */
static void find_friction(struct harmonic_balance *b, const z *v, int slopes)
{
    const size_t nh = b->harmonics, n = b->samples;
    for (size_t c = 0; c < CONTACTS; c++) {
        to_time(b, v + c * nh);
        for (size_t i = 0; i < n; i++) {
            const double s = tanh(b->time[i] / b->epsilon);
            b->time[i] = -b->limit * s;
            b->bend[i] = -b->limit / b->epsilon * (1.0 - s * s);
        }
        gsl_fft_real_radix2_transform(b->time, 1, n);
        for (size_t k = 0; k < nh; k++) {
            b->f[c * nh + k] = 2.0 * coefficient(b, b->time, 2 * k + 1);
        }
        if (slopes) {
            gsl_fft_real_radix2_transform(b->bend, 1, n);
            for (size_t k = 0; k < 2 * nh; k++) {
                b->slope[c * 2 * nh + k] = coefficient(b, b->bend, 2 * k);
            }
        }
    }
}

/* ------------------------------------------------------------------------------------------------------ Newton's method */

/* residual = v - free - response f(v); returns its norm. */
static double find_residual(struct harmonic_balance *b, const z *v, int slopes)
{
    const size_t nh = b->harmonics;
    find_friction(b, v, slopes);
    for (size_t c = 0; c < CONTACTS; c++) {
        for (size_t k = 0; k < nh; k++) {
            z r = v[c * nh + k] - b->free[c * nh + k];
            for (size_t d = 0; d < CONTACTS; d++) {
                r -= b->response[(k * CONTACTS + c) * CONTACTS + d] * b->f[d * nh + k];
            }
            gsl_vector_set(b->residual, 2 * (c * nh + k), creal(r));
            gsl_vector_set(b->residual, 2 * (c * nh + k) + 1, cimag(r));
        }
    }
    return gsl_blas_dnrm2(b->residual);
}

/* A change of V_l makes one of F_k by s_{k-l} dV_l + s_{k+l+1} conj(dV_l), s being the slope's coefficients. */
static void find_jacobian(struct harmonic_balance *b)
{
    const size_t nh = b->harmonics;
    for (size_t c = 0; c < CONTACTS; c++) {
        for (size_t d = 0; d < CONTACTS; d++) {
            const z *s = b->slope + d * 2 * nh;
            for (size_t k = 0; k < nh; k++) {
                const z y = -b->response[(k * CONTACTS + c) * CONTACTS + d];
                double *row = gsl_matrix_ptr(b->jacobian, 2 * (c * nh + k), 2 * d * nh);
                double *next = gsl_matrix_ptr(b->jacobian, 2 * (c * nh + k) + 1, 2 * d * nh);
                for (size_t l = 0; l < nh; l++) {
                    const z p = y * (k >= l ? s[k - l] : conj(s[l - k])), q = y * s[k + l + 1];
                    const double one = c == d && k == l ? 1.0 : 0.0;
                    row[2 * l] = one + creal(p) + creal(q);
                    row[2 * l + 1] = cimag(q) - cimag(p);
                    next[2 * l] = cimag(p) + cimag(q);
                    next[2 * l + 1] = one + creal(p) - creal(q);
                }
            }
        }
    }
}

static double shortened(struct harmonic_balance *b, double part)
{
    for (size_t i = 0; i < CONTACTS * b->harmonics; i++) {
        b->trial[i] = b->v[i] - part * (gsl_vector_get(b->step, 2 * i) + I * gsl_vector_get(b->step, 2 * i + 1));
    }
    return find_residual(b, b->trial, 0);
}

/* From v, at this epsilon; 1 if it converges to the part of the largest velocity that is wanted, in so many steps. */
static int newton(struct harmonic_balance *b, double epsilon, double wanted, size_t most)
{
    int sign;
    b->epsilon = epsilon * b->fastest;
    for (size_t steps = 0; steps < most; steps++, b->steps++) {
        const double norm = find_residual(b, b->v, 1);
        double part = 1.0;
        if (norm < wanted * b->fastest) {
            return 1;
        }
        find_jacobian(b);
        if (gsl_linalg_LU_decomp(b->jacobian, b->order, &sign) ||
            gsl_linalg_LU_solve(b->jacobian, b->order, b->residual, b->step)) {
            return 0;
        }
        while (!(shortened(b, part) < (1.0 - 0.1 * part) * norm) && part > LEAST) {
            part *= 0.5;
        }
        memcpy(b->v, b->trial, CONTACTS * b->harmonics * sizeof *b->v);
    }
    return 0;
}

/* From the motion without friction, by a law that gets ever steeper, more slowly where steps do not converge. */
static int steepen(struct harmonic_balance *b, double epsilon)
{
    const size_t bytes = CONTACTS * b->harmonics * sizeof *b->v;
    double reached = 1.0, ratio = STEEPER;
    memcpy(b->v, b->free, bytes);
    memcpy(b->good, b->free, bytes);
    while (reached > epsilon && ratio < SLOWEST) {
        const double next = fmax(ratio * reached, epsilon);
        if (newton(b, next, next > epsilon ? NEAR : EXACT, MOST)) {
            memcpy(b->good, b->v, bytes);
            reached = next;
        } else {
            memcpy(b->v, b->good, bytes);
            ratio = sqrt(ratio);
        }
    }
    return reached <= epsilon;
}

/* -------------------------------------------------------------------------------------------------------- the answer */

static void find_motion(struct harmonic_balance *b, z *x)
{
    const size_t nh = b->harmonics;
    for (size_t k = 0; k < nh; k++) {
        x[k] = 0.0;
        for (size_t mode = 0; mode < MODES; mode++) {
            z force = k == 0 ? -I * b->m->beam.load[mode] : 0.0;
            for (size_t c = 0; c < CONTACTS; c++) {
                force += b->m->beam.j[c][mode] * b->f[c * nh + k];
            }
            x[k] += b->m->beam.load[mode] * force * receptance(b, mode, k);
        }
    }
}

static void measure(struct harmonic_balance *b, struct steady *steady)
{
    double least = HUGE_VAL, most = -HUGE_VAL;
    find_friction(b, b->v, 0);
    steady->power = 0.0;
    for (size_t i = 0; i < CONTACTS * b->harmonics; i++) {
        steady->power -= 0.5 * creal(b->f[i] * conj(b->v[i]));
    }
    find_motion(b, b->trial);
    to_time(b, b->trial);
    for (size_t i = 0; i < b->samples; i++) {
        least = fmin(least, b->time[i]);
        most = fmax(most, b->time[i]);
    }
    steady->amplitude = 0.5 * (most - least);
}

size_t balance_solve(struct harmonic_balance *b, double omega, double limit, double epsilon, struct steady *steady)
{
    b->omega = omega;
    b->limit = limit;
    b->steps = 0;
    find_structure(b);
    b->fastest = 0.0;
    for (size_t i = 0; i < CONTACTS * b->harmonics; i++) {
        b->fastest = fmax(b->fastest, cabs(b->free[i]));
    }
    const int found = newton(b, epsilon, EXACT, MOST) || steepen(b, epsilon);
    measure(b, steady);
    return found ? b->steps : 0;
}
