/* SPDX-License-Identifier: BSD-3-Clause */
/* Methods "exact" and "event" where much happens at once, or next to nothing: contacts of equal limits that reach them together,
 * loads that just exceed a limit; and what cannot be followed ends soon and says so. */
#include <string.h>

#include "make.h"
#include "coulomb.h"
#include "run.h"

#define MOST 8

static const char *const methods[] = {"exact", "event"};

/* n unit blocks on top of each other, springs to the ground and between neighbours, all limits alike, a load on the top one. */
static tribo_system *pack(size_t n, double limit)
{
    double mass[MOST * MOST] = {0}, stiffness[MOST * MOST] = {0}, direction[MOST * MOST] = {0}, load[MOST] = {0};
    tribo_system *sys;
    for (size_t i = 0; i < n; i++) {
        mass[i * n + i] = direction[i * n + i] = 1.0;
        stiffness[i * n + i] += 1.0;
        if (i) {
            direction[i * n + i - 1] = -1.0;
            stiffness[i * n + i] += 0.5;
            stiffness[(i - 1) * n + i - 1] += 0.5;
            stiffness[i * n + i - 1] = stiffness[(i - 1) * n + i] = -0.5;
        }
    }
    load[n - 1] = 1.0;
    assert_ok(dense_system(&sys, n, n, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), limit));
    assert_ok(tribo_system_add_load(sys, 0.5, NULL, load));
    return sys;
}

/* All contacts reach their limit in one instant, and let go one after another: the top one with the third power of time, the one
 * below with the fifth, and so on. Displacement of the top block at t = 8: by central differences in steps of 5e-6, which are of
 * the first order. */
TEST(let_go_one_after_another)
{
    const double want[] = {-0.75982849, -0.75980607, -0.75980469, -0.75980465, -0.75980465};
    const size_t n = 4 + (size_t)_i;
    double first = 0.0;
    for (size_t k = 0; k < COUNT(methods); k++) {
        for (int cuts = 1; cuts <= 80; cuts += 79) {
            tribo_system *sys = pack(n, 0.2);
            tribo_driver *drv = driver_create(sys, methods[k], 1.0, 1e-12);
            double t = 0.0, y[2 * MOST + 1] = {0}, excess = 1.0;
            for (int cut = 1; cut <= cuts; cut++) {
                driver_advance(drv, &t, 8.0 * cut / cuts, y);
            }
            assert_close(y[n - 1], want[_i], 2e-8);
            first = first == 0.0 ? y[n - 1] : first;
            assert_close(y[n - 1], first, 1e-12);
            assert_ok(tribo_driver_real(drv, TRIBO_REAL_EXCESS, &excess));
            require(excess < 1e-12, "%s: %g beyond the limit", methods[k], excess);
            tribo_driver_destroy(drv);
            tribo_system_destroy(sys);
        }
    }
}

/* From loose to tight tolerances; both blocks end at rest, on each other and on the belt. */
TEST(belt_at_any_tolerance)
{
    double exact[5] = {0};
    tribo_system *sys;
    assert_ok(tribo_system_belt(&sys, 1.0, 1.0, 0.5, 1.0, 0.5));
    run(sys, "exact", 1.0, 0.0, 60.0, exact);
    for (double tolerance = 1e-3; tolerance > 1e-14; tolerance *= 0.1) {
        double y[5] = {0};
        run(sys, "event", 1.0, tolerance, 60.0, y);
        assert_all_close(y, exact, 5, fmax(tolerance, 1e-11));
    }
    tribo_system_destroy(sys);
}

/* A load beyond the limit by next to nothing, or a harmonic whose peak is: the block moves by no more than that. */
TEST(next_to_nothing)
{
    for (double beyond = 1e-15; beyond < 1e-8; beyond *= sqrt(10.0)) {
        for (int size = 0; size < 9; size++) {
            const double limit = 0.1 * pow(1.7, size), peak = limit * (1.0 + beyond);
            double y[3] = {0};
            tribo_system *sys = block(1.0, 1.0 + size, limit);
            assert_ok(tribo_system_add_load(sys, _i / 2 ? 0.7 : 0.0, _i / 2 ? NULL : &peak, _i / 2 ? &peak : NULL));
            run(sys, methods[_i % 2], 1.0, 1e-12, 50.0, y);
            require(fabs(y[0]) <= 3.0 * limit * beyond && fabs(y[1]) <= 3.0 * limit * beyond && y[2] >= -1e-14,
                    "%g beyond %g: x = %g, v = %g, E = %g", beyond, limit, y[0], y[1], y[2]);
            tribo_system_destroy(sys);
        }
    }
}

