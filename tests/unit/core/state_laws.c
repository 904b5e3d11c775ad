/* SPDX-License-Identifier: BSD-3-Clause */
/* Laws with a state: published values, steps cut into pieces, integration by Runge's method, sliders one by one, derivatives
 * against differences, borders, and bad input. */
#include "traps.h"

#include <string.h>

#include "common/exponent.h"

enum { DAHL, LUGRE, BOUC_WEN, IWAN, LAWS, ROOM = 40, STATES = 3 + 2 * ROOM };

struct element {
    int law;
    double parameter[6], dt, state[STATES]; /* of Dahl's law state[0] is the force */
};

/* Moves e by dz; returns the force. *df_dz: its derivative, where not NULL. */
static double move(struct element *e, double dz, double *df_dz)
{
    double f = e->state[0];
    const double *p = e->parameter;
    switch (e->law) {
    case DAHL:
        assert_quiet(tribo_dahl_force(1, &dz, p, p + 1, &f, df_dz));
        e->state[0] = f;
        break;
    case LUGRE:
        assert_quiet(tribo_lugre_force(1, e->dt, &dz, p, e->state, &f, df_dz));
        break;
    case BOUC_WEN:
        assert_quiet(tribo_bouc_wen_force(1, &dz, p, e->state, &f, df_dz));
        break;
    default:
        assert_quiet(tribo_iwan_force(1, ROOM, &dz, p, e->state, &f, df_dz));
    }
    return f;
}

/* A random element of a law, in a random state within the limit. */
static struct element random_element(struct random *g, int law)
{
    struct element e = {law, {0.0}, uniform(g, 0.1, 1.0), {0.0}};
    const double unit[LAWS][6] = {{5.0, 1.0}, {20.0, 2.0, 1.0, 1.0, 2.0, 1.0}, {2.0, 1.5, 2.0}, {2.0, 2.0, 0.0, 1.0}};
    for (int k = 0; k < 6; k++) {
        e.parameter[k] = unit[law][k] * uniform(g, 0.05, 1.0);
    }
    double most = e.parameter[1]; /* of |state| */
    if (law == LUGRE) {
        most = fmin(e.parameter[3], e.parameter[4]) / e.parameter[0];
    } else if (law == BOUC_WEN) {
        e.parameter[3] = uniform(g, -1.0, 1.5) * e.parameter[2];
        e.parameter[4] = below(g, 2) ? 2.0 : 1.0;
        most = pow(e.parameter[1] / (e.parameter[2] + e.parameter[3] + 0.1), 1.0 / e.parameter[4]);
    } else if (law == IWAN) {
        e.parameter[2] = uniform(g, -0.9, 1.0);
        for (int k = 0; k < 8; k++) {
            move(&e, uniform(g, -1.0, 1.0), NULL);
        }
        return e;
    }
    e.state[0] = most * uniform(g, -1.0, 1.0);
    return e;
}

/* The loop of Dahl's law has the energy 4 L (X - (L/s) tanh(s X/L)); by Simpson's rule. */
TEST(dahl_loop)
{
    struct element e = {DAHL, {100.0, 2.0}, 1.0, {0.0}};
    double energy = 0.0;
    for (int cycle = 0; cycle < 8; cycle++) {
        energy = 0.0;
        for (int k = 0; k < 4000; k++) {
            const double h = (k < 2000 ? 1.0 : -1.0) * 0.1 / 4000.0, f = e.state[0], middle = move(&e, h, NULL);
            energy -= (f + 4.0 * middle + move(&e, h, NULL)) * h / 3.0;
        }
    }
    assert_close(energy, 0.242141712296, 1e-12);
}

/* Segalman's four parameters: closed form of the first loading. */
TEST(iwan_values)
{
    struct element e = {IWAN, {2.0, 3.0, -0.1, 0.1}, 1.0, {0.0}};
    assert_close(move(&e, 0.5, NULL), -0.900917541218, 1e-12);
    assert_close(move(&e, 0.5, NULL), -1.630211188295, 1e-12);
    assert_close(move(&e, 10.0, NULL), -3.0, 1e-15);
    assert_close(move(&e, -10.0, NULL), 3.0, 1e-15);
}

