/* SPDX-License-Identifier: BSD-3-Clause */
/* Static limits that drop at once, of planar contacts and of scalar ones beside them, in driver "event": closed forms of the
 * line, structures of lines beside method "exact", and methods with steps as these become short. */
#include "make.h"
#include "run.h"

#include <string.h>

enum { BODIES = 3, FLAT = 2 * BODIES };

static const double axis[4][2] = {{1.0, 0.0}, {0.0, -1.0}, {0.6, 0.8}, {-0.28, 0.96}};

/* A block of mass 1 on springs of 1, kinetic limit 0.6 and static one 1, on a belt that runs at 0.2 along e: t_stick = 2 D/v0,
 * t_slip = 2 (pi - atan(D/v0)), the slip an arc of amplitude sqrt(D^2 + v0^2) about 0.6; D = 0.4, v0 = 0.2. From its sticking at
 * x = 0.2 along e. */
TEST(stick_slip)
{
    const double *e = axis[_i % 4], d = 0.4, v0 = 0.2, one[4] = {1.0, 0.0, 0.0, 1.0}, belt[2] = {v0 * e[0], v0 * e[1]};
    const double period = 2.0 * d / v0 + 2.0 * (PI - atan(d / v0)),
                 until[3] = {2.0, 2.0 * period + 3.0, 9.0 * period + 4.0 + 1.5};
    const double x[3] = {0.2 + 0.2 * 2.0, 0.2 + 0.2 * 3.0, 0.6 + d * cos(1.5) + v0 * sin(1.5)},
                 v[3] = {v0, v0, v0 * cos(1.5) - d * sin(1.5)};
    for (int stage = 0; stage < 3; stage++) {
        double y[5] = {0.2 * e[0], 0.2 * e[1], 0.2 * e[0], 0.2 * e[1], 0.0};
        tribo_system *sys;
        assert_ok(dense_system(&sys, 2, 2, one, NULL, one, one, 0, NULL, 0));
        assert_ok(tribo_system_add_base_motion(sys, 0.0, belt, NULL));
        assert_ok(tribo_set_planar(tribo_system_context(sys), 1, (const size_t[]){0}));
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.6));
        assert_ok(tribo_set_static(tribo_system_context(sys), (const double[]){1.0 / 0.6, 1.0 / 0.6}, NULL));
        run(sys, _i < 4 ? "event" : "auto", 0.1, 1e-12, until[stage], y);
        for (int k = 0; k < 2; k++) {
            assert_close(y[k], x[stage] * e[k], 1e-9);
            assert_close(y[2 + k], v[stage] * e[k], 1e-9);
        }
        tribo_system_destroy(sys);
    }
}

/* ----------------------------------------------------------------------------------------------------------------- lines
 * A chain of bodies on a line with contacts to ground, or to each other, and the same along an axis in a plane, each stiffness
 * and mass the same in all directions. */

/* Scene of seed on a line, wide = 1, or in a plane, wide = 2: every second contact of every second seed is scalar there, along
 * the axis. alike: limits and loads of all bodies are equal, and so are the motions. ratio 1: no static limits. */
static tribo_system *chain(uint64_t seed, size_t wide, const double *e, int alike, double *omega)
{
    uint64_t s = seed * 7919u + 999u;
    between(&s, 0.0, 1.0);
    const size_t bodies = 1 + (size_t)between(&s, 0.0, 3.0), n = wide * bodies, scalar = wide == 2 && seed % 2;
    double mass[FLAT * FLAT] = {0.0}, damping[FLAT * FLAT] = {0.0}, stiff[FLAT * FLAT] = {0.0}, j[FLAT * FLAT] = {0.0},
                       limit[FLAT], ratio[FLAT], load[FLAT];
    size_t pair[BODIES], pairs = 0, rows = 0;
    const double weight = between(&s, 0.5, 1.5), ground = between(&s, 0.3, 1.3), loss = between(&s, 0.01, 0.05);
    const double bound = between(&s, 0.3, 1.2), more = between(&s, 1.1, 2.0), force = between(&s, 1.2, 2.5);
    *omega = between(&s, 0.3, 1.3);
    for (size_t b = 0; b < bodies; b++) {
        const double own[] = {between(&s, 0.5, 1.5), between(&s, 0.3, 1.3), between(&s, 0.01, 0.05), between(&s, 0.3, 1.2),
                              between(&s, 1.0, 2.0), between(&s, 0.5, 2.5), between(&s, 0.0, 0.3)};
        const int on = seed % 3 == 1 && b > 0, along = scalar && b % 2 == 0;
        for (size_t d = 0; d < wide; d++) {
            const size_t i = wide * b + d, under = i - wide;
            mass[i * n + i] = alike ? weight : own[0];
            stiff[i * n + i] += alike ? ground : own[1];
            damping[i * n + i] = alike ? loss : own[2];
            load[i] = (alike ? force : own[5]) * (wide == 2 ? e[d] : 1.0);
            if (b > 0) {
                stiff[i * n + i] += own[6];
                stiff[under * n + under] += own[6];
                stiff[i * n + under] = stiff[under * n + i] = -own[6];
            }
            if (along) {
                j[rows * n + i] = e[d];
            } else {
                j[(rows + d) * n + i] = 1.0;
            }
            if (on && !alike) {
                j[(along ? rows : rows + d) * n + under] = along ? -e[d] : -1.0;
            }
        }
        pair[pairs] = rows;
        pairs += !along;
        for (size_t k = 0; k < (along ? 1 : wide); k++, rows++) {
            limit[rows] = alike ? bound : own[3];
            ratio[rows] = alike ? more : b == 2 ? 1.0 : own[4];
        }
    }
    tribo_system *sys;
    assert_ok(dense_system(&sys, n, rows, mass, damping, stiff, j, 0, NULL, 0));
    tribo_context *c = tribo_system_context(sys);
    assert_ok(tribo_set_planar(c, wide == 2 ? pairs : 0, pair));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_static(c, ratio, NULL));
    assert_ok(tribo_system_add_load(sys, *omega, load, NULL));
    return sys;
}

