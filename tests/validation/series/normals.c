/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts whose limits follow the motion: reference values of motions, by two independent codes each; orders of fixed steps;
 * derivatives of periodic motions; normals that contacts share; what is refused. */
#include "run.h"
#include "squeal.h"

#include <string.h>

enum { MOST = 16, EVENTS = 8 };

static const double full_turn = 6.283185307179586;

/* x'' + cx x' + 12 x + f = Fx cos wt, y'' + 2 y' + 21 y + N = 100 + Fy cos wt, N = 21 max(y, 0), limit 0.85 N, cx = 0.1 sqrt 12.
 * The elastic contact has stiffness 5. In coordinates turned by an angle both rows of J, and K, have several entries. damped:
 * factor of the damping. coupling: stiffness between x and y. */
static tribo_system *shaker_with(double fx, double fy, double omega, double soft, double turn, double damped, double coupling)
{
    const double c = cos(turn), s = sin(turn), cx = 0.1 * sqrt(12.0) * damped, cy = 2.0 * damped, mass[] = {1.0, 0.0, 0.0, 1.0};
    const double damping[] = {cx * c * c + cy * s * s, (cx - cy) * c * s, (cx - cy) * c * s, cx * s * s + cy * c * c};
    const double shared = (c * c - s * s) * coupling - 9.0 * c * s;
    const double stiffness[] = {12.0 * c * c + 21.0 * s * s - 2.0 * c * s * coupling, shared, shared,
                                12.0 * s * s + 21.0 * c * c + 2.0 * c * s * coupling};
    const double direction[] = {c, s, -s, c}, compliance[] = {soft, 0.0};
    const double steady[] = {-100.0 * s, 100.0 * c}, swing[] = {fx * c - fy * s, fx * s + fy * c};
    tribo_model *model = dense_model(2, 2, mass, damping, stiffness, direction);
    assert_ok(tribo_model_set_compliance(model, compliance));
    assert_ok(tribo_model_set_normal(model, 0, 1, 0.85, 21.0, 0.0));
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_system_add_load(sys, 0.0, steady, NULL));
    assert_ok(tribo_system_add_load(sys, omega, swing, NULL));
    return sys;
}

static tribo_system *shaker(double fx, double fy, double omega, double soft, double turn)
{
    return shaker_with(fx, fy, omega, soft, turn, 1.0, 0.0);
}

/* The methods with events. */
static tribo_driver *driver_of(tribo_system *sys, int exact)
{
    return driver_create(sys, exact ? "exact" : "event", exact ? 1e6 : 0.0, 0.0);
}

/* Moments of contacts, and extremes of y_0 that an observer sees. */
struct seen {
    size_t values, count; /* values: of y, that are kept */
    int kind[EVENTS];
    double t[EVENTS], y[EVENTS][4], most, least;
};

static int look(const tribo_moment *moment, void *data)
{
    struct seen *s = data;
    s->most = fmax(s->most, moment->y[0]);
    s->least = fmin(s->least, moment->y[0]);
    if (moment->kind != TRIBO_MOMENT_STEP && s->count < EVENTS) {
        s->kind[s->count] = moment->kind;
        s->t[s->count] = moment->t;
        memcpy(s->y[s->count++], moment->y, s->values * sizeof *moment->y);
    }
    return 0;
}

/* Loads; steady motion: extremes of x, energy a period, x and x' at the period's beginning, events. */
static const struct value {
    double fx, fy, omega, most, least, energy, x, u;
    int kind[4];
    double t[4];
} values[] = {
    {80.0,
     8.0,
     3.6,
     31.8774966,
     -32.4500590,
     4023.95945230,
     1.07617323796,
     114.223039188,
     {TRIBO_MOMENT_STICK, TRIBO_MOMENT_SLIP, TRIBO_MOMENT_STICK, TRIBO_MOMENT_SLIP},
     {0.434985393, 0.719887780, 1.293117369, 1.600127917}},
    {80.0,
     8.0,
     3.0,
     10.1088457,
     -10.7945178,
     331.541037,
     9.73329725389,
     8.13817691534,
     {TRIBO_MOMENT_STICK, TRIBO_MOMENT_SLIP, TRIBO_MOMENT_STICK, TRIBO_MOMENT_SLIP},
     {0.094371455, 0.844235571, 1.135060673, 1.870622800}},
    {100.0,
     10.0,
     3.6,
     44.0832493,
     -44.7881342,
     6109.163442,
     -5.93924926803,
     157.046948022,
     {TRIBO_MOMENT_STICK, TRIBO_MOMENT_SLIP, TRIBO_MOMENT_STICK, TRIBO_MOMENT_SLIP},
     {0.480612513, 0.717042420, 1.339525884, 1.600209500}},
    {60.0,
     60.0,
     5.0,
     6.2164272,
     -5.6224136,
     91.379129104,
     -5.44592597,
     7.32000819,
     {TRIBO_MOMENT_SLIP, TRIBO_MOMENT_LIFT, TRIBO_MOMENT_TOUCH, 0},
     {0.471637030, 0.585951290, 0.908836362, 0.0}},
    {60.0,
     90.0,
     5.5,
     2.9020668,
     -4.3523103,
     127.352515,
     -4.21484280,
     5.49746536,
     {TRIBO_MOMENT_SLIP, TRIBO_MOMENT_LIFT, TRIBO_MOMENT_TOUCH, 0},
     {0.486483491, 0.535378132, 1.049184890, 0.0}},
};

