/* Dense groups of at most SMALL contacts, R far from singular. */
#include "small.h"

#include <string.h>

#define LEAST_PIVOT 0.01

void tribo_small_invert(size_t n, const double *r, unsigned set, double *inverse)
{
    memset(inverse, 0, n * n * sizeof *inverse);
    for (size_t i = 0; i < n; i++) {
        double z[SMALL] = {0.0}, pivot = 0.0;
        z[i] = 1.0;
        for (size_t k = 0; k < i; k++) {
            for (size_t l = 0; l < i; l++) {
                z[k] -= inverse[k * n + l] * r[l * n + i];
            }
        }
        for (size_t k = 0; k <= i; k++) {
            pivot += r[i * n + k] * z[k];
        }
        for (size_t k = 0; (set >> i & 1u) && k <= i; k++) {
            for (size_t l = 0; l <= i; l++) {
                inverse[k * n + l] += z[k] * z[l] / pivot;
            }
        }
    }
}

int tribo_small_fits(size_t n, const double *r, double *inverse)
{
    int fits = n <= SMALL;
    for (size_t i = 0; fits && i < n; i++) {
        fits = r[i * (n + 1)] >= 1.0 / TRIBO_SMALL_MOST && r[i * (n + 1)] <= TRIBO_SMALL_MOST;
    }
    if (fits) {
        tribo_small_invert(n, r, (1u << n) - 1, inverse);
    }
    for (size_t i = 0; fits && i < n; i++) {
        fits = inverse[i * (n + 1)] > 0.0 && LEAST_PIVOT * inverse[i * (n + 1)] * r[i * (n + 1)] < 1.0;
    }
    memset(inverse, 0, n * n * sizeof *inverse);
    return fits;
}

int tribo_box_small(struct box_qp *p)
{
    const size_t n = p->group->size;
    const struct small s = {p->r, p->inverse, &p->sets->inverse_of, p->rounding.part, p->rounding.least, p->q,
                            p->lo, p->hi, p->to, p->x, p->gradient, p->noise};
    double most = 0.0;
    for (size_t e = 0; e < n; e++) {
        const size_t i = p->near[e];
        if (e < p->count) {
            most = greater(most, greater(fabs(p->q[i]), greater(fabs(p->lo[i]), fabs(p->hi[i]))));
            p->to[i] = !(p->lo[i] < p->hi[i]) ? AT_LOWER : p->at[i] == AWAY ? FREE : p->at[i];
        } else {
            most = greater(most, fabs(p->x[i]));
            p->to[i] = AWAY;
            p->q[i] = 0.0;
        }
    }
    const int done = most <= TRIBO_SMALL_MOST && (n == 2   ? tribo_small_solve(2, &s)
                                                  : n == 3 ? tribo_small_solve(3, &s)
                                                           : tribo_small_solve(4, &s));
    if (done) {
        p->sets->far = 0;
        p->twofold = 0;
        if (memcmp(p->to, p->at, n) != 0) {
            tribo_box_change_all(p);
        }
    }
    return done;
}
