/* SPDX-License-Identifier: BSD-3-Clause */
/* The box-constrained quadratic program of a group, min 1/2 x'Rx + q'x with lo <= x <= hi, to which Coulomb's law leads: an x
 * inside its box has no gradient, and the gradient at a bound pushes against the bound.
 *
 *     begin with the sets of the last call
 *     repeat  x = the solution with these sets; an x outside its box goes to the bound, an x whose gradient leads away from its
 *             bound becomes free
 *     until   no set changes, or patience ends
 *     after patience: change one contact at a time, down the objective, until no gradient pulls
 *     redundant contacts: x = the solution of least norm
 *
 * Whole sets change at once (the primal-dual active set method of Hintermueller, Ito and Kunisch 2002, SIAM J. Optim. 13, 865,
 * doi:10.1137/S1052623401383558). Usually none changes, and a call costs a solve and a gradient. That method may cycle; a primal
 * active set method, each change of which lowers the objective, then finishes. Either ends only when the gradient shows that x is
 * the solution, up to the gradient's rounding. */
#include "small.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* --------------------------------------------------------------------------- Newton's method with the sets as they are */

/* Rounding of the terms of a graded group, in parts of that of doubles. */
#define GRADED_PART 0x1p-50

/* low.x = 0: an x that no solver found has no low part. */
static void forget_low(const struct box_qp *p)
{
    if (p->twofold) {
        memset(p->low.x, 0, p->group->size * sizeof *p->low.x);
    }
}

/* Rounding of the caller's a must not set redundant contacts against each other: their gradient may be this part of the unit, but
 * not more than that part of the terms, since limits that are never reached do not bound rounding. */
#define DISAGREEMENT 5e-13
#define DISAGREED_TERMS 5e-9

/* Returns the gradient of i that rounding of the caller's a may cause, for groups with redundant contacts. */
static double disagreement(const struct box_qp *p, size_t i)
{
    if (!p->group->nullity) {
        return 0.0;
    }
    return p->twofold ? DISAGREEMENT * tribo_graded_terms(p, i)
                      : lesser(DISAGREEMENT * p->rounding.unit[i], DISAGREED_TERMS * p->rounding.terms[i]);
}

double tribo_box_tolerance(const struct box_qp *p, size_t i)
{
    return p->noise[i] + disagreement(p, i);
}

/* Returns 1 if pull, which may be negative, exceeds the tolerance of i. */
static int box_pulls(const struct box_qp *p, size_t i, double pull)
{
    return pull > p->noise[i] && pull > tribo_box_tolerance(p, i);
}

/* Returns 1 if the gradients of the independent x are at most noises times their rounding: noise_i, and sum_j |R_ij error_j| by
 * the rounding error [size] of x; error = NULL: noise_i only. */
static int box_settled(const struct box_qp *p, double noises, const double *error)
{
    for (size_t k = 0; k < p->sets->rank; k++) {
        const size_t i = p->order[k];
        double doubt = 0.0;
        if (error) {
            tribo_row_dot(p, i, error, &doubt);
        }
        if (!(fabs(p->gradient[i]) <= noises * (p->noise[i] + doubt))) {
            return 0;
        }
    }
    return 1;
}

/* Forces and R of a graded group are as good as exact: only q is rounded. noise_i is a part of the terms that are rounded, and of
 * the largest force, by which forces underflow. */
void tribo_box_gradients(struct box_qp *p)
{
    const double rounded = p->twofold ? GRADED_PART : 1.0;
    const double most = p->far ? clamp(tribo_largest(p->x, p->group->size), 1.0, TRIBO_FAR) : 1.0;
    double size;
    for (size_t e = 0; e < p->count; e++) {
        const size_t i = p->near[e];
        p->gradient[i] =
            p->twofold ? tribo_graded_gradient(p, i, &p->low.gradient[i], &size) : tribo_row_dot(p, i, p->x, &size) + p->q[i];
        p->noise[i] = p->rounding.part[i] * (rounded * size + fabs(p->q[i]) + p->rounding.least[i] * most);
    }
}

