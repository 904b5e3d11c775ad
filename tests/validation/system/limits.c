/* SPDX-License-Identifier: BSD-3-Clause */
/* Limits that follow harmonics, with lift-off: closed forms beside each case, and all methods against each other. */
#include <string.h>

#include "make.h"
#include "coulomb.h"
#include "model.h"
#include "../../set_up_driver.h"

/* Every test of a single block is run with both methods that locate events. */
static const char *const methods[] = {"exact", "event"};
#define TOLERANCE 1e-13

/* limit += c cos(omega t) + s sin(omega t) for a single contact. */
static void add_limit(tribo_system *sys, double omega, double c, double s)
{
    assert_ok(tribo_system_add_limit(sys, omega, &c, &s));
}

static void add_load(tribo_system *sys, double omega, double c, double s)
{
    assert_ok(tribo_system_add_load(sys, omega, &c, &s));
}

/* Goes from t to end; returns the events. */
static size_t go(tribo_system *sys, const char *method, double t, double end, double *y)
{
    double excess, backslip;
    tribo_driver *drv = driver_create(sys, method, 1.0, TOLERANCE);
    driver_advance(drv, &t, end, y);
    const size_t events = driver_count(drv, TRIBO_COUNT_EVENTS);
    assert_ok(tribo_driver_real(drv, TRIBO_REAL_EXCESS, &excess));
    assert_ok(tribo_driver_real(drv, TRIBO_REAL_BACKSLIP, &backslip));
    require(excess <= 1e-12 && backslip <= 1e-12, "%g beyond the limit, %g the wrong way", excess, backslip);
    tribo_driver_destroy(drv);
    return events;
}

/* ------------------------------------------------------------------------------------------------------- one direction */

/* A free block that slides on: x'' = 1.1 - (0.6 + 0.4 cos 2t + 0.3 sin 2t), v = 1 at first. */
TEST(slides_on)
{
    double y[3] = {0.0, 1.0, 0.0};
    const double t = 7.0, c = cos(2.0 * t), s = sin(2.0 * t);
    tribo_system *sys = block(1.0, 0.0, 0.6);
    add_limit(sys, 2.0, 0.4, 0.3);
    add_load(sys, 0.0, 1.1, 0.0);
    ck_assert_uint_eq(go(sys, methods[_i], 0.0, t, y), 0);
    /* v = a + t/2 - 0.2 sin 2t + 0.15 cos 2t with a = 0.85 */
    assert_close(y[1], 0.85 + 0.5 * t - 0.2 * s + 0.15 * c, 1e-12);
    const double x = 0.85 * t + 0.25 * t * t + 0.1 * (c - 1.0) + 0.075 * s;
    assert_close(y[0], x, 1e-11);
    /* what the load has done is motion or friction */
    assert_close(y[2], 1.1 * x - 0.5 * (y[1] * y[1] - 1.0), 1e-11);
    tribo_system_destroy(sys);
}

/* The limit in resonance with the structure, or next to it: x'' + x = -(1 + 0.2 cos w t) until the block stops, late in a swing
 * of 1000. */
TEST(resonance)
{
    const double omegas[] = {1.0, 1.0 + 1e-13, 1.0 + 1e-6, 1.0 - 1e-4, 1.002};
    for (size_t k = 0; k < COUNT(omegas); k++) {
        const double w = omegas[k], t = 3.0, d = 0.5 * (1.0 - w), u = 0.5 * (1.0 + w);
        double y[3] = {-1000.0, 0.0, 0.0};
        tribo_system *sys = block(1.0, 1.0, 1.0);
        add_limit(sys, w, 0.2, 0.0);
        go(sys, methods[_i], 0.0, t, y);
        /* (cos wt - cos t)/(1 - w^2) = sin(dt)/(2d) sin(ut)/u */
        const double beat = d == 0.0 ? 0.5 * t * sin(t) : 0.5 * sin(d * t) / d * sin(u * t) / u;
        const double x = -999.0 * cos(t) - 1.0 - 0.2 * beat;
        assert_close(y[0], x, 1e-10);
        assert_close(y[2], 0.5 * (1e6 - y[0] * y[0] - y[1] * y[1]), 1e-8);
        tribo_system_destroy(sys);
    }
}

/* ---------------------------------------------------------------------------------------------------------- lift-off */

