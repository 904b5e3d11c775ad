/* SPDX-License-Identifier: BSD-3-Clause */
/* Large groups, whose factor is kept sparse. */
#include <stdlib.h>
#include <string.h>

#include "problem.h"

/* 100,000 contacts in one row, most of them stuck; the sets change from call to call. */
TEST(long_chain)
{
    struct random g = random_of(_i);
    const size_t n = 100000;
    double *v = calloc(n, sizeof *v), *a = calloc(n, sizeof *a), *f = calloc(n, sizeof *f);
    tribo_context *c = problem_chain(n, 1, TRIBO_CONSISTENT);
    for (int k = 0; k < 4; k++) {
        for (size_t i = 0; i < n; i++) {
            v[i] = below(&g, 100) ? 0.0 : uniform(&g, -2.0, 2.0);
            f[i] = uniform(&g, -0.8, 0.8);
        }
        for (size_t i = 0; i < n; i++) {
            a[i] = (i > 0 ? f[i - 1] : 0.0) - 2.0 * f[i] + (i + 1 < n ? f[i + 1] : 0.0);
        }
        assert_ok(tribo_balance(c, v, a, NULL, f));
        for (size_t i = 0; i < n; i++) {
            const double rest = a[i] - (i > 0 ? f[i - 1] : 0.0) - (i + 1 < n ? f[i + 1] : 0.0);
            assert_close(f[i], law_force(TRIBO_QUINN, v[i], -0.5 * rest, 1.0, 1.0), 1e-12);
        }
    }
    require(count_of(c, TRIBO_COUNT_STUCK) > 9 * n / 10, "few are stuck");
    tribo_destroy(c);
    free(v);
    free(a);
    free(f);
}

/* A row of bodies in which every contact is there twice: too many for a dense factor, and half of them redundant. */
static tribo_context *doubled_row(size_t bodies)
{
    const size_t n = 2 * bodies;
    size_t *first = calloc(n + 1, sizeof *first), *col = malloc(2 * n * sizeof *col), k = 0;
    double *val = malloc(2 * n * sizeof *val), *inverse = malloc(bodies * sizeof *inverse);
    tribo_context *c;
    for (size_t i = 0; i < n; i++) {
        col[k] = i / 2;
        val[k++] = 1.0;
        if (i / 2 + 1 < bodies) {
            col[k] = i / 2 + 1;
            val[k++] = -1.0;
        }
        first[i + 1] = k;
        inverse[i / 2] = 1.0;
    }
    assert_ok(tribo_create(&c, n));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_epsilon_all(c, 1.0));
    assert_ok(tribo_set_operator_mass(c, bodies, inverse, first, col, val));
    free(first);
    free(col);
    free(val);
    free(inverse);
    return c;
}

/* Contacts come and go one by one, and by the hundred. */
TEST(redundant_and_sparse)
{
    struct random g = random_of(_i);
    const size_t bodies = 1100, n = 2 * bodies;
    double *v = calloc(n, sizeof *v), *a = calloc(n, sizeof *a), *f = calloc(n, sizeof *f), *u = calloc(bodies + 1, sizeof *u);
    double *pull = calloc(bodies + 1, sizeof *pull);
    tribo_context *c = doubled_row(bodies);
    for (int step = 0; step < 80; step++) {
        for (size_t i = step % 4 ? below(&g, n) : 0; i < n; i += step % 4 ? n : 7) {
            v[i] = below(&g, 2) ? 0.0 : 5.0;
        }
        for (size_t b = 0; b < bodies && step % 4 == 0; b++) {
            pull[b] = uniform(&g, -0.5, 0.5);
        }
        for (size_t i = 0; i < n; i++) {
            a[i] = pull[i / 2] - pull[i / 2 + 1];
        }
        assert_ok(tribo_balance(c, v, a, NULL, f));
        for (size_t b = 0; b < bodies; b++) { /* accelerations of the bodies */
            u[b] = f[2 * b] + f[2 * b + 1] - (b > 0 ? f[2 * b - 2] + f[2 * b - 1] : 0.0);
        }
        for (size_t i = 0; i < n; i++) {
            const double r = i / 2 + 1 < bodies ? 2.0 : 1.0, rest = a[i] + u[i / 2] - u[i / 2 + 1] - r * f[i];
            assert_close(f[i], law_force(TRIBO_QUINN, v[i], -rest / r, 1.0, 1.0), 1e-11);
        }
    }
    tribo_destroy(c);
    free(v);
    free(a);
    free(f);
    free(u);
    free(pull);
}

/* A clone goes on where its original is, the sparse factor included, and both give the same bits. */
TEST(sparse_clone)
{
    struct random g = random_of(_i);
    const size_t n = 700;
    tribo_context *c = problem_chain(n, 1, TRIBO_CONSISTENT), *d;
    double *v = calloc(n, sizeof *v), *a = calloc(n, sizeof *a), *f = calloc(n, sizeof *f), *h = calloc(n, sizeof *h);
    assert_ok(tribo_balance(c, v, a, NULL, f));
    assert_ok(tribo_clone(c, &d));
    for (int k = 0; k < 5; k++) {
        for (size_t i = 0; i < n; i++) {
            a[i] += uniform(&g, -1.0, 1.0);
        }
        assert_ok(tribo_balance(c, v, a, NULL, f));
        assert_ok(tribo_balance(d, v, a, NULL, h));
        assert_all_exact(h, f, n);
    }
    tribo_destroy(c);
    tribo_destroy(d);
    free(v);
    free(a);
    free(f);
    free(h);
}

/* More redundant contacts than shares are found for: an a outside the range of R is told all the same. */
TEST(outside_the_range_and_sparse)
{
    const size_t bodies = 1100, n = 2 * bodies;
    double *zero = calloc(n, sizeof *zero), *a = calloc(n, sizeof *a), *f = calloc(n, sizeof *f);
    tribo_context *c = doubled_row(bodies);
    assert_ok(tribo_set_coupling(c, TRIBO_PARTITION));
    a[10] = a[11] = 0.3;
    assert_ok(tribo_balance(c, zero, a, NULL, f));
    a[11] = -0.3;
    assert_status(tribo_balance(c, zero, a, NULL, f), TRIBO_ERR_INCONSISTENT);
    tribo_destroy(c);
    free(zero);
    free(a);
    free(f);
}

/* The first call on a sparse group begins with an empty factor. */
TEST(first_call_of_a_sparse_group)
{
    double v[400], a[400] = {0}, f[400];
    tribo_context *c = problem_chain(400, 1, TRIBO_CONSISTENT);
    for (size_t i = 0; i < 400; i++) {
        v[i] = i == 100 || i == 101 ? 0.0 : 3.0;
    }
    assert_ok(tribo_balance(c, v, a, NULL, f));
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_FACTORIZATIONS), 0);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_UPDATES), 2);
    tribo_destroy(c);
}

TEST_MAIN("sparse", {long_chain, 2}, {redundant_and_sparse, 2}, {sparse_clone, 3}, {outside_the_range_and_sparse, 1},
          {first_call_of_a_sparse_group, 1})
