/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact elements with a normal spring: forces against a formula of their own, derivatives against differences, borders between
 * stick, slip and lift-off, numbers of any size, and bad input. */
#include "traps.h"

#include <string.h>

#define TINY 4.9406564584124654e-324 /* the smallest number */

struct element {
    double dz[2], depth, tangential, normal, mu, f[3];
};

static void move(const struct element *e, double *f, double *df)
{
    memcpy(f, e->f, sizeof e->f);
    assert_quiet(tribo_contact_force(1, e->dz, &e->depth, &e->tangential, &e->normal, &e->mu, f, df));
}

/* The trial force over the limit; 2 where the element is open. */
static double reached(const struct element *e)
{
    const double x = e->f[0] - e->tangential * e->dz[0], y = e->f[1] - e->tangential * e->dz[1];
    return e->depth > 0.0 ? hypot(x, y) / (e->mu * e->normal * e->depth) : 2.0;
}

/* The force by turning into the direction of the trial force: along it lesser(size, limit), across it nothing. */
static void formula(const struct element *e, double *f)
{
    const double load = e->normal * fmax(e->depth, 0.0);
    const double x = e->f[0] - e->tangential * e->dz[0], y = e->f[1] - e->tangential * e->dz[1], angle = atan2(y, x);
    const double size = fmin(hypot(x, y), e->mu * load);
    f[0] = size * cos(angle);
    f[1] = size * sin(angle);
    f[2] = -load;
}

enum { STICK, SLIP, OPEN };

/* An element whose trial force points to angle, well inside a phase; force and length are the units. */
static struct element inside(struct random *g, int phase, double angle, double force, double length)
{
    const double pressed = uniform(g, 0.5, 2.0), mu = uniform(g, 0.1, 1.5), k = uniform(g, 0.5, 3.0), kn = uniform(g, 0.5, 3.0);
    const double limit = mu * kn * pressed, trial = limit * (phase == STICK ? uniform(g, 0.1, 0.8) : uniform(g, 1.3, 5.0));
    const double from[] = {uniform(g, -1.0, 1.0) * limit, uniform(g, -1.0, 1.0) * limit};
    return (struct element){{(from[0] - trial * cos(angle)) / k * length, (from[1] - trial * sin(angle)) / k * length},
                            (phase == OPEN ? -pressed : pressed) * length,
                            k * force / length,
                            kn * force / length,
                            mu,
                            {from[0] * force, from[1] * force, -uniform(g, 0.0, 3.0) * force}};
}

/* Phases, directions and units of run _i; 24 directions go once around. */
static struct element scene(struct random *g, int run, int phase)
{
    const double angle = 2.0 * PI * (run % 24) / 24.0;
    return run < 24 ? inside(g, phase, angle, 1.0, 1.0) : inside(g, phase, angle, log_uniform(g, 100.0), log_uniform(g, 100.0));
}

TEST(values)
{
    struct random g = random_of(_i);
    for (int phase = STICK; phase <= OPEN; phase++) {
        const struct element e = scene(&g, _i, phase);
        const double unit = e.normal * fabs(e.depth) * fmax(e.mu, 1.0);
        double f[3], want[3];
        move(&e, f, NULL);
        formula(&e, want);
        assert_all_close(f, want, 3, 2e-15 * unit);
    }
}

/* The derivative of f[row] by an entry of the motion, from four calls: of fourth order in h. */
static double slope(const struct element *e, double *entry, double h, size_t row)
{
    const double at = *entry, weight[] = {1.0, -8.0, 8.0, -1.0}, step[] = {-2.0, -1.0, 1.0, 2.0};
    double sum = 0.0;
    for (size_t k = 0; k < 4; k++) {
        double f[3];
        *entry = at + step[k] * h;
        move(e, f, NULL);
        sum += weight[k] / 12.0 * (f[row] / h);
    }
    *entry = at;
    return sum;
}

TEST(derivatives)
{
    struct random g = random_of(_i);
    for (int phase = STICK; phase <= OPEN; phase++) {
        struct element e = scene(&g, _i, phase);
        double *const entry[] = {e.dz, e.dz + 1, &e.depth}, size = fabs(e.depth);
        double f[3], df[9];
        move(&e, f, df);
        require((reached(&e) > 1.0) == (phase != STICK), "phase %d: trial force %g limits", phase, reached(&e));
        for (size_t column = 0; column < 3; column++) {
            const double unit = column < 2 ? e.tangential : e.normal * fmax(e.mu, 1.0);
            const double h = 3e-4 * (column < 2 ? e.mu * e.normal * size / e.tangential : size);
            for (size_t row = 0; row < 3; row++) {
                assert_close(df[3 * row + column] / unit, slope(&e, entry[column], h, row) / unit, 1e-9);
            }
        }
    }
}

