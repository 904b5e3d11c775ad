/* SPDX-License-Identifier: BSD-3-Clause */
/* A structure under loads: shapes by bases, forcing of the modes, and response of the modes. */
#include "parts.h"
#include "common/real.h"
#include "numerics/lapack.h"

#include <math.h>
#include <string.h>

/* |omega^2 - Omega^2 + i Omega damping|/omega^2 below which the closed form with a small divisor is not used: a response much
 * larger than the motion loses digits. */
#define RESONANCE 1e-2

/* |lambda - i Omega|/Omega down to which the response of coupled modes keeps enough digits. */
#define UNDAMPED 1e-9

/* The same where K~ is not symmetric. */
#define NEAR_RESONANCE 1e-5

/* ------------------------------------------------------------------------------------------------------- shapes by bases */

/* Makes room for shapes: one for each part of a harmonic of bases, one for bases of constant speed, and one for each table.
 * Without such shapes phi, on and by_u are arrays of the modal. Returns 0 if out of memory. */
static int make_shapes(struct modal_build *b)
{
    struct forced *f = b->forced;
    const struct modal *h = b->h;
    const tribo_system *sys = b->sys;
    const size_t n = tribo_modal_wide(h->within), m = h->modes, c = sys->ncontact;
    f->shapes = m;
    for (size_t s = 0; s < sys->loads.harmonics; s++) {
        const struct harmonic *w = &sys->loads.harmonic[s];
        f->shapes += w->drives != DRIVES_BASE ? 0 : w->omega != 0.0 ? 2 : 1;
    }
    for (size_t s = 0; s < f->harmonics; s++) {
        const struct harmonic *w = &sys->loads.harmonic[f->forcing[s].harmonic];
        const int table = w->knots && w->drives != DRIVES_BASE;
        f->shapes += (size_t)table;
        f->forcing[s].table = table ? f->shapes : 0;
    }
    f->speed = tribo_modal_take(&f->store, f->shapes, sizeof *f->speed);
    f->x = tribo_modal_take(&f->store, f->harmonics * f->shapes, sizeof *f->x);
    f->within[0] = f->shapes > m ? 0 : h->within[0];
    f->within[1] = f->shapes > m ? sys->ndof : h->within[1];
    double *const own[] = {h->phi, h->on, h->by_u}, **const to[] = {&f->phi, &f->on, &f->by_u};
    for (size_t k = 0; k < 3; k++) {
        const size_t rows = k ? c : f->shapes, wide = k ? f->shapes : tribo_modal_wide(f->within), each = k ? m : n;
        const int grows = f->shapes > m && own[k];
        *to[k] = grows ? tribo_modal_take(&f->store, rows * wide, sizeof **to[k]) : own[k];
        for (size_t i = 0; grows && *to[k] && i < (k ? c : m); i++) {
            memcpy(*to[k] + i * wide + (k ? 0 : h->within[0]), own[k] + i * each, each * sizeof **to[k]);
        }
    }
    return !f->store.failed;
}

/* Sets shape k, velocities y with J_I y = b_I, b = base [ncontact], and Phi'M y = 0, and what it does at contacts and to the
 * modes: place, rate [modes], forcing of eta per displacement, and per velocity of the shape. By Maxwell and Betti, phi'(K y -
 * J'f') is the sum of b_i times the force of contact i per eta over the contacts that hold, if no force follows the motion. */
static void follow_base(struct modal_build *b, size_t k, double omega, const double *base, double *place, double *rate)
{
    struct forced *f = b->forced;
    const struct modal *h = b->h;
    const size_t n = b->sys->ndof, m = h->modes, c = b->sys->ncontact, wide = tribo_modal_wide(h->within);
    const double omega2 = omega * omega;
    double *drag = tribo_modal_take(&b->scratch, n + 3 * c + m, sizeof *drag), *x = drag + n, *on = x + c, *by_u = on + c;
    double *y = f->phi + k * n;
    if (!drag) {
        return;
    }
    b->push = by_u + c;
    for (size_t p = 0; p < h->rests; p++) {
        x[p] = base[h->rest[p]];
    }
    tribo_constraints_follow(&h->ties, x, y);
    memset(place, 0, m * sizeof *place);
    memset(rate, 0, m * sizeof *rate);
    tribo_multiply_add(m, wide, 1, 1.0, h->psi, y + h->within[0], place);
    for (size_t l = 0; l < m; l++) {
        tribo_add(y + h->within[0], -place[l], h->phi + l * wide, wide);
        place[l] = 0.0;
    }
    tribo_matrix_multiply(&b->sys->mass, y, drag);
    tribo_matrix_multiply(&b->sys->direction, y, on);
    tribo_modal_effects(b, 1, y, drag, &omega2, base, on, f->by_u ? by_u : NULL);
    memcpy(place, b->push, b->follows ? m * sizeof *place : 0);
    for (size_t i = 0; i < c; i++) {
        tribo_add(place, h->key[i] == KEY_HOLDS && !b->follows ? -base[i] : 0.0, h->on + i * m, m);
        f->on[i * f->shapes + k] = on[i];
        if (f->by_u) {
            f->by_u[i * f->shapes + k] = by_u[i];
        }
    }
    if (b->c) {
        memset(drag, 0, n * sizeof *drag);
        tribo_matrix_multiply_add(b->c, -1.0, y, drag);
        tribo_multiply_add(m, wide, 1, 1.0, h->phi, drag + h->within[0], rate);
    }
}

