/* The reach of planar contacts and of the scalar ones beside them. A limit that is far beyond what pulls at a contact leaves no
 * digits to a force in parts of it. The force is then looked for within a smaller disc, a reach. Where it lies inside, it is the
 * solution for the limit, too, since the problem is convex; where it does not, the reach grows.
 *
 * A direction of a planar contact is loose if its force is such a small part of its limit that the other direction has its whole
 * limit, to the last digit. Then each of them is an interval of its own, with a reach of its own. Else both have one reach if
 * the limits of both are beyond it, or none. */
#include <float.h>

#include "core/context.h"

/* A reach is that many times what pulls at a contact would ask for. */
#define AMPLE 1e3

/* A reach is at least such a part of what any contact could be asked for. */
#define LITTLE 1e-50

/* A direction whose reach is less than this part of its limit is loose. */
#define BESIDE 1e-8

/* What the rim of the other direction adds to the stiffness of one that is loose is at most this part of it. */
#define STRAIGHT 1e-12

static int is_loose(const tribo_context *ctx, size_t i)
{
    return ctx->plane.radius[i] < BESIDE * ctx->follow.contacts.bound[i];
}

void tribo_planar_arrange(tribo_context *ctx, const struct cluster *g)
{
    struct disc_qp *p = &ctx->plane.problem;
    const size_t *member = ctx->planar->member + g->member;
    const unsigned char *directions = ctx->plane.directions;
    ctx->plane.cuts = 0;
    for (size_t k = 0; k < p->size; k++) {
        const size_t i = member[ctx->plane.near[k]];
        p->wide[k] = directions[k];
        p->shift[k] = ctx->plane.shift[k];
        if (tribo_planar_cut(ctx, i)) {
            p->shift[k] = product(quotient(ctx->follow.contacts.bound[i], ctx->plane.radius[i]), p->shift[k]);
            ctx->plane.cuts++;
        }
    }
    for (size_t e = 0; ctx->plane.cuts && e < p->size; e += directions[e]) {
        const size_t i = member[ctx->plane.near[e]];
        if (directions[e] == 2 && (is_loose(ctx, i) || is_loose(ctx, i + 1))) {
            p->wide[e] = p->wide[e + 1] = 1;
        }
    }
}

/* Gives the contact at e of the problem the reaches wanted [directions], as far as its limits are beyond them. */
static void set_radius(tribo_context *ctx, const struct cluster *g, size_t e, size_t directions, const double *wanted)
{
    const size_t i = ctx->planar->member[g->member + ctx->plane.near[e]];
    const double *bound = ctx->follow.contacts.bound + i;
    const int pair = directions == 2, apart = pair && (wanted[0] < BESIDE * bound[0] || wanted[1] < BESIDE * bound[1]);
    for (size_t k = 0; k < directions; k++) {
        const double before = tribo_planar_reach(ctx, i + k);
        const double radius = pair && !apart ? greater(wanted[0], wanted[1]) : wanted[k];
        const double least = pair && !apart ? lesser(bound[0], bound[1]) : bound[k];
        ctx->plane.radius[i + k] = radius < least ? radius : HUGE_VAL;
        const double reach = tribo_planar_reach(ctx, i + k);
        ctx->plane.y[i + k] = reach == before ? ctx->plane.y[i + k] : product(quotient(before, reach), ctx->plane.y[i + k]);
    }
}

/* Whether all contacts are pulled at by so much that their limits are not far, and have no reach below them. */
static int all_ask(const tribo_context *ctx, const struct cluster *g)
{
    const size_t n = ctx->plane.problem.size, *near = ctx->plane.near, *member = ctx->planar->member + g->member;
    size_t k = 0;
    while (k < n &&
           product(ctx->follow.contacts.bound[member[near[k]]], ctx->planar->r[g->r + near[k] * (g->size + 1)]) <=
               AMPLE * fabs(ctx->plane.pull[k]) &&
           !tribo_planar_cut(ctx, member[near[k]])) {
        k++;
    }
    return k == n;
}

/* What direction k of the problem would carry alone. */
static double ask_of(const tribo_context *ctx, const struct cluster *g, size_t k)
{
    const size_t at = ctx->plane.near[k], i = ctx->planar->member[g->member + at];
    const double r = ctx->planar->r[g->r + at * (g->size + 1)], bound = ctx->follow.contacts.bound[i];
    return lesser(quotient(fabs(ctx->plane.pull[k]), r) + product(fabs(ctx->plane.shift[k]), bound), bound);
}

/* The most that a direction would carry alone, times sqrt(R_kk): what any of them could be asked for, in the same units. */
static double largest_ask(const tribo_context *ctx, const struct cluster *g)
{
    double most = 0.0;
    for (size_t k = 0; k < ctx->plane.problem.size; k++) {
        const double r = ctx->planar->r[g->r + ctx->plane.near[k] * (g->size + 1)];
        most = greater(most, product(ask_of(ctx, g, k), sqrt(r)));
    }
    return most;
}