/* Limit 1/2 + cos t, load 1, v = 3 at first: flies from 2 pi/3 to 4 pi/3, and again. */
TEST(lift_off)
{
    const double third = 2.0 * PI / 3.0;
    double y[3] = {0.0, 3.0, 0.0};
    tribo_system *sys = block(1.0, 0.0, 0.5);
    add_limit(sys, 1.0, 1.0, 0.0);
    add_load(sys, 0.0, 1.0, 0.0);
    ck_assert_uint_eq(go(sys, methods[_i], 0.0, 3.0, y), 1);
    /* v = 3 + t/2 - sin t up to there; then v grows by the load alone */
    const double v = 3.0 + 0.5 * third - sin(third), x = 3.0 * third + 0.25 * third * third + cos(third) - 1.0;
    const double s = 3.0 - third, lost = x - 0.5 * (v * v - 9.0);
    assert_close(y[1], v + s, 1e-12);
    assert_close(y[0], x + v * s + 0.5 * s * s, 1e-11);
    assert_close(y[2], lost, 1e-11);
    ck_assert_uint_eq(go(sys, methods[_i], 3.0, 2.0 * PI, y), 1);
    /* a cycle takes 2 pi minus what friction takes: twice the integral of 1/2 + cos t up to 2 pi/3 */
    assert_close(y[1], 3.0 + 2.0 * PI - 2.0 * (0.5 * third + sin(third)), 1e-11);
    assert_close(y[2], y[0] - 0.5 * (y[1] * y[1] - 9.0), 1e-11);
    tribo_system_destroy(sys);
}

/* Limit max(0, -sin t), load b sin 2t: while it flies, to t = pi, v = b (1 - cos 2t)/2, which is 0 when it touches down, and
 * there both limit and load are 0, too. It sticks if the load grows no faster than the limit, b <= 1/2, and else slides. */
TEST(touches_down_at_rest)
{
    const double bs[] = {0.4, 0.5, 0.6, 0.5 - 1e-7, 0.5 + 1e-3};
    for (size_t k = 0; k < COUNT(bs); k++) {
        const double b = bs[k];
        double y[3] = {0.0, 0.0, 0.0};
        tribo_system *sys = block(1.0, 0.0, 0.0);
        add_limit(sys, 1.0, 0.0, -1.0);
        add_load(sys, 2.0, 0.0, b);
        if (b <= 0.5) {
            go(sys, methods[_i], 0.0, 2.0 * PI, y);
            assert_close(y[0], 0.5 * b * PI, 1e-12);
            assert_close(y[1], 0.0, 1e-12);
            assert_close(y[2], 0.0, 1e-20);
        } else {
            /* v = b (1 - cos 2s)/2 - (1 - cos s) */
            const double s = 0.05;
            go(sys, methods[_i], 0.0, PI + s, y);
            assert_close(y[1], b * sin(s) * sin(s) - 2.0 * sin(0.5 * s) * sin(0.5 * s), 1e-11);
        }
        tribo_system_destroy(sys);
    }
}

/* Limit max(0, -sin t), load 2 cos t: it touches down without velocity, but pulled, slides back, turns at once when it comes to
 * rest, where the load is 1.2 and the limit 0.8, and takes off again. */
TEST(touches_down_pulled)
{
    double y[3] = {0.0, 0.0, 0.0};
    const double turn = 2.0 * atan(2.0), fly = PI;
    tribo_system *sys = block(1.0, 0.0, 0.0);
    add_limit(sys, 1.0, 0.0, -1.0);
    add_load(sys, 2.0 / 2.0, 2.0, 0.0);
    go(sys, methods[_i], 0.0, fly, y);
    assert_close(y[1], 0.0, 1e-12);
    go(sys, methods[_i], fly, fly + 1.0, y);
    assert_close(y[1], -2.0 * sin(1.0) + 1.0 - cos(1.0), 1e-12);
    go(sys, methods[_i], fly + 1.0, 2.0 * fly, y);
    /* from the turn on v' = -2 cos s - sin s */
    assert_close(y[1], 2.0 * sin(turn) - 1.0 - cos(turn), 1e-11);
    tribo_system_destroy(sys);
}

/* Limits that come down to 0 and go up again, once with a fourth power, (1 - cos t)^2 = 3/2 - 2 cos t + cos(2t)/2. */
TEST(grazing_lift_off)
{
    for (int quartic = 0; quartic < 2; quartic++) {
        double y[3] = {0.0, 20.0, 0.0}, rest[3] = {0.5, 0.0, 0.0};
        tribo_system *sys = block(1.0, 0.0, quartic ? 1.5 : 1.0);
        add_limit(sys, 1.0, quartic ? -2.0 : -1.0, 0.0);
        if (quartic) {
            add_limit(sys, 2.0, 0.5, 0.0);
        }
        go(sys, methods[_i], 0.0, 4.0 * PI, y);
        assert_close(y[1], 20.0 - (quartic ? 6.0 : 4.0) * PI, 1e-11);
        assert_close(y[2], 0.5 * (400.0 - y[1] * y[1]), 1e-10);
        go(sys, methods[_i], 0.0, 20.0, rest);
        assert_exact(rest[0], 0.5);
        assert_exact(rest[2], 0.0);
        tribo_system_destroy(sys);
    }
}

