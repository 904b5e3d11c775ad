/* SPDX-License-Identifier: BSD-3-Clause */
/* The equilibrium of steady sliding.
 *
 *     contacts on bases that move slide, the others rest where y has them
 *     repeat, until the normals that press are those assumed
 *         the displacements that contacts at rest allow
 *         the equilibrium with all normals pressed
 *         the normals that do not press: a linear complementarity problem
 *     forces of the contacts at rest are within their limits
 */
#include "equilibrium.h"
#include "common/layout.h"
#include "common/real.h"
#include "numerics/constraint.h"
#include "numerics/linalg.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Smallest pivot of the stiffness, over its diagonal, of a structure that is held. */
#define FIRM 1e-13

/* A force beyond this part of the limit at rest counts as at the limit. LEFT: acceleration of a contact that is held, relative to
 * its terms. */
#define WITHIN (1.0 - 1e-9)
#define LEFT 1e-10

/* Velocity that is given to a contact which slides on a base at rest. */
#define SLOW 1e-150

/* ---------------------------------------------------------------------------------------------------------------- life */

void tribo_equilibrium_free(struct equilibrium *e)
{
    tribo_system_destroy(e->sys);
    tribo_destroy(e->probe);
    free(e->y);
    memset(e, 0, sizeof *e);
}

/* Sets base, limit, load and pair. Refuses drives that depend on time, but harmonic loads, and a given [ncontact] that contacts
 * cannot follow. Returns a status. */
static int steady_read_drives(struct equilibrium *e)
{
    static const char *const name[] = {"load", "base motion", "limit"};
    tribo_system *sys = e->sys;
    const size_t c = sys->ncontact;
    for (size_t k = 0; k < sys->loads.harmonics; k++) {
        const struct harmonic *w = sys->loads.harmonic + k;
        if (w->knots || (w->count > 0 && w->omega != 0.0 && w->drives != DRIVES_LOAD && !w->by_load)) {
            return tribo_error(e->message, TRIBO_ERR_UNSUPPORTED, "a %s %s: there is no equilibrium", name[w->drives],
                               w->knots ? "follows a table" : "depends on time");
        }
    }
    tribo_loads_keep_constant(sys);
    tribo_system_set_time(sys, 0.0);
    tribo_system_loads(sys, DRIVES_BASE, 0, 1.0, e->base);
    tribo_system_loads(sys, DRIVES_LOAD, 0, 1.0, e->residual);
    tribo_matrix_multiply(&sys->mass, e->residual, e->load);
    tribo_system_limits(sys, e->limit, e->way);
    int status = tribo_system_find_pairs(sys, e->pair);
    if (status) {
        return status;
    }
    status = tribo_set_law(e->probe, TRIBO_COULOMB);
    status = status ? status : tribo_set_coupling(e->probe, TRIBO_CONSISTENT);
    for (size_t i = 0; i < c; i++) {
        const signed char slip = e->given ? e->given[i] : 0, moves = (signed char)(e->base[i] > 0.0 ? -1 : e->base[i] < 0.0);
        const int along = slip == TRIBO_SLIP_FORTH || slip == TRIBO_SLIP_BACK, paired = e->pair[i] == PAIR_SECOND;
        const int one = e->pair[i] == PAIR_NONE;
        e->limit[i] = tribo_normals_follower(sys, i) ? 0.0 : greater(e->limit[i], 0.0);
        if (!along && slip != TRIBO_SLIP_STUCK && slip != TRIBO_SLIP_OPEN) {
            return tribo_error(e->message, TRIBO_ERR_RANGE, "given[%zu] = %d is none of -1, 0, 1, 2", i, slip);
        }
        if ((along && (!one || tribo_normals_at(sys, i) || (moves && slip != moves))) ||
            (paired && slip != (e->given ? e->given[i - 1] : 0))) {
            return tribo_error(e->message, TRIBO_ERR_RANGE, "given[%zu] = %d, but contact %zu %s", i, slip, i,
                               !one    ? "is one of two directions in the plane"
                               : moves ? "slides in the other direction"
                                       : "is a normal");
        }
    }
    return status ? tribo_error(e->message, status, "%s", tribo_message(e->probe)) : TRIBO_OK;
}

