/* SPDX-License-Identifier: BSD-3-Clause */
/* The Jacobian of a system's right-hand side, for implicit integrators: dense, with derivatives of the contact forces. */
#include "system.h"
#include "common/layout.h"

#include <stdlib.h>
#include <string.h>

/* Derivatives of the contact forces f(v, a), and arrays of which they are made. */
struct tangents {
    double *df_dv, *df_da; /* [ncontact][ncontact] */
    double *pull;          /* [ncontact][ndof] (df/da) J */
    double *df_dy;         /* [ncontact][2 ndof + 1] derivatives of f by the state */
    double *df_dt;         /* [ncontact] */
    double *load;          /* [ndof] derivative of the accelerations by the load */
};

/* Time step of finite differences, times the highest frequency. */
#define SHORT 1e-7

/* to [rows][stride] += factor a b, for a dense a [rows][b->rows]. */
static void jacobian_add_product(size_t rows, double factor, const double *a, const struct matrix *b, size_t stride, double *to)
{
    for (size_t k = 0; k < rows * b->rows; k++) {
        if (a[k] != 0.0) {
            tribo_matrix_add_row(b, k % b->rows, factor * a[k], to + k / b->rows * stride);
        }
    }
}

/* rates [ndof][stride] -= B_n k J_n, and df_dy [ncontact][stride] += (df/dlimit) mu k J_n, over the pressed normals: N = k (J_n q
 * - gap) pushes the bodies, and the limits of its contacts follow it. At the point of the last tribo_balance_tangent. Returns a
 * status. */
static int jacobian_add_normals(tribo_system *sys, size_t stride, double *rates, double *df_dy)
{
    double *limit = sys->work.put_limit, *force = sys->work.dv_dt;
    int status = TRIBO_OK;
    for (size_t k = 0; !status && k < sys->normals.count; k++) {
        const struct normal *n = &sys->normals.normal[k];
        memset(limit, 0, sys->ncontact * sizeof *limit);
        for (size_t e = 0; e < sys->normals.followers; e++) {
            const struct follower *f = sys->normals.follower + e;
            limit[f->contact] = limit[f->second] = f->normal == k ? f->mu * n->stiffness : limit[f->contact];
        }
        status = n->pressed ? tribo_limit_product(sys->contacts, limit, force) : TRIBO_OK;
        for (size_t i = 0; !status && n->pressed && i < sys->ndof; i++) {
            const double push = n->stiffness * tribo_matrix_get(&sys->response, i, n->row);
            tribo_matrix_add_row(&sys->direction, n->row, -push, rates + i * stride);
        }
        for (size_t i = 0; !status && n->pressed && i < sys->ncontact; i++) {
            tribo_matrix_add_row(&sys->direction, n->row, force[i], df_dy + i * stride);
        }
    }
    return status;
}

/* Writes the rows of q' = u, of u' = load - AK q - AC u + B f, and of the energy, of rate -sum tally_i f_i v_i:
 *     df/dy = (df/da) J [-AK, -AC, 0] + (df/dv) [0, J, 0],
 *     df/dt = (df/dlimit) limit' - (df/dv) b' + (df/da) (J load' - b''); df_dt in: the first term.
 * Overwrites v, a, f and dv_dt of sys->work. Returns a status. */
