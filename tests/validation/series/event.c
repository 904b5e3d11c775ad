/* SPDX-License-Identifier: BSD-3-Clause */
/* Method "event": errors follow the tolerance, nothing is missed, what rests is at rest. Closed forms beside each case. */
#include <string.h>

#include "make.h"
#include "coulomb.h"
#include "../../set_up_driver.h"

/* Every test of a single block is run with both methods that locate events. */
static const char *const methods[] = {"event", "exact"};

/* From rest or from y on to the end. */
static size_t go(tribo_system *sys, const char *method, double tolerance, double end, double *y)
{
    double t = 0.0;
    tribo_driver *drv = driver_create(sys, method, 1.0, tolerance);
    driver_advance(drv, &t, end, y);
    const size_t events = driver_count(drv, TRIBO_COUNT_EVENTS);
    tribo_driver_destroy(drv);
    return events;
}

static void constant_load(tribo_system *sys, double p)
{
    assert_ok(tribo_system_add_load(sys, 0.0, &p, NULL));
}

/* ---------------------------------------------------------------------------------------------------------- tolerances */

TEST(errors_follow_the_tolerance)
{
    const struct reference *r = &references[_i];
    const double tolerance[] = {1e-5, 1e-7, 1e-9, 1e-11};
    for (size_t k = 0; k < COUNT(tolerance); k++) {
        const double error = reference_error(r, "event", 1.0, tolerance[k], NULL);
        require(error <= 10.0 * tolerance[k], "%s: error %.3g at %g", r->name, error, tolerance[k]);
    }
    const double error = reference_error(r, "event", 1.0, 1e-13, NULL);
    require(error <= 1e-11, "%s: error %.3g at 1e-13", r->name, error);
}

/* Four cycles of the chain at 1e-9 for no more than twice what rk4 takes at dt = 0.01, where it is right to 1e-4. */
TEST(work_for_the_chain)
{
    struct effort rk4, event;
    reference_error(&references[3], "rk4/fixed", 0.01, 0.0, &rk4);
    const double error = reference_error(&references[3], "event", 1.0, 1e-10, &event);
    require(error <= 1e-9, "error %.3g", error);
    ck_assert_uint_ge(rk4.evaluations, 20000);
    require(event.evaluations <= 2 * rk4.evaluations, "%zu evaluations, rk4 %zu", event.evaluations, rk4.evaluations);
}

/* -------------------------------------------------------------------------------------- trap 1: events between the steps */

/* However loose the tolerance, as many events as there are, and a dissipation to that order. */
TEST(nothing_is_missed)
{
    const struct reference *r = &references[_i];
    struct effort exact, loose;
    reference_error(r, "exact", 1.0, 0.0, &exact);
    const double error = reference_error(r, "event", 1e3, 1e-3, &loose);
    require(error <= 1e-2, "%s: error %.3g", r->name, error);
    require(loose.events + 2 >= exact.events && loose.events <= exact.events + 2, "%s: %zu events, not %zu", r->name,
            loose.events, exact.events);
}

/* A fast and small vibration that dies out in ten half cycles, (x0 - 2 k N/K), beside a slow and large motion that sets the
 * relative tolerance: nobody would notice it in the large. */
TEST(fast_and_small)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {1e4, 0.0, 0.0, 1.0}, direction[] = {1.0, 0.0};
    double y[5] = {1.03e-3, 1.0, 0.0, 0.0, 0.0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 1, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.5));
    tribo_driver *drv = driver_relative(sys, "event", 10.0, 1e-6, 1e-6);
    double t = 0.0;
    driver_advance(drv, &t, 6.0, y);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_EVENTS), 10);
    assert_close(y[0], 3e-5, 1e-6);
    assert_close(y[4], 0.5e4 * (1.03e-3 * 1.03e-3 - 9e-10), 1e-5);
    assert_exact(y[2], 0.0);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------- trap 2: at rest on a belt */

struct rest {
    tribo_system *sys;
    size_t steps, off;
};

static int see_rest(const tribo_moment *moment, void *data)
{
    const double t = moment->t, *y = moment->y;
    struct rest *rest = data;
    double v[8];
    assert_ok(tribo_system_contacts(rest->sys, t, y, v, NULL, NULL));
    for (size_t i = 0; i < tribo_system_ncontact(rest->sys); i++) {
        rest->off += v[i] != 0.0;
    }
    rest->steps++;
    return 0;
}

