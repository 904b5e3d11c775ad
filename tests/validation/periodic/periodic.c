/* SPDX-License-Identifier: BSD-3-Clause */
/* Periodic motions against closed forms: Den Hartog's oscillator (1931) and what follows from it. */
#include "make.h"
#include "search.h"

#include <string.h>

static const char *const methods[] = {"exact", "event", "auto"};

/* ------------------------------------------------------------------------------------------------------ one oscillator */

static const struct {
    double beta, r, x0, stops;
} hartog[] = {{0.6, 0.3, 1.5356018093, 0.531513}, {0.7, 0.3, 1.8856998504, 0.722071}, {0.8, 0.4, 2.5017878810, 0.817406}};

/* Amplitude; 4 N x0 a period are dissipated, which is what the load does, pi F times the sine of the motion. */
TEST(den_hartog)
{
    const double one[] = {1.0, 0.0}, n = hartog[_i / 2].r;
    struct search s = oscillator_search(methods[_i % 2], 0.0, n, 1.0, hartog[_i / 2].beta);
    double y[3] = {0}, energy, share, cosine, sine;
    find(&s, 0.0, y);
    assert_exact(y[2], 0.0);
    const double x0 = amplitude(&s, 0);
    assert_close(x0, hartog[_i / 2].x0, 1e-9);
    assert_ok(tribo_driver_period_dissipation(s.drv, &energy));
    assert_close(energy, 4.0 * n * x0, 1e-9);
    assert_close(dissipated(&s, y), energy, 1e-9);
    assert_ok(tribo_driver_period_stick(s.drv, &share));
    assert_exact(share, 0.0);
    assert_ok(tribo_driver_period_harmonic(s.drv, one, 1, &cosine, &sine));
    assert_close(PI * sine, energy, 1e-9);
    assert_ok(tribo_driver_period_harmonic(s.drv, one, 0, &cosine, &sine));
    assert_close(cosine, 0.0, 1e-9);
    search_free(&s);
}

/* Below a limit there are no stops, and above it there are. */
TEST(stops)
{
    for (int above = 0; above < 2; above++) {
        struct search s =
            oscillator_search(methods[_i % 2], 0.0, hartog[_i / 2].stops + (above ? 2e-6 : -2e-6), 1.0, hartog[_i / 2].beta);
        double y[3] = {0}, share;
        find(&s, 0.0, y);
        assert_ok(tribo_driver_period_stick(s.drv, &share));
        require(above ? share > 0.0 : share == 0.0, "%g of the period at rest", share);
        search_free(&s);
    }
}

TEST(multipliers)
{
    struct search s = oscillator_search(methods[_i], 0.0, 0.3, 1.0, 0.7);
    double y[3] = {0}, re[2], im[2];
    find(&s, 0.0, y);
    assert_ok(tribo_driver_get_multipliers(s.drv, re, im));
    assert_close(re[0], -0.4533657390, 1e-8);
    assert_close(re[1], -0.4533657390, 1e-8);
    assert_close(im[0], 0.2331451411, 1e-8);
    assert_close(im[1], -0.2331451411, 1e-8);
    search_free(&s);
}

/* beta = 1/(2n): the amplitude does not depend on the limit, and motions form a family. A guess in it is kept. */
TEST(family)
{
    const double beta = 1.0 / (2.0 * (1 + _i / 2));
    struct search s = oscillator_search(methods[_i % 2], 0.0, 0.05, 1.0, beta);
    double y[3] = {0}, re[2], im[2];
    find(&s, 0.0, y);
    assert_close(amplitude(&s, 0), 1.0 / (1.0 - beta * beta), 1e-9);
    assert_ok(tribo_driver_get_multipliers(s.drv, re, im));
    assert_close(re[0], 1.0, 1e-8);
    require(driver_freedom(s.drv) == 1, "%zu free directions", driver_freedom(s.drv));
    search_free(&s);
}

