/* SPDX-License-Identifier: BSD-3-Clause */
/* Scenes of many contacts: what of the work on them is skipped, kept and done again. */
#include <fenv.h>
#include <stdlib.h>
#include <string.h>

#include "problem.h"

struct counts {
    size_t solves, skipped, reused, factorizations, updates, rank;
};

static struct counts counts_of(const tribo_context *c)
{
    return (struct counts){count_of(c, TRIBO_COUNT_SOLVES),  count_of(c, TRIBO_COUNT_SKIPPED),
                           count_of(c, TRIBO_COUNT_REUSED),  count_of(c, TRIBO_COUNT_FACTORIZATIONS),
                           count_of(c, TRIBO_COUNT_UPDATES), count_of(c, TRIBO_COUNT_RANK)};
}

/* One contact enters or leaves the stick set of a group of 60 (dense) or 600 (sparse): one update, and no factorization. */
TEST(one_change_is_one_update)
{
    const size_t n = _i % 2 ? 600 : 60;
    const int coupling = _i / 2;
    double *v = calloc(n, sizeof *v), *a = calloc(n, sizeof *a), *f = calloc(n, sizeof *f);
    tribo_context *c = problem_chain(n, 1, coupling);
    for (size_t i = 0; i < n; i++) {
        a[i] = i % 2 ? 0.1 : -0.1;
    }
    assert_ok(tribo_balance(c, v, a, NULL, f));
    /* with the same sets nothing is factorized */
    struct counts before = counts_of(c), now;
    for (int k = 0; k < 5; k++) {
        a[3] += 0.01;
        assert_ok(tribo_balance(c, v, a, NULL, f));
    }
    now = counts_of(c);
    ck_assert_uint_eq(now.solves, before.solves + 5);
    ck_assert_uint_eq(now.reused, before.reused + 5);
    ck_assert_uint_eq(now.factorizations, before.factorizations);
    ck_assert_uint_eq(now.updates, before.updates);
    const size_t rank = now.rank;
    /* contact 7 slides off, and comes to rest */
    for (int k = 0; k < 6; k++) {
        before = counts_of(c);
        v[7] = k % 2 ? 0.0 : 3.0;
        assert_ok(tribo_balance(c, v, a, NULL, f));
        now = counts_of(c);
        ck_assert_uint_eq(now.updates, before.updates + 1);
        ck_assert_uint_eq(now.factorizations, before.factorizations);
        ck_assert_uint_eq(now.reused, before.reused);
        ck_assert_uint_eq(now.rank, k % 2 ? rank : rank - 1);
        for (size_t i = 0; i < n; i++) {
            const double sum = a[i] + 2.0 * f[i] - (i > 0 ? f[i - 1] : 0.0) - (i + 1 < n ? f[i + 1] : 0.0);
            if (fabs(f[i]) < 1.0) {
                assert_close(sum, 0.0, 1e-13);
            }
        }
    }
    tribo_destroy(c);
    free(v);
    free(a);
    free(f);
}

/* Contacts that share no body have their f_eq also where everything slides, though f does not ask for it. */
TEST(sliding_singles)
{
    enum { N = 300 };
    size_t first[N + 1] = {0}, col[N + 2], k = 0;
    double val[N + 2], v[N], a[N], feq[N], f[N];
    tribo_context *c;
    for (size_t i = 0; i < N; i++) {
        if (i < 2) { /* 0 and 1 share one */
            col[k] = 1 - i;
            val[k++] = 0.5;
        }
        col[k] = i;
        val[k++] = 2.0;
        first[i + 1] = k;
        v[i] = i % 2 ? 3.0 : -3.0;
    }
    assert_ok(tribo_create(&c, N));
    assert_ok(tribo_set_law(c, _i));
    assert_ok(tribo_set_operator_csr(c, first, col, val));
    assert_ok(tribo_set_limit_all(c, 0.75));
    assert_ok(tribo_set_epsilon_all(c, 1.0));
    for (int call = 0; call < 3; call++) {
        for (size_t i = 0; i < N; i++) {
            a[i] = 0.25 * (double)i + call;
        }
        assert_ok(tribo_balance(c, v, a, call ? feq : NULL, f));
        for (size_t i = 0; i < N; i++) {
            const double other = i < 2 ? 0.5 * f[1 - i] : 0.0;
            assert_exact(f[i], law_force(_i, v[i], 0.0, 0.75, 1.0));
            assert_close(call ? feq[i] : 0.0, call ? -0.5 * (a[i] + other) : 0.0, 1e-14);
        }
    }
    tribo_destroy(c);
}

