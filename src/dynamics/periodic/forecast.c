/* SPDX-License-Identifier: BSD-3-Clause */
/* Approximate state of the odd periodic motion, by Coulomb's law. Damping that couples free modes is neglected.
 *
 * Forces and velocities are sums of the N/2 lowest odd harmonics of half a period, w_p = (2 p + 1) pi/span, known by their values at
 * N times. Mode k, eta'' + c eta' + omega^2 eta = load_k + J_k'f, has the receptance H_k = 1/(omega^2 - w^2 + i w c), so that
 * velocities are
 *     v = v_0 + i w (G + sum over modes of J_k J_k' H_k) f
 * v_0: velocities by loads and bases; G: matrix of compliance. f'v is the work on the structure, which generates no energy. Therefore,
 * with the limits L, the velocities v_0 + A f, and a rho that is diagonal over the contacts,
 *     f = clamp(s, -L, L),    (1 + rho A) y = 2 f - s - rho v_0,    s += y - f
 * converges to f = clamp(f - rho v, -L, L), Coulomb's law (Douglas and Rachford 1956; Lions and Mercier 1979). */
#include "period_map.h"
#include "common/imaginary.h"
#include "common/layout.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* N = number of modes, rounded down to even, within these bounds; at most N sweeps. */
enum { LEAST_TIMES = 32, MOST_TIMES = 96 };

/* Sweeps end when |y - f| <= SETTLED |f|. */
#define SETTLED 2e-3

/* There is no forecast if |omega^2 - w^2 + i w c| <= RESONANCE omega^2 for a mode and a harmonic. */
#define RESONANCE 1e-9

/* rho_i |A_ii| of the first harmonic, without compliance: about 1/3 needs the fewest sweeps, with few and with many modes. */
#define STEP 0.3

/* Signals [N] of contacts and modes are values at the times, or spectra: cosine and sine part of each harmonic. */
struct forecast {
    struct period_map *m;
    size_t modes, contacts, times; /* times: N, even */
    double h;                      /* time between them */
    double *shape;                 /* [modes][contacts] J phi_k */
    double *wave, *back;           /* [N][N] orthogonal: rows cos and sin of w_p t for each p; its transpose */
    double *inverse;               /* [N/2][2 contacts][2 contacts] (1 + rho A)^-1 on cosine and sine parts */
    double *rho;                   /* [contacts] */
    double *limit, *v, *f, *s;     /* [contacts][N]; v: v_0 */
    double *y, *change;            /* [contacts][N] workspace */
    double *force, *motion;        /* [modes][N] spectra of forces; of loads, and velocities by loads: workspace */
    double *scaled;                /* [modes][2 contacts] workspace */
    double *mobility;              /* [2 contacts][contacts] workspace */
    double *matrix;                /* [2 contacts][2 contacts] workspace */
    double *rate;                  /* [contacts] workspace */
    int *pivot;                    /* [2 contacts] workspace */
};

/* Lays out the arrays as zeros. Returns their memory, or NULL if out of memory. */
static void *lay_out_forecast(struct forecast *x)
{
    const size_t c = x->contacts, n = x->times * c, all = x->times * x->modes;
    const struct {
        double **array;
        size_t count;
    } part[] = {{&x->shape, x->modes * c},
                {&x->wave, x->times * x->times},
                {&x->back, x->times * x->times},
                {&x->inverse, 2 * n * c},
                {&x->rho, c},
                {&x->limit, n},
                {&x->v, n},
                {&x->f, n},
                {&x->s, n},
                {&x->y, n},
                {&x->change, n},
                {&x->force, all},
                {&x->motion, all},
                {&x->scaled, 2 * x->modes * c},
                {&x->mobility, 2 * c * c},
                {&x->matrix, 4 * c * c},
                {&x->rate, c}};
    struct layout l = {0};
    do {
        for (size_t k = 0; k < sizeof part / sizeof *part; k++) {
            *part[k].array = tribo_layout_array(&l, part[k].count, sizeof **part[k].array);
        }
        x->pivot = tribo_layout_array(&l, 2 * c, sizeof *x->pivot);
    } while (!l.memory && tribo_layout_zeros(&l));
    return l.memory;
}

/* w_p. */
static double harmonic(const struct forecast *x, size_t p)
{
    return acos(-1.0) * (double)(2 * p + 1) / x->m->span;
}

