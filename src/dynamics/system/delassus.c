/* SPDX-License-Identifier: BSD-3-Clause */
#include "delassus.h"
#include "numerics/constraint.h"
#include "numerics/lapack.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rows of J solved at a time: one pass through the factor serves BATCH rows. */
enum { BATCH = 16 };

int tribo_delassus_by_columns(const struct matrix *j, delassus_solve *solve, const void *a, double *r, double *own)
{
    const size_t n = j->cols, c = j->rows;
    double *x = malloc(BATCH * n * sizeof *x);
    int done = x != NULL;
    memset(r, 0, c * c * sizeof *r);
    for (size_t first = 0; done && first < c; first += BATCH) {
        const size_t count = c - first < BATCH ? c - first : BATCH;
        for (size_t i = 0; i < count; i++) {
            tribo_matrix_get_row(j, first + i, x + i * n);
        }
        done = solve(a, count, x);
        for (size_t i = 0; done && i < count; i++) {
            tribo_matrix_multiply_add(j, 1.0, x + i * n, r + (first + i) * c);
            for (size_t k = j->first[first + i]; k < j->first[first + i + 1]; k++) {
                own[k] = x[i * n + j->col[k]];
            }
        }
    }
    free(x);
    return done;
}

/* ------------------------------------------------------------------------------------------------------------ hidden bodies */

/* A contact between a light body m and a heavy body M has the entry 1/m + 1/M of R; rounding hides 1/M. If other contacts hold
 * the light body, a pivot of R is as small as m/M although the rows of J are independent. */

/* For pivots up to SMALL, rounding of R changes the motion of a body by more than 1e-7 of the motion. */
#define SMALL (DBL_EPSILON / 1e-7)

/* If the shares J^2/m of every contact have smaller ratios, small pivots have another cause. */
#define APART 1e3

int tribo_hidden(const struct matrix *direction, const struct matrix *mass, const double *own, const double *r,
                 struct hidden *where)
{
    const size_t n = direction->rows;
    where->spread = 1.0;
    for (size_t i = 0; i < n; i++) {
        /* spread = ratio of the largest to the smallest share J^2/m in R_ii */
        double least = HUGE_VAL, most = 0.0;
        for (size_t k = direction->first[i]; k < direction->first[i + 1]; k++) {
            const double share = fabs(product(direction->val[k], own[k]));
            if (share > 0.0) {
                least = lesser(least, share);
                most = greater(most, share);
            }
        }
        const double spread = most > 0.0 ? quotient(most, least) : 1.0;
        if (spread > where->spread) {
            *where = (struct hidden){i, spread};
        }
    }
    if (where->spread < APART) {
        return 0;
    }
    double *work = malloc((n + 2) * n * sizeof *work);
    const int rows = (int)n;
    const double small = SMALL;
    int hidden = -1, pivots = 0, info = 0, *order = malloc(n * sizeof *order);
    const size_t rank = tribo_constraints_rank(direction, mass);
    if (work && order && rank <= n && tribo_lapack_takes(n)) {
        memcpy(work, r, n * n * sizeof *work);
        for (size_t i = 0; i < n; i++) { /* scales R to a diagonal of 1 */
            const double root = sqrt(greater(work[i * n + i], DBL_MIN));
            for (size_t k = 0; k < n; k++) {
                work[i * n + k] /= root;
                work[k * n + i] /= root;
            }
        }
        /* pivots: the number of pivots > SMALL, largest pivot first */
        dpstrf_("U", &rows, work, &rows, order, &pivots, &small, work + n * n, &info, 1);
        hidden = (size_t)pivots < rank;
    }
    free(work);
    free(order);
    return hidden;
}
