#include "delassus.h"

#include <stdlib.h>
#include <string.h>

/* Rows of J solved at a time: one pass through the factor serves BATCH rows. */
enum { BATCH = 16 };

void tribo_delassus_put_row(const struct matrix *j, size_t i, double *x)
{
    memset(x, 0, j->cols * sizeof *x);
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        x[j->col[k]] = j->val[k];
    }
}

void tribo_delassus_note_own(const struct matrix *j, size_t i, const double *x, double *own)
{
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        own[k] = x[j->col[k]];
    }
}

int tribo_delassus_by_columns(const struct matrix *j, delassus_solve *solve, const void *a, double *x, double *r, double *own)
{
    const size_t n = j->cols, c = j->rows;
    double *room = x ? NULL : malloc(BATCH * n * sizeof *room);
    int done = x || room;
    memset(r, 0, c * c * sizeof *r);
    for (size_t first = 0; done && first < c; first += BATCH) {
        const size_t count = c - first < BATCH ? c - first : BATCH;
        double *some = x ? x + first * n : room;
        for (size_t i = 0; i < count; i++) {
            tribo_delassus_put_row(j, first + i, some + i * n);
        }
        done = solve(a, count, some);
        for (size_t i = 0; done && i < count; i++) {
            tribo_matrix_multiply_add(j, 1.0, some + i * n, r + (first + i) * c);
            tribo_delassus_note_own(j, first + i, some + i * n, own);
        }
    }
    free(room);
    return done;
}
