/* Structures reduced to their lowest modes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "normal_modes.h"
#include "model.h"

/* What to say of modes that were not found. */
static int modes_failed(const struct model *m, int status, const struct doubt *doubt)
{
    switch (status) {
    case TRIBO_ERR_MEMORY:
        return tribo_model_no_memory(m);
    case TRIBO_ERR_NOT_FINITE:
        return tribo_model_fail(m, status, "stiffness over mass overflows");
    case TRIBO_ERR_UNSUPPORTED:
        return tribo_model_fail(
            m, status,
            "omega^2 = %g of mode %zu is hardly more than rounding of the stiffness, which comes to %g: make the stiffest "
            "parts softer, or rigid",
            doubt->omega2, doubt->mode, doubt->noise);
    default:
        return tribo_model_fail(m, status, "omega^2 = %g of mode %zu does not come out pure: reduce the system to fewer modes",
                                doubt->omega2, doubt->mode);
    }
}

/* The lowest nmode modes: modes [ndof][nmode] with modal mass 1, and omega [nmode]. */
static int find_modes(const struct model *m, double *modes, double *omega)
{
    const struct matrix whole = {0};
    struct cholesky c;
    struct doubt doubt = {0};
    double *phi = malloc(m->nmode * m->ndof * sizeof *phi);
    int status = phi ? tribo_model_factorize(m, &c) : tribo_model_no_memory(m);
    if (!status) {
        status = tribo_normal_modes(&m->stiffness, &whole, &c, m->nmode, omega, phi, &doubt);
        status = status ? modes_failed(m, status, &doubt) : TRIBO_OK;
        tribo_cholesky_free(&c);
    }
    for (size_t j = 0; !status && j < m->nmode; j++) {
        if (omega[j] < 0.0) {
            status = tribo_model_fail(m, TRIBO_ERR_INDEFINITE, "stiffness is not positive semidefinite: omega^2 = %g of mode %zu",
                                      omega[j], j);
        }
        omega[j] = sqrt(fabs(omega[j]));
        for (size_t i = 0; i < m->ndof; i++) {
            modes[i * m->nmode + j] = phi[j * m->ndof + i];
        }
    }
    free(phi);
    return status;
}

/* a = diag(factor x), or of the squares of x; zeroed if out of memory. */
static int diagonal_matrix(struct matrix *a, const double *x, double factor, int square, size_t n)
{
    double *entries = malloc(n * sizeof *entries);
    for (size_t i = 0; entries && i < n; i++) {
        entries[i] = factor * x[i] * (square ? x[i] : 1.0);
    }
    *a = (struct matrix){0};
    const int done = entries && tribo_matrix_diagonal(a, n, entries);
    free(entries);
    return done;
}

int tribo_model_reduce(struct model *m, tribo_system **sys)
{
    const size_t n = m->ndof, r = m->nmode, c = m->ncontact;
    double *modes = malloc(n * r * sizeof *modes), *omega = malloc(r * sizeof *omega);
    double *j = calloc(c * r + 1, sizeof *j), *z = calloc(c * r + 1, sizeof *z);
    struct matrix kr = {0}, cr = {0}, jr = {0}, br = {0};
    int status = modes && omega && j && z ? find_modes(m, modes, omega) : tribo_model_no_memory(m);
    if (!status) {
        for (size_t i = 0; i < c; i++) {
            for (size_t k = m->direction.first[i]; k < m->direction.first[i + 1]; k++) {
                for (size_t mode = 0; mode < r; mode++) {
                    j[i * r + mode] += m->direction.val[k] * modes[m->direction.col[k] * r + mode];
                }
            }
            for (size_t mode = 0; mode < r; mode++) {
                z[mode * c + i] = j[i * r + mode];
            }
        }
        if (!(diagonal_matrix(&kr, omega, 1.0, 1, r) && tribo_matrix_from_dense(&jr, c, r, j) &&
              tribo_matrix_from_dense(&br, r, c, z))) {
            status = tribo_model_no_memory(m);
        }
    }
    free(j);
    if (!status) {
        status = tribo_system_build(sys, r, c, &kr, &cr, &jr, &br);
        status = status ? tribo_model_no_memory(m) : status;
    } else {
        tribo_matrix_free(&kr);
        tribo_matrix_free(&jr);
        tribo_matrix_free(&br);
    }
    if (status) {
        free(modes);
        free(omega);
        free(z);
        return status;
    }
    (*sys)->given = n;
    (*sys)->modes = modes;
    (*sys)->omega = omega;
    status = tribo_model_set_operator(m, *sys, z, r);
    free(z);
    return status;
}

/* ---------------------------------------------------------------------------------------------------------------------- calls */

static int only_reduced(const tribo_system *sys)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    return sys->modes ? TRIBO_OK : tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED, "the system is not reduced to modes");
}

int tribo_system_set_damping_ratio(tribo_system *sys, double zeta)
{
    const int status = only_reduced(sys);
    if (status) {
        return status;
    }
    if (!isfinite(zeta)) {
        return tribo_system_fail(sys, TRIBO_ERR_NOT_FINITE, "zeta = %g is not finite", zeta);
    }
    if (zeta < 0.0) {
        return tribo_system_fail(sys, TRIBO_ERR_NEGATIVE, "zeta = %g is negative", zeta);
    }
    struct matrix damping;
    if (!diagonal_matrix(&damping, sys->omega, 2.0 * zeta, 0, sys->ndof)) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the damping of %zu modes", sys->ndof);
    }
    tribo_matrix_free(&sys->damping);
    sys->damping = damping;
    sys->revision++;
    free(sys->dense);
    sys->dense = NULL;
    return TRIBO_OK;
}

int tribo_system_get_frequencies(const tribo_system *sys, double *omega)
{
    const int status = only_reduced(sys);
    if (status) {
        return status;
    }
    if (!omega) {
        return tribo_system_fail(sys, TRIBO_ERR_NULL, "omega is NULL");
    }
    memcpy(omega, sys->omega, sys->ndof * sizeof *omega);
    return TRIBO_OK;
}

int tribo_system_expand(const tribo_system *sys, const double *reduced, double *full)
{
    const int status = only_reduced(sys);
    if (status) {
        return status;
    }
    if (!reduced || !full) {
        return tribo_system_fail(sys, TRIBO_ERR_NULL, "%s is NULL", reduced ? "full" : "reduced");
    }
    for (size_t i = 0; i < sys->given; i++) {
        double sum = 0.0;
        for (size_t j = 0; j < sys->ndof; j++) {
            sum += sys->modes[i * sys->ndof + j] * reduced[j];
        }
        full[i] = sum;
    }
    return TRIBO_OK;
}
