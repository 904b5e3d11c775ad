/* SPDX-License-Identifier: BSD-3-Clause */
/* Builds structures with contacts held: modes, damping, and what the modes do at contacts. */
#include "parts.h"
#include "common/layout.h"
#include "common/real.h"
#include "dynamics/reduce/normal_modes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* C~_kl, k != l, counts as 0 up to NEGLIGIBLE sqrt|C~_kk C~_ll|. */
#define NEGLIGIBLE 1e-9

/* Part of other modes that a computed mode may contain. */
#define IMPURITY 1e-14

/* Damping of a mode counts as 0 up to ROUNDING times the rounding of the terms of phi'C phi. */
#define ROUNDING 8.0

/* Largest part of a mode in another mode that counts as rounding. */
#define TINY 1e-6

/* Velocity of a contact by its base and the structure that follows bases, relative to its terms, up to which it is rounding. */
#define NO_MOTION 1e-14

/* ------------------------------------------------------------------------------------------------------------------ memory */

/* Units of a block, which holds several short arrays; a longer array has a block of its own. With its head a block has 1032
 * bytes, the most that malloc of the GNU C library keeps at hand after free. */
#define BLOCK ((size_t)126)

struct modal_block {
    struct modal_block *next;
    size_t used, room; /* units */
    union layout_unit unit[];
};

void *tribo_modal_take(struct modal_store *store, size_t count, size_t size)
{
    struct modal_block *block = store->last;
    const size_t units = (count * size + sizeof *block->unit - 1) / sizeof *block->unit, room = units > BLOCK ? units : BLOCK;
    if (!block || block->room - block->used < units) {
        block = malloc(sizeof *block + room * sizeof *block->unit);
        if (!block) {
            store->failed = 1;
            return NULL;
        }
        *block = (struct modal_block){store->last, 0, room};
        store->last = block;
        store->bytes += sizeof *block + room * sizeof *block->unit;
    }
    block->used += units;
    return memset(block->unit + block->used - units, 0, units * sizeof *block->unit);
}

static void build_give_back(struct modal_store *store)
{
    while (store->last) {
        struct modal_block *next = store->last->next;
        free(store->last);
        store->last = next;
    }
}

/* ------------------------------------------------------------------------------------------------- the contacts that hold */

/* Sets key, rest and ties. Returns 0 if out of memory, or on another failure, with b->status set. */
static int list_rest(struct modal_build *b)
{
    struct modal *h = b->h;
    tribo_system *sys = b->sys;
    h->key = tribo_modal_take(&h->store, sys->ncontact, 1);
    h->rest = tribo_modal_take(&h->store, sys->ncontact + 1, sizeof *h->rest);
    for (size_t at = 0; !h->store.failed && at < 2 * sys->ncontact; at++) {
        const size_t i = at % sys->ncontact;
        const int springs = at >= sys->ncontact;
        const int listed = b->key[i] == KEY_HOLDS && springs == tribo_is_compliant(&sys->compliance, i);
        h->key[i] = b->key[i];
        h->rest[h->rests + h->springs] = i;
        *(springs ? &h->springs : &h->rests) += (size_t)listed;
    }
    b->like = h->rests ? NULL : b->like;
    if (h->store.failed || !tribo_constraints_create(&h->ties, &sys->direction, &sys->mass, h->rest, h->rests, NULL)) {
        return 0;
    }
    if (h->ties.rank < h->rests) {
        b->status =
            tribo_error(sys->message, TRIBO_ERR_INDEFINITE, "contact %zu cannot hold: the others that do leave it no motion",
                        h->rest[h->ties.order[h->ties.rank]]);
        return 0;
    }
    return 1;
}

