#include "band.h"

#include <math.h>
#include <string.h>

/* Returns the first column of row i. */
static size_t begin_of(size_t width, size_t i)
{
    return i > width ? i - width : 0;
}

void tribo_band_add(double *band, size_t width, const struct matrix *a, double factor, const double *row)
{
    for (size_t i = 0; i < a->rows; i++) {
        double *to = band + i * (width + 1) + width - i;
        for (size_t k = a->first[i]; k < a->first[i + 1] && a->col[k] <= i; k++) {
            to[a->col[k]] += factor * (row ? row[i] : 1.0) * a->val[k];
        }
    }
}

size_t tribo_band_factorize(size_t n, size_t width, const double *band, const signed char *held, double *l)
{
    const size_t w = width;
    for (size_t i = 0; i < n; i++) {
        const size_t begin = begin_of(w, i);
        const double *a = band + i * (w + 1);
        double *own = l + i * (w + 1), pivot = held && held[i] ? 1.0 : a[w];
        memset(own, 0, w * sizeof *own);
        for (size_t j = begin; j < i && !(held && held[i]); j++) {
            const double *other = l + j * (w + 1);
            double x = held && held[j] ? 0.0 : a[j + w - i];
            for (size_t k = begin; k < j; k++) {
                x -= own[k + w - i] * other[k + w - j];
            }
            own[j + w - i] = x;
        }
        for (size_t j = begin; j < i; j++) {
            const double x = own[j + w - i];
            own[j + w - i] = x / l[j * (w + 1) + w];
            pivot -= x * own[j + w - i];
        }
        own[w] = pivot;
        if (!(pivot > 0.0)) {
            return i;
        }
    }
    return n;
}

/* x = L^-1 x. */
static void forward(size_t n, size_t width, const double *l, double *x)
{
    for (size_t i = 0; i < n; i++) {
        const double *row = l + i * (width + 1) + width - i;
        double rest = x[i];
        for (size_t j = begin_of(width, i); j < i; j++) {
            rest -= row[j] * x[j];
        }
        x[i] = rest;
    }
}

/* x = L'^-1 x. */
static void back(size_t n, size_t width, const double *l, double *x)
{
    for (size_t i = n; i-- > 0;) {
        const double *row = l + i * (width + 1) + width - i, own = x[i];
        for (size_t j = begin_of(width, i); j < i; j++) {
            x[j] -= row[j] * own;
        }
    }
}

void tribo_band_solve(size_t n, size_t width, const double *l, double *x)
{
    forward(n, width, l, x);
    for (size_t i = 0; i < n; i++) {
        x[i] /= l[i * (width + 1) + width];
    }
    back(n, width, l, x);
}

static void band_divide_by_root(size_t n, size_t width, const double *l, double *x)
{
    for (size_t i = 0; i < n; i++) {
        x[i] /= sqrt(l[i * (width + 1) + width]);
    }
}

void tribo_band_half_solve(size_t n, size_t width, const double *l, double *x)
{
    forward(n, width, l, x);
    band_divide_by_root(n, width, l, x);
}

void tribo_band_half_solve_back(size_t n, size_t width, const double *l, double *x)
{
    band_divide_by_root(n, width, l, x);
    back(n, width, l, x);
}
