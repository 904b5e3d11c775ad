/* Symmetric matrices whose entries are near the diagonal, as the band [n][width + 1] of their lower triangle: row i begins with
 * column i - width. Factors L D L' look the same, with D in place of the ones on L's diagonal. */
#ifndef TRIBO_BAND_H
#define TRIBO_BAND_H

#include "matrix.h"

/* Adds factor [rows] (NULL: ones) times the rows of the lower triangle of a to the band. */
void tribo_band_add(double *band, size_t width, const struct matrix *a, double factor, const double *row);

/* l = the factors of band without the rows and columns that are held (NULL: none), which become those of the identity. Returns
 * the place of a pivot that is not positive, or n. */
size_t tribo_band_factorize(size_t n, size_t width, const double *band, const signed char *held, double *l);

/* x [n] = A^-1 x; and by halves, D^-1/2 L^-1 x and L'^-1 D^-1/2 x. */
void tribo_band_solve(size_t n, size_t width, const double *l, double *x);
void tribo_band_half_solve(size_t n, size_t width, const double *l, double *x);
void tribo_band_half_solve_back(size_t n, size_t width, const double *l, double *x);

#endif