/* A block rides on a shaking belt for 300 of its cycles: its relative velocity is 0, not nearly 0, whenever it is seen. Then it
 * is pulled off, slowly, and slides for good: one event. */
TEST(rest_on_a_belt)
{
    const double times[] = {2000.0, 2100.0}, values[] = {0.0, 5.0}, one = 1.0;
    double t = 0.0, y[3] = {0};
    tribo_system *sys = block(1.0, 0.1, 2.0);
    struct rest rest = {block(1.0, 0.1, 2.0), 0, 0};
    tribo_system *const both[] = {sys, rest.sys};
    for (size_t k = 0; k < 2; k++) {
        assert_ok(tribo_system_add_base_motion(both[k], 1.0, NULL, &one));
        assert_ok(tribo_system_add_load_table(both[k], 2, times, values, &one));
    }
    tribo_driver *drv = driver_create(sys, "event", 1.0, 1e-9);
    assert_ok(tribo_driver_set_observer(drv, see_rest, &rest));
    for (int k = 1; k <= 2000; k++) {
        driver_advance(drv, &t, k, y);
    }
    require(rest.steps > 500, "%zu steps", rest.steps);
    ck_assert_uint_eq(rest.off, 0);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_EVENTS), 0);
    assert_exact(y[2], 0.0);
    assert_close(y[0], 1.0 - cos(2000.0), 1e-9 * 500.0);
    assert_ok(tribo_driver_set_observer(drv, NULL, NULL));
    driver_advance(drv, &t, 2100.0, y);
    require(y[2] > 0.1, "it was not pulled off");
    require(driver_count(drv, TRIBO_COUNT_EVENTS) <= 100, "%zu events", driver_count(drv, TRIBO_COUNT_EVENTS));
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    tribo_system_destroy(rest.sys);
}

/* The paper's two blocks: both contacts stick to t = 0.5; then the blocks stay together while the lower one slides. */
TEST(rest_on_each_other)
{
    double t = 0.0, y[5] = {0};
    size_t together = 0;
    tribo_system *sys;
    assert_ok(tribo_system_belt(&sys, 2.0, 0.5, 0.25, 1.0, 0.5));
    tribo_driver *drv = driver_create(sys, methods[_i], 1.0, 1e-12);
    for (int k = 1; k <= 600; k++) {
        driver_advance(drv, &t, 0.1 * k, y);
        /* equal to 1e-9 or not at all, and equal means equal */
        require(y[2] == y[3] || fabs(y[2] - y[3]) > 1e-9, "t = %g: %.17g and %.17g", t, y[2], y[3]);
        together += y[2] == y[3];
    }
    require(together > 100 && together < 600, "together %zu times", together);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* -------------------------------------------------------------------------------------------------- trap 3: left-over modes */

/* Somewhere else in between, with another start and other limits: the first run comes out again, bit by bit, and from a new
 * driver too. */
TEST(nothing_left_over)
{
    static const char *const all[] = {"event", "exact", "central/fixed", "moreau/fixed"};
    double y[3][17], t, limit[8];
    tribo_system *sys;
    assert_ok(tribo_system_chain(&sys, 8, 1.0, 0.4, 1.0));
    assert_ok(tribo_get_limit(tribo_system_context(sys), limit));
    tribo_driver *drv = driver_create(sys, all[_i], 0.01, 1e-9);
    for (size_t k = 0; k < 3; k++) {
        tribo_driver *const now = k < 2 ? drv : driver_create(sys, all[_i], 0.01, 1e-9);
        memset(y[k], 0, sizeof y[k]);
        driver_advance(now, (t = 0.0, &t), 15.0, y[k]);
        if (k == 0) {
            double other[17] = {0.3, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, -1.0};
            assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.025));
            driver_advance(drv, (t = 3.0, &t), 7.77, other);
            assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
            /* it starts at rest, and the run before ended in sliding: times agree, states do not */
            memset(other, 0, sizeof other);
            driver_advance(drv, (t = 7.77, &t), 7.78, other);
        }
        if (now != drv) {
            tribo_driver_destroy(now);
        }
    }
    require(y[0][16] > 0.01, "nothing moved");
    assert_all_exact(y[1], y[0], 17);
    assert_all_exact(y[2], y[0], 17);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* A state that the caller changed between two advances is a new start. */