/* As on the line by "exact". */
TEST(lines)
{
    const double *e = axis[_i / 2 % 4];
    double omega, line[2 * BODIES + 1] = {0.0}, y[2 * FLAT + 1] = {0.0};
    tribo_system *sys = chain((uint64_t)_i, 1, e, _i % 5 == 0, &omega);
    const size_t bodies = tribo_system_ndof(sys);
    run(sys, "exact", 0.1, 0.0, 30.0, line);
    tribo_system_destroy(sys);
    sys = chain((uint64_t)_i, 2, e, _i % 5 == 0, &omega);
    run(sys, "event", 0.1, 1e-12, 30.0, y);
    tribo_system_destroy(sys);
    for (size_t k = 0; k < 4 * bodies; k++) {
        const double off = y[k] - line[k / 2] * e[k % 2];
        require(fabs(off) < 1e-8, "seed %d, value %zu: off by %g", _i, k, off);
    }
    require(fabs(y[4 * bodies] - line[2 * bodies]) < 1e-8, "seed %d: dissipated %.12g, %.12g", _i, y[4 * bodies],
            line[2 * bodies]);
}

/* A body on a line, wide = 1, or in a plane, wide = 2, whose limit follows a normal load that lifts off or, for even seeds,
 * changes with time, with a static ratio. */
static tribo_system *varying(uint64_t seed, size_t wide, const double *e, double *omega)
{
    uint64_t s = seed + 17;
    between(&s, 0.0, 1.0);
    const double mu = between(&s, 0.2, 0.8), kn = between(&s, 5.0, 20.0), ratio = between(&s, 1.1, 2.0);
    const size_t n = wide + 1;
    const double ratios[3] = {ratio, wide == 2 ? ratio : 1.0, 1.0};
    double mass[9] = {0.0}, stiff[9] = {0.0}, j[9] = {0.0}, damping[9] = {0.0}, load[3] = {0.0}, press[3] = {0.0},
           still[3] = {0.0};
    *omega = between(&s, 0.7, 1.6);
    const double force = between(&s, 0.5, 2.0), spring = between(&s, 0.5, 2.0);
    for (size_t i = 0; i < n; i++) {
        mass[i * n + i] = j[i * n + i] = 1.0;
        stiff[i * n + i] = spring;
        damping[i * n + i] = 0.05;
        load[i] = i == wide ? 0.0 : force * (wide == 2 ? e[i] : 1.0);
        if (i < wide) { /* the normal direction moves along, or multipliers would not know how limits follow it */
            stiff[i * n + wide] = stiff[wide * n + i] = 0.2 * (wide == 2 ? e[i] : 1.0);
        }
    }
    press[wide] = between(&s, 0.3, 1.5);
    still[wide] = 1.0;
    tribo_model *model = dense_model(n, n, mass, damping, stiff, j);
    if (seed % 2) {
        assert_ok(tribo_model_set_normal(model, 0, wide, mu, kn, 0.0));
    }
    tribo_system *sys = finish_model(model);
    tribo_context *c = tribo_system_context(sys);
    assert_ok(tribo_set_planar(c, wide - 1, (const size_t[]){0}));
    assert_ok(tribo_set_static(c, ratios, NULL));
    if (seed % 2 == 0) {
        const double bound[3] = {0.8, wide == 2 ? 0.8 : 0.0, 0.0}, by[3] = {mu, wide == 2 ? mu : 0.0, 0.0};
        assert_ok(tribo_set_limit(c, bound));
        assert_ok(tribo_system_add_limit(sys, 2.0 * *omega, by, NULL));
    }
    assert_ok(tribo_system_add_load(sys, *omega, load, NULL));
    assert_ok(tribo_system_add_load(sys, 3.0 * *omega, NULL, press));
    assert_ok(tribo_system_add_load(sys, 0.0, still, NULL));
    return sys;
}

