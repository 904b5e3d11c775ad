/* SPDX-License-Identifier: BSD-3-Clause */
/* Static friction above kinetic in the drivers: closed forms and a published value, ties, and falling friction against an
 * integration of its own. */
#include <string.h>

#include "make.h"
#include "model.h"
#include "../../set_up_driver.h"

#define EVENTS 400

static const char *const located[] = {"exact", "event"};
static const double closeness[] = {1e-11, 1e-9};

/* What happened, and when. */
struct tape {
    size_t count;
    double t[EVENTS], y[EVENTS][2];
};

static int note(const tribo_moment *moment, void *data)
{
    const double t = moment->t, *y = moment->y;
    const int event = moment->kind != TRIBO_MOMENT_STEP;
    struct tape *tape = data;
    /* contacts that change together are one event */
    const int another = event && !(tape->count && tape->t[tape->count - 1] == t);
    if (another && tape->count < EVENTS) {
        tape->t[tape->count] = t;
        memcpy(tape->y[tape->count++], y, sizeof *tape->y);
    }
    return 0;
}

static void set_static(tribo_system *sys, double ratio, double velocity)
{
    double r[8], v[8];
    for (size_t i = 0; i < 8; i++) {
        r[i] = ratio;
        v[i] = velocity;
    }
    assert_ok(tribo_set_static(tribo_system_context(sys), r, velocity > 0.0 ? v : NULL));
}

