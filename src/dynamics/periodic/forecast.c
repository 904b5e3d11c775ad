/* SPDX-License-Identifier: BSD-3-Clause */
/* Approximate state of the odd periodic motion, by Coulomb's law. Damping that couples free modes is neglected.
 *
 * Forces and velocities are sums of the N/2 lowest odd harmonics of half a period, w_p = (2 p + 1) pi/span, known by their values at
 * N times. Mode k, eta'' + c eta' + omega^2 eta = J_k'f, has the receptance H_k = 1/(omega^2 - w^2 + i w c), so that velocities are
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

struct forecast {
    struct period_map *m;
    size_t modes, contacts, times;          /* times: N, even */
    double h;                               /* time between them */
    double *shape;                          /* [modes][contacts] J phi_k */
    double *give;                           /* [contacts][contacts] matrix of compliance, 0 for rigid contacts */
    double *wave, *back;                    /* [N][N] orthogonal: rows cos and sin of w_p t for each p; its transpose */
    double *inverse;                        /* [N/2][2 contacts][2 contacts] (1 + rho A)^-1 on cosine and sine parts */
    double *rho;                            /* [contacts] */
    double *limit, *v, *f, *s, *y, *change; /* [contacts][N]; v: v_0 */
    double *scaled;                         /* [modes][2 contacts] workspace */
    double *mobility;                       /* [2 contacts][contacts] workspace */
    double *matrix;                         /* [2 contacts][2 contacts] workspace */
    double *part;                           /* [4 contacts] workspace */
    double *eta;                            /* [2][modes] amplitudes of modes at m->t, and their rates */
    double complex *way;                    /* [contacts] workspace */
    int *pivot;                             /* [2 contacts] workspace */
};

static void lay_out_forecast(struct forecast *x, struct layout *l)
{
    const size_t c = x->contacts, n = x->times * c;
    const struct {
        double **array;
        size_t count;
    } part[] = {{&x->shape, x->modes * c},
                {&x->give, c * c},
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
                {&x->scaled, 2 * x->modes * c},
                {&x->mobility, 2 * c * c},
                {&x->matrix, 4 * c * c},
                {&x->part, 4 * c},
                {&x->eta, 2 * x->modes}};
    for (size_t k = 0; k < sizeof part / sizeof *part; k++) {
        *part[k].array = tribo_layout_array(l, part[k].count, sizeof **part[k].array);
    }
    x->way = tribo_layout_array(l, c, sizeof *x->way);
    x->pivot = tribo_layout_array(l, 2 * c, sizeof *x->pivot);
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

/* Adds to eta the motion Re(H_k force e^(i w (t - m->t))) of mode k at m->t. Returns its velocity. */
static double complex add_motion(struct forecast *x, size_t k, double w, double complex force)
{
    const double complex eta = force / stiffness(x, k, w), rate = w * eta * I;
    x->eta[k] += creal(eta);
    x->eta[x->modes + k] += creal(rate);
    return rate;
}

/* Sets shape and give. Returns 0 if a mode does not oscillate, or resonates without damping. */
static int forecast_modes(struct forecast *x)
{
    const struct energy_norm *norm = &x->m->norm;
    const tribo_system *sys = x->m->sys;
    const struct compliance *g = &sys->compliance;
    for (size_t k = 0; k < x->modes; k++) {
        int fine = norm->natural[k] > 0.5 * fabs(norm->damping[k]);
        for (size_t p = 0; p < x->times / 2; p++) {
            fine &= cabs(stiffness(x, k, harmonic(x, p))) > RESONANCE * norm->natural[k] * norm->natural[k];
        }
        if (!fine) {
            return 0;
        }
        for (size_t i = 0; i < x->contacts; i++) {
            for (size_t e = sys->direction.first[i]; e < sys->direction.first[i + 1]; e++) {
                x->shape[k * x->contacts + i] += sys->direction.val[e] * norm->phi[sys->direction.col[e] * x->modes + k];
            }
        }
    }
    for (size_t k = 0; k < g->count * g->count; k++) {
        const size_t i = g->contact[k / g->count], j = g->contact[k % g->count];
        x->give[i * x->contacts + j] = tribo_compliance_entry(g, x->contacts, i, j);
    }
    return 1;
}

/* Sets v, limit, and the part of eta by loads. */
static void find_drive(struct forecast *x)
{
    const struct period_map *m = x->m;
    const size_t c = x->contacts;
    for (size_t s = 0; s < m->sys->loads.harmonics; s++) {
        const struct harmonic *p = &m->sys->loads.harmonic[s];
        const double complex unit = cexp(p->omega * m->t * I), step = cexp(p->omega * x->h * I);
        memset(x->way, 0, c * sizeof *x->way);
        for (size_t k = 0; p->drives == DRIVES_LOAD && k < x->modes; k++) {
            double complex force = 0.0;
            for (size_t e = 0; e < p->count; e++) {
                force += m->norm.psi[k * x->modes + p->index[e]] * (p->cosine[e] - p->sine[e] * I);
            }
            const double complex rate = add_motion(x, k, p->omega, unit * force);
            for (size_t i = 0; i < c; i++) {
                x->way[i] += x->shape[k * c + i] * rate;
            }
        }
        for (size_t e = 0; p->drives == DRIVES_BASE && e < p->count; e++) {
            x->way[p->index[e]] -= unit * (p->cosine[e] - p->sine[e] * I);
        }
        double complex turn = 1.0;
        for (size_t j = 0; j < x->times; j++, turn *= step) {
            for (size_t i = 0; i < c; i++) {
                x->v[i * x->times + j] += creal(x->way[i] * turn);
            }
        }
    }
    for (size_t j = 0; j < x->times; j++) {
        tribo_system_set_time(m->sys, m->t + (double)j * x->h);
        tribo_system_limits(m->sys, x->part, x->part + c);
        for (size_t i = 0; i < c; i++) {
            x->limit[i * x->times + j] = greater(x->part[i], 0.0);
        }
    }
}

/* Sets wave, back, rho and inverse. */
static void find_inverses(struct forecast *x)
{
    const size_t c = x->contacts, two = 2 * c;
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
                to[c] = x->rho[i] * (a[(c + i) * c + j] + w * x->give[i * c + j]);
                to[c * two] = -to[c];
            }
            inverse[i * two + i] = inverse[(c + i) * two + c + i] = 1.0;
        }
        tribo_lu_create(x->matrix, two, x->pivot);
        tribo_lu_solve(x->matrix, two, x->pivot, inverse, two);
    }
    tribo_transpose(x->times, x->times, x->wave, x->back);
}

