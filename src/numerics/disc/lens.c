/* SPDX-License-Identifier: BSD-3-Clause */
/* Projection onto lenses: the nearest point of one disc if it lies in the other disc, else a corner. Nothing subtracts from 1 a
 * number near 1, so that thin lenses are as exact as others. */
#include "disc_qp.h"

#include <float.h>
#include <math.h>

#include "common/real.h"

enum { SECULAR_ROUNDS = 40 };

/* Squares of numbers between TINY and its inverse have all digits. */
#define TINY 1e-150

double tribo_length(int directions, const double *x)
{
    if (directions == 1) {
        return fabs(x[0]);
    }
    const double most = greater(fabs(x[0]), fabs(x[1]));
    return most > TINY && most < 1.0 / TINY ? sqrt(x[0] * x[0] + x[1] * x[1]) : hypot(x[0], x[1]);
}

/* Uses 1 - |x|^2 = (1 - |x|)(1 + |x|), without cancellation near the rim. */
double tribo_way_to_rim(int directions, const double *x, const double *step)
{
    const double from = tribo_length(directions, x), c = (1.0 - from) * (1.0 + from), size = tribo_length(directions, step);
    double b = 0.0;
    for (int k = 0; k < directions; k++) {
        b += size > 0.0 ? x[k] * (step[k] / size) : 0.0;
    }
    const double root = sqrt(greater(b * b + c, 0.0));
    return quotient(b > 0.0 ? c / greater(b + root, DBL_MIN) : root - b, greater(size, DBL_MIN));
}

struct corner tribo_lens_corner(const double *c, const double *z)
{
    const double length = tribo_length(2, c), along[2] = {c[0] / length, c[1] / length}, half = 0.5 * length;
    const double across = along[0] * z[1] - along[1] * z[0];
    return (struct corner){
        {along[0], along[1]}, half, sqrt(greater((1.0 - half) * (1.0 + half), 0.0)), across < 0.0 ? -1.0 : 1.0};
}

static void corner_at(struct corner k, double *y)
{
    y[0] = -k.half * k.along[0] - k.side * k.height * k.along[1];
    y[1] = -k.half * k.along[1] + k.side * k.height * k.along[0];
}

/* n_k = q_k/(weight_k + mu) for the mu >= 0 with |n| = 1: 1/|n| is concave in mu, so that Newton's method for 1/|n| = 1 rises to
 * it. Returns 0, with mu = 0, if |n| <= 1 there. */
static int minimize_on_disc(const double *weight, const double *q, double *n)
{
    if (weight[0] == weight[1]) { /* the point nearest to q/weight */
        const double length = tribo_length(2, q);
        const int beyond = length > weight[0];
        n[0] = q[0] / (beyond ? length : weight[0]);
        n[1] = q[1] / (beyond ? length : weight[0]);
        return beyond;
    }
    double mu = greater(0.0, greater(fabs(q[0]) - weight[0], fabs(q[1]) - weight[1])), rise = HUGE_VAL;
    for (int round = 0; round < SECULAR_ROUNDS && rise > DBL_EPSILON * mu; round++) {
        n[0] = q[0] / (weight[0] + mu);
        n[1] = q[1] / (weight[1] + mu);
        const double length = tribo_length(2, n);
        if (length <= 1.0) {
            break;
        }
        const double u[2] = {n[0] / length, n[1] / length};
        rise = (length - 1.0) / (u[0] * u[0] / (weight[0] + mu) + u[1] * u[1] / (weight[1] + mu));
        mu += rise;
    }
    const double length = mu > 0.0 ? tribo_length(2, n) : 1.0;
    n[0] /= length;
    n[1] /= length;
    return mu > 0.0;
}

int tribo_lens_minimize(const double *c, const double *weight, const double *q, double *y)
{
    const double shifted[2] = {q[0] + weight[0] * c[0], q[1] + weight[1] * c[1]}, square = c[0] * c[0] + c[1] * c[1];
    double n[2], m[2];
    const int beyond = minimize_on_disc(weight, q, n);
    if (beyond && 2.0 * (n[0] * c[0] + n[1] * c[1]) + square <= 0.0) { /* |n + c| <= 1 */
        y[0] = n[0];
        y[1] = n[1];
        return LENS_ON_DISC;
    }
    const int far = (c[0] != 0.0 || c[1] != 0.0) && minimize_on_disc(weight, shifted, m); /* square may underflow */
    if (!beyond && !far) {
        y[0] = n[0];
        y[1] = n[1];
        return LENS_INSIDE;
    }
    if (far && square <= 2.0 * (m[0] * c[0] + m[1] * c[1])) { /* |m - c| <= 1 */
        y[0] = m[0] - c[0];
        y[1] = m[1] - c[1];
        return LENS_ON_SHIFTED;
    }
    /* the corner with the least sum */
    double other[2], change = 0.0;
    struct corner k = tribo_lens_corner(c, q);
    corner_at(k, y);
    k.side = -k.side;
    corner_at(k, other);
    for (int d = 0; d < 2; d++) {
        change += (other[d] - y[d]) * (0.5 * weight[d] * (other[d] + y[d]) - q[d]);
    }
    if (change < 0.0) {
        y[0] = other[0];
        y[1] = other[1];
    }
    return LENS_AT_CORNER;
}

int tribo_lens_project(int directions, const double *c, const double *z, double *y)
{
    const double even[2] = {1.0, 1.0};
    if (directions == 2) {
        return tribo_lens_minimize(c, even, z, y);
    }
    const double lo = greater(-1.0, -1.0 - c[0]), hi = lesser(1.0, 1.0 - c[0]);
    *y = clamp(z[0], lo, hi);
    return z[0] > hi    ? (c[0] > 0.0 ? LENS_ON_SHIFTED : LENS_ON_DISC)
           : z[0] >= lo ? LENS_INSIDE
                        : (c[0] < 0.0 ? LENS_ON_SHIFTED : LENS_ON_DISC);
}
