/* SPDX-License-Identifier: BSD-3-Clause */
/* What may be asked of searches for periodic motions, and of what they found: errors, other methods, static limits, and hard
 * cases. */
#include "make.h"
#include "search.h"

#include <string.h>

static const char *const methods[] = {"exact", "event", "auto"};

static int seen_by(const tribo_moment *moment, void *data)
{
    (void)moment;
    ++*(int *)data;
    return 0;
}

/* A search leaves the driver as if there had been none. */
TEST(nothing_left)
{
    struct search s = oscillator_search(methods[_i], 0.1, 0.5, 1.0, 0.8);
    double y[3] = {0}, z[3] = {0.3, -0.1, 0.0}, fresh[3] = {0.3, -0.1, 0.0}, t = 0.0;
    int calls = 0;
    assert_ok(tribo_driver_set_observer(s.drv, seen_by, &calls));
    find(&s, 0.0, y);
    require(calls == 0, "%d calls", calls);
    driver_advance(s.drv, &t, s.period, y);
    require(calls > 0, "no calls");
    assert_ok(tribo_driver_set_observer(s.drv, NULL, NULL));
    find(&s, 0.0, y);
    t = 0.0;
    driver_advance(s.drv, &t, 20.0, z);
    run(s.sys, methods[_i], 0.1, 1e-14, 20.0, fresh);
    assert_all_exact(z, fresh, 3);
    /* a velocity that would be rounding of the motion found */
    double slow[3] = {0.0, -2e-14, 0.0}, alone[3] = {0.0, -2e-14, 0.0};
    const size_t events = driver_count(s.drv, TRIBO_COUNT_EVENTS);
    t = 0.0;
    driver_advance(s.drv, &t, 0.1, slow);
    tribo_driver *other = driver_create(s.sys, methods[_i], 0.1, 1e-14);
    t = 0.0;
    driver_advance(other, &t, 0.1, alone);
    assert_all_exact(slow, alone, 3);
    require(driver_count(s.drv, TRIBO_COUNT_EVENTS) - events == driver_count(other, TRIBO_COUNT_EVENTS), "other events");
    tribo_driver_destroy(other);
    search_free(&s);
}

TEST(errors)
{
    const double one = 1.0;
    struct search s = oscillator_search(methods[_i], 0.1, 0.5, 1.0, 0.8);
    double y[3] = {0}, bad[3] = {NAN, 0.0, 0.0}, re[2], im[2], c[2] = {1.0, INFINITY}, a, b;
    assert_status(tribo_driver_find_periodic(NULL, 0.0, s.period, y), TRIBO_ERR_NULL);
    assert_status(tribo_driver_find_periodic(s.drv, 0.0, s.period, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_driver_find_periodic(s.drv, NAN, s.period, y), TRIBO_ERR_NOT_FINITE);
    assert_status(tribo_driver_find_periodic(s.drv, 0.0, INFINITY, y), TRIBO_ERR_NOT_FINITE);
    assert_status(tribo_driver_find_periodic(s.drv, 0.0, s.period, bad), TRIBO_ERR_NOT_FINITE);
    assert_status(tribo_driver_find_periodic(s.drv, 0.0, 0.0, y), TRIBO_ERR_NOT_POSITIVE);
    assert_status(tribo_driver_find_periodic(s.drv, 0.0, -1.0, y), TRIBO_ERR_NOT_POSITIVE);
    assert_status(tribo_driver_find_periodic(s.drv, 1e300, s.period, y), TRIBO_ERR_STEP);
    assert_status(tribo_driver_find_periodic(s.drv, 0.0, 1.1 * s.period, y), TRIBO_ERR_RANGE);
    assert_says(tribo_driver_message(s.drv), "load[0], omega = 0.8");
    assert_status(tribo_driver_find_periodic(s.drv, 0.0, 1e-12 * s.period, y), TRIBO_ERR_RANGE); /* no whole turn at all */
    assert_status(tribo_driver_get_multipliers(s.drv, re, im), TRIBO_ERR_STATE);
    assert_status(tribo_driver_period_extremes(s.drv, c, &a, &b, NULL, NULL), TRIBO_ERR_NOT_FINITE);
    c[1] = 0.0;
    assert_status(tribo_driver_period_extremes(s.drv, c, &a, &b, NULL, NULL), TRIBO_ERR_STATE);
    find(&s, 0.0, y);
    assert_status(tribo_driver_get_multipliers(s.drv, NULL, im), TRIBO_ERR_NULL);
    assert_status(tribo_driver_period_extremes(s.drv, NULL, &a, &b, NULL, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_driver_period_harmonic(s.drv, c, 1, NULL, &b), TRIBO_ERR_NULL);
    assert_status(tribo_driver_period_stick(s.drv, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_driver_period_dissipation(NULL, &a), TRIBO_ERR_NULL);
    assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), 0.6));
    assert_status(tribo_driver_period_extremes(s.drv, c, &a, &b, NULL, NULL), TRIBO_ERR_STATE);
    assert_says(tribo_driver_message(s.drv), "has changed");
    assert_ok(tribo_system_set_limit_table(s.sys, 1, &one, &one));
    assert_status(tribo_driver_find_periodic(s.drv, 0.0, s.period, y), TRIBO_ERR_UNSUPPORTED);
    search_free(&s);
}

