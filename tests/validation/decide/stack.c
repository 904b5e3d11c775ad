/* SPDX-License-Identifier: BSD-3-Clause */
/* A pile of 50 blocks, with masses that differ by up to 1e7 from neighbour to neighbour: the event-driven methods and rk4 with
 * Quinn's law and the consistent coupling lead to the same state, whatever the masses. With the partition the error grows with
 * the ratio of masses, since there a contact in S that cannot carry its f_eq leaves the light block between two contacts out of
 * balance. */
#include "pile.h"
#include "run.h"

static const double ratio[] = {1.0, 1e2, 1e4, 1e5, 1e6, 1e7};

static void reach(int even, double masses, const char *method, int coupling, double dt, double tolerance, double *y)
{
    const int status = pile_run(masses, even, method, coupling, dt, tolerance, y);
    require(status == TRIBO_OK, "%s, ratio %g, %s: %d, %s", even ? "even" : "uneven", masses, method, status,
            tribo_strerror(status));
}

/* Two ways to the same events. Rounding of forces, which are 1e7 times what accelerates heavy blocks, is in the result. */
TEST(event_and_exact_agree)
{
    const int even = _i % 2;
    const double masses = ratio[_i / 2];
    double exact[PILE_STATES], event[PILE_STATES];
    reach(even, masses, "exact", TRIBO_CONSISTENT, 1.0, 0.0, exact);
    reach(even, masses, "event", TRIBO_CONSISTENT, 1.0, 1e-10, event);
    const double apart = pile_distance(event, exact), allowed = 1e-10 + 1e-14 * masses;
    require(apart <= allowed, "ratio %g: %.3g apart", masses, apart);
    ck_assert_double_gt(fabs(event[0]), 1e-3);
}

/* First order in dt, with the same error for all ratios. */
TEST(consistent_converges)
{
    const int even = _i % 2;
    const double masses = ratio[_i / 2 * 4], dt[] = {1e-2, 2e-3};
    double want[PILE_STATES], y[PILE_STATES], error[COUNT(dt)];
    reach(even, masses, "event", TRIBO_CONSISTENT, 1.0, 1e-10, want);
    for (size_t k = 0; k < COUNT(dt); k++) {
        reach(even, masses, "rk4/fixed", TRIBO_CONSISTENT, dt[k], 0.0, y);
        error[k] = pile_distance(y, want);
    }
    require(error[0] <= 1e-3 && error[1] <= 2e-4, "ratio %g: errors %.3g, %.3g", masses, error[0], error[1]);
    require(order_of(dt, error, COUNT(dt)) >= 0.9, "ratio %g: errors %.3g, %.3g", masses, error[0], error[1]);
}

/* Equal masses: the same state, from farther away. A ratio of 1e6: nothing reports a failure, but light blocks are flung to where
 * no spring would let them go, five times as near with a fifth of the step. Uneven limits are a long case. */
TEST(partition)
{
    const int even = !_i;
    if (!even && !more()) {
        return;
    }
    const double dt[] = {1e-2, 2e-3};
    double want[PILE_STATES], y[PILE_STATES], error[COUNT(dt)];
    reach(even, 1.0, "event", TRIBO_CONSISTENT, 1.0, 1e-10, want);
    for (size_t k = 0; k < COUNT(dt); k++) {
        reach(even, 1.0, "rk4/fixed", TRIBO_PARTITION, dt[k], 0.0, y);
        error[k] = pile_distance(y, want);
    }
    require(error[0] <= 0.1 && error[1] <= 2e-2, "errors %.3g, %.3g", error[0], error[1]);
    require(order_of(dt, error, COUNT(dt)) >= 0.9, "errors %.3g, %.3g", error[0], error[1]);

    reach(even, 1e6, "event", TRIBO_CONSISTENT, 1.0, 1e-10, want);
    for (size_t k = 0; k < COUNT(dt); k++) {
        reach(even, 1e6, "rk4/fixed", TRIBO_PARTITION, dt[k], 0.0, y);
        error[k] = pile_distance(y, want);
    }
    require(error[0] >= 100.0 && error[1] >= 10.0, "errors %.3g, %.3g", error[0], error[1]);
}

TEST_MAIN("stack", {event_and_exact_agree, 2 * (int)COUNT(ratio)}, {consistent_converges, 4}, {partition, 2})
