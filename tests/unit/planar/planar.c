/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar contacts: arguments, the law by its closed forms, and coupled problems by what makes their solution. */
#include <string.h>

#include "problem.h"

#define ONE(x) ((const size_t[]){x})
#define TWO(x, y) ((const double[]){x, y})
#define THREE(x, y, z) ((const double[]){x, y, z})

static tribo_context *context_of(size_t n, int law, double limit, double epsilon, const double *r)
{
    tribo_context *c;
    assert_ok(tribo_create(&c, n));
    assert_ok(tribo_set_law(c, law));
    assert_ok(tribo_set_limit_all(c, limit));
    assert_ok(tribo_set_epsilon_all(c, epsilon));
    assert_ok(tribo_set_operator_diagonal(c, r));
    return c;
}

/* One planar contact of two directions. */
static tribo_context *disc(int law, double limit, double epsilon, double r)
{
    tribo_context *c = context_of(2, law, limit, epsilon, TWO(r, r));
    assert_ok(tribo_set_planar(c, 1, ONE(0)));
    return c;
}

/* ------------------------------------------------------------------------------------------------------- arguments */

TEST(arguments)
{
    tribo_context *c = context_of(5, TRIBO_QUINN, 1.0, 0.1, (const double[]){1.0, 1.0, 1.0, 1.0, 1.0});
    const size_t revision = count_of(c, TRIBO_COUNT_SETTINGS);
    assert_status(tribo_set_planar(NULL, 0, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_set_planar(c, 1, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_set_planar(c, 2, (const size_t[]){0, 4}), TRIBO_ERR_RANGE);
    assert_says(tribo_message(c), "first[1] is contact 4 of 5 contacts");
    assert_status(tribo_set_planar(c, 1, ONE(SIZE_MAX)), TRIBO_ERR_RANGE);
    assert_status(tribo_set_planar(c, 3, (const size_t[]){0, 3, 2}), TRIBO_ERR_DUPLICATE);
    assert_says(tribo_message(c), "first[2] takes contact 3, which first[1] has taken");
    assert_status(tribo_set_planar(c, 2, (const size_t[]){2, 2}), TRIBO_ERR_DUPLICATE);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_PLANAR), 0);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_SETTINGS), revision);
    assert_ok(tribo_set_planar(c, 2, (const size_t[]){3, 0}));
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_PLANAR), 2);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_ISLANDS), 3);
    ck_assert_uint_ne(count_of(c, TRIBO_COUNT_SETTINGS), revision);
    assert_status(tribo_set_coupling(c, TRIBO_PARTITION), TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_message(c), "partition");
    assert_ok(tribo_set_planar(c, 0, NULL));
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_ISLANDS), 5);
    assert_ok(tribo_set_coupling(c, TRIBO_PARTITION));
    assert_status(tribo_set_planar(c, 1, ONE(0)), TRIBO_ERR_UNSUPPORTED);
    tribo_destroy(c);
    assert_ok(tribo_create(&c, 1));
    assert_status(tribo_set_planar(c, 1, ONE(0)), TRIBO_ERR_RANGE);
    assert_ok(tribo_set_planar(c, 0, NULL));
    tribo_destroy(c);
}

/* Without planar contacts all is as it was, and so it is when they are gone. */
TEST(undone)
{
    const double r[] = {2.0, 1.0, 1.0, 2.0}, v[] = {0.05, -0.02}, a[] = {1.0, -3.0};
    double f[2], want[2];
    tribo_context *c = context_of(2, TRIBO_QUINN, 1.0, 0.1, TWO(1.0, 1.0));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_balance(c, v, a, NULL, want));
    assert_ok(tribo_set_planar(c, 1, ONE(0)));
    assert_ok(tribo_balance(c, v, a, NULL, f));
    require(f[0] != want[0], "the planar force is the scalar one");
    assert_ok(tribo_set_planar(c, 0, NULL));
    assert_ok(tribo_balance(c, v, a, NULL, f));
    assert_all_exact(f, want, 2);
    tribo_destroy(c);
}

/* ------------------------------------------------------------------------------------------------------ one contact */

