/* SPDX-License-Identifier: BSD-3-Clause */
/* tribo_dynamics.h for Fortran: see dynamics.c and methods.c. */
#ifndef TRIBO_FORTRAN_DYNAMICS_H
#define TRIBO_FORTRAN_DYNAMICS_H

#include <stdint.h>

#include "tribo/tribo_dynamics.h"

#include "handle.h"

/* A system as Fortran holds it, and its sizes; 0 for NULL. given: degrees of freedom of the matrices that it was made of. */
struct tribo_held {
    tribo_system *sys;
    int64_t context, given, users;
};
TRIBO_API TRIBO_PURE size_t tribo_fortran_ndof(const struct tribo_held *held);
TRIBO_API TRIBO_PURE size_t tribo_fortran_dimension(const struct tribo_held *held);
TRIBO_API TRIBO_PURE size_t tribo_fortran_ncontact(const struct tribo_held *held);
TRIBO_API TRIBO_PURE size_t tribo_fortran_given(const struct tribo_held *held);

/* Methods of tribo_dynamics.h, followed by the steppers of GSL in a build with libtribo_gsl, and a driver by one of them:
 * methods.c without GSL, methods_gsl.c with it. */
TRIBO_API int tribo_fortran_method_count(void);
TRIBO_API const char *tribo_fortran_method_name(int method);
TRIBO_API int tribo_fortran_driver_create(tribo_driver **drv, tribo_system *sys, const char *method);

#endif
