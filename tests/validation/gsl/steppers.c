/* SPDX-License-Identifier: BSD-3-Clause */
/* The methods that choose their steps: their order, what a tolerance means, and that friction does not deceive them. */
#include <stdlib.h>
#include <string.h>

#include "make.h"
#include "coulomb.h"
#include "../../set_up_driver.h"

static const struct {
    const char *name;
    int order, implicit;
    double power, most; /* the energy's relative error is at most most tolerance^power */
} steppers[] = {
    {"rk2", 3, 0, 1.0, 100.0},   {"rk4", 4, 0, 1.0, 100.0},     {"rkf45", 5, 0, 1.0, 100.0},    {"rkck", 5, 0, 1.0, 100.0},
    {"rk8pd", 8, 0, 1.0, 100.0}, {"rk1imp", 1, 1, 0.5, 4.0},    {"rk2imp", 2, 1, 2.0 / 3, 1.0}, {"rk4imp", 4, 1, 1.0, 100.0},
    {"bsimp", 0, 1, 1.0, 100.0}, {"msadams", 0, 0, 1.0, 100.0}, {"msbdf", 0, 1, 1.0, 200.0},
};

TEST(names)
{
    const char *const methods[] = {"rk4/fixed", "exact", "event", "central/fixed", "moreau/fixed", "auto"};
    ck_assert_int_eq(any_method_count(), COUNT(methods) + COUNT(steppers));
    for (size_t i = 0; i < COUNT(methods); i++) {
        ck_assert_str_eq(any_method_name((int)i), methods[i]);
    }
    for (size_t i = 0; i < COUNT(steppers); i++) {
        ck_assert_str_eq(any_method_name((int)(COUNT(methods) + i)), steppers[i].name);
    }
    ck_assert_ptr_null(any_method_name(-1));
    ck_assert_ptr_null(any_method_name(any_method_count()));
}

/* A stepper of one's own: Heun's method with Euler's as its estimate. */
struct heun {
    tribo_system *sys;
    double end[3];
    int destroyed;
};

static int heun_step(const tribo_trial *x, void *data)
{
    struct heun *h = data;
    for (size_t i = 0; i < 3; i++) {
        x->to[i] = x->y[i] + x->h * x->slope[i];
    }
    const int status = tribo_system_derivative(h->sys, x->t + x->h, x->to, h->end);
    for (size_t i = 0; i < 3; i++) {
        x->error[i] = 0.5 * x->h * (h->end[i] - x->slope[i]);
        x->to[i] += x->error[i];
    }
    return status;
}

static double heun_order(void *data)
{
    (void)data;
    return 1.0;
}

static void heun_destroy(void *data)
{
    ((struct heun *)data)->destroyed++;
}

TEST(own_stepper)
{
    const tribo_stepper heun = {.size = sizeof heun,
                                .name = "heun",
                                .stable = 2.0,
                                .takes_slope = 1,
                                .step = heun_step,
                                .order = heun_order,
                                .destroy = heun_destroy};
    tribo_stepper bad = heun;
    tribo_system *sys;
    tribo_driver *drv, *other;
    double y[2][3] = {{0.0}}, t[2] = {0.0};
    assert_ok(tribo_system_oscillator(&sys, 1.0, 1.5, 0.5));
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 0.01));
    struct heun own = {.sys = sys};
    bad.step = NULL;
    assert_status(tribo_driver_create_stepper(&drv, sys, &bad, &own), TRIBO_ERR_NULL);
    bad.size = 8;
    assert_status(tribo_driver_create_stepper(&drv, sys, &bad, &own), TRIBO_ERR_SIZE);
    assert_ok(tribo_driver_create_stepper(&drv, sys, &heun, &own));
    ck_assert_str_eq(tribo_driver_method(drv), "heun");
    assert_ok(tribo_gsl_driver_create(&other, sys, "RK8PD"));
    assert_ok(tribo_driver_set_tolerance(drv, 1e-7, 1e-7));
    assert_ok(tribo_driver_set_tolerance(other, 1e-9, 1e-9));
    assert_ok(tribo_driver_advance(drv, &t[0], 20.0, y[0]));
    assert_ok(tribo_driver_advance(other, &t[1], 20.0, y[1]));
    assert_all_close(y[0], y[1], 3, 1e-4);
    tribo_driver_destroy(other);
    ck_assert_int_eq(own.destroyed, 0);
    tribo_driver_destroy(drv);
    ck_assert_int_eq(own.destroyed, 1);
    tribo_system_destroy(sys);
}

