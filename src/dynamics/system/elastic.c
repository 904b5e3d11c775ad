#include "elastic.h"
#include "common/real.h"

#include <math.h>
#include <string.h>

static int is_elastic(const tribo_system *sys, size_t i)
{
    return tribo_massless_touches(&sys->massless, i);
}

/* J_i x, and the size of its terms. */
static double displaced(const tribo_system *sys, size_t i, const double *x, double *size)
{
    const struct matrix *j = &sys->direction;
    double sum = 0.0;
    for (size_t k = j->first[i]; k < j->first[i + 1]; k++) {
        sum += j->val[k] * x[j->col[k]];
        *size += fabs(j->val[k] * x[j->col[k]]);
    }
    return sum;
}

void tribo_elastic_forces(const tribo_system *sys, const double *q, double *work, double *force, double *size)
{
    const struct massless *w = &sys->massless;
    memcpy(work, q, sys->ndof * sizeof *work);
    tribo_massless_follow(w, work);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (is_elastic(sys, i)) {
            double terms = 0.0;
            const double way = displaced(sys, i, q, &terms) - displaced(sys, i, work, &terms);
            force[i] = way / w->compliance[i];
            if (size) {
                size[i] = terms / w->compliance[i];
            }
        }
    }
}

void tribo_elastic_give(const tribo_system *sys, const double *f, double *x)
{
    tribo_massless_follow(&sys->massless, x);
    tribo_matrix_multiply_add(&sys->massless.give, 1.0, f, x);
}

void tribo_elastic_move(const tribo_system *sys, const signed char *slip, const double *base, double *u, double *rate)
{
    const struct massless *w = &sys->massless;
    tribo_massless_follow(w, u);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const int holds = is_elastic(sys, i) && slip[i] == 0;
        rate[i] = holds ? (base[i] - tribo_matrix_row_dot(&sys->direction, i, u)) / w->compliance[i] : 0.0;
    }
    tribo_matrix_multiply_add(&w->give, 1.0, rate, u);
}

void tribo_elastic_enter(const tribo_system *sys, const double *limit, double *work, double *force, double *y)
{
    tribo_elastic_forces(sys, y, work, force, NULL);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (is_elastic(sys, i)) {
            const double within = clamp(force[i], -limit[i], limit[i]);
            y[2 * sys->ndof] += sys->tally[i] * within * (force[i] - within) * sys->massless.compliance[i];
            force[i] = within;
        }
    }
    tribo_elastic_give(sys, force, y);
}

void tribo_elastic_perturb(const tribo_system *sys, const signed char *slip, size_t columns, double *v, double *work)
{
    const size_t n = sys->ndof;
    double *x = work, *force = work + 2 * n;
    memset(force, 0, sys->ncontact * sizeof *force);
    for (size_t j = 0; j < columns; j++) {
        for (size_t d = 0; d < n; d++) {
            x[d] = v[d * columns + j];
        }
        tribo_elastic_forces(sys, x, work + n, force, NULL);
        for (size_t i = 0; i < sys->ncontact; i++) {
            force[i] = slip[i] == 0 ? force[i] : 0.0;
        }
        tribo_elastic_give(sys, force, x);
        for (size_t d = 0; d < n; d++) {
            v[d * columns + j] = x[d];
            v[(n + d) * columns + j] = sys->massless.is[d] ? 0.0 : v[(n + d) * columns + j];
        }
    }
}
