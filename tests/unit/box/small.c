/* SPDX-License-Identifier: BSD-3-Clause */
/* Small box problems by themselves: whatever the sets they begin with, the solution has no gradient where x is free, and one that
 * pushes against the bound elsewhere. */
#include <string.h>

#include "numerics/box/small.h"
#include "support.h"

struct bench {
    double r[SMALL * SMALL], inverse[SMALL * SMALL], part[SMALL], least[SMALL], q[SMALL], lo[SMALL], hi[SMALL];
    signed char at[SMALL];
    double x[SMALL], gradient[SMALL];
    unsigned inverse_of;
};

static struct small view(struct bench *b)
{
    return (struct small){b->r, b->inverse, &b->inverse_of, b->part, b->least, b->q, b->lo, b->hi, b->at, b->x, b->gradient};
}

/* R = I + random J J'; bounds and q are multiples of 1/4, so that some x lie at a bound exactly, and some boxes are points. */
static struct bench bench_of(struct random *g, size_t n)
{
    struct bench b = {.inverse_of = 0};
    double j[SMALL][SMALL];
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < n; k++) {
            j[i][k] = (double)below(g, 3) - 1.0;
        }
        b.part[i] = tribo_resolution(n);
        b.least[i] = 1e-300;
        b.q[i] = 0.25 * ((double)below(g, 33) - 16.0);
        b.hi[i] = 0.25 * (double)below(g, 9);
        b.lo[i] = below(g, 4) ? -b.hi[i] : b.hi[i];
        b.at[i] = (signed char)((int)below(g, 4) - 1);
        b.x[i] = b.at[i] == AWAY ? b.hi[i] : 1e30; /* of the others it is not read */
    }
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < n; k++) {
            b.r[i * n + k] = i == k ? 1.0 : 0.0;
            for (size_t l = 0; l < n; l++) {
                b.r[i * n + k] += j[i][l] * j[k][l];
            }
        }
    }
    return b;
}

TEST(solution)
{
    struct random g = random_of(_i);
    const size_t n = 1 + (size_t)_i % SMALL;
    struct bench b = bench_of(&g, n);
    const struct small s = view(&b);
    signed char before[SMALL];
    memcpy(before, b.at, sizeof before);
    require(tribo_small_fits(n, b.r, b.inverse), "R is no small one");
    require(tribo_small_solve(n, &s), "no solution");
    for (size_t i = 0; i < n; i++) {
        double gradient = b.q[i];
        for (size_t k = 0; k < n; k++) {
            gradient += b.r[i * n + k] * b.x[k];
        }
        require((b.at[i] == AWAY) == (before[i] == AWAY), "%zu has come or gone", i);
        if (b.at[i] == AWAY) {
            require(!(b.x[i] < b.hi[i] || b.x[i] > b.hi[i]), "x[%zu] was given", i);
            continue;
        }
        require(b.lo[i] <= b.x[i] && b.x[i] <= b.hi[i], "x[%zu] = %g is outside", i, b.x[i]);
        require(fabs(gradient - b.gradient[i]) <= 1e-13, "gradient[%zu] = %g is %g", i, b.gradient[i], gradient);
        const double against = b.x[i] <= b.lo[i] && b.x[i] >= b.hi[i] ? 0.0
                               : b.x[i] <= b.lo[i]                    ? greater(-gradient, 0.0)
                               : b.x[i] >= b.hi[i]                    ? greater(gradient, 0.0)
                                                                      : fabs(gradient);
        require(against <= 1e-13, "gradient[%zu] = %g pulls", i, gradient);
    }
}
END_TEST

/* The inverse over each set, and the problems that are for other solvers. */
TEST(inverses)
{
    struct random g = random_of(_i);
    const size_t n = 1 + (size_t)_i % SMALL;
    struct bench b = bench_of(&g, n);
    for (unsigned set = 0; set < 1u << n; set++) {
        tribo_small_invert(n, b.r, set, b.inverse);
        for (size_t i = 0; i < n; i++) {
            for (size_t j = 0; j < n; j++) {
                const int in = (set >> i & 1u) && (set >> j & 1u);
                double product = 0.0;
                for (size_t k = 0; k < n; k++) {
                    product += in ? b.r[i * n + k] * b.inverse[k * n + j] : 0.0;
                }
                const double off = in ? fabs(product - (i == j ? 1.0 : 0.0)) : fabs(b.inverse[i * n + j]);
                require(off <= 1e-13, "%zu, %zu of set %u: %g", i, j, set, off);
            }
        }
    }
}
END_TEST

TEST(misfits)
{
    double inverse[SMALL * SMALL];
    const double twins[] = {1.0, 1.0, 1.0, 1.0}, near[] = {1.0, 0.999, 0.999, 1.0}, fit[] = {1.0, 0.9, 0.9, 1.0},
                 huge[] = {1e101, 0.0, 0.0, 1.0}, tiny[] = {1.0, 0.0, 0.0, 1e-101};
    require(!tribo_small_fits(2, twins, inverse), "R is singular");
    require(!tribo_small_fits(2, near, inverse), "R is nearly singular");
    require(tribo_small_fits(2, fit, inverse), "R is regular");
    require(!tribo_small_fits(2, huge, inverse) && !tribo_small_fits(2, tiny, inverse), "R has no plain numbers");
}
END_TEST

TEST_MAIN("small", {solution, 4000}, {inverses, 40}, {misfits, 1})