/* Sets x->f by sweeps. */
static void forecast_forces(struct forecast *x)
{
    const size_t c = x->contacts, n = x->times * c, two = 2 * c;
    double change = HUGE_VAL, size = 0.0;
    for (size_t sweep = 0; sweep < x->times && change > SETTLED * SETTLED * size; sweep++) {
        for (size_t k = 0; k < n; k++) {
            x->f[k] = clamp(x->s[k], -x->limit[k], x->limit[k]);
            x->y[k] = 2.0 * x->f[k] - x->s[k] - x->rho[k / x->times] * x->v[k];
        }
        memset(x->change, 0, n * sizeof *x->change);
        tribo_multiply_add(c, x->times, x->times, 1.0, x->y, x->back, x->change);
        for (size_t p = 0; p < x->times / 2; p++) {
            double *from = x->part, *to = from + two;
            for (size_t i = 0; i < two; i++) {
                from[i] = x->change[i % c * x->times + 2 * p + i / c];
                to[i] = 0.0;
            }
            tribo_multiply_add(two, two, 1, 1.0, x->inverse + p * two * two, from, to);
            for (size_t i = 0; i < two; i++) {
                x->change[i % c * x->times + 2 * p + i / c] = to[i];
            }
        }
        memset(x->y, 0, n * sizeof *x->y);
        tribo_multiply_add(c, x->times, x->times, 1.0, x->change, x->wave, x->y);
        change = size = 0.0;
        for (size_t k = 0; k < n; k++) {
            const double move = x->y[k] - x->f[k];
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
    memset(x->change, 0, times * c * sizeof *x->change);
    tribo_multiply_add(c, times, times, sqrt(2.0 / (double)times), x->f, x->back, x->change);
    for (size_t p = 0; p < times / 2; p++) {
        for (size_t k = 0; k < n; k++) {
            double complex force = 0.0;
            for (size_t i = 0; i < c; i++) {
                const double *part = x->change + i * times + 2 * p;
                force += x->shape[k * c + i] * (part[0] - part[1] * I);
            }
            add_motion(x, k, harmonic(x, p), force);
        }
    }
    memset(m->y, 0, (m->n + 1) * sizeof *m->y);
    tribo_multiply_add(n, n, 1, 1.0, m->norm.phi, x->eta, m->y);
    tribo_multiply_add(n, n, 1, 1.0, m->norm.phi, x->eta + n, m->y + n);
    for (size_t i = 0; i < c; i++) {
        x->part[i] = x->f[i * times];
    }
    tribo_compliance_put(m->sys, x->part, m->y);
}

int tribo_forecast(struct period_map *m, double *x, int *done)
{
    const size_t modes = m->sys->ndof, even = modes - modes % 2;
    struct forecast forecast = {.m = m, .modes = modes, .contacts = m->sys->ncontact};
    forecast.times = even < LEAST_TIMES ? LEAST_TIMES : even > MOST_TIMES ? MOST_TIMES : even;
    forecast.h = m->span / (double)forecast.times;
    struct layout l = {0};
    lay_out_forecast(&forecast, &l);
    if (!tribo_layout_zeros(&l)) {
        return tribo_driver_fail(m->drv, TRIBO_ERR_MEMORY, "out of memory for the forces of %zu contact%s", forecast.contacts,
                                 plural(forecast.contacts));
    }
    char *memory = l.memory;
    lay_out_forecast(&forecast, &l);
    *done = forecast_modes(&forecast);
    if (*done) {
        find_drive(&forecast);
        find_inverses(&forecast);
        forecast_forces(&forecast);
        forecast_state(&forecast);
        tribo_energy_norm_of(&m->norm, 1, m->y, x);
        *done = tribo_dense_finite(x, m->n);
    }
    free(memory);
    return TRIBO_OK;
}
