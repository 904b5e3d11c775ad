/* SPDX-License-Identifier: BSD-3-Clause */
/* The share of redundant contacts. Where R is singular R x is unique, but x is not: x becomes the solution in the box of least
 * norm, which depends neither on the order of the contacts nor on the way to it.
 *
 * A primal active set method minimizes |x|^2 in the box along the null space of R over the contacts without gradient: basis spans
 * the null space, and its first vectors do not move the contacts at a bound. */
#include "box_qp.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Rounding of null vectors, which come from a factor, in parts of that of a sum. */
#define NULL_NOISE 64.0

static double free_dot(const struct box_qp *p, const double *x, const double *y)
{
    double sum = 0.0;
    for (size_t k = 0; k < p->sets->rank + p->sets->dependents; k++) {
        sum += x[p->order[k]] * y[p->order[k]];
    }
    return sum;
}

/* y += factor x */
static void free_add(const struct box_qp *p, double factor, const double *x, double *y)
{
    for (size_t k = 0; k < p->sets->rank + p->sets->dependents; k++) {
        y[p->order[k]] += factor * x[p->order[k]];
    }
}

void tribo_null_project(const struct box_qp *p, size_t k, double *y)
{
    for (size_t j = 0; j < k; j++) {
        const double *b = p->null.basis + j * p->group->size;
        free_add(p, -free_dot(p, b, y), b, y);
    }
}

void tribo_null_solve(const struct box_qp *p, size_t vectors, double *step)
{
    tribo_null_project(p, vectors, step);
    tribo_factor_solve(p, step);
    tribo_null_project(p, vectors, step);
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
        tribo_null_project(p, j, b);
        tribo_null_project(p, j, b);
        const double length = sqrt(free_dot(p, b, b));
        for (size_t k = 0; k < p->sets->rank + vectors; k++) {
            b[p->order[k]] /= length;
        }
    }
    return vectors;
}

/* Reflects the first vectors so that only the last of them moves contact i. Returns 1, or 0 if they move it by rounding only:
 * then makes these moves 0, since to hold i would take away a vector along which others share. */
static int hold_contact(struct box_qp *p, size_t vectors, size_t i)
{
    const size_t size = p->group->size, last = vectors - 1;
    double *u = p->row, square = 0.0;
    for (size_t j = 0; j < vectors; j++) {
        u[j] = p->null.basis[j * size + i];
        square += u[j] * u[j];
    }
    const double length = sqrt(square);
    const int moves = length > NULL_NOISE * tribo_resolution(size);
    u[last] += u[last] < 0.0 ? -length : length;
    const double scale = length * fabs(u[last]); /* u'u/2 */
    for (size_t k = 0; moves && k < p->sets->rank + p->sets->dependents; k++) {
        double *column = p->null.basis + p->order[k], sum = 0.0;
        for (size_t j = 0; j < vectors; j++) {
            sum += u[j] * column[j * size];
        }
        for (size_t j = 0; j < vectors; j++) {
            column[j * size] -= sum / scale * u[j];
        }
    }
    for (size_t j = 0; j < (moves ? last : vectors); j++) {
        p->null.basis[j * size + i] = 0.0;
    }
    memset(u, 0, vectors * sizeof *u);
    return moves;
}

/* step = the move of x to the least norm along the first vectors. */
static void aim_at_least(struct box_qp *p, size_t vectors)
{
    for (size_t k = 0; k < p->sets->rank + p->sets->dependents; k++) {
        p->step[p->order[k]] = p->low.step[p->order[k]] = 0.0;
    }
    for (size_t j = 0; j < vectors; j++) {
        const double *b = p->null.basis + j * p->group->size;
        free_add(p, -free_dot(p, b, p->x), b, p->step);
    }
}