/* A block on a spring, contacts of equal parts of the limit, on a belt at constant speed. */
static tribo_system *block(size_t contacts, double limit, double belt)
{
    const double one = 1.0, direction[] = {1.0, 1.0, 1.0};
    double speed[3], part[3];
    for (size_t i = 0; i < contacts; i++) {
        speed[i] = belt;
        part[i] = limit / (double)contacts;
    }
    tribo_system *sys;
    assert_ok(dense_system(&sys, 1, contacts, &one, NULL, &one, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_base_motion(sys, 0.0, speed, NULL));
    assert_ok(tribo_set_limit(tribo_system_context(sys), part));
    return sys;
}

/* A block on a belt sticks and slips, for times and by an amplitude that are known in closed form. Starts with the speed of the
 * belt. Redundant contacts break away together. */
TEST(belt)
{
    const int method = _i % 2;
    const size_t contacts = 1 + (size_t)_i / 2;
    const double limit = 0.6, d = 0.4, v0 = 0.2, t_stick = 2.0 * d / v0, t_slip = 2.0 * (PI - atan(d / v0));
    const double tolerance = closeness[method], amplitude = sqrt(d * d + v0 * v0);
    tribo_system *sys = block(contacts, limit, v0);
    set_static(sys, 1.0 / 0.6, 0.0);
    tribo_driver *drv = driver_create(sys, located[method], 0.1, 1e-12);
    struct tape tape = {0};
    assert_ok(tribo_driver_set_observer(drv, note, &tape));
    double y[3] = {1.0 - 2.0 * d, v0, 0.0}, t = 0.0;
    driver_advance(drv, &t, 80.0, y);
    assert_close(t_stick + t_slip, 8.0688878716, 1e-10);
    size_t breaks = 0, stops = 0;
    for (size_t k = 0; k < tape.count; k++) {
        const double phase = fmod(tape.t[k], t_stick + t_slip), round = tape.t[k] - phase;
        const double x = tape.y[k][0];
        if (x > 0.3 && x < 0.9) {
            continue; /* one contact at its limit, the others take over */
        }
        if (fabs(phase - t_stick) < 0.1) {
            assert_close(phase, t_stick, tolerance * (1.0 + round));
            assert_close(tape.y[k][0], 1.0, tolerance);
            breaks++;
        } else {
            /* at the end of a period; in exact arithmetic at the beginning of the next one */
            const double off = phase > 1.0 ? phase - t_stick - t_slip : phase;
            assert_close(off, 0.0, 10.0 * tolerance * (1.0 + round));
            assert_close(tape.y[k][0], 0.2, tolerance);
            stops++;
        }
    }
    require(breaks == 10 && stops == 9, "%zu times broken away, %zu times stuck", breaks, stops);
    /* from the state at 80, where it slides, the amplitude about limit/k */
    assert_close(hypot(y[0] - limit, y[1]), amplitude, tolerance);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Code_Aster SDND106: two masses on a spring, one of which rubs; the other one is pulled at until t = 0.2. */
TEST(code_aster_sdnd106)
{
    const double mass[] = {5.0, 0.0, 0.0, 5.0}, k = 1e4, stiffness[] = {k, -k, -k, k}, direction[] = {1.0, 0.0};
    const double load[] = {0.0, 3000.0}, limit = 2000.0;
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 1, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 0.0, load, NULL));
    assert_ok(tribo_set_limit(tribo_system_context(sys), &limit));
    set_static(sys, 1.5, 0.0);
    tribo_driver *drv = driver_create(sys, located[_i], 1e-3, 1e-13);
    struct tape tape = {0};
    assert_ok(tribo_driver_set_observer(drv, note, &tape));
    double y[5] = {0.0}, t = 0.0;
    driver_advance(drv, &t, 0.15, y);
    assert_close(y[0], 1.3533376609, 1e-10);
    assert_close(y[1], 1.8075324662, 1e-10);
    driver_advance(drv, &t, 0.2, y);
    assert_ok(tribo_system_clear_loads(sys));
    tape.count = 0;
    driver_advance(drv, &t, 0.32, y);
    require(tape.count >= 1, "no stop");
    assert_close(tape.t[0], 0.3149232754, 1e-10);
    assert_close(tape.y[0][0], 3.9556057735, 1e-9);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Two equal blocks, a spring between them, pulled apart ever harder: they break away at the same instant, as one that has twice
 * the spring would; and three of them with no spring between. */
TEST(equal_blocks)
{
    const int method = _i % 2, tied = _i / 2;
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, alone = 1.0 + 2.0 * tied, none = tied;
    const double stiffness[] = {1.0 + none, -none, -none, 1.0 + none}, direction[] = {1.0, 0.0, 0.0, 1.0};
    const double pull[] = {2.0, -2.0}, one = 1.0, limit[] = {1.0, 1.0};
    tribo_system *sys, *single;
    assert_ok(dense_system(&sys, 2, 2, mass, NULL, stiffness, direction, 0, NULL, 0));
    assert_ok(dense_system(&single, 1, 1, &one, NULL, &alone, &one, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 0.3, NULL, pull));
    assert_ok(tribo_system_add_load(single, 0.3, NULL, pull));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    assert_ok(tribo_set_limit(tribo_system_context(single), limit));
    set_static(sys, 1.5, 0.0);
    set_static(single, 1.5, 0.0);
    double y[5] = {0.0}, want[3] = {0.0};
    run(sys, located[method], 0.1, 1e-12, 60.0, y);
    run(single, located[method], 0.1, 1e-12, 60.0, want);
    ck_assert_double_gt(fabs(want[0]) + want[2], 0.5);
    assert_close(y[0], want[0], closeness[method]);
    assert_close(y[1], -want[0], closeness[method]);
    assert_close(y[4], 2.0 * want[2], 20.0 * closeness[method]);
    tribo_system_destroy(sys);
    tribo_system_destroy(single);
}

/* A load that comes up to the static limit and turns back moves nothing, also where an advance ends just before it does; one that
 * goes beyond does. */
TEST(up_to_the_limit)
{
    const int method = _i % 2, beyond = _i / 2 % 2, falls = _i / 4;
    const double load = 1.5 * (1.0 + (falls ? 0.1 : 1e-9) * beyond);
    tribo_system *sys = block(1, 1.0, 0.0);
    assert_ok(tribo_system_add_load(sys, 0.7, NULL, &load));
    set_static(sys, 1.5, falls ? 0.1 : 0.0);
    tribo_driver *drv = driver_create(sys, falls ? "event" : located[method], 0.1, 1e-12);
    double y[3] = {0.0}, t = 0.0;
    for (int k = 0; k < 10; k++) {
        driver_advance(drv, &t, ((double)k + 0.5) * PI / 0.7 - 2e-7, y);
    }
    tribo_driver_destroy(drv);
    ck_assert(beyond ? fabs(y[0]) > 0.01 && y[2] > 0.1 : y[0] == 0.0 && y[1] == 0.0 && y[2] == 0.0);
    tribo_system_destroy(sys);
}

/* Ratios of 1 change no bit, with any method; open contacts stay open. */
TEST(ratio_of_one)
{
    static const char *const methods[] = {"exact", "event", "central/fixed", "moreau/fixed", "rk4/fixed", "rkf45", "msbdf"};
    double y[2][17] = {{0.0}};
    for (int k = 0; k < 2; k++) {
        tribo_system *sys;
        double limit[8] = {0.1, 0.0, 0.1, 0.12, 0.0, 0.1, 0.1, 0.1};
        assert_ok(tribo_system_chain(&sys, 8, 1.0, 0.4, 0.5));
        assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
        assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 1e-3));
        if (k) {
            set_static(sys, 2.0, 0.0);
            set_static(sys, 1.0, 0.5);
        }
        run(sys, methods[_i], 0.01, 1e-8, 10.0, y[k]);
        tribo_system_destroy(sys);
    }
    assert_all_exact(y[1], y[0], 17);
}