static void count_up(void *data)
{
    ++*(int *)data;
}

/* Data hang on a system until it is destroyed, and not on its clone. */
TEST(attached)
{
    const char key[2] = {0};
    int freed = 0;
    tribo_system *sys, *copy;
    assert_ok(tribo_system_oscillator(&sys, 1.0, 1.5, 0.5));
    ck_assert_ptr_null(tribo_system_attached(sys, key));
    assert_ok(tribo_system_attach(sys, key, &freed, count_up));
    assert_ok(tribo_system_attach(sys, key + 1, &freed, NULL));
    assert_status(tribo_system_attach(sys, key, &freed, count_up), TRIBO_ERR_STATE);
    assert_status(tribo_system_attach(sys, NULL, &freed, count_up), TRIBO_ERR_NULL);
    ck_assert_ptr_eq(tribo_system_attached(sys, key), &freed);
    ck_assert_ptr_eq(tribo_gsl_system(sys), tribo_gsl_system(sys));
    assert_ok(tribo_system_clone(sys, &copy));
    ck_assert_ptr_null(tribo_system_attached(copy, key));
    tribo_system_destroy(copy);
    ck_assert_int_eq(freed, 0);
    tribo_system_destroy(sys);
    ck_assert_int_eq(freed, 1);
}

/* Steps as long as the largest, since no error is too large: those of a fixed step, whose order shows in the closed form of
 * x'' + x = 3/2 sin(t/2), x = 2 sin(t/2) - sin t + cos t. */
TEST(orders)
{
    const double coarse = steppers[_i].order > 5 ? 1.0 : 0.25, dt[] = {coarse, 0.25 * coarse}, end = 8.0;
    double error[2];
    for (size_t k = 0; k < 2 && steppers[_i].order; k++) {
        double t = 0.0, y[3] = {1.0, 0.0, 0.0};
        tribo_system *sys;
        assert_ok(tribo_system_oscillator(&sys, 0.0, 1.5, 0.5));
        tribo_driver *drv = driver_create(sys, steppers[_i].name, dt[k], 1e9);
        assert_ok(tribo_driver_set_max_step(drv, dt[k]));
        driver_advance(drv, &t, end, y);
        ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_STEPS), (size_t)round(end / dt[k]));
        error[k] = hypot(y[0] - (2.0 * sin(0.5 * end) - sin(end) + cos(end)), y[1] - (cos(0.5 * end) - cos(end) - sin(end)));
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    if (steppers[_i].order) {
        ck_assert_double_gt(order_of(dt, error, 2), steppers[_i].order - 0.35);
    }
}

/* The oscillator of Fig. 7a under the smooth law: no kink, and no largest step. */
TEST(smooth_law)
{
    const double tolerance[] = {1e-5, 1e-8};
    double error[2], want[3] = {0};
    tribo_system *sys = oscillator(TRIBO_SMOOTH, 1.5, 0.5);
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 0.5));
    run(sys, "rk4/fixed", 1e-3, 0.0, 20.0, want);
    for (size_t k = 0; k < 2; k++) {
        double t = 0.0, y[3] = {0};
        tribo_driver *drv = driver_create(sys, steppers[_i].name, 1e-3, tolerance[k]);
        assert_ok(tribo_driver_set_max_step(drv, HUGE_VAL));
        driver_advance(drv, &t, 20.0, y);
        error[k] = fmax(fabs(y[0] - want[0]), fmax(fabs(y[1] - want[1]), fabs(y[2] - want[2])));
        require(error[k] < 3.0 * steppers[_i].most * pow(tolerance[k], steppers[_i].power), "%s: %.2g", steppers[_i].name,
                error[k]);
        tribo_driver_destroy(drv);
    }
    require(error[1] < fmax(0.05 * error[0], 10.0 * tolerance[1]), "%s does not mind its tolerance: %.2g, %.2g",
            steppers[_i].name, error[0], error[1]);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------------------- friction */

