/* A part of a structure as a system of its own. */
#include "parts.h"

#include <string.h>

/* ---------------------------------------------------------------------------------------------------------- who belongs to it */

static void add_dof(struct modal_build *b, size_t d)
{
    if (b->whole->dof_place[d] == NOWHERE) {
        b->whole->dof_place[d] = b->n;
        b->dof[b->n++] = d;
    }
}

/* What has been added in ascending order but for some at the end. */
static void sort(size_t *list, size_t n)
{
    for (size_t k = 1; k < n; k++) {
        const size_t x = list[k];
        size_t to = k;
        for (; to > 0 && list[to - 1] > x; to--) {
            list[to] = list[to - 1];
        }
        list[to] = x;
    }
}

/* Its own degrees of freedom, and those beside them: walls that feel it. */
static void list_dofs(struct modal_build *b, size_t owns, const size_t *own)
{
    struct modal_whole *w = b->whole;
    for (size_t k = 0; k < owns; k++) {
        w->ours[own[k]] = 1;
        add_dof(b, own[k]);
    }
    for (size_t k = 0; k < owns; k++) {
        const size_t d = own[k];
        for (size_t e = w->first[d]; w->how[d] != MOVES_HELD && e < w->first[d + 1]; e++) {
            add_dof(b, w->beside[e]);
        }
    }
    sort(b->dof, b->n);
    for (size_t d = 0; d < b->n; d++) {
        w->dof_place[b->dof[d]] = d;
    }
}

static void add_contact(struct modal_build *b, size_t i)
{
    if (b->whole->contact_place[i] == NOWHERE) {
        b->whole->contact_place[i] = b->contacts;
        b->contact[b->contacts++] = i;
    }
}

/* Contacts that hold what is listed, and others of its own. Of one part that is all, also those that touch nothing. */
static void list_contacts(struct modal_build *b, const unsigned char *holds)
{
    struct modal_whole *w = b->whole;
    for (size_t k = 0; k < b->n; k++) {
        const size_t d = b->dof[k];
        for (size_t e = w->first_contact[d]; e < w->first_contact[d + 1]; e++) {
            if (holds[w->contact[e]] || w->ours[d]) {
                add_contact(b, w->contact[e]);
            }
        }
    }
    for (size_t i = 0; !w->divides && i < w->sys->ncontact; i++) {
        if (w->sys->direction.first[i] == w->sys->direction.first[i + 1]) {
            add_contact(b, i);
        }
    }
    sort(b->contact, b->contacts);
    for (size_t i = 0; i < b->contacts; i++) {
        w->contact_place[b->contact[i]] = i;
    }
}

int tribo_modal_list(struct modal_build *b, size_t part, const unsigned char *holds)
{
    struct modal_whole *w = b->whole;
    const size_t *own = w->own + w->first_own[part], owns = w->first_own[part + 1] - w->first_own[part];
    b->n = b->contacts = 0;
    b->dof = tribo_modal_scratch_indices(b, w->sys->ndof);
    b->contact = tribo_modal_scratch_indices(b, w->sys->ncontact);
    if (!b->dof || !b->contact) {
        return 0;
    }
    b->owns = owns;
    list_dofs(b, owns, own);
    list_contacts(b, holds);
    return 1;
}

void tribo_modal_unlist(struct modal_build *b)
{
    struct modal_whole *w = b->whole;
    for (size_t d = 0; d < b->n; d++) {
        w->ours[b->dof[d]] = 0;
        w->dof_place[b->dof[d]] = NOWHERE;
    }
    for (size_t i = 0; i < b->contacts; i++) {
        w->contact_place[b->contact[i]] = NOWHERE;
    }
}

/* ------------------------------------------------------------------------------------------------------- what goes with them */

