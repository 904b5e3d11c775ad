/* SPDX-License-Identifier: BSD-3-Clause */
/* Bases that follow a table, in every method; and bases that move no more. */
#include <math.h>
#include <string.h>

#include "make.h"
#include "run.h"

enum { BODIES = 2, STATE = 2 * BODIES + 1, KNOTS = 4 };

static const char *const methods[] = {"event", "auto", "central/fixed", "moreau/fixed", "rk4/fixed", "rkf45", "msbdf"};
static const double one_step[] = {0.1, 0.1, 1e-3, 1e-3, 1e-4, 1e-3, 1e-3};
static const double time[KNOTS] = {0.5, 1.0, 2.5, 3.0}, value[KNOTS] = {0.0, 1.0, -0.5, 0.25}, pattern[BODIES] = {2.0, -1.0};

/* Masses 2 and 1, coupled by a spring or not, each on a belt. */
static tribo_system *belts(double limit, double spring)
{
    const double mass[BODIES * BODIES] = {2.0, 0.0, 0.0, 1.0}, direction[BODIES * BODIES] = {1.0, 0.0, 0.0, 1.0};
    const double stiffness[BODIES * BODIES] = {3.0 + spring, -spring, -spring, 1.0 + spring};
    tribo_system *sys = NULL;
    char text[200] = "";
    require(!dense_system(&sys, BODIES, BODIES, mass, NULL, stiffness, direction, 0, text, sizeof text), "%s", text);
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), limit));
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 2e-3));
    return sys;
}

/* The integral of the table from 0 to t, piece by piece; and its value there. */
static double way(double t, double *speed)
{
    double sum = 0.0, begin = 0.0, b = value[0];
    for (size_t k = 0; k <= KNOTS; k++) {
        const double end = k < KNOTS ? fmin(t, time[k]) : t;
        const double slope = k == 0 || k == KNOTS ? 0.0 : (value[k] - value[k - 1]) / (time[k] - time[k - 1]);
        if (end > begin) {
            sum += (end - begin) * (b + 0.5 * slope * (end - begin));
            b += slope * (end - begin);
            begin = end;
        }
    }
    *speed = b;
    return sum;
}

