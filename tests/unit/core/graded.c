/* SPDX-License-Identifier: BSD-3-Clause */
/* Piles of bodies that are light and heavy in turn, contact i being between bodies i - 1 and i (the ground for i = 0). What
 * presses on the heavy ones goes through all contacts below, whatever the light ones weigh: everything has a closed form. */
#include "tribo/tribo.h"

#include "support.h"

#include <float.h>

enum { MOST = 8 };

struct pile {
    size_t n, contacts; /* twice as many contacts if they are doubled */
    double mass[MOST], inverse[MOST];
    tribo_context *c;
};

/* Body `light` mod 2 and every other one has 1/ratio. */
static struct pile pile_of(size_t n, double ratio, size_t light, int doubled, int expected)
{
    struct pile p = {n, doubled ? 2 * n : n, {0.0}, {0.0}, NULL};
    size_t rowptr[2 * MOST + 1] = {0}, col[4 * MOST], entries = 0;
    double val[4 * MOST];
    for (size_t i = 0; i < n; i++) {
        p.inverse[i] = (i % 2 == light ? ratio : 1.0) / (1.0 + (double)i);
        p.mass[i] = 1.0 / p.inverse[i];
    }
    for (size_t i = 0; i < p.contacts; i++) {
        const size_t body = i % n;
        if (body > 0) {
            col[entries] = body - 1;
            val[entries++] = -1.0;
        }
        col[entries] = body;
        val[entries++] = 1.0;
        rowptr[i + 1] = entries;
    }
    assert_ok(tribo_create(&p.c, p.contacts));
    assert_status(tribo_set_operator_mass(p.c, n, p.inverse, rowptr, col, val), expected);
    assert_ok(tribo_set_law(p.c, TRIBO_COULOMB));
    assert_ok(tribo_set_limit_all(p.c, 100.0));
    return p;
}

/* Accelerations of the contacts where `press` presses on every heavy body, and what the contacts then carry. */
static void press(const struct pile *p, const double *press, double *a, double *carried)
{
    double sum = 0.0;
    for (size_t i = p->n; i-- > 0;) {
        sum += press[i];
        carried[i] = -sum;
        a[i] = p->inverse[i] * press[i] - (i > 0 ? p->inverse[i - 1] * press[i - 1] : 0.0);
    }
    for (size_t i = p->n; i < p->contacts; i++) {
        a[i] = a[i - p->n];
        carried[i] = carried[i - p->n] *= 0.5;
    }
}

static double largest(const double *x, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, fabs(x[i]));
    }
    return most;
}

static const double ratios[] = {1e4, 1e7, 1e10, 1e12, 1e14, 1e16, 1e17};

/* Any number of bodies, either kind lowest, single or doubled contacts. */
static struct pile any_pile(int run, double *a, double *carried)
{
    const size_t n = 2 + (size_t)run % 7, light = (size_t)run / 7 % 2;
    const int doubled = run / 14 % 2;
    double on[MOST] = {0.0};
    for (size_t i = 0; i < n; i++) {
        on[i] = i % 2 == light ? 0.0 : 0.25 + (double)i;
    }
    const struct pile p = pile_of(n, ratios[run / 28], light, doubled, TRIBO_OK);
    press(&p, on, a, carried);
    return p;
}

enum { RUNS = 28 * COUNT(ratios) };

TEST(everything_holds)
{
    double a[2 * MOST], want[2 * MOST], v[2 * MOST] = {0.0}, f[2 * MOST], feq[2 * MOST];
    struct pile p = any_pile(_i, a, want);
    for (int coupling = TRIBO_CONSISTENT; coupling <= TRIBO_PARTITION; coupling++) {
        assert_ok(tribo_set_coupling(p.c, coupling));
        assert_ok(tribo_balance(p.c, v, a, feq, f));
        assert_all_close(f, want, p.contacts, 1e-12 * largest(want, p.contacts));
        assert_all_close(feq, want, p.contacts, 1e-12 * largest(want, p.contacts));
    }
    assert_ok(tribo_step_force(p.c, 1.0, a, f));
    assert_all_close(f, want, p.contacts, 1e-12 * largest(want, p.contacts));
    tribo_destroy(p.c);
}

