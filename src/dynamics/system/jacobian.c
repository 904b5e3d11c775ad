/* The Jacobian of a system's right-hand side, for implicit integrators: dense, with derivatives of the contact forces. */
#include "system.h"

#include <stdlib.h>
#include <string.h>

/* Dense matrices in sys->dense: AK, AC [ndof][ndof], J [ncontact][ndof], B [ndof][ncontact]; df/dv, df/da [ncontact][ncontact];
 * df/dq, df/du [ncontact][ndof]; workspace pull [ncontact][ndof], load [ndof]. */
struct dense {
    double *stiffness, *damping, *direction, *response, *df_dv, *df_da, *df_dq, *df_du, *pull, *load;
};

static struct dense dense_of(const tribo_system *sys)
{
    const size_t n = sys->ndof, m = sys->ncontact;
    struct dense d;
    d.stiffness = sys->dense;
    d.damping = d.stiffness + n * n;
    d.direction = d.damping + n * n;
    d.response = d.direction + m * n;
    d.df_dv = d.response + n * m;
    d.df_da = d.df_dv + m * m;
    d.df_dq = d.df_da + m * m;
    d.df_du = d.df_dq + m * n;
    d.pull = d.df_du + m * n;
    d.load = d.pull + m * n;
    return d;
}

static int jacobian_expand(const struct matrix *a, double *to)
{
    double *from = tribo_matrix_to_dense(a);
    if (from) {
        memcpy(to, from, a->rows * a->cols * sizeof *to);
    }
    free(from);
    return from != NULL;
}

static int create_dense(tribo_system *sys)
{
    const size_t n = sys->ndof, m = sys->ncontact;
    sys->dense = calloc(2 * n * n + 5 * m * n + 2 * m * m + n + 1, sizeof *sys->dense);
    if (!sys->dense) {
        return 0;
    }
    const struct dense d = dense_of(sys);
    if (jacobian_expand(&sys->stiffness, d.stiffness) && (!sys->damping.rows || jacobian_expand(&sys->damping, d.damping)) &&
        jacobian_expand(&sys->direction, d.direction) && jacobian_expand(&sys->response, d.response)) {
        return 1;
    }
    free(sys->dense);
    sys->dense = NULL;
    return 0;
}

/* Time step of finite differences, times the highest frequency. */
#define SHORT 1e-7

/* df_dt [ncontact] = (df/dlimit) limit', by a difference over a short time; 0 if limits are constant. Returns a status. */
static int find_limit_rates(tribo_system *sys, double *df_dt)
{
    const double fastest = tribo_system_fastest(sys), later = SHORT / (fastest > 0.0 ? fastest : 1.0);
    if (!tribo_system_limits_vary(sys)) {
        memset(df_dt, 0, sys->ncontact * sizeof *df_dt);
        return TRIBO_OK;
    }
    tribo_system_put_limits(sys, later);
    int status = tribo_balance(sys->contacts, sys->v, sys->a, NULL, sys->dv_dt);
    tribo_system_put_limits(sys, 0.0);
    status = status ? status : tribo_balance(sys->contacts, sys->v, sys->a, NULL, sys->f);
    for (size_t i = 0; !status && i < sys->ncontact; i++) {
        df_dt[i] = (sys->dv_dt[i] - sys->f[i]) / later;
    }
    return tribo_system_explain(sys, status);
}

/* pull = (df/da) J,  df/dq = -pull AK,  df/du = (df/dv) J - pull AC */
static void follow_state(size_t n, size_t m, const struct dense *d)
{
    memset(d->df_dq, 0, 3 * m * n * sizeof *d->df_dq);
    tribo_multiply_add(m, m, n, 1.0, d->df_da, d->direction, d->pull);
    tribo_multiply_add(m, n, n, -1.0, d->pull, d->stiffness, d->df_dq);
    tribo_multiply_add(m, n, n, -1.0, d->pull, d->damping, d->df_du);
    tribo_multiply_add(m, m, n, 1.0, d->df_dv, d->direction, d->df_du);
}

/* df_dt = -(df/dv) b' + (df/da) (J load' - b'') + (df/dlimit) limit'; df_dt in: the last term. d->load = load'. */
static void follow_time(tribo_system *sys, const struct dense *d, double *df_dt)
{
    const size_t n = sys->ndof, m = sys->ncontact;
    memset(d->load, 0, n * sizeof *d->load);
    memset(sys->dv_dt, 0, m * sizeof *sys->dv_dt);
    memset(sys->a, 0, m * sizeof *sys->a);
    tribo_system_loads(sys, DRIVES_LOAD, 1, 1.0, d->load);
    tribo_system_loads(sys, DRIVES_BASE, 1, -1.0, sys->dv_dt);
    tribo_system_loads(sys, DRIVES_BASE, 2, -1.0, sys->a);
    tribo_matrix_multiply_add(&sys->direction, 1.0, d->load, sys->a);
    tribo_multiply_add(m, m, 1, 1.0, d->df_dv, sys->dv_dt, df_dt);
    tribo_multiply_add(m, m, 1, 1.0, d->df_da, sys->a, df_dt);
}

