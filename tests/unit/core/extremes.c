/* SPDX-License-Identifier: BSD-3-Clause */
/* Masses and limits that are far apart, or near the largest numbers. */
#include <string.h>

#include "problem.h"

/* A row of bodies with masses from 1e-6 to 1e6 and limits from 1e-300 to 1e300, in one scene. */
TEST(extreme_limits_and_masses)
{
    struct random g = random_of(_i);
    const size_t n = 2 + below(&g, 20);
    struct problem p = {.n = n};
    double f[LARGEST], feq[LARGEST], inverse[LARGEST + 1];
    for (size_t i = 0; i <= n; i++) {
        inverse[i] = log_uniform(&g, 6.0);
    }
    for (size_t i = 0; i < n; i++) {
        p.r[i * n + i] = inverse[i] + inverse[i + 1];
        if (i > 0) {
            p.r[i * n + i - 1] = p.r[(i - 1) * n + i] = -inverse[i];
        }
        p.limit[i] = log_uniform(&g, i % 2 ? 300.0 : 3.0);
        p.epsilon[i] = 1.0;
        p.v[i] = below(&g, 2) ? 0.0 : uniform(&g, -0.5, 0.5);
        p.a[i] = uniform(&g, -2.0, 2.0) * fmin(p.limit[i], 1e290);
    }
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
    assert_ok(tribo_balance(c, p.v, p.a, feq, f));
    for (size_t i = 0; i < n; i++) {
        require(fabs(f[i]) <= p.limit[i], "|f| = %g is over the limit %g", fabs(f[i]), p.limit[i]);
        assert_close(f[i], law_force(TRIBO_QUINN, p.v[i], balancing(&p, i, f), p.limit[i], p.epsilon[i]),
                     1e-12 * p.limit[i] + 4.0 * balancing_noise(&p, i, f));
    }
    tribo_destroy(c);
}

/* A limit that no force comes near, as for contacts that are never to slide, changes nothing, however large it is; nor does it
 * matter that the contacts slid before it was set. */
TEST(limits_that_are_never_reached)
{
    const double far[] = {1e6, 1e12, 1e30, 1e31, 1e100, 1e299, 1e300, DBL_MAX};
    struct random g = random_of(_i);
    const struct recipe recipe = recipe_regular(&g, 12);
    struct problem p = problem_create(&g, &recipe);
    double slides[LARGEST], want[LARGEST], feq[LARGEST], f[LARGEST];
    for (size_t i = 0; i < p.n; i++) {
        p.v[i] = 0.0;
        slides[i] = 9.0 * p.a[i];
        p.limit[i] = 1.0;
    }
    for (size_t k = 0; k < COUNT(far); k++) {
        tribo_context *c = problem_context(&p, TRIBO_QUINN, _i % 2);
        assert_ok(tribo_step_force(c, 1e-3, slides, f));
        assert_ok(tribo_balance(c, p.v, slides, NULL, f));
        assert_ok(tribo_set_limit_all(c, far[k]));
        for (int call = 0; call < 3; call++) {
            assert_ok(call == 1 ? tribo_step_force(c, 1.0, p.a, f) : tribo_balance(c, p.v, p.a, feq, f));
            for (size_t i = 0; i < p.n; i++) {
                assert_close((double)acceleration(&p, i, f), 0.0, 8.0 * p.r[i * p.n + i] * balancing_noise(&p, i, f));
            }
            assert_all_close(f, k + (size_t)call > 0 ? want : f, p.n, 1e-9);
            memcpy(want, f, sizeof want);
        }
        tribo_destroy(c);
    }
}

/* Nor does it hide that nothing balances what redundant contacts are asked for. */
TEST(far_limits_of_redundant_contacts)
{
    const double far[] = {1.0, 1e6, 1e12, 1e30, 1e300, DBL_MAX}, r[] = {2.0, 2.0, 2.0, 2.0}, rest[] = {0.0, 0.0};
    const double together[] = {0.5, 0.5}, apart[] = {0.5, 0.6};
    tribo_context *c;
    assert_ok(tribo_create(&c, 2));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_set_coupling(c, TRIBO_PARTITION));
    for (size_t k = 0; k < COUNT(far); k++) {
        double f[2];
        assert_ok(tribo_set_limit_all(c, far[k]));
        assert_ok(tribo_balance(c, rest, together, NULL, f));
        assert_close(f[0], -0.125, 1e-15);
        assert_close(f[1], -0.125, 1e-15);
        assert_status(tribo_balance(c, rest, apart, NULL, f), TRIBO_ERR_INCONSISTENT);
    }
    tribo_destroy(c);
}

