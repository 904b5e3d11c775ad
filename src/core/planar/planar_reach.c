/* SPDX-License-Identifier: BSD-3-Clause */
/* Reaches of planar contacts and of the scalar ones beside them. In parts of a limit that is far beyond the pull at a contact, a
 * force has no digits. The force is then looked for within a smaller disc, a reach. If it lies inside, it is the solution for the
 * limit, too, since the problem is convex; else the reach grows.
 *
 * A direction of a planar contact is loose if its force is such a small part of its limit that the other direction has its whole
 * limit, to the last digit. Then both are intervals, each with a reach. Else both have one reach, if both limits exceed it, or
 * none. */
#include "parts.h"

/* A reach is this factor times what the pull at a contact would make of its force. */
#define AMPLE 1e3

/* A reach is at least this part of the largest force that any contact could carry. */
#define LITTLE 1e-50

/* A direction whose reach is less than this part of its limit is loose. */
#define BESIDE 1e-8

/* The rim of the other direction adds at most this part to the stiffness of a loose one. */
#define STRAIGHT 1e-12

void tribo_planar_arrange(tribo_context *ctx)
{
    struct disc_qp *p = &ctx->planar->problem;
    const double *bound = ctx->follow.contacts.bound, *radius = ctx->planar->radius;
    const unsigned char *directions = ctx->planar->directions;
    ctx->planar->cuts = 0;
    for (size_t k = 0; k < p->size; k++) {
        const size_t i = ctx->planar->contact[k];
        p->wide[k] = directions[k];
        p->shift[k] = ctx->planar->shift[k];
        if (tribo_planar_cut(ctx, i)) {
            p->shift[k] = product(quotient(bound[i], radius[i]), p->shift[k]);
            ctx->planar->cuts++;
        }
    }
    for (size_t e = 0; ctx->planar->cuts && e < p->size; e += directions[e]) {
        const size_t i = ctx->planar->contact[e];
        if (directions[e] == 2 && (radius[i] < BESIDE * bound[i] || radius[i + 1] < BESIDE * bound[i + 1])) {
            p->wide[e] = p->wide[e + 1] = 1;
        }
    }
}

/* Gives the contact at e of the problem the reaches wanted [directions], as far as its limits exceed them. */
static void set_radius(tribo_context *ctx, size_t e, size_t directions, const double *wanted)
{
    const size_t i = ctx->planar->contact[e];
    const double *bound = ctx->follow.contacts.bound + i;
    const int pair = directions == 2, apart = pair && (wanted[0] < BESIDE * bound[0] || wanted[1] < BESIDE * bound[1]);
    for (size_t k = 0; k < directions; k++) {
        const double before = tribo_planar_reach(ctx, i + k);
        const double radius = pair && !apart ? greater(wanted[0], wanted[1]) : wanted[k];
        const double least = pair && !apart ? lesser(bound[0], bound[1]) : bound[k];
        ctx->planar->radius[i + k] = radius < least ? radius : HUGE_VAL;
        const double reach = tribo_planar_reach(ctx, i + k);
        ctx->planar->y[i + k] = reach == before ? ctx->planar->y[i + k] : product(quotient(before, reach), ctx->planar->y[i + k]);
    }
}

/* ask [size]: the force of each direction alone becomes the largest that balances the asks of the others, up to its limit. */
static void find_asks(const tribo_context *ctx, const struct cluster *g, double *ask)
{
    const size_t n = ctx->planar->problem.size, *near = ctx->planar->near;
    const double *bound = ctx->follow.contacts.bound;
    int grown = 1;
    for (size_t round = 0; grown && round < n; round++) {
        grown = 0;
        for (size_t k = 0; k < n; k++) {
            const double *row = g->r + near[k] * g->size, before = ask[k];
            for (size_t j = 0; j < n; j++) {
                ask[k] = j == k ? ask[k] : greater(ask[k], quotient(product(fabs(row[near[j]]), ask[j]), row[near[k]]));
            }
            ask[k] = lesser(ask[k], bound[ctx->planar->contact[k]]);
            grown |= ask[k] > before;
        }
    }
}

