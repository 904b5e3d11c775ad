#include "system.h"
#include "common/real.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* -------------------------------------------------------------------------------------------------------------- life */

void tribo_compliance_free(struct compliance *g)
{
    free(g->contact);
    free(g->own);
    tribo_matrix_free(&g->pull);
    if (g->shared) {
        tribo_definite_free(g->shared);
    }
    free(g->shared);
    memset(g, 0, sizeof *g);
}

/* Sets own, contact, count and shared. Returns the status of tribo_definite_create, or TRIBO_ERR_MEMORY. */
static int set_entries(struct compliance *g, size_t ncontact, const double *own, const double *entries, size_t *where)
{
    g->own = malloc((ncontact + 1) * sizeof *g->own);
    g->contact = malloc((ncontact + 1) * sizeof *g->contact);
    g->shared = entries ? calloc(1, sizeof *g->shared) : NULL;
    if (!g->own || !g->contact || (entries && !g->shared)) {
        return TRIBO_ERR_MEMORY;
    }
    for (size_t i = 0; i < ncontact; i++) {
        g->own[i] = own[i];
        g->contact[g->count] = i;
        g->count += own[i] > 0.0;
    }
    return entries ? tribo_definite_create(g->shared, ncontact, entries, where) : TRIBO_OK;
}

/* Sets pull = M^-1 J' in the columns of compliant contacts. Returns 0 if out of memory. */
static int compliance_find_pull(tribo_system *sys)
{
    struct compliance *g = &sys->compliance;
    const size_t n = sys->ndof, c = sys->ncontact;
    const struct matrix *j = &sys->direction;
    size_t count = 0, room = 0;
    for (size_t k = 0; k < g->count; k++) {
        const size_t i = g->contact[k];
        room += sys->factor.factor || sys->factor.sparse ? n : j->first[i + 1] - j->first[i];
    }
    size_t *row = malloc((room + 1) * sizeof *row), *col = malloc((room + 1) * sizeof *col);
    double *val = malloc((room + 1) * sizeof *val), *x = malloc((2 * n + 1) * sizeof *x);
    for (size_t k = 0; row && col && val && x && k < g->count; k++) {
        const size_t i = g->contact[k];
        memset(x, 0, n * sizeof *x);
        for (size_t e = j->first[i]; e < j->first[i + 1]; e++) {
            x[j->col[e]] += j->val[e];
        }
        tribo_system_solve_mass(sys, x);
        for (size_t d = 0; d < n; d++) {
            row[count] = d;
            col[count] = i;
            val[count] = x[d];
            count += x[d] != 0.0;
        }
    }
    const int done = row && col && val && x && tribo_matrix_from_triplets(&g->pull, n, c, count, row, col, val);
    free(row);
    free(col);
    free(val);
    free(x);
    return done;
}