/* R = V diag(1 ... 1e-14) V' with V a reflection. The residual is still rounding. */
TEST(ill_conditioned)
{
    struct random g = random_of(_i);
    const size_t n = 3 + below(&g, 40);
    struct problem p = {.n = n};
    double u[LARGEST], square = 0.0, f[LARGEST];
    for (size_t i = 0; i < n; i++) {
        u[i] = uniform(&g, -1.0, 1.0);
        square += u[i] * u[i];
        p.limit[i] = p.epsilon[i] = 1.0;
        p.v[i] = below(&g, 3) ? 0.0 : uniform(&g, -0.1, 0.1);
    }
    for (size_t i = 0; i < n; i++) {
        p.a[i] = uniform(&g, -0.5, 0.5);
        for (size_t j = 0; j <= i; j++) {
            long double sum = 0.0L;
            for (size_t k = 0; k < n; k++) {
                const long double vi = (i == k) - 2.0L * u[i] * u[k] / square, vj = (j == k) - 2.0L * u[j] * u[k] / square;
                sum += vi * vj * powl(10.0L, -14.0L * k / (n - 1));
            }
            p.r[i * n + j] = p.r[j * n + i] = (double)sum;
        }
    }
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
    for (int k = 0; k < 5; k++) {
        assert_ok(tribo_balance(c, p.v, p.a, NULL, f));
        for (size_t i = 0; i < n; i++) {
            assert_close(f[i], law_force(TRIBO_QUINN, p.v[i], balancing(&p, i, f), 1.0, 1.0), 1e-12 + balancing_noise(&p, i, f));
            p.a[i] += uniform(&g, -0.1, 0.1);
        }
        require(real_of(c, TRIBO_REAL_RESIDUAL) < 1e-11, "residual %g", real_of(c, TRIBO_REAL_RESIDUAL));
    }
    tribo_destroy(c);
}

/* Balancing forces beyond all numbers have the right sign; so short a step that 1/dt is no number leaves a contact at rest alone.
 */
TEST(beyond_all_numbers)
{
    const double r[] = {2e-300, 1e-300, 0.0, 1e-300, 2e-300, 1e-300, 0.0, 1e-300, 2e-300}, a[] = {-1e10, -1e10, -0.8e10},
                 rest[3] = {0};
    double f[3];
    tribo_context *c;
    assert_ok(tribo_create(&c, 3));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_coupling(c, _i));
    assert_ok(tribo_balance(c, rest, a, NULL, f));
    for (size_t i = 0; i < 3; i++) {
        assert_exact(f[i], 1.0);
    }
    assert_ok(tribo_step_force(c, 1e-310, rest, f));
    for (size_t i = 0; i < 3; i++) {
        assert_exact(f[i], 0.0);
    }
    tribo_destroy(c);
}

/* What is left of forces that were larger than all others is not taken for a solution. */
TEST(after_huge_forces)
{
    const double r[] = {2.0, 1.0, 1.0, 2.0}, limit[] = {1e300, 1.0}, huge[] = {-1e300, 0.0}, pull[] = {-3.0, -1.0};
    double f[2];
    tribo_context *c;
    assert_ok(tribo_create(&c, 2));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_step_force(c, 1.0, huge, f));
    assert_close(f[0], 5e299, 1e285);
    assert_ok(tribo_step_force(c, 1.0, pull, f));
    assert_close(f[0], 5.0 / 3.0, 1e-15);
    assert_close(f[1], -1.0 / 3.0, 1e-15);
    tribo_destroy(c);
}

/* The same where bounds are far, and contacts that repeat each other have others. */
TEST(after_huge_forces_of_redundant_contacts)
{
    const double sign[] = {1.0, -1.0, -1.0}, huge[] = {1e300, -1e300, -1e300}, pull[] = {-0.5, 0.5, 0.5},
                 lower[] = {-1e9, 0.0, -1.5}, upper[] = {3e9, 1e300, 1.5}, want[] = {0.25, 0.0, -0.25};
    tribo_context *c = problem_of_one_body(3, sign, 1.0);
    double f[3];
    assert_ok(tribo_solve_box(c, huge, lower, upper, f));
    assert_ok(tribo_solve_box(c, pull, lower, upper, f));
    assert_all_close(f, want, 3, 1e-14);
    tribo_destroy(c);
}

/* Contacts of one body are driven apart, and two of them have no limit to speak of: one of these finds the others' limits, and
 * only its own are out of reach. */
TEST(one_unlimited_contact_holds)
{
    const double sign[] = {1.0, -1.0, 1.0, 1.0, -1.0}, a[] = {0.55, 2.0, 2.8, -0.07, -0.25},
                 lower[] = {-1.0, 0.0, -1.0, -1e300, -1.0}, upper[] = {3.0, 1e300, 1.0, 1e300, 3.0},
                 want[] = {-1.0, 0.0, -1.0, 5.07, 3.0};
    tribo_context *c = problem_of_one_body(5, sign, 1.0);
    double f[5];
    assert_ok(tribo_solve_box(c, a, lower, upper, f));
    assert_all_close(f, want, 5, 1e-13);
    tribo_destroy(c);
}

TEST_MAIN("extremes", {after_huge_forces, 1}, {after_huge_forces_of_redundant_contacts, 1}, {one_unlimited_contact_holds, 1},
          {extreme_limits_and_masses, 200}, {limits_that_are_never_reached, 20}, {far_limits_of_redundant_contacts, 1},
          {ill_conditioned, 60}, {beyond_all_numbers, 2})
