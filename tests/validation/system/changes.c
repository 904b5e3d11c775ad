/* SPDX-License-Identifier: BSD-3-Clause */
/* What happens between two advances: loads, tables, limits, settings and states that change, advances of no length and such that
 * fail. A driver must then go on as a new one would. */
#include <string.h>

#include "make.h"
#include "coulomb.h"
#include "model.h"
#include "set_up_driver.h"

#define METHODS 17
#define CHANGE 1.0
#define END 3.0

/* ------------------------------------------------------------------------------------------------------ kinds of change */

static const struct model *model;

static void add_load(tribo_system *sys)
{
    assert_ok(tribo_system_add_load(sys, 0.7, model->load[1], model->load[0]));
}

static void add_motion(tribo_system *sys)
{
    assert_ok(tribo_system_add_base_motion(sys, 0.0, model->motion[1], NULL));
}

static const double time[] = {0.0, 1.5, 4.0}, value[] = {0.0, 1.0, -1.0};
static const double limit_table[] = {0.2, 0.4, 0.6, 1.0, 0.5, 0.3, 0.1, 0.9, 0.8};

static void add_table(tribo_system *sys)
{
    assert_ok(tribo_system_add_load_table(sys, 3, time, value, model->load[0]));
}

static void begin_table(tribo_system *sys)
{
    assert_ok(tribo_system_set_limit_table(sys, 3, time, limit_table));
}

static void end_table(tribo_system *sys)
{
    assert_ok(tribo_system_clear_limits(sys));
}

static void add_limit(tribo_system *sys)
{
    assert_ok(tribo_system_add_limit(sys, 0.8, limit_table + 3, limit_table));
}

static void set_limit(tribo_system *sys)
{
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit_table + 3));
}

static void set_law(tribo_system *sys)
{
    assert_ok(tribo_set_law(tribo_system_context(sys), TRIBO_SMOOTH));
}

static void set_coupling(tribo_system *sys)
{
    assert_ok(tribo_set_coupling(tribo_system_context(sys), TRIBO_PARTITION));
}

static void set_epsilon(tribo_system *sys)
{
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 0.2));
}

static void begin_static(tribo_system *sys)
{
    const double ratio[] = {1.2, 1.1, 1.3};
    assert_ok(tribo_set_static(tribo_system_context(sys), ratio, NULL));
}

static void begin_falling(tribo_system *sys)
{
    const double ratio[] = {1.5, 1.2, 2.0}, velocity[] = {0.2, 0.5, 1.0};
    assert_ok(tribo_set_static(tribo_system_context(sys), ratio, velocity));
}

static void end_static(tribo_system *sys)
{
    assert_ok(tribo_set_static(tribo_system_context(sys), NULL, NULL));
}

static void set_damping(tribo_system *sys)
{
    assert_ok(tribo_system_set_damping_ratio(sys, 0.3));
}

static void nothing(tribo_system *sys)
{
    (void)sys;
}

static const struct {
    const char *name;
    void (*before)(tribo_system *sys), (*change)(tribo_system *sys);
} changes[] = {{"load", nothing, add_load},
               {"motion", nothing, add_motion},
               {"load table", nothing, add_table},
               {"limit table", nothing, begin_table},
               {"its end", begin_table, end_table},
               {"limits", nothing, set_limit},
               {"law", nothing, set_law},
               {"coupling", nothing, set_coupling},
               {"epsilon", nothing, set_epsilon},
               {"damping", nothing, set_damping},
               {"load table twice", add_table, add_table},
               {"static limits", nothing, begin_static},
               {"falling limits", begin_static, begin_falling},
               {"no more static limits", begin_falling, end_static},
               {"swinging limits", nothing, add_limit},
               {"swinging limits, and limits", add_limit, set_limit},
               {"swinging limits, and static ones", add_limit, begin_static}};

static int chooses_steps(const char *method)
{
    return !strchr(method, '/') && strcmp(method, "exact") && strcmp(method, "event") && strcmp(method, "auto");
}

/* Exact takes no limits that fall with the speed. Limits that drop make the force jump, by which two runs of a
 * method that chooses its steps are farther apart than its tolerance. */
static int possible(const char *method, size_t change)
{
    const int falls = changes[change].change == begin_falling || changes[change].before == begin_falling;
    if (changes[change].change == begin_static) {
        return !chooses_steps(method);
    }
    return strcmp(method, "exact") || !falls;
}

