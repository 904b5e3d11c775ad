/* SPDX-License-Identifier: BSD-3-Clause */
/* A viscous damper near v = 0: Martins and Oden (1987); Quinn (2004), Eq. 3. Creeps under any load. */
#include "law.h"

static inline double limited_force(double v, double feq, double limit, double epsilon, double slope)
{
    (void)feq;
    const double f = clamp(-0.5 * slope * inside_band(v, epsilon), -limit, limit);
    return fabs(v) > epsilon ? sliding(v, limit) : f;
}

static inline struct tangent limited_tangent(double v, double feq, double limit, double epsilon, double slope, double turn,
                                             double follows)
{
    (void)feq, (void)limit, (void)follows;
    const int slides = fabs(v) > epsilon;
    const double rate = -0.5 * turn * inside_band(v, epsilon);
    return (struct tangent){slides ? 0.0 : -0.5 * slope, 0.0, slides ? sliding(v, 1.0) : rate};
}

TRIBO_LAW_LOOPS(limited)

const struct law tribo_law_velocity_limited = {
    .id = 1,
    .name = "velocity-limited",
    .reference = "J. A. C. Martins and J. T. Oden, Nonlinear Anal. 11 (1987) 407, doi:10.1016/0362-546X(87)90055-1; "
                 "D. D. Quinn (2004), Eq. 3",
    .sticks_in_band = 1,
    .holds = 1.0,
    TRIBO_LAW_CALLS(limited),
};