/* A dashpot a thousand million times faster than what it leaves: once its moment is over, it costs nothing. */
TEST(fast_decay)
{
    const double mass = 1.0, damping = 1e9, stiffness = 1.0, direction = 1.0, load = 2.0;
    tribo_system *sys;
    assert_ok(dense_system(&sys, 1, 1, &mass, &damping, &stiffness, &direction, 0, NULL, 0));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.5));
    assert_ok(tribo_system_add_load(sys, 1.0, NULL, &load));
    tribo_driver *drv = driver_create(sys, "exact", 1.0, 0.0);
    double t = 0.0, y[3] = {0.0, 1.0, 0.0};
    driver_advance(drv, &t, 10.0, y);
    ck_assert_uint_le(driver_count(drv, TRIBO_COUNT_EVALUATIONS), 400);
    /* the first thousand millionth of a second; then the load, less its limit, against the dashpot */
    require(fabs(y[0]) < 1e-8 && y[2] > 0.0, "x = %g, E = %g", y[0], y[2]);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* A load faster than any time can be told apart; a motion that grows out of all numbers; an observer's steps that are lost beside
 * t. What was reached stays. */
TEST(what_cannot_be_followed)
{
    const double minus = -1.0, one = 1.0, two = 2.0;
    const char *method = methods[_i];
    double t = 0.0, y[3] = {0};
    tribo_system *sys = oscillator(TRIBO_QUINN, 2.0, 1e55);
    tribo_driver *drv = driver_create(sys, method, 1.0, 1e-10);
    assert_status(tribo_driver_advance(drv, &t, 10.0, y), TRIBO_ERR_STEP);
    assert_says(tribo_driver_message(drv), "t = 0 ");
    require(t == 0.0 && y[0] == 0.0 && y[1] == 0.0, "t = %g, y = %g, %g", t, y[0], y[1]);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);

    assert_ok(dense_system(&sys, 1, 1, &one, NULL, &minus, &one, 0, NULL, 0));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.5));
    assert_ok(tribo_system_add_load(sys, 1.0, NULL, &two));
    drv = driver_create(sys, method, 1.0, 1e-10);
    assert_status(tribo_driver_advance(drv, &t, 1000.0, y), TRIBO_ERR_NOT_FINITE);
    assert_says(tribo_driver_message(drv), "grows without bound");
    require(t > 600.0 && t < 711.0 && y[0] > 1e250 && isfinite(y[0]) && isfinite(y[1]) && isfinite(y[2]), "t = %g, y = %g", t,
            y[0]);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

static int never(const tribo_moment *moment, void *data)
{
    (void)moment;
    (void)data;
    return 0;
}

