/* SPDX-License-Identifier: BSD-3-Clause */
/* Drivers: fixed steps, counts, observers, and every way to fail. */
#include <fenv.h>
#include <stdint.h>
#include <string.h>

#include "make.h"
#include "run.h"
#include "../set_up_driver.h"

/* A chain on its way, in steps that are exact in binary. */
#define STEP (1.0 / 64.0)
#define BLOCKS 8
#define DIMENSION (2 * BLOCKS + 1)
#define METHODS 15

static tribo_system *chain(int law)
{
    tribo_system *sys;
    assert_ok(tribo_system_chain(&sys, BLOCKS, 1.0, 0.4, 1.0));
    assert_ok(tribo_set_law(tribo_system_context(sys), law));
    assert_ok(tribo_set_epsilon_step(tribo_system_context(sys), STEP, 0.4));
    return sys;
}

TEST(four_evaluations_a_step)
{
    double t = 0.0, y[DIMENSION] = {0};
    tribo_system *sys = chain(_i);
    tribo_driver *drv = driver_create(sys, "rk4/fixed", STEP, 0.0);
    for (size_t k = 1; k <= 3; k++) {
        driver_advance(drv, &t, (double)k * 100.0 * STEP, y);
        ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_STEPS), 100 * k);
        ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_EVALUATIONS), 400 * k);
    }
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_REJECTED), 0);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_JACOBIANS), 0);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_EVENTS), 0);
    driver_advance(drv, &t, t, y); /* nowhere to go */
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_STEPS), 300);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* The last step is shorter where the end asks for it; a remainder that is rounding is none. */
TEST(last_steps)
{
    const struct {
        double dt, end;
        size_t steps;
    } cases[] = {{0.1, 1.05, 11}, {0.1, 1.0, 10}, {0.1, 0.3, 3}, {0.7, 2.1, 3}, {5.0, 1.0, 1}, {0.01, 0.09999999999, 10}};
    for (size_t i = 0; i < COUNT(cases); i++) {
        double t = 0.0, y[DIMENSION] = {0};
        tribo_system *sys = chain(TRIBO_SMOOTH);
        tribo_driver *drv = driver_create(sys, "rk4/fixed", cases[i].dt, 0.0);
        driver_advance(drv, &t, cases[i].end, y);
        ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_STEPS), cases[i].steps);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}

/* rk4 written out, on the right-hand side that anybody's driver sees. */
TEST(classical_runge_kutta)
{
    double want[DIMENSION] = {0}, y[DIMENSION] = {0};
    tribo_system *sys = chain(TRIBO_QUINN);
    const gsl_odeiv2_system *ode = tribo_gsl_system(sys);
    ck_assert_uint_eq(ode->dimension, DIMENSION);
    run(sys, "rk4/fixed", STEP, 0.0, 256.0 * STEP, y);
    for (int k = 0; k < 256; k++) {
        double slope[4][DIMENSION], stage[DIMENSION];
        for (int s = 0; s < 4; s++) {
            const double part = s == 0 ? 0.0 : s == 3 ? STEP : 0.5 * STEP;
            for (size_t i = 0; i < DIMENSION; i++) {
                stage[i] = want[i] + (s ? part * slope[s - 1][i] : 0.0);
            }
            ck_assert_int_eq(ode->function(k * STEP + part, stage, slope[s], ode->params), GSL_SUCCESS);
        }
        for (size_t i = 0; i < DIMENSION; i++) {
            want[i] += STEP / 6.0 * (slope[0][i] + 2.0 * slope[1][i] + 2.0 * slope[2][i] + slope[3][i]);
        }
    }
    assert_all_close(y, want, DIMENSION, 1e-14);
    tribo_system_destroy(sys);
}

TEST(pieces)
{
    double at_once[DIMENSION] = {0}, y[DIMENSION] = {0}, t = 0.0;
    tribo_system *sys[] = {chain(_i), chain(_i)};
    run(sys[0], "rk4/fixed", STEP, 0.0, 480.0 * STEP, at_once);
    tribo_driver *drv = driver_create(sys[1], "rk4/fixed", STEP, 0.0);
    for (int k = 1; k <= 15; k++) {
        driver_advance(drv, &t, 32.0 * k * STEP, y);
    }
    assert_all_exact(y, at_once, DIMENSION);
    require(y[2 * BLOCKS] > 0.01, "nothing moved");
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys[0]);
    tribo_system_destroy(sys[1]);
}

