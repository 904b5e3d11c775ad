#include "parts.h"

#include <stdlib.h>
#include <string.h>

void tribo_modal_whole_free(struct modal_whole *w)
{
    tribo_matrix_free(&w->own_stiffness);
    tribo_matrix_free(&w->own_damping);
    tribo_modal_forget(&w->known);
    tribo_modal_give_back(w->scratch);
    tribo_modal_give_back(w->memory);
    memset(w, 0, sizeof *w);
}

/* Zeros that are freed with the whole. NULL if there are none left. */
static void *take(struct modal_whole *w, size_t count, size_t size)
{
    size_t ignored = 0;
    return tribo_modal_take(&w->memory, &ignored, count, size);
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

/* Counts for row d, at d + 2, who is beside it by an entry of a; of damping, the mirror image of an entry may be missing. */
static void count_beside(const struct matrix *a, size_t *first)
{
    for (size_t d = 0, k = 0; k < entries(a); d++) {
        for (; k < a->first[d + 1]; k++) {
            const int beside = a->val[k] != 0.0 && a->col[k] != d;
            first[d + 2] += (size_t)beside;
            first[a->col[k] + 2] += (size_t)beside;
        }
    }
}

static void list_beside(const struct modal_whole *w, const struct matrix *a)
{
    for (size_t d = 0, k = 0; k < entries(a); d++) {
        for (; k < a->first[d + 1]; k++) {
            const size_t e = a->col[k];
            if (a->val[k] != 0.0 && e != d) {
                w->beside[w->first[d + 1]++] = e;
                w->beside[w->first[e + 1]++] = d;
            }
        }
    }
}

/* Leaves each of the lists with everyone once. */
static void remove_repeats(const struct modal_whole *w)
{
    size_t *seen = w->root, kept = 0;
    for (size_t d = 0, k = 0; d < w->sys->ndof; d++) {
        const size_t end = w->first[d + 1];
        for (; k < end; k++) {
            if (seen[w->beside[k]] != d + 1) {
                seen[w->beside[k]] = d + 1;
                w->beside[kept++] = w->beside[k];
            }
        }
        w->first[d + 1] = kept;
    }
}

static int find_beside(struct modal_whole *w)
{
    const size_t n = w->sys->ndof;
    const struct matrix *const shared[] = {w->stiffness, w->damping, &w->sys->mass};
    w->first = take(w, n + 2, sizeof *w->first);
    for (size_t k = 0; w->first && k < 3; k++) {
        count_beside(shared[k], w->first);
    }
    for (size_t d = 0; w->first && d < n; d++) {
        w->first[d + 2] += w->first[d + 1];
    }
    w->beside = w->first ? take(w, w->first[n + 1], sizeof *w->beside) : NULL;
    for (size_t k = 0; w->beside && k < 3; k++) {
        list_beside(w, shared[k]);
    }
    if (w->beside) {
        remove_repeats(w);
    }
    return w->beside != NULL;
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

/* Who touches whom, of contacts and degrees of freedom. */
static int list_contacts(struct modal_whole *w)
{
    const struct matrix *j = &w->sys->direction;
    const size_t n = w->sys->ndof;
    w->first_contact = take(w, n + 2, sizeof *w->first_contact);
    w->contact = take(w, entries(j), sizeof *w->contact);
    w->alone = take(w, j->rows, sizeof *w->alone);
    if (!w->first_contact || !w->contact || !w->alone) {
        return 0;
    }
    for (size_t k = 0; k < entries(j); k++) {
        w->first_contact[j->col[k] + 2]++;
    }
    for (size_t d = 0; d < n; d++) {
        w->first_contact[d + 2] += w->first_contact[d + 1];
    }
    for (size_t i = 0; i < j->rows; i++) {
        w->alone[i] = only_one(j, i);
        for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
            w->contact[w->first_contact[j->col[k] + 1]++] = i;
        }
    }
    return 1;
}

/* Marks what harmonics change; and whether parts can be looked at by themselves: with loads only, which act where they are, and
 * contacts that touch something. */
static int find_harmonics(struct modal_whole *w)
{
    const tribo_system *sys = w->sys;
    const int shares_mass = sys->mass.rows && !tribo_matrix_is_diagonal(&sys->mass);
    w->always = take(w, sys->ndof, 1);
    w->divides = !shares_mass && sys->base_harmonics == 0 && sys->limit_harmonics == 0;
    for (size_t k = 0; w->always && k < sys->harmonics; k++) {
        note_harmonic(w, &sys->harmonic[k], shares_mass);
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        w->divides &= sys->direction.first[i] < sys->direction.first[i + 1];
    }
    return w->always != NULL;
}

static int create_workspace(struct modal_whole *w)
{
    const size_t n = w->sys->ndof, c = w->sys->ncontact;
    size_t **const list[] = {&w->dof_place, &w->root, &w->own, &w->first_own, &w->contact_place};
    const size_t count[] = {n, n, n, n + 2, c};
    for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
        *list[k] = take(w, count[k], sizeof **list[k]);
        if (!*list[k]) {
            return 0;
        }
    }
    w->how = take(w, n, 1);
    w->ours = take(w, n, 1);
    w->known.piece = take(w, n, sizeof *w->known.piece);
    w->known.lists = n;
    w->found = take(w, n + 1, sizeof(struct modal *));
    memset(w->dof_place, 0xff, n * sizeof *w->dof_place);
    memset(w->contact_place, 0xff, c * sizeof *w->contact_place);
    return w->how && w->ours && w->known.piece && w->found;
}