/* Sliders one by one, each in the middle of a piece of the distribution: of second order in their number. */
TEST(iwan_sliders)
{
    enum { SLIDERS = 20000 };
    struct random g = random_of(_i);
    const double kt = 2.0, fs = 3.0, chi = uniform(&g, -0.5, 0.5), beta = uniform(&g, 0.0, 1.0);
    const double sum = beta + (chi + 1.0) / (chi + 2.0), most = fs * (1.0 + beta) / (kt * sum);
    struct element e = {IWAN, {kt, fs, chi, beta}, 1.0, {0.0}};
    static double at[SLIDERS + 1], weight[SLIDERS + 1], reach[SLIDERS + 1];
    for (int k = 0; k <= SLIDERS; k++) {
        const double lo = (double)k / SLIDERS, hi = (k + 1.0) / SLIDERS;
        at[k] = 0.0;
        reach[k] = k < SLIDERS ? 0.5 * (lo + hi) * most : most;
        weight[k] = fs / (most * sum) * (k < SLIDERS ? pow(hi, chi + 1.0) - pow(lo, chi + 1.0) : beta);
    }
    for (int step = 0; step < 60; step++) {
        const double dx = uniform(&g, -1.0, 1.0) * (step % 7 ? 1.2 : 5.0);
        double force = 0.0;
        for (int k = 0; k <= SLIDERS; k++) {
            at[k] = fmin(fmax(at[k] + dx, -reach[k]), reach[k]); /* the stretch of slider k */
            force += weight[k] * at[k];
        }
        assert_close(move(&e, dx, NULL), -force, 1e-6);
    }
    require(e.state[1] <= ROOM, "%g turns", e.state[1]);
}

/* A step of constant velocity is exact: so are its pieces. */
TEST(pieces)
{
    struct random g = random_of(_i);
    for (int law = 0; law < LAWS; law++) {
        struct element e = random_element(&g, law), cut = e;
        const int count = 1 + (int)below(&g, 6);
        const double dz = uniform(&g, -1.5, 1.5), f = move(&e, dz, NULL);
        double last = 0.0;
        cut.dt /= count;
        for (int k = 0; k < count; k++) {
            last = move(&cut, dz / count, NULL);
        }
        assert_close(last, f, 1e-13);
    }
}

/* dz/dt of LuGre's bristles, dz/dx of Bouc and Wen's state. */
static double rate(const struct element *e, double v, double z)
{
    const double *p = e->parameter;
    if (e->law == LUGRE) {
        return v - p[0] * fabs(v) * z / (p[3] + (p[4] - p[3]) * exp(-(v / p[5]) * (v / p[5])));
    }
    return v * (p[1] - pow(fabs(z), p[4]) * (p[3] + p[2] * (z * v > 0.0 ? 1.0 : -1.0)));
}

TEST(integrated)
{
    enum { STEPS = 2000 };
    struct random g = random_of(_i);
    for (int law = LUGRE; law <= BOUC_WEN; law++) {
        struct element e = random_element(&g, law);
        const double dz = uniform(&g, -1.5, 1.5), v = dz / e.dt, h = e.dt / STEPS;
        double z = e.state[0];
        for (int k = 0; k < STEPS; k++) {
            const double a = rate(&e, v, z), b = rate(&e, v, z + 0.5 * h * a), c = rate(&e, v, z + 0.5 * h * b);
            z += h / 6.0 * (a + 2.0 * b + 2.0 * c + rate(&e, v, z + h * c));
        }
        move(&e, dz, NULL);
        assert_close(e.state[0], z, law == LUGRE ? 1e-11 : 1e-6); /* Runge's steps pass the kink at z = 0 */
    }
}

TEST(derivatives)
{
    struct random g = random_of(_i);
    for (int law = 0; law < LAWS; law++) {
        const struct element e = random_element(&g, law);
        const double dz = uniform(&g, 0.05, 1.5) * (below(&g, 2) ? 1.0 : -1.0), h = 1e-4;
        const double weight[] = {1.0, -8.0, 8.0, -1.0}, step[] = {-2.0, -1.0, 1.0, 2.0};
        double sum = 0.0, df_dz;
        for (int k = 0; k < 4; k++) {
            struct element there = e;
            sum += weight[k] / 12.0 * move(&there, dz + step[k] * h, NULL) / h;
        }
        struct element here = e;
        move(&here, dz, &df_dz);
        /* Iwan's slope has a kink where a loop closes: within h of it the difference is off. */
        const double bar = law == IWAN ? 2e-3 : 1e-7;
        assert_close(df_dz, sum, bar * fmax(1.0, fabs(sum)));
    }
}

