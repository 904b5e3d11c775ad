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

/* x [ncontact][columns] = C_HH^-1 x over the elastic contacts H with slip 0 (all elastic contacts: NULL); 0 for the others. */
static void solve_compliance(const tribo_system *sys, const signed char *slip, size_t columns, double *x)
{
    const struct massless *w = &sys->massless;
    if (w->shared) {
        tribo_definite_solve(w->shared, slip, columns, x);
        return;
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        const int holds = is_elastic(sys, i) && (!slip || slip[i] == TRIBO_SLIP_STUCK);
        for (size_t j = i * columns; j < (i + 1) * columns; j++) {
            x[j] = holds ? x[j] / w->compliance[i] : 0.0;
        }
    }
}

/* way [ncontact] = J (x - w), w following; of elastic contacts only. size as tribo_elastic_forces, not divided by C. */
static void stretch_springs(const tribo_system *sys, const double *x, double *work, double *way, double *size)
{
    memcpy(work, x, sys->ndof * sizeof *work);
    tribo_massless_follow(&sys->massless, work);
    for (size_t i = 0; i < sys->ncontact; i++) {
        double terms = 0.0;
        way[i] = is_elastic(sys, i) ? displaced(sys, i, x, &terms) - displaced(sys, i, work, &terms) : 0.0;
        if (size) {
            size[i] = terms;
        }
    }
}

/* By being elastic a contact this many times as stiff as all else changes a motion by 1e-8 of it, and the rounding of places
 * changes its force by as much; a stiffer one had better be rigid. */
#define MOST_STIFF 1e8

int tribo_elastic_check(const tribo_system *sys)
{
    const struct massless *w = &sys->massless;
    double own = w->own;
    for (size_t s = 0; s < sys->harmonics; s++) {
        own = greater(own, sys->harmonic[s].omega * sys->harmonic[s].omega);
    }
    if (!w->count || own == 0.0 || w->added <= MOST_STIFF * own) {
        return TRIBO_OK;
    }
    return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
                             "the elastic contact %zu gives way by %g, and makes omega^2 = %g of %g: a contact more than %g "
                             "times as stiff as the structure is rigid: leave out its spring, or take moreau/fixed",
                             w->tightest, w->compliance[w->tightest], w->added, own, MOST_STIFF);
}

void tribo_elastic_forces(const tribo_system *sys, const double *q, double *work, double *force, double *size)
{
    stretch_springs(sys, q, work, force, size);
    solve_compliance(sys, NULL, 1, force);
    if (size) {
        tribo_elastic_sizes(sys, size);
    }
}

void tribo_elastic_sizes(const tribo_system *sys, double *force)
{
    struct definite *c = sys->massless.shared;
    if (!c) {
        solve_compliance(sys, NULL, 1, force);
        return;
    }
    memcpy(c->x, force, c->n * sizeof *force);
    for (size_t i = 0; i < c->n; i++) {
        force[i] = 0.0;
        for (size_t k = 0; k < c->n; k++) {
            force[i] += fabs(c->inverse[i * c->n + k]) * c->x[k];
        }
    }
}

void tribo_elastic_answer(const tribo_system *sys, const signed char *slip, const double *q, double *work, double *force)
{
    stretch_springs(sys, q, work, force, NULL);
    solve_compliance(sys, slip, 1, force);
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
        rate[i] = is_elastic(sys, i) ? base[i] - tribo_matrix_row_dot(&sys->direction, i, u) : 0.0;
    }
    solve_compliance(sys, slip, 1, rate);
    tribo_matrix_multiply_add(&w->give, 1.0, rate, u);
}

/* q = factor C f. */
static void multiply_compliance(struct definite *c, double factor, const double *f, double *q)
{
    memset(q, 0, c->n * sizeof *q);
    tribo_multiply_add(c->n, c->n, 1, factor, c->matrix, f, q);
}

double tribo_elastic_bound(const tribo_system *sys, const double *limit, double *force)
{
    struct definite *c = sys->massless.shared;
    double energy = 0.0;
    int beyond = 0;
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double most = is_elastic(sys, i) ? limit[i] : 0.0, within = clamp(force[i], -most, most);
        beyond |= is_elastic(sys, i) && within != force[i];
        if (c) {
            c->lo[i] = -most;
            c->hi[i] = most;
        } else if (is_elastic(sys, i)) {
            energy += sys->tally[i] * within * (force[i] - within) * sys->massless.compliance[i];
            force[i] = within;
        }
    }
    if (!c || !beyond) {
        return energy;
    }
    multiply_compliance(c, -1.0, force, c->q);
    tribo_definite_box(c);
    for (size_t i = 0; i < c->n; i++) {
        force[i] = is_elastic(sys, i) ? force[i] - c->f[i] : 0.0;
    }
    multiply_compliance(c, 1.0, force, c->q);
    for (size_t i = 0; i < c->n; i++) {
        energy += sys->tally[i] * c->f[i] * c->q[i];
        force[i] = c->f[i];
    }
    return energy;
}
void tribo_elastic_enter(const tribo_system *sys, const double *limit, double *work, double *force, double *y)
{
    tribo_elastic_forces(sys, y, work, force, NULL);
    y[2 * sys->ndof] += tribo_elastic_bound(sys, limit, force);
    tribo_elastic_give(sys, force, y);
}