TEST(state_changed)
{
    double t = 0.0, y[3] = {2.75, 0.0, 0.0}, want[3] = {5.0, 0.0, 0.0};
    tribo_system *sys = oscillator(TRIBO_QUINN, 0.0, 1.0);
    tribo_driver *drv = driver_create(sys, methods[_i], 1.0, 1e-12);
    driver_advance(drv, &t, 25.0, y);
    assert_exact(y[1], 0.0); /* it sticks */
    y[0] = 5.0;
    y[2] = 0.0;
    driver_advance(drv, &t, 50.0, y);
    go(sys, methods[_i], 1e-12, 25.0, want);
    assert_all_close(y, want, 3, 1e-11);
    assert_close(fabs(y[0]), 1.0, 1e-11); /* 5, -3, 1 */
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------------------ single events */

/* Thrown against a load of twice the limit: v = 1 - 3 t, then -(t - 1/3). It turns in one event and does not stick. */
TEST(reversal)
{
    double y[3] = {0.0, 1.0, 0.0};
    tribo_system *sys = block(1.0, 0.0, 1.0);
    constant_load(sys, -2.0);
    ck_assert_uint_eq(go(sys, methods[_i], 1e-12, 2.0, y), 1);
    assert_close(y[0], 1.0 / 6.0 - 25.0 / 18.0, 1e-13);
    assert_close(y[1], -5.0 / 3.0, 1e-13);
    assert_close(y[2], 1.0 / 6.0 + 25.0 / 18.0, 1e-13);
    tribo_system_destroy(sys);
}

/* Stops at t = 1 for good: v = 1 - t. */
TEST(stop)
{
    double y[3] = {0.0, 1.0, 0.0};
    tribo_system *sys = block(1.0, 0.0, 1.0);
    ck_assert_uint_eq(go(sys, methods[_i], 1e-12, 50.0, y), 1);
    assert_close(y[0], 0.5, 1e-14);
    assert_exact(y[1], 0.0);
    assert_close(y[2], 0.5, 1e-14);
    tribo_system_destroy(sys);
}

/* At the limit from the start: on and beyond it slides at once, x' = (1 - cos t)/2, and whenever that touches zero goes on. */
TEST(grazing_velocity)
{
    const double half = 0.5, end = 7.0 * PI;
    double y[3] = {0};
    tribo_system *sys = block(1.0, 0.0, 1.0);
    constant_load(sys, 1.0);
    assert_ok(tribo_system_add_load(sys, 1.0, NULL, &half));
    go(sys, methods[_i], 1e-13, end, y);
    assert_close(y[0], 0.5 * end, 1e-9);
    assert_close(y[1], 1.0, 1e-9);
    assert_close(y[2], 0.5 * end, 1e-9);
    tribo_system_destroy(sys);
}

/* Load cos t, limit 1: the force touches the limit at the start and at every k pi, and the block never moves. The same with the
 * load 1 - (1 - cos t)^2/2, which touches it by its fourth derivative. */
TEST(grazing_force)
{
    const double one = 1.0, quarter[] = {0.25, -0.25};
    double y[3] = {0};
    tribo_system *sys = block(1.0, 0.0, 1.0);
    assert_ok(tribo_system_add_load(sys, 1.0, &one, NULL));
    if (_i >= 2) {
        constant_load(sys, quarter[0]);
        assert_ok(tribo_system_add_load(sys, 2.0, &quarter[1], NULL));
    }
    const size_t events = go(sys, methods[_i % 2], 1e-12, 20.0, y);
    require(events <= 40, "%zu events", events);
    assert_close(y[0], 0.0, 1e-12);
    assert_exact(y[1], 0.0);
    assert_close(y[2], 0.0, 1e-12);
    tribo_system_destroy(sys);
}

/* A load just above the limit, (1 + delta) sin t: breaks away at t1 = asin(1/(1 + delta)), and sticks again before long. What it
 * slides alternates; what it dissipates adds up. */
TEST(break_away_and_stick)
{
    const double deltas[] = {0.1, 1e-2, 1e-4, 1e-6};
    for (size_t k = 0; k < COUNT(deltas); k++) {
        const double a = 1.0 + deltas[k], start = asin(1.0 / a), c = cos(start);
        double y[3] = {0}, lo = start + (PI / 2.0 - start), hi = start + 10.0 * (PI / 2.0 - start);
        /* v = a (cos t1 - cos t) - (t - t1) = 0; with delta this small the slide is short, 3 (pi/2 - t1) */
        for (int i = 0; i < 100; i++) {
            const double middle = 0.5 * (lo + hi);
            *(a * (c - cos(middle)) - (middle - start) > 0.0 ? &lo : &hi) = middle;
        }
        const double time = lo - start, slid = a * (c * time - (sin(lo) - sin(start))) - 0.5 * time * time;
        tribo_system *sys = block(1.0, 0.0, 1.0);
        assert_ok(tribo_system_add_load(sys, 1.0, NULL, &a));
        const size_t events = go(sys, methods[_i], 1e-14, 20.0 * PI, y);
        ck_assert_uint_eq(events, 40);
        assert_close(y[2], 20.0 * slid, 1e-11);
        assert_close(y[0], 0.0, 1e-11);
        assert_exact(y[1], 0.0);
        require(slid > 0.0 && y[2] > 10.0 * slid, "slid %g, in all %g", slid, y[2]);
        tribo_system_destroy(sys);
    }
}

/* -------------------------------------------------------------------------------------------------------- several contacts */

/* Twins with a spring between them that they never stretch: both stop, and start, in the same event, and each is as it would be
 * alone. */
TEST(twins)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {1.7, -0.7, -0.7, 1.7}, direction[] = {1.0, 0.0, 0.0, 1.0};
    const double load[] = {1.5, 1.5};
    double y[5] = {0}, want[3] = {0};
    tribo_system *sys, *one = oscillator(TRIBO_QUINN, 1.5, 0.5);
    assert_ok(dense_system(&sys, 2, 2, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 0.5, NULL, load));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 1.0));
    const size_t events = go(sys, methods[_i], 1e-13, 60.0, y);
    const size_t alone = go(one, methods[_i], 1e-13, 60.0, want);
    require(events >= alone && events <= 2 * alone, "%zu events, alone %zu", events, alone);
    for (size_t k = 0; k < 2; k++) {
        assert_close(y[k], want[0], 1e-11);
        assert_close(y[2 + k], want[1], 1e-11);
    }
    assert_close(y[4], 2.0 * want[2], 1e-10);
    tribo_system_destroy(sys);
    tribo_system_destroy(one);
}