/* ----------------------------------------------------------------------------------------------------------- at rest */

/* Load 0.8 cos t on limit 0.8 - 0.3 sin t, which meet at 2 pi, where the load is at its largest and the limit falls. */
TEST(released_at_the_load_s_extremum)
{
    const double begin = 1.5 * PI, s = 0.5;
    double y[3] = {0.25, 0.0, 0.0};
    tribo_system *sys = block(1.0, 0.0, 0.8);
    add_limit(sys, 1.0, 0.0, -0.3);
    add_load(sys, 1.0, 0.8, 0.0);
    ck_assert_uint_eq(go(sys, methods[_i], begin, 2.0 * PI - 1e-9, y), 0);
    assert_exact(y[1], 0.0);
    go(sys, methods[_i], 2.0 * PI - 1e-9, 2.0 * PI + s, y);
    assert_close(y[1], 0.8 * sin(s) - 0.8 * s + 0.3 * (1.0 - cos(s)), 1e-11);
    assert_close(y[0], 0.25 + 0.8 * (1.0 - cos(s)) - 0.4 * s * s + 0.3 * (s - sin(s)), 1e-11);
    tribo_system_destroy(sys);
}

/* A spring pulls with 0.5, the limit comes down to 0.5 and goes up again: the block stays. A little less, and it slips. */
TEST(grazing_limit)
{
    for (int k = 0; k < 3; k++) {
        const double less[] = {0.0, 1e-15, 1e-2};
        double y[3] = {0.5, 0.0, 0.0};
        tribo_system *sys = block(1.0, 1.0, 1.0 - less[k]);
        add_limit(sys, 1.0, 0.5, 0.0);
        go(sys, methods[_i], 0.0, 6.0, y);
        if (k < 2) {
            assert_close(y[0], 0.5, 1e-12);
        } else {
            require(y[0] < 0.5 - 1e-5 && y[2] > 0.0, "x = %.17g, energy %g", y[0], y[2]);
        }
        tribo_system_destroy(sys);
    }
}

/* Without load or limit nothing happens; harmonics that cancel are none. */
TEST(zero_limits)
{
    double y[3] = {1.0, 0.0, 0.0};
    tribo_system *sys = block(1.0, 1.0, 0.0);
    add_limit(sys, 1.0, 0.3, 0.1);
    add_limit(sys, 1.0, -0.3, -0.1);
    add_limit(sys, 0.7, 0.0, 0.0);
    ck_assert_uint_eq(go(sys, methods[_i], 0.0, 10.0, y), 0);
    assert_close(y[0], cos(10.0), 1e-12);
    assert_exact(y[2], 0.0);
    /* and below zero all the time */
    add_limit(sys, 0.0, -5.0, 0.0);
    add_limit(sys, 3.0, 2.0, 3.0);
    ck_assert_uint_eq(go(sys, methods[_i], 10.0, 20.0, y), 0);
    assert_close(y[0], cos(20.0), 1e-12);
    tribo_system_destroy(sys);
}

/* A frequency of 0 makes other limits, and no others than tribo_set_limit does. */
TEST(constant)
{
    static const char *const all[] = {"exact", "event", "central/fixed", "moreau/fixed", "rk4/fixed", "rkf45", "msbdf"};
    for (size_t k = 0; k < COUNT(all); k++) {
        double y[3] = {0}, z[3] = {0};
        tribo_system *a = block(1.0, 1.0, 0.75), *b = block(1.0, 1.0, 0.5);
        add_load(a, 0.5, 1.5, 0.0);
        add_load(b, 0.5, 1.5, 0.0);
        add_limit(b, 0.0, 0.25, 17.0);
        assert_ok(tribo_set_epsilon_all(tribo_system_context(a), 0.01));
        assert_ok(tribo_set_epsilon_all(tribo_system_context(b), 0.01));
        run(a, all[k], 0.005, 1e-10, 20.0, y);
        run(b, all[k], 0.005, 1e-10, 20.0, z);
        assert_all_close(z, y, 3, 1e-11);
        tribo_system_destroy(a);
        tribo_system_destroy(b);
    }
}