/* Its motions that stop where the period begins, but for rounding, have the multipliers of a later beginning. */
TEST(begins_at_stop)
{
    const double beta = 1.0 / (2.0 * (1 + _i / 2));
    struct search s = oscillator_search(methods[_i % 2], 0.0, 0.05, 1.0, beta);
    for (int k = -1; k < 2; k++) {
        double y[3] = {1.0 / (1.0 - beta * beta), 1e-13 * k}, z[3], re[2], im[2], want[2], t = 0.0;
        find(&s, 0.0, y);
        assert_close(y[1], 0.0, 2e-13);
        assert_ok(tribo_driver_get_multipliers(s.drv, re, im));
        require(driver_freedom(s.drv) == 1, "%zu free directions", driver_freedom(s.drv));
        memcpy(z, y, sizeof z);
        driver_advance(s.drv, &t, 0.3, z);
        find(&s, 0.3, z);
        assert_ok(tribo_driver_get_multipliers(s.drv, want, im));
        assert_all_close(re, want, 2, 1e-9);
    }
    search_free(&s);
}

TEST(viscous_damping)
{
    struct search s = oscillator_search(methods[_i], 0.1, 1.0, 1.5, 0.9);
    double y[3] = {0};
    find(&s, 0.0, y);
    assert_close(amplitude(&s, 0), 2.420236350574, 1e-11);
    search_free(&s);
}

/* At a later time: the same motion. */
TEST(later)
{
    struct search s = oscillator_search(methods[_i], 0.1, 1.0, 1.5, 0.9);
    double y[3] = {0}, z[3] = {0}, t = 0.0;
    find(&s, 0.0, y);
    driver_advance(s.drv, &t, 2.5, y);
    find(&s, 2.5 + 100.0 * s.period, z);
    assert_all_close(z, y, 2, 1e-9);
    search_free(&s);
}

/* A multiple of the period has the same motion; its multipliers are powers. */
TEST(multiple)
{
    struct search s = oscillator_search(methods[_i], 0.0, 0.3, 1.0, 0.7);
    double y[3] = {0}, z[3] = {0}, re[2], im[2], re2[2], im2[2];
    find(&s, 0.0, y);
    assert_ok(tribo_driver_get_multipliers(s.drv, re, im));
    s.period *= 2.0;
    find(&s, 0.0, z);
    assert_ok(tribo_driver_get_multipliers(s.drv, re2, im2));
    assert_all_close(z, y, 2, 1e-9);
    assert_close(re2[0], re[0] * re[0] - im[0] * im[0], 1e-8);
    assert_close(im2[0], fabs(2.0 * re[0] * im[0]), 1e-8);
    search_free(&s);
}

/* Limit above the load: at rest for good, where the guess is; zeros stay zeros. */
TEST(stuck)
{
    struct search s = oscillator_search(methods[_i], 0.1, 2.0, 1.0, 0.7);
    double y[3] = {0}, z[3] = {0.4, 0.0, 3.0}, re[2], im[2], share, least, most;
    const double velocity[] = {0.0, 1.0};
    find(&s, 0.0, y);
    assert_all_exact(y, ((double[]){0.0, 0.0, 0.0}), 3);
    find(&s, 0.0, z);
    assert_all_close(z, ((double[]){0.4, 0.0, 0.0}), 3, 1e-12);
    assert_ok(tribo_driver_get_multipliers(s.drv, re, im));
    assert_close(re[0], 1.0, 1e-12);
    assert_close(re[1], 0.0, 1e-12);
    assert_close(im[0], 0.0, 1e-12);
    require(driver_freedom(s.drv) == 1, "%zu free directions", driver_freedom(s.drv));
    assert_ok(tribo_driver_period_stick(s.drv, &share));
    assert_close(share, 1.0, 1e-14);
    assert_ok(tribo_driver_period_extremes(s.drv, velocity, &least, &most, NULL, NULL));
    assert_close(most - least, 0.0, 1e-14);
    search_free(&s);
}

/* Limit 0: the linear response. */
TEST(open)
{
    const double damping = 0.2, omega = 1.3, re = 1.0 - omega * omega, im = damping * omega, c[] = {1.0, 0.0};
    struct search s = oscillator_search(methods[_i], damping, 0.0, 1.5, omega);
    double y[3] = {0.1, 0.2, 0.0}, cosine, sine;
    find(&s, 0.0, y);
    assert_close(amplitude(&s, 0), 1.5 / hypot(re, im), 1e-12);
    assert_ok(tribo_driver_period_harmonic(s.drv, c, 1, &cosine, &sine));
    assert_close(cosine, 1.5 * re / (re * re + im * im), 1e-12);
    assert_close(sine, 1.5 * im / (re * re + im * im), 1e-12);
    assert_ok(tribo_driver_period_harmonic(s.drv, c, 3, &cosine, &sine));
    assert_close(hypot(cosine, sine), 0.0, 1e-12);
    require(driver_count(s.drv, TRIBO_COUNT_PERIODS) <= 3, "%zu periods", driver_count(s.drv, TRIBO_COUNT_PERIODS));
    search_free(&s);
}

