/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces of coupled contacts: the consistent balance, the paper's partition, and the step force, against their equations. */
#include <string.h>

#include "problem.h"

/* Forces found, with what comes along. */
struct answer {
    double feq[LARGEST], f[LARGEST];
};

static struct answer balance(const struct problem *p, int law, int coupling)
{
    struct answer x;
    tribo_context *c = problem_context(p, law, coupling);
    assert_ok(tribo_balance(c, p->v, p->a, x.feq, x.f));
    tribo_destroy(c);
    return x;
}

static const int laws_with_feq[] = {TRIBO_COULOMB, TRIBO_KARNOPP, TRIBO_QUINN};

/* -------------------------------------------------------------------------------------------------------- consistent */

/* f_i is the law's force for the f_eq that the others' forces leave, to 1e-12 of the limit (and to the rounding of the sum, where
 * neighbours are so much stronger that it is more); and f_eq is reported as just that. */
static void check_fixed_point(const struct problem *p, int law, const struct answer *x)
{
    for (size_t i = 0; i < p->n; i++) {
        const double limit = p->limit[i], noise = balancing_noise(p, i, x->f), feq = balancing(p, i, x->f);
        require(fabs(x->f[i]) <= limit, "|f| is %g over the limit at contact %zu", fabs(x->f[i]) - limit, i);
        assert_exact(x->f[i], law_force(law, p->v[i], x->feq[i], limit, p->epsilon[i]));
        if (limit > 0.0) {
            assert_close(x->f[i], law_force(law, p->v[i], feq, limit, p->epsilon[i]), 1e-12 * limit + noise);
            assert_close(x->feq[i], feq, 1e-12 * (limit + fabs(feq)) + 8.0 * noise);
        } else {
            assert_exact(x->feq[i], 0.0);
        }
    }
}

TEST(consistent_fixed_point)
{
    struct random g = random_of(_i);
    for (int k = 0; k < 6; k++) {
        const struct recipe recipe = recipe_random(&g, USUAL, k < 3 ? 0.0 : 1.5);
        const struct problem p = problem_create(&g, &recipe);
        const struct answer x = balance(&p, laws_with_feq[k % 3], TRIBO_CONSISTENT);
        check_fixed_point(&p, laws_with_feq[k % 3], &x);
    }
}

