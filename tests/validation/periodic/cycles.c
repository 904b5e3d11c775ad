/* SPDX-License-Identifier: BSD-3-Clause */
/* Cycles, whose period is unknown: reference values of stick-slip and squeal, from poor guesses; an unstable cycle without
 * events; cycles that are independent of each other; states of rest, and loads in time. */
#include "run.h"
#include "squeal.h"

#include <string.h>

static const char *const methods[] = {"exact", "event", "auto"};

/* Equal blocks, m = k = 1, on a belt at speed v0, of which block i has a spring k (1 + differ i). Limits 0.6 while sliding, ratio
 * times that at rest; falls: velocity by which they fall, 0: at once. damping: of each block. */
static tribo_system *blocks(size_t count, double ratio, double falls, double v0, double damping, double differ)
{
    double mass[4] = {1.0}, k[4] = {1.0}, j[4] = {1.0}, c[4] = {damping}, belt[2] = {v0, v0};
    const double ratios[2] = {ratio, ratio}, velocity[2] = {falls, falls};
    if (count == 2) {
        mass[3] = 1.0;
        k[3] = 1.0 + differ;
        j[3] = 1.0;
        c[3] = damping;
    }
    tribo_system *sys = finish_model(dense_model(count, count, mass, c, k, j));
    assert_ok(tribo_system_add_base_motion(sys, 0.0, belt, NULL));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.6));
    assert_ok(tribo_set_static(tribo_system_context(sys), ratios, falls > 0.0 ? velocity : NULL));
    return sys;
}

static void find_cycle(tribo_driver *d, double *period, double *y)
{
    const int status = tribo_driver_find_cycle(d, 0.5, period, y);
    require(!status, "%s", tribo_driver_message(d));
}