static tribo_system *fig_7a(double epsilon)
{
    tribo_system *sys = oscillator(TRIBO_QUINN, 1.5, 0.5);
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), epsilon));
    return sys;
}

static tribo_system *fig_7b(double epsilon)
{
    tribo_system *sys = oscillator(TRIBO_QUINN, 2.0, 2.0);
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), epsilon));
    return sys;
}

static tribo_system *belt(double epsilon)
{
    tribo_system *sys;
    assert_ok(tribo_system_belt(&sys, 2.0, 0.5, 0.25, 1.0, 0.5));
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), epsilon));
    return sys;
}

static const struct {
    const char *name;
    tribo_system *(*create)(double epsilon);
    double end;
} systems[] = {{"7a", fig_7a, 40.0 * PI}, {"7b", fig_7b, 10.0 * PI}, {"belt", belt, 60.0}};

/* What friction dissipates from rest to the end. */
static double energy(size_t system, const char *method, double epsilon, double dt, double tolerance)
{
    double y[5] = {0};
    tribo_system *sys = systems[system].create(epsilon);
    const size_t last = tribo_system_dimension(sys) - 1;
    run(sys, method, dt, tolerance, systems[system].end, y);
    tribo_system_destroy(sys);
    return y[last];
}

/* Against fixed steps in which the band is resolved. The steps of the method of first order are as the root of the tolerance: its
 * tightest tolerance is one of the long cases. */
TEST(energies)
{
    const double epsilon = _i % 2 ? 1e-3 : 1e-2;
    const size_t system = (size_t)_i / 2;
    const double want = energy(system, "rk4/fixed", epsilon, 0.1 * epsilon, 0.0);
    for (size_t k = 0; k < COUNT(steppers); k++) {
        const double tightest = steppers[k].order == 1 && !more() ? 1e-6 : 1e-8;
        for (double tolerance = 1e-4; tolerance > 0.5 * tightest; tolerance *= 1e-2) {
            const double error = energy(system, steppers[k].name, epsilon, 1e-3, tolerance) / want - 1.0;
            require(fabs(error) < steppers[k].most * fmin(pow(tolerance, steppers[k].power), 1e-2),
                    "%s, %s, epsilon %g, tolerance %g: off by %.2g", systems[system].name, steppers[k].name, epsilon, tolerance,
                    error);
        }
    }
}

/* Rest gives slopes of exactly zero, an error of zero, and so ever longer steps, which must not pass over what the load does
 * next. Ten cycles, of which an epsilon this small changes 1e-8; also with a tolerance much larger than epsilon. */
TEST(steps_over_rest)
{
    const double epsilon = 1e-4, want = energy(0, "exact", epsilon, 1.0, 0.0);
    assert_close(want, 67.674, 1e-3);
    const double tightest = steppers[_i].order == 1 && !more() ? 1e-3 : 1e-8;
    for (double tolerance = 1e-3; tolerance > 0.5 * tightest; tolerance *= 1e-5) {
        const double error = energy(0, steppers[_i].name, epsilon, 1e-3, tolerance) / want - 1.0;
        require(fabs(error) < steppers[_i].most * fmin(pow(tolerance, steppers[_i].power), 1e-3), "%s, tolerance %g: off by %.2g",
                steppers[_i].name, tolerance, error);
    }
}

/* Loads that exceed the limit by less and less, for a shorter and shorter time: what is overlooked dissipates no more than the
 * header says, four slips each. */
TEST(short_slips)
{
    struct random g = random_of(_i);
    for (double excess = 1e-5; excess < 0.03; excess *= 3.0) {
        double y[3] = {0}, want[3] = {0}, begin = uniform(&g, 0.0, 1.0), t[2] = {begin, begin};
        tribo_system *sys = oscillator(TRIBO_QUINN, 1.0 + excess, 0.5);
        assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 1e-3));
        tribo_driver *drv[] = {driver_create(sys, steppers[_i].name, 1e-3, 1e-9), driver_create(sys, "exact", 1.0, 0.0)};
        driver_advance(drv[0], &t[0], begin + 25.0, y);
        driver_advance(drv[1], &t[1], begin + 25.0, want);
        require(fabs(y[2] - want[2]) < (steppers[_i].order == 1 ? 1e-4 : 5e-6), "%s: %g, not %g, at a load of 1 + %.2g",
                steppers[_i].name, y[2], want[2], excess);
        tribo_driver_destroy(drv[0]);
        tribo_driver_destroy(drv[1]);
        tribo_system_destroy(sys);
    }
}