/* As on the line. */
TEST(limits_that_vary)
{
    const double *e = axis[_i / 2 % 4];
    double y[2][7] = {{0.0}}, omega;
    for (size_t wide = 1; wide < 3; wide++) {
        tribo_system *sys = varying((uint64_t)_i, wide, e, &omega);
        run(sys, "event", 0.1, 1e-12, 20.0, y[wide - 1]);
        tribo_system_destroy(sys);
    }
    for (size_t k = 0; k < 4; k++) {
        const double off = y[1][3 * (k / 2) + k % 2] - y[0][2 * (k / 2)] * e[k % 2];
        require(fabs(off) < 1e-8, "seed %d, value %zu: off by %g", _i, k, off);
    }
    require(fabs(y[1][6] - y[0][4]) < 1e-8, "seed %d: dissipated %.12g, %.12g", _i, y[1][6], y[0][4]);
}

/* ------------------------------------------------------------------------------------------------------------ two directions */

/* The chain in a plane, with a load across the axis, too, until t = 15. */
static void run_across(uint64_t seed, const char *method, double dt, double tolerance, double *y)
{
    double omega, across[FLAT];
    tribo_system *sys = chain(seed, 2, axis[2], 0, &omega);
    for (size_t i = 0; i < tribo_system_ndof(sys); i++) {
        across[i] = (1.0 + 0.3 * (double)(i / 2)) * (i % 2 ? axis[2][0] : -axis[2][1]);
    }
    assert_ok(tribo_system_add_load(sys, 0.77 * omega, NULL, across));
    memset(y, 0, (2 * FLAT + 1) * sizeof *y);
    run(sys, method, dt, tolerance, 15.0, y);
    tribo_system_destroy(sys);
}

/* Tolerances are kept; and methods with steps, of first order where static limits are lost, come to the same. */
TEST(across)
{
    double want[2 * FLAT + 1], rough[2 * FLAT + 1], coarse[2 * FLAT + 1], fine[2 * FLAT + 1];
    run_across((uint64_t)_i, "event", 0.1, 1e-12, want);
    run_across((uint64_t)_i, "event", 0.1, 1e-9, rough);
    const double off = largest_difference(rough, want, 2 * FLAT + 1);
    require(off < 1e-6, "seed %d: off by %g", _i, off);
    run_across((uint64_t)_i, "moreau/fixed", 8e-3, 0.0, coarse);
    run_across((uint64_t)_i, "moreau/fixed", 1e-3, 0.0, fine);
    const double far = largest_difference(coarse, want, 2 * FLAT + 1), near = largest_difference(fine, want, 2 * FLAT + 1);
    require(near < 0.01 && near < 0.35 * far + 1e-3, "seed %d: off by %g, %g", _i, far, near);
}

/* The periodic motion from `begin` on returns, and the traces of the map over a period and of its square are those of
 * multipliers. Ends the test, and sys. */
static void assert_multipliers(tribo_system *sys, double begin, double period)
{
    double y[2 * FLAT + 1] = {0.0};
    tribo_driver *d = driver_create(sys, "event", 0.0, 0.0);
    const int status = tribo_driver_find_periodic(d, begin, period, y);
    require(!status, "%s", tribo_driver_message(d));
    assert_traces(d, 2 * tribo_system_ndof(sys), begin, period, y, 1e-6, 1e-5);
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

/* From 0.17 of a period on, where in these scenes no contact at rest has a force above its kinetic limit: moved, that would not
 * come to rest. */
TEST(multipliers)
{
    double aside[FLAT], omega;
    tribo_system *sys = chain((uint64_t)_i, 2, axis[2], 0, &omega);
    for (size_t i = 0; i < tribo_system_ndof(sys); i++) {
        aside[i] = (0.5 + 0.3 * (double)(i / 2)) * (i % 2 ? axis[2][0] : -axis[2][1]);
    }
    assert_ok(tribo_system_add_load(sys, omega, NULL, aside));
    assert_multipliers(sys, 0.17 * 2.0 * PI / omega, 2.0 * PI / omega);
}

/* The same where limits vary. */
TEST(multipliers_vary)
{
    double omega;
    tribo_system *sys = varying((uint64_t)(_i < 10 ? _i : 2 * _i - 9), 2, axis[2], &omega);
    const double aside[3] = {0.4, -0.3, 0.0};
    assert_ok(tribo_system_add_load(sys, omega, NULL, aside));
    assert_multipliers(sys, 0.17 * 2.0 * PI / omega, 2.0 * PI / omega);
}

TEST_MAIN("planar_drops", {stick_slip, 8}, {lines, 60}, {limits_that_vary, 60}, {across, 30}, {multipliers, 22},
          {multipliers_vary, 16})
