/* SPDX-License-Identifier: BSD-3-Clause */
#include "krylov.h"
#include "linalg.h"

#include <math.h>
#include <string.h>

size_t tribo_gmres_room(size_t n, size_t most)
{
    return (most + 1) * (n + most + 4);
}

/* (a, b) = (c a + s b, c b - s a). */
static void rotate_pair(double c, double s, double *a, double *b)
{
    const double x = *a;
    *a = c * x + s * *b;
    *b = c * *b - s * x;
}

/* Makes v_k orthonormal to v_0 ... v_k-1, v [k + 1][n]: v_k = sum_i h_i v_i before. */
static void orthonormalize(size_t n, size_t k, double *v, double *h)
{
    double *last = v + k * n;
    memset(h, 0, (k + 1) * sizeof *h);
    for (int again = 0; again < 2; again++) {
        for (size_t i = 0; i < k; i++) {
            const double part = tribo_dot(v + i * n, last, n);
            h[i] += part;
            tribo_add(last, -part, v + i * n, n);
        }
    }
    h[k] = sqrt(tribo_dot(last, last, n));
    for (size_t i = 0; i < n && h[k] > 0.0; i++) {
        last[i] /= h[k];
    }
}

int tribo_gmres(size_t n, tribo_product *product, void *data, double tolerance, size_t most, double *x, double *part,
                double *work)
{
    const size_t rows = most + 1;
    double *v = work, *r = v + rows * n, *c = r + rows * rows, *s = c + rows, *rhs = s + rows; /* r by columns */
    const double size = sqrt(tribo_dot(x, x, n));
    size_t count = 0;
    *part = size > 0.0 ? 1.0 : 0.0;
    rhs[0] = size;
    for (size_t i = 0; i < n; i++) {
        v[i] = size > 0.0 ? x[i] / size : 0.0;
    }
    while (*part > tolerance && count < most) {
        double *h = r + count * rows;
        memcpy(v + (count + 1) * n, v + count * n, n * sizeof *v);
        const int status = product(data, v + (count + 1) * n);
        if (status) {
            return status;
        }
        orthonormalize(n, count + 1, v, h);
        for (size_t i = 0; i < count; i++) {
            rotate_pair(c[i], s[i], &h[i], &h[i + 1]);
        }
        const double length = hypot(h[count], h[count + 1]);
        if (!(length > 0.0)) {
            break;
        }
        c[count] = h[count] / length;
        s[count] = h[count + 1] / length;
        h[count] = length;
        rhs[count + 1] = 0.0;
        rotate_pair(c[count], s[count], &rhs[count], &rhs[count + 1]);
        count++;
        *part = fabs(rhs[count]) / size;
    }
    memset(x, 0, n * sizeof *x);
    for (size_t k = count; k-- > 0;) {
        rhs[k] /= r[k * rows + k];
        for (size_t i = 0; i < k; i++) {
            rhs[i] -= r[k * rows + i] * rhs[k];
        }
        tribo_add(x, rhs[k], v + k * n, n);
    }
    return 0;
}
