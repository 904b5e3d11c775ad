/* SPDX-License-Identifier: BSD-3-Clause */
/* Nonlinear modes: reference values of an oscillator with an elastic contact; modes of structures beside the motion of a
 * structure with the damping C - 2 delta M; a backbone of the beam; what is refused. */
#include "beam.h"
#include "run.h"

#include <string.h>

static const char *const methods[] = {"exact", "event", "auto"};

static void find_mode(tribo_driver *d, const double *c, double amplitude, double *omega, double *zeta, double *y)
{
    const int status = tribo_driver_find_mode(d, c, amplitude, omega, zeta, y);
    require(!status, "amplitude %g: %s", amplitude, tribo_driver_message(d));
}

/* m = k = kt = 1, limit 0.5: closed pieces, by an adaptive integrator of another code to 1e-13. From the linear mode; then from
 * the mode of the amplitude before. Energy of friction 4 N (X - N/kt). */
TEST(jenkins)
{
    static const double amplitude[] = {0.3, 0.6, 1.0, 2.0};
    static const double values[][2] = {{1.4142135623731, 0.0},
                                       {1.3747608670481, 0.046412663224},
                                       {1.2258676901977, 0.105752880426},
                                       {1.0935981120212, 0.101057277142}};
    const double one = 1.0, soft = 1.0, c[] = {1.0, 0.0}, swing[] = {0.3, 0.0};
    tribo_model *model = dense_model(1, 1, &one, NULL, &one, &one);
    assert_ok(tribo_model_set_compliance(model, &soft));
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.5));
    assert_ok(tribo_system_add_load(sys, 0.7, swing, NULL)); /* does not act */
    tribo_driver *drv = driver_create(sys, methods[_i % 3], 1e-3, 1e-13);
    double y[4] = {0.0}, omega = 0.0, zeta = 0.0, least, most, energy;
    for (int k = 0; k < 4; k++) {
        if (_i < 3) {
            memset(y, 0, sizeof y);
            omega = zeta = 0.0;
        }
        find_mode(drv, c, amplitude[k], &omega, &zeta, y);
        assert_close(omega, values[k][0], 1e-11);
        assert_close(zeta, values[k][1], 1e-11);
        assert_close(y[0], amplitude[k], 1e-12);
        assert_close(y[1], 0.0, 1e-12);
        assert_exact(y[3], 0.0);
        assert_ok(tribo_driver_period_extremes(drv, c, &least, &most, NULL, NULL));
        assert_close(most, amplitude[k], 1e-11);
        assert_close(least, -amplitude[k], 1e-11);
        assert_ok(tribo_driver_period_dissipation(drv, &energy));
        assert_close(energy, 4.0 * 0.5 * fmax(amplitude[k] - 0.5, 0.0), 1e-11);
        const int kind = TRIBO_PARAMETER_LIMIT;
        const size_t contact = 0;
        assert_status(tribo_driver_period_derivatives(drv, 1, &kind, &contact, NULL, NULL, &energy, NULL), TRIBO_ERR_UNSUPPORTED);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Two masses between springs, damped; the first contact has this compliance, the second is rigid, soft[2] > 0: or a spring before
 * it. less: delta that is taken from the damping. preload: normal load of a contact under the second mass, 0: constant limits. */
static tribo_system *masses(double soft, double less, double preload)
{
    const double mass[] = {1.0, 0.0, 0.0, 2.0}, stiffness[] = {5.0, -2.0, -2.0, 4.0}, direction[] = {1.0, 0.0, -1.0, 1.0};
    const double damping[] = {0.05 - 2.0 * less, -0.01, -0.01, 0.06 - 4.0 * less}, compliance[] = {soft, 0.0};
    const double load[] = {0.0, preload}, limit[] = {0.3, 0.1};
    tribo_model *model = dense_model(2, 2, mass, damping, stiffness, direction);
    assert_ok(tribo_model_set_compliance(model, compliance));
    if (preload > 0.0) {
        assert_ok(tribo_model_set_normal(model, 0, 1, 0.4, 3.0, 0.0));
    }
    tribo_system *sys = finish_model(model);
    if (preload > 0.0) {
        assert_ok(tribo_system_add_load(sys, 0.0, load, NULL));
    } else {
        assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    }
    return sys;
}

/* A structure with the damping C - 2 delta M comes back after 2 pi/omega from the state found, where the signal has the amplitude
 * and no rate. Signals of displacements, and of velocities; from zeros and both linear frequencies. */
TEST(structures)
{
    static const double signals[][4] = {{1.0, 0.0, 0.0, 0.0}, {0.5, 1.0, 0.0, 0.0}, {0.0, 0.0, 0.3, 1.0}, {0.2, 0.3, 0.4, 0.0}};
    const int by_load = _i % 12 >= 8, elastic = _i % 12 < 4 || by_load;
    const double *c = signals[by_load ? _i % 2 : _i % 4], preload = by_load ? 2.0 : 0.0;
    tribo_system *sys = masses(elastic ? 0.2 : 0.0, 0.0, preload);
    tribo_driver *drv = driver_create(sys, by_load ? "event" : methods[_i / 12], 1e-3, 1e-13);
    for (int k = 0; k < 4; k++) {
        const double amplitude = by_load ? 0.9 + 0.2 * k : 0.5 + 0.4 * k;
        double y[6] = {0.0}, z[6], omega = k % 2 ? 2.6 : 0.0, zeta = 0.0, t = 0.0, re[5], im[5];
        const size_t n = elastic ? 5 : 4;
        find_mode(drv, c, amplitude, &omega, &zeta, y);
        tribo_system *other = masses(elastic ? 0.2 : 0.0, zeta * omega, preload);
        tribo_driver *march = driver_create(other, "event", 1e-3, 1e-13);
        assert_close(c[0] * y[0] + c[1] * y[1] + c[2] * y[2] + c[3] * y[3], amplitude, 1e-10);
        memcpy(z, y, sizeof z);
        driver_advance(march, &t, 2.0 * acos(-1.0) / omega, z);
        for (size_t i = 0; i < n; i++) {
            assert_close(z[i], y[i], 1e-9);
        }
        /* the rate of the signal */
        double least, most;
        assert_ok(tribo_driver_period_extremes(drv, c, &least, &most, NULL, NULL));
        if (!by_load) {
            assert_close(most, amplitude, 1e-8);
            assert_close(least, -amplitude, 1e-8);
        }
        assert_ok(tribo_driver_get_multipliers(drv, re, im));
        double nearest = HUGE_VAL;
        for (size_t i = 0; i < n; i++) {
            nearest = fmin(nearest, hypot(re[i] - 1.0, im[i]));
        }
        require(nearest < 1e-6, "no multiplier is 1: off by %g", nearest);
        tribo_driver_destroy(march);
        tribo_system_destroy(other);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* The first mode of the beam at 60 amplitudes, each from the one before, up and down: the same ones, also on springs so stiff
 * that searches have to shorten their steps, which takes 10 periods a mode. At small amplitudes contacts stick, and frequency
 * and damping are constant; at large ones they slide, and what they dissipate, 4 limit amplitude, makes zeta fall with
 * 1/amplitude to that of the structure. */
TEST(backbone)
{
    enum { AMPLITUDES = 60 };
    const double limit = 1e-2;
    tribo_system *sys = beam_with_springs(_i < 2 ? 0.3 : 0.1, limit);
    tribo_driver *drv = driver_create(sys, methods[_i % 2], 1e-3, 1e-13);
    double c[2 * BEAM_MODES] = {1.0}, natural[BEAM_MODES], y[BEAM_STATES + 3] = {0.0}, omega = 0.0, zeta = 0.0;
    double up[AMPLITUDES][2];
    size_t periods;
    assert_ok(tribo_system_get_frequencies(sys, natural));
    for (int k = 0; k < 2 * AMPLITUDES; k++) {
        const int at = k < AMPLITUDES ? k : 2 * AMPLITUDES - 1 - k;
        const double amplitude = limit / (natural[0] * natural[0]) * pow(10.0, 0.1 * at - 1.0);
        find_mode(drv, c, amplitude, &omega, &zeta, y);
        if (k < AMPLITUDES) {
            up[at][0] = omega;
            up[at][1] = zeta;
        } else {
            assert_close(omega / up[at][0], 1.0, 1e-9);
            assert_close(zeta, up[at][1], 1e-9);
        }
    }
    assert_close(up[10][0] / up[0][0], 1.0, 1e-9);
    assert_close(up[10][1], up[0][1], 1e-9);
    assert_close(up[AMPLITUDES - 1][0] / natural[0], 1.0, 1e-3);
    const double fell = (up[AMPLITUDES - 2][1] - 0.002) / (up[AMPLITUDES - 1][1] - 0.002);
    assert_close(fell, pow(10.0, 0.1), 0.01);
    require(up[34][1] > 0.05, "damping %g", up[34][1]);
    assert_ok(tribo_driver_count(drv, TRIBO_COUNT_PERIODS, &periods));
    require(periods < 12 * 2 * AMPLITUDES, "%zu periods", periods);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST(refused)
{
    tribo_system *sys = masses(0.0, 0.0, _i ? 2.0 : 0.0);
    tribo_driver *drv = driver_create(sys, "event", 1e-3, 1e-13), *steps = driver_create(sys, "moreau/fixed", 1e-3, 0.0);
    const double c[] = {1.0, 0.0, 0.0, 0.0}, none[4] = {0.0}, bad[] = {0.0, NAN, 0.0, 0.0}, fast[] = {0.0, 0.0, 1.0, 0.0};
    double y[6] = {0.1, 0.2}, start[6], omega = 2.0, zeta = 0.01, less = -1.0, nan = NAN;
    memcpy(start, y, sizeof y);
    assert_status(tribo_driver_find_mode(NULL, c, 1.0, &omega, &zeta, y), TRIBO_ERR_NULL);
    assert_status(tribo_driver_find_mode(drv, NULL, 1.0, &omega, &zeta, y), TRIBO_ERR_NULL);
    assert_status(tribo_driver_find_mode(drv, c, 1.0, NULL, &zeta, y), TRIBO_ERR_NULL);
    assert_status(tribo_driver_find_mode(drv, c, 1.0, &omega, NULL, y), TRIBO_ERR_NULL);
    assert_status(tribo_driver_find_mode(drv, c, 1.0, &omega, &zeta, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_driver_find_mode(drv, c, 0.0, &omega, &zeta, y), TRIBO_ERR_NOT_POSITIVE);
    assert_status(tribo_driver_find_mode(drv, c, 1.0, &less, &zeta, y), TRIBO_ERR_NOT_POSITIVE);
    assert_status(tribo_driver_find_mode(drv, c, 1.0, &nan, &zeta, y), TRIBO_ERR_NOT_FINITE);
    assert_says(tribo_driver_message(drv), "omega = nan is not finite");
    assert_status(tribo_driver_find_mode(drv, bad, 1.0, &omega, &zeta, y), TRIBO_ERR_NOT_FINITE);
    assert_says(tribo_driver_message(drv), "c[");
    assert_status(tribo_driver_find_mode(drv, none, 1.0, &omega, &zeta, y), TRIBO_ERR_RANGE);
    assert_says(tribo_driver_message(drv), "c is 0");
    assert_status(tribo_driver_find_mode(steps, c, 1.0, &omega, &zeta, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(steps), "method moreau/fixed finds no modes");
    if (_i) {
        assert_status(tribo_driver_find_mode(drv, fast, 1.0, &omega, &zeta, y), TRIBO_ERR_UNSUPPORTED);
    } else {
        assert_ok(tribo_system_add_limit(sys, 1.5, c, NULL));
        assert_status(tribo_driver_find_mode(drv, c, 1.0, &omega, &zeta, y), TRIBO_ERR_UNSUPPORTED);
        assert_says(tribo_driver_message(drv), "limits that do not depend on time");
    }
    assert_all_exact(y, start, 6);
    assert_exact(omega, 2.0);
    assert_exact(zeta, 0.01);
    tribo_driver_destroy(steps);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* A structure of so much damping that its linear modes do not vibrate, from zeros and from a guess: no mode is found, and the
 * arguments are unchanged. */
TEST(overdamped)
{
    tribo_system *sys = masses(0.2, -4.0, 0.0);
    tribo_driver *drv = driver_create(sys, methods[_i % 3], 1e-3, 1e-13);
    const double c[] = {1.0, 0.0, 0.0, 0.0};
    double y[6] = {_i < 3 ? 0.0 : 0.5}, start[6], omega = _i < 3 ? 0.0 : 2.0, zeta = _i < 3 ? 0.0 : 3.0;
    const double given[] = {omega, zeta};
    memcpy(start, y, sizeof y);
    assert_status(tribo_driver_find_mode(drv, c, 1.0, &omega, &zeta, y), TRIBO_ERR_NO_CONVERGENCE);
    assert_says(tribo_driver_message(drv), "no mode was found");
    assert_all_exact(y, start, 6);
    assert_exact(omega, given[0]);
    assert_exact(zeta, given[1]);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST_MAIN("modes", {jenkins, 6}, {structures, 36}, {refused, 2}, {backbone, 3}, {overdamped, 6})
