/* Disjoint sets of 0 to n - 1: parent [n] leads from an element to the root of its set; roots are their own parents. */
#ifndef TRIBO_UNION_FIND_H
#define TRIBO_UNION_FIND_H

#include <stddef.h>

/* Returns the root of the set of i, and halves the path to it. */
static inline size_t tribo_root(size_t *parent, size_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

/* Joins the sets of i and j; the smaller root stays a root. */
static inline void tribo_join(size_t *parent, size_t i, size_t j)
{
    const size_t p = tribo_root(parent, i), q = tribo_root(parent, j);
    parent[p > q ? p : q] = p > q ? q : p;
}

#endif
