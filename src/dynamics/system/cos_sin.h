/* SPDX-License-Identifier: BSD-3-Clause */
/* Cosine and sine of an angle, or of omega t, for one time or many. */
#ifndef TRIBO_COS_SIN_H
#define TRIBO_COS_SIN_H

#include <stddef.h>

/* c [n], s [n] = cosine and sine of omega t, times t [n], to 1.2e-16 for the exact product omega t. The bits of a pair depend
 * only on omega and its t, not on n. For |omega t| <= COS_SIN_NEAR: some 100 operations, several times at once; beyond by
 * math.h. */
#define COS_SIN_NEAR 1e6
void tribo_cos_sin_all(double omega, size_t n, const double *t, double *c, double *s);

/* c, s = cosine and sine of omega (t + low), low the part of the time below the last digit of t, to the same error; by math.h
 * beyond COS_SIN_NEAR, error 2.5e-16. With low = 0 the bits are those of tribo_cos_sin_all. */
void tribo_cos_sin(double omega, double t, double low, double *c, double *s);

#endif