/* Contacts that never slip take their bodies along. */
TEST(stuck)
{
    const int approximate = _i >= 4; /* laws of the context, which creep */
    tribo_system *sys = belts(20.0, _i % 2 ? 0.7 : 0.0);
    assert_ok(tribo_system_add_base_table(sys, KNOTS, time, value, pattern));
    tribo_driver *drv = driver_create(sys, methods[_i], one_step[_i], 1e-10);
    double y[STATE] = {0.0}, t = 0.0, b;
    for (double end = 0.25; end <= 4.0; end += 0.25) {
        assert_ok(tribo_driver_advance(drv, &t, end, y));
        const double moved = way(end, &b);
        for (size_t i = 0; i < BODIES; i++) {
            const double error = approximate ? 1e-2 : _i >= 2 ? 2e-3 : 1e-13;
            require(fabs(y[i] - pattern[i] * moved) < error, "%s: at t = %g q[%zu] = %.17g, not %.17g", methods[_i], end, i, y[i],
                    pattern[i] * moved);
            require(fabs(y[BODIES + i] - pattern[i] * b) < error, "%s: at t = %g q'[%zu] = %.17g, not %.17g", methods[_i], end, i,
                    y[BODIES + i], pattern[i] * b);
        }
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* A mass of 1 on a spring of 1 and a belt of velocity t: stuck, q = t^2/2, until 1 + q = limit = 3; then it slides back around
 * 3. */
TEST(breaks_away)
{
    const double ramp[2] = {0.0, 10.0}, one = 1.0, mass = 1.0;
    tribo_system *sys = NULL;
    char text[200] = "";
    require(!dense_system(&sys, 1, 1, &mass, NULL, &one, &one, 0, text, sizeof text), "%s", text);
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 3.0));
    assert_ok(tribo_system_add_base_table(sys, 2, ramp, ramp, &one));
    tribo_driver *drv = driver_create(sys, "event", 1.0, 1e-12);
    double y[3] = {0.0}, t = 0.0, v, feq, f;
    assert_ok(tribo_driver_advance(drv, &t, 1.5, y));
    assert_ok(tribo_system_contacts(sys, t, y, &v, &feq, &f));
    assert_close(v, 0.0, 1e-13);
    assert_close(feq, 1.0 + 1.125, 1e-12);
    assert_ok(tribo_driver_advance(drv, &t, 4.0, y));
    const double leaves = 2.0, s = t - leaves; /* q = 2, q' = 2 there */
    assert_close(y[0], 3.0 - cos(s) + 2.0 * sin(s), 1e-11);
    assert_close(y[1], sin(s) + 2.0 * cos(s), 1e-11);
    /* friction dissipates 3 times the way of the belt past the mass */
    assert_close(y[2], 3.0 * (0.5 * (t * t - leaves * leaves) - (y[0] - 2.0)), 1e-10);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Motions with sticking and slipping by a fixed step, beside event. */
TEST(slip)
{
    tribo_system *sys[] = {belts(0.8, 0.7), belts(0.8, 0.7)};
    tribo_driver *drv[2];
    double y[2][STATE] = {{0.0}}, t[2] = {0.0, 0.0};
    for (int k = 0; k < 2; k++) {
        assert_ok(tribo_system_add_base_table(sys[k], KNOTS, time, value, pattern));
        assert_ok(tribo_system_add_base_motion(sys[k], 1.7, pattern, NULL));
        drv[k] = driver_create(sys[k], methods[k * (2 + _i)], one_step[k * (2 + _i)], 1e-11);
        assert_ok(tribo_driver_advance(drv[k], &t[k], 5.0, y[k]));
    }
    for (size_t i = 0; i < STATE; i++) {
        require(fabs(y[0][i] - y[1][i]) < 2e-3, "%s: y[%zu] = %.17g, not %.17g", methods[2 + _i], i, y[1][i], y[0][i]);
    }
    require(y[0][STATE - 1] > 0.5, "friction dissipates %g only", y[0][STATE - 1]);
    for (int k = 0; k < 2; k++) {
        tribo_driver_destroy(drv[k]);
        tribo_system_destroy(sys[k]);
    }
}

/* Once base motions are taken away nothing of them is left, also not in a driver that has followed them. */
TEST(cleared)
{
    const double omega = 1.3;
    const int automatic = _i == 1, table = _i % 2 == 0 || automatic;
    for (double limit = 0.5; limit < 100.0; limit *= 100.0) {
        tribo_system *sys[] = {belts(limit, 0.7), belts(limit, 0.7)};
        tribo_driver *drv[2];
        double y[2][STATE] = {{0.0}}, t[2] = {0.0, 0.0};
        if (table) {
            assert_ok(tribo_system_add_base_table(sys[0], KNOTS, time, value, pattern));
        } else {
            assert_ok(tribo_system_add_base_motion(sys[0], omega, NULL, pattern));
        }
        drv[0] = driver_create(sys[0], methods[_i], one_step[_i], 1e-10);
        assert_ok(tribo_driver_advance(drv[0], &t[0], 1.7, y[0]));
        assert_ok(tribo_system_clear_base_motion(sys[0]));
        for (size_t i = 0; i < STATE; i++) {
            y[0][i] = y[1][i] = i < BODIES ? 0.3 : 0.0;
        }
        t[1] = t[0];
        drv[1] = driver_create(sys[1], methods[_i], one_step[_i], 1e-10);
        for (int k = 0; k < 2; k++) {
            assert_ok(tribo_driver_advance(drv[k], &t[k], 4.1, y[k]));
        }
        for (size_t i = 0; i < STATE; i++) {
            require(fabs(y[0][i] - y[1][i]) < 1e-9, "%s: y[%zu] = %.17g, not %.17g", methods[_i], i, y[0][i], y[1][i]);
        }
        for (int k = 0; k < 2; k++) {
            tribo_driver_destroy(drv[k]);
            tribo_system_destroy(sys[k]);
        }
    }
}

#define REFUSED(call, expected, text)                                                                                            \
    require((call) == (expected) && strstr(tribo_system_message(sys), text), "%s", tribo_system_message(sys))

TEST(errors)
{
    const double bad[BODIES] = {1.0, NAN}, late[KNOTS] = {0.0, 1.0, 1.0, 2.0};
    tribo_system *sys = belts(1.0, 0.0), *copy;
    require((tribo_system_add_base_table(NULL, KNOTS, time, value, pattern)) == TRIBO_ERR_NULL, "status");
    REFUSED(tribo_system_add_base_table(sys, 0, time, value, pattern), TRIBO_ERR_SIZE, "knots = 0");
    REFUSED(tribo_system_add_base_table(sys, KNOTS, time, value, NULL), TRIBO_ERR_NULL, "pattern is NULL");
    REFUSED(tribo_system_add_base_table(sys, KNOTS, late, value, pattern), TRIBO_ERR_RANGE, "time[2] = 1 is not after");
    REFUSED(tribo_system_add_base_table(sys, KNOTS, time, value, bad), TRIBO_ERR_NOT_FINITE, "pattern[1] = nan is not finite");
    assert_ok(tribo_system_add_base_table(sys, KNOTS, time, value, pattern));
    tribo_driver *drv;
    assert_ok(tribo_driver_create(&drv, sys, "auto"));
    double y[STATE] = {0.0}, t = 0.0, z[STATE] = {0.0}, s = 0.0;
    require((tribo_driver_find_periodic(drv, 0.0, 1.0, y)) == TRIBO_ERR_UNSUPPORTED, "status");
    assert_ok(tribo_system_clear_loads(sys)); /* bases go on */
    assert_ok(tribo_driver_advance(drv, &t, 2.0, y));
    tribo_driver_destroy(drv);
    assert_ok(tribo_system_clone(sys, &copy));
    assert_ok(tribo_driver_create(&drv, copy, "exact"));
    assert_ok(tribo_driver_advance(drv, &s, 2.0, z));
    require(memcmp(y, z, sizeof y) == 0 && y[0] != 0.0, "a copy goes to q[0] = %.17g, not %.17g", z[0], y[0]);
    tribo_driver_destroy(drv);
    tribo_system_destroy(copy);
    tribo_system_destroy(sys);
}

TEST_MAIN("base_tables", {stuck, 7}, {breaks_away, 1}, {slip, 5}, {cleared, 7}, {errors, 1})