/* --------------------------------------------------------------------------------------------------------- observers */

struct seen {
    size_t steps, stop_at;
    double t, y[DIMENSION];
};

static int see(const tribo_moment *moment, void *data)
{
    const double t = moment->t, *y = moment->y;
    struct seen *seen = data;
    require(moment->kind == TRIBO_MOMENT_STEP && t > seen->t, "kind %d at %g after %g", moment->kind, t, seen->t);
    ck_assert(moment->contact == SIZE_MAX && moment->size == sizeof *moment);
    seen->steps++;
    seen->t = t;
    memcpy(seen->y, y, sizeof seen->y);
    return seen->steps == seen->stop_at ? 7 : 0;
}

/* Stopped, then sent on: nothing is lost. */
TEST(observer_stops)
{
    const char *const methods[] = {"rk4/fixed", "rkf45", "msbdf"};
    double t = 0.0, y[DIMENSION] = {0}, at_once[DIMENSION] = {0};
    struct seen seen = {0, 20, 0.0, {0}};
    tribo_system *sys[] = {chain(TRIBO_QUINN), chain(TRIBO_QUINN)};
    tribo_driver *drv = driver_create(sys[0], methods[_i], STEP, 1e-6);
    assert_ok(tribo_driver_set_observer(drv, see, &seen));
    assert_status(tribo_driver_advance(drv, &t, 2.0, y), TRIBO_ERR_STOPPED);
    assert_says(tribo_driver_message(drv), "observer answered 7");
    ck_assert_uint_eq(seen.steps, 20);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_STEPS), 20);
    assert_exact(t, seen.t);
    assert_all_exact(y, seen.y, DIMENSION);
    driver_advance(drv, &t, 2.0, y);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_STEPS), seen.steps);
    assert_exact(t, seen.t);
    run(sys[1], methods[_i], STEP, 1e-6, 2.0, at_once);
    assert_all_exact(y, at_once, DIMENSION);
    assert_ok(tribo_driver_set_observer(drv, NULL, NULL));
    driver_advance(drv, &t, 3.0, y);
    assert_exact(seen.t, 2.0);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys[0]);
    tribo_system_destroy(sys[1]);
}

/* ------------------------------------------------------------------------------------------------------------ errors */

TEST(creation_errors)
{
    const struct {
        const char *method;
        int status;
        const char *text;
    } cases[] = {
        {NULL, TRIBO_ERR_NULL, "method is NULL"},
        {"rk5", TRIBO_ERR_NAME,
         "method \"rk5\" is unknown; there are rk4/fixed, exact, event, central/fixed, moreau/fixed, auto; "
         "tribo_gsl_driver_create takes GSL's steppers"},
        {"rkf45", TRIBO_ERR_NAME, "tribo_gsl_driver_create"},
        {"rk4/fixed and much more that nobody wants to read again", TRIBO_ERR_NAME, "moreau/fixed, auto"},
        {"", TRIBO_ERR_NAME, "method \"\""},
    };
    tribo_driver *drv;
    tribo_system *sys = chain(TRIBO_QUINN);
    stain(&drv, sizeof drv);
    for (size_t i = 0; i < COUNT(cases); i++) {
        assert_status(tribo_driver_create(&drv, sys, cases[i].method), cases[i].status);
        assert_says(tribo_system_message(sys), cases[i].text);
    }
    assert_status(tribo_driver_create(NULL, sys, "rk4/fixed"), TRIBO_ERR_NULL);
    assert_says(tribo_system_message(sys), "drv is NULL");
    assert_status(tribo_driver_create(&drv, NULL, "rk4/fixed"), TRIBO_ERR_NULL);
    ck_assert(stained(&drv, sizeof drv));
    tribo_system_destroy(sys);
}

/* The settings, and what stands in their place. */
enum { SET_STEP, SET_TOLERANCE, SET_OUTPUT, SET_MAX_STEP, SETTERS };

static int set(tribo_driver *drv, int which, double value)
{
    return which == SET_STEP        ? tribo_driver_set_step(drv, value)
           : which == SET_TOLERANCE ? tribo_driver_set_tolerance(drv, value, 0.0)
           : which == SET_OUTPUT    ? tribo_driver_set_output(drv, value)
                                    : tribo_driver_set_max_step(drv, value);
}