/* At rest: what holds it, or the limit against what pulls. */
TEST(rest)
{
    const int laws[] = {TRIBO_COULOMB, TRIBO_KARNOPP, TRIBO_QUINN, TRIBO_QUINN_REVERSAL};
    signed char slip[2];
    double f[2], feq[2];
    tribo_context *c = disc(laws[_i], 2.0, 0.1, 0.5);
    assert_ok(tribo_balance(c, TWO(0.0, 0.0), TWO(0.6, -0.3), feq, f));
    assert_all_close(f, TWO(-1.2, 0.6), 2, 1e-15);
    assert_all_close(feq, f, 2, 1e-15);
    assert_ok(tribo_get_slip(c, slip));
    ck_assert(slip[0] == TRIBO_SLIP_STUCK && slip[1] == TRIBO_SLIP_STUCK);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_STUCK), 2);
    assert_ok(tribo_balance(c, TWO(0.0, 0.0), TWO(3.0, -4.0), feq, f));
    assert_all_close(f, TWO(-1.2, 1.6), 2, 1e-15);
    assert_all_close(feq, TWO(-6.0, 8.0), 2, 1e-14);
    assert_ok(tribo_get_slip(c, slip));
    ck_assert(slip[0] == TRIBO_SLIP_PLANE && slip[1] == TRIBO_SLIP_PLANE);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_STUCK), 0);
    assert_ok(tribo_balance(c, TWO(0.0, 0.0), TWO(0.0, 0.0), NULL, f));
    assert_all_exact(f, TWO(0.0, 0.0), 2);
    tribo_destroy(c);
}

/* In motion: against the direction of motion, and by how fast it is. */
TEST(motion)
{
    const struct {
        int law;
        double speed, carried;
    } cases[] = {{TRIBO_COULOMB, 1e-9, 1.0},         {TRIBO_KARNOPP, 1.01, 1.0},         {TRIBO_QUINN, 1.0, 1.0},
                 {TRIBO_QUINN_REVERSAL, 3.0, 1.0},   {TRIBO_SMOOTH, 0.5, tanh(0.5)},     {TRIBO_SMOOTH, 7.0, tanh(7.0)},
                 {TRIBO_VELOCITY_LIMITED, 0.5, 0.5}, {TRIBO_VELOCITY_LIMITED, 2.0, 1.0}, {TRIBO_VELOCITY_LIMITED, 0.0, 0.0}};
    for (size_t k = 0; k < COUNT(cases); k++) {
        const double epsilon = 0.1, v[2] = {0.6 * cases[k].speed * epsilon, -0.8 * cases[k].speed * epsilon};
        double f[2], given[2];
        tribo_context *c = disc(cases[k].law, 5.0, epsilon, 0.5);
        assert_ok(tribo_balance(c, v, TWO(3.0, 40.0), NULL, f));
        assert_all_close(f, TWO(-3.0 * cases[k].carried, 4.0 * cases[k].carried), 2, 2e-15);
        assert_ok(tribo_force(c, v, TWO(NAN, NAN), given));
        assert_all_exact(given, f, 2);
        ck_assert_uint_eq(count_of(c, TRIBO_COUNT_SOLVES), 0);
        tribo_destroy(c);
    }
}

/* The nearest point of the lens to z = f_eq - kappa, in its four places. Limit and epsilon 1, kappa = (1.2, 0). */
TEST(lens)
{
    const double v[2] = {0.6, 0.0}, disc_rim = hypot(4.2, 0.7), shifted_rim = hypot(5.0, 1.0), corner = 0.8;
    const struct {
        double a[2], f[2];
    } cases[] = {{{-0.9, 0.2}, {-0.3, -0.2}},
                 {{3.0, 0.7}, {-4.2 / disc_rim, -0.7 / disc_rim}},
                 {{-5.0, -1.0}, {5.0 / shifted_rim - 1.2, 1.0 / shifted_rim}},
                 {{-0.6, -9.0}, {-0.6, corner}},
                 {{-0.6, 9.0}, {-0.6, -corner}}};
    tribo_context *c = disc(TRIBO_QUINN, 1.0, 1.0, 1.0);
    for (size_t k = 0; k < COUNT(cases); k++) {
        double f[2], feq[2], law[2];
        assert_ok(tribo_balance(c, v, cases[k].a, feq, f));
        assert_all_close(f, cases[k].f, 2, 1e-15);
        assert_all_close(feq, TWO(-cases[k].a[0], -cases[k].a[1]), 2, 1e-15);
        assert_ok(tribo_force(c, v, feq, law));
        assert_all_close(law, f, 2, 1e-15);
    }
    tribo_destroy(c);
}

