/* SPDX-License-Identifier: BSD-3-Clause */
/* Method "exact": the reference values to 12 digits, what it costs, what it refuses; and what "auto" makes of that. */
#include <stdlib.h>
#include <string.h>

#include "make.h"
#include "beam.h"
#include "coulomb.h"
#include "model.h"
#include "../../set_up_driver.h"

TEST(reference_values)
{
    const struct reference *r = &references[_i];
    const double error = reference_error(r, "exact", 1.0, 0.0, NULL);
    require(error <= 1e-11, "%s: error %.3g", r->name, error);
}

/* 373 events in the chain's four cycles, by the code that computed the reference values; it saw the start as one, too, and so do
 * not we. */
TEST(events_of_the_chain)
{
    struct effort effort;
    reference_error(&references[3], "exact", 1.0, 0.0, &effort);
    require(effort.events >= 372 && effort.events <= 374, "%zu events", effort.events);
    ck_assert_uint_ge(effort.steps, effort.events);
}

/* A mass of 1 on a spring of -1 from q = v = 1 on, which friction of 5 stops at q = 5 - sqrt(15), and holds there. Its motion
 * grows: over the time asked for, 2000, it would overflow if nothing stopped it. */
TEST(growth_that_stops)
{
    const double one = 1.0, spring = -1.0, limit = 5.0;
    double t = 0.0, y[3] = {1.0, 1.0, 0.0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 1, 1, &one, NULL, &spring, &one, 0, NULL, 0));
    assert_ok(tribo_set_limit(tribo_system_context(sys), &limit));
    tribo_driver *drv = driver_create(sys, "exact", 1.0, 0.0);
    driver_advance(drv, &t, 2000.0, y);
    assert_close(y[0], 5.0 - sqrt(15.0), 1e-14);
    assert_exact(y[1], 0.0);
    assert_close(y[2], 5.0 * (4.0 - sqrt(15.0)), 1e-14);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------------ against event */

/* Chains for which no values are known. */
TEST(chains)
{
    const size_t blocks[] = {2, 3, 8, 17, 64, 128};
    const size_t n = blocks[_i];
    double y[2][MOST_STATES] = {{0}};
    for (size_t k = 0; k < 2; k++) {
        tribo_system *sys;
        double t = 0.0;
        assert_ok(tribo_system_chain(&sys, n, 1.0, n < 8 ? 1.5 : 0.25, 0.5));
        tribo_driver *drv = driver_relative(sys, k ? "event" : "exact", 1.0, 1e-13, 1e-12);
        driver_advance(drv, &t, 8.0 * PI, y[k]);
        require(driver_count(drv, TRIBO_COUNT_EVENTS) > 2, "nothing happens");
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    assert_all_close(y[1], y[0], 2 * n + 1, 1e-11);
    assert_close(y[1][2 * n] / y[0][2 * n], 1.0, 1e-11);
}

/* Everything to 1e-9 of the largest of its kind: positions, velocities, energy. */
TEST(beam_against_event)
{
    const double limits[] = {1e-3, 0.02, 0.06}, period = 1.0 / 26.69254;
    double y[2][BEAM_STATES] = {{0}};
    size_t events[2];
    for (size_t k = 0; k < 2; k++) {
        double t = 0.0;
        tribo_system *sys = beam_with_damper(limits[_i]);
        tribo_driver *drv = driver_relative(sys, k ? "event" : "exact", period, 1e-14, 1e-12);
        driver_advance(drv, &t, 10.0 * period, y[k]);
        events[k] = driver_count(drv, TRIBO_COUNT_EVENTS);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    require(events[0] > 20 && events[0] == events[1], "%zu and %zu events", events[0], events[1]);
    for (size_t from = 0; from < BEAM_STATES; from += BEAM_MODES) {
        const size_t n = from < 2 * BEAM_MODES ? BEAM_MODES : 1;
        double most = 0.0;
        for (size_t i = from; i < from + n; i++) {
            most = fmax(most, fabs(y[0][i]));
        }
        require(most > 0.0, "nothing moves");
        assert_all_close(y[1] + from, y[0] + from, n, 1e-9 * most);
    }
}

/* --------------------------------------------------------------------------------------------------------------- stick */

/* Stuck far inside their limits from start to end: one phase, no events, and hardly a look at the motion; velocities are zero. */
TEST(stuck_for_good)
{
    double t = 0.0, y[17] = {0};
    tribo_system *sys;
    assert_ok(tribo_system_chain(&sys, 8, 10.0, 0.25, 0.5));
    tribo_driver *drv = driver_create(sys, _i ? "event" : "exact", 1.0, 1e-9);
    driver_advance(drv, &t, 1000.0, y);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_EVENTS), 0);
    for (size_t i = 0; i < 17; i++) {
        assert_exact(y[i], 0.0);
    }
    if (!_i) {
        ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_STEPS), 1);
        ck_assert_uint_le(driver_count(drv, TRIBO_COUNT_EVALUATIONS), 4);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* ---------------------------------------------------------------------------------------------------------- resonances */

