/* SPDX-License-Identifier: BSD-3-Clause */
/* How redundant contacts share. */
#include <string.h>

#include "problem.h"

/* m contacts that are all the same share what is asked of them: equal forces, but nobody more than the limit. */
TEST(identical_contacts_share)
{
    struct random g = random_of(_i);
    const size_t m = 2 + below(&g, 20);
    struct problem p = {.n = m};
    double total = 0.0, f[LARGEST], lo = 0.0, hi = 0.0;
    for (size_t i = 0; i < m; i++) {
        p.epsilon[i] = 1.0;
        p.limit[i] = uniform(&g, 0.1, 2.0);
        total += p.limit[i];
        hi = fmax(hi, p.limit[i]);
        for (size_t j = 0; j < m; j++) {
            p.r[i * m + j] = 1.0;
        }
    }
    const double pull = total * uniform(&g, -0.98, 0.98);
    for (size_t i = 0; i < m; i++) {
        p.a[i] = pull;
    }
    for (int k = 0; k < 100; k++) { /* sum of min(limit, level) = |pull| */
        double sum = 0.0;
        for (size_t i = 0; i < m; i++) {
            sum += fmin(p.limit[i], 0.5 * (lo + hi));
        }
        *(sum < fabs(pull) ? &lo : &hi) = 0.5 * (lo + hi);
    }
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
    assert_ok(tribo_balance(c, p.v, p.a, NULL, f));
    for (size_t i = 0; i < m; i++) {
        assert_close(f[i], -sgn(pull) * fmin(p.limit[i], lo), 1e-13 * total);
    }
    tribo_destroy(c);
}

/* The share does not depend on the order of the contacts, nor on what was solved before. */
TEST(share_without_order)
{
    struct random g = random_of(_i);
    const size_t n = 2 + below(&g, USUAL - 2);
    const struct recipe recipe = {n, 1 + below(&g, n), 0.0, 0.9, 1.0, 0.05, 0.5, 0.0};
    const struct problem p = problem_create(&g, &recipe);
    struct problem q = p;
    size_t to[LARGEST];
    double f[LARGEST], other[LARGEST];
    for (size_t i = 0; i < n; i++) {
        to[i] = i;
    }
    for (size_t i = n; i-- > 1;) {
        const size_t j = below(&g, i + 1), x = to[i];
        to[i] = to[j];
        to[j] = x;
    }
    for (size_t i = 0; i < n; i++) {
        q.limit[to[i]] = p.limit[i];
        q.epsilon[to[i]] = p.epsilon[i];
        q.v[to[i]] = p.v[i];
        q.a[to[i]] = p.a[i];
        for (size_t j = 0; j < n; j++) {
            q.r[to[i] * n + to[j]] = p.r[i * n + j];
        }
    }
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_CONSISTENT),
                  *d = problem_context(&q, TRIBO_QUINN, TRIBO_CONSISTENT);
    assert_ok(tribo_balance(c, p.v, p.a, NULL, f));
    for (int k = 0; k < 2; k++) {
        assert_ok(tribo_balance(d, q.v, q.a, NULL, other));
        for (size_t i = 0; i < n; i++) {
            assert_close(other[to[i]], f[i], 1e-9);
        }
        double disturbed[LARGEST];
        for (size_t i = 0; i < n; i++) {
            disturbed[i] = 3.0 * q.a[i] * uniform(&g, -1.0, 1.0);
        }
        assert_ok(tribo_balance(d, q.v, disturbed, NULL, other));
    }
    tribo_destroy(c);
    tribo_destroy(d);
}