static int write_rows(tribo_system *sys, const struct tangents *d, double *dfdy, double *dfdt)
{
    const size_t n = sys->ndof, m = sys->ncontact, size = 2 * n + 1;
    const struct matrix *b = &sys->response, *j = &sys->direction;
    double *rates = dfdy + n * size, *energy = dfdy + 2 * n * size, *dv_dt = sys->work.dv_dt;
    memset(dfdy, 0, size * size * sizeof *dfdy);
    for (size_t i = 0; i < n; i++) {
        dfdy[i * size + n + i] = 1.0;
        tribo_matrix_add_row(&sys->stiffness, i, -1.0, rates + i * size);
        if (sys->damping.rows) {
            tribo_matrix_add_row(&sys->damping, i, -1.0, rates + i * size + n);
        }
    }
    const int status = jacobian_add_normals(sys, size, rates, d->df_dy);
    if (status) {
        return status;
    }
    jacobian_add_product(m, 1.0, d->df_da, j, n, d->pull);
    tribo_multiply_add(m, n, size, 1.0, d->pull, rates, d->df_dy);
    jacobian_add_product(m, 1.0, d->df_dv, j, size, d->df_dy + n);
    tribo_matrix_add_columns(b, 1.0, size, d->df_dy, rates);
    for (size_t i = 0; i < m; i++) {
        sys->work.v[i] *= -sys->tally[i];
        sys->work.f[i] *= -sys->tally[i];
        dv_dt[i] = sys->work.a[i] = 0.0;
    }
    tribo_multiply_add(1, m, size, 1.0, sys->work.v, d->df_dy, energy);
    jacobian_add_product(1, 1.0, sys->work.f, j, 0, energy + n);
    if (dfdt) {
        memset(d->load, 0, n * sizeof *d->load);
        tribo_system_loads(sys, DRIVES_LOAD, 1, 1.0, d->load);
        tribo_system_loads(sys, DRIVES_BASE, 1, -1.0, dv_dt);
        tribo_system_loads(sys, DRIVES_BASE, 2, -1.0, sys->work.a);
        tribo_matrix_multiply_add(j, 1.0, d->load, sys->work.a);
        tribo_multiply_add(m, m, 1, 1.0, d->df_dv, dv_dt, d->df_dt);
        tribo_multiply_add(m, m, 1, 1.0, d->df_da, sys->work.a, d->df_dt);
        memset(dfdt, 0, size * sizeof *dfdt);
        memcpy(dfdt + n, d->load, n * sizeof *dfdt);
        tribo_matrix_multiply_add(b, 1.0, d->df_dt, dfdt + n);
        dfdt[2 * n] = tribo_dot(sys->work.v, d->df_dt, m) + tribo_dot(sys->work.f, dv_dt, m);
    }
    return TRIBO_OK;
}

/* With u = q':  u' = load - AK q - AC u + B f,  f = f(v, a),  v = J u - b,  a = J (load - AK q - AC u) - b'. */
int tribo_system_jacobian(tribo_system *sys, double t, const double *y, double *dfdy, double *dfdt)
{
    if (!sys || tribo_system_begin_rates(sys, "the Jacobian", y, "dfdy", dfdy)) {
        return sys ? sys->status : TRIBO_ERR_NULL;
    }
    const size_t n = sys->ndof, m = sys->ncontact;
    const size_t dropping = sys->normals.count ? tribo_system_first_dropping(sys, 0) : m;
    if (dropping < m) {
        return sys->status =
                   tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                               "contact %zu has a static limit, beside limits that follow normal loads, as of contact %zu, "
                               "and the Jacobian lacks its derivatives: take an explicit method, moreau/fixed or event",
                               dropping, sys->normals.follower[0].contact);
    }
    struct tangents d;
    sys->jacobians++;
    if (!ALLOCATE(ARRAY(d.df_dv, m * m), ARRAY(d.df_da, m * m), ARRAY(d.pull, m * n), ARRAY(d.df_dy, m * (2 * n + 1)),
                  ARRAY(d.df_dt, m), ARRAY(d.load, n))) {
        return sys->status = tribo_error(sys->message, TRIBO_ERR_MEMORY, "out of memory for the Jacobian");
    }
    tribo_system_free_motion(sys, t, y, d.load, sys->work.v, sys->work.a);
    int status = TRIBO_OK;
    for (size_t k = 0; k < sys->normals.count; k++) { /* df_dt is for the state as it is */
        sys->normals.normal[k].speed = 0.0;
    }
    if (sys->loads.limits) { /* df_dt = (df/dlimit) limit', by a difference over a short time */
        const double fastest = tribo_system_fastest(sys), later = SHORT / (fastest > 0.0 ? fastest : 1.0);
        tribo_system_put_limits(sys, later);
        status = tribo_balance(sys->contacts, sys->work.v, sys->work.a, NULL, sys->work.dv_dt);
        tribo_system_put_limits(sys, 0.0);
        status = status ? status : tribo_balance(sys->contacts, sys->work.v, sys->work.a, NULL, sys->work.f);
        for (size_t i = 0; !status && i < m; i++) {
            d.df_dt[i] = (sys->work.dv_dt[i] - sys->work.f[i]) / later;
        }
    }
    status =
        status ? status : tribo_balance_tangent(sys->contacts, sys->work.v, sys->work.a, NULL, sys->work.f, d.df_dv, d.df_da);
    if (status) {
        tribo_system_explain(sys, status);
        const int found = tribo_system_check_state(sys, t, y); /* names the value of y that is not finite */
        sys->status = found ? found : status;
    } else {
        sys->status = write_rows(sys, &d, dfdy, dfdt);
    }
    free(d.df_dv);
    return sys->status;
}