/* Extremes are where the velocity is zero, at times of the period that was asked for; of a linear motion, and of one
 * that stops. */
TEST(times_of_extremes)
{
    const double damping = 0.2, omega = 1.3, limit = _i / 2 ? 0.4 : 0.0, t = 40.0, c[] = {1.0, 0.0};
    struct search s = oscillator_search(methods[_i % 2], damping, limit, 1.5, omega);
    double y[3] = {0}, at[2], e[2], least, most, from = t;
    find(&s, t, y);
    assert_ok(tribo_driver_period_extremes(s.drv, c, &least, &most, NULL, NULL));
    assert_ok(tribo_driver_period_extremes(s.drv, c, &e[0], &e[1], &at[0], &at[1]));
    assert_exact(e[0], least);
    assert_exact(e[1], most);
    for (int i = 0; i < 2; i++) {
        const int k = at[0] < at[1] ? i : 1 - i; /* the earlier one first */
        require(at[k] >= t && at[k] <= t + s.period, "extreme %d at %g", k, at[k]);
        driver_advance(s.drv, &from, at[k], y);
        assert_close(y[0], e[k], 1e-9);
        assert_close(y[1], 0.0, 1e-9);
    }
    if (limit == 0.0) {
        const double turns = (omega * at[1] - atan2(damping * omega, 1.0 - omega * omega)) / (2.0 * PI);
        assert_close(turns, round(turns), 1e-11);
    }
    search_free(&s);
}

/* A constant load moves the middle, and takes the symmetry away. */
TEST(constant_load)
{
    const double one = 1.0, c[] = {1.0, 0.0};
    struct search s = oscillator_search(methods[_i], 0.1, 0.5, 2.0, 0.9);
    double y[3] = {0}, z[3], cosine, sine;
    find(&s, 0.0, y);
    memcpy(z, y, sizeof z);
    assert_ok(tribo_system_add_load(s.sys, 0.0, &one, NULL));
    find(&s, 0.0, z);
    assert_close(z[0], y[0] + 1.0, 1e-9);
    assert_close(z[1], y[1], 1e-9);
    assert_ok(tribo_driver_period_harmonic(s.drv, c, 0, &cosine, &sine));
    assert_close(cosine, 1.0, 1e-9);
    search_free(&s);
}

/* A body on a belt that moves to and fro, held by a spring: relative to the belt it is one that is shaken. */
TEST(belt)
{
    const double one = 1.0, zero = 0.0, omega = 0.7, speed = 0.8, c[] = {1.0, 0.0};
    struct search s = search_create(methods[_i], 1, 1, &one, NULL, &one, &one, omega, &zero);
    struct search shaken = oscillator_search(methods[_i], 0.0, 0.1, speed * (1.0 / omega - omega), omega);
    double y[3] = {0}, z[3] = {0}, energy[2], least, most;
    assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), 0.1));
    assert_ok(tribo_system_add_base_motion(s.sys, omega, NULL, &speed));
    find(&s, 0.0, y);
    find(&shaken, 0.0, z);
    /* x = belt + w, belt = -speed/omega cos(omega t); w'' + w = -(belt'' + belt) + f */
    assert_close(y[0], z[0] - speed / omega, 1e-9);
    assert_close(y[1], z[1], 1e-9);
    assert_ok(tribo_driver_period_dissipation(s.drv, &energy[0]));
    assert_ok(tribo_driver_period_dissipation(shaken.drv, &energy[1]));
    assert_close(energy[0], energy[1], 1e-9);
    assert_close(dissipated(&s, y), energy[0], 1e-9);
    assert_ok(tribo_driver_period_extremes(s.drv, c, &least, &most, NULL, NULL));
    require(most > 0.0, "nothing moves");
    search_free(&s);
    search_free(&shaken);
}

/* Limits that follow harmonics: even ones keep the symmetry of the motion, others do not; with lift-off, and on a belt that
 * moves. The motion comes back, as marching has it, and contacts dissipate what the state's energy says. */
