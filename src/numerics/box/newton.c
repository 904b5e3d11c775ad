/* The gradient of a group's problem, its rounding, and Newton's step, which takes the gradient of free contacts to zero. */
#include "box_qp.h"

#include <float.h>
#include <math.h>

/* Rounding of the terms of a graded group, in parts of that of doubles. */
#define GRADED_PART 0x1p-50

/* Sets noise_i from the size of the terms of gradient_i that are rounded, and the largest force, by which forces underflow. */
static inline void set_noise(struct box_qp *p, size_t i, double rounded, double most)
{
    p->noise[i] = p->rounding.part[i] * (rounded + p->rounding.least[i] * most);
}

/* Forces and R of a graded group are as good as exact: only q is rounded. */
void tribo_box_gradients(struct box_qp *p)
{
    double most = 1.0, size, low;
    for (size_t i = 0; p->far && i < p->group->size; i++) {
        most = greater(most, fabs(p->x[i]));
    }
    most = lesser(most, TRIBO_FAR);
    for (size_t e = 0; !p->twofold && e < p->count; e++) {
        const size_t i = p->near[e];
        p->gradient[i] = tribo_row_dot(p, i, p->x, &size) + p->q[i];
        set_noise(p, i, size + fabs(p->q[i]), most);
    }
    for (size_t e = 0; p->twofold && e < p->count; e++) {
        const size_t i = p->near[e];
        p->gradient[i] = tribo_graded_gradient(p, i, &low, &size);
        set_noise(p, i, fabs(p->q[i]) + GRADED_PART * size, most);
    }
}

static void rest_dependents(struct box_qp *p)
{
    for (size_t k = p->sets->rank; k < p->sets->rank + p->sets->dependents; k++) {
        p->step[p->order[k]] = p->low.step[p->order[k]] = 0.0;
    }
}

void tribo_box_downhill(struct box_qp *p)
{
    for (size_t k = 0; k < p->sets->rank; k++) {
        p->step[p->order[k]] = -p->gradient[p->order[k]];
        p->low.step[p->order[k]] = 0.0;
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

double tribo_box_moved(struct box_qp *p, size_t i)
{
    const double x = p->twofold ? tribo_graded_move(p, i, 1.0) : p->x[i] + p->step[i];
    return p->far ? tribo_cut(p, i, x) : cut(x);
}