/* First order: at 1e-8 each run takes 10^5 steps. */
static int slow(const char *method)
{
    return strcmp(method, "rk1imp") == 0;
}

/* Where rkf45 rejects a step depends on the last bits: at 1e-8 two runs are now and then 1e-6 apart. */
static tribo_driver *start(const char *method, tribo_system *sys)
{
    tribo_driver *drv = driver_create(sys, method, 0.02, strcmp(method, "rkf45") ? 1e-8 : 1e-9);
    ck_assert_int_eq(any_method_count(), METHODS);
    return drv;
}

/* A driver that has been there before the change, and a new one on a new system that has been like that from the beginning. */
TEST(like_a_new_driver)
{
    const char *method = any_method_name(_i);
    for (size_t k = 0; k < COUNT(changes); k++) {
        struct random g = random_of(1 + (int)k);
        const struct model m = model_create(&g, 1);
        double t[2] = {0.0}, y[2][DIMENSION] = {{0.5, 0.0, -0.5}};
        model = &m;
        if (!possible(method, k) || (!more() && slow(method) && k % 5)) {
            continue;
        }
        tribo_system *sys[] = {model_system(&m, 0, 4, 0.05), model_system(&m, 0, 4, 0.05)};
        const size_t dimension = tribo_system_dimension(sys[0]);
        changes[k].before(sys[0]);
        tribo_driver *drv = start(method, sys[0]);
        driver_advance(drv, &t[0], 0.5 * CHANGE, y[0]);
        driver_advance(drv, &t[0], CHANGE, y[0]);
        changes[k].change(sys[0]);
        memcpy(y[1], y[0], sizeof y[0]);
        driver_advance(drv, &t[0], END, y[0]);
        if (strcmp(changes[k].name, "its end")) {
            changes[k].before(sys[1]);
            changes[k].change(sys[1]);
        }
        tribo_driver *other = start(method, sys[1]);
        t[1] = CHANGE;
        driver_advance(other, &t[1], END, y[1]);
        /* what the context remembers decides about last bits, and these now and then about an adaptive step: as far apart
         * as two runs at this tolerance may be */
        const double tolerance = chooses_steps(method) ? 1e-6 : 1e-11;
        const char *off = differences(changes[k].name, y[0], y[1], dimension, tolerance);
        require(!off, "%s: %s", method, off);
        tribo_driver_destroy(drv);
        tribo_driver_destroy(other);
        tribo_system_destroy(sys[0]);
        tribo_system_destroy(sys[1]);
    }
}

/* Second order, as without the change: a load that is there from t = 1 on, and limits that are others. */
TEST(order_after_a_change)
{
    const char *const methods[] = {"central/fixed", "moreau/fixed", "event"};
    const double dt[] = {0.05, 0.025, 0.0125, 0.00625}, one = 1.0;
    double error[4], x[5];
    for (size_t k = 0; k < 5; k++) {
        double t = 0.0, y[3] = {0};
        tribo_system *sys = oscillator(TRIBO_QUINN, 1.5, 0.5);
        tribo_driver *drv = driver_create(sys, methods[k < 4 ? _i % 2 : 2], k < 4 ? dt[k] : 1.0, k < 4 ? 0.0 : 1e-12);
        driver_advance(drv, &t, 3.0, y);
        if (_i < 2) {
            assert_ok(tribo_system_add_load(sys, 0.0, &one, NULL));
        } else {
            assert_ok(tribo_set_limit_all(tribo_system_context(sys), 1.3));
        }
        driver_advance(drv, &t, 7.0, y);
        x[k] = y[0];
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    for (size_t k = 0; k < 4; k++) {
        error[k] = fabs(x[k] - x[4]);
    }
    require(order_of(dt, error, 4) > 1.7, "order %.2f, errors %g to %g", order_of(dt, error, 4), error[0], error[3]);
}

/* A block that friction holds on ground that starts to move: it slides, and does not go along. x = 1 - cos(t - 1)/2. */
TEST(ground_that_starts)
{
    const char *method = any_method_name(_i);
    const double speed = 0.7;
    double t = 0.0, y[3] = {0.5, 0.0, 0.0};
    tribo_system *sys = block(1.0, 1.0, 1.0);
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 1e-3));
    tribo_driver *drv = driver_create(sys, method, 5e-4, 1e-8);
    driver_advance(drv, &t, 1.0, y);
    assert_close(y[0], 0.5, 1e-9);
    assert_ok(tribo_system_add_base_motion(sys, 0.0, &speed, NULL));
    driver_advance(drv, &t, 1.5, y);
    const double tolerance = strcmp(method, "rk1imp") ? 1e-6 : 1e-4;
    assert_close(y[0], 1.0 - 0.5 * cos(0.5), tolerance);
    assert_close(y[1], 0.5 * sin(0.5), tolerance);
    assert_close(y[2], 0.5 * speed - (0.5 - 0.5 * cos(0.5)), tolerance);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------- how a run may begin */

