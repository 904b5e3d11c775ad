/* SPDX-License-Identifier: BSD-3-Clause */
#include "degrees.h"

#include <ctype.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "text.h"

static int compare_rows(const void *a, const void *b)
{
    const struct degree *x = a, *y = b;
    return x->row != y->row ? (x->row < y->row ? -1 : 1) : (x->line > y->line) - (x->line < y->line);
}

/* Sorts by row, each of which must be there once at most; what: the name of a row in messages. */
static void sort_rows(const char *path, const char *what, struct degree *all, size_t count)
{
    if (count) {
        qsort(all, count, sizeof *all, compare_rows);
    }
    for (size_t i = 1; i < count; i++) {
        die_if(all[i].row == all[i - 1].row, "%s:%zu: %s %zu has been given in line %zu", path, all[i].line, what, all[i].row,
               all[i - 1].line);
    }
}

/* ------------------------------------------------------------------------------------------------- CalculiX's input */

/* 1 if the line begins with the keyword, given in capitals. */
static int is_keyword(const char *line, const char *keyword)
{
    for (; *keyword; line++) {
        if (*line != ' ' && toupper((unsigned char)*line) != *keyword++) {
            return 0;
        }
    }
    line += strspn(line, " \t\r");
    return *line == '\0' || *line == ',';
}

/* The nodes of an input, "number, x, y, z" below *NODE: row is the number, and coordinates that are not there are zero. */
static struct degree *read_nodes(const char *path, size_t *count)
{
    struct text t = open_text(path);
    struct degree *all = NULL;
    size_t n = 0;
    int reading = 0;
    while (next_data(&t)) {
        if (*t.at == '*') {
            reading = t.at[1] == '*' ? reading : is_keyword(t.at, "*NODE");
            die_at_if(&t, is_keyword(t.at, "*TRANSFORM"),
                      "*TRANSFORM turns directions of nodes, so that 1, 2, 3 need not be x, y, z");
        } else if (reading) {
            struct degree d = {.line = t.line};
            d.row = next_whole(&t, "node", ",", 1, INT_MAX);
            next_coordinates(&t, ",", ",", 0, d.at);
            expect_end(&t);
            all = need_room(all, n, sizeof *all);
            all[n++] = d;
        }
    }
    sort_rows(path, "node", all, n);
    *count = n;
    return all;
}

static int compare_row(const void *key, const void *element)
{
    const size_t row = *(const size_t *)key, other = ((const struct degree *)element)->row;
    return (row > other) - (row < other);
}

/* Finds the places of degrees of freedom in name.inp, for name.dof or name.dof.gz. */
static void find_places(const char *path, struct degree *dof, size_t count)
{
    const size_t ending = strlen(path) - (path[strlen(path) - 1] == 'z' ? strlen(".dof.gz") : strlen(".dof"));
    char *input = new_text("%.*s.inp", (int)ending, path);
    size_t nodes;
    struct degree *all = read_nodes(input, &nodes);
    for (size_t i = 0; i < count; i++) {
        const struct degree *node = nodes ? bsearch(&dof[i].node, all, nodes, sizeof *all, compare_row) : NULL;
        die_if(!node, "%s:%zu: node %zu has no place in %s (files that it includes are not read)", path, dof[i].line, dof[i].node,
               input);
        memcpy(dof[i].at, node->at, sizeof dof[i].at);
    }
    free(all);
    free(input);
}

/* -------------------------------------------------------------------------------------------------------------- calls */

/* One line; a row of 0: the line does not hold it. */
static struct degree read_degree(struct text *t, int calculix)
{
    struct degree d = {.line = t->line};
    if (calculix) {
        const char *dot = strchr(t->at, '.');
        die_at_if(t, !dot || strchr(dot + 1, '.'), "expected node.direction, a point between two whole numbers");
        d.node = next_whole(t, "node", ".", 1, INT_MAX);
        d.direction = (int)next_whole(t, "direction", "", 1, 3);
        return d;
    }
    d.row = next_whole(t, "row", " ", 1, INT_MAX);
    d.node = next_whole(t, "node", " ", 0, INT_MAX);
    d.direction = (int)next_whole(t, "direction", " ", 1, 3);
    next_coordinates(t, " ", "", 3, d.at);
    return d;
}

struct degree *read_degrees(const char *path, size_t *count)
{
    struct text t = open_text(path);
    struct degree *dof = NULL;
    const int calculix = is_named(path, ".dof");
    size_t n = 0;
    for (; next_data(&t); n++) {
        dof = need_room(dof, n, sizeof *dof);
        dof[n] = read_degree(&t, calculix);
        dof[n].row = calculix ? n + 1 : dof[n].row;
    }
    die_if(n == 0, "%s: there is no degree of freedom in it", path);
    if (calculix) {
        find_places(path, dof, n);
    } else {
        sort_rows(path, "row", dof, n);
    }
    for (size_t i = 0; i < n; i++) {
        die_if(dof[i].row != i + 1, "%s:%zu: row %zu, but there is no row %zu", path, dof[i].line, dof[i].row, i + 1);
    }
    *count = n;
    return dof;
}
