/* SPDX-License-Identifier: BSD-3-Clause */
/* tribo with GSL: GSL's steppers and types for the systems of tribo_dynamics.h.
 *
 * GSL's error handler is never changed. Singular matrices and a lack of memory return an error of tribo before GSL sees them.
 * Adaptive steppers of GSL allocate memory, and end the program if the allocation fails. Therefore tribo first allocates and
 * frees the same amount, and returns TRIBO_ERR_MEMORY if the allocation fails. GSL can still end the program if another thread
 * takes the memory in between, or if the operating system grants memory that does not exist (overcommit).
 * This library is BSD-3-Clause; GSL is under the GPL, and so is a program that links both.
 * All functions: since 1.0, unless stated otherwise.
 */
#ifndef TRIBO_TRIBO_GSL_H
#define TRIBO_TRIBO_GSL_H

#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_spmatrix.h>

#include "tribo/tribo_dynamics.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Set the matrices of a model from GSL's, in any sparse format. Symmetric matrices need both triangles.
 * m, c, k  [ndof][ndof] in
 * j        [ncontact][ndof] in
 * Return what tribo_model_set_mass_csr returns, and TRIBO_ERR_SIZE if the matrix has another size. */
TRIBO_API int tribo_gsl_model_set_mass(tribo_model *model, const gsl_spmatrix *m);
TRIBO_API int tribo_gsl_model_set_damping(tribo_model *model, const gsl_spmatrix *c);
TRIBO_API int tribo_gsl_model_set_stiffness(tribo_model *model, const gsl_spmatrix *k);
TRIBO_API int tribo_gsl_model_set_direction(tribo_model *model, const gsl_spmatrix *j);

/* Creates a driver with adaptive steps by a stepper of GSL, see tribo_driver_create.
 * stepper   in   a name, upper or lower case. Explicit, steps are short while contacts rest: "rk2", "rk4", "rkf45", "rkck",
 *                "rk8pd", "msadams". Implicit, with dense matrices of the whole state: "rk1imp", "rk2imp", "rk4imp", "bsimp",
 *                "msbdf"
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NAME, TRIBO_ERR_MEMORY, TRIBO_ERR_UNSUPPORTED; details by tribo_system_message. */
TRIBO_API int tribo_gsl_driver_create(tribo_driver **drv, tribo_system *sys, const char *stepper);

/* Names of the steppers, 0 to tribo_gsl_stepper_count() - 1; NULL outside. */
TRIBO_API int tribo_gsl_stepper_count(void);
TRIBO_API const char *tribo_gsl_stepper_name(int stepper);

/* The system, with Jacobian, for a GSL driver of the caller. Owned by sys; for one driver at a time. NULL if sys is NULL or out
 * of memory. */
TRIBO_API const gsl_odeiv2_system *tribo_gsl_system(tribo_system *sys);

#ifdef __cplusplus
}
#endif

#endif