/* Groups of three and single contacts by turns, or single ones only, in a scene so large that whole stretches of it slide. */
enum { STRETCH = 300, STRETCHES = 6, SCENE = STRETCH * STRETCHES };

static int coupled_with(size_t i, size_t j)
{
    return i / STRETCH % 2 == 0 && i / 3 == j / 3 && i != j;
}

static tribo_context *mostly_sliding_scene(struct random *g, int law, int alike, int apart, double *limit, double *epsilon)
{
    static size_t first[SCENE + 1], col[3 * SCENE];
    static double val[3 * SCENE];
    size_t k = 0;
    tribo_context *c;
    for (size_t i = 0; i < SCENE; i++) {
        for (size_t j = i - i % 3; j < i - i % 3 + 3; j++) {
            if (j == i || (!apart && coupled_with(i, j))) {
                col[k] = j;
                val[k++] = j == i ? 2.0 : 0.5;
            }
        }
        first[i + 1] = k;
        limit[i] = alike ? 1.0 : below(g, 9) == 0 || i / STRETCH == 4 ? 0.0 : uniform(g, 0.5, 2.0);
        epsilon[i] = alike ? 1.0 : uniform(g, 0.5, 1.5);
    }
    assert_ok(tribo_create(&c, SCENE));
    assert_ok(tribo_set_law(c, law));
    assert_ok(tribo_set_operator_csr(c, first, col, val));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_epsilon(c, epsilon));
    return c;
}

/* Which forces are kept and which follow from directions makes no difference: not to forces, modes or clones, nor after a call
 * that failed. */
TEST(mostly_sliding)
{
    struct random g = random_of(_i);
    const int law = _i % tribo_law_count(), alike = _i / tribo_law_count() % 2, apart = _i >= 2 * tribo_law_count();
    static double limit[SCENE], epsilon[SCENE], v[SCENE], a[SCENE], f[SCENE], feq[SCENE], again[SCENE];
    static signed char slip[SCENE], before[SCENE];
    tribo_context *c = mostly_sliding_scene(&g, law, alike, apart, limit, epsilon), *d;
    for (int call = 0; call < 10; call++) {
        const size_t busy = below(&g, STRETCHES), crowd = call % 3 ? 40 : 2;
        for (size_t i = 0; i < SCENE; i++) {
            const int near = i / STRETCH == busy && below(&g, crowd) == 0;
            v[i] = near ? (below(&g, 2) ? 0.0 : uniform(&g, -1.5, 1.5)) : below(&g, 2) ? uniform(&g, 2.0, 3.0) : -2.0;
            a[i] = uniform(&g, -5.0, 5.0);
        }
        assert_ok(tribo_clone(c, &d));
        feclearexcept(FE_ALL_EXCEPT);
        assert_ok(tribo_balance(c, v, a, call % 2 ? feq : NULL, f));
        require(!fetestexcept(FE_INVALID), "a trap for invalid operations would have been sprung");
        for (size_t i = 0; i < SCENE && law != TRIBO_QUINN_REVERSAL; i++) { /* whose f_eq is not that of its own forces */
            double rest = a[i];
            for (size_t j = i - i % 3; j < i - i % 3 + 3; j++) {
                rest += !apart && coupled_with(i, j) ? 0.5 * f[j] : 0.0;
            }
            const double want = limit[i] > 0.0 ? -0.5 * rest : 0.0;
            assert_close(f[i], law_force(law, v[i], want, limit[i], epsilon[i]), 1e-14);
            assert_close(call % 2 ? feq[i] : want, want, 1e-14);
        }
        assert_ok(tribo_get_slip(c, slip));
        for (size_t i = 0; i < SCENE && law != TRIBO_SMOOTH; i++) {
            const int holds = fabs(f[i]) < limit[i];
            ck_assert_int_eq(slip[i], limit[i] == 0.0 ? TRIBO_SLIP_OPEN
                                      : holds         ? TRIBO_SLIP_STUCK
                                      : f[i] < 0.0    ? TRIBO_SLIP_FORTH
                                                      : TRIBO_SLIP_BACK);
        }
        /* the same calls from the same beginning give the same bits, whether f_eq is wanted or not */
        assert_ok(tribo_balance(d, v, a, call % 2 ? NULL : feq, again));
        assert_all_exact(again, f, SCENE);
        tribo_destroy(d);
        /* modes are those of the balance, whatever becomes of the limits */
        const size_t stuck = count_of(c, TRIBO_COUNT_STUCK);
        assert_ok(tribo_set_limit_all(c, call % 3));
        assert_ok(tribo_clone(c, &d));
        assert_ok(tribo_set_limit(c, limit));
        for (int clone = 0; clone < 2; clone++) {
            assert_ok(tribo_get_slip(clone ? d : c, before));
            ck_assert_mem_eq(before, slip, sizeof slip);
            ck_assert_uint_eq(count_of(clone ? d : c, TRIBO_COUNT_STUCK), stuck);
        }
        tribo_destroy(d);
        /* a bad number in the last contact, after all others have been looked at */
        double *bad = below(&g, 2) ? v : a;
        const double good = bad[SCENE - 1];
        bad[SCENE - 1] = below(&g, 2) ? (double)NAN : -HUGE_VAL;
        for (size_t i = 0; i + 1 < SCENE; i++) {
            v[i] = -v[i];
        }
        assert_status(tribo_balance(c, v, a, NULL, again), TRIBO_ERR_NOT_FINITE);
        assert_says(tribo_message(c), bad == v ? "v[1799]" : "a[1799]");
        assert_all_exact(again, f, SCENE);
        assert_ok(tribo_get_slip(c, before));
        ck_assert_mem_eq(before, slip, sizeof slip);
        bad[SCENE - 1] = good;
    }
    /* finite, though no sum of them is */
    for (size_t i = 0; i < SCENE; i++) {
        v[i] = DBL_MAX;
        a[i] = 0.9 * DBL_MAX;
    }
    assert_ok(tribo_balance(c, v, a, NULL, f));
    for (size_t i = 0; i < SCENE; i++) {
        assert_exact(f[i], law_force(law, v[i], 0.0, limit[i], epsilon[i]));
    }
    tribo_destroy(c);
}

