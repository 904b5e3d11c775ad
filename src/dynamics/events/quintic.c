/* SPDX-License-Identifier: BSD-3-Clause */
#include "quintic.h"
#include "common/real.h"

#include <float.h>
#include <math.h>

/* In Bernstein's basis, and in powers. */
enum { COEFFICIENTS = 7, POWERS = 6 };

/* Roots at 0 that are divided out; as many zeros follow the coefficients. */
enum { ROOTS = 3 };

/* Halvings of an interval to prove a function positive. */
#define HALVINGS 3

/* A step of Newton's method below this leaves an error of its square. */
#define CLOSE 1e-8

/* Splits at s: from = the coefficients before s, c = those after s. */
static void split_bernstein(double *c, double s, double *from)
{
    for (int left = COEFFICIENTS; left > 0; left--) {
        from[COEFFICIENTS - left] = c[0];
        for (int k = 0; k + 1 < left; k++) {
            c[k] += s * (c[k + 1] - c[k]);
        }
    }
}

/* A lower bound of the function: the least coefficient, or that of its halves if it is below enough. */
static double least(double *c, double enough, int halvings)
{
    const double ends = lesser(c[0], c[6]);
    const double all = lesser(lesser(lesser(c[1], c[2]), lesser(c[4], c[5])), lesser(ends, c[3]));
    if (all >= enough || !(ends >= enough) || halvings == 0) {
        return all;
    }
    double from[COEFFICIENTS];
    split_bernstein(c, 0.5, from);
    const double first = least(from, enough, halvings - 1);
    return first >= enough ? lesser(first, least(c, enough, halvings - 1)) : first;
}

/* By Bernstein coefficients c, degree 6, of a lower bound of all functions with samples a, b and sixth derivative up to bend:
 * they differ from the quintic through both samples by at most bend h^6/6! s^3 (1-s)^3, a multiple of the middle element 20 s^3
 * (1-s)^3 of the basis. */
double tribo_quintic_least(const struct sample *a, const struct sample *b, double h, double bend, double until, double enough)
{
    const double h_3 = h * h * h, doubt = bend * h_3 * h_3 * (1 / 14400.);
    const double p0 = a->g, p1 = p0 + 0.2 * h * a->d, p2 = p1 + 0.2 * h * (a->d + 0.25 * h * a->e);
    const double p5 = b->g, p4 = p5 - 0.2 * h * b->d, p3 = p4 - 0.2 * h * (b->d - 0.25 * h * b->e);
    /* 20 s^3 (1-s)^3 is at most half the sum of the middle elements of degree 5 */
    const double rough = lesser(lesser(lesser(p0, p1), lesser(p2, p3) - 0.5 * doubt), lesser(p4, p5));
    if (rough >= enough) {
        return rough;
    }
    double from[COEFFICIENTS], c[COEFFICIENTS] = {p0,
                                                  (p0 + 5.0 * p1) * (1 / 6.),
                                                  (p1 + 2.0 * p2) * (1 / 3.),
                                                  0.5 * (p2 + p3) - doubt,
                                                  (2.0 * p3 + p4) * (1 / 3.),
                                                  (5.0 * p4 + p5) * (1 / 6.),
                                                  p5};
    if (until < h) {
        split_bernstein(c, until / h, from);
    }
    return least(until < h ? from : c, enough, HALVINGS);
}

double tribo_quintic_error(double at, double h, double bend)
{
    const double x = at * (h - at);
    return bend * x * x * x * (1 / 720.);
}

/* The quintic in powers of s = t/h. */
static void quintic_powers(const struct sample *a, const struct sample *b, double h, double *p)
{
    const double d = h * a->d, e = h * h * a->e;
    const double rise = b->g - a->g - d - 0.5 * e, tilt = h * b->d - d - e, curve = h * h * b->e - e;
    p[0] = a->g;
    p[1] = d;
    p[2] = 0.5 * e;
    p[3] = 10.0 * rise - 4.0 * tilt + 0.5 * curve;
    p[4] = 7.0 * tilt - 15.0 * rise - curve;
    p[5] = 6.0 * rise - 3.0 * tilt + 0.5 * curve;
}

/* The zero of p by Newton's method from s on, bisecting where it leaves the interval. Roots at 0 are divided out. */
static double zero(const double *p, double s)
{
    int roots = 0;
    while (roots < ROOTS && p[roots] <= 0.0) {
        roots++;
    }
    const double *const c = p + roots;
    double lo = 0.0, hi = 1.0;
    s = roots ? 0.5 : s;
    for (int i = 0; i < 40; i++) {
        const double value = c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5]))));
        const double slope = c[1] + s * (2.0 * c[2] + s * (3.0 * c[3] + s * (4.0 * c[4] + s * (5.0 * c[5]))));
        *(value > 0.0 ? &lo : &hi) = s;
        const double next = s - value / slope;
        if (slope < 0.0 && fabs(next - s) < CLOSE) {
            return next;
        }
        s = next > lo && next < hi ? next : 0.5 * (lo + hi);
    }
    return s;
}

/* A zero in the second half is found from the end, which has less rounding there; at once if a step of Newton's method from the
 * end leads there. */
double tribo_quintic_zero(const struct sample *a, const struct sample *b, double h)
{
    double p[POWERS + ROOTS] = {0.0}, back = b->d < 0.0 ? b->g / (h * b->d) : 1.0;
    if (a->g <= 0.0 && a->d < 0.0) {
        return 0.0;
    }
    if (!(back > 0.0 && back < 0.5)) {
        quintic_powers(a, b, h, p);
        const double s = zero(p, a->g / (a->g - b->g));
        if (s <= 0.5 || !(b->g < 0.0)) {
            return s * h;
        }
        back = 1.0 - s;
    }
    const struct sample end = {-b->g, b->d, -b->e}, start = {-a->g, a->d, -a->e};
    quintic_powers(&end, &start, h, p);
    return h - zero(p, back) * h;
}

void tribo_curve_add(const struct curve *c, double s, double factor, struct sample *to)
{
    double v0 = 0.0, v1 = 0.0, v2 = 0.0;
    for (size_t k = c->terms; k-- > 0;) {
        v2 = v2 * s + v1;
        v1 = v1 * s + v0;
        v0 = v0 * s + c->term[k * c->stride];
    }
    to->g += factor * v0;
    to->d += factor * v1;
    to->e += factor * 2.0 * v2;
}

void tribo_curves_bound(struct curve *curve, size_t count, size_t terms, size_t stride, const double *term, double h)
{
    double power = 1.0, sixth = 1.0; /* of h; the second that of the sixth derivative */
    for (size_t i = 0; i < count; i++) {
        curve[i] = (struct curve){.term = term + i, .terms = terms, .stride = stride};
    }
    for (size_t k = 0; k < terms; k++) {
        const double six = k < 6 ? 0.0 : (double)(k * (k - 1) * (k - 2)) * (double)((k - 3) * (k - 4) * (k - 5)) * sixth;
        for (size_t i = 0; i < count; i++) {
            const double w = fabs(term[k * stride + i]);
            curve[i].size += w * power;
            curve[i].bend += w * six;
        }
        power = lesser(power * h, DBL_MAX);
        sixth = k < 6 ? 1.0 : lesser(sixth * h, DBL_MAX);
    }
}