/* sizes [ncontact] = |G^-1| sizes. */
static void solve_sizes(const struct compliance *g, size_t ncontact, double *sizes)
{
    for (size_t i = 0; !g->shared && i < ncontact; i++) {
        sizes[i] = g->own[i] > 0.0 ? sizes[i] / g->own[i] : 0.0;
    }
    if (g->shared) {
        memcpy(g->shared->x, sizes, ncontact * sizeof *sizes);
        for (size_t i = 0; i < ncontact; i++) {
            sizes[i] = 0.0;
            for (size_t k = 0; k < ncontact; k++) {
                sizes[i] += fabs(g->shared->inverse[i * ncontact + k]) * g->shared->x[k];
            }
        }
    }
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
    solve_sizes(g, sys->ncontact, force);
    tribo_matrix_add_sizes(&sys->stiffness, one, rate);
    tribo_matrix_add_sizes(&g->pull, force, rate);
    g->stiffest = tribo_largest(rate, n);
    for (size_t d = 0; d < n; d++) {
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

int tribo_compliance_create(tribo_system *sys, struct matrix *direction, const double *own, const double *g, size_t *where)
{
    if (direction) {
        tribo_matrix_free(&sys->direction);
        sys->direction = *direction;
        *direction = (struct matrix){0};
    }
    const int status = set_entries(&sys->compliance, sys->ncontact, own, g, where);
    return status ? status : compliance_find_pull(sys) && find_stiffest(sys) ? TRIBO_OK : TRIBO_ERR_MEMORY;
}

int tribo_compliance_copy(tribo_system *to, const tribo_system *from)
{
    const struct compliance *g = &from->compliance;
    size_t where;
    return !g->count || !tribo_compliance_create(to, NULL, g->own, g->shared ? g->shared->matrix : NULL, &where);
}

/* Largest stiffness of a compliant contact, relative to the structure. At this ratio the compliance changes a motion by 1e-8 of
 * the motion, and the rounding of displacements changes the force by 1e-8 of the force: the contact should be rigid. */
#define MOST_STIFF 1e8

int tribo_compliance_check(const tribo_system *sys)
{
    const struct compliance *g = &sys->compliance;
    double own = g->structure;
    for (size_t s = 0; s < sys->harmonics; s++) {
        own = greater(own, sys->harmonic[s].omega * sys->harmonic[s].omega);
    }
    if (!g->count || own == 0.0 || g->added <= MOST_STIFF * own) {
        return TRIBO_OK;
    }
    return tribo_system_fail(sys, TRIBO_ERR_UNSUPPORTED,
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
    if (g->shared) {
        tribo_definite_solve(g->shared, slip, columns, x);
        return;
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        const int rests = tribo_is_compliant(g, i) && (!slip || slip[i] == TRIBO_SLIP_STUCK);
        for (size_t j = i * columns; j < (i + 1) * columns; j++) {
            x[j] = rests ? x[j] / g->own[i] : 0.0;
        }
    }
}

void tribo_compliance_give(const tribo_system *sys, size_t columns, const double *f, double *x)
{
    const struct compliance *g = &sys->compliance;
    const size_t c = sys->ncontact;
    memset(x, 0, c * columns * sizeof *x);
    if (g->shared) {
        tribo_multiply_add(c, c, columns, 1.0, g->shared->matrix, f, x);
    }
    for (size_t k = 0; !g->shared && k < g->count; k++) {
        const size_t i = g->contact[k];
        tribo_add(x + i * columns, g->own[i], f + i * columns, columns);
    }
}

void tribo_compliance_rates(const tribo_system *sys, const signed char *slip, double *v, double *rate)
{
    const struct compliance *g = &sys->compliance;
    const size_t c = sys->ncontact;
    for (size_t i = 0; i < c; i++) {
        rate[i] = tribo_is_compliant(g, i) ? -v[i] : 0.0;
    }
    tribo_compliance_solve(sys, slip, 1, rate);
    if (g->shared) {
        tribo_multiply_add(c, c, 1, 1.0, g->shared->matrix, rate, v);
    }
    for (size_t k = 0; k < g->count; k++) {
        const size_t i = g->contact[k];
        v[i] = slip[i] == TRIBO_SLIP_STUCK ? 0.0 : v[i];
    }
}

void tribo_compliance_share(struct definite *c, double *v)
{
    memcpy(c->q, v, c->n * sizeof *v);
    tribo_definite_box(c);
    tribo_multiply_add(c->n, c->n, 1, 1.0, c->matrix, c->f, v);
    for (size_t i = 0; i < c->n; i++) {
        v[i] = c->f[i] != 0.0 ? 0.0 : v[i];
    }
}

void tribo_compliance_noise(const tribo_system *sys, const double *q, double *noise)
{
    for (size_t i = 0; i < sys->ncontact; i++) {
        noise[i] = tribo_is_compliant(&sys->compliance, i) ? tribo_matrix_row_size(&sys->direction, i, q) : 0.0;
    }
    solve_sizes(&sys->compliance, sys->ncontact, noise);
    for (size_t i = 0; i < sys->ncontact; i++) {
        noise[i] *= TRIBO_SPRING_NOISE;
    }
}

void tribo_compliance_move(const tribo_system *sys, const double *y, double *v, double *rate)
{
    const struct compliance *g = &sys->compliance;
    struct definite *c = g->shared;
    double *limit = sys->put_limit, *noise = sys->dv_dt;
    tribo_get_limit(sys->contacts, limit);
    tribo_compliance_noise(sys, y, noise);
    memset(rate, 0, sys->ncontact * sizeof *rate);
    for (size_t i = 0; c && i < sys->ncontact; i++) {
        c->lo[i] = c->hi[i] = c->f[i] = 0.0;
    }
    for (size_t k = 0; k < g->count; k++) {
        const size_t i = g->contact[k];
        const double force = y[2 * sys->ndof + k];
        const int at_limit = fabs(force) >= limit[i] - TRIBO_SPRING_ALLOWED * noise[i], open = limit[i] == 0.0;
        rate[i] = c ? v[i] : open || (at_limit && force * v[i] < 0.0) ? 0.0 : -v[i] / g->own[i];
        if (c) {
            c->lo[i] = open || (at_limit && force < 0.0) ? 0.0 : -HUGE_VAL;
            c->hi[i] = open || (at_limit && force > 0.0) ? 0.0 : HUGE_VAL;
        }
    }
    if (c) {
        tribo_compliance_share(c, rate);
    }
    for (size_t k = 0; k < g->count; k++) {
        const size_t i = g->contact[k];
        v[i] = c ? rate[i] : rate[i] != 0.0 ? 0.0 : v[i];
        rate[i] = c ? c->f[i] : rate[i];
    }
}

double tribo_compliance_bound(const tribo_system *sys, const double *limit, double *force)
{
    const struct compliance *g = &sys->compliance;
    struct definite *c = g->shared;
    double energy = 0.0;
    int beyond = 0;
    for (size_t i = 0; i < sys->ncontact; i++) {
        const double most = tribo_is_compliant(g, i) ? limit[i] : 0.0, within = clamp(force[i], -most, most);
        beyond |= tribo_is_compliant(g, i) && within != force[i];
        if (c) {
            c->lo[i] = -most;
            c->hi[i] = most;
        } else if (tribo_is_compliant(g, i)) {
            energy += sys->tally[i] * within * (force[i] - within) * g->own[i];
            force[i] = within;
        }
    }
    if (!c || !beyond) {
        return energy;
    }
    tribo_compliance_give(sys, 1, force, c->q);
    for (size_t i = 0; i < c->n; i++) {
        c->q[i] = -c->q[i];
    }
    tribo_definite_box(c);
    for (size_t i = 0; i < c->n; i++) {
        force[i] = tribo_is_compliant(g, i) ? force[i] - c->f[i] : 0.0;
    }
    tribo_compliance_give(sys, 1, force, c->q);
    for (size_t i = 0; i < c->n; i++) {
        energy += sys->tally[i] * c->f[i] * c->q[i];
        force[i] = c->f[i];
    }
    return energy;
}

void tribo_compliance_enter(const tribo_system *sys, const double *limit, double *force, double *y)
{
    tribo_compliance_get(sys, y, force);
    y[tribo_system_energy(sys)] += tribo_compliance_bound(sys, limit, force);
    tribo_compliance_put(sys, force, y);
}

void tribo_compliance_perturb(const tribo_system *sys, const signed char *slip, size_t columns, double *v, double *work)
{
    const struct compliance *g = &sys->compliance;
    const size_t c = sys->ncontact, row = columns * sizeof *v;
    double *f = v + 2 * sys->ndof * columns, *way = work + c * columns;
    memset(work, 0, c * row);
    for (size_t k = 0; k < g->count; k++) {
        memcpy(work + g->contact[k] * columns, f + k * columns, row);
    }
    if (g->shared) {
        tribo_compliance_give(sys, columns, work, way);
        tribo_compliance_solve(sys, slip, columns, way);
    }
    for (size_t k = 0; k < g->count; k++) {
        const size_t i = g->contact[k];
        if (g->shared || slip[i] != TRIBO_SLIP_STUCK) {
            memset(f + k * columns, 0, row);
        }
        if (g->shared && slip[i] == TRIBO_SLIP_STUCK) {
            memcpy(f + k * columns, way + i * columns, row);
        }
    }
}
