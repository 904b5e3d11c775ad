/* SPDX-License-Identifier: BSD-3-Clause */
#include "delassus.h"
#include "system.h"
#include "common/layout.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* -------------------------------------------------------------------------------------------------------------- life */

void tribo_compliance_free(struct compliance *g)
{
    free(g->contact);
    tribo_destroy(g->box);
    tribo_matrix_free(&g->pull);
    if (g->g) {
        tribo_definite_free(g->g);
    }
    free(g->g);
    memset(g, 0, sizeof *g);
}

/* Sets stiffest, structure, added, tightest, by the bound |G^-1| |J| of forces per displacement. Returns 0 if out of memory. */
static int find_stiffest(tribo_system *sys)
{
    const size_t n = sys->ndof;
    struct compliance *g = &sys->compliance;
    double *one = malloc((2 * n + sys->ncontact + 1) * sizeof *one), *rate = one + n, *force = one + 2 * n;
    if (!one) {
        return 0;
    }
    for (size_t d = 0; d < n; d++) {
        one[d] = 1.0;
    }
    memset(rate, 0, (n + sys->ncontact) * sizeof *rate);
    tribo_matrix_add_sizes(&sys->direction, one, force);
    tribo_definite_solve_sizes(g->g, force);
    tribo_matrix_add_sizes(&sys->stiffness, one, rate);
    tribo_matrix_add_sizes(&g->pull, force, rate);
    g->stiffest = tribo_largest(rate, n);
    for (size_t d = 0; d < sys->stiffness.rows; d++) {
        g->structure = greater(g->structure, tribo_matrix_get(&sys->stiffness, d, d));
        for (size_t e = g->pull.first[d]; e < g->pull.first[d + 1]; e++) {
            const double added = fabs(g->pull.val[e]) * force[g->pull.col[e]];
            g->tightest = added > g->added ? g->pull.col[e] : g->tightest;
            g->added = greater(g->added, added);
        }
    }
    free(one);
    return 1;
}

int tribo_compliance_create(tribo_system *sys, const double *own, const double *entries, size_t *where)
{
    struct compliance *g = &sys->compliance;
    const int room = ALLOCATE(ARRAY(g->contact, sys->ncontact), ARRAY(g->lo, sys->ncontact), ARRAY(g->hi, sys->ncontact),
                              ARRAY(g->f, sys->ncontact)) != NULL;
    g->g = calloc(1, sizeof *g->g);
    int status = room && g->g ? tribo_definite_create(g->g, sys->ncontact, own, entries, where) : TRIBO_ERR_MEMORY;
    status = status ? status : tribo_create(&g->box, sys->ncontact);
    status = status ? status : entries ? tribo_set_operator_dense(g->box, entries) : tribo_set_operator_diagonal(g->box, own);
    if (status) {
        return status;
    }
    g->own = g->g->own;
    for (size_t i = 0; i < sys->ncontact; i++) {
        g->contact[g->count] = i;
        g->count += own[i] > 0.0;
    }
    struct triplets pull = {0};
    double *x = malloc((sys->ndof + 1) * sizeof *x);
    for (size_t k = 0; x && k < g->count; k++) {
        tribo_matrix_get_row(&sys->direction, g->contact[k], x);
        tribo_system_solve_mass(sys, x);
        for (size_t d = 0; d < sys->ndof; d++) {
            tribo_triplets_put(&pull, d, g->contact[k], x[d]);
        }
    }
    const int done = tribo_triplets_finish(&pull, sys->ndof, sys->ncontact, &g->pull) && x && find_stiffest(sys);
    free(x);
    return done ? TRIBO_OK : TRIBO_ERR_MEMORY;
}

/* Largest stiffness of a compliant contact, relative to the structure. At this ratio the compliance changes a motion by 1e-8 of
 * the motion, and the rounding of displacements changes the force by 1e-8 of the force: the contact should be rigid. */
#define MOST_STIFF 1e8

int tribo_compliance_check(const tribo_system *sys)
{
    const struct compliance *g = &sys->compliance;
    const double omega = tribo_system_load_frequency(sys), own = greater(g->structure, omega * omega);
    if (!g->count || own == 0.0 || g->added <= MOST_STIFF * own) {
        return TRIBO_OK;
    }
    return tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                       "the elastic contact %zu gives way by %g, and makes omega^2 = %g of %g: a contact more than %g "
                       "times as stiff as the structure is rigid: leave out its spring, or take moreau/fixed",
                       g->tightest, g->own[g->tightest], g->added, own, MOST_STIFF);
}

