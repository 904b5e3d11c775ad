/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction laws of one contact: the registry, values, bounds, derivatives, and the reversal law with its memory. */
#include <limits.h>
#include <string.h>

#include "support.h"

#define ULPS(n) ((n)*DBL_EPSILON)

static const double none = NAN;

/* ---------------------------------------------------------------------------------------------------------- registry */

static const char *const names[] = {"coulomb", "velocity-limited", "smooth", "karnopp", "quinn", "quinn-reversal"};

TEST(registry)
{
    ck_assert_int_eq(tribo_law_count(), COUNT(names));
    for (int law = 0; law < tribo_law_count(); law++) {
        int found = -1;
        ck_assert_str_eq(tribo_law_name(law), names[law]);
        ck_assert_uint_gt(strlen(tribo_law_reference(law)), 10);
        assert_ok(tribo_law_find(names[law], &found));
        ck_assert_int_eq(found, law);
    }
    assert_says(tribo_law_reference(TRIBO_QUINN), "doi:10.1115/1.1760564");
    const char *const cases[] = {"QUINN-REVERSAL", "Quinn-Reversal", "qUINN-rEVERSAL"};
    for (size_t i = 0; i < COUNT(cases); i++) {
        int found = -1;
        assert_ok(tribo_law_find(cases[i], &found));
        ck_assert_int_eq(found, TRIBO_QUINN_REVERSAL);
    }
    const int outside[] = {-1, (int)COUNT(names), INT_MIN, INT_MAX};
    for (size_t i = 0; i < COUNT(outside); i++) {
        ck_assert_ptr_null(tribo_law_name(outside[i]));
        ck_assert_ptr_null(tribo_law_reference(outside[i]));
    }
}

TEST(unknown_names)
{
    const char *const unknown[] = {"", "quin", "quinn ", " quinn", "quinn-reversal-2", "coulomb\n", "qu\xc4nn"};
    int found = 77;
    for (size_t i = 0; i < COUNT(unknown); i++) {
        ck_assert_int_eq(tribo_law_find(unknown[i], &found), TRIBO_ERR_NAME);
    }
    ck_assert_int_eq(tribo_law_find(NULL, &found), TRIBO_ERR_NULL);
    ck_assert_int_eq(tribo_law_find("quinn", NULL), TRIBO_ERR_NULL);
    ck_assert_int_eq(found, 77);
}

/* ------------------------------------------------------------------------------------------------------------ values */

static double force_of(int law, double v, double feq, double limit, double epsilon)
{
    double f;
    assert_ok(tribo_law_eval(law, v, feq, limit, epsilon, &f, NULL, NULL, NULL));
    return f;
}

/* g(r) of the reversal law. The closed form loses about r^2 LDBL_EPSILON. */
static double crossing(double r)
{
    const long double x = r;
    return r > 1.0 ? (double)(x - (x - 1.0L) * (x + 1.0L) / 2.0L * logl((x + 1.0L) / (x - 1.0L))) : 1.0;
}

/* The laws as their sources write them; Quinn's by s and xi, which is not how the library computes it. */
static double formula(int law, double v, double feq, double limit, double epsilon)
{
    const double held = clamped(feq, limit), slid = -limit * sgn(v);
    const double r = limit > 0.0 ? fabs(feq) / limit : 0.0;
    const double xi = epsilon / 2.0 * (limit > 0.0 ? held / limit : 0.0) * (law == TRIBO_QUINN_REVERSAL ? crossing(r) : 1.0);
    switch (law) {
    case TRIBO_COULOMB:
        return v != 0.0 ? slid : held;
    case TRIBO_VELOCITY_LIMITED:
        return clamped(-limit * (v / epsilon), limit);
    case TRIBO_SMOOTH:
        return -limit * tanh(v / epsilon);
    case TRIBO_KARNOPP:
        return fabs(v) <= epsilon ? held : slid;
    default:
        return fabs(v - xi) <= epsilon / 2.0 ? -(2.0 * limit / epsilon) * (v - xi) : -limit * sgn(v - xi);
    }
}

static const double places[] = {0.0, 1e-9, 0.05, 0.25, 0.4999, 0.5, 0.6, 0.9, 1.0, 1.0 + 4.0 * DBL_EPSILON, 1.5, 1e6};
static const double ratios[] = {0.0, 1e-9, 0.2, 0.5, 0.99, 1.0, 1.01, 1.3, 2.0, 5.0, 80.0};

