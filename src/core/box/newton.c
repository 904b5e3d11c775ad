/* The gradient of a group's problem, what of it may be rounding, and Newton's step over the free contacts that takes it to zero.
 */
#include "box_qp.h"

#include <float.h>
#include <math.h>

/* So much of the first terms is no gradient at all, though it may be all that there is. */
#define NOTHING 1e-45

/* Rounding of a graded group's terms beside that of doubles. */
#define GRADED_PART 0x1p-50

/* The gradient of i is found, its terms being of this size, and what of it is rounded of that. */
static inline void set_noise(struct box_qp *p, size_t i, double terms, double rounded, int first)
{
    p->first[i] = first ? terms : p->first[i];
    p->noise[i] = tribo_resolution(p->terms[i]) * rounded + NOTHING * p->first[i];
}

/* Of terms some may have underflowed. A graded group's forces and R are as good as
 * exact, and what it knows of q is q. */
static inline void find_gradients(struct box_qp *p, int first)
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

void tribo_box_gradients(struct box_qp *p, int first)
{
    if (first) {
        find_gradients(p, 1);
    } else {
        find_gradients(p, 0);
    }
}

static void rest_dependents(struct box_qp *p)
{
    for (size_t k = p->sets->rank; k < p->sets->rank + p->sets->dependents; k++) {
        p->step[p->order[k]] = p->step_low[p->order[k]] = 0.0;
    }
}

void tribo_box_downhill(struct box_qp *p)
{
    for (size_t k = 0; k < p->sets->rank; k++) {
        p->step[p->order[k]] = -p->gradient[p->order[k]];
        p->step_low[p->order[k]] = 0.0;
    }
    tribo_factor_solve(p, p->step);
    rest_dependents(p);
}

void tribo_box_newton(struct box_qp *p)
{
    if (p->twofold) {
        tribo_graded_newton(p);
        rest_dependents(p);
    } else {
        tribo_box_downhill(p);
    }
}

void tribo_box_begin(struct box_qp *p, int bounded)
{
    p->twofold = p->group->graded && tribo_graded_fits(p, bounded);
    p->pull = 0.0;
    for (size_t e = 0; p->twofold && e < p->count; e++) {
        p->pull = greater(p->pull, fabs(p->q[p->near[e]]));
    }
}

double tribo_box_moved(struct box_qp *p, size_t i)
{
    const double x = p->twofold ? tribo_graded_move(p, i, 1.0) : p->x[i] + p->step[i];
    return p->far ? tribo_cut(p, i, x) : cut(x);
}