/* step = the move of the independent x that takes gradient to zero; 0 for the dependents. */
static void box_newton(struct box_qp *p)
{
    for (size_t k = 0; k < p->sets->rank + p->sets->dependents; k++) {
        const size_t i = p->order[k];
        p->step[i] = -p->gradient[i];
        p->low.step[i] = p->twofold ? -p->low.gradient[i] : 0.0;
    }
    if (p->twofold) {
        tribo_graded_solve(p, p->step, p->low.step);
    } else {
        tribo_factor_solve(p, 0, p->step);
    }
}

/* Chooses twofold, and finds rounding.terms. bounded: lo and hi are set. */
static void box_begin(struct box_qp *p, int bounded)
{
    p->twofold = p->group->graded && tribo_graded_fits(p, bounded);
    if (p->group->nullity && !p->twofold) {
        /* Sizes of the gradient's terms at x_i = clamp(-q_i/R_ii, lo_i, hi_i): independent of earlier calls. */
        double *alone = p->step, size;
        for (size_t e = 0; e < p->group->size; e++) {
            const size_t i = p->near[e];
            const double stops = -product(p->q[i], p->scale[i] * p->scale[i]);
            alone[i] = e >= p->count ? p->x[i] : bounded ? clamp(stops, p->lo[i], p->hi[i]) : stops;
        }
        for (size_t e = 0; e < p->count; e++) {
            const size_t i = p->near[e];
            tribo_row_dot(p, i, alone, &size);
            p->rounding.terms[i] = size + fabs(p->q[i]);
        }
    }
}

/* Returns x_i + step_i. */
static double box_moved(struct box_qp *p, size_t i)
{
    const double x = p->twofold ? tribo_graded_move(p, i, 1.0) : p->x[i] + p->step[i];
    return p->far ? tribo_cut(p, i, x) : cut(x);
}

/* ---------------------------------------------------------------------------------------------------------------- sets */

/* A contact begins free if its bound exceeds its last force by this factor. */
#define FAR_AWAY 1e3

/* at = to, and the factor accordingly. Returns the number of contacts that became free or not free. */
static size_t box_change_all(struct box_qp *p)
{
    const size_t n = p->group->size;
    size_t changes = 0, free = 0;
    for (size_t i = 0; i < n; i++) {
        changes += (p->at[i] == FREE) != (p->to[i] == FREE);
        free += p->to[i] == FREE;
    }
    /* A change of a dense factor costs about rank^2, a dense factor free^3/3. As measured on carpets and chains of 400 to 100,000
     * contacts, a sparse factor costs some size/16 changes, 16 where each is searched for dependents. */
    const size_t many = p->group->sparse ? (p->group->nullity ? 16 : n / 16) : p->group->graded ? 0 : free / 3;
    /* Where contacts depend on others, a change may factorize anew, over at as it is then: several changes factorize once. */
    if (changes > many || (p->sets->dependents && changes > 1)) {
        p->work.updates += changes;
        memcpy(p->at, p->to, n);
        tribo_factor_rebuild(p, NULL);
        return changes;
    }
    for (int entering = 0; entering < 2; entering++) {
        for (size_t i = 0; i < n; i++) {
            if (p->at[i] != p->to[i] && (p->to[i] == FREE) == entering) {
                tribo_box_change(p, i, p->to[i]);
            }
        }
    }
    return changes;
}

/* Moves the free x by as much of longest step as keeps them in their boxes. Returns the contact that meets its bound, or size. */
static size_t box_advance(struct box_qp *p, double longest)
{
    const size_t all = p->sets->rank + p->sets->dependents;
    double length = longest;
    size_t hit = p->group->size;
    for (size_t k = 0; k < all; k++) {
        const size_t i = p->order[k];
        const double s = p->step[i], room = s > 0.0 ? p->hi[i] - p->x[i] : p->x[i] - p->lo[i];
        const double time = quotient(greater(room, 0.0), greater(fabs(s), DBL_MIN));
        if (s != 0.0 && time < length) {
            length = time;
            hit = i;
        }
    }
    for (size_t k = 0; k < all; k++) {
        const size_t i = p->order[k];
        const double x = p->twofold ? tribo_graded_move(p, i, length) : p->x[i] + length * p->step[i];
        p->x[i] = clamp(x, p->lo[i], p->hi[i]);
        p->low.x[i] = p->x[i] == x ? p->low.x[i] : 0.0;
    }
    if (hit < p->group->size) {
        p->x[hit] = p->step[hit] > 0.0 ? p->hi[hit] : p->lo[hit];
        p->low.x[hit] = 0.0;
    }
    return hit;
}

