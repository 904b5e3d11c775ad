/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar contacts in driver "event": closed forms, values of another code, and other methods as their steps become short. */
#include "make.h"
#include "run.h"

#include <string.h>

static const double identity[4] = {1.0, 0.0, 0.0, 1.0}, none[4] = {0.0};

/* One planar contact on a mass of 1, with these limits. */
static tribo_system *planar_mass(const double *springs, double limit1, double limit2)
{
    const double limit[2] = {limit1, limit2};
    tribo_system *s;
    assert_ok(dense_system(&s, 2, 2, identity, NULL, springs, identity, 0, NULL, 0));
    tribo_context *c = tribo_system_context(s);
    assert_ok(tribo_set_planar(c, 1, (const size_t[]){0}));
    assert_ok(tribo_set_limit(c, limit));
    return s;
}

/* x'' + x = p sin 0.7 t + f, y'' + 1.7 y = 1.2 cos(0.7 t + 0.4) + f: values at t = 60 of another code, x, y and dissipation. */
TEST(reference)
{
    const double springs[4] = {1.0, 0.0, 0.0, 1.7}, p[2] = {1.6, 2.5};
    const double want[2][3] = {{-0.794389645, -0.394078205, 67.840627726}, {-2.813421575, -0.353837684, 122.943559967}};
    const double cosine[2] = {0.0, 1.2 * cos(0.4)}, sine[2] = {p[_i % 2], -1.2 * sin(0.4)};
    double y[5] = {0.0};
    tribo_system *s = planar_mass(springs, 1.0, 1.0);
    assert_ok(tribo_system_add_load(s, 0.7, cosine, sine));
    run(s, _i < 2 ? "event" : "auto", 0.1, 1e-10, 60.0, y);
    assert_close(y[0], want[_i % 2][0], 1e-9);
    assert_close(y[1], want[_i % 2][1], 1e-9);
    assert_close(y[4], want[_i % 2][2], 1e-9);
    tribo_system_destroy(s);
}

/* A force of size P = 1 that turns at w = 0.6: a circle of radius sqrt(P^2 - N^2)/|k - w^2|, behind by asin(N/P); at rest for
 * N >= P. */
TEST(whirl)
{
    const double w = 0.6, limit = 0.3, radius = sqrt(1.0 - limit * limit) / (1.0 - w * w), lag = asin(limit), t1 = 20.0;
    double y[5] = {radius * cos(lag), -radius * sin(lag), radius * w * sin(lag), radius * w * cos(lag), 0.0}, still[5] = {0.0};
    assert_close(radius, 1.4905300022, 1e-10);
    assert_close(lag, 0.3046926540, 1e-10);
    tribo_system *s = planar_mass(identity, limit, limit);
    assert_ok(tribo_system_add_load(s, w, (const double[]){1.0, 0.0}, (const double[]){0.0, 1.0}));
    run(s, "event", 0.1, 1e-11, t1, y);
    assert_close(y[0], radius * cos(w * t1 - lag), 1e-9);
    assert_close(y[1], radius * sin(w * t1 - lag), 1e-9);
    assert_close(y[4], limit * radius * w * t1, 1e-9);
    assert_ok(tribo_set_limit_all(tribo_system_context(s), 1.0 + 1e-9));
    run(s, "event", 0.1, 1e-11, t1, still);
    assert_all_exact(still, ((const double[5]){0.0}), 5);
    tribo_system_destroy(s);
}

/* Contacts that become planar between advances move as those of a new system, also where frequencies leave a series with squares
 * fewer terms: a force that turns, on a structure with frequencies around omega. */