TEST(other_methods)
{
    static const char *const others[] = {"rk4/fixed", "central/fixed", "moreau/fixed", "rkf45"};
    struct search s = oscillator_search(others[_i], 0.1, 0.5, 1.0, 0.8);
    double y[3] = {0};
    assert_status(tribo_driver_find_periodic(s.drv, 0.0, s.period, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(s.drv), "exact, event or auto");
    search_free(&s);
}

/* Multipliers are those of differences, in which a contact that rests stays so. */
static void check_multipliers(const struct search *s, const double *y)
{
    const double h = 1e-6;
    double m[2][2], re[2], im[2];
    assert_ok(tribo_driver_get_multipliers(s->drv, re, im));
    for (int k = 0; k < 2; k++) {
        double up[3] = {y[0], y[1], 0.0}, down[3] = {y[0], y[1], 0.0};
        up[k] += h;
        down[k] -= h;
        dissipated(s, up);
        dissipated(s, down);
        for (int i = 0; i < 2; i++) {
            m[i][k] = (up[i] - down[i]) / (2.0 * h);
        }
    }
    assert_close(re[0] + re[1], m[0][0] + m[1][1], 1e-6);
    assert_close(re[0] * re[1] - im[0] * im[1], m[0][0] * m[1][1] - m[0][1] * m[1][0], 1e-6);
}

/* The motion found is where marching leads to, and dissipates what a period of that does. */
static void check_marched(const struct search *s, const double *y)
{
    double z[3] = {0}, t = 0.0, energy;
    assert_ok(tribo_driver_period_dissipation(s->drv, &energy));
    driver_advance(s->drv, &t, 300.0 * s->period, z);
    assert_all_close(z, y, 2, 1e-9);
    z[2] = 0.0;
    assert_close(dissipated(s, z), energy, 1e-9);
}

/* Static limits that drop at once, and a belt that moves or swings. */
TEST(static_limit)
{
    static const struct {
        double omega, limit, ratio, speed, turns;
    } scene[] = {{0.5, 0.5, 1.4, 0.0, 0.0}, {0.3, 0.4, 1.6, 0.0, 0.0}, {0.5, 0.5, 1.4, 0.3, 1.0}, {0.3, 0.4, 1.6, 0.3, 0.0}};
    struct search s = oscillator_search(methods[_i % 3], 0.1, scene[_i / 3].limit, 1.0, scene[_i / 3].omega);
    double y[3] = {0}, share;
    assert_ok(tribo_set_static(tribo_system_context(s.sys), &scene[_i / 3].ratio, NULL));
    assert_ok(tribo_system_add_base_motion(s.sys, scene[_i / 3].turns * s.omega, &scene[_i / 3].speed, NULL));
    find(&s, 0.0, y);
    assert_ok(tribo_driver_period_stick(s.drv, &share));
    require(share > 0.1, "rests for %g of the period", share);
    check_multipliers(&s, y);
    check_marched(&s, y);
    search_free(&s);
}

/* Such that fall with the speed, a little or steeply; beside limits that swing; on a belt that moves fast, so that the contact
 * never rests; and with stick. */
TEST(falling_limit)
{
    static const struct {
        double omega, limit, ratio, velocity, speed, turns, swing;
        int rests;
    } scene[] = {{0.8, 0.3, 1.4, 0.5, 0.0, 0.0, 0.0, 0},  {0.5, 0.5, 1.4, 0.3, 0.0, 0.0, 0.0, 1},
                 {0.3, 0.4, 1.6, 0.05, 0.0, 0.0, 0.0, 1}, {0.5, 0.5, 1.4, 0.3, 0.3, 1.0, 0.0, 1},
                 {1.2, 0.3, 1.3, 2.0, 4.0, 0.0, 0.0, 0},  {0.5, 0.5, 1.4, 0.3, 0.0, 0.0, 0.2, 1}};
    static const char *const able[] = {"event", "auto"};
    const size_t k = (size_t)_i / 2;
    struct search s = oscillator_search(able[_i % 2], 0.1, scene[k].limit, 1.0, scene[k].omega);
    double y[3] = {0}, share;
    assert_ok(tribo_set_static(tribo_system_context(s.sys), &scene[k].ratio, &scene[k].velocity));
    assert_ok(tribo_system_add_base_motion(s.sys, scene[k].turns * s.omega, &scene[k].speed, NULL));
    assert_ok(tribo_system_add_limit(s.sys, 2.0 * s.omega, &scene[k].swing, NULL));
    find(&s, 0.0, y);
    assert_ok(tribo_driver_period_stick(s.drv, &share));
    require(scene[k].rests ? share > 0.05 : share == 0.0, "rests for %g of the period", share);
    check_multipliers(&s, y);
    check_marched(&s, y);
    search_free(&s);
}

/* Near resonance with a limit just below the load, the free amplitude is 1e6 times and more that of the motion: a response in
 * that size would leave no digits of it. */
TEST(nearly_stuck)
{
    for (int k = 0; k < 40; k++) {
        const double limit = 3.0 - pow(10.0, -3.0 + 0.05 * k);
        struct search s = oscillator_search("exact", 0.004, limit, 3.0, 1.0);
        double y[3] = {0}, share;
        find(&s, 0.0, y);
        assert_ok(tribo_driver_period_stick(s.drv, &share));
        require(share > 0.7 && share < 1.0, "limit %g: %g of the period at rest", limit, share);
        search_free(&s);
    }
}

/* A load 1e4 times as fast as the mode: what 0.3 of friction would do to the mode in time is 1e8 times the motion, of which
 * closed forms have digits enough. Nearly rigid: x'' = cos(omega t) + f. */
TEST(fast_load)
{
    const double omega = 1e4, n = 0.3;
    struct search s = oscillator_search(methods[_i], 0.1, n, 1.0, omega);
    double y[3] = {0};
    find(&s, 0.0, y);
    assert_close(amplitude(&s, 0) * omega * omega, sqrt(1.0 - n * n * PI * PI / 4.0), 1e-5);
    search_free(&s);
}

/* "auto" leaves it to one of the two, with all that is asked of the motion and counted, and goes on as they do. */
TEST(automatic)
{
    const double one[] = {1.0, 0.0};
    double y[2][3] = {{0}}, e[2][2], re[2][2], im[2][2], t, z[2][3] = {{0}};
    size_t count[2];
    for (int k = 0; k < 2; k++) {
        struct search s = oscillator_search(k ? "auto" : "exact", 0.1, 0.5, 1.0, 0.8);
        assert_status(tribo_driver_get_multipliers(s.drv, re[k], im[k]), TRIBO_ERR_STATE);
        find(&s, 0.0, y[k]);
        assert_says(tribo_driver_method(s.drv), "exact");
        assert_ok(tribo_driver_period_extremes(s.drv, one, &e[k][0], &e[k][1], NULL, NULL));
        assert_ok(tribo_driver_get_multipliers(s.drv, re[k], im[k]));
        count[k] = driver_count(s.drv, TRIBO_COUNT_PERIODS);
        assert_status(tribo_driver_find_periodic(s.drv, 0.0, 1.1 * s.period, y[k]), TRIBO_ERR_RANGE);
        assert_says(tribo_driver_message(s.drv), "load[0], omega = 0.8");
        t = 0.0;
        driver_advance(s.drv, &t, 10.0, z[k]);
        assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), 0.6));
        assert_status(tribo_driver_period_extremes(s.drv, one, &e[k][0], &e[k][1], NULL, NULL), TRIBO_ERR_STATE);
        assert_says(tribo_driver_message(s.drv), "has changed");
        search_free(&s);
    }
    assert_all_exact(y[1], y[0], 3);
    assert_all_exact(z[1], z[0], 3);
    assert_all_exact(e[1], e[0], 2);
    assert_all_exact(re[1], re[0], 2);
    require(count[1] == count[0] && count[0] > 0, "%zu periods, not %zu", count[1], count[0]);
}

