#include "parts.h"
#include "common/real.h"
#include "dynamics/reduce/normal_modes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Damping that two modes share is none beside so much more of their own. */
#define NEGLIGIBLE 1e-9

/* A mode may have so much of another one. */
#define IMPURITY 1e-14

/* Damping that is not more than so many times the rounding of its terms is none. */
#define ROUNDING 8.0

/* ------------------------------------------------------------------------------------------------- the contacts that hold */

static int list_rest(struct modal_build *b, const unsigned char *holds)
{
    b->rest = tribo_modal_scratch_indices(b, b->sys->ncontact);
    for (size_t i = 0; b->rest && i < b->sys->ncontact; i++) {
        if (holds[b->contact[i]]) {
            b->rest[b->rests++] = i;
        }
    }
    if (!b->rest || !tribo_constraints_create(&b->ties, &b->sys->direction, &b->sys->mass, b->rest, b->rests, NULL)) {
        return 0;
    }
    if (b->ties.rank < b->rests) {
        b->status =
            tribo_system_fail(b->sys, TRIBO_ERR_INDEFINITE, "contact %zu cannot hold: the others that do leave it no motion",
                              b->contact[b->rest[b->ties.order[b->ties.rank]]]);
        return 0;
    }
    return 1;
}

/* ------------------------------------------------------------------------------------------------- modes of vibration */

/* Factor of Z'MZ. Returns a status. */
static int factorize_mass(struct modal_build *b, const struct matrix *z, struct cholesky *c)
{
    const size_t m = z->cols;
    double *mass = tribo_modal_scratch(b, m * m), pivot = 0.0;
    struct matrix w = {0};
    size_t where = 0;
    int status = TRIBO_ERR_MEMORY;
    if (mass && tribo_matrix_congruent(&b->sys->mass, z, mass) && tribo_matrix_from_dense(&w, m, m, mass)) {
        status = tribo_cholesky_create(c, &w, &where, &pivot);
    }
    tribo_matrix_free(&w);
    if (status == TRIBO_ERR_INDEFINITE) {
        tribo_system_fail(b->sys, status, "mass of what is not held is not positive definite: pivot %g", pivot);
    }
    return status;
}

/* What to say of modes that were not found. */
static int modes_failed(const struct modal_build *b, int status, const struct doubt *doubt)
{
    switch (status) {
    case TRIBO_ERR_NOT_FINITE:
        return tribo_system_fail(b->sys, status, "stiffness over mass overflows");
    case TRIBO_ERR_UNSUPPORTED:
        return tribo_system_fail(b->sys, status,
                                 "with contacts at rest held, omega^2 = %g of mode %zu is hardly more than rounding of the "
                                 "stiffness, which comes to %g: make the stiffest parts softer, or rigid",
                                 doubt->omega2, doubt->mode, doubt->noise);
    case TRIBO_ERR_NO_CONVERGENCE:
        return tribo_system_fail(b->sys, status,
                                 "with contacts at rest held, omega^2 = %g of mode %zu does not come out pure: take method event",
                                 doubt->omega2, doubt->mode);
    default:
        return status;
    }
}

static int find_modes(struct modal_build *b)
{
    struct matrix z = {0};
    struct cholesky own = {0};
    struct doubt doubt = {0};
    const int all_free = b->rests == 0 && b->n == b->whole->sys->ndof;
    int status = all_free || tribo_constraints_basis(&b->ties, b->n, &z) ? TRIBO_OK : TRIBO_ERR_MEMORY;
    status = status || !b->sys->massless.count ? status : tribo_modal_condense(b, &z);
    const int held = z.rows > 0;
    b->h->modes = held ? z.cols : b->n;
    b->h->omega2 = tribo_modal_keep(b, b->h->modes);
    b->phi = b->h->phi = tribo_modal_keep(b, b->h->modes * b->n);
    status = status || (b->h->omega2 && b->phi) ? status : TRIBO_ERR_MEMORY;
    if (!status && b->h->modes > 0) {
        status = held ? factorize_mass(b, &z, &own) : TRIBO_OK;
        status = status ? status
                        : modes_failed(b,
                                       tribo_normal_modes(b->stiffness, &z, held ? &own : &b->sys->factor, b->h->modes,
                                                          b->h->omega2, b->phi, &doubt),
                                       &doubt);
    }
    tribo_matrix_free(&z);
    tribo_cholesky_free(&own);
    b->status = status;
    return !status;
}

