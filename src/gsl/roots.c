#include "roots.h"

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
 * element alone, 20 s^3 (1-s)^3: raised to that degree, the quintic needs coefficients that are positive, the middle one by this
 * much. */
int tribo_positive(const struct sample *a, const struct sample *b, double h, double bend, double noise)
{
    double c[6];
    bernstein(a, b, h, c);
    const double h_3 = h * h * h, doubt = bend * h_3 * h_3 / 14400.0;
    const double low =
        fmin(fmin(c[0] + 5.0 * c[1], 2.0 * c[1] + 4.0 * c[2]), fmin(4.0 * c[3] + 2.0 * c[4], 5.0 * c[4] + c[5])) / 6.0;
    return fmin(fmin(low, fmin(c[0], c[5])), 0.5 * (c[2] + c[3]) - doubt) >= -noise;
}

/* Value at s of the polynomial of this degree with Bernstein coefficients c, and its slope. */
static double value(const double *c, int degree, double s, double *slope)
{
    const double r = 1.0 - s;
    double p[6];
    for (int i = 0; i <= degree; i++) {
        p[i] = c[i];
    }
    for (int k = degree; k > 1; k--) {
        for (int i = 0; i < k; i++) {
            p[i] = r * p[i] + s * p[i + 1];
        }
    }
    *slope = degree * (p[1] - p[0]);
    return r * p[0] + s * p[1];
}

double tribo_root_guess(const struct sample *a, const struct sample *b, double h)
{
    double c[6], lo = 0.0, hi = 1.0, slope;
    int degree = 5;
    bernstein(a, b, h, c);
    /* roots at the start are divided out */
    while (degree > 1 && c[0] <= 0.0) {
        for (int i = 0; i < degree; i++) {
            c[i] = c[i + 1] * degree / (i + 1.0);
        }
        degree--;
    }
    double s = c[0] > 0.0 ? c[0] / (c[0] - c[degree]) : 0.5;
    for (int i = 0; i < 20 && hi - lo > 1e-12; i++) {
        const double p = value(c, degree, s, &slope);
        if (p > 0.0) {
            lo = s;
        } else {
            hi = s;
        }
        const double next = s - p / slope;
        if (slope < 0.0 && fabs(next - s) < 1e-12) {
            break;
        }
        s = next > lo && next < hi ? next : 0.5 * (lo + hi);
    }
    return s * h;
}
