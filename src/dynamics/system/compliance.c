/* SPDX-License-Identifier: BSD-3-Clause */
#include "delassus.h"
#include "system.h"
#include "common/layout.h"
#include "common/real.h"
#include "numerics/lapack.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* -------------------------------------------------------------------------------------------------------------- life */

void tribo_compliance_free(struct compliance *g)
{
    free(g->contact);
    tribo_destroy(g->box);
    tribo_matrix_free(&g->pull);
    tribo_matrix_free(&g->g);
    tribo_matrix_free(&g->inverse);
    memset(g, 0, sizeof *g);
}

/* Sets stiffest, structure, added, tightest, by the bound |G^-1| |J| of forces per displacement. Returns 0 if out of memory. */
static int find_stiffest(tribo_system *sys)
{
    const size_t n = sys->ndof;
    struct compliance *g = &sys->compliance;
    double *one, *rate, *size, *force;
    if (!ALLOCATE(ARRAY(one, n), ARRAY(rate, n), ARRAY(size, sys->ncontact), ARRAY(force, sys->ncontact))) {
        return 0;
    }
    for (size_t d = 0; d < n; d++) {
        one[d] = 1.0;
    }
    tribo_matrix_add_sizes(&sys->direction, one, size);
    tribo_matrix_add_sizes(&g->inverse, size, force);
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

/* A pivot below this part of the diagonal entry is rounding. */
#define ROUNDING (64.0 * DBL_EPSILON)

/* Returns 1 if contact i is compliant, and rests; slip NULL: all rest. */
static int gives_at_rest(const struct compliance *g, const signed char *slip, size_t i)
{
    return tribo_is_compliant(g, i) && (!slip || slip[i] == TRIBO_SLIP_STUCK);
}

/* Sets factor [*rests][*rests], of G over the compliant contacts at rest. Returns the number of the pivot that is not positive,
 * or 0. */
static int factorize_at_rest(const struct compliance *g, const signed char *slip, size_t *rests)
{
    double *to = g->factor;
    int rows = 0, info = 0;
    for (size_t k = 0; k < g->count; k++) {
        const size_t i = g->contact[k];
        const int in = gives_at_rest(g, slip, i);
        for (size_t l = 0; in && l < g->count; l++) {
            if (gives_at_rest(g, slip, g->contact[l])) {
                *to++ = tribo_matrix_get(&g->g, i, g->contact[l]);
            }
        }
        rows += in;
    }
    *rests = (size_t)rows;
    if (rows) {
        dpotrf_("U", &rows, g->factor, &rows, &info, 1);
    }
    return info;
}

/* Sets inverse. Returns TRIBO_OK, TRIBO_ERR_MEMORY, or TRIBO_ERR_INDEFINITE with the row *where of a pivot that is rounding. */
static int find_inverse(tribo_system *sys, size_t *where)
{
    struct compliance *g = &sys->compliance;
    const size_t n = sys->ncontact, columns = g->factor ? n : 1;
    size_t rests = 0;
    const int info = g->factor ? factorize_at_rest(g, NULL, &rests) : 0;
    double *x;
    for (size_t k = 0; k < rests; k++) {
        const double l = g->factor[k * (rests + 1)];
        if (k + 1 == (size_t)info || !(l * l > ROUNDING * g->own[g->contact[k]])) {
            *where = g->contact[k];
            return TRIBO_ERR_INDEFINITE;
        }
    }
    if (!ALLOCATE(ARRAY(x, n * columns))) {
        return TRIBO_ERR_MEMORY;
    }
    for (size_t i = 0; i < n; i++) {
        x[i * columns + i % columns] = 1.0;
    }
    tribo_compliance_solve(sys, NULL, columns, x);
    const int done = g->factor ? tribo_matrix_from_dense(&g->inverse, n, n, x) : tribo_matrix_diagonal(&g->inverse, n, x);
    free(x);
    return done ? TRIBO_OK : TRIBO_ERR_MEMORY;
}

int tribo_compliance_create(tribo_system *sys, const double *own, const double *entries, size_t *where)
{
    struct compliance *g = &sys->compliance;
    const size_t n = sys->ncontact;
    if ((entries && !tribo_lapack_takes(n)) ||
        !ALLOCATE(ARRAY(g->contact, n), ARRAY(g->own, n), ARRAY(g->lo, n), ARRAY(g->hi, n), ARRAY(g->f, n),
                  ARRAY(g->factor, entries ? n * n : 0)) ||
        !(entries ? tribo_matrix_from_dense(&g->g, n, n, entries) : tribo_matrix_diagonal(&g->g, n, own))) {
        return TRIBO_ERR_MEMORY;
    }
    for (size_t i = 0; i < n; i++) {
        g->own[i] = own[i];
        g->contact[g->count] = i;
        g->count += own[i] > 0.0;
    }
    g->factor = tribo_matrix_is_diagonal(&g->g) ? NULL : g->factor;
    int status = find_inverse(sys, where);
    status = status ? status : tribo_create(&g->box, n);
    status = status ? status : tribo_set_operator_csr(g->box, g->g.first, g->g.col, g->g.val);
    if (status) {
        return status;
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

const struct matrix *tribo_springs_matrix(const tribo_system *sys)
{
    return &sys->compliance.g;
}

int tribo_springs_copy_first(tribo_model *model, const tribo_system *from)
{
    return from->compliance.count ? tribo_model_set_compliance(model, from->compliance.own) : TRIBO_OK;
}

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
    const struct compliance *g = &sys->compliance;
    struct cholesky c = {.factor = g->factor};
    size_t rests = 0;
    for (size_t i = 0; i < sys->ncontact; i++) {
        if (gives_at_rest(g, slip, i)) {
            for (size_t k = 0; k < columns; k++) {
                x[rests * columns + k] = g->factor ? x[i * columns + k] : x[i * columns + k] / g->own[i];
            }
            rests++;
        }
    }
    if (g->factor && rests) {
        factorize_at_rest(g, slip, &c.n);
        tribo_half_solve(&c, 0, x, columns);
        tribo_half_solve(&c, 1, x, columns);
    }
    for (size_t i = sys->ncontact; i-- > 0;) { /* from the first `rests` rows to those of the contacts at rest */
        if (gives_at_rest(g, slip, i)) {
            memmove(x + i * columns, x + --rests * columns, columns * sizeof *x);
        } else {
            memset(x + i * columns, 0, columns * sizeof *x);
        }
    }
}

void tribo_compliance_give(const tribo_system *sys, size_t columns, const double *f, double *x)
{
    memset(x, 0, sys->ncontact * columns * sizeof *x);
    tribo_matrix_add_columns(&sys->compliance.g, 1.0, columns, f, x);
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

void tribo_springs_hold(const tribo_system *sys, const signed char *slip, size_t columns, double *stretch, double *f)
{
    if (sys->compliance.count) {
        tribo_matrix_add_columns(&sys->compliance.g, -1.0, columns, f, stretch);
        tribo_compliance_solve(sys, slip, columns, stretch);
        tribo_add(f, 1.0, stretch, sys->ncontact * columns);
    }
}

void tribo_system_put_steady(const tribo_system *sys, const double *q, const double *f, double *y)
{
    memset(y, 0, tribo_system_size(sys) * sizeof *y);
    memcpy(y, q, sys->ndof * sizeof *q);
    tribo_compliance_put(sys, f, y);
}

void tribo_compliance_share(const struct compliance *g, double *v)
{
    if (tribo_solve_box(g->box, v, g->lo, g->hi, g->f)) {
        memset(g->f, 0xff, g->g.rows * sizeof *g->f); /* NaN: the states that follow fail */
    }
    tribo_matrix_multiply_add(&g->g, 1.0, g->f, v);
    for (size_t i = 0; i < g->g.rows; i++) {
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
        tribo_matrix_add_columns(&sys->compliance.g, 1.0, columns, slide, v);
    }
    tribo_add(rate, -1.0, v, sys->ncontact * columns);
    tribo_compliance_solve(sys, slip, columns, rate);
    tribo_matrix_add_columns(&sys->compliance.g, 1.0, columns, rate, v);
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
    double *size = g->lo;
    memset(noise, 0, sys->ncontact * sizeof *noise);
    for (size_t i = 0; g->count && i < sys->ncontact; i++) {
        size[i] = g->own[i] > 0.0 ? TRIBO_SPRING_NOISE * tribo_matrix_row_size(&sys->direction, i, q) : 0.0;
    }
    tribo_matrix_add_sizes(&g->inverse, size, noise);
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
        const size_t i = g->contact[k];
        const int pressed = slip[i] != TRIBO_SLIP_OPEN;
        if (slip[i] == TRIBO_SLIP_STUCK || slip[i] == TRIBO_SLIP_PLANE) {
            continue;
        }
        memcpy(work + i * columns, f + k * columns, row);
        memset(f + k * columns, 0, row);
        if (rise && pressed) {
            tribo_add(f + k * columns, -slip[i], rise + i * columns, columns);
        }
        const struct follower *own = pressed ? tribo_normals_follower(sys, i) : NULL;
        const struct normal *n = own ? &sys->normals.normal[own->normal] : NULL;
        for (size_t e = n ? j->first[n->row] : 0; n && e < j->first[n->row + 1]; e++) {
            tribo_add(f + k * columns, -slip[i] * own->mu * n->stiffness * j->val[e], v + j->col[e] * columns, columns);
        }
        tribo_add(work + i * columns, -1.0, f + k * columns, columns);
    }
    tribo_compliance_give(sys, columns, work, way);
    tribo_compliance_solve(sys, slip, columns, way);
    for (size_t k = 0; k < g->count; k++) {
        tribo_add(f + k * columns, 1.0, way + g->contact[k] * columns, columns);
    }
}
