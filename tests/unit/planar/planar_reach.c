/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar contacts whose limits are far beyond the force, up to 1e300, alone and beside others that slide: conditions of
 * optimality in long double. */
#include <float.h>
#include <string.h>

#include "problem.h"

enum { MOST = 12 };

struct scene {
    size_t n, count, first[MOST], wide[MOST]; /* wide: 2, 1, or 0 for the second direction of a contact */
    double r[MOST * MOST], a[MOST], limit[MOST];
};

static double ten_to(struct random *g, double lo, double hi)
{
    return pow(10.0, uniform(g, lo, hi));
}

/* R = J M J', J with zeros in it; tied: contacts in pairs that are the same. */
static void couple(struct scene *s, struct random *g, int tied)
{
    double j[MOST][MOST], m[MOST];
    for (size_t i = 0; i < s->n; i++) {
        m[i] = ten_to(g, -1.0, 1.0);
        for (size_t k = 0; k < s->n; k++) {
            j[i][k] = i == k ? 1.0 : below(g, 4) ? uniform(g, -0.5, 0.5) : 0.0;
        }
    }
    for (size_t i = 2; tied && i < s->n; i++) {
        memcpy(j[i], j[i % 2], sizeof j[i]);
    }
    for (size_t e = 0; e < s->n * s->n; e++) {
        const size_t i = e / s->n, k = e % s->n, least = i < k ? i : k, most = i < k ? k : i;
        for (size_t d = 0; d < s->n; d++) {
            s->r[e] += j[least][d] * m[d] * j[most][d];
        }
    }
}

/* Limits from the force up to decades beyond it: all alike, or each its own. Now and then an ellipse, or a line. */
static void choose_limits(struct scene *s, struct random *g, double force, double decades)
{
    const double common = force * ten_to(g, 0.0, decades);
    for (size_t i = 0; i < s->n; i += s->wide[i]) {
        const size_t kind = below(g, 4), shape = below(g, 8);
        const double limit = kind == 0 ? common : kind == 1 ? force * ten_to(g, -1.0, 1.0) : force * ten_to(g, 0.0, decades);
        s->limit[i] = limit;
        if (s->wide[i] == 2) {
            s->limit[i + 1] = shape == 0 ? 0.0 : shape == 1 ? force * ten_to(g, -1.0, decades) : limit;
        }
    }
}

/* a is what some forces of that size balance, now and then 0 for some. */
static struct scene scene_create(struct random *g, int tied, double decades)
{
    struct scene s = {0};
    const size_t contacts = 1 + below(g, 6);
    const double force = below(g, 2) ? 1.0 : ten_to(g, -4.0, 4.0);
    double f[MOST];
    for (size_t k = 0; k < contacts; k++) {
        const size_t wide = k == 0 || below(g, 4) ? 2 : 1;
        s.first[s.count] = s.n;
        s.count += wide == 2;
        s.wide[s.n] = wide;
        s.n += wide;
    }
    couple(&s, g, tied);
    choose_limits(&s, g, force, decades);
    for (size_t i = 0; i < s.n; i++) {
        f[i] = force * uniform(g, -1.0, 1.0) * (below(g, 4) ? 1.0 : ten_to(g, -4.0, 0.0));
    }
    for (size_t i = 0; i < s.n; i++) {
        for (size_t k = 0; k < s.n; k++) {
            s.a[i] -= s.r[i * s.n + k] * f[k];
        }
        s.a[i] *= tied || below(g, 4) ? 1.0 : 0.0;
    }
    return s;
}

static tribo_context *scene_context(const struct scene *s, int law)
{
    tribo_context *c;
    assert_ok(tribo_create(&c, s->n));
    assert_ok(tribo_set_law(c, law));
    assert_ok(tribo_set_operator_dense(c, s->r));
    assert_ok(tribo_set_planar(c, s->count, s->first));
    assert_ok(tribo_set_limit(c, s->limit));
    return c;
}

/* R f + a in parts of the sizes of its terms where the contact at i is within its limits; on the rim that along the rim, and
 * what of it points outwards. */
