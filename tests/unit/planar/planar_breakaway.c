/* SPDX-License-Identifier: BSD-3-Clause */
/* Static friction above kinetic in the plane: who holds, who breaks away and which way, beside scalar contacts and beside the
 * same rule carried out from outside, round by round. */
#include "problem.h"

#define ONE(x) ((const size_t[]){x})
#define TWO(x, y) ((const double[]){x, y})

/* One planar contact of R = r. */
static tribo_context *plane(int law, const double *limit, const double *r, double ratio, double velocity)
{
    tribo_context *c;
    assert_ok(tribo_create(&c, 2));
    assert_ok(tribo_set_law(c, law));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_epsilon_all(c, 0.1));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_set_planar(c, 1, ONE(0)));
    assert_ok(tribo_set_static(c, TWO(ratio, ratio), velocity > 0.0 ? TWO(velocity, velocity) : NULL));
    return c;
}

static void check_slip(const tribo_context *c, int want)
{
    signed char slip[2];
    assert_ok(tribo_get_slip(c, slip));
    ck_assert_int_eq(slip[0], want);
    ck_assert_int_eq(slip[1], want);
}

/* Forces at rest, or of a step of 1. */
static void check_force(tribo_context *c, int step, const double *a, const double *want)
{
    double f[2];
    assert_ok(step ? tribo_step_force(c, 1.0, a, f) : tribo_balance(c, TWO(0.0, 0.0), a, NULL, f));
    assert_all_close(f, want, 2, 2e-15);
}

/* Holds up to the rim of the larger disc, and that included; beyond it slides at the smaller one, the way it was held. */
TEST(one_disc)
{
    const double r[4] = {1.0, 0.0, 0.0, 1.0};
    tribo_context *c = plane(TRIBO_QUINN, TWO(1.0, 1.0), r, 1.5, 0.0);
    check_force(c, _i, TWO(0.84, -1.12), TWO(-0.84, 1.12));
    check_slip(c, 0);
    check_force(c, _i, TWO(0.9, -1.2), TWO(-0.9, 1.2));
    check_force(c, _i, TWO(0.9 * (1.0 + 1e-13), -1.2 * (1.0 + 1e-13)), TWO(-0.6, 0.8));
    check_slip(c, 3);
    check_force(c, _i, TWO(9.0, -12.0), TWO(-0.6, 0.8));
    check_force(c, _i, TWO(1.2, 0.0), TWO(-1.2, 0.0));
    check_slip(c, 0);
    assert_ok(tribo_set_static(c, NULL, NULL));
    check_slip(c, 0);
    check_force(c, _i, TWO(1.2, 0.0), TWO(-1.0, 0.0));
    check_slip(c, 3);
    tribo_destroy(c);
}

/* A mass that differs by direction, an ellipse: it holds within the larger ellipse, and slides as without static limits. */
TEST(ellipse)
{
    const double r[4] = {2.0, 0.3, 0.3, 0.5}, limit[2] = {2.0, 0.7}, ratio = 1.4;
    struct random g = random_of(_i);
    tribo_context *c = plane(TRIBO_COULOMB, limit, r, ratio, 0.0), *slides = plane(TRIBO_COULOMB, limit, r, 1.0, 0.0);
    size_t held = 0;
    for (int k = 0; k < 200; k++) {
        const double feq[2] = {uniform(&g, -4.0, 4.0), uniform(&g, -1.4, 1.4)};
        const double a[2] = {-r[0] * feq[0] - r[1] * feq[1], -r[2] * feq[0] - r[3] * feq[1]};
        const int holds = hypot(feq[0] / limit[0], feq[1] / limit[1]) < ratio;
        double f[2], want[2];
        assert_ok(tribo_balance(slides, TWO(0.0, 0.0), a, NULL, want));
        assert_ok(tribo_balance(c, TWO(0.0, 0.0), a, NULL, f));
        assert_all_close(f, holds ? feq : want, 2, 1e-12);
        assert_ok(tribo_force(c, TWO(0.0, 0.0), feq, f));
        assert_all_close(f, holds ? feq : want, 2, 1e-12);
        assert_ok(tribo_step_force(c, 0.5, TWO(0.5 * a[0], 0.5 * a[1]), f));
        assert_all_close(f, holds ? feq : want, 2, 1e-12);
        held += (size_t)holds;
    }
    require(held > 20 && held < 180, "%zu held", held);
    tribo_destroy(c);
    tribo_destroy(slides);
}