/* Masses, lever arms and limits from the planetary to the atomic, in one problem. */
TEST(consistent_extreme_scales)
{
    const double decades[] = {5.0, 20.0, 60.0};
    struct random g = random_of(_i);
    for (size_t k = 0; k < COUNT(decades); k++) {
        const struct recipe recipe = recipe_random(&g, USUAL, decades[k]);
        const struct problem p = problem_create(&g, &recipe);
        const struct answer x = balance(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
        check_fixed_point(&p, TRIBO_QUINN, &x);
    }
}

/* The context's last forces are where the next search begins, and must not show in what it finds. */
TEST(consistent_after_other_problems)
{
    struct random g = random_of(_i);
    const struct recipe recipe = recipe_regular(&g, USUAL);
    struct problem p = problem_create(&g, &recipe);
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
    for (int k = 0; k < 20; k++) {
        struct answer x;
        for (size_t i = 0; i < p.n; i++) {
            p.v[i] = k % 2 ? 0.8 * p.v[i] : p.epsilon[i] * uniform(&g, -0.7, 0.7);
            p.a[i] += uniform(&g, -1.0, 1.0);
        }
        assert_ok(tribo_balance(c, p.v, p.a, x.feq, x.f));
        check_fixed_point(&p, TRIBO_QUINN, &x);
        require(real_of(c, TRIBO_REAL_RESIDUAL) < 1e-12, "residual %g", real_of(c, TRIBO_REAL_RESIDUAL));
    }
    tribo_destroy(c);
}

/* Nor must it if those were so large that their rounding hides the forces of now. Contacts hardly coupled keep their place in the
 * stick set, and so start from there. */
TEST(consistent_after_large_forces)
{
    const double strong[2] = {3e10, -1e10}, limits[2] = {1e11, 1e11};
    const struct problem p = {
        .n = 2, .r = {1.0, 1e-12, 1e-12, 1.0}, .limit = {1.0, 1.0}, .epsilon = {1.0, 1.0}, .a = {0.3, -0.7}};
    struct answer x;
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
    assert_ok(tribo_set_limit(c, limits));
    assert_ok(tribo_balance(c, p.v, strong, x.feq, x.f));
    assert_close(x.f[0], -3e10, 1.0);
    assert_ok(tribo_set_limit(c, p.limit));
    assert_ok(tribo_balance(c, p.v, p.a, x.feq, x.f));
    check_fixed_point(&p, TRIBO_QUINN, &x);
    assert_ok(tribo_set_limit(c, limits));
    assert_ok(tribo_step_force(c, 1.0, strong, x.f));
    assert_ok(tribo_set_limit(c, p.limit));
    assert_ok(tribo_step_force(c, 1.0, p.a, x.f));
    assert_close(x.f[0], -0.3, 2e-12);
    assert_close(x.f[1], 0.7, 2e-12);
    tribo_destroy(c);
}

/* f_eq balances Quinn's forces; the law itself then has its xi from it, where the memory is set. */
TEST(consistent_reversal)
{
    struct random g = random_of(_i);
    const struct recipe recipe = recipe_random(&g, USUAL, 0.5);
    const struct problem p = problem_create(&g, &recipe);
    double moved[LARGEST];
    struct answer x, quinn = balance(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
    tribo_context *c = problem_context(&p, TRIBO_QUINN_REVERSAL, TRIBO_CONSISTENT);
    for (size_t i = 0; i < p.n; i++) {
        moved[i] = i % 2 ? 3.0 * p.epsilon[i] : 0.0;
    }
    assert_ok(tribo_accept(c, moved, quinn.feq));
    assert_ok(tribo_balance(c, p.v, p.a, x.feq, x.f));
    for (size_t i = 0; i < p.n; i++) {
        const int law = i % 2 ? TRIBO_QUINN_REVERSAL : TRIBO_QUINN;
        assert_exact(x.f[i], law_force(law, p.v[i], x.feq[i], p.limit[i], p.epsilon[i]));
        if (fabs(p.v[i]) <= p.epsilon[i]) {
            assert_exact(x.feq[i], quinn.feq[i]);
        }
    }
    tribo_destroy(c);
}

/* f_eq of contacts that nothing was solved for is reported all the same. */
TEST(laws_without_feq)
{
    struct random g = random_of(_i);
    const struct recipe recipe = recipe_random(&g, USUAL, 0.5);
    const struct problem p = problem_create(&g, &recipe);
    const int law = _i % 2 ? TRIBO_SMOOTH : TRIBO_VELOCITY_LIMITED;
    const struct answer x = balance(&p, law, _i % 4 / 2);
    check_fixed_point(&p, law, &x);
}

/* At rest the balance is Coulomb's law: who moves off next is not held back by more than the limit, the others stay. */
TEST(coulomb_at_rest)
{
    struct random g = random_of(_i);
    struct recipe recipe = recipe_random(&g, USUAL, 0.0);
    recipe.resting = 1.0;
    const struct problem p = problem_create(&g, &recipe);
    const struct answer coulomb = balance(&p, TRIBO_COULOMB, TRIBO_CONSISTENT);
    const struct answer karnopp = balance(&p, TRIBO_KARNOPP, TRIBO_CONSISTENT);
    const struct answer quinn = balance(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
    assert_all_exact(karnopp.f, coulomb.f, p.n);
    assert_all_exact(quinn.f, coulomb.f, p.n);
    for (size_t i = 0; i < p.n; i++) {
        const double accelerates = (double)acceleration(&p, i, coulomb.f), r = p.r[i * p.n + i];
        if (fabs(accelerates) > r * (1e-12 * p.limit[i] + balancing_noise(&p, i, coulomb.f))) {
            assert_exact(coulomb.f[i], -p.limit[i] * sgn(accelerates));
        }
    }
}

/* --------------------------------------------------------------------------------------------------------- partition */

static int in_band(const struct problem *p, size_t i)
{
    return fabs(p->v[i]) <= p->epsilon[i] && p->limit[i] > 0.0;
}

/* Forces with which the paper's equations balance: f_eq of S, -N sgn v of the rest. */
static struct answer balancing_forces(const struct problem *p, const struct answer *x)
{
    struct answer b = *x;
    for (size_t i = 0; i < p->n; i++) {
        b.f[i] = in_band(p, i) ? x->feq[i] : -p->limit[i] * sgn(p->v[i]);
    }
    return b;
}

/* Equations 8 to 10, in the sense that a solver of linear equations can meet them: to the rounding of their terms. */
static void check_partition(const struct problem *p, const struct answer *x)
{
    const struct answer b = balancing_forces(p, x);
    for (size_t i = 0; i < p->n; i++) {
        assert_exact(x->f[i], law_force(TRIBO_QUINN, p->v[i], x->feq[i], p->limit[i], p->epsilon[i]));
        if (in_band(p, i)) {
            assert_close((double)acceleration(p, i, b.f), 0.0, 4.0 * p->r[i * p->n + i] * balancing_noise(p, i, b.f));
        } else if (p->limit[i] > 0.0) {
            assert_close(x->feq[i], balancing(p, i, x->f), 2.0 * balancing_noise(p, i, x->f));
        }
    }
}

TEST(partition_equations)
{
    struct random g = random_of(_i);
    for (int k = 0; k < 4; k++) {
        struct recipe recipe = recipe_regular(&g, USUAL);
        recipe.decades = k < 2 ? 0.0 : 2.0;
        recipe.open = 0.1;
        const struct problem p = problem_create(&g, &recipe);
        const struct answer x = balance(&p, TRIBO_QUINN, TRIBO_PARTITION);
        check_partition(&p, &x);
    }
}

TEST(partition_is_consistent_unsaturated)
{
    struct random g = random_of(_i);
    struct recipe recipe = recipe_regular(&g, 12);
    recipe.resting = 1.0;
    struct problem p = problem_create(&g, &recipe);
    for (size_t i = 0; i < p.n; i++) {
        p.limit[i] = 1e3 * (1.0 + fabs(p.a[i])); /* strong enough for everyone: lambda_min of R is not that small */
    }
    const struct answer partition = balance(&p, TRIBO_QUINN, TRIBO_PARTITION);
    const struct answer consistent = balance(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
    for (size_t i = 0; i < p.n; i++) {
        require(fabs(consistent.f[i]) < p.limit[i], "contact %zu is saturated: this tests nothing", i);
        assert_close(partition.f[i], consistent.f[i], 1e-12 * p.limit[i]);
        assert_close((double)acceleration(&p, i, partition.f), 0.0, 1e-12 * p.limit[i]);
    }
}

TEST(partition_redundant_in_range)
{
    struct problem p = twins;
    const double a[] = {3.0, 3.0, 1.25}, feq[] = {-0.875, -0.875, 0.5}; /* the smallest f_eq: the twins share */
    p.a[0] = a[0], p.a[1] = a[1], p.a[2] = a[2];
    const struct answer x = balance(&p, TRIBO_QUINN, TRIBO_PARTITION);
    assert_all_close(x.feq, feq, 3, 8.0 * DBL_EPSILON);
    assert_all_close(x.f, feq, 3, 8.0 * DBL_EPSILON);
}

/* The twins cannot have different accelerations: least squares meets the mean. The outputs hold it, and the message says so. */
TEST(partition_redundant_outside)
{
    struct problem p = twins;
    const double a[] = {2.5, 3.5, 1.25}, feq[] = {-0.875, -0.875, 0.5}, limit[] = {5.0, 5.0, 5.0};
    p.a[0] = a[0], p.a[1] = a[1], p.a[2] = a[2];
    struct answer x;
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_PARTITION);
    assert_status(tribo_balance(c, p.v, p.a, x.feq, x.f), TRIBO_ERR_INCONSISTENT);
    assert_says(tribo_message(c), "3 contacts");
    assert_says(tribo_message(c), "contact 0");
    assert_says(tribo_message(c), "rank 2");
    assert_all_close(x.feq, feq, 3, 8.0 * DBL_EPSILON);
    assert_all_close(x.f, feq, 3, 8.0 * DBL_EPSILON);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_RANK), 2);
    memset(x.feq, 0, sizeof x.feq);
    assert_status(tribo_balance_tangent(c, p.v, p.a, x.feq, NULL, NULL, NULL), TRIBO_ERR_INCONSISTENT);
    assert_all_close(x.feq, feq, 3, 8.0 * DBL_EPSILON);
    assert_ok(tribo_set_coupling(c, TRIBO_CONSISTENT));
    assert_ok(tribo_balance(c, p.v, p.a, x.feq, x.f));
    check_fixed_point(&p, TRIBO_QUINN, &x);
    assert_ok(tribo_get_limit(c, x.f));
    assert_all_exact(x.f, limit, 3);
    tribo_destroy(c);
}

/* Random redundancy. With a in the range of R, to the rounding of its terms, f_eq balances it; with any a, what is left of R f_eq
 * + a is orthogonal to the range. */
static void check_redundant(struct random *g, int in_range)
{
    const size_t n = 2 + below(g, 20);
    const struct recipe recipe = {n, 1 + below(g, n), 0.0, 1.0, 1.0, 0.0, 1.0, 0.0};
    struct problem p = problem_create(g, &recipe), normal;
    for (size_t i = 0; in_range && i < n; i++) {
        p.a[i] = p.r[i * n] - p.r[i * n + n - 1];
    }
    struct answer x;
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_PARTITION);
    const int status = tribo_balance(c, p.v, p.a, x.feq, x.f);
    assert_status(status, in_range || count_of(c, TRIBO_COUNT_RANK) == n ? TRIBO_OK : TRIBO_ERR_INCONSISTENT);
    tribo_destroy(c);
    double rest[LARGEST], size = 0.0;
    normal = p;
    for (size_t i = 0; i < n; i++) {
        rest[i] = (double)acceleration(&p, i, x.feq);
        normal.a[i] = 0.0;
        size = fmax(size, p.r[i * n + i] * (fabs(x.feq[i]) + 1.0));
    }
    for (size_t i = 0; i < n; i++) {
        assert_close((double)acceleration(&normal, i, rest), 0.0, 1e-12 * size);
        assert_close(rest[i], 0.0, status ? HUGE_VAL : 1e-13 * size);
    }
}

