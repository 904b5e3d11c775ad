/* Mode k, eta'' + c eta' + omega^2 eta = J_k'f, has the map z = (eta, eta') -> A z + (1 - A) (J_k'f/omega^2, 0) over an interval
 * of length h. Odd motions are sums of e^{i theta j}, theta = pi/N, 3 pi/N, ... (N - 1) pi/N, so that mean velocities are
 *     v = w + G(theta) f,    G = sum over modes of J_k J_k' (e^{i theta} - 1)/h [(e^{i theta} - A)^-1 (1 - A)]_11/omega^2
 * w: velocities by loads and bases. Compliance adds (1 - e^{-i theta})/h times its matrix to G. f'v is the work on the structure,
 * so G does not generate energy. Therefore, with the limits L and a rho that is diagonal over the contacts,
 *     f = clamp(s, -L, L),    (1 + rho G) y = 2 f - s - rho w,    s += y - f
 * converges to f = clamp(f - rho v, -L, L), Coulomb's law (Douglas and Rachford 1956; Lions and Mercier 1979). */
#include "forecast.h"
#include "common/imaginary.h"
#include "common/layout.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* N = number of modes, rounded down to even, within these bounds; at most SWEEPS N sweeps. */
enum { LEAST_INTERVALS = 32, MOST_INTERVALS = 64, SWEEPS = 2 };

/* Sweeps end when |y - f| <= SETTLED |f|. */
#define SETTLED 1e-2

/* There is no forecast if |det(1 + A^N)| <= RESONANCE for a mode: its free motion comes back after a period. */
#define RESONANCE 1e-9

/* rho_i |G_ii(pi/N)| without compliance: about 1/3 needs the fewest sweeps, with few and with many modes. */
#define STEP 0.3

struct forecast {
    struct period_map *m;
    size_t modes, contacts, intervals; /* intervals: N, even */
    double h;
    double *shape;                          /* [modes][contacts] J phi_k */
    double *move;                           /* [modes][4] A */
    double *give;                           /* [contacts][contacts] matrix of compliance, 0 for rigid contacts */
    double complex *eta;                    /* [harmonics][modes] modal amplitudes by loads, times e^{i omega t0} */
    double *wave, *back;                    /* [N][N] orthogonal: rows cos theta j and sin theta j of each theta; its transpose */
    double *inverse;                        /* [N/2][2 contacts][2 contacts] (1 + rho G)^-1 on cosine and sine parts */
    double complex *g;                      /* [contacts][contacts] workspace */
    double *scaled;                         /* [modes][2 contacts] workspace */
    double *rho;                            /* [contacts] */
    double *limit, *w, *f, *s, *y, *change; /* [contacts][N] */
    double *part;                           /* [4 contacts] workspace */
};

static void lay_out_forecast(struct forecast *x, struct layout *l)
{
    const size_t c = x->contacts, n = x->intervals * c;
    double **const array[] = {&x->limit, &x->w, &x->f, &x->s, &x->y, &x->change};
    x->eta = tribo_layout_array(l, x->m->sys->harmonics * x->modes, sizeof *x->eta);
    x->shape = tribo_layout_array(l, x->modes * c, sizeof *x->shape);
    x->move = tribo_layout_array(l, x->modes * 4, sizeof *x->move);
    x->give = tribo_layout_array(l, c * c, sizeof *x->give);
    x->wave = tribo_layout_array(l, x->intervals * x->intervals, sizeof *x->wave);
    x->back = tribo_layout_array(l, x->intervals * x->intervals, sizeof *x->back);
    x->inverse = tribo_layout_array(l, 2 * n * c, sizeof *x->inverse);
    x->g = tribo_layout_array(l, c * c, sizeof *x->g);
    x->scaled = tribo_layout_array(l, 2 * x->modes * c, sizeof *x->scaled);
    x->rho = tribo_layout_array(l, c, sizeof *x->rho);
    x->part = tribo_layout_array(l, 4 * c, sizeof *x->part);
    for (size_t k = 0; k < sizeof array / sizeof *array; k++) {
        *array[k] = tribo_layout_array(l, n, sizeof **array[k]);
    }
}

