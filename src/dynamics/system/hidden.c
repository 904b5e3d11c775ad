/* A contact between a light body m and a heavy body M gives the entry 1/m + 1/M of R, in which rounding hides 1/M. Where other
 * contacts hold the light body, a pivot of R is as small as m/M, though the rows of J are independent. */
#include "numerics/constraint.h"
#include "hidden.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A smaller pivot: rounding of R changes the motion of a body by more than 1e-7 of it. */
#define SMALL (DBL_EPSILON / 1e-7)

/* With a smaller ratio of the shares J^2/m of a contact, small pivots have another cause. */
#define APART 1e3

/* How many pivots of the Cholesky factorization of r, with the largest first and the diagonal scaled to 1, are not small; r is
 * used up. */
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
        /* the last row and column take the place of those that are done */
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
        /* How much more the body that gives way most in contact i does than the one that does least. */
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