static void cycle_free(tribo_driver *d, tribo_system *sys)
{
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

/* The limit drops at once: closed form. From rest without a guess of the period, from afar, from three periods; the state begins
 * as the block breaks away; another search from it changes nothing; the motion has the period; a period's energy is the belt's
 * work. */
TEST(drops)
{
    static const double guess[] = {0.0, 8.0, 24.2, 1.0};
    static const double from[] = {0.0, 40.0, 3.0, -7.0};
    const double d = 0.4, v0 = 0.2, stick = 2.0 * d / v0, slip = 2.0 * (acos(-1.0) - atan(d / v0)), c[] = {1.0, 0.0};
    tribo_system *sys = blocks(1, 1.0 / 0.6, 0.0, v0, 0.0, 0.0);
    tribo_driver *drv = driver_create(sys, methods[_i % 3], 1e-3, 1e-13);
    double y[3] = {from[_i / 3], 0.0, 3.0}, period = guess[_i / 3], re[2], im[2], least, most, energy, share, at;
    find_cycle(drv, &period, y);
    const int kind = TRIBO_PARAMETER_LIMIT;
    const size_t contact = 0;
    assert_status(tribo_driver_period_derivatives(drv, 1, &kind, &contact, NULL, NULL, &energy, NULL), TRIBO_ERR_UNSUPPORTED);
    assert_close(period, 8.0688878716, 1e-10);
    assert_close(period, stick + slip, 1e-11);
    assert_close(y[0], 1.0, 1e-12);
    assert_close(y[1], v0, 1e-12);
    assert_exact(y[2], 0.0);
    assert_ok(tribo_driver_get_multipliers(drv, re, im));
    assert_close(re[0], 1.0, 1e-10);
    assert_close(re[1], 0.0, 1e-10);
    ck_assert_uint_eq(driver_freedom(drv), 1);
    assert_ok(tribo_driver_period_extremes(drv, c, &least, &most, &at, NULL));
    assert_close(most, 0.6 + hypot(d, v0), 1e-11);
    assert_close(least, 0.6 - hypot(d, v0), 1e-11);
    require(at > 0.5 && at < 0.5 + slip, "at %g", at);
    assert_ok(tribo_driver_period_dissipation(drv, &energy));
    assert_close(energy, 0.6 * (v0 * slip + 2.0 * d),
                 1e-11); /* limit times the distance slid: v0 slip less the way from 1 to 0.2 */
    assert_ok(tribo_driver_period_stick(drv, &share));
    assert_close(share, stick / (stick + slip), 1e-11);
    double t = 0.0, z[3] = {y[0] - 0.01, y[1], 0.0}, again = period;
    driver_advance(drv, &t, 0.05, z);
    memcpy(z, y, sizeof z);
    find_cycle(drv, &again, z);
    assert_close(again, period, 1e-12);
    assert_close(z[0], y[0], 1e-12);
    cycle_free(drv, sys);
}

/* The limit falls with the speed, limit 0.6 + 0.4 exp(-|v|/0.3): slip of 4.63232626800163 to x = 0.18626175426093, by steps of 80
 * bits of another code. */
TEST(falls)
{
    tribo_system *sys = blocks(1, 1.0 / 0.6, 0.3, 0.2, 0.0, 0.0);
    tribo_driver *drv = driver_create(sys, methods[1 + _i], 1e-3, 1e-13);
    double y[3] = {0.0}, period = 0.0, re[2], im[2], share;
    find_cycle(drv, &period, y);
    assert_close(period, 8.701017496697, 1e-9);
    assert_close(y[0], 1.0, 1e-9);
    assert_close(y[1], 0.2, 1e-12);
    assert_ok(tribo_driver_get_multipliers(drv, re, im));
    assert_close(re[0], 1.0, 1e-8);
    assert_close(re[1], 0.0, 1e-8);
    assert_ok(tribo_driver_period_stick(drv, &share));
    assert_close(share, 1.0 - 4.63232626800163 / 8.701017496697, 1e-9);
    cycle_free(drv, sys);
}

/* A block with damping 0.115 slides on a belt at speed 1, limit 0.6 + 0.4 exp(-|v|/0.5). The state of equilibrium is stable, and
 * an unstable cycle without events surrounds it: period, largest velocity at the place of equilibrium, and multiplier by another
 * code. */
TEST(unstable)
{
    tribo_system *sys = blocks(1, 1.0 / 0.6, 0.5, 1.0, 0.115, 0.0);
    tribo_driver *drv = driver_create(sys, methods[1 + _i], 1e-3, 1e-13);
    const double place = 0.6 + 0.4 * exp(-2.0), c[] = {1.0, 0.0};
    double y[3] = {place, 0.35, 0.0}, period = 6.25, re[2], im[2], least, most, energy, t = 0.0;
    find_cycle(drv, &period, y);
    assert_close(period, 6.284826318480383, 1e-9);
    assert_ok(tribo_driver_get_multipliers(drv, re, im));
    assert_close(fmax(re[0], re[1]), 1.044151958696, 1e-9);
    assert_close(fmin(re[0], re[1]), 1.0, 1e-9);
    assert_ok(tribo_driver_period_extremes(drv, c, &least, &most, NULL, NULL));
    assert_ok(tribo_driver_period_dissipation(drv, &energy));
    require(most > place + 0.3 && least < place - 0.3, "%g to %g", least, most);
    double z[3] = {y[0], y[1], 0.0};
    driver_advance(drv, &t, period, z);
    assert_close(z[0], y[0], 1e-9);
    assert_close(z[1], y[1], 1e-9);
    assert_close(z[2], energy, 1e-9);
    /* velocity where the place is passed forth */
    const double ahead = period / 400.0;
    for (int k = 0; k < 800 && !(z[0] < place && z[0] + ahead * z[1] >= place); k++) {
        driver_advance(drv, &t, t + ahead, z);
    }
    const double before[3] = {z[0], z[1], 0.0};
    for (double k = 0.0, left = 0.0; k < 8.0; k += 1.0) {
        left += (place - z[0]) / z[1];
        memcpy(z, before, sizeof z);
        t = 0.0;
        driver_advance(drv, &t, left, z);
    }
    assert_close(z[0], place, 1e-10);
    assert_close(z[1], 0.3488558160060274, 1e-9);
    cycle_free(drv, sys);
}

/* Slip, lift off, touch, stick: two speeds of the belt, by two methods, from states that are near to no cycle. */
TEST(squeals)
{
    static const double from[][4] = {{0.0}, {0.1, 0.9, 0.0, 0.0}, {5.0, -3.0, 2.0, 0.0}};
    const double belt = _i % 2 ? 1.0 : 0.5, c[] = {1.0, 0.0, 0.0, 0.0};
    tribo_system *sys = squeal(belt, 0.6, 0.1);
    tribo_driver *drv = driver_create(sys, methods[1 + _i / 2 % 2], 1e-3, 1e-13);
    double y[5] = {0.0}, period = _i / 4 == 1 ? 1.5 : 0.0, re[4], im[4], least, most;
    memcpy(y, from[_i / 4], sizeof from[0]);
    find_cycle(drv, &period, y);
    assert_close(period, belt < 0.7 ? 1.53650780675 : 1.48153261, belt < 0.7 ? 1e-10 : 1e-8);
    assert_close(y[2], belt, 1e-12);
    assert_ok(tribo_driver_get_multipliers(drv, re, im));
    assert_close(re[0], 1.0, 1e-9);
    assert_close(im[0], 0.0, 1e-9);
    assert_close(re[3], 0.0, 1e-9);
    if (belt < 0.7) {
        assert_close(y[0], 0.16859251, 1e-8);
        assert_close(y[1], 1.46871763, 1e-8);
        assert_close(y[3], 1.36898954, 1e-8);
        assert_close(re[1], 0.758384, 1e-6);
        assert_close(im[1], 0.424284, 1e-6);
        assert_close(im[2], -im[1], 1e-12);
        assert_ok(tribo_driver_period_extremes(drv, c, &least, &most, NULL, NULL));
        assert_close(most, 0.27080300, 1e-8);
        assert_close(least, -0.14959332, 1e-8);
    }
    cycle_free(drv, sys);
}

/* Two blocks on one belt: alike from one state or from two, each has its own neutral direction; of other periods there is no
 * common cycle. */
TEST(two_blocks)
{
    tribo_system *sys = blocks(2, 1.0 / 0.6, 0.0, 0.2, 0.0, _i / 3 == 2 ? 0.7 : 0.0);
    tribo_driver *drv = driver_create(sys, methods[_i % 3], 1e-3, 1e-13);
    double y[5] = {0.3, _i / 3 ? -0.9 : 0.3}, start[5], period = 0.0, re[4], im[4], energy[2];
    memcpy(start, y, sizeof y);
    if (_i / 3 == 2) {
        assert_status(tribo_driver_find_cycle(drv, 0.0, &period, y), TRIBO_ERR_NO_CONVERGENCE);
        assert_all_exact(y, start, 5);
        assert_exact(period, 0.0);
        assert_status(tribo_driver_get_multipliers(drv, re, im), TRIBO_ERR_STATE);
    } else {
        find_cycle(drv, &period, y);
        assert_close(period, 8.0688878716, 1e-10);
        assert_close(y[0], 1.0, 1e-11);
        require((fabs(y[1] - y[0]) < 1e-9) == (_i / 3 == 0), "%.17g and %.17g", y[0], y[1]);
        assert_ok(tribo_driver_get_multipliers(drv, re, im));
        assert_close(re[0], 1.0, 1e-10);
        assert_close(re[1], 1.0, 1e-10);
        assert_close(re[2], 0.0, 1e-10);
        ck_assert_uint_eq(driver_freedom(drv), 2);
        assert_ok(tribo_driver_period_dissipation(drv, energy));
        assert_close(energy[0], energy[1], 1e-11);
    }
    cycle_free(drv, sys);
}

/* States of rest are no cycles: sliding on the belt, from the equilibrium and from near it; held by a base at rest; below
 * flutter. */
TEST(rests)
{
    tribo_system *sys = _i == 3 ? squeal(0.5, 0.3, 0.1) : blocks(1, 1.0 / 0.6, 0.5, _i == 2 ? 0.0 : 1.0, 0.2, 0.0);
    tribo_driver *drv = driver_create(sys, "auto", 1e-3, 1e-13);
    const double place = 0.6 + 0.4 * exp(-2.0);
    for (int k = 0; k < 2; k++) {
        double y[5] = {_i == 1 ? place : 0.2}, start[5], period = k ? 6.0 : 0.0, re[4], im[4], least, most;
        const double c[4] = {1.0}, guess = period;
        memcpy(start, y, sizeof y);
        assert_status(tribo_driver_find_cycle(drv, 0.0, &period, y), TRIBO_ERR_NO_CONVERGENCE);
        assert_says(tribo_driver_message(drv), "comes to rest");
        assert_all_exact(y, start, 5);
        assert_exact(period, guess);
        assert_status(tribo_driver_get_multipliers(drv, re, im), TRIBO_ERR_STATE);
        assert_status(tribo_driver_period_extremes(drv, c, &least, &most, NULL, NULL), TRIBO_ERR_STATE);
    }
    cycle_free(drv, sys);
}

TEST(refused)
{
    tribo_system *sys = blocks(2, 1.0 / 0.6, 0.0, 0.2, 0.0, 0.0);
    tribo_driver *drv = driver_create(sys, methods[_i], 1e-3, 1e-13), *steps = driver_create(sys, "moreau/fixed", 1e-3, 0.0);
    double y[5] = {0.1, 0.2, 0.3, 0.4, 0.5}, bad[5] = {0.0, NAN}, start[5], period = 8.0, none = 0.0, less = -1.0, nan = NAN;
    const double one[] = {0.0, 1.0}, zero[] = {0.0, 0.0};
    memcpy(start, y, sizeof y);
    assert_status(tribo_driver_find_cycle(NULL, 0.0, &period, y), TRIBO_ERR_NULL);
    assert_status(tribo_driver_find_cycle(drv, 0.0, NULL, y), TRIBO_ERR_NULL);
    assert_status(tribo_driver_find_cycle(drv, 0.0, &period, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_driver_find_cycle(drv, 0.0, &period, bad), TRIBO_ERR_NOT_FINITE);
    assert_status(tribo_driver_find_cycle(drv, NAN, &period, y), TRIBO_ERR_NOT_FINITE);
    assert_status(tribo_driver_find_cycle(drv, 0.0, &nan, y), TRIBO_ERR_NOT_FINITE);
    assert_status(tribo_driver_find_cycle(drv, 0.0, &less, y), TRIBO_ERR_NOT_POSITIVE);
    assert_status(tribo_driver_find_cycle(drv, 1e300, &period, y), TRIBO_ERR_STEP);
    assert_status(tribo_driver_find_cycle(steps, 0.0, &none, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(steps), "method moreau/fixed finds no cycles");
    assert_ok(tribo_system_add_load(sys, 0.0, one, NULL));
    assert_ok(tribo_system_add_load(sys, 0.9, one, NULL));
    assert_status(tribo_driver_find_cycle(drv, 0.0, &period, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(drv), "load[1], omega = 0.9");
    assert_ok(tribo_system_clear_loads(sys));
    assert_ok(tribo_system_add_load(sys, 0.9, zero, zero));
    assert_ok(tribo_system_add_base_motion(sys, 1.5, one, NULL));
    assert_status(tribo_driver_find_cycle(drv, 0.0, &period, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(drv), "base motion[1], omega = 1.5, depends on time");
    tribo_driver_destroy(steps);
    cycle_free(drv, sys);
    sys = blocks(1, 1.0 / 0.6, 0.0, 0.2, 0.0, 0.0);
    drv = driver_create(sys, methods[_i], 1e-3, 1e-13);
    assert_ok(tribo_system_add_limit(sys, 1.5, one + 1, NULL));
    assert_status(tribo_driver_find_cycle(drv, 0.0, &period, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(drv), "limit[0], omega = 1.5, depends on time");
    assert_all_exact(y, start, 5);
    assert_exact(period, 8.0);
    cycle_free(drv, sys);
}

TEST_MAIN("cycles", {drops, 12}, {falls, 2}, {unstable, 2}, {squeals, 12}, {two_blocks, 9}, {rests, 4}, {refused, 3})
