/* SPDX-License-Identifier: BSD-3-Clause */
/* Outputs of a structure under loads: velocities and forces of contacts as sums of its terms. */
#include "parts.h"

#include <math.h>
#include <string.h>

#include "common/real.h"

/* Sets the terms: the exponents, then the harmonics. Returns 0 if out of memory. */
static int find_terms(struct modal_build *b)
{
    struct forced *f = b->forced;
    const size_t p = f->exponents = b->h->exponents, count = p + f->harmonics > 0 ? p + f->harmonics : 1;
    f->terms = (count + TRIBO_TERMS - 1) / TRIBO_TERMS * TRIBO_TERMS;
    f->lr = tribo_modal_take(&f->store, 4 * f->terms, sizeof *f->lr);
    if (!f->lr) {
        return 0;
    }
    f->li = f->lr + f->terms;
    f->size = f->li + f->terms;
    f->sixth = f->size + f->terms;
    memcpy(f->lr, b->h->lr, p * sizeof *f->lr);
    memcpy(f->li, b->h->li, p * sizeof *f->li);
    for (size_t s = 0; s < f->harmonics; s++) {
        f->li[p + s] = f->forcing[s].omega;
    }
    for (size_t k = 0; k < f->terms; k++) {
        f->size[k] = tribo_modal_magnitude(f->lr[k], f->li[k]);
        f->sixth[k] = f->size[k] * f->size[k] * f->size[k] * f->size[k] * f->size[k] * f->size[k];
        f->fastest = greater(f->fastest, k < p ? f->size[k] : 0.0);
        f->quickest = greater(f->quickest, f->size[k]);
        f->decay = greater(f->decay, -f->lr[k]);
        f->growth = greater(f->growth, f->lr[k]);
    }
    return 1;
}

/* force [n] = minus the force by a part, cosine or -sine, of a load, or of a limit as force. load [n] is workspace. Returns 0
 * if the force is 0, or constant. */
static int force_part(const tribo_system *sys, const struct forcing *f, int part, double *load, double *force)
{
    const struct harmonic *w = &sys->loads.harmonic[f->harmonic];
    const struct matrix *j = &sys->direction;
    const double *value = part ? w->sine : w->cosine, side = part ? 1.0 : -1.0;
    const int limit = f->contact < sys->ncontact;
    const size_t first = limit ? j->first[f->contact] : 0;
    const size_t end = limit ? j->first[f->contact + 1] : w->drives == DRIVES_LOAD ? w->count : 0;
    int acts = 0;
    memset(load, 0, sys->ndof * sizeof *load);
    memset(force, 0, sys->ndof * sizeof *force);
    for (size_t e = first; e < end && f->omega != 0.0; e++) {
        const double x = limit ? j->val[e] * value[f->contact] : value[e];
        (limit ? force : load)[limit ? j->col[e] : w->index[e]] = side * x;
        acts |= x != 0.0;
    }
    if (acts && !limit) {
        tribo_system_add_mass(sys, 1.0, load, force);
    }
    return acts;
}

/* Sets direct [harmonics][rests], zero before, = forces of the rigid contacts that hold by loads and limits at fixed eta: J_I'f
 * is the part of the force of force_part that the modes leave. Returns 0 if out of memory. */
static int find_direct(struct modal_build *b, double complex *direct)
{
    const struct forced *f = b->forced;
    const struct modal *h = b->h;
    const size_t n = h->n, rests = h->rests;
    double *load = tribo_modal_scratch(b, 2 * n + h->modes + rests), *force = load ? load + n : NULL;
    for (size_t at = 0; load && at < 2 * f->harmonics; at++) {
        const int part = at % 2;
        double *work = force + n, *react = work + h->modes;
        if (force_part(b->shared->sys, &f->forcing[at / 2], part, load, force)) {
            tribo_modal_react(h, force, react, work);
            for (size_t p = 0; p < rests; p++) {
                direct[at / 2 * rests + p] += react[p] * (part ? I : 1.0);
            }
        }
    }
    return load != NULL;
}

/* Sets the output of contact i: the velocity, of a contact at rest that does not hold without modes; or the force, with the
 * rest of the harmonics in direct, `rests` apart; NULL: 0. c [3 terms] is its memory, zero before. Returns 1 if the output
 * varies. */
