/* SPDX-License-Identifier: BSD-3-Clause */
/* What results.f90 does from Fortran, through the C interface: data that both read, and a tape of results to compare with, see
 * tape.h. */
#include <string.h>

#include "tape.h"
#include "tribo/tribo.h"

#define N 4
#define NDOF 6
#define STATES 5
#define COUNTS 10
#define REALS 3

/* gfortran takes it for granted that they are aligned as its own arrays would be. */
#if defined(__GNUC__)
#define ALIGNED __attribute__((aligned(32)))
#else
#define ALIGNED
#endif

ALIGNED double scene_limit[N] = {0.5, 0.25, 0.0, 1.5};
ALIGNED double scene_epsilon[N] = {1e-2, 2e-2, 3e-2, 4e-2};

/* R in five forms that differ. The last are J diag(1/m) J' and J M^-1 J' with M^-1 as in accelerate, of rank 3: the partition
 * coupling fails where contacts 0, 1 and 3 may all stick. */
ALIGNED double scene_diagonal[N] = {1.0, 2.0, 0.5, 0.0};
ALIGNED double scene_dense[N][N] = {{2.0, -0.5, 0.1, 0.3}, {-0.5, 1.5, 0.2, 0.0}, {0.1, 0.2, 1.0, -0.4}, {0.3, 0.0, -0.4, 3.0}};
ALIGNED size_t scene_rowptr[N + 1] = {0, 2, 4, 5, 8};
ALIGNED size_t scene_col[8] = {3, 0, 1, 3, 2, 3, 0, 1};
ALIGNED double scene_val[8] = {0.25, 1.0, 2.0, -0.5, 0.7, 1.25, 0.25, -0.5};
ALIGNED double scene_inverse_mass[NDOF] = {1.0, 0.5, 0.0, 2.0, 4.0, 0.25};
ALIGNED size_t scene_j_rowptr[N + 1] = {0, 1, 3, 4, 5};
ALIGNED size_t scene_j_col[5] = {0, 0, 1, 5, 1};
ALIGNED double scene_j_val[5] = {1.0, -1.0, 1.0, 2.0, 1.0};
ALIGNED double scene_shared = 0.125;

ALIGNED double scene_v[STATES][N] = {{0.0, 0.0, 0.0, 0.0},
                                     {1e-3, -2e-3, 0.3, 1e-2},
                                     {-5e-3, 1.9e-2, 1e-3, -0.5},
                                     {2e-3, 1e-3, -1e-3, -3e-3},
                                     {0.4, -0.6, 0.2, 0.1}};
ALIGNED double scene_a[STATES][N] = {
    {0.1, -0.2, 0.3, 0.15}, {0.6, 0.1, -0.2, 0.9}, {-0.3, 0.7, 0.1, 5.0}, {0.05, 0.02, -3.0, -0.1}, {1.0, 2.0, 3.0, 4.0}};
ALIGNED double scene_feq[STATES][N] = {
    {0.1, -0.3, 0.2, 0.4}, {0.7, 0.2, 0.0, -1.0}, {0.3, 0.1, 0.1, 2.5}, {-0.6, 0.2, 0.3, 1.6}, {0.0, 0.0, 0.0, 0.0}};

ALIGNED double scene_lower[N] = {-0.2, -0.1, 0.0, -1.0};
ALIGNED double scene_upper[N] = {0.3, -0.05, 0.5, 2.0};