void tribo_planar_estimate(tribo_context *ctx, const struct cluster *g)
{
    const size_t n = ctx->planar->problem.size;
    const double *bound = ctx->follow.contacts.bound;
    double *ask = ctx->planar->problem.spare,
           most = 0.0; /* the largest ask sqrt(R_ii): in these units asks of contacts compare */
    int far = 0;
    for (size_t k = 0; k < n; k++) {
        const size_t i = ctx->planar->contact[k];
        ask[k] =
            lesser(quotient(fabs(ctx->planar->pull[k]), ctx->op->diagonal[i]) + product(fabs(ctx->planar->shift[k]), bound[i]),
                   bound[i]);
        most = greater(most, product(ask[k], sqrt(ctx->op->diagonal[i])));
    }
    for (size_t k = 0; k < n; k++) {
        const size_t i = ctx->planar->contact[k];
        far |= product(bound[i], sqrt(ctx->op->diagonal[i])) > AMPLE * most || tribo_planar_cut(ctx, i);
    }
    for (size_t k = 0; far && !(most > 0.0) && k < n; k++) {
        const size_t i = ctx->planar->contact[k];
        ctx->planar->radius[i] = HUGE_VAL;
        ctx->planar->y[i] = 0.0;
    }
    if (!far || !(most > 0.0)) {
        return;
    }
    find_asks(ctx, g, ask);
    for (size_t e = 0; e < n; e += ctx->planar->directions[e]) {
        const size_t count = ctx->planar->directions[e];
        double wanted[2];
        for (size_t d = 0; d < count; d++) {
            const double root = sqrt(ctx->op->diagonal[ctx->planar->contact[e + d]]);
            wanted[d] = product(greater(ask[e + d], greater(quotient(LITTLE * most, root), DBL_MIN)), AMPLE);
        }
        set_radius(ctx, e, count, wanted);
    }
}

/* 1 if the direction at e of the problem is on the rim of its limit, which bends so much that the direction at other cannot be
 * loose. */
static int planar_reach_bends(const tribo_context *ctx, size_t e, size_t other)
{
    const struct disc_qp *p = &ctx->planar->problem;
    const size_t i = ctx->planar->contact[e], j = ctx->planar->contact[other];
    const double part = quotient(tribo_planar_reach(ctx, j), ctx->follow.contacts.bound[j]);
    return p->place[e] != LENS_INSIDE && !tribo_planar_cut(ctx, i) && tribo_planar_cut(ctx, j) &&
           fabs(p->gradient[e]) * part * part > STRAIGHT * p->s[other * (p->size + 1)];
}

size_t tribo_planar_widen(tribo_context *ctx)
{
    const struct disc_qp *p = &ctx->planar->problem;
    size_t widened = 0;
    for (size_t e = 0; e < p->size; e += ctx->planar->directions[e]) {
        const size_t count = ctx->planar->directions[e];
        double wanted[2];
        int out = 0;
        for (size_t d = 0; d < count; d++) {
            const size_t i = ctx->planar->contact[e + d], at = p->wide[e + d] ? e + d : e;
            const int beyond = p->place[at] != LENS_INSIDE && tribo_planar_cut(ctx, i);
            wanted[d] = beyond ? product(AMPLE, ctx->planar->radius[i]) : ctx->planar->radius[i];
            out |= beyond;
        }
        if (p->wide[e] < count && (planar_reach_bends(ctx, e, e + 1) || planar_reach_bends(ctx, e + 1, e))) {
            wanted[0] = wanted[1] = HUGE_VAL;
            out = 1;
        }
        if (out) {
            set_radius(ctx, e, count, wanted);
            widened++;
        }
    }
    return widened;
}
