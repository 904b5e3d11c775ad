#include "modal_parts.h"

#include <stdlib.h>
#include <string.h>

void tribo_modal_whole_free(struct modal_whole *w)
{
    tribo_matrix_free(&w->own_stiffness);
    tribo_matrix_free(&w->own_damping);
    tribo_modal_give_back(w->scratch);
    free(w->first);
    free(w->beside);
    free(w->alone);
    free(w->always);
    memset(w, 0, sizeof *w);
}

/* ------------------------------------------------------------------------------------------------------------------- matrices */

/* K or C: as given, or M times what accelerates. */
static const struct matrix *force_matrix(const tribo_system *sys, const struct matrix *given, const struct matrix *accelerates,
                                         struct matrix *own)
{
    if (given->rows || !sys->mass.rows) {
        return given->rows ? given : accelerates;
    }
    double *mass = malloc(sys->ndof * sizeof *mass);
    for (size_t d = 0; mass && d < sys->ndof; d++) {
        mass[d] = tribo_matrix_get(&sys->mass, d, d);
    }
    const int done = mass && tribo_matrix_copy(own, accelerates);
    if (done) {
        tribo_matrix_scale_rows(own, mass);
    }
    free(mass);
    return done ? own : NULL;
}

static int find_forces(struct modal_whole *w)
{
    const tribo_system *sys = w->sys;
    w->stiffness = force_matrix(sys, &sys->elastic, &sys->stiffness, &w->own_stiffness);
    w->damping = sys->damping.rows ? force_matrix(sys, &sys->viscous, &sys->damping, &w->own_damping) : NULL;
    return w->stiffness && (w->damping || !sys->damping.rows);
}

static size_t entries(const struct matrix *a)
{
    return a && a->rows ? a->first[a->rows] : 0;
}

/* Appends to the list of those beside d whom a has there. seen [ndof] is d + 1 for those that the list has. */
static void list_beside(struct modal_whole *w, const struct matrix *a, size_t d, size_t *seen)
{
    for (size_t k = a && a->rows ? a->first[d] : 0; a && a->rows && k < a->first[d + 1]; k++) {
        if (a->val[k] != 0.0 && seen[a->col[k]] != d + 1) {
            seen[a->col[k]] = d + 1;
            w->beside[w->first[d + 1]++] = a->col[k];
        }
    }
}

static int find_beside(struct modal_whole *w)
{
    const size_t n = w->sys->ndof;
    const struct matrix *const shared[] = {w->stiffness, w->damping, &w->sys->mass};
    w->first = calloc(n + 1, sizeof *w->first);
    w->beside = malloc((entries(shared[0]) + entries(shared[1]) + entries(shared[2]) + 1) * sizeof *w->beside);
    size_t *seen = calloc(n, sizeof *seen);
    const int done = w->first && w->beside && seen;
    for (size_t d = 0; done && d < n; d++) {
        seen[d] = d + 1;
        w->first[d + 1] = w->first[d];
        for (size_t k = 0; k < 3; k++) {
            list_beside(w, shared[k], d, seen);
        }
    }
    free(seen);
    return done;
}

/* ------------------------------------------------------------------------------------------------------- what happens to them */

/* The degree of freedom of contact i if it has but one, else ndof. */
static size_t only_one(const struct matrix *j, size_t i)
{
    size_t found = j->cols, count = 0;
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        if (j->val[k] != 0.0) {
            found = j->col[k];
            count++;
        }
    }
    return count == 1 ? found : j->cols;
}

static void note(struct modal_whole *w, size_t d, int and_beside)
{
    w->always[d] = 1;
    for (size_t k = w->first[d]; and_beside && k < w->first[d + 1]; k++) {
        w->always[w->beside[k]] = 1;
    }
}

static void note_contact(struct modal_whole *w, size_t i, int and_beside)
{
    const struct matrix *j = &w->sys->direction;
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        note(w, j->col[k], and_beside);
    }
}

/* What a harmonic changes: with a load, forces on what shares mass with the loaded; with a base, all that its motion strains. */
static void note_harmonic(struct modal_whole *w, const struct harmonic *h, int shares_mass)
{
    for (size_t k = 0; h->drives == DRIVES_LOAD && h->omega != 0.0 && k < h->count; k++) {
        note(w, h->index[k], shares_mass);
    }
    for (size_t k = 0; h->drives == DRIVES_BASE && k < h->count; k++) {
        note_contact(w, h->index[k], 1);
    }
    for (size_t i = 0; h->drives == DRIVES_LIMIT && i < w->sys->ncontact; i++) {
        if (h->cosine[i] != 0.0 || h->sine[i] != 0.0) {
            note_contact(w, i, 0);
        }
    }
}