/* x'' + x = cos t - sgn x' 1/2 from rest: between turns at k pi, where |x| has grown by pi/2 - 1, the motion is that of an
 * undamped oscillator in exact resonance. Amplitudes are (k pi/2 - k). */
TEST(resonance)
{
    const double one = 1.0, pi = PI;
    tribo_system *sys = block(1.0, 1.0, 0.5);
    assert_ok(tribo_system_add_load(sys, 1.0, NULL, &one));
    double y[3] = {0}, z[3] = {0};
    tribo_driver *exact = driver_create(sys, "exact", 1.0, 0.0), *event = driver_create(sys, "event", 1.0, 1e-13);
    double t = 0.0, s = 0.0;
    for (int k = 1; k <= 8; k++) {
        driver_advance(exact, &t, k * 2.0 * pi, y);
        driver_advance(event, &s, k * 2.0 * pi, z);
        assert_all_close(z, y, 3, 1e-10);
    }
    /* what a cycle adds to the amplitude: pi by the load, 4 N/k/2 less by friction */
    double before = fabs(y[0]);
    driver_advance(exact, &t, 18.0 * pi, y);
    require(before > 5.0, "amplitude %g", before);
    assert_close(fabs(y[0]) - before, pi - 2.0, 0.05);
    tribo_driver_destroy(exact);
    tribo_driver_destroy(event);
    tribo_system_destroy(sys);
}

/* A harmonic that does not act on a mode leaves it alone, also at its very frequency: the first mass turns freely, the load at
 * the second one's frequency moves the first. */
TEST(resonance_elsewhere)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {1.0, 0.0, 0.0, 4.0}, direction[] = {1.0, 0.0}, load[] = {3.0, 0.0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 1, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 2.0, load, NULL));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.3));
    double y[5] = {0.0, 1.0, 0.0, 0.0, 0.0}, want[5] = {0.0, 1.0, 0.0, 0.0, 0.0};
    run(sys, "exact", 1.0, 0.0, 20.0, y);
    run(sys, "event", 1.0, 1e-13, 20.0, want);
    assert_all_close(y, want, 5, 1e-10);
    assert_close(y[1], cos(40.0), 1e-12);
    require(y[4] > 1.0, "nothing slides");
    tribo_system_destroy(sys);
}

/* Masses 0 and 1 damp each other, mass 2 is undamped and loaded at its own frequency: no response in closed form. Exact says so;
 * event takes it. */
TEST(resonance_beside_damping)
{
    const double mass[] = {1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0},
                 stiffness[] = {3.0, -1.0, 0.0, -1.0, 2.0, 0.0, 0.0, 0.0, 4.0};
    const double damping[] = {0.2, -0.1, 0.0, -0.1, 0.1, 0.0, 0.0, 0.0, 0.0}, direction[] = {1.0, 0.0, 0.0},
                 load[] = {0.0, 0.0, 1.0};
    double t = 0.0, y[7] = {0};
    tribo_system *sys;
    tribo_driver *exact;
    assert_ok(dense_system(&sys, 3, 1, mass, damping, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 2.0, load, NULL));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.3));
    y[0] = 1.0;
    int status = set_up_driver(&exact, sys, "exact", 1.0, 0.0, 0.0);
    if (!status) {
        status = tribo_driver_advance(exact, &t, 5.0, y);
        assert_says(tribo_driver_message(exact), "resonance");
        tribo_driver_destroy(exact);
    }
    assert_status(status, TRIBO_ERR_UNSUPPORTED);
    t = 0.0;
    run(sys, "event", 1.0, 1e-12, 5.0, y);
    assert_close(y[2], 0.25 * 5.0 * sin(10.0), 1e-10); /* q'' + 4 q = cos 2t, from rest */
    tribo_system_destroy(sys);
}

