/* SPDX-License-Identifier: BSD-3-Clause */
/* The Jacobian that implicit methods are given, against differences of the right-hand side. */
#include <stdlib.h>
#include <string.h>

#include "model.h"

#define LARGEST 17
#define SYSTEMS 7 /* of the last two one has limits that vary, and one is reduced */
#define STEP 1e-6

static void rate_of(const gsl_odeiv2_system *ode, double t, const double *y, double *dydt)
{
    ck_assert_int_eq(ode->function(t, y, dydt, ode->params), GSL_SUCCESS);
}

/* d(dydt)/dy_j, or /dt for j = dimension, where no kink is near; answers how many entries that were. */
static size_t check_column(const gsl_odeiv2_system *ode, double t, const double *y, size_t j, const double *derivative,
                           size_t stride)
{
    double at[LARGEST], rate[3][LARGEST];
    size_t smooth = 0;
    for (int k = -1; k <= 1; k++) {
        memcpy(at, y, ode->dimension * sizeof *y);
        at[j < ode->dimension ? j : 0] += j < ode->dimension ? k * STEP : 0.0;
        rate_of(ode, j < ode->dimension ? t : t + k * STEP, at, rate[k + 1]);
    }
    for (size_t i = 0; i < ode->dimension; i++) {
        const double forward = (rate[2][i] - rate[1][i]) / STEP, backward = (rate[1][i] - rate[0][i]) / STEP;
        const double got = derivative[i * stride], size = 1.0 + fabs(got);
        if (fabs(forward - backward) < 2e-4 * size) {
            /* rounding of a rate of up to 100 leaves 1e-8 */
            assert_close(got, 0.5 * (forward + backward), 1e-6 * size);
            smooth++;
        }
    }
    return smooth;
}

static void check_jacobian(tribo_system *sys, struct random *g)
{
    const gsl_odeiv2_system *ode = tribo_gsl_system(sys);
    const size_t n = ode->dimension;
    double y[LARGEST], dfdy[LARGEST * LARGEST], dfdt[LARGEST];
    size_t smooth = 0;
    for (int k = 0; k < 20; k++) {
        const double t = uniform(g, 0.0, 9.0);
        for (size_t i = 0; i < n; i++) {
            y[i] = uniform(g, -0.5, 0.5);
        }
        if (k % 3 == 0) {
            assert_ok(tribo_system_accept(sys, t, y)); /* sets some memory bits */
        }
        stain(dfdy, sizeof dfdy);
        stain(dfdt, sizeof dfdt);
        ck_assert_int_eq(ode->jacobian(t, y, dfdy, dfdt, ode->params), GSL_SUCCESS);
        for (size_t j = 0; j < n; j++) {
            smooth += check_column(ode, t, y, j, dfdy + j, n);
        }
        smooth += check_column(ode, t, y, n, dfdt, 1);
    }
    ck_assert_uint_gt(smooth, 20 * n * (n + 1) * 9 / 10);
}

static tribo_system *system_of(struct random *g, int which)
{
    const struct model m = model_create(g, which == 3);
    tribo_system *sys = NULL;
    switch (which) {
    case 0:
        assert_ok(tribo_system_oscillator(&sys, 1.0, 1.5, 0.5));
        break;
    case 1:
        assert_ok(tribo_system_chain(&sys, 8, 1.0, 0.25, 0.5));
        break;
    case 2:
        assert_ok(tribo_system_belt(&sys, 2.0, 0.5, 0.25, 1.0, 0.5));
        break;
    case 3:
    case 4:
    case 5:
        sys = model_system(&m, 1, 0, 1.0);
        break;
    default:
        sys = model_system(&m, 0, 4, 1.0);
        assert_ok(tribo_system_set_damping_ratio(sys, 0.05));
    }
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 0.5));
    if (which == SYSTEMS - 2) {
        assert_ok(tribo_system_add_limit(sys, 0.7, m.motion[0], m.motion[1]));
    }
    return sys;
}

/* Without Coulomb's law: its derivatives are zero wherever v is not. */
static const int laws[] = {TRIBO_VELOCITY_LIMITED, TRIBO_SMOOTH, TRIBO_KARNOPP, TRIBO_QUINN, TRIBO_QUINN_REVERSAL};

TEST(jacobians)
{
    struct random g = random_of(_i);
    tribo_system *sys = system_of(&g, _i % SYSTEMS);
    assert_ok(tribo_set_law(tribo_system_context(sys), laws[(size_t)(_i / SYSTEMS) % COUNT(laws)]));
    for (int coupling = 0; coupling < 2; coupling++) {
        assert_ok(tribo_set_coupling(tribo_system_context(sys), coupling));
        check_jacobian(sys, &g);
    }
    tribo_system_destroy(sys);
}

