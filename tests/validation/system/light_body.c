/* SPDX-License-Identifier: BSD-3-Clause */
/* A light body between the ground and a heavy one: the heavy one moves as if it stood on the ground itself, with the smaller one
 * of both limits, whatever the light one weighs. */
#include "make.h"
#include "run.h"

#include <string.h>

static const double limits[][2] = {{0.1, 0.3}, {0.3, 0.1}, {0.2, 0.2}};
static const double ratios[] = {1e6, 1e9, 1e12, 1e14, 1e16, 1e17};

static const struct {
    const char *name;
    double dt, tolerance, error;
} methods[] = {{"exact", 1.0, 0.0, 1e-12},
               {"event", 1.0, 1e-12, 1e-10},
               {"central/fixed", 2e-3, 0.0, 1e-12},
               {"moreau/fixed", 2e-3, 0.0, 1e-12}};

/* limit [2] of the contacts with the ground and between the bodies; off is what the mass matrix has off its diagonal, in parts of
 * the most that it may have, and join a spring between them. */
static tribo_system *stand(double ratio, const double *limit, double off, double join, int expected)
{
    const double light = 1.0 / ratio, both = off * sqrt(light), mass[] = {light, both, both, 1.0};
    const double stiffness[] = {join, -join, -join, 1.0 + join}, direction[] = {1.0, 0.0, -1.0, 1.0}, load[] = {0.0, 0.7};
    tribo_system *sys = NULL;
    char text[200];
    assert_status(dense_system(&sys, 2, 2, mass, NULL, stiffness, direction, 0, text, sizeof text), expected);
    if (sys) {
        assert_ok(tribo_set_law(tribo_system_context(sys), TRIBO_COULOMB));
        assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
        assert_ok(tribo_system_add_load(sys, 0.5, NULL, load));
    } else {
        assert_says(text, "contact 1 touches bodies of which one is");
    }
    return sys;
}

static tribo_system *alone(double limit)
{
    const double one = 1.0, load = 0.7;
    tribo_system *sys;
    assert_ok(dense_system(&sys, 1, 1, &one, NULL, &one, &one, 0, NULL, 0));
    assert_ok(tribo_set_law(tribo_system_context(sys), TRIBO_COULOMB));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), limit));
    assert_ok(tribo_system_add_load(sys, 0.5, NULL, &load));
    return sys;
}

TEST(moves_as_if_alone)
{
    const size_t m = (size_t)_i % COUNT(methods), l = (size_t)_i / COUNT(methods) % COUNT(limits);
    const double ratio = ratios[(size_t)_i / COUNT(methods) / COUNT(limits)];
    tribo_system *pair = stand(ratio, limits[l], 0.0, 0.0, TRIBO_OK), *one = alone(fmin(limits[l][0], limits[l][1]));
    double y[5] = {0.0}, want[3] = {0.0};
    run(pair, methods[m].name, methods[m].dt, methods[m].tolerance, 20.0, y);
    run(one, methods[m].name, methods[m].dt, methods[m].tolerance, 20.0, want);
    const double error = methods[m].error + 20.0 / ratio;
    assert_close(y[1], want[0], error);
    assert_close(y[3], want[1], error);
    assert_close(y[4], want[2], error);
    ck_assert(fabs(want[2]) > 0.5);
    tribo_system_destroy(pair);
    tribo_system_destroy(one);
}