/* Along any line it is the scalar contact: every law, limits that drop (even) and that fall. */
TEST(line)
{
    const int law = _i / 2;
    const double limit = 1.5, r = 0.7, ratio = 1.4, velocity = _i % 2 ? 0.08 : 0.0, block[4] = {r, 0.0, 0.0, r};
    struct random g = random_of(_i);
    if (velocity == 0.0 && (law == TRIBO_VELOCITY_LIMITED || law == TRIBO_SMOOTH)) {
        return;
    }
    tribo_context *scalar, *c = plane(law, TWO(limit, limit), block, ratio, velocity);
    assert_ok(tribo_create(&scalar, 1));
    assert_ok(tribo_set_law(scalar, law));
    assert_ok(tribo_set_limit_all(scalar, limit));
    assert_ok(tribo_set_epsilon_all(scalar, 0.1));
    assert_ok(tribo_set_operator_diagonal(scalar, &r));
    assert_ok(tribo_set_static(scalar, &ratio, velocity > 0.0 ? &velocity : NULL));
    for (int k = 0; k < 500; k++) {
        const double angle = uniform(&g, -PI, PI), e[2] = {cos(angle), sin(angle)};
        const double v = below(&g, 4) ? uniform(&g, -0.15, 0.15) : 0.0, a = uniform(&g, -3.0, 3.0), feq = -a / r;
        double f[2], want;
        assert_ok(tribo_balance(scalar, &v, &a, NULL, &want));
        assert_ok(tribo_balance(c, TWO(v * e[0], v * e[1]), TWO(a * e[0], a * e[1]), NULL, f));
        assert_all_close(f, TWO(want * e[0], want * e[1]), 2, 1e-13);
        assert_ok(tribo_force(scalar, &v, &feq, &want));
        assert_ok(tribo_force(c, TWO(v * e[0], v * e[1]), TWO(feq * e[0], feq * e[1]), f));
        assert_all_close(f, TWO(want * e[0], want * e[1]), 2, 1e-13);
        assert_ok(tribo_step_force(scalar, 0.3, &a, &want));
        assert_ok(tribo_step_force(c, 0.3, TWO(a * e[0], a * e[1]), f));
        assert_all_close(f, TWO(want * e[0], want * e[1]), 2, 1e-14);
        assert_ok(tribo_step_force_mean(scalar, 0.3, &v, &a, &want));
        assert_ok(tribo_step_force_mean(c, 0.3, TWO(v * e[0], v * e[1]), TWO(a * e[0], a * e[1]), f));
        assert_all_close(f, TWO(want * e[0], want * e[1]), 2, 1e-14);
    }
    assert_close(real_of(c, TRIBO_REAL_MAX_RATE), real_of(scalar, TRIBO_REAL_MAX_RATE), 1e-13);
    tribo_destroy(c);
    tribo_destroy(scalar);
}

/* ------------------------------------------------------------------------------------------------- coupled contacts */

struct scene {
    struct problem p;
    size_t count, first[LARGEST];
    int wide[LARGEST];
    double ratio[LARGEST], velocity[LARGEST];
};

static struct scene scene_create(struct random *g)
{
    const struct recipe recipe = recipe_regular(g, 12);
    struct scene s = {.p = problem_create(g, &recipe)};
    for (size_t i = 0; i < s.p.n; i += (size_t)s.wide[i]) {
        s.wide[i] = i + 1 < s.p.n && below(g, 3) > 0 ? 2 : 1;
        s.ratio[i] = below(g, 4) ? uniform(g, 1.0, 2.0) : 1.0;
        s.velocity[i] = uniform(g, 0.1, 2.0);
        if (s.wide[i] == 2) {
            s.first[s.count++] = i;
            s.p.limit[i + 1] = below(g, 3) ? s.p.limit[i] : s.p.limit[i] * uniform(g, 0.2, 1.0);
            s.p.epsilon[i + 1] = s.p.epsilon[i];
            s.p.v[i + 1] = s.p.v[i] == 0.0 ? 0.0 : s.p.epsilon[i] * uniform(g, -1.0, 1.0);
            s.ratio[i + 1] = s.ratio[i];
            s.velocity[i + 1] = s.velocity[i];
        }
    }
    return s;
}