enum { VALUES = sizeof values / sizeof *values };

TEST(steady_motions)
{
    const struct value *v = &values[_i % VALUES];
    const double period = full_turn / v->omega;
    tribo_system *sys = shaker(v->fx, v->fy, v->omega, 0.2, 0.0);
    tribo_driver *d = driver_of(sys, _i >= VALUES);
    double t = 0.0, y[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    struct seen s = {.most = -HUGE_VAL, .least = HUGE_VAL};
    driver_advance(d, &t, 200.0 * period, y);
    y[5] = 0.0;
    assert_close(y[0], v->x, 3e-9);
    assert_close(y[2], v->u, 1e-8);
    assert_ok(tribo_driver_set_observer(d, look, &s));
    assert_ok(tribo_driver_set_output(d, period / 20000.0));
    driver_advance(d, &t, 201.0 * period, y);
    assert_close(y[5], v->energy, 6e-7);
    assert_close(s.most, v->most, 3e-6);
    assert_close(s.least, v->least, 3e-6);
    const size_t count = v->kind[3] ? 4 : 3;
    ck_assert_uint_eq(s.count, count);
    for (size_t k = 0; k < count; k++) {
        ck_assert_int_eq(s.kind[k], v->kind[k]);
        assert_close(s.t[k] - 200.0 * period, v->t[k], 1.5e-9);
    }
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

/* The same by shooting, from rest, with the values of cases 1 to 3 to their last digit; and in turned coordinates. */
TEST(periodic)
{
    const struct value *v = &values[_i % VALUES];
    const double period = full_turn / v->omega, turn = _i / VALUES % 2 ? 0.7 : 0.0;
    tribo_system *sys = shaker(v->fx, v->fy, v->omega, 0.2, turn);
    tribo_driver *d = driver_of(sys, _i >= 2 * VALUES);
    double y[6] = {0.0};
    const int status = tribo_driver_find_periodic(d, 0.0, period, y);
    require(!status, "%s", tribo_driver_message(d));
    const double error = _i % VALUES < 3 ? 1e-11 : 1e-8;
    assert_close(cos(turn) * y[0] + sin(turn) * y[1], v->x, error * 10.0);
    assert_close(cos(turn) * y[2] + sin(turn) * y[3], v->u, error * 100.0);
    double least, most, c[4] = {cos(turn), sin(turn), 0.0, 0.0};
    assert_ok(tribo_driver_period_extremes(d, c, &least, &most, NULL, NULL));
    assert_close(most, v->most, 4e-6); /* those values are extremes of samples */
    assert_close(least, v->least, 4e-6);
    ck_assert(most > v->most - 1e-7 && least < v->least + 1e-7);
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

/* Multipliers: trace of the map over a period, and of its square, by differences of motions. Elastic and rigid, and rigid with a
 * static limit; a spring couples x and y. */
TEST(multipliers)
{
    const struct value *v = &values[_i % VALUES];
    const double period = full_turn / v->omega;
    tribo_system *sys = shaker_with(v->fx, v->fy, v->omega, _i / VALUES % 2 || _i >= 4 * VALUES ? 0.0 : 0.2, 0.4, 1.0, 3.0);
    tribo_driver *d = driver_of(sys, _i / VALUES / 2 == 1);
    if (_i >= 4 * VALUES) {
        assert_ok(tribo_set_static(tribo_system_context(sys), (const double[]){1.3, 1.0}, NULL));
    }
    double y[6] = {0.0};
    const int status = tribo_driver_find_periodic(d, 0.0, period, y);
    require(!status, "%s", tribo_driver_message(d));
    assert_traces(d, tribo_system_dimension(sys) - 1, 0.0, period, y, 1e-6, 2e-6);
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

/* A motion that others leave, so that no marching finds it, and that Newton's steps of full length miss: the search by |r|. */
TEST(unstable)
{
    const double period = full_turn / 3.5;
    tribo_system *sys = shaker_with(60.0, 60.0, 3.5, 0.2, 0.0, 0.05, 14.0);
    tribo_driver *d = driver_create(sys, "event", 0.0, 0.0);
    double t = 0.0, y[6] = {0.0}, z[6], re[5], im[5];
    const int status = tribo_driver_find_periodic(d, 0.0, period, y);
    require(!status, "%s", tribo_driver_message(d));
    assert_ok(tribo_driver_get_multipliers(d, re, im));
    require(hypot(re[0], im[0]) > 1.03, "|%g + %g i|", re[0], im[0]);
    memcpy(z, y, sizeof y);
    driver_advance(d, &t, period, z);
    for (size_t i = 0; i < 5; i++) {
        assert_close(z[i], y[i], 1e-8);
    }
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------- several normals, one body */

/* A body between three walls: it slides on bases that run away, along x on a wall below and one above, along y on one beside it.
 * Each presses by its own stiffness, from its own gap. */
static const struct wall {
    double mu, stiffness, gap;
} walls[] = {{0.6, 21.0, -0.3}, {0.4, 15.0, -0.2}, {0.5, 9.0, -0.1}};

static tribo_system *between_walls(double fast, double load)
{
    const double mass[] = {1.0, 0.0, 0.0, 1.5}, damping[] = {0.3, 0.0, 0.0, 0.5}, stiffness[] = {12.0, 2.0, 2.0, 17.0};
    const double direction[] = {1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 1.0, 0.0};
    const double base[] = {fast, fast, -fast, 0.0, 0.0, 0.0};
    tribo_model *model = dense_model(2, 6, mass, damping, stiffness, direction);
    for (size_t k = 0; k < 3; k++) {
        assert_ok(tribo_model_set_normal(model, k, 3 + k, walls[k].mu, walls[k].stiffness, walls[k].gap));
    }
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_system_add_load(sys, 3.0, (const double[]){9.0 * load, 20.0 * load}, (const double[]){4.0 * load, 0.0}));
    assert_ok(tribo_system_add_base_motion(sys, 0.0, base, NULL));
    return sys;
}

static double wall_load(size_t k, double x)
{
    return walls[k].stiffness * fmax(x - walls[k].gap, 0.0);
}

static void wall_rates(double t, const double *y, double *rate)
{
    const double below = wall_load(0, y[1]), above = wall_load(1, -y[1]), beside = wall_load(2, y[0]);
    rate[0] = y[2];
    rate[1] = y[3];
    rate[2] = 9.0 * cos(3.0 * t) + 4.0 * sin(3.0 * t) - 12.0 * y[0] - 2.0 * y[1] - 0.3 * y[2] + walls[0].mu * below +
              walls[1].mu * above - beside;
    rate[3] = (20.0 * cos(3.0 * t) - 2.0 * y[0] - 17.0 * y[1] - 0.5 * y[3] - walls[2].mu * beside - below + above) / 1.5;
}

/* Against the equations by hand, in short steps of Runge and Kutta's method: loads and limits are continuous where walls are
 * left. */
TEST(walls_of_a_body)
{
    static const char *const method[] = {"event", "moreau/fixed", "central/fixed", "exact"};
    const double error[] = {1e-8, 1e-4, 2e-3, 1e-8}, h = 1e-5;
    double want[4] = {0.0}, y[5] = {0.0};
    for (size_t step = 0; step < 300000; step++) {
        double rate[4][4] = {{0.0}}, at[4];
        for (int k = 0; k < 4; k++) {
            const double part = k == 0 ? 0.0 : k == 3 ? h : 0.5 * h;
            for (size_t i = 0; i < 4; i++) {
                at[i] = want[i] + part * rate[k ? k - 1 : 0][i];
            }
            wall_rates((double)step * h + part, at, rate[k]);
        }
        for (size_t i = 0; i < 4; i++) {
            want[i] += h / 6.0 * (rate[0][i] + 2.0 * (rate[1][i] + rate[2][i]) + rate[3][i]);
        }
    }
    tribo_system *sys = between_walls(100.0, 1.0);
    run(sys, method[_i], 1e-4, 0.0, 3.0, y);
    for (size_t i = 0; i < 4; i++) {
        assert_close(y[i], want[i], error[_i]);
    }
    tribo_system_destroy(sys);
}

/* The walls stand: two of them hold the body along x, at rest together, and each limit goes its own way. Steps of 1e-4 are off by
 * 1e-5. Method exact, which decides at events only, and event are the same. */
TEST(redundant)
{
    static const char *const method[] = {"event", "moreau/fixed", "exact"};
    double y[3][5] = {{0.0}, {0.0}, {0.0}};
    for (size_t k = 0; k < 3; k++) {
        tribo_system *sys = between_walls(0.0, 0.3 * pow(1.5, (double)_i));
        run(sys, method[k], 1e-4, 0.0, 12.0, y[k]);
        tribo_system_destroy(sys);
    }
    for (size_t i = 0; i < 5; i++) {
        assert_close(y[0][i], y[2][i], 1e-9);
        assert_close(y[0][i], y[1][i], 1e-4 * (1.0 + y[0][4]));
    }
}

/* N falls to 0 and rises again, or lifts off for a moment: multipliers are those of a motion that stays pressed close by. */
TEST(graze)
{
    static const double more[] = {0.0, 1e-15, -1e-15, 1e-14, 1e-13, 1e-12, 1e-10};
    const double w = 3.6, fy = 100.0 / 42.0 * hypot(42.0 - w * w, 2.0 * w), period = full_turn / w;
    double re[2][5], im[2][5];
    for (int k = 0; k < 2; k++) {
        tribo_system *sys = shaker(80.0, fy * (k ? 1.0 + more[_i / 2] : 1.0 - 1e-6), w, 0.2, 0.0);
        tribo_driver *d = driver_of(sys, _i % 2);
        double y[6] = {0.0};
        const int status = tribo_driver_find_periodic(d, 0.0, period, y);
        require(!status, "%s", tribo_driver_message(d));
        assert_ok(tribo_driver_get_multipliers(d, re[k], im[k]));
        tribo_driver_destroy(d);
        tribo_system_destroy(sys);
    }
    assert_all_close(re[1], re[0], 5, 1e-4);
    assert_all_close(im[1], im[0], 5, 1e-4);
}

/* A normal that rests at depth 0, beside a body that slides: neighbouring motions press or do not, and there are no
 * multipliers. */
TEST(resting)
{
    const double mass[] = {1.0, 1.0, 1.0}, stiffness[] = {2.0, 3.0, 5.0},
                 direction[] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const double damping[] = {0.1, 0.1, 0.1}, limit[] = {0.0, 0.0, 0.5}, swing[] = {1.0, 0.0, 2.0}, period = full_turn / 1.3;
    double y[7] = {0.0}, re[6] = {5.0}, im[6];
    tribo_model *model;
    tribo_system *sys;
    assert_ok(tribo_model_create(&model, 3, 3));
    assert_ok(tribo_model_set_mass_diagonal(model, mass));
    assert_ok(tribo_model_set_damping_diagonal(model, damping));
    assert_ok(tribo_model_set_stiffness_diagonal(model, stiffness));
    assert_ok(tribo_model_set_direction(model, direction));
    assert_ok(tribo_model_set_normal(model, 0, 1, 0.4, 7.0, 0.0));
    assert_ok(tribo_system_create(&sys, model));
    tribo_model_destroy(model);
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    assert_ok(tribo_system_add_load(sys, 1.3, swing, NULL));
    tribo_driver *d = driver_of(sys, _i);
    assert_ok(tribo_driver_find_periodic(d, 0.0, period, y));
    assert_status(tribo_driver_get_multipliers(d, re, im), TRIBO_ERR_UNSUPPORTED);
    assert_exact(re[0], 5.0);
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

/* Limit cycle: stick, slip, lift, touch, of period 1.53650780675 (belt 0.5) and 1.48153261 (belt 1.0). */
TEST(limit_cycle)
{
    const int fast = _i % 2;
    const double belt = fast ? 1.0 : 0.5, period = fast ? 1.48153261 : 1.53650780675;
    tribo_system *sys = squeal(belt, 0.6, 0.1);
    tribo_driver *d = driver_of(sys, _i >= 2);
    double t = 0.0, y[5] = {0.1, 0.9};
    struct seen s = {.values = 4, .most = -HUGE_VAL, .least = HUGE_VAL};
    driver_advance(d, &t, 600.0, y);
    assert_ok(tribo_driver_set_observer(d, look, &s));
    driver_advance(d, &t, 603.2, y);
    size_t k = 0;
    while (s.kind[k] != TRIBO_MOMENT_SLIP) {
        k++;
    }
    ck_assert_uint_ge(s.count, k + 5);
    ck_assert_int_eq(s.kind[k + 1], TRIBO_MOMENT_LIFT);
    ck_assert_int_eq(s.kind[k + 2], TRIBO_MOMENT_TOUCH);
    ck_assert_int_eq(s.kind[k + 3], TRIBO_MOMENT_STICK);
    ck_assert_int_eq(s.kind[k + 4], TRIBO_MOMENT_SLIP);
    assert_close(s.t[k + 4] - s.t[k], period, fast ? 1e-8 : 1e-10);
    if (!fast) {
        assert_close(s.y[k][0], 0.16859251, 1e-8);
        assert_close(s.y[k][1], 1.46871763, 1e-8);
        assert_close(s.y[k][2], 0.5, 1e-12);
        assert_close(s.y[k][3], 1.36898954, 1e-8);
        /* multipliers 1, 0, 0.758384 +- 0.424284 i */
        double re[4], im[4], least, most;
        const double c[] = {1.0, 0.0, 0.0, 0.0};
        assert_ok(tribo_driver_set_observer(d, NULL, NULL));
        assert_ok(tribo_driver_find_periodic(d, 0.0, period, y));
        assert_ok(tribo_driver_get_multipliers(d, re, im));
        assert_close(re[0], 1.0, 1e-6);
        assert_close(re[1], 0.758384, 1e-6);
        assert_close(fabs(im[1]), 0.424284, 1e-6);
        assert_close(re[3], 0.0, 1e-9);
        assert_ok(tribo_driver_period_extremes(d, c, &least, &most, NULL, NULL));
        assert_close(most, 0.27080300, 1e-8);
        assert_close(least, -0.14959332, 1e-8);
    }
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

/* At the border of flutter, mu = ((K11 - K22)^2 + 4 K12^2)/(4 K12 kn), the sliding state has two equal exponents and one vector:
 * exact says so, and auto takes event. Beside it exact has both exponents, and agrees. */
TEST(flutter)
{
    static const double mu[] = {0.47237749297, 0.47237749297 * (1.0 - 1e-5), 0.47237749297 * (1.0 + 1e-5)};
    tribo_system *sys = squeal(5.0, mu[_i], 0.0);
    double y[3][5] = {{0.1, 0.9}, {0.1, 0.9}, {0.1, 0.9}}, t = 0.0;
    tribo_driver *d = driver_of(sys, 1);
    const int status = tribo_driver_advance(d, &t, 2.0, y[0]);
    ck_assert_int_eq(status, _i ? TRIBO_OK : TRIBO_ERR_UNSUPPORTED);
    if (status) {
        assert_says(tribo_driver_message(d), "as at the border of flutter; method event can do it");
    }
    tribo_driver_destroy(d);
    for (int k = 1; k < 3; k++) {
        t = 0.0;
        assert_ok(tribo_driver_create(&d, sys, k == 1 ? "auto" : "event"));
        driver_advance(d, &t, 2.0, y[k]);
        tribo_driver_destroy(d);
    }
    assert_all_close(y[1], y[2], 5, _i ? 1e-10 : 0.0);
    tribo_system_destroy(sys);
}

/* A mass on a spring runs against a stop: Code_Aster SDND101, whose contact lasts 0.0312600152681, largest force 9950.37190210.
 * No friction: the tangential row does not move. */
TEST(shock)
{
    const double mass = 100.0, stiffness = 1e4, direction[] = {0.0, 1.0}, w = sqrt((1e4 + 1e6) / 100.0);
    tribo_model *model = dense_model(1, 2, &mass, NULL, &stiffness, direction);
    assert_ok(tribo_model_set_normal(model, 0, 1, 0.0, 1e6, 0.0));
    tribo_system *sys = finish_model(model);
    tribo_driver *d = driver_of(sys, _i);
    struct seen s = {.most = 0.0};
    double t = 0.0, y[3] = {0.0, 1.0, 0.0}, f[2], top[] = {1.0 / w, 0.0, 0.0};
    assert_ok(tribo_driver_set_observer(d, look, &s));
    driver_advance(d, &t, 0.1, y);
    ck_assert_uint_ge(s.count, 1);
    ck_assert_int_eq(s.kind[s.count - 1], TRIBO_MOMENT_LIFT);
    assert_close(s.t[s.count - 1], 0.0312600152681, 1e-13);
    assert_close(y[1], -cos(10.0 * (0.1 - 0.0312600152681)), 1e-12);
    assert_ok(tribo_system_contacts(sys, 0.0, top, NULL, NULL, f));
    assert_close(f[1], -9950.37190210, 1e-8);
    assert_exact(f[0], 0.0);
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

/* ------------------------------------------------------------------------------------------------------------- fixed steps */

/* Errors of fixed steps against event, relative to the largest displacement, velocity, or energy. Rigid contacts slide on a fast
 * base: where they stop, steps are of first order with constant limits, too. Central differences are of second order without
 * damping. rk4 has the law of Quinn, with a band of the width of 10 steps. */
static double step_error(const char *method, double dt, const struct value *v, double soft)
{
    const double fast[] = {300.0, 0.0}, end = 3.0, damped = strcmp(method, "central/fixed") ? 1.0 : 0.0;
    double y[6] = {0.0, 2.0}, z[6] = {0.0, 2.0}, most = 0.0;
    for (int k = 0; k < 2; k++) {
        tribo_system *sys = shaker_with(v->fx, v->fy, v->omega, soft, 0.3, damped, 0.0);
        double t = 0.0;
        assert_ok(tribo_system_add_base_motion(sys, 0.0, soft > 0.0 ? NULL : fast, NULL));
        assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 10.0 * dt));
        tribo_driver *d = driver_create(sys, k ? method : "event", dt, 0.0);
        driver_advance(d, &t, end, k ? z : y);
        tribo_driver_destroy(d);
        tribo_system_destroy(sys);
    }
    for (size_t i = 0; i < (soft > 0.0 ? 6 : 5); i++) {
        most = fmax(most, fabs(y[i] - z[i]) / (i < 4 ? 10.0 : 1e4));
    }
    return most;
}

TEST(steps)
{
    static const struct {
        const char *method;
        size_t value;
        double soft, order, error;
    } scene[] = {{"central/fixed", 0, 0.0, 1.8, 1e-3}, {"moreau/fixed", 0, 0.0, 1.8, 1e-3},  {"moreau/fixed", 0, 0.2, 1.8, 1e-3},
                 {"rk4/fixed", 0, 0.0, 0.9, 0.1},      {"central/fixed", 4, 0.0, 0.9, 1e-1}, {"moreau/fixed", 4, 0.0, 0.9, 1e-1},
                 {"moreau/fixed", 4, 0.2, 0.9, 1e-1}};
    const double dt[] = {1e-2, 1e-3, 1e-4};
    double error[3];
    for (size_t k = 0; k < 3; k++) {
        error[k] = step_error(scene[_i].method, dt[k], &values[scene[_i].value], scene[_i].soft);
    }
    const double order = order_of(dt, error, 3);
    require(order > scene[_i].order && error[1] < scene[_i].error, "%s: errors %g, %g, %g: order %g", scene[_i].method, error[0],
            error[1], error[2], order);
}

/* A stiff normal that stays pressed is stable in steps of moreau far above 1/omega: the distance from equilibrium does not
 * grow. */
TEST(stiff)
{
    const double mass = 1.0, spring = 100.0, stiffness = 1e8, push = 1e6, direction[] = {0.0, 1.0};
    const double rest = push / (stiffness + spring);
    double t = 0.0, y[3] = {rest + 1e-4};
    tribo_model *model = dense_model(1, 2, &mass, NULL, &spring, direction);
    assert_ok(tribo_model_set_normal(model, 0, 1, 0.5, stiffness, 0.0));
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_system_add_load(sys, 0.0, &push, NULL));
    tribo_driver *d = driver_create(sys, "moreau/fixed", 1e-2, 0.0);
    for (int k = 1; k <= 100; k++) {
        driver_advance(d, &t, 0.1 * k, y);
        ck_assert(fabs(y[0] - rest) < 1.0001e-4);
    }
    tribo_driver_destroy(d);
    tribo_system_destroy(sys);
}

/* -------------------------------------------------------------------------------------------------------------- structures */

/* Three bodies on springs, each with a tangential and a normal degree of freedom. Contact 0 is tied to the ground by normal 3,
 * contacts 1 and 2, on bodies 0 and 1, and on body 2, share normal 4, between the bodies 1 and 2; contact 5 has no normal. soft:
 * the compliance of contacts 0 and 2. */
static tribo_model *block_model(int seed, double soft)
{
    enum { N = 6, C = 6 };
    struct random r = random_of(seed);
    double mass[N], damping[N * N] = {0.0}, stiffness[N * N] = {0.0}, direction[C * N] = {0.0}, compliance[C] = {soft, 0.0, soft};
    for (size_t i = 0; i < N; i++) {
        mass[i] = uniform(&r, 0.5, 2.0);
        for (size_t j = 0; j < i; j++) {
            const double k = uniform(&r, 0.0, 3.0);
            stiffness[i * N + j] = stiffness[j * N + i] = -k;
            stiffness[i * N + i] += k;
            stiffness[j * N + j] += k;
        }
        stiffness[i * N + i] += uniform(&r, 5.0, 10.0);
        damping[i * N + i] = uniform(&r, 0.0, 0.2);
    }
    direction[0 * N + 0] = 1.0;
    direction[1 * N + 0] = 1.0;
    direction[1 * N + 2] = -1.0;
    direction[2 * N + 4] = 1.0;
    direction[3 * N + 1] = 1.0;
    direction[4 * N + 3] = 1.0;
    direction[4 * N + 5] = -1.0;
    direction[5 * N + 2] = 1.0;
    tribo_model *model;
    assert_ok(tribo_model_create(&model, N, C));
    assert_ok(tribo_model_set_mass_diagonal(model, mass));
    assert_ok(tribo_model_set_damping(model, damping));
    assert_ok(tribo_model_set_stiffness(model, stiffness));
    assert_ok(tribo_model_set_direction(model, direction));
    assert_ok(tribo_model_set_compliance(model, compliance));
    assert_ok(tribo_model_set_normal(model, 0, 3, 0.5, 20.0, -0.1));
    assert_ok(tribo_model_set_normal(model, 1, 4, 0.3, 30.0, -0.2));
    assert_ok(tribo_model_set_normal(model, 2, 4, 0.4, 30.0, -0.2));
    return model;
}

static void load_blocks(tribo_system *sys)
{
    const double limit[6] = {[5] = 0.2};
    const double a[] = {2.0, 3.0, 1.0, 4.0, 2.0, -3.0}, b[] = {1.0, 0.0, 2.0, 0.0, -2.0, 1.0};
    assert_ok(tribo_set_limit(tribo_system_context(sys), limit));
    assert_ok(tribo_system_add_load(sys, 2.1, a, NULL));
    assert_ok(tribo_system_add_load(sys, 3.3, NULL, b));
}

static tribo_system *blocks(int seed, double soft)
{
    tribo_model *model = block_model(seed, soft);
    tribo_system *sys;
    assert_ok(tribo_system_create(&sys, model));
    tribo_model_destroy(model);
    load_blocks(sys);
    return sys;
}

/* Event in one advance and in 50; a clone; all modes; fixed steps; exact. */
TEST(structures)
{
    enum { SIZE = 15, RUNS = 7 };
    const double soft = _i % 2 ? 0.3 : 0.0;
    static const char *const method[RUNS] = {"event", "event", "event", "event", "moreau/fixed", "central/fixed", "exact"};
    double y[RUNS][SIZE] = {{0.0}};
    size_t events = 0;
    for (int k = 0; k < RUNS; k++) {
        tribo_system *sys = blocks(_i, soft), *copy;
        if (k == 5 && soft > 0.0) {
            memcpy(y[5], y[4], sizeof *y);
        } else if (k == 3) {
            tribo_model *model = block_model(_i, soft);
            tribo_system_destroy(sys);
            assert_ok(tribo_system_reduce(&sys, model, 6, TRIBO_STATICS_NONE));
            tribo_model_destroy(model);
            load_blocks(sys);
        } else if (k == 2) {
            assert_ok(tribo_system_clone(sys, &copy));
            tribo_system_destroy(sys);
            sys = copy;
        }
        double t = 0.0;
        tribo_driver *d = k == 5 && soft > 0.0 ? NULL : driver_create(sys, method[k], 5e-5, 0.0);
        for (int p = k == 1 ? 1 : 50; d && p <= 50; p++) {
            driver_advance(d, &t, 0.2 * p, y[k]);
        }
        events = k ? events : driver_count(d, TRIBO_COUNT_EVENTS);
        if (k == 3) {
            double full[6];
            assert_ok(tribo_system_expand(sys, y[k], full));
            memcpy(y[k], full, sizeof full);
            assert_ok(tribo_system_expand(sys, y[k] + 6, full));
            memcpy(y[k] + 6, full, sizeof full);
        }
        tribo_driver_destroy(d);
        tribo_system_destroy(sys);
    }
    const size_t energy = soft > 0.0 ? 14 : 12;
    ck_assert_uint_gt(events, 20);
    ck_assert(y[0][energy] > 0.1);
    assert_all_close(y[1], y[0], energy + 1, 1e-9);
    assert_all_exact(y[2], y[0], energy + 1);
    assert_all_close(y[3], y[0], energy + 1, 1e-9);
    assert_all_close(y[4], y[0], energy + 1, 2e-3);
    assert_all_close(y[5], y[0], energy + 1, 2e-3);
    assert_all_close(y[6], y[0], energy + 1, 1e-11);
}

/* An observer that evaluates the system, also with another state, does not change the motion. */
static int evaluate(const tribo_moment *moment, void *data)
{
    double f[6], other[15] = {[1] = -1.0, [3] = -1.0};
    assert_ok(tribo_system_contacts(data, moment->t, moment->y, NULL, NULL, f));
    return tribo_system_contacts(data, moment->t, other, NULL, NULL, f);
}

TEST(observed)
{
    const double soft = _i % 2 ? 0.3 : 0.0;
    double y[2][15] = {{0.0}};
    for (int k = 0; k < 2; k++) {
        tribo_system *sys = blocks(_i, soft);
        double t = 0.0;
        tribo_driver *d = driver_of(sys, _i / 2 % 2);
        assert_ok(tribo_driver_set_output(d, 0.01));
        assert_ok(tribo_driver_set_observer(d, k ? evaluate : NULL, sys));
        for (int p = 1; p <= 10; p++) {
            driver_advance(d, &t, p, y[k]);
        }
        tribo_driver_destroy(d);
        tribo_system_destroy(sys);
    }
    assert_all_close(y[1], y[0], soft > 0.0 ? 15 : 13, 1e-12);
}

/* A planar contact whose motion keeps to a line is the scalar one; along any line, with both directions at 45 degrees. */
TEST(planar)
{
    static const char *const method[] = {"central/fixed", "moreau/fixed", "rk4/fixed", "event"};
    const double c = sqrt(0.5), mass[] = {1.0, 1.0, 1.0}, stiffness[] = {12.0, 12.0, 21.0};
    const double direction[] = {c, c, 0.0, -c, c, 0.0, 0.0, 0.0, 1.0}, steady[] = {0.0, 0.0, 100.0}, swing[] = {60.0, 0.0, 60.0};
    double y[7] = {0.0}, z[5] = {0.0}, t = 0.0, u = 0.0;
    const size_t first = 0;
    tribo_model *model;
    tribo_system *sys, *line = shaker_with(60.0, 60.0, 5.0, 0.0, 0.0, 0.0, 0.0);
    assert_ok(tribo_model_create(&model, 3, 3));
    assert_ok(tribo_model_set_mass_diagonal(model, mass));
    assert_ok(tribo_model_set_stiffness_diagonal(model, stiffness));
    assert_ok(tribo_model_set_direction(model, direction));
    assert_ok(tribo_model_set_normal(model, 0, 2, 0.85, 21.0, 0.0));
    assert_ok(tribo_system_create(&sys, model));
    tribo_model_destroy(model);
    assert_ok(tribo_set_planar(tribo_system_context(sys), 1, &first));
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 1e-2));
    assert_ok(tribo_set_epsilon_all(tribo_system_context(line), 1e-2));
    assert_ok(tribo_system_add_load(sys, 0.0, steady, NULL));
    assert_ok(tribo_system_add_load(sys, 5.0, swing, NULL));
    const double step = _i == 3 ? 0.0 : 1e-4;
    tribo_driver *d = driver_create(sys, method[_i], step, 0.0), *e = driver_create(line, method[_i], step, 0.0);
    driver_advance(d, &t, 3.0, y);
    driver_advance(e, &u, 3.0, z);
    const double error = _i < 2    ? 3e-2
                         : _i == 2 ? 1e-6
                                   : 1e-10; /* friction over steps that reverse differs by the order of a step */
    assert_close(y[0], z[0], error);
    assert_close(y[1], 0.0, 1e-12);
    assert_close(y[2], z[1], 1e-12);
    assert_close(y[3], z[2], error);
    assert_close(y[6], z[4], _i < 2 ? error : _i == 2 ? 1e-3 : 1e-9);
    ck_assert(y[6] > 100.0);
    tribo_driver_destroy(d);
    tribo_driver_destroy(e);
    tribo_system_destroy(sys);
    tribo_system_destroy(line);
}

/* ----------------------------------------------------------------------------------------------------------------- refused */

TEST(wrong_normals)
{
    tribo_model *m;
    assert_ok(tribo_model_create(&m, 2, 4));
    assert_status(tribo_model_set_normal(NULL, 0, 1, 0.5, 1.0, 0.0), TRIBO_ERR_NULL);
    const struct {
        size_t contact, normal;
        double mu, stiffness, gap;
        int status;
        const char *says;
    } wrong[] = {
        {4, 1, 0.5, 1.0, 0.0, TRIBO_ERR_RANGE, "contact = 4 is not below 4"},
        {0, 4, 0.5, 1.0, 0.0, TRIBO_ERR_RANGE, "normal = 4 is not below 4"},
        {2, 2, 0.5, 1.0, 0.0, TRIBO_ERR_RANGE, "contact 2 is to be its own normal"},
        {2, 0, 0.5, 1.0, 0.0, TRIBO_ERR_RANGE, "contact 0 is the normal of contact 2, and takes no normal itself"},
        {1, 3, 0.5, 1.0, 0.0, TRIBO_ERR_RANGE, "contact 1 is the normal of contact 0, and takes no normal itself"},
        {2, 1, 0.5, 2.0, 0.0, TRIBO_ERR_RANGE, "stiffness = 2 of contact 2, but 1 of contact 0 with the same normal"},
        {2, 1, 0.5, 1.0, 0.5, TRIBO_ERR_RANGE, "gap = 0.5 of contact 2, but 0 of contact 0 with the same normal"},
        {2, 3, -0.5, 1.0, 0.0, TRIBO_ERR_NEGATIVE, "mu = -0.5 of contact 2 is negative"},
        {2, 3, 0.5, -1.0, 0.0, TRIBO_ERR_NEGATIVE, "stiffness = -1 of contact 2 is negative"},
        {2, 3, NAN, 1.0, 0.0, TRIBO_ERR_NOT_FINITE, "mu = nan of contact 2 is not finite"},
        {2, 3, 0.5, HUGE_VAL, 0.0, TRIBO_ERR_NOT_FINITE, "stiffness = inf of contact 2 is not finite"},
        {2, 3, 0.5, 1.0, NAN, TRIBO_ERR_NOT_FINITE, "gap = nan of contact 2 is not finite"},
    };
    assert_ok(tribo_model_set_normal(m, 0, 1, 0.5, 1.0, 0.0));
    for (size_t k = 0; k < COUNT(wrong); k++) {
        assert_status(tribo_model_set_normal(m, wrong[k].contact, wrong[k].normal, wrong[k].mu, wrong[k].stiffness, wrong[k].gap),
                      wrong[k].status);
        assert_says(tribo_model_message(m), wrong[k].says);
    }
    assert_ok(tribo_model_set_normal(m, 2, 1, 0.25, 1.0, 0.0));
    tribo_model_destroy(m);
}

/* What methods and calls do not take, and say why. */
TEST(refused)
{
    tribo_system *sys = shaker(60.0, 60.0, 5.0, 0.0, 0.0), *out;
    tribo_context *c = tribo_system_context(sys);
    const double limit[][2] = {{1.0, 0.0}, {0.0, 1.0}, {0.0, 0.0}}, y[5] = {0.0};
    double to[25];
    static const char *const said[] = {"limit[0] = 1, but the limit of contact 0 follows its normal load",
                                       "limit[1] = 1, but contact 1 is a normal direction"};
    tribo_driver *d;
    for (int k = 0; k < 2; k++) {
        assert_ok(tribo_set_limit(c, limit[k]));
        assert_status(tribo_driver_create(&d, sys, "event"), TRIBO_ERR_UNSUPPORTED);
        assert_says(tribo_system_message(sys), said[k]);
        assert_ok(tribo_set_limit(c, limit[2]));
        assert_status(tribo_system_add_limit(sys, 1.0, limit[k], NULL), TRIBO_ERR_UNSUPPORTED);
        assert_says(tribo_system_message(sys), k ? "contact 1 is a normal direction" : "contact 0 has a limit that follows");
    }
    assert_status(tribo_system_get_limit(sys, 0.0, to), TRIBO_ERR_UNSUPPORTED);
    /* limits that fall with the speed: fixed steps only */
    const double ratio[] = {1.5, 1.0}, velocity[] = {1.0, 1.0};
    double t = 0.0, z[5] = {0.0};
    d = driver_create(sys, "event", 0.0, 0.0);
    assert_ok(tribo_set_static(c, ratio, velocity));
    assert_status(tribo_system_jacobian(sys, 0.0, y, to, NULL), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_system_message(sys), "contact 0 has a static limit, beside limits that follow normal loads");
    assert_status(tribo_driver_advance(d, &t, 1.0, z), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_driver_message(d), "contact 0 has a limit that falls with the speed");
    tribo_driver_destroy(d);
    /* planar contacts */
    const size_t first = 0;
    assert_ok(tribo_set_static(c, NULL, NULL));
    assert_ok(tribo_set_planar(c, 1, &first));
    assert_status(tribo_driver_create(&d, sys, "moreau/fixed"), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_system_message(sys), "contact 0 and contact 1 are the directions of one planar contact");
    tribo_system_destroy(sys);
    /* normals without mass */
    for (int k = 0; k < 2; k++) {
        tribo_model *model = block_model(1, 0.0);
        const double soft[6] = {[3] = 0.1};
        if (!k) {
            assert_ok(tribo_model_set_compliance(model, soft));
        } else {
            const double none[36] = {0.0};
            assert_ok(tribo_model_set_damping(model, none));
        }
        assert_status(k ? tribo_system_reduce(&out, model, 3, TRIBO_STATICS_COMPLIANCE) : tribo_system_create(&out, model),
                      TRIBO_ERR_UNSUPPORTED);
        assert_says(tribo_model_message(model), k ? "TRIBO_STATICS_COMPLIANCE" : "contact 3 is the normal of contact 0");
        tribo_model_destroy(model);
    }
}

TEST_MAIN("normals", {steady_motions, 2 * VALUES}, {periodic, 4 * VALUES}, {multipliers, 5 * VALUES}, {unstable, 1},
          {walls_of_a_body, 4}, {redundant, 4}, {limit_cycle, 4}, {graze, 14}, {resting, 2}, {flutter, 3}, {shock, 2}, {steps, 7},
          {stiff, 1}, {structures, 8}, {observed, 4}, {planar, 4}, {wrong_normals, 1}, {refused, 1})