int tribo_equilibrium_create(struct equilibrium *e, tribo_system *sys, const signed char *given, const double *y)
{
    *e = (struct equilibrium){.message = sys->message, .given = given, .friction = 1.0, .speed = 1.0};
    const size_t n = sys->ndof, c = sys->ncontact, normals = sys->normals.count;
    int status = tribo_system_take_settings(sys);
    status = status ? status : tribo_system_check_solved(sys, "an equilibrium");
    status = status ? status : tribo_system_check_contacts(sys, "equilibrium", 0);
    if (!status && n > DENSE_MOST) {
        status = tribo_error(sys->message, TRIBO_ERR_UNSUPPORTED,
                             "%zu degree%s of freedom are more than the %d that an equilibrium takes: take tribo_system_reduce",
                             n, plural(n), DENSE_MOST);
    }
    status = status || !y ? status : tribo_system_check_state(sys, 0.0, y);
    status = status ? status : tribo_system_clone(sys, &e->sys);
    if (status) {
        return status;
    }
    if (tribo_clone(sys->contacts, &e->probe) ||
        !ALLOCATE(ARRAY(e->y, tribo_system_size(sys)), ARRAY(e->base, c), ARRAY(e->limit, c), ARRAY(e->unit, c),
                  ARRAY(e->slope, c * c), ARRAY(e->hold, c), ARRAY(e->depth, normals), ARRAY(e->lift, normals), ARRAY(e->load, n),
                  ARRAY(e->shape, n * n), ARRAY(e->q, n), ARRAY(e->f, c), ARRAY(e->residual, n), ARRAY(e->way, c * (n + 1)),
                  ARRAY(e->force, c * (n + 1)), ARRAY(e->moved, n * n), ARRAY(e->matrix, n * n), ARRAY(e->scale, n),
                  ARRAY(e->pivot, n), ARRAY(e->slip, c), ARRAY(e->pair, c), ARRAY(e->pressed, normals))) {
        return tribo_error(e->message, TRIBO_ERR_MEMORY, "out of memory for an equilibrium of %zu degree%s of freedom", n,
                           plural(n));
    }
    if (y && sys->expansion.place) {
        tribo_system_read_state(sys, y, e->y);
    } else if (y) {
        memcpy(e->y, y, n * sizeof *y);
    }
    tribo_system_find_ways(sys, 1, e->y, e->force, e->hold);
    return steady_read_drives(e);
}

/* -------------------------------------------------------------------------------------------------------------- contacts */

/* Sets slip, with followers at rest open if their normals do not press; unit and slope. Returns a status. */
static int steady_choose_slips(struct equilibrium *e)
{
    const tribo_system *sys = e->sys;
    const size_t c = sys->ncontact;
    double *v = e->way, *still = v + c, *bound = e->force;
    memset(still, 0, c * sizeof *still);
    for (size_t i = 0; i < c; i++) {
        const struct follower *f = tribo_normals_follower(sys, i);
        const signed char given = e->given ? e->given[i] : TRIBO_SLIP_STUCK;
        bound[i] = e->friction * (f ? f->mu * sys->normals.normal[f->normal].stiffness : e->limit[i]);
        v[i] = -e->speed * e->base[i];
        v[i] = v[i] == 0.0 && given != TRIBO_SLIP_OPEN ? given * SLOW : v[i];
        const size_t other = e->pair[i] == PAIR_FIRST ? i + 1 : e->pair[i] == PAIR_SECOND ? i - 1 : i;
        const int moves = v[i] != 0.0 || e->speed * e->base[other] != 0.0;
        if (!(bound[i] > 0.0) || given == TRIBO_SLIP_OPEN || tribo_normals_at(sys, i) ||
            (!moves && f && !e->pressed[f->normal])) {
            e->slip[i] = TRIBO_SLIP_OPEN;
        } else if (moves && e->pair[i] != PAIR_NONE) {
            e->slip[i] = TRIBO_SLIP_PLANE;
        } else {
            e->slip[i] = v[i] > 0.0 ? TRIBO_SLIP_FORTH : v[i] < 0.0 ? TRIBO_SLIP_BACK : TRIBO_SLIP_STUCK;
        }
        bound[i] = tribo_equilibrium_slides(e, i) ? bound[i] : 0.0;
    }
    int status = tribo_set_limit(e->probe, bound);
    status = status ? status : tribo_balance_tangent(e->probe, v, still, NULL, e->unit, e->slope, NULL);
    return status ? tribo_error(e->message, status, "%s", tribo_message(e->probe)) : TRIBO_OK;
}

