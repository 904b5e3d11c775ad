/* SPDX-License-Identifier: BSD-3-Clause */
/* Exponential function and logarithm without branches and calls: loops over them become vectors, with the same bits in all
 * variants. */
#ifndef TRIBO_EXPONENT_H
#define TRIBO_EXPONENT_H

#include <stdint.h>
#include <string.h>

#include "real.h"

/* ln 2 in two parts; products of the first one with whole numbers up to 2^20 are exact. */
#define TRIBO_LN2_HIGH 6.93147180369123816490e-01
#define TRIBO_LN2_LOW 1.90821492927058770002e-10

static inline uint64_t tribo_bits(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline double tribo_of_bits(uint64_t bits)
{
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* exp(x) - one, one = 0 or 1, to 2 units in the last place; |x| > 700 counts as 700. x = k ln 2 + r; 2^k comes from the last bits
 * of k + ROUND. */
static inline double tribo_exp_minus(double x, double one)
{
    const double ROUND = 6755399441055744.0, PER_LN2 = 1.44269504088896338700e+00;
    const double y = clamp(x, -700.0, 700.0), moved = y * PER_LN2 + ROUND, k = moved - ROUND;
    const double r = (y - k * TRIBO_LN2_HIGH) - k * TRIBO_LN2_LOW, power = tribo_of_bits((tribo_bits(moved) + 1023) << 52);
    const double rr = r * r, c2 = 1.0 / 2 + r * (1.0 / 6), c4 = 1.0 / 24 + r * (1.0 / 120), c6 = 1.0 / 720 + r * (1.0 / 5040),
                 c8 = 1.0 / 40320 + r * (1.0 / 362880), c10 = 1.0 / 3628800 + r * (1.0 / 39916800),
                 c12 = 1.0 / 479001600 + r * (1.0 / 6227020800);
    const double tail = c2 + rr * (c4 + rr * (c6 + rr * (c8 + rr * (c10 + rr * c12))));
    return power * (r + rr * tail) + (power - one);
}

static inline double tribo_exp(double x)
{
    return tribo_exp_minus(x, 0.0);
}

static inline double tribo_expm1(double x)
{
    return tribo_exp_minus(x, 1.0);
}

/* log(x) to 1 unit in the last place, x a normal number > 0. x = 2^k (1 + f), |f| < 0.42; the series in f/(2 + f) is that of
 * fdlibm. */
static inline double tribo_log(double x)
{
    const uint64_t least = 0x3fe6a09e00000000, one = 0x3ff0000000000000, whole = 0x4330000000000000; /* sqrt(1/2), 1, 2^52 */
    const uint64_t exponent = (tribo_bits(x) - least + one) >> 52;
    const double k = tribo_of_bits(whole | exponent) - (4503599627370496.0 + 1023.0);
    const double f = tribo_of_bits(tribo_bits(x) - ((exponent - 1023) << 52)) - 1.0, s = f / (2.0 + f), z = s * s,
                 half = 0.5 * f * f;
    const double zz = z * z,
                 odd = 6.666666666666735130e-01 +
                       zz * (2.857142874366239149e-01 + zz * (1.818357216161805012e-01 + zz * 1.479819860511658591e-01)),
                 even = 3.999999999940941908e-01 + zz * (2.222219843214978396e-01 + zz * 1.531383769920937332e-01),
                 series = z * (odd + z * even);
    return k * TRIBO_LN2_HIGH - ((half - (s * (half + series) + k * TRIBO_LN2_LOW)) - f);
}

#endif
