/* Structures reduced to their lowest modes. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "dynamics/system/model.h"
#include "common/real.h"

/* a = diag(factor x); zeroed if out of memory. */
static int diagonal_matrix(struct matrix *a, const double *x, double factor, size_t n)
{
    double *entries = malloc(n * sizeof *entries);
    for (size_t i = 0; entries && i < n; i++) {
        entries[i] = factor * x[i];
    }
    *a = (struct matrix){0};
    const int done = entries && tribo_matrix_diagonal(a, n, entries);
    free(entries);
    return done;
}

/* The modes as the system keeps them, [ndof][count], and omega; takes what else it needs from r. 0 if out of memory. */
static int take_modes(tribo_system *sys, size_t given, const struct reduced *r)
{
    const size_t count = r->count;
    sys->given = given;
    sys->modes = malloc(given * count * sizeof *sys->modes);
    sys->omega = malloc(count * sizeof *sys->omega);
    sys->truncation = r->truncation;
    if (!sys->modes || !sys->omega) {
        return 0;
    }
    tribo_transpose(count, given, r->phi, sys->modes);
    for (size_t k = 0; k < count; k++) {
        sys->omega[k] = sqrt(r->omega2[k]);
    }
    return 1;
}

/* Velocities of contacts are none if rounding leaves less than two digits of them, in parts of what they are the sum of: as where
 * a mode moves both sides alike. A contact can hold nothing by such. */
#define NO_SHAPE (100.0 * DBL_EPSILON)

/* What of a mode may be rounding at contact i: modes have a norm of 1, and degrees of freedom that move alone one over the root
 * of their mass. */
static double least_shape(const struct model *m, size_t i)
{
    const struct matrix *j = &m->direction;
    double alone = 0.0;
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        const double mass = tribo_matrix_get(&m->mass, j->col[k], j->col[k]);
        alone += mass > 0.0 ? fabs(j->val[k]) / sqrt(mass) : 0.0;
    }
    return DBL_EPSILON * alone;
}

/* How mode phi [ndof] moves contact i, of which no more than least is nothing. */
static double shape(const struct model *m, size_t i, const double *phi, double least)
{
    const double sum = tribo_matrix_row_dot(&m->direction, i, phi);
    return fabs(sum) > greater(NO_SHAPE * tribo_matrix_row_size(&m->direction, i, phi), least) ? sum : 0.0;
}

/* shapes [ncontact][count] = J phi. */
static void find_shapes(const struct model *m, const struct reduced *r, double *shapes)
{
    for (size_t i = 0; i < m->ncontact; i++) {
        const double least = least_shape(m, i);
        for (size_t k = 0; k < r->count; k++) {
            shapes[i * r->count + k] = shape(m, i, r->phi + k * m->ndof, least);
        }
    }
}

/* q'' + diag(omega^2) q = modes' p + shapes' f. responses [count][ncontact] out: transposed shapes. */
static int build(const struct model *m, const struct reduced *r, double *responses, tribo_system **sys)
{
    const size_t count = r->count, c = m->ncontact;
    struct matrix stiffness = {0}, damping = {0}, direction = {0}, response = {0};
    double *shapes = malloc((c * count + 1) * sizeof *shapes);
    int done = shapes != NULL;
    if (done) {
        find_shapes(m, r, shapes);
        tribo_transpose(c, count, shapes, responses);
        done = diagonal_matrix(&stiffness, r->omega2, 1.0, count) && tribo_matrix_from_dense(&direction, c, count, shapes) &&
               tribo_matrix_from_dense(&response, count, c, responses);
    }
    free(shapes);
    if (done) {
        return tribo_system_build(sys, count, c, &stiffness, &damping, &direction, &response) ? tribo_model_no_memory(m)
                                                                                              : TRIBO_OK;
    }
    tribo_matrix_free(&stiffness);
    tribo_matrix_free(&direction);
    tribo_matrix_free(&response);
    return tribo_model_no_memory(m);
}

int tribo_model_reduce(struct model *m, tribo_system **sys)
{
    struct reduced r;
    int status = tribo_model_find_modes(m, &r);
    double *responses = status ? NULL : malloc((m->ncontact * r.count + 1) * sizeof *responses);
    if (!status) {
        status = responses ? build(m, &r, responses, sys) : tribo_model_no_memory(m);
    }
    if (!status) {
        status = take_modes(*sys, m->ndof, &r) ? tribo_model_set_operator(m, *sys, responses, r.count) : tribo_model_no_memory(m);
    }
    free(responses);
    tribo_reduced_free(&r);
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
    if (!diagonal_matrix(&damping, sys->omega, 2.0 * zeta, sys->ndof)) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the damping of %zu mode%s", sys->ndof,
                                 plural(sys->ndof));
    }
    tribo_matrix_free(&sys->damping);
    sys->damping = damping;
    sys->revision++;
    sys->structure++;
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

int tribo_system_get_truncation(const tribo_system *sys, double omega, double *error)
{
    const int status = only_reduced(sys);
    if (status) {
        return status;
    }
    if (!error) {
        return tribo_system_fail(sys, TRIBO_ERR_NULL, "error is NULL");
    }
    if (!isfinite(omega)) {
        return tribo_system_fail(sys, TRIBO_ERR_NOT_FINITE, "omega = %g is not finite", omega);
    }
    const struct truncation *t = &sys->truncation;
    const double x = (omega * omega + t->shift) / t->above;
    *error = x < 1.0 ? t->missing * (t->statics ? x * x : 1.0) / (1.0 - x) : HUGE_VAL;
    return TRIBO_OK;
}