/* dz = 0 moves nothing; limits of 0 are open. */
TEST(rest)
{
    struct random g = random_of(_i);
    for (int law = 0; law < LAWS; law++) {
        struct element e = random_element(&g, law);
        const struct element before = e;
        double df_dz;
        const double f = move(&e, 0.0, &df_dz);
        ck_assert_mem_eq(e.state, before.state, sizeof e.state);
        require(df_dz <= 0.0, "law %d: df_dz = %g at rest", law, df_dz);
        assert_close(move(&e, 0.0, NULL), f, 0.0);
    }
    struct element open[] = {{DAHL, {1.0, 0.0}, 1.0, {0.0}},
                             {LUGRE, {1.0, 1.0, 0.0, 0.0, 0.0, 1.0}, 1.0, {0.0}},
                             {IWAN, {1.0, 0.0, -0.5, 0.5}, 1.0, {0.0}}};
    for (size_t k = 0; k < COUNT(open); k++) {
        double df_dz = 1.0;
        assert_close(move(open + k, 0.7, &df_dz), 0.0, 0.0);
        assert_close(move(open + k, -0.7, &df_dz), 0.0, 0.0);
        assert_close(df_dz, 0.0, 0.0);
    }
}

/* Numbers from 1e-30 to 1e30: no exception, all finite. */
TEST(extremes)
{
    const double sizes[] = {1e-30, 1e-15, 1.0, 1e15, 1e30};
    const size_t n = COUNT(sizes);
    for (size_t k = 0; k < n * n * n * n * n; k++) {
        const double a = sizes[k % n], b = sizes[k / n % n], c = sizes[k / n / n % n], d = sizes[k / n / n / n % n];
        const double s = sizes[k / n / n / n / n];
        struct element all[] = {{DAHL, {a, b}, 1.0, {c}},
                                {LUGRE, {a, b, c, d, s, b}, c, {0.0}},
                                {LUGRE, {a, b, c, d, s, a}, d, {b}},
                                {BOUC_WEN, {a, b, c, d, 1.0}, 1.0, {-s}},
                                {BOUC_WEN, {a, b, c, -c, 2.0}, 1.0, {-s}},
                                {IWAN, {a, b, -0.9, c}, 1.0, {0.0}},
                                {IWAN, {a, b, 90.0, 0.0}, 1.0, {0.0}}};
        for (size_t i = 0; i < COUNT(all); i++) {
            for (int turn = 0; turn < 3; turn++) {
                double df_dz;
                const double f = move(all + i, turn == 1 ? -d : d, &df_dz);
                require(isfinite(f) && isfinite(df_dz), "f %g, df_dz %g", f, df_dz);
            }
        }
    }
}

/* Bouc and Wen's law with beta = 0, displaced from one bound towards the other: dz/dx = 0 there, and z stays. */
TEST(stationary)
{
    for (int k = 0; k < 1000; k++) {
        const double m = 1.0 + k % 2, gamma = ldexp(1.0, k % 8 - 4), a = gamma * ldexp(1.0, 2 * (k % 5) - 4);
        const double bound = pow(a / gamma, 1.0 / m), sign = k % 3 ? 1.0 : -1.0;
        struct element e = {BOUC_WEN, {1.0, a, 0.0, gamma, m}, 1.0, {-sign * bound}};
        const double f = move(&e, sign * 0.1 * k * bound / a, NULL);
        require(f == sign * bound, "displacement %d: %.17g, not %g", k, f, sign * bound);
    }
}

/* Elements side by side with beta + gamma = 0, where z has no bound, raise no exception. */
TEST(unbounded)
{
    enum { N = 64 };
    double parameter[5 * N], z[N], dz[N], f[N];
    for (size_t i = 0; i < N; i++) {
        const double own[] = {1.0, 1e30, 1.0, -1.0, 1.0 + (double)(i % 2)};
        memcpy(parameter + 5 * i, own, sizeof own);
        z[i] = 0.0;
        dz[i] = 1.0;
    }
    assert_quiet(tribo_bouc_wen_force(N, dz, parameter, z, f, NULL));
    for (size_t i = 0; i < N; i++) {
        assert_close(f[i] / -1e30, 1.0, 1e-15);
    }
}

