/* Cosine and sine at once: of an angle, and of omega t, for one time or for many. */
#ifndef TRIBO_COS_SIN_H
#define TRIBO_COS_SIN_H

#include <stddef.h>

/* By the functions of math.h. A function of its own, without branches, in which compilers see that both are of the same angle. */
void tribo_turn(double angle, double *cosine, double *sine);

/* c [n] and s [n] of omega t at the times t [n], to 1.2e-16 of the exact product: each pair is a function of omega and its t
 * to the last bit, whatever n is. Up to |omega t| = COS_SIN_NEAR it takes some 100 operations for several times at once,
 * beyond that the functions of math.h. */
#define COS_SIN_NEAR 1e6
void tribo_cos_sin_all(double omega, size_t n, const double *t, double *c, double *s);

/* The same at t + low, where low is the part of a time below its last digit, by the functions of math.h, to 2.5e-16. */
void tribo_cos_sin(double omega, double t, double low, double *c, double *s);

#endif
