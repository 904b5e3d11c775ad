/* Symmetric band matrices, as the band [n][width + 1] of their lower triangle: row i begins with column i - width. Factors L L'
 * likewise. */
#ifndef TRIBO_BAND_H
#define TRIBO_BAND_H

#include "matrix.h"

/* band += the lower triangle of a, row i times factor row[i] (row NULL: factor). */
void tribo_band_add(double *band, size_t width, const struct matrix *a, double factor, const double *row);

/* Factors the band with the rows and columns held [n] (NULL: none) replaced by those of the identity. Returns the row of a pivot
 * that is not positive, or n. */
size_t tribo_band_factorize(size_t n, size_t width, const double *band, const signed char *held, double *l);

/* x [n] = A^-1 x. */
void tribo_band_solve(size_t n, size_t width, const double *l, double *x);

/* x [n] = L^-1 x, and x = L'^-1 x; one after the other they are tribo_band_solve. */
void tribo_band_half_solve(size_t n, size_t width, const double *l, double *x);
void tribo_band_half_solve_back(size_t n, size_t width, const double *l, double *x);

#endif
