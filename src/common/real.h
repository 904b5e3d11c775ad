/* Arithmetic that neither calls a function nor raises a floating-point exception: some programs stop at those. */
#ifndef TRIBO_REAL_H
#define TRIBO_REAL_H

#include <math.h>

/* Forces and accelerations are cut to this: sums of such numbers stay finite. */
#define TRIBO_FAR 1e300

/* Minimum and maximum that compile to one instruction; those of math.h are calls, for the sake of NaN. */
static inline double lesser(double x, double y)
{
    return x < y ? x : y;
}

static inline double greater(double x, double y)
{
    return x > y ? x : y;
}

/* A NaN becomes lo. */
static inline double clamp(double x, double lo, double hi)
{
    return lesser(greater(x, lo), hi);
}

static inline double cut(double x)
{
    return clamp(x, -TRIBO_FAR, TRIBO_FAR);
}

/* x/y, TRIBO_FAR at most; y > 0. */
static inline double quotient(double x, double y)
{
    return x / greater(y, fabs(x) * (1.0 / TRIBO_FAR));
}

/* x, cut to numbers that y divides without overflow. */
static inline double divisible(double x, double y)
{
    const double most = TRIBO_FAR * lesser(y, 1.0);
    return clamp(x, -most, most);
}

/* x y, TRIBO_FAR at most. */
static inline double product(double x, double y)
{
    const double most = TRIBO_FAR / greater(fabs(y), 1.0);
    return clamp(x, -most, most) * y;
}

/* product(x, y) for any finite x; y > 0. */
static inline double scaled(double x, double y)
{
    return y > 1.0 ? product(x, y) : cut(x * y);
}

#endif
