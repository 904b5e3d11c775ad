/* complex.h with I of double, which _Complex_I is not: -Wdouble-promotion finds each use. */
#ifndef TRIBO_IMAGINARY_H
#define TRIBO_IMAGINARY_H

#include <complex.h>
#undef I
#define I ((double complex)_Complex_I)

#endif