/* A velocity whose square underflows: the force is along the pull, as at rest. */
TEST(hardly_a_lens)
{
    const double a[2] = {5.0, 1.0}, feq[2] = {-5.0, -1.0}, length = sqrt(26.0);
    tribo_context *c = disc(TRIBO_QUINN, 1.0, 1e-3, 1.0);
    for (double speed = 1e-100; speed > 0.0; speed *= 1e-10) {
        for (int side = -1; side <= 1; side += 2) {
            double f[2];
            assert_ok(tribo_balance(c, TWO(side * speed, 0.0), a, NULL, f));
            assert_all_close(f, TWO(-5.0 / length, -1.0 / length), 2, 1e-15);
            assert_ok(tribo_force(c, TWO(side * speed, 0.0), feq, f));
            assert_all_close(f, TWO(-5.0 / length, -1.0 / length), 2, 1e-15);
        }
    }
    tribo_destroy(c);
}

/* A contact that moves and is pulled along one direction only is a scalar one, however its axes are turned. */
TEST(line)
{
    struct random g = random_of(_i);
    const double angle = uniform(&g, -PI, PI), e[2] = {cos(angle), sin(angle)};
    for (int law = 0; law < tribo_law_count(); law++) {
        for (int k = 0; k < 200; k++) {
            const double v = below(&g, 5) ? uniform(&g, -0.15, 0.15) : 0.0, a = uniform(&g, -4.0, 4.0);
            tribo_context *c = disc(law, 1.5, 0.1, 0.7), *scalar = context_of(1, law, 1.5, 0.1, THREE(0.7, 0.0, 0.0));
            double f[2], want;
            assert_ok(tribo_balance(scalar, &v, &a, NULL, &want));
            assert_ok(tribo_balance(c, TWO(v * e[0], v * e[1]), TWO(a * e[0], a * e[1]), NULL, f));
            assert_all_close(f, TWO(want * e[0], want * e[1]), 2, 3e-15 * 40.0);
            assert_ok(tribo_step_force(scalar, 0.3, &v, &want));
            assert_ok(tribo_step_force(c, 0.3, TWO(v * e[0], v * e[1]), f));
            assert_all_close(f, TWO(want * e[0], want * e[1]), 2, 3e-15);
            tribo_destroy(scalar);
            tribo_destroy(c);
        }
    }
}

/* With a limit of one direction only it is a scalar contact in that direction. */
TEST(flat)
{
    struct random g = random_of(_i);
    const double r[4] = {2.0, 0.5, 0.5, 1.0};
    for (int law = 0; law < tribo_law_count(); law++) {
        tribo_context *c = context_of(2, law, 0.0, 0.1, TWO(1.0, 1.0)), *scalar = context_of(2, law, 0.0, 0.1, TWO(1.0, 1.0));
        const int free = law % 2;
        const double limit[2] = {free ? 0.0 : 1.5, free ? 1.5 : 0.0};
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_set_limit(scalar, limit));
        assert_ok(tribo_set_operator_dense(c, r));
        assert_ok(tribo_set_operator_dense(scalar, r));
        assert_ok(tribo_set_planar(c, 1, ONE(0)));
        for (int k = 0; k < 100; k++) {
            const double v[2] = {below(&g, 5) ? uniform(&g, -0.15, 0.15) : 0.0, uniform(&g, -0.15, 0.15)};
            const double a[2] = {uniform(&g, -9.0, 9.0), uniform(&g, -9.0, 9.0)};
            double f[2], want[2];
            assert_ok(tribo_balance(scalar, v, a, NULL, want));
            assert_ok(tribo_balance(c, v, a, NULL, f));
            if (law != TRIBO_QUINN_REVERSAL) {
                assert_all_close(f, want, 2, 1e-14);
            }
            assert_ok(tribo_step_force(scalar, 0.3, v, want));
            assert_ok(tribo_step_force(c, 0.3, v, f));
            assert_all_close(f, want, 2, 1e-14);
        }
        tribo_destroy(scalar);
        tribo_destroy(c);
    }
}

TEST(open)
{
    signed char slip[2];
    double f[2] = {1.0, 1.0}, feq[2] = {1.0, 1.0};
    tribo_context *c = disc(TRIBO_QUINN, 0.0, 0.1, 1.0);
    assert_ok(tribo_balance(c, TWO(0.0, 0.0), TWO(1.0, 1.0), feq, f));
    assert_all_exact(f, TWO(0.0, 0.0), 2);
    assert_all_exact(feq, TWO(0.0, 0.0), 2);
    assert_ok(tribo_get_slip(c, slip));
    ck_assert(slip[0] == TRIBO_SLIP_OPEN && slip[1] == TRIBO_SLIP_OPEN);
    assert_ok(tribo_step_force(c, 0.1, TWO(1.0, 1.0), f));
    assert_all_exact(f, TWO(0.0, 0.0), 2);
    tribo_destroy(c);
}