/* ------------------------------------------------------------------------------------------------------ many contacts */

/* Blocks in a row, alike: all lift off at once, and touch down at once. What one does is what a single one does. */
TEST(together)
{
    enum { N = 5 };
    double mass[N * N] = {0.0}, stiffness[N * N] = {0.0}, sine[N], cosine[N], y[2 * N + 1] = {0.0}, one[3] = {0.0};
    for (size_t i = 0; i < N; i++) {
        mass[i * N + i] = stiffness[i * N + i] = 1.0;
        sine[i] = 1.5;
        cosine[i] = 0.6;
    }
    tribo_system *sys, *single = block(1.0, 1.0, 0.3);
    assert_ok(dense_system(&sys, N, N, mass, NULL, stiffness, mass, 0, NULL, 0));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.3));
    assert_ok(tribo_system_add_load(sys, 0.5, NULL, sine));
    assert_ok(tribo_system_add_limit(sys, 1.25, cosine, NULL));
    add_load(single, 0.5, 0.0, 1.5);
    add_limit(single, 1.25, 0.6, 0.0);
    go(sys, methods[_i], 0.0, 30.0, y);
    go(single, methods[_i], 0.0, 30.0, one);
    for (size_t i = 0; i < N; i++) {
        assert_close(y[i], one[0], 1e-10);
        assert_close(y[N + i], one[1], 1e-10);
    }
    assert_close(y[2 * N], N * one[2], 1e-9);
    tribo_system_destroy(sys);
    tribo_system_destroy(single);
}

/* Two contacts that hold one body share what there is: as one of twice the limit. */
TEST(doubled)
{
    const double one = 1.0, direction[] = {1.0, 1.0}, swing[] = {0.4, 0.4}, uneven[] = {0.7, 0.1}, given[] = {0.5, 0.1};
    for (int k = 0; k < 2; k++) {
        double y[3] = {0.0}, z[3] = {0.0};
        tribo_system *sys, *single = block(1.0, 1.0, k ? 0.6 : 0.5);
        assert_ok(dense_system(&sys, 1, 2, &one, NULL, &one, direction, 0, NULL, 0));
        if (k) {
            assert_ok(tribo_set_limit(tribo_system_context(sys), given));
        } else {
            assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.25));
        }
        assert_ok(tribo_system_add_limit(sys, 0.8, k ? given : swing, k ? given : NULL));
        add_limit(single, 0.8, k ? 0.6 : 0.8, k ? 0.6 : 0.0);
        assert_ok(tribo_system_add_load(sys, 0.5, &one, uneven));
        assert_ok(tribo_system_add_load(single, 0.5, &one, uneven));
        go(sys, methods[_i], 0.0, 40.0, y);
        go(single, methods[_i], 0.0, 40.0, z);
        assert_all_close(y, z, 3, 1e-10);
        tribo_system_destroy(sys);
        tribo_system_destroy(single);
    }
}

/* A random structure with limits that swing, some of them below 0. Kind 1: damped, 2: reduced; loads and belts as they come. */
static tribo_system *swinging(int seed, int driven)
{
    struct random g = random_of(seed);
    const struct model m = model_create(&g, seed % 2);
    tribo_system *sys = model_system(&m, seed % 4 == 1, seed % 4 == 2 ? 4 : 0, 2e-4);
    double c[CONTACTS], s[CONTACTS];
    model_swing(sys, &g, c, s);
    assert_ok(tribo_system_add_base_motion(sys, 0.0, c, NULL));
    if (!driven) {
        tribo_system_destroy(sys);
        struct model free = m;
        memset(free.load, 0, sizeof free.load);
        memset(free.motion, 0, sizeof free.motion);
        sys = model_system(&free, 0, 0, 2e-4);
        assert_ok(tribo_system_add_limit(sys, 0.6, c, s));
    }
    return sys;
}

/* From a displaced start; t1 = 8. */
static void follow(int seed, const char *method, double dt, double tolerance, double *y)
{
    tribo_system *sys = swinging(seed, 1);
    memset(y, 0, DIMENSION * sizeof *y);
    y[0] = 0.7;
    y[2] = -0.5;
    run(sys, method, dt, tolerance, 8.0, y);
    tribo_system_destroy(sys);
}

