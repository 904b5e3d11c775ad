/* SPDX-License-Identifier: BSD-3-Clause */
/* The smooth companion of the velocity-limited law; creeps like it. */
#include "law.h"

static inline double smooth_force(double v, double feq, double limit, double epsilon, double slope)
{
    (void)feq, (void)slope;
    return -limit * tanh(quotient(v, epsilon));
}

static inline struct tangent smooth_tangent(double v, double feq, double limit, double epsilon, double slope, double turn,
                                            double follows)
{
    (void)feq, (void)limit, (void)turn;
    const double x = quotient(v, epsilon), t = tanh(x), cosh_2 = (1.0 - t) * (1.0 + t);
    return (struct tangent){-0.5 * slope * cosh_2, 0.0, -t + follows * x * cosh_2};
}

TRIBO_LAW_LOOPS(smooth)

const struct law tribo_law_smooth = {
    .id = 2,
    .name = "smooth",
    .reference = "hyperbolic tangent, as in the smooth laws that D. D. Quinn, J. Vib. Acoust. 126 (2004) 391, "
                 "cites as references 13 and 14",
    .sticks_in_band = 1,
    .holds = 0.7615941559557649, /* tanh(1), at |v| = epsilon */
    TRIBO_LAW_CALLS(smooth),
};