/* Two masses that a held contact makes one, on no ground: what is left of their stiffness is rounding, and must not be taken for
 * a spring. A third force slides along. */
TEST(held_together)
{
    const double mass[] = {0.7500071, 0.0, 0.0, 0.517392}, spring = 0.7297691;
    const double stiffness[] = {spring, -spring, -spring, spring}, damping[] = {0.01281, -0.01281, -0.01281, 0.01281};
    const double direction[] = {-1.0, 1.0, 1.0, 0.0}, limit[] = {50.0, 0.05}, load[] = {0.3028, 0.0};
    double y[5] = {0}, want[5] = {0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 2, mass, _i ? damping : NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 0.447, NULL, load));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    run(sys, "exact", 1.0, 0.0, 20.0, y);
    run(sys, "event", 1.0, 1e-13, 20.0, want);
    assert_all_close(y, want, 5, 1e-10);
    assert_close(y[0], y[1], 1e-13);
    assert_exact(y[2], y[3]);
    require(fabs(y[0]) > 0.1, "nothing moves");
    tribo_system_destroy(sys);
}

/* -------------------------------------------------------------------------------------------------------------- energy */

struct work {
    const struct model *m;
    tribo_system *twin;
    double t, sum;
};

/* Power of load, damping and moving bases at (t, y). */
static double power_at(const struct work *w, double t, const double *y)
{
    const struct model *m = w->m;
    double f[CONTACTS], power = -form(m->damping, y + DOFS, y + DOFS);
    assert_ok(tribo_system_contacts(w->twin, t, y, NULL, NULL, f));
    for (size_t i = 0; i < DOFS; i++) {
        power += y[DOFS + i] * (m->load[0][i] * cos(m->load_omega * t) + m->load[1][i] * sin(m->load_omega * t));
    }
    for (size_t i = 0; i < CONTACTS; i++) {
        power += f[i] * (m->motion[0][i] * cos(m->motion_omega * t) + m->motion[1][i] * sin(m->motion_omega * t));
    }
    return power;
}

/* The dissipated energy closes the balance to 1e-12 of what is exchanged: the work between events by Gauss's rule of 8 points, on
 * pieces that end at events. Forces are those of Coulomb's law at the state: contacts at rest have velocity 0 to the last bit
 * only if they are blocks on the ground, so they are. */