/* Twins that are pulled apart cannot follow: least squares is what balances the mean of their accelerations. */
TEST(twins_pulled_apart)
{
    double a[2 * MOST], want[2 * MOST], v[2 * MOST] = {0.0}, feq[2 * MOST];
    struct pile p = any_pile(_i, a, want);
    const size_t twins = p.contacts - p.n;
    for (size_t i = 0; i < twins; i++) {
        a[i] += 0.5;
        a[p.n + i] -= 0.5;
    }
    assert_ok(tribo_set_coupling(p.c, TRIBO_PARTITION));
    assert_status(tribo_balance(p.c, v, a, feq, NULL), twins ? TRIBO_ERR_INCONSISTENT : TRIBO_OK);
    assert_all_close(feq, want, p.contacts, 1e-12 * largest(want, p.contacts));
    tribo_destroy(p.c);
}

/* The lowest contact gives way: what lies on it goes with it, and holds together by what moves the bodies above. */
TEST(the_lowest_slides)
{
    double a[2 * MOST], carried[2 * MOST], limit[2 * MOST], v[2 * MOST] = {0.0}, f[2 * MOST], whole = 0.0, above = 0.0, most;
    struct pile p = any_pile(_i, a, carried);
    for (size_t i = 0; i < p.contacts; i++) {
        limit[i] = i % p.n == 0 ? 0.5 * fabs(carried[i]) : 100.0;
    }
    assert_ok(tribo_set_limit(p.c, limit));
    assert_ok(tribo_balance(p.c, v, a, NULL, f));
    const double doubled = p.contacts > p.n ? 2.0 : 1.0, pull = -0.5 * doubled * carried[0];
    for (size_t i = 0; i < p.n; i++) {
        whole += p.mass[i];
    }
    for (size_t i = p.n; i-- > 0;) {
        above += p.mass[i];
        most = fabs(doubled * carried[i]) + pull * above / whole;
        assert_close(doubled * f[i], doubled * carried[i] + pull * above / whole, 1e-10 * most);
    }
    tribo_destroy(p.c);
}

/* df/da = -R^-1, where (R^-1)_ij is the mass on the higher of both contacts. */
TEST(derivatives)
{
    double a[2 * MOST], carried[2 * MOST], v[2 * MOST] = {0.0}, d[4 * MOST * MOST], above[MOST + 1] = {0.0};
    struct pile p = any_pile(_i, a, carried);
    const double shares = p.contacts > p.n ? 4.0 : 1.0;
    assert_ok(tribo_balance_tangent(p.c, v, a, NULL, NULL, NULL, d));
    for (size_t i = p.n; i-- > 0;) {
        above[i] = above[i + 1] + p.mass[i];
    }
    for (size_t i = 0; i < p.contacts; i++) {
        for (size_t j = 0; j < p.contacts; j++) {
            const size_t higher = i % p.n > j % p.n ? i % p.n : j % p.n;
            assert_close(d[i * p.contacts + j], -above[higher] / shares, 1e-9 * above[higher] / shares);
        }
    }
    tribo_destroy(p.c);
}

/* Solving again, in a copy, and after other sets, changes nothing. */
TEST(history)
{
    double a[2 * MOST], want[2 * MOST], limit[2 * MOST], first[2 * MOST], f[2 * MOST];
    struct pile p = any_pile(_i, a, want);
    tribo_context *copy;
    assert_ok(tribo_step_force(p.c, 1.0, a, first));
    for (size_t i = 0; i < p.contacts; i++) {
        limit[i] = i % 3 ? 100.0 : 0.1;
    }
    assert_ok(tribo_set_limit(p.c, limit));
    assert_ok(tribo_step_force(p.c, 1.0, a, f));
    assert_ok(tribo_clone(p.c, &copy));
    assert_ok(tribo_set_limit_all(copy, 100.0));
    assert_ok(tribo_step_force(copy, 1.0, a, f));
    assert_all_close(f, first, p.contacts, 1e-12 * largest(first, p.contacts));
    tribo_destroy(copy);
    tribo_destroy(p.c);
}