/* Three masses of 1 with springs between them; contacts 0 and 1 along the first mass and between the first two, a planar contact
 * 2, 3 on the others, one at zero and one that shares it; two normals, which are pressed in about half of the states. */
static tribo_system *following(int planar)
{
    const double mass[4] = {1.0, 1.2, 0.8, 1.5}, j[6 * 4] = {1.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.3, 0.0, 0.0, 1.0, 0.2,
                                                             0.0, 0.5, 0.0, 1.0, 0.0, 1.0,  0.4, 0.0, 0.3, 0.0, 0.0, -1.0};
    const double stiffness[16] = {3.0, -1.0, 0.0, 0.5, -1.0, 4.0, -0.3, 0.0, 0.0, -0.3, 2.0, 0.0, 0.5, 0.0, 0.0, 2.5};
    tribo_model *model;
    tribo_system *sys;
    assert_ok(tribo_model_create(&model, 4, 6));
    assert_ok(tribo_model_set_mass_diagonal(model, mass));
    assert_ok(tribo_model_set_stiffness(model, stiffness));
    assert_ok(tribo_model_set_direction(model, j));
    assert_ok(tribo_model_set_normal(model, 0, 4, 0.7, 6.0, -0.1));
    assert_ok(tribo_model_set_normal(model, 1, 4, 0.3, 6.0, -0.1));
    assert_ok(tribo_model_set_normal(model, 2, 5, 0.5, 8.0, 0.05));
    assert_ok(tribo_system_create(&sys, model));
    tribo_model_destroy(model);
    assert_ok(tribo_system_add_load(sys, 1.1, (const double[]){1.0, 2.0, 0.5, -1.0}, NULL));
    assert_ok(tribo_set_planar(tribo_system_context(sys), planar ? 1 : 0, (const size_t[]){2}));
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 0.5));
    return sys;
}

/* Limits that follow the motion: their derivatives by the displacement. One more contact has a limit that changes with time. */
TEST(limits_that_follow)
{
    struct random g = random_of(_i);
    tribo_system *sys = following(_i % 2);
    assert_ok(tribo_set_law(tribo_system_context(sys), _i % 4 < 2 ? TRIBO_QUINN : TRIBO_SMOOTH));
    if (_i % 2 == 0) {
        assert_ok(tribo_system_add_limit(sys, 0.7, (const double[]){0.0, 0.0, 0.0, 0.4, 0.0, 0.0}, NULL));
    }
    check_jacobian(sys, &g);
    tribo_system_destroy(sys);
}

/* Implicit steps of GSL arrive where explicit ones do. */
TEST(implicit_steps)
{
    double y[2][9] = {{0.3, 0.2, -0.1, 0.1}, {0.3, 0.2, -0.1, 0.1}};
    for (int k = 0; k < 2; k++) {
        tribo_system *sys = following(_i);
        tribo_driver *d;
        double t = 0.0;
        assert_ok(tribo_gsl_driver_create(&d, sys, k ? "rkf45" : "bsimp"));
        assert_ok(tribo_driver_set_tolerance(d, 1e-11, 0.0));
        assert_ok(tribo_driver_advance(d, &t, 3.0, y[k]));
        tribo_driver_destroy(d);
        tribo_system_destroy(sys);
    }
    for (size_t i = 0; i < 9; i++) {
        assert_close(y[0][i], y[1][i], 1e-6);
    }
}

/* Damping that comes after the first Jacobian is in the next one. */
TEST(jacobian_after_new_damping)
{
    struct random g = random_of(_i);
    tribo_system *sys = system_of(&g, SYSTEMS - 1);
    for (int k = 0; k < 3; k++) {
        assert_ok(tribo_system_set_damping_ratio(sys, 0.1 * k));
        check_jacobian(sys, &g);
    }
    tribo_system_destroy(sys);
}

TEST(jacobian_of_bad_states)
{
    double y[3] = {0.0, NAN, 0.0}, dfdy[9], dfdt[3], dydt[3];
    tribo_system *sys = oscillator(TRIBO_QUINN, 1.0, 1.0);
    const gsl_odeiv2_system *ode = tribo_gsl_system(sys);
    ck_assert_int_ne(ode->jacobian(0.0, y, dfdy, dfdt, ode->params), GSL_SUCCESS);
    ck_assert_int_ne(ode->function(0.0, y, dydt, ode->params), GSL_SUCCESS);
    tribo_system_destroy(sys);
}

TEST_MAIN("jacobian", {jacobians, SYSTEMS *COUNT(laws)}, {limits_that_follow, 4}, {implicit_steps, 2},
          {jacobian_after_new_damping, 1}, {jacobian_of_bad_states, 1})