static int find_events(struct modal_whole *w)
{
    const tribo_system *sys = w->sys;
    w->alone = malloc((sys->ncontact + 1) * sizeof *w->alone);
    w->always = calloc(sys->ndof, 1);
    if (!w->alone || !w->always) {
        return 0;
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        w->alone[i] = only_one(&sys->direction, i);
    }
    const int shares_mass = sys->mass.rows && !tribo_matrix_is_diagonal(&sys->mass);
    for (size_t k = 0; k < sys->harmonics; k++) {
        note_harmonic(w, &sys->harmonic[k], shares_mass);
    }
    return 1;
}

int tribo_modal_whole_create(struct modal_whole *w, tribo_system *sys)
{
    *w = (struct modal_whole){.sys = sys};
    return find_forces(w) && find_beside(w) && find_events(w)
               ? TRIBO_OK
               : tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the matrices of a structure to be held");
}

/* ------------------------------------------------------------------------------------------------------- what is to be looked at */

/* How degrees of freedom move: freely, as the base of the one contact that holds them, or as contacts make them that tie them
 * together, or are too many. */
enum { FREE, HELD, TIED };

static void hold(const struct modal_whole *w, size_t i, unsigned char *how)
{
    const struct matrix *j = &w->sys->direction;
    const size_t d = w->alone[i];
    if (d < w->sys->ndof) {
        how[d] = how[d] == FREE ? HELD : TIED;
        return;
    }
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        how[j->col[k]] = j->val[k] != 0.0 ? TIED : how[j->col[k]];
    }
}

/* inside [ndof] = 1 for what may move, what is beside that, and the degrees of freedom of contacts that do not hold. */
static void look_around(const struct modal_whole *w, const unsigned char *holds, const unsigned char *how, unsigned char *inside)
{
    const struct matrix *j = &w->sys->direction;
    memcpy(inside, w->always, w->sys->ndof);
    for (size_t d = 0; d < w->sys->ndof; d++) {
        inside[d] |= how[d] != HELD;
        for (size_t k = w->first[d]; how[d] != HELD && k < w->first[d + 1]; k++) {
            inside[w->beside[k]] = 1;
        }
    }
    for (size_t i = 0; i < w->sys->ncontact; i++) {
        for (size_t k = j->first[i]; !holds[i] && k < j->first[i + 1]; k++) {
            inside[j->col[k]] = 1;
        }
    }
}

/* Lists those inside, place [all] being where they are listed, or `all`. Returns how many they are. */
static size_t list(const unsigned char *inside, size_t all, size_t *listed, size_t *place)
{
    size_t count = 0;
    for (size_t k = 0; k < all; k++) {
        place[k] = all;
        if (inside[k]) {
            place[k] = count;
            listed[count++] = k;
        }
    }
    return count;
}

/* to = these rows of a matrix, and the columns that have a place among so many. Without what would speed up products. */
static int extract(struct modal_build *b, const struct matrix *from, size_t rows, const size_t *row, size_t cols,
                   const size_t *place, struct matrix *to)
{
    size_t room = 0, count = 0;
    for (size_t i = 0; i < rows; i++) {
        room += from->first[row[i] + 1] - from->first[row[i]];
    }
    *to = (struct matrix){.rows = rows,
                          .cols = cols,
                          .first = tribo_modal_scratch_indices(b, rows + 2),
                          .col = tribo_modal_scratch_indices(b, room),
                          .val = tribo_modal_scratch(b, room)};
    if (!to->first || !to->col || !to->val) {
        return 0;
    }
    for (size_t i = 0; i < rows; i++) {
        for (size_t k = from->first[row[i]]; k < from->first[row[i] + 1]; k++) {
            if (place[from->col[k]] < cols) {
                to->col[count] = place[from->col[k]];
                to->val[count++] = from->val[k];
            }
        }
        to->first[i + 1] = count;
    }
    return 1;
}