/* The contact of an oscillator in three: once with a part of the limit, once turned around, once with twice the lever and half of
 * what is left. Nobody can tell from the motion. */
TEST(redundant_contacts)
{
    const double one = 1.0, direction[] = {1.0, -1.0, 2.0}, limit[] = {0.2, 0.5, 0.15}, load = _i < 2 ? 1.5 : 2.0;
    const double omega = _i < 2 ? 0.5 : 2.0;
    double y[3] = {0}, want[3] = {0};
    tribo_system *sys, *single = oscillator(TRIBO_QUINN, load, omega);
    assert_ok(dense_system(&sys, 1, 3, &one, NULL, &one, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, omega, NULL, &load));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    go(sys, methods[_i % 2], 1e-13, 60.0, y);
    go(single, methods[_i % 2], 1e-13, 60.0, want);
    assert_all_close(y, want, 3, 1e-10);
    tribo_system_destroy(sys);
    tribo_system_destroy(single);
}

/* A contact that is driven from both sides moves nothing and dissipates limit times the belt's way: b = cos t - 1 touches zero
 * with no slope at the start and every 2 pi. */
TEST(driven_from_both_sides)
{
    const double one = 1.0, direction[] = {0.0, 1.0}, limit[] = {2.0, 1.0}, shake[] = {1.0, 0.0}, shift[] = {-1.0, 0.0};
    double y[3] = {0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 1, 2, &one, NULL, &one, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_base_motion(sys, 1.0, shake, NULL));
    assert_ok(tribo_system_add_base_motion(sys, 0.0, shift, NULL));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    go(sys, methods[_i], 1e-13, 20.0, y);
    assert_close(y[2], 2.0 * (20.0 - sin(20.0)), 1e-8);
    assert_exact(y[0], 0.0);
    tribo_system_destroy(sys);
}

