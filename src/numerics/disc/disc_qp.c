/* SPDX-License-Identifier: BSD-3-Clause */
/* Solves the problem of discs, lenses and intervals.
 *
 *     from the last solution, where a factor takes long: sweeps, contact by contact
 *     Newton's method, its steps projected to the set; a problem like the last one ends it at once
 *     without convergence: an interior-point method, and Newton's method from there
 *     without convergence: the same with a little stiffness towards the end of the interior-point method
 *
 * Each ends only if y is, up to rounding, the point of the set nearest to y - gain gradient: the solution. */
#include "disc_qp.h"

#include <stdlib.h>
#include <string.h>

#include "common/layout.h"
#include "common/real.h"

enum { FROM_BEFORE = 12, FROM_INTERIOR = 40, SWEEPS = 12 };

/* Distances up to SETTLED times their rounding count as 0. */
#define SETTLED 4.0

/* A sparse factor of more than MANY entries a row takes far longer than a step. It serves further steps with the same freedoms,
 * while each step leaves at most GAIN of the residual, also those of the next problem from residuals below LASTING on. */
#define MANY 16
#define GAIN 0.03
#define LASTING 0.1

/* See disc_approach. */
#define SLOW 0.7
#define CLOSE 1e-6

/* y = the point of the set nearest to from + part (aim - from). */
static void disc_project(struct disc_qp *p, const double *from, const double *aim, double part)
{
    for (size_t i = 0; i < p->size; i += p->wide[i]) {
        double z[2];
        for (size_t k = 0; k < p->wide[i]; k++) {
            z[k] = part < 1.0 ? from[i + k] + part * (aim[i + k] - from[i + k]) : aim[i + k];
        }
        tribo_lens_project(p->wide[i], p->shift + i, z, p->y + i);
    }
}

/* Takes each contact to the point of its set nearest to y - gain gradient, which lowers the objective: every other contact first,
 * since a contact waits for the one before it, to which it often couples. Returns the largest move. */
static double disc_sweep(struct disc_qp *p)
{
    double most = 0.0;
    for (size_t odd = 0; odd < 2; odd++) {
        size_t contact = 0;
        for (size_t i = 0; i < p->size; i += p->wide[i]) {
            if (contact++ % 2 == odd) {
                double gradient[2] = {p->pull[i], p->pull[i + p->wide[i] - 1]}, to[2];
                tribo_disc_add(p, i, p->y, gradient);
                tribo_disc_descend(p, i, gradient, to);
                for (size_t k = 0; k < p->wide[i]; k++) {
                    most = greater(most, fabs(to[k] - p->y[i + k]));
                    p->y[i + k] = to[k];
                }
            }
        }
    }
    return most;
}

/* 1 if a factor serves further steps, and sweeps come before it. */
static int takes_long(const struct disc_qp *p)
{
    return p->s.pattern && tribo_sparse_slots(p->s.pattern) > MANY * p->s.places;
}

/* from = y, aim = y + Newton's step, for gradient and places at y. */
static void find_aim(struct disc_qp *p)
{
    memcpy(p->from, p->y, p->size * sizeof *p->y);
    for (size_t i = 0; i < p->size; i += p->wide[i]) {
        for (size_t k = i; k < i + p->wide[i]; k++) {
            p->y[k] = p->place[i] == LENS_INSIDE ? p->y[k] : p->to[k];
        }
    }
    tribo_disc_list(p);
    int served = p->residual < p->factor.serves && p->freedoms == p->factor.sets.rank;
    for (size_t k = 0; served && k < p->freedoms; k++) {
        served = p->factor.qp.at[p->freedom[k].row] == FREE;
    }
    if (!served) {
        tribo_disc_assemble(p);
        tribo_disc_factorize(p);
    }
    p->factor.serves = takes_long(p) ? GAIN * p->residual : 0.0;
    tribo_disc_gradients(p);
    tribo_disc_follow(p, p->gradient, p->aim);
    if (p->factor.redundant) {
        tribo_disc_slide(p, p->gradient, p->slide);
    }
    for (size_t i = 0; i < p->size; i++) {
        p->aim[i] = cut(p->y[i] + p->aim[i] + (p->factor.redundant ? p->slide[i] : 0.0));
    }
}

static void step_newton(struct disc_qp *p)
{
    find_aim(p);
    disc_project(p, p->from, p->aim, 1.0);
}

/* Finds gradient and places at y. Returns the distance of tribo_disc_places. */
static double disc_look(struct disc_qp *p)
{
    tribo_disc_gradients(p);
    return tribo_disc_places(p);
}