/* Solves the m x m system a x = b by elimination; 0 if it is nearly singular. */
static int eliminate(size_t m, double *a, double *b)
{
    for (size_t k = 0; k < m; k++) {
        size_t best = k;
        for (size_t i = k; i < m; i++) {
            best = fabs(a[i * m + k]) > fabs(a[best * m + k]) ? i : best;
        }
        for (size_t j = 0; j < m; j++) {
            const double x = a[k * m + j];
            a[k * m + j] = a[best * m + j];
            a[best * m + j] = x;
        }
        const double x = b[k];
        b[k] = b[best];
        b[best] = x;
        if (fabs(a[k * m + k]) < 1e-4) {
            return 0;
        }
        for (size_t i = k + 1; i < m; i++) {
            const double factor = a[i * m + k] / a[k * m + k];
            for (size_t j = k; j < m; j++) {
                a[i * m + j] -= factor * a[k * m + j];
            }
            b[i] -= factor * b[k];
        }
    }
    for (size_t k = m; k-- > 0;) {
        for (size_t j = k + 1; j < m; j++) {
            b[k] -= a[k * m + j] * b[j];
        }
        b[k] /= a[k * m + k];
    }
    return 1;
}

/* Many contacts hold few bodies. Of all f with J'f as asked for, the least in norm is f = clamp(J lambda): lambda follows from
 * those inside their limits, and must fit the others. */
TEST(least_norm)
{
    struct random g = random_of(_i);
    const size_t m = 1 + below(&g, 4), n = 3 * m + below(&g, 20);
    struct problem p = {.n = n};
    double j[LARGEST * 4], f[LARGEST], square[16] = {0}, lambda[4] = {0}, pull[4] = {0};
    for (size_t i = 0; i < n; i++) {
        p.epsilon[i] = 1.0;
        p.limit[i] = uniform(&g, 0.2, 2.0);
        const double inside = p.limit[i] * uniform(&g, 0.3, 1.0);
        for (size_t k = 0; k < m; k++) {
            j[i * m + k] = uniform(&g, -1.0, 1.0);
            pull[k] += j[i * m + k] * inside;
        }
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < m; k++) {
            p.a[i] -= j[i * m + k] * pull[k];
        }
        for (size_t l = 0; l <= i; l++) {
            for (size_t k = 0; k < m; k++) {
                p.r[i * n + l] += j[i * m + k] * j[l * m + k];
            }
            p.r[l * n + i] = p.r[i * n + l];
        }
    }
    tribo_context *c = problem_context(&p, TRIBO_COULOMB, TRIBO_CONSISTENT);
    assert_ok(tribo_balance(c, p.v, p.a, NULL, f));
    tribo_destroy(c);
    for (size_t k = 0; k < m; k++) {
        double sum = 0.0;
        for (size_t i = 0; i < n; i++) {
            sum += j[i * m + k] * f[i];
        }
        assert_close(sum, pull[k], 1e-11);
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < m && fabs(f[i]) < 0.999999 * p.limit[i]; k++) {
            lambda[k] += j[i * m + k] * f[i];
            for (size_t l = 0; l < m; l++) {
                square[k * m + l] += j[i * m + k] * j[i * m + l];
            }
        }
    }
    if (eliminate(m, square, lambda)) {
        for (size_t i = 0; i < n; i++) {
            double want = 0.0;
            for (size_t k = 0; k < m; k++) {
                want += j[i * m + k] * lambda[k];
            }
            assert_close(f[i], clamped(want, p.limit[i]), 1e-7);
        }
    }
}

/* With shares that go on from the last ones forces follow a slow pull without jumps, and who has reached the limit stays there; R
 * f is the same as with least shares. */
