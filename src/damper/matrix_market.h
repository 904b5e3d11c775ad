/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_MATRIX_MARKET_H
#define DAMPER_MATRIX_MARKET_H

#include "entries.h"

/* Reads the entries of a Matrix Market file that has to have that many rows and columns. Returns 1 if they are those of the lower
 * triangle of a symmetric matrix, 0 if they are all. */
int read_matrix_market(const char *path, const struct rows *rows, struct entries *all);

#endif
