/* The factor of an island whose R is kept as a square block. Rows are appended and deleted in O(rank^2), and contacts that depend
 * on those in the factor wait beside it. A pivot that is small, but not zero to rounding, is not trusted: then everything is
 * factorized anew with the largest pivots first, which is where the rank is decided.
 *
 * Row k of l holds l_k0, ... l_k,k-1 and 1/l_kk. */
#include "island.h"

#include <math.h>
#include <string.h>

static double scaled(const struct program *p, size_t i, size_t j)
{
    return p->scale[i] * p->r[i * p->island->size + j] * p->scale[j];
}

/* Four sums side by side, since one would have to be added up in order. */
static double dot(const double *x, const double *y, size_t n)
{
    double sum[4] = {0.0};
    size_t i = 0;
    for (; i + 4 <= n; i += 4) {
        for (size_t k = 0; k < 4; k++) {
            sum[k] += x[i + k] * y[i + k];
        }
    }
    for (; i < n; i++) {
        sum[0] += x[i] * y[i];
    }
    return sum[0] + sum[1] + (sum[2] + sum[3]);
}

/* row [rank] = L^-1 (column of contact i); returns the pivot that i would have. */
static double column(const struct program *p, size_t i, double *row)
{
    const size_t rank = p->island->rank, size = p->island->size;
    double pivot = scaled(p, i, i);
    for (size_t k = 0; k < rank; k++) {
        const double *l = p->l + k * size;
        row[k] = (scaled(p, i, p->order[k]) - dot(l, row, k)) * l[k];
        pivot -= row[k] * row[k];
    }
    return pivot;
}

/* Appends i to the independent contacts or to the dependents. Returns 0 if it is not clear which. */
static int append(struct program *p, size_t i)
{
    struct island *is = p->island;
    double *row = p->l + is->rank * is->size;
    const double pivot = column(p, i, row), relative = pivot / scaled(p, i, i);
    p->order[is->rank + is->dependents] = i;
    if (relative <= tribo_resolution(is->rank + 1)) {
        is->dependents++;
    } else if (relative <= TRIBO_DOUBTFUL) {
        return 0;
    } else {
        row[is->rank] = 1.0 / sqrt(pivot);
        /* the first dependent makes room at the end of the independent ones */
        p->order[is->rank + is->dependents] = p->order[is->rank];
        p->order[is->rank++] = i;
    }
    return 1;
}

void tribo_dense_add(struct program *p, size_t i)
{
    if (!append(p, i)) {
        tribo_factor_rebuild(p, NULL);
    }
}

/* Row at leaves the factor: the rows below move up, their diagonal to the right of the new one, and rotations of neighbouring
 * columns make the matrix triangular again. */
static void take_out(struct program *p, size_t at)
{
    struct island *is = p->island;
    const size_t size = is->size;
    is->rank--;
    for (size_t k = at; k < is->rank; k++) {
        memcpy(p->l + k * size, p->l + (k + 1) * size, (k + 2) * sizeof *p->l);
    }
    for (size_t k = at; k < is->rank; k++) {
        double *l = p->l + k * size;
        const double a = l[k], b = 1.0 / l[k + 1], length = sqrt(a * a + b * b), c = a / length, s = b / length;
        l[k] = 1.0 / length;
        for (size_t below = k + 1; below < is->rank; below++) {
            double *m = p->l + below * size;
            const double x = m[k], y = m[k + 1];
            m[k] = c * x + s * y;
            m[k + 1] = c * y - s * x;
        }
    }
}