/* Sets b->stiffness. Returns 0 if out of memory. */
static int find_stiffness(struct modal_build *b)
{
    const struct matrix *j = &b->sys->direction;
    const size_t n = b->sys->ndof, c = j->rows;
    b->stiffness = b->k;
    if ((!b->h->springs && b->sys->circulation == 0.0) || b->powers) {
        return 1;
    }
    double *added = tribo_modal_take(&b->scratch, n * (n + 2 * c), sizeof *added), *x = added + n * n, *dense = x + c * n;
    if (!added) {
        return 0;
    }
    tribo_matrix_spread(b->k, added);
    if (b->h->springs) {
        tribo_matrix_spread(j, dense);
        memcpy(x, dense, c * n * sizeof *x);
        tribo_compliance_solve(b->sys, b->slip, n, x);
        tribo_multiply_transposed_add(c, n, n, dense, x, added);
    }
    tribo_even_out(n, added);
    b->stiffness = &b->own_stiffness;
    return tribo_matrix_from_dense(&b->own_stiffness, n, n, added);
}

void tribo_modal_react(const struct modal *h, const size_t *rows, size_t columns, double *force, double *f, double *work)
{
    const size_t n = tribo_modal_wide(h->within);
    double *moved = force + (h->within[0] - rows[0]) * columns;
    memset(work, 0, h->modes * columns * sizeof *work);
    tribo_multiply_add(h->modes, n, columns, -1.0, h->phi, moved, work);
    tribo_multiply_transposed_add(h->modes, n, columns, h->psi, work, moved);
    tribo_constraints_react(&h->ties, rows, columns, force, f);
}

/* to [rows[1] - rows[0]][columns] += rows of a times x, which is 0 but in its rows `of`. */
static void add_between(const struct matrix *a, const size_t *rows, const size_t *of, size_t columns, const double *x, double *to)
{
    if (tribo_modal_wide(rows) == a->rows && tribo_modal_wide(of) == a->cols) {
        tribo_matrix_add_columns(a, 1.0, columns, x, to);
        return;
    }
    for (size_t i = rows[0]; i < rows[1]; i++) {
        for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
            const size_t j = a->col[e];
            if (of[0] <= j && j < of[1]) {
                tribo_add(to + (i - rows[0]) * columns, a->val[e], x + (j - of[0]) * columns, columns);
            }
        }
    }
}

/* Sets h->within by the displacements q = z y; z without rows, compliant contacts, normals, or K not symmetric: all. */
static void find_within(struct modal_build *b, const struct matrix *z)
{
    const tribo_system *sys = b->sys;
    const struct matrix *const beside[] = {&sys->k, &sys->mass, &sys->c};
    size_t *within = b->h->within, first = 0, end = sys->ndof;
    const int some = z->rows > 0 && sys->compliance.count == 0 && sys->normals.count == 0 && sys->circulation == 0.0;
    while (some && first < end && z->first[first] == z->first[first + 1]) {
        first++;
    }
    while (some && first < end && z->first[end - 1] == z->first[end]) {
        end--;
    }
    within[0] = first;
    within[1] = end;
    for (size_t at = 0; some && at < 3 * sys->ndof; at++) { /* rows with entries from first to end; columns ascend */
        const struct matrix *a = beside[at % 3];
        const size_t d = at / 3, from = a->rows ? a->first[d] : 0, to = a->rows ? a->first[d + 1] : 0;
        if (from < to && a->col[from] < end && a->col[to - 1] >= first) {
            within[0] = d < within[0] ? d : within[0];
            within[1] = d < within[1] ? within[1] : d + 1;
        }
    }
}

/* ------------------------------------------------------------------------------------------------- modes of vibration */

/* *c = Cholesky factor of Z'MZ. Returns a status. */
static int factorize_mass(struct modal_build *b, const struct matrix *z, struct cholesky *c)
{
    const size_t m = z->cols;
    double *mass = tribo_modal_take(&b->scratch, m * m, sizeof *mass), pivot = 0.0;
    struct matrix w = {0};
    size_t where = 0;
    int status = TRIBO_ERR_MEMORY;
    if (mass && tribo_matrix_congruent(&b->sys->mass, z, mass) && tribo_matrix_from_dense(&w, m, m, mass)) {
        status = tribo_cholesky_create(c, &w, &w, &where, &pivot);
    }
    if (status == TRIBO_ERR_INDEFINITE) {
        tribo_error(b->sys->message, status, "mass of what is not held is not positive definite: pivot %g", pivot);
    }
    return status;
}

