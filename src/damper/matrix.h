/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_MATRIX_H
#define DAMPER_MATRIX_H

#include <stddef.h>

/* How many rows and columns a matrix has, by the degrees of freedom in the file of that path. */
struct rows {
    size_t count;
    const char *path;
};

/* A square matrix in compressed rows, counted from 0. */
struct sparse {
    size_t rows, *first, *col; /* [rows + 1], [first[rows]] */
    double *val;
};
void free_sparse(struct sparse *m);

/* Reads a matrix of that many rows and columns, with both triangles whatever the file holds: a Matrix Market file ("matrix
 * coordinate", real or integer, symmetric or general); or name.sti or name.mas, which CalculiX writes for *FREQUENCY,
 * SOLVER=MATRIXSTORAGE: lines "row column value" without a head, each pair of rows once, and all of the diagonal. Each may be
 * compressed (.gz). Memory is in proportion to the file's entries, whatever its head announces. Ends the program, naming file,
 * line and value, if anything is wrong. */
struct sparse read_matrix(const char *path, const struct rows *rows);

#endif
