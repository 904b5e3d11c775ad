/* Solves the problem of discs, lenses and intervals.
 *
 *     Newton's method from where the last call ended, its steps brought back to the set: in a call like the last it ends at once
 *     if it does not end: an interior-point method, and Newton's method from there
 *
 * Either ends only when y is the nearest point of the set to y - gain gradient, up to rounding, which is to say that it is the
 * solution. */
#include "disc_qp.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "common/real.h"

enum { FROM_BEFORE = 12, FROM_INTERIOR = 40 };

/* Distances of so much rounding are none. */
#define SETTLED 4.0

/* y = the point of the set that is nearest to from + part (aim - from). */
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

/* aim = where Newton's method leads from y, gradient and places being those at y. */
static void find_aim(struct disc_qp *p)
{
    memcpy(p->from, p->y, p->size * sizeof *p->y);
    for (size_t i = 0; i < p->size; i += p->wide[i]) {
        for (size_t k = i; k < i + p->wide[i]; k++) {
            p->y[k] = p->place[i] == LENS_INSIDE ? p->y[k] : p->to[k];
        }
    }
    tribo_disc_linearize(p);
    tribo_disc_gradients(p);
    tribo_disc_follow(p, p->gradient, p->aim);
    if (p->redundant) {
        tribo_disc_slide(p, p->gradient, p->slide);
    }
    for (size_t i = 0; i < p->size; i++) {
        p->aim[i] = cut(p->y[i] + p->aim[i] + (p->redundant ? p->slide[i] : 0.0));
    }
}

static void step_newton(struct disc_qp *p)
{
    find_aim(p);
    disc_project(p, p->from, p->aim, 1.0);
}

/* Returns what tribo_disc_places does. */
static double disc_look(struct disc_qp *p)
{
    tribo_disc_gradients(p);
    return tribo_disc_places(p);
}

/* Whether the objective at y is less than at from, where gradient and noise are those at y: the difference is found from the way
 * between them, so that little of it is lost. */
static int descends(const struct disc_qp *p)
{
    double change = 0.0, rounding = 0.0;
    for (size_t i = 0; i < p->size; i++) {
        double turn = 0.0;
        for (size_t k = 0; k < p->size; k++) {
            turn += p->s[i * p->size + k] * (p->y[k] - p->from[k]);
        }
        change += (p->y[i] - p->from[i]) * (p->gradient[i] - 0.5 * turn);
        rounding += fabs(p->y[i] - p->from[i]) * p->noise[i];
    }
    return change <= rounding;
}

/* How far from may go towards aim until a contact that is inside meets a rim, which is one of |x + t step| = 1. */
static double way_inside(const struct disc_qp *p)
{
    double way = 1.0;
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
    return way;
}

/* As much of Newton's step as leads downwards; near the solution, where that drowns in rounding, all of it if it leads nearer. */
static void step_down(struct disc_qp *p)
{
    const double before = p->residual;
    find_aim(p);
    const double way = way_inside(p);
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
    /* contact by contact to the point of its set nearest to y - gain gradient: slow, but always downwards */
    for (size_t i = 0; i < p->size; i += p->wide[i]) {
        double gradient[2];
        for (size_t k = 0; k < p->wide[i]; k++) {
            gradient[k] = p->pull[i + k];
            for (size_t j = 0; j < p->size; j++) {
                gradient[k] += p->s[(i + k) * p->size + j] * p->y[j];
            }
        }
        tribo_disc_descend(p, i, gradient, p->y + i);
    }
}

