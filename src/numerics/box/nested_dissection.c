/* SPDX-License-Identifier: BSD-3-Clause */
/* Nested dissection (George 1973): a level of a breadth-first search splits the graph of R into two sides, and is eliminated
 * after them; each side is split likewise. */
#include <stdlib.h>
#include <string.h>

#include "factor_sparse.h"

/* Parts of at most LEAF nodes are not split. */
#define LEAF 24

struct graph {
    const struct csr *r;
    size_t *node;  /* [n] the order; parts are pieces of it */
    size_t *list;  /* [n] nodes in the order of a search */
    size_t *level; /* [n] distances from its start */
    size_t *mark;  /* [n] stamp: node of the part, not found */
    size_t stamp;
};

struct part {
    size_t begin, end;
};

/* list = the nodes of the part connected with start, nearest first. Returns their number. The other nodes of the part have the
 * mark stamp. */
static size_t search_breadth_first(struct graph *g, struct part part, size_t start)
{
    size_t count = 1;
    g->stamp++;
    for (size_t k = part.begin; k < part.end; k++) {
        g->mark[g->node[k]] = g->stamp;
    }
    g->list[0] = start;
    g->level[start] = g->mark[start] = 0;
    for (size_t next = 0; next < count; next++) {
        const size_t i = g->list[next];
        for (size_t e = g->r->first[i]; e < g->r->first[i + 1]; e++) {
            const size_t j = g->r->col[e];
            if (g->mark[j] == g->stamp) {
                g->mark[j] = 0;
                g->level[j] = g->level[i] + 1;
                g->list[count++] = j;
            }
        }
    }
    return count;
}

/* Orders a part, and appends the two sides that are not in order to stack: of a part in pieces, one piece and the others. */
static void dissect(struct graph *g, struct part part, struct part *stack, size_t *depth)
{
    size_t *node = g->node + part.begin, from = 0, to = 0;
    const size_t size = part.end - part.begin;
    if (size <= LEAF) {
        return;
    }
    const size_t count = search_breadth_first(g, part, node[0]);
    if (count < size) {
        for (size_t k = 0, next = count; k < size; k++) {
            if (g->mark[node[k]] == g->stamp) {
                g->list[next++] = node[k];
            }
        }
        memcpy(node, g->list, size * sizeof *node);
        from = to = count;
    } else {
        /* A search from the far end has more and smaller levels. list[from, to) = a small level that splits the others evenly. */
        search_breadth_first(g, part, g->list[size - 1]);
        const size_t last = g->level[g->list[size - 1]];
        size_t best = SIZE_MAX;
        for (size_t k = 0; k < size;) {
            const size_t level = g->level[g->list[k]], begin = k;
            while (k < size && g->level[g->list[k]] == level) {
                k++;
            }
            const size_t behind = size - k, cost = 4 * (k - begin) + (begin > behind ? begin - behind : behind - begin);
            if (level > 0 && level < last && cost < best) {
                best = cost;
                from = begin;
                to = k;
            }
        }
        if (best == SIZE_MAX) {
            return;
        }
        memcpy(node, g->list, from * sizeof *node);
        memcpy(node + from, g->list + to, (size - to) * sizeof *node);
        memcpy(node + from + size - to, g->list + from, (to - from) * sizeof *node);
    }
    stack[(*depth)++] = (struct part){part.begin, part.begin + from};
    stack[(*depth)++] = (struct part){part.begin + from, part.begin + from + size - to};
}

int tribo_nested_dissection(const struct csr *r, size_t *place)
{
    struct graph g = {.r = r, .node = place};
    struct part *stack = malloc((r->n + 2) * sizeof *stack);
    g.list = malloc(2 * r->n * sizeof *g.list);
    g.mark = calloc(r->n, sizeof *g.mark);
    const int done = stack && g.list && g.mark;
    if (done) {
        size_t depth = 1;
        g.level = g.list + r->n;
        for (size_t i = 0; i < r->n; i++) {
            place[i] = i;
        }
        stack[0] = (struct part){0, r->n};
        while (depth > 0) {
            depth--;
            dissect(&g, stack[depth], stack, &depth);
        }
    }
    free(stack);
    free(g.list);
    free(g.mark);
    return done;
}
