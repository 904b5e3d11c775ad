/* SPDX-License-Identifier: BSD-3-Clause */
/* Life and settings of planar contacts. Clusters are made anew whenever operator or contacts change. */
#include <stdlib.h>

#include "common/layout.h"
#include "core/static.h"
#include "numerics/union_find.h"
#include "parts.h"

static void release(struct planar *planar)
{
    if (planar && TRIBO_SHARED_ADD(planar->references, SIZE_MAX) == 0) { /* one less */
        free(planar->cluster->r);
        free(planar);
    }
}

/* Returns 1, or 0 if out of memory: then plane_free still applies. */
static int plane_create(struct plane *plane, const struct planar *planar, size_t n)
{
    struct layout b = {0};
    double **const vector[] = {&plane->y,      &plane->a,      &plane->v,    &plane->df,   &plane->other,
                               &plane->dlimit, &plane->radius, &plane->pull, &plane->shift};
    enum { VECTORS = sizeof vector / sizeof *vector };
    *plane = (struct plane){0};
    if (!planar) {
        return 1;
    }
    do {
        plane->near = tribo_layout_array(&b, planar->largest + 1, sizeof *plane->near);
        plane->contact = tribo_layout_array(&b, planar->largest, sizeof *plane->contact);
        plane->directions = tribo_layout_array(&b, planar->largest, 1);
        double *numbers = tribo_layout_array(&b, VECTORS * n, sizeof *numbers);
        for (size_t k = 0; numbers && k < VECTORS; k++) {
            *vector[k] = numbers + k * n;
        }
    } while (!b.memory && tribo_layout_zeros(&b));
    for (size_t i = 0; b.memory && i < n; i++) {
        plane->radius[i] = HUGE_VAL;
    }
    return b.memory && tribo_disc_create(&plane->problem, planar->largest);
}

static void plane_free(struct plane *plane)
{
    if (plane->near) {
        tribo_disc_free(&plane->problem);
        free(plane->near);
    }
}

int tribo_clusters_clone(tribo_context *clone, const tribo_context *from)
{
    const size_t n = from->planar ? from->n : 0;
    clone->planar = from->planar;
    if (clone->planar) {
        TRIBO_SHARED_ADD(clone->planar->references, (size_t)1);
    }
    const int done = plane_create(&clone->plane, clone->planar, n);
    if (done) {
        tribo_copy(clone->plane.y, from->plane.y, n);
        tribo_copy(clone->plane.radius, from->plane.radius, n);
    }
    return done;
}

void tribo_clusters_free(tribo_context *ctx)
{
    release(ctx->planar);
    plane_free(&ctx->plane);
}

/* --------------------------------------------------------------------------------------------------------- clusters */

/* Workspace: forest of islands, 2 at the roots of clusters, and what tribo_list_sets finds. */
struct lists {
    size_t *parent, *chosen, *of, *place, *first;
};

/* Sets islands, clusters and their members. */
static void find_members(struct planar *c, const struct delassus *op, size_t n, const struct lists *w)
{
    for (size_t i = 0; i < n; i++) {
        w->parent[i] = i;
        w->chosen[i] = 0;
    }
    for (size_t g = 0; g < op->groups; g++) {
        const size_t *member = op->member + op->group[g].first;
        for (size_t k = 1; k < op->group[g].size; k++) {
            tribo_join(w->parent, member[0], member[k]);
        }
    }
    for (size_t k = 0; k < c->count; k++) {
        tribo_join(w->parent, c->first[k], c->first[k] + 1);
    }
    for (size_t k = 0; k < c->count; k++) {
        w->chosen[tribo_root(w->parent, c->first[k])] = 2;
    }
    size_t *member = c->cluster->member;
    c->clusters = tribo_list_sets(n, w->parent, w->chosen, w->of, w->place, w->first, member);
    for (size_t i = 0; i < n; i++) {
        c->islands += w->parent[i] == i;
    }
    for (size_t k = 0; k < c->clusters; k++) {
        c->cluster[k].member = member + w->first[k];
        c->cluster[k].size = w->first[k + 1] - w->first[k];
        c->largest = c->cluster[k].size > c->largest ? c->cluster[k].size : c->largest;
    }
}

