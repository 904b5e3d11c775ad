/* Quinn's law for one contact; the reversal law falls back on it. */
#ifndef TRIBO_LAW_QUINN_H
#define TRIBO_LAW_QUINN_H

#include "law.h"

/* Outside the band the last line says what the middle one says there up to rounding. */
static inline double quinn_force(double v, double feq, double limit, double epsilon, double slope)
{
    const double f = clamp(clamp(feq, -limit, limit) - slope * v, -limit, limit);
    return v > epsilon ? -limit : v < -epsilon ? limit : f;
}

static inline struct tangent quinn_tangent(double v, double feq, double limit, double epsilon, double slope, double follows)
{
    const double x = clamp(feq, -limit, limit) - slope * v;
    if (fabs(v) > epsilon || fabs(x) > limit) {
        return (struct tangent){0.0, 0.0, fabs(v) > epsilon ? -sign(v) : sign(x)};
    }
    const int held = fabs(feq) < limit;
    return (struct tangent){-slope, held ? 1.0 : 0.0, (held ? 0.0 : sign(feq)) - (1.0 - follows) * 2.0 * v / epsilon};
}

#endif