/* The entries of a harmonic whose degrees of freedom, or contacts, have a place among so many. */
static int extract_entries(struct modal_build *b, struct harmonic *h, size_t inside, const size_t *place)
{
    const struct harmonic from = *h;
    h->count = 0;
    h->index = tribo_modal_scratch_indices(b, from.count);
    h->cosine = tribo_modal_scratch(b, from.count);
    h->sine = tribo_modal_scratch(b, from.count);
    if (!h->index || !h->cosine || !h->sine) {
        return 0;
    }
    for (size_t k = 0; k < from.count; k++) {
        if (place[from.index[k]] < inside) {
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
    h->cosine = tribo_modal_scratch(b, b->part.ncontact);
    h->sine = tribo_modal_scratch(b, b->part.ncontact);
    for (size_t i = 0; h->cosine && h->sine && i < b->part.ncontact; i++) {
        h->cosine[i] = from.cosine[b->contact[i]];
        h->sine[i] = from.sine[b->contact[i]];
    }
    return h->cosine && h->sine;
}

static int extract_harmonics(struct modal_build *b, const size_t *dof_place, const size_t *contact_place)
{
    tribo_system *sys = &b->part;
    sys->harmonic = tribo_modal_scratch_harmonics(b, sys->harmonics);
    int done = sys->harmonic != NULL;
    for (size_t k = 0; done && k < sys->harmonics; k++) {
        struct harmonic *h = &sys->harmonic[k];
        *h = b->whole->sys->harmonic[k];
        done = h->drives == DRIVES_LIMIT  ? extract_limits(b, h)
               : h->drives == DRIVES_BASE ? extract_entries(b, h, sys->ncontact, contact_place)
                                          : extract_entries(b, h, sys->ndof, dof_place);
    }
    return done;
}

/* The degrees of freedom inside, and the contacts there, with their matrices and harmonics, as a system of its own. */
static int extract_part(struct modal_build *b, const size_t *dof_place, const size_t *contact_place)
{
    const struct modal_whole *w = b->whole;
    const tribo_system *sys = w->sys;
    const size_t n = b->part.ndof, c = b->part.ncontact;
    b->part.massless.is = sys->massless.count ? tribo_modal_scratch_bytes(b, n) : NULL;
    for (size_t d = 0; b->part.massless.is && d < n; d++) {
        b->part.massless.is[d] = sys->massless.is[b->dof[d]];
    }
    return (b->part.massless.is || !sys->massless.count) &&
           extract(b, &sys->direction, c, b->contact, n, dof_place, &b->part.direction) &&
           (!sys->mass.rows || extract(b, &sys->mass, n, b->dof, n, dof_place, &b->part.mass)) &&
           extract(b, w->stiffness, n, b->dof, n, dof_place, &b->own_stiffness) &&
           (!w->damping || extract(b, w->damping, n, b->dof, n, dof_place, &b->own_damping)) &&
           extract_harmonics(b, dof_place, contact_place);
}

/* Lists what is inside, and looks at the whole if that is all of it. */
static int divide(struct modal_build *b, const unsigned char *inside, const unsigned char *holds, unsigned char *counts)
{
    const struct modal_whole *w = b->whole;
    const size_t n = w->sys->ndof, c = w->sys->ncontact;
    size_t *dof_place = tribo_modal_scratch_indices(b, n), *contact_place = tribo_modal_scratch_indices(b, c);
    b->dof = tribo_modal_scratch_indices(b, n);
    b->contact = tribo_modal_scratch_indices(b, c);
    if (!dof_place || !contact_place || !b->dof || !b->contact) {
        return 0;
    }
    for (size_t i = 0; i < c; i++) {
        counts[i] = !holds[i] || w->alone[i] == n || inside[w->alone[i]];
    }
    b->part = *w->sys;
    b->part.ndof = list(inside, n, b->dof, dof_place);
    b->part.ncontact = list(counts, c, b->contact, contact_place);
    b->stiffness = w->stiffness;
    b->damping = w->damping;
    if (b->part.ndof == n) {
        return 1;
    }
    b->stiffness = &b->own_stiffness;
    b->damping = w->damping ? &b->own_damping : NULL;
    return extract_part(b, dof_place, contact_place);
}

int tribo_modal_divide(struct modal_build *b, const unsigned char *holds)
{
    const struct modal_whole *w = b->whole;
    const size_t n = w->sys->ndof, c = w->sys->ncontact;
    unsigned char *how = tribo_modal_scratch_bytes(b, n), *inside = tribo_modal_scratch_bytes(b, n);
    unsigned char *counts = tribo_modal_scratch_bytes(b, c);
    if (!how || !inside || !counts) {
        return 0;
    }
    for (size_t i = 0; i < c; i++) {
        if (holds[i]) {
            hold(w, i, how);
        }
    }
    look_around(w, holds, how, inside);
    return divide(b, inside, holds, counts);
}