/* to = these rows of a matrix, and the columns of the part. Without what would speed up products. */
static int extract(struct modal_build *b, const struct matrix *from, size_t rows, const size_t *row, struct matrix *to)
{
    const size_t *place = b->whole->dof_place;
    size_t room = 0, count = 0;
    for (size_t i = 0; i < rows; i++) {
        room += from->first[row[i] + 1] - from->first[row[i]];
    }
    *to = (struct matrix){.rows = rows,
                          .cols = b->n,
                          .first = tribo_modal_scratch_indices(b, rows + 2),
                          .col = tribo_modal_scratch_indices(b, room),
                          .val = tribo_modal_scratch(b, room)};
    if (!to->first || !to->col || !to->val) {
        return 0;
    }
    for (size_t i = 0; i < rows; i++) {
        for (size_t k = from->first[row[i]]; k < from->first[row[i] + 1]; k++) {
            if (place[from->col[k]] != NOWHERE) {
                to->col[count] = place[from->col[k]];
                to->val[count++] = from->val[k];
            }
        }
        to->first[i + 1] = count;
    }
    return 1;
}

/* The entries of a harmonic that belong to the part: loads on its own degrees of freedom, bases of its contacts. */
static int extract_entries(struct modal_build *b, struct harmonic *h)
{
    const struct modal_whole *w = b->whole;
    const struct harmonic from = *h;
    const size_t *place = h->drives == DRIVES_BASE ? w->contact_place : w->dof_place;
    h->count = 0;
    h->index = tribo_modal_scratch_indices(b, from.count);
    h->cosine = tribo_modal_scratch(b, from.count);
    h->sine = tribo_modal_scratch(b, from.count);
    if (!h->index || !h->cosine || !h->sine) {
        return 0;
    }
    for (size_t k = 0; k < from.count; k++) {
        if (place[from.index[k]] != NOWHERE && (h->drives == DRIVES_BASE || w->ours[from.index[k]])) {
            h->index[h->count] = place[from.index[k]];
            h->cosine[h->count] = from.cosine[k];
            h->sine[h->count++] = from.sine[k];
        }
    }
    return 1;
}

/* Limits have an entry for each contact. */
static int extract_limits(struct modal_build *b, struct harmonic *h)
{
    const struct harmonic from = *h;
    h->cosine = tribo_modal_scratch(b, b->contacts);
    h->sine = tribo_modal_scratch(b, b->contacts);
    for (size_t i = 0; h->cosine && h->sine && i < b->contacts; i++) {
        h->cosine[i] = from.cosine[b->contact[i]];
        h->sine[i] = from.sine[b->contact[i]];
    }
    return h->cosine && h->sine;
}

static int extract_harmonics(struct modal_build *b, tribo_system *part)
{
    part->harmonic = tribo_modal_scratch_harmonics(b, part->harmonics);
    int done = part->harmonic != NULL;
    for (size_t k = 0; done && k < part->harmonics; k++) {
        part->harmonic[k] = b->whole->sys->harmonic[k];
        done = part->harmonic[k].drives == DRIVES_LIMIT ? extract_limits(b, &part->harmonic[k])
                                                        : extract_entries(b, &part->harmonic[k]);
    }
    return done;
}

static int extract_massless(struct modal_build *b, tribo_system *part)
{
    const struct massless *from = &b->whole->sys->massless;
    part->massless.is = from->count ? tribo_modal_scratch_bytes(b, b->n) : NULL;
    for (size_t d = 0; part->massless.is && d < b->n; d++) {
        part->massless.is[d] = from->is[b->dof[d]];
    }
    return part->massless.is || !from->count;
}

static int extract_system(struct modal_build *b)
{
    const struct modal_whole *w = b->whole;
    tribo_system *part = tribo_modal_scratch_system(b);
    if (!part) {
        return 0;
    }
    *part = *w->sys;
    part->ndof = b->n;
    part->ncontact = b->contacts;
    b->sys = part;
    b->stiffness = &b->own_stiffness;
    b->damping = w->damping ? &b->own_damping : NULL;
    return extract(b, &w->sys->direction, b->contacts, b->contact, &part->direction) &&
           (!w->sys->mass.rows || extract(b, &w->sys->mass, b->n, b->dof, &part->mass)) &&
           extract(b, w->stiffness, b->n, b->dof, &b->own_stiffness) &&
           (!w->damping || extract(b, w->damping, b->n, b->dof, &b->own_damping)) && extract_massless(b, part) &&
           extract_harmonics(b, part);
}

int tribo_modal_extract(struct modal_build *b)
{
    const struct modal_whole *w = b->whole;
    b->sys = w->sys;
    b->stiffness = w->stiffness;
    b->damping = w->damping;
    return b->owns == w->sys->ndof || extract_system(b);
}
