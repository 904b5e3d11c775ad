#include "parts.h"
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

/* Up to FEW modes a dense product does not pay. */
#define FEW 4

/* ------------------------------------------------------------------------------------------------- the contacts that hold */

static int list_rest(struct modal_build *b, const unsigned char *holds)
{
    tribo_system *sys = b->shared->sys;
    const struct compliance *g = &sys->compliance;
    b->rest = tribo_modal_scratch_indices(b, sys->ncontact);
    for (size_t i = 0; b->rest && i < sys->ncontact; i++) {
        if (holds[i] && !tribo_is_compliant(g, i)) {
            b->rest[b->rests++] = i;
        }
    }
    for (size_t k = 0; b->rest && k < g->count; k++) {
        if (holds[g->contact[k]]) {
            b->rest[b->rests + b->springs++] = g->contact[k];
        }
    }
    b->rates = b->springs ? sys->ncontact : 0;
    if (!b->rest || !tribo_constraints_create(&b->ties, &sys->direction, &sys->mass, b->rest, b->rests, NULL)) {
        return 0;
    }
    if (b->ties.rank < b->rests) {
        b->status = tribo_system_fail(sys, TRIBO_ERR_INDEFINITE, "contact %zu cannot hold: the others that do leave it no motion",
                                      b->rest[b->ties.order[b->ties.rank]]);
        return 0;
    }
    return 1;
}

/* Sets b->stiffness. Returns 0 if out of memory. */
static int find_stiffness(struct modal_build *b)
{
    const tribo_system *sys = b->shared->sys;
    const size_t n = b->n, c = sys->ncontact;
    b->stiffness = b->shared->stiffness;
    if (!b->springs) {
        return 1;
    }
    const int whole = sys->compliance.shared != NULL;
    double *inverse = tribo_modal_scratch(b, whole ? c * c : c), *added = tribo_modal_scratch(b, n * n);
    struct matrix g = {0}, k = {0};
    for (size_t i = 0; inverse && i < c; i++) {
        inverse[whole ? i * c + i : i] = 1.0;
    }
    if (inverse) {
        tribo_compliance_solve(sys, b->slip, whole ? c : 1, inverse);
    }
    const int done = inverse && added &&
                     (whole ? tribo_matrix_from_dense(&g, c, c, inverse) : tribo_matrix_diagonal(&g, c, inverse)) &&
                     tribo_matrix_congruent(&g, &sys->direction, added) && tribo_matrix_from_dense(&k, n, n, added) &&
                     tribo_matrix_sum(&b->own_stiffness, 1.0, b->shared->stiffness, 1.0, &k);
    tribo_matrix_free(&g);
    tribo_matrix_free(&k);
    b->stiffness = &b->own_stiffness;
    return done;
}

/* ------------------------------------------------------------------------------------------------- modes of vibration */

/* *c = Cholesky factor of Z'MZ. Returns a status. */
static int factorize_mass(struct modal_build *b, const struct matrix *z, struct cholesky *c)
{
    const size_t m = z->cols;
    double *mass = tribo_modal_scratch(b, m * m), pivot = 0.0;
    struct matrix w = {0};
    size_t where = 0;
    int status = TRIBO_ERR_MEMORY;
    if (mass && tribo_matrix_congruent(&b->shared->sys->mass, z, mass) && tribo_matrix_from_dense(&w, m, m, mass)) {
        status = tribo_cholesky_create(c, &w, &where, &pivot);
    }
    tribo_matrix_free(&w);
    if (status == TRIBO_ERR_INDEFINITE) {
        tribo_system_fail(b->shared->sys, status, "mass of what is not held is not positive definite: pivot %g", pivot);
    }
    return status;
}

