/* Equations that may have no solution, or many. */
#ifndef TRIBO_LEAST_NORM_H
#define TRIBO_LEAST_NORM_H

#include <stddef.h>

/* x [n] = the shortest vector that comes closest to a y = x, singular values below cut being taken for zero. a [n][n] is
 * kept.
 * kernel  out, or NULL   how many singular values are below cut
 * 1, or 0 if out of memory. */
int tribo_least_norm_solve(double *a, size_t n, double cut, double *x, size_t *kernel);

#endif
