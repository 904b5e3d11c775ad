/* SPDX-License-Identifier: BSD-3-Clause */
/* The factor of R over the free contacts of a group, and rows of R, dense, graded or sparse; and the dense and graded factors.
 *
 * Dense: R is a square block. Rows are appended and deleted in O(rank^2). Dependents wait beside the factor. A pivot that is
 * small, but not zero to rounding, leads to a new factor with the largest pivots first, which decides the rank. Row k of l holds
 * l_k0, ... l_k,k-1 and 1/l_kk.
 *
 * Graded: a contact of the group touches a light body and a heavy one. In R = J M^-1 J' as a double 1/m of the light body hides
 * 1/M of the heavy one but for the last digits, and with them the effect of friction on it. R, its factor, and the forces of the
 * free contacts are therefore kept to twice as many digits, which are enough for masses that differ by 1e18. Each change of the
 * stick set factorizes anew. */
#include "box_qp.h"

#include <math.h>
#include <string.h>

#include "common/real.h"
#include "common/simd.h"
#include "numerics/csr.h"
#include "numerics/twofold.h"

/* Largest numbers of a graded solve: its results stay below TWOFOLD_FAR. */
#define FITS 1e100

/* With the smallest pivots of a factor, of 1e-200, this part of the largest numbers lead to finite ones. */
#define ROOM 0x1p-664

/* Sums side by side, since one sum waits for itself. */
enum { SUMS = 4 };

static inline double sum_of_four(const double *sum)
{
    return sum[0] + sum[1] + (sum[2] + sum[3]);
}

/* ---------------------------------------------------------------------------------------------------- the dense factor */

/* Returns x'y, and *size = |x|'|y|, unless size is NULL. */
static inline double dot_of_four(const double *restrict x, const double *restrict y, size_t n, double *size)
{
    double sum[SUMS] = {0.0}, all[SUMS] = {0.0};
    size_t i = 0;
    for (; i + SUMS <= n; i += SUMS) {
        for (size_t k = 0; k < SUMS; k++) {
            sum[k] += x[i + k] * y[i + k];
            all[k] += size ? fabs(x[i + k] * y[i + k]) : 0.0;
        }
    }
    for (; i < n; i++) {
        sum[0] += x[i] * y[i];
        all[0] += size ? fabs(x[i] * y[i]) : 0.0;
    }
    if (size) {
        *size = sum_of_four(all);
    }
    return sum_of_four(sum);
}

/* Returns the scaled R_ij; its low part is 0 unless R is graded. */
static inline struct twofold scaled_entry(const struct box_qp *p, int graded, size_t i, size_t j)
{
    const size_t at = i * p->group->size + j;
    return graded ? twofold_scale((struct twofold){p->r[at], p->low.r[at]}, p->scale[i] * p->scale[j])
                  : (struct twofold){p->scale[i] * p->r[at] * p->scale[j], 0.0};
}

static inline struct twofold factor_entry(const struct box_qp *p, int graded, size_t i, size_t j)
{
    const size_t at = i * p->group->size + j;
    return (struct twofold){p->l[at], graded ? p->low.l[at] : 0.0};
}

static inline void set_factor(const struct box_qp *p, int graded, size_t i, size_t j, struct twofold x)
{
    const size_t at = i * p->group->size + j;
    p->l[at] = x.hi;
    if (graded) {
        p->low.l[at] = x.lo;
    }
}

static inline struct twofold factor_times(int graded, struct twofold x, struct twofold y)
{
    return graded ? twofold_times(x, y) : (struct twofold){x.hi * y.hi, 0.0};
}

static inline struct twofold factor_minus(int graded, struct twofold x, struct twofold y)
{
    return graded ? twofold_minus(x, y) : (struct twofold){x.hi - y.hi, 0.0};
}

/* Exchanges rows and columns k and best > k of the lower triangle of l [all][all]. */
static inline void exchange_contacts(const struct box_qp *p, int graded, size_t k, size_t best, size_t all)
{
    const size_t size = p->group->size, first = p->order[k];
    double *const array[] = {p->l, p->low.l};
    for (int a = 0; a < 1 + graded; a++) {
        double *const l = array[a];
        tribo_exchange(l + k * size, l + best * size, k, 1);
        tribo_exchange(l + k * (size + 1), l + best * (size + 1), 1, 1);
        for (size_t i = k + 1; i < best; i++) {
            tribo_exchange(l + i * size + k, l + best * size + i, 1, 1);
        }
        for (size_t i = best + 1; i < all; i++) {
            tribo_exchange(l + i * size + k, l + i * size + best, 1, 1);
        }
    }
    p->order[k] = p->order[best];
    p->order[best] = first;
}