static void registry(void)
{
    put_one(tribo_version());
    put_text(tribo_version_string());
    for (int status = -1; status < 64; status++) {
        put_text(tribo_strerror(status));
    }
    put_one(tribo_law_count());
    for (int law = -1; law <= tribo_law_count(); law++) {
        put_text(tribo_law_name(law));
        put_text(tribo_law_reference(law));
        for (size_t i = 0; i < N; i++) {
            double f[4] = {0.0, 0.0, 0.0, 0.0};
            put_one(
                tribo_law_eval(law, scene_v[3][i], scene_feq[3][i], scene_limit[i], scene_epsilon[i], f, f + 1, f + 2, f + 3));
            put(4, f);
        }
    }
    double f[2][N], d[2][2 * N];
    for (int plane = 0; plane < 2; plane++) {
        memcpy(f[plane], scene_feq[3], sizeof f[plane]);
        put_one(plane ? tribo_elastic_force_planar(N / 2, scene_v[3], scene_epsilon, scene_limit, f[1], d[1])
                      : tribo_elastic_force(N, scene_v[3], scene_epsilon, scene_limit, f[0], d[0]));
        put(N, f[plane]);
        put(plane ? 2 * N : N, d[plane]);
    }
    double force[6], df[18];
    memcpy(force, scene_feq + 3, sizeof force);
    put_one(tribo_contact_force(2, scene_v[3], scene_limit, scene_diagonal, scene_diagonal, scene_epsilon, force, df));
    put(6, force);
    put(18, df);
    for (int law = 0; law < 4; law++) {
        double parameter[2][6], state[2][5] = {{0.0}}, z[2] = {0.0, 0.0}, slope[2];
        for (int k = 0; k < 12; k++) { /* a Bouc-Wen exponent of 1 */
            parameter[k / 6][k % 6] = law == 2 && (k == 4 || k == 9) ? 1.0 : scene_epsilon[k % N] + 0.25;
        }
        double *const p = parameter[0], *const forces = f[0];
        forces[0] = forces[1] = 0.0;
        put_one(law == 0   ? tribo_dahl_force(2, scene_v[3], scene_epsilon, scene_limit, forces, slope)
                : law == 1 ? tribo_lugre_force(2, 0.5, scene_v[3], p, z, forces, slope)
                : law == 2 ? tribo_bouc_wen_force(2, scene_v[3], p, z, forces, slope)
                           : tribo_iwan_force(2, 1, scene_v[3], p, state[0], forces, slope));
        put(2, forces);
        put(2, slope);
        put(2, z);
        put(10, state[0]);
    }
}

static void settings(const tribo_context *c)
{
    size_t n = 0;
    int law = -1, coupling = -1, sharing = -1;
    double x[N] = {0.0}, velocity[N] = {0.0};
    put_one(tribo_get_ncontact(c, &n));
    put_one((double)n);
    put_one(tribo_get_law(c, &law));
    put_one(law);
    put_one(tribo_get_coupling(c, &coupling));
    put_one(coupling);
    put_one(tribo_get_sharing(c, &sharing));
    put_one(sharing);
    put_one(tribo_get_limit(c, x));
    put(N, x);
    put_one(tribo_get_static(c, x, velocity));
    put(N, x);
    put(N, velocity);
    put_one(tribo_get_epsilon(c, x));
    put(N, x);
}

static void queries(const tribo_context *c)
{
    signed char mode[N] = {9, 9, 9, 9};
    put_one(tribo_get_slip(c, mode));
    for (size_t i = 0; i < N; i++) {
        put_one(mode[i]);
    }
    for (int which = 0; which < COUNTS; which++) {
        size_t count = 0;
        put_one(tribo_get_count(c, which, &count));
        put_one((double)count);
    }
    for (int which = 0; which < REALS; which++) {
        double value = 0.0;
        put_one(tribo_get_real(c, which, &value));
        put_one(value);
    }
}

static void forces(tribo_context *c)
{
    for (size_t k = 0; k < STATES; k++) {
        const double *v = scene_v[k], *a = scene_a[k], *feq = scene_feq[k];
        double f[N] = {0.0}, x[3][N] = {{0.0}}, df_dv[N * N] = {0.0}, df_da[N * N] = {0.0};
        put_one(tribo_force(c, v, feq, f));
        put(N, f);
        put_one(tribo_force_tangent(c, v, feq, f, x[0], x[1], x[2]));
        put(N, f);
        put(3 * N, x[0]);
        put_one(tribo_balance(c, v, a, x[0], f));
        put(N, x[0]);
        put(N, f);
        queries(c);
        put_one(tribo_balance_tangent(c, v, a, x[0], f, df_dv, df_da));
        put(N, x[0]);
        put(N, f);
        put(N * N, df_dv);
        put(N * N, df_da);
        put_one(tribo_tangent_product(c, feq, a, x[0]));
        put_one(tribo_tangent_product(c, feq, NULL, x[1]));
        put_one(tribo_tangent_product(c, NULL, a, x[2]));
        put(3 * N, x[0]);
        put_one(tribo_limit_product(c, a, x[0]));
        put(N, x[0]);
        put_one(tribo_step_force(c, 0.125, v, f));
        put(N, f);
        queries(c);
        put_one(tribo_step_force_mean(c, 0.125, a, v, f));
        put(N, f);
        put_one(tribo_solve_box(c, a, scene_lower, scene_upper, f));
        put(N, f);
        put_one(tribo_accept(c, v, feq));
    }
}