void tribo_elastic_share_rates(struct definite *c, double *v)
{
    memcpy(c->q, v, c->n * sizeof *v);
    tribo_definite_box(c);
    tribo_multiply_add(c->n, c->n, 1, 1.0, c->matrix, c->f, v);
    for (size_t i = 0; i < c->n; i++) {
        v[i] = c->f[i] != 0.0 ? 0.0 : v[i];
    }
}

/* v [ncontact]: velocities of elastic contacts if all slide, in; with these forces, out. limit, slack [ncontact]. */
static void slide_sliders(const tribo_system *sys, const double *force, const double *limit, const double *slack, double *v)
{
    struct definite *c = sys->massless.shared;
    for (size_t i = 0; i < sys->ncontact; i++) {
        const int elastic = is_elastic(sys, i), at_limit = fabs(force[i]) >= limit[i] - slack[i];
        const int slides = elastic && (limit[i] == 0.0 || (at_limit && force[i] * v[i] < 0.0));
        if (c) {
            v[i] = elastic ? v[i] : 0.0;
            c->lo[i] = !elastic || limit[i] == 0.0 || (at_limit && force[i] < 0.0) ? 0.0 : -HUGE_VAL;
            c->hi[i] = !elastic || limit[i] == 0.0 || (at_limit && force[i] > 0.0) ? 0.0 : HUGE_VAL;
        } else {
            v[i] = slides ? v[i] : 0.0;
        }
    }
    if (c) {
        tribo_elastic_share_rates(c, v);
    }
}

void tribo_elastic_set_velocities(tribo_system *sys, double *y)
{
    const size_t n = sys->ndof, first = n - sys->sliders;
    double *force = sys->feq, *slack = sys->a, *v = sys->v, *limit = sys->dv_dt, *base = sys->put_limit;
    tribo_elastic_forces(sys, y, sys->acceleration, force, slack);
    memset(base, 0, sys->ncontact * sizeof *base);
    tribo_system_loads(sys, DRIVES_BASE, 0, 1.0, base);
    tribo_massless_follow(&sys->massless, y + n);
    for (size_t i = 0; i < sys->ncontact; i++) {
        slack[i] *= TRIBO_SPRING_ALLOWED * TRIBO_SPRING_NOISE;
        v[i] = tribo_matrix_row_dot(&sys->direction, i, y + n) - base[i];
    }
    tribo_get_limit(sys->contacts, limit);
    slide_sliders(sys, force, limit, slack, v);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const size_t w = is_elastic(sys, i) ? sys->direction.col[sys->direction.first[i]] : 0;
        if (w >= first) {
            y[n + w] = v[i] + base[i];
        }
    }
}

/* way [ncontact][columns] += factor J v, of what has no mass. */
static void add_ways(const tribo_system *sys, double factor, size_t columns, const double *v, double *way)
{
    const struct matrix *j = &sys->direction;
    for (size_t i = 0; i < sys->ncontact; i++) {
        for (size_t e = j->first[i]; e < j->first[i + 1]; e++) {
            const double part = sys->massless.is[j->col[e]] ? factor * j->val[e] : 0.0;
            tribo_add(way + i * columns, part, v + j->col[e] * columns, part != 0.0 ? columns : 0);
        }
    }
}

/* Rows of to += rows of a [rows][..] that are not empty times rows of v. */
static void add_row_products(const struct matrix *a, size_t columns, const double *v, double *to)
{
    for (size_t d = 0; d < a->rows; d++) {
        for (size_t e = a->first[d]; e < a->first[d + 1]; e++) {
            tribo_add(to + d * columns, a->val[e], v + a->col[e] * columns, columns);
        }
    }
}

void tribo_elastic_perturb(const tribo_system *sys, const signed char *slip, size_t columns, double *v, double *work)
{
    const struct massless *w = &sys->massless;
    memset(work, 0, sys->ncontact * columns * sizeof *work);
    add_ways(sys, 1.0, columns, v, work);
    for (size_t d = 0; d < sys->ndof; d++) {
        const size_t empty = w->is[d] ? columns * sizeof *v : 0;
        memset(v + d * columns, 0, empty);
        memset(v + (sys->ndof + d) * columns, 0, empty);
    }
    add_row_products(&w->follow, columns, v, v);
    add_ways(sys, -1.0, columns, v, work);
    solve_compliance(sys, slip, columns, work);
    add_row_products(&w->give, columns, work, v);
}