/* Lets the first held contact go that moves off its bound then. Returns 0 if there is none. */
static int release_contact(struct box_qp *p, size_t vectors, size_t *held)
{
    double most = DBL_MIN, sum = 0.0; /* scaled, since squares may overflow */
    for (size_t k = 0; k < p->sets->rank + p->sets->dependents; k++) {
        most = greater(most, fabs(p->x[p->order[k]]));
    }
    for (size_t k = 0; k < p->sets->rank + p->sets->dependents; k++) {
        const double part = p->x[p->order[k]] / most;
        sum += part * part;
    }
    const double noise = tribo_resolution(p->group->size) * (most * sqrt(sum));
    for (size_t tried = 0; tried < *held; tried++) {
        const size_t i = p->null.held[0], others = *held - 1;
        memmove(p->null.held, p->null.held + 1, others * sizeof *p->null.held);
        for (size_t h = 0; h < others; h++) {
            hold_contact(p, vectors - h, p->null.held[h]);
        }
        aim_at_least(p, vectors - others);
        if (p->x[i] <= p->lo[i] ? p->step[i] > noise : p->step[i] < -noise) {
            *held = others;
            return 1;
        }
        p->null.held[others] = i;
        hold_contact(p, vectors - others, i);
    }
    return 0;
}

int tribo_least_norm(struct box_qp *p)
{
    const size_t size = p->group->size;
    /* Contacts at a bound without gradient share, too. */
    for (size_t e = 0; e < p->count; e++) {
        const size_t i = p->near[e];
        if (p->at[i] != FREE && p->lo[i] < p->hi[i] && fabs(p->gradient[i]) <= tribo_box_tolerance(p, i)) {
            tribo_box_change(p, i, FREE);
        }
    }
    const size_t vectors = tribo_null_basis(p);
    size_t held = 0;
    for (size_t round = 0; vectors && round < 20 * (size + vectors); round++) {
        aim_at_least(p, vectors - held);
        const size_t hit = tribo_box_advance(p, 1.0);
        if (hit < size && held < vectors) {
            p->null.held[held] = hit;
            held += (size_t)hold_contact(p, vectors - held, hit);
        } else if (!release_contact(p, vectors, &held)) {
            break;
        }
    }
    return vectors > 0;
}

/* ------------------------------------------------------------------------------------------------ the linear system */

/* x = the solution of R x + q = 0 of least norm, or the least-squares one, by the factor as it is. Returns 1 if there is one. */
static int minimum_norm(struct box_qp *p)
{
    tribo_box_forget_low(p);
    for (size_t e = 0; e < p->count; e++) {
        p->x[p->near[e]] = 0.0;
    }
    const size_t vectors = tribo_null_basis(p);
    int consistent = 1;
    for (int pass = 0; pass < 3; pass++) {
        tribo_box_gradients(p);
        if (vectors) {
            double rounding = DBL_MIN;
            for (size_t e = 0; e < p->count; e++) {
                p->step[p->near[e]] = p->gradient[p->near[e]];
                p->low.gradient[p->near[e]] = 0.0;
                rounding = greater(rounding, 16.0 * p->noise[p->near[e]]);
            }
            tribo_null_project(p, vectors, p->gradient);
            for (size_t e = 0; e < p->count; e++) {
                const size_t i = p->near[e];
                consistent &= pass > 0 || fabs(p->step[i] - p->gradient[i]) <= rounding + tribo_box_disagreement(p, i);
            }
        } else if (pass > 0 && tribo_box_settled(p, 1.0)) {
            break;
        }
        tribo_box_newton(p);
        if (vectors) { /* projections have the digits of a double */
            tribo_null_project(p, vectors, p->step);
            memset(p->low.step, 0, p->group->size * sizeof *p->low.step);
        }
        for (size_t e = 0; e < p->count; e++) {
            const size_t i = p->near[e];
            p->x[i] = tribo_box_moved(p, i);
        }
    }
    tribo_box_gradients(p);
    /* Without null vectors the system is consistent if the dependents have no gradient. */
    for (size_t d = 0; d < p->sets->dependents && !vectors; d++) {
        const size_t i = p->order[p->sets->rank + d];
        consistent &= fabs(p->gradient[i]) <= 16.0 * p->noise[i] + tribo_box_disagreement(p, i);
    }
    return consistent;
}

int tribo_box_linear(struct box_qp *p)
{
    p->sets->far = p->far;
    tribo_box_begin(p, 0);
    tribo_box_enter(p, 0);
    int consistent = minimum_norm(p);
    /* The rank of a factor made row by row may differ from that of one with the largest pivots first. */
    if (!consistent || !tribo_box_settled(p, TRIBO_SETTLED)) {
        tribo_factor_rebuild(p, NULL);
        consistent = minimum_norm(p);
    }
    return consistent;
}