TEST(swinging_limits)
{
    static const struct {
        double limit, cosine, sine, turns, belt;
    } scene[] = {{0.6, 0.0, 1.0, 1.0, 0.0}, {0.5, 0.3, 0.0, 2.0, 0.0}, {0.5, 0.2, -0.6, 2.0, 0.7}, {0.3, 0.0, 0.3, 1.0, 0.7}};
    const double limit = scene[_i / 2].limit, omega = 0.7, one[] = {1.0, 0.0};
    struct search s = oscillator_search(methods[_i % 2], 0.1, limit, 1.0, omega);
    double y[3] = {0}, z[3] = {0}, t = 0.0, energy, least, most;
    assert_ok(tribo_system_add_limit(s.sys, scene[_i / 2].turns * omega, &scene[_i / 2].cosine, &scene[_i / 2].sine));
    assert_ok(tribo_system_add_base_motion(s.sys, omega, NULL, &scene[_i / 2].belt));
    find(&s, 0.0, y);
    driver_advance(s.drv, &t, 60.0 * s.period, z);
    assert_close(z[0], y[0], 1e-9);
    assert_close(z[1], y[1], 1e-9);
    find(&s, 0.0, y);
    assert_ok(tribo_driver_period_dissipation(s.drv, &energy));
    assert_ok(tribo_driver_period_extremes(s.drv, one, &least, &most, NULL, NULL));
    ck_assert_int_eq(fabs(least + most) < 1e-9, scene[_i / 2].turns == 2.0);
    assert_close(dissipated(&s, y), energy, 1e-9);
    search_free(&s);
}

/* The determinant of the period map's derivative, by differences of motions that start apart from y. */
static double determinant(const struct search *s, const double *y)
{
    const double apart = 1e-5;
    double slope[2][2];
    for (int k = 0; k < 2; k++) {
        double z[2][3];
        for (int side = 0; side < 2; side++) {
            double t = 0.0;
            memcpy(z[side], y, sizeof z[side]);
            z[side][k] += side ? apart : -apart;
            driver_advance(s->drv, &t, s->period, z[side]);
        }
        slope[0][k] = (z[1][0] - z[0][0]) / (2.0 * apart);
        slope[1][k] = (z[1][1] - z[0][1]) / (2.0 * apart);
    }
    return slope[0][0] * slope[1][1] - slope[0][1] * slope[1][0];
}

/* Where a body reverses, the jump of its acceleration is twice the limit of that instant, not that of an earlier one. */
TEST(multipliers_of_swinging_limits)
{
    const double omega = 0.7, cosine = 0.04, sine = -0.08;
    struct search s = oscillator_search(methods[_i], 0.1, 0.15, 1.0, omega);
    double y[3] = {0}, re[2], im[2];
    assert_ok(tribo_system_add_limit(s.sys, 2.0 * omega, &cosine, &sine));
    find(&s, 0.0, y);
    assert_ok(tribo_driver_get_multipliers(s.drv, re, im));
    const double product = re[0] * re[1] - im[0] * im[1];
    require(fabs(product) > 0.05, "%g", product);
    assert_close(product, determinant(&s, y), 1e-7);
    search_free(&s);
}

/* Two blocks that move alike, each held by its own static limit; with_mass, with_damping: inertia, or damping, couples them. */
static struct search twins(const char *method, double with_mass, double with_damping, double limit)
{
    const double mass[] = {1.0, with_mass, with_mass, 1.0}, damping[] = {0.1, with_damping, with_damping, 0.1},
                 stiffness[] = {1.8, -0.3, -0.3, 1.8};
    const double direction[] = {1.0, 0.0, 0.0, 1.0}, force[] = {1.75, 1.75}, ratio[] = {1.3, 1.3};
    struct search s = search_create(method, 2, 2, mass, damping, stiffness, direction, 0.63, force);
    assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), limit));
    assert_ok(tribo_set_static(tribo_system_context(s.sys), ratio, NULL));
    return s;
}

/* The multipliers of the motion from y on, all contacts sliding there, have the trace of the map of a period, by differences. */
static void check_trace(const struct search *s, const double *y)
{
    const size_t n = 2 * s->ndof;
    const double apart = 1e-5;
    double re[MOST_STATES], im[MOST_STATES], sum = 0.0, trace = 0.0;
    assert_ok(tribo_driver_get_multipliers(s->drv, re, im));
    for (size_t k = 0; k < n; k++) {
        sum += re[k];
        for (int side = -1; side <= 1; side += 2) {
            double t = 0.0, z[MOST_STATES];
            memcpy(z, y, (n + 1) * sizeof *z);
            z[k] += side * apart;
            driver_advance(s->drv, &t, s->period, z);
            trace += side * z[k] / (2.0 * apart);
        }
    }
    assert_close(sum, trace, 1e-6);
}

