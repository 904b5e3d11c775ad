/* SPDX-License-Identifier: BSD-3-Clause */
/* Quinn's law, second order also where a contact is driven through v = 0 without stick: there, for r = |f_eq|/N > 1, the
 * law's xi is scaled by g(r), which makes the time to cross the band exact for constant load. It holds for contacts
 * that came in sliding (moving); contacts that break away from stick keep Quinn's form, which is better for them. */
#include "law.h"

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

/* Sets the force of contact i, and its derivatives in d, or NULL, where they are not those of Quinn's law. */
static void cross(const struct contacts *c, size_t i, double v, double feq, double *f, const struct tangents *d)
{
    const double limit = c->limit[i], follows = c->scales;
    if (c->moving[i] && fabs(feq) > limit && limit > 0.0 && fabs(v) <= tribo_epsilon_of(c, i)) {
        const double slope = tribo_slope_of(c, i), r = quotient(fabs(feq), limit);
        double g, dg;
        crossing(r, &g, &dg);
        const double x = sign(feq) * g * limit - slope * v, turned = 2.0 * quotient(v, tribo_epsilon_of(c, i));
        const int full = fabs(x) > limit;
        *f = clamp(x, -limit, limit);
        if (d) {
            d->dv[i] = full ? 0.0 : -slope;
            d->dfeq[i] = full ? 0.0 : dg;
            d->dlimit[i] = full ? sign(x) : sign(feq) * (g - r * dg) - (1.0 - follows) * turned;
        }
    }
}

static void reversal_force_all(const struct contacts *c, size_t n, const double *v, const double *feq, double *f)
{
    tribo_law_quinn.force(c, n, v, feq, f);
    for (size_t i = 0; i < n; i++) {
        cross(c, i, v[i], feq[i], f + i, NULL);
    }
}

static void reversal_tangent_all(const struct contacts *c, size_t n, const double *v, const double *feq, const struct tangents *d)
{
    tribo_law_quinn.tangent(c, n, v, feq, d);
    for (size_t i = 0; i < n; i++) {
        cross(c, i, v[i], feq[i], d->f + i, d);
    }
}

const struct law tribo_law_quinn_reversal = {
    .id = 5,
    .name = "quinn-reversal",
    .reference = "D. D. Quinn (2004), Eq. 4, with the crossing time of a driven reversal made exact; tribo 1.0",
    .uses_feq = 1,
    .sticks_in_band = 1,
    .relaxes = 1,
    .remembers = 1,
    .holds = 1.0,
    TRIBO_LAW_CALLS(reversal),
};
