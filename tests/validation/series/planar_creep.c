/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar contacts that creep in driver "event": motions of closed form, which take no more steps the slower they are. */
#include "make.h"
#include "run.h"

#include <stdlib.h>
#include <string.h>

static const double unit[4] = {1.0, 0.0, 0.0, 1.0}, none[4] = {0.0};

/* So many steps are enough for a turn. */
#define ENOUGH 60

/* A mass of 1 without springs, the limits of its planar contact being these. */
static tribo_system *block(double limit1, double limit2)
{
    tribo_system *s;
    assert_ok(dense_system(&s, 2, 2, unit, NULL, none, unit, 0, NULL, 0));
    assert_ok(tribo_set_planar(tribo_system_context(s), 1, (const size_t[]){0}));
    assert_ok(tribo_set_limit(tribo_system_context(s), (const double[]){limit1, limit2}));
    return s;
}

/* Limit 1 and a load of a little more that turns: v = v0 (-sin t, cos t), which the load is v' - (limit 1) v/|v| for. */
static tribo_system *turning(double v0)
{
    tribo_system *s = block(1.0, 1.0);
    assert_ok(tribo_system_add_load(s, 1.0, (const double[]){-v0, 1.0}, (const double[]){-1.0, -v0}));
    return s;
}

static void start_turning(double v0, double *y)
{
    memcpy(y, (const double[5]){v0, 0.0, 0.0, v0, 0.0}, 5 * sizeof *y);
}

static void assert_turned(const double *y, double v0, double t)
{
    const double want[5] = {v0 * cos(t), v0 * sin(t), -v0 * sin(t), v0 * cos(t), v0 * t};
    assert_all_close(y, want, 5, 2e-9);
}

