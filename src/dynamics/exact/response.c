/* Harmonics: what they do to the modes, and the response to that. */
#include "parts.h"

#include <math.h>
#include <string.h>

/* Closer than this, relative, the response to a harmonic is computed without the closed form's small divisor: what a response
 * exceeds the motion by is lost in digits. */
#define RESONANCE 1e-2

/* A response larger than one over this would leave too few digits. */
#define UNDAMPED 1e-9

/* y [ndof] = velocities from the b [rest] of the contacts that hold, in which the modes have no part. */
static int belt_velocities(struct modal_build *b, const double *x, double *y)
{
    tribo_constraints_follow(&b->ties, x, y);
    if (!tribo_modal_relax(b, y)) {
        return 0;
    }
    for (size_t k = 0; k < b->h->modes; k++) {
        tribo_add(y, -tribo_dot(b->psi + k * b->n, y, b->n), b->phi + k * b->n, b->n);
    }
    return 1;
}

/* One part (0 cosine, 1 minus sine: harmonics are Re((c - i s) e^{i Omega t})) of a harmonic of b_I. Returns whether it moves
 * anything. */
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

/* pull = -K y by, drag = -C y: the forces of stiffness and of damping where degrees of freedom move as y [ndof] says. */
static void resist(const struct modal_build *b, const double *y, double by, double *pull, double *drag)
{
    memset(pull, 0, b->n * sizeof *pull);
    memset(drag, 0, b->n * sizeof *drag);
    tribo_matrix_multiply_add(b->shared->stiffness, -by, y, pull);
    if (b->shared->damping) {
        tribo_matrix_multiply_add(b->shared->damping, -1.0, y, drag);
    }
}

/* Forcing of eta by a base: -K y/(i Omega) - C y, where held contacts move the structure with velocities y; 1/i turns the real
 * part into minus the imaginary one. Velocities of belts of constant speed go to y0. 0 if out of memory, or with the status
 * of another failure in b. */
static int force_by_base(struct modal_build *b, size_t w, double *x, double *pull, double *drag)
{
    struct modal *h = b->h;
    const size_t n = b->n, m = h->modes;
    const struct harmonic *wave = &b->shared->sys->harmonic[w];
    double *const g[] = {h->gr + w * m, h->gi + w * m}, *const y[] = {b->yr + w * n, b->yi + w * n};
    int moves[2];
    for (int part = 0; part < 2; part++) {
        moves[part] = base_part(b, wave, part, x);
        if (moves[part] && !belt_velocities(b, x, y[part])) {
            return 0;
        }
    }
    if (wave->omega == 0.0) {
        tribo_add(b->y0, 1.0, y[0], n);
        b->steady |= moves[0];
        memset(y[0], 0, n * sizeof **y);
        memset(y[1], 0, n * sizeof **y);
        return 1;
    }
    for (int part = 0; part < 2; part++) {
        if (!moves[part]) {
            continue;
        }
        resist(b, y[part], (part ? 1.0 : -1.0) / wave->omega, pull, drag);
        for (size_t k = 0; k < m; k++) {
            g[1 - part][k] += tribo_dot(b->phi + k * n, pull, n);
            g[part][k] += tribo_dot(b->phi + k * n, drag, n);
        }
    }
    return 1;
}