/* Groups without a contact near stick are left alone, in the balance and in the step force. */
TEST(sleeping_islands)
{
    const size_t n = 4, islands = 50, all = n * islands;
    double v[200], a[200], f[200];
    tribo_context *c = problem_chain(n, islands, _i);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_ISLANDS), islands);
    for (size_t i = 0; i < all; i++) {
        v[i] = i % 2 ? 3.0 : -2.0;
        a[i] = 0.5;
    }
    assert_ok(tribo_balance(c, v, a, NULL, f));
    struct counts now = counts_of(c);
    ck_assert_uint_eq(now.solves, 0);
    ck_assert_uint_eq(now.skipped, islands);
    ck_assert_uint_eq(now.factorizations, 0);
    v[2 * n + 1] = v[7 * n] = v[7 * n + 3] = 0.0;
    assert_ok(tribo_balance(c, v, a, NULL, f));
    now = counts_of(c);
    ck_assert_uint_eq(now.solves, 2);
    ck_assert_uint_eq(now.skipped, 2 * islands - 2);
    ck_assert_uint_eq(now.factorizations, 2);
    /* nobody in the first 40 islands can be held: each is pulled with more than its own limit and its neighbours', 4, over a step
     * of 1 */
    for (size_t i = 0; i < all; i++) {
        v[i] = i < 40 * n ? (i % 2 ? 4.1 : -5.0) : 0.5;
    }
    assert_ok(tribo_step_force(c, 1.0, v, f));
    now = counts_of(c);
    ck_assert_uint_eq(now.solves, 2 + 10);
    ck_assert_uint_eq(now.skipped, 2 * islands - 2 + 40);
    for (size_t i = 0; i < 40 * n; i++) {
        assert_exact(f[i], -sgn(v[i]));
    }
    tribo_destroy(c);
}

TEST_MAIN("scenes", {one_change_is_one_update, 4}, {sliding_singles, 6}, {mostly_sliding, 24}, {sleeping_islands, 2})
