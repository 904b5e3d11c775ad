/* The stick sets of a group: which contacts are free and which at a bound, and their changes, with which the factor changes. */
#include "box_qp.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* A contact begins free if its bound exceeds its last force by this factor. */
#define FAR_AWAY 1e3

void tribo_box_change(struct box_qp *p, size_t i, signed char to)
{
    const signed char from = p->at[i];
    p->at[i] = to;
    if ((from == FREE) != (to == FREE)) {
        p->work.updates++;
        tribo_factor_change(p, i);
    }
}

size_t tribo_box_change_all(struct box_qp *p)
{
    const size_t n = p->group->size;
    size_t changes = 0, free = 0;
    for (size_t i = 0; i < n; i++) {
        changes += (p->at[i] == FREE) != (p->to[i] == FREE);
        free += p->to[i] == FREE;
    }
    /* Where contacts depend on others, a change may factorize anew, over at as it is then: several changes factorize once. */
    if (changes > 0 && (tribo_factor_many(p, changes, free) || (p->sets->dependents && changes > 1))) {
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

size_t tribo_box_advance(struct box_qp *p, double longest)
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

void tribo_box_enter(struct box_qp *p, int keep_bounds)
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
    tribo_box_change_all(p);
}