/* f [ncontact][columns] = forces by way [ncontact][columns]: J q, affine = 1: of a state, with rows of normals less the gap and
 * plus the lift; 0: of perturbations. Overwrites way. */
static void steady_find_forces(const struct equilibrium *e, int affine, size_t columns, double *way, double *f)
{
    const tribo_system *sys = e->sys;
    const struct normals *s = &sys->normals;
    memset(f, 0, sys->ncontact * columns * sizeof *f);
    for (size_t k = 0; k < s->count; k++) {
        const size_t row = s->normal[k].row;
        tribo_add(f + row * columns, e->pressed[k] ? -s->normal[k].stiffness : 0.0, way + row * columns, columns);
    }
    for (size_t k = 0; k < s->followers; k++) {
        const struct follower *at = s->follower + k;
        const double *depth = way + s->normal[at->normal].row * columns;
        const int follows = e->pressed[at->normal] && tribo_equilibrium_slides(e, at->contact);
        tribo_add(f + at->contact * columns, follows ? e->unit[at->contact] : 0.0, depth, columns);
        tribo_add(f + at->second * columns, follows && at->second != at->contact ? e->unit[at->second] : 0.0, depth, columns);
    }
    for (size_t i = 0; i < sys->ncontact; i++) {
        f[i * columns] += affine && tribo_equilibrium_slides(e, i) && !tribo_normals_follower(sys, i) ? e->unit[i] : 0.0;
        for (size_t k = 0; k < columns; k++) {
            way[i * columns + k] = (affine ? e->hold[i] : 0.0) - way[i * columns + k];
        }
    }
    tribo_springs_hold(sys, e->slip, columns, way, f);
}

/* residual = load - K q + J'f, with f = e->f by q. */
static void steady_find_residual(struct equilibrium *e)
{
    const tribo_system *sys = e->sys;
    double *way = e->way;
    tribo_matrix_multiply(&sys->direction, e->q, way);
    for (size_t k = 0; k < sys->normals.count; k++) {
        way[sys->normals.normal[k].row] += e->lift[k] - sys->normals.normal[k].gap;
    }
    steady_find_forces(e, 1, 1, way, e->f);
    memcpy(e->residual, e->load, sys->ndof * sizeof *e->load);
    tribo_matrix_multiply_add(&sys->k, -1.0, e->q, e->residual);
    tribo_matrix_add_transposed(&sys->direction, 1.0, 1, e->f, e->residual);
}

/* a [modes][modes] = shape'moved. */
static void steady_project(const struct equilibrium *e, double *a)
{
    memset(a, 0, e->modes * e->modes * sizeof *a);
    tribo_multiply_transposed_add(e->sys->ndof, e->modes, e->modes, e->shape, e->moved, a);
}

int tribo_equilibrium_stiffness(const struct equilibrium *e, double *a)
{
    const tribo_system *sys = e->sys;
    const size_t m = e->modes;
    int even = sys->circulation == 0.0;
    memset(e->moved, 0, sys->ndof * m * sizeof *e->moved);
    memset(e->way, 0, sys->ncontact * m * sizeof *e->way);
    tribo_matrix_add_columns(&sys->k, 1.0, m, e->shape, e->moved);
    tribo_matrix_add_columns(&sys->direction, 1.0, m, e->shape, e->way);
    steady_find_forces(e, 0, m, e->way, e->force);
    tribo_matrix_add_transposed(&sys->direction, -1.0, m, e->force, e->moved);
    steady_project(e, a);
    for (size_t k = 0; k < sys->normals.followers; k++) {
        const struct follower *f = &sys->normals.follower[k];
        even &= !(tribo_equilibrium_slides(e, f->contact) && e->pressed[f->normal]);
    }
    return even;
}