void tribo_dense_remove(struct program *p, size_t i)
{
    struct island *is = p->island;
    const size_t all = is->rank + is->dependents;
    size_t at = 0;
    while (p->order[at] != i) {
        at++;
    }
    memmove(p->order + at, p->order + at + 1, (all - at - 1) * sizeof *p->order);
    if (at >= is->rank) {
        is->dependents--;
        return;
    }
    take_out(p, at);
    /* what depended on the one that left may be independent now */
    const size_t waiting = is->dependents;
    is->dependents = 0;
    for (size_t d = 0; d < waiting; d++) {
        if (!append(p, p->order[is->rank + is->dependents])) {
            tribo_factor_rebuild(p, NULL);
            return;
        }
    }
}

/* Symmetric exchange of rows and columns k and other > k in the lower triangle, columns before k included. */
static void exchange(struct program *p, size_t all, size_t k, size_t other)
{
    const size_t size = p->island->size, order = p->order[k];
    p->order[k] = p->order[other];
    p->order[other] = order;
    for (size_t j = 0; j < all; j++) {
        if (j != k && j != other) {
            double *a = j < k ? &p->l[k * size + j] : &p->l[j * size + k];
            double *b = j < other ? &p->l[other * size + j] : &p->l[j * size + other];
            const double x = *a;
            *a = *b;
            *b = x;
        }
    }
    const double x = p->l[k * size + k];
    p->l[k * size + k] = p->l[other * size + other];
    p->l[other * size + other] = x;
}

/* What elimination has left of the rows from k on. */
static double leftover(const struct program *p, size_t k, size_t all, size_t *where)
{
    const size_t size = p->island->size;
    double most = 0.0;
    for (size_t i = k; i < all; i++) {
        for (size_t j = k; j <= i; j++) {
            const double x = p->l[i * size + j];
            if (fabs(x) > fabs(most)) {
                most = i == j ? x : -fabs(x);
                *where = p->order[i];
            }
        }
    }
    return most;
}

/* Cholesky factorization with the largest pivot next, so that the rank is revealed. */
double tribo_dense_rebuild(struct program *p, size_t *where)
{
    struct island *is = p->island;
    const size_t size = is->size;
    size_t all = 0, k = 0;
    for (size_t e = 0; e < p->count; e++) {
        if (p->at[p->near[e]] == FREE) {
            p->order[all++] = p->near[e];
        }
    }
    for (size_t i = 0; i < all; i++) {
        for (size_t j = 0; j <= i; j++) {
            p->l[i * size + j] = scaled(p, p->order[i], p->order[j]);
        }
    }
    for (; k < all; k++) {
        size_t best = k;
        for (size_t i = k + 1; i < all; i++) {
            best = p->l[i * size + i] > p->l[best * size + best] ? i : best;
        }
        if (p->l[best * size + best] <= tribo_resolution(all)) {
            break;
        }
        if (best != k) {
            exchange(p, all, k, best);
        }
        const double inverse = 1.0 / sqrt(p->l[k * size + k]);
        p->l[k * size + k] = inverse;
        for (size_t i = k + 1; i < all; i++) {
            p->l[i * size + k] *= inverse;
        }
        for (size_t i = k + 1; i < all; i++) {
            const double x = p->l[i * size + k];
            for (size_t j = k + 1; x != 0.0 && j <= i; j++) {
                p->l[i * size + j] -= x * p->l[j * size + k];
            }
        }
    }
    is->rank = k;
    is->dependents = all - k;
    return where ? leftover(p, k, all, where) : 0.0;
}

void tribo_dense_solve(const struct program *p, double *step)
{
    const size_t rank = p->island->rank, size = p->island->size;
    double *y = p->row;
    for (size_t i = 0; i < rank; i++) {
        const double *l = p->l + i * size;
        y[i] = (p->scale[p->order[i]] * step[p->order[i]] - dot(l, y, i)) * l[i];
    }
    for (size_t i = rank; i-- > 0;) {
        const double *l = p->l + i * size, x = y[i] * l[i];
        for (size_t j = 0; j < i; j++) {
            y[j] -= l[j] * x;
        }
        step[p->order[i]] = p->scale[p->order[i]] * x;
        y[i] = 0.0;
    }
}