/* Four contacts on two bodies, pulled as if contact 0 alone resisted, so that contact 1 is not pulled at all. */
TEST(partition_in_range_with_a_zero)
{
    const double j[4][2] = {{1.0, 1.0}, {1.0, -1.0}, {0.3, 0.7}, {0.6, 0.2}};
    struct problem p = {.n = 4, .limit = {9.0, 9.0, 9.0, 9.0}, .epsilon = {1.0, 1.0, 1.0, 1.0}};
    for (size_t i = 0; i < 4; i++) {
        for (size_t k = 0; k < 4; k++) {
            p.r[4 * i + k] = j[i][0] * j[k][0] + j[i][1] * j[k][1];
        }
        p.a[i] = p.r[4 * i];
    }
    const struct answer x = balance(&p, TRIBO_QUINN, TRIBO_PARTITION);
    for (size_t i = 0; i < 4; i++) {
        assert_close((double)acceleration(&p, i, x.f), 0.0, 1e-14);
    }
}

TEST(partition_random_in_range)
{
    struct random g = random_of(_i);
    check_redundant(&g, 1);
}

TEST(partition_least_squares)
{
    struct random g = random_of(_i);
    check_redundant(&g, 0);
}

/* -------------------------------------------------------------------------------------------------------- step force */

/* v_end = vfree + dt R f is 0, or f opposes it in full. vfree is a dt. */
TEST(step_force)
{
    struct random g = random_of(_i);
    for (int k = 0; k < 4; k++) {
        const struct recipe recipe = recipe_random(&g, USUAL, k < 2 ? 0.0 : 1.5);
        const struct problem p = problem_create(&g, &recipe);
        tribo_context *c = problem_context(&p, TRIBO_QUINN, k % 2);
        const double dt = log_uniform(&g, 3);
        double f[LARGEST], vfree[LARGEST];
        for (size_t i = 0; i < p.n; i++) {
            vfree[i] = p.a[i] * dt;
        }
        assert_ok(tribo_step_force(c, dt, vfree, f));
        for (size_t i = 0; i < p.n; i++) {
            const double unit = p.r[i * p.n + i], end = (double)acceleration(&p, i, f);
            require(fabs(f[i]) <= p.limit[i], "|f| is over the limit at contact %zu", i);
            if (fabs(end) > unit * (1e-12 * p.limit[i] + balancing_noise(&p, i, f))) {
                assert_exact(f[i], -p.limit[i] * sgn(end));
            }
        }
        tribo_destroy(c);
    }
}