TEST(shares_that_last)
{
    struct random g = random_of(_i);
    const size_t n = 3 + below(&g, 10);
    struct problem p = {.n = n};
    double f[LARGEST], least[LARGEST], before[LARGEST] = {0}, lever[LARGEST], total = 0.0;
    int at_limit[LARGEST] = {0}, sharing;
    for (size_t i = 0; i < n; i++) {
        lever[i] = uniform(&g, 0.5, 2.0) * (below(&g, 2) ? 1.0 : -1.0);
        p.limit[i] = uniform(&g, 0.5, 2.0);
        p.epsilon[i] = 1.0;
        total += fabs(lever[i]) * p.limit[i];
        for (size_t j = 0; j <= i; j++) {
            p.r[i * n + j] = p.r[j * n + i] = lever[i] * lever[j];
        }
    }
    tribo_context *c = problem_context(&p, TRIBO_COULOMB, TRIBO_CONSISTENT),
                  *d = problem_context(&p, TRIBO_COULOMB, TRIBO_CONSISTENT);
    assert_ok(tribo_set_sharing(c, TRIBO_SHARE_PREVIOUS));
    assert_ok(tribo_get_sharing(c, &sharing));
    ck_assert_int_eq(sharing, TRIBO_SHARE_PREVIOUS);
    const double step = 0.999 * total / 400.0;
    for (int k = 0; k <= 400; k++) {
        double torque = 0.0, same = 0.0;
        for (size_t i = 0; i < n; i++) {
            p.a[i] = lever[i] * k * step;
        }
        assert_ok(tribo_balance(c, p.v, p.a, NULL, f));
        assert_ok(tribo_balance(d, p.v, p.a, NULL, least));
        for (size_t i = 0; i < n; i++) {
            require(fabs(f[i] - before[i]) <= 2.0 * step + 1e-12, "jump of %g at contact %zu", f[i] - before[i], i);
            require(!at_limit[i] || fabs(f[i]) > (1.0 - 1e-12) * p.limit[i], "contact %zu leaves its limit", i);
            at_limit[i] = fabs(f[i]) > (1.0 - 1e-12) * p.limit[i];
            before[i] = f[i];
            torque += lever[i] * f[i];
            same += lever[i] * least[i];
        }
        assert_close(torque, -k * step, 1e-12 * total);
        assert_close(same, -k * step, 1e-12 * total);
    }
    tribo_destroy(c);
    tribo_destroy(d);
}

/* Forces go on from those of sliding, for which nothing was solved. */
TEST(shares_after_sliding)
{
    const double r[] = {1.0, 1.0, 1.0, 1.0}, rest[] = {0.0, 0.0}, slides[] = {3.0, -3.0}, pull[] = {-0.6, -0.6},
                 none[] = {0.0, 0.0};
    double f[2];
    tribo_context *c;
    assert_ok(tribo_create(&c, 2));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_epsilon_all(c, 1.0));
    assert_ok(tribo_set_sharing(c, TRIBO_SHARE_PREVIOUS));
    assert_ok(tribo_balance(c, rest, pull, NULL, f));
    assert_ok(tribo_balance(c, slides, none, NULL, f));
    assert_ok(tribo_balance(c, rest, none, NULL, f));
    assert_close(f[0], -1.0, 1e-15);
    assert_close(f[1], 1.0, 1e-15);
    tribo_destroy(c);
}

/* Fourteen contacts between nine bodies, two pairs of which are twins. Of the pair 4 and 11 both are at their limits, where they
 * cannot share but as they do; the pair 0 and 7 shares in halves. */
TEST(twins_share_beside_twins_at_limits)
{
    static const size_t body[14][2] = {{0, 7}, {4, 1}, {1, 7}, {3, 7}, {8, 5}, {8, 6}, {8, 7},
                                       {0, 7}, {8, 2}, {5, 0}, {2, 6}, {8, 5}, {3, 7}, {1, 6}};
    static const double inverse[9] = {0.5, 3.0, 1.0, 2.0, 1.0, 0.5, 3.0, 2.0, 1.0};
    static const double limit[14] = {2.0, 2.0, 2.0, 0.0, 2.0, 1.0, 2.0, 2.0, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0};
    size_t rowptr[15] = {0};
    double sign[28], vfree[14], f[14];
    tribo_context *c;
    for (size_t i = 0; i < 14; i++) {
        rowptr[i + 1] = 2 * (i + 1);
        sign[2 * i] = 1.0;
        sign[2 * i + 1] = -1.0;
        vfree[i] = -2.0;
    }
    assert_ok(tribo_create(&c, 14));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_operator_mass(c, 9, inverse, rowptr, &body[0][0], sign));
    assert_ok(tribo_step_force(c, 1.0, vfree, f));
    assert_close(f[0], f[7], 1e-13);
    assert_close(f[4], 2.0, 1e-13);
    assert_close(f[11], 1.0, 1e-13);
    tribo_destroy(c);
}