/* Sets stiffness = S'Z'KZ S and b->shape = Z S, (Z'MZ)^-1 = S S'. Returns a status. */
static int find_coordinates(struct modal_build *b, const struct matrix *z, const struct cholesky *mass)
{
    struct modal *h = b->h;
    const size_t m = h->modes, all[] = {0, m};
    double *a = tribo_modal_take(&b->scratch, 3 * m * m, sizeof *a), *turned = a + m * m, *s = turned + m * m;
    if (!a || !tribo_matrix_congruent(b->k, z, turned)) {
        return TRIBO_ERR_MEMORY;
    }
    tribo_half_solve(mass, 0, turned, m);
    tribo_transpose(m, m, turned, a);
    tribo_half_solve(mass, 0, a, m);
    tribo_even_out(m, a);
    for (size_t k = 0; k < m; k++) {
        s[k * (m + 1)] = 1.0;
    }
    tribo_half_solve(mass, 1, s, m);
    memcpy(b->shape, s, z->rows ? 0 : m * m * sizeof *s);
    if (z->rows) {
        add_between(z, h->within, all, m, s, b->shape);
    }
    return tribo_matrix_from_dense(&h->powers->stiffness, m, m, a) ? TRIBO_OK : TRIBO_ERR_MEMORY;
}

/* Sets modes, omega2, phi, psi, and damping to zeros. Returns 0 on failure, with b->status set unless out of memory. */
static int find_modes(struct modal_build *b)
{
    struct modal *h = b->h;
    const tribo_system *sys = b->sys;
    struct matrix z = {0};
    struct cholesky own = {0};
    const struct modes_text text = {sys->message, "with contacts at rest held, ", "take method event"};
    int status = h->rests == 0 || tribo_constraints_basis(&h->ties, sys->ndof, &z) ? TRIBO_OK : TRIBO_ERR_MEMORY;
    const int held = z.rows > 0;
    find_within(b, &z);
    const size_t n = tribo_modal_wide(h->within), m = h->modes = held ? z.cols : sys->ndof, all = m * (2 + 2 * n);
    const size_t room = all + (h->rests == 0 || h->springs ? m * sys->ncontact : 0);
    h->powers = b->like ? b->like->powers : b->powers ? calloc(1, sizeof *h->powers + room * sizeof *h->omega2) : NULL;
    h->omega2 = h->powers ? h->powers->array : b->powers ? NULL : tribo_modal_take(&h->store, all, sizeof *h->omega2);
    if (h->powers) {
        h->powers->users++;
    }
    b->shape = tribo_modal_take(&b->scratch, b->like ? 0 : 2 * m * n, sizeof *b->shape);
    b->full = tribo_modal_take(&b->scratch, b->powers ? 0 : m * sys->ndof, sizeof *b->full);
    status = status || (h->omega2 && b->shape && b->full) ? status : TRIBO_ERR_MEMORY;
    if (!status) {
        h->damping = h->omega2 + m;
        h->phi = h->damping + m;
        h->psi = h->phi + m * n;
        b->inertia = b->shape + (b->like ? 0 : m * n);
        status = held && m > 0 ? factorize_mass(b, &z, &own) : TRIBO_OK;
    }
    if (!status && b->powers) {
        status = b->like ? TRIBO_OK : find_coordinates(b, &z, held ? &own : &sys->factor);
    } else if (!status && m > 0) {
        status =
            tribo_normal_modes(b->stiffness, sys->expansion.terms, &z, held ? &own : &sys->factor, m, h->omega2, b->full, &text);
        for (size_t k = 0; k < m; k++) {
            for (size_t d = 0; d < n; d++) {
                b->shape[d * m + k] = b->full[k * sys->ndof + h->within[0] + d];
            }
        }
    }
    if (!status && !b->like) {
        add_between(&sys->mass, h->within, h->within, m, b->shape, b->inertia);
        tribo_transpose(n, m, b->shape, h->phi);
        tribo_transpose(n, m, b->inertia, h->psi);
    }
    tribo_matrix_free(&z);
    tribo_cholesky_free(&own);
    b->status = status;
    return !status;
}

