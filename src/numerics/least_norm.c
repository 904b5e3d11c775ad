#include "least_norm.h"
#include "lapack.h"
#include "linalg.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int tribo_least_norm_solve(double *a, size_t n, double cut, double *x, size_t *kernel)
{
    const int rows = (int)n, size = 6 * rows + 1;
    double *v = tribo_lapack_takes(n) ? malloc((n * n + 8 * n + 1) * sizeof *v) : NULL, unused;
    int info = 1, one = 1;
    size_t zeros = 0;
    if (!v) {
        return 0;
    }
    double *value = v + n * n, *right = value + n, *work = right + n;
    memcpy(right, x, n * sizeof *x);
    /* By columns a is A' = sum_k value_k u_k v_k': u_k replaces row k of a, and v [n][n] has v_k in column k. */
    if (n && tribo_dense_finite(a, n * n)) {
        dgesvd_("O", "A", &rows, &rows, a, &rows, value, &unused, &one, v, &rows, work, &size, &info, 1, 1);
    }
    for (size_t i = 0; i < n; i++) {
        x[i] = info ? (double)NAN : 0.0;
    }
    for (size_t k = 0; !info && k < n; k++) {
        double part = 0.0;
        for (size_t i = 0; i < n; i++) {
            part += v[i * n + k] * right[i];
        }
        zeros += value[k] < cut;
        tribo_add(x, value[k] < cut ? 0.0 : part / value[k], a + k * n, n);
    }
    free(v);
    if (kernel) {
        *kernel = zeros;
    }
    return 1;
}