/* At rest between limit and static limit, the latter is taken away: the block slides. */
TEST(undone)
{
    const int method = _i;
    tribo_system *sys = block(1, 1.0, 0.0);
    set_static(sys, 1.5, 0.0);
    tribo_driver *drv = driver_create(sys, located[method], 0.1, 1e-12);
    double y[3] = {1.4, 0.0, 0.0}, t = 0.0;
    driver_advance(drv, &t, 1.0, y);
    assert_exact(y[0], 1.4);
    assert_ok(tribo_set_static(tribo_system_context(sys), NULL, NULL));
    driver_advance(drv, &t, 1.0 + PI, y);
    assert_close(y[0], 0.6, 1e-9);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* The two located methods agree about chains, where what one block no longer carries comes to others. */
TEST(chains)
{
    double y[2][17] = {{0.0}};
    for (int k = 0; k < 2; k++) {
        tribo_system *sys;
        assert_ok(tribo_system_chain(&sys, 8, 1.0, 0.35 + 0.05 * _i, 0.5));
        set_static(sys, 1.3 + 0.1 * _i, 0.0);
        run(sys, located[k], 0.01, 1e-12, 20.0, y[k]);
        tribo_system_destroy(sys);
    }
    ck_assert_double_gt(y[0][16], 1e-3);
    assert_all_close(y[0], y[1], 17, 1e-8);
}

/* At once two contacts cannot hold, but one of them, by what the other one still carries, does. A step is no different. */
TEST(held_after_all)
{
    const double one[] = {1.0, 0.0, 0.0, 1.0}, slope = sqrt(0.19), direction[] = {1.0, 0.0, -0.9, slope}, limit[] = {1.0, 1.0};
    const double ratio[] = {3.0, 1.1}, load[] = {-2.02, (0.02 - 0.9 * 2.02) / slope}, end = 0.01;
    static const char *const methods[] = {"exact", "event", "moreau/fixed", "central/fixed"};
    double y[5] = {0.0}, t = 0.0;
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 2, one, NULL, one, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 0.0, load, NULL));
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    assert_ok(tribo_set_static(tribo_system_context(sys), ratio, NULL));
    tribo_driver *drv = driver_create(sys, methods[_i], 1e-3, 1e-12);
    driver_advance(drv, &t, end, y);
    require(_i > 1 || driver_count(drv, TRIBO_COUNT_EVENTS) == 0, "it slides first");
    tribo_driver_destroy(drv);
    /* f_2 = 0.88, with which contact 2 stays and contact 1 accelerates by -1.812 */
    assert_close(slope * y[1] - 0.9 * y[0], 0.0, 1e-15);
    assert_close(y[2], -1.812 * end, 1e-5);
    tribo_system_destroy(sys);
}

