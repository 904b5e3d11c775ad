/* SPDX-License-Identifier: BSD-3-Clause */
/* Entries of a sparse matrix in any order, collected one by one. */
#ifndef TRIBO_TRIPLETS_H
#define TRIBO_TRIPLETS_H

#include "matrix.h"

/* Entries value[k] at (row[k], col[k]). */
struct triplets {
    size_t count, room, *row, *col;
    double *value;
    int failed; /* 1: out of memory */
};

/* Appends the entry (i, j), unless v is 0. */
void tribo_triplets_put(struct triplets *t, size_t i, size_t j, double v);

/* Appends row i of a as a part of row `row`. */
void tribo_triplets_put_row(struct triplets *t, size_t row, const struct matrix *a, size_t i);

/* to [rows][cols] = the matrix of the entries; frees t. Returns 1, or 0 if out of memory, also in an earlier call. */
int tribo_triplets_finish(struct triplets *t, size_t rows, size_t cols, struct matrix *to);

#endif