/* Returns 1 if the objective at y is not above that at from, for gradient and noise at y. */
static int descends(struct disc_qp *p)
{
    double change = 0.0, rounding = 0.0;
    for (size_t i = 0; i < p->size; i++) {
        p->spare[i] = p->y[i] - p->from[i];
    }
    tribo_disc_multiply(p, p->spare, p->slide, p->step);
    for (size_t i = 0; i < p->size; i++) {
        change += p->spare[i] * (p->gradient[i] - 0.5 * p->slide[i]);
        rounding += fabs(p->spare[i]) * p->noise[i];
    }
    return change <= rounding;
}

/* Takes as much of Newton's step as lowers the objective: from its part up to the first rim of an inside contact on, halved until
 * it does; all of it if it halves the distance, since near the solution the objective is rounding. If no part does, sweeps. */
static void step_down(struct disc_qp *p)
{
    const double before = p->residual;
    double way = 1.0;
    find_aim(p);
    for (size_t i = 0; i < p->size; i += p->wide[i]) {
        for (int d = 0; p->place[i] == LENS_INSIDE && d < 2; d++) {
            double x[2], step[2];
            for (size_t k = 0; k < p->wide[i]; k++) {
                x[k] = p->from[i + k] + (d ? p->shift[i + k] : 0.0);
                step[k] = p->aim[i + k] - p->from[i + k];
            }
            way = lesser(way, tribo_way_to_rim(p->wide[i], x, step));
        }
    }
    disc_project(p, p->from, p->aim, 1.0);
    disc_look(p);
    if (p->residual < 0.5 * before) {
        return;
    }
    for (double part = way; part > 1e-3 * way; part *= 0.5) {
        disc_project(p, p->from, p->aim, part);
        tribo_disc_gradients(p);
        if (descends(p)) {
            return;
        }
    }
    disc_project(p, p->from, p->from, 1.0);
    disc_sweep(p);
}

/* Repeats step until y, looked at, is the solution up to rounding, at most rounds times. distance: as of disc_look. Returns 0
 * without convergence. */
static int disc_settle(struct disc_qp *p, double distance, int rounds, void (*step)(struct disc_qp *p))
{
    for (int round = 0; !(distance <= SETTLED); round++) {
        if (round == rounds) {
            return 0;
        }
        step(p);
        distance = disc_look(p);
    }
    /* Steps that halve the distance still improve y; those by the factor of an earlier step converge linearly, and go on. */
    double before = HUGE_VAL;
    while (p->residual > (p->factor.serves > 0.0 ? 0.01 : 1.0) * p->near_enough && p->residual < 0.5 * before) {
        before = p->residual;
        memcpy(p->best, p->y, p->size * sizeof *p->y);
        step_newton(p);
        disc_look(p);
    }
    if (p->residual >= before) {
        memcpy(p->y, p->best, p->size * sizeof *p->y);
        disc_look(p);
    }
    return 1;
}

/* Sweeps while each sweep leaves at most SLOW of the move before it: a dozen sweeps take less time than a factor, and show most
 * places and the angles of slides. Newton's method then takes moves from CLOSE on to rounding. */
static void disc_approach(struct disc_qp *p)
{
    double before = HUGE_VAL, move = disc_sweep(p);
    for (int sweep = 1; sweep < SWEEPS && move < SLOW * before && move > CLOSE; sweep++) {
        before = move;
        move = disc_sweep(p);
    }
}

/* `least` of tribo_disc_interior: the places are those of the solution, with LITTLE unless S is nearly singular. */
#define LITTLE 1e-13
#define NOTHING 1e-20

/* y = the solution, from y; without convergence, from the interior-point method. Returns 0 if that does not converge, either. */
static int solve_once(struct disc_qp *p)
{
    const int kept = takes_long(p) && p->factor.group.sparse == p->s.pattern && !p->factor.sets.dependents;
    p->factor.serves = kept ? LASTING : 0.0;
    p->factor.sets = kept ? p->factor.sets : (struct sets){0};
    tribo_disc_gains(p);
    disc_project(p, p->y, p->y, 1.0);
    double distance = disc_look(p);
    if (takes_long(p) && distance > SETTLED) {
        disc_approach(p);
        distance = disc_look(p);
    } else if (!takes_long(p)) { /* of contacts that do not couple `to` is the solution */
        disc_project(p, p->to, p->to, 1.0);
        distance = disc_look(p);
    }
    int done = disc_settle(p, distance, FROM_BEFORE, step_newton);
    for (int deep = 0; !done && deep < 2; deep++) {
        tribo_disc_interior(p, deep ? NOTHING : LITTLE);
        p->factor.serves = 0.0;
        done = disc_settle(p, disc_look(p), FROM_INTERIOR, step_down);
    }
    return done;
}