/* ------------------------------------------------------------------------------------------------------------ forces */

void tribo_compliance_get(const tribo_system *sys, const double *y, double *force)
{
    const struct compliance *g = &sys->compliance;
    memset(force, 0, sys->ncontact * sizeof *force);
    for (size_t k = 0; k < g->count; k++) {
        force[g->contact[k]] = y[2 * sys->ndof + k];
    }
}

void tribo_compliance_put(const tribo_system *sys, const double *force, double *y)
{
    const struct compliance *g = &sys->compliance;
    for (size_t k = 0; k < g->count; k++) {
        y[2 * sys->ndof + k] = force[g->contact[k]];
    }
}

void tribo_compliance_solve(const tribo_system *sys, const signed char *slip, size_t columns, double *x)
{
    if (sys->compliance.g) {
        tribo_definite_solve(sys->compliance.g, slip, columns, x);
    } else {
        memset(x, 0, sys->ncontact * columns * sizeof *x);
    }
}

void tribo_compliance_give(const tribo_system *sys, size_t columns, const double *f, double *x)
{
    memset(x, 0, sys->ncontact * columns * sizeof *x);
    if (sys->compliance.g) {
        tribo_definite_multiply_add(sys->compliance.g, columns, f, x);
    }
}

void tribo_system_find_ways(const tribo_system *sys, size_t columns, const double *v, double *f, double *way)
{
    memset(f, 0, sys->ncontact * columns * sizeof *f);
    for (size_t k = 0; k < sys->compliance.count; k++) {
        memcpy(f + sys->compliance.contact[k] * columns, v + (2 * sys->ndof + k) * columns, columns * sizeof *v);
    }
    tribo_compliance_give(sys, columns, f, way);
    tribo_matrix_add_columns(&sys->direction, 1.0, columns, v, way);
}

void tribo_compliance_share(const struct compliance *g, double *v)
{
    if (tribo_solve_box(g->box, v, g->lo, g->hi, g->f)) {
        memset(g->f, 0xff, g->g->n * sizeof *g->f); /* NaN: the states that follow fail */
    }
    tribo_definite_multiply_add(g->g, 1, g->f, v);
    for (size_t i = 0; i < g->g->n; i++) {
        v[i] = g->lo[i] < g->f[i] && g->f[i] < g->hi[i] ? 0.0 : v[i];
    }
}

/* v += G slide; rate_A = -G_AA^-1 v_A, v += G rate, over the compliant contacts A at rest. */
void tribo_compliance_rates(const tribo_system *sys, const signed char *slip, const double *slide, size_t columns, double *v,
                            double *rate)
{
    memset(rate, 0, sys->ncontact * columns * sizeof *rate);
    if (sys->compliance.count == 0) {
        return;
    }
    if (slide) {
        tribo_definite_multiply_add(sys->compliance.g, columns, slide, v);
    }
    tribo_add(rate, -1.0, v, sys->ncontact * columns);
    tribo_compliance_solve(sys, slip, columns, rate);
    tribo_definite_multiply_add(sys->compliance.g, columns, rate, v);
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (tribo_is_compliant(&sys->compliance, i) && slip[i] == TRIBO_SLIP_STUCK) {
            memset(v + i * columns, 0, columns * sizeof *v);
        }
        if (slide && tribo_is_compliant(&sys->compliance, i)) {
            tribo_add(rate + i * columns, 1.0, slide + i * columns, columns);
        }
    }
}

void tribo_compliance_noise(const tribo_system *sys, const double *q, double *noise)
{
    const struct compliance *g = &sys->compliance;
    memset(noise, 0, sys->ncontact * sizeof *noise);
    for (size_t k = 0; k < g->count; k++) {
        noise[g->contact[k]] = TRIBO_SPRING_NOISE * tribo_matrix_row_size(&sys->direction, g->contact[k], q);
    }
    if (g->count) {
        tribo_definite_solve_sizes(g->g, noise);
    }
}