static int stop_at_once(const tribo_moment *moment, void *data)
{
    (void)moment;
    (void)data;
    return 1;
}

/* Before the run: nothing, advances of no length, advances that are refused, and one that failed; or a stop on the way. */
static void begin(tribo_driver *drv, int how, double *t, double *y)
{
    double before = *t, bad[DIMENSION];
    switch (how) {
    case 1:
        assert_ok(tribo_driver_advance(drv, t, *t, y));
        assert_ok(tribo_driver_advance(drv, t, *t, y));
        break;
    case 2:
        assert_status(tribo_driver_advance(drv, t, *t - 1.0, y), TRIBO_ERR_RANGE);
        assert_status(tribo_driver_advance(drv, t, NAN, y), TRIBO_ERR_NOT_FINITE);
        memcpy(bad, y, sizeof bad);
        bad[0] = NAN;
        assert_status(tribo_driver_advance(drv, t, *t + 1.0, bad), TRIBO_ERR_NOT_FINITE);
        break;
    case 3: /* numbers that overflow; events between them are not for here */
        memcpy(bad, y, sizeof bad);
        bad[0] = bad[1] = 1.7e308;
        if (tribo_driver_method(drv)[0] != 'e') {
            ck_assert_int_ne(tribo_driver_advance(drv, &before, *t + 1.0, bad), TRIBO_OK);
        }
        break;
    case 4:
        assert_ok(tribo_driver_set_observer(drv, stop_at_once, NULL));
        memcpy(bad, y, sizeof bad);
        assert_status(tribo_driver_advance(drv, &before, *t + 1.0, bad), TRIBO_ERR_STOPPED);
        assert_ok(tribo_driver_set_observer(drv, NULL, NULL));
        break;
    default:
        break;
    }
}

/* From x = 1, v = 2: x(1) as if nothing had been before. */
TEST(beginnings)
{
    const char *method = any_method_name(_i);
    double want = 0.0;
    for (int how = 0; how < 5; how++) {
        double t = 0.0, y[DIMENSION] = {1.0, 2.0, 0.0};
        tribo_system *sys;
        assert_ok(tribo_system_oscillator(&sys, 0.1, 0.5, 0.7));
        assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 1e-2));
        tribo_driver *drv = driver_relative(sys, method, 1e-3, 1e-8, 1e-8);
        begin(drv, how, &t, y);
        driver_advance(drv, &t, 1.0, y);
        want = how ? want : y[0];
        require(fabs(y[0] - want) <= 1e-13, "%s, beginning %d: x = %.17g, not %.17g", method, how, y[0], want);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    assert_close(want, 2.2314, strcmp(method, "rk1imp") ? 1e-4 : 1e-3);
}