/* Returns the largest s_kk. */
static double stiffest_of(const struct disc_qp *p)
{
    double most = 0.0;
    for (size_t i = 0; i < p->size; i++) {
        most = greater(most, p->s.val[tribo_disc_own(p, i)]);
    }
    return most;
}

/* y = the solution with stiffness more weight^2 towards centre [size]; NULL: towards 0, which is far, until y moves by rounding
 * only, since in soft directions distances settle before y does. Returns 0 without convergence. */
static int solve_towards(struct disc_qp *p, double more, const double *centre)
{
    double *diagonal = p->kept, *pull = diagonal + p->size, moved = 1.0;
    for (size_t i = 0; i < p->size; i++) {
        const double soft = more * p->weight[i] * p->weight[i];
        diagonal[i] = p->s.val[tribo_disc_own(p, i)];
        pull[i] = p->pull[i];
        p->s.val[tribo_disc_own(p, i)] += soft;
        p->pull[i] -= centre ? soft * centre[i] : 0.0;
    }
    const int done = solve_once(p);
    for (int round = 0; !centre && round < FROM_INTERIOR && moved > 1e-8; round++) {
        step_newton(p);
        disc_look(p);
        moved = 0.0;
        for (size_t i = 0; i < p->size; i++) {
            moved = greater(moved, fabs(p->y[i] - p->from[i]));
        }
    }
    for (size_t i = 0; i < p->size; i++) {
        p->s.val[tribo_disc_own(p, i)] = diagonal[i];
        p->pull[i] = pull[i];
    }
    p->factor.group.sparse = NULL; /* the next problem has another stiffness */
    tribo_disc_gains(p);
    return done;
}

/* Stiffness that keeps y near a point, in parts of the largest s_kk: the first one, and its factor after a solution and without
 * convergence. */
#define KEEPS 1e-8
#define LOOSER 0.1
#define FIRMER 10.0

enum { KEPT_ROUNDS = 16 };

/* Where S is nearly singular, Newton's steps along its soft directions are rounding, and projection to the rims adds their
 * squares, which the other directions feel. Stiffness towards the end of the interior-point method leaves short steps, and moves
 * y by so little that y is the solution without stiffness, too (proximal point algorithm, Rockafellar 1976, SIAM J. Control
 * Optim. 14, 877, doi:10.1137/0314056). */
int tribo_disc_solve(struct disc_qp *p)
{
    if (solve_once(p)) {
        return 1;
    }
    double *centre = p->kept + 2 * p->size, keeps = KEEPS * stiffest_of(p);
    memset(p->place, LENS_INSIDE, p->size);
    tribo_disc_linearize(p);
    const size_t dependents = p->factor.sets.dependents;
    tribo_disc_interior(p, NOTHING);
    memcpy(centre, p->y, p->size * sizeof *centre);
    for (int round = 0; round < KEPT_ROUNDS; round++) {
        const int found = solve_towards(p, keeps, centre);
        p->factor.sets.dependents = dependents; /* of S as it is; the stiffer S has none */
        if (disc_look(p) <= SETTLED) {
            return 1;
        }
        keeps *= found ? LOOSER : FIRMER;
        memcpy(found ? centre : p->y, found ? p->y : centre, p->size * sizeof *centre);
    }
    return 0;
}

/* ------------------------------------------------------------------------------------------------ redundant contacts */

/* Stiffness that takes y to the least norm, in parts of the largest s_kk. */
#define SOFT 1e-6

/* A share within this part of limits of a solution is one: a further solution would leave the share. */
#define SHARED 1e-12

/* Returns 1 if y is a solution, for a further solution would leave the share. nearest: y is the solution nearest to a share, up
 * to rounding, which exceeds SHARED where limits are small beside others. */
static int is_shared(struct disc_qp *p, int nearest)
{
    const int far = p->near_enough < TRIBO_NEAR_ENOUGH, settled = disc_look(p) <= SETTLED;
    return ((far || nearest) && settled) || (!far && p->residual < SHARED);
}

/* With SOFT more stiffness the solution is off by as much; its solutions with SOFT, SOFT/2 and SOFT/4 extrapolate to 0 with
 * errors of third order. Stiffness towards the share then takes y to the solution nearest to the share: Newton's step without
 * stiffness goes far along the null vectors where a rim bears next to no pressure. */
