/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_MATRIX_FILE_H
#define DAMPER_MATRIX_FILE_H

#include <stddef.h>

#include "entries.h"

/* Reads a matrix of that many rows and columns, with both triangles whatever the file holds, into compressed rows: from
 * CalculiX's name.sti or name.mas, or else from a Matrix Market file ("matrix coordinate", real or integer, symmetric or
 * general); each may be compressed (.gz). Takes time and memory in proportion to the file's entries, whatever its head announces.
 * Ends the program, naming file, line and value, if the file has another format. */
struct sparse read_matrix(const char *path, const struct rows *rows);

#endif