TEST(methods_agree)
{
    double want[DIMENSION], y[DIMENSION];
    const struct {
        const char *method;
        double dt, tolerance, apart;
    } cases[] = {{"event", 1.0, 1e-13, 1e-9},
                 {"rk4/fixed", 1e-4, 0.0, 2e-3},
                 {"central/fixed", 5e-4, 0.0, 2e-3},
                 {"moreau/fixed", 5e-4, 0.0, 2e-3}};
    follow(_i, "exact", 1.0, 0.0, want);
    for (size_t k = 0; k < COUNT(cases); k++) {
        follow(_i, cases[k].method, cases[k].dt, cases[k].tolerance, y);
        const char *off = differences(cases[k].method, y, want, DIMENSION, cases[k].apart);
        require(!off, "seed %d: %s", _i, off);
    }
}

/* The paper's systems, whose matrices have scalings of their own. */
TEST(reference_systems)
{
    const double c[] = {0.2, -0.1, 0.3, 0.05}, d[] = {0.0, 0.3, -0.2, 0.1};
    for (int kind = 0; kind < 2; kind++) {
        tribo_system *sys;
        double y[3][9] = {{0.0}};
        assert_ok(kind ? tribo_system_chain(&sys, 4, 0.1, 1.5, 0.5) : tribo_system_belt(&sys, 2.0, 0.5, 0.25, 1.0, 0.5));
        assert_ok(tribo_system_add_limit(sys, 1.25, c, d));
        assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 2e-4));
        go(sys, "exact", 0.0, 20.0, y[0]);
        go(sys, "event", 0.0, 20.0, y[1]);
        run(sys, "rk4/fixed", 2e-4, 0.0, 20.0, y[2]);
        assert_all_close(y[1], y[0], tribo_system_dimension(sys), 1e-10);
        assert_all_close(y[2], y[0], tribo_system_dimension(sys), 1e-3);
        tribo_system_destroy(sys);
    }
}

/* The steppers of GSL, on an oscillator that sticks, slips and flies. */
TEST(steppers)
{
    static const char *const all[] = {"rk2",    "rk4",    "rkf45", "rkck",  "rk8pd",  "rk1imp",
                                      "rk2imp", "rk4imp", "bsimp", "msbdf", "msadams"};
    double want[3] = {0.0};
    for (size_t k = 0; k <= COUNT(all); k++) {
        double y[3] = {0.0};
        tribo_system *sys = block(1.0, 1.0, 0.3);
        add_limit(sys, 1.25, 0.6, 0.0);
        add_load(sys, 0.5, 0.0, 1.5);
        assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 1e-4));
        if (k == 0) {
            run(sys, "exact", 1.0, 0.0, 10.0, want);
        } else {
            run(sys, all[k - 1], 1e-3, 1e-6, 10.0, y);
            const char *off = differences(all[k - 1], y, want, 3, 2e-3);
            require(!off, "%s", off);
        }
        tribo_system_destroy(sys);
    }
}

/* Nothing comes from outside and there is no damping: what is not mechanical energy any more has gone into friction. */
TEST(energy)
{
    struct random g = random_of(_i);
    const struct model m = model_create(&g, _i % 2);
    double y[DIMENSION] = {0.7, 0.0, -0.5};
    tribo_system *sys = swinging(_i, 0);
    const double before = 0.5 * form(m.stiffness, y, y);
    for (int k = 0; k < 8; k++) {
        go(sys, "exact", k, k + 1.0, y);
        const double now = 0.5 * (form(m.stiffness, y, y) + form(m.mass, y + DOFS, y + DOFS));
        assert_close(now + y[2 * DOFS], before, 1e-12 * fmax(before, 1.0));
    }
    require(y[2 * DOFS] > 1e-3 * before, "nothing dissipated: %g of %g", y[2 * DOFS], before);
    tribo_system_destroy(sys);
}

/* The same late: a whole number of cycles later to all digits that the frequencies have, 2 pi k being no number. */
TEST(late_in_time)
{
    const double begin = 1e9;
    double y[3] = {0.0, 0.0, 0.0}, z[3] = {0.0, 0.0, 0.0};
    tribo_system *late = block(1.0, 1.0, 0.3), *early = block(1.0, 1.0, 0.3);
    const double c = cos(0.5 * begin), s = sin(0.5 * begin), d = cos(1.25 * begin), e = sin(1.25 * begin);
    add_load(late, 0.5, 0.0, 1.5);
    add_limit(late, 1.25, 0.6, 0.0);
    add_load(early, 0.5, 1.5 * s, 1.5 * c);
    add_limit(early, 1.25, 0.6 * d, -0.6 * e);
    go(late, methods[_i], begin, begin + 20.0, y);
    go(early, methods[_i], 0.0, 20.0, z);
    assert_all_close(y, z, 3, 1e-11);
    tribo_system_destroy(late);
    tribo_system_destroy(early);
}