int tribo_disc_share(struct disc_qp *p)
{
    const double part[] = {1.0, 0.5, 0.25}, weight[] = {1.0 / 3.0, -2.0, 8.0 / 3.0};
    const double most = stiffest_of(p);
    double *share = p->kept + 2 * p->size;
    int done = 1, shared;
    memset(share, 0, p->size * sizeof *share);
    for (int k = 0; k < 3; k++) {
        done = solve_towards(p, part[k] * SOFT * most, NULL) && done;
        for (size_t i = 0; i < p->size; i++) {
            share[i] += weight[k] * p->y[i];
        }
    }
    disc_project(p, share, share, 1.0);
    disc_look(p);
    disc_project(p, p->to, p->to, 1.0); /* sliding contacts are on their rims to the last digit */
    for (double nearer = 0.25; !(shared = is_shared(p, nearer < 0.25)) && nearer > 1e-5; nearer *= 0.125) {
        memcpy(share, p->y, p->size * sizeof *share);
        solve_towards(p, nearer * SOFT * most, share);
    }
    return done && (shared || tribo_disc_solve(p));
}

/* ------------------------------------------------------------------------------------------------------------ room */

int tribo_disc_create(struct disc_qp *p, const struct disc_room *room)
{
    const size_t s = room->size + 1, dense = (room->dense + 1) * (room->dense + 1), places = room->places,
                 entries = room->entries, vectors = TRIBO_SPARSE_REDUNDANT * places;
    struct disc_rows *rows = &p->s;
    struct box_qp *qp = &p->factor.qp;
    struct sparse_factor *f = &qp->sparse;
    *p = (struct disc_qp){.room = p->room};
    if (!ALLOCATE_IN(&p->room, ARRAY(p->pull, s), ARRAY(p->shift, s), ARRAY(p->y, s), ARRAY(p->gradient, s), ARRAY(p->noise, s),
                     ARRAY(p->gain, s), ARRAY(p->to, s), ARRAY(p->outward, s), ARRAY(p->curvature, s), ARRAY(p->step, s),
                     ARRAY(p->spare, s), ARRAY(p->best, s), ARRAY(p->from, s), ARRAY(p->aim, s), ARRAY(p->slide, s),
                     ARRAY(qp->q, s), ARRAY(qp->row, s), ARRAY(p->weight, s), ARRAY(p->factor.dense, dense), ARRAY(qp->l, dense),
                     ARRAY(rows->val, dense > entries ? dense : entries),
                     ARRAY(qp->null.basis, dense > vectors ? dense : vectors), ARRAY(rows->first, places + 1),
                     ARRAY(rows->own, places), ARRAY(rows->col, entries), ARRAY(rows->slot, entries), ARRAY(f->l, room->slots),
                     ARRAY(f->d, places), ARRAY(f->w, places), ARRAY(f->index, places), ARRAY(p->kept, 3 * s),
                     ARRAY(p->freedom, s), ARRAY(p->disc, 2 * s), ARRAY(qp->near, s), ARRAY(qp->order, s), ARRAY(p->wide, s),
                     ARRAY(p->place, s), ARRAY(qp->at, s))) {
        return 0;
    }
    qp->scale = qp->q;
    qp->far = 1;
    return 1;
}

void tribo_disc_copy_factor(struct disc_qp *p, const struct disc_qp *from, struct sparse *pattern)
{
    struct disc_factor *f = &p->factor;
    const struct box_qp *like = &from->factor.qp;
    const size_t n = from->factor.group.size;
    f->group = (struct group){.size = n, .sparse = pattern};
    f->sets = from->factor.sets;
    f->qp.group = &f->group;
    f->qp.sets = &f->sets;
    memcpy(f->qp.q, like->q, n * sizeof *like->q);
    memcpy(f->qp.at, like->at, n);
    memcpy(f->qp.order, like->order, n * sizeof *like->order);
    memcpy(f->qp.sparse.l, like->sparse.l, tribo_sparse_slots(pattern) * sizeof *like->sparse.l);
    memcpy(f->qp.sparse.d, like->sparse.d, n * sizeof *like->sparse.d);
    memcpy(f->qp.sparse.index, like->sparse.index, n * sizeof *like->sparse.index);
}

void tribo_disc_free(struct disc_qp *p)
{
    free(p->room.block);
    *p = (struct disc_qp){0};
}

void tribo_disc_alone(struct disc_alone *x, const double *s, const double *pull, const double *shift)
{
    x->p.room = (struct room){x->store, sizeof x->store};
    tribo_disc_create(&x->p, &(struct disc_room){.size = 2, .dense = 2});
    x->p.size = x->p.wide[0] = 2;
    x->p.near_enough = TRIBO_NEAR_ENOUGH;
    x->p.weight[0] = x->p.weight[1] = 1.0;
    memcpy(x->p.s.val, s, 4 * sizeof *s);
    memcpy(x->p.pull, pull, 2 * sizeof *pull);
    memcpy(x->p.shift, shift, 2 * sizeof *shift);
}
