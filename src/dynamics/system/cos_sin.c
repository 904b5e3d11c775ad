/* SPDX-License-Identifier: BSD-3-Clause */
/* omega t is a sum of two doubles. Subtracting whole quarter turns gives an angle up to an eighth of a turn, where eight terms of
 * Taylor's series suffice. There are no branches, so that loops over times become vectors. */
#include "cos_sin.h"
#include "common/simd.h"
#include "numerics/twofold.h"

#include <math.h>

/* Returns the sum of c[k] (-z)^k, k < 8, added in pairs: no term waits for more than three others. */
static inline double alternating(double z, const double *c)
{
    const double z2 = z * z;
    return ((c[0] - z * c[1]) + z2 * (c[2] - z * c[3])) + z2 * z2 * ((c[4] - z * c[5]) + z2 * (c[6] - z * c[7]));
}

static inline double cosine_near_0(struct twofold x)
{
    static const double c[] = {1 / 24.,        1 / 720.,         1 / 40320.,          1 / 3628800.,
                               1 / 479001600., 1 / 87178291200., 1 / 20922789888000., 1 / 6402373705728000.};
    const double z = x.hi * x.hi, half = 0.5 * z, w = 1.0 - half;
    return w + (((1.0 - w) - half) + (z * z * alternating(z, c) - x.hi * x.lo));
}

static inline double sine_near_0(struct twofold x)
{
    static const double c[] = {1 / 6.,        1 / 120.,        1 / 5040.,          1 / 362880.,
                               1 / 39916800., 1 / 6227020800., 1 / 1307674368000., 1 / 355687428096000.};
    const double z = x.hi * x.hi;
    return x.hi + (x.lo * (1.0 - 0.5 * z) - x.hi * z * alternating(z, c));
}

/* c, s = cosine and sine of an angle up to COS_SIN_NEAR, in any rounding mode. x = angle - quarters pi/2, pi/2 = first + second +
 * third; multiples of first and second up to 2^20 are exact. Integers would be vectors of another length than doubles. */
static inline void cos_sin_of(struct twofold angle, double *c, double *s)
{
    const double first = 0x1.921fb544p+0, second = 0x1.0b4611a6p-34, third = 0x1.3198a2e037073p-69;
    const double quarters = floor(angle.hi * 0.63661977236758134 + 0.5);
    const struct twofold most = twofold_sum(angle.hi - quarters * first, -quarters * second);
    const struct twofold x = twofold_sum(most.hi, (most.lo - quarters * third) + angle.lo);
    const double cx = cosine_near_0(x), sx = sine_near_0(x);
    const double left = quarters - 4.0 * floor(0.25 * quarters + 0.25), size = fabs(left); /* left: -1, 0, 1, 2 */
    const double cq = 1.0 - size, sq = left * (2.0 - size);
    *c = cq * cx - sq * sx;
    *s = sq * cx + cq * sx;
}

/* Far angles: rotates by `rest`, the rounding error of omega t plus omega low, without which phases at late times have random
 * errors. */
TRIBO_SIMD_OF_FOUR void tribo_cos_sin(double omega, double t, double low, double *c, double *s)
{
    const double angle = omega * t, rest = (fabs(angle) < TWOFOLD_FAR ? twofold_product(omega, t).lo : 0.0) + omega * low;
    if (fabs(angle) <= COS_SIN_NEAR) {
        cos_sin_of((struct twofold){angle, rest}, c, s);
        return;
    }
    const double ca = cos(angle), sa = sin(angle), cr = cos(rest), sr = sin(rest);
    *c = ca * cr - sa * sr;
    *s = sa * cr + ca * sr;
}

TRIBO_SIMD void tribo_cos_sin_all(double omega, size_t n, const double *restrict t, double *restrict c, double *restrict s)
{
    int64_t far = 0; /* as wide as the doubles compared, for vectors */
    for (size_t k = 0; k < n; k++) {
        far |= fabs(omega * t[k]) <= COS_SIN_NEAR ? 0 : -1;
    }
    for (size_t k = 0; far && k < n; k++) {
        tribo_cos_sin(omega, t[k], 0.0, c + k, s + k);
    }
    for (size_t k = 0; !far && k < n; k++) {
        cos_sin_of(twofold_product(omega, t[k]), c + k, s + k);
    }
}
