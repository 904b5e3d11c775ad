/* Cosine and sine at once: of an angle, and of omega t, for one time or for many. */
#ifndef TRIBO_COS_SIN_H
#define TRIBO_COS_SIN_H

#include <stddef.h>

/* By the functions of math.h. A call of its own, in which compilers see that both are of the same angle: among branches they may
 * not. */
void tribo_turn(double angle, double *cosine, double *sine);

/* c [n] and s [n] at the times t [n]: each pair is a function of omega and its t to the last bit, however many times there are: a
 * point that is right to 1.2e-16, of the exact product of omega and t. Up to |omega t| = COS_SIN_NEAR it takes some 100
 * operations, which are done for several times at once, beyond that the functions of math.h. */
#define COS_SIN_NEAR 1e6
void tribo_cos_sin_all(double omega, size_t n, const double *t, double *c, double *s);

/* The same where all |omega t| are known to be at most COS_SIN_NEAR. */
void tribo_cos_sin_near(double omega, size_t n, const double *t, double *c, double *s);

/* The same at t + low, where low is what rounding left of a time, by the functions of math.h. */
void tribo_cos_sin(double omega, double t, double low, double *c, double *s);

#endif