/* M phi, K phi and C phi. */
static int multiply_modes(struct modal_build *b)
{
    const size_t n = b->n, m = b->h->modes;
    b->psi = tribo_modal_scratch(b, (b->damping ? 3 : 2) * m * n);
    if (!b->psi) {
        return 0;
    }
    b->k_phi = b->psi + m * n;
    b->c_phi = b->damping ? b->k_phi + m * n : NULL;
    for (size_t k = 0; k < m; k++) {
        const double *phi = b->phi + k * n;
        tribo_system_add_mass(b->sys, 1.0, phi, b->psi + k * n);
        tribo_matrix_multiply_add(b->stiffness, 1.0, phi, b->k_phi + k * n);
        if (b->damping) {
            tribo_matrix_multiply_add(b->damping, 1.0, phi, b->c_phi + k * n);
        }
    }
    return 1;
}

/* 1 if the modes share damping c [modes][modes] that is neither negligible beside their own nor rounding. */
static int damping_couples(const struct modal_build *b, const double *c, const double *root)
{
    const size_t n = b->n, m = b->h->modes;
    for (size_t k = 0; k < m; k++) {
        for (size_t l = 0; l < m; l++) {
            const double shared = fabs(c[k * m + l]), own = sqrt(fabs(c[k * m + k] * c[l * m + l]));
            const double impure = IMPURITY * greater(fabs(c[k * m + k]), fabs(c[l * m + l]));
            if (k != l && shared > greater(NEGLIGIBLE * own, impure) &&
                shared > ROUNDING * tribo_matrix_noise(b->damping, root, b->phi + k * n, b->phi + l * n)) {
                return 1;
            }
        }
    }
    return 0;
}

/* Damping of the modes, each by itself, or coupled. */
static int find_damping(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t n = b->n, m = h->modes;
    h->damping = tribo_modal_keep(b, m);
    double *c = b->damping ? tribo_modal_scratch(b, m * m + n) : NULL, *root = c ? c + m * m : NULL;
    if (!h->damping || !c) {
        return h->damping && !b->damping;
    }
    tribo_matrix_roots(b->damping, root);
    double most = 0.0;
    for (size_t k = 0; k < m; k++) {
        for (size_t l = 0; l < m; l++) {
            c[k * m + l] = tribo_dot(b->phi + k * n, b->c_phi + l * n, n);
        }
        most = greater(most, fabs(c[k * m + k]));
    }
    for (size_t k = 0; k < m; k++) {
        const double own = c[k * m + k], noise = tribo_matrix_noise(b->damping, root, b->phi + k * n, b->phi + k * n);
        h->damping[k] = fabs(own) > greater(ROUNDING * noise, IMPURITY * IMPURITY * most) ? own : 0.0;
    }
    if (damping_couples(b, c, root)) {
        h->coupling = tribo_modal_keep(b, m * m);
        if (!h->coupling) {
            return 0;
        }
        memcpy(h->coupling, c, m * m * sizeof *c);
    }
    return 1;
}

static int find_drifts(struct modal_build *b)
{
    struct modal *h = b->h;
    h->drifts = tribo_modal_keep_bytes(b, h->modes);
    for (size_t k = 0; h->drifts && k < h->modes; k++) {
        h->drifts[k] = h->omega2[k] == 0.0 && h->damping[k] == 0.0;
    }
    return h->drifts != NULL;
}

/* ------------------------------------------------------------------------------------------------------- structures */

/* Keeps modes and belt velocities for the degrees of freedom that move. */
static int compress(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t n = b->n, m = h->modes, s = h->given;
    h->dof = tribo_modal_keep_indices(b, n);
    for (size_t d = 0; h->dof && d < n; d++) {
        int moves = b->y0[d] != 0.0;
        for (size_t k = 0; k < m; k++) {
            moves |= b->phi[k * n + d] != 0.0 || b->psi[k * n + d] != 0.0;
        }
        for (size_t w = 0; w < s; w++) {
            moves |= b->yr[w * n + d] != 0.0 || b->yi[w * n + d] != 0.0;
        }
        if (moves) {
            h->dof[h->moving++] = d;
        }
    }
    double **const kept[] = {&h->phi, &h->psi, &h->yr, &h->yi, &h->y0};
    const size_t count[] = {m * h->moving, m * h->moving, s * h->moving, s * h->moving, h->moving};
    h->begin = tribo_modal_keep_indices(b, m);
    h->end = tribo_modal_keep_indices(b, m);
    if (!h->dof || !h->begin || !h->end || !tribo_modal_keep_all(b, sizeof kept / sizeof *kept, kept, count)) {
        return 0;
    }
    for (size_t k = 0; k < m; k++) {
        h->end[k] = h->moving;
    }
    for (size_t i = 0; i < h->moving; i++) {
        const size_t d = h->dof[i];
        for (size_t k = 0; k < m; k++) {
            h->phi[k * h->moving + i] = b->phi[k * n + d];
            h->psi[k * h->moving + i] = b->psi[k * n + d];
        }
        for (size_t w = 0; w < s; w++) {
            h->yr[w * h->moving + i] = b->yr[w * n + d];
            h->yi[w * h->moving + i] = b->yi[w * n + d];
        }
        h->y0[i] = b->y0[d];
    }
    return 1;
}