static double imbalance(const struct scene *s, size_t i, const double *a, const double *f)
{
    long double rate[2] = {0.0L, 0.0L}, size[2] = {0.0L, 0.0L}, y[2] = {0.0L, 0.0L}, off = 0.0L;
    for (size_t k = 0; k < s->wide[i]; k++) {
        const size_t row = i + k;
        const long double limit = s->limit[row];
        if (!(limit > 0.0L)) {
            require(f[row] == 0.0, "f[%zu] = %g without a limit", row, f[row]);
            continue;
        }
        rate[k] = a[row];
        size[k] = fabs(a[row]);
        for (size_t j = 0; j < s->n; j++) {
            const long double term = (long double)s->r[row * s->n + j] * f[j];
            rate[k] += term;
            size[k] += fabsl(term);
        }
        off = size[k] > 0.0L ? fmaxl(off, fabsl(rate[k]) / size[k]) : off;
        rate[k] *= limit;
        size[k] *= limit;
        y[k] = f[row] / limit;
    }
    const long double length = hypotl(y[0], y[1]), most = fmaxl(size[0], size[1]);
    require(length <= 1.0L + 1e-12L, "contact %zu carries %Lg of its limit", i, length);
    if (length < 1.0L - 1e-9L || !(most > 0.0L)) {
        return (double)off;
    }
    const long double along = fabsl(y[0] * rate[1] - y[1] * rate[0]), outward = y[0] * rate[0] + y[1] * rate[1];
    const long double around = fabsl(y[0]) * size[1] + fabsl(y[1]) * size[0] + 1e-10L * most;
    return (double)fminl(off, fmaxl(along / around, outward / most));
}

static void check(const struct scene *s, const double *a, const double *f)
{
    for (size_t i = 0; i < s->n; i += s->wide[i]) {
        const double off = imbalance(s, i, a, f);
        require(off < 1e-7, "contact %zu of %zu directions, limit %g: R f + a is %.3g of its terms", i, s->n, s->limit[i], off);
    }
}

/* Every form of the problem at rest, one after the other in one context, and the same again for a smaller pull. */
static void check_random(int seed, int tied, double decades)
{
    struct random g = random_of(seed);
    for (int k = 0; k < 150; k++) {
        const struct scene s = scene_create(&g, tied, decades);
        const double still[MOST] = {0.0};
        double a[MOST], f[MOST];
        tribo_context *c = scene_context(&s, TRIBO_COULOMB);
        if (k % 2) {
            assert_ok(tribo_set_sharing(c, TRIBO_SHARE_PREVIOUS));
        }
        for (int round = 0; round < 3; round++) {
            for (size_t i = 0; i < s.n; i++) {
                a[i] = s.a[i] * (round == 1 ? 1e-3 : round == 2 ? -0.7 : 1.0);
            }
            assert_ok(tribo_balance(c, still, a, NULL, f));
            check(&s, a, f);
            require(real_of(c, TRIBO_REAL_RESIDUAL) < 1e-6, "residual %g", real_of(c, TRIBO_REAL_RESIDUAL));
            assert_ok(tribo_step_force(c, 1.0, a, f));
            check(&s, a, f);
        }
        tribo_destroy(c);
    }
}

TEST(far_limits)
{
    check_random(_i, 0, _i % 2 ? 13.0 : 290.0);
}

TEST(far_limits_tied)
{
    check_random(_i, 1, _i % 2 ? 13.0 : 290.0);
}

/* The limit has no part in the force of a contact that sticks, nor in those of others. */
TEST(any_limit)
{
    const double r[] = {2.0, 0.5, 0.3, 0.1, 0.5, 1.0, 0.0, 0.2, 0.3, 0.0, 1.0, 0.1, 0.1, 0.2, 0.1, 1.5};
    const double a[] = {-3.0, 5.0, 20.0, 30.0}, still[4] = {0.0};
    struct scene s = {.n = 4, .count = 2, .first = {0, 2}, .wide = {2, 0, 2, 0}, .limit = {0.0, 0.0, 1.0, 1.0}};
    double want[4] = {0.0}, f[4], feq[4];
    memcpy(s.r, r, sizeof r);
    for (int e = 2; e <= 300; e++) {
        s.limit[0] = s.limit[1] = pow(10.0, e);
        tribo_context *c = scene_context(&s, TRIBO_QUINN);
        assert_ok(tribo_balance(c, still, a, feq, f));
        check(&s, a, f);
        memcpy(want, e == 2 ? f : want, sizeof want);
        assert_all_close(f, want, 4, 1e-12);
        assert_ok(tribo_step_force(c, 1.0, a, f));
        assert_all_close(f, want, 4, 1e-12);
        assert_ok(tribo_step_force_mean(c, 1.0, still, a, f));
        assert_all_close(f, want, 2, 10.0);
        assert_ok(tribo_force(c, still, feq, f));
        assert_all_close(f, want, 4, 1e-9);
        tribo_destroy(c);
    }
}