int tribo_equilibrium_damping(const struct equilibrium *e, double *a)
{
    const tribo_system *sys = e->sys;
    const size_t m = e->modes, c = sys->ncontact;
    memset(e->moved, 0, sys->ndof * m * sizeof *e->moved);
    memset(e->way, 0, c * m * sizeof *e->way);
    memset(e->force, 0, c * m * sizeof *e->force);
    if (sys->c.rows > 0) {
        tribo_matrix_add_columns(&sys->c, 1.0, m, e->shape, e->moved);
    }
    tribo_matrix_add_columns(&sys->direction, 1.0, m, e->shape, e->way);
    for (size_t i = 0; i < c; i++) {
        const struct follower *f = tribo_normals_follower(sys, i);
        const double factor = f ? greater(e->depth[f->normal], 0.0) : 1.0;
        for (size_t k = 0; k < c; k++) {
            tribo_add(e->force + i * m, factor * e->slope[i * c + k], e->way + k * m, m);
        }
    }
    tribo_matrix_add_transposed(&sys->direction, -1.0, m, e->force, e->moved);
    steady_project(e, a);
    return tribo_largest(a, m * m) > 0.0;
}

/* ----------------------------------------------------------------------------------------------------------- displacements */

/* Sets modes and shape = Z S, J_H Z = 0, (Z'MZ)^-1 = S S'. Returns a status. */
static int steady_find_shape(struct equilibrium *e)
{
    const tribo_system *sys = e->sys;
    size_t *rest = malloc((sys->ncontact + 1) * sizeof *rest), count = 0, where;
    struct constraints ties = {0}, held = {0};
    struct matrix z = {0}, mass = {0};
    struct cholesky own = {0};
    double pivot;
    for (size_t i = 0; rest && i < sys->ncontact; i++) {
        rest[count] = i;
        count += e->slip[i] == TRIBO_SLIP_STUCK && tribo_system_delassus(sys, i, i) > 0.0;
    }
    int done = rest && (!count || tribo_constraints_create(&ties, &sys->direction, &sys->mass, rest, count, NULL));
    for (size_t k = 0; done && k < ties.rank; k++) {
        ties.order[k] = rest[ties.order[k]];
    }
    done = done && (!count || (tribo_constraints_create(&held, &sys->direction, &sys->mass, ties.order, ties.rank, NULL) &&
                               tribo_constraints_basis(&held, sys->ndof, &z)));
    const size_t m = e->modes = count ? z.cols : sys->ndof;
    done = done && (!count || !m ||
                    (tribo_matrix_congruent(&sys->mass, &z, e->matrix) && tribo_matrix_from_dense(&mass, m, m, e->matrix)));
    int status = !done ? TRIBO_ERR_MEMORY : count && m ? tribo_cholesky_create(&own, &mass, &mass, &where, &pivot) : TRIBO_OK;
    if (!status && m) {
        double *s = count ? e->matrix : e->shape;
        memset(s, 0, m * m * sizeof *s);
        for (size_t k = 0; k < m; k++) {
            s[k * (m + 1)] = 1.0;
        }
        tribo_half_solve(count ? &own : &sys->factor, 1, s, m);
        memset(e->shape, 0, count ? sys->ndof * m * sizeof *s : 0);
        if (count) {
            tribo_matrix_add_columns(&z, 1.0, m, s, e->shape);
        }
    }
    tribo_cholesky_free(&own);
    tribo_matrix_free(&z);
    tribo_constraints_free(&held);
    tribo_constraints_free(&ties);
    free(rest);
    return status ? tribo_error(e->message, status, "the mass that contacts at rest leave free: %s", tribo_strerror(status))
                  : TRIBO_OK;
}

