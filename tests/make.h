/* SPDX-License-Identifier: BSD-3-Clause */
/* Systems in one call, for tests. */
#ifndef TRIBO_TESTS_MAKE_H
#define TRIBO_TESTS_MAKE_H

#include "tribo/tribo_gsl.h"

/* The system of a model with dense matrices (damping may be NULL), nmode > 0: reduced to as many modes. message [size] or NULL:
 * the model's message if a call fails. Returns the status of the call that failed first. */
int dense_system(tribo_system **sys, size_t ndof, size_t ncontact, const double *mass, const double *damping,
                 const double *stiffness, const double *direction, size_t nmode, char *message, size_t size);

/* The same of GSL's sparse matrices; and reduced with static_contacts. */
int sparse_system(tribo_system **sys, const gsl_spmatrix *mass, const gsl_spmatrix *damping, const gsl_spmatrix *stiffness,
                  const gsl_spmatrix *direction, size_t nmode, char *message, size_t size);
int reduced_system(tribo_system **sys, const gsl_spmatrix *mass, const gsl_spmatrix *stiffness, const gsl_spmatrix *direction,
                   size_t nmode, int static_contacts, char *message, size_t size);

#endif