/* What constant loads force, and belts of constant speed. */
static void force_by_constants(struct modal_build *b, double *pull, double *drag)
{
    struct modal *h = b->h;
    if (b->steady) {
        resist(b, b->y0, 1.0, pull, drag);
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
    double **const kept[] = {&h->gr, &h->gi, &h->ramp, &h->constant};
    const size_t count[] = {h->harmonics * m, h->harmonics * m, m, m};
    double *y = tribo_modal_scratch(b, 2 * velocities + b->n);
    if (!y || !tribo_modal_keep_all(b, sizeof kept / sizeof *kept, kept, count)) {
        return 0;
    }
    b->yr = y;
    b->yi = y + velocities;
    b->y0 = y + 2 * velocities;
    return 1;
}

/* Forcing of eta by each harmonic, and what the held contacts are moved by. */
int tribo_modal_forcing(struct modal_build *b)
{
    if (!list_forcing(b) || !create_forcing(b)) {
        return 0;
    }
    struct modal *h = b->h;
    const tribo_system *sys = b->shared->sys;
    const size_t m = h->modes;
    double *pull = tribo_modal_scratch(b, 2 * b->n + b->rests), *drag = pull ? pull + b->n : NULL, *x = pull ? drag + b->n : NULL;
    int done = pull != NULL;
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
            done = force_by_base(b, w, x, pull, drag);
        }
    }
    for (size_t w = sys->harmonics; done && w < h->harmonics; w++) {
        /* Forcing of eta by a limit. */
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
        /* Belts of constant speed move modes with stiffness, whose damping resists that: a constant force. Modes that damping couples all
         * have stiffness. */
        for (size_t k = 0; k < m; k++) {
            for (size_t l = h->coupling ? 0 : k; l < (h->coupling ? m : k + 1) && h->omega2[l] != 0.0; l++) {
                h->constant[k] -= (h->coupling ? h->coupling[k * m + l] : h->damping[k]) * (h->ramp[l] / h->omega2[l]);
            }
        }
    }
    return done;
}

/* Response of modes of which each has damping of its own. */
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

/* Response of modes that damping couples: real and imaginary parts are the unknowns. a [2 modes][2 modes], x [2 modes]. */
static int respond_together(struct modal_build *b, size_t w, double *a, double *x, int *pivot)
{
    struct modal *h = b->h;
    const size_t m = h->modes, size = 2 * m;
    const double omega = b->h->forcing[w].omega;
    memset(a, 0, size * size * sizeof *a);
    for (size_t k = 0; k < m; k++) {
        a[k * size + k] = a[(m + k) * size + m + k] = h->omega2[k] - omega * omega;
        for (size_t l = 0; l < m; l++) {
            a[k * size + m + l] = -omega * h->coupling[k * m + l];
            a[(m + k) * size + l] = omega * h->coupling[k * m + l];
        }
    }
    memcpy(x, h->gr + w * m, m * sizeof *x);
    memcpy(x + m, h->gi + w * m, m * sizeof *x);
    if (!(tribo_lu_create(a, size, pivot) > UNDAMPED * omega * omega)) {
        b->status = tribo_system_fail(b->shared->sys, TRIBO_ERR_UNSUPPORTED,
                                      "the harmonic of omega = %g is in resonance with an undamped mode, while damping couples "
                                      "others: take method event",
                                      omega);
        return 0;
    }
    tribo_lu_solve(a, size, pivot, x, 1);
    memcpy(h->xr + w * m, x, m * sizeof *x);
    memcpy(h->xi + w * m, x + m, m * sizeof *x);
    return 1;
}

/* Response of eta to the harmonics, (diag(omega^2) - Omega^2 + i Omega C~) x = g. */
int tribo_modal_response(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t m = h->modes, count = h->harmonics, size = h->coupling ? 2 * m : 0;
    double *kept = tribo_modal_keep(b, 2 * count * m), *a = tribo_modal_scratch(b, size * size + size);
    int *pivot = (int *)tribo_modal_scratch_indices(b, size);
    h->resonant = tribo_modal_keep_bytes(b, count * m);
    int done = kept && a && pivot && h->resonant;
    double *x = done ? a + size * size : NULL;
    h->xr = kept;
    h->xi = done ? kept + count * m : NULL;
    for (size_t w = 0; done && w < count; w++) {
        if (b->h->forcing[w].omega != 0.0 && h->coupling) {
            done = respond_together(b, w, a, x, pivot);
        } else if (b->h->forcing[w].omega != 0.0) {
            respond_alone(b, w);
        }
    }
    return done;
}
