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

/* The same from sparse matrices (any GSL format; ones that hold only one triangle of a symmetric matrix must be completed first).
 * Without reduction a mass matrix that is not diagonal makes the system dense. With more than 3000 degrees of freedom the
 * matrices stay sparse, damping must be symmetric, and the system has no accelerations: driver moreau/fixed takes it through
 * time, with a sparse factor (CHOLMOD) of M + dt/2 C + dt^2/4 K, and whatever needs accelerations is TRIBO_ERR_UNSUPPORTED: other
 * drivers, tribo_system_contacts, tribo_system_accept, tribo_system_odeiv2.
 *
 * From 200 degrees of freedom on, of which at most a quarter are modes wanted, the modes come from Lanczos' method and sparse
 * factors (CHOLMOD; a library built without it refuses more than 3000 degrees of freedom, TRIBO_ERR_UNSUPPORTED). Repeated
 * frequencies and rigid-body motions are found as often as there are: the modes below a frequency are counted by the signs of a
 * factor's pivots, and each is checked by its residual; what does not pass is TRIBO_ERR_NO_CONVERGENCE. A library with CHOLMOD
 * also reduces structures with a mass matrix that is only semidefinite, if the stiffness holds what has no mass, to the modes
 * that there are; of an indefinite one with more than 3000 rows it sees what the minors of two rows show.
 *
 * CHOLMOD's factors may start threads of OpenMP, up to four, unless the environment has OMP_THREAD_LIMIT=1: with such threads, a
 * child process made by fork() after a factor may wait forever in a call that makes another factor, and OpenMP ends the program
 * if no thread can be started.
 * Returns what tribo_system_linear does. */
TRIBO_API int tribo_system_linear_sparse(tribo_system **sys, const gsl_spmatrix *mass, const gsl_spmatrix *damping,
                                         const gsl_spmatrix *stiffness, const gsl_spmatrix *direction, size_t nmode,
                                         char *message, size_t size);

/* A structure reduced to its lowest nmode modes, as by tribo_system_linear_sparse, and to what steady forces at its contacts do
 * beside them: of the displacements that contacts make, modes alone leave out much. static_contacts:
 *   TRIBO_STATICS_NONE        nothing beside the modes
 *   TRIBO_STATICS_MASS        motions, orthonormal in M and orthogonal in K as the modes: ndof is nmode and at most one more a
 *                             contact. Their frequencies may be far above those of the modes. Responses to a load are had in the
 *                             same way, from a row of direction that is the load, as a contact whose limit stays 0
 *   TRIBO_STATICS_COMPLIANCE  contacts are elastic (see tribo_system_linear), with the flexibility G that the modes leave them as
 *                             shared compliance, and rigid where that is none: z = J Phi q + G f + g(t), with g what loads do
 *                             beside the modes. State: q, then w = z - g of the elastic contacts, without mass; g'(t) counts in
 *                             their velocities. No frequency is above those of the structure. G must be positive definite:
 *                             repeated contacts are refused, and so are loads by tables. tribo_system_expand lacks what loads do
 *                             beside the modes
 * nmode > 0. Returns what tribo_system_linear does, and TRIBO_ERR_RANGE (static_contacts). */
TRIBO_API int tribo_system_reduced(tribo_system **sys, const gsl_spmatrix *mass, const gsl_spmatrix *stiffness,
                                   const gsl_spmatrix *direction, size_t nmode, int static_contacts, char *message, size_t size);

/* The system for anyone's own GSL driver, with Jacobian; borrowed. Use one driver at a time. */
TRIBO_API const gsl_odeiv2_system *tribo_system_odeiv2(tribo_system *sys);

#ifdef __cplusplus
}
#endif

#endif