/* Advances that are as short as time resolves. */
TEST(shortest_advances)
{
    const char *method = any_method_name(_i);
    double t = 3.0, y[DIMENSION] = {1.0, 2.0, 0.0};
    tribo_system *sys = oscillator(TRIBO_QUINN, 0.5, 0.7);
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 1e-2));
    tribo_driver *drv = driver_create(sys, method, 1e-3, 1e-8);
    for (int k = 0; k < 20; k++) {
        driver_advance(drv, &t, nextafter(t, 4.0), y);
        assert_close(y[0], 1.0, 1e-12);
        assert_close(y[1], 2.0, 1e-12);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Bodies that stand on each other come to rest, by contacts that are listed in any order, or, as in the last case, hold two
 * degrees of freedom by sums of both. What moves then is nothing to a driver that knows no more than the state: by static limits,
 * which are twice as much, they hold a load of 1.4 limits. */
TEST(rest_is_seen_anew)
{
    static const char *const methods[] = {"exact", "event"};
    const double direction[4][6] = {{1.0, 0.0, -1.0, 1.0, 0.0, 0.0},
                                    {0.0, 1.0, 1.0, -1.0, 0.0, 0.0},
                                    {-1.0, 1.0, 0.0, 1.0, 0.0, 0.0},
                                    {0.6, 0.3, 0.2, 0.7, 0.0, 0.0}};
    const double mass[] = {1.0, 0.0, 0.0, 1.3}, stiffness[] = {0.2, 0.0, 0.0, 0.3}, limit[] = {1.0, 1.0}, ratio[] = {2.0, 2.0};
    const double push[] = {0.3, 0.2}, hold[4][2] = {{1.4, 0.1}, {0.1, 1.4}, {0.1, 1.4}, {0.9, 0.4}};
    for (size_t k = 0; k < 4; k++) {
        double t = 0.0, y[5] = {0.1, -0.1, 0.0, 0.0, 0.0}, rest[5];
        tribo_system *sys;
        assert_ok(dense_system(&sys, 2, 2, mass, NULL, stiffness, direction[k], 0, NULL, 0));
        assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
        assert_ok(tribo_set_static(tribo_system_context(sys), ratio, NULL));
        assert_ok(tribo_system_add_load(sys, 1.7, push, push));
        y[2] = 1.0 + 0.1 * _i;
        y[3] = -0.3;
        run(sys, methods[_i % 2], 0.5, 1e-11, 10.0, y);
        assert_all_close(y + 2, ((const double[2]){0.0}), 2, 1e-12);
        assert_all_close(y + 2, ((const double[2]){0.0}), 2, k < 3 ? 0.0 : 1e-12);
        memcpy(rest, y, sizeof y);
        assert_ok(tribo_system_clear_loads(sys));
        assert_ok(tribo_system_add_load(sys, 0.0, hold[k], NULL));
        tribo_driver *drv = driver_create(sys, methods[_i % 2], 0.5, 1e-11);
        driver_advance(drv, &t, 1.0, y);
        assert_all_close(y, rest, 5, 1e-12);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}

/* --------------------------------------------------------------------------------------------------- limits and tables */

/* Limits that a table had replaced come back, also if there were two tables; those that are set meanwhile count from then on. */
TEST(limits_after_a_table)
{
    struct random g = random_of(1);
    const struct model m = model_create(&g, 1);
    const double before[CONTACTS] = {0.3, 0.1, 0.7};
    double limit[CONTACTS], y[DIMENSION] = {1.0}, t = 0.0;
    tribo_system *sys = model_system(&m, 1, 0, 0.1);
    assert_ok(tribo_set_limit(tribo_system_context(sys), before));
    tribo_driver *drv = driver_create(sys, "rk4/fixed", 0.02, 0.0);
    begin_table(sys);
    driver_advance(drv, &t, 2.0, y);
    assert_ok(tribo_get_limit(tribo_system_context(sys), limit));
    assert_all_exact(limit, before, CONTACTS);
    assert_ok(tribo_system_get_limit(sys, t, limit));
    ck_assert_double_ne(limit[0], before[0]);
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 9.0));
    begin_table(sys);
    driver_advance(drv, &t, 2.5, y);
    for (int k = 0; k < 2; k++) {
        const double nine[CONTACTS] = {9.0, 9.0, 9.0};
        assert_ok(tribo_system_clear_limits(sys));
        assert_ok(tribo_get_limit(tribo_system_context(sys), limit));
        assert_all_exact(limit, nine, CONTACTS);
        assert_ok(tribo_system_get_limit(sys, t, limit));
        assert_all_exact(limit, nine, CONTACTS);
    }
    begin_table(sys);
    assert_ok(tribo_set_limit(tribo_system_context(sys), before));
    assert_ok(tribo_system_clear_limits(sys));
    assert_ok(tribo_system_get_limit(sys, t, limit));
    assert_all_exact(limit, before, CONTACTS);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* While there is a table, limits that are set in the context have no effect, at the same time neither. */
TEST(limits_beside_a_table)
{
    struct random g = random_of(2);
    const struct model m = model_create(&g, 1);
    double y[DIMENSION] = {1.0, 0.3}, f[2][CONTACTS];
    tribo_system *sys = model_system(&m, 1, 0, 0.1);
    begin_table(sys);
    for (size_t k = 0; k < 2; k++) {
        assert_ok(tribo_system_contacts(sys, 0.5, y, NULL, NULL, f[k]));
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), 1e-6));
    }
    assert_all_exact(f[1], f[0], CONTACTS);
    ck_assert_double_gt(fabs(f[0][0]) + fabs(f[0][1]) + fabs(f[0][2]), 1e-3);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------------------- "auto" */