/* What the derivative of a sliding element is made of: nothing along the force, and mu normal along it by depth. */
TEST(sliding_derivative)
{
    struct random g = random_of(_i);
    const struct element e = scene(&g, _i, SLIP);
    double f[3], df[9];
    move(&e, f, df);
    const double size = hypot(f[0], f[1]), along[] = {f[0] / size, f[1] / size};
    for (size_t row = 0; row < 2; row++) {
        assert_close(df[3 * row] * along[0] + df[3 * row + 1] * along[1], 0.0, 1e-15 * e.tangential);
        assert_close(df[3 * row + 2], e.mu * e.normal * along[row], 1e-15 * e.mu * e.normal);
    }
    assert_close(-df[0] - df[4], e.tangential / reached(&e), 4e-15 * e.tangential);
}

static const double nothing[9] = {0.0};

/* Where phases meet. At depth 0 an element is open; on the limit it sticks, but not with a limit of 0, where f stays 0. */
TEST(borders)
{
    const struct {
        struct element e;
        double f[3], df[9];
    } cases[] = {
        {{{0.0, 0.0}, 5.0, 2.0, 4.0, 0.25, {3.0, 4.0, 0.0}}, {3.0, 4.0, -20.0}, {-2.0, 0.0, 0.0, 0.0, -2.0, 0.0, 0.0, 0.0, -4.0}},
        {{{0.0, -2.0}, 5.0, 2.0, 4.0, 0.25, {3.0, 0.0, 0.0}},
         {3.0, 4.0, -20.0},
         {-2.0, 0.0, 0.0, 0.0, -2.0, 0.0, 0.0, 0.0, -4.0}},
        {{{0.0, 0.0}, 5.0, 2.0, 4.0, 0.25, {0.0, 0.0, 0.0}}, {0.0, 0.0, -20.0}, {-2.0, 0.0, 0.0, 0.0, -2.0, 0.0, 0.0, 0.0, -4.0}},
        {{{0.0, -8.0}, 5.0, 2.0, 4.0, 0.25, {0.0, 0.0, 0.0}},
         {0.0, 5.0, -20.0},
         {-0.625, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -4.0}},
        {{{1.0, 1.0}, 0.0, 2.0, 4.0, 0.25, {3.0, 4.0, -20.0}}, {0.0}, {0.0}},
        {{{0.0, 0.0}, 0.0, 2.0, 4.0, 0.25, {0.0, 0.0, 0.0}}, {0.0}, {0.0}},
        {{{0.0, 0.0}, -1.0, 2.0, 4.0, 0.25, {0.0, 0.0, 0.0}}, {0.0}, {0.0}},
        {{{1.0, 0.0}, -TINY, 2.0, 4.0, 0.25, {3.0, 4.0, -20.0}}, {0.0}, {0.0}},
        {{{1.0, 1.0}, 5.0, 2.0, 4.0, 0.0, {3.0, 4.0, 0.0}}, {0.0, 0.0, -20.0}, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0}},
        {{{0.0, 0.0}, 5.0, 2.0, 4.0, 0.0, {0.0, 0.0, 0.0}}, {0.0, 0.0, -20.0}, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0}},
        {{{0.0, 0.0}, 5.0, 2.0, 0.0, 0.5, {0.0, 0.0, 0.0}}, {0.0}, {0.0}},
        {{{1.0, 1.0}, 5.0, 0.0, 4.0, 0.25, {3.0, 0.0, 0.0}}, {3.0, 0.0, -20.0}, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0}},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        double f[3], df[9];
        move(&cases[i].e, f, df);
        assert_all_exact(f, cases[i].f, 3);
        assert_all_exact(df, cases[i].df, 9);
    }
}

/* Lift-off and touch-down: the force before is forgotten, and the slider begins at the body, f = -tangential dz; a press under
 * which the limit is smaller than that slides from the beginning. */