/* Contacts that share bodies, on moving bases. */
TEST(coupled)
{
    struct random g = random_of(_i);
    const struct model m = model_create(&g, _i % 2);
    tribo_system *sys = model_system(&m, 0, 0, 0.05);
    double y[2][DIMENSION] = {{0.5, 0.0, -0.5}, {0.5, 0.0, -0.5}};
    set_static(sys, 1.1 + 0.1 * (_i % 5), 0.0);
    for (int k = 0; k < 2; k++) {
        run(sys, located[k], 0.1, 1e-12, 12.0, y[k]);
    }
    assert_all_close(y[0], y[1], DIMENSION, 1e-8);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------------ falling friction */

/* The same with limits that fall, beside steps; of some contacts only. */
TEST(coupled_and_falling)
{
    struct random g = random_of(_i);
    const double more = 0.1 + 0.1 * (_i % 5), ratio[] = {1.0 + more, _i % 4 ? 1.0 : 1.0 + more, 1.0 + 2.0 * more};
    const double velocity[] = {0.5, 0.5, 0.5};
    const struct model m = model_create(&g, _i % 2);
    tribo_system *sys = model_system(&m, 0, 0, 0.05);
    double y[3][DIMENSION] = {{0.5, 0.0, -0.5}, {0.5, 0.0, -0.5}, {0.5, 0.0, -0.5}};
    assert_ok(tribo_set_static(tribo_system_context(sys), ratio, velocity));
    if (_i % 3 == 0) {
        const double time[] = {0.0, 4.0, 7.0}, limit[] = {0.5, 1.0, 0.25, 1.5, 0.2, 0.75, 0.1, 0.1, 0.1};
        assert_ok(tribo_system_set_limit_table(sys, 3, time, limit));
    }
    run(sys, "event", 0.1, 1e-12, 6.0, y[0]);
    run(sys, "event", 0.1, 1e-8, 6.0, y[1]);
    run(sys, "moreau/fixed", 2e-4, 0.0, 6.0, y[2]);
    assert_all_close(y[0], y[1], DIMENSION, 1e-6);
    assert_all_close(y[0], y[2], DIMENSION, 3e-3);
    tribo_system_destroy(sys);
}

/* A block on a spring, limit 0.6 + 0.4 exp(-|v|/scale), that slides on a belt towards one side: x'' = -x - side N(|x' - v0|). */
struct fall {
    double v0, scale, side;
};

static void rate(const struct fall *p, const double *y, double *d)
{
    const double speed = p->side * (y[1] - p->v0), limit = 0.6 + 0.4 * exp(-speed / p->scale);
    d[0] = y[1];
    d[1] = -y[0] - p->side * limit;
    d[2] = limit * speed;
}

static void rk4(const struct fall *p, double h, double *y)
{
    double k[4][3], at[3];
    rate(p, y, k[0]);
    for (int s = 1; s < 4; s++) {
        for (int i = 0; i < 3; i++) {
            at[i] = y[i] + (s == 3 ? h : 0.5 * h) * k[s - 1][i];
        }
        rate(p, at, k[s]);
    }
    for (int i = 0; i < 3; i++) {
        y[i] += h / 6.0 * (k[0][i] + 2.0 * k[1][i] + 2.0 * k[2][i] + k[3][i]);
    }
}

/* Slides in steps of h until the velocity against the belt is zero again; Newton's method finds the rest of the last step. */
static double slide(const struct fall *p, double h, double *y)
{
    double t = 0.0, d[3];
    do {
        rk4(p, h, y);
        t += h;
    } while (p->side * (y[1] - p->v0) > 0.0);
    for (int k = 0; k < 5; k++) {
        rate(p, y, d);
        const double back = -(y[1] - p->v0) / d[1];
        rk4(p, back, y);
        t += back;
    }
    return t;
}

/* A block slides ever faster on another one, which rests just at its limit, and which a load pulls the same way ever harder: what
 * the first one carries over falls faster than that, so that the second one stays. */
TEST(relieved_by_speed)
{
    const double one[] = {1.0, 0.0, 0.0, 1.0}, direction[] = {1.0, -1.0, 0.0, 1.0}, ratio[] = {2.0, 1.0}, velocity[] = {0.5, 0.5};
    const double pull[] = {5.0, 0.0}, more[] = {0.0, 0.1}, v[] = {0.3, 0.0}, none[] = {0.0, 0.0};
    double limit[] = {1.0, 9.0}, f[2], y[5] = {0.0, 0.0, 0.3, 0.0, 0.0}, t = 0.0;
    tribo_system *sys;
    assert_ok(dense_system(&sys, 2, 2, one, NULL, one, direction, 0, NULL, 0));
    assert_ok(tribo_system_add_load(sys, 0.0, pull, NULL));
    assert_ok(tribo_system_add_load(sys, 1.0, NULL, more));
    tribo_context *c = tribo_system_context(sys);
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_static(c, ratio, velocity));
    assert_ok(tribo_force(c, v, none, f));
    limit[1] = -f[0];
    assert_ok(tribo_set_limit(c, limit));
    tribo_driver *drv = driver_create(sys, "event", 0.1, 1e-12);
    driver_advance(drv, &t, 0.3, y);
    assert_exact(y[1], 0.0);
    ck_assert_uint_eq(driver_count(drv, TRIBO_COUNT_EVENTS), 0);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Stick-slip with a Stribeck curve: period, place of the stop and dissipation. */
TEST(falling_on_a_belt)
{
    const struct fall p = {0.2, 0.3, -1.0};
    double at[3] = {1.0, p.v0, 0.0};
    const double t_slip = slide(&p, 1e-4, at);
    const double t_stick = (1.0 - at[0]) / p.v0, period = t_stick + t_slip;
    tribo_system *sys = block(1 + (size_t)_i, 0.6, p.v0);
    set_static(sys, 1.0 / 0.6, p.scale);
    tribo_driver *drv = driver_create(sys, "event", 0.1, 1e-13);
    struct tape tape = {0};
    assert_ok(tribo_driver_set_observer(drv, note, &tape));
    double y[3] = {1.0 - p.v0, p.v0, 0.0}, t = 0.0;
    driver_advance(drv, &t, 1.0 + 3.0 * period + 0.5 * t_stick, y);
    size_t stops = 0;
    for (size_t k = 0; k < tape.count; k++) {
        if (tape.y[k][0] < 0.9) {
            stops++;
            assert_close(tape.t[k], 1.0 + t_slip + (double)(stops - 1) * period, 2e-9);
            assert_close(tape.y[k][0], at[0], 1e-9);
        }
    }
    ck_assert_uint_eq(stops, 3);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

/* Left alone the block's energy goes, turn by turn, by falling friction: exactly what the state says. */
TEST(falling_to_rest)
{
    const double start = 6.0;
    struct fall p = {0.0, 0.3, -1.0};
    double want[3] = {start, 0.0, 0.0}, t = 0.0;
    while (fabs(want[0]) > 1.0) {
        p.side = want[0] > 0.0 ? -1.0 : 1.0;
        t += slide(&p, 1e-4, want);
        want[1] = 0.0;
    }
    tribo_system *sys = block(1, 0.6, 0.0);
    set_static(sys, 1.0 / 0.6, p.scale);
    double y[3] = {start, 0.0, 0.0};
    run(sys, "event", 0.1, 1e-13, t + 1.0, y);
    assert_close(y[0], want[0], 1e-9);
    assert_exact(y[1], 0.0);
    assert_close(y[2], want[2], 1e-9);
    assert_close(y[2], 0.5 * (start * start - y[0] * y[0]), 1e-11);
    tribo_system_destroy(sys);
}

/* Methods with steps come to the same, with first order. */
TEST(steps)
{
    static const char *const methods[] = {"rk4/fixed", "central/fixed", "moreau/fixed"};
    const char *method = methods[_i % 3];
    const double velocity = _i / 3 ? 0.3 : 0.0, dt[] = {4e-3, 2e-3, 1e-3, 5e-4};
    double want[3] = {0.5, 0.2, 0.0}, error[4];
    tribo_system *sys = block(1, 0.6, 0.2);
    set_static(sys, 1.0 / 0.6, velocity);
    run(sys, "event", 0.1, 1e-12, 30.0, want);
    for (int k = 0; k < 4; k++) {
        double y[3] = {0.5, 0.2, 0.0};
        assert_ok(tribo_set_epsilon_step(tribo_system_context(sys), dt[k], 1.0));
        run(sys, method, dt[k], 0.0, 30.0, y);
        error[k] = fabs(y[0] - want[0]) + fabs(y[1] - want[1]) + fabs(y[2] - want[2]);
    }
    require(error[3] < 4e-3, "%s: error %g", method, error[3]);
    ck_assert_double_lt(error[3], 0.5 * error[0]);
    tribo_system_destroy(sys);
}

/* GSL's steppers, by the law with its epsilon; implicit ones by its tangents. */
TEST(steppers)
{
    static const char *const methods[] = {"rkf45", "msbdf", "bsimp"};
    double want[3] = {0.5, 0.2, 0.0}, y[3] = {0.5, 0.2, 0.0};
    tribo_system *sys = block(1, 0.6, 0.2);
    set_static(sys, 1.0 / 0.6, _i / 3 ? 0.3 : 0.0);
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 1e-4));
    run(sys, "event", 0.1, 1e-12, 12.0, want);
    run(sys, methods[_i % 3], 1e-3, 1e-7, 12.0, y);
    assert_all_close(y, want, 3, 2e-3);
    tribo_system_destroy(sys);
}

