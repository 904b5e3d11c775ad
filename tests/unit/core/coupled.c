/* SPDX-License-Identifier: BSD-3-Clause */
/* Forces of coupled contacts against other ways to find them, and against themselves after many changes. */
#include <string.h>

#include "problem.h"

/* The consistent problem by projected Gauss-Seidel in long double, until a sweep changes nothing. 0 if that takes too long. */
static int gauss_seidel(const struct problem *p, int law, long double *f)
{
    memset(f, 0, p->n * sizeof *f);
    for (size_t sweep = 0; sweep < 10000000 / (p->n * p->n); sweep++) {
        long double change = 0.0L;
        for (size_t i = 0; i < p->n; i++) {
            const long double limit = p->limit[i], r = p->r[i * p->n + i];
            long double rest = p->a[i];
            for (size_t j = 0; j < p->n; j++) {
                rest += j == i ? 0.0L : p->r[i * p->n + j] * f[j];
            }
            long double x = fminl(fmaxl(-rest / r, -limit), limit);
            if (fabs(p->v[i]) > (law == TRIBO_COULOMB ? 0.0 : p->epsilon[i])) {
                x = p->v[i] > 0.0 ? -limit : limit;
            } else if (law == TRIBO_QUINN) {
                x = fminl(fmaxl(x - 2.0L * limit / p->epsilon[i] * p->v[i], -limit), limit);
            }
            change = fmaxl(change, fabsl(x - f[i]));
            f[i] = x;
        }
        if (change < 1e-18L) {
            return 1;
        }
    }
    return 0;
}

/* R f is unique, f where R has full rank. */
TEST(gauss_seidel_agrees)
{
    struct random g = random_of(_i);
    const size_t n = 1 + below(&g, _i % 4 ? 30 : LARGEST);
    const struct recipe recipe = {n, _i % 2 ? 2 * n : 1 + below(&g, n), 0.0, 2.0, 2.0, 0.1, 0.4, 0.0};
    struct problem p = problem_create(&g, &recipe);
    const int law = _i % 3 ? TRIBO_QUINN : TRIBO_COULOMB;
    static long double want[LARGEST];
    double f[LARGEST], feq[LARGEST];
    tribo_context *c = problem_context(&p, law, TRIBO_CONSISTENT);
    assert_ok(tribo_balance(c, p.v, p.a, feq, f));
    tribo_destroy(c);
    const int converged = gauss_seidel(&p, law, want);
    require(converged || _i % 2 == 0, "no reference");
    if (!converged) {
        return;
    }
    for (size_t i = 0; i < n; i++) {
        long double off = 0.0L, size = 0.0L;
        for (size_t j = 0; j < n; j++) {
            off += p.r[i * n + j] * ((long double)f[j] - want[j]);
            size += fabsl(p.r[i * n + j] * want[j]) + fabs(p.r[i * n + j] * p.limit[j]);
        }
        assert_close((double)off, 0.0, 1e-12 * (double)size);
    }
}

/* One warm context through many problems: the fixed point, to 1e-12 of the limits. */
TEST(fixed_point_after_many_changes)
{
    struct random g = random_of(_i);
    const struct recipe recipe = recipe_random(&g, _i % 4 ? USUAL : LARGEST, _i % 3 * 1.5);
    struct problem p = problem_create(&g, &recipe);
    double f[LARGEST], feq[LARGEST];
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_CONSISTENT);
    for (int k = 0; k < (_i % 4 ? 300 : 30); k++) {
        assert_ok(tribo_balance(c, p.v, p.a, feq, f));
        for (size_t i = 0; i < p.n; i++) {
            const double noise = balancing_noise(&p, i, f);
            const double want =
                law_force(TRIBO_QUINN, p.v[i], p.limit[i] > 0.0 ? balancing(&p, i, f) : 0.0, p.limit[i], p.epsilon[i]);
            assert_close(f[i], want, 1e-12 * p.limit[i] + noise);
        }
        for (size_t i = 0; i < p.n; i++) {
            p.a[i] += below(&g, 4) ? 0.0 : p.r[i * p.n + i] * p.limit[i] * uniform(&g, -1.0, 1.0);
            p.v[i] = below(&g, 8) ? p.v[i] : p.epsilon[i] * uniform(&g, -2.0, 2.0);
        }
    }
    tribo_destroy(c);
}

