/* Harmonics: forcing of the modes, and response of the modes. */
#include "parts.h"
#include "common/imaginary.h"

#include <math.h>
#include <string.h>

/* |omega^2 - Omega^2 + i Omega damping|/omega^2 below which the closed form with a small divisor is not used: a response much
 * larger than the motion loses digits. */
#define RESONANCE 1e-2

/* |lambda - i Omega|/Omega down to which the response of coupled modes keeps enough digits. */
#define UNDAMPED 1e-9

/* y [ndof], zero before, = velocities with J_I y = x, x [rests] = b_I, and Phi'M y = 0. */
static void belt_velocities(struct modal_build *b, const double *x, double *y)
{
    tribo_constraints_follow(&b->ties, x, y);
    for (size_t k = 0; k < b->h->modes; k++) {
        tribo_add(y, -tribo_dot(b->psi + k * b->n, y, b->n), b->phi + k * b->n, b->n);
    }
}

/* x [rests] = a part of harmonic w of b_I = Re((c - i s) e^{i Omega t}): c for part 0, -s for part 1. Returns 1 if x is not 0. */
static int base_part(const struct modal_build *b, const struct harmonic *w, int part, double *x)
{
    int moves = 0;
    for (size_t p = 0; p < b->rests; p++) {
        x[p] = 0.0;
        for (size_t i = 0; i < w->count; i++) {
            if (w->index[i] == b->rest[p]) {
                x[p] = part ? -w->sine[i] : w->cosine[i];
                moves |= x[p] != 0.0;
            }
        }
    }
    return moves;
}

/* rate [ncontact] = the same part of f' of compliant contacts at rest, for velocities y [ndof]. work [ncontact] is workspace.
 * Returns 1 if rate is not 0. */
static int spring_part(const struct modal_build *b, const struct harmonic *w, int part, const double *y, double *work,
                       double *rate)
{
    const tribo_system *sys = b->shared->sys;
    int moves = 0;
    if (!b->springs) {
        return 0;
    }
    tribo_matrix_multiply(&sys->direction, y, work);
    for (size_t e = 0; e < w->count; e++) {
        work[w->index[e]] -= part ? -w->sine[e] : w->cosine[e];
    }
    tribo_compliance_rates(sys, b->slip, work, rate);
    for (size_t p = b->rests; p < b->rests + b->springs; p++) {
        moves |= rate[b->rest[p]] != 0.0;
    }
    return moves;
}

void tribo_modal_add_springs(const struct modal_build *b, double by, const double *rate, double *pull)
{
    const struct matrix *j = &b->shared->sys->direction;
    for (size_t p = b->rests; p < b->rests + b->springs; p++) {
        const size_t i = b->rest[p];
        for (size_t e = j->first[i]; e < j->first[i + 1]; e++) {
            pull[j->col[e]] += by * rate[i] * j->val[e];
        }
    }
}

static int list_forcing(struct modal_build *b)
{
    struct modal *h = b->h;
    const tribo_system *sys = b->shared->sys;
    const size_t c = sys->ncontact;
    h->given = h->harmonics = sys->harmonics;
    h->forcing = tribo_modal_keep_forcing(b, sys->harmonics + sys->limit_harmonics * (c - b->rests));
    if (!h->forcing) {
        return 0;
    }
    for (size_t k = 0; k < sys->harmonics; k++) {
        const struct harmonic *w = &sys->harmonic[k];
        h->forcing[k] = (struct forcing){w->omega, k, c};
        for (size_t i = 0; w->drives == DRIVES_LIMIT && w->omega != 0.0 && i < c; i++) {
            if (b->h->key[i] != 2 && (w->cosine[i] != 0.0 || w->sine[i] != 0.0)) {
                h->forcing[h->harmonics++] = (struct forcing){w->omega, k, i};
            }
        }
    }
    return 1;
}

/* pull [ndof] = -by K y, drag [ndof] = -C y: forces of stiffness and of damping for velocities y [ndof]. */
static void resist(const struct modal_build *b, const double *y, double by, double *pull, double *drag)
{
    memset(pull, 0, b->n * sizeof *pull);
    memset(drag, 0, b->n * sizeof *drag);
    tribo_matrix_multiply_add(b->shared->stiffness, -by, y, pull);
    if (b->shared->damping) {
        tribo_matrix_multiply_add(b->shared->damping, -1.0, y, drag);
    }
}

/* Adds the forcing of eta by harmonic w of bases, Phi'((J'f' - K y)/(i Omega) - C y), y: velocities by held contacts, f': rates
 * of compliant contacts at rest; 1/i turns the real part into minus the imaginary part. Omega = 0: adds y to y0 and f' to rate_0.
 * x [rests + ncontact], pull and drag [ndof] are workspace. */