/* 1/H_k at the frequency w. */
static double complex stiffness(const struct forecast *x, size_t k, double w)
{
    const struct energy_norm *norm = &x->m->norm;
    return norm->natural[k] * norm->natural[k] - w * w + w * norm->damping[k] * I;
}

/* Harmonic p of mode k by x->force, of its displacement. */
static double complex harmonic_of(const struct forecast *x, size_t k, size_t p)
{
    const double *part = x->force + k * x->times + 2 * p;
    return (part[0] - part[1] * I) / stiffness(x, k, harmonic(x, p));
}

/* to [rows][N] = from by wave or back, from values to spectra by back. */
static void transform(const struct forecast *x, size_t rows, const double *by, const double *from, double *to)
{
    memset(to, 0, rows * x->times * sizeof *to);
    tribo_multiply_add(rows, x->times, x->times, 1.0, from, by, to);
}

/* Sets shape. Returns 0 if a mode does not oscillate, or resonates without damping. */
static int forecast_modes(struct forecast *x)
{
    const struct energy_norm *norm = &x->m->norm;
    for (size_t k = 0; k < x->modes; k++) {
        int fine = norm->natural[k] > 0.5 * fabs(norm->damping[k]);
        for (size_t p = 0; p < x->times / 2; p++) {
            fine &= cabs(stiffness(x, k, harmonic(x, p))) > RESONANCE * norm->natural[k] * norm->natural[k];
        }
        if (!fine) {
            return 0;
        }
        tribo_matrix_multiply(&x->m->sys->direction, norm->phi + k * x->modes, x->shape + k * x->contacts);
    }
    return 1;
}

/* Sets wave, back, rho and inverse. */
static void find_inverses(struct forecast *x)
{
    const size_t c = x->contacts, two = 2 * c;
    const struct compliance *g = &x->m->sys->compliance;
    double *a = x->mobility; /* real and imaginary part of A, without compliance */
    for (size_t p = 0; p < x->times / 2; p++) {
        const double w = harmonic(x, p);
        for (size_t j = 0; j < x->times; j++) {
            x->wave[2 * p * x->times + j] = sqrt(2.0 / (double)x->times) * cos(w * x->h * (double)j);
            x->wave[(2 * p + 1) * x->times + j] = sqrt(2.0 / (double)x->times) * sin(w * x->h * (double)j);
        }
        for (size_t k = 0; k < x->modes; k++) {
            const double complex r = w / stiffness(x, k, w) * I;
            for (size_t i = 0; i < c; i++) {
                x->scaled[k * two + i] = creal(r) * x->shape[k * c + i];
                x->scaled[k * two + c + i] = cimag(r) * x->shape[k * c + i];
            }
        }
        memset(a, 0, two * c * sizeof *a);
        tribo_multiply_transposed_add(x->modes, two, c, x->scaled, x->shape, a);
        double *inverse = x->inverse + p * two * two;
        for (size_t i = 0; i < c; i++) {
            const double size = hypot(a[i * c + i], a[(c + i) * c + i]);
            x->rho[i] = p ? x->rho[i] : size > 0.0 ? STEP / size : 0.0;
            for (size_t j = 0; j < c; j++) { /* of signals cosine - i sine */
                double *to = x->matrix + i * two + j;
                to[0] = to[c * two + c] = (i == j) + x->rho[i] * a[i * c + j];
                to[c] = x->rho[i] * (a[(c + i) * c + j] + w * tribo_compliance_entry(g, c, i, j));
                to[c * two] = -to[c];
            }
            inverse[i * two + i] = inverse[(c + i) * two + c + i] = 1.0;
        }
        tribo_lu_create(x->matrix, two, x->pivot);
        tribo_lu_solve(x->matrix, two, x->pivot, inverse, two);
    }
    tribo_transpose(x->times, x->times, x->wave, x->back);
}