TEST(touch_down)
{
    struct element e = {{0.0, 0.1}, 1.0, 10.0, 4.0, 0.5, {0.0, 0.0, 0.0}};
    double df[9];
    move(&e, e.f, df);
    assert_all_close(e.f, ((const double[]){0.0, -1.0, -4.0}), 3, 1e-15);
    e.depth = -0.5;
    e.dz[0] = 7.0;
    move(&e, e.f, df);
    assert_all_exact(e.f, nothing, 3);
    assert_all_exact(df, nothing, 9);
    const struct element open = e;
    e.depth = 0.5;
    e.dz[0] = -0.03;
    e.dz[1] = 0.04;
    move(&e, e.f, NULL);
    assert_all_close(e.f, ((const double[]){0.3, -0.4, -2.0}), 3, 1e-15);
    e = open;
    e.depth = 0.05;
    e.dz[0] = -0.03;
    e.dz[1] = 0.04;
    move(&e, e.f, NULL);
    assert_all_close(e.f, ((const double[]){0.06, -0.08, -0.2}), 3, 1e-15);
}

/* With a normal load that is constant the element is that of the plane. */
TEST(constant_load)
{
    struct random g = random_of(_i);
    struct element e = inside(&g, STICK, 1.0, 1.0, 1.0);
    const double limit = e.mu * (e.normal * e.depth);
    double plane[2] = {e.f[0], e.f[1]};
    for (int k = 0; k < 50; k++) {
        double df[9], rate[4];
        e.dz[0] = uniform(&g, -1.0, 1.0);
        e.dz[1] = uniform(&g, -1.0, 1.0);
        move(&e, e.f, df);
        assert_ok(tribo_elastic_force_planar(1, e.dz, &e.tangential, &limit, plane, rate));
        assert_all_exact(e.f, plane, 2);
        assert_all_exact(df, rate, 2);
        assert_all_exact(df + 3, rate + 2, 2);
    }
}

/* Along a curve under a normal load that goes up and down: a step gives the bodies at most the energy that the tangential springs
 * lose, also where the limit falls or rises. */
TEST(energy)
{
    enum { STEPS = 2000 };
    struct random g = random_of(_i);
    struct element e = {{0.0, 0.0}, 0.0, uniform(&g, 0.5, 5.0), uniform(&g, 0.5, 5.0), uniform(&g, 0.1, 1.0), {0.0, 0.0, 0.0}};
    double z[2] = {0.0, 0.0};
    const double base = uniform(&g, -0.5, 1.0);
    for (int k = 1; k <= STEPS; k++) {
        const double a = 0.05 * k, at[] = {2.0 * cos(a), sin(1.7 * a)};
        const double held = 0.5 * (e.f[0] * e.f[0] + e.f[1] * e.f[1]) / e.tangential;
        for (size_t c = 0; c < 2; c++) {
            e.dz[c] = at[c] - z[c];
            z[c] = at[c];
        }
        e.depth = base + sin(2.3 * a);
        move(&e, e.f, NULL);
        const double holds = 0.5 * (e.f[0] * e.f[0] + e.f[1] * e.f[1]) / e.tangential;
        const double given = e.f[0] * e.dz[0] + e.f[1] * e.dz[1]; /* to the bodies */
        require(given + holds <= held + 1e-14 * (1.0 + held), "step %d gives %g and holds %g, of %g", k, given, holds, held);
        require(hypot(e.f[0], e.f[1]) <= e.mu * e.normal * fmax(e.depth, 0.0) * (1.0 + 4e-16), "beyond the limit");
    }
}

/* n elements at once are n single ones, also if inputs share arrays, and whether df is asked for or not. */
TEST(batch)
{
    enum { N = 257 };
    struct random g = random_of(_i);
    double dz[2 * N], shared[N], depth[N], f[3 * N], df[9 * N], bare[3 * N], single[3 * N], rate[9 * N];
    for (size_t i = 0; i < N; i++) {
        const struct element e = scene(&g, (int)i, (int)below(&g, 3));
        memcpy(dz + 2 * i, e.dz, sizeof e.dz);
        memcpy(f + 3 * i, e.f, sizeof e.f);
        depth[i] = e.depth;
        shared[i] = e.tangential;
    }
    memcpy(bare, f, sizeof f);
    memcpy(single, f, sizeof f);
    assert_ok(tribo_contact_force(N, dz, depth, shared, shared, shared, f, df));
    assert_ok(tribo_contact_force(N, dz, depth, shared, shared, shared, bare, NULL));
    for (size_t i = 0; i < N; i++) {
        const double k = shared[i], other = k, mu = k;
        assert_ok(tribo_contact_force(1, dz + 2 * i, depth + i, &k, &other, &mu, single + 3 * i, rate + 9 * i));
    }
    ck_assert_mem_eq(f, bare, sizeof f);
    ck_assert_mem_eq(f, single, sizeof f);
    ck_assert_mem_eq(df, rate, sizeof df);
}

