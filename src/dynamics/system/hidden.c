/* A contact between a light body m and a heavy body M has the entry 1/m + 1/M of R; rounding hides 1/M. If other contacts hold
 * the light body, a pivot of R is as small as m/M although the rows of J are independent. */
#include "numerics/constraint.h"
#include "hidden.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* For pivots up to SMALL, rounding of R changes the motion of a body by more than 1e-7 of the motion. */
#define SMALL (DBL_EPSILON / 1e-7)

/* If the shares J^2/m of every contact have smaller ratios, small pivots have another cause. */
#define APART 1e3

/* Returns the number of pivots > SMALL of the Cholesky factorization of r, scaled to a diagonal of 1, largest pivot first.
 * Overwrites r. */
static size_t large_pivots(double *r, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const double root = sqrt(greater(r[i * n + i], DBL_MIN));
        for (size_t k = 0; k < n; k++) {
            r[i * n + k] /= root;
            r[k * n + i] /= root;
        }
    }
    size_t left = n;
    for (; left > 0; left--) {
        size_t best = 0;
        for (size_t i = 1; i < left; i++) {
            best = r[i * n + i] > r[best * n + best] ? i : best;
        }
        const double pivot = r[best * n + best];
        if (pivot <= SMALL) {
            break;
        }
        for (size_t i = 0; i < left; i++) {
            for (size_t k = 0; i != best && k < left; k++) {
                r[i * n + k] -= k != best ? r[i * n + best] / pivot * r[best * n + k] : 0.0;
            }
        }
        /* moves the last row and column to the place of the eliminated ones */
        for (size_t k = 0; k < left; k++) {
            r[best * n + k] = r[(left - 1) * n + k];
        }
        for (size_t k = 0; k < left; k++) {
            r[k * n + best] = r[k * n + left - 1];
        }
    }
    return n - left;
}

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
    double *work = malloc(n * n * sizeof *work);
    const size_t rank = tribo_constraints_rank(direction, mass);
    int hidden = -1;
    if (work && rank <= n) {
        memcpy(work, r, n * n * sizeof *work);
        hidden = large_pivots(work, n) < rank;
    }
    free(work);
    return hidden;
}
