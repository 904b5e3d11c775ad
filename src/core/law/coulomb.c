/* SPDX-License-Identifier: BSD-3-Clause */
/* Coulomb's law itself, with f_eq at rest: Quinn (2004), Eq. 1 and 2. */
#include "law.h"

static inline double coulomb_force(double v, double feq, double limit, double epsilon, double slope)
{
    (void)epsilon, (void)slope;
    const double held = clamp(feq, -limit, limit);
    return v != 0.0 ? sliding(v, limit) : held;
}

static inline struct tangent coulomb_tangent(double v, double feq, double limit, double epsilon, double slope, double turn,
                                             double follows)
{
    (void)epsilon, (void)slope, (void)turn, (void)follows;
    return dry_tangent(v != 0.0, v, feq, limit);
}

TRIBO_LAW_LOOPS(coulomb)

const struct law tribo_law_coulomb = {
    .id = 0,
    .name = "coulomb",
    .reference = "C. A. de Coulomb (1785); with f_eq at rest: D. D. Quinn, J. Vib. Acoust. 126 (2004) 391, Eq. 1-2, "
                 "doi:10.1115/1.1760564",
    .uses_feq = 1,
    .holds = 1.0,
    TRIBO_LAW_CALLS(coulomb),
};