/* What friction cannot move carries its limit against what pulls, and nothing if nothing does. */
TEST(immovable)
{
    double f[2];
    tribo_context *c = disc(TRIBO_QUINN, 5.0, 0.1, 0.0);
    assert_ok(tribo_balance(c, TWO(0.0, 0.0), TWO(0.3, -0.4), NULL, f));
    assert_all_close(f, TWO(-3.0, 4.0), 2, 1e-14);
    assert_ok(tribo_balance(c, TWO(0.0, 0.0), TWO(0.0, 0.0), NULL, f));
    assert_all_exact(f, TWO(0.0, 0.0), 2);
    tribo_destroy(c);
}

/* An ellipse slides by the most that friction can dissipate: f = -limit^2 v/|limit v|. */
TEST(ellipse)
{
    const double limit[2] = {3.0, 1.0}, v[2] = {0.4, 0.9}, length = hypot(3.0 * 0.4, 0.9);
    const double want[2] = {-9.0 * 0.4 / length, -0.9 / length};
    double f[2];
    tribo_context *c = disc(TRIBO_QUINN, 1.0, 0.1, 1.0);
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_balance(c, v, TWO(5.0, 5.0), NULL, f));
    assert_all_close(f, want, 2, 1e-15);
    /* at rest: on the rim where its normal is against R f + a */
    assert_ok(tribo_balance(c, TWO(0.0, 0.0), TWO(4.0, 2.0), NULL, f));
    const double g[2] = {f[0] + 4.0, f[1] + 2.0}, y[2] = {f[0] / 3.0, f[1]};
    assert_close(hypot(y[0], y[1]), 1.0, 1e-15);
    assert_close(3.0 * g[0] * y[1], g[1] * y[0], 1e-14);
    require(g[0] * f[0] < 0.0, "friction drives");
    tribo_destroy(c);
}

/* ------------------------------------------------------------------------------------------- blocks of derivatives */

#define STEP 1e-7

/* Column d of the block by v, f_eq or limits (kind 0, 1, 2) beside differences of f; returns how many entries are smooth. */
static size_t check_column(tribo_context *c, const double *v, const double *feq, const double *limit, int kind, size_t d,
                           const double *block)
{
    double at[3][3], f[3][3];
    size_t smooth = 0;
    for (int side = 0; side < 3; side++) {
        const double *const from[3] = {v, feq, limit};
        for (int k = 0; k < 3; k++) {
            memcpy(at[k], from[k], sizeof at[k]);
        }
        at[kind][d] += (side - 1) * STEP;
        assert_ok(tribo_set_limit(c, at[2]));
        assert_ok(tribo_force(c, at[0], at[1], f[side]));
    }
    assert_ok(tribo_set_limit(c, limit));
    for (size_t i = 0; i < 3; i++) {
        const double forward = (f[2][i] - f[1][i]) / STEP, backward = (f[1][i] - f[0][i]) / STEP;
        const double want = i < 2 && d < 2 ? block[2 * i + d] : i == d ? block[2 * i] : 0.0, size = 1.0 + fabs(want);
        if (fabs(forward - backward) < 1e-4 * size) {
            require(fabs(want - 0.5 * (forward + backward)) < 3e-5 * size, "f[%zu] by [%zu] of %d: %g, not %g", i, d, kind, want,
                    0.5 * (forward + backward));
            smooth++;
        }
    }
    return smooth;
}