/* Takes the near contacts into the problem, free, and the others out of it. keep_bounds: contacts at a bound stay there, unless
 * the bound went far away. */
static void box_enter(struct box_qp *p, int keep_bounds)
{
    for (size_t e = 0; e < p->group->size; e++) {
        const size_t i = p->near[e];
        const signed char at = p->at[i];
        if (e >= p->count) {
            p->to[i] = AWAY;
        } else if (keep_bounds && !(p->lo[i] < p->hi[i])) {
            p->to[i] = AT_LOWER;
        } else if (keep_bounds && (at == AT_LOWER || at == AT_UPPER)) {
            p->to[i] = fabs(at == AT_LOWER ? p->lo[i] : p->hi[i]) <= FAR_AWAY * fabs(p->x[i]) ? at : FREE;
        } else {
            p->to[i] = FREE;
        }
    }
    box_change_all(p);
}

/* --------------------------------------------------------------------------------------------------------- the problem */

/* Takes the gradient of the independent x, which is up to date, to its rounding. */
static void box_refine(struct box_qp *p)
{
    for (int pass = 0; pass < 4 && !box_settled(p, 1.0, NULL); pass++) {
        box_newton(p);
        for (size_t k = 0; k < p->sets->rank; k++) {
            const size_t i = p->order[k];
            p->x[i] = box_moved(p, i);
        }
        tribo_box_gradients(p);
    }
}

/* to = the place where each x belongs. Returns 1 if all are there. */
static int box_revise(struct box_qp *p)
{
    const struct group *g = p->group;
    memcpy(p->to, p->at, g->size);
    for (size_t e = 0; e < p->count; e++) {
        const size_t i = p->near[e];
        if (p->at[i] != FREE && p->lo[i] < p->hi[i] && box_pulls(p, i, (double)p->at[i] * p->gradient[i])) {
            p->to[i] = FREE;
        }
    }
    for (size_t k = 0; k < p->sets->rank; k++) {
        const size_t i = p->order[k];
        p->to[i] = (signed char)((p->x[i] > p->hi[i]) - (p->x[i] < p->lo[i]));
    }
    for (size_t k = p->sets->rank; k < p->sets->rank + p->sets->dependents; k++) {
        const size_t i = p->order[k];
        if (box_pulls(p, i, fabs(p->gradient[i]))) {
            p->to[i] = p->gradient[i] > 0.0 ? AT_LOWER : AT_UPPER;
        }
    }
    return memcmp(p->to, p->at, g->size) == 0;
}

/* x = 0, or the bound next to 0: forces of earlier calls may be so large that their rounding hides others. */
static void box_forget(struct box_qp *p)
{
    forget_low(p);
    for (size_t e = 0; e < p->count; e++) {
        const size_t i = p->near[e];
        p->x[i] = clamp(0.0, p->lo[i], p->hi[i]);
    }
}

/* x = the solution with the sets and the factor as they are. Returns 1 if its gradient is rounding. */
static int box_solve_sets(struct box_qp *p)
{
    forget_low(p);
    for (size_t e = 0; e < p->count; e++) {
        const size_t i = p->near[e];
        p->x[i] = p->at[i] == AT_LOWER ? p->lo[i] : p->at[i] == AT_UPPER ? p->hi[i] : p->x[i];
    }
    for (size_t d = 0; d < p->sets->dependents; d++) {
        const size_t i = p->order[p->sets->rank + d];
        p->x[i] = clamp(p->x[i], p->lo[i], p->hi[i]);
    }
    tribo_box_gradients(p);
    box_refine(p);
    return box_settled(p, TRIBO_SETTLED, NULL);
}

/* Patience as with block pivoting (Judice and Pires 1994, Comput. Oper. Res. 21, 587): it ends when the number of changes has
 * reached no new low for a while. */
