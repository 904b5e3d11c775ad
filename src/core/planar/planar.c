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

struct block tribo_block_of(const double *first, const double *second)
{
    const double great = first[0], small = second ? *second : great, across = second ? first[1] : 0.0;
    const double mean = 0.5 * great + 0.5 * small, half = 0.5 * great - 0.5 * small;
    const double turned[2] = {half, across}, spread = tribo_length(2, turned);
    const double raw[2] = {half >= 0.0 ? spread + half : across, half >= 0.0 ? across : spread - half},
                 length = tribo_length(2, raw);
    return (struct block){
        mean + spread, greater(mean - spread, 0.0), {length > 0.0 ? raw[0] / length : 1.0, length > 0.0 ? raw[1] / length : 0.0}};
}

struct block tribo_cluster_block(const struct cluster *g, size_t k, size_t directions)
{
    return tribo_block_of(tribo_csr_entry(&g->r, k, k), directions == 2 ? tribo_csr_entry(&g->r, k + 1, k + 1) : NULL);
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
            rate = greater(rate, product(2.0 * quotient(s.bound, s.epsilon), tribo_block_of(weighed, weighed + 3).great));
        }
    }
    return rate;
}

/* -------------------------------------------------------------------------------------------------------------- life */

/* Frees R and the patterns of all clusters. */
static void forget_clusters(struct clusters *c)
{
    for (size_t k = 0; k < c->laid_out; k++) {
        tribo_sparse_free(c->cluster[k].made);
        tribo_csr_free(&c->cluster[k].r);
    }
}

void tribo_clusters_free(struct clusters *c)
{
    tribo_disc_free(&c->problem);
    forget_clusters(c);
    for (size_t k = 0; k < sizeof c->rooms / sizeof *c->rooms; k++) {
        free(c->rooms[k].block);
    }
    *c = (struct clusters){0};
}