/* Both lose their static limits at one instant; motions next to it have each do so at its own time. */
TEST(multipliers_of_twins)
{
    struct search s = twins(methods[_i], 0.0, 0.0, 0.6);
    double y[5] = {0};
    find(&s, 0.0, y);
    require(fabs(y[2]) > 0.1, "at rest");
    check_trace(&s, y);
    search_free(&s);
}

/* A chain whose halves mirror each other: where the outer blocks reverse, that pulls loose what holds the inner ones to them. */
TEST(multipliers_of_mirrored_halves)
{
    enum { N = 4 };
    double mass[N * N] = {0}, stiffness[N * N] = {0}, damping[N * N], y[2 * N + 1] = {0};
    const double direction[] = {1, -1, 0, 0, 0, 0, 1, -1, 1, 0, 0, 0, 0, 0, 0, 1}, force[] = {1, 1, -1, -1};
    for (size_t i = 0; i < N; i++) {
        mass[i * N + i] = 1.75;
        stiffness[i * N + i] = i == 0 || i == N - 1 ? 2.5 : 3.63;
        if (i > 0) {
            stiffness[i * N + i - 1] = stiffness[(i - 1) * N + i] = -1.13;
        }
    }
    for (size_t k = 0; k < N * N; k++) {
        damping[k] = 0.05 * mass[k] + 0.02 * stiffness[k];
    }
    struct search s = search_create(methods[_i], N, 4, mass, damping, stiffness, direction, 2.24, force);
    assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), 0.25));
    find(&s, 0.0, y);
    check_trace(&s, y);
    search_free(&s);
}

/* If inertia couples them, who breaks away first, or, where limits are low, reverses first, changes the other one's time; and if
 * damping does, who breaks away first changes how fast the other one's force rises. */
TEST(no_multipliers)
{
    const int reverses = _i / 2 == 1, damped = _i / 2 == 2;
    struct search s = twins(methods[_i % 2], damped ? 0.0 : 0.2, damped ? -0.05 : 0.0, reverses ? 0.02 : 0.6);
    double y[5] = {0}, re[4] = {7.0}, im[4], share[2];
    find(&s, 0.0, y);
    assert_status(tribo_driver_get_multipliers(s.drv, re, im), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(s.drv), "contact 0 and contact 1 ");
    assert_exact(re[0], 7.0);
    assert_ok(tribo_driver_period_stick(s.drv, share));
    require(reverses ? share[0] == 0.0 : share[0] > 0.0, "%g of the period at rest", share[0]);
    search_free(&s);
}

/* Blocks with two contacts each, of which one follows its swinging limit while the other one holds: both of them let go, on both
 * blocks at one instant. */
TEST(multipliers_of_pairs)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, damping[] = {0.3, 0.0, 0.0, 0.3}, stiffness[] = {3.0, -2.0, -2.0, 3.0},
                 direction[] = {1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0}, force[] = {1.0, -1.0}, limit[] = {0.1, 0.1, 0.25, 0.25},
                 swing[] = {0.04, 0.04, 0.1, 0.1}, ratio[] = {1.3, 1.3, 1.3, 1.3};
    struct search s = search_create(methods[_i], 2, 4, mass, damping, stiffness, direction, 0.65, force);
    double y[5] = {0}, share[4];
    assert_ok(tribo_set_limit(tribo_system_context(s.sys), limit));
    assert_ok(tribo_set_static(tribo_system_context(s.sys), ratio, NULL));
    assert_ok(tribo_system_add_limit(s.sys, 1.3, swing, NULL));
    find(&s, 0.0, y);
    check_trace(&s, y);
    assert_ok(tribo_driver_period_stick(s.drv, share));
    require(share[0] > 0.0 && share[0] < 1.0, "%g of the period at rest", share[0]);
    search_free(&s);
}

/* When block 0 reverses, and when block 1 loses its static limit, last. */
struct instants {
    tribo_system *sys;
    double reverses, goes;
};