TEST(planar_later)
{
    const double omega[] = {1.0, 1e10, 1e-10}, w = omega[_i], springs[4] = {w * w, 0.0, 0.0, 1.7 * w * w};
    double y[2][5] = {{0.0}};
    for (int later = 0; later < 2; later++) {
        double t = 0.0;
        tribo_system *s;
        tribo_driver *d;
        assert_ok(dense_system(&s, 2, 2, identity, NULL, springs, identity, 0, NULL, 0));
        tribo_context *c = tribo_system_context(s);
        assert_ok(tribo_set_limit_all(c, 0.3));
        assert_ok(tribo_system_add_load(s, 0.6 * w, (const double[]){1.0, 0.0}, (const double[]){0.0, 1.0}));
        assert_ok(tribo_driver_create(&d, s, "event"));
        if (later) {
            driver_advance(d, &t, 1e-9 / w, y[1]);
            memset(y[1], 0, sizeof y[1]);
            t = 0.0;
        }
        assert_ok(tribo_set_planar(c, 1, (const size_t[]){0}));
        driver_advance(d, &t, 20.0 / w, y[later]);
        tribo_driver_destroy(d);
        tribo_system_destroy(s);
    }
    assert_all_exact(y[1], y[0], 5);
}

/* A block kicked sideways on an incline of slope mu: v (1 + cos phi) stays, phi from straight down, so that half the speed is
 * left. */
