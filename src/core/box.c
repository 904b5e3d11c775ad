/* The box-constrained quadratic program of an island, min 1/2 x'Rx + q'x with lo <= x <= hi, which Coulomb's law comes down to:
 * an x inside its box has no gradient, and the gradient at a bound pushes against it.
 *
 * It begins with the sets of the last call. Whole sets change at once at first (the primal-dual active set method of
 * Hintermueller, Ito and Kunisch 2002, SIAM J. Optim. 13, 865, doi:10.1137/S1052623401383558): usually none does, and the call
 * costs a solve and a look at the gradient. That method may cycle; then a primal active set method finishes, in which every
 * change lowers the objective. Either ends only when the gradient shows that x is the solution, up to its own rounding. */
#include "island.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* What a caller's rounding may do to a must not pit redundant contacts against each other: so much of its unit the gradient of
 * one may have; but not more than so much of the first terms, since limits that are never reached say nothing of rounding. */
#define DISAGREEMENT 5e-13
#define DISAGREED_TERMS 5e-9

/* So much of the first terms is no gradient at all, though it may be all that there is. */
#define NOTHING 1e-45

/* Rounding of a graded island's terms beside that of doubles. */
#define GRADED_PART 0x1p-50

/* A bound that moves by this factor is another one. */
#define FAR_AWAY 1e3

/* Refinement ends with gradients of so much rounding, or the factor is not what it should be. */
#define SETTLED 4.0

/* The gradient of i is found, its terms being of this size, and what of it is rounded of that. */
static inline void set_noise(struct program *p, size_t i, double terms, double rounded, int first)
{
    p->first[i] = first ? terms : p->first[i];
    p->noise[i] = tribo_resolution(p->terms[i]) * rounded + NOTHING * p->first[i];
}

/* first: they are the first ones of a call. Of terms some may have underflowed. A graded island's forces and R are as good as
 * exact, and what it knows of q is q. */
static void find_gradients(struct program *p, int first)
{
    double size, low;
    for (size_t e = 0; !p->twofold && e < p->count; e++) {
        const size_t i = p->near[e];
        p->gradient[i] = tribo_row_dot(p, i, p->x, &size) + p->q[i];
        const double terms = size + fabs(p->q[i]) + DBL_MIN;
        set_noise(p, i, terms, terms, first);
    }
    for (size_t e = 0; p->twofold && e < p->count; e++) {
        const size_t i = p->near[e];
        p->gradient[i] = tribo_graded_gradient(p, i, &low, &size);
        const double q = fabs(p->q[i]) + DBL_MIN;
        set_noise(p, i, size + q, q + GRADED_PART * size, first);
    }
}

void tribo_box_gradient(struct program *p)
{
    find_gradients(p, 0);
}

void tribo_box_change(struct program *p, size_t i, signed char to)
{
    const signed char from = p->at[i];
    p->at[i] = to;
    if (from == FREE && to != FREE) {
        p->work.updates++;
        tribo_factor_remove(p, i);
    } else if (from != FREE && to == FREE) {
        p->work.updates++;
        tribo_factor_add(p, i);
    }
}