TEST(an_observer_that_would_see_nothing)
{
    double t = 1e8, y[3] = {0};
    tribo_system *sys = oscillator(TRIBO_QUINN, 1.5, 0.5);
    tribo_driver *drv = driver_create(sys, "exact", 1e-9, 0.0);
    assert_ok(tribo_driver_set_observer(drv, never, NULL));
    assert_status(tribo_driver_advance(drv, &t, 1e8 + 1.0, y), TRIBO_ERR_STEP);
    assert_says(tribo_driver_message(drv), "output every 1e-09");
    assert_exact(t, 1e8);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Three oscillators; two contacts between bodies 0 and 1, whose forces at rest are not unique, and one that holds body 1 by a
 * limit that swings through zero, 10^2 to 10^6 times as large: it passes the load in a moment, and a decision must not look
 * beyond that. A period has some 20 events, wherever it is cut. */
static tribo_system *clutch(struct random *g)
{
    const double mass[] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, direction[] = {0, -1, 1, 0, 1, -1, 0, 1, 0}, load[] = {0, 1, 0};
    const double damping[] = {uniform(g, 0.0, 0.001), 0, 0, 0, 0.001, 0, 0, 0, 0.002}, big = pow(10.0, uniform(g, 2.0, 6.0));
    const double limit[] = {pow(10.0, uniform(g, -2.5, -1.0)), pow(10.0, uniform(g, -2.5, -1.0)), big};
    const double swing = big * uniform(g, 1.02, 1.4), phase = uniform(g, -0.3, 0.3), cosine[] = {0.0, 0.0, swing * cos(phase)};
    const double sine[] = {uniform(g, 0.0, 0.1) * limit[0], uniform(g, 0.0, 0.1) * limit[1], swing * sin(phase)};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 3, 3, mass, damping, mass, direction, 0, NULL, 0));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    assert_ok(tribo_system_add_load(sys, 1.0, load, NULL));
    assert_ok(tribo_system_add_limit(sys, 2.0, cosine, sine));
    return sys;
}

TEST(a_limit_that_passes_the_load_in_a_moment)
{
    struct random g = random_of(_i);
    for (int trial = 0; trial < 10; trial++) {
        tribo_system *sys = clutch(&g);
        double start[7] = {0}, dissipated[2];
        run(sys, methods[_i % 2], 1.0, 1e-12, 40.0 * PI, start);
        start[6] = 0.0;
        for (int k = 0; k < 2; k++) {
            const int pieces = k ? 1000 : 1;
            tribo_driver *drv = driver_create(sys, methods[_i % 2], 1.0, 1e-12);
            double y[7], t = 40.0 * PI;
            memcpy(y, start, sizeof y);
            for (int piece = 1; piece <= pieces; piece++) {
                driver_advance(drv, &t, 40.0 * PI + 2.0 * PI * piece / pieces, y);
            }
            const size_t events = driver_count(drv, TRIBO_COUNT_EVENTS);
            require(events <= (k ? 500 : 40), "trial %d: %zu events in %d", trial, events, pieces);
            dissipated[k] = y[6];
            tribo_driver_destroy(drv);
        }
        assert_close(dissipated[1], dissipated[0], 1e-7 * dissipated[0]);
        tribo_system_destroy(sys);
    }
}

/* What a driver tells of its motion, and what it does not. */
TEST(violations)
{
    double value = 7.0, t = 0.0, y[3] = {0};
    tribo_system *sys = oscillator(TRIBO_QUINN, 1.5, 0.5);
    tribo_driver *drv = driver_create(sys, methods[_i], 1.0, 1e-10), *other = driver_create(sys, "rk4/fixed", 0.1, 0.0);
    assert_ok(tribo_driver_real(drv, TRIBO_REAL_EXCESS, &value));
    assert_exact(value, 0.0);
    driver_advance(drv, &t, 50.0, y);
    for (int which = TRIBO_REAL_EXCESS; which <= TRIBO_REAL_BACKSLIP; which++) {
        value = -1.0;
        assert_ok(tribo_driver_real(drv, which, &value));
        require(value >= 0.0 && value <= 1e-13, "%d: %g", which, value);
        assert_status(tribo_driver_real(other, which, &value), TRIBO_ERR_UNSUPPORTED);
    }
    assert_status(tribo_driver_real(drv, 7, &value), TRIBO_ERR_RANGE);
    assert_status(tribo_driver_real(drv, TRIBO_REAL_EXCESS, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_driver_real(NULL, TRIBO_REAL_EXCESS, &value), TRIBO_ERR_NULL);
    tribo_driver_destroy(drv);
    tribo_driver_destroy(other);
    tribo_system_destroy(sys);
}

TEST_MAIN("coincidence", {let_go_one_after_another, 5}, {belt_at_any_tolerance, 1}, {next_to_nothing, 4}, {fast_decay, 1},
          {what_cannot_be_followed, 2}, {an_observer_that_would_see_nothing, 1}, {violations, 2},
          {a_limit_that_passes_the_load_in_a_moment, 8})