/* Sets R of all clusters, group_of and own. */
static void fill_clusters(struct planar *c, const struct delassus *op, struct memory *m, size_t n, const struct lists *w)
{
    for (size_t i = 0; i < n; i++) {
        c->group_of[i] = op->groups && w->of[i] == SIZE_MAX ? op->group_of[i] : TRIBO_ALONE;
        if (w->of[i] != SIZE_MAX) {
            c->cluster[w->of[i]].r[w->place[i] * (c->cluster[w->of[i]].size + 1)] = op->diagonal[i];
        }
    }
    for (size_t g = 0; g < op->groups; g++) {
        struct box_qp *p = tribo_memory_problem(op, m, g);
        struct cluster *to = w->of[p->member[0]] != SIZE_MAX ? &c->cluster[w->of[p->member[0]]] : NULL;
        double *unit = p->step, ignored;
        memset(unit, 0, p->group->size * sizeof *unit);
        for (size_t j = 0; to && j < p->group->size; j++) {
            unit[j] = 1.0;
            for (size_t i = 0; i < p->group->size; i++) {
                to->r[w->place[p->member[i]] * to->size + w->place[p->member[j]]] =
                    p->group->sparse ? tribo_row_dot(p, i, unit, &ignored) : p->r[i * p->group->size + j];
            }
            unit[j] = 0.0;
            to->redundant |= p->group->nullity > 0;
        }
    }
    for (size_t k = 0; k < c->count; k++) {
        const struct cluster *g = &c->cluster[w->of[c->first[k]]];
        const double *row = g->r + w->place[c->first[k]] * (g->size + 1);
        c->own[k][0] = row[0];
        c->own[k][1] = row[1];
        c->own[k][2] = row[g->size + 1];
    }
}

/* Makes clusters for the operator op and its memory m; a status. */
static int find_clusters(struct planar *c, size_t n, const struct delassus *op, struct memory *m)
{
    enum { LISTS = 5 };
    size_t *work = malloc(LISTS * (n + 1) * sizeof *work), entries = 0;
    if (!work) {
        return TRIBO_ERR_MEMORY;
    }
    const struct lists w = {work, work + (n + 1), work + 2 * (n + 1), work + 3 * (n + 1), work + 4 * (n + 1)};
    find_members(c, op, n, &w);
    const int status = c->largest > TRIBO_CLUSTER_MOST ? TRIBO_ERR_UNSUPPORTED : TRIBO_OK;
    for (size_t k = 0; !status && k < c->clusters; k++) {
        entries += c->cluster[k].size * c->cluster[k].size;
    }
    double *r = status ? NULL : calloc(entries, sizeof *r);
    if (r) {
        for (size_t k = 0; k < c->clusters; k++) {
            c->cluster[k].r = r;
            r += c->cluster[k].size * c->cluster[k].size;
        }
        fill_clusters(c, op, m, n, &w);
    }
    free(work);
    return status || r ? status : TRIBO_ERR_MEMORY;
}

/* Makes count planar contacts of n directions, with clusters if op has an operator; a status. *planar is to be released. */
static int planar_create(struct planar **planar, size_t n, size_t count, const size_t *first, const struct delassus *op,
                         struct memory *m)
{
    struct layout b = {0};
    struct planar *c, at = {.references = 1, .count = count};
    size_t *member;
    do {
        c = tribo_layout_array(&b, 1, sizeof *c);
        at.first = tribo_layout_array(&b, count, sizeof *at.first);
        at.role = tribo_layout_array(&b, n, 1);
        at.own = tribo_layout_array(&b, count, sizeof *at.own);
        at.group_of = tribo_layout_array(&b, n, sizeof *at.group_of);
        at.cluster = tribo_layout_array(&b, count, sizeof *at.cluster);
        member = tribo_layout_array(&b, n, sizeof *member);
    } while (!b.memory && tribo_layout_zeros(&b));
    *planar = c;
    if (!c) {
        return TRIBO_ERR_MEMORY;
    }
    *c = at;
    c->cluster->member = member;
    memcpy(c->first, first, count * sizeof *first);
    for (size_t k = 0; k < count; k++) {
        c->role[first[k]] = ROLE_FIRST;
        c->role[first[k] + 1] = ROLE_SECOND;
        c->own[k][0] = c->own[k][2] = 1.0;
    }
    return op->diagonal ? find_clusters(c, n, op, m) : TRIBO_OK;
}

/* --------------------------------------------------------------------------------------------------------- settings */