static int disc_settle(struct disc_qp *p, int rounds, void (*step)(struct disc_qp *p))
{
    for (int round = 0; disc_look(p) > SETTLED; round++) {
        if (round == rounds) {
            return 0;
        }
        step(p);
    }
    /* y is the solution but for rounding; steps that halve the distance may still improve it */
    double before = HUGE_VAL;
    while (p->residual > p->near_enough && p->residual < 0.5 * before) {
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

int tribo_disc_solve(struct disc_qp *p)
{
    /* contacts that do not couple: the point of the set nearest to y - gain gradient is the solution */
    p->sets = (struct sets){0};
    tribo_disc_gains(p);
    disc_project(p, p->y, p->y, 1.0);
    disc_look(p);
    disc_project(p, p->to, p->to, 1.0);
    if (disc_settle(p, FROM_BEFORE, step_newton)) {
        return 1;
    }
    tribo_disc_interior(p);
    return disc_settle(p, FROM_INTERIOR, step_down);
}

/* ------------------------------------------------------------------------------------------------ redundant contacts */

/* As stiff as that, in parts of s, is what takes y to the least norm. */
#define SOFT 1e-6

/* y = the solution with so much stiffness more. */
static int solve_softly(struct disc_qp *p, double more)
{
    for (size_t i = 0; i < p->size; i++) {
        p->s[i * (p->size + 1)] = p->diagonal[i] + more * p->weight[i] * p->weight[i];
    }
    const int done = tribo_disc_solve(p);
    /* Newton's steps until one moves y by rounding only: in soft directions distances settle long before y does */
    double moved = 1.0;
    for (int round = 0; round < FROM_INTERIOR && moved > 1e-8; round++) {
        step_newton(p);
        disc_look(p);
        moved = 0.0;
        for (size_t i = 0; i < p->size; i++) {
            moved = greater(moved, fabs(p->y[i] - p->from[i]));
        }
    }
    return done;
}

/* Off by no more than that, in parts of limits, y is not solved for again: that would leave the share. */
#define SHARED 1e-12

/* The solution with a little stiffness more is off by that; those with half and a quarter of it show by how much, to second
 * order. */
int tribo_disc_share(struct disc_qp *p)
{
    const double part[] = {1.0, 0.5, 0.25}, weight[] = {1.0 / 3.0, -2.0, 8.0 / 3.0};
    double most = 0.0;
    int done = 1;
    for (size_t i = 0; i < p->size; i++) {
        p->diagonal[i] = p->s[i * (p->size + 1)];
        most = greater(most, p->diagonal[i]);
        p->share[i] = 0.0;
    }
    for (int k = 0; k < 3; k++) {
        done = solve_softly(p, part[k] * SOFT * most) && done;
        for (size_t i = 0; i < p->size; i++) {
            p->share[i] += weight[k] * p->y[i];
        }
    }
    for (size_t i = 0; i < p->size; i++) {
        p->s[i * (p->size + 1)] = p->diagonal[i];
    }
    tribo_disc_gains(p);
    disc_project(p, p->share, p->share, 1.0);
    disc_look(p);
    disc_project(p, p->to, p->to, 1.0); /* what slides is on its rim, to the last digit */
    const double off = disc_look(p);
    const int shared = p->near_enough < TRIBO_NEAR_ENOUGH ? off <= SETTLED : p->residual < SHARED;
    return done && (shared || tribo_disc_solve(p));
}

/* ------------------------------------------------------------------------------------------------------------ room */

/* Makes vectors of store [TRIBO_DISC_VECTORS s], press being two of them. */
static void lay_out(struct disc_qp *p, double *store, size_t s)
{
    double **const vector[] = {&p->pull,    &p->shift,     &p->y,          &p->gradient, &p->noise,    &p->gain,  &p->to,
                               &p->outward, &p->curvature, &p->step,       &p->spare,    &p->best,     &p->from,  &p->aim,
                               &p->slide,   &p->factor.q,  &p->factor.row, &p->weight,   &p->diagonal, &p->share, &p->press};
    for (size_t k = 0; k < sizeof vector / sizeof *vector; k++) {
        *vector[k] = store + k * s;
    }
}

int tribo_disc_create(struct disc_qp *p, size_t most)
{
    const size_t s = most + 1;
    struct box_qp *f = &p->factor;
    *p = (struct disc_qp){0};
    double *store = calloc(TRIBO_DISC_VECTORS * s, sizeof *store);
    lay_out(p, store, s);
    p->wide = calloc(s, 1);
    p->place = malloc(s);
    p->s = calloc(s * s, sizeof *p->s);
    p->matrix = malloc(s * s * sizeof *p->matrix);
    p->freedom = malloc(s * sizeof *p->freedom);
    f->near = malloc(s * sizeof *f->near);
    f->order = malloc(s * sizeof *f->order);
    f->at = malloc(s);
    f->l = malloc(s * s * sizeof *f->l);
    f->basis = malloc(s * s * sizeof *f->basis);
    return store && p->wide && p->place && p->s && p->matrix && p->freedom && f->near && f->order && f->at && f->l && f->basis;
}

void tribo_disc_free(struct disc_qp *p)
{
    free(p->pull);
    free(p->wide);
    free(p->place);
    free(p->s);
    free(p->matrix);
    free(p->freedom);
    free(p->factor.near);
    free(p->factor.order);
    free(p->factor.at);
    free(p->factor.l);
    free(p->factor.basis);
    *p = (struct disc_qp){0};
}

void tribo_disc_alone(struct disc_alone *x, const double *s, const double *pull, const double *shift)
{
    memset(x, 0, sizeof *x);
    memcpy(x->s, s, 4 * sizeof *s);
    x->wide[0] = 2;
    x->p = (struct disc_qp){.size = 2, .wide = x->wide, .place = x->place, .s = x->s, .matrix = x->matrix, .freedom = x->freedom};
    x->p.near_enough = TRIBO_NEAR_ENOUGH;
    x->p.factor = (struct box_qp){.near = x->near, .order = x->order, .at = x->at, .l = x->l, .basis = x->basis};
    lay_out(&x->p, x->store, TRIBO_DISC_ALONE);
    memcpy(x->p.pull, pull, 2 * sizeof *pull);
    memcpy(x->p.shift, shift, 2 * sizeof *shift);
}
