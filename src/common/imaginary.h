/* SPDX-License-Identifier: BSD-3-Clause */
/* Defines I of type double complex. _Complex_I is of type float complex: -Wdouble-promotion reports every use. */
#ifndef TRIBO_IMAGINARY_H
#define TRIBO_IMAGINARY_H

#include <complex.h>
#undef I
#define I ((double complex)_Complex_I)

#endif