/* Whether a limit is far beyond what the contact could be asked for. */
static int any_unreachable(const tribo_context *ctx, const struct cluster *g, double most)
{
    size_t far = 0;
    for (size_t k = 0; k < ctx->plane.problem.size; k++) {
        const size_t at = ctx->plane.near[k], i = ctx->planar->member[g->member + at];
        const double root = sqrt(ctx->planar->r[g->r + at * (g->size + 1)]);
        far += product(ctx->follow.contacts.bound[i], root) > AMPLE * most || tribo_planar_cut(ctx, i);
    }
    return far > 0;
}

/* ask [size] = what each direction would carry alone, or for the sake of the others, at most. */
static void spread_asks(const tribo_context *ctx, const struct cluster *g, double *ask)
{
    const size_t n = ctx->plane.problem.size, *near = ctx->plane.near;
    int grown = 1;
    for (size_t k = 0; k < n; k++) {
        ask[k] = ask_of(ctx, g, k);
    }
    for (size_t round = 0; grown && round < n; round++) {
        grown = 0;
        for (size_t k = 0; k < n; k++) {
            const double *row = ctx->planar->r + g->r + near[k] * g->size, before = ask[k];
            for (size_t j = 0; j < n; j++) {
                ask[k] = j == k ? ask[k] : greater(ask[k], quotient(product(fabs(row[near[j]]), ask[j]), row[near[k]]));
            }
            ask[k] = lesser(ask[k], ctx->follow.contacts.bound[ctx->planar->member[g->member + near[k]]]);
            grown |= ask[k] > before;
        }
    }
}

/* Nothing pulls at any contact. */
static void rest(tribo_context *ctx, const struct cluster *g)
{
    for (size_t k = 0; k < ctx->plane.problem.size; k++) {
        const size_t i = ctx->planar->member[g->member + ctx->plane.near[k]];
        ctx->plane.radius[i] = HUGE_VAL;
        ctx->plane.y[i] = 0.0;
    }
}

void tribo_planar_estimate(tribo_context *ctx, const struct cluster *g)
{
    const size_t n = ctx->plane.problem.size;
    double *ask = ctx->plane.problem.spare;
    if (all_ask(ctx, g)) {
        return;
    }
    const double most = largest_ask(ctx, g);
    if (!any_unreachable(ctx, g, most)) {
        return;
    }
    if (!(most > 0.0)) {
        rest(ctx, g);
        return;
    }
    spread_asks(ctx, g, ask);
    for (size_t e = 0; e < n; e += ctx->plane.directions[e]) {
        const size_t count = ctx->plane.directions[e];
        double wanted[2];
        for (size_t d = 0; d < count; d++) {
            const double root = sqrt(ctx->planar->r[g->r + ctx->plane.near[e + d] * (g->size + 1)]);
            wanted[d] = product(greater(ask[e + d], greater(quotient(LITTLE * most, root), DBL_MIN)), AMPLE);
        }
        set_radius(ctx, g, e, count, wanted);
    }
}

/* Whether the direction at e of the problem is on the rim of its limit, and that bends so much that the direction at other cannot
 * be loose. */
static int planar_reach_bends(const tribo_context *ctx, const struct cluster *g, size_t e, size_t other)
{
    const struct disc_qp *p = &ctx->plane.problem;
    const size_t *member = ctx->planar->member + g->member, i = member[ctx->plane.near[e]], j = member[ctx->plane.near[other]];
    const double part = quotient(tribo_planar_reach(ctx, j), ctx->follow.contacts.bound[j]);
    return p->place[e] != LENS_INSIDE && !tribo_planar_cut(ctx, i) && tribo_planar_cut(ctx, j) &&
           fabs(p->gradient[e]) * part * part > STRAIGHT * p->s[other * (p->size + 1)];
}

size_t tribo_planar_widen(tribo_context *ctx, const struct cluster *g)
{
    const struct disc_qp *p = &ctx->plane.problem;
    const size_t *member = ctx->planar->member + g->member;
    size_t widened = 0;
    for (size_t e = 0; e < p->size; e += ctx->plane.directions[e]) {
        const size_t count = ctx->plane.directions[e];
        double wanted[2];
        int out = 0;
        for (size_t d = 0; d < count; d++) {
            const size_t i = member[ctx->plane.near[e + d]], at = p->wide[e + d] ? e + d : e;
            const int beyond = p->place[at] != LENS_INSIDE && tribo_planar_cut(ctx, i);
            wanted[d] = beyond ? product(AMPLE, ctx->plane.radius[i]) : ctx->plane.radius[i];
            out |= beyond;
        }
        if (p->wide[e] < count && (planar_reach_bends(ctx, g, e, e + 1) || planar_reach_bends(ctx, g, e + 1, e))) {
            wanted[0] = wanted[1] = HUGE_VAL;
            out = 1;
        }
        if (out) {
            set_radius(ctx, g, e, count, wanted);
            widened++;
        }
    }
    return widened;
}