/* Each method takes its settings, and says of the others which methods do; one by one, and of the second kind as NULL. */
TEST(settings)
{
    const struct {
        const char *method;
        int takes[SETTERS];
    } all[] = {
        {"exact", {0, 0, 1, 0}},         {"event", {0, 1, 1, 0}},        {"auto", {0, 1, 1, 0}},  {"rk4/fixed", {1, 0, 0, 0}},
        {"central/fixed", {1, 0, 0, 0}}, {"moreau/fixed", {1, 0, 0, 0}}, {"rkf45", {1, 1, 0, 1}}, {"msbdf", {1, 1, 0, 1}},
    };
    const char *const name[] = {"dt", "abstol", "dt", "h"};
    const char *const answers[] = {"takes no step; rk4/fixed, central/fixed, moreau/fixed and GSL's adaptive methods do",
                                   "takes no tolerance; event, auto and GSL's adaptive methods do",
                                   "takes no output; exact, event and auto do",
                                   "takes no largest step; GSL's adaptive methods do"};
    tribo_system *sys = chain(TRIBO_QUINN);
    tribo_driver *drv;
    char text[200];
    assert_ok(create_any_driver(&drv, sys, all[_i].method));
    ck_assert_str_eq(tribo_driver_message(drv), "");
    for (int k = 0; k < SETTERS; k++) {
        assert_status(set(drv, k, 0.1), all[_i].takes[k] ? TRIBO_OK : TRIBO_ERR_UNSUPPORTED);
        assert_status(set(NULL, k, 0.1), TRIBO_ERR_NULL);
        if (!all[_i].takes[k]) {
            snprintf(text, sizeof text, "method %s %s", all[_i].method, answers[k]);
            assert_says(tribo_driver_message(drv), text);
            continue;
        }
        assert_status(set(drv, k, 0.0), TRIBO_ERR_NOT_POSITIVE);
        snprintf(text, sizeof text, "%s = 0 is not positive", name[k]);
        assert_says(tribo_driver_message(drv), text);
        assert_status(set(drv, k, -1.0), TRIBO_ERR_NOT_POSITIVE);
        assert_status(set(drv, k, NAN), TRIBO_ERR_NOT_FINITE);
        snprintf(text, sizeof text, "%s = nan is not finite", name[k]);
        assert_says(tribo_driver_message(drv), text);
        assert_status(set(drv, k, HUGE_VAL), k == SET_MAX_STEP ? TRIBO_OK : TRIBO_ERR_NOT_FINITE);
    }
    if (all[_i].takes[SET_TOLERANCE]) {
        assert_status(tribo_driver_set_tolerance(drv, 1.0, -2.0), TRIBO_ERR_NEGATIVE);
        assert_says(tribo_driver_message(drv), "reltol = -2 is negative");
        assert_status(tribo_driver_set_tolerance(drv, 1.0, NAN), TRIBO_ERR_NOT_FINITE);
        assert_says(tribo_driver_message(drv), "reltol = nan");
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Without a step nothing moves, until there is one; all other methods go without any setting. */
TEST(defaults)
{
    const char *const method = any_method_name(_i);
    tribo_system *sys = chain(TRIBO_QUINN), *other = chain(TRIBO_QUINN);
    tribo_driver *drv;
    double t = 0.25, y[DIMENSION] = {0}, u = 0.25, z[DIMENSION] = {0};
    assert_ok(create_any_driver(&drv, sys, method));
    if (strstr(method, "/fixed")) {
        char text[100];
        snprintf(text, sizeof text, "method %s has no step: call tribo_driver_set_step", method);
        assert_status(tribo_driver_advance(drv, &t, 1.0, y), TRIBO_ERR_STATE);
        assert_says(tribo_driver_message(drv), text);
        assert_exact(t, 0.25);
        assert_ok(tribo_driver_set_step(drv, STEP));
    }
    driver_advance(drv, &t, 1.0, y);
    tribo_driver_destroy(drv);
    const int first_order = strcmp(method, "rk1imp") == 0;
    drv = driver_create(other, method, STEP, first_order ? 1e-8 : 1e-9);
    driver_advance(drv, &u, 1.0, z);
    const double error = first_order ? 1e-3 : 1e-5;
    for (size_t i = 0; i < DIMENSION; i++) {
        require(fabs(y[i] - z[i]) <= error * fabs(z[0]), "%s: y[%zu] = %g, not %g", method, i, y[i], z[i]);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    tribo_system_destroy(other);
}

/* Settings changed between advances hold from there on: the motion is that of a driver that begins there. */
TEST(settings_change)
{
    const char *const methods[] = {"event", "rk4/fixed", "central/fixed", "rkf45", "auto"};
    const char *const method = methods[_i];
    tribo_system *sys[] = {oscillator(TRIBO_QUINN, 1.5, 0.5), oscillator(TRIBO_QUINN, 1.5, 0.5)};
    double t = 0.0, y[3] = {0.0, 1.0, 0.0}, u, z[3];
    for (size_t k = 0; k < 2; k++) {
        assert_ok(tribo_set_epsilon_step(tribo_system_context(sys[k]), STEP, 0.4));
    }
    tribo_driver *drv = driver_create(sys[0], method, STEP, 1e-4), *other = driver_create(sys[1], method, 0.5 * STEP, 1e-11);
    driver_advance(drv, &t, 1.0, y);
    u = t;
    memcpy(z, y, sizeof z);
    for (int k = SET_STEP; k <= SET_TOLERANCE; k++) {
        const int status = set(drv, k, k == SET_STEP ? 0.5 * STEP : 1e-11);
        ck_assert(status == TRIBO_OK || status == TRIBO_ERR_UNSUPPORTED);
    }
    driver_advance(drv, &t, 3.0, y);
    driver_advance(other, &u, 3.0, z);
    assert_all_exact(y, z, 3);
    tribo_driver_destroy(drv);
    tribo_driver_destroy(other);
    tribo_system_destroy(sys[0]);
    tribo_system_destroy(sys[1]);
}

TEST(advance_errors)
{
    const char *const methods[] = {"rk4/fixed", "rkf45", "rk4imp"};
    tribo_system *sys = chain(TRIBO_QUINN);
    tribo_driver *drv = driver_create(sys, methods[_i], STEP, 1e-6);
    double t = 0.5, bad = NAN, y[DIMENSION] = {0}, ill[DIMENSION] = {0};
    y[3] = 0.25;
    ill[4] = -HUGE_VAL;
    assert_status(tribo_driver_advance(NULL, &t, 1.0, y), TRIBO_ERR_NULL);
    assert_status(tribo_driver_advance(drv, NULL, 1.0, y), TRIBO_ERR_NULL);
    assert_says(tribo_driver_message(drv), "t is NULL");
    assert_status(tribo_driver_advance(drv, &t, 1.0, NULL), TRIBO_ERR_NULL);
    assert_says(tribo_driver_message(drv), "y is NULL");
    assert_status(tribo_driver_advance(drv, &bad, 1.0, y), TRIBO_ERR_NOT_FINITE);
    assert_says(tribo_driver_message(drv), "t = nan");
    assert_status(tribo_driver_advance(drv, &t, HUGE_VAL, y), TRIBO_ERR_NOT_FINITE);
    assert_says(tribo_driver_message(drv), "t1 = inf");
    assert_status(tribo_driver_advance(drv, &t, 0.25, y), TRIBO_ERR_RANGE);
    assert_says(tribo_driver_message(drv), "t1 = 0.25 is before t = 0.5");
    assert_status(tribo_driver_advance(drv, &t, 1.0, ill), TRIBO_ERR_NOT_FINITE);
    assert_says(tribo_driver_message(drv), "y[4] = -inf");
    assert_exact(t, 0.5);
    assert_exact(y[3], 0.25);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_STEPS), 0);
    driver_advance(drv, &t, 1.0, y);
    ck_assert_uint_gt(driver_count(drv, TRIBO_COUNT_STEPS), 0);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST(other_errors)
{
    size_t count;
    double value;
    tribo_system *sys = chain(TRIBO_QUINN);
    tribo_driver *drv = driver_create(sys, "rk4/fixed", STEP, 0.0);
    stain(&count, sizeof count);
    stain(&value, sizeof value);
    assert_status(tribo_driver_count(NULL, TRIBO_COUNT_STEPS, &count), TRIBO_ERR_NULL);
    assert_status(tribo_driver_count(drv, TRIBO_COUNT_STEPS, NULL), TRIBO_ERR_NULL);
    assert_says(tribo_driver_message(drv), "value is NULL");
    assert_status(tribo_driver_count(drv, TRIBO_COUNT_STUCK, &count), TRIBO_ERR_RANGE);
    assert_status(tribo_driver_count(drv, TRIBO_COUNT_RESTED + 1, &count), TRIBO_ERR_RANGE);
    assert_says(tribo_driver_message(drv), "which = 108");
    assert_status(tribo_driver_real(drv, TRIBO_REAL_RESIDUAL, &value), TRIBO_ERR_RANGE);
    assert_says(tribo_driver_message(drv), "which = 0");
    assert_status(tribo_driver_real(drv, TRIBO_REAL_EXCESS, &value), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(drv), "method rk4/fixed");
    assert_status(tribo_driver_get_multipliers(drv, &value, &value), TRIBO_ERR_STATE);
    assert_says(tribo_driver_message(drv), "no periodic motion");
    assert_status(tribo_driver_get_multipliers(drv, &value, NULL), TRIBO_ERR_NULL);
    assert_says(tribo_driver_message(drv), "im is NULL");
    assert_status(tribo_driver_get_freedom(drv, &count), TRIBO_ERR_STATE);
    assert_says(tribo_driver_message(drv), "no periodic motion");
    assert_status(tribo_driver_get_freedom(drv, NULL), TRIBO_ERR_NULL);
    assert_says(tribo_driver_message(drv), "freedom is NULL");
    assert_status(tribo_driver_get_freedom(NULL, &count), TRIBO_ERR_NULL);
    ck_assert(stained(&value, sizeof value));
    assert_status(tribo_driver_set_observer(NULL, see, NULL), TRIBO_ERR_NULL);
    ck_assert(stained(&count, sizeof count));
    ck_assert_uint_gt(strlen(tribo_driver_message(NULL)), 0);
    tribo_driver_destroy(NULL);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------- failures under way */

/* The same contact twice, each with a motion of its own: the partition has no f_eq for that once both are near stick. */
static tribo_system *torn(void)
{
    const double mass[] = {1.0}, stiffness[] = {1.0}, direction[] = {1.0, 1.0}, sine[] = {0.0, 1.0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 1, 2, mass, NULL, stiffness, direction, 0, NULL, 0));
    tribo_context *c = tribo_system_context(sys);
    assert_ok(tribo_system_add_base_motion(sys, 1.0, NULL, sine));
    assert_ok(tribo_set_coupling(c, TRIBO_PARTITION));
    assert_ok(tribo_set_limit_all(c, 0.1));
    assert_ok(tribo_set_epsilon_all(c, 0.1));
    return sys;
}

static int see_one(const tribo_moment *moment, void *data)
{
    const double t = moment->t, *y = moment->y;
    struct seen *seen = data;
    seen->t = t;
    memcpy(seen->y, y, 3 * sizeof *y);
    return 0;
}

/* From far above, the contacts come to the band within a few steps. */
TEST(inconsistent_under_way)
{
    const char *const methods[] = {"rk4/fixed", "rkf45", "rk4imp"};
    tribo_system *sys = torn();
    tribo_driver *drv = driver_create(sys, methods[_i], 0.01, 1e-6);
    double t = 0.0, y[3] = {0.0, 1.0, 0.0};
    struct seen seen = {0, 0, 0.0, {0}};
    assert_ok(tribo_driver_set_observer(drv, see_one, &seen));
    assert_status(tribo_driver_advance(drv, &t, 50.0, y), TRIBO_ERR_INCONSISTENT);
    assert_says(tribo_driver_message(drv), "at t = ");
    assert_says(tribo_driver_message(drv), "rank 1");
    assert_exact(t, seen.t);
    assert_all_exact(y, seen.y, 3);
    require(t > 0.1 && t < 50.0 && y[1] != 1.0, "failed at t = %g", t);
    /* the consistent coupling takes it from there */
    assert_ok(tribo_set_coupling(tribo_system_context(sys), TRIBO_CONSISTENT));
    driver_advance(drv, &t, 50.0, y);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* In any case of letters; nothing shorter, and nothing longer. */
TEST(names)
{
    const char *const right[] = {"rk4/fixed", "RK4/FIXED", "Rk8Pd", "CENTRAL/fixed", "Auto", "eXACT"};
    const char *const wrong[] = {"rk4/fixe", "rk4/fixed ", "rk", "exact2", "\xc5xact"};
    tribo_system *sys = chain(TRIBO_QUINN);
    for (size_t i = 0; i < COUNT(right); i++) {
        tribo_driver_destroy(driver_create(sys, right[i], STEP, 1e-6));
    }
    for (size_t i = 0; i < COUNT(wrong); i++) {
        tribo_driver *drv;
        assert_status(set_up_driver(&drv, sys, wrong[i], STEP, 1e-6, 0.0), TRIBO_ERR_NAME);
    }
    tribo_system_destroy(sys);
}

/* Steps that time does not resolve are refused before the first one. */
TEST(resolution)
{
    const char *const methods[] = {"rk4/fixed", "central/fixed", "moreau/fixed"};
    const struct {
        double dt, begin, end;
    } cases[] = {{1e-9, 1e8, 1e8 + 1.0}, {1e-9, 0.0, 1e8}, {1e-9, -1e8, 1.0}, {1e-300, 0.0, 1e-283}, {1e-320, 0.0, 1.0}};
    tribo_system *sys = oscillator(TRIBO_QUINN, 1.5, 0.5);
    for (size_t k = 0; k < COUNT(cases); k++) {
        double t = cases[k].begin, y[3] = {1.0, 0.0, 0.0};
        tribo_driver *drv = driver_create(sys, methods[_i], cases[k].dt, 0.0);
        assert_status(tribo_driver_advance(drv, &t, cases[k].end, y), TRIBO_ERR_STEP);
        assert_says(tribo_driver_message(drv), "hardly more than time resolves");
        assert_exact(t, cases[k].begin);
        assert_exact(y[0], 1.0);
        ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_STEPS), 0);
        tribo_driver_destroy(drv);
    }
    /* and near there, steps differ by the rounding of time */
    double t = 1e8, y[3] = {1.0, 0.0, 0.0};
    tribo_driver *drv = driver_create(sys, methods[_i], 1e-6, 0.0);
    driver_advance(drv, &t, 1e8 + 1e-3, y);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_STEPS), 1000);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* A degree of freedom that no contact touches, and that grows until numbers end. Nobody sees what is not finite. */