static tribo_context *scene_context(const struct scene *s, int law, int falls)
{
    tribo_context *c = problem_context(&s->p, law, TRIBO_CONSISTENT);
    assert_ok(tribo_set_planar(c, s->count, s->first));
    if (falls >= 0) {
        assert_ok(tribo_set_static(c, s->ratio, falls ? s->velocity : NULL));
    }
    return c;
}

static double size_of(const struct scene *s, size_t i, const double *x, const double *parts)
{
    return s->wide[i] == 2 ? hypot(x[i] / parts[i], x[i + 1] / parts[i + 1]) : fabs(x[i] / parts[i]);
}

/* Whether the contact at i moves too slowly to slide. */
static int near_stick(const struct scene *s, size_t i, int law)
{
    const double *limit = s->p.limit + i, *v = s->p.v + i;
    if (s->wide[i] == 1) {
        return law == TRIBO_COULOMB ? v[0] == 0.0 : fabs(v[0]) <= s->p.epsilon[i];
    }
    const double length = hypot(limit[0] * v[0], limit[1] * v[1]);
    return law == TRIBO_COULOMB ? length == 0.0 : length < fmax(limit[0], limit[1]) * s->p.epsilon[i];
}

/* The limits of the contact at i as it slides at v. */
static void slide(const struct scene *s, size_t i, const double *v, int falls, double *limit)
{
    const double speed = s->wide[i] == 2 ? hypot(v[i], v[i + 1]) : fabs(v[i]);
    const double factor = falls ? 1.0 + (s->ratio[i] - 1.0) * exp(-speed / s->velocity[i]) : 1.0;
    for (size_t k = i; k < i + (size_t)s->wide[i]; k++) {
        limit[k] = s->p.limit[k] * factor;
    }
}

static void hold(const struct scene *s, size_t i, double *limit)
{
    for (size_t k = i; k < i + (size_t)s->wide[i]; k++) {
        limit[k] = s->p.limit[k] * s->ratio[k];
    }
}

/* The documented rule, by a context that knows no static limits: c's limits are set in every round. */
static void balance_by_rounds(const struct scene *s, tribo_context *c, int law, int falls, double *f)
{
    double limit[LARGEST], most[LARGEST], feq[LARGEST];
    char gone[LARGEST] = {0};
    size_t broken = 1;
    for (size_t i = 0; i < s->p.n; i += (size_t)s->wide[i]) {
        hold(s, i, most);
        gone[i] = (char)(falls || !near_stick(s, i, law));
        if (gone[i]) {
            slide(s, i, s->p.v, falls, limit);
        } else {
            hold(s, i, limit);
        }
    }
    while (broken) {
        broken = 0;
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_balance(c, s->p.v, s->p.a, feq, f));
        for (size_t i = 0; i < s->p.n; i += (size_t)s->wide[i]) {
            if (!gone[i] && size_of(s, i, feq, most) > 1.0 + 1e-9) {
                gone[i] = 1;
                slide(s, i, s->p.v, falls, limit);
                broken++;
            }
        }
    }
}

static void step_by_rounds(const struct scene *s, tribo_context *c, int falls, double *f)
{
    double limit[LARGEST], v[LARGEST];
    char gone[LARGEST] = {0};
    size_t broken = 1;
    for (size_t i = 0; i < s->p.n; i += (size_t)s->wide[i]) {
        hold(s, i, limit);
    }
    while (broken) {
        broken = 0;
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_step_force(c, 1.0, s->p.a, f));
        for (size_t i = 0; i < s->p.n; i++) {
            v[i] = (double)acceleration(&s->p, i, f);
        }
        for (size_t i = 0; i < s->p.n; i += (size_t)s->wide[i]) {
            if (!gone[i] && (s->wide[i] == 2 ? hypot(v[i], v[i + 1]) : fabs(v[i])) > 1e-9) {
                gone[i] = 1;
                slide(s, i, v, falls, limit);
                broken++;
            }
        }
    }
}

