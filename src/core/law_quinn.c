/* The paper's law: Quinn (2004), Eq. 4, with half-width epsilon/2 and slope 2N/epsilon. */
#include "law_quinn.h"

static inline double force(double v, double feq, double limit, double epsilon, double slope, unsigned char moving)
{
    (void)moving;
    return quinn_force(v, feq, limit, epsilon, slope);
}

static inline struct tangent tangent(double v, double feq, double limit, double epsilon, double slope, unsigned char moving,
                                     double follows)
{
    (void)moving;
    return quinn_tangent(v, feq, limit, epsilon, slope, follows);
}

TRIBO_LAW_LOOPS

const struct law tribo_law_quinn = {
    .id = 4,
    .name = "quinn",
    .reference = "D. D. Quinn, J. Vib. Acoust. 126 (2004) 391, Eq. 4, doi:10.1115/1.1760564",
    .uses_feq = 1,
    .sticks_in_band = 1,
    .relaxes = 1,
    .force = force_all,
    .tangent = tangent_all,
};