/* Numbers of any size: no exception, all finite, within the limit; and where tangential dz is beyond all forces the force still
 * points against dz. */
TEST(extremes)
{
    const double sizes[] = {0.0, TINY, 1e-310, 1e-160, 1.0, 1e160, 1e300, DBL_MAX};
    const size_t n = COUNT(sizes);
    for (size_t k = 0; k < n * n * n * n * n; k++) {
        const double step = sizes[k % n], from = sizes[k / n % n], normal = sizes[k / n / n % n], mu = sizes[k / n / n / n % n];
        const double tangential = sizes[k / n / n / n / n];
        const struct element e = {{step, -0.5 * step}, k % 7 ? 0.75 : step, tangential, normal, mu, {from, -from, from}};
        double f[3], df[9];
        move(&e, f, df);
        const double load = fmin(normal > 1.0 ? normal * fmin(e.depth, 1e300 / normal) : normal * e.depth, 1e300);
        const double limit = fmin(mu > 1.0 ? mu * fmin(load, 1e300 / mu) : mu * load, 1e300);
        require(-f[2] <= load * (1.0 + 1e-15), "load %g beyond %g", f[2], load);
        require(hypot(f[0] / fmax(limit, 1.0), f[1] / fmax(limit, 1.0)) <= (1.0 + 1e-15) * fmin(limit, 1.0) + 2.0 * TINY,
                "%g %g beyond %g", f[0], f[1], limit);
        for (size_t c = 0; c < 9; c++) {
            require(isfinite(df[c]), "df[%zu] = %g", c, df[c]);
        }
    }
    const struct element far = {{4e200, -3e200}, 1.0, 1e200, 10.0, 1.0, {1.0, 1.0, 0.0}};
    double f[3], df[9];
    move(&far, f, df);
    assert_all_close(f, ((const double[]){-8.0, 6.0, -10.0}), 3, 1e-14);
    assert_close(df[0] * 4e200 / 10.0, -0.36 * 0.8, 1e-14); /* limit/|dz| */
}

/* On bad input nothing is written; the earliest bad argument decides. */
TEST(bad_input)
{
    double dz[] = {0.1, 0.1, 0.2, 0.3}, depth[] = {1.0, 1.0}, kt[] = {1.0, 1.0}, kn[] = {2.0, 2.0}, mu[] = {0.5, 0.5};
    double f[] = {0.5, 0.25, 0.0, 0.5, 0.25, 0.0}, df[18], kept[6];
    double *const all[] = {dz, depth, kt, kn, mu, f};
    const size_t last[] = {3, 1, 1, 1, 1, 5};
    stain(df, sizeof df);
    for (size_t a = 0; a < COUNT(all); a++) {
        double *const x = all[a] + last[a], good = *x;
        const double bad[] = {NAN, INFINITY, -INFINITY, -TINY, -1.0};
        for (size_t k = 0; k < COUNT(bad); k++) {
            const int signed_too = a < 2 || a == 5;
            if (k < 3 || !signed_too) {
                *x = bad[k];
                memcpy(kept, f, sizeof f);
                assert_status(quiet(tribo_contact_force(2, dz, depth, kt, kn, mu, f, df)),
                              k < 3 ? TRIBO_ERR_NOT_FINITE : TRIBO_ERR_NEGATIVE);
                ck_assert_mem_eq(f, kept, sizeof f);
                require(stained(df, sizeof df), "df is written");
            }
        }
        *x = good;
        assert_status(tribo_contact_force(2, a == 0 ? NULL : dz, a == 1 ? NULL : depth, a == 2 ? NULL : kt, a == 3 ? NULL : kn,
                                          a == 4 ? NULL : mu, a == 5 ? NULL : f, df),
                      TRIBO_ERR_NULL);
    }
    assert_status(tribo_contact_force(SIZE_MAX / 72 + 1, dz, depth, kt, kn, mu, f, df), TRIBO_ERR_SIZE);
    assert_ok(tribo_contact_force(0, NULL, NULL, NULL, NULL, NULL, NULL, NULL));
    require(stained(df, sizeof df), "df is written");
    kn[0] = mu[1] = -0.0;
    assert_ok(tribo_contact_force(2, dz, depth, kt, kn, mu, f, df));
}

TEST_MAIN("contact", {values, 200}, {derivatives, 200}, {sliding_derivative, 200}, {borders, 1}, {touch_down, 1},
          {constant_load, 20}, {energy, 20}, {batch, 4}, {extremes, 1}, {bad_input, 1})
