/* Large and difficult groups of coupled contacts, and what of the work on them is skipped, kept and done again. */
#include <fenv.h>
#include <stdlib.h>
#include <string.h>

#include "problem.h"

/* ---------------------------------------------------------------------------------------------------------- references */

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

/* ------------------------------------------------------------------------------------------------------ redundant contacts */

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

/* ------------------------------------------------------------------------------------------------------------- scaling */

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

/* ------------------------------------------------------------------------------------------------- what is skipped and kept */

struct counts {
    size_t solves, skipped, reused, factorizations, updates, rank;
};

static struct counts counts_of(const tribo_context *c)
{
    return (struct counts){count_of(c, TRIBO_COUNT_SOLVES),  count_of(c, TRIBO_COUNT_SKIPPED),
                           count_of(c, TRIBO_COUNT_REUSED),  count_of(c, TRIBO_COUNT_FACTORIZATIONS),
                           count_of(c, TRIBO_COUNT_UPDATES), count_of(c, TRIBO_COUNT_RANK)};
}

/* A chain of n contacts between bodies of mass 1: tridiagonal R. */
static tribo_context *chain(size_t n, size_t islands, int coupling)
{
    const size_t all = n * islands;
    size_t *first = malloc((all + 1) * sizeof *first), *col = malloc(3 * all * sizeof *col), k = 0;
    double *val = malloc(3 * all * sizeof *val);
    tribo_context *c;
    first[0] = 0;
    for (size_t i = 0; i < all; i++) {
        if (i % n > 0) {
            col[k] = i - 1;
            val[k++] = -1.0;
        }
        col[k] = i;
        val[k++] = 2.0;
        if (i % n + 1 < n) {
            col[k] = i + 1;
            val[k++] = -1.0;
        }
        first[i + 1] = k;
    }
    assert_ok(tribo_create(&c, all));
    assert_ok(tribo_set_operator_csr(c, first, col, val));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_epsilon_all(c, 1.0));
    assert_ok(tribo_set_coupling(c, coupling));
    free(first);
    free(col);
    free(val);
    return c;
}

/* One contact enters or leaves the stick set of a group of 60 (dense) or 600 (sparse): one update, and no factorization. */
TEST(one_change_is_one_update)
{
    const size_t n = _i % 2 ? 600 : 60;
    const int coupling = _i / 2;
    double *v = calloc(n, sizeof *v), *a = calloc(n, sizeof *a), *f = calloc(n, sizeof *f);
    tribo_context *c = chain(n, 1, coupling);
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
    static signed char mode[SCENE], before[SCENE];
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
        assert_ok(tribo_get_slip(c, mode));
        for (size_t i = 0; i < SCENE && law != TRIBO_SMOOTH; i++) {
            const int holds = fabs(f[i]) < limit[i];
            ck_assert_int_eq(mode[i], limit[i] == 0.0 ? 2 : holds ? 0 : f[i] < 0.0 ? 1 : -1);
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
            ck_assert_mem_eq(before, mode, sizeof mode);
            ck_assert_uint_eq(count_of(clone ? d : c, TRIBO_COUNT_STUCK), stuck);
        }
        tribo_destroy(d);
        /* a bad number in the last contact, after all others have been looked at */
        double *bad = below(&g, 2) ? v : a;
        const double good = bad[SCENE - 1];
        bad[SCENE - 1] = below(&g, 2) ? NAN : -HUGE_VAL;
        for (size_t i = 0; i + 1 < SCENE; i++) {
            v[i] = -v[i];
        }
        assert_status(tribo_balance(c, v, a, NULL, again), TRIBO_ERR_NOT_FINITE);
        assert_says(tribo_message(c), bad == v ? "v[1799]" : "a[1799]");
        assert_all_exact(again, f, SCENE);
        assert_ok(tribo_get_slip(c, before));
        ck_assert_mem_eq(before, mode, sizeof mode);
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
    tribo_context *c = chain(n, islands, _i);
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

/* ------------------------------------------------------------------------------------------------------ large sparse groups */

/* 100,000 contacts in one row, most of them stuck; the sets change from call to call. */
TEST(long_chain)
{
    struct random g = random_of(_i);
    const size_t n = 100000;
    double *v = calloc(n, sizeof *v), *a = calloc(n, sizeof *a), *f = calloc(n, sizeof *f);
    tribo_context *c = chain(n, 1, TRIBO_CONSISTENT);
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
    tribo_context *c = chain(n, 1, TRIBO_CONSISTENT), *d;
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

/* The first call on a sparse group begins with an empty factor. */
TEST(first_call_of_a_sparse_group)
{
    double v[400], a[400] = {0}, f[400];
    tribo_context *c = chain(400, 1, TRIBO_CONSISTENT);
    for (size_t i = 0; i < 400; i++) {
        v[i] = i == 100 || i == 101 ? 0.0 : 3.0;
    }
    assert_ok(tribo_balance(c, v, a, NULL, f));
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_FACTORIZATIONS), 0);
    ck_assert_uint_eq(count_of(c, TRIBO_COUNT_UPDATES), 2);
    tribo_destroy(c);
}