/* Writes the rows of u' = load - AK q - AC u + B f; dfdy is 0 there before the call. */
static void write_motion(const tribo_system *sys, const struct dense *d, const double *df_dt, double *dfdy, double *dfdt)
{
    const size_t n = sys->ndof, m = sys->ncontact, size = tribo_system_dimension(sys);
    for (size_t i = 0; i < n; i++) {
        double *row = dfdy + (n + i) * size;
        for (size_t j = 0; j < n; j++) {
            row[j] = -d->stiffness[i * n + j];
            row[n + j] = -d->damping[i * n + j];
        }
        tribo_multiply_add(1, m, n, 1.0, d->response + i * m, d->df_dq, row);
        tribo_multiply_add(1, m, n, 1.0, d->response + i * m, d->df_du, row + n);
        if (dfdt) {
            dfdt[n + i] = d->load[i];
            tribo_multiply_add(1, m, 1, 1.0, d->response + i * m, df_dt, dfdt + n + i);
        }
    }
}

/* Writes the row of the energy, of rate -sum tally_i f_i v_i. Overwrites sys->v and d->pull. */
static void write_power(tribo_system *sys, const struct dense *d, const double *df_dt, double *row, double *dfdt)
{
    const size_t n = sys->ndof, m = sys->ncontact;
    double *f = d->pull;
    for (size_t i = 0; i < m; i++) {
        sys->v[i] *= sys->tally[i];
        f[i] = sys->tally[i] * sys->f[i];
    }
    tribo_multiply_add(1, m, n, -1.0, sys->v, d->df_dq, row);
    tribo_multiply_add(1, m, n, -1.0, sys->v, d->df_du, row + n);
    tribo_multiply_add(1, m, n, -1.0, f, d->direction, row + n);
    if (dfdt) {
        tribo_multiply_add(1, m, 1, -1.0, sys->v, df_dt, dfdt);
        tribo_multiply_add(1, m, 1, -1.0, f, sys->dv_dt, dfdt);
    }
}

/* With u = q':  u' = load - AK q - AC u + B f,  f = f(v, a),  v = J u - b,  a = J (load - AK q - AC u) - b'. */
int tribo_system_jacobian(tribo_system *sys, double t, const double *y, double *dfdy, double *dfdt)
{
    if (!sys) {
        return TRIBO_ERR_NULL;
    }
    const size_t n = sys->ndof, size = tribo_system_dimension(sys);
    sys->jacobians++;
    sys->status = tribo_system_take_settings(sys);
    sys->status = sys->status ? sys->status : tribo_system_check_rates(sys, "the Jacobian");
    if (!sys->status && (!y || !dfdy)) {
        sys->status = tribo_system_fail(sys, TRIBO_ERR_NULL, "%s is NULL", y ? "dfdy" : "y");
    }
    if (!sys->status && !sys->dense && !create_dense(sys)) {
        sys->status = tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the Jacobian");
    }
    if (sys->status) {
        return sys->status;
    }
    const struct dense d = dense_of(sys);
    double *df_dt = sys->feq;
    /* at (t, y): sys->f, df_dv, df_da, df_dt */
    tribo_system_free_motion(sys, t, y, d.load, sys->v, sys->a);
    const int status = find_limit_rates(sys, df_dt);
    sys->status = status ? status
                         : tribo_system_explain(sys, tribo_balance_tangent(sys->contacts, sys->v, sys->a, NULL, sys->f, d.df_dv,
                                                                           d.df_da));
    if (sys->status) {
        const int found = tribo_system_check_state(sys, t, y); /* names the value of y that is not finite */
        return sys->status = found ? found : sys->status;
    }
    follow_state(n, sys->ncontact, &d);
    follow_time(sys, &d, df_dt);
    memset(dfdy, 0, size * size * sizeof *dfdy);
    if (dfdt) {
        memset(dfdt, 0, size * sizeof *dfdt);
    }
    for (size_t i = 0; i < n; i++) {
        dfdy[i * size + n + i] = 1.0;
    }
    write_motion(sys, &d, df_dt, dfdy, dfdt);
    write_power(sys, &d, df_dt, dfdy + 2 * n * size, dfdt ? dfdt + 2 * n : NULL);
    return TRIBO_OK;
}
