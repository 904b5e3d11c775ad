#ifndef EXAMPLES_MATRIX_MARKET_H
#define EXAMPLES_MATRIX_MARKET_H

#include <stddef.h>

#include <gsl/gsl_spmatrix.h>

/* Reads a square matrix from a Matrix Market file ("matrix coordinate", real or integer, symmetric or general), with both
 * triangles whatever the file holds. Ends the program, naming file and line, if the file is not what it should be.
 * Expects that GSL's error handler is off. */
gsl_spmatrix *read_matrix(const char *path);

#endif
