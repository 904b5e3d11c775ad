/* SPDX-License-Identifier: BSD-3-Clause */
#include "triplets.h"

#include <stdlib.h>

void tribo_triplets_put(struct triplets *t, size_t i, size_t j, double v)
{
    if (t->count == t->room && !t->failed) {
        const size_t room = 2 * t->room + 64;
        size_t *row = realloc(t->row, room * sizeof *row), *col = row ? realloc(t->col, room * sizeof *col) : NULL;
        double *value = col ? realloc(t->value, room * sizeof *value) : NULL;
        t->row = row ? row : t->row;
        t->col = col ? col : t->col;
        t->value = value ? value : t->value;
        t->room = value ? room : t->room;
        t->failed = !value;
    }
    if (v != 0.0 && !t->failed) {
        t->row[t->count] = i;
        t->col[t->count] = j;
        t->value[t->count++] = v;
    }
}

void tribo_triplets_put_row(struct triplets *t, size_t row, const struct matrix *a, size_t i)
{
    for (size_t e = a->first[i]; e < a->first[i + 1]; e++) {
        tribo_triplets_put(t, row, a->col[e], a->val[e]);
    }
}

int tribo_triplets_finish(struct triplets *t, size_t rows, size_t cols, struct matrix *to)
{
    const int done = !t->failed && tribo_matrix_from_triplets(to, rows, cols, t->count, t->row, t->col, t->value);
    free(t->row);
    free(t->col);
    free(t->value);
    *t = (struct triplets){0};
    return done;
}
