/* SPDX-License-Identifier: BSD-3-Clause */
/* Static limits, and such that fall with the speed, that follow harmonics, with lift-off: closed forms, an integration of its
 * own, and methods against each other. */
#include <string.h>

#include "make.h"
#include "coulomb.h"
#include "model.h"

static const char *const methods[] = {"exact", "event"};
#define TOLERANCE 1e-13

static void set_static(tribo_system *sys, double ratio, double velocity)
{
    const double r[] = {ratio, ratio, ratio}, v[] = {velocity, velocity, velocity};
    assert_ok(tribo_set_static(tribo_system_context(sys), r, velocity > 0.0 ? v : NULL));
}

static void add_limit(tribo_system *sys, double omega, double c, double s)
{
    assert_ok(tribo_system_add_limit(sys, omega, &c, &s));
}

static void add_load(tribo_system *sys, double omega, double c, double s)
{
    assert_ok(tribo_system_add_load(sys, omega, &c, &s));
}

/* Goes from t to end; returns the events. */
static size_t go(tribo_system *sys, const char *method, double t, double end, double *y)
{
    tribo_driver *drv = driver_create(sys, method, 1.0, TOLERANCE);
    driver_advance(drv, &t, end, y);
    const size_t events = driver_count(drv, TRIBO_COUNT_EVENTS);
    tribo_driver_destroy(drv);
    return events;
}

/* ------------------------------------------------------------------------------------------------------- closed forms */

/* Load 1, limits to stick 1.2 - 0.45 sin t and to slide 0.8 - 0.3 sin t: let go where sin t = 4/9. */
TEST(let_go)
{
    const double begin = asin(4.0 / 9.0), end = 3.0, s = end - begin;
    double y[3] = {0.25, 0.0, 0.0};
    tribo_system *sys = block(1.0, 0.0, 0.8);
    set_static(sys, 1.5, 0.0);
    add_limit(sys, 1.0, 0.0, -0.3);
    add_load(sys, 0.0, 1.0, 0.0);
    ck_assert_uint_eq(go(sys, methods[_i], 0.0, begin - 1e-9, y), 0);
    assert_exact(y[1], 0.0);
    ck_assert_uint_eq(go(sys, methods[_i], 0.0, end, y), 1);
    const double v = 0.2 * s + 0.3 * (cos(begin) - cos(end)), x = 0.1 * s * s + 0.3 * (s * cos(begin) - sin(end) + sin(begin));
    assert_close(y[1], v, 1e-11);
    assert_close(y[0], 0.25 + x, 1e-11);
    assert_close(y[2], x - 0.5 * v * v, 1e-11);
    tribo_system_destroy(sys);
}

/* A spring pulls with 0.5; the limit to stick comes down to 0.5 and goes up again: the block stays. A little less, and it slides
 * on at half of it. */
TEST(grazing)
{
    const double less[] = {0.0, 1e-15, 1e-2};
    for (size_t k = 0; k < COUNT(less); k++) {
        double y[3] = {0.5, 0.0, 0.0};
        tribo_system *sys = block(1.0, 1.0, 0.5 - less[k]);
        set_static(sys, 2.0, 0.0);
        add_limit(sys, 1.0, 0.25, 0.0);
        const size_t events = go(sys, methods[_i], 0.0, 6.0, y);
        if (k < 2) {
            ck_assert_uint_eq(events, 0);
            assert_exact(y[0], 0.5);
        } else {
            require(y[0] < 0.2 && y[2] > 0.0, "x = %.17g, energy %g", y[0], y[2]);
        }
        tribo_system_destroy(sys);
    }
}

/* Limits max(0, -sin t) to stick and half of that to slide, load b sin 2t: touches down at t = pi without velocity or load. It
 * sticks if the load grows no faster than the limit to stick, b <= 1/2, and else slides. */
TEST(touches_down)
{
    const double bs[] = {0.4, 0.5, 0.6, 0.5 - 1e-7, 0.5 + 1e-3};
    for (size_t k = 0; k < COUNT(bs); k++) {
        const double b = bs[k], s = 0.05;
        double y[3] = {0.0};
        tribo_system *sys = block(1.0, 0.0, 0.0);
        set_static(sys, 2.0, 0.0);
        add_limit(sys, 1.0, 0.0, -0.5);
        add_load(sys, 2.0, 0.0, b);
        if (b <= 0.5) {
            go(sys, methods[_i], 0.0, 2.0 * PI, y);
            assert_close(y[0], 0.5 * b * PI, 1e-12);
            assert_close(y[1], 0.0, 1e-12);
        } else {
            go(sys, methods[_i], 0.0, PI + s, y);
            assert_close(y[1], b * sin(s) * sin(s) - sin(0.5 * s) * sin(0.5 * s), 1e-11);
        }
        tribo_system_destroy(sys);
    }
}

