/* Quinn's law for one contact; the reversal law falls back on it. */
#ifndef TRIBO_LAW_QUINN_H
#define TRIBO_LAW_QUINN_H

#include "law.h"

/* Outside the band the middle line would say what the last one says up to rounding, but slope v may overflow there. */
static inline double quinn_force(double v, double feq, double limit, double epsilon, double slope, unsigned char moving)
{
    (void)moving;
    const int inside = fabs(v) <= epsilon;
    const double f = clamp(clamp(feq, -limit, limit) - slope * (inside ? v : 0.0), -limit, limit);
    return inside ? f : sliding(v, limit);
}

static inline struct tangent quinn_tangent(double v, double feq, double limit, double epsilon, double slope, unsigned char moving,
                                           double follows)
{
    (void)moving;
    if (fabs(v) > epsilon) {
        return sliding_tangent(v);
    }
    const double x = clamp(feq, -limit, limit) - slope * v;
    if (fabs(x) > limit) {
        return (struct tangent){0.0, 0.0, sign(x)};
    }
    const int held = fabs(feq) < limit;
    return (struct tangent){-slope, held ? 1.0 : 0.0, (held ? 0.0 : sign(feq)) - (1.0 - follows) * 2.0 * quotient(v, epsilon)};
}

#endif