/* Returns 1 if some c_kl, k != l, of c = C~ [modes][modes] is neither negligible beside c_kk and c_ll nor rounding of C or of the
 * modes. root, stiff_root [n]: square roots of the sizes of the terms of C_ii and K_ii. */
static int damping_couples(const struct modal_build *b, const double *c, const double *root, const double *stiff_root)
{
    const struct modal *h = b->h;
    const size_t n = b->sys->ndof, m = h->modes;
    for (size_t kl = 0; kl < m * m; kl++) {
        const size_t k = kl / m, l = kl % m;
        const double *one = b->full + k * n, *other = b->full + l * n;
        const double shared = fabs(c[kl]), own = sqrt(fabs(c[k * m + k] * c[l * m + l]));
        const double larger = greater(fabs(c[k * m + k]), fabs(c[l * m + l]));
        if (k == l || shared <= greater(NEGLIGIBLE * own, IMPURITY * larger)) {
            continue;
        }
        /* The part of mode l in mode k by rounding of K: noise of phi_k'K phi_l over |omega_k^2 - omega_l^2|; 0 if above TINY. */
        const double distance = fabs(h->omega2[k] - h->omega2[l]);
        const double noise = tribo_matrix_noise(b->stiffness, stiff_root, one, other);
        const double mixed = noise < TINY * distance ? noise / distance : 0.0;
        if (shared > ROUNDING * (tribo_matrix_noise(b->c, root, one, other) + mixed * larger)) {
            return 1;
        }
    }
    return 0;
}

/* Sets damping = diagonal of C~, 0 where only rounding; coupling = C~ if not diagonal; or, without modes, powers->damping = C~.
 * Returns 0 if out of memory. */
static int find_damping(struct modal_build *b)
{
    struct modal *h = b->h;
    const struct matrix *damping = b->like ? NULL : b->c;
    const size_t n = b->sys->ndof, m = h->modes;
    double *c = tribo_modal_take(&h->store, damping || b->follows ? m * m : 0, sizeof *c), most = 0.0;
    double *root = tribo_modal_take(&b->scratch, damping ? n * (2 + m) : 0, sizeof *root);
    h->coupling = b->follows ? c : NULL;
    if (!damping || !c || !root) {
        return c && root;
    }
    add_between(damping, h->within, h->within, m, b->shape, root + 2 * n);
    tribo_multiply_add(m, tribo_modal_wide(h->within), m, 1.0, h->phi, root + 2 * n, c);
    if (b->powers) {
        return tribo_matrix_from_dense(&h->powers->damping, m, m, c);
    }
    tribo_matrix_roots(damping, NULL, root);
    tribo_matrix_roots(b->stiffness, b->sys->expansion.terms, root + n);
    for (size_t k = 0; k < m; k++) {
        most = greater(most, fabs(c[k * (m + 1)]));
    }
    for (size_t k = 0; k < m; k++) {
        const double own = c[k * (m + 1)], noise = tribo_matrix_noise(damping, root, b->full + k * n, b->full + k * n);
        h->damping[k] = fabs(own) > greater(ROUNDING * noise, IMPURITY * IMPURITY * most) ? own : 0.0;
    }
    h->coupling = b->follows || damping_couples(b, c, root, root + n) ? c : NULL;
    return 1;
}

/* Rows i of to [ncontact][columns] = f_i of the rigid contacts i that hold, J_I'f = force, project: without the part of the force
 * that moves the modes. work [rests + modes][columns]. */
