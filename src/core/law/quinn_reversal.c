/* Quinn's law, second order also where a contact is driven through v = 0 without stick: there, for r = |f_eq|/N > 1, the
 * law's xi is scaled by g(r), which makes the time to cross the band exact for constant load. It holds for contacts
 * that came in sliding (moving); contacts that break away from stick keep Quinn's form, which is better for them. */
#include "quinn.h"

/* g(r) = r - (r^2-1)/2 ln((r+1)/(r-1)) and g'(r) = 2 - r ln((r+1)/(r-1)), for r >= 1. */
static void crossing(double r, double *g, double *dg)
{
    if (r <= 1.0) {
        *g = 1.0;
        *dg = 0.0;
    } else if (r < 2.0) {
        const double l = log1p(2.0 / (r - 1.0));
        *g = r - 0.5 * (r - 1.0) * (r + 1.0) * l;
        *dg = 2.0 - r * l;
    } else {
        /* in powers of 1/r, since the closed form loses digits */
        const double x = 1.0 / r, x_2 = x * x;
        double power = x;
        *g = 0.0;
        *dg = 0.0;
        for (int k = 1; power > 1e-17 * x; k += 2) {
            *g += 2.0 * power / (double)(k * (k + 2));
            *dg -= 2.0 * power * x / (double)(k + 2);
            power *= x_2;
        }
    }
}

static int reverses(double v, double feq, double limit, double epsilon, unsigned char moving)
{
    return moving && fabs(v) <= epsilon && fabs(feq) > limit && limit > 0.0;
}

static double reversal_force(double v, double feq, double limit, double epsilon, double slope, unsigned char moving)
{
    if (!reverses(v, feq, limit, epsilon, moving)) {
        return quinn_force(v, feq, limit, epsilon, slope, moving);
    }
    double g, dg;
    crossing(quotient(fabs(feq), limit), &g, &dg);
    return clamp(sign(feq) * g * limit - slope * v, -limit, limit);
}

static struct tangent reversal_tangent(double v, double feq, double limit, double epsilon, double slope, unsigned char moving,
                                       double follows)
{
    if (!reverses(v, feq, limit, epsilon, moving)) {
        return quinn_tangent(v, feq, limit, epsilon, slope, moving, follows);
    }
    double g, dg;
    const double r = quotient(fabs(feq), limit);
    crossing(r, &g, &dg);
    const double x = sign(feq) * g * limit - slope * v;
    if (fabs(x) > limit) {
        return (struct tangent){0.0, 0.0, sign(x)};
    }
    return (struct tangent){-slope, dg, sign(feq) * (g - r * dg) - (1.0 - follows) * 2.0 * quotient(v, epsilon)};
}

TRIBO_LAW_LOOPS(reversal)

const struct law tribo_law_quinn_reversal = {
    .id = 5,
    .name = "quinn-reversal",
    .reference = "D. D. Quinn (2004), Eq. 4, with the crossing time of a driven reversal made exact; tribo 1.0",
    .uses_feq = 1,
    .sticks_in_band = 1,
    .relaxes = 1,
    .remembers = 1,
    .holds = 1.0,
    .force = reversal_force_all,
    .tangent = reversal_tangent_all,
};
