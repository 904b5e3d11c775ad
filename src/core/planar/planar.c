/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar contacts: one alone, its motion and limits; life and settings of all. Clusters are made anew whenever operator or
 * contacts change. */
#include <stdlib.h>

#include "common/layout.h"
#include "numerics/union_find.h"
#include "core/calls.h"

/* ---------------------------------------------------------------------------------------------------- one contact alone */

/* A contact with a speed above EDGE epsilon has a lens whose width is rounding: it counts as sliding. */
#define EDGE (1.0 - 16.0 * DBL_EPSILON)

struct slide tribo_planar_slide(const tribo_context *ctx, size_t i, const double *v)
{
    const size_t directions = tribo_directions(ctx, i);
    const struct contacts *c = &ctx->follow.contacts;
    const double *bound = (ctx->set.breaking ? ctx->follow.hold : c->bound) + i;
    struct slide s = {.directions = directions, .open = 1};
    double longest = -1.0;
    for (size_t k = 0; k < directions; k++) {
        const double way = product(bound[k], tribo_epsilon_of(c, i + k));
        s.far = way > longest || (way == longest && bound[k] > bound[0]) ? k : s.far;
        longest = greater(longest, way);
        s.open &= !(bound[k] > 0.0);
    }
    s.bound = bound[s.far];
    for (size_t k = 0; k < directions && !s.open; k++) {
        s.part[k] = bound[k] == s.bound ? 1.0 : quotient(bound[k], s.bound);
        s.x[k] = product(s.part[k], v[k]);
    }
    s.length = tribo_length(2, s.x);
    for (size_t k = 0; k < directions && s.length > 0.0; k++) {
        s.n[k] = s.x[k] / s.length;
    }
    s.epsilon = tribo_epsilon_of(c, i + s.far);
    s.speed = quotient(s.length, s.epsilon);
    return s;
}

int tribo_planar_near(const struct law *law, const struct slide *s)
{
    const int near = !law->sticks_in_band ? s->length == 0.0 : law->relaxes ? s->speed < EDGE : s->speed <= 1.0;
    return !s->open && law->uses_feq && near;
}

/* Laws that do not use f_eq have the force of a scalar contact with limit and epsilon 1, along the direction of motion. */
double tribo_planar_carried(const struct law *law, double speed, double *slope)
{
    const double one = 1.0, two = 2.0, none = 0.0;
    const unsigned char moving = 0;
    const struct contacts c = {&one, &one, &one, &two, &moving, 0, 0, 0, 0, NULL};
    double f = -1.0;
    struct tangent d = {0.0, 0.0, 0.0};
    if (!law->uses_feq) {
        law->tangent(&c, 1, &speed, &none, &(struct tangents){&f, &d.dv, &d.dfeq, &d.dlimit});
    }
    *slope = d.dv;
    return f;
}

void tribo_planar_slide_force(const struct law *law, const struct slide *s, const double *limit, double *f)
{
    double ignored;
    const double carried = tribo_planar_carried(law, s->speed, &ignored);
    for (size_t k = 0; k < s->directions; k++) {
        f[k] = carried * s->n[k] * limit[k];
    }
}

void tribo_planar_limits(const tribo_context *ctx, size_t i, int holds, const double *v, double *limit)
{
    const size_t directions = tribo_directions(ctx, i);
    const double speed = tribo_length((int)directions, v);
    for (size_t k = 0; k < directions; k++) {
        limit[k] = holds && ctx->set.breaking == DROPS ? ctx->follow.hold[i + k] : tribo_limit_at(ctx, i + k, speed);
    }
}

