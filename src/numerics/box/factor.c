/* SPDX-License-Identifier: BSD-3-Clause */
/* The factor of R over the free contacts of a group, and rows of R, dense, sparse or graded; and the dense factor.
 *
 * Dense: R is a square block. Rows are appended and deleted in O(rank^2). Dependents wait beside the factor. A pivot that is small,
 * but not zero to rounding, leads to a new factor with the largest pivots first, which decides the rank. Row k of l holds
 * l_k0, ... l_k,k-1 and 1/l_kk. */
#include "box_qp.h"

#include <math.h>
#include <string.h>

#include "common/real.h"
#include "common/simd.h"

/* ---------------------------------------------------------------------------------------------------- the dense factor */

static double dense_entry(const struct box_qp *p, size_t i, size_t j)
{
    return p->scale[i] * p->r[i * p->group->size + j] * p->scale[j];
}

/* Returns x'y: four sums side by side, since one sum waits for itself. */
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

/* Appends i to the independent contacts or to the dependents. Returns 0 if the pivot is doubtful. */
static int dense_append(struct box_qp *p, size_t i)
{
    const size_t rank = p->sets->rank, size = p->group->size;
    const double diagonal = dense_entry(p, i, i);
    double *row = p->l + rank * size, pivot = diagonal;
    for (size_t k = 0; k < rank; k++) {
        const double *l = p->l + k * size;
        row[k] = (dense_entry(p, i, p->order[k]) - dense_row_dot(l, row, k)) * l[k];
        pivot -= row[k] * row[k];
    }
    const double relative = pivot / diagonal;
    p->order[rank + p->sets->dependents] = i;
    if (relative <= tribo_resolution(rank + 1)) {
        p->sets->dependents++;
    } else if (relative <= TRIBO_DOUBTFUL) {
        return 0;
    } else {
        row[rank] = 1.0 / sqrt(pivot);
        /* The first dependent makes room at the end of the independent contacts. */
        p->order[rank + p->sets->dependents] = p->order[rank];
        p->order[p->sets->rank++] = i;
    }
    return 1;
}

static void dense_remove(struct box_qp *p, size_t i)
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
    const size_t size = p->group->size;
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
    /* Dependents of the contact that left may be independent. */
    const size_t waiting = p->sets->dependents;
    p->sets->dependents = 0;
    for (size_t d = 0; d < waiting; d++) {
        if (!dense_append(p, p->order[p->sets->rank + p->sets->dependents])) {
            tribo_dense_rebuild(p, NULL);
            return;
        }
    }
}

size_t tribo_dense_order(struct box_qp *p)
{
    size_t all = 0;
    p->work.factorizations++;
    for (size_t e = 0; e < p->count; e++) {
        if (p->at[p->near[e]] == FREE) {
            p->order[all++] = p->near[e];
        }
    }
    return all;
}

