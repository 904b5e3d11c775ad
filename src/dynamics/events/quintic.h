/* SPDX-License-Identifier: BSD-3-Clause */
/* Zeros of a function, and intervals without one, from its values and two derivatives at both ends of an interval. */
#ifndef TRIBO_QUINTIC_H
#define TRIBO_QUINTIC_H

/* Value, first and second derivative. */
struct sample {
    double g, d, e;
};

/* A lower bound, over [0, until], of a function with samples a and b at 0 and h >= until and a sixth derivative up to bend in
 * size. It is refined only until it reaches enough. */
double tribo_quintic_least(const struct sample *a, const struct sample *b, double h, double bend, double until, double enough);

/* The first zero in (0, h) of the quintic through both samples; a.g > 0 >= b.g. */
double tribo_quintic_zero(const struct sample *a, const struct sample *b, double h);

/* Bound of the difference between quintic and function at `at`. */
double tribo_quintic_error(double at, double h, double bend);

#endif