/* to [ndof] += shape A^-1 shape'force, by the factors of A; force [ndof]. */
static void steady_give_way(const struct equilibrium *e, const double *force, double *to)
{
    const size_t n = e->sys->ndof, m = e->modes;
    double *x = e->moved;
    memset(x, 0, m * sizeof *x);
    tribo_multiply_transposed_add(n, m, 1, e->shape, force, x);
    for (size_t k = 0; k < m; k++) {
        x[k] *= e->scale[k];
    }
    tribo_lu_solve(e->matrix, m, e->pivot, x, 1);
    for (size_t k = 0; k < m; k++) {
        x[k] *= e->scale[k];
    }
    tribo_multiply_add(n, m, 1, 1.0, e->shape, x, to);
}

/* Sets q, f and depth for the lifts, with the stiffness factored. */
static void steady_solve(struct equilibrium *e)
{
    const struct normals *s = &e->sys->normals;
    memcpy(e->q, e->y, e->sys->ndof * sizeof *e->q);
    for (int again = 0; again < 3; again++) { /* the second time removes the rounding of the first; the third sets f */
        steady_find_residual(e);
        if (again < 2) {
            steady_give_way(e, e->residual, e->q);
        }
    }
    for (size_t k = 0; k < s->count; k++) {
        e->depth[k] = tribo_matrix_row_dot(&e->sys->direction, s->normal[k].row, e->q) - s->normal[k].gap;
    }
}

/* ------------------------------------------------------------------------------------------------------------- normals
 * With lifts l, all normals pressed: depth = d + H l, and
 *     d + B l >= 0,   l >= 0,   the product of both 0,   B = 1 + H:  depth where a normal presses, l = - depth where not. */

/* Largest number of normals of which all sets are tried. */
enum { MOST_TRIED = 12 };

/* A depth, relative to the largest depth and gap, that counts as 0. NEGATIVE: smallest eigenvalue that does not count as
 * negative. SINGULAR: smallest pivot of B. */
#define TOUCHING 1e-9
#define NEGATIVE (-1e-12)
#define SINGULAR 1e-12

struct complementarity {
    size_t n;
    double *b, *d;       /* [n][n], [n] */
    double *part, *l;    /* [n][n], [n] workspace: of the normals that do not press */
    double *value;       /* [n] depth, or lift */
    size_t *at;          /* [n] normals that do not press */
    int *pivot;          /* [n] */
    unsigned char *open; /* [n] 1: does not press */
    double size;         /* of depths */
};

/* Sets value for `open`. Returns the smallest value over size; -1 if B is singular. */
static double steady_try_open(struct complementarity *p)
{
    const size_t n = p->n;
    size_t count = 0;
    for (size_t k = 0; k < n; k++) {
        p->at[count] = k;
        count += p->open[k];
    }
    for (size_t k = 0; k < count * count; k++) {
        p->part[k] = p->b[p->at[k / count] * n + p->at[k % count]];
    }
    for (size_t k = 0; k < count; k++) {
        p->l[k] = -p->d[p->at[k]];
    }
    if (!(tribo_lu_create(p->part, count, p->pivot) > SINGULAR)) {
        return -1.0;
    }
    tribo_lu_solve(p->part, count, p->pivot, p->l, 1);
    double least = HUGE_VAL;
    for (size_t i = 0, at = 0; i < n; i++) {
        p->value[i] = p->d[i];
        for (size_t k = 0; !p->open[i] && k < count; k++) {
            p->value[i] += p->b[i * n + p->at[k]] * p->l[k];
        }
        p->value[i] = p->open[i] ? p->l[at++] : p->value[i];
        least = lesser(least, p->value[i]);
    }
    return least / p->size;
}

/* Sets `open`, of the solution. Returns the number of solutions, 2 standing for all above 1. */
static size_t steady_solve_complementarity(struct complementarity *p)
{
    const size_t n = p->n, sets = (size_t)1 << (n <= MOST_TRIED ? n : 0);
    size_t found = 0, best = 0;
    if (n > MOST_TRIED) { /* the first normal that is wrong changes (Murty 1974) */
        for (size_t turns = 0; turns < 50 * n; turns++) {
            size_t k = 0;
            if (steady_try_open(p) > -TOUCHING) {
                return 1;
            }
            while (k + 1 < n && p->value[k] >= 0.0) {
                k++;
            }
            p->open[k] = !p->open[k];
        }
        return 0;
    }
    for (size_t set = 0; set <= sets; set++) { /* the last round sets `open` of best */
        for (size_t k = 0; k < n; k++) {
            p->open[k] = ((set < sets ? set : best) >> k) & 1;
        }
        if (set < sets && steady_try_open(p) > -TOUCHING) {
            best = set;
            found++;
        }
    }
    return found < 2 ? found : 2;
}

