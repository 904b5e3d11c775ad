/* SPDX-License-Identifier: BSD-3-Clause */
#include "matrix_file.h"

#include <stdlib.h>

#include "calculix.h"
#include "matrix_market.h"

struct sparse read_matrix(const char *path, const struct rows *rows)
{
    struct entries all = {0, 0, NULL};
    int symmetric = 1;
    if (is_named(path, ".sti") || is_named(path, ".mas")) {
        read_calculix_matrix(path, rows, &all);
    } else {
        symmetric = read_matrix_market(path, rows, &all);
    }
    const struct sparse matrix = make_matrix(path, &all, rows->count, symmetric);
    free(all.entry);
    return matrix;
}
