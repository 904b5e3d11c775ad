/* SPDX-License-Identifier: BSD-3-Clause */
/* Outputs of a structure under loads: velocities and forces of contacts as sums of its terms. */
#include "parts.h"

#include <float.h>
#include <math.h>

#include "common/real.h"

/* Sets the terms: the exponents, then the harmonics. Returns 0 if out of memory. */
static int find_terms(struct modal_build *b)
{
    struct forced *f = b->forced;
    const size_t p = b->h->exponents, count = p + f->harmonics > 0 ? p + f->harmonics : 1;
    f->terms = (count + TRIBO_TERMS - 1) / TRIBO_TERMS * TRIBO_TERMS;
    f->lr = tribo_modal_take(&f->store, 4 * f->terms, sizeof *f->lr);
    if (!f->lr) {
        return 0;
    }
    f->li = f->lr + f->terms;
    f->size = f->li + f->terms;
    f->sixth = f->size + f->terms;
    for (size_t k = 0; k < p; k++) {
        f->lr[k] = b->h->lr[k];
        f->li[k] = b->h->li[k];
    }
    for (size_t s = 0; s < f->harmonics; s++) {
        f->li[p + s] = f->forcing[s].omega;
    }
    for (size_t k = 0; k < f->terms; k++) {
        f->size[k] = tribo_modal_magnitude(f->lr[k], f->li[k]);
        /* finite: times 0 it is 0 in outputs without this term */
        f->sixth[k] = lesser(f->size[k] * f->size[k] * f->size[k] * f->size[k] * f->size[k] * f->size[k], DBL_MAX);
        f->quickest = greater(f->quickest, f->size[k]);
        f->decay = greater(f->decay, -f->lr[k]);
        f->growth = greater(f->growth, f->lr[k]);
    }
    if (b->h->powers) {
        f->quickest = greater(f->quickest, tribo_powers_fastest(b->h));
    }
    return 1;
}

double complex tribo_forced_weight(const struct forced *f, size_t p, const double *place, const double *speed)
{
    const struct modal *h = f->modal;
    const size_t e = h->exponents, m = h->modes;
    const double complex lambda = f->lr[p] + f->li[p] * I;
    double complex sum = 0.0;
    if (p < e && h->owner) {
        return (place ? place[h->owner[p]] : 0.0) + (speed ? lambda * speed[h->owner[p]] : 0.0);
    }
    if (p < e) {
        const double *rr = h->rr + p * m, *ri = h->ri + p * m;
        sum += place ? tribo_dot(place, rr, m) - tribo_dot(place, ri, m) * I : 0.0;
        return sum + (speed ? lambda * (tribo_dot(speed, rr, m) - tribo_dot(speed, ri, m) * I) : 0.0);
    }
    for (size_t k = h->powers ? m : 0; k < f->shapes; k++) { /* powers of time have the response of the modes */
        sum += ((place ? place[k] : 0.0) + (speed ? lambda * speed[k] : 0.0)) * f->x[(p - e) * f->shapes + k];
    }
    return sum;
}

/* Sets *w = the output of contact i, unless it is constant and `always` is 0: N of a normal; the velocity, of a contact at rest
 * that does not hold by bases only (on of modes is 0); or the force, with the rest of the harmonics in direct, `rests` apart;
 * NULL: 0. Returns the number of outputs, 0 or 1. */
static size_t fill_output(const struct modal_build *b, size_t i, const double complex *direct, int always, struct output *w)
{
    struct forced *f = b->forced;
    const size_t e = b->h->exponents;
    const int of_normal = b->h->key[i] == KEY_APART || b->h->key[i] == KEY_PRESSED;
    const int holds = b->h->key[i] == KEY_HOLDS || of_normal;
    const double *own = f->on + i * f->shapes, *by_u = holds && !of_normal && f->by_u ? f->by_u + i * f->shapes : NULL;
    int varies = tribo_largest(own, f->shapes) > 0.0 || (by_u && tribo_largest(by_u, f->shapes) > 0.0);
    for (size_t s = 0; direct && s < f->harmonics; s++) {
        varies |= direct[s * b->h->rests] != 0.0;
    }
    double *c = varies || always ? tribo_modal_take(&f->store, 3 * f->terms, sizeof *c) : NULL;
    if (!c) {
        return 0;
    }
    *w = (struct output){i, c, c + f->terms, c + 2 * f->terms, own};
    for (size_t p = 0; varies && p < e + f->harmonics; p++) {
        const double complex z = tribo_forced_weight(f, p, holds ? own : NULL, holds ? by_u : own) +
                                 (direct && p >= e ? direct[(p - e) * b->h->rests] : 0.0);
        w->cr[p] = creal(z);
        w->ci[p] = cimag(z);
        w->size[p] = z != 0.0 ? tribo_modal_magnitude(creal(z), cimag(z)) : 0.0;
    }
    return 1;
}

/* Sets the outputs: of contacts that slide, where velocity, force or limit varies, of all normals, and of all limits that depend
 * on time. */
int tribo_forced_outputs(struct modal_build *b)
{
    struct forced *f = b->forced;
    const struct modal *h = b->h;
    const tribo_system *sys = b->sys;
    f->output = tribo_modal_take(&f->store, 2 * sys->ncontact, sizeof *f->output);
    if (!f->output || !find_terms(b)) {
        return 0;
    }
    for (int holds = 0; holds < 2; holds++) {
        f->sliding = f->outputs;
        for (size_t i = 0, p = 0; i < sys->ncontact; i++) {
            if (holds == (h->key[i] == KEY_HOLDS) && !tribo_normals_at(sys, i)) {
                const double complex *own = p < h->rests && h->rest[p] == i ? b->direct + p++ : NULL;
                const int slides = h->key[i] == KEY_FREE || h->key[i] == KEY_BACK || h->key[i] == KEY_FORTH;
                const int varies = tribo_normals_follower(sys, i) || sys->loads.limit_tables ||
                                   (sys->loads.limits && tribo_system_swing(sys, i) > 0.0);
                f->outputs += fill_output(b, i, own, slides || (holds && varies), &f->output[f->outputs]);
            }
        }
    }
    f->holding = f->outputs;
    for (size_t k = 0; k < sys->normals.count; k++) {
        f->outputs += fill_output(b, sys->normals.normal[k].row, NULL, 1, &f->output[f->outputs]);
    }
    f->limits = f->outputs;
    for (size_t i = 0; sys->loads.limits && i < sys->ncontact; i++) { /* by harmonics; the part by a table is no term */
        double *c = tribo_modal_take(&f->store, 3 * f->terms, sizeof *c);
        if (!c) {
            return 0;
        }
        for (size_t s = 0, p = h->exponents; s < sys->loads.harmonics; s++, p++) {
            const struct harmonic *w = &sys->loads.harmonic[s];
            if (w->drives == DRIVES_LIMIT && !w->knots) {
                c[p] = w->cosine[i];
                c[f->terms + p] = -w->sine[i];
                c[2 * f->terms + p] = tribo_modal_magnitude(w->cosine[i], w->sine[i]);
            }
        }
        f->output[f->outputs++] = (struct output){i, c, c + f->terms, c + 2 * f->terms, NULL};
    }
    return !f->store.failed;
}
