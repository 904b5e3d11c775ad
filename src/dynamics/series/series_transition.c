#include "series_transition.h"
#include "dynamics/periodic/variation.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Most terms; a series of exponentials over a step of method event has far less. */
#define MOST_TERMS 400

void tribo_series_transition_free(struct series_transition *x)
{
    free(x->project);
    free(x->holds);
    free(x->push);
    free(x->pull);
    memset(x, 0, sizeof *x);
}

static int series_transition_reserve(struct series_transition *x, const tribo_system *sys, size_t columns)
{
    const size_t n = sys->ndof;
    x->holds = malloc(sys->ncontact + 1);
    x->project = malloc((3 * n * n + 3 * n * columns + 1) * sizeof *x->project);
    if (!x->holds || !x->project) {
        tribo_series_transition_free(x);
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for %zu perturbation%s", columns, plural(columns));
    }
    x->stiff = x->project + n * n;
    x->damp = x->stiff + n * n;
    x->q = x->damp + n * n;
    x->u = x->q + n * columns;
    x->next = x->u + n * columns;
    x->columns = columns;
    return TRIBO_OK;
}

static int reserve_springs(struct series_transition *x, const tribo_system *sys)
{
    const size_t n = sys->ndof, c = sys->ncontact;
    x->pull = malloc((n * c + c * x->columns + 1) * sizeof *x->pull);
    if (!x->pull) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for %zu perturbation%s", x->columns, plural(x->columns));
    }
    x->spring = x->pull + n * c;
    x->known = 0;
    return TRIBO_OK;
}

static int reserve_slopes(struct series_transition *x, const tribo_system *sys, size_t terms)
{
    const size_t c = sys->ncontact;
    x->push = malloc((sys->ndof * c + (terms + 1) * c * x->columns + 1) * sizeof *x->push);
    if (!x->push) {
        return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for %zu perturbation%s", x->columns, plural(x->columns));
    }
    x->force = x->push + sys->ndof * c;
    x->row = x->force + c * x->columns;
    x->terms = terms;
    x->known = 0;
    return TRIBO_OK;
}

/* to [ndof][ndof] = factor P a, a [ndof][ndof] transposed in `columns`, or no rows: the identity. */
static int series_transition_project(struct stick_slip *m, const tribo_system *sys, const struct matrix *a, double factor,
                                     double *to)
{
    const size_t n = sys->ndof;
    double *columns = a ? tribo_matrix_transpose_to_dense(a) : calloc(n * n + 1, sizeof *columns);
    int status = columns ? TRIBO_OK : tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for %zu column%s", n, plural(n));
    for (size_t j = 0; !status && j < n; j++) {
        columns[j * n + j] += a ? 0.0 : 1.0;
        status = tribo_stick_slip_project(m, sys, m->constant.still, columns + j * n);
        for (size_t i = 0; i < n; i++) {
            to[i * n + j] = factor * columns[j * n + i];
        }
    }
    free(columns);
    return status;
}

/* to [ndof][ncontact] = P b */
static int project_response(struct stick_slip *m, const tribo_system *sys, const struct matrix *b, double *to)
{
    const size_t n = sys->ndof, c = sys->ncontact;
    double *column = m->noise.size;
    int status = TRIBO_OK;
    for (size_t i = 0; !status && i < c; i++) {
        for (size_t d = 0; d < n; d++) {
            column[d] = tribo_matrix_get(b, d, i);
        }
        status = tribo_stick_slip_project(m, sys, m->constant.still, column);
        for (size_t d = 0; d < n; d++) {
            to[d * c + i] = column[d];
        }
    }
    return status;
}

/* The matrices for the contacts that hold. */
static int update(struct series_transition *x, struct stick_slip *m, const tribo_system *sys)
{
    if (x->known && x->revision == sys->revision && memcmp(x->holds, m->state.holds, sys->ncontact) == 0) {
        return TRIBO_OK;
    }
    memcpy(x->holds, m->state.holds, sys->ncontact);
    x->revision = sys->revision;
    int status = series_transition_project(m, sys, NULL, 1.0, x->project);
    status = status ? status : series_transition_project(m, sys, &sys->stiffness, -1.0, x->stiff);
    if (!status && sys->damping.rows) {
        status = series_transition_project(m, sys, &sys->damping, -1.0, x->damp);
    }
    if (!status && x->terms) {
        status = project_response(m, sys, &sys->response, x->push);
    }
    if (!status && x->pull) {
        status = project_response(m, sys, &sys->compliance.pull, x->pull);
    }
    x->known = !status;
    return status;
}