/* A contact that holds beside two that slide, from limits that are reached to some that are not. */
TEST(held_beside_sliding)
{
    const double r[] = {204.13725, -94.5876,   -185.12701, 0.85772444, 21.197223,  -94.5876,   83.601658,  74.177376, 40.214564,
                        6.6885449, -185.12701, 74.177376,  178.89407,  -22.517441, -33.066684, 0.85772444, 40.214564, -22.517441,
                        55.217167, 30.117912,  21.197223,  6.6885449,  -33.066684, 30.117912,  22.20007};
    const double a[] = {22555.752, -11162.258, -20311.225, -539.15344, 2138.716};
    struct scene s = {.n = 5, .count = 2, .first = {0, 2}, .wide = {2, 0, 2, 0, 1}, .limit = {0.0, 0.0, 1.356, 1.356, 10.5}};
    double f[5];
    memcpy(s.r, r, sizeof r);
    for (int e = 3; e <= 300; e++) {
        s.limit[0] = s.limit[1] = pow(10.0, e);
        tribo_context *c = scene_context(&s, TRIBO_COULOMB);
        assert_ok(tribo_step_force(c, 1.0, a, f));
        check(&s, a, f);
        tribo_destroy(c);
    }
}

/* A planar contact with one limit is a scalar one, also in a direction that nothing moves. */
TEST(one_living_direction)
{
    struct random g = random_of(_i);
    for (int k = 0; k < 100; k++) {
        const double r[] = {below(&g, 2) ? 5.4 : 0.0, below(&g, 2) ? 1.3 : 0.0}, living = _i % 2;
        const double limit[] = {living > 0.0 ? 0.0 : 0.9, living > 0.0 ? 0.9 : 0.0};
        const double v[] = {uniform(&g, -0.003, 0.003), uniform(&g, -0.003, 0.003)};
        const double a[] = {below(&g, 2) ? 0.0 : uniform(&g, -1.0, 1.0), below(&g, 2) ? 0.0 : uniform(&g, -1.0, 1.0)};
        const size_t first = 0;
        double f[2], want[2];
        tribo_context *c, *scalar;
        assert_ok(tribo_create(&c, 2));
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_set_epsilon_all(c, 0.003));
        assert_ok(tribo_set_operator_diagonal(c, r));
        assert_ok(tribo_clone(c, &scalar));
        assert_ok(tribo_set_planar(c, 1, &first));
        assert_ok(tribo_balance(c, v, a, NULL, f));
        assert_ok(tribo_balance(scalar, v, a, NULL, want));
        assert_all_close(f, want, 2, 1e-14);
        tribo_destroy(c);
        tribo_destroy(scalar);
    }
}

/* Derivatives of forces that stick are the same whatever the limit, and those by limits that are not reached are 0. */
TEST(derivatives)
{
    struct random g = random_of(_i);
    const size_t n = 5;
    struct scene s = {.n = n, .count = 2, .first = {0, 2}, .wide = {2, 0, 2, 0, 1}};
    double f[5], by_a[25], want[25], df[5];
    const double still[5] = {0.0}, dlimit[] = {1.0, 2.0, 0.0, 0.0, 1.0};
    couple(&s, &g, 0);
    for (size_t i = 0; i < n; i++) {
        s.a[i] = uniform(&g, -1.0, 1.0);
    }
    for (int e = 2; e < 300; e += 7) {
        s.limit[0] = s.limit[1] = s.limit[4] = pow(10.0, e);
        s.limit[2] = s.limit[3] = 0.01;
        tribo_context *c = scene_context(&s, TRIBO_COULOMB);
        assert_ok(tribo_balance_tangent(c, still, s.a, NULL, f, NULL, by_a));
        memcpy(want, e == 2 ? by_a : want, sizeof want);
        assert_all_close(by_a, want, n * n, 1e-9);
        assert_ok(tribo_limit_product(c, dlimit, df));
        assert_all_close(df, still, n, 1e-12);
        tribo_destroy(c);
    }
}

TEST_MAIN("planar_reach", {far_limits, 8}, {far_limits_tied, 8}, {any_limit, 1}, {held_beside_sliding, 1},
          {one_living_direction, 2}, {derivatives, 5})
