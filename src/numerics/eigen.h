/* Eigenvalues and eigenvectors of a general real matrix (LAPACK's dgeev). */
#ifndef TRIBO_EIGEN_H
#define TRIBO_EIGEN_H

#include <stddef.h>

/* a [n][n]      in, overwritten
 * re, im [n]    out  eigenvalues; of a complex pair the one with im > 0 first, its conjugate next
 * x [n][n]      out  eigenvectors of length 1: row k of a real eigenvalue k; of a pair k, k + 1 the real part in row k and the
 *                    imaginary part in row k + 1. Nearly parallel eigenvectors may be anything.
 * Returns TRIBO_OK, TRIBO_ERR_MEMORY, TRIBO_ERR_NOT_FINITE (a), TRIBO_ERR_NO_CONVERGENCE. */
int tribo_eigen(double *a, size_t n, double *re, double *im, double *x);

#endif
