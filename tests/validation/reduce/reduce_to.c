/* SPDX-License-Identifier: BSD-3-Clause */
/* Reduction to a tolerance: as many modes as the bound of truncation asks for, and not many more. Damping matrices of reduced
 * structures: beside the same matrices without reduction. */
#include <math.h>
#include <string.h>

#include "make.h"
#include "beam.h"
#include "run.h"

/* The beam with two contacts and the place of a load. */
static tribo_model *beam(void)
{
    gsl_spmatrix *mass = beam_matrix("M.mtx"), *stiffness = beam_matrix("K.mtx"), *j = gsl_spmatrix_alloc(3, BEAM_DOFS);
    tribo_model *model;
    gsl_spmatrix_set(j, 0, 100, 1.0);
    gsl_spmatrix_set(j, 1, 201, 1.0);
    gsl_spmatrix_set(j, 1, 141, -1.0);
    gsl_spmatrix_set(j, 2, 280, 1.0);
    assert_ok(tribo_model_create(&model, BEAM_DOFS, 3));
    assert_ok(tribo_gsl_model_set_mass(model, mass));
    assert_ok(tribo_gsl_model_set_stiffness(model, stiffness));
    assert_ok(tribo_gsl_model_set_direction(model, j));
    gsl_spmatrix_free(mass);
    gsl_spmatrix_free(stiffness);
    gsl_spmatrix_free(j);
    return model;
}

TEST(bounds)
{
    static const double tolerance[] = {0.1, 1e-2, 1e-4};
    const int statics = 1 + _i % 2;
    const double omega = _i < 2 ? 0.0 : _i < 4 ? 700.0 : 9000.0;
    tribo_model *model = beam();
    size_t last = 0;
    for (size_t k = 0; k < 3; k++) {
        tribo_system *sys, *less;
        double error, worse = HUGE_VAL;
        assert_ok(tribo_system_reduce_to(&sys, model, omega, tolerance[k], statics));
        assert_ok(tribo_system_get_truncation(sys, omega, &error));
        const size_t n = tribo_system_ndof(sys), modes = n > 3 ? n - 3 : 0;
        require(error <= tolerance[k], "%zu motions: %g above %g", n, error, tolerance[k]);
        require(n >= last, "%zu motions for %g, %zu for %g", n, tolerance[k], last, tolerance[k - (k > 0)]);
        if (modes > 8 && omega > 0.0) {
            assert_ok(tribo_system_reduce(&less, model, modes - modes / 4 - 2, statics));
            assert_ok(tribo_system_get_truncation(less, omega, &worse));
            require(worse > tolerance[k], "%zu modes and more, but %g with three quarters of them is below %g", modes, worse,
                    tolerance[k]);
            tribo_system_destroy(less);
        }
        last = n;
        tribo_system_destroy(sys);
    }
    require(omega < 1000.0 || last > 12, "%zu motions up to %g", last, omega);
    tribo_model_destroy(model);
}

#define REFUSED(call, expected, text)                                                                                            \
    require((call) == (expected) && strstr(tribo_model_message(model), text), "%s", tribo_model_message(model))

TEST(errors)
{
    enum { N = 3 };
    const double one[N] = {1.0, 1.0, 1.0}, k[N] = {1.0, 2.0, 3.0}, j[N] = {1.0, 1.0, 1.0};
    tribo_model *model;
    tribo_system *sys = NULL;
    double error;
    assert_ok(tribo_model_create(&model, N, 1));
    REFUSED(tribo_system_reduce_to(&sys, model, 1.0, 0.1, 1), TRIBO_ERR_STATE, "mass has not been set");
    assert_ok(tribo_model_set_mass_diagonal(model, one));
    assert_ok(tribo_model_set_stiffness_diagonal(model, k));
    assert_ok(tribo_model_set_direction(model, j));
    require(tribo_system_reduce_to(&sys, NULL, 1.0, 0.1, 1) == TRIBO_ERR_NULL, "model");
    REFUSED(tribo_system_reduce_to(NULL, model, 1.0, 0.1, 1), TRIBO_ERR_NULL, "sys is NULL");
    REFUSED(tribo_system_reduce_to(&sys, model, NAN, 0.1, 1), TRIBO_ERR_NOT_FINITE, "omega = nan is not finite");
    REFUSED(tribo_system_reduce_to(&sys, model, -1.0, 0.1, 1), TRIBO_ERR_NEGATIVE, "omega = -1 is negative");
    REFUSED(tribo_system_reduce_to(&sys, model, 1.0, HUGE_VAL, 1), TRIBO_ERR_NOT_FINITE, "tolerance = inf is not finite");
    REFUSED(tribo_system_reduce_to(&sys, model, 1.0, 0.0, 1), TRIBO_ERR_NOT_POSITIVE, "tolerance = 0 is not positive");
    REFUSED(tribo_system_reduce_to(&sys, model, 1.0, 0.1, 3), TRIBO_ERR_RANGE, "static_contacts = 3");
    require(sys == NULL, "a system after an error");
    for (int statics = 0; statics < 2; statics++) {
        assert_ok(tribo_system_reduce_to(&sys, model, 100.0, 1e-9, statics));
        assert_ok(tribo_system_get_truncation(sys, 100.0, &error));
        require(tribo_system_ndof(sys) == N && error <= 1e-9, "%zu modes, %g", tribo_system_ndof(sys), error);
        tribo_system_destroy(sys);
    }
    tribo_model_destroy(model);
}

