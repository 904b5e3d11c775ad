/* SPDX-License-Identifier: BSD-3-Clause */
/* Karnopp's threshold velocity, below which the contact counts as at rest: Quinn (2004), reference 2 and Fig. 2. */
#include "law.h"

static inline double karnopp_force(double v, double feq, double limit, double epsilon, double slope)
{
    (void)slope;
    const double held = clamp(feq, -limit, limit);
    return fabs(v) > epsilon ? sliding(v, limit) : held;
}

static inline struct tangent karnopp_tangent(double v, double feq, double limit, double epsilon, double slope, double turn,
                                             double follows)
{
    (void)slope, (void)turn, (void)follows;
    return dry_tangent(fabs(v) > epsilon, v, feq, limit);
}

TRIBO_LAW_LOOPS(karnopp)

const struct law tribo_law_karnopp = {
    .id = 3,
    .name = "karnopp",
    .reference = "D. Karnopp, J. Dyn. Syst. Meas. Control 107 (1985) 100, doi:10.1115/1.3140698",
    .uses_feq = 1,
    .sticks_in_band = 1,
    .holds = 1.0,
    TRIBO_LAW_CALLS(karnopp),
};