TEST(step_force_uncoupled)
{
    const double r[] = {2.0, 0.5, 4.0, 1.0}, limit[] = {1.0, 3.0, 0.5, 0.0}, vfree[] = {0.1, -9.0, 0.5, 1.0};
    const double want[] = {-0.5, 3.0, -0.5, 0.0}; /* clamp(-vfree/(dt R_ii)) with dt = 0.1 */
    double f[4];
    tribo_context *c;
    assert_ok(tribo_create(&c, 4));
    assert_ok(tribo_set_operator_diagonal(c, r));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_step_force(c, 0.1, vfree, f));
    assert_all_close(f, want, 4, DBL_EPSILON);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_SOLVES), 0);
    tribo_destroy(c);
}

/* ------------------------------------------------------------------------------------------------------ special operators */

/* Uncoupled contacts follow from their own equation, in every law and coupling, and no solver sees them. */
TEST(diagonal_never_solves)
{
    struct random g = random_of(_i);
    const int law = _i % tribo_law_count(), coupling = _i % 2;
    const size_t n = 25;
    const struct recipe recipe = {n, n, 1.0, 2.0, 3.0, 0.1, 0.3, 0.0};
    struct problem p = problem_create(&g, &recipe);
    for (size_t k = 0; k < n * n; k++) {
        p.r[k] = k % (n + 1) ? 0.0 : p.r[k];
    }
    struct answer x;
    tribo_context *c = problem_context(&p, law, coupling);
    for (int k = 0; k < 3; k++) {
        assert_ok(tribo_balance(c, p.v, p.a, x.feq, x.f));
        assert_ok(tribo_balance_tangent(c, p.v, p.a, NULL, x.f, NULL, NULL));
        assert_ok(tribo_step_force(c, 0.01, p.v, x.f));
    }
    assert_ok(tribo_balance(c, p.v, p.a, x.feq, x.f));
    check_fixed_point(&p, law == TRIBO_QUINN_REVERSAL ? TRIBO_QUINN : law, &x);
    const int counts[] = {TRIBO_COUNT_SOLVES, TRIBO_COUNT_FACTORIZATIONS, TRIBO_COUNT_UPDATES, TRIBO_COUNT_RANK};
    for (size_t k = 0; k < COUNT(counts); k++) {
        ck_assert_uint_eq(count_of(c, counts[k]), 0);
    }
    tribo_destroy(c);
}

