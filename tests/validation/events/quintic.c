/* SPDX-License-Identifier: BSD-3-Clause */
/* Bounds and zeros of functions by samples at the ends of an interval. */
#include <math.h>

#include "support.h"
#include "dynamics/events/quintic.h"

enum { POINTS = 200, CASES = 20000 };

/* A polynomial of degree 5 in s = t/h, 0 <= s <= 1. */
struct polynomial {
    double c[6], h;
};

static double value(const struct polynomial *p, double s)
{
    double sum = 0.0;
    for (int k = 5; k >= 0; k--) {
        sum = sum * s + p->c[k];
    }
    return sum;
}

static struct sample sample_at(const struct polynomial *p, double s)
{
    double d = 0.0, e = 0.0;
    for (int k = 5; k >= 1; k--) {
        d = d * s + k * p->c[k];
    }
    for (int k = 5; k >= 2; k--) {
        e = e * s + k * (k - 1) * p->c[k];
    }
    return (struct sample){value(p, s), d / p->h, e / p->h / p->h};
}

/* factor times the product of (root - s). */
static struct polynomial by_roots(double factor, int roots, const double *root, double h)
{
    struct polynomial p = {{factor}, h};
    for (int r = 0; r < roots; r++) {
        for (int k = 5; k >= 0; k--) {
            p.c[k] = root[r] * p.c[k] - (k > 0 ? p.c[k - 1] : 0.0);
        }
    }
    return p;
}

static double zero_of(const struct polynomial *p)
{
    const struct sample a = sample_at(p, 0.0), b = sample_at(p, 1.0);
    return tribo_quintic_zero(&a, &b, p->h) / p->h;
}

/* On this interval and of this size. */
static void find_root(double factor, int roots, const double *root, double h, double expected, double within)
{
    const struct polynomial p = by_roots(factor, roots, root, h);
    const double at = zero_of(&p);
    require(fabs(at - expected) <= within, "%.17g for %.17g", at, expected);
}

TEST(single_roots)
{
    const double ends[] = {1e-9, 1e-3, 0.25, 0.5, 0.75, 0.999, 1.0};
    for (size_t k = 0; k < sizeof ends / sizeof *ends; k++) {
        const double far[] = {ends[k], 3.0, 2.5, 4.0, 5.0}, other[] = {ends[k], 1.5, 7.0};
        find_root(1.0, 5, far, 1.0, ends[k], 1e-14);
        find_root(1.0, 1, far, 1.0, ends[k], 1e-15);
        find_root(1.0, 3, other, 1.0, ends[k], 1e-14);
    }
}

/* So close are they that rounding of the coefficients moves them by its root. */
TEST(two_close_roots_and_a_third)
{
    const double root[] = {0.3, 0.3 + 1e-3, 0.9};
    const struct polynomial p = by_roots(1.0, 3, root, 1.0);
    const double at = zero_of(&p);
    double nearest = HUGE_VAL;
    for (int k = 0; k < 3; k++) {
        nearest = fmin(nearest, fabs(at - root[k]));
    }
    require(nearest <= 1e-10, "%.17g", at);
}

TEST(roots_whatever_the_scale)
{
    const double root[] = {0.7, 2.0, 3.0};
    for (double size = 1e-100; size < 1e101; size *= 1e50) {
        for (double h = 1e-40; h < 1e41; h *= 1e20) {
            find_root(size, 3, root, h, 0.7, 1e-14);
        }
    }
}

/* Leading coefficients that are hardly there do not count. */
TEST(tiny_leading_coefficients)
{
    for (double tiny = 1e-300; tiny < 1e-15; tiny *= 1e20) {
        const struct polynomial p = {{0.5, -1.0, 0.0, tiny, -tiny, tiny}, 1.0};
        assert_close(zero_of(&p), 0.5, 1e-14);
    }
}

/* A zero at the start, from which the function rises first, is not the one looked for. */
TEST(zero_at_the_start)
{
    const struct polynomial p = {{0.0, 1.0, -2.0, 0.0, 0.0, 0.0}, 1.0};
    assert_close(zero_of(&p), 0.5, 1e-14);
}

/* A function at zero, or below by rounding, that falls from the start is zero there. */
TEST(fall_from_the_start)
{
    for (int k = 0; k < 3; k++) {
        const struct polynomial p = {{-1e-16 * k, -1.0, -0.01, 0.1, 0.0, 0.0}, 1.0};
        assert_exact(zero_of(&p), 0.0);
    }
}

/* Two sines and a constant, of which the sixth derivative is at most bend. */
struct swing {
    double a, b, omega, phase, offset, bend;
};