/* Makes count planar contacts of n directions, without clusters. Returns 0 if out of memory. */
static int planar_create(struct clusters *c, size_t n, size_t count, const size_t *first)
{
    if (!ALLOCATE_IN(&c->rooms[0], ARRAY(c->first, count), ARRAY(c->role, n), ARRAY(c->own, count), ARRAY(c->group_of, n),
                     ARRAY(c->members, n), ARRAY(c->near, n + 1), ARRAY(c->contact, n), ARRAY(c->index, n),
                     ARRAY(c->directions, n), ARRAY(c->y, n), ARRAY(c->a, n), ARRAY(c->v, n), ARRAY(c->df, n),
                     ARRAY(c->growth, n), ARRAY(c->radius, n), ARRAY(c->pull, n), ARRAY(c->shift, n))) {
        return 0;
    }
    if (c->laid_out != count) {
        forget_clusters(c);
        c->laid_out = 0;
        if (!ALLOCATE_IN(&c->rooms[1], ARRAY(c->cluster, count))) {
            return 0;
        }
        c->laid_out = count;
    }
    c->count = count;
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

/* Data from which clusters are made; lists are [n]. */
struct parts {
    const struct delassus *op;
    struct memory *m;                /* of op */
    size_t *parent, *chosen, *start; /* see tribo_list_sets; start [n + 1] */
    size_t *of, *place;              /* cluster, or SIZE_MAX, and place there */
    size_t *inside;                  /* place in the operator's group */
    size_t *mark;                    /* first direction + 1 of the last contact that listed this one; 0 at first */
};

/* A row of R, of the contacts member. */
struct row {
    size_t count;
    const size_t *member, *col; /* col NULL: member 0, 1, ... */
    const double *val;
};

/* The row of direction *i. */
static struct row find_row(const struct parts *x, const size_t *i)
{
    struct row row = {1, i, NULL, x->op->diagonal + *i};
    if (x->op->groups && x->op->group_of[*i] != TRIBO_ALONE) {
        const struct box_qp *p = tribo_memory_problem(x->op, x->m, x->op->group_of[*i]);
        row.member = p->member;
        row.count = tribo_row_entries(p, x->inside[*i], &row.col, &row.val);
    }
    return row;
}

static size_t row_member(const struct row *row, size_t e)
{
    return row->member[row->col ? row->col[e] : e];
}

/* Appends to col the places of the contacts that R couples with direction *i of the contact with mark stamp, unless they have
 * this mark. Returns their number. */
static size_t list_neighbours(const struct clusters *c, const struct parts *x, const size_t *i, size_t stamp, size_t *col)
{
    const struct row row = find_row(x, i);
    size_t count = 0;
    for (size_t e = 0; e < row.count; e++) {
        const size_t j = row_member(&row, e), first = j - (c->role[j] == ROLE_SECOND);
        for (size_t d = first; row.val[e] != 0.0 && x->mark[first] != stamp && d <= first + (c->role[first] == ROLE_FIRST); d++) {
            col[count++] = x->place[d];
        }
        x->mark[first] = row.val[e] != 0.0 ? stamp : x->mark[first];
    }
    return count;
}

/* Sets R of g to zeros at the places of t. Keeps the memory of R and the pattern of its factor if the places are the same.
 * Returns 0 if out of memory. */
static int take_places(struct cluster *g, const struct csr *t)
{
    const size_t n = t->n, entries = t->first[n];
    struct csr *r = &g->r;
    if (r->first && r->n == n && memcmp(r->first, t->first, (n + 1) * sizeof *t->first) == 0 &&
        memcmp(r->col, t->col, entries * sizeof *t->col) == 0) {
        memset(r->val, 0, entries * sizeof *r->val);
        return 1;
    }
    tribo_sparse_free(g->made);
    tribo_csr_free(r);
    g->made = NULL;
    g->dense = 0;
    if (!tribo_csr_create(r, n, entries)) {
        return 0;
    }
    memcpy(r->first, t->first, (n + 1) * sizeof *t->first);
    memcpy(r->col, t->col, entries * sizeof *t->col);
    return 1;
}

/* Makes R of a cluster. Returns 0 if out of memory. */
static int fill_cluster(struct clusters *c, const struct parts *x, struct cluster *g)
{
    struct csr listed = {.n = g->size}, sorted = {.n = g->size};
    size_t room = 0;
    for (size_t k = 0, directions; k < g->size; k += directions) {
        size_t most = 0;
        directions = c->role[g->member[k]] == ROLE_FIRST ? 2 : 1;
        for (size_t d = 0; d < directions; d++) {
            most += 2 * find_row(x, &g->member[k + d]).count;
        }
        room += directions * (most < g->size ? most : g->size);
    }
    if (!ALLOCATE_IN(&c->rooms[3], ARRAY(listed.first, g->size + 2), ARRAY(listed.col, room + 1), ARRAY(listed.val, room + 1),
                     ARRAY(sorted.first, g->size + 2), ARRAY(sorted.col, room + 1), ARRAY(sorted.val, room + 1))) {
        return 0;
    }
    for (size_t k = 0, end = 0, directions; k < g->size; k += directions) {
        const size_t i = g->member[k], begin = end;
        directions = c->role[i] == ROLE_FIRST ? 2 : 1;
        for (size_t d = 0; d < directions; d++) {
            end += list_neighbours(c, x, &g->member[k + d], i + 1, listed.col + end);
        }
        listed.first[k + 1] = end;
        if (directions == 2) {
            memcpy(listed.col + end, listed.col + begin, (end - begin) * sizeof *listed.col);
            listed.first[k + 2] = end += end - begin;
        }
    }
    /* The pattern is symmetric: its transpose has columns ascending. */
    tribo_csr_transpose(&sorted, g->size, g->size, listed.first, listed.col, listed.val);
    const int done = take_places(g, &sorted);
    for (size_t k = 0; done && k < g->size; k++) {
        const struct row row = find_row(x, &g->member[k]);
        for (size_t e = 0; e < row.count; e++) {
            if (row.val[e] != 0.0) {
                *tribo_csr_entry(&g->r, k, x->place[row_member(&row, e)]) = row.val[e];
            }
        }
    }
    return done;
}

/* Makes R of all clusters, patterns of sparse ones, room for their problems, group_of and own. Returns 0 if out of memory. */
static int fill_clusters(struct clusters *c, const struct parts *x, size_t n)
{
    const struct delassus *op = x->op;
    struct disc_room room = {0};
    for (size_t i = 0; i < n; i++) {
        c->group_of[i] = op->groups && x->of[i] == SIZE_MAX ? op->group_of[i] : TRIBO_ALONE;
    }
    for (size_t k = 0; k < c->clusters; k++) {
        struct cluster *g = &c->cluster[k];
        int thin = 0;
        g->redundant = 0;
        for (size_t j = 0; op->groups && j < g->size; j++) {
            const size_t group = op->group_of[g->member[j]];
            g->redundant |= group != TRIBO_ALONE && op->group[group].nullity > 0;
            thin |= group != TRIBO_ALONE && op->group[group].thin;
        }
        const int sparse_pays = tribo_prefers_sparse(g->size, thin);
        if (!fill_cluster(c, x, g)) {
            return 0;
        }
        if (sparse_pays && !g->made && !g->dense) {
            if (!tribo_sparse_create(&g->made, &g->r)) {
                return 0;
            }
            g->dense = !g->made; /* the sparse factor would have too many entries */
        }
        g->pattern = sparse_pays ? g->made : NULL;
        const size_t sparse = g->pattern ? g->size : 0, dense = g->size - sparse;
        room.size = g->size > room.size ? g->size : room.size;
        room.dense = dense > room.dense ? dense : room.dense;
        if (sparse) {
            const size_t entries = g->r.first[sparse], slots = tribo_sparse_slots(g->pattern);
            room.places = sparse > room.places ? sparse : room.places;
            room.entries = entries > room.entries ? entries : room.entries;
            room.slots = slots > room.slots ? slots : room.slots;
        }
    }
    for (size_t k = 0; k < c->count; k++) {
        const struct cluster *g = &c->cluster[x->of[c->first[k]]];
        const size_t place = x->place[c->first[k]];
        const double *first = tribo_csr_entry(&g->r, place, place);
        c->own[k][0] = first[0];
        c->own[k][1] = c->own[k][2] = first[1];
        c->own[k][3] = *tribo_csr_entry(&g->r, place + 1, place + 1);
    }
    return tribo_disc_create(&c->problem, &room);
}

/* Makes clusters of the operator's groups and the contacts that join them. Returns 0 if out of memory. */
static int find_clusters(struct clusters *c, size_t n, const struct delassus *op, struct memory *m)
{
    struct parts x = {.op = op, .m = m};
    if (!ALLOCATE_IN(&c->rooms[2], ARRAY(x.parent, n), ARRAY(x.chosen, n), ARRAY(x.start, n + 1), ARRAY(x.of, n),
                     ARRAY(x.place, n), ARRAY(x.inside, n), ARRAY(x.mark, n))) {
        return 0;
    }
    for (size_t i = 0; i < n; i++) {
        x.parent[i] = i;
    }
    for (size_t g = 0; g < op->groups; g++) {
        const size_t *member = op->member + op->group[g].first;
        for (size_t k = 0; k < op->group[g].size; k++) {
            x.inside[member[k]] = k;
            tribo_join(x.parent, member[0], member[k]);
        }
    }
    for (size_t k = 0; k < c->count; k++) {
        tribo_join(x.parent, c->first[k], c->first[k] + 1);
    }
    for (size_t k = 0; k < c->count; k++) {
        x.chosen[tribo_root(x.parent, c->first[k])] = 2;
    }
    for (size_t i = 0; i < n; i++) {
        c->islands += x.parent[i] == i;
    }
    c->clusters = tribo_list_sets(n, x.parent, x.chosen, x.of, x.place, x.start, c->members);
    for (size_t k = 0; k < c->clusters; k++) {
        c->cluster[k].member = c->members + x.start[k];
        c->cluster[k].size = x.start[k + 1] - x.start[k];
    }
    return fill_clusters(c, &x, n);
}

/* --------------------------------------------------------------------------------------------------------- settings */

/* Light bodies between heavy ones come out right to this ratio in doubles, which clusters use. */
#define SPREAD_MOST 1e10

int tribo_clusters_make(struct clusters *c, tribo_context *ctx, size_t count, const size_t *first, const struct delassus *op,
                        struct memory *m)
{
    *c = (struct clusters){.cluster = c->cluster,
                           .laid_out = c->laid_out,
                           .problem = c->problem,
                           .rooms = {c->rooms[0], c->rooms[1], c->rooms[2], c->rooms[3]}};
    int status = TRIBO_OK;
    if (count && (!planar_create(c, ctx->n, count, first) || (op->diagonal && !find_clusters(c, ctx->n, op, m)))) {
        status = tribo_fail(ctx, TRIBO_ERR_MEMORY, "out of memory for %zu contact%s in the plane", count, plural(count));
    }
    for (size_t k = 0; !status && count && op->diagonal && k < op->groups; k++) {
        const struct group *g = &op->group[k];
        if (g->graded && g->spread > SPREAD_MOST && c->group_of[op->member[g->first]] == TRIBO_ALONE) {
            status = tribo_fail(ctx, TRIBO_ERR_UNSUPPORTED,
                                "contact %zu touches bodies of which one is %g times as heavy as the other, and in a group with "
                                "planar contacts not more than %g can be told",
                                g->uneven, g->spread, SPREAD_MOST);
        }
    }
    return status;
}

/* Gives ctx these planar contacts in the place of those it has; a status. */
static int renew_clusters(tribo_context *ctx, size_t count, const size_t *first)
{
    struct clusters c = {0};
    const int status = tribo_clusters_make(&c, ctx, count, first, ctx->op, &ctx->memory);
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
    return renew_clusters(ctx, count, first);
}

void tribo_clusters_keep(struct clusters *to, const struct clusters *from, size_t n)
{
    tribo_copy(to->y, from->y, to->count ? n : 0);
    tribo_copy(to->radius, from->radius, to->count ? n : 0);
}

int tribo_clusters_clone(tribo_context *clone, const tribo_context *from)
{
    const struct clusters *c = &from->plane;
    const struct sparse *factored = c->problem.factor.group.sparse;
    const int status = tribo_clusters_copy(clone, from);
    if (status) {
        return status;
    }
    tribo_clusters_keep(&clone->plane, c, from->n);
    for (size_t q = 0; factored && q < c->clusters; q++) {
        if (c->cluster[q].pattern == factored) {
            tribo_disc_copy_factor(&clone->plane.problem, &c->problem, clone->plane.cluster[q].pattern);
        }
    }
    return status;
}

/* A planar contact has one epsilon for all directions: for R_ii stands the largest eigenvalue of its block. */
void tribo_clusters_refresh(tribo_context *ctx, int follows, double time)
{
    for (size_t k = 0; follows && k < ctx->plane.count; k++) {
        const double largest = tribo_block_of(ctx->plane.own[k], ctx->plane.own[k] + 3).great,
                     half = greater(product(largest, time), DBL_MIN);
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
        status = renew_clusters(ctx, count, first);
    }
    if (!status) {
        tribo_refresh(ctx);
    }
    return status;
}