/* Sets x->force = term k of the forces by slopes, from the terms of velocities up to u, the k-th. */
static void series_transition_find_forces(struct series_transition *x, const tribo_system *sys, const struct slopes *slopes,
                                          size_t k, double tau)
{
    const size_t c = sys->ncontact, columns = x->columns;
    double power = 1.0;
    memset(x->force, 0, c * columns * sizeof *x->force);
    for (size_t i = 0; i < c; i++) {
        tribo_contact_row(sys, i, x->u, columns, x->row + ((k % x->terms) * c + i) * columns);
    }
    for (size_t j = 0; j <= k && j < x->terms; j++) {
        const double *row = x->row + ((k - j) % x->terms) * c * columns;
        for (size_t i = 0; i < c; i++) {
            tribo_add(x->force + i * columns, power * slopes->term[j * c + i], row + i * columns, columns);
        }
        power *= tau;
    }
}

/* x->spring = part f', by x->u. */
static void find_rates(struct series_transition *x, const struct stick_slip *m, const tribo_system *sys, double part)
{
    const size_t c = sys->ncontact, columns = x->columns;
    for (size_t i = 0; i < c; i++) {
        tribo_contact_row(sys, i, x->u, columns, x->spring + i * columns);
    }
    tribo_compliance_solve(sys, m->state.slip, columns, x->spring);
    for (size_t i = 0; i < c * columns; i++) {
        x->spring[i] *= -part;
    }
}

/* Forces of compliant contacts in perturbations v += x->spring; or, begin, x->spring = these. */
static void take_springs(const struct series_transition *x, const tribo_system *sys, int begin, double *v)
{
    const size_t columns = x->columns;
    for (size_t k = 0; k < sys->compliance.count; k++) {
        double *f = v + (2 * sys->ndof + k) * columns, *term = x->spring + sys->compliance.contact[k] * columns;
        if (begin) {
            memcpy(term, f, columns * sizeof *f);
        } else {
            tribo_add(f, 1.0, term, columns);
        }
    }
}

/* Sets q, u and spring to the k-th terms, x^(k) tau^k/k!, from those before. */
static void series_transition_differentiate(struct series_transition *x, const struct stick_slip *m, const tribo_system *sys,
                                            const struct slopes *slopes, size_t k, double tau)
{
    const size_t n = sys->ndof, c = x->columns;
    const double part = tau / (double)k;
    memset(x->next, 0, n * c * sizeof *x->next);
    tribo_multiply_add(n, n, c, part, x->stiff, x->q, x->next);
    if (sys->damping.rows) {
        tribo_multiply_add(n, n, c, part, x->damp, x->u, x->next);
    }
    if (slopes->terms) {
        series_transition_find_forces(x, sys, slopes, k - 1, tau);
        tribo_multiply_add(n, sys->ncontact, c, part, x->push, x->force, x->next);
    }
    if (x->pull) {
        tribo_multiply_add(n, sys->ncontact, c, part, x->pull, x->spring, x->next);
        find_rates(x, m, sys, part);
    }
    for (size_t i = 0; i < n * c; i++) {
        x->q[i] = part * x->u[i];
    }
    memcpy(x->u, x->next, n * c * sizeof *x->u);
}

int tribo_series_transition(struct series_transition *x, struct stick_slip *m, const tribo_system *sys,
                            const struct slopes *slopes, double tau, size_t columns, double *v)
{
    const size_t n = sys->ndof, half = n * columns;
    int status = x->project ? TRIBO_OK : series_transition_reserve(x, sys, columns);
    status = status || !slopes->terms || x->push ? status : reserve_slopes(x, sys, slopes->terms);
    status = status || !sys->compliance.count || x->pull ? status : reserve_springs(x, sys);
    status = status ? status : update(x, m, sys);
    if (status) {
        return status;
    }
    memcpy(x->q, v, half * sizeof *v);
    memset(x->u, 0, half * sizeof *v);
    tribo_multiply_add(n, n, columns, 1.0, x->project, v + half, x->u);
    memcpy(v + half, x->u, half * sizeof *v);
    if (x->pull) {
        memset(x->spring, 0, sys->ncontact * columns * sizeof *v);
        take_springs(x, sys, 1, v);
    }
    for (size_t k = 1, small = 0; small < 2 && k < MOST_TERMS; k++) {
        series_transition_differentiate(x, m, sys, slopes, k, tau);
        tribo_add(v, 1.0, x->q, half);
        tribo_add(v + half, 1.0, x->u, half);
        if (x->pull) {
            take_springs(x, sys, 0, v);
        }
        small = tribo_largest(x->q, half) <= DBL_EPSILON * tribo_largest(v, half) &&
                        tribo_largest(x->u, half) <= DBL_EPSILON * tribo_largest(v + half, half)
                    ? small + 1
                    : 0;
    }
    return TRIBO_OK;
}