TEST(balance_of_energy)
{
    static const double x[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
    static const double weight[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
    struct random g = random_of(_i);
    struct model m = model_create(&g, 0);
    memset(m.direction, 0, sizeof m.direction);
    memset(m.motion, 0, sizeof m.motion);
    for (size_t i = 0; i < CONTACTS; i++) {
        m.direction[i * DOFS + 2 * i] = 1.0;
    }
    tribo_system *sys = model_system(&m, 1, 0, 0.1);
    struct work w = {&m, model_system(&m, 1, 0, 0.1), 0.0, 0.0};
    assert_ok(tribo_set_law(tribo_system_context(w.twin), TRIBO_COULOMB));
    static struct log log;
    memset(&log, 0, sizeof log);
    double t = 0.0, y[DIMENSION] = {1.0}, end = 20.0;
    const double start = 0.5 * form(m.stiffness, y, y);
    tribo_driver *drv = driver_create(sys, _i % 2 ? "event" : "exact", 100.0, 1e-13);
    assert_ok(tribo_driver_set_observer(drv, log_event, &log));
    driver_advance(drv, &t, end, y);
    tribo_driver_destroy(drv);
    const double whole = y[2 * DOFS], kept = 0.5 * (form(m.stiffness, y, y) + form(m.mass, y + DOFS, y + DOFS)) - start;
    require(log.events > 5 && log.events < MOST_SEEN, "%zu events", log.events);
    /* the same again, stopping at the points of the rule */
    drv = driver_create(sys, _i % 2 ? "event" : "exact", 100.0, 1e-13);
    memset(y, 0, sizeof y);
    y[0] = 1.0;
    t = 0.0;
    for (size_t k = 0; k <= log.events; k++) {
        const double to = k < log.events ? log.t[k] : end, from = t, pieces = ceil((to - from) / 0.2);
        for (double piece = 0.0; piece < pieces; piece++) {
            const double half = 0.5 * (to - from) / pieces, middle = from + (2.0 * piece + 1.0) * half;
            for (int p = 0; p < 8; p++) {
                const double at = p < 4 ? middle - half * x[3 - p] : middle + half * x[p - 4];
                if (at > t) {
                    driver_advance(drv, &t, at, y);
                }
                w.sum += half * weight[p < 4 ? 3 - p : p - 4] * power_at(&w, t, y);
            }
        }
        if (to > t) {
            driver_advance(drv, &t, to, y);
        }
    }
    require(whole > 1.0, "dissipation %g", whole);
    assert_close((whole + kept) / whole, w.sum / whole, 1e-11);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    tribo_system_destroy(w.twin);
}

/* ----------------------------------------------------------------------------------------------------------- observers */

struct grid {
    double dt, last, at[200], x[200];
    size_t steps, events, stop_after;
};

static int see(const tribo_moment *moment, void *data)
{
    const double t = moment->t, *y = moment->y;
    const int event = moment->kind != TRIBO_MOMENT_STEP;
    struct grid *g = data;
    require(t >= g->last, "%.17g after %.17g", t, g->last);
    g->last = t;
    if (event) {
        g->events++;
    } else {
        g->at[g->steps] = t;
        g->x[g->steps] = y[0];
        g->steps++;
    }
    return g->stop_after && g->steps == g->stop_after ? 3 : 0;
}

/* dt only says how often the observer looks: each dt, and at the end; it disturbs nothing. */
TEST(observer_sees_the_motion)
{
    double y[3] = {0}, want[3] = {0}, x[3] = {0}, t = 0.0, s = 0.0;
    struct grid grid = {0.25, 0.0, {0}, {0}, 0, 0, 0};
    tribo_system *sys = oscillator(TRIBO_QUINN, 1.5, 0.5);
    tribo_driver *drv = driver_create(sys, "exact", 0.25, 0.0), *other = driver_create(sys, "exact", 7.0, 0.0);
    run(sys, "exact", 1.0, 0.0, 20.0, want);
    assert_ok(tribo_driver_set_observer(drv, see, &grid));
    driver_advance(drv, &t, 20.0, y);
    assert_all_close(y, want, 3, 1e-14);
    ck_assert_uint_eq(grid.steps, 80);
    ck_assert_uint_eq(grid.events, driver_count(drv, TRIBO_COUNT_EVENTS));
    ck_assert_uint_gt(grid.events, 4);
    for (size_t k = 0; k < 80; k++) {
        assert_close(grid.at[k], 0.25 * (double)(k + 1), 1e-13);
        driver_advance(other, &s, grid.at[k], x);
        assert_close(grid.x[k], x[0], 1e-12);
    }
    tribo_driver_destroy(drv);
    tribo_driver_destroy(other);
    tribo_system_destroy(sys);
}

/* Stopped, t and y are those of the last phase that ended; sent on, the run ends where it would have. */
TEST(observer_stops)
{
    double y[3] = {0}, want[3] = {0}, t = 0.0;
    struct grid grid = {0.25, 0.0, {0}, {0}, 0, 0, 50};
    tribo_system *sys = oscillator(TRIBO_QUINN, 1.5, 0.5);
    tribo_driver *drv = driver_create(sys, "exact", 0.25, 0.0);
    run(sys, "exact", 1.0, 0.0, 20.0, want);
    assert_ok(tribo_driver_set_observer(drv, see, &grid));
    assert_status(tribo_driver_advance(drv, &t, 20.0, y), TRIBO_ERR_STOPPED);
    assert_says(tribo_driver_message(drv), "observer answered 3");
    require(t > 0.0 && t <= grid.last, "t = %g, seen %g", t, grid.last);
    grid.last = 0.0;
    driver_advance(drv, &t, 20.0, y);
    assert_all_close(y, want, 3, 1e-13);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* In pieces the answer is the same to rounding, and a load that comes later is taken into account. */
TEST(in_pieces)
{
    const double push = 0.5;
    double y[3] = {0}, want[3] = {0}, t = 0.0;
    tribo_system *sys = oscillator(TRIBO_QUINN, 1.5, 0.5);
    tribo_driver *drv = driver_create(sys, "exact", 1.0, 0.0);
    run(sys, "exact", 1.0, 0.0, 20.0, want);
    for (int k = 1; k <= 40; k++) {
        driver_advance(drv, &t, 0.5 * k, y);
    }
    assert_all_close(y, want, 3, 1e-12);
    assert_ok(tribo_system_add_load(sys, 1.3, &push, NULL));
    memcpy(want, y, sizeof want);
    driver_advance(drv, &t, 30.0, y);
    tribo_driver *event = driver_create(sys, "event", 1.0, 1e-13);
    t = 20.0;
    driver_advance(event, &t, 30.0, want);
    assert_all_close(y, want, 3, 1e-10);
    tribo_driver_destroy(drv);
    tribo_driver_destroy(event);
    tribo_system_destroy(sys);
}

/* -------------------------------------------------------------------------------------------------------- auto, errors */

TEST(automatic)
{
    const double times[] = {0.0, 1.0}, values[] = {0.0, 1.0}, pattern[] = {1.0}, limits[] = {1.0, 2.0};
    tribo_system *small = oscillator(TRIBO_QUINN, 1.5, 0.5), *loaded = oscillator(TRIBO_QUINN, 1.5, 0.5);
    tribo_system *pressed = oscillator(TRIBO_QUINN, 1.5, 0.5), *moved = oscillator(TRIBO_QUINN, 1.5, 0.5), *large;
    tribo_system *falls = oscillator(TRIBO_QUINN, 1.5, 0.5);
    assert_ok(tribo_system_add_load_table(loaded, 2, times, values, pattern));
    assert_ok(tribo_system_set_limit_table(pressed, 2, times, limits));
    assert_ok(tribo_system_add_base_table(moved, 2, times, values, pattern));
    assert_ok(tribo_set_static(tribo_system_context(falls), limits + 1, limits));
    assert_ok(tribo_system_chain(&large, 1000, 1.0, 0.25, 0.5));
    const struct {
        tribo_system *sys;
        const char *asked, *got;
    } cases[] = {{small, "auto", "exact"},          {loaded, "auto", "exact"},
                 {pressed, "auto", "exact"},        {moved, "auto", "exact"},
                 {falls, "auto", "event"},          {large, "auto", "event"},
                 {large, "exact", "exact"},         {small, "event", "event"},
                 {small, "rk4/fixed", "rk4/fixed"}, {small, "moreau/fixed", "moreau/fixed"}};
    for (size_t k = 0; k < COUNT(cases); k++) {
        tribo_driver *drv = driver_create(cases[k].sys, cases[k].asked, 1.0, 1e-9);
        ck_assert_str_eq(tribo_driver_method(drv), cases[k].got);
        tribo_driver_destroy(drv);
    }
    ck_assert_ptr_null(tribo_driver_method(NULL));
    /* limits that no longer fall make it exact again */
    assert_ok(tribo_set_static(tribo_system_context(falls), NULL, NULL));
    tribo_driver *drv = driver_create(falls, "auto", 1.0, 0.0);
    ck_assert_str_eq(tribo_driver_method(drv), "exact");
    tribo_driver_destroy(drv);
    tribo_system_destroy(small);
    tribo_system_destroy(loaded);
    tribo_system_destroy(pressed);
    tribo_system_destroy(moved);
    tribo_system_destroy(falls);
    tribo_system_destroy(large);
}

/* What "auto" runs is what its name says. */
TEST(automatic_runs)
{
    double y[3] = {0}, want[3] = {0};
    tribo_system *sys = oscillator(TRIBO_QUINN, 1.5, 0.5);
    run(sys, "auto", 1.0, 0.0, 20.0, y);
    run(sys, "exact", 1.0, 0.0, 20.0, want);
    assert_all_exact(y, want, 3);
    tribo_system_destroy(sys);
}

static void check_event_takes(tribo_system *sys)
{
    double y[3] = {0.25, 2.0, 0.0};
    run(sys, "event", 1.0, 1e-9, 3.0, y);
    tribo_system_destroy(sys);
}

/* A mode damped just critically, and (with damping that couples modes) resonance without damping have no closed form here; time
 * and state stay. */
TEST(unsupported)
{
    const double one = 1.0, two = 2.0;
    double t = 0.5, y[3] = {0.25, 2.0, 0.0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 1, 1, &one, &two, &one, &one, 0, NULL, 0));
    tribo_driver *drv = driver_create(sys, "exact", 1.0, 0.0);
    assert_status(tribo_driver_advance(drv, &t, 3.0, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(drv), "critically damped");
    assert_says(tribo_driver_message(drv), "method event");
    assert_exact(t, 0.5);
    assert_exact(y[0], 0.25);
    assert_exact(y[1], 2.0);
    tribo_driver_destroy(drv);
    check_event_takes(sys);
}

/* No tolerances are asked for. */
TEST(creation)
{
    tribo_driver *drv;
    tribo_system *sys = block(1.0, 1.0, 1.0);
    assert_ok(tribo_driver_create(&drv, sys, "exact"));
    assert_status(tribo_driver_set_tolerance(drv, 1e-9, 0.0), TRIBO_ERR_UNSUPPORTED);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* A contact holds, lifts off and stops its body again under a limit of up to 1e9 times the load that swings through zero: what
 * friction takes is the little kinetic energy at touch-down, and no difference of large numbers. As "event" has it, whose series
 * are of the power; in an advance, and over a period. */
TEST(limits_through_zero)
{
    const double big = pow(10.0, 2.0 + _i), one = 1.0, damping = 0.07, limit = big, swing = 1.2 * big, period = PI / 0.8;
    const double constant = _i % 2 ? 0.75 * limit : 0.0, rest = limit - constant; /* in a harmonic, and in the context */
    double taken[2], over[2], least = HUGE_VAL;
    for (int k = 0; k < 2; k++) {
        char text[200];
        tribo_system *sys;
        double t = 0.0, y[3] = {0.0}, before = 0.0;
        assert_ok(dense_system(&sys, 1, 1, &one, &damping, &one, &one, 0, text, sizeof text));
        assert_ok(tribo_set_limit(tribo_system_context(sys), &rest));
        assert_ok(tribo_system_add_limit(sys, 0.0, &constant, NULL));
        assert_ok(tribo_system_add_load(sys, 1.6, &one, NULL));
        assert_ok(tribo_system_add_limit(sys, 3.2, &swing, NULL));
        tribo_driver *drv = driver_create(sys, k ? "event" : "exact", period, 1e-13);
        for (int part = 1; part <= 40; part++) {
            driver_advance(drv, &t, period * part / 40.0, y);
            least = fmin(least, y[2] - before);
            before = y[2];
        }
        taken[k] = y[2];
        memset(y, 0, sizeof y);
        assert_ok(tribo_driver_find_periodic(drv, 0.0, period, y));
        assert_ok(tribo_driver_period_dissipation(drv, &over[k]));
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    assert_close(taken[0], taken[1], 1e-12 * sqrt(big) * taken[1] + 1e-17 * big);
    require(least >= 0.0, "friction gave %g", -least);
    assert_close(over[0], over[1], fmax(1e-7 * over[1], 1e-19 * big));
}

/* Bodies of one mass in a ring of one spring: modes in pairs of one frequency, contacts that stop at one time, and phases so
 * short that they are powers of time. */
TEST(ring)
{
    enum { N = 40 };
    double mass[N * N] = {0.0}, stiffness[N * N] = {0.0}, damping[N * N], direction[N * N] = {0.0}, load[N];
    double y[2 * N + 1] = {0.0}, want[2 * N + 1] = {0.0};
    for (size_t i = 0; i < N; i++) {
        mass[i * (N + 1)] = direction[i * (N + 1)] = 1.0;
        stiffness[i * (N + 1)] = 2.5;
        stiffness[i * N + (i + 1) % N] = stiffness[i * N + (i + N - 1) % N] = -1.0;
        load[i] = i % 2 ? 1.0 : _i ? -1.0 : 0.5 * cos((double)i);
    }
    for (size_t k = 0; k < N * N; k++) {
        damping[k] = 0.05 * stiffness[k];
    }
    tribo_system *sys;
    assert_ok(dense_system(&sys, N, N, mass, damping, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 1.3, load, NULL));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.3));
    run(sys, "exact", 1.0, 0.0, 30.0, y);
    run(sys, "event", 1.0, 1e-13, 30.0, want);
    assert_all_close(y, want, 2 * N + 1, 1e-10);
    require(y[2 * N] > 1.0, "nothing slides");
    tribo_system_destroy(sys);
}

TEST_MAIN("exact", {limits_through_zero, 8}, {reference_values, REFERENCES}, {events_of_the_chain, 1}, {growth_that_stops, 1},
          {chains, 6}, {beam_against_event, 3}, {stuck_for_good, 2}, {resonance, 1}, {resonance_elsewhere, 1},
          {resonance_beside_damping, 1}, {held_together, 2}, {balance_of_energy, 8}, {observer_sees_the_motion, 1},
          {observer_stops, 1}, {in_pieces, 1}, {automatic, 1}, {automatic_runs, 1}, {unsupported, 1}, {ring, 2}, {creation, 1})
