/* A structure with contacts held, put together from parts of it that are known. */
#include "parts.h"

#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------------------ parts that are known */

/* key = the part that is listed in b. Returns its length. */
static size_t write_key(const struct modal_build *b, size_t part, const unsigned char *holds, size_t *key)
{
    const struct modal_whole *w = b->whole;
    const size_t owns = w->first_own[part + 1] - w->first_own[part];
    key[0] = owns;
    memcpy(key + 1, w->own + w->first_own[part], owns * sizeof *key);
    for (size_t i = 0; i < b->contacts; i++) {
        key[1 + owns + i] = 2 * b->contact[i] + holds[b->contact[i]];
    }
    return 1 + owns + b->contacts;
}

/* b->h = the part that is listed, which has no key. Returns a status, and leaves b->h NULL on failure. */
static int build(struct modal_build *b, const unsigned char *holds)
{
    b->h = tribo_modal_alloc();
    const int status = b->h ? tribo_modal_build(b, holds) : TRIBO_ERR_MEMORY;
    if (status) {
        tribo_modal_free(b->h);
        b->h = NULL;
    }
    return status;
}

/* *modal = what is known of a part. Returns a status. */
static int look_up(struct modal_whole *w, size_t part, const unsigned char *holds, struct modal **modal)
{
    struct modal_build b = {.whole = w};
    size_t *key = tribo_modal_scratch_indices(&b, 1 + w->sys->ndof + w->sys->ncontact);
    int status = key && tribo_modal_list(&b, part, holds) ? TRIBO_OK : TRIBO_ERR_MEMORY;
    const size_t count = status ? 0 : write_key(&b, part, holds, key);
    *modal = status ? NULL : tribo_modal_recall(&w->known, count, key);
    if (!status && !*modal) {
        status = build(&b, holds);
        status = status ? status : tribo_modal_remember(&w->known, count, key, b.h);
        *modal = b.h;
    }
    tribo_modal_unlist(&b);
    tribo_modal_empty(&w->scratch);
    return status;
}

/* -------------------------------------------------------------------------------------------------------------- put together */

/* Where something of a part stands among all. */
struct place {
    size_t mode, exponent, dof;
};

static void copy(double *to, const double *from, size_t n)
{
    memcpy(to, from, n * sizeof *to);
}

static int reserve(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t m = h->modes, e = h->exponents, s = h->harmonics;
    double **const kept[] = {&h->phi, &h->psi, &h->omega2, &h->damping, &h->ramp, &h->constant, &h->lr, &h->li, &h->ar, &h->ai,
                             &h->br,  &h->bi,  &h->gr,     &h->gi,      &h->xr,   &h->xi,       &h->yr, &h->yi, &h->y0};
    const size_t count[] = {m * h->moving, m * h->moving, m,        m, m, m, e, e, e, e, e, e, s * m, s * m, s * m, s * m,
                            s * h->moving, s * h->moving, h->moving};
    const int done = tribo_modal_keep_all(b, sizeof kept / sizeof *kept, kept, count);
    h->dof = tribo_modal_keep_indices(b, h->moving);
    h->owner = tribo_modal_keep_indices(b, e);
    h->begin = tribo_modal_keep_indices(b, m);
    h->end = tribo_modal_keep_indices(b, m);
    h->drifts = tribo_modal_keep_bytes(b, m);
    h->resonant = tribo_modal_keep_bytes(b, s * m);
    return done && h->dof && h->owner && h->begin && h->end && h->drifts && h->resonant;
}

static void put_modes(struct modal *h, const struct modal *part, const struct place *at)
{
    const size_t m = part->modes;
    memcpy(h->dof + at->dof, part->dof, part->moving * sizeof *h->dof);
    memcpy(h->drifts + at->mode, part->drifts, m);
    copy(h->omega2 + at->mode, part->omega2, m);
    copy(h->damping + at->mode, part->damping, m);
    copy(h->ramp + at->mode, part->ramp, m);
    copy(h->constant + at->mode, part->constant, m);
    for (size_t k = 0; k < m; k++) {
        h->begin[at->mode + k] = at->dof + part->begin[k];
        h->end[at->mode + k] = at->dof + part->end[k];
        copy(h->phi + (at->mode + k) * h->moving + at->dof, part->phi + k * part->moving, part->moving);
        copy(h->psi + (at->mode + k) * h->moving + at->dof, part->psi + k * part->moving, part->moving);
    }
    for (size_t s = 0; s < h->harmonics; s++) {
        const size_t to = s * h->modes + at->mode;
        copy(h->gr + to, part->gr + s * m, m);
        copy(h->gi + to, part->gi + s * m, m);
        copy(h->xr + to, part->xr + s * m, m);
        copy(h->xi + to, part->xi + s * m, m);
        memcpy(h->resonant + to, part->resonant + s * m, m);
    }
}

