#include "eigen.h"
#include "lapack.h"
#include "linalg.h"

#include <stdlib.h>

#include "tribo/tribo.h"

int tribo_eigen(double *a, size_t n, double *re, double *im, double *x)
{
    if (n == 0 || !tribo_dense_finite(a, n * n)) {
        return n ? TRIBO_ERR_NOT_FINITE : TRIBO_OK;
    }
    enum { BLOCK = 32 };
    const int rows = (int)n, one = 1, size = (4 + BLOCK) * rows;
    double *work = tribo_lapack_takes(n) ? malloc((size_t)size * sizeof *work) : NULL;
    int info;
    if (!work) {
        return TRIBO_ERR_MEMORY;
    }
    /* Left eigenvectors of the transpose are the conjugates of the right ones of A. */
    dgeev_("V", "N", &rows, a, &rows, re, im, x, &rows, NULL, &one, work, &size, &info, 1, 1);
    free(work);
    for (size_t k = 0; info == 0 && k < n; k++) {
        for (size_t i = 0; im[k] < 0.0 && i < n; i++) {
            x[k * n + i] = -x[k * n + i];
        }
    }
    return info ? TRIBO_ERR_NO_CONVERGENCE : TRIBO_OK;
}