/* M^-1 = diag(1/m) and the same entry everywhere. With the data above all sums are exact, in whatever order. */
static int accelerate(size_t ndof, const double *force, double *acceleration, void *data)
{
    const double *shared = data;
    double sum = 0.0;
    for (size_t i = 0; i < ndof; i++) {
        sum += *shared * force[i];
    }
    for (size_t i = 0; i < ndof; i++) {
        acceleration[i] = scene_inverse_mass[i] * force[i] + sum;
    }
    return 0;
}

static void set_operator(tribo_context *c, int form)
{
    switch (form) {
    case 0:
        put_one(tribo_set_operator_diagonal(c, scene_diagonal));
        put_one(tribo_update_operator(c, scene_diagonal));
        break;
    case 1:
        put_one(tribo_set_operator_dense(c, scene_dense[0]));
        break;
    case 2:
        put_one(tribo_set_operator_csr(c, scene_rowptr, scene_col, scene_val));
        put_one(tribo_update_operator(c, scene_val));
        break;
    case 3:
        put_one(tribo_set_operator_mass(c, NDOF, scene_inverse_mass, scene_j_rowptr, scene_j_col, scene_j_val));
        put_one(tribo_update_operator(c, scene_j_val));
        break;
    default:
        put_one(tribo_set_operator_callback(c, NDOF, accelerate, &scene_shared, scene_j_rowptr, scene_j_col, scene_j_val));
    }
}

static void planar(tribo_context *c)
{
    const size_t first = 1;
    double feq[N] = {0.0}, f[N] = {0.0}, x[3][2 * N] = {{0.0}};
    put_one(tribo_set_planar(c, 1, &first));
    for (size_t k = 0; k < STATES; k++) {
        put_one(tribo_balance(c, scene_v[k], scene_a[k], feq, f));
        put(N, feq);
        put(N, f);
        queries(c);
        put_one(tribo_force_tangent_planar(c, scene_v[k], scene_feq[k], f, x[0], x[1], x[2]));
        put(N, f);
        put(6 * N, x[0]);
        put_one(tribo_step_force_mean(c, 0.125, scene_a[k], scene_v[k], f));
        put(N, f);
        queries(c);
    }
    put_one(tribo_set_planar(c, 0, NULL));
}

void scene_play(void)
{
    registry();

    double ratio[N];
    tribo_context *c = NULL, *copy = NULL;
    put_one(tribo_create(&c, N));
    put_text(tribo_message(c));
    settings(c);
    queries(c);
    put_one(tribo_set_normal_load(c, scene_epsilon, scene_limit));
    settings(c);
    put_one(tribo_set_limit(c, scene_limit));
    put_one(tribo_set_epsilon(c, scene_epsilon));
    settings(c);
    for (int form = 0; form < 5; form++) {
        set_operator(c, form);
        for (int setting = 0; setting < 3; setting++) {
            put_one(tribo_set_coupling(c, setting % 2));
            put_one(tribo_set_sharing(c, setting / 2));
            for (int law = 0; law < tribo_law_count(); law++) {
                put_one(tribo_set_law(c, law));
                settings(c);
                forces(c);
            }
        }
    }
    put_one(tribo_set_coupling(c, TRIBO_CONSISTENT));
    planar(c);
    put_one(tribo_set_epsilon_step(c, 0.01, 0.4));
    settings(c);
    put_one(tribo_set_epsilon_step(c, 0.01, 1.0));
    settings(c);
    forces(c);
    for (size_t i = 0; i < N; i++) {
        ratio[i] = 1.0 + 32.0 * scene_epsilon[i];
    }
    for (int falls = 0; falls < 2; falls++) {
        put_one(tribo_set_static(c, ratio, falls ? scene_epsilon : NULL));
        settings(c);
        forces(c);
    }
    put_one(tribo_set_epsilon_all(c, 0.03125));
    put_one(tribo_set_limit_all(c, 0.75));
    settings(c);
    put_one(tribo_clone(c, &copy));
    put_one(tribo_copy_settings(copy, c));
    put_one(tribo_set_law(c, TRIBO_SMOOTH));
    forces(c);
    settings(copy);
    queries(copy);
    forces(copy);
    put_one(tribo_fix_operator(copy));
    tribo_destroy(c);
    tribo_destroy(copy);
}