static void force_by_base(struct modal_build *b, size_t w, double *x, double *pull, double *drag)
{
    struct modal *h = b->h;
    const size_t n = b->n, m = h->modes, c = b->rates;
    const struct harmonic *wave = &b->shared->sys->harmonic[w];
    double *const g[] = {h->gr + w * m, h->gi + w * m}, *const y[] = {b->yr + w * n, b->yi + w * n};
    double *const rate[] = {b->rate_r + w * c, b->rate_i + w * c};
    int moves[2];
    for (int part = 0; part < 2; part++) {
        moves[part] = base_part(b, wave, part, x);
        if (moves[part]) {
            belt_velocities(b, x, y[part]);
        }
        moves[part] |= spring_part(b, wave, part, y[part], x + b->rests, rate[part]);
    }
    if (wave->omega == 0.0) {
        tribo_add(b->y0, 1.0, y[0], n);
        tribo_add(b->rate_0, 1.0, rate[0], c);
        b->steady |= moves[0];
        memset(y[0], 0, n * sizeof **y);
        memset(y[1], 0, n * sizeof **y);
        memset(rate[0], 0, c * sizeof **rate);
        memset(rate[1], 0, c * sizeof **rate);
        return;
    }
    for (int part = 0; part < 2; part++) {
        if (!moves[part]) {
            continue;
        }
        const double by = (part ? 1.0 : -1.0) / wave->omega;
        resist(b, y[part], by, pull, drag);
        tribo_modal_add_springs(b, by, rate[part], pull);
        for (size_t k = 0; k < m; k++) {
            g[1 - part][k] += tribo_dot(b->phi + k * n, pull, n);
            g[part][k] += tribo_dot(b->phi + k * n, drag, n);
        }
    }
}

/* Sets h->ramp and h->constant by constant loads and bases of constant speed. */
static void force_by_constants(struct modal_build *b, double *pull, double *drag)
{
    struct modal *h = b->h;
    if (b->steady) {
        resist(b, b->y0, 1.0, pull, drag);
        tribo_modal_add_springs(b, 1.0, b->rate_0, pull);
    }
    for (size_t k = 0; k < h->modes; k++) {
        h->ramp[k] = b->steady ? tribo_dot(b->phi + k * b->n, pull, b->n) : 0.0;
        h->constant[k] = b->steady ? tribo_dot(b->phi + k * b->n, drag, b->n) : 0.0;
        for (size_t w = 0; w < b->shared->sys->harmonics; w++) {
            h->constant[k] += h->forcing[w].omega == 0.0 ? h->gr[w * h->modes + k] : 0.0;
        }
    }
}

static int create_forcing(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t m = h->modes, velocities = b->shared->sys->harmonics * b->n;
    const size_t rates = b->shared->sys->harmonics * b->rates;
    double **const kept[] = {&h->gr, &h->gi, &h->ramp, &h->constant};
    const size_t count[] = {h->harmonics * m, h->harmonics * m, m, m};
    double *y = tribo_modal_scratch(b, 2 * velocities + b->n + 2 * rates + b->rates);
    if (!y || !tribo_modal_keep_all(b, sizeof kept / sizeof *kept, kept, count)) {
        return 0;
    }
    b->yr = y;
    b->yi = y + velocities;
    b->y0 = y + 2 * velocities;
    b->rate_r = b->y0 + b->n;
    b->rate_i = b->rate_r + rates;
    b->rate_0 = b->rate_i + rates;
    return 1;
}

/* Sets the forcing of eta by each harmonic, and the velocities y and rates f' by bases. */
int tribo_modal_forcing(struct modal_build *b)
{
    if (!list_forcing(b) || !create_forcing(b)) {
        return 0;
    }
    struct modal *h = b->h;
    const tribo_system *sys = b->shared->sys;
    const size_t m = h->modes;
    double *pull = tribo_modal_scratch(b, 2 * b->n + b->rests + sys->ncontact), *drag = pull ? pull + b->n : NULL;
    double *x = pull ? drag + b->n : NULL;
    const int done = pull != NULL;
    for (size_t w = 0; done && w < sys->harmonics; w++) {
        const enum drives drives = sys->harmonic[w].drives;
        if (drives == DRIVES_LOAD) {
            /* Forcing of eta by a load. */
            const struct harmonic *load = &sys->harmonic[w];
            for (size_t k = 0; k < m; k++) {
                const double *psi = b->psi + k * b->n;
                for (size_t i = 0; i < load->count; i++) {
                    h->gr[w * m + k] += load->cosine[i] * psi[load->index[i]];
                    h->gi[w * m + k] += -load->sine[i] * psi[load->index[i]];
                }
            }
        } else if (drives == DRIVES_BASE) {
            force_by_base(b, w, x, pull, drag);
        }
    }
    for (size_t w = sys->harmonics; done && w < h->harmonics; w++) {
        /* Forcing of eta by a harmonic of a limit, f = limit. */
        const size_t i = h->forcing[w].contact;
        const struct harmonic *limit = &sys->harmonic[h->forcing[w].harmonic];
        for (size_t k = 0; k < m; k++) {
            const double push = tribo_modal_shape(b, i, k);
            h->gr[w * m + k] = push * limit->cosine[i];
            h->gi[w * m + k] = -push * limit->sine[i];
        }
    }
    if (done) {
        force_by_constants(b, pull, drag);
        /* With bases of constant speed modes of omega != 0 have eta' = ramp/omega^2; damping of eta' is a constant force. Modes
         * that damping couples all have omega != 0. */
        for (size_t k = 0; k < m; k++) {
            for (size_t l = h->coupling ? 0 : k; l < (h->coupling ? m : k + 1) && h->omega2[l] != 0.0; l++) {
                h->constant[k] -= (h->coupling ? h->coupling[k * m + l] : h->damping[k]) * (h->ramp[l] / h->omega2[l]);
            }
        }
    }
    return done;
}

