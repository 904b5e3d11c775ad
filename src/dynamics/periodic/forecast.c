/* SPDX-License-Identifier: BSD-3-Clause */
/* Approximate state of the odd periodic motion, by Coulomb's law. Damping that couples free modes is neglected.
 *
 * Forces and velocities are sums of the N/2 lowest odd harmonics of half a period, w_p = (2 p + 1) pi/span, known by their values
 * at N times. Mode k, eta'' + c eta' + omega^2 eta = load_k + J_k'f, has the receptance H_k = 1/(omega^2 - w^2 + i w c), so that
 * velocities are
 *     v = v_0 + i w (G + sum over modes of J_k J_k' H_k) f
 * v_0: velocities by loads and bases; G: matrix of compliance. f'v is the work on the structure, which generates no energy.
 * Therefore, with the limits L, the velocities v_0 + A f, and a rho that is diagonal over the contacts,
 *     f = clamp(s, -L, L),    (1 + rho A) y = 2 f - s - rho v_0,    s += y - f
 * converges to f = clamp(f - rho v, -L, L), Coulomb's law (Douglas and Rachford 1956; Lions and Mercier 1979). */
#include "period_map.h"
#include "common/imaginary.h"
#include "common/layout.h"
#include "common/real.h"
#include "numerics/lapack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* In a ring all sectors have the forces of sector 0, later by multiples of lag: f has the contacts of sector 0 only, and A_ij is
 * the sum over all sectors j of the mobilities times e^{-i w lag j}. */

/* N = number of modes, rounded down to even, within these bounds; at most N sweeps. */
enum { LEAST_TIMES = 32, MOST_TIMES = 96 };

/* Sweeps end when |y - f| <= SETTLED |f|. */
#define SETTLED 2e-3

/* There is no forecast if |omega^2 - w^2 + i w c| <= RESONANCE omega^2 for a mode and a harmonic. */
#define RESONANCE 1e-9

/* rho_i |A_ii| of the first harmonic, without compliance: about 1/3 needs the fewest sweeps, with few and with many modes. */
#define STEP 0.3

/* Signals are values at the times j h, or spectra, transformed by the orthogonal wave_pj = (cos + sin)(w_p j h)/sqrt(N). Entries
 * p and N - 1 - p of a spectrum s make z = s_p + i s_(N-1-p), and the signal is the sum over p < N/2 of
 * Re((1 - i) z e^{i w_p j h})/sqrt(N). */
struct forecast {
    struct period_map *m;
    double span;                   /* half a period */
    size_t modes, contacts, times; /* contacts: of sector 0; times: N, even */
    size_t sectors;                /* 1: no ring */
    double *wave, *back;           /* [N][N] its transpose */
    double complex *receptance;    /* [N/2][modes] H_k */
    double *shape;                 /* [sectors contacts][modes] J phi_k */
    double complex *inverse;       /* [N/2][contacts][contacts] (1 + rho A)^-1 */
    double *rho;                   /* [contacts] */
    double *limit, *v, *f, *s;     /* [sectors contacts][N], of which sweeps have those of sector 0; v: v_0 */
    double *y, *part;              /* [sectors contacts][N] workspace */
    double *load, *motion;         /* [modes][N] spectra of forces on modes; workspace */
    double complex *matrix;        /* [contacts][contacts] workspace */
    double *at;                    /* [sectors contacts] workspace */
    int *pivot;                    /* [contacts] workspace */
};

/* w_p. */
static double harmonic(const struct forecast *x, size_t p)
{
    return acos(-1.0) * (double)(2 * p + 1) / x->span;
}

/* Get and put z at harmonic p of row `row` of spectra. */
static double complex get(const struct forecast *x, const double *spectra, size_t row, size_t p)
{
    return spectra[row * x->times + p] + spectra[(row + 1) * x->times - 1 - p] * I;
}

static void put(const struct forecast *x, double *spectra, size_t row, size_t p, double complex z)
{
    spectra[row * x->times + p] = creal(z);
    spectra[(row + 1) * x->times - 1 - p] = cimag(z);
}

/* z at harmonic p of the displacement of mode k by x->load. */
static double complex displacement(const struct forecast *x, size_t k, size_t p)
{
    return get(x, x->load, k, p) * x->receptance[p * x->modes + k];
}

/* Entry of A at harmonic p. */
static double complex mobility(const struct forecast *x, size_t p, size_t i, size_t j, double compliance)
{
    double complex sum = compliance;
    for (size_t k = 0; k < x->modes; k++) {
        sum += x->shape[i * x->modes + k] * x->shape[j * x->modes + k] * x->receptance[p * x->modes + k];
    }
    return harmonic(x, p) * sum * I;
}