/* All contacts go to their places in p->to. Returns how many were free, or are now, but not both. */
static size_t change_all(struct program *p)
{
    const size_t n = p->island->size;
    size_t changes = 0, free = 0;
    for (size_t i = 0; i < n; i++) {
        changes += (p->at[i] == FREE) != (p->to[i] == FREE);
        free += p->to[i] == FREE;
    }
    /* a change that loses contacts while others depend on them may end in a factorization of its own, over a set that is no
     * longer that of at */
    if (changes > 0 && (tribo_factor_many(p, changes, free) || (p->island->dependents && changes > 1))) {
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

/* Where the program begins with a contact that is near: where it was, unless it was not near, or its bound has gone far away, or
 * its box is a point. */
static signed char begin_at(const struct program *p, size_t i)
{
    const signed char at = p->at[i];
    if (!(p->lo[i] < p->hi[i])) {
        return AT_LOWER;
    }
    if (at == FREE || at == AWAY) {
        return FREE;
    }
    return fabs(at == AT_LOWER ? p->lo[i] : p->hi[i]) <= FAR_AWAY * fabs(p->x[i]) ? at : FREE;
}

/* Contacts that are near for the first time enter the program; those that no longer are leave it. */
static void enter(struct program *p, int keep_bounds)
{
    for (size_t e = 0; e < p->island->size; e++) {
        const size_t i = p->near[e];
        p->to[i] = e >= p->count ? AWAY : keep_bounds ? begin_at(p, i) : FREE;
    }
    change_all(p);
}

/* step = the move of the independent x that takes their gradient to zero; dependent ones stay. */
static void newton(struct program *p)
{
    const size_t rank = p->island->rank;
    if (p->twofold) {
        tribo_graded_newton(p);
    } else {
        for (size_t k = 0; k < rank; k++) {
            p->step[p->order[k]] = -p->gradient[p->order[k]];
        }
        tribo_factor_solve(p, p->step);
    }
    for (size_t k = rank; k < rank + p->island->dependents; k++) {
        p->step[p->order[k]] = p->step_low[p->order[k]] = 0.0;
    }
}

static int settled(const struct program *p, double noises)
{
    for (size_t k = 0; k < p->island->rank; k++) {
        const size_t i = p->order[k];
        if (!(fabs(p->gradient[i]) <= noises * p->noise[i])) {
            return 0;
        }
    }
    return 1;
}

/* Where the step takes x. */
static double moved(struct program *p, size_t i)
{
    const double x = p->twofold ? tribo_graded_move(p, i, 1.0) : p->x[i] + p->step[i];
    return p->far ? tribo_cut(p, i, x) : cut(x);
}

/* Takes the gradient of the independent x, which is found, to zero. */
static void refine(struct program *p)
{
    for (int pass = 0; pass < 4 && !settled(p, 1.0); pass++) {
        newton(p);
        for (size_t k = 0; k < p->island->rank; k++) {
            const size_t i = p->order[k];
            p->x[i] = moved(p, i);
        }
        tribo_box_gradient(p);
    }
}

static int outside(double x, double lo, double hi)
{
    return (x > hi) - (x < lo);
}

static double disagreement(const struct program *p, size_t i)
{
    if (!p->island->nullity) {
        return 0.0;
    }
    /* of a graded island a unit may be a billion times what counts: there the largest q is taken */
    return p->twofold ? DISAGREEMENT * p->pull : lesser(DISAGREEMENT * p->unit[i], DISAGREED_TERMS * p->first[i]);
}

double tribo_box_tolerance(const struct program *p, size_t i)
{
    return p->noise[i] + disagreement(p, i);
}

/* Where each x wants to be, in p->to. Returns whether that is where it is. */
static int revise(struct program *p)
{
    const struct island *is = p->island;
    memcpy(p->to, p->at, is->size);
    for (size_t e = 0; e < p->count; e++) {
        const size_t i = p->near[e];
        if (p->at[i] != FREE && p->lo[i] < p->hi[i] && (double)p->at[i] * p->gradient[i] > tribo_box_tolerance(p, i)) {
            p->to[i] = FREE;
        }
    }
    for (size_t k = 0; k < is->rank; k++) {
        const size_t i = p->order[k];
        p->to[i] = (signed char)outside(p->x[i], p->lo[i], p->hi[i]);
    }
    for (size_t k = is->rank; k < is->rank + is->dependents; k++) {
        const size_t i = p->order[k];
        if (fabs(p->gradient[i]) > tribo_box_tolerance(p, i)) {
            p->to[i] = p->gradient[i] > 0.0 ? AT_LOWER : AT_UPPER;
        }
    }
    return memcmp(p->to, p->at, is->size) == 0;
}

/* What rounding left of x is known of what a solver found, and of nothing else. */
static void forget_low(const struct program *p)
{
    if (p->twofold) {
        memset(p->low, 0, p->island->size * sizeof *p->low);
    }
}

static void put_at_bounds(struct program *p)
{
    forget_low(p);
    for (size_t e = 0; e < p->count; e++) {
        const size_t i = p->near[e];
        p->x[i] = p->at[i] == AT_LOWER ? p->lo[i] : p->at[i] == AT_UPPER ? p->hi[i] : p->x[i];
    }
    for (size_t d = 0; d < p->island->dependents; d++) {
        const size_t i = p->order[p->island->rank + d];
        p->x[i] = clamp(p->x[i], p->lo[i], p->hi[i]);
    }
}

/* x with the sets as they are; if rounding has gathered in the factor over many changes, with a new one. */
static void solve(struct program *p, int first)
{
    put_at_bounds(p);
    find_gradients(p, first);
    refine(p);
    if (!settled(p, SETTLED)) {
        tribo_factor_rebuild(p, NULL);
        put_at_bounds(p);
        tribo_box_gradient(p);
        refine(p);
    }
}

/* Patience as with block pivoting (Judice and Pires 1994, Comput. Oper. Res. 21, 587): it ends when the number of changes has
 * reached no new low for a while. */
static int primal_dual(struct program *p)
{
    size_t least = SIZE_MAX;
    for (int patience = 10, first = 1; patience > 0; patience--, first = 0) {
        solve(p, first);
        if (revise(p)) {
            return 1;
        }
        const size_t changes = change_all(p);
        if (changes < least) {
            least = changes;
            patience = 11;
        }
    }
    return 0;
}

/* ------------------------------------------------------------------------------------------------ primal active set */

size_t tribo_box_advance(struct program *p, double longest)
{
    const size_t all = p->island->rank + p->island->dependents;
    double length = longest;
    size_t hit = p->island->size;
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
        p->low[i] = p->x[i] == x ? p->low[i] : 0.0;
    }
    if (hit < p->island->size) {
        p->x[hit] = p->step[hit] > 0.0 ? p->hi[hit] : p->lo[hit];
        p->low[hit] = 0.0;
    }
    return hit;
}

/* The same, and who met a bound stays there. Returns 1 if one did. */
static int move(struct program *p, double longest)
{
    const size_t hit = tribo_box_advance(p, longest);
    if (hit == p->island->size) {
        return 0;
    }
    tribo_box_change(p, hit, p->step[hit] > 0.0 ? AT_UPPER : AT_LOWER);
    return 1;
}

/* error [size] = what rounding leaves of doubt about the x of the free contacts. */
static void find_doubt(const struct program *p, double *error)
{
    memset(error, 0, p->island->size * sizeof *error);
    for (size_t k = 0; k < p->island->rank + p->island->dependents; k++) {
        const size_t i = p->order[k];
        error[i] = p->noise[i] * p->scale[i] * p->scale[i];
    }
}

/* A contact whose gradient is farthest beyond rounding, its own and that of the others' x: a dependent one, or one at a bound
 * that should leave it. size if there is none. */
static size_t worst(const struct program *p, int dependent)
{
    const struct island *is = p->island;
    size_t found = is->size;
    double most = 1.0;
    find_doubt(p, p->spare[0]);
    for (size_t e = 0; e < (dependent ? is->dependents : p->count); e++) {
        const size_t i = dependent ? p->order[is->rank + e] : p->near[e];
        const double pull = dependent ? fabs(p->gradient[i]) : p->lo[i] < p->hi[i] ? (double)p->at[i] * p->gradient[i] : 0.0;
        double doubt = 0.0;
        if (pull > tribo_box_tolerance(p, i)) {
            tribo_row_dot(p, i, p->spare[0], &doubt);
        }
        const double excess = quotient(pull, greater(tribo_box_tolerance(p, i) + doubt, DBL_MIN));
        if (excess > most) {
            most = excess;
            found = i;
        }
    }
    return found;
}

/* Down along the null vector in which the dependent d moves by 1, as far as a bound; or, where R is not quite singular, to the
 * bottom. */
static int slide(struct program *p, size_t d)
{
    double size;
    const double pull = p->gradient[d];
    memset(p->step, 0, p->island->size * sizeof *p->step);
    memset(p->step_low, 0, p->island->size * sizeof *p->step_low);
    tribo_null_vector(p, d, p->step);
    for (size_t k = 0; pull > 0.0 && k < p->island->rank + p->island->dependents; k++) {
        p->step[p->order[k]] *= -1.0;
    }
    const double curvature = fabs(tribo_row_dot(p, d, p->step, &size));
    return move(p, quotient(fabs(pull), greater(greater(curvature, tribo_resolution(p->island->size) * size), DBL_MIN)));
}

/* 1 if something moved as far as a bound. */
static int descend(struct program *p)
{
    tribo_box_gradient(p);
    newton(p);
    return move(p, 1.0);
}

/* Every round lowers the objective, or takes an x out of the set, so that no set comes back. */
static int primal(struct program *p)
{
    memcpy(p->to, p->at, p->island->size);
    forget_low(p);
    for (size_t e = 0; e < p->count; e++) {
        const size_t i = p->near[e];
        p->x[i] = clamp(p->x[i], p->lo[i], p->hi[i]);
        p->to[i] = p->x[i] <= p->lo[i] ? AT_LOWER : p->x[i] >= p->hi[i] ? AT_UPPER : FREE;
    }
    change_all(p);
    for (size_t round = 0; round < 100 + 20 * p->count; round++) {
        if (descend(p)) {
            continue;
        }
        tribo_box_gradient(p);
        const size_t d = worst(p, 1);
        if (d < p->island->size) {
            slide(p, d);
            continue;
        }
        if (descend(p)) {
            continue;
        }
        tribo_box_gradient(p);
        const size_t i = worst(p, 0);
        if (i < p->island->size) {
            tribo_box_change(p, i, FREE);
        } else if (settled(p, SETTLED)) {
            return 1;
        } else {
            tribo_factor_rebuild(p, NULL);
        }
    }
    return 0;
}

/* How far x is from the fixed point, in parts of what may be rounding. */
static double violation(const struct program *p)
{
    double most = 0.0;
    for (size_t e = 0; e < p->count; e++) {
        const size_t i = p->near[e];
        const double r = p->unit[i] / greater(0.5 * p->hi[i] - 0.5 * p->lo[i], DBL_MIN);
        const double off = clamp(-p->gradient[i], r * (p->lo[i] - p->x[i]), r * (p->hi[i] - p->x[i]));
        most = greater(most, quotient(fabs(off), greater(p->noise[i], DBL_MIN)));
    }
    return most;
}

static void restore(struct program *p, const double *x)
{
    forget_low(p);
    for (size_t e = 0; e < p->count; e++) {
        p->x[p->near[e]] = x[p->near[e]];
    }
    tribo_box_gradient(p);
}

static int inside(const struct program *p)
{
    int all = 1;
    for (size_t k = 0; k < p->island->rank; k++) {
        const size_t i = p->order[k];
        all &= p->lo[i] <= p->x[i] && p->x[i] <= p->hi[i];
    }
    return all;
}

static void begin_graded(struct program *p, int bounded)
{
    p->twofold = p->island->graded && tribo_graded_fits(p, bounded);
    p->pull = 0.0;
    for (size_t e = 0; p->twofold && e < p->count; e++) {
        p->pull = greater(p->pull, fabs(p->q[p->near[e]]));
    }
}

int tribo_box_solve(struct program *p)
{
    for (size_t e = 0; (p->far || p->island->far) && e < p->count; e++) {
        const size_t i = p->near[e];
        p->x[i] = clamp(p->x[i], p->lo[i], p->hi[i]);
    }
    p->island->far = p->far;
    begin_graded(p, 1);
    enter(p, 1);
    return primal_dual(p) || primal(p);
}

/* The rounding of shares may be much to a contact that carries little: then it is taken away again, where the boxes have room for
 * that, and otherwise the contacts share as they did before. */
void tribo_box_share(struct program *p)
{
    double *before = p->spare[0], *split = p->spare[1];
    memcpy(before, p->x, p->island->size * sizeof *before);
    if (!tribo_split(p)) {
        return;
    }
    memcpy(split, p->x, p->island->size * sizeof *split);
    tribo_box_gradient(p);
    refine(p);
    if (!inside(p)) {
        restore(p, split);
    }
    const double after = violation(p);
    if (after > SETTLED) {
        memcpy(split, p->x, p->island->size * sizeof *split);
        restore(p, before);
        if (violation(p) > after) {
            restore(p, split);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ the linear system */

/* With the factor as it is. */
static int minimum_norm(struct program *p)
{
    forget_low(p);
    for (size_t e = 0; e < p->count; e++) {
        p->x[p->near[e]] = 0.0;
    }
    const size_t vectors = tribo_null_basis(p);
    int consistent = 1;
    for (int pass = 0; pass < 3; pass++) {
        find_gradients(p, pass == 0);
        if (vectors) {
            double rounding = DBL_MIN;
            for (size_t e = 0; e < p->count; e++) {
                p->step[p->near[e]] = p->gradient[p->near[e]];
                rounding = greater(rounding, 16.0 * p->noise[p->near[e]]);
            }
            tribo_project(p, vectors, p->gradient);
            for (size_t e = 0; e < p->count; e++) {
                const size_t i = p->near[e];
                consistent &= pass > 0 || fabs(p->step[i] - p->gradient[i]) <= rounding + disagreement(p, i);
            }
        } else if (pass > 0 && settled(p, 1.0)) {
            break;
        }
        newton(p);
        tribo_project(p, vectors, p->step);
        for (size_t e = 0; e < p->count; e++) {
            const size_t i = p->near[e];
            p->x[i] = moved(p, i);
        }
    }
    tribo_box_gradient(p);
    /* without null vectors those that depend on others tell by themselves */
    for (size_t d = 0; d < p->island->dependents && !vectors; d++) {
        const size_t i = p->order[p->island->rank + d];
        consistent &= fabs(p->gradient[i]) <= 16.0 * p->noise[i] + disagreement(p, i);
    }
    return consistent;
}

int tribo_box_linear(struct program *p)
{
    p->island->far = p->far;
    begin_graded(p, 0);
    enter(p, 0);
    int consistent = minimum_norm(p);
    /* a factor that grew row by row may see another rank than one that has chosen among all pivots */
    if (!consistent || !settled(p, SETTLED)) {
        tribo_factor_rebuild(p, NULL);
        consistent = minimum_norm(p);
    }
    return consistent;
}