/* One planar contact and a scalar one: every law, epsilon given or not, static limits that drop or fall or none. */
TEST(blocks)
{
    const int law = _i % tribo_law_count(), follows = _i / tribo_law_count() % 2, way = _i / tribo_law_count() / 2;
    const double r[9] = {2.0, 0.4, 0.0, 0.4, 1.0, 0.0, 0.0, 0.0, 1.5};
    struct random g = random_of(_i);
    size_t smooth = 0, all = 0;
    if (way == 1 && (law == TRIBO_VELOCITY_LIMITED || law == TRIBO_SMOOTH)) {
        return;
    }
    for (int k = 0; k < 80; k++) {
        const double limit[3] = {1.0, uniform(&g, 0.3, 1.5), 1.2}, scale = law == TRIBO_COULOMB ? k % 2 : 1.0;
        const double v[3] = {scale * uniform(&g, -0.1, 0.1), scale * uniform(&g, -0.1, 0.1), uniform(&g, -0.1, 0.1)};
        const double feq[3] = {uniform(&g, -2.0, 2.0), uniform(&g, -2.0, 2.0), uniform(&g, -2.0, 2.0)};
        double block[3][6], f[3], want[3];
        tribo_context *c = context_of(3, law, 1.0, 0.1, THREE(1.0, 1.0, 1.0));
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_set_operator_dense(c, r));
        assert_ok(tribo_set_planar(c, 1, ONE(0)));
        assert_ok(follows ? tribo_set_epsilon_step(c, 0.05, 2.0) : TRIBO_OK);
        assert_ok(way ? tribo_set_static(c, THREE(1.3, 1.3, 1.6), way == 2 ? THREE(0.2, 0.2, 0.2) : NULL) : TRIBO_OK);
        assert_ok(tribo_accept(c, THREE(9.0, 9.0, 9.0), feq));
        assert_status(tribo_force_tangent(c, v, feq, NULL, block[0], NULL, NULL), TRIBO_ERR_UNSUPPORTED);
        assert_ok(tribo_force_tangent_planar(c, v, feq, f, block[0], block[1], block[2]));
        assert_ok(tribo_force(c, v, feq, want));
        assert_all_exact(f, want, 3);
        for (int kind = law == TRIBO_COULOMB ? 1 : 0; kind < 3; kind++) {
            for (size_t d = 0; d < 3; d++) {
                smooth += check_column(c, v, feq, limit, kind, d, block[kind]);
                all += 3;
            }
            assert_exact(block[kind][5], 0.0);
        }
        tribo_destroy(c);
    }
    require(10 * smooth > 9 * all, "only %zu of %zu compared", smooth, all);
}

/* Without planar contacts the first column is tribo_force_tangent; and at corners, rims and ends of the band all is bounded. */
TEST(bounded)
{
    struct random g = random_of(_i);
    tribo_context *c = disc(TRIBO_QUINN, 1.0, 1.0, 1.0), *scalar = context_of(2, TRIBO_QUINN, 1.0, 1.0, TWO(1.0, 1.0));
    for (int k = 0; k < 400; k++) {
        const double speed = 1.0 - pow(10.0, -(k % 17)), angle = uniform(&g, -PI, PI), turn = PI / 4.0 * (double)below(&g, 8);
        const double v[2] = {speed * cos(angle), speed * sin(angle)}, size = below(&g, 2) ? 1.0 : 2.0;
        const double feq[2] = {size * cos(angle + turn), size * sin(angle + turn)};
        double by_v[4], by_feq[4], by_limit[4], diagonal[2];
        assert_ok(tribo_force_tangent_planar(c, v, feq, NULL, by_v, by_feq, by_limit));
        for (int i = 0; i < 4; i++) {
            require(fabs(by_v[i]) < 1e9 && fabs(by_feq[i]) < 1e9 && fabs(by_limit[i]) < 1e9, "%g %g %g", by_v[i], by_feq[i],
                    by_limit[i]);
        }
        assert_ok(tribo_force_tangent_planar(scalar, v, feq, NULL, by_v, NULL, NULL));
        assert_ok(tribo_force_tangent(scalar, v, feq, NULL, diagonal, NULL, NULL));
        assert_all_exact(by_v, ((const double[]){diagonal[0], 0.0, diagonal[1], 0.0}), 4);
    }
    assert_status(tribo_force_tangent_planar(NULL, TWO(0.0, 0.0), TWO(0.0, 0.0), NULL, NULL, NULL, NULL), TRIBO_ERR_NULL);
    assert_status(tribo_force_tangent_planar(c, TWO(0.0, 0.0), TWO(0.0, NAN), NULL, NULL, NULL, NULL), TRIBO_ERR_NOT_FINITE);
    tribo_destroy(c);
    tribo_destroy(scalar);
}

TEST_MAIN("planar", {arguments, 1}, {undone, 1}, {rest, 4}, {motion, 1}, {lens, 1}, {hardly_a_lens, 1}, {line, 4}, {flat, 2},
          {open, 1}, {immovable, 1}, {ellipse, 1}, {blocks, 36}, {bounded, 2})