static int note_instants(const tribo_moment *moment, void *data)
{
    const double t = moment->t, *y = moment->y;
    const int event = moment->kind != TRIBO_MOMENT_STEP;
    struct instants *x = data;
    double v[2], f[2];
    assert_ok(tribo_system_contacts(x->sys, t, y, v, NULL, f));
    x->reverses = event && fabs(v[0]) < 1e-9 ? t : x->reverses;
    x->goes = event && v[1] == 0.0 && fabs(fabs(f[1]) - 0.6) < 1e-9 ? t : x->goes;
    return 0;
}

/* Two blocks that nothing couples: one slides all the time, one sticks in turn. Its load lags by so much time. */
static struct search strangers(const char *method, double lag)
{
    const double omega = 0.63, mass[] = {1.0, 0.0, 0.0, 1.0}, damping[] = {0.1, 0.0, 0.0, 0.1},
                 stiffness[] = {1.8, 0.0, 0.0, 1.5};
    const double direction[] = {1.0, 0.0, 0.0, 1.0}, force[] = {1.75, 0.0}, limit[] = {0.02, 0.6}, ratio[] = {1.0, 1.3};
    const double cosine[] = {0.0, 1.75 * cos(omega * lag)}, sine[] = {0.0, 1.75 * sin(omega * lag)};
    struct search s = search_create(method, 2, 2, mass, damping, stiffness, direction, omega, force);
    assert_ok(tribo_system_add_load(s.sys, omega, cosine, sine));
    assert_ok(tribo_set_limit(tribo_system_context(s.sys), limit));
    assert_ok(tribo_set_static(tribo_system_context(s.sys), ratio, NULL));
    return s;
}

/* One block loses its static limit in the instant in which the other one reverses: each makes its own jump. */
TEST(multipliers_of_strangers)
{
    struct search s = strangers(methods[_i], 0.0);
    struct instants x = {s.sys, 0.0, 0.0};
    double y[5] = {0}, t = 0.0;
    find(&s, 0.0, y);
    assert_ok(tribo_driver_set_observer(s.drv, note_instants, &x));
    driver_advance(s.drv, &t, s.period, y);
    search_free(&s);
    s = strangers(methods[_i], x.reverses - x.goes);
    find(&s, 0.0, y);
    check_trace(&s, y);
    search_free(&s);
}

/* No multipliers where no inertia couples them, but a third contact that rests does, which leaves their sum with the block
 * between. */
TEST(no_multipliers_by_a_third)
{
    const double mass[] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0},
                 stiffness[] = {1.8, 0.0, 0.0, 0.0, 1.8, 0.0, 0.0, 0.0, 1.8};
    const double damping[] = {0.1, 0.0, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.1};
    const double direction[] = {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0};
    const double force[] = {1.75, 0.0, 1.75}, limit[] = {0.02, 0.02, 100.0};
    struct search s = search_create(methods[_i], 3, 3, mass, damping, stiffness, direction, 0.63, force);
    double y[7] = {0}, re[6], im[6];
    assert_ok(tribo_set_limit(tribo_system_context(s.sys), limit));
    find(&s, 0.0, y);
    assert_status(tribo_driver_get_multipliers(s.drv, re, im), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(s.drv), "contact 0 and contact 1 ");
    search_free(&s);
}

/* A free body between two bounds of friction: x'' = cos(t) + f. */
TEST(rigid_body)
{
    const double one = 1.0, zero = 0.0;
    struct search s = search_create(methods[_i], 1, 1, &one, NULL, &zero, &one, 1.0, &one);
    double y[3] = {0}, re[2], im[2];
    assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), 0.2));
    find(&s, 0.0, y);
    /* Den Hartog with k -> 0: V = -1, U = pi/2 */
    assert_close(amplitude(&s, 0), sqrt(1.0 - 0.04 * PI * PI / 4.0), 1e-9);
    assert_ok(tribo_driver_get_multipliers(s.drv, re, im));
    assert_close(re[0], 1.0, 1e-8);
    require(driver_freedom(s.drv) == 1, "%zu free directions", driver_freedom(s.drv));
    search_free(&s);
}

/* ------------------------------------------------------------------------------------------------------ structures */