static int box_primal_dual(struct box_qp *p)
{
    size_t least = SIZE_MAX;
    for (int patience = 10; patience > 0; patience--) {
        int found = box_solve_sets(p);
        if (!found) { /* rounding of many changes in the factor, or of large forces of earlier calls */
            tribo_factor_rebuild(p, NULL);
            box_forget(p);
            found = box_solve_sets(p);
        }
        if (box_revise(p)) {
            return found;
        }
        /* A dependent that is to go to a bound so far away that its pull is rounding beside its force there. */
        int hides = 0;
        for (size_t k = p->sets->rank; k < p->sets->rank + p->sets->dependents; k++) {
            const size_t i = p->order[k];
            const double bound = p->to[i] == AT_LOWER ? p->lo[i] : p->to[i] == AT_UPPER ? p->hi[i] : 0.0;
            hides |= p->rounding.part[i] * fabs(bound) > product(fabs(p->gradient[i]), p->scale[i] * p->scale[i]);
        }
        if (hides) {
            return 0;
        }
        const size_t changes = box_change_all(p);
        if (changes < least) {
            least = changes;
            patience = 11;
        }
    }
    return 0;
}

/* ------------------------------------------------------------------------------------------------ primal active set */

/* box_advance; a contact that meets a bound stays there. Returns 1 if one did. */
static int box_move(struct box_qp *p, double longest)
{
    const size_t hit = box_advance(p, longest);
    if (hit == p->group->size) {
        return 0;
    }
    tribo_box_change(p, hit, p->step[hit] > 0.0 ? AT_UPPER : AT_LOWER);
    return 1;
}

/* error [size] = rounding errors of the free x; 0 elsewhere. */
static void find_doubt(const struct box_qp *p, double *error)
{
    memset(error, 0, p->group->size * sizeof *error);
    for (size_t k = 0; k < p->sets->rank + p->sets->dependents; k++) {
        const size_t i = p->order[k];
        error[i] = p->noise[i] * p->scale[i] * p->scale[i];
    }
}

double tribo_box_doubt(const struct box_qp *p, size_t i)
{
    double doubt;
    find_doubt(p, p->spare[0]);
    tribo_row_dot(p, i, p->spare[0], &doubt);
    return p->noise[i] + doubt;
}

/* Returns the contact whose pull is the largest in parts of its rounding and that of the free x, or size if all are within it: of
 * the dependents, or of the contacts at a bound. */
static size_t box_worst(const struct box_qp *p, int dependent)
{
    const struct group *g = p->group;
    size_t found = g->size;
    double most = 1.0;
    find_doubt(p, p->spare[0]);
    for (size_t e = 0; e < (dependent ? p->sets->dependents : p->count); e++) {
        const size_t i = dependent ? p->order[p->sets->rank + e] : p->near[e];
        const double pull = dependent ? fabs(p->gradient[i]) : p->lo[i] < p->hi[i] ? (double)p->at[i] * p->gradient[i] : 0.0;
        double doubt = 0.0, excess = 0.0;
        if (box_pulls(p, i, pull)) {
            tribo_row_dot(p, i, p->spare[0], &doubt);
            excess = quotient(pull, greater(tribo_box_tolerance(p, i) + doubt, DBL_MIN));
        }
        if (excess > most) {
            most = excess;
            found = i;
        }
    }
    return found;
}

/* Moves x down along the null vector in which the dependent d moves by 1, to a bound, or to the minimum if R is not quite
 * singular. */
static int box_slide(struct box_qp *p, size_t d)
{
    double size;
    const double pull = p->gradient[d];
    memset(p->step, 0, p->group->size * sizeof *p->step);
    memset(p->low.step, 0, p->group->size * sizeof *p->low.step);
    tribo_null_vector(p, d, p->step);
    for (size_t k = 0; pull > 0.0 && k < p->sets->rank + p->sets->dependents; k++) {
        p->step[p->order[k]] *= -1.0;
    }
    double curvature = 0.0; /* with twice as many digits R is singular along a null vector */
    if (!p->twofold) {
        curvature = fabs(tribo_row_dot(p, d, p->step, &size));
        curvature = greater(curvature, tribo_resolution(p->group->size) * size);
    }
    return box_move(p, quotient(fabs(pull), greater(curvature, DBL_MIN)));
}