/* Sets the response to harmonic w, and resonant, of modes without coupling. */
static void respond_alone(struct modal_build *b, size_t w)
{
    struct modal *h = b->h;
    const double omega = b->h->forcing[w].omega;
    for (size_t k = 0; k < h->modes; k++) {
        const size_t at = w * h->modes + k;
        const double gr = h->gr[at], gi = h->gi[at];
        const double re = h->omega2[k] - omega * omega, im = omega * h->damping[k], square = re * re + im * im;
        h->resonant[at] = sqrt(square) < RESONANCE * fabs(h->omega2[k]) && (gr != 0.0 || gi != 0.0);
        h->any_resonant |= h->resonant[at];
        if (!h->resonant[at] && (gr != 0.0 || gi != 0.0)) {
            h->xr[at] = (gr * re + gi * im) / square;
            h->xi[at] = (gi * re - gr * im) / square;
        }
    }
}

/* x [modes] += response to Re(g e^{i Omega t}), g [modes], by exponents: z' = lambda z + b Re(g e^{i Omega t}) has a solution
 * with parts e^{i Omega t} and e^{-i Omega t}; eta = Re(r z). push [2][exponents] is workspace. */
static void add_resolvent(const struct modal *h, double omega, const double complex *g, double complex *push, double complex *x)
{
    const size_t m = h->modes, e = h->exponents;
    double complex *back = push + e;
    memset(push, 0, 2 * e * sizeof *push);
    for (size_t k = 0; k < m; k++) {
        for (size_t p = 0; p < e; p++) {
            push[p] += (h->br[k * e + p] + h->bi[k * e + p] * I) * g[k];
            back[p] += (h->br[k * e + p] - h->bi[k * e + p] * I) * g[k];
        }
    }
    for (size_t p = 0; p < e; p++) {
        const double complex lambda = h->lr[p] + h->li[p] * I;
        const double complex one = 0.5 * push[p] / (omega * I - lambda), other = 0.5 * back[p] / (omega * I - conj(lambda));
        for (size_t k = 0; k < m; k++) {
            x[k] += (one + other) * h->rr[p * m + k] + (one - other) * I * h->ri[p * m + k];
        }
    }
}

/* Sets the response to harmonic w of coupled modes, refined once. x [7 modes] is workspace. Returns 0 on failure. */
static int respond_together(struct modal_build *b, size_t w, double complex *x)
{
    struct modal *h = b->h;
    const size_t m = h->modes;
    const double omega = b->h->forcing[w].omega;
    double complex *g = x + m, *missed = g + m, *push = missed + m;
    for (size_t p = 0; p < h->exponents; p++) {
        if (!(hypot(h->lr[p], fabs(h->li[p]) - fabs(omega)) > UNDAMPED * fabs(omega))) {
            b->status = tribo_system_fail(b->shared->sys, TRIBO_ERR_UNSUPPORTED,
                                          "the harmonic of omega = %g is in resonance with an undamped mode, while damping couples "
                                          "others: take method event",
                                          omega);
            return 0;
        }
    }
    for (size_t k = 0; k < m; k++) {
        x[k] = 0.0;
        g[k] = h->gr[w * m + k] + h->gi[w * m + k] * I;
    }
    add_resolvent(h, omega, g, push, x);
    for (size_t k = 0; k < m; k++) {
        double complex drag = 0.0;
        for (size_t l = 0; l < m; l++) {
            drag += h->coupling[k * m + l] * x[l];
        }
        missed[k] = g[k] - (h->omega2[k] - omega * omega) * x[k] - omega * I * drag;
    }
    add_resolvent(h, omega, missed, push, x);
    for (size_t k = 0; k < m; k++) {
        h->xr[w * m + k] = creal(x[k]);
        h->xi[w * m + k] = cimag(x[k]);
    }
    return 1;
}

/* Sets the response of eta to the harmonics, (diag(omega^2) - Omega^2 + i Omega C~) x = g. */
int tribo_modal_response(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t m = h->modes, count = h->harmonics;
    double *kept = tribo_modal_keep(b, 2 * count * m);
    double complex *x = (double complex *)tribo_modal_scratch(b, 14 * m);
    h->resonant = tribo_modal_keep_bytes(b, count * m);
    int done = kept && x && h->resonant;
    h->xr = kept;
    h->xi = done ? kept + count * m : NULL;
    for (size_t w = 0; done && w < count; w++) {
        if (b->h->forcing[w].omega != 0.0 && h->coupling) {
            done = respond_together(b, w, x);
        } else if (b->h->forcing[w].omega != 0.0) {
            respond_alone(b, w);
        }
    }
    return done;
}