/* The same from later times on: what the velocity at t = pi is the sum of then cancels but for rounding, and it sticks. */
TEST(touches_down_by_rounding)
{
    const double bs[] = {0.37, 0.43, 0.49};
    for (size_t k = 0; k < COUNT(bs); k++) {
        for (int j = 0; j < 10; j++) {
            const double b = bs[k], t = 0.3 * j;
            double y[3] = {0.5 * b * (t - 0.5 * sin(2.0 * t)), b * sin(t) * sin(t), 0.0};
            tribo_system *sys = block(1.0, 0.0, 0.0);
            set_static(sys, 2.0, 0.0);
            add_limit(sys, 1.0, 0.0, -0.5);
            add_load(sys, 2.0, 0.0, b);
            go(sys, methods[_i], t, 2.0 * PI, y);
            assert_close(y[0], 0.5 * b * PI, 1e-12);
            assert_close(y[1], 0.0, 1e-12);
            tribo_system_destroy(sys);
        }
    }
}

/* Rests with a load of 0.3 until the limit to stick, 0.6 + 1.2 cos t, has fallen to it; lifts off where the limit to slide, half
 * of that, is 0. */
TEST(lifts_off)
{
    const double begin = acos(-0.25), off = 2.0 * PI / 3.0, end = 2.5;
    double y[3] = {0.0};
    tribo_system *sys = block(1.0, 0.0, 0.3);
    set_static(sys, 2.0, 0.0);
    add_limit(sys, 1.0, 0.6, 0.0);
    add_load(sys, 0.0, 0.3, 0.0);
    ck_assert_uint_eq(go(sys, methods[_i], 0.0, end, y), 2);
    assert_close(y[1], 0.6 * (sin(begin) - sin(off)) + 0.3 * (end - off), 1e-11);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------------ many contacts */

/* Two contacts that hold one body share what there is, as one with the sum of their limits. */
TEST(doubled)
{
    const double one = 1.0, direction[] = {1.0, 1.0}, load[] = {0.7}, sine[] = {0.4}, even[] = {0.2, 0.2}, uneven[] = {0.3, 0.1};
    for (int k = 0; k < 2; k++) {
        double y[3] = {0.0}, z[3] = {0.0};
        const double *part = k ? uneven : even;
        tribo_system *sys, *single = block(1.0, 1.0, 0.4);
        assert_ok(dense_system(&sys, 1, 2, &one, NULL, &one, direction, 0, NULL, 0));
        assert_ok(tribo_set_limit(tribo_system_context(sys), part));
        assert_ok(tribo_system_add_limit(sys, 0.8, part, NULL));
        add_limit(single, 0.8, 0.4, 0.0);
        assert_ok(tribo_system_add_load(sys, 0.5, load, sine));
        assert_ok(tribo_system_add_load(single, 0.5, load, sine));
        set_static(sys, 1.5, 0.0);
        set_static(single, 1.5, 0.0);
        go(sys, methods[_i], 0.0, 40.0, y);
        go(single, methods[_i], 0.0, 40.0, z);
        require(z[2] > 0.1, "nothing slides: %g", z[2]);
        assert_all_close(y, z, 3, 1e-10);
        tribo_system_destroy(sys);
        tribo_system_destroy(single);
    }
}

/* A random structure on moving bases with limits that swing, some of them below 0. */
static tribo_system *swinging(int seed)
{
    struct random g = random_of(seed);
    const struct model m = model_create(&g, seed % 2);
    tribo_system *sys = model_system(&m, seed % 4 == 1, 0, 2e-4);
    double c[CONTACTS], s[CONTACTS];
    model_swing(sys, &g, c, s);
    return sys;
}

/* Limits that drop: the two methods that locate events come to the same. */
TEST(located_methods_agree)
{
    double y[2][DIMENSION] = {{0.7, 0.0, -0.5}, {0.7, 0.0, -0.5}};
    tribo_system *sys = swinging(_i);
    set_static(sys, 1.1 + 0.1 * (_i % 7), 0.0);
    for (int k = 0; k < 2; k++) {
        go(sys, methods[k], 0.0, 8.0, y[k]);
    }
    const char *off = differences("event", y[1], y[0], DIMENSION, 1e-9);
    require(!off, "seed %d: %s", _i, off);
    tribo_system_destroy(sys);
}

/* Limits that fall with the speed: steps come to the same. */
TEST(steps_agree)
{
    static const char *const steps[] = {"rk4/fixed", "central/fixed", "moreau/fixed"};
    double want[DIMENSION] = {0.7, 0.0, -0.5};
    tribo_system *sys = swinging(_i);
    set_static(sys, 1.3, 0.5);
    go(sys, "event", 0.0, 5.0, want);
    for (size_t k = 0; k < COUNT(steps); k++) {
        const double dt = k == 0 ? 5e-5 : 2e-4; /* and the law's epsilon */
        double y[DIMENSION] = {0.7, 0.0, -0.5};
        assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), dt));
        run(sys, steps[k], dt, 0.0, 5.0, y);
        const char *off = differences(steps[k], y, want, DIMENSION, 3e-3);
        require(!off, "seed %d: %s", _i, off);
    }
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------------ falling friction */