struct block tribo_block_of(const double *r, size_t size, size_t directions)
{
    const double second = r[(directions - 1) * (size + 1)], across = directions == 2 ? r[1] : 0.0;
    const double mean = 0.5 * r[0] + 0.5 * second, half = 0.5 * r[0] - 0.5 * second;
    const double turned[2] = {half, across}, spread = tribo_length(2, turned);
    const double raw[2] = {half >= 0.0 ? spread + half : across, half >= 0.0 ? across : spread - half},
                 length = tribo_length(2, raw);
    return (struct block){
        mean + spread, greater(mean - spread, 0.0), {length > 0.0 ? raw[0] / length : 1.0, length > 0.0 ? raw[1] / length : 0.0}};
}

double tribo_plane_rate(const tribo_context *ctx)
{
    const double none[2] = {0.0, 0.0};
    double rate = 0.0;
    for (size_t k = 0; k < ctx->plane.count; k++) {
        const double *own = ctx->plane.own[k];
        const struct slide s = tribo_planar_slide(ctx, ctx->plane.first[k], none);
        double weighed[4];
        for (size_t e = 0; e < 4; e++) {
            weighed[e] = product(s.part[e / 2], product(s.part[e % 2], own[e]));
        }
        if (!s.open) {
            rate = greater(rate, product(2.0 * quotient(s.bound, s.epsilon), tribo_block_of(weighed, 2, 2).great));
        }
    }
    return rate;
}

/* -------------------------------------------------------------------------------------------------------------- life */

void tribo_clusters_free(struct clusters *c)
{
    tribo_disc_free(&c->problem);
    free(c->cluster ? c->cluster->r : NULL);
    free(c->first);
}

/* Makes count planar contacts of n directions, without clusters. Returns 0 if out of memory. */
static int planar_create(struct clusters *c, size_t n, size_t count, const size_t *first)
{
    size_t *member;
    if (!ALLOCATE(ARRAY(c->first, count), ARRAY(c->role, n), ARRAY(c->own, count), ARRAY(c->group_of, n),
                  ARRAY(c->cluster, count), ARRAY(member, n), ARRAY(c->near, n + 1), ARRAY(c->contact, n),
                  ARRAY(c->directions, n), ARRAY(c->y, n), ARRAY(c->a, n), ARRAY(c->v, n), ARRAY(c->df, n), ARRAY(c->growth, n),
                  ARRAY(c->radius, n), ARRAY(c->pull, n), ARRAY(c->shift, n))) {
        return 0;
    }
    c->count = count;
    c->cluster->member = member;
    memcpy(c->first, first, count * sizeof *first);
    for (size_t k = 0; k < count; k++) {
        c->role[first[k]] = ROLE_FIRST;
        c->role[first[k] + 1] = ROLE_SECOND;
        c->own[k][0] = c->own[k][3] = 1.0;
    }
    for (size_t i = 0; i < n; i++) {
        c->radius[i] = HUGE_VAL;
    }
    return 1;
}

/* --------------------------------------------------------------------------------------------------------- clusters */

/* Sets R of all clusters, which is 0, group_of and own. of, place [n]: see tribo_list_sets. */
static void fill_clusters(struct clusters *c, const struct delassus *op, struct memory *m, size_t n, const size_t *of,
                          const size_t *place)
{
    for (size_t i = 0; i < n; i++) {
        c->group_of[i] = op->groups && of[i] == SIZE_MAX ? op->group_of[i] : TRIBO_ALONE;
        if (of[i] != SIZE_MAX) {
            c->cluster[of[i]].r[place[i] * (c->cluster[of[i]].size + 1)] = op->diagonal[i];
        }
    }
    for (size_t g = 0; g < op->groups; g++) {
        struct box_qp *p = tribo_memory_problem(op, m, g);
        struct cluster *to = of[p->member[0]] != SIZE_MAX ? &c->cluster[of[p->member[0]]] : NULL;
        double *unit = p->step, ignored;
        memset(unit, 0, p->group->size * sizeof *unit);
        for (size_t j = 0; to && j < p->group->size; j++) {
            unit[j] = 1.0;
            for (size_t i = 0; i < p->group->size; i++) {
                to->r[place[p->member[i]] * to->size + place[p->member[j]]] = tribo_row_dot(p, i, unit, &ignored);
            }
            unit[j] = 0.0;
            to->redundant |= p->group->nullity > 0;
        }
    }
    for (size_t k = 0; k < c->count; k++) {
        const struct cluster *g = &c->cluster[of[c->first[k]]];
        const double *row = g->r + place[c->first[k]] * (g->size + 1);
        c->own[k][0] = row[0];
        c->own[k][1] = c->own[k][2] = row[1];
        c->own[k][3] = row[g->size + 1];
    }
}