/* An open contact has no derivatives, whatever epsilon is. */
TEST(tangents_of_open_contacts)
{
    const double r[] = {2.0, 1.0, 1.0, 2.0}, limit[] = {1.0, 0.0}, v[] = {0.0, 0.0}, a[] = {0.1, 0.1};
    const double want_dv[] = {-50.0, 0.0, 0.0, 0.0}, want_da[] = {-0.5, 0.0, 0.0, 0.0};
    double f[2], dv[4], da[4];
    tribo_context *c;
    assert_ok(tribo_create(&c, 2));
    assert_ok(tribo_set_operator_dense(c, r));
    assert_ok(tribo_set_limit(c, limit));
    assert_ok(tribo_set_epsilon_step(c, 0.01, 1.0));
    assert_ok(tribo_balance_tangent(c, v, a, NULL, f, dv, da));
    assert_all_close(dv, want_dv, 4, 1e-12);
    assert_all_close(da, want_da, 4, 1e-15);
    tribo_destroy(c);
}

/* ------------------------------------------------------------------------------------------------------ operators by callback */

/* M^-1 of a mass matrix that is tridiagonal, 4 and 1, by elimination. */
static int solve_mass(size_t ndof, const double *force, double *acceleration, void *data)
{
    double pivot[64];
    int *calls = data;
    if (--*calls < 0) {
        return 7;
    }
    for (size_t i = 0; i < ndof; i++) {
        pivot[i] = 4.0 - (i ? 1.0 / pivot[i - 1] : 0.0);
        acceleration[i] = force[i] - (i ? acceleration[i - 1] / pivot[i - 1] : 0.0);
    }
    for (size_t i = ndof; i-- > 0;) {
        acceleration[i] = (acceleration[i] - (i + 1 < ndof ? acceleration[i + 1] : 0.0)) / pivot[i];
    }
    return 0;
}

/* R from J and M^-1 is that which gives the same forces as the dense one. */
TEST(consistent_mass)
{
    struct random g = random_of(_i);
    const size_t n = 2 + below(&g, 20), ndof = n + below(&g, 30);
    size_t first[30] = {0}, col[64];
    double val[64], v[30], a[30], f[30], want[30], limit[30], column[64], force[64], *r = calloc(n * n, sizeof *r);
    for (size_t i = 0; i < n; i++) {
        col[2 * i] = i;
        val[2 * i] = uniform(&g, 0.5, 2.0);
        col[2 * i + 1] = (i + 1 + below(&g, ndof - 1)) % ndof;
        val[2 * i + 1] = uniform(&g, -1.0, 1.0);
        first[i + 1] = 2 * i + 2;
        v[i] = below(&g, 2) ? 0.0 : uniform(&g, -1.5, 1.5);
        a[i] = uniform(&g, -1.0, 1.0);
        limit[i] = uniform(&g, 0.1, 2.0);
    }
    for (size_t j = 0; j < n; j++) {
        int calls = 1;
        memset(force, 0, sizeof force);
        force[col[2 * j]] += val[2 * j];
        force[col[2 * j + 1]] += val[2 * j + 1];
        solve_mass(ndof, force, column, &calls);
        for (size_t i = 0; i < n; i++) {
            r[i * n + j] = val[2 * i] * column[col[2 * i]] + val[2 * i + 1] * column[col[2 * i + 1]];
        }
    }
    for (int dense = 0; dense < 2; dense++) {
        tribo_context *c;
        int calls = (int)n;
        assert_ok(tribo_create(&c, n));
        assert_ok(dense ? tribo_set_operator_dense(c, r)
                        : tribo_set_operator_callback(c, ndof, solve_mass, &calls, first, col, val));
        assert_ok(tribo_set_limit(c, limit));
        assert_ok(tribo_set_epsilon_all(c, 1.0));
        assert_ok(tribo_balance(c, v, a, NULL, dense ? want : f));
        tribo_destroy(c);
    }
    assert_all_close(f, want, n, 1e-12);
    free(r);
}