/* ------------------------------------------------------------------------------------------------------------- damping */

enum { N = 5, C = 2 };
static const double mass[N] = {1.0, 2.0, 0.5, 1.5, 1.0}, directions[C * N] = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0};

static void fill(double *stiffness, double *damping, int proportional)
{
    memset(stiffness, 0, N * N * sizeof *stiffness);
    memset(damping, 0, N * N * sizeof *damping);
    for (size_t i = 0; i < N; i++) {
        stiffness[i * N + i] = 3.0 + (double)i;
        if (i) {
            stiffness[i * N + i - 1] = stiffness[(i - 1) * N + i] = -1.0;
        }
    }
    for (size_t i = 0; i < N * N; i++) {
        damping[i] = proportional ? 0.03 * stiffness[i] + (i % (N + 1) == 0 ? 0.02 * mass[i / N] : 0.0) : 0.0;
    }
    if (!proportional) {
        damping[1 * N + 1] = 0.2;
        damping[3 * N + 3] = damping[4 * N + 4] = 0.1;
        damping[3 * N + 4] = damping[4 * N + 3] = -0.1;
    }
}

/* Reduced to all modes, or to fewer and the static responses that are missing, a damped structure is the whole one; with springs
 * before its sliders, too. */
TEST(damping)
{
    static const char *const method[] = {"exact", "event"};
    const int proportional = _i & 1, springs = (_i >> 1) & 1;
    const double soft[C] = {0.0, 0.4}, limit[C] = {0.2, 0.3}, load[N] = {1.0, 0.0, 0.5, 0.0, -0.5};
    double stiffness[N * N], damper[N * N], place[2][N], energy[2];
    fill(stiffness, damper, proportional);
    for (int reduced = 0; reduced < 2; reduced++) {
        tribo_model *model;
        tribo_system *sys;
        tribo_driver *drv;
        double y[2 * N + C + 1] = {0.0}, t = 0.0;
        assert_ok(tribo_model_create(&model, N, C));
        assert_ok(tribo_model_set_mass_diagonal(model, mass));
        assert_ok(tribo_model_set_damping(model, damper));
        assert_ok(tribo_model_set_stiffness(model, stiffness));
        assert_ok(tribo_model_set_direction(model, directions));
        assert_ok(tribo_model_set_compliance(model, springs ? soft : (double[C]){0.0}));
        assert_ok(reduced ? tribo_system_reduce(&sys, model, springs ? N : 3, springs ? TRIBO_STATICS_NONE : TRIBO_STATICS_MASS)
                          : tribo_system_create(&sys, model));
        assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
        assert_ok(tribo_system_add_load(sys, 1.3, NULL, load));
        assert_ok(tribo_driver_create(&drv, sys, method[_i >> 2]));
        assert_ok(tribo_driver_advance(drv, &t, 30.0, y));
        energy[reduced] = y[tribo_system_dimension(sys) - 1];
        if (reduced) {
            assert_ok(tribo_system_expand(sys, y, place[1]));
        } else {
            memcpy(place[0], y, sizeof place[0]);
        }
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
        tribo_model_destroy(model);
    }
    for (size_t i = 0; i < N; i++) {
        assert_close(place[1][i], place[0][i], 1e-9);
    }
    assert_close(energy[1], energy[0], 1e-9);
    require(energy[0] > 0.1, "friction dissipates %g", energy[0]);
}

TEST(damping_refused)
{
    double stiffness[N * N], damper[N * N];
    tribo_model *model;
    tribo_system *sys;
    fill(stiffness, damper, 0);
    assert_ok(tribo_model_create(&model, N, C));
    assert_ok(tribo_model_set_mass_diagonal(model, mass));
    assert_ok(tribo_model_set_damping(model, damper));
    assert_ok(tribo_model_set_stiffness(model, stiffness));
    assert_ok(tribo_model_set_direction(model, directions));
    REFUSED(tribo_system_reduce(&sys, model, 3, TRIBO_STATICS_COMPLIANCE), TRIBO_ERR_UNSUPPORTED, "takes no damping matrix");
    tribo_model_destroy(model);
}

TEST_MAIN("reduce_to", {bounds, 6}, {errors, 1}, {damping, 8}, {damping_refused, 1})
