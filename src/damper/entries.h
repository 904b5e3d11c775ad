/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_ENTRIES_H
#define DAMPER_ENTRIES_H

#include <stddef.h>

#include "lines.h"

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

/* Entries of a matrix as a file has them. */
struct entry {
    size_t row, column, line; /* row and column counted from 1 */
    double value;
};

struct entries {
    size_t count, room;
    struct entry *entry;
};

/* Reads the rest of the line: "row column value". */
struct entry read_entry(struct lines *l, const struct rows *rows);

void add_entry(struct entries *all, const struct entry *e);

/* Sorts the entries, and makes a matrix of those that are not zero, in compressed rows; of symmetric ones, which lie in the lower
 * triangle, also the upper triangle. Ends the program if a place has been given twice in the file of that path. */
struct sparse make_matrix(const char *path, struct entries *all, size_t rows, int symmetric);

#endif
