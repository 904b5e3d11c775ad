/* The factor of a group whose R is kept as a square block. Rows are appended and deleted in O(rank^2), and contacts that depend
 * on those in the factor wait beside it. A pivot that is small, but not zero to rounding, is not trusted: then everything is
 * factorized anew with the largest pivots first, which is where the rank is decided.
 *
 * Row k of l holds l_k0, ... l_k,k-1 and 1/l_kk. */
#include "box_qp.h"

#include <math.h>
#include <string.h>

static double dense_entry(const struct box_qp *p, size_t i, size_t j)
{
    return p->scale[i] * p->r[i * p->group->size + j] * p->scale[j];
}

/* Four sums side by side, since one would have to be added up in order. */
static double dense_row_dot(const double *x, const double *y, size_t n)
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
static double dense_column(const struct box_qp *p, size_t i, double *row)
{
    const size_t rank = p->sets->rank, size = p->group->size;
    double pivot = dense_entry(p, i, i);
    for (size_t k = 0; k < rank; k++) {
        const double *l = p->l + k * size;
        row[k] = (dense_entry(p, i, p->order[k]) - dense_row_dot(l, row, k)) * l[k];
        pivot -= row[k] * row[k];
    }
    return pivot;
}

/* Appends i to the independent contacts or to the dependents. Returns 0 if it is not clear which. */
static int dense_append(struct box_qp *p, size_t i)
{
    const struct group *g = p->group;
    double *row = p->l + p->sets->rank * g->size;
    const double pivot = dense_column(p, i, row), relative = pivot / dense_entry(p, i, i);
    p->order[p->sets->rank + p->sets->dependents] = i;
    if (relative <= tribo_resolution(p->sets->rank + 1)) {
        p->sets->dependents++;
    } else if (relative <= TRIBO_DOUBTFUL) {
        return 0;
    } else {
        row[p->sets->rank] = 1.0 / sqrt(pivot);
        /* the first dependent makes room at the end of the independent ones */
        p->order[p->sets->rank + p->sets->dependents] = p->order[p->sets->rank];
        p->order[p->sets->rank++] = i;
    }
    return 1;
}

void tribo_dense_add(struct box_qp *p, size_t i)
{
    if (!dense_append(p, i)) {
        tribo_dense_rebuild(p, NULL);
    }
}

void tribo_dense_remove(struct box_qp *p, size_t i)
{
    const size_t all = p->sets->rank + p->sets->dependents;
    size_t at = 0;
    while (p->order[at] != i) {
        at++;
    }
    memmove(p->order + at, p->order + at + 1, (all - at - 1) * sizeof *p->order);
    if (at >= p->sets->rank) {
        p->sets->dependents--;
        return;
    }
    /* Row at leaves the factor: the rows below move up, their diagonal to the right of the new one, and rotations of neighbouring
     * columns make the matrix triangular again. */
    const struct group *g = p->group;
    const size_t size = g->size;
    p->sets->rank--;
    for (size_t k = at; k < p->sets->rank; k++) {
        memcpy(p->l + k * size, p->l + (k + 1) * size, (k + 2) * sizeof *p->l);
    }
    for (size_t k = at; k < p->sets->rank; k++) {
        double *l = p->l + k * size;
        const double a = l[k], b = 1.0 / l[k + 1], length = sqrt(a * a + b * b), c = a / length, s = b / length;
        l[k] = 1.0 / length;
        for (size_t below = k + 1; below < p->sets->rank; below++) {
            double *m = p->l + below * size;
            const double x = m[k], y = m[k + 1];
            m[k] = c * x + s * y;
            m[k + 1] = c * y - s * x;
        }
    }
    /* what depended on the one that left may be independent now */
    const size_t waiting = p->sets->dependents;
    p->sets->dependents = 0;
    for (size_t d = 0; d < waiting; d++) {
        if (!dense_append(p, p->order[p->sets->rank + p->sets->dependents])) {
            tribo_dense_rebuild(p, NULL);
            return;
        }
    }
}

void tribo_dense_exchange(const struct box_qp *p, double *l, size_t all, size_t k, size_t other)
{
    const size_t size = p->group->size;
    for (size_t j = 0; j < all; j++) {
        if (j != k && j != other) {
            double *a = j < k ? &l[k * size + j] : &l[j * size + k];
            double *b = j < other ? &l[other * size + j] : &l[j * size + other];
            const double x = *a;
            *a = *b;
            *b = x;
        }
    }
    const double x = l[k * size + k];
    l[k * size + k] = l[other * size + other];
    l[other * size + other] = x;
}

double tribo_dense_leftover(const struct box_qp *p, size_t k, size_t all, size_t *where)
{
    const size_t size = p->group->size;
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

size_t tribo_dense_order(struct box_qp *p)
{
    size_t all = 0;
    for (size_t e = 0; e < p->count; e++) {
        if (p->at[p->near[e]] == FREE) {
            p->order[all++] = p->near[e];
        }
    }
    return all;
}

/* Cholesky factorization with the largest pivot next, so that the rank is revealed. */
double tribo_dense_rebuild(struct box_qp *p, size_t *where)
{
    const struct group *g = p->group;
    const size_t size = g->size, all = tribo_dense_order(p);
    size_t k = 0;
    p->work.factorizations++;
    for (size_t i = 0; i < all; i++) {
        for (size_t j = 0; j <= i; j++) {
            p->l[i * size + j] = dense_entry(p, p->order[i], p->order[j]);
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
            tribo_dense_exchange(p, p->l, all, k, best);
            const size_t order = p->order[k];
            p->order[k] = p->order[best];
            p->order[best] = order;
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
    p->sets->rank = k;
    p->sets->dependents = all - k;
    return where ? tribo_dense_leftover(p, k, all, where) : 0.0;
}

void tribo_dense_solve(const struct box_qp *p, double *step)
{
    const size_t rank = p->sets->rank, size = p->group->size;
    double *y = p->row;
    for (size_t i = 0; i < rank; i++) {
        const double *l = p->l + i * size;
        y[i] = (p->scale[p->order[i]] * step[p->order[i]] - dense_row_dot(l, y, i)) * l[i];
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