/* Sets the message for a failure of tribo_normal_modes. Returns status. */
static int build_modes_failed(const struct modal_build *b, int status, const struct doubt *doubt)
{
    switch (status) {
    case TRIBO_ERR_NOT_FINITE:
        return tribo_system_fail(b->shared->sys, status, "stiffness over mass overflows");
    case TRIBO_ERR_UNSUPPORTED:
        return tribo_system_fail(b->shared->sys, status,
                                 "with contacts at rest held, omega^2 = %g of mode %zu is hardly more than rounding of the "
                                 "stiffness, which comes to %g: make the stiffest parts softer, or rigid",
                                 doubt->omega2, doubt->mode, doubt->noise);
    case TRIBO_ERR_NO_CONVERGENCE:
        return tribo_system_fail(b->shared->sys, status,
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
    const int all_free = b->rests == 0;
    int status = all_free || tribo_constraints_basis(&b->ties, b->n, &z) ? TRIBO_OK : TRIBO_ERR_MEMORY;
    const int held = z.rows > 0;
    b->h->modes = held ? z.cols : b->n;
    b->h->omega2 = tribo_modal_keep(b, b->h->modes);
    b->phi = b->h->phi = tribo_modal_keep(b, b->h->modes * b->n);
    status = status || (b->h->omega2 && b->phi) ? status : TRIBO_ERR_MEMORY;
    if (!status && b->h->modes > 0) {
        status = held ? factorize_mass(b, &z, &own) : TRIBO_OK;
        status = status ? status
                        : build_modes_failed(b,
                                             tribo_normal_modes(b->stiffness, b->shared->sys->expansion.terms, &z,
                                                                held ? &own : &b->shared->sys->factor, b->h->modes, b->h->omega2,
                                                                b->phi, &doubt),
                                             &doubt);
    }
    tribo_matrix_free(&z);
    tribo_cholesky_free(&own);
    b->status = status;
    return !status;
}

/* Sets psi = M phi, k_phi = stiffness phi and c_phi = C phi. Returns 0 if out of memory. */
static int multiply_modes(struct modal_build *b)
{
    const size_t n = b->n, m = b->h->modes;
    b->psi = tribo_modal_scratch(b, (b->shared->damping ? 3 : 2) * m * n);
    if (!b->psi) {
        return 0;
    }
    b->k_phi = b->psi + m * n;
    b->c_phi = b->shared->damping ? b->k_phi + m * n : NULL;
    for (size_t k = 0; k < m; k++) {
        const double *phi = b->phi + k * n;
        tribo_system_add_mass(b->shared->sys, 1.0, phi, b->psi + k * n);
        tribo_matrix_multiply_add(b->stiffness, 1.0, phi, b->k_phi + k * n);
        if (b->shared->damping) {
            tribo_matrix_multiply_add(b->shared->damping, 1.0, phi, b->c_phi + k * n);
        }
    }
    return 1;
}

/* Returns the part of mode l in mode k by rounding of K: noise of phi_k'K phi_l over |omega_k^2 - omega_l^2|; 0 if above TINY. */
static double mixed(const struct modal_build *b, const double *root, size_t k, size_t l)
{
    const double distance = fabs(b->h->omega2[k] - b->h->omega2[l]);
    const double noise = tribo_matrix_noise(b->stiffness, root, b->phi + k * b->n, b->phi + l * b->n);
    return noise <= TINY * distance ? noise / distance : 0.0;
}

/* Returns 1 if some c_kl, k != l, of c = C~ [modes][modes] is neither negligible beside c_kk and c_ll nor rounding of C or of the
 * modes. root, stiff_root [n]: square roots of the sizes of the terms of C_ii and K_ii. */
static int damping_couples(const struct modal_build *b, const double *c, const double *root, const double *stiff_root)
{
    const size_t n = b->n, m = b->h->modes;
    for (size_t k = 0; k < m; k++) {
        for (size_t l = 0; l < m; l++) {
            const double shared = fabs(c[k * m + l]), own = sqrt(fabs(c[k * m + k] * c[l * m + l]));
            const double larger = greater(fabs(c[k * m + k]), fabs(c[l * m + l]));
            if (k != l && shared > greater(NEGLIGIBLE * own, IMPURITY * larger) &&
                shared > ROUNDING * (tribo_matrix_noise(b->shared->damping, root, b->phi + k * n, b->phi + l * n) +
                                     mixed(b, stiff_root, k, l) * larger)) {
                return 1;
            }
        }
    }
    return 0;
}

/* Sets h->damping = diagonal of C~, 0 where only rounding; h->coupling = C~ if not diagonal. Returns 0 if out of memory. */
static int find_damping(struct modal_build *b)
{
    struct modal *h = b->h;
    const size_t n = b->n, m = h->modes;
    h->damping = tribo_modal_keep(b, m);
    double *c = b->shared->damping ? tribo_modal_scratch(b, m * m + 2 * n) : NULL, *root = c ? c + m * m : NULL;
    if (!h->damping || !c) {
        return h->damping && !b->shared->damping;
    }
    tribo_matrix_roots(b->shared->damping, NULL, root);
    tribo_matrix_roots(b->stiffness, b->shared->sys->expansion.terms, root + n);
    double most = 0.0;
    for (size_t k = 0; k < m; k++) {
        for (size_t l = 0; l < m; l++) {
            c[k * m + l] = tribo_dot(b->phi + k * n, b->c_phi + l * n, n);
        }
        most = greater(most, fabs(c[k * m + k]));
    }
    for (size_t k = 0; k < m; k++) {
        const double own = c[k * m + k], noise = tribo_matrix_noise(b->shared->damping, root, b->phi + k * n, b->phi + k * n);
        h->damping[k] = fabs(own) > greater(ROUNDING * noise, IMPURITY * IMPURITY * most) ? own : 0.0;
    }
    if (damping_couples(b, c, root, root + n)) {
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

/* Sets h->dof, and keeps phi, psi, yr, yi and y0 of the degrees of freedom h->dof. Returns 0 if out of memory. */
static int build_compress(struct modal_build *b)
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
    size_t entries = 0;
    for (size_t k = 0; k < m; k++) {
        double *phi = h->phi + k * h->moving, *psi = h->psi + k * h->moving;
        for (size_t i = 0; i < h->moving; i++) {
            phi[i] = b->phi[k * n + h->dof[i]];
            psi[i] = b->psi[k * n + h->dof[i]];
            if (phi[i] != 0.0 || psi[i] != 0.0) {
                h->begin[k] = h->end[k] ? h->begin[k] : i;
                h->end[k] = i + 1;
            }
        }
        entries += h->end[k] - h->begin[k];
    }
    for (size_t i = 0; i < h->moving; i++) {
        const size_t d = h->dof[i];
        for (size_t w = 0; w < s; w++) {
            h->yr[w * h->moving + i] = b->yr[w * n + d];
            h->yi[w * h->moving + i] = b->yi[w * n + d];
        }
        h->y0[i] = b->y0[d];
    }
    const int dense = m > FEW && 4 * entries >= m * h->moving;
    h->columns = dense ? tribo_modal_keep(b, m * h->moving) : NULL;
    if (h->columns) {
        tribo_transpose(m, h->moving, h->psi, h->columns);
    }
    return h->columns || !dense;
}

/* Sets the parts of b->h that do not depend on loads. Returns a status; TRIBO_ERR_MEMORY for a failure with b->status 0. */
static int find_structure(struct modal_build *b)
{
    if (!find_modes(b) || !multiply_modes(b) || !find_damping(b) || !find_drifts(b) || !tribo_modal_hold(b)) {
        return b->status ? b->status : TRIBO_ERR_MEMORY;
    }
    return tribo_modal_exponents(b);
}

struct modal_piece {
    struct modal_piece *next;
    struct modal *modal;
    size_t rests, springs, rest[]; /* [rests + springs] as in struct modal_build */
};

void tribo_modal_forget(struct modal_known *known)
{
    for (struct modal_piece *p = known->first; p;) {
        struct modal_piece *next = p->next;
        tribo_modal_free(p->modal);
        free(p);
        p = next;
    }
    *known = (struct modal_known){NULL, 0};
}

/* Adds a piece with the parts of find_structure to known. Returns a status. */
static int build_learn(struct modal_build *b, struct modal_known *known)
{
    const size_t list = (b->rests + b->springs) * sizeof *b->rest, bytes = sizeof(struct modal_piece) + list;
    struct modal_piece *p = malloc(bytes);
    struct modal *h = b->h, *found = b->h = p ? tribo_modal_alloc() : NULL;
    const int status = found ? find_structure(b) : TRIBO_ERR_MEMORY;
    b->h = h;
    if (status) {
        tribo_modal_free(found);
        free(p);
        return status;
    }
    p->modal = found;
    p->rests = b->rests;
    p->springs = b->springs;
    memcpy(p->rest, b->rest, list);
    p->next = known->first;
    known->first = p;
    known->bytes += bytes + found->bytes;
    return TRIBO_OK;
}

/* Sets the parts of find_structure in b->h from known, adds a missing piece; valid for one sys->structure. Returns a status. */
static int recall_structure(struct modal_build *b, struct modal_known *known)
{
    const struct modal_piece *p = known->first;
    const size_t list = (b->rests + b->springs) * sizeof *b->rest;
    while (p && (p->rests != b->rests || p->springs != b->springs || memcmp(p->rest, b->rest, list) != 0)) {
        p = p->next;
    }
    const int status = p ? TRIBO_OK : build_learn(b, known);
    if (status) {
        return status;
    }
    p = p ? p : known->first;
    struct modal *h = b->h;
    const struct modal own = *h;
    *h = *p->modal;
    h->key = own.key;
    h->memory = own.memory;
    h->bytes = own.bytes;
    h->users = own.users;
    h->base = tribo_modal_share(p->modal);
    b->phi = h->phi;
    return b->psi || multiply_modes(b) ? TRIBO_OK : TRIBO_ERR_MEMORY;
}

/* Builds all of b->h. Returns a status; TRIBO_ERR_MEMORY for a failure with b->status 0. */
static int build_find_all(struct modal_build *b, const unsigned char *holds)
{
    if (!list_rest(b, holds) || !find_stiffness(b)) {
        return b->status ? b->status : TRIBO_ERR_MEMORY;
    }
    const int status = b->shared->known ? recall_structure(b, b->shared->known) : find_structure(b);
    if (status) {
        return status;
    }
    return tribo_modal_forcing(b) && tribo_modal_response(b) && tribo_modal_outputs(b) && build_compress(b) ? TRIBO_OK
           : b->status                                                                                      ? b->status
                                                                                                            : TRIBO_ERR_MEMORY;
}

int tribo_modal_build(struct modal_build *b, const unsigned char *holds)
{
    const int status = build_find_all(b, holds);
    tribo_constraints_free(&b->ties);
    tribo_matrix_free(&b->own_stiffness);
    return status;
}