/* What a dense matrix hides is refused, and what does no harm is not. */
TEST(hidden_bodies)
{
    double y[5] = {0.0}, t = 0.0;
    tribo_driver *drv;
    stand(1e12, limits[0], 0.1, 0.0, TRIBO_ERR_UNSUPPORTED);
    tribo_system_destroy(stand(1e6, limits[0], 0.1, 0.0, TRIBO_OK));
    tribo_system *sys = stand(1e12, limits[0], 0.0, 1e-9, TRIBO_OK);
    drv = driver_create(sys, "moreau/fixed", 1e-3, 0.0);
    assert_status(tribo_driver_advance(drv, &t, 1.0, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(drv), "contact 1 touches bodies");
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------ beside planar contacts */

/* A heavy body in the plane with a planar contact of limit 0.3, on which another one acts along x: of the smaller one of both
 * limits, or by a light body that stands on the ground and so in between. light 0: there is none. */
static void move_in_plane(const char *method, double light, const double *limit, double dt, double *y)
{
    enum { MOST = 3 };
    const size_t n = light > 0.0 ? 3 : 2, contacts = n + 1;
    const double cosine[MOST] = {0.0, 0.9 * cos(0.4), 0.0}, sine[MOST] = {1.1, -0.9 * sin(0.4), 0.0};
    const double limits_of[4] = {0.3, 0.3, light > 0.0 ? limit[0] : fmin(limit[0], limit[1]), limit[1]};
    double mass[MOST * MOST] = {0.0}, stiffness[MOST * MOST] = {0.0}, direction[4 * MOST] = {0.0};
    for (size_t i = 0; i < n; i++) {
        mass[i * n + i] = i < 2 ? 1.0 : light;
    }
    stiffness[0] = direction[0] = direction[n + 1] = direction[2 * n] = 1.0;
    stiffness[n + 1] = 1.7;
    if (light > 0.0) {
        direction[2 * n + 2] = -1.0;
        direction[3 * n + 2] = 1.0;
    }
    tribo_system *sys;
    assert_ok(dense_system(&sys, n, contacts, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limits_of));
    assert_ok(tribo_set_planar(tribo_system_context(sys), 1, (const size_t[]){0}));
    assert_ok(tribo_set_epsilon_step(tribo_system_context(sys), dt, 1.0));
    assert_ok(tribo_system_add_load(sys, 0.7, cosine, sine));
    double state[2 * MOST + 1] = {0.0};
    run(sys, method, dt, 0.0, 20.0, state);
    for (size_t k = 0; k < 2; k++) {
        y[k] = state[k];
        y[2 + k] = state[n + k];
    }
    y[4] = state[2 * n];
    tribo_system_destroy(sys);
}

/* What ordinary digits do not tell is refused, whichever call comes first. */
TEST(hidden_in_the_plane)
{
    const double inverse[4] = {1.0, 1.0, _i ? 1e8 : 1e12, 0.0}, val[] = {1.0, 1.0, 1.0, -1.0, 1.0};
    const size_t rowptr[] = {0, 1, 2, 4, 5}, col[] = {0, 1, 0, 2, 2}, first = 0;
    const int want = _i ? TRIBO_OK : TRIBO_ERR_UNSUPPORTED;
    for (int before = 0; before < 2; before++) {
        tribo_context *c;
        assert_ok(tribo_create(&c, 4));
        assert_ok(tribo_set_limit_all(c, 1.0));
        assert_ok(before ? tribo_set_planar(c, 1, &first) : TRIBO_OK);
        assert_status(tribo_set_operator_mass(c, 3, inverse, rowptr, col, val), before ? want : TRIBO_OK);
        assert_status(before ? want : tribo_set_planar(c, 1, &first), want);
        if (want) {
            assert_says(tribo_message(c), "contact 2 touches bodies of which one is 1e+12 times as heavy as the other");
        }
        tribo_destroy(c);
    }
}

/* The step form of planar contacts takes scalar ones along: as near a fine run by another method as without the light body. */
TEST(in_the_plane)
{
    static const char *const steps[] = {"central/fixed", "moreau/fixed"};
    const double *limit = limits[_i / 2], light[] = {0.0, 1e-6, 1e-10};
    double want[5], y[5];
    move_in_plane("rk4/fixed", 0.0, limit, 2e-4, want);
    require(want[4] > 5.0, "dissipated %g", want[4]);
    for (size_t k = 0; k < COUNT(light); k++) {
        move_in_plane(steps[_i % 2], light[k], limit, 1e-3, y);
        const char *off = differences(steps[_i % 2], y, want, 5, 1e-3);
        require(!off, "light body of %g: %s", light[k], off);
    }
}

TEST_MAIN("light_body", {in_the_plane, 6}, {hidden_in_the_plane, 2},
          {moves_as_if_alone, (int)(COUNT(methods) * COUNT(limits) * COUNT(ratios))}, {hidden_bodies, 1})