static int see_finite(const tribo_moment *moment, void *data)
{
    const double t = moment->t, *y = moment->y;
    struct seen *seen = data;
    for (size_t i = 0; i < 5; i++) {
        require(isfinite(y[i]), "at t = %g an observer sees y[%zu] = %g", t, i, y[i]);
    }
    seen->t = t;
    memcpy(seen->y, y, 5 * sizeof *y);
    return 0;
}

TEST(growth)
{
    const char *method = any_method_name(_i);
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {1.0, 0.0, 0.0, -1.0}, direction[] = {1.0, 0.0};
    for (int observed = 0; observed < 2; observed++) {
        double t = 0.0, y[5] = {1.0, 1.0};
        struct seen seen = {0, 0, 0.0, {0}};
        tribo_system *sys;
        tribo_driver *drv;
        assert_ok(dense_system(&sys, 2, 1, mass, NULL, stiffness, direction, 0, NULL, 0));
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.1));
        assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 0.1));
        assert_ok(set_up_driver(&drv, sys, method, 0.1, 1e-4, 1e-4));
        assert_ok(tribo_driver_set_observer(drv, observed ? see_finite : NULL, &seen));
        const int status = tribo_driver_advance(drv, &t, 2000.0, y);
        require(status == TRIBO_ERR_NOT_FINITE || status == TRIBO_ERR_STEP, "%s: %d, y[1] = %g", method, status, y[1]);
        ck_assert_uint_gt(strlen(tribo_driver_message(drv)), 20);
        require(t > 1.0 && t < 720.0, "%s ends at %g", method, t);
        for (size_t i = 0; i < 5; i++) {
            require(isfinite(y[i]), "%s: y[%zu] = %g", method, i, y[i]);
        }
        if (observed && strcmp(method, "event") != 0) { /* which shows no steps */
            assert_exact(t, seen.t);
            assert_all_exact(y, seen.y, 5);
        }
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}