/* Sets v, limit, and force by loads. */
static void find_drive(struct forecast *x)
{
    const size_t c = x->contacts, n = x->modes, times = x->times;
    tribo_system *sys = x->m->sys;
    for (size_t j = 0; j < times; j++) {
        tribo_system_set_time(sys, x->m->t + (double)j * x->h);
        tribo_system_loads(sys, DRIVES_LOAD, 0, 1.0, x->motion + j * n);
        tribo_system_loads(sys, DRIVES_BASE, 0, -1.0, x->f + j * c);
        tribo_system_limits(sys, x->y + j * c, x->rate);
    }
    tribo_transpose(times, c, x->f, x->v);
    tribo_transpose(times, c, x->y, x->limit);
    tribo_transpose(times, n, x->motion, x->force);
    memset(x->motion, 0, n * times * sizeof *x->motion);
    tribo_multiply_add(n, n, times, 1.0, x->m->norm.psi, x->force, x->motion);
    transform(x, n, x->back, x->motion, x->force);
    for (size_t k = 0; k < n; k++) {
        for (size_t p = 0; p < times / 2; p++) {
            const double complex rate = harmonic(x, p) * harmonic_of(x, k, p) * I;
            x->motion[k * times + 2 * p] = creal(rate);
            x->motion[k * times + 2 * p + 1] = -cimag(rate);
        }
    }
    tribo_multiply_transposed_add(n, c, times, x->shape, x->motion, x->change);
    tribo_multiply_add(c, times, times, 1.0, x->change, x->wave, x->v);
}

/* Sets x->f by sweeps. */
static void forecast_forces(struct forecast *x)
{
    const size_t c = x->contacts, n = x->times * c, two = 2 * c;
    double change = HUGE_VAL, size = 0.0;
    for (size_t sweep = 0; sweep < x->times && change > SETTLED * SETTLED * size; sweep++) {
        for (size_t k = 0; k < n; k++) {
            const double limit = greater(x->limit[k], 0.0);
            x->f[k] = clamp(x->s[k], -limit, limit);
            x->y[k] = 2.0 * x->f[k] - x->s[k] - x->rho[k / x->times] * x->v[k];
        }
        transform(x, c, x->back, x->y, x->change);
        tribo_transpose(c, x->times, x->change, x->y); /* [N/2][2 contacts] */
        memset(x->change, 0, n * sizeof *x->change);
        for (size_t p = 0; p < x->times / 2; p++) {
            tribo_multiply_add(two, two, 1, 1.0, x->inverse + p * two * two, x->y + p * two, x->change + p * two);
        }
        tribo_transpose(x->times, c, x->change, x->y);
        transform(x, c, x->wave, x->y, x->change);
        change = size = 0.0;
        for (size_t k = 0; k < n; k++) {
            const double move = x->change[k] - x->f[k];
            x->s[k] += move;
            change += move * move;
            size += x->f[k] * x->f[k];
        }
    }
}

/* Sets x->m->y = the state at m->t. */
static void forecast_state(struct forecast *x)
{
    struct period_map *m = x->m;
    const size_t n = x->modes, c = x->contacts, times = x->times;
    const double size = sqrt(2.0 / (double)times);
    transform(x, c, x->back, x->f, x->change);
    tribo_multiply_add(n, c, times, 1.0, x->shape, x->change, x->force);
    memset(m->y, 0, (m->n + 1) * sizeof *m->y);
    for (size_t k = 0; k < n; k++) {
        double complex eta = 0.0, rate = 0.0;
        for (size_t p = 0; p < times / 2; p++) {
            const double complex part = harmonic_of(x, k, p);
            eta += part;
            rate += harmonic(x, p) * part * I;
        }
        tribo_add(m->y, size * creal(eta), m->norm.phi + k * n, n);
        tribo_add(m->y + n, size * creal(rate), m->norm.phi + k * n, n);
    }
    for (size_t i = 0; i < c; i++) {
        x->rate[i] = x->f[i * times];
    }
    tribo_compliance_put(m->sys, x->rate, m->y);
}

int tribo_forecast(struct period_map *m, double *x, int *done)
{
    const size_t modes = m->sys->ndof, even = modes - modes % 2;
    struct forecast forecast = {.m = m, .modes = modes, .contacts = m->sys->ncontact};
    forecast.times = even < LEAST_TIMES ? LEAST_TIMES : even > MOST_TIMES ? MOST_TIMES : even;
    forecast.h = m->span / (double)forecast.times;
    void *memory = lay_out_forecast(&forecast);
    if (!memory) {
        return tribo_driver_fail(m->drv, TRIBO_ERR_MEMORY, "out of memory for the forces of %zu contact%s", forecast.contacts,
                                 plural(forecast.contacts));
    }
    *done = forecast_modes(&forecast);
    if (*done) {
        find_inverses(&forecast);
        find_drive(&forecast);
        forecast_forces(&forecast);
        forecast_state(&forecast);
        tribo_energy_norm_of(&m->norm, 1, m->y, x);
        *done = tribo_dense_finite(x, m->n);
    }
    free(memory);
    return TRIBO_OK;
}
