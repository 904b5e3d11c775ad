#include "harmonic_balance.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_blas.h>
#include <gsl/gsl_fft_halfcomplex.h>
#include <gsl/gsl_fft_real.h>
#include <gsl/gsl_linalg.h>

#include "../../examples/common/output.h"

typedef double complex z;

/* Of a motion x(t) = Re(sum over h of X_h e^{i h omega t}), h = 1 ... H, contact by contact: X[c*H + h - 1]. */
struct harmonic_balance {
    const struct model *m;
    size_t harmonics, samples, unknowns; /* 2*CONTACTS*harmonics real ones */
    double omega, limit, epsilon;
    z *v, *trial, *f, *free; /* [CONTACTS*H] velocities, those tried, forces, velocities without friction */
    z *response;             /* [H][CONTACTS][CONTACTS] velocities by forces */
    z *slope;                /* [CONTACTS][2 H + 1] Fourier coefficients of df/dv */
    double *time;            /* [samples] */
    gsl_matrix *jacobian;
    gsl_vector *residual, *step;
    gsl_permutation *order;
};

struct harmonic_balance *balance_create(const struct model *m, size_t harmonics)
{
    struct harmonic_balance *b = need_memory(1, sizeof *b);
    const size_t n = CONTACTS * harmonics;
    *b = (struct harmonic_balance){.m = m, .harmonics = harmonics, .samples = 64, .unknowns = 2 * n};
    while (b->samples < 16 * harmonics) {
        b->samples *= 2;
    }
    b->v = need_memory(4 * n + CONTACTS * n + CONTACTS * (2 * harmonics + 1), sizeof *b->v);
    b->trial = b->v + n;
    b->f = b->trial + n;
    b->free = b->f + n;
    b->response = b->free + n;
    b->slope = b->response + CONTACTS * n;
    b->time = need_memory(b->samples, sizeof *b->time);
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

/* Displacement of mode k by a force e^{i h omega t} on it. */
static z receptance(const struct harmonic_balance *b, size_t k, size_t h)
{
    const double w = b->omega * (double)h;
    return 1.0 / (b->m->beam.stiffness[k] - w * w + I * w * b->m->beam.damping[k]);
}

static void find_structure(struct harmonic_balance *b)
{
    const struct modal *s = &b->m->beam;
    const size_t nh = b->harmonics;
    memset(b->free, 0, CONTACTS * nh * sizeof *b->free);
    memset(b->response, 0, CONTACTS * CONTACTS * nh * sizeof *b->response);
    for (size_t h = 1; h <= nh; h++) {
        for (size_t k = 0; k < MODES; k++) {
            const z velocity = I * b->omega * (double)h * receptance(b, k, h);
            for (size_t c = 0; c < CONTACTS; c++) {
                if (h == 1) {
                    b->free[c * nh] += s->j[c][k] * velocity * -I * s->load[k]; /* sin = Re(-i e^{i omega t}) */
                }
                for (size_t d = 0; d < CONTACTS; d++) {
                    b->response[((h - 1) * CONTACTS + c) * CONTACTS + d] += s->j[c][k] * velocity * s->j[d][k];
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
    for (size_t h = 1; h <= b->harmonics; h++) {
        b->time[h] = 0.5 * (double)n * creal(x[h - 1]);
        b->time[n - h] = 0.5 * (double)n * cimag(x[h - 1]);
    }
    gsl_fft_halfcomplex_radix2_inverse(b->time, 1, n);
}

/* Mean of time times e^{-i h omega t}, after its transformation. */
static z coefficient(const struct harmonic_balance *b, size_t h)
{
    const size_t n = b->samples;
    return (b->time[h] + (h ? I * b->time[n - h] : 0.0)) / (double)n;
}

/* f of the velocities v, and the slopes if they are wanted. */
static void find_friction(struct harmonic_balance *b, const z *v, int slopes)
{
    const size_t nh = b->harmonics, n = b->samples;
    for (size_t c = 0; c < CONTACTS; c++) {
        to_time(b, v + c * nh);
        for (size_t i = 0; i < n; i++) {
            b->time[i] = -b->limit * tanh(b->time[i] / b->epsilon);
        }
        gsl_fft_real_radix2_transform(b->time, 1, n);
        for (size_t h = 1; h <= nh; h++) {
            b->f[c * nh + h - 1] = 2.0 * coefficient(b, h);
        }
        if (slopes) {
            to_time(b, v + c * nh);
            for (size_t i = 0; i < n; i++) {
                const double s = tanh(b->time[i] / b->epsilon);
                b->time[i] = -b->limit / b->epsilon * (1.0 - s * s);
            }
            gsl_fft_real_radix2_transform(b->time, 1, n);
            for (size_t h = 0; h <= 2 * nh; h++) {
                b->slope[c * (2 * nh + 1) + h] = coefficient(b, h);
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
        for (size_t h = 0; h < nh; h++) {
            z r = v[c * nh + h] - b->free[c * nh + h];
            for (size_t d = 0; d < CONTACTS; d++) {
                r -= b->response[(h * CONTACTS + c) * CONTACTS + d] * b->f[d * nh + h];
            }
            gsl_vector_set(b->residual, 2 * (c * nh + h), creal(r));
            gsl_vector_set(b->residual, 2 * (c * nh + h) + 1, cimag(r));
        }
    }
    return gsl_blas_dnrm2(b->residual);
}

/* A change of V_k makes one of F_h by s_{h-k} dV_k + s_{h+k} conj(dV_k), s being the slope's coefficients. */
static void find_jacobian(struct harmonic_balance *b)
{
    const size_t nh = b->harmonics;
    for (size_t c = 0; c < CONTACTS; c++) {
        for (size_t d = 0; d < CONTACTS; d++) {
            const z *s = b->slope + d * (2 * nh + 1);
            for (size_t h = 1; h <= nh; h++) {
                const z y = -b->response[((h - 1) * CONTACTS + c) * CONTACTS + d];
                for (size_t k = 1; k <= nh; k++) {
                    const z p = y * (h >= k ? s[h - k] : conj(s[k - h])), q = y * s[h + k];
                    const double one = c == d && h == k ? 1.0 : 0.0;
                    const size_t row = 2 * (c * nh + h - 1), col = 2 * (d * nh + k - 1);
                    gsl_matrix_set(b->jacobian, row, col, one + creal(p) + creal(q));
                    gsl_matrix_set(b->jacobian, row, col + 1, cimag(q) - cimag(p));
                    gsl_matrix_set(b->jacobian, row + 1, col, cimag(p) + cimag(q));
                    gsl_matrix_set(b->jacobian, row + 1, col + 1, one + creal(p) - creal(q));
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

/* From v, at the epsilon that is set; returns its steps, or 0. */
static size_t newton(struct harmonic_balance *b, double tolerance)
{
    int sign;
    for (size_t steps = 1; steps <= 40; steps++) {
        const double norm = find_residual(b, b->v, 1);
        double part = 1.0;
        if (norm < tolerance) {
            return steps;
        }
        find_jacobian(b);
        if (gsl_linalg_LU_decomp(b->jacobian, b->order, &sign) ||
            gsl_linalg_LU_solve(b->jacobian, b->order, b->residual, b->step)) {
            return 0;
        }
        while (!(shortened(b, part) < (1.0 - 0.1 * part) * norm) && part > 1e-3) {
            part *= 0.5;
        }
        memcpy(b->v, b->trial, CONTACTS * b->harmonics * sizeof *b->v);
    }
    return 0;
}

/* -------------------------------------------------------------------------------------------------------- the answer */

static void measure(struct harmonic_balance *b, struct steady *steady)
{
    const size_t nh = b->harmonics;
    double least = HUGE_VAL, most = -HUGE_VAL;
    z *x = b->trial;
    find_friction(b, b->v, 0);
    steady->power = 0.0;
    for (size_t i = 0; i < CONTACTS * nh; i++) {
        steady->power -= 0.5 * creal(b->f[i] * conj(b->v[i]));
    }
    for (size_t h = 1; h <= nh; h++) {
        x[h - 1] = 0.0;
        for (size_t k = 0; k < MODES; k++) {
            z force = h == 1 ? -I * b->m->beam.load[k] : 0.0;
            for (size_t c = 0; c < CONTACTS; c++) {
                force += b->m->beam.j[c][k] * b->f[c * nh + h - 1];
            }
            x[h - 1] += b->m->beam.load[k] * force * receptance(b, k, h);
        }
    }
    to_time(b, x);
    for (size_t i = 0; i < b->samples; i++) {
        least = fmin(least, b->time[i]);
        most = fmax(most, b->time[i]);
    }
    steady->amplitude = 0.5 * (most - least);
}

size_t balance_solve(struct harmonic_balance *b, double omega, double limit, double epsilon, struct steady *steady)
{
    const size_t n = CONTACTS * b->harmonics;
    double fastest = 0.0;
    b->omega = omega;
    b->limit = limit;
    find_structure(b);
    for (size_t i = 0; i < n; i++) {
        fastest = fmax(fastest, cabs(b->free[i]));
    }
    b->epsilon = epsilon * fastest;
    size_t steps = newton(b, 1e-9 * fastest), all = steps;
    if (!steps) {
        /* from the motion without friction, and the law ever steeper */
        memcpy(b->v, b->free, n * sizeof *b->v);
        for (double wide = 1.0; wide > epsilon; wide *= 0.5) {
            b->epsilon = wide * fastest;
            all += newton(b, 1e-6 * fastest);
        }
        b->epsilon = epsilon * fastest;
        steps = newton(b, 1e-9 * fastest);
        all += steps;
    }
    measure(b, steady);
    return steps ? all : 0;
}