static void keep_reactions(const struct modal *h, const size_t *rows, size_t columns, double *force, int project, double *work,
                           double *to)
{
    if (project) {
        tribo_modal_react(h, rows, columns, force, work, work + h->rests * columns);
    } else {
        tribo_constraints_react(&h->ties, rows, columns, force, work);
    }
    for (size_t p = 0; p < h->rests; p++) {
        memcpy(to + h->rest[p] * columns, work + p * columns, columns * sizeof *to);
    }
}

void tribo_modal_rates(const struct modal_build *b, size_t columns, const double *slide, double *v, double *rate)
{
    tribo_compliance_rates(b->sys, b->slip, b->follows ? slide : NULL, columns, v, rate);
    for (size_t i = 0; b->follows && i < b->sys->ncontact; i++) {
        const int keeps = tribo_is_compliant(&b->sys->compliance, i);
        memcpy(rate + i * columns, slide + i * columns, keeps ? 0 : columns * sizeof *rate);
    }
}

/* v [ncontact], velocities of contacts by those of the structure, y: becomes v - base, or 0 if that is rounding; of normals v. */
static void leave_bases(const tribo_system *sys, const double *y, const double *base, double *v)
{
    const double most = tribo_largest(y, sys->ndof);
    for (size_t i = 0; i < sys->ncontact; i++) {
        double size = fabs(base[i]);
        for (size_t e = sys->direction.first[i]; e < sys->direction.first[i + 1]; e++) {
            size += fabs(sys->direction.val[e]) * most;
        }
        const double rest = fabs(v[i] - base[i]) > NO_MOTION * size ? v[i] - base[i] : 0.0;
        v[i] = tribo_normals_at(sys, i) ? v[i] : rest;
    }
}

void tribo_modal_effects(struct modal_build *b, size_t columns, const double *y, const double *inertia, const double *omega2,
                         const double *base, double *on, double *by_u)
{
    const struct modal *h = b->h;
    const tribo_system *sys = b->sys;
    const struct matrix *j = &sys->direction;
    const size_t all[] = {0, sys->ndof}, *rows = base ? all : h->within, n = tribo_modal_wide(rows);
    const size_t c = sys->ncontact, springs = sys->compliance.count || b->follows ? c : 0, each = columns * sizeof *on;
    const int pulls = h->rests > 0 || (base && b->follows);
    double *force = tribo_modal_take(&b->scratch, columns * (n + h->rests + h->modes + 2 * springs), sizeof *force);
    double *work = force + n * columns, *rate = work + (h->rests + h->modes) * columns, *slide = rate + springs * columns;
    if (!force) {
        return;
    }
    if (b->follows) {
        tribo_follow_slide(sys, h->key, columns, on, slide);
    }
    if (base) {
        leave_bases(sys, y, base, on);
    }
    if (springs) {
        tribo_modal_rates(b, columns, slide, on, rate);
    }
    for (size_t i = 0; i < c; i++) {
        const struct normal *normal = tribo_normals_at(sys, i);
        const int gives = tribo_is_compliant(&sys->compliance, i), slides = tribo_follow_side(h->key[i]) != 0.0;
        const int rests = h->key[i] == KEY_HOLDS ||
                          (!base && (h->key[i] == KEY_RESTS || h->key[i] == KEY_TIED_BACK || h->key[i] == KEY_TIED_FORTH));
        memset(on + i * columns, 0, rests ? each : 0);
        memcpy(on + i * columns, rate + (gives ? i * columns : 0), rests && gives ? each : 0);
        for (size_t k = 0; normal && k < columns; k++) {
            on[i * columns + k] *= normal->stiffness;
        }
        for (size_t e = j->first[i]; (gives || slides) && pulls && e < j->first[i + 1]; e++) {
            tribo_add(force + j->col[e] * columns, -j->val[e], rate + i * columns, columns);
        }
    }
    if (pulls) {
        add_between(b->k, rows, rows, columns, y, force);
        const size_t pulled = base || !(h->powers || b->follows) ? n * columns : 0; /* of coordinates omega2 is 0 */
        for (size_t at = 0, k = 0; at < pulled; at++, k = k + 1 < columns ? k + 1 : 0) {
            force[at] -= omega2[k] * inertia[at];
        }
        if (base && b->follows) {
            memset(b->push, 0, h->modes * sizeof *b->push);
            tribo_multiply_add(h->modes, n, 1, -1.0, h->phi, force, b->push);
        }
        keep_reactions(h, rows, columns, force, base || h->powers || b->follows, work, on);
    }
    if (by_u) {
        memset(force, 0, n * each);
        add_between(b->c, rows, rows, columns, y, force);
        keep_reactions(h, rows, columns, force, 1, work, by_u);
    }
}

