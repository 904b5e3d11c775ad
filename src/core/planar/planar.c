/* Life of planar contacts: clusters are made whenever operator or contacts change. */
#include <stdlib.h>
#include <string.h>

#include "core/context.h"
#include "numerics/union_find.h"

#if defined(TRIBO_GNU_C)
#define COUNT(references, change) __atomic_add_fetch(&(references), (change), __ATOMIC_ACQ_REL)
#else
#define COUNT(references, change) ((references) += (change))
#endif

struct planar *tribo_planar_share(struct planar *planar)
{
    if (planar) {
        COUNT(planar->references, (size_t)1);
    }
    return planar;
}

void tribo_planar_release(struct planar *planar)
{
    if (!planar || COUNT(planar->references, SIZE_MAX) > 0) { /* one less */
        return;
    }
    free(planar->first);
    free(planar->role);
    free(planar->own);
    free(planar->cluster);
    free(planar->member);
    free(planar->r);
    free(planar->group_of);
    free(planar);
}

int tribo_plane_create(struct plane *plane, const struct planar *planar, size_t n)
{
    enum { VECTORS = 10 };
    *plane = (struct plane){0};
    if (!planar) {
        return 1;
    }
    plane->near = malloc((planar->largest + 1) * sizeof *plane->near);
    plane->y = calloc(VECTORS * (n + 1), sizeof *plane->y);
    double **const vector[VECTORS] = {&plane->y,     &plane->v,      &plane->a,      &plane->unit, &plane->df,
                                      &plane->other, &plane->dlimit, &plane->radius, &plane->pull, &plane->shift};
    for (size_t k = 1; plane->y && k < VECTORS; k++) {
        *vector[k] = plane->y + k * (n + 1);
    }
    for (size_t i = 0; plane->y && i < n; i++) {
        plane->radius[i] = HUGE_VAL;
    }
    plane->directions = malloc(planar->largest + 1);
    return plane->near && plane->y && plane->directions && tribo_disc_create(&plane->problem, planar->largest);
}

void tribo_plane_free(struct plane *plane)
{
    if (plane->near && plane->y && plane->directions) {
        tribo_disc_free(&plane->problem);
    }
    free(plane->near);
    free(plane->directions);
    free(plane->y);
}

/* -------------------------------------------------------------------------------------------------------- clusters */

/* parent [n] = the first direction of each one's cluster. Returns how many islands are left. */
static size_t find_parents(const struct planar *c, const struct delassus *op, size_t n, size_t *parent)
{
    size_t islands = 0;
    for (size_t i = 0; i < n; i++) {
        parent[i] = i;
    }
    for (size_t g = 0; g < op->groups; g++) {
        const size_t *member = op->member + op->group[g].first;
        for (size_t k = 1; k < op->group[g].size; k++) {
            tribo_join(parent, member[0], member[k]);
        }
    }
    for (size_t k = 0; k < c->count; k++) {
        tribo_join(parent, c->first[k], c->first[k] + 1);
    }
    for (size_t i = 0; i < n; i++) {
        parent[i] = tribo_root(parent, i);
        islands += parent[i] == i;
    }
    return islands;
}

/* Members of clusters, cluster by cluster; label [n]: the cluster of a direction, or clusters if it is in none. place [n]. */
static void find_members(struct planar *c, size_t n, const size_t *parent, size_t *label, size_t *place)
{
    size_t members = 0, entries = 0;
    for (size_t i = 0; i < n; i++) {
        label[i] = SIZE_MAX;
    }
    for (size_t k = 0; k < c->count; k++) {
        size_t *of = &label[parent[c->first[k]]];
        *of = *of == SIZE_MAX ? c->clusters++ : *of;
    }
    for (size_t i = 0; i < n; i++) {
        label[i] = label[parent[i]];
        if (label[i] != SIZE_MAX) {
            place[i] = c->cluster[label[i]].size++;
        }
    }
    for (size_t k = 0; k < c->clusters; k++) {
        struct cluster *g = &c->cluster[k];
        g->member = members;
        g->r = entries;
        members += g->size;
        entries += g->size > TRIBO_CLUSTER_MOST ? 0 : g->size * g->size;
        c->largest = g->size > c->largest ? g->size : c->largest;
    }
    for (size_t i = 0; i < n; i++) {
        if (label[i] != SIZE_MAX) {
            c->member[c->cluster[label[i]].member + place[i]] = i;
        }
    }
}

