/* Singular values by one-sided Jacobi rotations (Hestenes 1958), which know the small ones to rounding of the matrix: rows of A^T
 * are turned into each other until they are orthogonal. */
#include "least_norm.h"
#include "linalg.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_SWEEPS 60

static void rotate(double *x, double *y, size_t n, double c, double s)
{
    for (size_t i = 0; i < n; i++) {
        const double old = x[i];
        x[i] = c * old - s * y[i];
        y[i] = s * old + c * y[i];
    }
}

/* Makes two rows orthogonal, and turns those of v likewise; 1 if they were not. */
static int least_norm_separate(double *a, double *v, size_t n, size_t p, size_t q)
{
    double *x = a + p * n, *y = a + q * n;
    const double xx = tribo_dot(x, x, n), yy = tribo_dot(y, y, n), xy = tribo_dot(x, y, n);
    if (fabs(xy) <= DBL_EPSILON * sqrt(xx) * sqrt(yy) || xy == 0.0) {
        return 0;
    }
    const double z = (yy - xx) / (2.0 * xy), t = copysign(1.0, z) / (fabs(z) + hypot(1.0, z)), c = 1.0 / hypot(1.0, t);
    rotate(x, y, n, c, c * t);
    rotate(v + p * n, v + q * n, n, c, c * t);
    return 1;
}

int tribo_least_norm_solve(double *a, size_t n, double cut, double *x, size_t *kernel)
{
    double *v = calloc(2 * n * n + n + 1, sizeof *v);
    size_t zeros = 0;
    if (!v) {
        return 0;
    }
    double *columns = v + n * n, *right = columns + n * n;
    tribo_transpose(n, n, a, columns);
    memcpy(right, x, n * sizeof *x);
    memset(x, 0, n * sizeof *x);
    for (size_t i = 0; i < n; i++) {
        v[i * n + i] = 1.0;
    }
    /* Rows of a become A v_k, rows of v the orthonormal v_k; a is A^T before. */
    size_t turned = 1;
    for (int sweep = 0; turned && sweep < MOST_SWEEPS; sweep++) {
        turned = 0;
        for (size_t p = 0; p < n; p++) {
            for (size_t q = p + 1; q < n; q++) {
                turned += (size_t)least_norm_separate(columns, v, n, p, q);
            }
        }
    }
    for (size_t k = 0; k < n; k++) {
        const double *row = columns + k * n, square = tribo_dot(row, row, n);
        const int zero = square < cut * cut;
        zeros += (size_t)zero;
        tribo_add(x, zero ? 0.0 : tribo_dot(row, right, n) / square, v + k * n, n);
    }
    free(v);
    if (kernel) {
        *kernel = zeros;
    }
    return 1;
}