TEST(incline)
{
    double y[5] = {0.0, 0.0, 1.0, 0.0, 0.0};
    tribo_system *s = planar_mass(none, 1.0, 1.0);
    assert_ok(tribo_system_add_load(s, 0.0, (const double[]){0.0, 1.0}, NULL));
    tribo_driver *d = driver_create(s, "event", 0.1, 1e-11);
    double t = 0.0;
    for (int n = 1; n <= 4; n++) {
        driver_advance(d, &t, 2.0 * n, y);
        assert_close(hypot(y[2], y[3]) + y[3], 1.0, 1e-10);
    }
    assert_close(hypot(y[2], y[3]), 0.5, 1e-6);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* Code_Aster's SDND100 at 45 degrees in the plane: k = 1e4, m = 1, limit 1, released 0.85 mm off; from the fourth extreme on at
 * rest. */
TEST(released)
{
    const double springs[4] = {1e4, 0.0, 0.0, 1e4}, want[6] = {-0.65, 0.45, -0.25, 0.05, 0.05, 0.05}, side = sqrt(0.5);
    double t = 0.0, y[5] = {0.85e-3 * side, 0.85e-3 * side, 0.0, 0.0, 0.0};
    tribo_system *s = planar_mass(springs, 1.0, 1.0);
    tribo_driver *d = driver_create(s, "event", 1e-3, 1e-12);
    for (int n = 0; n < 6; n++) {
        driver_advance(d, &t, (n + 1) * PI / 100.0, y);
        assert_close(1e3 * y[0] / side, want[n], 1e-8);
        assert_close(1e3 * y[1] / side, want[n], 1e-8);
    }
    assert_exact(y[2], 0.0);
    assert_exact(y[3], 0.0);
    assert_close(y[4], 1e-3 * (0.85 + 2.0 * (0.65 + 0.45 + 0.25) + 0.05), 1e-11);
    require(driver_count(d, TRIBO_COUNT_EVENTS) >= 4, "stops are events");
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* On a line, in any direction, a planar contact is the scalar one: stick, slip and reversal. */
TEST(on_line)
{
    const double alpha[3] = {1.2, 1.6, 4.0}, angle[3] = {0.0, 0.3, 0.25 * PI}, t1 = 40.0;
    const double side[2] = {cos(angle[_i % 3]), sin(angle[_i % 3])}, p = alpha[_i / 3];
    double y[5] = {0.0}, scalar_y[3] = {0.0};
    tribo_system *s = planar_mass(identity, 1.0, 1.0), *scalar = oscillator(TRIBO_COULOMB, p, 0.5);
    assert_ok(tribo_system_add_load(s, 0.5, NULL, (const double[]){p * side[0], p * side[1]}));
    run(s, "event", 0.1, 1e-11, t1, y);
    run(scalar, "event", 0.1, 1e-12, t1, scalar_y);
    for (int d = 0; d < 2; d++) {
        assert_close(y[d], side[d] * scalar_y[0], 1e-9);
        assert_close(y[2 + d], side[d] * scalar_y[1], 1e-9);
    }
    assert_close(y[4], scalar_y[2], 1e-9);
    require(scalar_y[2] > 0.1, "nothing slides");
    tribo_system_destroy(s);
    tribo_system_destroy(scalar);
}

/* A contact that slides on a line, along an axis, and just reverses there on its base: the planar one is the scalar one, also
 * where what is left of its speed is next to nothing beside what it soon has. */
TEST(reverses_on_line)
{
    const double springs[4] = {1.9, 0.0, 0.0, 0.3}, load[2][2] = {{-0.15, 0.0}, {-0.71, 0.0}};
    const double base[3][2] = {{0.2, 0.0}, {0.26, 0.0}, {-0.04, 0.0}};
    struct random g = random_of(_i);
    double y[2][5] = {{uniform(&g, -0.5, 0.5), 0.0, uniform(&g, -0.5, 0.5)}}, error = 0.0;
    memcpy(y[1], y[0], sizeof y[0]);
    for (int scalar = 0; scalar < 2; scalar++) {
        tribo_system *s = planar_mass(springs, 0.27, scalar ? 0.0 : 0.8);
        assert_ok(tribo_system_add_load(s, 0.46, load[0], load[1]));
        assert_ok(tribo_system_add_base_motion(s, 1.59, base[0], base[1]));
        assert_ok(tribo_system_add_base_motion(s, 0.0, base[2], NULL));
        run(s, "event", 0.5, 1e-11, 60.0, y[scalar]);
        tribo_system_destroy(s);
    }
    for (int d = 0; d < 5; d++) {
        error = fmax(error, fabs(y[0][d] - y[1][d]));
    }
    require(error <= 1e-8, "off by %.3g", error);
}

/* ----------------------------------------------------------------------------------------------------- coupled contacts */

enum { MOST = 8 };

/* One to three masses with planar contacts, with each other for every third seed, and up to two with scalar ones, which may be
 * on the planar masses: springs and inertia between all, and two harmonics. scale: of limits; every second one has ellipses. */
static tribo_system *coupled(uint64_t seed, double scale, size_t *ndof)
{
    uint64_t s = seed * 7919u + 12345u;
    between(&s, 0.0, 1.0);
    const size_t planar = 1 + (size_t)between(&s, 0.0, 3.0), n = 2 * planar + (size_t)between(&s, 0.0, 3.0);
    double mass[MOST * MOST] = {0.0}, damping[MOST * MOST] = {0.0}, stiff[MOST * MOST] = {0.0}, j[MOST * MOST] = {0.0},
                       limit[MOST];
    for (size_t i = 0; i < n; i++) {
        mass[i * n + i] = between(&s, 0.5, 1.5);
        stiff[i * n + i] += between(&s, 0.3, 1.3);
        damping[i * n + i] = between(&s, 0.0, 0.05);
        limit[i] = scale * between(&s, 0.3, 1.2);
        j[i * n + i] = 1.0;
        for (size_t k = 0; k < i; k++) {
            const double spring = between(&s, 0.0, 1.0) < 0.5 ? between(&s, 0.0, 0.3) : 0.0;
            stiff[i * n + i] += spring;
            stiff[k * n + k] += spring;
            stiff[i * n + k] = stiff[k * n + i] = -spring;
            mass[i * n + k] = mass[k * n + i] = between(&s, -0.06, 0.06);
        }
    }
    for (size_t i = 0; i < n; i++) {
        if (i < 2 * planar ? seed % 3 == 1 && i >= 2 : seed % 2) {
            j[i * n + (i < 2 * planar ? i - 2 : i - 2 * planar)] = -1.0;
        }
        limit[i] = i < 2 * planar && i % 2 && seed % 2 ? limit[i - 1] : limit[i];
    }
    tribo_system *sys;
    assert_ok(dense_system(&sys, n, n, mass, damping, stiff, j, 0, NULL, 0));
    assert_ok(tribo_set_planar(tribo_system_context(sys), planar, (const size_t[]){0, 2, 4}));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    for (int h = 0; h < 2; h++) {
        double cosine[MOST], sine[MOST];
        for (size_t i = 0; i < n; i++) {
            cosine[i] = between(&s, -1.0, 1.0);
            sine[i] = between(&s, -1.2, 1.2);
        }
        assert_ok(tribo_system_add_load(sys, between(&s, 0.3, 1.3), cosine, sine));
    }
    *ndof = n;
    return sys;
}

static void run_coupled(uint64_t seed, double scale, const char *method, double dt, double tolerance, double *y)
{
    size_t n;
    tribo_system *s = coupled(seed, scale, &n);
    memset(y, 0, (2 * MOST + 1) * sizeof *y);
    assert_ok(tribo_set_epsilon_step(tribo_system_context(s), dt, 1.0));
    run(s, method, dt, tolerance, 15.0, y);
    tribo_system_destroy(s);
}

/* Tolerances are kept, up to what motions make of errors, also where contacts rest for long: then when they let go counts. */
TEST(tolerances)
{
    const double scale = _i % 2 ? 3.0 : 1.0;
    double rough[2 * MOST + 1], fine[2 * MOST + 1];
    run_coupled((uint64_t)_i, scale, "event", 0.1, 1e-9, rough);
    run_coupled((uint64_t)_i, scale, "event", 0.1, 1e-12, fine);
    const double off = largest_difference(rough, fine, 2 * MOST + 1);
    require(off < 1e-7, "seed %d: off by %g", _i, off);
}

/* What methods with steps come to as these become short. */
TEST(agreement)
{
    const char *methods[] = {"moreau/fixed", "rk4/fixed", "central/fixed"};
    const uint64_t seed = (uint64_t)(_i / 3);
    const double scale = seed % 2 ? 2.0 : 1.0;
    double want[2 * MOST + 1], coarse[2 * MOST + 1], fine[2 * MOST + 1];
    run_coupled(seed, scale, "event", 0.1, 1e-10, want);
    run_coupled(seed, scale, methods[_i % 3], 1.6e-2, 0.0, coarse);
    run_coupled(seed, scale, methods[_i % 3], 1e-3, 0.0, fine);
    const double far = largest_difference(coarse, want, 2 * MOST + 1), near = largest_difference(fine, want, 2 * MOST + 1);
    require(near < 2e-3, "%s, seed %d: off by %g", methods[_i % 3], _i / 3, near);
    require(near < 0.25 * far + 1e-6, "%s, seed %d: %g does not become less than %g", methods[_i % 3], _i / 3, far, near);
}

/* Two equal masses, pulled equally and joined by a spring, move equally; contacts let go and stick at the same instants. */
TEST(equal)
{
    const double stiff[16] = {1.3, 0.0, -0.3, 0.0, 0.0, 1.8, 0.0, -0.3, -0.3, 0.0, 1.3, 0.0, 0.0, -0.3, 0.0, 1.8};
    const double limits[2][4] = {{1.0, 1.0, 1.0, 1.0}, {1.0, 1.5, 1.0, 1.5}};
    double unit[16] = {0.0}, y[9] = {0.0}, one[5] = {0.0};
    tribo_system *s, *single;
    for (size_t i = 0; i < 4; i++) {
        unit[5 * i] = 1.0;
    }
    const double cosine[4] = {0.3, 0.8, 0.3, 0.8}, sine[4] = {1.3, -0.4, 1.3, -0.4}, springs[4] = {1.0, 0.0, 0.0, 1.5};
    assert_ok(dense_system(&s, 4, 4, unit, NULL, stiff, unit, 0, NULL, 0));
    assert_ok(tribo_set_planar(tribo_system_context(s), 2, (const size_t[]){0, 2}));
    assert_ok(tribo_set_limit(tribo_system_context(s), limits[_i]));
    assert_ok(tribo_system_add_load(s, 0.5, cosine, sine));
    single = planar_mass(springs, limits[_i][0], limits[_i][1]);
    assert_ok(tribo_system_add_load(single, 0.5, cosine, sine));
    run(s, "event", 0.1, 1e-10, 30.0, y);
    run(single, "event", 0.1, 1e-10, 30.0, one);
    assert_all_close(y, one, 2, 1e-8);
    assert_all_close(y + 2, one, 2, 1e-8);
    assert_close(y[8], 2.0 * one[4], 1e-8);
    require(one[4] > 0.1, "nothing slides");
    tribo_system_destroy(s);
    tribo_system_destroy(single);
}

/* Without a limit in one direction it is a scalar contact, without any it is open. */
TEST(no_limits)
{
    const double springs[4] = {1.0, 0.2, 0.2, 1.7}, limit[2] = {_i ? 0.5 : 0.0, 0.0};
    double y[5] = {0.1, 0.0, 0.0, 0.2, 0.0}, want[5] = {0.1, 0.0, 0.0, 0.2, 0.0};
    tribo_system *s = planar_mass(springs, limit[0], limit[1]);
    assert_ok(tribo_system_add_load(s, 0.7, (const double[]){0.8, 0.4}, NULL));
    run(s, "event", 0.1, 1e-10, 20.0, y);
    assert_ok(tribo_set_planar(tribo_system_context(s), 0, NULL));
    run(s, "event", 0.1, 1e-10, 20.0, want);
    assert_all_close(y, want, 5, 1e-9);
    tribo_system_destroy(s);
}

/* Advances in parts, and changes between them. */
TEST(parts)
{
    const double springs[4] = {1.0, 0.0, 0.0, 1.7};
    double y[5] = {0.0}, want[5] = {0.0}, t = 0.0;
    tribo_system *s = planar_mass(springs, 1.0, 0.6);
    assert_ok(tribo_system_add_load(s, 0.7, (const double[]){1.2, 0.3}, (const double[]){0.2, 1.1}));
    run(s, "event", 0.1, 1e-11, 20.0, want);
    tribo_driver *d = driver_create(s, "event", 0.1, 1e-11);
    for (int k = 1; k <= 40; k++) {
        driver_advance(d, &t, 0.5 * k, y);
    }
    assert_all_close(y, want, 5, 1e-9);
    assert_ok(tribo_set_limit_all(tribo_system_context(s), 10.0));
    driver_advance(d, &t, 40.0, y);
    assert_exact(y[2], 0.0);
    assert_exact(y[3], 0.0);
    assert_ok(tribo_set_planar(tribo_system_context(s), 0, NULL));
    driver_advance(d, &t, 41.0, y);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* ------------------------------------------------------------------------------------------------------------- refusals */

/* Limits of both directions that change with time, and differ. */
TEST(refused)
{
    double y[5] = {0.0}, t = 0.0;
    tribo_system *s = planar_mass(identity, 1.0, 1.0);
    assert_ok(tribo_system_add_load(s, 1.0, (const double[]){1.5, 0.0}, NULL));
    tribo_driver *d = driver_create(s, "event", 0.1, 1e-9);
    assert_ok(tribo_system_add_limit(s, 1.0, (const double[]){0.1, 0.2}, NULL));
    assert_status(tribo_driver_advance(d, &t, 1.0, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(d), "limits of both directions of the planar contact 0 change with time, and differ");
    assert_exact(t, 0.0);
    assert_status(tribo_driver_find_periodic(d, 0.0, 2.0 * PI, y), TRIBO_ERR_UNSUPPORTED);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* A limit that swings, and lifts off where it would be negative (1), and a limit by a table (2): on a line, directions askew, a
 * planar contact is the scalar one. Without a table also its periodic motion, and multipliers. */
TEST(limits_vary)
{
    const double askew[4] = {0.6, 0.8, -0.8, 0.6}, one[1] = {1.0}, size[] = {0.5, 1.3, 0.0};
    double y[2][5] = {{0.0}}, re[2][4], im[4], t;
    for (size_t plane = 0; plane < 2; plane++) {
        const size_t n = 1 + plane;
        tribo_system *s;
        assert_ok(dense_system(&s, n, n, identity, NULL, plane ? identity : one, plane ? askew : one, 0, NULL, 0));
        assert_ok(plane ? tribo_set_planar(tribo_system_context(s), 1, (const size_t[]){0}) : TRIBO_OK);
        assert_ok(tribo_set_limit_all(tribo_system_context(s), 0.8));
        assert_ok(tribo_system_add_load(s, 0.7, (const double[]){1.6, 0.0}, (const double[]){0.4, 0.0}));
        if (_i < 2) {
            assert_ok(tribo_system_add_limit(s, 1.4, (const double[]){size[_i], size[_i]}, NULL));
        } else {
            const double time[] = {0.0, 5.0, 7.0, 20.0}, limit[] = {1.0, 1.0, 0.2, 0.2, 0.0, 0.0, 1.5, 1.5};
            const double alone[] = {1.0, 0.2, 0.0, 1.5};
            assert_ok(tribo_system_set_limit_table(s, 4, time, plane ? limit : alone));
        }
        tribo_driver *d = driver_create(s, "event", 0.1, 1e-11);
        t = 0.0;
        driver_advance(d, &t, 20.0, y[plane]);
        if (_i < 2) {
            assert_ok(tribo_driver_find_periodic(d, 0.0, 2.0 * PI / 0.7, y[plane]));
            assert_ok(tribo_driver_get_multipliers(d, re[plane], im));
        }
        tribo_driver_destroy(d);
        tribo_system_destroy(s);
    }
    assert_close(y[1][0], y[0][0], 1e-9);
    assert_close(y[1][1], 0.0, 1e-9);
    assert_close(y[1][2], y[0][1], 1e-9);
    assert_close(y[1][4], y[0][2], 1e-9);
}

/* Limits that fall with the speed, nothing changed; of a planar contact, or of a scalar one beside it. Ratios of 1 are none. */
TEST(refused_falling)
{
    const double diagonal[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}, nothing[9] = {0.0}, velocity[3] = {0.3, 0.3, 0.3};
    const double more = _i < 1 ? 2.0 : 1.0, ratio[2][3] = {{more, more, 3.0 - more}, {1.0, 1.0, 1.0}};
    const double start[7] = {0.0, 0.0, 0.0, 0.6, -0.8, 1.0, 0.0};
    double y[7], t = 0.0;
    tribo_system *s;
    assert_ok(dense_system(&s, 3, 3, diagonal, NULL, nothing, diagonal, 0, NULL, 0));
    tribo_context *c = tribo_system_context(s);
    assert_ok(tribo_set_planar(c, 1, (const size_t[]){0}));
    assert_ok(tribo_set_limit_all(c, 0.6));
    assert_ok(tribo_set_static(c, ratio[0], velocity));
    tribo_driver *d = driver_create(s, _i ? "event" : "auto", 0.1, 1e-9);
    memcpy(y, start, sizeof y);
    assert_status(tribo_driver_advance(d, &t, 1.0, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(d), _i < 1 ? "contact 0 has ratio[0] = 2" : "contact 2 has ratio[2] = 2");
    assert_all_exact(y, start, 7);
    assert_exact(t, 0.0);
    assert_ok(tribo_set_static(c, ratio[1], NULL));
    driver_advance(d, &t, 1.0, y);
    assert_close(hypot(y[3], y[4]), 0.4, 1e-9);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* Two planar contacts hold one mass: how they share is not known at rest; while it slides they are fine. */
TEST(redundant)
{
    const double twice[8] = {1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0};
    double y[5] = {0.0, 0.0, 2.0, 1.0, 0.0}, t = 0.0;
    tribo_system *s;
    assert_ok(dense_system(&s, 2, 4, identity, NULL, none, twice, 0, NULL, 0));
    assert_ok(tribo_set_planar(tribo_system_context(s), 2, (const size_t[]){0, 2}));
    assert_ok(tribo_set_limit_all(tribo_system_context(s), 0.5));
    tribo_driver *d = driver_create(s, "event", 0.1, 1e-10);
    driver_advance(d, &t, 1.0, y);
    assert_close(hypot(y[2], y[3]), sqrt(5.0) - 1.0, 1e-10);
    assert_status(tribo_driver_advance(d, &t, 10.0, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(d), "redundant");
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* Beside a load so fast that few terms have numbers for powers of its frequency, and without it again: as from the beginning. */
TEST(fewer_and_more_terms)
{
    const double m[] = {1.0, 0.0, 0.0, 1.0}, k[] = {1.0, 0.0, 0.0, 1.7}, load[] = {1e-9, 0.0}, slow[] = {0.0, 1.5};
    const size_t first = 0;
    double y[2][5] = {{0.9, 0.3, 0.0, 0.5, 0.0}, {0.9, 0.3, 0.0, 0.5, 0.0}};
    for (int with = 0; with < 2; with++) {
        double t = 0.0, z[5] = {0.9, 0.3, 0.0, 0.5, 0.0};
        tribo_system *sys;
        assert_ok(dense_system(&sys, 2, 2, m, NULL, k, m, 0, NULL, 0));
        assert_ok(tribo_set_planar(tribo_system_context(sys), 1, &first));
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.3));
        assert_ok(tribo_system_add_load(sys, 0.6, slow, NULL));
        tribo_driver *drv = driver_create(sys, "event", 0.1, 1e-14);
        if (with) {
            assert_ok(tribo_system_add_load(sys, 1e12, load, NULL));
            driver_advance(drv, &t, 1e-11, z);
            assert_ok(tribo_system_clear_loads(sys));
            assert_ok(tribo_system_add_load(sys, 0.6, slow, NULL));
        }
        t = 0.0;
        driver_advance(drv, &t, 5.0, y[with]);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    assert_all_close(y[1], y[0], 5, 1e-11);
}

/* A load that goes around the limit, at 1 + d times its size everywhere: for d <= 0 the contact rests exactly, by however little;
 * otherwise it creeps as in small steps. Circles and ellipses, with springs, and masses that are coupled. */
TEST(spinning_edge)
{
    static const double far[] = {-1e-3, -1e-8, -1e-11, -1e-13, -1e-15, 0.0,  1e-15, 1e-14,
                                 1e-13, 1e-12, 1e-10,  1e-8,   1e-6,   1e-4, 1e-2};
    const double d = far[_i / 4], spring = _i % 2, axis = _i / 2 % 2 ? 2.5 : 1.0, inertia = _i / 2 % 2 ? 0.3 : 0.0;
    const double m[] = {1.0, inertia, inertia, 2.0}, k[] = {spring, 0.0, 0.0, spring}, limit[] = {1.0, axis};
    double y[2][5] = {{0.0}, {0.0}};
    for (int which = 0; which < 2; which++) {
        tribo_system *s;
        assert_ok(dense_system(&s, 2, 2, m, NULL, k, identity, 0, NULL, 0));
        assert_ok(tribo_set_planar(tribo_system_context(s), 1, (const size_t[]){0}));
        assert_ok(tribo_set_limit(tribo_system_context(s), limit));
        assert_ok(tribo_system_add_load(s, 1.1, (const double[]){1.0 + d, 0.0}, (const double[]){0.0, axis * (1.0 + d)}));
        run(s, which ? "moreau/fixed" : "event", which ? 2e-4 : 0.1, which ? 0.0 : 1e-11, 5.0, y[which]);
        tribo_system_destroy(s);
    }
    if (d <= 0.0) {
        assert_all_exact(y[0], none, 4);
    }
    assert_all_close(y[0], y[1], 2, 1e-6 + 1e-2 * hypot(y[1][0], y[1][1]));
}

TEST_MAIN("planar_event", {reference, 4}, {whirl, 1}, {planar_later, 3}, {incline, 1}, {released, 1}, {reverses_on_line, 40},
          {on_line, 9}, {tolerances, 40}, {agreement, 36}, {equal, 2}, {no_limits, 2}, {parts, 1}, {refused, 1}, {limits_vary, 3},
          {refused_falling, 2}, {redundant, 1}, {fewer_and_more_terms, 1}, {spinning_edge, 60})