/* "auto" finds motions by "exact" until limits fall with the speed, then by "event", and by "exact" again: each as a new
 * driver. */
TEST(automatic_turns)
{
    const double ratio[2] = {1.4, 1.4}, falls[2] = {0.5, 0.5}, force[4] = {1.0, 0.0, 0.5, 0.0};
    double matrix[3][4][4] = {{{0}}}, direction[2][4] = {{1, 0, 0, 0}, {0, 0, 1, 0}};
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            matrix[1][i][j] = i == j ? 2.0 : abs(i - j) == 1 ? -1.0 : 0.0;
            matrix[0][i][j] = 0.05 * matrix[1][i][j];
            matrix[2][i][j] = i == j;
        }
    }
    struct search s = search_create("auto", 4, 2, *matrix[2], *matrix[0], *matrix[1], *direction, 0.6, force);
    assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), 0.2));
    for (int turn = 0; turn < 3; turn++) {
        struct search fresh = s;
        double y[MOST_STATES] = {0}, z[MOST_STATES] = {0};
        assert_ok(tribo_set_static(tribo_system_context(s.sys), turn == 1 ? ratio : NULL, turn == 1 ? falls : NULL));
        find(&s, 0.0, y);
        assert_says(tribo_driver_method(s.drv), turn == 1 ? "event" : "exact");
        assert_ok(tribo_driver_create(&fresh.drv, s.sys, turn == 1 ? "event" : "exact"));
        find(&fresh, 0.0, z);
        assert_all_close(y, z, 8, 1e-8);
        tribo_driver_destroy(fresh.drv);
    }
    search_free(&s);
}

