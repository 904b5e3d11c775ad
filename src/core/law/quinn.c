/* The paper's law: Quinn (2004), Eq. 4, with half-width epsilon/2 and slope 2N/epsilon. */
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
    const int inside = fabs(v) <= epsilon, held = fabs(feq) < limit;
    const double x = clamp(feq, -limit, limit) - slope * (inside ? v : 0.0);
    const int slides = fabs(v) > epsilon, beyond = fabs(x) > limit;
    const double rate = held_rate(feq, held) - (1.0 - follows) * 2.0 * quotient(v, epsilon);
    return (struct tangent){slides ? 0.0 : beyond ? 0.0 : -slope, slides ? 0.0 : beyond ? 0.0 : held ? 1.0 : 0.0,
                            slides ? sliding_rate(v) : beyond ? sign(x) : rate};
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
    .force = quinn_force_all,
    .balance = quinn_balance_all,
    .tangent = quinn_tangent_all,
};
