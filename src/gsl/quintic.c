#include "quintic.h"
#include "../common/real.h"

#include <math.h>

/* Bernstein coefficients of the quintic that has the samples' values and derivatives at its ends. */
static void bernstein(const struct sample *a, const struct sample *b, double h, double *c)
{
    c[0] = a->g;
    c[1] = c[0] + 0.2 * h * a->d;
    c[2] = c[1] + 0.2 * h * (a->d + 0.25 * h * a->e);
    c[5] = b->g;
    c[4] = c[5] - 0.2 * h * b->d;
    c[3] = c[4] - 0.2 * h * (b->d - 0.25 * h * b->e);
}

/* The function differs from the quintic by at most bend h^6/6! s^3 (1-s)^3, which in Bernstein's basis of degree 6 is the middle
 * element alone, 20 s^3 (1-s)^3. So the least of the coefficients of the quintic, raised to that degree, with the middle one less
 * by this much, is a lower bound. */
double tribo_quintic_least(const struct sample *a, const struct sample *b, double h, double bend)
{
    double c[6];
    bernstein(a, b, h, c);
    const double h_3 = h * h * h, doubt = bend * h_3 * h_3 / 14400.0;
    const double least =
        lesser(lesser(c[0] + 5.0 * c[1], 2.0 * c[1] + 4.0 * c[2]), lesser(4.0 * c[3] + 2.0 * c[4], 5.0 * c[4] + c[5])) / 6.0;
    return lesser(lesser(least, lesser(c[0], c[5])), 0.5 * (c[2] + c[3]) - doubt);
}

double tribo_quintic_zero(const struct sample *a, const struct sample *b, double h)
{
    const double d = h * a->d, e = h * h * a->e;
    const double rise = b->g - a->g - d - 0.5 * e, tilt = h * b->d - d - e, curve = h * h * b->e - e;
    double p[6] = {a->g,
                   d,
                   0.5 * e,
                   10.0 * rise - 4.0 * tilt + 0.5 * curve,
                   7.0 * tilt - 15.0 * rise - curve,
                   6.0 * rise - 3.0 * tilt + 0.5 * curve};
    /* roots at the start are divided out */
    int first = 0;
    while (first < 3 && p[first] <= 0.0) {
        p[first++] = 0.0;
    }
    double lo = 0.0, hi = 1.0, s = p[0] > 0.0 ? a->g / (a->g - b->g) : 0.5;
    for (int i = 0; i < 30; i++) {
        double value = 0.0, slope = 0.0;
        for (int k = 5; k >= first; k--) {
            slope = slope * s + value;
            value = value * s + p[k];
        }
        *(value > 0.0 ? &lo : &hi) = s;
        const double next = s - value / slope;
        const int inside = next > lo && next < hi;
        /* a step this short leaves an error of its square */
        if (slope < 0.0 && fabs(next - s) < 1e-6) {
            return next * h;
        }
        s = inside ? next : 0.5 * (lo + hi);
    }
    return s * h;
}