/* Makes clusters of the operator's groups and the contacts that join them; a status. m: memory of op. */
static int find_clusters(struct clusters *c, size_t n, const struct delassus *op, struct memory *m)
{
    enum { LISTS = 5 };
    size_t *parent = malloc(LISTS * (n + 1) * sizeof *parent), entries = 0;
    if (!parent) {
        return TRIBO_ERR_MEMORY;
    }
    size_t *chosen = parent + n + 1, *of = chosen + n + 1, *place = of + n + 1, *start = place + n + 1;
    for (size_t i = 0; i < n; i++) {
        parent[i] = i;
        chosen[i] = 0;
        if (op->groups && op->group_of[i] != TRIBO_ALONE) {
            tribo_join(parent, op->member[op->group[op->group_of[i]].first], i);
        }
    }
    for (size_t k = 0; k < c->count; k++) {
        tribo_join(parent, c->first[k], c->first[k] + 1);
    }
    for (size_t k = 0; k < c->count; k++) {
        chosen[tribo_root(parent, c->first[k])] = 2;
    }
    for (size_t i = 0; i < n; i++) {
        c->islands += parent[i] == i;
    }
    size_t *member = c->cluster->member;
    c->clusters = tribo_list_sets(n, parent, chosen, of, place, start, member);
    for (size_t k = 0; k < c->clusters; k++) {
        c->cluster[k].member = member + start[k];
        c->cluster[k].size = start[k + 1] - start[k];
        c->largest = c->cluster[k].size > c->largest ? c->cluster[k].size : c->largest;
        entries += c->cluster[k].size * c->cluster[k].size;
    }
    int status = c->largest > TRIBO_CLUSTER_MOST ? TRIBO_ERR_UNSUPPORTED : TRIBO_OK;
    double *r = status ? NULL : calloc(entries, sizeof *r);
    c->cluster->r = r;
    if (r) {
        for (size_t k = 0; k < c->clusters; k++) {
            c->cluster[k].r = r;
            r += c->cluster[k].size * c->cluster[k].size;
        }
        fill_clusters(c, op, m, n, of, place);
    }
    free(parent);
    return status || r ? status : TRIBO_ERR_MEMORY;
}

/* --------------------------------------------------------------------------------------------------------- settings */

/* Light bodies between heavy ones come out right to this ratio in doubles, which clusters use. */
#define SPREAD_MOST 1e10

int tribo_clusters_renew(tribo_context *ctx, size_t count, const size_t *first, const struct delassus *op, struct memory *m)
{
    struct clusters c = {0};
    int status = count && !planar_create(&c, ctx->n, count, first) ? TRIBO_ERR_MEMORY
                 : count && op->diagonal                           ? find_clusters(&c, ctx->n, op, m)
                                                                   : TRIBO_OK;
    if (status == TRIBO_ERR_UNSUPPORTED) {
        tribo_fail(ctx, status, "planar contacts couple %zu direction%s with each other, and not more than %d can be", c.largest,
                   plural(c.largest), TRIBO_CLUSTER_MOST);
    } else if (status || (count && !tribo_disc_create(&c.problem, c.largest))) {
        status = tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s in the plane", count, plural(count));
    }
    for (size_t k = 0; !status && count && op->diagonal && k < op->groups; k++) {
        const struct group *g = &op->group[k];
        if (g->graded && g->spread > SPREAD_MOST && c.group_of[op->member[g->first]] == TRIBO_ALONE) {
            status = tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED,
                                "contact %zu touches bodies of which one is %g times as heavy as the other, and in a group with "
                                "planar contacts not more than %g can be told",
                                g->uneven, g->spread, SPREAD_MOST);
        }
    }
    tribo_clusters_free(status ? &c : &ctx->plane);
    ctx->plane = status ? ctx->plane : c;
    return status;
}