/* Light bodies between heavy ones come out right to this ratio in doubles, which clusters use. */
#define SPREAD_MOST 1e10

int tribo_clusters_prepare(tribo_context *ctx, size_t count, const size_t *first, const struct delassus *op, struct memory *m,
                           struct clusters *c)
{
    *c = (struct clusters){0};
    int status = count ? planar_create(&c->planar, ctx->n, count, first, op, m) : TRIBO_OK;
    if (status == TRIBO_ERR_UNSUPPORTED) {
        const size_t large = c->planar->largest;
        tribo_fail(ctx, status, "planar contacts couple %zu direction%s with each other, and not more than %d can be", large,
                   plural(large), TRIBO_CLUSTER_MOST);
    } else if (status || !plane_create(&c->plane, c->planar, ctx->n)) {
        status = tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s in the plane", count, plural(count));
    }
    for (size_t k = 0; !status && c->planar && op->diagonal && k < op->groups; k++) {
        const struct group *g = &op->group[k];
        if (g->graded && g->spread > SPREAD_MOST && c->planar->group_of[op->member[g->first]] == TRIBO_ALONE) {
            status = tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED,
                                "contact %zu touches bodies of which one is %g times as heavy as the other, and in a group with "
                                "planar contacts not more than %g can be told",
                                g->uneven, g->spread, SPREAD_MOST);
        }
    }
    if (status) {
        plane_free(&c->plane);
        release(c->planar);
    }
    return status;
}

void tribo_clusters_install(tribo_context *ctx, const struct clusters *c)
{
    tribo_clusters_free(ctx);
    ctx->planar = c->planar;
    ctx->plane = c->plane;
}

int tribo_clusters_copy(tribo_context *ctx, const tribo_context *from)
{
    const size_t count = tribo_plane_count(from), *first = tribo_plane_first(from);
    struct clusters c;
    if (count == tribo_plane_count(ctx) && (!count || memcmp(first, ctx->planar->first, count * sizeof *first) == 0)) {
        return TRIBO_OK;
    }
    const int status = tribo_clusters_prepare(ctx, count, first, ctx->op, &ctx->memory, &c);
    if (!status) {
        tribo_clusters_install(ctx, &c);
    }
    return status;
}

/* A planar contact has one epsilon for all directions: for R_ii stands the largest eigenvalue of its block. */
void tribo_clusters_refresh(tribo_context *ctx, int follows, double time)
{
    if (ctx->planar && ctx->op->diagonal) {
        ctx->group_of = ctx->planar->group_of;
    }
    for (size_t k = 0; follows && k < tribo_plane_count(ctx); k++) {
        const double largest = tribo_block_of(ctx->planar->own[k]).great, half = greater(product(largest, time), DBL_MIN);
        for (size_t i = ctx->planar->first[k]; i < ctx->planar->first[k] + 2; i++) {
            ctx->set.width[i] = 2.0 * half;
            ctx->set.rate[i] = largest > TRIBO_IMMOVABLE ? 1.0 / half : 0.0;
        }
    }
}

int tribo_plane_check_coupling(tribo_context *ctx, int coupling, size_t count, const size_t *first)
{
    return count && coupling == TRIBO_PARTITION
               ? tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED, "the partition coupling knows no planar contacts, and contact %zu is one",
                            first[0])
               : TRIBO_OK;
}

/* Checks that first [count] are pairs of contacts, none in two of them; a status. */
static int check_first(tribo_context *ctx, size_t count, const size_t *first)
{
    signed char *taken = ctx->spare;
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
    return TRIBO_OK;
}

int tribo_set_planar(tribo_context *ctx, size_t count, const size_t *first)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!first && count) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "first is NULL");
    }
    int status = tribo_plane_check_coupling(ctx, ctx->set.coupling, count, first);
    if (status || (!count && !ctx->planar)) {
        return status;
    }
    struct clusters c;
    status = check_first(ctx, count, first);
    status = status ? status : tribo_check_one_ratio(ctx, ctx->set.ratio, ctx->set.stribeck, count, first);
    status = status ? status : tribo_clusters_prepare(ctx, count, first, ctx->op, &ctx->memory, &c);
    if (!status) {
        tribo_write_slips(ctx);
        tribo_clusters_install(ctx, &c);
        tribo_refresh(ctx);
    }
    return status;
}