/* A contact that friction cannot move, R_ii = 0: the limit R_ii -> +0. Contact 1 of three, alone or beside coupled ones. */
TEST(immovable_contacts)
{
    const double alone[] = {1.0, 0, 0, 0, 0, 0, 0, 0, 1.0}, beside[] = {2.0, 0, 1.0, 0, 0, 0, 1.0, 0, 2.0};
    const double limit[] = {1.0, 0.7, 1.0}, v[] = {0.0, 0.0, 0.0};
    for (int k = 0; k < 12; k++) {
        const double pull = k % 3 - 1.0, a[] = {0.5, pull * 0.01, 0.25};
        double feq[3], f[3];
        tribo_context *c;
        assert_ok(tribo_create(&c, 3));
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_set_operator_dense(c, k < 6 ? alone : beside));
        assert_ok(tribo_set_coupling(c, k / 3 % 2));
        assert_ok(tribo_balance(c, v, a, feq, f));
        assert_exact(f[1], -0.7 * pull);
        require(pull == 0.0 ? feq[1] == 0.0 : isfinite(feq[1]) && feq[1] * pull < -1e100, "feq = %g", feq[1]);
        assert_close(f[0], k < 6 ? -0.5 : -0.25, DBL_EPSILON);
        assert_ok(tribo_step_force(c, 0.1, a, f));
        assert_exact(f[1], -0.7 * pull);
        tribo_destroy(c);
    }
}

TEST_MAIN("balance", {consistent_fixed_point, 300}, {consistent_extreme_scales, 60}, {consistent_after_other_problems, 60},
          {consistent_after_large_forces, 1}, {consistent_reversal, 100}, {laws_without_feq, 40}, {coulomb_at_rest, 200},
          {partition_equations, 100}, {partition_is_consistent_unsaturated, 40}, {partition_redundant_in_range, 1},
          {partition_redundant_outside, 1}, {partition_in_range_with_a_zero, 1}, {partition_random_in_range, 100},
          {partition_least_squares, 100}, {step_force, 150}, {step_force_uncoupled, 1}, {diagonal_never_solves, 24},
          {immovable_contacts, 1})