/* Newton's step, to the first bound. Returns 1 if there is one. */
static int box_descend(struct box_qp *p)
{
    tribo_box_gradients(p);
    box_newton(p);
    return box_move(p, 1.0);
}

/* Returns 1 if the gradients of the independent x are rounding of x: beside large forces which redundant contacts hold against
 * each other, a force of 0 cannot be found to its own rounding. */
static int box_hidden(const struct box_qp *p)
{
    find_doubt(p, p->spare[0]);
    return box_settled(p, TRIBO_SETTLED, p->spare[0]);
}

/* Each round lowers the objective, or takes an x out of the set: no set returns. */
static int box_primal(struct box_qp *p)
{
    int anew = 0;
    memcpy(p->to, p->at, p->group->size);
    forget_low(p);
    for (size_t e = 0; e < p->count; e++) {
        const size_t i = p->near[e];
        p->x[i] = clamp(p->x[i], p->lo[i], p->hi[i]);
        p->to[i] = p->x[i] <= p->lo[i] ? AT_LOWER : p->x[i] >= p->hi[i] ? AT_UPPER : FREE;
    }
    box_change_all(p);
    for (size_t round = 0; round < 100 + 20 * p->count; round++) {
        if (box_descend(p)) {
            continue;
        }
        tribo_box_gradients(p);
        const size_t d = box_worst(p, 1);
        if (d < p->group->size) {
            box_slide(p, d);
            continue;
        }
        if (box_descend(p)) {
            continue;
        }
        tribo_box_gradients(p);
        const size_t i = box_worst(p, 0);
        if (i < p->group->size) {
            tribo_box_change(p, i, FREE);
        } else if (box_settled(p, TRIBO_SETTLED, NULL) || (anew && box_hidden(p))) {
            return 1;
        } else {
            tribo_factor_rebuild(p, NULL);
            anew = 1;
        }
    }
    return 0;
}

static void box_restore(struct box_qp *p, const double *x)
{
    forget_low(p);
    for (size_t e = 0; e < p->count; e++) {
        p->x[p->near[e]] = x[p->near[e]];
    }
    tribo_box_gradients(p);
}

int tribo_box_small(struct box_qp *p)
{
    const size_t n = p->group->size;
    const struct small s = {p->r,  p->inverse, &p->sets->inverse_of, p->rounding.part, p->rounding.least, p->q, p->lo, p->hi,
                            p->to, p->x,       p->gradient};
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
            box_change_all(p);
        }
    }
    return done;
}

int tribo_box_solve(struct box_qp *p)
{
    for (size_t e = 0; (p->far || p->sets->far) && e < p->count; e++) {
        const size_t i = p->near[e];
        p->x[i] = clamp(p->x[i], p->lo[i], p->hi[i]);
    }
    p->sets->far = p->far;
    box_begin(p, 1);
    box_enter(p, 1);
    return box_primal_dual(p) || box_primal(p);
}

/* ---------------------------------------------------------------------------------------------------------- least norm
 * Where R is singular R x is unique, but x is not: x becomes the solution in the box of least norm, which depends neither on the
 * order of the contacts nor on the way to it. A primal active set method minimizes |x|^2 in the box along the null space of R
 * over the contacts without gradient: basis spans the null space, and its first vectors do not move the contacts at a bound. */

/* Rounding of null vectors, which come from a factor, in parts of that of a sum. */
#define NULL_NOISE 64.0

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
    tribo_null_project(p, vectors, p->x, p->step);
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

/* x = the solution of least norm, up to rounding. Contacts at a bound without gradient become free. Returns 0 if the solution is
 * unique. */
static int find_least_norm(struct box_qp *p)
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
        const size_t hit = box_advance(p, 1.0);
        if (hit < size && held < vectors) {
            p->null.held[held] = hit;
            held += (size_t)hold_contact(p, vectors - held, hit);
        } else if (!release_contact(p, vectors, &held)) {
            break;
        }
    }
    return vectors > 0;
}