/* An undamped chain of four, one contact: amplitude sqrt(H^2 - N^2 U^2) of the contact. */
TEST(undamped_structure)
{
    const double mass[16] = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1.5, 0, 0, 0, 0, 1}, omega = 1.4, n = 0.05;
    const double stiffness[16] = {2, -1, 0, 0, -1, 4, -3, 0, 0, -3, 5, -2, 0, 0, -2, 2.5};
    const double direction[4] = {0, 0, 1, 0}, load[4] = {1, 0, 0, 0.5};
    struct search s = search_create(methods[_i], 4, 1, mass, NULL, stiffness, direction, omega, load);
    double y[9] = {0}, h = 0.0, u = 0.0, frequency[4], shape[4], part[4];
    tribo_system *modal;
    assert_ok(dense_system(&modal, 4, 1, mass, NULL, stiffness, direction, 4, NULL, 0));
    assert_ok(tribo_system_get_frequencies(modal, frequency));
    for (size_t k = 0; k < 4; k++) {
        memset(part, 0, sizeof part);
        part[k] = 1.0;
        assert_ok(tribo_system_expand(modal, part, shape));
        const double w = frequency[k], force = shape[0] * load[0] + shape[3] * load[3];
        h += shape[2] * force / (w * w - omega * omega);
        u += shape[2] * shape[2] * tan(PI * w / (2.0 * omega)) / (w * omega);
    }
    tribo_system_destroy(modal);
    assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), n));
    find(&s, 0.0, y);
    assert_close(amplitude(&s, 2), sqrt(h * h - n * n * u * u), 1e-9);
    search_free(&s);
}

/* Two oscillators that know nothing of each other, and reverse at the same instant; and contacts that share one body. */
TEST(tied)
{
    const double unit[4] = {1, 0, 0, 1}, load[2] = {1, 1}, one = 1.0, shared[2] = {1, 1}, limits[] = {0.1, 0.2};
    struct search two = search_create(methods[_i], 2, 2, unit, NULL, unit, unit, 0.7, load);
    struct search both = search_create(methods[_i], 1, 2, &one, NULL, &one, shared, 0.7, load);
    double y[5] = {0}, z[3] = {0}, re[4], im[4];
    assert_ok(tribo_set_limit_all(tribo_system_context(two.sys), 0.3));
    assert_ok(tribo_set_limit(tribo_system_context(both.sys), limits));
    find(&two, 0.0, y);
    find(&both, 0.0, z);
    assert_close(amplitude(&two, 0), hartog[1].x0, 1e-9);
    assert_close(amplitude(&two, 1), hartog[1].x0, 1e-9);
    assert_close(amplitude(&both, 0), hartog[1].x0, 1e-9);
    assert_ok(tribo_driver_get_multipliers(two.drv, re, im));
    for (size_t k = 0; k < 4; k++) {
        assert_close(re[k], -0.4533657390, 1e-8);
        assert_close(fabs(im[k]), 0.2331451411, 1e-8);
    }
    assert_ok(tribo_driver_get_multipliers(both.drv, re, im));
    assert_close(re[0], -0.4533657390, 1e-8);
    search_free(&two);
    search_free(&both);
}

/* Two bodies that a contact joins, which holds for good, and another one that slides; with more contacts in the same place. */
TEST(redundant)
{
    const double mass[4] = {1, 0, 0, 1}, stiffness[4] = {2, -1, -1, 2}, damping[4] = {0.1, 0, 0, 0.1}, load[2] = {1, 0};
    const double direction[8] = {1, -1, 1, -1, 1, -1, 0, 1}, limits[] = {5, 5, 5, 0.3}, one[2] = {1, -1};
    struct search s = search_create(methods[_i], 2, 4, mass, damping, stiffness, direction, 0.9, load);
    const double body = 2.0, spring = 2.0, dashpot = 0.2, force = 1.0;
    struct search whole = search_create(methods[_i], 1, 1, &body, &dashpot, &spring, &body, 0.9, &force);
    double y[5] = {0}, z[3] = {0}, share[4], least, most;
    const double joined[4] = {one[0], one[1], 0, 0};
    assert_ok(tribo_set_limit(tribo_system_context(s.sys), limits));
    assert_ok(tribo_set_limit_all(tribo_system_context(whole.sys), 0.15));
    find(&s, 0.0, y);
    find(&whole, 0.0, z);
    assert_close(amplitude(&s, 1), amplitude(&whole, 0), 1e-9);
    assert_ok(tribo_driver_period_extremes(s.drv, joined, &least, &most, NULL, NULL));
    assert_close(most - least, 0.0, 1e-12);
    assert_ok(tribo_driver_period_stick(s.drv, share));
    assert_close(share[0], 1.0, 1e-12);
    require(driver_freedom(s.drv) == 1, "%zu free directions", driver_freedom(s.drv));
    search_free(&s);
    search_free(&whole);
}