/* Sets on, by_u and powers->reach. Returns 0 if out of memory. */
static int find_effects(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t m = h->modes, all = m * b->sys->ncontact, lags = b->c && h->rests;
    h->on = tribo_modal_take(&h->store, (lags ? 2 : 1) * all, sizeof *h->on);
    if (!h->on) {
        return 0;
    }
    h->by_u = lags ? h->on + all : NULL;
    const int apart = h->powers && (h->rests == 0 || h->springs);
    const size_t contacts[] = {0, b->sys->ncontact};
    double *reach = apart ? h->powers->reach = h->psi + m * tribo_modal_wide(h->within) : h->on;
    if (!b->like) {
        add_between(&b->sys->direction, contacts, h->within, m, b->shape, reach);
    }
    memmove(h->on, reach, apart ? all * sizeof *reach : 0);
    tribo_modal_effects(b, m, b->shape, b->inertia, h->omega2, NULL, h->on, h->by_u);
    return !b->scratch.failed;
}

int tribo_modal_create(struct modal **modal, tribo_system *sys, const signed char *slip, const signed char *key, int powers,
                       const struct modal *like)
{
    struct modal_store store = {0};
    struct modal_build b = {.sys = sys,
                            .h = *modal,
                            .slip = slip,
                            .key = key,
                            .powers = powers,
                            .like = like,
                            .k = &sys->k,
                            .c = sys->c.rows ? &sys->c : NULL};
    int done = !b.h || tribo_follow_press(&b);
    if (!b.h && (b.h = tribo_modal_take(&store, 1, sizeof *b.h)) != NULL) {
        b.h->store = store;
        done = list_rest(&b) && tribo_follow_press(&b) && find_stiffness(&b) && find_modes(&b) && find_damping(&b) &&
               tribo_follow_couple(&b) && find_effects(&b);
        b.status = done && !powers ? tribo_modal_exponents(&b) : b.status;
    }
    store = (struct modal_store){0};
    if (done && b.h && !b.status && (b.forced = tribo_modal_take(&store, 1, sizeof *b.forced)) != NULL) {
        *b.forced = (struct forced){.modal = b.h, .store = store};
        b.h->forced = b.forced;
    }
    done = b.forced && tribo_forced_respond(&b) && tribo_forced_outputs(&b);
    build_give_back(&b.scratch);
    tribo_matrix_free(&b.own_stiffness);
    tribo_matrix_free(&b.pressed_stiffness);
    if (done) {
        *modal = b.h;
        return TRIBO_OK;
    }
    if (*modal) {
        tribo_forced_free(*modal);
    } else {
        tribo_modal_free(b.h);
    }
    return b.status && b.status != TRIBO_ERR_MEMORY
               ? b.status
               : tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for the modes of a held structure");
}

void tribo_modal_free(struct modal *h)
{
    if (h && h->users-- == 0) {
        struct modal_store store = h->store;
        if (h->powers && --h->powers->users == 0) {
            tribo_matrix_free(&h->powers->stiffness);
            tribo_matrix_free(&h->powers->damping);
            free(h->powers);
        }
        tribo_forced_free(h);
        tribo_constraints_free(&h->ties);
        build_give_back(&store);
    }
}

void tribo_forced_free(struct modal *h)
{
    if (h->forced) {
        struct modal_store store = h->forced->store;
        build_give_back(&store);
        h->forced = NULL;
    }
}