int tribo_modal_whole_create(struct modal_whole *w, tribo_system *sys)
{
    *w = (struct modal_whole){.sys = sys};
    return create_workspace(w) && find_forces(w) && find_beside(w) && list_contacts(w) && find_harmonics(w)
               ? TRIBO_OK
               : tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the matrices of a structure to be held");
}

/* -------------------------------------------------------------------------------------------------------------------- parts */

static void hold(struct modal_whole *w, size_t i)
{
    const struct matrix *j = &w->sys->direction;
    const size_t d = w->alone[i];
    if (d < w->sys->ndof) {
        w->how[d] = w->how[d] == MOVES_FREELY ? MOVES_HELD : MOVES_TIED;
        return;
    }
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        if (j->val[k] != 0.0) {
            w->how[j->col[k]] = MOVES_TIED;
        }
    }
}

static void find_how(struct modal_whole *w, const unsigned char *holds)
{
    memset(w->how, MOVES_FREELY, w->sys->ndof);
    for (size_t i = 0; i < w->sys->ncontact; i++) {
        if (holds[i]) {
            hold(w, i);
        }
    }
}

static size_t root_of(const struct modal_whole *w, size_t d)
{
    while (w->root[d] != d) {
        d = w->root[d] = w->root[w->root[d]];
    }
    return d;
}

/* The lower root becomes that of both: so it is the first of a part. */
static void join(struct modal_whole *w, size_t d, size_t e)
{
    const size_t a = root_of(w, d), b = root_of(w, e);
    w->root[a > b ? a : b] = a < b ? a : b;
}

static void join_moving(struct modal_whole *w, const unsigned char *holds)
{
    const struct matrix *j = &w->sys->direction;
    const size_t n = w->sys->ndof;
    for (size_t d = 0; d < n; d++) {
        w->root[d] = d;
    }
    for (size_t d = 0; d < n; d++) {
        for (size_t k = w->first[d]; w->how[d] != MOVES_HELD && k < w->first[d + 1]; k++) {
            if (w->how[w->beside[k]] != MOVES_HELD) {
                join(w, d, w->beside[k]);
            }
        }
    }
    for (size_t i = 0; i < w->sys->ncontact; i++) {
        size_t tied = n;
        for (size_t k = j->first[i]; holds[i] && w->alone[i] == n && k < j->first[i + 1]; k++) {
            if (j->val[k] != 0.0) {
                join(w, j->col[k], tied < n ? tied : j->col[k]);
                tied = j->col[k];
            }
        }
    }
}

/* Numbers the trees, and leaves in root the number of the tree. Parents are lower than their children. */
static void number_parts(struct modal_whole *w)
{
    size_t *number = w->own;
    w->parts = 0;
    for (size_t d = 0; d < w->sys->ndof; d++) {
        w->root[d] = w->root[w->root[d]];
        if (w->root[d] == d && w->how[d] != MOVES_HELD) {
            number[d] = w->parts++;
        }
    }
    for (size_t d = 0; d < w->sys->ndof; d++) {
        w->root[d] = w->how[d] != MOVES_HELD ? number[w->root[d]] : NOWHERE;
    }
}

static void list_parts(struct modal_whole *w)
{
    size_t *first = w->first_own;
    memset(first, 0, (w->parts + 2) * sizeof *first);
    for (size_t d = 0; d < w->sys->ndof; d++) {
        if (w->root[d] != NOWHERE) {
            first[w->root[d] + 2]++;
        }
    }
    for (size_t k = 0; k < w->parts; k++) {
        first[k + 2] += first[k + 1];
    }
    for (size_t d = 0; d < w->sys->ndof; d++) {
        if (w->root[d] != NOWHERE) {
            w->own[first[w->root[d] + 1]++] = d;
        }
    }
}

/* What is held and loaded is a part without motion. */
static void list_still(struct modal_whole *w)
{
    size_t end = w->first_own[w->parts];
    for (size_t d = 0; d < w->sys->ndof; d++) {
        if (w->always[d] && w->how[d] == MOVES_HELD) {
            w->own[end++] = d;
        }
    }
    if (end > w->first_own[w->parts]) {
        w->first_own[++w->parts] = end;
    }
}

void tribo_modal_divide(struct modal_whole *w, const unsigned char *holds)
{
    find_how(w, holds);
    join_moving(w, holds);
    number_parts(w);
    list_parts(w);
    list_still(w);
}

/* inside [ndof] += what may move, and what is beside that. */
static void mark_moving(const struct modal_whole *w, unsigned char *inside)
{
    for (size_t d = 0; d < w->sys->ndof; d++) {
        inside[d] |= w->how[d] != MOVES_HELD;
        for (size_t k = w->first[d]; w->how[d] != MOVES_HELD && k < w->first[d + 1]; k++) {
            inside[w->beside[k]] = 1;
        }
    }
}

/* inside [ndof] += what contacts touch that do not hold. */
static void mark_touched(const struct modal_whole *w, const unsigned char *holds, unsigned char *inside)
{
    const struct matrix *j = &w->sys->direction;
    for (size_t i = 0; i < j->rows; i++) {
        for (size_t k = j->first[i]; !holds[i] && k < j->first[i + 1]; k++) {
            inside[j->col[k]] = 1;
        }
    }
}

void tribo_modal_take_all(struct modal_whole *w, const unsigned char *holds)
{
    unsigned char *inside = w->ours;
    find_how(w, holds);
    memcpy(inside, w->always, w->sys->ndof);
    mark_moving(w, inside);
    mark_touched(w, holds, inside);
    w->parts = 1;
    w->first_own[0] = w->first_own[1] = 0;
    for (size_t d = 0; d < w->sys->ndof; d++) {
        if (inside[d]) {
            w->own[w->first_own[1]++] = d;
        }
        inside[d] = 0;
    }
}
