/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions of time: polynomials, outputs of guards; zeros of any function, and intervals without one, from its values and two
 * derivatives at both ends of an interval. */
#ifndef TRIBO_QUINTIC_H
#define TRIBO_QUINTIC_H

#include <stddef.h>

/* Value, first and second derivative. */
struct sample {
    double g, d, e;
};

/* The sum of term[k stride] s^k, k < terms. Bounds over a phase: size, of the sum of the sizes of its terms; bend, of that of its
 * sixth derivative. */
struct curve {
    const double *term;
    size_t terms, stride;
    double size, bend;
};

/* Adds factor times value and two derivatives of the curve at s to `to`. */
void tribo_curve_add(const struct curve *c, double s, double factor, struct sample *to);

/* Sets curves [count], neighbouring polynomials from term on, and their bounds over [0, h]. */
void tribo_curves_bound(struct curve *curve, size_t count, size_t terms, size_t stride, const double *term, double h);

/* A lower bound, over [0, until], of a function with samples a and b at 0 and h >= until and a sixth derivative up to bend in
 * size. It is refined only until it reaches enough. */
double tribo_quintic_least(const struct sample *a, const struct sample *b, double h, double bend, double until, double enough);

/* The first zero in (0, h) of the quintic through both samples; a.g > 0 >= b.g. */
double tribo_quintic_zero(const struct sample *a, const struct sample *b, double h);

/* Bound of the difference between quintic and function at `at`. */
double tribo_quintic_error(double at, double h, double bend);

#endif