/* Finds the normals that press. The solution is unique if it is the only one of all sets; or if B, its rows and columns scaled
 * by the stiffnesses, has a symmetric part without negative eigenvalues. Returns a status. */
static int steady_find_pressed(struct equilibrium *e, struct complementarity *p)
{
    const tribo_system *sys = e->sys;
    const struct normal *normal = sys->normals.normal;
    const size_t n = p->n;
    int status = TRIBO_OK;
    memset(e->lift, 0, n * sizeof *e->lift);
    steady_solve(e);
    memcpy(p->d, e->depth, n * sizeof *p->d);
    p->size = greater(tribo_largest(p->d, n), DBL_MIN);
    for (size_t k = 0; k < n; k++) {
        p->size = greater(p->size, fabs(normal[k].gap));
        memset(e->way, 0, sys->ncontact * sizeof *e->way);
        memset(e->residual, 0, sys->ndof * sizeof *e->residual);
        memset(e->q, 0, sys->ndof * sizeof *e->q);
        e->way[normal[k].row] = 1.0;
        steady_find_forces(e, 0, 1, e->way, e->force);
        tribo_matrix_add_transposed(&sys->direction, 1.0, 1, e->force, e->residual);
        steady_give_way(e, e->residual, e->q);
        for (size_t i = 0; i < n; i++) {
            const double stiff = normal[i].stiffness, other = normal[k].stiffness;
            p->b[i * n + k] = (i == k) + tribo_matrix_row_dot(&sys->direction, normal[i].row, e->q);
            p->part[i * n + k] = p->b[i * n + k] * (stiff > 0.0 && other > 0.0 ? sqrt(stiff / other) : 1.0);
        }
    }
    if (n > MOST_TRIED) {
        tribo_even_out(n, p->part);
        status = tribo_symmetric_eigen(p->part, n, p->l);
    }
    if (status || (n > MOST_TRIED && !(p->l[0] >= NEGATIVE))) {
        return status ? tribo_error(e->message, status, "normals: %s", tribo_strerror(status))
                      : tribo_error(e->message, TRIBO_ERR_UNSUPPORTED, "there may be several equilibria of so many normals");
    }
    const size_t solutions = steady_solve_complementarity(p);
    if (solutions == 1 && steady_try_open(p) > TOUCHING) {
        return TRIBO_OK;
    }
    return solutions == 0 ? tribo_error(e->message, TRIBO_ERR_NO_CONVERGENCE, "no set of normals that press is in equilibrium")
                          : tribo_error(e->message, TRIBO_ERR_UNSUPPORTED, "%s a normal touches without force",
                                        solutions == 1 ? "" : "there are several equilibria, or");
}

/* --------------------------------------------------------------------------------------------------------------- limits */

/* Sets q, f and depth for the lifts, and pressed and slip for the normals that do not press, open [normals]. Refuses contacts at
 * rest of which the forces are not within the limits. Returns a status. */