/* y'' = 1 - y/10 - N, N = max(0.5 + cos t, 0) (1 + 0.8 exp(-y'/0.7)), forward. */
static void rate(double t, const double *y, double *d)
{
    const double limit = fmax(0.5 + cos(t), 0.0) * (1.0 + 0.8 * exp(-y[1] / 0.7));
    d[0] = y[1];
    d[1] = 1.0 - 0.1 * y[0] - limit;
    d[2] = limit * y[1];
}

static void rk4(double t, double h, double *y)
{
    double k[4][3], at[3];
    rate(t, y, k[0]);
    for (int s = 1; s < 4; s++) {
        const double part = s == 3 ? h : 0.5 * h;
        for (int i = 0; i < 3; i++) {
            at[i] = y[i] + part * k[s - 1][i];
        }
        rate(t + part, at, k[s]);
    }
    for (int i = 0; i < 3; i++) {
        y[i] += h / 6.0 * (k[0][i] + 2.0 * k[1][i] + 2.0 * k[2][i] + k[3][i]);
    }
}

/* Slides, flies and slides again, always forward. */
TEST(falls_and_swings)
{
    const double until[] = {0.0, 2.0 * PI / 3.0, 4.0 * PI / 3.0, 4.7};
    const int steps = 4000;
    double want[3] = {-9.0, 1.0, 0.0}, y[3] = {-9.0, 1.0, 0.0}, slowest = HUGE_VAL;
    for (int part = 0; part < 3; part++) {
        const double h = (until[part + 1] - until[part]) / steps;
        for (int k = 0; k < steps; k++) {
            rk4(until[part] + k * h, h, want);
            slowest = fmin(slowest, want[1]);
        }
    }
    tribo_system *sys = block(1.0, 0.1, 0.5);
    set_static(sys, 1.8, 0.7);
    add_limit(sys, 1.0, 1.0, 0.0);
    add_load(sys, 0.0, 1.0, 0.0);
    ck_assert_uint_eq(go(sys, "event", 0.0, until[3], y), 2);
    require(slowest > 0.0, "turns back: %g", slowest);
    assert_all_close(y, want, 3, 1e-10);
    tribo_system_destroy(sys);
}

/* A body rests on a contact that holds 1.2 while another one drags at it on a belt that turns back: at that instant both rest,
 * and then the first one holds as before. */
TEST(turning_belt)
{
    static const char *const each[] = {"exact", "event", "central/fixed", "moreau/fixed"};
    const double mass = 1.0, stiffness = 0.0, direction[] = {1.0, 1.0}, limit[] = {0.1, 0.8}, ratio[] = {1.0, 1.5}, load = 1.0,
                 belt[] = {0.4, 0.0};
    double y[3] = {0.0}, t = 0.0;
    tribo_system *sys;
    assert_ok(dense_system(&sys, 1, 2, &mass, NULL, &stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    assert_ok(tribo_set_static(tribo_system_context(sys), ratio, NULL));
    assert_ok(tribo_system_add_load(sys, 0.0, &load, NULL));
    assert_ok(tribo_system_add_base_motion(sys, 1.0, NULL, belt));
    tribo_driver *drv = driver_create(sys, each[_i], 0.01, 1e-10);
    const int status = tribo_driver_advance(drv, &t, 20.0, y);
    require(status == TRIBO_OK, "%s: status %d, and the body is at %g", each[_i], status, y[0]);
    assert_close(y[0], 0.0, 1e-12);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST_MAIN("static_limits", {let_go, 2}, {grazing, 2}, {touches_down, 2}, {touches_down_by_rounding, 2}, {lifts_off, 2},
          {doubled, 2}, {located_methods_agree, 40}, {steps_agree, 8}, {falls_and_swings, 1}, {turning_belt, 4})