/* The callback's failure is told, and nothing changes. */
TEST(callback_fails)
{
    const size_t first[] = {0, 1, 2}, col[] = {0, 1};
    const double val[] = {1.0, 1.0}, diagonal[] = {3.0, 5.0};
    double v[2] = {0.0, 0.0}, a[2] = {0.3, 0.5}, f[2];
    int calls = 1;
    tribo_context *c;
    assert_ok(tribo_create(&c, 2));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_operator_diagonal(c, diagonal));
    assert_status(tribo_set_operator_callback(c, 2, solve_mass, &calls, first, col, val), TRIBO_ERR_CALLBACK);
    assert_says(tribo_message(c), "apply answered 7 for contact 1");
    assert_status(tribo_set_operator_callback(c, 2, NULL, &calls, first, col, val), TRIBO_ERR_NULL);
    assert_says(tribo_message(c), "apply is NULL");
    assert_ok(tribo_balance(c, v, a, NULL, f));
    assert_close(f[0], -0.1, 1e-16);
    assert_close(f[1], -0.1, 1e-16);
    tribo_destroy(c);
}

/* ------------------------------------------------------------------------------------------------------ product of tangents */

/* The product is the matrices' product, for every law and coupling, groups and single contacts. */
TEST(product_of_tangents)
{
    struct random g = random_of(_i);
    const int law = _i % tribo_law_count(), coupling = _i / tribo_law_count() % 2;
    const struct recipe recipe = recipe_random(&g, USUAL, 0.3);
    const struct problem p = problem_create(&g, &recipe);
    const size_t n = p.n;
    double *dv = malloc(n * n * sizeof *dv), *da = malloc(n * n * sizeof *da), x[LARGEST], y[LARGEST], df[LARGEST];
    tribo_context *c = problem_context(&p, law, coupling);
    assert_status(tribo_tangent_product(c, p.v, p.a, df), TRIBO_ERR_STATE);
    const int status = tribo_balance_tangent(c, p.v, p.a, NULL, NULL, dv, da);
    if (status != TRIBO_ERR_INCONSISTENT) {
        assert_ok(status);
        for (size_t i = 0; i < n; i++) {
            x[i] = uniform(&g, -1.0, 1.0);
            y[i] = uniform(&g, -1.0, 1.0);
        }
        for (int part = 1; part < 4; part++) {
            assert_ok(tribo_tangent_product(c, part & 1 ? x : NULL, part & 2 ? y : NULL, df));
            for (size_t i = 0; i < n; i++) {
                double want = 0.0, size = 0.0;
                for (size_t j = 0; j < n; j++) {
                    const double terms[] = {part & 1 ? dv[i * n + j] * x[j] : 0.0, part & 2 ? da[i * n + j] * y[j] : 0.0};
                    want += terms[0] + terms[1];
                    size += fabs(terms[0]) + fabs(terms[1]);
                }
                assert_close(df[i], want, 1e-9 * size);
            }
        }
        assert_ok(tribo_set_limit(c, p.limit));
        assert_status(tribo_tangent_product(c, x, y, df), TRIBO_ERR_STATE);
        assert_says(tribo_message(c), "tribo_balance_tangent");
    }
    tribo_destroy(c);
    free(dv);
    free(da);
}

TEST_MAIN("coupled", {gauss_seidel_agrees, 60}, {fixed_point_after_many_changes, 60}, {identical_contacts_share, 100},
          {share_without_order, 200}, {least_norm, 200}, {shares_that_last, 40}, {one_after_the_other, 300},
          {limits_that_are_never_reached, 20}, {far_limits_of_redundant_contacts, 1}, {extreme_limits_and_masses, 200},
          {ill_conditioned, 60}, {one_change_is_one_update, 4}, {mostly_sliding, 24}, {sleeping_islands, 2}, {sliding_singles, 6},
          {long_chain, 2}, {redundant_and_sparse, 2}, {sparse_clone, 3}, {outside_the_range_and_sparse, 1},
          {shares_after_sliding, 1}, {beyond_all_numbers, 2}, {first_call_of_a_sparse_group, 1}, {tangents_of_open_contacts, 1},
          {consistent_mass, 40}, {callback_fails, 1}, {product_of_tangents, 120})
