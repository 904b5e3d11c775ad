/* SPDX-License-Identifier: BSD-3-Clause */
/* Elastic contacts in methods other than "exact": events by series, fixed steps, periodic motions; and what is refused. */
#include "sliders.h"

#include <stdlib.h>
#include <string.h>
#include "../../set_up_driver.h"

static void set_limits(tribo_system *s, double rigid)
{
    const double limit[] = {limits[0], limits[1], limits[2], rigid};
    assert_ok(tribo_set_limit(tribo_system_context(s), limit));
}

/* -------------------------------------------------------------------------------------------------------------- event */

/* A rigid contact, too, or none; sliders that springs couple, or not. */
TEST(event_is_exact)
{
    tribo_system *s = structure(_i / 2);
    set_limits(s, _i % 2 ? rigid_limit : 0.0);
    tribo_driver *exact = driver_create(s, "exact", 1e-3, 0.0), *event = driver_create(s, "event", 1e-3, 1e-13);
    double t = 0.0, u = 0.0, y[2 * DOFS + 1] = {0.0}, z[2 * DOFS + 1] = {0.0};
    for (int k = 1; k <= 50; k++) {
        driver_advance(exact, &t, 0.7 * k, y);
        driver_advance(event, &u, 0.7 * k, z);
        for (size_t i = 0; i < 2 * DOFS + 1; i++) {
            assert_close(z[i], y[i], 1e-10);
        }
    }
    ck_assert_uint_eq(driver_count(event, TRIBO_COUNT_EVENTS), driver_count(exact, TRIBO_COUNT_EVENTS));
    ck_assert_uint_gt(driver_count(event, TRIBO_COUNT_EVENTS), 20);
    tribo_driver_destroy(exact);
    tribo_driver_destroy(event);
    tribo_system_destroy(s);
}

