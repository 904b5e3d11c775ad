/* The finite-element beam of the examples. */
#ifndef TRIBO_TESTS_BEAM_H
#define TRIBO_TESTS_BEAM_H

#include <stdio.h>

#include <gsl/gsl_spmatrix.h>

#define BEAM_DOFS 288

/* "M.mtx" or "K.mtx": a symmetric Matrix Market file of which the lower triangle is stored. */
gsl_spmatrix *beam_matrix(const char *name);

#endif