/* On bad input nothing is written. */
TEST(bad_input)
{
    double dz = 0.1, state[5] = {0.25, 1.0, 1.0, 0.25, -0.1}, f = 0.5, df = 0.75;
    const double kept[] = {0.25, 1.0, 1.0, 0.25, -0.1};
    const double good[LAWS][6] = {{1.0, 1.0}, {1.0, 1.0, 1.0, 1.0, 1.0, 1.0}, {1.0, 1.0, 1.0, 1.0, 1.0}, {1.0, 1.0, 0.0, 1.0}};
    const struct {
        int law, number;
        double value;
        int status;
    } cases[] = {
        {DAHL, 0, -1.0, TRIBO_ERR_NEGATIVE},        {DAHL, 1, NAN, TRIBO_ERR_NOT_FINITE},
        {DAHL, 1, 1e31, TRIBO_ERR_RANGE},           {LUGRE, 0, 0.0, TRIBO_ERR_NOT_POSITIVE},
        {LUGRE, 1, -1.0, TRIBO_ERR_NEGATIVE},       {LUGRE, 3, -1.0, TRIBO_ERR_NEGATIVE},
        {LUGRE, 5, 0.0, TRIBO_ERR_NOT_POSITIVE},    {LUGRE, 5, 1e-31, TRIBO_ERR_RANGE},
        {LUGRE, 4, INFINITY, TRIBO_ERR_NOT_FINITE}, {BOUC_WEN, 1, 0.0, TRIBO_ERR_NOT_POSITIVE},
        {BOUC_WEN, 2, -1.0, TRIBO_ERR_NEGATIVE},    {BOUC_WEN, 3, -1.5, TRIBO_ERR_RANGE},
        {BOUC_WEN, 4, 1.5, TRIBO_ERR_RANGE},        {IWAN, 0, 0.0, TRIBO_ERR_NOT_POSITIVE},
        {IWAN, 2, -1.0, TRIBO_ERR_RANGE},           {IWAN, 3, -1.0, TRIBO_ERR_NEGATIVE},
    };
    for (size_t k = 0; k < COUNT(cases); k++) {
        double p[6];
        memcpy(p, good[cases[k].law], sizeof p);
        p[cases[k].number] = cases[k].value;
        const int status = cases[k].law == DAHL       ? quiet(tribo_dahl_force(1, &dz, p, p + 1, &f, &df))
                           : cases[k].law == LUGRE    ? quiet(tribo_lugre_force(1, 0.1, &dz, p, state, &f, &df))
                           : cases[k].law == BOUC_WEN ? quiet(tribo_bouc_wen_force(1, &dz, p, state, &f, &df))
                                                      : quiet(tribo_iwan_force(1, 1, &dz, p, state, &f, &df));
        assert_status(status, cases[k].status);
        ck_assert_mem_eq(state, kept, sizeof state);
        require(f == 0.5 && df == 0.75, "case %zu is written", k);
    }
    const double *const p = good[IWAN];
    double back = -0.1;
    assert_status(tribo_iwan_force(1, 1, &back, p, state, &f, &df), TRIBO_ERR_SIZE); /* a second turn */
    state[1] = 2.0;
    assert_status(tribo_iwan_force(1, 1, &dz, p, state, &f, &df), TRIBO_ERR_RANGE);
    assert_status(tribo_iwan_force(1, SIZE_MAX, &dz, p, state, &f, &df), TRIBO_ERR_SIZE);
    assert_status(tribo_dahl_force(SIZE_MAX / 8, &dz, p, p, &f, &df), TRIBO_ERR_SIZE);
    assert_status(tribo_dahl_force(1, NULL, p, p, &f, &df), TRIBO_ERR_NULL);
    assert_status(tribo_lugre_force(1, 0.0, &dz, good[LUGRE], state, &f, &df), TRIBO_ERR_NOT_POSITIVE);
    assert_status(tribo_lugre_force(1, 0.1, &dz, NULL, state, &f, &df), TRIBO_ERR_NULL);
    assert_status(tribo_lugre_force(1, 0.1, &dz, good[LUGRE], state, NULL, &df), TRIBO_ERR_NULL);
    assert_status(tribo_bouc_wen_force(1, &dz, good[BOUC_WEN], NULL, &f, &df), TRIBO_ERR_NULL);
    require(f == 0.5 && df == 0.75 && state[0] == 0.25, "outputs are written");
    assert_ok(tribo_iwan_force(0, 0, NULL, NULL, NULL, NULL, NULL));
    assert_ok(tribo_lugre_force(0, 1.0, NULL, NULL, NULL, NULL, NULL));
}