static int steady_finish(struct equilibrium *e, const unsigned char *open)
{
    const tribo_system *sys = e->sys;
    const struct matrix *j = &sys->direction;
    const size_t c = sys->ncontact;
    double *a = e->way, *still = a + c, *bound = e->force, *f = bound + c, *acceleration = e->residual, *by_friction = e->moved;
    steady_solve(e);
    for (size_t k = 0; k < sys->normals.count; k++) {
        e->lift[k] = 0.0;
        e->pressed[k] = !open[k];
    }
    for (size_t k = 0; k < sys->normals.followers; k++) {
        const struct follower *at = sys->normals.follower + k;
        if (open[at->normal]) {
            e->slip[at->contact] = e->slip[at->second] = TRIBO_SLIP_OPEN;
        }
    }
    steady_find_residual(e);
    size_t fails = c;
    tribo_system_solve_mass(sys, acceleration);
    memset(a, 0, 2 * c * sizeof *a);
    for (size_t i = 0; i < c; i++) {
        const struct follower *at = tribo_normals_follower(sys, i);
        const int rests = e->slip[i] == TRIBO_SLIP_STUCK, rigid = rests && tribo_system_delassus(sys, i, i) > 0.0;
        const double limit = at ? at->mu * sys->normals.normal[at->normal].stiffness * e->depth[at->normal] : e->limit[i];
        bound[i] = rigid ? WITHIN * e->friction * limit : 0.0;
        a[i] = rigid ? tribo_matrix_row_dot(j, i, acceleration) : 0.0;
        fails = rests && fabs(e->f[i]) > WITHIN * e->friction * limit ? i : fails; /* springs */
    }
    int status = tribo_set_limit(e->probe, bound);
    status = status ? status : tribo_balance(e->probe, still, a, NULL, f);
    if (status) {
        return tribo_error(e->message, status, "%s", tribo_message(e->probe));
    }
    tribo_matrix_multiply(&sys->response, f, by_friction);
    for (size_t i = 0; i < c; i++) {
        const double size = tribo_matrix_row_size(j, i, acceleration) + tribo_matrix_row_size(j, i, by_friction);
        const double left = bound[i] > 0.0 ? a[i] + tribo_matrix_row_dot(j, i, by_friction) : 0.0;
        fails = fabs(left) > LEFT * size ? i : fails;
    }
    return fails == c ? TRIBO_OK
                      : tribo_error(e->message, TRIBO_ERR_NO_CONVERGENCE,
                                    "no equilibrium: contact %zu cannot rest where it is, its force reaches the limit", fails);
}

int tribo_equilibrium_find(struct equilibrium *e)
{
    const size_t n = e->sys->normals.count;
    struct complementarity p = {.n = n};
    unsigned char *assumed; /* open of the round before */
    int status = TRIBO_OK, changed = 1;
    if (!ALLOCATE(ARRAY(p.b, n * n), ARRAY(p.d, n), ARRAY(p.part, n * n), ARRAY(p.l, n), ARRAY(p.value, n), ARRAY(p.at, n),
                  ARRAY(p.pivot, n), ARRAY(p.open, n), ARRAY(assumed, n))) {
        return tribo_error(e->message, TRIBO_ERR_MEMORY, "out of memory for %zu normal%s", n, plural(n));
    }
    for (size_t round = 0; !status && changed && round < n + 3; round++) {
        memcpy(assumed, p.open, n);
        for (size_t k = 0; k < n; k++) {
            e->pressed[k] = !assumed[k];
        }
        status = steady_choose_slips(e);
        status = status ? status : steady_find_shape(e);
        memset(e->pressed, 1, n);
        tribo_equilibrium_stiffness(e, e->matrix);
        for (size_t k = 0; k < e->modes; k++) {
            const double own = fabs(e->matrix[k * (e->modes + 1)]);
            e->scale[k] = own > 0.0 ? 1.0 / sqrt(own) : 1.0;
        }
        for (size_t at = 0; at < e->modes * e->modes; at++) {
            e->matrix[at] *= e->scale[at / e->modes] * e->scale[at % e->modes];
        }
        if (!status && !(tribo_lu_create(e->matrix, e->modes, e->pivot) >= FIRM)) {
            status = tribo_error(e->message, TRIBO_ERR_INDEFINITE,
                                 "the structure has no equilibrium, or many: its stiffness is singular%s",
                                 n ? " with all normals pressed" : "");
        }
        status = status || !n ? status : steady_find_pressed(e, &p);
        changed = memcmp(p.open, assumed, n) != 0;
    }
    if (!status && changed) {
        status = tribo_error(e->message, TRIBO_ERR_NO_CONVERGENCE, "no set of normals that press is in equilibrium");
    }
    for (size_t k = 0; !status && k < n; k++) {
        e->lift[k] = p.open[k] ? p.value[k] : 0.0;
    }
    status = status ? status : steady_finish(e, p.open);
    free(p.b);
    return status;
}
