/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar contacts with static friction above kinetic in the drivers: closed forms of the line, along turned axes. */
#include "make.h"
#include "run.h"

static const char *const methods[] = {"rk4/fixed", "central/fixed", "moreau/fixed"};

static void set_static(tribo_system *sys, double limit, double ratio, double velocity)
{
    const double ratios[2] = {ratio, ratio}, velocities[2] = {velocity, velocity};
    tribo_context *c = tribo_system_context(sys);
    assert_ok(tribo_set_planar(c, 1, (const size_t[]){0}));
    assert_ok(tribo_set_limit_all(c, limit));
    assert_ok(tribo_set_static(c, ratios, velocity > 0.0 ? velocities : NULL));
}

/* A block of mass 1 on springs of 1, kinetic limit 0.6 and static one 1, on a belt that runs at 0.2 along e. */
static tribo_system *block(const double *e, double velocity)
{
    const double one[4] = {1.0, 0.0, 0.0, 1.0}, belt[2] = {0.2 * e[0], 0.2 * e[1]};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 2, one, NULL, one, one, 0, NULL, 0));
    assert_ok(tribo_system_add_base_motion(sys, 0.0, belt, NULL));
    set_static(sys, 0.6, 1.0 / 0.6, velocity);
    return sys;
}

/* From its sticking at x = 0.2 along e: y at t, in steps of dt. */
static void ride(const double *e, const char *method, double velocity, double dt, double t, double *y)
{
    tribo_system *sys = block(e, velocity);
    for (int k = 0; k < 2; k++) {
        y[k] = y[2 + k] = 0.2 * e[k];
    }
    y[4] = 0.0;
    assert_ok(tribo_set_epsilon_step(tribo_system_context(sys), dt, 1.0));
    run(sys, method, dt, 0.0, t, y);
    tribo_system_destroy(sys);
}

/* Largest error of place and velocity along e, and across it, where nothing moves. */
static double error_of(const double *y, const double *e, double x, double v)
{
    const double along[2] = {e[0] * y[0] + e[1] * y[1], e[0] * y[2] + e[1] * y[3]};
    assert_close(e[0] * y[1] - e[1] * y[0], 0.0, 1e-9);
    assert_close(e[0] * y[3] - e[1] * y[2], 0.0, 1e-9);
    return fmax(fabs(along[0] - x), fabs(along[1] - v));
}

/* Stick-slip along 45 degrees: t_stick = 2 D/(k v0), t_slip = 2 (pi - atan(D/v0)), the slip an arc of amplitude
 * sqrt(D^2 + v0^2) about 0.6; D = 0.4, v0 = 0.2. Of first order. */
TEST(belt)
{
    const double e[2] = {sqrt(0.5), sqrt(0.5)}, d = 0.4, v0 = 0.2;
    const double period = 2.0 * d / v0 + 2.0 * (PI - atan(d / v0)), until[2] = {2.0 * period + 3.0, 2.0 * period + 4.0 + 1.5};
    const double x[2] = {0.2 + 0.2 * 3.0, 0.6 + d * cos(1.5) + v0 * sin(1.5)}, v[2] = {v0, v0 * cos(1.5) - d * sin(1.5)};
    const double dts[2] = {4e-3, 5e-4};
    double error[2], y[5];
    assert_close(period, 8.0688878716, 1e-10);
    for (int stage = 0; stage < 2; stage++) {
        for (int k = 0; k < 2; k++) {
            ride(e, methods[_i], 0.0, dts[k], until[stage], y);
            error[k] = error_of(y, e, x[stage], v[stage]);
        }
        require(error[0] < 0.03 && error[1] < 4e-3, "%s: errors %g, %g", methods[_i], error[0], error[1]);
    }
    assert_close(hypot(e[0] * y[0] + e[1] * y[1] - 0.6, e[0] * y[2] + e[1] * y[3]), hypot(d, v0), 2e-3);
    /* from rest to slip the belt takes what the spring stores and friction dissipates */
    require(y[4] > 0.0, "dissipated %g", y[4]);
}

/* A limit that falls with the speed: as the same driver does it on a line. */
TEST(falling)
{
    const double e[2] = {0.6, -0.8}, one = 1.0, speed = 0.2, ratio = 1.0 / 0.6, velocity = 0.3, dt = 1e-3;
    double y[5], line[3] = {0.2, 0.2, 0.0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 1, 1, &one, NULL, &one, &one, 0, NULL, 0));
    assert_ok(tribo_system_add_base_motion(sys, 0.0, &speed, NULL));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.6));
    assert_ok(tribo_set_static(tribo_system_context(sys), &ratio, &velocity));
    assert_ok(tribo_set_epsilon_step(tribo_system_context(sys), dt, 1.0));
    run(sys, methods[_i], dt, 0.0, 20.0, line);
    tribo_system_destroy(sys);
    ride(e, methods[_i], velocity, dt, 20.0, y);
    require(error_of(y, e, line[0], line[1]) < 1e-7, "%s: off by %g", methods[_i], error_of(y, e, line[0], line[1]));
    assert_close(y[4], line[2], 1e-7);
}

/* Code_Aster SDND106 in the plane, along an axis turned by 0.7: two masses of 5 on a spring of 1e4, limits 3000 and 2000 on the
 * first one, 3000 pulling at the second one until t = 0.2. */
TEST(code_aster_sdnd106)
{
    enum { N = 4 };
    const double k = 1e4, e[2] = {cos(0.7), sin(0.7)}, load[N] = {0.0, 0.0, 3000.0 * e[0], 3000.0 * e[1]};
    const double direction[2 * N] = {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0}, dt = 2e-5;
    double mass[N * N] = {0.0}, stiffness[N * N] = {0.0}, y[2 * N + 1] = {0.0}, t = 0.0;
    for (size_t i = 0; i < N; i++) {
        mass[i * N + i] = 5.0;
        stiffness[i * N + i] = k;
        stiffness[i * N + (i + 2) % N] = -k;
    }
    tribo_system *sys;
    assert_ok(dense_system(&sys, N, 2, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 0.0, load, NULL));
    set_static(sys, 2000.0, 1.5, 0.0);
    assert_ok(tribo_set_epsilon_step(tribo_system_context(sys), dt, 1.0));
    tribo_driver *drv = driver_create(sys, methods[_i], dt, 0.0);
    driver_advance(drv, &t, 0.15, y);
    assert_close(e[0] * y[0] + e[1] * y[1], 1.3533376609, 1e-3);
    assert_close(e[0] * y[2] + e[1] * y[3], 1.8075324662, 1e-3);
    driver_advance(drv, &t, 0.2, y);
    assert_ok(tribo_system_clear_loads(sys));
    driver_advance(drv, &t, 0.3149232754, y);
    assert_close(e[0] * y[0] + e[1] * y[1], 3.9556057735, 2e-3);
    assert_close(e[0] * y[1] - e[1] * y[0], 0.0, 1e-9);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST_MAIN("planar_static", {belt, 3}, {falling, 3}, {code_aster_sdnd106, 3})