/* Sets the shapes, of bases Re((c - i s) e^{i Omega t}) by c and by -s, with the forcing of the modes by these, and eta of these.
 * Returns 0 if out of memory. */
static int follow_bases(struct modal_build *b)
{
    struct forced *f = b->forced;
    const struct modal *h = b->h;
    const tribo_system *sys = b->sys;
    const size_t m = h->modes, c = sys->ncontact;
    double *base = tribo_modal_take(&b->scratch, c + 2 * m, sizeof *base);
    if (!base || !make_shapes(b)) {
        return 0;
    }
    double *place = base + c, *rate = place + m;
    for (size_t at = 0, k = m; at < 2 * sys->loads.harmonics; at++) {
        const struct harmonic *w = &sys->loads.harmonic[at / 2];
        const int part = at % 2;
        const double complex unit = part ? I : 1.0, along = part ? 1.0 : -I; /* along = unit/i */
        if (w->drives != DRIVES_BASE || (part && w->omega == 0.0)) {
            continue;
        }
        memset(base, 0, c * sizeof *base);
        for (size_t e = 0; e < w->count; e++) {
            base[w->index[e]] = part ? -w->sine[e] : w->cosine[e];
        }
        follow_base(b, k, w->omega, base, place, rate);
        if (w->knots) {
            f->forcing[at / 2].table = k + 1;
        } else if (w->omega == 0.0) {
            f->steady = 1;
            f->speed[k] = 1.0;
            tribo_add(f->ramp, 1.0, place, m);
            tribo_add(f->constant, 1.0, rate, m);
        } else {
            f->x[at / 2 * f->shapes + k] = along / w->omega;
        }
        for (size_t l = 0; (w->knots || w->omega != 0.0) && l < m; l++) {
            f->g[at / 2 * m + l] += w->knots ? place[l] + rate[l] * I : place[l] / w->omega * along + rate[l] * unit;
        }
        k++;
    }
    return !b->scratch.failed;
}

/* ------------------------------------------------------------------------------------------------- forcing and response */

/* Adds to g the forcing of eta by forcing s: a load, or a limit as force f = limit. Adds the forces of contacts that hold, by the
 * part of the load beside the modes, to direct; of a table, to `on` of its shape. work [2 n + modes + rests]. */
static void force_modes(struct modal_build *b, size_t s, double *work)
{
    struct forced *f = b->forced;
    const struct modal *h = b->h;
    const tribo_system *sys = b->sys;
    const struct matrix *j = &sys->direction;
    const size_t n = sys->ndof, all[] = {0, n}, m = h->modes, i = f->forcing[s].contact;
    const struct harmonic *w = &sys->loads.harmonic[f->forcing[s].harmonic];
    double *load = work, *force = load + n, *by = force + n, *react = by + m;
    for (int part = 0; part < 2; part++) {
        const double *value = part ? w->sine : w->cosine;
        const double complex unit = part ? -I : 1.0;
        const double loads = w->drives == DRIVES_LOAD ? tribo_largest(value, w->count) : 0.0;
        if ((i < sys->ncontact ? fabs(value[i]) : loads) == 0.0) {
            continue;
        }
        memset(work, 0, 2 * n * sizeof *work);
        if (i < sys->ncontact) {
            tribo_matrix_add_row(j, i, -value[i], force);
        } else {
            for (size_t e = 0; e < w->count; e++) {
                load[w->index[e]] = -value[e];
            }
            tribo_matrix_multiply_add(&sys->mass, 1.0, load, force);
        }
        tribo_modal_react(h, all, 1, force, react, by);
        for (size_t k = 0; k < m; k++) {
            f->g[s * m + k] += unit * by[k];
        }
        for (size_t p = 0; w->omega != 0.0 && p < h->rests; p++) {
            b->direct[s * h->rests + p] += unit * react[p];
        }
        for (size_t p = 0; f->forcing[s].table && p < h->rests; p++) {
            f->on[h->rest[p] * f->shapes + f->forcing[s].table - 1] += react[p];
        }
    }
}

/* Sets the response of modes without coupling, and resonant. */
static int respond_alone(struct modal_build *b)
{
    struct forced *f = b->forced;
    const struct modal *h = b->h;
    int any = 0;
    f->resonant = tribo_modal_take(&f->store, f->harmonics * h->modes, 1);
    for (size_t at = 0; f->resonant && at < f->harmonics * h->modes; at++) {
        const size_t s = at / h->modes, k = at % h->modes;
        const double omega = f->forcing[s].omega, gr = creal(f->g[at]), gi = cimag(f->g[at]);
        const double re = h->omega2[k] - omega * omega, im = omega * h->damping[k], square = re * re + im * im;
        const int forced = omega != 0.0 && (gr != 0.0 || gi != 0.0);
        f->resonant[at] = forced && sqrt(square) < RESONANCE * fabs(h->omega2[k]);
        any |= f->resonant[at];
        f->resonates = f->resonant[at] ? greater(f->resonates, fabs(omega)) : f->resonates;
        if (!f->resonant[at] && forced) {
            f->x[s * f->shapes + k] = (gr * re + gi * im) / square + (gi * re - gr * im) / square * I;
        }
    }
    const int done = f->resonant != NULL;
    f->resonant = any ? f->resonant : NULL;
    return done;
}