int tribo_clusters_copy(tribo_context *ctx, const tribo_context *from)
{
    const size_t count = from->plane.count, *first = from->plane.first;
    if (count == ctx->plane.count && (!count || memcmp(first, ctx->plane.first, count * sizeof *first) == 0)) {
        return TRIBO_OK;
    }
    return tribo_clusters_renew(ctx, count, first, ctx->op, &ctx->memory);
}

int tribo_clusters_clone(tribo_context *clone, const tribo_context *from)
{
    const int status = tribo_clusters_copy(clone, from);
    if (!status && from->plane.count) {
        tribo_copy(clone->plane.y, from->plane.y, from->n);
        tribo_copy(clone->plane.radius, from->plane.radius, from->n);
    }
    return status;
}

/* A planar contact has one epsilon for all directions: for R_ii stands the largest eigenvalue of its block. */
void tribo_clusters_refresh(tribo_context *ctx, int follows, double time)
{
    for (size_t k = 0; follows && k < ctx->plane.count; k++) {
        const double largest = tribo_block_of(ctx->plane.own[k], 2, 2).great, half = greater(product(largest, time), DBL_MIN);
        for (size_t i = ctx->plane.first[k]; i < ctx->plane.first[k] + 2; i++) {
            ctx->set.width[i] = 2.0 * half;
            ctx->set.rate[i] = largest > TRIBO_IMMOVABLE ? 1.0 / half : 0.0;
        }
    }
}

int tribo_plane_check_coupling(tribo_context *ctx, const struct law *law, int coupling, size_t count, const size_t *first)
{
    if (count && law == &tribo_law_own) {
        return tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED, "laws of the caller know no planar contacts, and contact %zu is one",
                          first[0]);
    }
    return count && coupling == TRIBO_PARTITION
               ? tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED, "the partition coupling knows no planar contacts, and contact %zu is one",
                            first[0])
               : TRIBO_OK;
}

int tribo_set_planar(tribo_context *ctx, size_t count, const size_t *first)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!first && count) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "first is NULL");
    }
    signed char *taken = ctx->spare;
    int status = tribo_plane_check_coupling(ctx, ctx->set.law, ctx->set.coupling, count, first);
    if (status || (!count && !ctx->plane.count)) {
        return status;
    }
    memset(taken, 0, ctx->n);
    for (size_t k = 0; k < count; k++) {
        const size_t i = first[k];
        if (ctx->n < 2 || i > ctx->n - 2) {
            return tribo_fail(ctx, TRIBO_ERR_RANGE,
                              "first[%zu] is contact %zu of %zu contact%s; a planar contact needs first and first + 1", k, i,
                              ctx->n, plural(ctx->n));
        }
        if (taken[i] || taken[i + 1]) {
            const size_t twice = taken[i] ? i : i + 1;
            size_t owner = 0;
            while (twice - first[owner] > 1) {
                owner++;
            }
            return tribo_fail(ctx, TRIBO_ERR_DUPLICATE, "first[%zu] takes contact %zu, which first[%zu] has taken", k, twice,
                              owner);
        }
        taken[i] = taken[i + 1] = 1;
    }
    status = tribo_check_one_ratio(ctx, ctx->set.ratio, ctx->set.stribeck, count, first);
    if (!status) {
        tribo_write_slips(ctx);
        status = tribo_clusters_renew(ctx, count, first, ctx->op, &ctx->memory);
    }
    if (!status) {
        tribo_refresh(ctx);
    }
    return status;
}
