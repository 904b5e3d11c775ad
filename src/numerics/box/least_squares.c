/* The linear system of the partition coupling, R x + q = 0 over the near contacts, all of them free: its solution of least norm,
 * or its least-squares one. */
#include "box_qp.h"

#include <float.h>
#include <math.h>

/* x = that solution, with the factor as it is. Returns 1 if R x + q = 0. */
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
        (vectors ? tribo_box_downhill : tribo_box_newton)(p);
        tribo_null_project(p, vectors, p->step);
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
