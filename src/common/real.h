/* SPDX-License-Identifier: BSD-3-Clause */
/* Arithmetic without function calls and without floating-point exceptions, at which some programs stop. */
#ifndef TRIBO_REAL_H
#define TRIBO_REAL_H

#include <math.h>
#include <stddef.h>

/* Bound of forces and accelerations. Sums of such numbers stay finite. */
#define TRIBO_FAR 1e300

/* Minimum and maximum that compile to one instruction. fmin and fmax are calls, because of NaN. */
static inline double lesser(double x, double y)
{
    return x < y ? x : y;
}

static inline double greater(double x, double y)
{
    return x > y ? x : y;
}

/* Returns x within [lo, hi]; lo for NaN. */
static inline double clamp(double x, double lo, double hi)
{
    return lesser(greater(x, lo), hi);
}

static inline double cut(double x)
{
    return clamp(x, -TRIBO_FAR, TRIBO_FAR);
}

/* Returns x/y, |x/y| limited to TRIBO_FAR; y > 0. */
static inline double quotient(double x, double y)
{
    return x / greater(y, fabs(x) * (1.0 / TRIBO_FAR));
}

/* Returns x y, |x y| limited to TRIBO_FAR. */
static inline double product(double x, double y)
{
    const double most = TRIBO_FAR / greater(fabs(y), 1.0);
    return clamp(x, -most, most) * y;
}

/* Returns product(x, y) for any finite x; y > 0. */
static inline double scaled(double x, double y)
{
    return y > 1.0 ? product(x, y) : cut(x * y);
}

/* Returns max |x_i|. */
static inline double tribo_largest(const double *x, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        most = greater(most, fabs(x[i]));
    }
    return most;
}

/* Exchanges count elements of x and y, at distances of stride. */
static inline void tribo_exchange(double *x, double *y, size_t count, size_t stride)
{
    for (size_t i = 0; i < count; i++) {
        const double z = x[i * stride];
        x[i * stride] = y[i * stride];
        y[i * stride] = z;
    }
}

#endif
