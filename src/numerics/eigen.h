/* Eigenvalues and eigenvectors of a general real matrix (LAPACK's dgeev). */
#ifndef TRIBO_EIGEN_H
#define TRIBO_EIGEN_H

#include <stddef.h>

/* a [n][n] in, overwritten. A complex pair stands in neighbouring places, the one with the positive imaginary part first.
 * re, im  [n] out
 * x       [n][n] out   the eigenvector of a real eigenvalue k is row k; that of a pair k, k + 1 has row k for real and row k + 1
 *                      for imaginary part. Their length is 1; where eigenvectors are nearly parallel they may be anything.
 * Returns TRIBO_OK, TRIBO_ERR_MEMORY, TRIBO_ERR_NOT_FINITE (a), TRIBO_ERR_NO_CONVERGENCE. */
int tribo_eigen(double *a, size_t n, double *re, double *im, double *x);

#endif