static struct swing draw(struct random *r)
{
    struct swing f = {uniform(r, 0.0, 1.0),      uniform(r, 0.0, 1.0), uniform(r, 1.0, 5.0),
                      uniform(r, 0.0, 2.0 * PI), uniform(r, 0.0, 2.0), 0.0};
    f.bend = f.a + f.b * pow(f.omega, 6.0);
    return f;
}

static double derivative(const struct swing *f, double t, int k)
{
    const double quarter = 0.5 * PI;
    return (k == 0 ? f->offset : 0.0) + f->a * cos(t + k * quarter) +
           f->b * pow(f->omega, k) * cos(f->omega * t + f->phase + k * quarter);
}

static struct sample swing_at(const struct swing *f, double t)
{
    return (struct sample){derivative(f, t, 0), derivative(f, t, 1), derivative(f, t, 2)};
}

static double least_of(const struct swing *f, double begin, double end)
{
    double least = HUGE_VAL;
    for (int k = 0; k <= POINTS; k++) {
        least = fmin(least, derivative(f, begin + (end - begin) * k / POINTS, 0));
    }
    return least;
}

/* Bounds that are enough are nowhere above the function, however long the interval. */
TEST(bounds_are_below)
{
    int told = 0;
    struct random r = random_of(1);
    for (int k = 0; k < CASES; k++) {
        const struct swing f = draw(&r);
        const double t = uniform(&r, 0.0, 10.0), h = uniform(&r, 0.0, 2.0) / f.omega,
                     until = k % 2 ? h : h * uniform(&r, 0.0, 1.0);
        const double enough = uniform(&r, -0.5, 0.5);
        const struct sample a = swing_at(&f, t), b = swing_at(&f, t + h);
        const double least = least_of(&f, t, t + until);
        const double quintic = tribo_quintic_least(&a, &b, h, f.bend, until, enough);
        require(!(quintic >= enough) || quintic <= least + 1e-13, "samples, case %d", k);
        told += quintic >= enough;
    }
    require(told > CASES / 4, "%d", told);
}

/* Where a function is well above zero, short intervals tell. */
TEST(bounds_tell_of_short_intervals)
{
    struct random r = random_of(2);
    for (int k = 0; k < CASES; k++) {
        struct swing f = draw(&r);
        const double t = uniform(&r, 0.0, 10.0), h = 0.5 / f.omega;
        f.offset += 0.05 - least_of(&f, t, t + h);
        const struct sample a = swing_at(&f, t), b = swing_at(&f, t + h);
        require(tribo_quintic_least(&a, &b, h, f.bend, h, 0.0) >= 0.0, "samples, case %d", k);
    }
}

/* A parabola that touches zero, nearly: above or below it by so much. */
TEST(near_touch)
{
    for (double gap = 1e-3; gap > 1e-13; gap *= 0.1) {
        for (int side = -1; side <= 1; side += 2) {
            const struct polynomial p = {{0.25 + side * gap, -1.0, 1.0, 0.0, 0.0, 0.0}, 1.0};
            const struct sample a = sample_at(&p, 0.0), b = sample_at(&p, 1.0);
            const int quintic = tribo_quintic_least(&a, &b, 1.0, 0.0, 1.0, 0.0) >= 0.0;
            require(quintic == (side > 0), "gap %g", side * gap);
        }
    }
}

/* What a zero of the quintic leaves of the function is no more than the error that is told. */
TEST(error_of_a_zero)
{
    struct random r = random_of(3);
    int found = 0;
    for (int k = 0; k < CASES; k++) {
        const struct swing f = draw(&r);
        const double t = uniform(&r, 0.0, 10.0), h = uniform(&r, 0.0, 2.0) / f.omega;
        const struct sample a = swing_at(&f, t), b = swing_at(&f, t + h);
        if (a.g > 0.0 && b.g < 0.0) {
            const double at = tribo_quintic_zero(&a, &b, h), left = fabs(derivative(&f, t + at, 0));
            require(left <= tribo_quintic_error(at, h, f.bend) + 1e-13, "case %d: %g", k, left);
            found++;
        }
    }
    require(found > CASES / 50, "%d", found);
}

TEST_MAIN("quintic", {single_roots, 1}, {two_close_roots_and_a_third, 1}, {roots_whatever_the_scale, 1},
          {tiny_leading_coefficients, 1}, {fall_from_the_start, 1}, {zero_at_the_start, 1}, {bounds_are_below, 1},
          {bounds_tell_of_short_intervals, 1}, {near_touch, 1}, {error_of_a_zero, 1})