/* Beyond what digits there are for is an error. */
TEST(too_far_apart)
{
    struct pile p = pile_of(3, 1e18, 0, 0, TRIBO_ERR_UNSUPPORTED);
    assert_says(tribo_message(p.c), "contact 1 touches bodies whose masses differ by 2e+18");
    tribo_destroy(p.c);
}

/* Appends entry x in column body to the last row. */
static void put(size_t *entries, size_t *col, double *val, size_t body, double x)
{
    col[*entries] = body;
    val[(*entries)++] = x;
}

/* A chain, and two contacts k of a light body with two heavy ones: v_k = u_light + (1 + k)(u_heavy - u_other). R of the chain's last
 * contact with these is 0: terms by the heavy bodies cancel, or J has a 0 at the light one. Numbers of the chain are no entries of
 * the pair's matrix (sanitizers see writes behind it). */
TEST(beside_another_group)
{
    enum { CHAIN = 5, N = CHAIN + 2, LIGHT = CHAIN + 1, HEAVY, OTHER, BODIES };
    const double inverse[BODIES] = {
        [0] = 1.0, [1] = 1.0, [2] = 1.0, [3] = 1.0, [4] = 1.0, [5] = 1.0, [LIGHT] = 1e6, [HEAVY] = 1.0, [OTHER] = 1.0};
    for (int zero = 0; zero < 2; zero++) {
        size_t rowptr[N + 1] = {0}, col[4 * N], entries = 0;
        double val[4 * N], v[N] = {0.0}, a[N] = {[CHAIN] = 100.0, [CHAIN + 1] = 101.0}, f[N];
        for (size_t i = 0; i < CHAIN; i++) {
            put(&entries, col, val, i, 1.0);
            put(&entries, col, val, i + 1, -1.0);
            if (i + 1 == CHAIN) {
                put(&entries, col, val, zero ? LIGHT : HEAVY, zero ? 0.0 : 1.0);
                put(&entries, col, val, OTHER, zero ? 0.0 : 1.0);
            }
            rowptr[i + 1] = entries;
        }
        for (size_t k = 0; k < 2; k++) {
            put(&entries, col, val, LIGHT, 1.0);
            put(&entries, col, val, HEAVY, 1.0 + (double)k);
            put(&entries, col, val, OTHER, -1.0 - (double)k);
            rowptr[CHAIN + k + 1] = entries;
        }
        tribo_context *c;
        assert_ok(tribo_create(&c, N));
        assert_ok(tribo_set_operator_mass(c, BODIES, inverse, rowptr, col, val));
        assert_ok(tribo_set_law(c, TRIBO_COULOMB));
        assert_ok(tribo_set_limit_all(c, 1e3));
        assert_ok(tribo_balance(c, v, a, NULL, f));
        for (size_t k = 0; k < 2; k++) {
            const double apart = f[CHAIN] + 2.0 * f[CHAIN + 1]; /* force on the heavy bodies */
            const double rest = 1e6 * (f[CHAIN] + f[CHAIN + 1]) + 2.0 * (1.0 + (double)k) * apart + a[CHAIN + k];
            require(fabs(rest) < 1e-12 * 1e6 * 1e2, "%d, contact %zu: %g is missing", zero, CHAIN + k, rest);
        }
        tribo_destroy(c);
    }
}

TEST_MAIN("graded", {everything_holds, RUNS}, {twins_pulled_apart, RUNS}, {the_lowest_slides, RUNS}, {derivatives, RUNS},
          {history, RUNS}, {too_far_apart, 1}, {beside_another_group, 1})