/* What the contacts of the part do: as the set is known, or, if it has no key, whether they hold. */
static int find_part_key(struct modal_build *b, const unsigned char *holds)
{
    b->key = (signed char *)tribo_modal_scratch_bytes(b, b->contacts);
    for (size_t i = 0; b->key && i < b->contacts; i++) {
        const size_t at = b->contact[i];
        b->key[i] = b->h->key ? b->h->key[at] : (signed char)(2 * holds[at]);
    }
    return b->key != NULL;
}

/* Degrees of freedom and contacts of the part become those of the whole. */
static void number_as_whole(struct modal_build *b)
{
    struct modal *h = b->h;
    for (size_t i = 0; i < h->moving; i++) {
        h->dof[i] = b->dof[h->dof[i]];
    }
    for (size_t k = 0; k < h->outputs; k++) {
        h->output[k].contact = b->contact[h->output[k].contact];
    }
    for (size_t s = 0; s < h->harmonics; s++) {
        size_t *contact = &h->forcing[s].contact;
        *contact = *contact < b->sys->ncontact ? b->contact[*contact] : b->whole->sys->ncontact;
    }
}

/* What does not depend on loads. Returns a status, TRIBO_ERR_MEMORY if none is in b. */
static int find_structure(struct modal_build *b)
{
    if (!find_modes(b) || !multiply_modes(b) || !find_damping(b) || !find_drifts(b) || !tribo_modal_hold(b)) {
        return b->status ? b->status : TRIBO_ERR_MEMORY;
    }
    return tribo_modal_exponents(b);
}

/* The same of all degrees of freedom, which is kept while the structure is what it is. */
static int recall_structure(struct modal_build *b)
{
    struct modal_whole *w = b->whole;
    size_t *key = tribo_modal_scratch_indices(b, b->rests + 2);
    if (!key) {
        return TRIBO_ERR_MEMORY;
    }
    key[0] = b->rests;
    memcpy(key + 2, b->rest, b->rests * sizeof *key);
    struct modal *h = b->h, *known = tribo_modal_recall(w->structures, b->rests + 2, key);
    int status = TRIBO_OK;
    if (!known) {
        b->h = known = tribo_modal_alloc();
        status = known ? find_structure(b) : TRIBO_ERR_MEMORY;
        b->h = h;
        if (status) {
            tribo_modal_free(known);
            return status;
        }
        status = tribo_modal_remember(w->structures, b->rests + 2, key, known);
    }
    if (status) {
        return status;
    }
    const struct modal own = *h;
    *h = *known;
    h->key = own.key;
    h->memory = own.memory;
    h->bytes = own.bytes;
    h->users = own.users;
    h->base = tribo_modal_share(known);
    b->phi = h->phi;
    return b->psi || multiply_modes(b) ? TRIBO_OK : TRIBO_ERR_MEMORY;
}

/* Returns a status, TRIBO_ERR_MEMORY if none is in b. */
static int find_all(struct modal_build *b, const unsigned char *holds)
{
    if (!find_part_key(b, holds) || !list_rest(b, holds)) {
        return b->status ? b->status : TRIBO_ERR_MEMORY;
    }
    const tribo_system *sys = b->whole->sys;
    const int kept = b->whole->structures && b->owns == sys->ndof && (!sys->massless.count || sys->base_harmonics == 0);
    const int status = kept ? recall_structure(b) : find_structure(b);
    if (status) {
        return status;
    }
    if (!tribo_modal_forcing(b) || !tribo_modal_response(b) || !tribo_modal_outputs(b) || !compress(b)) {
        return b->status ? b->status : TRIBO_ERR_MEMORY;
    }
    number_as_whole(b);
    return TRIBO_OK;
}

int tribo_modal_build(struct modal_build *b, const unsigned char *holds)
{
    const int status = tribo_modal_extract(b) ? find_all(b, holds) : TRIBO_ERR_MEMORY;
    tribo_constraints_free(&b->ties);
    tribo_matrix_free(&b->slack);
    tribo_cholesky_free(&b->slack_stiffness);
    return status;
}