/* Cholesky factorization with the largest pivot next: takes each column, once found, from the entries behind it. All entries come
 * from one triangle of R and are sums in one order, so that those of equal contacts are equal to the last digit. */
static inline double dense_rebuild(struct box_qp *p, int graded, size_t *where)
{
    const size_t size = p->group->size;
    size_t all = 0, k = 0;
    double most = 0.0;
    p->work.factorizations++;
    for (size_t e = 0; e < p->count; e++) {
        if (p->at[p->near[e]] == FREE) {
            p->order[all++] = p->near[e];
        }
    }
    const double zero = graded ? TRIBO_GRADED_ZERO : tribo_resolution(all);
    for (size_t i = 0; i < all; i++) {
        for (size_t j = 0; j <= i; j++) {
            set_factor(p, graded, i, j, scaled_entry(p, graded, p->order[i], p->order[j]));
        }
    }
    for (; k < all; k++) {
        size_t best = k;
        for (size_t i = k + 1; i < all; i++) {
            best = p->l[i * (size + 1)] > p->l[best * (size + 1)] ? i : best;
        }
        if (p->l[best * (size + 1)] <= zero) {
            break;
        }
        if (best > k) {
            exchange_contacts(p, graded, k, best, all);
        }
        const struct twofold pivot = factor_entry(p, graded, k, k);
        const struct twofold inverse = graded ? twofold_inverse_root(pivot) : (struct twofold){1.0 / sqrt(pivot.hi), 0.0};
        set_factor(p, graded, k, k, inverse);
        for (size_t i = k + 1; i < all; i++) {
            const struct twofold x = factor_times(graded, factor_entry(p, graded, i, k), inverse);
            set_factor(p, graded, i, k, x);
            set_factor(p, graded, k, i, x); /* the column, side by side */
            for (size_t j = k + 1; j <= i; j++) {
                const struct twofold part = factor_times(graded, x, factor_entry(p, graded, k, j));
                set_factor(p, graded, i, j, factor_minus(graded, factor_entry(p, graded, i, j), part));
            }
        }
    }
    p->sets->rank = k;
    p->sets->dependents = all - k;
    for (size_t i = k; where && i < all; i++) {
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

/* Computes the row of i as the last one of l. Returns what i is. */
static int dense_enter(struct box_qp *p, size_t i)
{
    const size_t rank = p->sets->rank, size = p->group->size;
    const double diagonal = scaled_entry(p, 0, i, i).hi;
    double *row = p->l + rank * size, pivot = diagonal;
    for (size_t k = 0; k < rank; k++) {
        const double *l = p->l + k * size;
        row[k] = (scaled_entry(p, 0, i, p->order[k]).hi - dot_of_four(l, row, k, NULL)) * l[k];
        pivot -= row[k] * row[k];
    }
    const double relative = pivot / diagonal;
    if (relative <= TRIBO_DOUBTFUL) {
        return relative <= tribo_resolution(rank + 1) ? DEPENDENT : UNDECIDED;
    }
    row[rank] = 1.0 / sqrt(pivot);
    return INDEPENDENT;
}

static void dense_leave(struct box_qp *p, size_t i)
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
}

static void dense_solve(const struct box_qp *p, double *step)
{
    const size_t rank = p->sets->rank, size = p->group->size;
    double *y = p->row;
    for (size_t i = 0; i < rank; i++) {
        const double *l = p->l + i * size;
        y[i] = (p->scale[p->order[i]] * step[p->order[i]] - dot_of_four(l, y, i, NULL)) * l[i];
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

/* --------------------------------------------------------------------------------------------------- the graded factor */

void tribo_graded_solve(const struct box_qp *p, double *step, double *low)
{
    const size_t rank = p->sets->rank;
    double most = 1.0;
    int e;
    for (size_t k = 0; k < p->sets->rank; k++) {
        const size_t i = p->order[k];
        most = greater(most, product(fabs(step[i]), greater(p->scale[i], 1.0)));
    }
    frexp(most, &e);
    const double unit = most > FITS ? ldexp(1.0, -e) : 1.0; /* brings step to at most FITS */
    for (size_t k = 0; k < rank; k++) {
        const size_t i = p->order[k];
        struct twofold y = twofold_scale((struct twofold){unit * step[i], unit * low[i]}, p->scale[i]);
        for (size_t j = 0; j < k; j++) {
            const struct twofold x = {step[p->order[j]], low[p->order[j]]};
            y = twofold_minus(y, twofold_times(factor_entry(p, 1, k, j), x));
        }
        y = twofold_times(y, factor_entry(p, 1, k, k));
        step[i] = y.hi;
        low[i] = y.lo;
    }
    for (size_t k = rank; k-- > 0;) {
        const size_t i = p->order[k];
        struct twofold y = {step[i], low[i]};
        for (size_t j = k + 1; j < rank; j++) {
            const struct twofold x = {step[p->order[j]], low[p->order[j]]};
            y = twofold_minus(y, twofold_times(factor_entry(p, 1, j, k), x));
        }
        y = twofold_times(y, factor_entry(p, 1, k, k));
        step[i] = y.hi;
        low[i] = y.lo;
    }
    for (size_t k = 0; k < rank + p->sets->dependents; k++) {
        const size_t i = p->order[k];
        step[i] = k < rank ? quotient(p->scale[i] * step[i], unit) : 0.0;
        low[i] = k < rank ? quotient(p->scale[i] * low[i], unit) : 0.0;
    }
}

int tribo_graded_fits(const struct box_qp *p, int bounded)
{
    double most = 0.0;
    for (size_t e = 0; e < p->group->size; e++) {
        const size_t i = p->near[e];
        const int near = e < p->count;
        const double x = !near ? fabs(p->x[i]) : bounded ? greater(fabs(p->lo[i]), fabs(p->hi[i])) : 0.0;
        most = greater(most, greater(quotient(x, p->scale[i]), near ? product(fabs(p->q[i]), p->scale[i]) : 0.0));
    }
    return most <= FITS;
}

double tribo_graded_gradient(const struct box_qp *p, size_t i, double *low, double *size)
{
    const double own = 1.0 / p->scale[i];
    struct twofold sum = {p->scale[i] * p->q[i], 0.0};
    *size = 0.0;
    for (size_t j = 0; j < p->group->size; j++) {
        const struct twofold x = twofold_scale((struct twofold){p->x[j], p->low.x[j]}, 1.0 / p->scale[j]),
                             term = twofold_times(scaled_entry(p, 1, i, j), x);
        sum = twofold_add(sum, term);
        *size += fabs(term.hi);
    }
    *size *= own;
    *low = own * sum.lo;
    return own * sum.hi;
}

double tribo_graded_terms(const struct box_qp *p, size_t i)
{
    double *y = p->low.step, sum = fabs(p->q[i]);
    tribo_null_vector(p, i, y);
    for (size_t k = 0; k < p->sets->rank; k++) {
        sum += fabs(y[p->order[k]] * p->q[p->order[k]]);
    }
    return sum;
}

double tribo_graded_move(struct box_qp *p, size_t i, double length)
{
    const struct twofold step = twofold_times((struct twofold){p->step[i], p->low.step[i]}, (struct twofold){length, 0.0}),
                         x = twofold_add((struct twofold){p->x[i], p->low.x[i]}, step);
    p->low.x[i] = x.lo;
    return x.hi;
}

/* ---------------------------------------------------------------------------------------------------------- the factor */

/* Takes a free contact into the independent contacts or the dependents; factorizes anew if its pivot is doubtful. */
static void factor_append(struct box_qp *p, size_t i)
{
    const struct group *g = p->group;
    const size_t all = p->sets->rank + p->sets->dependents;
    const int is = g->graded ? UNDECIDED : g->sparse ? tribo_sparse_enter(p, i) : dense_enter(p, i);
    if (is == UNDECIDED) {
        tribo_factor_rebuild(p, NULL);
    } else if (is == DEPENDENT) {
        tribo_box_order(p, all, i);
        p->sets->dependents++;
    } else {
        /* The first dependent makes room at the end of the independent contacts. */
        if (p->sets->dependents) {
            tribo_box_order(p, all, p->order[p->sets->rank]);
        }
        tribo_box_order(p, p->sets->rank++, i);
    }
}

void tribo_box_change(struct box_qp *p, size_t i, signed char to)
{
    const int entered = p->at[i] == FREE, enters = to == FREE;
    const size_t rank = p->sets->rank, factorizations = p->work.factorizations;
    p->at[i] = to;
    if (entered == enters) {
        return;
    }
    p->work.updates++;
    if (enters) {
        factor_append(p, i);
    } else if (p->group->graded) {
        tribo_factor_rebuild(p, NULL);
    } else {
        (p->group->sparse ? tribo_sparse_leave : dense_leave)(p, i);
        /* Dependents of an independent contact that left may be independent. */
        const size_t waiting = p->sets->rank < rank ? p->sets->dependents : 0;
        p->sets->dependents -= waiting;
        for (size_t d = 0; d < waiting && p->work.factorizations == factorizations; d++) {
            factor_append(p, p->order[p->sets->rank + p->sets->dependents]);
        }
    }
}

TRIBO_SIMD double tribo_factor_rebuild(struct box_qp *p, size_t *where)
{
    return p->group->sparse   ? tribo_sparse_rebuild(p, where)
           : p->group->graded ? dense_rebuild(p, 1, where)
                              : dense_rebuild(p, 0, where);
}

/* step = R^-1 step, 0 for dependents; row [size] = the low part of step of a graded group, and 0 on return. */
static void factor_solve(const struct box_qp *p, double *step)
{
    for (size_t k = p->sets->rank; k < p->sets->rank + p->sets->dependents; k++) {
        step[p->order[k]] = 0.0;
    }
    if (p->group->graded) {
        tribo_graded_solve(p, step, p->row);
        memset(p->row, 0, p->group->size * sizeof *p->row);
    } else if (p->group->sparse) {
        tribo_sparse_solve(p, step);
    } else {
        dense_solve(p, step);
    }
}

void tribo_factor_solve(const struct box_qp *p, size_t vectors, double *step)
{
    const size_t all = p->sets->rank + (vectors ? p->sets->dependents : 0);
    double most = 0.0;
    for (size_t k = 0; p->far && k < all; k++) {
        most = greater(most, fabs(step[p->order[k]]));
    }
    const double room = most < ROOM * TRIBO_FAR ? 1.0 : ROOM, far = room * TRIBO_FAR;
    for (size_t k = 0; p->far && k < all; k++) {
        step[p->order[k]] *= room;
    }
    tribo_null_project(p, vectors, step, step);
    factor_solve(p, step);
    tribo_null_project(p, vectors, step, step);
    for (size_t k = 0; p->far && k < all; k++) {
        step[p->order[k]] = clamp(step[p->order[k]], -far, far) / room;
    }
}

/* ----------------------------------------------------------------------------------------------------------- rows of R */

TRIBO_SIMD double tribo_row_dot(const struct box_qp *p, size_t i, const double *x, double *size)
{
    const size_t n = p->group->size;
    return p->group->sparse ? tribo_sparse_dot(p, i, x, size) : dot_of_four(p->r + i * n, x, n, size);
}

size_t tribo_row_entries(const struct box_qp *p, size_t i, const size_t **col, const double **val)
{
    const struct csr *r = p->group->sparse ? tribo_sparse_rows(p->group->sparse) : NULL;
    *col = r ? r->col + r->first[i] : NULL;
    *val = r ? r->val + r->first[i] : p->r + i * p->group->size;
    return r ? r->first[i + 1] - r->first[i] : p->group->size;
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

void tribo_null_vector(const struct box_qp *p, size_t d, double *y)
{
    const struct group *g = p->group;
    const size_t *col;
    const double *val;
    const size_t entries = tribo_row_entries(p, d, &col, &val);
    for (size_t k = 0; k < p->sets->rank; k++) {
        y[p->order[k]] = 0.0;
    }
    for (size_t e = 0; e < entries; e++) {
        const size_t j = col ? col[e] : e;
        if (p->at[j] == FREE) {
            y[j] = -val[e];
            p->row[j] = g->graded ? -p->low.r[d * g->size + j] : 0.0;
        }
    }
    if (g->graded) {
        factor_solve(p, y);
    } else {
        tribo_factor_solve(p, 0, y);
    }
    y[d] = 1.0;
}

/* ---------------------------------------------------------------------------------------------------------- null space */

static double free_dot(const struct box_qp *p, const double *x, const double *y)
{
    double sum = 0.0;
    for (size_t k = 0; k < p->sets->rank + p->sets->dependents; k++) {
        sum += x[p->order[k]] * y[p->order[k]];
    }
    return sum;
}

void tribo_null_project(const struct box_qp *p, size_t vectors, const double *x, double *y)
{
    for (size_t j = 0; j < vectors; j++) {
        const double *b = p->null.basis + j * p->group->size, part = free_dot(p, b, x);
        for (size_t k = 0; k < p->sets->rank + p->sets->dependents; k++) {
            y[p->order[k]] -= part * b[p->order[k]];
        }
    }
}

size_t tribo_null_basis(struct box_qp *p)
{
    const size_t vectors = p->sets->dependents;
    if (vectors > p->null.redundant) {
        return 0;
    }
    for (size_t j = 0; j < vectors; j++) {
        double *b = p->null.basis + j * p->group->size;
        tribo_null_vector(p, p->order[p->sets->rank + j], b);
        tribo_null_project(p, j, b, b);
        tribo_null_project(p, j, b, b);
        const double length = sqrt(free_dot(p, b, b));
        for (size_t k = 0; k < p->sets->rank + vectors; k++) {
            b[p->order[k]] /= length;
        }
    }
    return vectors;
}