/* Exchanges rows and columns k and other > k of the lower triangle l [all][size], columns before k included. */
static void dense_exchange(double *l, size_t size, size_t all, size_t k, size_t other)
{
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

int tribo_dense_pivot(struct box_qp *p, size_t k, size_t all, double zero)
{
    const size_t size = p->group->size;
    size_t best = k;
    for (size_t i = k + 1; i < all; i++) {
        best = p->l[i * size + i] > p->l[best * size + best] ? i : best;
    }
    if (k == all || p->l[best * size + best] <= zero) {
        return 0;
    }
    if (best != k) {
        dense_exchange(p->l, size, all, k, best);
        if (p->group->graded) {
            dense_exchange(p->low.l, size, all, k, best);
        }
        const size_t i = p->order[k];
        p->order[k] = p->order[best];
        p->order[best] = i;
    }
    return 1;
}

double tribo_dense_end(struct box_qp *p, size_t rank, size_t all, size_t *where)
{
    const size_t size = p->group->size;
    double most = 0.0;
    p->sets->rank = rank;
    p->sets->dependents = all - rank;
    for (size_t i = rank; where && i < all; i++) {
        for (size_t j = rank; j <= i; j++) {
            const double x = p->l[i * size + j];
            if (fabs(x) > fabs(most)) {
                most = i == j ? x : -fabs(x);
                *where = p->order[i];
            }
        }
    }
    return most;
}

/* Cholesky factorization with the largest pivot next. */
double tribo_dense_rebuild(struct box_qp *p, size_t *where)
{
    const size_t size = p->group->size, all = tribo_dense_order(p);
    size_t k = 0;
    for (size_t i = 0; i < all; i++) {
        for (size_t j = 0; j <= i; j++) {
            p->l[i * size + j] = dense_entry(p, p->order[i], p->order[j]);
        }
    }
    for (; tribo_dense_pivot(p, k, all, tribo_resolution(all)); k++) {
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
    return tribo_dense_end(p, k, all, where);
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

/* ---------------------------------------------------------------------------------------------------------- the factor */

void tribo_factor_change(struct box_qp *p, size_t i)
{
    const int enters = p->at[i] == FREE;
    if (p->group->graded) {
        tribo_factor_rebuild(p, NULL);
    } else if (p->group->sparse) {
        (enters ? tribo_sparse_add : tribo_sparse_remove)(p, i);
    } else if (!enters) {
        dense_remove(p, i);
    } else if (!dense_append(p, i)) {
        tribo_dense_rebuild(p, NULL);
    }
}

double tribo_factor_rebuild(struct box_qp *p, size_t *where)
{
    if (p->group->graded) {
        return tribo_graded_rebuild(p, where);
    }
    return p->group->sparse ? tribo_sparse_rebuild(p, where) : tribo_dense_rebuild(p, where);
}

static void factor_solve(const struct box_qp *p, double *step)
{
    if (p->group->graded) {
        tribo_graded_solve(p, step, p->row);
        memset(p->row, 0, p->group->size * sizeof *p->row);
    } else if (p->group->sparse) {
        tribo_sparse_solve(p, step);
    } else {
        tribo_dense_solve(p, step);
    }
}

void tribo_factor_solve(const struct box_qp *p, double *step)
{
    if (!p->far) {
        factor_solve(p, step);
        return;
    }
    double most = 0.0;
    for (size_t k = 0; k < p->sets->rank; k++) {
        most = greater(most, fabs(step[p->order[k]]));
    }
    const double room = most < TRIBO_ROOM * TRIBO_FAR ? 1.0 : TRIBO_ROOM, far = room * TRIBO_FAR;
    for (size_t k = 0; k < p->sets->rank; k++) {
        step[p->order[k]] *= room;
    }
    factor_solve(p, step);
    for (size_t k = 0; k < p->sets->rank; k++) {
        step[p->order[k]] = clamp(step[p->order[k]], -far, far) / room;
    }
}

int tribo_factor_many(const struct box_qp *p, size_t changes, size_t free)
{
    /* A change of a dense factor costs about rank^2, a dense factor free^3/3. As measured on carpets and chains of 400 to 100,000
     * contacts, a sparse factor costs some size/16 changes, 16 where each is searched for dependents. */
    const size_t many = p->group->nullity ? 16 : p->group->size / 16;
    return p->group->sparse ? changes > many : p->group->graded || 3 * changes > free;
}

/* ----------------------------------------------------------------------------------------------------------- rows of R */

/* Returns row'x, and *size = |row|'|x|: four sums side by side, since one sum waits for itself. */
TRIBO_SIMD static double factor_dense_dot(const double *restrict row, const double *restrict x, size_t n, double *size)
{
    enum { SUMS = 4 };
    double sum[SUMS] = {0.0}, all[SUMS] = {0.0};
    size_t j = 0;
    for (; j + SUMS <= n; j += SUMS) {
        for (size_t k = 0; k < SUMS; k++) {
            const double term = row[j + k] * x[j + k];
            sum[k] += term;
            all[k] += fabs(term);
        }
    }
    for (; j < n; j++) {
        sum[0] += row[j] * x[j];
        all[0] += fabs(row[j] * x[j]);
    }
    *size = all[0] + all[1] + (all[2] + all[3]);
    return sum[0] + sum[1] + (sum[2] + sum[3]);
}

double tribo_row_dot(const struct box_qp *p, size_t i, const double *x, double *size)
{
    if (p->group->sparse) {
        return tribo_sparse_dot(p, i, x, size);
    }
    return factor_dense_dot(p->r + i * p->group->size, x, p->group->size, size);
}

double tribo_row_others(const struct box_qp *p, size_t i, double *x)
{
    const double own = x[i];
    double ignored;
    x[i] = 0.0;
    const double sum = tribo_row_dot(p, i, x, &ignored);
    x[i] = own;
    return sum;
}

void tribo_row_spread(const struct box_qp *p, size_t i, double factor, double *y)
{
    if (p->group->sparse) {
        tribo_sparse_spread(p, i, factor, y);
        return;
    }
    const size_t all = p->sets->rank + p->sets->dependents;
    for (size_t k = 0; k < all; k++) {
        y[p->order[k]] = factor * p->r[i * p->group->size + p->order[k]];
    }
}