/* ------------------------------------------------------------------------------------------------------------- tables */

/* A table's limits of 0 are the same lift-off: v' = 1 - limit. */
TEST(table_lifts_off)
{
    const double time[] = {0.0, 1.0, 2.0, 3.0, 4.0}, limit[] = {1.0, 0.0, 0.0, 1.0, 0.0};
    double y[3] = {0.0, 1.0, 0.0};
    tribo_system *sys = block(1.0, 0.0, 7.0);
    add_load(sys, 0.0, 1.0, 0.0);
    assert_ok(tribo_system_set_limit_table(sys, COUNT(time), time, limit));
    go(sys, "event", 0.0, 6.0, y);
    assert_close(y[1], 1.0 + 0.5 + 1.0 + 0.5 + 0.5 + 2.0, 1e-12);
    tribo_system_destroy(sys);
}

/* Harmonics come on top of a table, too. */
TEST(table_and_harmonics)
{
    const double time[] = {0.0, 1.0, 5.0}, zero[] = {0.0, 0.0, 0.0}, even[] = {0.3, 0.3, 0.3}, ramp[] = {0.3, 0.3, 0.9};
    double y[3] = {0.0}, z[3] = {0.0}, w[3] = {0.0};
    tribo_system *sys = block(1.0, 1.0, 0.3), *tabled = block(1.0, 1.0, 5.0);
    tribo_system *both[] = {sys, tabled};
    for (int k = 0; k < 2; k++) {
        add_load(both[k], 0.5, 0.0, 1.5);
        add_limit(both[k], 1.25, 0.6, 0.0);
    }
    assert_ok(tribo_system_set_limit_table(tabled, 3, time, even));
    go(sys, "event", 0.0, 20.0, y);
    go(tabled, "event", 0.0, 20.0, z);
    assert_all_close(z, y, 3, 1e-11);
    /* ramps, against small steps */
    assert_ok(tribo_system_set_limit_table(tabled, 3, time, ramp));
    memset(z, 0, sizeof z);
    go(tabled, "event", 0.0, 20.0, z);
    run(tabled, "central/fixed", 5e-4, 0.0, 20.0, w);
    assert_all_close(w, z, 3, 1e-3);
    require(fabs(z[0] - y[0]) > 1e-2, "the table makes no difference");
    /* 0 all the time leaves the harmonics alone */
    assert_ok(tribo_system_set_limit_table(tabled, 3, time, zero));
    assert_ok(tribo_set_limit_all(tribo_system_context(sys), 0.0));
    memset(y, 0, sizeof y);
    memset(z, 0, sizeof z);
    go(sys, "event", 0.0, 20.0, y);
    go(tabled, "event", 0.0, 20.0, z);
    assert_all_close(z, y, 3, 1e-11);
    tribo_system_destroy(sys);
    tribo_system_destroy(tabled);
}

/* ------------------------------------------------------------------------------------------------------------ setting */

/* The limits set in the context are what harmonics are added to, whenever they are set; and they come back in the end. */
TEST(given_limits)
{
    double y[3] = {0.0}, z[3] = {0.0}, got;
    tribo_system *first = block(1.0, 1.0, 0.3), *then = block(1.0, 1.0, 5.0), *copy;
    tribo_system *both[] = {first, then};
    for (int k = 0; k < 2; k++) {
        add_limit(both[k], 1.25, 0.6, 0.0);
        add_load(both[k], 0.5, 0.0, 1.5);
    }
    assert_ok(tribo_set_limit_all(tribo_system_context(then), 0.3));
    go(first, methods[_i], 0.0, 7.0, y);
    go(then, methods[_i], 0.0, 7.0, z);
    assert_all_exact(z, y, 3);
    /* while it runs */
    tribo_driver *drv = driver_create(first, methods[_i], 1.0, TOLERANCE);
    double t = 7.0;
    driver_advance(drv, &t, 9.0, y);
    assert_ok(tribo_set_limit_all(tribo_system_context(first), 0.8));
    driver_advance(drv, &t, 12.0, y);
    tribo_driver_destroy(drv);
    go(then, methods[_i], 7.0, 9.0, z);
    assert_ok(tribo_set_limit_all(tribo_system_context(then), 0.8));
    assert_ok(tribo_system_clone(then, &copy));
    go(copy, methods[_i], 9.0, 12.0, z);
    assert_all_close(z, y, 3, 1e-12);
    /* the context says what was set, and the system what the limit is at a time */
    assert_ok(tribo_system_contacts(copy, 2.0, y, NULL, NULL, NULL));
    assert_ok(tribo_get_limit(tribo_system_context(copy), &got));
    assert_exact(got, 0.8);
    assert_ok(tribo_system_get_limit(copy, 2.0, &got));
    assert_close(got, fmax(0.8 + 0.6 * cos(2.5), 0.0), 1e-15);
    /* clearing loads leaves limits as they are; the end of them does not */
    assert_ok(tribo_system_clear_loads(copy));
    assert_ok(tribo_system_get_limit(copy, 2.0, &got));
    assert_close(got, fmax(0.8 + 0.6 * cos(2.5), 0.0), 1e-15);
    assert_ok(tribo_system_clear_limits(copy));
    assert_ok(tribo_get_limit(tribo_system_context(copy), &got));
    assert_exact(got, 0.8);
    assert_ok(tribo_system_get_limit(copy, 1.0, &got));
    assert_exact(got, 0.8);
    tribo_system_destroy(first);
    tribo_system_destroy(then);
    tribo_system_destroy(copy);
}