/* x = the solution of least norm. Takes the rounding of shares, which may be much to a contact that carries little, away again if
 * x stays in its boxes. before [size] = x as it was, after [size] = x. Returns the distance of x from a solution, in parts of
 * tolerances. */
static double box_share_once(struct box_qp *p, double *before, double *after)
{
    double most = 0.0;
    int inside = 1;
    memcpy(before, p->x, p->group->size * sizeof *before);
    if (!find_least_norm(p)) {
        return 0.0;
    }
    memcpy(after, p->x, p->group->size * sizeof *after);
    tribo_box_gradients(p);
    box_refine(p);
    for (size_t k = 0; k < p->sets->rank; k++) {
        const size_t i = p->order[k];
        inside &= p->lo[i] <= p->x[i] && p->x[i] <= p->hi[i];
    }
    if (!inside) {
        box_restore(p, after);
    }
    memcpy(after, p->x, p->group->size * sizeof *after);
    /* Counts the acceleration that contact i is free to follow; all of its gradient if it exceeds a trace of the box, which may
     * be less than the tolerance. */
    for (size_t e = 0; e < p->count; e++) {
        const size_t i = p->near[e];
        const double r = p->rounding.unit[i] / greater(0.5 * p->hi[i] - 0.5 * p->lo[i], DBL_MIN);
        const double off = clamp(-p->gradient[i], r * (p->lo[i] - p->x[i]), r * (p->hi[i] - p->x[i]));
        const double counts = fabs(off) > TRIBO_MISSED * p->rounding.unit[i] ? fabs(p->gradient[i]) : fabs(off);
        most = greater(most, quotient(counts, greater(tribo_box_tolerance(p, i), DBL_MIN)));
    }
    return most;
}

/* Large forces of earlier calls may have left too much rounding: then solves anew from x = 0. Where that does not help, contacts
 * share as they did before. */
void tribo_box_share(struct box_qp *p)
{
    double *before = p->spare[0], *after = p->spare[1];
    double violation = box_share_once(p, before, after);
    if (violation > TRIBO_SETTLED) {
        box_forget(p);
        box_enter(p, 0);
        if (box_primal_dual(p)) {
            violation = box_share_once(p, before, after);
        }
    }
    if (violation > TRIBO_SETTLED) {
        box_restore(p, before);
    }
}

/* --------------------------------------------------------------------------------------------------- the linear system */

/* x = the solution of R x + q = 0 of least norm, or the least-squares one, by the factor as it is. Returns 1 if there is one. */
static int minimum_norm(struct box_qp *p)
{
    forget_low(p);
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
            tribo_null_project(p, vectors, p->gradient, p->gradient);
            for (size_t e = 0; e < p->count; e++) {
                const size_t i = p->near[e];
                consistent &= pass > 0 || fabs(p->step[i] - p->gradient[i]) <= rounding + disagreement(p, i);
            }
        } else if (pass > 0 && box_settled(p, 1.0, NULL)) {
            break;
        }
        box_newton(p);
        if (vectors) { /* projections have the digits of a double */
            tribo_null_project(p, vectors, p->step, p->step);
            memset(p->low.step, 0, p->group->size * sizeof *p->low.step);
        }
        for (size_t e = 0; e < p->count; e++) {
            const size_t i = p->near[e];
            p->x[i] = box_moved(p, i);
        }
    }
    tribo_box_gradients(p);
    /* Without null vectors the system is consistent if the dependents have no gradient. */
    for (size_t d = 0; d < p->sets->dependents && !vectors; d++) {
        const size_t i = p->order[p->sets->rank + d];
        consistent &= fabs(p->gradient[i]) <= 16.0 * p->noise[i] + disagreement(p, i);
    }
    return consistent;
}

int tribo_box_linear(struct box_qp *p)
{
    p->sets->far = p->far;
    box_begin(p, 0);
    box_enter(p, 0);
    int consistent = minimum_norm(p);
    /* The rank of a factor made row by row may differ from that of one with the largest pivots first. */
    if (!consistent || !box_settled(p, TRIBO_SETTLED, NULL)) {
        tribo_factor_rebuild(p, NULL);
        consistent = minimum_norm(p);
    }
    return consistent;
}
