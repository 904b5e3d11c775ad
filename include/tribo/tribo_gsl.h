/* tribo with GSL: GSL's steppers and types for the systems of tribo_dynamics.h.
 *
 * GSL's error handler is never changed, and what it would object to is refused here first: matrices that are singular, and more
 * memory than there is. GSL allocates for itself in adaptive methods, and ends the program where it gets nothing; what it will ask
 * for is allocated and freed just before, and refused with TRIBO_ERR_MEMORY if there is not so much. That is no help where another
 * thread takes the memory in between, or where the system promises memory that it has not (overcommit).
 * This library is BSD-3-Clause; GSL is under the GPL, and so is what is linked with both.
 * All functions: since 1.0, unless said otherwise.
 */
#ifndef TRIBO_TRIBO_GSL_H
#define TRIBO_TRIBO_GSL_H

#include <gsl/gsl_odeiv2.h>
#include <gsl/gsl_spmatrix.h>

#include "tribo/tribo_dynamics.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Matrices of a model from GSL's, of any sparse format; what holds only one triangle of a symmetric matrix must be completed first.
 * mass, damping, stiffness [ndof][ndof], direction [ncontact][ndof] in.
 * Returns what tribo_model_set_mass_csr does, TRIBO_ERR_SIZE if m is of another size. */
TRIBO_API int tribo_gsl_model_set_mass(tribo_model *model, const gsl_spmatrix *m);
TRIBO_API int tribo_gsl_model_set_damping(tribo_model *model, const gsl_spmatrix *c);
TRIBO_API int tribo_gsl_model_set_stiffness(tribo_model *model, const gsl_spmatrix *k);
TRIBO_API int tribo_gsl_model_set_direction(tribo_model *model, const gsl_spmatrix *j);

/* A driver with adaptive steps that a stepper of GSL tries, see tribo_driver_create.
 * stepper   in   "rk2", "rk4", "rkf45", "rkck", "rk8pd", "msadams" (explicit: they follow the stiffness of contacts at rest);
 *                "rk1imp", "rk2imp", "rk4imp", "bsimp", "msbdf" (implicit: dense matrices of the whole state); in any case of letters
 * Returns TRIBO_ERR_NULL, TRIBO_ERR_NAME, TRIBO_ERR_MEMORY, TRIBO_ERR_UNSUPPORTED; tribo_system_message says more. */
TRIBO_API int tribo_gsl_driver_create(tribo_driver **drv, tribo_system *sys, const char *stepper);

/* Names of the steppers, 0 to tribo_gsl_stepper_count() - 1; NULL outside. */
TRIBO_API int tribo_gsl_stepper_count(void);
TRIBO_API const char *tribo_gsl_stepper_name(int stepper);

/* The system for your own GSL driver, with Jacobian; borrowed, one driver at a time. NULL for NULL, or if out of memory. */
TRIBO_API const gsl_odeiv2_system *tribo_gsl_system(tribo_system *sys);

#ifdef __cplusplus
}
#endif

#endif