/* "auto" takes the closed form, also of a table of limits; static limits that fall with the speed are not for it. */
TEST(automatic)
{
    const double time[] = {0.0, 1.0}, limit[] = {1.0, 2.0};
    double y[3] = {0.0}, t = 0.0;
    tribo_system *sys = block(1.0, 1.0, 0.3);
    add_limit(sys, 1.25, 0.6, 0.0);
    tribo_driver *drv = driver_create(sys, "auto", 1.0, 0.0);
    ck_assert_str_eq(tribo_driver_method(drv), "exact");
    tribo_driver_destroy(drv);
    drv = driver_create(sys, "exact", 1.0, 0.0);
    assert_ok(tribo_system_set_limit_table(sys, 2, time, limit));
    driver_advance(drv, &t, 0.5, y);
    assert_ok(tribo_set_static(tribo_system_context(sys), limit + 1, limit));
    assert_status(tribo_driver_advance(drv, &t, 1.0, y), TRIBO_ERR_UNSUPPORTED);
    tribo_driver_destroy(drv);
    assert_status(set_up_driver(&drv, sys, "exact", 1.0, 0.0, 0.0), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_system_message(sys), "falls with the speed");
    tribo_system_destroy(sys);
}

/* What a system does, with any method, changes nothing in the context that it lends; errors of the system leave no message
 * there. */