/* Sets the response of coupled modes to all harmonics, by LU factors. Returns 0 on failure. */
static int respond_together(struct modal_build *b)
{
    struct forced *f = b->forced;
    const struct modal *h = b->h;
    const size_t m = h->modes;
    const int rows = (int)m, one = 1;
    double complex *a = tribo_modal_take(&b->scratch, m * m, sizeof *a);
    int *pivot = tribo_modal_take(&b->scratch, m, sizeof *pivot), info = 0;
    for (size_t s = 0; a && pivot && s < f->harmonics; s++) {
        const double omega = f->forcing[s].omega;
        double complex *x = f->x + s * f->shapes;
        int known = 1;
        if (omega == 0.0 || m == 0) {
            continue;
        }
        for (size_t p = 0; p < h->exponents; p++) {
            known &= hypot(h->lr[p], fabs(h->li[p]) - fabs(omega)) > (h->stiff ? NEAR_RESONANCE : UNDAMPED) * fabs(omega);
        }
        for (size_t k = 0; k < m; k++) {
            x[k] = f->g[s * m + k];
            for (size_t l = 0; l < m; l++) {
                const double stiff = h->stiff ? h->stiff[k * m + l] : k == l ? h->omega2[k] : 0.0;
                a[l * m + k] = stiff - (k == l ? omega * omega : 0.0) + omega * h->coupling[k * m + l] * I;
            }
        }
        zgesv_(&rows, &one, a, &rows, pivot, x, &rows, &info);
        if (!known || info != 0) {
            b->status = tribo_error(b->sys->message, TRIBO_ERR_UNSUPPORTED,
                                    "the harmonic of omega = %g is in resonance with an undamped mode, while damping couples "
                                    "others: take method event",
                                    omega);
            return 0;
        }
    }
    return a && pivot;
}

int tribo_forced_respond(struct modal_build *b)
{
    struct forced *f = b->forced;
    const struct modal *h = b->h;
    const tribo_system *sys = b->sys;
    const size_t m = h->modes, c = sys->ncontact;
    f->harmonics = sys->loads.harmonics;
    f->forcing = tribo_modal_take(&f->store, f->harmonics + sys->loads.limits * (c - h->rests), sizeof *f->forcing);
    for (size_t k = 0; f->forcing && k < sys->loads.harmonics; k++) {
        const struct harmonic *w = &sys->loads.harmonic[k];
        f->forcing[k] = (struct forcing){w->omega, k, c, 0};
        for (size_t i = 0; w->drives == DRIVES_LIMIT && (w->omega != 0.0 || w->knots) && i < c; i++) {
            const int follows = w->knots && (tribo_normals_at(sys, i) || tribo_normals_follower(sys, i));
            if (h->key[i] != KEY_HOLDS && !follows && (w->cosine[i] != 0.0 || w->sine[i] != 0.0)) {
                f->forcing[f->harmonics++] = (struct forcing){w->omega, k, i, 0};
            }
        }
    }
    f->g = tribo_modal_take(&f->store, f->harmonics * m, sizeof *f->g);
    f->ramp = tribo_modal_take(&f->store, 2 * m, sizeof *f->ramp);
    f->constant = f->ramp ? f->ramp + m : NULL;
    b->direct = tribo_modal_take(&b->scratch, f->harmonics * h->rests, sizeof *b->direct);
    double *work = tribo_modal_take(&b->scratch, 2 * sys->ndof + m + h->rests, sizeof *work);
    if (f->store.failed || b->scratch.failed || !follow_bases(b)) {
        return 0;
    }
    for (size_t s = 0; s < f->harmonics; s++) {
        force_modes(b, s, work);
    }
    /* With bases of constant speed modes of omega != 0 have eta' = ramp/omega^2; damping of eta' is a constant force. Modes that
     * damping couples all have omega != 0. */
    if (h->stiff && !tribo_follow_ramps(b)) {
        return 0;
    }
    for (size_t k = 0; k < m && !h->stiff; k++) {
        for (size_t s = 0; s < sys->loads.harmonics; s++) {
            const int steady = f->forcing[s].omega == 0.0 && !f->forcing[s].table;
            f->constant[k] += steady ? creal(f->g[s * m + k]) : 0.0;
        }
        for (size_t l = h->coupling ? 0 : k; l < (h->coupling ? m : k + 1) && h->omega2[l] != 0.0; l++) {
            f->constant[k] -= (h->coupling ? h->coupling[k * m + l] : h->damping[k]) * (f->ramp[l] / h->omega2[l]);
        }
    }
    return h->powers ? 1 : h->coupling ? respond_together(b) : respond_alone(b);
}
