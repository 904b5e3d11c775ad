/* SPDX-License-Identifier: BSD-3-Clause */
/* Structures reduced to their lowest modes. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/real.h"
#include "dynamics/system/model.h"

/* J_i phi is 0 below this part of the sum of its |terms|, where rounding keeps less than two digits, as where a mode moves both
 * sides of the contact alike. A contact can hold nothing by such a velocity. */
#define NO_SHAPE (100.0 * DBL_EPSILON)

/* Sets shapes [ncontact][count] = J Phi, 0 where that is rounding: by NO_SHAPE, or because phi has norm 1 in M, and a degree of
 * freedom d that moves alone has phi_d = 1/sqrt(M_dd). */
static void find_shapes(const tribo_model *m, const struct reduced *r, double *shapes)
{
    const struct matrix *j = &m->direction;
    for (size_t i = 0; i < m->ncontact; i++) {
        double alone = 0.0;
        for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
            const double mass = tribo_matrix_get(&m->mass, j->col[k], j->col[k]);
            alone += mass > 0.0 ? fabs(j->val[k]) / sqrt(mass) : 0.0;
        }
        for (size_t k = 0; k < r->count; k++) {
            const double *phi = r->phi + k * m->ndof, sum = tribo_matrix_row_dot(j, i, phi);
            const double noise = greater(NO_SHAPE * tribo_matrix_row_size(j, i, phi), DBL_EPSILON * alone);
            shapes[i * r->count + k] = fabs(sum) > noise ? sum : 0.0;
        }
    }
}

/* An entry of Phi'C Phi is 0 below this part of the sum of its |terms|: rounding, as between modes of proportional damping. */
#define NO_DAMPING (256.0 * DBL_EPSILON)

/* Sets `to` [count][count] = Phi'C Phi; without damping `to` stays without rows. Returns 0 if out of memory. */
static int project_damping(const tribo_model *m, const struct reduced *r, struct matrix *to)
{
    const size_t whole = m->ndof, n = r->count;
    if (!m->damping.first || m->damping.first[whole] == 0) {
        return 1;
    }
    double *c = malloc((n * n + 2 * whole) * sizeof *c), *force = c + n * n, *size = force + whole;
    for (size_t k = 0; c && k < n; k++) {
        tribo_matrix_multiply(&m->damping, r->phi + k * whole, force);
        memset(size, 0, whole * sizeof *size);
        tribo_matrix_add_sizes(&m->damping, r->phi + k * whole, size);
        for (size_t i = 0; i < n; i++) {
            const double *phi = r->phi + i * whole, sum = tribo_dot(phi, force, whole);
            c[i * n + k] = fabs(sum) > NO_DAMPING * tribo_size_of_eight(whole, phi, size) ? sum : 0.0;
        }
    }
    const int done = c && tribo_matrix_from_dense(to, n, n, c);
    free(c);
    return done;
}

/* ------------------------------------------------------------------------------------------------------------ compliance */

/* A contact is rigid if the flexibility that the modes lack is at most this part of its flexibility. */
#define RIGID 1e-7

/* A structure reduced to modes q has a compliance G at its soft contacts: springs before sliders, and residual flexibility, the
 * flexibility that the modes lack, with which w = P q + G f of the soft contacts moves the structure too:
 *     q'' + Omega^2 q = modes' p + P'f,   displacements = Phi q + residual'f. */

/* Sets own [ncontact] = G_ii; r->flexibility = G. Contacts with springs before their sliders (compliance [ncontact] > 0; NULL: no
 * springs) are soft, and contacts that are not rigid by RIGID. shapes [ncontact][count]: P of all contacts. Returns the number of
 * soft contacts. */
static size_t find_soft(struct reduced *r, size_t contacts, const double *shapes, const double *compliance, double *own)
{
    size_t soft = 0;
    for (size_t i = 0; i < contacts; i++) {
        const double *shape = shapes + i * r->count, spring = compliance ? compliance[i] : 0.0;
        own[i] = spring + (r->flexibility ? r->flexibility[i * contacts + i] : 0.0);
        double whole = own[i];
        for (size_t k = 0; k < r->count; k++) {
            whole += r->omega2[k] > 0.0 ? shape[k] * shape[k] / r->omega2[k] : 0.0;
        }
        const int is_soft = spring > 0.0 || own[i] > RIGID * whole;
        own[i] = is_soft ? own[i] : 0.0;
        soft += (size_t)is_soft;
    }
    for (size_t at = 0; r->flexibility && at < contacts * contacts; at++) {
        const double a = own[at / contacts], b = own[at % contacts];
        r->flexibility[at] = at % (contacts + 1) == 0 ? a : a > 0.0 && b > 0.0 ? r->flexibility[at] : 0.0;
    }
    return soft;
}

/* Sets sys->reduced: modes [given][dofs] = displacements by unit q and w; truncation. Returns 0 if out of memory. */
static int set_modes(const struct reduced *r, size_t given, tribo_system *sys)
{
    const size_t n = sys->expansion.dofs, *contact = sys->compliance.contact;
    const size_t soft = r->residual ? sys->compliance.count : 0;
    double *unit = calloc(tribo_system_dimension(sys) + tribo_system_size(sys), sizeof *unit);
    double *state = unit + tribo_system_dimension(sys);
    sys->reduced = (struct reduction){malloc(given * n * sizeof(double)), r->truncation, given};
    for (size_t k = 0; unit && sys->reduced.modes && k < n; k++) {
        if (soft) {
            unit[k] = 1.0;
            tribo_system_read_state(sys, unit, state);
            unit[k] = 0.0;
        }
        for (size_t i = 0; i < given; i++) {
            double *x = sys->reduced.modes + i * n + k;
            *x = k < r->count ? r->phi[k * given + i] : 0.0;
            for (size_t a = 0; a < soft; a++) {
                *x += state[2 * r->count + a] * r->residual[contact[a] * given + i];
            }
        }
    }
    const int done = unit && sys->reduced.modes;
    free(unit);
    return done;
}

