/* SPDX-License-Identifier: BSD-3-Clause */
/* The paper's law: Quinn (2004), Eq. 4, with half-width epsilon/2 and slope 2N/epsilon. */
#include "law.h"

/* Outside the band both expressions are equal up to rounding, but slope v might overflow. */
static inline double quinn_force(double v, double feq, double limit, double epsilon, double slope)
{
    const double f = clamp(clamp(feq, -limit, limit) - slope * inside_band(v, epsilon), -limit, limit);
    return fabs(v) > epsilon ? sliding(v, limit) : f;
}

static inline struct tangent quinn_tangent(double v, double feq, double limit, double epsilon, double slope, double turn,
                                           double follows)
{
    (void)follows;
    const int slides = fabs(v) > epsilon, held = fabs(feq) < limit;
    const double near = inside_band(v, epsilon), x = clamp(feq, -limit, limit) - slope * near;
    const int full = fabs(x) > limit;
    const double gain = held ? 1.0 : 0.0, rest = held_rate(feq, held) - turn * near, toward = slides ? -v : x;
    return (struct tangent){slides | full ? 0.0 : -slope, slides | full ? 0.0 : gain,
                            slides | full ? copysign(1.0, toward) : rest};
}

TRIBO_LAW_LOOPS(quinn)

const struct law tribo_law_quinn = {
    .id = 4,
    .name = "quinn",
    .reference = "D. D. Quinn, J. Vib. Acoust. 126 (2004) 391, Eq. 4, doi:10.1115/1.1760564",
    .uses_feq = 1,
    .sticks_in_band = 1,
    .relaxes = 1,
    .holds = 1.0,
    TRIBO_LAW_CALLS(quinn),
};
