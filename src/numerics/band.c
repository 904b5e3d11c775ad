/* SPDX-License-Identifier: BSD-3-Clause */
#include "band.h"
#include "lapack.h"

#include <math.h>
#include <string.h>

size_t tribo_band_factorize(const struct matrix *a, size_t width, const signed char *held, double *l)
{
    for (size_t i = 0; i < a->rows; i++) {
        const int holds = held && held[i];
        double *own = l + i * (width + 1) + width - i; /* own[j] = l_ij */
        memset(l + i * (width + 1), 0, (width + 1) * sizeof *l);
        for (size_t k = a->first[i]; k < a->first[i + 1] && a->col[k] <= i; k++) {
            own[a->col[k]] = holds || (held && held[a->col[k]]) ? 0.0 : a->val[k];
        }
        double pivot = holds ? 1.0 : own[i];
        for (size_t j = i > width ? i - width : 0; !holds && j < i; j++) {
            const double *other = l + j * (width + 1) + width - j;
            double x = own[j];
            for (size_t k = i > width ? i - width : 0; k < j; k++) {
                x -= own[k] * other[k];
            }
            own[j] = x / other[j];
            pivot -= own[j] * own[j];
        }
        if (!(pivot > 0.0)) {
            return i;
        }
        own[i] = sqrt(pivot);
    }
    return a->rows;
}

/* LAPACK's upper band, by columns, is L by rows. */
void tribo_band_solve(size_t n, size_t width, const double *l, double *x)
{
    const int rows = (int)n, below = (int)width, stride = below + 1, one = 1;
    for (size_t i = 0; !width && i < n; i++) {
        x[i] = x[i] / l[i] / l[i];
    }
    if (width) {
        dtbsv_("U", "T", "N", &rows, &below, l, &stride, x, &one, 1, 1, 1);
        dtbsv_("U", "N", "N", &rows, &below, l, &stride, x, &one, 1, 1, 1);
    }
}