static void put_exponents(struct modal *h, const struct modal *part, const struct place *at)
{
    double *const to[] = {h->lr, h->li, h->ar, h->ai, h->br, h->bi};
    const double *const from[] = {part->lr, part->li, part->ar, part->ai, part->br, part->bi};
    for (size_t k = 0; k < sizeof to / sizeof *to; k++) {
        copy(to[k] + at->exponent, from[k], part->exponents);
    }
    for (size_t p = 0; p < part->exponents; p++) {
        h->owner[at->exponent + p] = at->mode + part->owner[p];
    }
    h->any_resonant |= part->any_resonant;
}

/* Adds what a part does to a contact. */
static void put_output(const struct modal *h, const struct modal *part, const struct place *at, const struct output *from,
                       struct output *to)
{
    copy(to->cr + at->exponent, from->cr, part->exponents);
    copy(to->ci + at->exponent, from->ci, part->exponents);
    copy(to->on_rate + at->mode, from->on_rate, part->modes);
    for (size_t s = 0; s < h->harmonics; s++) {
        to->rr[s] += from->rr[s];
        to->ri[s] += from->ri[s];
    }
}

/* Outputs of contacts: those that slide, and those that hold and that a part does something to; place [ncontact] is where. */
static int list_outputs(struct modal_build *b, struct modal *const *part, size_t *place)
{
    struct modal *h = b->h;
    const size_t c = b->whole->sys->ncontact;
    size_t held = 0;
    for (size_t k = 0; k < b->whole->parts; k++) {
        for (size_t o = part[k]->sliding; o < part[k]->outputs; o++) {
            held += place[part[k]->output[o].contact] == NOWHERE;
            place[part[k]->output[o].contact] = 0;
        }
    }
    for (size_t i = 0; i < c; i++) {
        h->sliding += h->key[i] == 0;
    }
    h->output = tribo_modal_keep_outputs(b, h->sliding + held);
    for (size_t which = 0; h->output && which < 2; which++) {
        for (size_t i = 0; i < c; i++) {
            if (which == 0 ? h->key[i] == 0 : place[i] == 0 && h->key[i] == 2) {
                if (!tribo_modal_create_output(b, &h->output[h->outputs], i)) {
                    return 0;
                }
                place[i] = h->outputs++;
            }
        }
    }
    return h->output != NULL;
}

static void put_outputs(const struct modal *h, const struct modal *part, const struct place *at, const size_t *place)
{
    for (size_t o = 0; o < part->outputs; o++) {
        const size_t to = place[part->output[o].contact];
        if (to != NOWHERE) {
            put_output(h, part, at, &part->output[o], &h->output[to]);
        }
    }
}

/* Adds up how much there is of everything. */
static void count(struct modal *h, size_t parts, struct modal *const *part)
{
    for (size_t k = 0; k < parts; k++) {
        h->modes += part[k]->modes;
        h->exponents += part[k]->exponents;
        h->moving += part[k]->moving;
    }
}

static void go_past(const struct modal *part, struct place *at)
{
    at->mode += part->modes;
    at->exponent += part->exponents;
    at->dof += part->moving;
}

/* The set b->h, whose key is known, from its parts. 0 if out of memory. */
static int put_together(struct modal_build *b, struct modal *const *part)
{
    struct modal *h = b->h;
    const size_t parts = b->whole->parts;
    struct place at = {0, 0, 0};
    size_t *place = b->whole->contact_place;
    count(h, parts, part);
    int done = tribo_modal_list_forcing(b) && reserve(b);
    for (size_t k = 0; done && k < parts; k++) {
        put_modes(h, part[k], &at);
        put_exponents(h, part[k], &at);
        go_past(part[k], &at);
    }
    done = done && tribo_modal_find_terms(b) && list_outputs(b, part, place);
    at = (struct place){0, 0, 0};
    for (size_t k = 0; done && k < parts; k++) {
        put_outputs(h, part[k], &at, place);
        go_past(part[k], &at);
    }
    for (size_t o = 0; done && o < h->outputs; o++) {
        tribo_modal_finish_output(h, &h->output[o]);
    }
    memset(place, 0xff, b->whole->sys->ncontact * sizeof *place);
    return done;
}

int tribo_modal_from_pieces(struct modal_build *b, const unsigned char *holds)
{
    struct modal_whole *w = b->whole;
    int status = TRIBO_OK;
    for (size_t k = 0; !status && k < w->parts; k++) {
        status = look_up(w, k, holds, &w->found[k]);
        w->divides &= status || !w->found[k]->coupling;
    }
    if (!w->divides) {
        tribo_modal_forget(&w->known);
    }
    if (status || !w->divides) {
        return status;
    }
    b->sys = w->sys;
    return put_together(b, w->found) ? TRIBO_OK : TRIBO_ERR_MEMORY;
}