/* One contact (4) rests just at its limit for good, held there by a spring, while contact 0 comes to its own: that event must not
 * be lost beside the first, whose distance from the limit is rounding at every look. */
TEST(beside_one_at_its_limit)
{
    const double mass[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2};
    const double stiffness[] = {4, -1, -1, 0, -1, 4, -2, 0, -1, -2, 4, 0, 0, 0, 0, 1};
    const double direction[] = {-1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 1, 0, 0, -1};
    const double limit[] = {4, 0, 2, 2, 1}, cosine[] = {-1, 2, 0, 0}, sine[] = {2, 2, 0, 0};
    double y[2][9] = {{0, -1, 1, -1, -1, 1, -1, 0, 0}, {0, -1, 1, -1, -1, 1, -1, 0, 0}};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 4, 5, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 1.0, cosine, sine));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    for (size_t k = 0; k < 2; k++) {
        go(sys, methods[k], 1e-12, 20.0, y[k]);
        /* moreau/fixed in steps of 1e-4 leads to 17.38339552 */
        assert_close(y[k][8], 17.3834, 1e-3);
    }
    assert_all_close(y[0], y[1], 9, 1e-9);
    tribo_system_destroy(sys);
}

/* --------------------------------------------------------------------------------------------------------------- tables */

static const double tolerances[] = {1e-3, 1e-6, 1e-12};

/* Load 0, 2, 0 at t = 0, 2, 4 on limit 1: sticks to t = 1; v = (t - 1)^2/2; from 2 on v = 1/2 + (t - 2) - (t - 2)^2/2; from 4 on
 * v = 1/2 - (t - 4), and rests at x = 1/6 + 5/3 + 1/8. The tolerance hardly matters: the motion is a polynomial. */
TEST(load_table)
{
    const double time[] = {0.0, 2.0, 4.0}, value[] = {0.0, 2.0, 0.0}, one = 1.0, rest = 1.0 / 6.0 + 5.0 / 3.0 + 1.0 / 8.0;
    double y[3] = {0}, t = 0.0;
    tribo_system *sys = block(1.0, 0.0, 1.0);
    assert_ok(tribo_system_add_load_table(sys, 3, time, value, &one));
    tribo_driver *drv = driver_create(sys, "event", 100.0, tolerances[_i]);
    driver_advance(drv, &t, 3.0, y);
    assert_close(y[1], 1.0, 1e-12);
    driver_advance(drv, &t, 10.0, y);
    assert_close(y[0], rest, 1e-12);
    assert_exact(y[1], 0.0);
    assert_close(y[2], rest, 1e-12);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_EVENTS), 2);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Limit 2, 0, 0, 3 at t = 0, 2, 3, 6 and a load of 1: slides from t = 1 on with a = t - 1, freely from 2 to 3, and is then
 * pressed: a = 1 - (t - 3), v = 3/2 + s - s^2/2, s = t - 3, until s = 3 and v = 0, just where the limit stops rising. */
