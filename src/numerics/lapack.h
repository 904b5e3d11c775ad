/* SPDX-License-Identifier: BSD-3-Clause */
/* LAPACK and BLAS by their Fortran symbols: arguments by address, matrices by columns, so that a row-major matrix is passed as
 * its transpose; the lengths of the texts (1) at the end. Callers check sizes and entries: XERBLA prints, or ends the program. */
#ifndef TRIBO_LAPACK_H
#define TRIBO_LAPACK_H

#include <limits.h>
#include <stddef.h>

/* Returns 1 if int counts 2 n^2. */
static inline int tribo_lapack_takes(size_t n)
{
    return n <= 32000;
}

/* A = P L U of a band, and A^-1 x. */
void dgbtrf_(const int *rows, const int *cols, const int *below, const int *above, double *band, const int *stride, int *pivot,
             int *info);
void dgbtrs_(const char *trans, const int *n, const int *below, const int *above, const int *count, const double *band,
             const int *stride, const int *pivot, double *x, const int *next, int *info, size_t one);

/* A = L L'. */
void dpotrf_(const char *triangle, const int *n, double *a, const int *stride, int *info, size_t one);

/* P'A P = L L', largest pivot first, until a pivot is at most least: rank columns of L. */
void dpstrf_(const char *triangle, const int *n, double *a, const int *stride, int *order, int *rank, const double *least,
             double *work, int *info, size_t one);

/* A = P L U. */
void dgetrf_(const int *rows, const int *cols, double *a, const int *stride, int *pivot, int *info);

/* Solution of A x = b of complex numbers. */
void zgesv_(const int *n, const int *count, double _Complex *a, const int *stride, int *pivot, double _Complex *x,
            const int *next, int *info);

/* Eigenvalues and eigenvectors of a general, and of a symmetric matrix. */
void dgeev_(const char *left, const char *right, const int *n, double *a, const int *stride, double *re, double *im, double *vl,
            const int *next_l, double *vr, const int *next_r, double *work, const int *size, int *info, size_t one, size_t two);
void dsyev_(const char *vectors, const char *triangle, const int *n, double *a, const int *stride, double *values, double *work,
            const int *size, int *info, size_t one, size_t two);

/* Eigenvalues, ascending, of a symmetric tridiagonal matrix; overwrites both diagonals. */
void dsterf_(const int *n, double *values, double *beside, int *info);

/* Singular values, and left and right singular vectors. */
void dgesvd_(const char *left, const char *right, const int *rows, const int *cols, double *a, const int *stride, double *values,
             double *u, const int *next_u, double *v, const int *next_v, double *work, const int *size, int *info, size_t one,
             size_t two);

/* x = op(A)^-1 x for a triangle A of a band. */
void dpbtrs_(const char *triangle, const int *n, const int *width, const int *count, const double *band, const int *stride,
             double *x, const int *next, int *info, size_t one);

/* X = factor op(A)^-1 X, or factor X op(A)^-1, for a triangle A. */
void dtrsm_(const char *side, const char *triangle, const char *trans, const char *unit, const int *rows, const int *cols,
            const double *factor, const double *a, const int *stride, double *x, const int *next, size_t one, size_t two,
            size_t three, size_t four);

#endif
