/* SPDX-License-Identifier: BSD-3-Clause */
/* Disjoint sets of 0 to n - 1: parent [n] leads from an element to the root of its set; roots are their own parents. */
#ifndef TRIBO_UNION_FIND_H
#define TRIBO_UNION_FIND_H

#include <stddef.h>
#include <stdint.h>

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

/* Lists the sets with chosen[root] > 1, by their first elements: of [n] = the set of i, or SIZE_MAX; place [n] = the place of i
 * there; member[first[k]] to member[first[k + 1] - 1]: the elements of set k, ascending; first [n + 1]. Returns their number. */
static inline size_t tribo_list_sets(size_t n, size_t *parent, const size_t *chosen, size_t *of, size_t *place, size_t *first,
                                     size_t *member)
{
    size_t sets = 0, members = 0;
    for (size_t i = 0; i < n; i++) {
        const size_t root = tribo_root(parent, i);
        if (root == i && chosen[i] > 1) {
            first[sets] = 0;
            of[i] = sets++;
        } else {
            of[i] = root == i ? SIZE_MAX : of[root];
        }
        place[i] = of[i] == SIZE_MAX ? 0 : first[of[i]]++;
    }
    for (size_t k = 0; k < sets; k++) {
        members += first[k];
        first[k] = members - first[k];
    }
    first[sets] = members;
    for (size_t i = 0; i < n; i++) {
        if (of[i] != SIZE_MAX) {
            member[first[of[i]] + place[i]] = i;
        }
    }
    return sets;
}

#endif