TEST(limit_table)
{
    const double time[] = {0.0, 2.0, 3.0, 6.0}, limit[] = {2.0, 0.0, 0.0, 3.0};
    double y[3] = {0}, t = 0.0;
    tribo_system *sys = block(1.0, 0.0, 17.0);
    constant_load(sys, 1.0);
    assert_ok(tribo_system_set_limit_table(sys, 4, time, limit));
    tribo_driver *drv = driver_create(sys, "event", 100.0, tolerances[_i]);
    driver_advance(drv, &t, 2.0, y);
    assert_close(y[1], 0.5, 1e-12);
    assert_close(y[2], 1.0 / 6.0 - 1.0 / 8.0, 1e-12);
    driver_advance(drv, &t, 3.0, y);
    assert_close(y[1], 1.5, 1e-12);
    assert_close(y[2], 1.0 / 6.0 - 1.0 / 8.0, 1e-12);
    driver_advance(drv, &t, 9.0, y);
    /* x = 1/6 + 1 + 9/2 + 9/2 - 9/2, energy 1/24 + integral of s v */
    assert_close(y[0], 1.0 / 6.0 + 1.0 + 4.5, 1e-11);
    assert_close(y[2], 1.0 / 24.0 + 6.75 + 9.0 - 81.0 / 8.0, 1e-11);
    assert_close(y[1], 0.0, 1e-12);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* A kink that pulls a contact at rest off at once, and limits that vanish and come back while it moves. */
TEST(kinks_that_are_events)
{
    const double time[] = {1.0, 1.5, 2.0}, value[] = {1.0, 1.5, 1.0}, one = 1.0;
    double y[3] = {0};
    tribo_system *sys = block(1.0, 0.0, 1.0);
    assert_ok(tribo_system_add_load_table(sys, 3, time, value, &one));
    /* at its limit up to t = 1; then a = s, up to 1/2, and back: v = 1/4 at t = 2, and stays */
    const size_t events = go(sys, "event", tolerances[_i], 4.0, y);
    require(events <= 3, "%zu events", events);
    assert_close(y[1], 0.25, 1e-12);
    assert_close(y[0], 0.125 + 0.5, 1e-12);
    tribo_system_destroy(sys);
}

/* ---------------------------------------------------------------------------------------------------------- observers */

static struct log log_1;

/* Events in order, each at a state in which a contact is at rest or just at its limit. */
TEST(observed_events)
{
    double t = 0.0, y[3] = {0};
    tribo_system *sys = oscillator(TRIBO_QUINN, 1.5, 0.5);
    tribo_driver *drv = driver_create(sys, methods[_i], 0.5, 1e-12);
    memset(&log_1, 0, sizeof log_1);
    log_1.dimension = 3;
    assert_ok(tribo_driver_set_observer(drv, log_event, &log_1));
    driver_advance(drv, &t, 40.0, y);
    ck_assert_uint_eq(log_1.events, driver_count(drv, TRIBO_COUNT_EVENTS));
    require(log_1.events > 6 && log_1.calls > log_1.events, "%zu events, %zu calls", log_1.events, log_1.calls);
    for (size_t k = 0; k < log_1.events; k++) {
        assert_close(log_1.y[k][1], 0.0, 1e-12);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* ----------------------------------------------------------------------------------------------------------- the edge */

/* On a belt with b = sin t the spring's force grows just as the inertia's shrinks: f = x + b' = 1, the limit itself, for ever.
 * The block stays, as Coulomb's law has it. */
TEST(on_the_edge)
{
    const double one = 1.0;
    double t = 0.0, y[3] = {0}, excess = 1.0, backslip = 1.0;
    tribo_system *sys = block(1.0, 1.0, 1.0);
    assert_ok(tribo_system_add_base_motion(sys, 1.0, NULL, &one));
    tribo_driver *drv = driver_create(sys, methods[_i], 1.0, 1e-12);
    driver_advance(drv, &t, 200.0, y);
    assert_close(y[0], 1.0 - cos(t), 1e-11);
    assert_close(y[1], sin(t), 1e-11);
    assert_close(y[2], 0.0, 1e-11);
    assert_ok(tribo_driver_real(drv, TRIBO_REAL_EXCESS, &excess));
    assert_ok(tribo_driver_real(drv, TRIBO_REAL_BACKSLIP, &backslip));
    require(excess <= 1e-12 && backslip <= 1e-12, "%g beyond the limit, %g the wrong way", excess, backslip);
    tribo_driver_destroy(drv);
    for (int k = 0; k < 2; k++) { /* as the text of the status says, fixed steps go on from there */
        double u = t, z[3] = {y[0], y[1], y[2]};
        drv = driver_create(sys, k ? "central/fixed" : "moreau/fixed", 0.01, 0.0);
        driver_advance(drv, &u, 200.0, z);
        assert_close(z[0], 1.0 - cos(u), 1e-4); /* seen: 2e-5 */
        assert_close(z[1], sin(u), 1e-4);
        tribo_driver_destroy(drv);
    }
    tribo_system_destroy(sys);
}

/* ---------------------------------------------------------------------------------------------------------- any units */

/* Two masses on springs with contacts, in other units of mass, length and time. y out: the state at 7, in these. */
static void move_in_units(double mass, double length, double time, double *y)
{
    const double force = mass * length / (time * time), stiff = mass / (time * time), t1 = 7.0 * time;
    const double m[] = {mass, 0.0, 0.0, 2.0 * mass}, k[] = {3.0 * stiff, -stiff, -stiff, 2.0 * stiff};
    const double j[] = {1.0, 0.0, -1.0, 1.0}, limit[] = {0.6 * force, 0.3 * force}, load[] = {2.0 * force, 0.0};
    double t = 0.0;
    tribo_system *sys;
    tribo_driver *drv;
    assert_ok(dense_system(&sys, 2, 2, m, NULL, k, j, 0, NULL, 0));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    assert_ok(tribo_system_add_load(sys, 2.3 / time, load, NULL));
    assert_ok(set_up_driver(&drv, sys, "event", time, 1e-10 * length, 1e-10));
    driver_advance(drv, &t, t1, y);
    for (size_t i = 0; i < 2; i++) {
        y[i] /= length;
        y[2 + i] *= time / length;
    }
    y[4] /= force * length;
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Small, fast machines, earthquakes, and what is neither: powers of times are no numbers for long. */
TEST(units)
{
    const double unit[][3] = {{1e-15, 1e-9, 1e-9}, {1e-15, 1e-9, 1e-10}, {1e3, 1e-14, 1e10}, {1.0, 1.0, 1e40}, {1.0, 1.0, 1e-40}};
    double y[5] = {0}, want[5] = {0};
    move_in_units(1.0, 1.0, 1.0, want);
    move_in_units(unit[_i][0], unit[_i][1], unit[_i][2], y);
    assert_all_close(y, want, 5, 1e-8);
}

/* A body without springs and loads, of which no frequency tells how fast it is: it slides for long, or for an instant. */
TEST(long_slide)
{
    const double one = 1.0, none = 0.0, limit = _i ? 1.0 : 1e-14, t1 = _i ? 1e-60 : 1e16;
    double t = 0.0, y[3] = {0.0, 1.0, 0.0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 1, 1, &one, NULL, &none, &one, 0, NULL, 0));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), limit));
    tribo_driver *drv = driver_create(sys, "event", 1.0, 1e-9);
    driver_advance(drv, &t, t1, y);
    assert_close(y[0] * (_i ? 1e60 : 2e-14), 1.0, 1e-9);
    assert_close(y[1], _i ? 1.0 : 0.0, 1e-15);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Without tolerances the motion is found in any units of length and time: x'' + x = 1.5 sin(t/2) + f, from rest. */
TEST(units_by_default)
{
    const double length[] = {1e-12, 1e-6, 1.0, 1e9}, time[] = {1e-6, 1.0, 1e4}, end = 60.0;
    const double s = length[_i % 4], w = 1.0 / time[_i / 4], load = 1.5 * s * w * w;
    double t = 0.0, u = 0.0, y[3] = {0.0}, want[3] = {0.0};
    tribo_system *sys = block(1.0, w * w, s * w * w), *other = oscillator(TRIBO_COULOMB, 1.5, 0.5);
    tribo_driver *drv, *exact;
    assert_ok(tribo_system_add_load(sys, 0.5 * w, NULL, &load));
    assert_ok(tribo_driver_create(&drv, sys, "event"));
    assert_ok(tribo_driver_create(&exact, other, "exact"));
    driver_advance(drv, &t, end * time[_i / 4], y);
    driver_advance(exact, &u, end, want);
    assert_close(y[0] / s, want[0], 1e-10);
    assert_close(y[1] / (s * w), want[1], 1e-10);
    assert_close(y[2] / (s * s * w * w), want[2], 1e-10);
    tribo_driver_destroy(drv);
    tribo_driver_destroy(exact);
    tribo_system_destroy(sys);
    tribo_system_destroy(other);
}

TEST_MAIN("event", {units_by_default, 12}, {errors_follow_the_tolerance, REFERENCES}, {work_for_the_chain, 1},
          {nothing_is_missed, REFERENCES}, {fast_and_small, 1}, {rest_on_a_belt, 1}, {rest_on_each_other, 2},
          {nothing_left_over, 4}, {state_changed, 2}, {reversal, 2}, {stop, 2}, {grazing_velocity, 2}, {grazing_force, 4},
          {break_away_and_stick, 2}, {twins, 2}, {redundant_contacts, 4}, {driven_from_both_sides, 2},
          {beside_one_at_its_limit, 1}, {load_table, 3}, {limit_table, 3}, {kinks_that_are_events, 3}, {observed_events, 2},
          {on_the_edge, 2}, {units, 5}, {long_slide, 2})