TEST(turn)
{
    const double v0 = pow(10.0, -2.0 - _i), t1 = 2.0 * PI;
    double y[5], t = 0.0;
    start_turning(v0, y);
    tribo_system *s = turning(v0);
    tribo_driver *d = driver_create(s, "event", 0.1, 1e-10);
    driver_advance(d, &t, t1, y);
    assert_turned(y, v0, t1);
    require(driver_count(d, TRIBO_COUNT_STEPS) <= ENOUGH, "v0 = %g: %zu steps", v0, driver_count(d, TRIBO_COUNT_STEPS));
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* In parts, each of which goes on as the one before did; and the same again, to the last digit. */
TEST(parts)
{
    const double v0 = 1e-5;
    double y[2][5];
    tribo_system *s = turning(v0);
    tribo_driver *d = driver_create(s, "event", 0.1, 1e-10);
    for (int run = 0; run < 2; run++) {
        double t = 0.0;
        start_turning(v0, y[run]);
        for (int k = 1; k <= 50; k++) {
            driver_advance(d, &t, 0.1 * k, y[run]);
        }
    }
    assert_turned(y[0], v0, 5.0);
    assert_all_exact(y[1], y[0], 5);
    require(driver_count(d, TRIBO_COUNT_STEPS) <= 2 * (50 + ENOUGH), "%zu steps", driver_count(d, TRIBO_COUNT_STEPS));
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* v = v0 cos(s t) (cos t, sin t), until it stops at t = pi/2s, by a load of three frequencies; then it rests, since the load has
 * become less than the limit. */
TEST(comes_to_rest)
{
    const double v0 = pow(10.0, -3.0 - _i), slow = 0.2, fast = 1.0 + slow, less = 1.0 - slow, stop = 0.5 * PI / slow;
    const double until[2] = {0.6 * stop, 1.5 * stop};
    double y[5] = {0.0, 0.0, v0, 0.0, 0.0}, t = 0.0;
    tribo_system *s = block(1.0, 1.0);
    assert_ok(tribo_system_add_load(s, 1.0, (const double[]){1.0, 0.0}, (const double[]){0.0, 1.0}));
    assert_ok(tribo_system_add_load(s, fast, (const double[]){0.0, 0.5 * v0 * fast}, (const double[]){-0.5 * v0 * fast, 0.0}));
    assert_ok(tribo_system_add_load(s, less, (const double[]){0.0, 0.5 * v0 * less}, (const double[]){-0.5 * v0 * less, 0.0}));
    tribo_driver *d = driver_create(s, "event", 0.1, 1e-11);
    for (int k = 0; k < 2; k++) {
        const double moved = k ? stop : until[k];
        driver_advance(d, &t, until[k], y);
        assert_close(y[0], 0.5 * v0 * (sin(fast * moved) / fast + sin(less * moved) / less), 2e-9);
        assert_close(y[1], 0.5 * v0 * ((1.0 - cos(fast * moved)) / fast + (1.0 - cos(less * moved)) / less), 2e-9);
        assert_close(y[2], k ? 0.0 : v0 * cos(slow * moved) * cos(moved), k ? 0.0 : 2e-9);
        assert_close(y[3], k ? 0.0 : v0 * cos(slow * moved) * sin(moved), k ? 0.0 : 2e-9);
        assert_close(y[4], v0 / slow * sin(slow * moved), 1e-8);
    }
    assert_close((double)driver_count(d, TRIBO_COUNT_EVENTS), 1.0, 0.0);
    require(driver_count(d, TRIBO_COUNT_STEPS) <= 3 * ENOUGH, "v0 = %g: %zu steps", v0, driver_count(d, TRIBO_COUNT_STEPS));
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* ----------------------------------------------------------------------------------------------------- several contacts */

enum { BODIES = 3, SIZE = 2 * BODIES };

/* Each body turns at its own slow speed and phase, with masses and springs, of one direction, between them. */
struct turning_bodies {
    double mass[BODIES][BODIES], stiff[BODIES][BODIES], limit[BODIES], speed[BODIES], phase[BODIES];
};

static const struct turning_bodies bodies = {.mass = {{1.0, 0.1, 0.0}, {0.1, 1.3, -0.05}, {0.0, -0.05, 0.8}},
                                             .stiff = {{0.4, -0.2, 0.0}, {-0.2, 0.9, -0.3}, {0.0, -0.3, 0.6}},
                                             .limit = {1.0, 0.7, 0.4},
                                             .speed = {1e-4, 3e-6, 2e-2},
                                             .phase = {0.3, 2.0, -1.1}};

/* Of both directions, which do not know each other. */
static void both(const double (*one)[BODIES], double *to)
{
    for (size_t k = 0; k < SIZE * SIZE; k++) {
        const size_t i = k / SIZE, j = k % SIZE;
        to[k] = i % 2 == j % 2 ? one[i / 2][j / 2] : 0.0;
    }
}

/* Velocity of body i: speed (cos, sin)(t + phase). At t its place and velocity. */
static void place(double t, double *y)
{
    for (size_t i = 0; i < BODIES; i++) {
        const double angle = t + bodies.phase[i];
        y[2 * i] = bodies.speed[i] * sin(angle);
        y[2 * i + 1] = -bodies.speed[i] * cos(angle);
        y[SIZE + 2 * i] = bodies.speed[i] * cos(angle);
        y[SIZE + 2 * i + 1] = bodies.speed[i] * sin(angle);
    }
}

/* M q'' + K q + limit v/|v| at t: the load there. */
static void load_at(double t, double *load)
{
    double y[2 * SIZE];
    place(t, y);
    for (size_t i = 0; i < SIZE; i++) {
        load[i] = bodies.limit[i / 2] * y[SIZE + i] / bodies.speed[i / 2];
        for (size_t j = 0; j < BODIES; j++) {
            load[i] += (bodies.stiff[i / 2][j] - bodies.mass[i / 2][j]) * y[2 * j + i % 2];
        }
    }
}

TEST(coupled)
{
    double mass[SIZE * SIZE], stiff[SIZE * SIZE], contact[SIZE * SIZE] = {0.0}, limit[SIZE], cosine[SIZE], sine[SIZE];
    double y[2 * SIZE + 1] = {0.0}, want[2 * SIZE + 1] = {0.0}, t = 0.0;
    const double t1 = 2.0 * PI;
    both(bodies.mass, mass);
    both(bodies.stiff, stiff);
    for (size_t i = 0; i < SIZE; i++) {
        contact[i * SIZE + i] = 1.0;
        limit[i] = bodies.limit[i / 2];
    }
    load_at(0.0, cosine);
    load_at(0.5 * PI, sine);
    tribo_system *s;
    assert_ok(dense_system(&s, SIZE, SIZE, mass, NULL, stiff, contact, 0, NULL, 0));
    assert_ok(tribo_set_planar(tribo_system_context(s), BODIES, (const size_t[]){0, 2, 4}));
    assert_ok(tribo_set_limit(tribo_system_context(s), limit));
    assert_ok(tribo_system_add_load(s, 1.0, cosine, sine));
    tribo_driver *d = driver_create(s, "event", 0.1, 1e-10);
    place(0.0, y);
    driver_advance(d, &t, t1, y);
    place(t1, want);
    for (size_t i = 0; i < BODIES; i++) {
        want[2 * SIZE] += bodies.limit[i] * bodies.speed[i] * t1;
    }
    assert_all_close(y, want, 2 * SIZE + 1, 3e-9);
    require(driver_count(d, TRIBO_COUNT_STEPS) <= 2 * ENOUGH, "%zu steps", driver_count(d, TRIBO_COUNT_STEPS));
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* Masses of 1 that nothing joins, each on a planar contact, under loads of frequency 1. */
struct block {
    double limit, place[2], speed[2], cosine[2], sine[2];
};

/* Returns how many steps they take until t1; y [4 count + 1]. */
static size_t run_blocks(size_t count, const struct block *b, double tolerance, double t1, double *y)
{
    const size_t n = 2 * count;
    double mass[16] = {0.0}, limit[4], cosine[4], sine[4], t = 0.0;
    const double springs[16] = {0.0};
    tribo_system *s;
    y[2 * n] = 0.0;
    for (size_t i = 0; i < n; i++) {
        mass[i * (n + 1)] = 1.0;
        limit[i] = b[i / 2].limit;
        cosine[i] = b[i / 2].cosine[i % 2];
        sine[i] = b[i / 2].sine[i % 2];
        y[i] = b[i / 2].place[i % 2];
        y[n + i] = b[i / 2].speed[i % 2];
    }
    assert_ok(dense_system(&s, n, n, mass, NULL, springs, mass, 0, NULL, 0));
    assert_ok(tribo_set_planar(tribo_system_context(s), count, (const size_t[]){0, 2}));
    assert_ok(tribo_set_limit(tribo_system_context(s), limit));
    assert_ok(tribo_system_add_load(s, 1.0, cosine, sine));
    tribo_driver *d = driver_create(s, "event", 0.1, tolerance);
    driver_advance(d, &t, t1, y);
    const size_t steps = driver_count(d, TRIBO_COUNT_STEPS);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
    return steps;
}

/* Beside one that creeps the other block turns fast; or slows down until its load has turned it, within a short time; or begins
 * to slide so slowly that its speed is nothing beside the tolerance for long. It moves as it does alone. */
TEST(beside)
{
    const double v0 = 1e-7, t1 = 4.0;
    const struct block other[3] = {
        {.limit = 0.6, .place = {0.5, 0.0}, .speed = {0.0, 0.5}, .cosine = {-1.5, 0.6}, .sine = {-0.6, -0.2}},
        {.limit = 0.5, .speed = {5e-3, 0.0}, .cosine = {0.0, 0.51}, .sine = {0.0, 0.0}},
        {.limit = 3e-5, .cosine = {0.0, 0.0}, .sine = {3.2e-5, 1e-5}},
    };
    const struct block both[2] = {
        {.limit = 1.0, .place = {v0, 0.0}, .speed = {0.0, v0}, .cosine = {-v0, 1.0}, .sine = {-1.0, -v0}}, other[_i]};
    double y[9], alone[5];
    run_blocks(1, &other[_i], 1e-12, t1, alone);
    const size_t steps = run_blocks(2, both, 1e-10, t1, y);
    for (size_t k = 0; k < 2; k++) {
        assert_close(y[2 + k], alone[k], 1e-8);
        assert_close(y[6 + k], alone[2 + k], 1e-8);
    }
    const double turned[5] = {y[0], y[1], y[4], y[5], y[8] - alone[4]};
    assert_turned(turned, v0, t1);
    require(hypot(alone[0], alone[1]) > 1e-8, "the other block rests");
    require(steps <= 3 * ENOUGH, "%zu steps", steps);
}

/* Limits that differ by direction, a load that turns and swings, and a kick across to begin with: tolerances are kept, and
 * methods with steps come to the same. */
static void run_ellipse(const char *method, double dt, double tolerance, double *y)
{
    tribo_system *s = block(1.0, 1.4);
    memcpy(y, (const double[5]){0.0, 0.0, -2e-5, 1e-5, 0.0}, 5 * sizeof *y);
    assert_ok(tribo_system_add_load(s, 0.6, (const double[]){1.0001, 0.0}, (const double[]){0.0, 1.4001}));
    assert_ok(tribo_system_add_load(s, 0.9, (const double[]){1e-4, 5e-5}, (const double[]){0.0, 1e-4}));
    assert_ok(tribo_set_epsilon_step(tribo_system_context(s), dt, 1.0));
    run(s, method, dt, tolerance, 8.0, y);
    tribo_system_destroy(s);
}

TEST(ellipse)
{
    double rough[5], fine[5], coarse[5], steps[5];
    run_ellipse("event", 0.1, 1e-9, rough);
    run_ellipse("event", 0.1, 1e-13, fine);
    assert_all_close(rough, fine, 5, 1e-7);
    run_ellipse("moreau/fixed", 1e-2, 0.0, coarse);
    run_ellipse("moreau/fixed", 1e-4, 0.0, steps);
    assert_all_close(steps, fine, 5, 1e-6);
    require(fabs(steps[4] - fine[4]) < 0.1 * fabs(coarse[4] - fine[4]), "%g after %g", steps[4] - fine[4], coarse[4] - fine[4]);
    require(fine[4] > 1e-4, "nothing slides");
}

/* So many blocks that turn alike. */
static tribo_system *many_turning(size_t many, double v0, double *y)
{
    double *mass = calloc(8 * many * many + 5 * many, sizeof *mass), *springs = mass + 4 * many * many;
    double *cosine = springs + 4 * many * many, *sine = cosine + 2 * many;
    size_t *first = calloc(many, sizeof *first);
    for (size_t i = 0; i < 2 * many; i++) {
        mass[i * (2 * many + 1)] = 1.0;
        first[i / 2] = i - i % 2;
        cosine[i] = i % 2 ? 1.0 : -v0;
        sine[i] = i % 2 ? -v0 : -1.0;
        y[i] = i % 2 ? 0.0 : v0;
        y[2 * many + i] = i % 2 ? v0 : 0.0;
    }
    y[4 * many] = 0.0;
    tribo_system *s;
    assert_ok(dense_system(&s, 2 * many, 2 * many, mass, NULL, springs, mass, 0, NULL, 0));
    assert_ok(tribo_set_planar(tribo_system_context(s), many, first));
    assert_ok(tribo_set_limit_all(tribo_system_context(s), 1.0));
    assert_ok(tribo_system_add_load(s, 1.0, cosine, sine));
    free(first);
    free(mass);
    return s;
}

enum { SOME = 40, MANY = 129 };

TEST(many)
{
    double y[4 * SOME + 1], t = 0.0;
    const double v0 = 1e-7, t1 = 2.0;
    tribo_system *s = many_turning(SOME, v0, y);
    tribo_driver *d = driver_create(s, "event", 0.1, 1e-10);
    driver_advance(d, &t, t1, y);
    for (size_t k = 0; k < SOME; k++) {
        const double *q = y + 2 * k, *u = q + 2 * SOME, one[5] = {q[0], q[1], u[0], u[1], y[4 * SOME] / SOME};
        assert_turned(one, v0, t1);
    }
    require(driver_count(d, TRIBO_COUNT_STEPS) <= ENOUGH, "%zu steps", driver_count(d, TRIBO_COUNT_STEPS));
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

/* More contacts than that are solved for at once go on by short steps, to an error in the end: a long case. */
TEST(too_many)
{
    if (!more()) {
        return;
    }
    double y[4 * MANY + 1], t = 0.0;
    const double v0 = 1e-9;
    tribo_system *s = many_turning(MANY, v0, y);
    tribo_driver *d = driver_create(s, "event", 0.1, 1e-10);
    assert_status(tribo_driver_advance(d, &t, 1.0, y), TRIBO_ERR_STEP);
    assert_says(tribo_driver_message(d), "lead nowhere: take moreau/fixed");
    assert_close(hypot(y[2 * MANY], y[2 * MANY + 1]), v0, 1e-10);
    require(t > 0.0 && t < 0.1, "t = %g", t);
    tribo_driver_destroy(d);
    tribo_system_destroy(s);
}

TEST_MAIN("planar_creep", {turn, 8}, {parts, 1}, {comes_to_rest, 4}, {coupled, 1}, {beside, 3}, {ellipse, 1}, {many, 1},
          {too_many, 1})
