/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar contacts with springs before their sliders, by event. */
#include "make.h"
#include "run.h"

#include <math.h>
#include <string.h>

enum { MOST = 11 };

/* How the whirl of a mass has its contact: along its axes; along others; by a limit that follows a normal load, which a third
 * degree of freedom makes; rigid, on a node without mass. */
enum { PLAIN, ASKEW, FOLLOWS, MASSLESS, KINDS };

/* x'' + k x + f = e^(i w t), the slider behind a spring kt under the limit. */
static tribo_system *whirl(int kind, double k, double kt, double limit, double w)
{
    const double c[3] = {1.0 / kt, 1.0 / kt, 0.0}, mass[4] = {1.0, 1.0, kind == FOLLOWS};
    const size_t n = kind == FOLLOWS ? 3 : kind == MASSLESS ? 4 : 2, contacts = kind == FOLLOWS ? 3 : 2;
    double stiffness[16] = {0.0}, rows[9] = {0.0};
    tribo_model *model;
    tribo_system *sys;
    for (size_t i = 0; i < 2; i++) {
        rows[i * n + (kind == MASSLESS ? 2 + i : i)] = kind == ASKEW ? 0.6 : 1.0;
        rows[i * n + 1 - i] = kind == ASKEW ? (i ? -0.8 : 0.8) : rows[i * n + 1 - i];
        stiffness[i * n + i] = k + (kind == MASSLESS ? kt : 0.0);
        for (size_t j = 2 + i; kind == MASSLESS && j == 2 + i; j++) {
            stiffness[j * n + j] = kt;
            stiffness[i * n + j] = stiffness[j * n + i] = -kt;
        }
    }
    if (kind == FOLLOWS) {
        rows[8] = stiffness[8] = 1.0;
    }
    assert_ok(tribo_model_create(&model, n, contacts));
    assert_ok(tribo_model_set_mass_diagonal(model, mass));
    assert_ok(tribo_model_set_stiffness(model, stiffness));
    assert_ok(tribo_model_set_direction(model, rows));
    if (kind != MASSLESS) {
        assert_ok(tribo_model_set_compliance(model, c));
    }
    if (kind == FOLLOWS) {
        assert_ok(tribo_model_set_normal(model, 0, 2, 0.5, 3.0, -limit / 1.5));
    }
    assert_ok(tribo_system_create(&sys, model));
    tribo_model_destroy(model);
    assert_ok(tribo_set_planar(tribo_system_context(sys), 1, (const size_t[]){0}));
    if (kind == FOLLOWS) {
        assert_ok(tribo_system_add_load(sys, 0.0, (const double[]){0.0, 0.0, 2.0 * limit}, NULL));
    } else {
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), limit));
    }
    assert_ok(tribo_system_add_load(sys, w, (const double[]){1.0, 0.0, 0.0, 0.0}, (const double[]){0.0, 1.0, 0.0, 0.0}));
    return sys;
}