/* A pulse between two knots of a table, while all is at rest for a hundred times as long. */
TEST(pulse)
{
    const double time[] = {0.0, 5.0, 5.01, 5.02}, value[] = {0.0, 0.0, 300.0, 0.0}, one = 1.0;
    double y[3] = {0}, want[3] = {0};
    tribo_system *sys = block(1.0, 0.01, 1.0);
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 1e-3));
    assert_ok(tribo_system_add_load_table(sys, COUNT(time), time, value, &one));
    run(sys, "event", 1.0, 1e-10, 20.0, want);
    ck_assert_double_gt(want[2], 3.0);
    run(sys, steppers[_i].name, 1e-3, 1e-7, 20.0, y);
    assert_close(y[2] / want[2], 1.0, steppers[_i].order == 1 ? 2e-3 : 1e-4);
    tribo_system_destroy(sys);
}

/* The reversal law changes its form between steps, also where the slope at the end of one is kept for the next. */
TEST(reversal_law)
{
    double y[3] = {0}, want[3] = {0};
    tribo_system *sys[2];
    for (int k = 0; k < 2; k++) {
        sys[k] = oscillator(TRIBO_QUINN_REVERSAL, 2.0, 2.0);
        assert_ok(tribo_set_epsilon_all(tribo_system_context(sys[k]), 0.05));
    }
    run(sys[0], "rk4/fixed", 1e-4, 0.0, 20.0, want);
    run(sys[1], steppers[_i].name, 1e-3, steppers[_i].order == 1 && !more() ? 1e-7 : 1e-9, 20.0, y);
    assert_all_close(y, want, 3, steppers[_i].order == 1 ? 1e-3 : steppers[_i].order == 2 ? 1e-5 : 2e-6);
    tribo_system_destroy(sys[0]);
    tribo_system_destroy(sys[1]);
}

/* Coulomb's law itself jumps where v = 0: right, or an error, and in any case the state that an observer saw last. The multistep
 * methods take 4 million steps at the jump: long cases. */
TEST(coulombs_law)
{
    if (!more() && strncmp(steppers[_i].name, "ms", 2) == 0) {
        return;
    }
    struct log *log = calloc(1, sizeof *log);
    double t = 0.0, y[3] = {0}, want[3] = {0};
    tribo_system *sys = oscillator(TRIBO_COULOMB, 1.5, 0.5);
    tribo_driver *drv = driver_create(sys, steppers[_i].name, 1e-3, 5e-6);
    assert_ok(tribo_driver_set_observer(drv, log_event, log));
    const int status = tribo_driver_advance(drv, &t, 6.0, y);
    if (status) {
        assert_status(status, TRIBO_ERR_STEP);
        assert_says(tribo_driver_message(drv), "step");
        assert_exact(t, log->last);
    } else {
        run(sys, "exact", 1.0, 0.0, 6.0, want);
        assert_all_close(y, want, 3, 1e-3);
    }
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_STEPS), log->calls);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    free(log);
}

/* -------------------------------------------------------------------------------------------------------- largest step */

static int longest_step(const tribo_moment *moment, void *data)
{
    const double t = moment->t;
    double *seen = data;
    seen[1] = fmax(seen[1], t - seen[0]);
    seen[0] = t;
    return 0;
}