/* "exact" has no closed form for them, and says so; "auto" takes "event". */
TEST(refusal)
{
    double y[3] = {0.5, 0.2, 0.0}, t = 0.0, want[3] = {0.5, 0.2, 0.0};
    tribo_system *sys = block(1, 0.6, 0.2);
    tribo_driver *drv = driver_create(sys, "exact", 0.1, 0.0), *none = NULL;
    set_static(sys, 1.5, 0.3);
    assert_status(set_up_driver(&none, sys, "exact", 0.1, 0.0, 0.0), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_system_message(sys), "contact 0 has a static limit that falls with the speed");
    ck_assert_ptr_null(none);
    assert_status(tribo_driver_advance(drv, &t, 1.0, y), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(drv), "contact 0 has a static limit that falls with the speed");
    assert_says(tribo_driver_message(drv), "take event or auto");
    assert_exact(t, 0.0);
    assert_exact(y[0], 0.5);
    tribo_driver_destroy(drv);
    run(sys, "event", 0.1, 1e-12, 10.0, want);
    run(sys, "auto", 0.1, 1e-12, 10.0, y);
    assert_all_close(y, want, 3, 1e-11);
    tribo_system_destroy(sys);
}

TEST_MAIN("breakaway", {belt, 6}, {code_aster_sdnd106, 2}, {equal_blocks, 4}, {up_to_the_limit, 8}, {ratio_of_one, 7},
          {undone, 2}, {chains, 4}, {held_after_all, 4}, {coupled, 40}, {coupled_and_falling, 20}, {relieved_by_speed, 1},
          {falling_on_a_belt, 2}, {falling_to_rest, 1}, {steps, 6}, {steppers, 6}, {refusal, 1})
