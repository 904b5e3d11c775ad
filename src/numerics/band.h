/* SPDX-License-Identifier: BSD-3-Clause */
/* Factors L L' of symmetric band matrices, as the band [n][width + 1] of L: row i begins with column i - width. */
#ifndef TRIBO_BAND_H
#define TRIBO_BAND_H

#include "matrix.h"

/* Factors A [n][n] of at most width entries left of the diagonal, by its lower triangle, with the rows and columns held [n]
 * (NULL: none) replaced by those of the identity. Returns the row of a pivot that is not positive, or n. */
size_t tribo_band_factorize(const struct matrix *a, size_t width, const signed char *held, double *l);

/* x [n] = A^-1 x. */
void tribo_band_solve(size_t n, size_t width, const double *l, double *x);

#endif