TEST(rounds)
{
    const int laws[] = {TRIBO_QUINN, TRIBO_COULOMB, TRIBO_KARNOPP}, falls = _i % 2;
    struct random g = random_of(_i);
    size_t solves = 0, plain = 0;
    for (int k = 0; k < 60; k++) {
        const struct scene s = scene_create(&g);
        const int law = laws[k % 3];
        double f[LARGEST], want[LARGEST];
        tribo_context *c = scene_context(&s, law, falls), *by_rounds = scene_context(&s, law, -1);
        assert_ok(tribo_balance(c, s.p.v, s.p.a, NULL, f));
        balance_by_rounds(&s, by_rounds, law, falls, want);
        assert_all_close(f, want, s.p.n, 1e-10);
        assert_ok(tribo_step_force(c, 1.0, s.p.a, f));
        step_by_rounds(&s, by_rounds, falls, want);
        assert_all_close(f, want, s.p.n, 1e-10);
        solves += count_of(c, TRIBO_COUNT_SOLVES);
        plain += 2;
        tribo_destroy(c);
        tribo_destroy(by_rounds);
    }
    require(solves > plain + 20, "%zu solutions, of which %zu are the first", solves, plain);
}

/* Other tangential directions, the same forces; what a contact carries when its clone is asked. */
TEST(turned)
{
    struct random g = random_of(_i);
    for (int k = 0; k < 40; k++) {
        struct scene s = scene_create(&g), t;
        const size_t n = s.p.n;
        double turn[LARGEST * LARGEST], f[LARGEST], got[LARGEST];
        t = s;
        t.p = problem_turn(&g, &s.p, s.wide, turn);
        tribo_context *c = scene_context(&s, TRIBO_QUINN, k % 2), *d = scene_context(&t, TRIBO_QUINN, k % 2), *copy;
        assert_ok(tribo_clone(d, &copy));
        for (int step = 0; step < 2; step++) {
            assert_ok(step ? tribo_step_force(c, 1.0, s.p.a, f) : tribo_balance(c, s.p.v, s.p.a, NULL, f));
            assert_ok(step ? tribo_step_force(copy, 1.0, t.p.a, got) : tribo_balance(copy, t.p.v, t.p.a, NULL, got));
            problem_check_turned(n, turn, f, got);
        }
        tribo_destroy(c);
        tribo_destroy(d);
        tribo_destroy(copy);
    }
}

#define STEP 1e-7

/* Derivatives by v and a beside differences, where there is neither jump nor kink: limits that fall with |v| have one at rest. */
TEST(tangents)
{
    struct random g = random_of(_i);
    size_t smooth = 0, all = 0;
    for (int k = 0; k < 60; k++) {
        struct scene s = scene_create(&g);
        const size_t n = s.p.n;
        const int falls = k / 6 % 2,
                  law = falls || (k % 6 != TRIBO_VELOCITY_LIMITED && k % 6 != TRIBO_SMOOTH) ? k % 6 : TRIBO_QUINN;
        double by_v[LARGEST * LARGEST], by_a[LARGEST * LARGEST], dv[LARGEST], da[LARGEST], df[LARGEST];
        double f[LARGEST], before[LARGEST], after[LARGEST];
        tribo_context *c = scene_context(&s, law, falls);
        for (size_t i = 0; i < n; i++) {
            dv[i] = law == TRIBO_COULOMB ? 0.0 : uniform(&g, -1.0, 1.0);
            da[i] = uniform(&g, -1.0, 1.0);
            s.p.v[i] += falls && s.p.v[i] == 0.0 ? 0.1 * s.p.epsilon[i] : 0.0;
        }
        assert_ok(tribo_balance_tangent(c, s.p.v, s.p.a, NULL, NULL, by_v, by_a));
        assert_ok(tribo_tangent_product(c, dv, da, df));
        problem_forces(c, &s.p, 0.0, dv, da, f);
        problem_forces(c, &s.p, -STEP, dv, da, before);
        problem_forces(c, &s.p, STEP, dv, da, after);
        for (size_t i = 0; i < n; i++) {
            const double forward = (after[i] - f[i]) / STEP, backward = (f[i] - before[i]) / STEP;
            double sum = 0.0, size = 1.0;
            for (size_t j = 0; j < n; j++) {
                sum += by_v[i * n + j] * dv[j] + by_a[i * n + j] * da[j];
                size += fabs(by_v[i * n + j] * dv[j]) + fabs(by_a[i * n + j] * da[j]);
            }
            assert_close(df[i], sum, 1e-12 * size);
            if (fabs(forward - backward) < 1e-4 * size) {
                assert_close(sum, 0.5 * (forward + backward), 2e-5 * size);
                smooth++;
            }
        }
        all += n;
        tribo_destroy(c);
    }
    require(smooth > all / 2, "only %zu of %zu compared", smooth, all);
}