/* Exact where it can, event where it cannot; the name says which. */
TEST(choices)
{
    const double more = 1.0 + 1e-10, one = 1.0, two = 2.0, stiff[] = {1.0, 0.0, 0.0, 0.0}, mass[] = {1.0, 0.0, 0.0, 1.0},
                 damping[] = {0.1, 0.05, 0.05, 0.1}, direction[] = {1.0, 0.0}, load[] = {0.0, 0.1};
    tribo_system *critical, *coupled, *changing = block(1.0, 1.0, 1.0);
    assert_ok(dense_system(&critical, 1, 1, &one, &two, &one, &one, 0, NULL, 0));
    assert_ok(dense_system(&coupled, 2, 1, mass, damping, stiff, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(coupled, 0.0, load, NULL));
    tribo_system *const sys[] = {critical, coupled};
    for (size_t k = 0; k < 2; k++) {
        double t = 0.0, y[2][5] = {{0.25, 1.0}, {0.25, 1.0}};
        assert_ok(tribo_set_limit_all(tribo_system_context(sys[k]), 0.1));
        tribo_driver *drv = driver_create(sys[k], "auto", 0.5, 1e-10);
        driver_advance(drv, &t, 1.0, y[0]);
        driver_advance(drv, &t, 3.0, y[0]);
        run(sys[k], "event", 0.5, 1e-10, 3.0, y[1]);
        assert_all_close(y[0], y[1], tribo_system_dimension(sys[k]), 1e-8);
        ck_assert_str_eq(tribo_driver_message(drv), "");
        ck_assert_uint_gt(driver_count(drv, TRIBO_COUNT_STEPS), 1);
        ck_assert_uint_gt(driver_count(drv, TRIBO_COUNT_EVALUATIONS), 1);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys[k]);
    }
    double t = 0.0, y[3] = {2.0, 0.0, 0.0};
    tribo_driver *drv = driver_create(changing, "auto", 0.5, 1e-10);
    ck_assert_str_eq(tribo_driver_method(drv), "exact");
    driver_advance(drv, &t, 1.0, y);
    ck_assert_str_eq(tribo_driver_method(drv), "exact");
    assert_ok(tribo_set_static(tribo_system_context(changing), &more, &one));
    driver_advance(drv, &t, 2.0, y);
    ck_assert_str_eq(tribo_driver_method(drv), "event");
    assert_ok(tribo_set_static(tribo_system_context(changing), NULL, NULL));
    driver_advance(drv, &t, 4.0, y);
    ck_assert_str_eq(tribo_driver_method(drv), "exact");
    assert_close(y[0], 0.0, 1e-8); /* x = 1 + cos t, then rests at 0 */
    assert_close(y[2], 2.0, 1e-8);
    tribo_driver_destroy(drv);
    tribo_system_destroy(changing);
}

/* Without a tolerance auto takes event, too, where exact cannot do the system. */
TEST(choice_by_default)
{
    const double one = 1.0, two = 2.0;
    double t = 0.0, y[2][3] = {{0.25, 2.0, 0.0}, {0.25, 2.0, 0.0}};
    tribo_system *sys;
    tribo_driver *drv;
    assert_ok(dense_system(&sys, 1, 1, &one, &two, &one, &one, 0, NULL, 0));
    assert_ok(tribo_driver_create(&drv, sys, "auto"));
    driver_advance(drv, &t, 1.0, y[0]);
    ck_assert_str_eq(tribo_driver_method(drv), "event");
    run(sys, "event", 1.0, 1e-14, 1.0, y[1]);
    assert_all_close(y[0], y[1], 3, 1e-11);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST_MAIN("changes", {like_a_new_driver, METHODS}, {order_after_a_change, 4}, {ground_that_starts, METHODS},
          {beginnings, METHODS}, {shortest_advances, METHODS}, {rest_is_seen_anew, 10}, {limits_after_a_table, 1},
          {limits_beside_a_table, 1}, {choices, 1}, {choice_by_default, 1})