/* Four contacts between two bodies, each of which may carry one way only, share nothing where nothing pulls, whatever they
 * carried before. */
TEST(nothing_is_shared_of_nothing)
{
    static const double sign[4] = {1.0, -1.0, -1.0, 1.0}, none[4] = {0.0, 0.0, 0.0, 0.0}, vfree[4] = {1.0, 2.0, -1.0, 0.5},
                        lower[4] = {-2.0, 0.0, -2.0, 0.0}, upper[4] = {0.0, 2.0, 0.0, 2.0};
    tribo_context *c = problem_of_one_body(4, sign, 3.28380076);
    double f[4];
    assert_ok(tribo_set_limit_all(c, 2.0));
    assert_ok(tribo_step_force(c, 1.0, vfree, f));
    assert_ok(tribo_solve_box(c, none, lower, upper, f));
    assert_all_close(f, none, 4, 1e-15);
    tribo_destroy(c);
}

/* Contacts of one body, one of which is pulled to its limit; what rounding leaves of the others' accelerations does not pit them
 * against each other, in the first call nor in a later one. */
TEST(rounding_takes_no_part)
{
    const double sign[] = {1.0, -1.0, 1.0, -2.0, 1.0, 1.0}, vfree[] = {0.0, 0.0, 0.0, 0.0, -2.0, -1.6e-13},
                 want[] = {-0.125, 0.125, -0.125, 0.25, 1.0, -0.125};
    tribo_context *c = problem_of_one_body(6, sign, 1.0);
    double f[6];
    assert_ok(tribo_set_limit_all(c, 1.0));
    for (int k = 0; k < 2; k++) {
        assert_ok(tribo_step_force(c, 1.0, vfree, f));
        assert_all_close(f, want, 6, 1e-12);
    }
    tribo_destroy(c);
}

/* Contacts 0, 1, 2 hold bodies 0 and 1 against each other, beside bodies without velocity: forces of 3 and 4 are 0, which no
 * solver finds to their own rounding. */
TEST(rest_beside_contacts_that_press)
{
    static const double inverse[] = {130.0, 0.0105, 108.0, 112.0, 0.879},
                        arm[] = {1.0, -1.0, 1.0, 1.0, 0.25, 1.0, 1.0, -0.875, 1.0}, limit[] = {0.05, 0.002, 301.0, 1.3, 7.2},
                        slips[] = {0.00127, 0.000127, -0.00054};
    static const size_t first[] = {0, 1, 2, 4, 7, 9}, body[] = {1, 0, 0, 1, 2, 3, 1, 3, 4};
    for (int run = 0; run < 200; run++) {
        const double vfree[5] = {0.0, slips[run % 3], -0.7 - 0.01 * run, 0.0, 0.0};
        tribo_context *c;
        double f[5];
        assert_ok(tribo_create(&c, 5));
        assert_ok(tribo_set_operator_mass(c, 5, inverse, first, body, arm));
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_step_force(c, 0.5, vfree, f));
        assert_close(fabs(f[1]), limit[1], 1e-15);
        assert_close(130.0 * (f[2] - f[1]) + vfree[2] / 0.5, 0.0, 1e-12);
        assert_close(f[0] + f[2], 0.0, 1e-14);
        assert_all_close(f + 3, ((double[]){0.0, 0.0}), 2, 1e-15);
        tribo_destroy(c);
    }
}

TEST_MAIN("sharing", {rounding_takes_no_part, 1}, {identical_contacts_share, 100}, {twins_share_beside_twins_at_limits, 1},
          {share_without_order, 200}, {least_norm, 200}, {shares_that_last, 40}, {shares_after_sliding, 1},
          {nothing_is_shared_of_nothing, 1}, {rest_beside_contacts_that_press, 1})
