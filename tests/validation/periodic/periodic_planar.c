/* SPDX-License-Identifier: BSD-3-Clause */
/* Periodic motions of planar contacts: a circle in closed form, and multipliers by differences of motions. */
#include "make.h"
#include "run.h"

enum { MOST = 6 };

static const double identity[4] = {1.0, 0.0, 0.0, 1.0};

/* A force of size 1 that turns at w = 0.6 on a mass of 1: a circle of radius sqrt(1 - N^2)/(1 - w^2), behind by asin(N), whose
 * friction takes 2 pi N radius a period; two multipliers of a motion that turns with the load. */
TEST(whirl)
{
    const double w = 0.6, limit = 0.3, radius = sqrt(1.0 - limit * limit) / (1.0 - w * w), lag = asin(limit);
    const double bound[2] = {limit, limit}, c[4] = {1.0, 0.0, 0.0, 0.0};
    double y[5] = {0.0}, re[4], im[4], energy[2], stick[2], least, most, cosine, sine;
    tribo_system *s;
    assert_ok(dense_system(&s, 2, 2, identity, NULL, identity, identity, 0, NULL, 0));
    assert_ok(tribo_set_planar(tribo_system_context(s), 1, (const size_t[]){0}));
    assert_ok(tribo_set_limit(tribo_system_context(s), bound));
    assert_ok(tribo_system_add_load(s, w, (const double[]){1.0, 0.0}, (const double[]){0.0, 1.0}));
    tribo_driver *d = driver_create(s, _i ? "auto" : "event", 1e-3, 0.0);
    const int status = tribo_driver_find_periodic(d, 0.0, 2.0 * PI / w, y);
    require(!status, "%s", tribo_driver_message(d));
    assert_close(y[0], radius * cos(lag), 1e-10);
    assert_close(y[1], -radius * sin(lag), 1e-10);
    assert_close(y[2], radius * w * sin(lag), 1e-10);
    assert_close(y[3], radius * w * cos(lag), 1e-10);
    assert_ok(tribo_driver_period_dissipation(d, energy));
    assert_close(energy[0], PI * limit * radius, 1e-9);
    assert_close(energy[1], PI * limit * radius, 1e-9);
    assert_ok(tribo_driver_period_stick(d, stick));
    assert_exact(stick[0], 0.0);
    assert_ok(tribo_driver_period_extremes(d, c, &least, &most, NULL, NULL));
    assert_close(most, radius, 1e-10);
    assert_close(least, -radius, 1e-10);
    assert_ok(tribo_driver_period_harmonic(d, c, 1, &cosine, &sine));
    assert_close(hypot(cosine, sine), radius, 1e-10);
    /* in a frame that turns with the load the equations have constant coefficients: the product of all multipliers is that of the
     * damping N/|v| across the velocity, along it there is none */
    assert_ok(tribo_driver_get_multipliers(d, re, im));
    double product = 1.0;
    for (size_t i = 0; i < 4; i++) {
        product *= hypot(re[i], im[i]);
    }
    assert_close(product, exp(-limit / (radius * w) * 2.0 * PI / w), 1e-9);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* On a line the planar contact is the scalar one, Den Hartog's: amplitude, and two of the multipliers. */
TEST(line)
{
    const double w = 0.7, bound[2] = {0.3, 0.3}, c[4] = {0.6, 0.8, 0.0, 0.0};
    double y[5] = {0.0}, re[4], im[4], least, most, off = HUGE_VAL;
    tribo_system *s;
    assert_ok(dense_system(&s, 2, 2, identity, NULL, identity, identity, 0, NULL, 0));
    assert_ok(tribo_set_planar(tribo_system_context(s), 1, (const size_t[]){0}));
    assert_ok(tribo_set_limit(tribo_system_context(s), bound));
    assert_ok(tribo_system_add_load(s, w, (const double[]){0.6, 0.8}, NULL));
    tribo_driver *d = driver_create(s, "event", 0.0, 0.0);
    const int status = tribo_driver_find_periodic(d, 0.0, 2.0 * PI / w, y);
    require(!status, "%s", tribo_driver_message(d));
    assert_ok(tribo_driver_period_extremes(d, c, &least, &most, NULL, NULL));
    assert_close(most, 1.8856998504, 1e-9);
    assert_ok(tribo_driver_get_multipliers(d, re, im));
    for (size_t i = 0; i < 4; i++) {
        off = fmin(off, hypot(re[i] + 0.4533657390, im[i] - 0.2331451411));
    }
    assert_close(off, 0.0, 1e-8);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* One to three masses with planar contacts, with each other for every third seed, some with ellipses; two harmonics of a period.
 * wide: limits of a hundredth to three: some contacts turn within 1e-6 while others rest, and squares of their series
 * overflow. */
static tribo_system *coupled(uint64_t seed, int wide, size_t *ndof, double *period)
{
    uint64_t s = seed * 7919u + 12345u;
    between(&s, 0.0, 1.0);
    const size_t planar = 1 + (size_t)between(&s, 0.0, 3.0), n = 2 * planar;
    double mass[MOST * MOST] = {0.0}, damping[MOST * MOST] = {0.0}, stiff[MOST * MOST] = {0.0}, j[MOST * MOST] = {0.0},
                       limit[MOST];
    for (size_t i = 0; i < n; i++) {
        mass[i * n + i] = between(&s, 0.5, 1.5);
        stiff[i * n + i] += between(&s, 0.3, 1.3);
        damping[i * n + i] = between(&s, 0.02, 0.05);
        limit[i] = wide ? pow(10.0, between(&s, -1.5, 0.5))
                        : (seed % 4 == 3 ? 0.2
                           : seed % 2    ? 1.6
                                         : 0.8) *
                              between(&s, 0.5, 1.2);
        j[i * n + i] = 1.0;
        for (size_t k = 0; k < i; k++) {
            const double spring = between(&s, 0.0, 1.0) < 0.5 ? between(&s, 0.0, 0.3) : 0.0;
            stiff[i * n + i] += spring;
            stiff[k * n + k] += spring;
            stiff[i * n + k] = stiff[k * n + i] = -spring;
            mass[i * n + k] = mass[k * n + i] = between(&s, -0.06, 0.06);
        }
        if (seed % 3 == 1 && i >= 2) {
            j[i * n + i - 2] = -1.0;
        }
        limit[i] = i % 2 && seed % 2 ? limit[i - 1] : limit[i];
    }
    tribo_system *sys;
    assert_ok(dense_system(&sys, n, n, mass, damping, stiff, j, 0, NULL, 0));
    assert_ok(tribo_set_planar(tribo_system_context(sys), planar, (const size_t[]){0, 2, 4}));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    const double omega = between(&s, 0.3, 1.3);
    for (int h = 1; h < 3; h++) {
        double cosine[MOST], sine[MOST];
        for (size_t i = 0; i < n; i++) {
            cosine[i] = between(&s, -1.0, 1.0);
            sine[i] = between(&s, -1.2, 1.2);
        }
        assert_ok(tribo_system_add_load(sys, h * omega, cosine, sine));
    }
    *ndof = n;
    *period = 2.0 * PI / omega;
    return sys;
}

/* Traces of the map over a period, and of its square. sticks: the first contact rests for a part of the period. */
TEST(multipliers)
{
    static const struct {
        uint64_t seed;
        int sticks, wide;
    } scene[] = {{0, 0, 0},  {3, 0, 0},   {5, 1, 0},  {9, 1, 0},  {13, 1, 0},
                 {17, 1, 0}, {122, 0, 1}, {24, 0, 1}, {60, 0, 1}, {92, 0, 1}};
    size_t n;
    double y[2 * MOST + 1] = {0.0}, period, stick[MOST];
    tribo_system *sys = coupled(scene[_i].seed, scene[_i].wide, &n, &period);
    tribo_driver *d = driver_create(sys, "event", 0.0, 0.0);
    const int status = tribo_driver_find_periodic(d, 0.0, period, y);
    require(!status, "%d: %s", _i, tribo_driver_message(d));
    assert_ok(tribo_driver_period_stick(d, stick));
    /* motions after stops in the plane have rounding of 1e-11 */
    assert_traces(d, 2 * n, 0.0, period, y, 1e-5, 1e-6);
    require(!scene[_i].sticks || (stick[0] > 0.05 && stick[0] < 1.0), "at rest for %g", stick[0]);
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

TEST_MAIN("periodic_planar", {whirl, 2}, {line, 1}, {multipliers, 10})