/* Closed form, kappa = k - w^2: the radius r of the circle and the energy a turn, 2 pi L sqrt(r^2 - L^2/kt^2). */
TEST(circle)
{
    const int which = _i % 2, kind = _i / 2;
    const double kappa[] = {0.64, -0.69}, limit[] = {0.3, 0.4}, kt[] = {2.0, 3.0}, w[] = {0.6, 1.3};
    const double radius[] = {1.442586110948, 1.385252538591}, energy[] = {2.704470991767, 3.465354654383};
    const double period = 2.0 * PI / w[which];
    double y[MOST] = {0.1, 0.2}, z[MOST], re[MOST], im[MOST], t = 0.0, trace = 0.0, sum = 0.0;
    tribo_system *sys = whirl(kind, kappa[which] + w[which] * w[which], kt[which], limit[which], w[which]);
    const size_t all = tribo_system_dimension(sys);
    tribo_driver *d = driver_create(sys, _i ? "event" : "auto", 1.0, 0.0);
    driver_advance(d, &t, 3.0, y);
    const int status = tribo_driver_find_periodic(d, 0.0, period, y);
    require(!status, "%s", tribo_driver_message(d));
    assert_close(hypot(y[0], y[1]), radius[which], 1e-9);
    t = 0.0;
    y[all - 1] = 0.0;
    memcpy(z, y, sizeof z);
    driver_advance(d, &t, period, z);
    assert_close(z[all - 1], energy[which], 1e-9);
    assert_close(hypot(z[0], z[1]), radius[which], 1e-9);
    assert_ok(tribo_driver_get_multipliers(d, re, im));
    for (size_t i = 0; kind != MASSLESS && i + 1 < all; i++) {
        for (double side = -1.0; side <= 1.0; side += 2.0) {
            memcpy(z, y, sizeof z);
            z[i] += side * 1e-6;
            t = 0.0;
            driver_advance(d, &t, period, z);
            trace += side * z[i] / 2e-6;
        }
        sum += re[i];
    }
    assert_close(sum, trace, 1e-7);
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

/* A limit that stays far below all other forces: the force follows the velocity, as without a spring. */
TEST(faint)
{
    double y[2][MOST] = {{0.1, 0.2}, {0.1, 0.2}};
    for (int rigid = 0; rigid < 2; rigid++) {
        tribo_system *sys = whirl(PLAIN, 1.0, rigid ? 1e4 : 1.0, 1e-10, 0.6);
        double t = 0.0;
        tribo_driver *d = driver_create(sys, "event", 0.0, 0.0);
        driver_advance(d, &t, 20.0, y[rigid]);
        assert_close(y[rigid][6], y[0][6], 1e-16);
        assert_close(y[rigid][0], y[0][0], 1e-12);
        require(y[0][6] > 1e-10, "the contact slides, and loses %g", y[0][6]);
        tribo_driver_destroy(d);
        tribo_system_destroy(sys);
    }
}

/* At rest at the limit, the constant load balances the spring: nothing moves, however the force is turned. */
TEST(rest_at_the_limit)
{
    const double kt = 1000.0, limit = 0.0143;
    for (int k = 0; k < 60; k++) {
        const double at[2] = {limit * cos(0.1 * k), limit * sin(0.1 * k)};
        double y[7] = {0.0, 0.0, 0.0, 0.0, at[0] / kt, at[1] / kt}, t = 0.0;
        tribo_system *sys = whirl(PLAIN, 1.0, kt, limit, 1.0);
        assert_ok(tribo_system_clear_loads(sys));
        assert_ok(tribo_system_add_load(sys, 0.0, (const double[]){-at[0], -at[1]}, NULL));
        tribo_driver *d = driver_create(sys, "event", 1.0, 0.0);
        driver_advance(d, &t, 0.5, y);
        require(driver_count(d, TRIBO_COUNT_EVENTS) < 10, "%zu events", driver_count(d, TRIBO_COUNT_EVENTS));
        assert_all_close(y, ((double[]){0.0, 0.0}), 2, 1e-15);
        tribo_driver_destroy(d);
        tribo_system_destroy(sys);
    }
}

/* Springs or limits that differ, or one spring only. */
TEST(refused)
{
    const double one[4] = {1.0, 0.0, 0.0, 1.0}, c[3][2] = {{0.5, 0.4}, {0.5, 0.0}, {0.5, 0.5}};
    const double limit[2] = {0.3, _i == 2 ? 0.4 : 0.3};
    double y[7] = {0.0}, t = 0.0;
    tribo_model *model = dense_model(2, 2, one, NULL, one, one);
    assert_ok(tribo_model_set_compliance(model, c[_i]));
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_set_planar(tribo_system_context(sys), 1, (const size_t[]){0}));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    tribo_driver *d = driver_create(sys, "event", 0.0, 0.0);
    assert_status(tribo_driver_advance(d, &t, 1.0, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(d), "contact 0 has a direction beside it in its plane");
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

TEST_MAIN("pair_event", {circle, 2 * KINDS}, {faint, 1}, {rest_at_the_limit, 1}, {refused, 3})
