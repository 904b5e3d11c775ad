/* SPDX-License-Identifier: BSD-3-Clause */
/* Cosine and sine of omega t: right to rounding, and the same bits for one time and for many; and of harmonics that a motion
 * turns on from one time to the next. */
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stdint.h>

#include "support.h"
#include "dynamics/system/cos_sin.h"
#include "dynamics/system/system.h"
#include "../../set_up_driver.h"

enum { TIMES = 16 };

/* An even sequence of numbers in (0, 1), the same in each run. */
static double next(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (*state >> 8) / 16777216.0 + 1.0 / 33554432.0;
}

/* Off by no more than this, and by what long double leaves of the angle; both ways. */
static void compare(double omega, double t, double most)
{
    double c[2], s[2];
    const long double angle = (long double)omega * t, doubt = LDBL_EPSILON * fabsl(angle);
    tribo_cos_sin_all(omega, 1, &t, c, s);
    tribo_cos_sin(omega, t, 0.0, c + 1, s + 1);
    for (int k = 0; k < 2; k++) {
        const long double off = hypotl(c[k] - cosl(angle), s[k] - sinl(angle));
        require(off <= most + doubt, "omega = %.17g, t = %.17g: off by %Lg", omega, t, off);
    }
}

TEST(right_to_rounding)
{
    uint32_t state = 1;
    for (int k = 0; k < 100000; k++) {
        const double omega = exp(6.0 * next(&state) - 3.0), t = 200.0 * next(&state) - 100.0;
        compare(omega, t, 1.2e-16);
    }
}

/* On either side of COS_SIN_NEAR. */
TEST(late_times)
{
    uint32_t state = 2;
    for (int k = 0; k < 10000; k++) {
        const double omega = 3.0 + next(&state), t = 3e5 * next(&state) * (k % 2 ? 1.0 : -1.0);
        compare(omega, t, 2.5e-16);
        compare(omega, 1e3 * t, 2.5e-16);
    }
}

/* Near whole quarter turns one of the two is small. */
TEST(quarter_turns)
{
    const double quarter = 1.5707963267948966;
    for (int k = -400000; k <= 400000; k += 997) {
        double c, s;
        const double t = k * quarter;
        tribo_cos_sin_all(1.0, 1, &t, &c, &s);
        assert_close(c, cos(t), 1.2e-16);
        assert_close(s, sin(t), 1.2e-16);
        require(fabs(k % 2 ? c : s) < 1e-9 && fabs(hypot(c, s) - 1.0) < 4e-16, "quarter %d: %.17g, %.17g", k, c, s);
    }
}

/* However many times there are, and though one of them is far away. */
TEST(one_by_one)
{
    uint32_t state = 3;
    double t[TIMES], c[TIMES], s[TIMES];
    for (int round = 0; round < 100; round++) {
        const double omega = 40.0 * next(&state);
        const size_t n = 1 + (size_t)(TIMES * next(&state)) % TIMES;
        for (size_t k = 0; k < n; k++) {
            t[k] = (round % 2 ? 1e6 : 10.0) * next(&state);
        }
        tribo_cos_sin_all(omega, n, t, c, s);
        for (size_t k = 0; k < n; k++) {
            double one_c, one_s;
            tribo_cos_sin_all(omega, 1, t + k, &one_c, &one_s);
            require(one_c == c[k] && one_s == s[k], "omega = %g, t = %g: %.17g, %.17g and %.17g, %.17g", omega, t[k], one_c,
                    one_s, c[k], s[k]);
        }
    }
}

/* Callers that round upwards, downwards or to zero get the same. */
TEST(rounding_modes)
{
    const int modes[] = {
#if defined(FE_UPWARD) && defined(FE_DOWNWARD) && defined(FE_TOWARDZERO)
        FE_UPWARD,
        FE_DOWNWARD,
        FE_TOWARDZERO,
#endif
        FE_TONEAREST
    };
    uint32_t state = 3;
    for (int k = 0; k < 20000; k++) {
        const double omega = exp(6.0 * next(&state) - 3.0), t = 200.0 * next(&state) - 100.0;
        for (size_t m = 0; m < COUNT(modes); m++) {
            double c, s;
            fesetround(modes[m]);
            tribo_cos_sin_all(omega, 1, &t, &c, &s);
            fesetround(FE_TONEAREST);
            const long double angle = (long double)omega * t;
            const double off = (double)hypotl(c - cosl(angle), s - sinl(angle));
            require(off <= 1e-15, "rounding mode %zu, omega = %.17g, t = %.17g: off by %g", m, omega, t, off);
        }
    }
}

TEST_MAIN("cos_sin", {rounding_modes, 1}, {right_to_rounding, 1}, {late_times, 1}, {quarter_turns, 1}, {one_by_one, 1})