/* No contacts at all, nor any load: linear, and at rest. */
TEST(no_contacts)
{
    const double mass[4] = {1, 0, 0, 2}, stiffness[4] = {3, -1, -1, 2}, damping[4] = {0.3, -0.1, -0.1, 0.1}, load[2] = {1, -0.5};
    struct search s = search_create(methods[_i], 2, 0, mass, damping, stiffness, NULL, 1.1, load);
    double y[5] = {1, 2, 3, 4, 5}, t = 0.0, z[5];
    find(&s, 0.0, y);
    memcpy(z, y, sizeof z);
    driver_advance(s.drv, &t, s.period, z);
    assert_all_close(z, y, 4, 1e-12);
    assert_ok(tribo_system_clear_loads(s.sys));
    find(&s, 0.0, y);
    assert_all_close(y, ((double[5]){0}), 4, 1e-14);
    search_free(&s);
}

/* ------------------------------------------------------------------------------------------------------ what fails */

/* Resonance without damping: nothing comes back, nothing is touched, and the driver goes on as a new one does. */
TEST(resonance)
{
    struct search s = oscillator_search(methods[_i], 0.0, 0.0, 1.0, 1.0);
    double y[3] = {0.5, 0.25, 0.125}, z[3] = {0}, fresh[3] = {0}, t = 0.0, re[2], im[2];
    assert_status(tribo_driver_find_periodic(s.drv, 0.0, s.period, y), TRIBO_ERR_NO_CONVERGENCE);
    assert_says(tribo_driver_message(s.drv), "misses its beginning by");
    assert_all_exact(y, ((double[]){0.5, 0.25, 0.125}), 3);
    assert_status(tribo_driver_get_multipliers(s.drv, re, im), TRIBO_ERR_STATE);
    assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), 0.3));
    driver_advance(s.drv, &t, 20.0, z);
    run(s.sys, methods[_i], 0.1, 1e-14, 20.0, fresh);
    assert_all_exact(z, fresh, 3);
    search_free(&s);
}

/* The same of many modes, of which one resonates. */
TEST(resonance_among_many)
{
    enum { DOFS = 25 };
    static double mass[DOFS * DOFS], damping[DOFS * DOFS], stiffness[DOFS * DOFS];
    double direction[DOFS] = {0}, load[DOFS] = {1.0}, y[2 * DOFS + 1] = {0};
    for (size_t i = 0; i < DOFS; i++) {
        mass[i * DOFS + i] = 1.0;
        stiffness[i * DOFS + i] = 2.0;
        if (i + 1 < DOFS) {
            stiffness[i * DOFS + i + 1] = stiffness[(i + 1) * DOFS + i] = -1.0;
        }
    }
    direction[2] = 1.0;
    struct search s =
        search_create("exact", DOFS, 1, mass, damping, stiffness, direction, 2.0 * sin(1.5 * PI / (DOFS + 1)), load);
    assert_ok(tribo_set_limit_all(tribo_system_context(s.sys), _i ? 0.01 : 0.0));
    assert_status(tribo_driver_find_periodic(s.drv, 0.0, s.period, y), TRIBO_ERR_NO_CONVERGENCE);
    search_free(&s);
}

TEST_MAIN("periodic", {den_hartog, 6}, {stops, 6}, {multipliers, 2}, {family, 4}, {begins_at_stop, 4}, {viscous_damping, 2},
          {later, 2}, {multiple, 2}, {stuck, 2}, {open, 2}, {times_of_extremes, 4}, {constant_load, 2}, {swinging_limits, 8},
          {multipliers_of_swinging_limits, 2}, {multipliers_of_twins, 2}, {multipliers_of_mirrored_halves, 2},
          {no_multipliers, 6}, {multipliers_of_pairs, 2}, {multipliers_of_strangers, 2}, {no_multipliers_by_a_third, 2},
          {belt, 2}, {rigid_body, 2}, {undamped_structure, 2}, {tied, 2}, {redundant, 2}, {no_contacts, 2}, {resonance, 2},
          {resonance_among_many, 2})
