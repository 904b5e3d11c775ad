/* SPDX-License-Identifier: BSD-3-Clause */
/* The factor of a graded group, one of whose contacts touches a light body and a heavy one. In R = J M^-1 J' as a double 1/m of
 * the light body hides 1/M of the heavy one but for the last digits, and with them the effect of friction on it. R, its factor,
 * and the forces of the free contacts are therefore kept to twice as many digits, which are enough for masses that differ by
 * 1e18.
 *
 * A change of the stick set factorizes anew. Row k of l holds l_k0, ... l_k,k-1 and 1/l_kk, as in factor.c. */
#include "box_qp.h"

#include <math.h>
#include <string.h>

#include "common/real.h"
#include "numerics/twofold.h"

/* Largest numbers of a graded solve: its results stay below TWOFOLD_FAR. */
#define FITS 1e100

static struct twofold graded_entry(const struct box_qp *p, size_t i, size_t j)
{
    const size_t at = i * p->group->size + j;
    return twofold_scale((struct twofold){p->r[at], p->low.r[at]}, p->scale[i] * p->scale[j]);
}

static struct twofold graded_factor(const struct box_qp *p, size_t i, size_t j)
{
    const size_t at = i * p->group->size + j;
    return (struct twofold){p->l[at], p->low.l[at]};
}

static void graded_set_factor(const struct box_qp *p, size_t i, size_t j, struct twofold x)
{
    const size_t at = i * p->group->size + j;
    p->l[at] = x.hi;
    p->low.l[at] = x.lo;
}

/* ---------------------------------------------------------------------------------------------------------- rebuild */

double tribo_graded_rebuild(struct box_qp *p, size_t *where)
{
    const size_t all = tribo_dense_order(p);
    size_t k = 0;
    for (size_t i = 0; i < all; i++) {
        for (size_t j = 0; j <= i; j++) {
            graded_set_factor(p, i, j, graded_entry(p, p->order[i], p->order[j]));
        }
    }
    for (; tribo_dense_pivot(p, k, all, TRIBO_GRADED_ZERO); k++) {
        const struct twofold inverse = twofold_inverse_root(graded_factor(p, k, k));
        graded_set_factor(p, k, k, inverse);
        for (size_t i = k + 1; i < all; i++) {
            graded_set_factor(p, i, k, twofold_times(graded_factor(p, i, k), inverse));
        }
        for (size_t i = k + 1; i < all; i++) {
            const struct twofold x = graded_factor(p, i, k);
            for (size_t j = k + 1; x.hi != 0.0 && j <= i; j++) {
                graded_set_factor(p, i, j, twofold_minus(graded_factor(p, i, j), twofold_times(x, graded_factor(p, j, k))));
            }
        }
    }
    return tribo_dense_end(p, k, all, where);
}

/* ------------------------------------------------------------------------------------------------------------ solve */

/* y -= l_kj x */
static struct twofold graded_subtract(const struct box_qp *p, struct twofold y, size_t k, size_t j, struct twofold x)
{
    return twofold_minus(y, twofold_times(graded_factor(p, k, j), x));
}

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
            y = graded_subtract(p, y, k, j, (struct twofold){step[p->order[j]], low[p->order[j]]});
        }
        y = twofold_times(y, graded_factor(p, k, k));
        step[i] = y.hi;
        low[i] = y.lo;
    }
    for (size_t k = rank; k-- > 0;) {
        const size_t i = p->order[k];
        struct twofold y = {step[i], low[i]};
        for (size_t j = k + 1; j < rank; j++) {
            y = graded_subtract(p, y, j, k, (struct twofold){step[p->order[j]], low[p->order[j]]});
        }
        y = twofold_times(y, graded_factor(p, k, k));
        step[i] = y.hi;
        low[i] = y.lo;
    }
    for (size_t k = 0; k < rank; k++) {
        const size_t i = p->order[k];
        step[i] = quotient(p->scale[i] * step[i], unit);
        low[i] = quotient(p->scale[i] * low[i], unit);
    }
}

void tribo_graded_null_vector(const struct box_qp *p, size_t d, double *y)
{
    const size_t size = p->group->size;
    double *low = p->row;
    for (size_t k = 0; k < p->sets->rank; k++) {
        const size_t i = p->order[k];
        y[i] = -p->r[d * size + i];
        low[i] = -p->low.r[d * size + i];
    }
    tribo_graded_solve(p, y, low);
    memset(low, 0, size * sizeof *low);
}

/* --------------------------------------------------------------------------------------------------------- gradient */

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
                             term = twofold_times(graded_entry(p, i, j), x);
        sum = twofold_add(sum, term);
        *size += fabs(term.hi);
    }
    *size *= own;
    *low = own * sum.lo;
    return own * sum.hi;
}

void tribo_graded_newton(struct box_qp *p)
{
    double size;
    for (size_t k = 0; k < p->sets->rank; k++) {
        const size_t i = p->order[k];
        p->step[i] = -tribo_graded_gradient(p, i, &p->low.step[i], &size);
        p->low.step[i] *= -1.0;
    }
    tribo_graded_solve(p, p->step, p->low.step);
}

double tribo_graded_terms(const struct box_qp *p, size_t i)
{
    double *y = p->low.step, sum = fabs(p->q[i]);
    tribo_graded_null_vector(p, i, y);
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