/* Returns e^{-i w_p lag sector}. */
static double complex delay(const struct forecast *x, size_t p, size_t sector)
{
    const double angle = harmonic(x, p) * x->m->ring.lag * (double)sector;
    return cos(angle) - sin(angle) * I;
}

/* to [rows][N] = from by wave or back, from values to spectra by back. */
static void transform(const struct forecast *x, size_t rows, const double *by, const double *from, double *to)
{
    memset(to, 0, rows * x->times * sizeof *to);
    tribo_multiply_add(rows, x->times, x->times, 1.0, from, by, to);
}

/* Sets receptance, shape, wave and back. Returns 0 if a mode does not oscillate, or resonates without damping. */
static int forecast_modes(struct forecast *x)
{
    const struct energy_norm *norm = &x->m->norm;
    const size_t times = x->times;
    for (size_t at = 0; at < times / 2 * x->modes; at++) {
        const size_t k = at % x->modes;
        const double w = harmonic(x, at / x->modes), omega = norm->natural[k];
        const double complex stiffness = omega * omega - w * w + w * norm->damping[k] * I;
        if (!(omega > 0.5 * fabs(norm->damping[k])) || !(cabs(stiffness) > RESONANCE * omega * omega)) {
            return 0;
        }
        x->receptance[at] = 1.0 / stiffness;
    }
    for (size_t at = 0; at < x->sectors * x->contacts * x->modes; at++) {
        x->shape[at] = tribo_matrix_row_dot(&x->m->sys->direction, at / x->modes, norm->phi + at % x->modes * x->modes);
    }
    for (size_t at = 0; at < times * times; at++) {
        const double turn = harmonic(x, at / times) * (double)(at % times) * x->span / (double)times;
        x->wave[at] = (cos(turn) + sin(turn)) / sqrt((double)times);
    }
    tribo_transpose(times, times, x->wave, x->back);
    return 1;
}

/* Sets rho and inverse. */
static void find_inverses(struct forecast *x)
{
    const size_t c = x->contacts;
    const int count = (int)c;
    int info;
    for (size_t i = 0; i < c; i++) {
        const double size = cabs(mobility(x, 0, i, i, 0.0));
        x->rho[i] = size > 0.0 ? STEP / size : 0.0;
    }
    for (size_t p = 0; p < x->times / 2; p++) {
        double complex *inverse = x->inverse + p * c * c;
        for (size_t at = 0; at < c * c; at++) {
            const size_t i = at / c, j = at % c;
            const double own = tribo_compliance_entry(&x->m->sys->compliance, i, j);
            inverse[at] = i == j;
            x->matrix[at] = inverse[at] + x->rho[i] * mobility(x, p, i, j, own);
        }
        for (size_t sector = 1; sector < x->sectors; sector++) {
            const double complex later = delay(x, p, sector);
            for (size_t at = 0; at < c * c; at++) {
                const size_t i = at / c, j = sector * c + at % c;
                const double own = tribo_compliance_entry(&x->m->sys->compliance, i, j);
                x->matrix[at] += x->rho[i] * mobility(x, p, i, j, own) * later;
            }
        }
        zgesv_(&count, &count, x->matrix, &count, x->pivot, inverse, &count, &info);
    }
}

/* Sets v, limit and load. */
static void find_drive(struct forecast *x)
{
    const size_t c = x->contacts, all = x->sectors * c, n = x->modes, times = x->times;
    tribo_system *sys = x->m->sys;
    for (size_t j = 0; j < times; j++) {
        tribo_system_set_time(sys, x->m->t + (double)j * x->span / (double)times);
        tribo_system_loads(sys, DRIVES_LOAD, 0, 1.0, x->motion + j * n);
        tribo_system_loads(sys, DRIVES_BASE, 0, -1.0, x->f + j * all);
        tribo_system_limits(sys, x->y + j * all, x->at);
    }
    tribo_transpose(times, all, x->f, x->v);
    tribo_transpose(times, all, x->y, x->limit);
    tribo_transpose(times, n, x->motion, x->load);
    memset(x->motion, 0, n * times * sizeof *x->motion);
    tribo_multiply_add(n, n, times, 1.0, x->m->norm.psi, x->load, x->motion);
    transform(x, n, x->back, x->motion, x->load);
    for (size_t at = 0; at < n * times / 2; at++) {
        const size_t k = at % n, p = at / n;
        put(x, x->motion, k, p, harmonic(x, p) * displacement(x, k, p) * I);
    }
    memset(x->part, 0, c * times * sizeof *x->part);
    tribo_multiply_add(c, n, times, 1.0, x->shape, x->motion, x->part);
    tribo_multiply_add(c, times, times, 1.0, x->part, x->wave, x->v);
}