/* -------------------------------------------------------------------------------------------------------- arguments */

/* A planar contact has one ratio and one velocity, whichever call comes first; what is refused changes nothing. */
/* At rest, pulled beyond limits that fall with the speed, the same in all directions or not: differences on the way in which the
 * contact is about to slide. */
TEST(tangents_about_to_slide)
{
    static const int laws[] = {TRIBO_KARNOPP, TRIBO_QUINN};
    const double limit[] = {1.0, _i & 1 ? 0.6 : 1.0}, r[] = {1.0, 0.2, 0.2, _i & 2 ? 0.5 : 1.0};
    const double h = 1e-7, none[] = {0.0, 0.0}, a[] = {-2.7, -2.1};
    double feq[2], f[2], g[2], dv[4], df[2], way[2], at[2], given[3][4];
    tribo_context *c = plane(laws[_i / 4], limit, r, 1.5, 0.3);
    assert_ok(tribo_balance_tangent(c, none, a, feq, f, dv, NULL));
    for (int k = 0; k < 2; k++) {
        way[k] = a[k] + r[2 * k] * f[0] + r[2 * k + 1] * f[1];
    }
    const double length = hypot(way[0], way[1]);
    for (int k = 0; k < 2; k++) {
        way[k] /= length;
        at[k] = h * way[k];
    }
    assert_ok(tribo_tangent_product(c, way, NULL, df));
    assert_ok(tribo_balance(c, at, a, NULL, g));
    for (int k = 0; k < 2; k++) {
        assert_close(dv[2 * k] * way[0] + dv[2 * k + 1] * way[1], (g[k] - f[k]) / h, 1e-4);
        assert_close(df[k], (g[k] - f[k]) / h, 1e-4);
    }
    assert_ok(tribo_force_tangent_planar(c, none, feq, f, given[0], given[1], given[2]));
    assert_ok(tribo_force(c, at, feq, g));
    for (int k = 0; k < 2; k++) {
        assert_close(given[0][2 * k] * way[0] + given[0][2 * k + 1] * way[1], (g[k] - f[k]) / h, 1e-4);
    }
    tribo_destroy(c);
}

TEST(refusals)
{
    const double r[4] = {1.0, 0.0, 0.0, 1.0};
    double ratio[2], velocity[2];
    tribo_context *c = plane(TRIBO_QUINN, TWO(1.0, 1.0), r, 1.5, 0.2);
    assert_status(tribo_set_static(c, TWO(1.5, 1.6), NULL), TRIBO_ERR_RANGE);
    assert_says(tribo_message(c), "ratio[0] = 1.5 and ratio[1] = 1.6 are of one planar contact, and differ");
    assert_status(tribo_set_static(c, TWO(1.5, 1.5), TWO(0.2, 0.1)), TRIBO_ERR_RANGE);
    assert_says(tribo_message(c), "velocity[0] = 0.2 and velocity[1] = 0.1");
    assert_ok(tribo_get_static(c, ratio, velocity));
    assert_all_exact(ratio, TWO(1.5, 1.5), 2);
    assert_all_exact(velocity, TWO(0.2, 0.2), 2);
    assert_ok(tribo_set_planar(c, 0, NULL));
    assert_ok(tribo_set_static(c, TWO(1.0, 1.6), NULL));
    assert_status(tribo_set_planar(c, 1, ONE(0)), TRIBO_ERR_RANGE);
    assert_says(tribo_message(c), "ratio[0] = 1 and ratio[1] = 1.6");
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_PLANAR), 0);
    tribo_destroy(c);
}

TEST_MAIN("planar_breakaway", {one_disc, 2}, {ellipse, 3}, {line, 12}, {rounds, 6}, {turned, 4}, {tangents, 4},
          {tangents_about_to_slide, 8}, {refusals, 1})