TEST(values)
{
    const double limits[] = {0.0, 1.0, 0.3, 7.3e5, 4e-7}, epsilons[] = {1.0, 1e-6, 3e4};
    for (size_t at = 0; at < 2 * COUNT(places) * 2 * COUNT(ratios); at++) {
        const double place = places[at / 2 % COUNT(places)] * (at % 2 ? 1.0 : -1.0);
        const double ratio = ratios[at / 4 / COUNT(places)] * (at / 2 / COUNT(places) % 2 ? 1.0 : -1.0);
        for (size_t k = 0; k < COUNT(limits) * COUNT(epsilons); k++) {
            const double limit = limits[k % COUNT(limits)], epsilon = epsilons[k / COUNT(limits)];
            const double v = place * epsilon, feq = ratio * limit;
            /* at the edges of the band, formula and library may fall to different sides, where both are as good */
            assert_close(force_of(_i, v, feq, limit, epsilon), formula(_i, v, feq, limit, epsilon), ULPS(12) * limit);
        }
    }
}

TEST(odd_symmetry)
{
    struct random g = random_of(_i);
    for (int k = 0; k < 20000; k++) {
        const double limit = log_uniform(&g, 6), epsilon = log_uniform(&g, 6);
        const double v = epsilon * uniform(&g, -1.5, 1.5), feq = limit * uniform(&g, -4.0, 4.0);
        assert_exact(force_of(_i, -v, -feq, limit, epsilon), -force_of(_i, v, feq, limit, epsilon));
    }
}

/* Sliding is -N sgn v bit for bit, but for the smooth law, and f_eq is not looked at. */
static void check_bound(int law, double v, double feq, double limit, double epsilon)
{
    const double f = force_of(law, v, feq, limit, epsilon);
    require(fabs(f) <= limit, "%s: |%g| > %g at v %g, feq %g, epsilon %g", names[law], f, limit, v, feq, epsilon);
    if (fabs(v) > epsilon && law != TRIBO_SMOOTH) {
        assert_exact(f, -limit * sgn(v));
        assert_exact(force_of(law, v, none, limit, epsilon), f);
    }
}

TEST(bounds)
{
    const double sizes[] = {1e-300, 1e-160, 1e-20, 1.0, 3e15, 1e160, 1e300, DBL_MAX};
    const size_t n = COUNT(sizes);
    for (size_t k = 0; k < n * n * n * n; k++) {
        const double limit = sizes[k % n], epsilon = sizes[k / n % n], feq = sizes[k / n / n % n], other = sizes[k / n / n / n];
        const double v[] = {0.0, other, -other, epsilon, -0.3 * epsilon, nextafter(epsilon, HUGE_VAL)};
        for (size_t i = 0; i < COUNT(v); i++) {
            if (isfinite(v[i])) {
                check_bound(_i, v[i], feq, limit, epsilon);
                check_bound(_i, v[i], -feq, limit, epsilon);
                check_bound(_i, v[i], limit, limit, epsilon);
                check_bound(_i, v[i], feq, 0.0, epsilon);
            }
        }
    }
}

/* A limit that rounds badly must not be exceeded by an ulp anywhere in the band either. */
TEST(bounds_in_the_band)
{
    struct random g = random_of(_i);
    for (int k = 0; k < 100000; k++) {
        const double limit = log_uniform(&g, 3), epsilon = log_uniform(&g, 3);
        check_bound(_i, epsilon * uniform(&g, -1.1, 1.1), limit * uniform(&g, -3, 3), limit, epsilon);
    }
}

/* -------------------------------------------------------------------------------------------------------- derivatives */

/* One contact whose law, limit and epsilon can be varied: on its own, or in a context whose epsilon follows the limit. */
struct contact {
    int law;
    tribo_context *context; /* NULL: tribo_law_eval */
    double x[3];            /* v, feq, limit */
    double epsilon;
};

static double evaluate(const struct contact *c, double *d)
{
    double f;
    if (!c->context) {
        assert_ok(tribo_law_eval(c->law, c->x[0], c->x[1], c->x[2], c->epsilon, &f, d, d ? d + 1 : NULL, d ? d + 2 : NULL));
        return f;
    }
    assert_ok(tribo_set_limit_all(c->context, c->x[2]));
    assert_ok(tribo_force_tangent(c->context, c->x, c->x + 1, &f, d, d ? d + 1 : NULL, d ? d + 2 : NULL));
    return f;
}

/* Compares a derivative with differences, both one-sided ones having to agree, or else there is a kink in between, and it must be
 * one of them. Answers whether there was one. */
static int check_derivative(struct contact c, int which, double got, double h, double scale)
{
    const double f = evaluate(&c, NULL), x = c.x[which];
    c.x[which] = x + h;
    const double forward = (evaluate(&c, NULL) - f) / h;
    c.x[which] = x - h;
    const double backward = (f - evaluate(&c, NULL)) / h;
    const double tolerance = 1e-5 * scale; /* steps of 1e-7 lose 1e-9 to rounding, and 1e-7 times the curvature, at most 50 */
    if (fabs(forward - backward) < tolerance) {
        assert_close(got, 0.5 * (forward + backward), tolerance);
        return 0;
    }
    assert_close(got, fabs(got - forward) < fabs(got - backward) ? forward : backward, tolerance);
    return 1;
}