/* Motions of any size: squares of the smallest are 0, and squares of the largest are no numbers. */
TEST(any_size)
{
    const double sizes[] = {1e-280, 1e-160, 1e140};
    const double size = sizes[_i / 2], e[2] = {1.0, 0.0};
    double y[3] = {0}, want[3] = {0}, least, most;
    struct search s = oscillator_search(methods[_i % 2], 0.1, 0.1 * size, size, 0.7),
                  ordinary = oscillator_search(methods[_i % 2], 0.1, 0.1, 1.0, 0.7);
    find(&s, 0.0, y);
    find(&ordinary, 0.0, want);
    assert_close(y[0] / size, want[0], 1e-11);
    assert_close(y[1] / size, want[1], 1e-11);
    assert_ok(tribo_driver_period_extremes(s.drv, e, &least, &most, NULL, NULL));
    assert_close(least / most, -1.0, 1e-11);
    search_free(&s);
    search_free(&ordinary);
}

/* A contact that is nothing beside its load: 1/(1 - omega^2) of that, as without friction. */
TEST(huge_load)
{
    double y[3] = {0};
    struct search s = oscillator_search("exact", 0.0, 0.5, 1e200, 0.7);
    find(&s, 0.0, y);
    assert_close(hypot(y[0], y[1] / 0.7) / 1e200, 1.0 / 0.51, 1e-9);
    search_free(&s);
}

/* Four masses and one contact with a static limit, load and base of one frequency. All that drives them is odd, and the motion in
 * which they end is stable, but not odd: half a period later it is not minus itself. It is found from itself, and from zeros. */
TEST(not_odd)
{
    enum { N = 4 };
    const double omega = 0.18824263738325386, period = 2.0 * PI / omega, j[N] = {-1.0, 0.0, 1.0, 0.0}, limit = 1.912075867437178;
    const double k[N * N] = {2.0, -1.0, 0.0, 0.0, -1.0, 3.0, -1.0, 0.0, 0.0, -1.0, 3.0, -1.0, 0.0, 0.0, -1.0, 2.0};
    const double load[N] = {1.0}, base = 1.0, ratio = 1.7095138103201202;
    double m[N * N] = {0.0}, c[N * N] = {0.0}, y[2 * N + 1] = {0.0}, z[2 * N + 1], t = 0.0, odd = 0.0;
    tribo_system *sys;
    for (size_t i = 0; i < N; i++) {
        m[i * N + i] = 1.0;
        c[i * N + i] = 4.0752852251347654e-4 * (double)(i + 1);
    }
    assert_ok(dense_system(&sys, N, 1, m, c, k, j, 0, NULL, 0));
    assert_ok(tribo_set_limit(tribo_system_context(sys), &limit));
    assert_ok(tribo_set_static(tribo_system_context(sys), &ratio, NULL));
    assert_ok(tribo_system_add_load(sys, omega, load, NULL));
    assert_ok(tribo_system_add_base_motion(sys, omega, &base, NULL));
    tribo_driver *drv = driver_create(sys, _i % 2 ? "event" : "exact", period, 1e-12);
    if (_i / 2) {
        for (int p = 0; p < 3000; p++) {
            t = 0.0;
            driver_advance(drv, &t, period, y);
        }
    }
    assert_ok(tribo_driver_find_periodic(drv, 0.0, period, y));
    memcpy(z, y, sizeof z);
    t = 0.0;
    driver_advance(drv, &t, 0.5 * period, z);
    for (size_t i = 0; i < 2 * N; i++) {
        odd = fmax(odd, fabs(z[i] + y[i]));
    }
    require(odd > 1.0, "half a period later the state is minus itself but for %g", odd);
    driver_advance(drv, &t, period, z);
    assert_all_close(z, y, 2 * N, 1e-8);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST_MAIN("periodic_rules", {nothing_left, 2}, {errors, 2}, {other_methods, 4}, {static_limit, 12}, {falling_limit, 12},
          {nearly_stuck, 1}, {fast_load, 2}, {automatic, 1}, {automatic_turns, 1}, {any_size, 6}, {huge_load, 1}, {not_odd, 4})
