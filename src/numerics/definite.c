/* SPDX-License-Identifier: BSD-3-Clause */
#include "definite.h"
#include "common/layout.h"
#include "common/real.h"
#include "lapack.h"
#include "linalg.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "tribo/tribo.h"

/* A pivot below this part of the diagonal entry is rounding. */
#define ROUNDING (64.0 * DBL_EPSILON)

/* Makes factor that of the rows with skip [n] 0 (all rows: NULL). Returns the place in index of a pivot that is rounding, or
 * held. */
static size_t factor_set(struct definite *d, const signed char *skip)
{
    size_t m = 0;
    int info = 0;
    for (size_t i = 0; i < d->n; i++) {
        if (d->own[i] > 0.0 && (!skip || skip[i] == 0)) {
            d->index[m++] = i;
        }
    }
    d->held = m;
    for (size_t i = 0; i < m; i++) {
        for (size_t j = 0; j <= i; j++) {
            d->factor[i * m + j] = d->matrix[d->index[i] * d->n + d->index[j]];
        }
    }
    const int rows = (int)m;
    if (m > 0) {
        dpotrf_("U", &rows, d->factor, &rows, &info, 1);
    }
    for (size_t i = 0; i < m; i++) {
        const double l = d->factor[i * (m + 1)];
        if (i + 1 == (size_t)info || !(l * l > ROUNDING * d->matrix[d->index[i] * (d->n + 1)])) {
            return i;
        }
    }
    return m;
}

void tribo_definite_solve(struct definite *d, const signed char *skip, size_t columns, double *x)
{
    for (size_t i = 0; !d->matrix && i < d->n; i++) {
        const int in = d->own[i] > 0.0 && (!skip || skip[i] == 0);
        for (size_t k = i * columns; k < (i + 1) * columns; k++) {
            x[k] = in ? x[k] / d->own[i] : 0.0;
        }
    }
    if (!d->matrix) {
        return;
    }
    factor_set(d, skip);
    const struct cholesky factor = {.n = d->held, .factor = d->factor};
    for (size_t k = 0; k < d->held; k++) {
        memmove(x + k * columns, x + d->index[k] * columns, columns * sizeof *x);
    }
    tribo_half_solve(&factor, 0, x, columns);
    tribo_half_solve(&factor, 1, x, columns);
    for (size_t i = d->n, k = d->held; i-- > 0;) {
        if (k > 0 && d->index[k - 1] == i) {
            k--;
            memmove(x + i * columns, x + k * columns, columns * sizeof *x);
        } else {
            memset(x + i * columns, 0, columns * sizeof *x);
        }
    }
}

int tribo_definite_create(struct definite *d, size_t n, const double *own, const double *a, size_t *where)
{
    const size_t square = a ? n * n : 0;
    *d = (struct definite){.n = n};
    d->memory = !a || tribo_lapack_takes(n) ? ALLOCATE(ARRAY(d->own, n), ARRAY(d->matrix, square), ARRAY(d->inverse, square),
                                                       ARRAY(d->factor, square), ARRAY(d->x, n), ARRAY(d->index, n))
                                            : NULL;
    if (!d->memory) {
        return TRIBO_ERR_MEMORY;
    }
    memcpy(d->own, own, n * sizeof *own);
    if (!a) {
        d->matrix = NULL;
        return TRIBO_OK;
    }
    memcpy(d->matrix, a, n * n * sizeof *a);
    const size_t at = factor_set(d, NULL);
    if (at < d->held) {
        *where = d->index[at];
        return TRIBO_ERR_INDEFINITE;
    }
    for (size_t i = 0; i < n; i++) {
        d->inverse[i * n + i] = 1.0;
    }
    tribo_definite_solve(d, NULL, n, d->inverse);
    return TRIBO_OK;
}

void tribo_definite_free(struct definite *d)
{
    free(d->memory);
    *d = (struct definite){0};
}

void tribo_definite_multiply_add(const struct definite *d, size_t columns, const double *x, double *y)
{
    if (d->matrix) {
        tribo_multiply_add(d->n, d->n, columns, 1.0, d->matrix, x, y);
        return;
    }
    for (size_t i = 0; i < d->n; i++) {
        if (d->own[i] > 0.0) {
            tribo_add(y + i * columns, d->own[i], x + i * columns, columns);
        }
    }
}

void tribo_definite_solve_sizes(struct definite *d, double *x)
{
    memcpy(d->x, x, d->n * sizeof *x);
    for (size_t i = 0; i < d->n; i++) {
        x[i] = !d->matrix && d->own[i] > 0.0 ? d->x[i] / d->own[i] : 0.0;
        for (size_t k = 0; d->matrix && k < d->n; k++) {
            x[i] += fabs(d->inverse[i * d->n + k]) * d->x[k];
        }
    }
}