/* Rows of the operator's groups into those of clusters. */
static void fill_groups(struct planar *c, const struct delassus *op, struct memory *m, const size_t *label, const size_t *place)
{
    for (size_t g = 0; g < op->groups; g++) {
        struct box_qp *p = tribo_memory_problem(op, m, g);
        const size_t size = p->group->size;
        if (label[p->member[0]] == SIZE_MAX) {
            continue;
        }
        struct cluster *to = &c->cluster[label[p->member[0]]];
        to->redundant |= p->group->nullity > 0;
        double *unit = p->step, ignored;
        memset(unit, 0, size * sizeof *unit);
        for (size_t j = 0; j < size; j++) {
            unit[j] = 1.0;
            for (size_t i = 0; i < size; i++) {
                c->r[to->r + place[p->member[i]] * to->size + place[p->member[j]]] =
                    p->group->sparse ? tribo_row_dot(p, i, unit, &ignored) : p->r[i * size + j];
            }
            unit[j] = 0.0;
        }
    }
}

static void planar_fill_rows(struct planar *c, const struct delassus *op, struct memory *m, size_t n, const size_t *label,
                             const size_t *place)
{
    fill_groups(c, op, m, label, place);
    for (size_t i = 0; i < n; i++) {
        c->group_of[i] = op->groups && label[i] == SIZE_MAX ? op->group_of[i] : TRIBO_ALONE;
        if (label[i] != SIZE_MAX) {
            const struct cluster *g = &c->cluster[label[i]];
            c->r[g->r + place[i] * (g->size + 1)] = op->diagonal[i];
        }
    }
    for (size_t k = 0; k < c->count; k++) {
        const size_t i = c->first[k];
        const struct cluster *g = &c->cluster[label[i]];
        const double *row = c->r + g->r + place[i] * g->size + place[i];
        c->own[k][0] = row[0];
        c->own[k][1] = row[1];
        c->own[k][2] = row[g->size + 1];
    }
}

static int find_clusters(struct planar *c, size_t n, const struct delassus *op, struct memory *m, size_t *flaw)
{
    size_t *work = malloc((3 * n + 1) * sizeof *work), entries = 0;
    int status = TRIBO_ERR_MEMORY;
    c->cluster = calloc(c->count, sizeof *c->cluster);
    c->member = malloc(n * sizeof *c->member);
    c->group_of = malloc(n * sizeof *c->group_of);
    if (work && c->cluster && c->member && c->group_of) {
        c->islands = find_parents(c, op, n, work);
        find_members(c, n, work, work + n, work + 2 * n);
        *flaw = c->largest;
        status = c->largest > TRIBO_CLUSTER_MOST ? TRIBO_ERR_UNSUPPORTED : TRIBO_OK;
    }
    for (size_t k = 0; !status && k < c->clusters; k++) {
        entries += c->cluster[k].size * c->cluster[k].size;
    }
    c->r = status ? NULL : calloc(entries, sizeof *c->r);
    if (c->r) {
        planar_fill_rows(c, op, m, n, work + n, work + 2 * n);
    }
    free(work);
    return status || c->r ? status : TRIBO_ERR_MEMORY;
}

/* Planar contacts of n directions, with the clusters that op makes of them, if op has an operator; m is what goes with op. A
 * status; *flaw is the size of a cluster that is too large. */
static int create_planar(struct planar **planar, size_t n, size_t count, const size_t *first, const struct delassus *op,
                         struct memory *m, size_t *flaw)
{
    struct planar *c = calloc(1, sizeof *c);
    int status = TRIBO_ERR_MEMORY;
    *planar = NULL;
    if (c) {
        c->references = 1;
        c->count = count;
        c->first = malloc(count * sizeof *c->first);
        c->role = calloc(n, 1);
        c->own = calloc(count, sizeof *c->own);
    }
    if (c && c->first && c->role && c->own) {
        memcpy(c->first, first, count * sizeof *first);
        for (size_t k = 0; k < count; k++) {
            c->role[first[k]] = ROLE_FIRST;
            c->role[first[k] + 1] = ROLE_SECOND;
            c->own[k][0] = c->own[k][2] = 1.0;
        }
        status = op->diagonal ? find_clusters(c, n, op, m, flaw) : TRIBO_OK;
    }
    if (status) {
        tribo_planar_release(c);
    } else {
        *planar = c;
    }
    return status;
}

/* ------------------------------------------------------------------------------------------------------- settings */