TEST(lent_context)
{
    const char *method = any_method_name(_i);
    double y[3] = {0.0, 0.3, 0.0}, t = 0.0, limit, bad = NAN;
    signed char slip = 9;
    size_t before, after, stuck;
    tribo_driver *drv, *none = NULL;
    tribo_system *sys = block(1.0, 1.0, 0.3);
    tribo_context *c = tribo_system_context(sys);
    assert_ok(tribo_set_limit_all(c, 0.7));
    assert_ok(tribo_set_epsilon_all(c, 1e-3));
    add_limit(sys, 1.25, 0.6, 0.0);
    assert_status(tribo_set_law(c, 999), TRIBO_ERR_RANGE);
    assert_ok(tribo_get_count(c, TRIBO_COUNT_SETTINGS, &before));
    assert_status(tribo_system_get_slip(sys, &slip), TRIBO_ERR_STATE);
    ck_assert_int_eq(slip, 9);
    assert_ok(set_up_driver(&drv, sys, method, 0.01, 1e-6, 1e-6));
    assert_ok(tribo_driver_advance(drv, &t, 3.0, y));
    assert_status(tribo_driver_advance(drv, &t, 4.0, &bad), TRIBO_ERR_NOT_FINITE);
    assert_status(set_up_driver(&none, sys, "none", 0.01, 1e-6, 1e-6), TRIBO_ERR_NAME);
    assert_says(tribo_system_message(sys), "\"none\" is unknown");
    assert_status(tribo_system_add_load(sys, NAN, NULL, NULL), TRIBO_ERR_NOT_FINITE);
    ck_assert_str_eq(tribo_system_message(sys), "omega = nan is not finite");
    ck_assert_str_eq(tribo_message(c), "law = 999 is none of the 6 laws");
    assert_ok(tribo_get_count(c, TRIBO_COUNT_SETTINGS, &after));
    ck_assert_uint_eq(after, before);
    assert_ok(tribo_get_limit(c, &limit));
    assert_exact(limit, 0.7);
    assert_status(tribo_get_slip(c, &slip), TRIBO_ERR_STATE);
    assert_status(tribo_set_operator_diagonal(c, &limit), TRIBO_ERR_UNSUPPORTED);
    /* slips and counts are the system's */
    y[1] = 2.0;
    assert_ok(tribo_system_contacts(sys, 0.0, y, NULL, NULL, NULL));
    assert_ok(tribo_system_get_slip(sys, &slip));
    ck_assert_int_eq(slip, TRIBO_SLIP_FORTH);
    assert_ok(tribo_system_get_count(sys, TRIBO_COUNT_STUCK, &stuck));
    ck_assert_uint_eq(stuck, 0);
    assert_ok(tribo_system_contacts(sys, PI / 1.25, y, NULL, NULL, NULL)); /* 0.7 - 0.6 */
    assert_ok(tribo_set_limit_all(c, 0.5));
    assert_ok(tribo_system_contacts(sys, PI / 1.25, y, NULL, NULL, NULL)); /* 0.5 - 0.6 */
    assert_ok(tribo_system_get_slip(sys, &slip));
    ck_assert_int_eq(slip, TRIBO_SLIP_OPEN);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST(errors)
{
    const double bad = HUGE_VAL, one = 1.0, far = 1e301;
    tribo_system *sys = block(1.0, 1.0, 0.3);
    const char *message = tribo_system_message(sys);
    assert_status(tribo_system_add_limit(NULL, 1.0, &one, &one), TRIBO_ERR_NULL);
    assert_status(tribo_system_add_limit(sys, NAN, &one, &one), TRIBO_ERR_NOT_FINITE);
    assert_says(message, "omega");
    assert_status(tribo_system_add_limit(sys, 1.0, &bad, NULL), TRIBO_ERR_NOT_FINITE);
    assert_says(message, "cosine[0]");
    assert_status(tribo_system_add_limit(sys, 1.0, NULL, &bad), TRIBO_ERR_NOT_FINITE);
    assert_says(message, "sine[0]");
    assert_ok(tribo_system_add_limit(sys, 1.0, NULL, NULL));
    assert_status(tribo_system_add_limit(sys, 1.0, &far, NULL), TRIBO_ERR_RANGE);
    assert_says(message, "limit of contact 0 comes to");
    tribo_system_destroy(sys);
}

TEST(errors_of_tables)
{
    const struct {
        double limit[4];
        int status;
        const char *text;
    } cases[] = {
        {{1.0, 1.0, 1.0, -2.0}, TRIBO_ERR_NEGATIVE, "limit[1] = -2 of contact 1 is negative"},
        {{1.0, 1.0, NAN, 1.0}, TRIBO_ERR_NOT_FINITE, "limit[1] = nan of contact 0 is not finite"},
        {{1.0, HUGE_VAL, 1.0, 1.0}, TRIBO_ERR_NOT_FINITE, "limit[0] = inf of contact 1 is not finite"},
    };
    const double time[] = {0.0, 1.0};
    tribo_system *sys;
    assert_ok(tribo_system_belt(&sys, 2.0, 0.5, 0.25, 1.0, 0.5));
    const char *message = tribo_system_message(sys);
    for (size_t i = 0; i < COUNT(cases); i++) {
        assert_status(tribo_system_set_limit_table(sys, 2, time, cases[i].limit), cases[i].status);
        ck_assert_str_eq(message, cases[i].text);
    }
    assert_status(tribo_system_set_limit_table(sys, 2, time, NULL), TRIBO_ERR_NULL);
    ck_assert_str_eq(message, "limit is NULL");
    assert_status(tribo_system_set_limit_table(sys, 2, NULL, cases[0].limit), TRIBO_ERR_NULL);
    ck_assert_str_eq(message, "time is NULL");
    tribo_system_destroy(sys);
}

TEST_MAIN("limits", {slides_on, 2}, {resonance, 2}, {lift_off, 2}, {touches_down_at_rest, 2}, {touches_down_pulled, 2},
          {grazing_lift_off, 2}, {released_at_the_load_s_extremum, 2}, {grazing_limit, 2}, {zero_limits, 2}, {constant, 1},
          {together, 2}, {doubled, 2}, {methods_agree, 12}, {reference_systems, 1}, {steppers, 1}, {energy, 12},
          {late_in_time, 2}, {table_lifts_off, 1}, {table_and_harmonics, 1}, {given_limits, 2}, {automatic, 1},
          {lent_context, 17}, {errors, 1}, {errors_of_tables, 1})