TEST(largest_step)
{
    const double fastest = 2.0; /* of the load; the structure's is 1 */
    const double set[] = {0.0, 0.004, HUGE_VAL};
    for (size_t k = 0; k < COUNT(set); k++) {
        double t = 0.0, y[3] = {0}, seen[2] = {0};
        tribo_system *sys = oscillator(TRIBO_QUINN, 0.5, fastest); /* rests for good */
        assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 1e-3));
        tribo_driver *drv = driver_create(sys, steppers[_i].name, 1e-3, 1e-6);
        if (set[k] > 0.0) {
            assert_ok(tribo_driver_set_max_step(drv, set[k]));
        }
        assert_ok(tribo_driver_set_observer(drv, longest_step, seen));
        driver_advance(drv, &t, 10.0, y);
        const double most = set[k] > 0.0 ? set[k] : 0.1 / fastest;
        require(seen[1] <= most * (1.0 + 1e-12), "step of %g, not %g", seen[1], most);
        require(!steppers[_i].implicit || seen[1] > fmin(0.9 * most, 1.0), "no step longer than %g", seen[1]);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}

TEST(largest_step_errors)
{
    tribo_system *sys = fig_7a(1e-3);
    assert_status(tribo_driver_set_max_step(NULL, 1.0), TRIBO_ERR_NULL);
    for (int m = 0; m < any_method_count(); m++) {
        tribo_driver *drv = driver_create(sys, any_method_name(m), 0.1, 1e-6);
        int adaptive = 0;
        for (size_t k = 0; k < COUNT(steppers); k++) {
            adaptive |= strcmp(any_method_name(m), steppers[k].name) == 0;
        }
        if (adaptive) {
            assert_ok(tribo_driver_set_max_step(drv, 0.5));
            assert_status(tribo_driver_set_max_step(drv, 0.0), TRIBO_ERR_NOT_POSITIVE);
            assert_says(tribo_driver_message(drv), "h = 0 is not positive");
            assert_status(tribo_driver_set_max_step(drv, -1.0), TRIBO_ERR_NOT_POSITIVE);
            assert_status(tribo_driver_set_max_step(drv, NAN), TRIBO_ERR_NOT_FINITE);
            assert_says(tribo_driver_message(drv), "h = nan");
        } else {
            assert_status(tribo_driver_set_max_step(drv, 0.5), TRIBO_ERR_UNSUPPORTED);
            assert_says(tribo_driver_message(drv), any_method_name(m));
        }
        tribo_driver_destroy(drv);
    }
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------- what is not dissipative */

/* x'' = x + c x' from x = 1: in steps of 1 (c = 0), the iteration matrix of rk1imp is singular; dampers that drive do the same.
 * The step is then another one, and the answer right. */
TEST(singular_matrices)
{
    const double one = 1.0, stiffness = -1.0, drive[] = {0.0, -1.5};
    for (size_t k = 0; k < COUNT(drive); k++) {
        for (double dt = 0.5; dt < 9.0; dt *= 2.0) {
            double t = 0.0, y[3] = {1.0, 0.0, 0.0};
            tribo_system *sys;
            assert_ok(dense_system(&sys, 1, 0, &one, k ? &drive[k] : NULL, &stiffness, NULL, 0, NULL, 0));
            tribo_driver *drv = NULL;
            assert_ok(set_up_driver(&drv, sys, steppers[_i].name, dt, 1e-7, 1e-7));
            driver_advance(drv, &t, 4.0, y);
            const double p = k ? 2.0 : 1.0, q = k ? -0.5 : -1.0; /* exponents */
            const double want = (p * exp(q * 4.0) - q * exp(p * 4.0)) / (p - q);
            assert_close(y[0] / want, 1.0, steppers[_i].order == 1 ? 5e-3 : 1e-4);
            tribo_driver_destroy(drv);
            tribo_system_destroy(sys);
        }
    }
}

/* Two blocks whose contact is a damper so strong that 1 is nothing beside it: matrices that are singular but for rounding, which
 * GSL would end the program for. */
TEST(singular_by_rounding)
{
    for (double epsilon = 1e-14; steppers[_i].implicit && epsilon > 1e-40; epsilon *= 1e-3) {
        double t = 0.0, y[5] = {0.0, 0.0, 0.3, 0.3, 0.0};
        tribo_system *sys;
        assert_ok(tribo_system_belt(&sys, 2.0, 0.0, 0.25, 1.0, 0.5));
        assert_ok(tribo_set_law(tribo_system_context(sys), TRIBO_VELOCITY_LIMITED));
        assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), epsilon));
        tribo_driver *drv = driver_create(sys, steppers[_i].name, 0.05, 1e-5);
        const int status = tribo_driver_advance(drv, &t, 0.2, y);
        require(!status || status == TRIBO_ERR_STEP, "%s, epsilon %g: %d, %s", steppers[_i].name, epsilon, status,
                tribo_driver_message(drv));
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}

