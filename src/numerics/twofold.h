/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers with twice as many digits, as sums of two doubles: Dekker (1971, Numer. Math. 18, 224, doi:10.1007/BF01397083). Sizes
 * must stay below TWOFOLD_FAR: nothing overflows then. */
#ifndef TRIBO_TWOFOLD_H
#define TRIBO_TWOFOLD_H

#include <math.h>

#define TWOFOLD_FAR 1e140

struct twofold {
    double hi, lo; /* |lo| is at most half a unit of hi's last digit */
};

static inline struct twofold twofold_sum(double a, double b)
{
    const double s = a + b, part = s - a;
    return (struct twofold){s, (a - (s - part)) + (b - part)};
}

/* Returns the upper half of the digits of x. */
static inline double twofold_upper(double x)
{
    const double c = 134217729.0 * x;
    return c - (c - x);
}

static inline struct twofold twofold_product(double a, double b)
{
    const double p = a * b, ah = twofold_upper(a), bh = twofold_upper(b), al = a - ah, bl = b - bh;
    return (struct twofold){p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

static inline struct twofold twofold_add(struct twofold a, struct twofold b)
{
    const struct twofold s = twofold_sum(a.hi, b.hi), t = twofold_sum(a.lo, b.lo), u = twofold_sum(s.hi, s.lo + t.hi);
    return twofold_sum(u.hi, u.lo + t.lo);
}

static inline struct twofold twofold_times(struct twofold a, struct twofold b)
{
    const struct twofold p = twofold_product(a.hi, b.hi);
    return twofold_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

/* Returns a factor, for a power of 2. */
static inline struct twofold twofold_scale(struct twofold a, double factor)
{
    return (struct twofold){a.hi * factor, a.lo * factor};
}

static inline struct twofold twofold_minus(struct twofold a, struct twofold b)
{
    return twofold_add(a, twofold_scale(b, -1.0));
}

/* Returns 1/sqrt(a), by one step of Newton's iteration from the rounded value. */
static inline struct twofold twofold_inverse_root(struct twofold a)
{
    const double x = 1.0 / sqrt(a.hi);
    const struct twofold square = twofold_product(x, x), one = {1.0, 0.0};
    const struct twofold left = twofold_minus(one, twofold_times(a, square));
    return twofold_sum(x, 0.5 * x * left.hi);
}

#endif