/* At random places but f_eq = N, where the reversal law has a vertical tangent; epsilon is 2 N in the context. */
static int check_derivatives(struct contact *c, struct random *g)
{
    const double limit = log_uniform(g, 2), ratio = uniform(g, -3.0, 3.0);
    const double epsilon = c->context ? 2.0 * limit : log_uniform(g, 2);
    c->epsilon = epsilon;
    c->x[0] = epsilon * uniform(g, -1.4, 1.4);
    c->x[1] = limit * (fabs(fabs(ratio) - 1.0) < 0.02 ? 0.0 : ratio);
    c->x[2] = limit;
    double d[3];
    evaluate(c, d);
    const int kinks[] = {check_derivative(*c, 0, d[0], 1e-7 * epsilon, limit / epsilon),
                         check_derivative(*c, 1, d[1], 1e-7 * limit, 1.0), check_derivative(*c, 2, d[2], 1e-7 * limit, 1.0)};
    return kinks[0] + kinks[1] + kinks[2];
}

#define PLACES 4000

TEST(tangents)
{
    struct random g = random_of(_i);
    struct contact c = {.law = _i};
    int kinks = 0;
    for (int k = 0; k < PLACES; k++) {
        kinks += check_derivatives(&c, &g);
    }
    ck_assert_int_lt(kinks, PLACES / 100);
}

/* lambda dt = 1: epsilon = 2 N R dt. Odd runs have the reversal memory set; it shows only in the law that has one. */
TEST(tangents_in_a_context)
{
    struct random g = random_of(_i);
    struct contact c = {.law = _i / 2};
    const double fast = 1e6, zero = 0.0, unit = 1.0;
    assert_ok(tribo_create(&c.context, 1));
    assert_ok(tribo_set_law(c.context, c.law));
    assert_ok(tribo_set_operator_diagonal(c.context, &unit));
    assert_ok(tribo_set_epsilon_step(c.context, 1.0, 1.0));
    if (_i % 2) {
        assert_ok(tribo_accept(c.context, &fast, &zero));
    }
    int kinks = 0;
    for (int k = 0; k < PLACES; k++) {
        kinks += check_derivatives(&c, &g);
    }
    ck_assert_int_lt(kinks, PLACES / 100);
    tribo_destroy(c.context);
}