/* Contacts that come to rest one after the other, nearly redundant ones among them, end with the rank and the forces of those
 * that came all at once. */
TEST(one_after_the_other)
{
    struct random g = random_of(_i);
    const size_t n = 4 + below(&g, 20);
    const struct recipe recipe = {n, 2 + below(&g, n), 0.0, 0.0, 1.0, 0.0, 1.0, 0.7};
    struct problem p = problem_create(&g, &recipe);
    double f[LARGEST], want[LARGEST], rest[LARGEST], v[LARGEST];
    for (size_t i = 0; i < n; i++) { /* a in the range of R */
        rest[i] = 0.0;
        for (size_t j = 0; j < n; j++) {
            rest[i] += p.r[i * n + j] * (j % 2 ? 0.3 : -0.2);
        }
        v[i] = 5.0 * p.epsilon[i];
    }
    tribo_context *c = problem_context(&p, TRIBO_QUINN, TRIBO_PARTITION),
                  *fresh = problem_context(&p, TRIBO_QUINN, TRIBO_PARTITION);
    for (size_t k = 0; k < n; k++) {
        v[(5 * k + 3) % n] = 0.0;
        tribo_balance(c, v, rest, f, NULL);
    }
    memset(v, 0, sizeof v);
    assert_ok(tribo_balance(c, v, rest, f, NULL));
    assert_ok(tribo_balance(fresh, v, rest, want, NULL));
    for (size_t i = 0; i < n; i++) {
        double sum = rest[i], size = fabs(rest[i]);
        for (size_t j = 0; j < n; j++) {
            sum += p.r[i * n + j] * f[j];
            size += fabs(p.r[i * n + j] * f[j]);
        }
        assert_close(sum, 0.0, 1e-13 * size);
    }
    tribo_destroy(c);
    tribo_destroy(fresh);
}

/* Box problems by what makes them solutions: R of rows of sizes from 1e-4 to 1e4, bounds beyond all forces, on one side of 0,
 * equal, and of the size of the forces. */
TEST(boxes)
{
    struct random g = random_of(_i);
    const size_t n = 1 + below(&g, 12);
    const struct recipe recipe = {n, 2 * n, 4.0, 0.0, 1.0, 0.0, 1.0, 0.0};
    struct problem p = problem_create(&g, &recipe);
    double lo[LARGEST], hi[LARGEST], f[LARGEST];
    tribo_context *c;
    for (size_t i = 0; i < n; i++) {
        const size_t kind = below(&g, 5);
        const double own = sqrt(p.r[i * n + i]);
        p.a[i] = own * uniform(&g, -1.0, 1.0);
        hi[i] = kind < 2 ? 1e200 : kind == 2 ? 0.0 : uniform(&g, 0.0, 1.0) / own;
        lo[i] = kind == 0 ? -1e200 : kind == 4 ? hi[i] : kind == 1 ? 0.0 : -uniform(&g, 0.0, 1.0) / own;
    }
    assert_ok(tribo_create(&c, n));
    assert_ok(tribo_set_operator_dense(c, p.r));
    assert_ok(tribo_solve_box(c, p.a, lo, hi, f));
    for (size_t i = 0; i < n; i++) {
        const double size = balancing_noise(&p, i, f) * p.r[i * n + i] / DBL_EPSILON,
                     pull = (double)acceleration(&p, i, f) / size;
        require(f[i] >= lo[i] && f[i] <= hi[i], "f[%zu] = %g is not within %g and %g", i, f[i], lo[i], hi[i]);
        require(f[i] == lo[i] || pull <= 1e-13, "contact %zu: %g above", i, pull);
        require(f[i] == hi[i] || pull >= -1e-13, "contact %zu: %g below", i, pull);
    }
    tribo_destroy(c);
}

TEST_MAIN("coupled", {boxes, 500}, {gauss_seidel_agrees, 60}, {fixed_point_after_many_changes, 60}, {one_after_the_other, 300})
