/* The factor of R over the free contacts of a group, and rows of R: dense, sparse or graded. */
#include "box_qp.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "common/real.h"
#include "common/simd.h"

void tribo_factor_change(struct box_qp *p, size_t i)
{
    const int enters = p->at[i] == FREE;
    if (p->group->graded) {
        tribo_factor_rebuild(p, NULL);
    } else if (p->group->sparse) {
        (enters ? tribo_sparse_add : tribo_sparse_remove)(p, i);
    } else {
        (enters ? tribo_dense_add : tribo_dense_remove)(p, i);
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
    /* A change of a dense factor costs about rank^2, a dense factor free^3/3. */
    return p->group->sparse ? tribo_sparse_many(p, changes) : p->group->graded || 3 * changes > free;
}

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
