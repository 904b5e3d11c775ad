#ifndef EXAMPLES_MATRIX_MARKET_H
#define EXAMPLES_MATRIX_MARKET_H

#include <stddef.h>

#include <gsl/gsl_spmatrix.h>

/* Reads a matrix of that many rows and columns from a Matrix Market file ("matrix coordinate", real or integer, symmetric or
 * general), with both triangles whatever the file holds. Takes no more memory than the file's entries need, whatever its head
 * announces. Ends the program, naming file, line and value, if the file is not what it should be.
 * Expects that GSL's error handler is off. */
gsl_spmatrix *read_matrix(const char *path, size_t rows);

#endif