/* owner [n] is workspace. */
static int check_first(tribo_context *ctx, size_t count, const size_t *first, size_t *owner)
{
    for (size_t i = 0; i < ctx->n; i++) {
        owner[i] = SIZE_MAX;
    }
    for (size_t k = 0; k < count; k++) {
        if (ctx->n < 2 || first[k] > ctx->n - 2) {
            return tribo_fail(ctx, TRIBO_ERR_RANGE,
                              "first[%zu] is contact %zu of %zu contact%s, and a planar one takes the next one, too", k, first[k],
                              ctx->n, plural(ctx->n));
        }
        for (size_t i = first[k]; i < first[k] + 2; i++) {
            if (owner[i] != SIZE_MAX) {
                return tribo_fail(ctx, TRIBO_ERR_DUPLICATE, "first[%zu] takes contact %zu, which first[%zu] has taken", k, i,
                                  owner[i]);
            }
            owner[i] = k;
        }
    }
    return TRIBO_OK;
}

/* In ordinary digits, light bodies between heavy ones come out right to this ratio. */
#define SPREAD_MOST 1e10

/* Clusters have no more digits. */
static int check_spread(tribo_context *ctx, const struct planar *c, const struct delassus *op)
{
    for (size_t k = 0; op->diagonal && k < op->groups; k++) {
        const struct group *g = &op->group[k];
        if (g->graded && g->spread > SPREAD_MOST && c->group_of[op->member[g->first]] == TRIBO_ALONE) {
            return tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED,
                              "contact %zu touches bodies of which one is %g times as heavy as the other, and in a group with "
                              "planar contacts not more than %g can be told",
                              g->uneven, g->spread, SPREAD_MOST);
        }
    }
    return TRIBO_OK;
}

int tribo_planar_prepare(tribo_context *ctx, size_t count, const size_t *first, const struct delassus *op, struct memory *m,
                         struct planar **planar, struct plane *plane)
{
    size_t large = 0;
    *planar = NULL;
    *plane = (struct plane){0};
    int status = count ? create_planar(planar, ctx->n, count, first, op, m, &large) : TRIBO_OK;
    if (status == TRIBO_ERR_UNSUPPORTED) {
        return tribo_fail(ctx, status, "planar contacts couple %zu direction%s with each other, and not more than %d can be",
                          large, plural(large), TRIBO_CLUSTER_MOST);
    }
    if (status || !tribo_plane_create(plane, *planar, ctx->n)) {
        tribo_plane_free(plane);
        tribo_planar_release(*planar);
        return tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s in the plane", count, plural(count));
    }
    status = *planar ? check_spread(ctx, *planar, op) : TRIBO_OK;
    if (status) {
        tribo_plane_free(plane);
        tribo_planar_release(*planar);
    }
    return status;
}

void tribo_planar_install(tribo_context *ctx, struct planar *planar, const struct plane *plane)
{
    tribo_planar_release(ctx->planar);
    tribo_plane_free(&ctx->plane);
    ctx->planar = planar;
    ctx->plane = *plane;
}

int tribo_set_planar(tribo_context *ctx, size_t count, const size_t *first)
{
    if (!ctx) {
        return TRIBO_ERR_NULL;
    }
    if (!first && count) {
        return tribo_fail(ctx, TRIBO_ERR_NULL, "first is NULL");
    }
    if (count && ctx->set.coupling == TRIBO_PARTITION) {
        return tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED, "the partition coupling knows no planar contacts, and contact %zu is one",
                          first[0]);
    }
    if (!count && !ctx->planar) {
        return TRIBO_OK;
    }
    size_t *owner = malloc((ctx->n + 1) * sizeof *owner);
    if (!owner) {
        return tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s in the plane", count, plural(count));
    }
    struct planar *planar;
    struct plane plane;
    int status = check_first(ctx, count, first, owner);
    free(owner);
    if (!status && ctx->set.breaking) {
        status = tribo_check_one_ratio(ctx, ctx->set.ratio, ctx->set.stribeck, count, first);
    }
    status = status ? status : tribo_planar_prepare(ctx, count, first, ctx->op, &ctx->memory, &planar, &plane);
    if (!status) {
        tribo_write_slips(ctx);
        tribo_planar_install(ctx, planar, &plane); /* NOLINT(clang-analyzer-unix.Malloc): tribo_fail does not return 0 */
        tribo_refresh(ctx);
    }
    return status;
}