/* x'' + 2 x = load t, x = load (t - sin(wt)/w)/2 while the slider holds; by event, and by exact, which auto takes. */
TEST(table)
{
    const double w = sqrt(2.0), mass[4] = {1.0}, stiffness[4] = {2.0, -1.0, -1.0, 1.0}, direction[2] = {0.0, 1.0};
    const double time[2] = {0.0, 10.0}, value[2] = {0.0, 1.0}, pattern[2] = {1.0};
    tribo_system *s = linear(2, 1, mass, NULL, stiffness, direction);
    assert_ok(tribo_set_limit_all(tribo_system_context(s), 0.25));
    assert_ok(tribo_system_add_load_table(s, 2, time, value, pattern));
    tribo_driver *d = driver_create(s, _i ? "auto" : "event", 1e-3, 1e-13);
    double t = 0.0, y[5] = {0.0};
    driver_advance(d, &t, 4.0, y);
    assert_exact(strcmp(tribo_driver_method(d), _i ? "exact" : "event"), 0);
    assert_close(y[0], 0.05 * (4.0 - sin(4.0 * w) / w), 1e-13);
    assert_exact(y[1], 0.0);
    assert_exact(y[4], 0.0);
    /* then x > 0.25: the slider goes with the mass, and its force is the limit */
    driver_advance(d, &t, 8.0, y);
    assert_close(y[0] - y[1], 0.25, 1e-13);
    assert_close(y[4], 0.25 * y[1], 1e-12);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* ------------------------------------------------------------------------------------------------------------- moreau */

/* Largest difference from exact, of all but velocities without mass, over the time to 12. The base of the rigid contact, if there
 * is one, is fast: it slides all the time. */
static double error_of(double dt, double rigid, double between)
{
    const double fast[] = {0.0, 0.0, 0.0, 9.0};
    tribo_system *s = structure(between);
    set_limits(s, rigid);
    assert_ok(tribo_system_add_base_motion(s, 0.0, fast, NULL));
    tribo_driver *exact = driver_create(s, "exact", 1e-3, 0.0), *moreau = driver_create(s, "moreau/fixed", dt, 0.0);
    double t = 0.0, u = 0.0, y[2 * DOFS + 1] = {0.0}, z[2 * DOFS + 1] = {0.0}, most = 0.0;
    for (int k = 1; k <= 12; k++) {
        driver_advance(exact, &t, k, y);
        driver_advance(moreau, &u, k, z);
        for (size_t i = 0; i < 2 * DOFS + 1; i++) {
            most = fmax(most, i < DOFS + MASSES || i == 2 * DOFS ? fabs(z[i] - y[i]) : 0.0);
        }
    }
    tribo_driver_destroy(exact);
    tribo_driver_destroy(moreau);
    tribo_system_destroy(s);
    return most;
}

TEST(moreau_order)
{
    const double dt[] = {1e-2, 1e-3};
    double error[2];
    for (size_t k = 0; k < 2; k++) {
        error[k] = error_of(dt[k], _i % 2 ? rigid_limit : 0.0, _i / 2);
    }
    const double order = order_of(dt, error, 2);
    require(order > 1.8 && error[1] < 1e-5, "errors %g, %g: order %g", error[0], error[1], order);
}

/* Energy 4 N (X - N/k) a cycle: k = 2, N = 3, X = 4, in steps that a cycle is a multiple of, where turning points are ends of
 * steps. The mass beside it stands for something to move. */
TEST(moreau_loop)
{
    const double pi = acos(-1.0), stiffness[4] = {1.0, 0.0, 0.0, 2.0}, direction[2] = {0.0, 1.0}, way[1] = {4.0}, mass[4] = {1.0};
    const double h = 2.0 * pi / 4096.0, chord = h / 2.0 / tan(h / 2.0); /* the trapezoidal rule's part of the way */
    tribo_system *s = linear(2, 1, mass, NULL, stiffness, direction);
    tribo_driver *d = driver_create(s, "moreau/fixed", h, 0.0);
    double t = 0.0, y[5] = {0.0};
    assert_ok(tribo_set_limit_all(tribo_system_context(s), 3.0));
    assert_ok(tribo_system_add_base_motion(s, 1.0, way, NULL));
    driver_advance(d, &t, 1.5 * pi, y);
    const double before = y[4];
    driver_advance(d, &t, 5.5 * pi, y);
    assert_close(y[4] - before, 2.0 * 12.0 * (4.0 * chord - 1.5), 1e-9);
    assert_close(2.0 * 12.0 * (4.0 * chord - 1.5), 60.0, 1e-4);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* Two bodies that mass and stiffness couple, with a contact of this compliance on the first; and oscillators, each by itself. */
static tribo_system *coupled(size_t n, double soft)
{
    const size_t entries = n + 2;
    const double head[2][4] = {{2.0, 0.5, 0.5, 1.0}, {3.0, -1.0, -1.0, 2.0}}, limit = 0.3, one = 1.0;
    size_t *first = calloc(n + 1 + entries, sizeof *first), *col = first + n + 1, row[] = {0, 1}, zero = 0;
    double *mass = calloc(2 * entries + n, sizeof *mass), *stiffness = mass + entries, *load = stiffness + entries;
    tribo_model *model;
    tribo_system *sys;
    for (size_t i = 0, k = 0; i < n; i++) {
        for (size_t j = i < 2 ? 0 : i; j < (i < 2 ? 2 : i + 1); j++, k++) {
            col[k] = j;
            mass[k] = i < 2 ? head[0][2 * i + j] : 1.0;
            stiffness[k] = i < 2 ? head[1][2 * i + j] : 1.0;
        }
        first[i + 1] = first[i] + (i < 2 ? 2 : 1);
    }
    load[1] = 1.0;
    assert_ok(tribo_model_create(&model, n, 1));
    assert_ok(tribo_model_set_mass_csr(model, first, col, mass));
    assert_ok(tribo_model_set_stiffness_csr(model, first, col, stiffness));
    assert_ok(tribo_model_set_direction_csr(model, row, &zero, &one));
    assert_ok(tribo_model_set_compliance(model, &soft));
    const int status = tribo_system_create(&sys, model);
    require(!status, "%s", tribo_model_message(model));
    tribo_model_destroy(model);
    assert_ok(tribo_set_limit(tribo_system_context(sys), &limit));
    assert_ok(tribo_system_add_load(sys, 0.8, load, NULL));
    free(first);
    free(mass);
    return sys;
}

/* A mass matrix too large for dense factors, beside the two bodies alone. */
TEST(moreau_large)
{
    enum { N = 3001 };
    static double y[2 * N + 2];
    double z[6] = {0.0}, t = 0.0, u = 0.0;
    if (!tribo_dynamics_has(TRIBO_FEATURE_CHOLMOD)) {
        return;
    }
    tribo_system *large = coupled(N, 0.5), *small = coupled(2, 0.5);
    tribo_driver *d = driver_create(large, "moreau/fixed", 0.01, 0.0), *e = driver_create(small, "moreau/fixed", 0.01, 0.0);
    for (int k = 1; k <= 10; k++) {
        driver_advance(d, &t, k, y);
        driver_advance(e, &u, k, z);
        const double all[] = {y[0], y[1], y[N], y[N + 1], y[2 * N], y[2 * N + 1]};
        for (size_t i = 0; i < 6; i++) {
            assert_close(all[i], z[i], 1e-12);
        }
    }
    ck_assert(z[5] > 0.1);
    tribo_driver_destroy(d);
    tribo_driver_destroy(e);
    tribo_system_destroy(large);
    tribo_system_destroy(small);
}

/* Steady state, max x = 3.38660810 as far as the steps show it; and the state there. */
TEST(moreau_steady_state)
{
    const double period = 2.0 * acos(-1.0) / 1.1;
    double most[2] = {0.0, 0.0}, y[2][7] = {{0.0}};
    for (int k = 0; k < 2; k++) {
        tribo_system *s = element(0.5, 1 + (size_t)_i);
        tribo_driver *d = driver_create(s, k ? "exact" : "moreau/fixed", period / 4000.0, 0.0);
        double t = 0.0;
        driver_advance(d, &t, 60.0 * period, y[k]);
        assert_ok(tribo_driver_set_observer(d, see_most, &most[k]));
        driver_advance(d, &t, 61.0 * period, y[k]);
        tribo_driver_destroy(d);
        tribo_system_destroy(s);
    }
    assert_close(most[0], 3.38660810, 1e-5);
    for (size_t i = 0; i < 4 + 2 * (size_t)_i; i++) {
        assert_close(y[0][i], y[1][i], 1e-5);
    }
}

/* A slider that starts beyond its limit goes back to it, and dissipates limit times the way; so does one whose limit falls. */
TEST(beyond_limit)
{
    static const char *const method[] = {"exact", "event", "moreau/fixed"};
    tribo_system *s = element(0.5, 1);
    tribo_driver *d = driver_create(s, method[_i], 1e-9, 1e-12);
    double t = 0.0, y[5] = {0.0, 3.0, -0.1, 0.0, 1.0};
    driver_advance(d, &t, 1e-9, y);
    assert_close(y[1] - y[0], 0.5, 1e-8);
    assert_close(y[4], 1.0 + 0.5 * 2.5, 1e-8);
    assert_ok(tribo_set_limit_all(tribo_system_context(s), 0.25));
    driver_advance(d, &t, 2e-9, y);
    assert_close(y[1] - y[0], 0.25, 1e-8);
    assert_close(y[4], 1.0 + 0.5 * 2.5 + 0.25 * 0.25, 1e-8);
    /* without limit it is a mark on the mass */
    assert_ok(tribo_set_limit_all(tribo_system_context(s), 0.0));
    driver_advance(d, &t, 3e-9, y);
    assert_close(y[1], y[0], 1e-15);
    assert_close(y[3], y[2], 1e-15);
    assert_close(y[4], 1.0 + 0.5 * 2.5 + 0.25 * 0.25, 1e-8);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* An observer that stops, and a driver that goes on, makes no difference; nor does rest: no load, slider just at its limit. */
TEST(rest_at_limit)
{
    static const char *const method[] = {"exact", "event", "moreau/fixed"};
    const double mass[4] = {1.0}, stiffness[4] = {2.0, -1.0, -1.0, 1.0}, direction[2] = {0.0, 1.0}, load[2] = {1.5};
    tribo_system *s = linear(2, 1, mass, NULL, stiffness, direction);
    tribo_driver *d = driver_create(s, method[_i], 0.01, 1e-12);
    double t = 0.0, y[5] = {1.0, 0.5, 0.0, 0.0, 0.0}; /* K x = load - force: 1.0 + 0.5 = 1.5, the slider's force is 0.5 */
    assert_ok(tribo_set_limit_all(tribo_system_context(s), 0.5));
    assert_ok(tribo_system_add_load(s, 0.0, load, NULL));
    for (int k = 1; k <= 5; k++) {
        driver_advance(d, &t, 3.0 * k, y);
        assert_close(y[0], 1.0, 1e-12);
        assert_close(y[1], 0.5, 1e-12);
        assert_close(y[4], 0.0, 1e-12);
    }
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* ---------------------------------------------------------------------------------------------------------- periodic motions */

/* x'' + 0.1 x' + x + f = cos 1.1 t, k = 1, N = 0.5: one element, two in parallel, or two that are the two ends of one spring. */
TEST(periodic_element)
{
    const double period = 2.0 * acos(-1.0) / 1.1, c[14] = {1.0};
    tribo_system *s = element(0.5, 1 + (size_t)_i % 2);
    tribo_driver *d = driver_create(s, _i < 2 ? "exact" : "event", 1e-3, 1e-14);
    const size_t n = (tribo_system_dimension(s) - 1) / 2;
    double y[7] = {0.0}, z[7], least, most, energy[2], share[2], re[14], im[14], t = 0.0;
    assert_ok(tribo_driver_find_periodic(d, 0.0, period, y));
    assert_ok(tribo_driver_period_extremes(d, c, &least, &most, NULL, NULL));
    assert_close(most, 3.38660810, 1e-8);
    assert_close(least, -3.38660810, 1e-8);
    /* each comes back, and has gone all its loop: 4 N (X - N/k) */
    assert_ok(tribo_driver_period_dissipation(d, energy));
    assert_close(energy[0] + (_i % 2 ? energy[1] : 0.0), 4.0 * 0.5 * (most - 0.5), 1e-9);
    assert_ok(tribo_driver_period_stick(d, share));
    ck_assert(share[0] > 0.05 && share[0] < 0.95);
    memcpy(z, y, sizeof z);
    driver_advance(d, &t, period, z);
    for (size_t i = 0; i < 2 * n; i++) {
        assert_close(z[i], y[i], 1e-9);
    }
    assert_ok(tribo_driver_get_multipliers(d, re, im));
    assert_close(hypot(re[2], im[2]), 0.0, 1e-12);
    ck_assert(hypot(re[0], im[0]) < 1.0);
    size_t freedom;
    assert_ok(tribo_driver_get_freedom(d, &freedom));
    ck_assert_uint_eq(freedom, 0);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

static int see_fastest(const tribo_moment *moment, void *most)
{
    *(double *)most = fmax(*(double *)most, moment->y[3]);
    return 0;
}

/* Extremes of the displacement w and the velocity w' of the slider: |w| <= X - N/k, and w' as an observer sees it. */
TEST(periodic_slider)
{
    const double period = 2.0 * acos(-1.0) / 1.1, place[4] = {0.0, 1.0}, speed[4] = {0.0, 0.0, 0.0, 1.0};
    tribo_system *s = element(0.5, 1);
    tribo_driver *d = driver_create(s, _i ? "event" : "exact", 1e-3, 1e-14);
    double y[5] = {0.0}, least, most, fastest, seen = 0.0, t = 0.0;
    assert_ok(tribo_driver_find_periodic(d, 0.0, period, y));
    assert_ok(tribo_driver_period_extremes(d, place, &least, &most, NULL, NULL));
    assert_close(most, 2.88660810, 1e-8);
    assert_close(least, -2.88660810, 1e-8);
    assert_ok(tribo_driver_period_extremes(d, speed, &least, &fastest, NULL, NULL));
    assert_close(least, -fastest, 1e-9);
    assert_ok(tribo_driver_set_output(d, period / 10000.0));
    assert_ok(tribo_driver_set_observer(d, see_fastest, &seen));
    driver_advance(d, &t, period, y);
    require(seen <= fastest + 1e-9 && seen > fastest - 1e-5, "w' is up to %.17g, not %.17g", seen, fastest);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* A slider that never moves is a spring, and may stand anywhere: a family of motions, of which the guess tells. */
TEST(periodic_held)
{
    const double period = 2.0 * acos(-1.0) / 1.1, c[4] = {1.0}, amplitude = 1.0 / hypot(2.0 - 1.21, 0.11);
    tribo_system *s = element(100.0, 1);
    tribo_driver *d = driver_create(s, _i < 2 ? "exact" : "event", 1e-3, 1e-14);
    double y[5] = {0.0, _i % 2 ? 0.25 : 0.0, 0.0, 0.0, 0.0}, least, most, re[4], im[4];
    size_t freedom;
    assert_ok(tribo_driver_find_periodic(d, 0.0, period, y));
    assert_ok(tribo_driver_period_extremes(d, c, &least, &most, NULL, NULL));
    /* it stands where it did, and pulls the mass by half as much */
    assert_close(y[1], _i % 2 ? 0.25 : 0.0, 1e-10);
    assert_close(most - least, 2.0 * amplitude, 1e-9);
    assert_close(most + least, _i % 2 ? 0.25 : 0.0, 1e-9);
    assert_ok(tribo_driver_get_freedom(d, &freedom));
    ck_assert_uint_eq(freedom, 1);
    assert_ok(tribo_driver_get_multipliers(d, re, im));
    assert_close(re[0], 1.0, 1e-9);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* What many periods lead to, with moving bases and a rigid contact or without, is found in some steps, from any guess; of a
 * family it is the nearest one, and stays. */
TEST(periodic_structure)
{
    const double period = 2.0 * acos(-1.0) / 0.3;
    tribo_system *s = structure(_i / 8);
    set_limits(s, _i % 2 ? rigid_limit : 0.0);
    tribo_driver *d = driver_create(s, _i % 8 < 4 ? "exact" : "event", 1e-3, 1e-14),
                 *march = driver_create(s, "exact", 1e-3, 0.0);
    double t = 0.0, y[2 * DOFS + 1] = {0.0}, z[2 * DOFS + 1] = {0.0};
    for (size_t i = 0; _i % 4 > 1 && i < 2 * DOFS; i++) {
        y[i] = i % 2 ? 0.5 : -1.0;
    }
    const int status = tribo_driver_find_periodic(d, 0.0, period, y);
    require(!status, "%s", tribo_driver_message(d));
    require(driver_count(d, TRIBO_COUNT_NEWTON) < 16, "%zu steps", driver_count(d, TRIBO_COUNT_NEWTON));
    /* with the rigid contact slider 1 never moves, and may stand anywhere up to where its force meets the limit: there the search
     * ends, and rounding decides whether it sees a family */
    ck_assert_uint_le(driver_freedom(d), _i % 2 ? 1 : 0);
    if (_i % 4 == 3) {
        memcpy(z, y, sizeof z);
    }
    driver_advance(march, &t, 40.0 * period, z);
    for (size_t i = 0; i < 2 * DOFS; i++) {
        assert_close(z[i], y[i], 1e-7);
    }
    tribo_driver_destroy(d);
    tribo_driver_destroy(march);
    tribo_system_destroy(s);
}

/* The derivative of the period, by modes and by series. */
TEST(multipliers)
{
    const double period = 2.0 * acos(-1.0) / 0.3;
    static const char *const method[] = {"exact", "event"};
    double re[2][2 * DOFS], im[2][2 * DOFS], y[2 * DOFS + 1] = {0.0};
    for (int k = 0; k < 2; k++) {
        tribo_system *s = structure(_i);
        set_limits(s, 0.0);
        tribo_driver *d = driver_create(s, method[k], 1e-3, 1e-14);
        assert_ok(tribo_driver_find_periodic(d, 0.0, period, y));
        assert_ok(tribo_driver_get_multipliers(d, re[k], im[k]));
        tribo_driver_destroy(d);
        tribo_system_destroy(s);
    }
    ck_assert(hypot(re[0][0], im[0][0]) > 0.3);
    for (size_t i = 0; i < 4; i++) {
        assert_close(re[1][i], re[0][i], 1e-8);
        assert_close(im[1][i], im[0][i], 1e-8);
    }
}

/* Contacts whose springs are on masses that other contacts touch, and one whose spring and base are two masses. */
TEST(contacts_of_state)
{
    static const double y[2 * DOFS + 1] = {0.3, -0.2, 0.1, 0.2, 0.0, -0.1, 0.5, 0.4, 0.0, 0.5, 0.0, 0.2};
    double v[SLIDERS + 1], feq[SLIDERS + 1], f[SLIDERS + 1];
    tribo_system *s = structure(0.0), *e = element(0.5, 2);
    set_limits(s, rigid_limit);
    assert_ok(tribo_system_contacts(s, 0.0, y, v, feq, f));
    const double force[] = {3.0 * -0.1, 1.5 * -0.3, 0.8 * 0.1, -rigid_limit}, velocity[] = {0.5, -0.4, 0.2 - base_speed, 0.0};
    for (size_t i = 0; i <= SLIDERS; i++) {
        assert_close(f[i], force[i], 1e-15);
        assert_close(v[i], velocity[i], 1e-15);
    }
    /* springs of 0.5, limits 0.25, places 0.3 and, beyond the limit, -0.9 away from the mass */
    assert_ok(tribo_system_contacts(e, 0.0, (const double[]){0.4, 0.7, -0.5, 1.0, 0.0, 2.0, 0.0}, v, feq, f));
    assert_close(f[0], 0.5 * 0.3, 1e-15);
    assert_exact(f[1], -0.25);
    assert_exact(feq[1], -0.25);
    assert_exact(v[0], 0.0);
    assert_exact(v[1], 2.0);
    signed char slip[2];
    size_t stuck;
    assert_ok(tribo_system_get_slip(e, slip));
    assert_ok(tribo_system_get_count(e, TRIBO_COUNT_STUCK, &stuck));
    require(slip[0] == TRIBO_SLIP_STUCK && slip[1] == TRIBO_SLIP_FORTH && stuck == 1, "slips %d and %d, %zu stuck", slip[0],
            slip[1], stuck);
    tribo_system_destroy(s);
    tribo_system_destroy(e);
}

/* ----------------------------------------------------------------------------------------------------------- refusals */

TEST(static_limits)
{
    static const char *const method[] = {"exact", "event", "moreau/fixed", "auto"};
    const double rigid[] = {1.0, 1.0, 1.0, 1.5}, elastic[] = {1.0, 1.2, 1.0, 1.0};
    tribo_system *s = structure(0.0);
    tribo_context *contacts = tribo_system_context(s);
    double t = 0.0, y[2 * DOFS + 1] = {0.0};
    tribo_driver *d = driver_create(s, method[_i], 0.01, 1e-9), *other = NULL;
    set_limits(s, rigid_limit);
    assert_ok(tribo_set_static(contacts, rigid, NULL));
    driver_advance(d, &t, 1.0, y);
    const double before = y[0];
    assert_ok(tribo_set_static(contacts, elastic, NULL));
    assert_status(tribo_driver_advance(d, &t, 2.0, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(d), "contact 1 is elastic, and takes no static limit: ratio[1] = 1.2");
    assert_exact(t, 1.0);
    assert_exact(y[0], before);
    assert_status(set_up_driver(&other, s, method[_i], 0.01, 1e-9, 0.0), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_system_message(s), "contact 1 is elastic");
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* Bodies 0 and 1, the latter of which only contacts hold, and sliders 2 and 3 on springs of this stiffness on them. */
static tribo_system *sprung(double on_0, double on_1, double k)
{
    const double mass[] = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    const double stiffness[] = {k + on_0, 0, -on_0, 0, 0, on_1, 0, -on_1, -on_0, 0, on_0, 0, 0, -on_1, 0, on_1};
    const double direction[] = {0, 0, 1, 0, 0, 0, 0, 1}, limit[] = {0.3, 0.2};
    tribo_system *sys = linear(4, 2, mass, NULL, stiffness, direction);
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    return sys;
}

/* A spring 10^8 times as stiff as the structure, or as the inertia under its loads, is refused, with its contact's number. */
TEST(springs_that_are_rigid)
{
    const double load[] = {0.5, 0.4, 0.0, 0.0};
    const char *const method = _i % 2 ? "exact" : "event";
    for (double stiff = 1e2; stiff < 1e18; stiff *= 1e3) {
        tribo_system *sys = sprung(_i < 2 ? stiff : 1e2, _i < 2 ? 1e2 : 2.0 * stiff, 1.0);
        tribo_driver *drv = driver_create(sys, method, 0.1, 1e-9);
        double t = 0.0, y[9] = {0};
        assert_ok(tribo_system_add_load(sys, 0.7, load, NULL));
        const int status = tribo_driver_advance(drv, &t, 0.1, y);
        assert_status(status, stiff > 1e8 ? TRIBO_ERR_UNSUPPORTED : TRIBO_OK);
        if (status) {
            assert_says(tribo_driver_message(drv), _i < 2 ? "elastic contact 0" : "elastic contact 1");
            assert_exact(t, 0.0);
        }
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}

/* Nothing is soft beside the springs of masses that are free but for them, unless a load is slow. */
TEST(springs_alone)
{
    const double load[] = {0.5, 0.4, 0.0, 0.0};
    const char *const method = _i % 2 ? "exact" : "event";
    tribo_system *sys = sprung(1e12, 1e12, 0.0);
    tribo_driver *drv = driver_create(sys, method, 1e-6, 1e-9);
    double t = 0.0, y[9] = {0.0, 0.0, 0.0, 0.0, 1e-7};
    assert_ok(tribo_driver_advance(drv, &t, 1e-6, y));
    assert_ok(tribo_system_add_load(sys, 1e3, load, NULL));
    assert_ok(tribo_driver_advance(drv, &t, 2e-6, y));
    assert_ok(tribo_system_clear_loads(sys));
    assert_ok(tribo_system_add_load(sys, 1.0, load, NULL));
    assert_status(tribo_driver_advance(drv, &t, 3e-6, y), TRIBO_ERR_UNSUPPORTED);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST_MAIN("elastic_methods", {event_is_exact, 4}, {table, 2}, {moreau_order, 4}, {moreau_loop, 1}, {moreau_large, 1},
          {moreau_steady_state, 2}, {beyond_limit, 3}, {rest_at_limit, 3}, {periodic_element, 4}, {periodic_slider, 2},
          {periodic_held, 4}, {periodic_structure, 16}, {multipliers, 2}, {contacts_of_state, 1}, {static_limits, 4},
          {springs_that_are_rigid, 4}, {springs_alone, 2})