/* Sets x->f by sweeps. */
static void forecast_forces(struct forecast *x)
{
    const size_t c = x->contacts, n = x->times * c;
    double change = HUGE_VAL, size = 0.0;
    for (size_t sweep = 0; sweep < x->times && change > SETTLED * SETTLED * size; sweep++) {
        for (size_t k = 0; k < n; k++) {
            const double limit = greater(x->limit[k], 0.0);
            x->f[k] = clamp(x->s[k], -limit, limit);
            x->y[k] = 2.0 * x->f[k] - x->s[k] - x->rho[k / x->times] * x->v[k];
        }
        transform(x, c, x->back, x->y, x->part);
        for (size_t at = 0; at < n / 2; at++) {
            double complex z = 0.0;
            for (size_t j = 0; j < c; j++) {
                z += x->inverse[at * c + j] * get(x, x->part, j, at / c);
            }
            put(x, x->y, at % c, at / c, z);
        }
        transform(x, c, x->wave, x->y, x->part);
        change = size = 0.0;
        for (size_t k = 0; k < n; k++) {
            const double move = x->part[k] - x->f[k];
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
    const size_t n = x->modes, times = x->times, c = x->contacts, all = x->sectors * c;
    transform(x, c, x->back, x->f, x->part);
    for (size_t sector = 1; sector < x->sectors; sector++) {
        for (size_t p = 0; p < times / 2; p++) {
            const double complex later = delay(x, p, sector);
            for (size_t i = 0; i < c; i++) {
                put(x, x->part, sector * c + i, p, get(x, x->part, i, p) * later);
            }
        }
    }
    if (x->sectors > 1) {
        transform(x, all, x->wave, x->part, x->f);
    }
    tribo_multiply_transposed_add(all, n, times, x->shape, x->part, x->load);
    memset(m->y, 0, (m->n + 1) * sizeof *m->y);
    for (size_t k = 0; k < n; k++) {
        double complex eta = 0.0, rate = 0.0;
        for (size_t p = 0; p < times / 2; p++) {
            const double complex z = displacement(x, k, p) * (1.0 - I) / sqrt((double)times);
            eta += z;
            rate += harmonic(x, p) * z * I;
        }
        tribo_add(m->y, creal(eta), m->norm.phi + k * n, n);
        tribo_add(m->y + n, creal(rate), m->norm.phi + k * n, n);
    }
    for (size_t i = 0; i < all; i++) {
        x->at[i] = x->f[i * times];
    }
    tribo_compliance_put(m->sys, x->at, m->y);
}

int tribo_forecast(struct period_map *m, double *x, int *done)
{
    const size_t n = m->sys->ndof, sectors = m->ring.sectors ? m->ring.sectors : 1, all = m->sys->ncontact, c = all / sectors;
    const size_t even = n - n % 2;
    const size_t times = even < LEAST_TIMES ? LEAST_TIMES : even > MOST_TIMES ? MOST_TIMES : even;
    struct forecast f = {.m = m, .span = 0.5 * m->period, .modes = n, .contacts = c, .times = times, .sectors = sectors};
    if (!ALLOCATE(ARRAY(f.receptance, times / 2 * n), ARRAY(f.shape, n * all), ARRAY(f.wave, times * times),
                  ARRAY(f.back, times * times), ARRAY(f.inverse, times / 2 * c * c), ARRAY(f.limit, times * all),
                  ARRAY(f.v, times * all), ARRAY(f.f, times * all), ARRAY(f.s, times * all), ARRAY(f.y, times * all),
                  ARRAY(f.part, times * all), ARRAY(f.load, times * n), ARRAY(f.motion, times * n), ARRAY(f.matrix, c * c),
                  ARRAY(f.rho, c), ARRAY(f.at, all), ARRAY(f.pivot, c))) {
        return tribo_error(m->drv->message, TRIBO_ERR_MEMORY, "out of memory for the forces of %zu contact%s", c, plural(c));
    }
    *done = c > 0 && tribo_lapack_takes(c) && forecast_modes(&f);
    if (*done) {
        find_inverses(&f);
        find_drive(&f);
        forecast_forces(&f);
        forecast_state(&f);
        tribo_energy_norm_of(&m->norm, 1, m->y, x);
        *done = tribo_dense_finite(x, m->n);
    }
    free(f.receptance);
    return TRIBO_OK;
}