/* The system is q'' + Phi'C Phi q' + diag(omega^2) q = modes' p + P'f. */
int tribo_model_reduce(tribo_model *m, tribo_system **sys)
{
    struct reduced r;
    int status = tribo_model_find_modes(m, &r);
    const size_t c = m->ncontact, k = r.count;
    size_t where = 0, soft = 0;
    double *own = calloc(c * (k + 1) + 1, sizeof *own), *shapes = own + c;
    status = status || own ? status : TRIBO_ERR_MEMORY;
    if (!status) {
        tribo_model modal = {.ndof = k, .ncontact = c, .nmode = k, .message = m->message};
        find_shapes(m, &r, shapes);
        soft = find_soft(&r, c, shapes, m->compliance, own);
        const int done = tribo_matrix_diagonal(&modal.mass, k, NULL) && tribo_matrix_diagonal(&modal.stiffness, k, r.omega2) &&
                         project_damping(m, &r, &modal.damping) && tribo_matrix_from_dense(&modal.direction, c, k, shapes);
        status = done ? tribo_model_build_massive(&modal, own, sys) : TRIBO_ERR_MEMORY;
        tribo_model_free(&modal);
    }
    if (!status && soft) {
        struct expansion x = {k, m->flexible ? 0 : soft, .place = malloc((k + soft) * sizeof *x.place)};
        for (size_t d = 0; x.place && d < k; d++) {
            x.place[d] = d;
        }
        status = x.place ? tribo_compliance_create(*sys, own, r.flexibility, &where) : TRIBO_ERR_MEMORY;
        status = status || tribo_expansion_create(*sys, &x, own) ? status : TRIBO_ERR_MEMORY;
        tribo_expansion_free(&x);
        status =
            status == TRIBO_ERR_INDEFINITE
                ? tribo_error(m->message, TRIBO_ERR_UNSUPPORTED,
                              "the flexibility that %zu mode%s to contact %zu is that of other contacts: take other modes, or "
                              "TRIBO_STATICS_MASS",
                              k, k == 1 ? " leaves" : "s leave", where)
                : status;
    }
    status = status || set_modes(&r, m->ndof, *sys) ? status : TRIBO_ERR_MEMORY;
    free(r.omega2);
    free(own);
    return status;
}

/* ---------------------------------------------------------------------------------------------------------------------- calls */

/* Checks that sys is reduced, and that its argument of that name is not NULL. */
static int check_reduced(const tribo_system *sys, const void *argument, const char *name)
{
    return sys && !sys->reduced.modes ? tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED, "the system is not reduced to modes")
                                      : tribo_system_check_given(sys, argument, name);
}

int tribo_system_set_damping_ratio(tribo_system *sys, double zeta)
{
    int status = check_reduced(sys, &zeta, "zeta");
    status = status ? status : tribo_check_number(sys->message, NOT_NEGATIVE, zeta, "zeta = %g", zeta);
    if (status) {
        return status;
    }
    struct matrix damping = {0}, rates = {0}; /* equal, because M = 1 */
    double *entries = malloc(sys->ndof * sizeof *entries);
    for (size_t k = 0; entries && k < sys->ndof; k++) {
        entries[k] = 2.0 * zeta * sqrt(tribo_matrix_get(&sys->stiffness, k, k));
    }
    const int done = entries && tribo_matrix_diagonal(&damping, sys->ndof, entries) && tribo_matrix_copy(&rates, &damping);
    free(entries);
    if (!done) {
        tribo_matrix_free(&damping);
        return tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for the damping of %zu mode%s", sys->ndof,
                           plural(sys->ndof));
    }
    tribo_system_put_damping(sys, &damping, &rates);
    return TRIBO_OK;
}

int tribo_system_get_frequencies(const tribo_system *sys, double *omega)
{
    const int status = check_reduced(sys, omega, "omega");
    for (size_t k = 0; !status && k < tribo_system_ndof(sys); k++) { /* after the modes displacements without mass */
        omega[k] = k < sys->ndof ? sqrt(tribo_matrix_get(&sys->stiffness, k, k)) : HUGE_VAL;
    }
    return status;
}

int tribo_system_expand(const tribo_system *sys, const double *reduced, double *full)
{
    const int status = reduced ? check_reduced(sys, full, "full") : check_reduced(sys, reduced, "reduced");
    if (status) {
        return status;
    }
    const size_t n = tribo_system_ndof(sys), dofs = sys->expansion.dofs;
    for (size_t i = 0; i < sys->reduced.given; i++) {
        full[i] = tribo_dot(sys->reduced.modes + i * dofs, reduced, n);
    }
    return TRIBO_OK;
}

int tribo_system_get_truncation(const tribo_system *sys, double omega, double *error)
{
    int status = check_reduced(sys, error, "error");
    status = status ? status : tribo_check_number(sys->message, FINITE, omega, "omega = %g", omega);
    if (status) {
        return status;
    }
    const struct truncation *t = &sys->reduced.truncation;
    const double square = omega * omega, x = square < t->above ? square / t->above : 1.0;
    *error = x < 1.0 ? t->missing * pow(x, t->order) / (1.0 - x) : HUGE_VAL;
    return TRIBO_OK;
}