TEST(tangents_at_jumps)
{
    const int laws[] = {TRIBO_COULOMB, TRIBO_KARNOPP};
    for (size_t i = 0; i < COUNT(laws); i++) {
        double f, d = none;
        for (int side = -1; side <= 1; side++) {
            assert_ok(tribo_law_eval(laws[i], side * (laws[i] == TRIBO_KARNOPP ? 0.5 : 0.0), 0.3, 1.0, 0.5, &f, &d, NULL, NULL));
            assert_exact(d, 0.0);
            assert_exact(f, 0.3);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------- the reversal law */

/* At v = 0 the force over the limit is g(r). */
static double g_of(double r)
{
    return force_of(TRIBO_QUINN_REVERSAL, 0.0, r, 1.0, 1.0);
}

TEST(crossing_function)
{
    assert_exact(g_of(1.0), 1.0);
    for (double r = 1.0; r < 100.0; r *= 1.003) {
        assert_close(g_of(r), crossing(r), ULPS(8) * crossing(r) + r * r * (double)LDBL_EPSILON);
    }
    for (double near = 1e-15; near < 0.1; near *= 1.5) {
        const double r = 1.0 + near, d = r - 1.0;
        assert_close(g_of(r), crossing(r), ULPS(4));
        /* continuous at 1: 1 - g = d (ln(2/d) - 1) and higher orders */
        assert_close(g_of(r), 1.0, d * (2.0 + log(2.0 / d)));
    }
}

TEST(crossing_at_the_seam)
{
    double lo = 2.0, hi = 2.0;
    for (int i = 0; i < 50; i++) {
        lo = nextafter(lo, 0.0);
        hi = nextafter(hi, 3.0);
        assert_close(g_of(lo), crossing(lo), ULPS(4));
        assert_close(g_of(hi), crossing(hi), ULPS(4));
    }
    double before, after, f;
    assert_ok(tribo_law_eval(TRIBO_QUINN_REVERSAL, 0.0, lo, 1.0, 1.0, &f, NULL, &before, NULL));
    assert_ok(tribo_law_eval(TRIBO_QUINN_REVERSAL, 0.0, hi, 1.0, 1.0, &f, NULL, &after, NULL));
    assert_close(before, after, 1e-13);
    assert_close(before, 2.0 - 2.0 * log(3.0), 1e-13);
}

TEST(crossing_far_out)
{
    for (double r = 100.0; r < 1e300; r *= 7.0) {
        /* 2/(3r) + 2/(15 r^3) + 2/(35 r^5) */
        assert_close(g_of(r), 2.0 / (3.0 * r) * (1.0 + 1.0 / (5.0 * r * r)), 1e-9 / r * (r < 1e4 ? 1.0 : 1e-6));
    }
}

/* A contact whose memory bit can be seen: at rest with f_eq = 2 N its force is N if the bit is clear, g(2) N if set. */
static int remembers(const tribo_context *c, size_t i)
{
    const double rest[2] = {0.0, 0.0}, twice[2] = {2.0, 2.0};
    double f[2];
    assert_ok(tribo_force(c, rest, twice, f));
    ck_assert(f[i] == 1.0 || fabs(f[i] - crossing(2.0)) < 1e-15);
    return f[i] != 1.0;
}

static tribo_context *reversal_contacts(void)
{
    tribo_context *c;
    assert_ok(tribo_create(&c, 2));
    assert_ok(tribo_set_law(c, TRIBO_QUINN_REVERSAL));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_epsilon_all(c, 0.1));
    return c;
}

TEST(memory)
{
    /* v/epsilon, |f_eq|/N, and what becomes of the bit: 1 set, 0 cleared, -1 kept */
    const struct {
        double v, feq;
        int after;
    } cases[] = {
        {1.01, 0.0, 1},  {-1.01, 0.5, 1}, {50.0, NAN, 1},  {1.0, 1.0, 0},   {-1.0, -1.0, 0}, {0.0, 0.0, 0},
        {0.2, -0.99, 0}, {1.0, 1.01, -1}, {0.0, -3.0, -1}, {-0.5, 1e9, -1}, {0.99, 1.5, -1},
    };
    tribo_context *c = reversal_contacts();
    const double fast[2] = {9.0, 9.0}, rest[2] = {0.0, 0.0};
    ck_assert_int_eq(remembers(c, 0), 0);
    for (size_t k = 0; k < COUNT(cases); k++) {
        for (int before = 0; before < 2; before++) {
            /* the other contact stays as it is */
            const double v[2] = {0.1 * cases[k].v, before ? 9.0 : 0.0}, feq[2] = {cases[k].feq, 0.0};
            size_t marks[2];
            assert_ok(tribo_accept(c, before ? fast : rest, rest));
            assert_ok(tribo_get_count(c, TRIBO_COUNT_REVERSALS, &marks[0]));
            assert_ok(tribo_accept(c, v, feq));
            assert_ok(tribo_get_count(c, TRIBO_COUNT_REVERSALS, &marks[1]));
            const int after = cases[k].after < 0 ? before : cases[k].after;
            ck_assert_msg(remembers(c, 0) == after, "case %zu, bit %d before", k, before);
            ck_assert_int_eq(remembers(c, 1), before);
            ck_assert_uint_eq(marks[1] - marks[0], before != after);
        }
    }
    tribo_destroy(c);
}

TEST(memory_of_other_laws)
{
    const double fast[2] = {9.0, -9.0}, rest[2] = {0.0, 0.0};
    size_t marks = 1;
    tribo_context *c = reversal_contacts();
    assert_ok(tribo_set_law(c, TRIBO_QUINN));
    assert_ok(tribo_accept(c, fast, rest));
    assert_ok(tribo_get_count(c, TRIBO_COUNT_REVERSALS, &marks));
    ck_assert_uint_eq(marks, 0);
    assert_ok(tribo_set_law(c, TRIBO_QUINN_REVERSAL));
    ck_assert_int_eq(remembers(c, 0), 0);
    assert_ok(tribo_accept(c, fast, rest));
    ck_assert_int_eq(remembers(c, 1), 1);
    assert_ok(tribo_set_law(c, TRIBO_QUINN_REVERSAL)); /* choosing a law forgets */
    ck_assert_int_eq(remembers(c, 1), 0);
    tribo_destroy(c);
}

TEST_MAIN("laws", {registry, 1}, {unknown_names, 1}, {values, 6}, {odd_symmetry, 6}, {bounds, 6}, {bounds_in_the_band, 6},
          {tangents, 6}, {tangents_in_a_context, 12}, {tangents_at_jumps, 1}, {crossing_function, 1}, {crossing_at_the_seam, 1},
          {crossing_far_out, 1}, {memory, 1}, {memory_of_other_laws, 1})