/* Sets a [2][2] = the map of (eta, eta') over tau for free mode k with omega > c/2. */
static void move_mode(const struct energy_norm *norm, size_t k, double tau, double *a)
{
    const double omega = norm->natural[k], half = 0.5 * norm->damping[k], nu = sqrt(omega * omega - half * half);
    const double size = exp(-half * tau), c = size * cos(nu * tau), s = size * sin(nu * tau) / nu;
    a[0] = c + half * s;
    a[1] = s;
    a[2] = -omega * omega * s;
    a[3] = c - half * s;
}

/* Sets end [4] = 1 + A^N of mode k. Returns det(1 + A^N): 0 if the mode resonates without damping. */
static double end_mode(const struct forecast *x, size_t k, double *end)
{
    move_mode(&x->m->norm, k, x->m->span, end);
    end[0] += 1.0;
    end[3] += 1.0;
    return end[0] * end[3] - end[1] * end[2];
}

/* Sets shape, move and give. Returns 0 if a mode does not oscillate, or resonates without damping. */
static int forecast_modes(struct forecast *x)
{
    const struct energy_norm *norm = &x->m->norm;
    const tribo_system *sys = x->m->sys;
    const struct compliance *g = &sys->compliance;
    for (size_t k = 0; k < x->modes; k++) {
        double end[4];
        if (!(norm->natural[k] > 0.5 * fabs(norm->damping[k])) || !(fabs(end_mode(x, k, end)) > RESONANCE)) {
            return 0;
        }
        move_mode(norm, k, x->h, x->move + 4 * k);
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

/* Sets x->eta, x->w = mean velocities without friction, and x->limit = the limits in the middle of the intervals. */
static void find_drive(struct forecast *x)
{
    const struct period_map *m = x->m;
    const size_t c = x->contacts;
    for (size_t s = 0; s < m->sys->harmonics; s++) {
        const struct harmonic *p = &m->sys->harmonic[s];
        const double complex unit = cexp(p->omega * m->t * I), step = cexp(p->omega * x->h * I);
        double complex *eta = x->eta + s * x->modes, *way = (double complex *)x->change; /* [contacts], memory of change */
        memset(way, 0, c * sizeof *way);
        for (size_t k = 0; p->drives == DRIVES_LOAD && k < x->modes; k++) {
            const double omega = m->norm.natural[k];
            double complex force = 0.0;
            for (size_t e = 0; e < p->count; e++) {
                force += m->norm.psi[k * x->modes + p->index[e]] * (p->cosine[e] - p->sine[e] * I);
            }
            eta[k] = unit * force / (omega * omega - p->omega * p->omega + p->omega * m->norm.damping[k] * I);
            for (size_t i = 0; i < c; i++) {
                way[i] += x->shape[k * c + i] * eta[k];
            }
        }
        for (size_t e = 0; p->drives == DRIVES_BASE && e < p->count; e++) {
            way[p->index[e]] -= unit * (p->cosine[e] - p->sine[e] * I) / (p->omega * I);
        }
        double complex turn = (step - 1.0) / x->h;
        for (size_t j = 0; j < x->intervals; j++, turn *= step) {
            for (size_t i = 0; i < c; i++) {
                x->w[i * x->intervals + j] += creal(way[i] * turn);
            }
        }
    }
    for (size_t j = 0; j < x->intervals; j++) {
        tribo_system_set_time(m->sys, m->t + ((double)j + 0.5) * x->h);
        tribo_system_limits(m->sys, x->part, x->part + c);
        for (size_t i = 0; i < c; i++) {
            x->limit[i * x->intervals + j] = greater(x->part[i], 0.0);
        }
    }
}

/* Sets g [c][c] = g^-1, by Gauss and Jordan. */
static void invert_without_pivots(size_t c, double complex *g)
{
    for (size_t k = 0; k < c; k++) {
        const double complex pivot = 1.0 / g[k * c + k];
        g[k * c + k] = 1.0;
        for (size_t j = 0; j < c; j++) {
            g[k * c + j] *= pivot;
        }
        for (size_t i = 0; i < c; i++) {
            const double complex factor = i == k ? 0.0 : g[i * c + k];
            g[i * c + k] = i == k ? g[i * c + k] : 0.0;
            for (size_t j = 0; i != k && j < c; j++) {
                g[i * c + j] -= factor * g[k * c + j];
            }
        }
    }
}

/* Sets wave, back, rho and inverse. 1 + rho G needs no pivots: 1 + rho^1/2 G rho^1/2 has a positive definite real part. */
static void find_inverses(struct forecast *x)
{
    const size_t c = x->contacts, two = 2 * c;
    const double *omega = x->m->norm.natural;
    double complex *g = x->g;
    for (size_t p = 0; p < x->intervals / 2; p++) {
        const double theta = acos(-1.0) * (double)(2 * p + 1) / (double)x->intervals;
        const double complex z = cexp(theta * I), step = (z - 1.0) / x->h;
        for (size_t j = 0; j < x->intervals; j++) {
            x->wave[2 * p * x->intervals + j] = sqrt(2.0 / (double)x->intervals) * cos(theta * (double)j);
            x->wave[(2 * p + 1) * x->intervals + j] = sqrt(2.0 / (double)x->intervals) * sin(theta * (double)j);
        }
        for (size_t k = 0; k < x->modes; k++) {
            const double *a = x->move + 4 * k;
            const double complex r = step * ((z - a[3]) * (1.0 - a[0]) - a[1] * a[2]) /
                                     (((z - a[0]) * (z - a[3]) - a[1] * a[2]) * (omega[k] * omega[k]));
            for (size_t i = 0; i < c; i++) {
                x->scaled[k * two + i] = creal(r) * x->shape[k * c + i];
                x->scaled[k * two + c + i] = cimag(r) * x->shape[k * c + i];
            }
        }
        double *inverse = x->inverse + p * two * two; /* real and imaginary part of G here */
        tribo_multiply_transposed_add(x->modes, two, c, x->scaled, x->shape, inverse);
        for (size_t i = 0; i < c; i++) {
            const double size = hypot(inverse[i * c + i], inverse[(c + i) * c + i]);
            x->rho[i] = p ? x->rho[i] : size > 0.0 ? STEP / size : 0.0;
            for (size_t j = 0; j < c; j++) {
                const double complex give = (1.0 - 1.0 / z) / x->h * x->give[i * c + j];
                g[i * c + j] = (i == j) + x->rho[i] * (inverse[i * c + j] + inverse[(c + i) * c + j] * I + give);
            }
        }
        invert_without_pivots(c, g);
        for (size_t i = 0; i < c; i++) { /* for signals cosine - i sine */
            for (size_t j = 0; j < c; j++) {
                double *to = inverse + i * two + j;
                to[0] = to[c * two + c] = creal(g[i * c + j]);
                to[c] = cimag(g[i * c + j]);
                to[c * two] = -cimag(g[i * c + j]);
            }
        }
    }
    tribo_transpose(x->intervals, x->intervals, x->wave, x->back);
}

/* Sets x->f by sweeps. */
static void forecast_forces(struct forecast *x)
{
    const size_t c = x->contacts, n = x->intervals * c, two = 2 * c;
    double change = HUGE_VAL, size = 0.0;
    for (size_t sweep = 0; sweep < SWEEPS * x->intervals && change > SETTLED * SETTLED * size; sweep++) {
        for (size_t k = 0; k < n; k++) {
            x->f[k] = clamp(x->s[k], -x->limit[k], x->limit[k]);
            x->y[k] = 2.0 * x->f[k] - x->s[k] - x->rho[k / x->intervals] * x->w[k];
        }
        memset(x->change, 0, n * sizeof *x->change);
        tribo_multiply_add(c, x->intervals, x->intervals, 1.0, x->y, x->back, x->change);
        for (size_t p = 0; p < x->intervals / 2; p++) {
            double *from = x->part, *to = from + two;
            for (size_t i = 0; i < two; i++) {
                from[i] = x->change[i % c * x->intervals + 2 * p + i / c];
                to[i] = 0.0;
            }
            tribo_multiply_add(two, two, 1, 1.0, x->inverse + p * two * two, from, to);
            for (size_t i = 0; i < two; i++) {
                x->change[i % c * x->intervals + 2 * p + i / c] = to[i];
            }
        }
        memset(x->y, 0, n * sizeof *x->y);
        tribo_multiply_add(c, x->intervals, x->intervals, 1.0, x->change, x->wave, x->y);
        change = size = 0.0;
        for (size_t k = 0; k < n; k++) {
            const double move = x->y[k] - x->f[k];
            x->s[k] += move;
            change += move * move;
            size += x->f[k] * x->f[k];
        }
    }
}

/* Sets x->m->y = the state at t0 = m->t. eta [2][modes]: workspace. */
static void forecast_state(struct forecast *x, double *eta)
{
    struct period_map *m = x->m;
    const size_t n = x->modes, c = x->contacts;
    for (size_t k = 0; k < n; k++) {
        /* z0 = -(1 + A^N)^-1 sum of A^(N - 1 - j) (1 - A) (J'f_j/omega^2, 0) */
        const double *a = x->move + 4 * k, omega = m->norm.natural[k];
        double q = 0.0, u = 0.0, end[4];
        const double det = end_mode(x, k, end);
        for (size_t j = 0; j < x->intervals; j++) {
            double force = 0.0;
            for (size_t i = 0; i < c; i++) {
                force += x->shape[k * c + i] * x->f[i * x->intervals + j];
            }
            const double rest = force / (omega * omega), off = q - rest;
            q = rest + a[0] * off + a[1] * u;
            u = a[2] * off + a[3] * u;
        }
        eta[k] = -(end[3] * q - end[1] * u) / det;
        eta[n + k] = -(end[0] * u - end[2] * q) / det;
        for (size_t s = 0; s < m->sys->harmonics; s++) {
            eta[k] += creal(x->eta[s * n + k]);
            eta[n + k] -= m->sys->harmonic[s].omega * cimag(x->eta[s * n + k]);
        }
    }
    memset(m->y, 0, (m->n + 1) * sizeof *m->y);
    tribo_multiply_add(n, n, 1, 1.0, m->norm.phi, eta, m->y);
    tribo_multiply_add(n, n, 1, 1.0, m->norm.phi, eta + n, m->y + n);
    for (size_t i = 0; i < c; i++) {
        x->part[i] = 0.5 * (x->f[i * x->intervals] - x->f[i * x->intervals + x->intervals - 1]);
    }
    tribo_compliance_put(m->sys, x->part, m->y);
}

int tribo_forecast(struct period_map *m, double *x, int *done)
{
    const size_t modes = m->sys->ndof, even = modes - modes % 2;
    struct forecast forecast = {.m = m, .modes = modes, .contacts = m->sys->ncontact};
    forecast.intervals = even < LEAST_INTERVALS ? LEAST_INTERVALS : even > MOST_INTERVALS ? MOST_INTERVALS : even;
    forecast.h = m->span / (double)forecast.intervals;
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
        forecast_state(&forecast, x);
        tribo_energy_norm_of(&m->norm, 1, m->y, x);
        *done = tribo_dense_finite(x, m->n);
    }
    free(memory);
    return TRIBO_OK;
}