/* Calls of all laws with n elements at dz: parameters [n][6] of which a law has the first numbers, states [n][STATES]. */
static int move_many(int law, size_t n, double dt, const double *dz, const double *parameter, double *state, double *f,
                     double *df)
{
    return law == DAHL       ? tribo_dahl_force(n, dz, parameter, parameter + n, f, df)
           : law == LUGRE    ? tribo_lugre_force(n, dt, dz, parameter, state, f, df)
           : law == BOUC_WEN ? tribo_bouc_wen_force(n, dz, parameter, state, f, df)
                             : tribo_iwan_force(n, ROOM, dz, parameter, state, f, df);
}

/* Many elements in one call have the bits of elements alone; a bad one among them changes none. */
TEST(many)
{
    enum { MOST = 300 };
    static const int numbers[LAWS] = {2, 6, 5, 4};
    static double parameter[6 * MOST], state[MOST * STATES], before[MOST * STATES], f[MOST], df[MOST], dz[MOST];
    struct random g = random_of(_i);
    for (int law = 0; law < LAWS; law++) {
        const size_t n = 1 + below(&g, MOST), size = law == IWAN ? STATES : 1, bad = below(&g, n);
        struct element e[MOST];
        for (size_t i = 0; i < n; i++) {
            e[i] = random_element(&g, law);
            e[i].dt = 0.5;
            dz[i] = below(&g, 9) ? uniform(&g, -1.5, 1.5) : 0.0;
            for (int k = 0; k < numbers[law]; k++) {
                parameter[law == DAHL ? (size_t)k * n + i : (size_t)(numbers[law] * (int)i + k)] = e[i].parameter[k];
            }
            memcpy(state + size * i, e[i].state, size * sizeof *state);
            f[i] = e[i].state[0];
            df[i] = 0.25;
        }
        memcpy(before, state, sizeof state);
        double *at = law == DAHL ? parameter + bad : parameter + numbers[law] * (int)bad, kept = *at;
        *at = -1.0;
        assert_status(move_many(law, n, 0.5, dz, parameter, state, f, df),
                      law == DAHL || law == BOUC_WEN ? TRIBO_ERR_NEGATIVE : TRIBO_ERR_NOT_POSITIVE);
        ck_assert_mem_eq(state, before, sizeof state);
        require(f[n / 2] == e[n / 2].state[0] || law != DAHL, "f is written");
        require(df[n / 2] == 0.25, "df_dz is written");
        *at = kept;
        assert_ok(move_many(law, n, 0.5, dz, parameter, state, f, df));
        for (size_t i = 0; i < n; i++) {
            double slope;
            const double alone = move(e + i, dz[i], &slope);
            require(alone == f[i] && slope == df[i], "law %d, element %zu: f = %.17g, df_dz = %.17g alone; %.17g, %.17g of %zu",
                    law, i, alone, slope, f[i], df[i], n);
            ck_assert_mem_eq(law == DAHL ? f + i : state + size * i, e[i].state, size * sizeof *state);
        }
    }
    /* a limit of -0 is 0 */
    double none[] = {1.0, -0.0}, one = 1.0, way = 0.5, force = 0.0;
    assert_ok(tribo_dahl_force(1, &way, &one, none + 1, &force, NULL));
    assert_close(force, 0.0, 0.0);
}

/* exp, expm1 and log beside those of the system. */
TEST(exponents)
{
    const double unit = 2.3e-16;
    struct random g = random_of(_i);
    for (int k = 0; k < 20000; k++) {
        const double x = (k % 2 ? -1.0 : 1.0) * pow(10.0, uniform(&g, -18.0, 2.8)),
                     y = k % 3 ? pow(10.0, uniform(&g, -300.0, 300.0)) : uniform(&g, 0.5, 1.5);
        assert_close(tribo_exp(x) / exp(x), 1.0, 2.0 * unit);
        assert_close(tribo_expm1(x), expm1(x), 2.5 * unit * fabs(expm1(x)));
        assert_close(tribo_log(y), log(y), 2.0 * unit * fabs(log(y)));
    }
    require(tribo_exp(0.0) == 1.0 && tribo_expm1(0.0) == 0.0 && tribo_log(1.0) == 0.0, "at 0 and 1");
    assert_close(tribo_expm1(-1e30), -1.0, 0.0);
}

TEST_MAIN("state_laws", {many, 40}, {exponents, 3}, {dahl_loop, 1}, {iwan_values, 1}, {iwan_sliders, 5}, {pieces, 300},
          {integrated, 50}, {derivatives, 300}, {rest, 50}, {extremes, 1}, {stationary, 1}, {unbounded, 1}, {bad_input, 1})