static int fill_output(const struct modal_build *b, size_t i, const double complex *direct, double *c, struct output *w)
{
    const struct forced *f = b->forced;
    const size_t terms = f->terms, e = f->exponents;
    const int holds = b->h->key[i] == 2, parts = b->h->key[i] == 1;
    const double *own = f->on + i * f->shapes, *by_u = holds && f->by_u ? f->by_u + i * f->shapes : b->zero;
    const double *place = holds ? own : b->zero, *speed = holds ? by_u : own;
    int varies = 0;
    *w = (struct output){i, c, c + terms, c + 2 * terms, own};
    for (size_t k = 0; k < f->shapes; k++) {
        varies |= own[k] != 0.0 || by_u[k] != 0.0;
    }
    for (size_t s = 0; direct && s < f->harmonics; s++) {
        varies |= direct[s * b->h->rests] != 0.0;
    }
    for (size_t p = 0; varies && p < e + f->harmonics; p++) {
        double complex z = p < e ? (parts ? 0.0 : tribo_modal_weight(b->h, p, place, speed))
                                 : tribo_forced_weight(f, p - e, parts ? b->h->modes : 0, place, speed);
        z += direct && p >= e ? direct[(p - e) * b->h->rests] : 0.0;
        w->cr[p] = creal(z);
        w->ci[p] = cimag(z);
        w->size[p] = z != 0.0 ? tribo_modal_magnitude(creal(z), cimag(z)) : 0.0;
    }
    return varies;
}

/* Appends the outputs of the contacts that hold, or of the others: of contacts that slide, and where velocity, force or limit
 * varies. Returns 0 if out of memory. */
static int append_outputs(struct modal_build *b, const double complex *direct, int holds)
{
    struct forced *f = b->forced;
    const struct modal *h = b->h;
    const tribo_system *sys = b->shared->sys;
    double *c = NULL;
    for (size_t i = 0, p = 0; i < sys->ncontact; i++) {
        if (holds != (h->key[i] == 2)) {
            continue;
        }
        const double complex *own = p < h->rests && h->rest[p] == i ? direct + p++ : NULL;
        c = c ? c : tribo_modal_take(&f->store, 3 * f->terms, sizeof *c);
        if (!c) {
            return 0;
        }
        if (fill_output(b, i, own, c, &f->output[f->outputs]) || h->key[i] == 0 || (holds && tribo_system_swing(sys, i) > 0.0)) {
            f->outputs++;
            c = NULL;
        }
    }
    return 1;
}

int tribo_forced_outputs(struct modal_build *b)
{
    struct forced *f = b->forced;
    const size_t count = f->harmonics * b->h->rests;
    double complex *direct = (double complex *)tribo_modal_scratch(b, 2 * count);
    f->output = tribo_modal_take(&f->store, b->shared->sys->ncontact, sizeof *f->output);
    b->zero = tribo_modal_scratch(b, f->shapes);
    if (!direct || !f->output || !b->zero || !find_terms(b) || (count && !find_direct(b, direct))) {
        return 0;
    }
    const int done = append_outputs(b, direct, 0);
    f->sliding = f->outputs;
    return done && append_outputs(b, direct, 1);
}

int tribo_forced_create(struct modal *h, const struct modal_shared *shared, const signed char *slip)
{
    struct modal_store store = {0};
    struct modal_build b = {.shared = shared, .h = h, .forced = tribo_modal_take(&store, 1, sizeof *b.forced), .slip = slip};
    if (b.forced) {
        *b.forced = (struct forced){.modal = h, .store = store};
        h->forced = b.forced;
    }
    const int done = b.forced && tribo_forced_respond(&b) && tribo_forced_outputs(&b);
    tribo_modal_give_back(&b.scratch);
    if (done) {
        return TRIBO_OK;
    }
    tribo_forced_free(h);
    return b.status ? b.status
                    : tribo_system_fail(shared->sys, TRIBO_ERR_MEMORY, "out of memory for the modes of a held structure");
}

void tribo_forced_free(struct modal *h)
{
    if (h->forced) {
        struct modal_store store = h->forced->store;
        tribo_modal_give_back(&store);
        h->forced = NULL;
    }
}