void tribo_compliance_move(const tribo_system *sys, const double *y, double *v, double *rate)
{
    const struct compliance *g = &sys->compliance;
    double *limit = sys->work.put_limit, *noise = sys->work.dv_dt, *rise = g->f;
    tribo_system_limits(sys, limit, rise);
    tribo_compliance_noise(sys, y, noise);
    tribo_compliance_get(sys, y, rate);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const int at_limit = fabs(rate[i]) >= limit[i] - TRIBO_SPRING_ALLOWED * noise[i];
        const int open = !tribo_is_compliant(g, i) || limit[i] < 0.0 || (limit[i] == 0.0 && !(rise[i] > 0.0));
        g->lo[i] = open ? 0.0 : at_limit && rate[i] <= 0.0 && (rate[i] < 0.0 || rise[i] > 0.0) ? -rise[i] : -TRIBO_UNBOUNDED;
        g->hi[i] = open ? 0.0 : at_limit && rate[i] >= 0.0 && (rate[i] > 0.0 || rise[i] > 0.0) ? rise[i] : TRIBO_UNBOUNDED;
    }
    tribo_compliance_share(g, v);
    memcpy(rate, g->f, sys->ncontact * sizeof *rate);
}

/* The change of the forces to within their limits minimizes f'G f. */
void tribo_compliance_enter(const tribo_system *sys, const double *limit, double *force, double *y)
{
    const struct compliance *g = &sys->compliance;
    double *way = sys->work.dv_dt;
    int beyond = 0;
    tribo_compliance_get(sys, y, force);
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double most = tribo_is_compliant(g, i) ? limit[i] : 0.0;
        beyond |= most < fabs(force[i]);
        g->lo[i] = -most - force[i];
        g->hi[i] = most - force[i];
        way[i] = 0.0;
    }
    if (!beyond) {
        return;
    }
    tribo_compliance_share(g, way);
    for (size_t k = 0; k < g->count; k++) {
        const size_t i = g->contact[k];
        force[i] = g->f[i] == g->hi[i] ? limit[i] : g->f[i] == g->lo[i] ? -limit[i] : force[i] + g->f[i];
        y[tribo_system_energy(sys)] -= sys->tally[i] * force[i] * way[i];
    }
    tribo_compliance_put(sys, force, y);
}

/* f_A += G_AA^-1 G_AS (f_S - s) over the sets A at rest and S of sliding contacts, then f_S = s = -slip (limit(q) + rise). */
void tribo_compliance_perturb(const tribo_system *sys, const signed char *slip, const double *rise, size_t columns, double *v,
                              double *work)
{
    const struct compliance *g = &sys->compliance;
    const struct matrix *j = &sys->direction;
    const size_t c = sys->ncontact, row = columns * sizeof *v;
    double *f = v + 2 * sys->ndof * columns, *way = work + c * columns;
    memset(work, 0, c * row);
    for (size_t k = 0; k < g->count; k++) {
        if (slip[g->contact[k]] != TRIBO_SLIP_STUCK) {
            memcpy(work + g->contact[k] * columns, f + k * columns, row);
            memset(f + k * columns, 0, row);
            const struct follower *own = tribo_normals_follower(sys, g->contact[k]);
            const struct normal *n = own ? &sys->normals.normal[own->normal] : NULL;
            const signed char side = slip[g->contact[k]];
            const double *own_rise = rise && side != TRIBO_SLIP_OPEN ? rise + g->contact[k] * columns : NULL;
            tribo_add(f + k * columns, -side, own_rise, own_rise ? columns : 0);
            tribo_add(work + g->contact[k] * columns, side, own_rise, own_rise ? columns : 0);
            for (size_t e = n && side != TRIBO_SLIP_OPEN ? j->first[n->row] : 0;
                 n && side != TRIBO_SLIP_OPEN && e < j->first[n->row + 1]; e++) {
                const double slope = -side * own->mu * n->stiffness * j->val[e];
                tribo_add(f + k * columns, slope, v + j->col[e] * columns, columns);
                tribo_add(work + g->contact[k] * columns, -slope, v + j->col[e] * columns, columns);
            }
        }
    }
    tribo_compliance_give(sys, columns, work, way);
    tribo_compliance_solve(sys, slip, columns, way);
    for (size_t k = 0; k < g->count; k++) {
        tribo_add(f + k * columns, 1.0, way + g->contact[k] * columns, columns);
    }
}
