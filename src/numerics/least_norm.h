/* Linear equations that may have no solution, or many. */
#ifndef TRIBO_LEAST_NORM_H
#define TRIBO_LEAST_NORM_H

#include <stddef.h>

/* x [n] = the shortest y that minimizes |a y - x|, with singular values of a [n][n] below cut taken as zero. Overwrites a.
 * kernel  out, or NULL   the number of singular values below cut
 * Returns 1, or 0 if out of memory. x is NaN if a is not finite. */
int tribo_least_norm_solve(double *a, size_t n, double cut, double *x, size_t *kernel);

#endif