/* Structures that no contact touches: x'' + x = 3/2 sin(t/2) from x = 1, x' = 0. */
TEST(no_contacts)
{
    const char *method = any_method_name(_i);
    const double one = 1.0, amplitude = 1.5, end = 8.0;
    double t = 0.0, y[3] = {1.0, 0.0, 0.0};
    tribo_system *sys;
    assert_ok(dense_system(&sys, 1, 0, &one, NULL, &one, NULL, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 0.5, NULL, &amplitude));
    assert_ok(tribo_system_contacts(sys, 0.0, y, NULL, NULL, NULL));
    tribo_driver *drv = driver_create(sys, method, 1e-3, 1e-8);
    for (int k = 1; k <= 4; k++) {
        driver_advance(drv, &t, 0.25 * k * end, y);
    }
    const double tolerance = strcmp(method, "rk1imp") ? 1e-5 : 2e-3; /* of a step 1e-8 */
    assert_close(y[0], 2.0 * sin(0.5 * end) - sin(end) + cos(end), tolerance);
    assert_close(y[1], cos(0.5 * end) - cos(end) - sin(end), tolerance);
    assert_exact(y[2], 0.0);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Numbers that overflow end the run where they do. */
TEST(overflow)
{
    const char *const methods[] = {"rk4/fixed", "rkf45", "rk4imp"};
    tribo_system *sys = chain(TRIBO_QUINN);
    tribo_driver *drv = driver_create(sys, methods[_i], STEP, 1e-6);
    double t = 0.0, y[DIMENSION] = {0};
    y[0] = 1e308; /* times n^2 */
    const int status = tribo_driver_advance(drv, &t, 1.0, y);
    require(status == TRIBO_ERR_NOT_FINITE || status == TRIBO_ERR_STEP, "%d: %s", status, tribo_driver_message(drv));
    ck_assert_uint_gt(strlen(tribo_driver_message(drv)), 0);
    assert_exact(t, 0.0);
    assert_exact(y[0], 1e308);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* What auto has strayed from Coulomb's law is what the method at work has; adaptive methods do not know. */
TEST(reals)
{
    const char *const methods[] = {"exact", "auto", "msbdf"};
    double value[2] = {-1.0, -1.0};
    for (size_t k = 0; k < COUNT(methods); k++) {
        double t = 0.0, y[3] = {0}, untouched = -1.0;
        tribo_system *sys = oscillator(TRIBO_QUINN, 1.5, 0.5);
        tribo_driver *drv = driver_create(sys, methods[k], 1.0, 1e-6);
        driver_advance(drv, &t, 20.0, y);
        if (k < 2) {
            assert_ok(tribo_driver_real(drv, TRIBO_REAL_EXCESS, &value[k]));
            ck_assert_double_ge(value[k], 0.0);
        } else {
            assert_status(tribo_driver_real(drv, TRIBO_REAL_EXCESS, &untouched), TRIBO_ERR_UNSUPPORTED);
            assert_exact(untouched, -1.0);
        }
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    assert_exact(value[1], value[0]);
}

/* The rounding mode of the caller changes rounding, and nothing else. */
TEST(rounding_modes)
{
    const char *const methods[] = {"exact", "event", "central/fixed", "moreau/fixed", "rk4/fixed"};
    const int modes[] = {
        FE_TONEAREST,
#if defined(FE_UPWARD) && defined(FE_DOWNWARD) && defined(FE_TOWARDZERO)
        FE_UPWARD,
        FE_DOWNWARD,
        FE_TOWARDZERO
#endif
    };
    double first[3];
    for (size_t m = 0; m < COUNT(modes); m++) {
        tribo_system *sys;
        double t = 0.0, y[3] = {1.0, 0.0, 0.0};
        assert_ok(tribo_system_oscillator(&sys, 0.1, 0.5, 0.7));
        assert_ok(tribo_set_epsilon_step(tribo_system_context(sys), 0.01, 1.0));
        fesetround(modes[m]);
        tribo_driver *drv = driver_create(sys, methods[_i], 0.01, 1e-10);
        const int status = tribo_driver_advance(drv, &t, 10.0, y);
        fesetround(FE_TONEAREST);
        assert_ok(status);
        for (size_t k = 0; k < 3; k++) {
            first[k] = m ? first[k] : y[k];
        }
        assert_all_close(y, first, 3, 1e-9);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}

TEST_MAIN("driver", {rounding_modes, 5}, {reals, 1}, {four_evaluations_a_step, 6}, {last_steps, 1}, {classical_runge_kutta, 1},
          {pieces, 6}, {observer_stops, 3}, {creation_errors, 1}, {settings, 8}, {defaults, METHODS}, {settings_change, 5},
          {advance_errors, 3}, {other_errors, 1}, {inconsistent_under_way, 3}, {overflow, 3}, {names, 1}, {resolution, 3},
          {growth, METHODS}, {no_contacts, METHODS})