/* A tolerance below what numbers of the size of the state resolve is an error, not work without end. */
TEST(impossible_tolerance)
{
    const double states[3][3] = {{1e12, 0.0, 0.0}, {0.0, 1e12, 0.0}, {0.0, 0.0, 1e12}};
    const char *const texts[] = {"y[0] = 1e+12 is found to 1e-06", "y[1] = 1e+12 is found to 1e-06",
                                 "y[2] = 1e+12 is found to 1e-06"};
    tribo_system *sys = fig_7a(0.05);
    tribo_driver *drv = driver_create(sys, steppers[_i].name, 1e-3, 1e-6);
    for (size_t k = 0; k < 3; k++) {
        double t = 0.0, y[3];
        memcpy(y, states[k], sizeof y);
        assert_status(tribo_driver_advance(drv, &t, 1.0, y), TRIBO_ERR_STEP);
        assert_says(tribo_driver_message(drv), texts[k]);
        assert_all_exact(y, states[k], 3);
        assert_exact(t, 0.0);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Explicit methods need no Jacobian, and rejected steps are counted. */
TEST(counts)
{
    tribo_system *sys = fig_7a(0.05);
    tribo_driver *drv = driver_create(sys, steppers[_i].name, 1e-3, 1e-6);
    struct log *log = calloc(1, sizeof *log);
    double t = 0.0, y[3] = {0};
    assert_ok(tribo_driver_set_observer(drv, log_event, log));
    driver_advance(drv, &t, 20.0, y);
    const size_t steps = driver_count(drv, TRIBO_COUNT_STEPS), evaluations = driver_count(drv, TRIBO_COUNT_EVALUATIONS);
    ck_assert_uint_eq(steps, log->calls);
    ck_assert_uint_gt(driver_count(drv, TRIBO_COUNT_REJECTED), 0);
    ck_assert_uint_ge(evaluations, 2 * steps);
    ck_assert((driver_count(drv, TRIBO_COUNT_JACOBIANS) > 0) == steppers[_i].implicit);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_EVENTS), 0);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    free(log);
}

/* In pieces, the step size goes on from where it was: hardly more steps than at once, and the same result. */
TEST(advance_in_pieces)
{
    double at_once[3] = {0}, y[3] = {0}, t = 0.0;
    size_t steps[2];
    for (int pieces = 1; pieces <= 10; pieces += 9) {
        tribo_system *sys = oscillator(TRIBO_SMOOTH, 1.5, 0.5);
        assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 0.5));
        tribo_driver *drv = driver_create(sys, steppers[_i].name, 1e-6, 1e-7);
        t = 0.0;
        for (int k = 1; k <= pieces; k++) {
            driver_advance(drv, &t, k * 20.0 / pieces, pieces > 1 ? y : at_once);
        }
        steps[pieces > 1] = driver_count(drv, TRIBO_COUNT_STEPS);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
    assert_all_close(y, at_once, 3, steppers[_i].order == 1 ? 1e-3 : 1e-4);
    ck_assert_uint_le(steps[1], steps[0] + 100);
}

TEST_MAIN("steppers", {names, 1}, {own_stepper, 1}, {attached, 1}, {orders, COUNT(steppers)}, {smooth_law, COUNT(steppers)},
          {energies, 2 * COUNT(systems)}, {steps_over_rest, COUNT(steppers)}, {short_slips, COUNT(steppers)},
          {pulse, COUNT(steppers)}, {reversal_law, COUNT(steppers)}, {coulombs_law, COUNT(steppers)},
          {largest_step, COUNT(steppers)}, {largest_step_errors, 1}, {singular_matrices, COUNT(steppers)},
          {singular_by_rounding, COUNT(steppers)}, {impossible_tolerance, COUNT(steppers)}, {counts, COUNT(steppers)},
          {advance_in_pieces, COUNT(steppers)})
