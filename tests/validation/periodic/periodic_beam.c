/* SPDX-License-Identifier: BSD-3-Clause */
/* The finite-element beam with a friction damper, at 4 frequencies and 33 limits: every periodic motion is found, from zeros and
 * from its neighbour, with little work, and dissipates what marching to rest does. */
#include "run.h"

#include <stdlib.h>
#include <string.h>

#include "beam.h"

#define LIMITS 33

static double limit_of(int i)
{
    return 1e-4 * pow(1e4, i / (LIMITS - 1.0));
}

/* The first resonance, beside it, and the second. */
static double frequency(const tribo_system *sys, int which)
{
    double omega[BEAM_MODES];
    const double of_first[] = {1.0, 1.1, 0.9};
    assert_ok(tribo_system_get_frequencies(sys, omega));
    return which < 3 ? of_first[which] * omega[0] : omega[1];
}

static int ascending(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a, y = *(const size_t *)b;
    return (x > y) - (x < y);
}

/* Energy norm of a difference of reduced states. */
static double apart(const double *omega, const double *a, const double *b)
{
    double sum = 0.0;
    for (size_t k = 0; k < BEAM_MODES; k++) {
        const double q = omega[k] * (a[k] - b[k]), u = a[BEAM_MODES + k] - b[BEAM_MODES + k];
        sum += q * q + u * u;
    }
    return sqrt(sum);
}

static void check_return(tribo_system *sys, double period, const double *y)
{
    double z[BEAM_STATES], zero[BEAM_STATES] = {0}, omega[BEAM_MODES], t = 0.0;
    memcpy(z, y, sizeof z);
    tribo_driver *drv = driver_create(sys, "exact", period, 0.0);
    driver_advance(drv, &t, period, z);
    tribo_driver_destroy(drv);
    assert_ok(tribo_system_get_frequencies(sys, omega));
    /* at least what the load makes of the beam at rest counts */
    assert_close(apart(omega, z, y), 0.0, 1e-10 * fmax(2.0 * apart(omega, y, zero), 1e-5));
}

/* Loop test: _i / 2 is the frequency, _i % 2 whether searches begin at their neighbour. */
TEST(sweep)
{
    size_t work[LIMITS], before = 0;
    double y[BEAM_STATES] = {0};
    tribo_system *sys = beam_with_contacts(0.0);
    const double omega = frequency(sys, _i / 2), period = 2.0 * PI / omega;
    beam_add_load(sys, omega);
    tribo_driver *drv = driver_create(sys, "exact", period, 0.0);
    for (int i = 0; i < LIMITS; i++) {
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), limit_of(i)));
        if (_i % 2 == 0) {
            memset(y, 0, sizeof y);
        }
        const int status = tribo_driver_find_periodic(drv, 0.0, period, y);
        require(!status, "limit %g: %s", limit_of(i), tribo_driver_message(drv));
        work[i] = driver_count(drv, TRIBO_COUNT_PERIODS) - before;
        before += work[i];
        check_return(sys, period, y);
    }
    qsort(work, LIMITS, sizeof *work, ascending);
    require(work[LIMITS / 2] <= 6 && work[LIMITS - 1] <= 40, "%zu periods of work in the median, %zu at most", work[LIMITS / 2],
            work[LIMITS - 1]);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Marching in the first resonance: 0.2% of damping take 2000 periods. */
TEST(marching)
{
    const int points[] = {8, 14, 18, 22, 24};
    tribo_system *sys = beam_with_damper(limit_of(points[_i]));
    const double period = 2.0 * PI / frequency(sys, 0);
    double y[BEAM_STATES] = {0}, z[BEAM_STATES] = {0}, energy[3], t = 0.0;
    tribo_driver *drv = driver_create(sys, "exact", period, 0.0);
    assert_ok(tribo_driver_find_periodic(drv, 0.0, period, y));
    assert_ok(tribo_driver_period_dissipation(drv, energy));
    const double sum = energy[0] + energy[1] + energy[2];
    for (int k = 1; k <= 2500; k++) {
        z[2 * BEAM_MODES] = 0.0;
        driver_advance(drv, &t, k * period, z);
    }
    require(sum > 0.0, "nothing slides");
    assert_close(z[2 * BEAM_MODES] / sum, 1.0, 1e-9);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* By "event", whose tolerances may be coarse: the motions come back on "exact", and need no more work; of contacts
 * that slip, and of such that stay stuck. Loop test: _i / 4 is the tolerance, _i % 4 the frequency. */
TEST(coarse_tolerances)
{
    const double tolerance[] = {1e-4, 1e-6, 1e-9};
    tribo_system *sys = beam_with_contacts(0.0);
    const double omega = frequency(sys, _i % 4), period = 2.0 * PI / omega;
    beam_add_load(sys, omega);
    tribo_driver *drv = driver_create(sys, "event", period, tolerance[_i / 4]);
    for (int i = 4; i <= 36; i += 8) {
        double y[BEAM_STATES] = {0};
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), limit_of(i)));
        const int status = tribo_driver_find_periodic(drv, 0.0, period, y);
        require(!status, "limit %g: %s", limit_of(i), tribo_driver_message(drv));
        check_return(sys, period, y);
    }
    const size_t work = driver_count(drv, TRIBO_COUNT_PERIODS);
    require(work <= 80, "%zu periods", work);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST_MAIN("periodic_beam", {sweep, 8}, {coarse_tolerances, 12}, {marching, 5})
