/* SPDX-License-Identifier: BSD-3-Clause */
#include "calculix.h"

#include <ctype.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------------------------------------------------------- matrices */

/* The format has no count of entries: a file that is cut off lacks entries on the diagonal. */
static void check_diagonal(const char *path, const char *seen, const struct rows *rows)
{
    const char *missing = memchr(seen, 0, rows->count);
    if (missing) {
        die("%s: row %zu of %zu has no entry on the diagonal: is the file cut off, or does it belong to other degrees of "
            "freedom than those in %s?",
            path, (size_t)(missing - seen) + 1, rows->count, rows->path);
    }
}

void read_calculix_matrix(const char *path, const struct rows *rows, struct entries *all)
{
    struct lines l = open_lines(path);
    char *seen = need_memory(rows->count, 1);
    while (next_data(&l)) {
        struct entry e = read_entry(&l, rows);
        if (e.column > e.row) {
            e = (struct entry){e.column, e.row, e.line, e.value};
        }
        seen[e.row - 1] |= e.row == e.column;
        add_entry(all, &e);
    }
    close_lines(&l);
    check_diagonal(path, seen, rows);
    free(seen);
}

/* ------------------------------------------------------------------------------------------------------ degrees of freedom */

struct degree read_calculix_degree(struct lines *l, size_t row)
{
    struct degree d = {.line = l->line, .row = row};
    const char *dot = strchr(l->at, '.');
    if (!dot || strchr(dot + 1, '.')) {
        die_at(l, "expected node.direction, a point between two whole numbers");
    }
    part_at(l, '.');
    d.node = next_whole(l, "node", 1, INT_MAX);
    d.direction = (int)next_whole(l, "direction", 1, 3);
    expect_end(l);
    return d;
}

/* ------------------------------------------------------------------------------------------------------------------- nodes */

struct node {
    size_t number, line;
    double at[3];
};

struct nodes {
    size_t count, room;
    struct node *node;
};

/* 1 if the line begins with the keyword, given in capitals. */
static int is_keyword(const struct lines *l, const char *keyword)
{
    const char *c = l->at;
    for (; *keyword; c++) {
        if (*c != ' ' && toupper((unsigned char)*c) != *keyword++) {
            return 0;
        }
    }
    c += strspn(c, " \t\r");
    return *c == '\0' || *c == ',';
}

/* An empty word means zero to CalculiX, and would shift the others here. */
static void refuse_empty_words(const struct lines *l)
{
    for (const char *c = l->at; (c = strchr(c, ',')) != NULL;) {
        c++;
        c += strspn(c, " \t\r");
        if (*c == ',') {
            die_at(l, "an empty word between commas: put a zero there");
        }
    }
}

/* "number, x, y, z"; of the coordinates the last ones may be missing, and are zero. */
static struct node read_node(struct lines *l)
{
    struct node n = {.line = l->line};
    refuse_empty_words(l);
    part_at(l, ',');
    n.number = next_whole(l, "node", 1, INT_MAX);
    for (size_t i = 0; i < 3 && *(l->at += strspn(l->at, " \t\r")); i++) {
        n.at[i] = next_real(l, (const char *[]){"coordinate x", "coordinate y", "coordinate z"}[i]);
    }
    expect_end(l);
    return n;
}

static int compare_nodes(const void *a, const void *b)
{
    const struct node *x = a, *y = b;
    return x->number != y->number ? (x->number < y->number ? -1 : 1) : (x->line > y->line) - (x->line < y->line);
}

static struct nodes read_nodes(const char *path)
{
    struct lines l = open_lines(path);
    struct nodes all = {0, 0, NULL};
    int reading = 0;
    while (next_data(&l)) {
        if (*l.at == '*') {
            reading = l.at[1] == '*' ? reading : is_keyword(&l, "*NODE");
            if (is_keyword(&l, "*TRANSFORM")) {
                die_at(&l, "*TRANSFORM turns directions of nodes, so that 1, 2, 3 need not be x, y, z");
            }
        } else if (reading) {
            all.node = need_room(all.node, all.count, &all.room, sizeof *all.node);
            all.node[all.count++] = read_node(&l);
        }
    }
    close_lines(&l);
    if (all.count) {
        qsort(all.node, all.count, sizeof *all.node, compare_nodes);
    }
    for (size_t k = 1; k < all.count; k++) {
        if (all.node[k].number == all.node[k - 1].number) {
            die("%s:%zu: node %zu has been given in line %zu", path, all.node[k].line, all.node[k].number, all.node[k - 1].line);
        }
    }
    return all;
}

/* name.inp for name.dof or name.dof.gz; the caller frees it. */
static char *input_of(const char *path)
{
    static const char ending[] = ".inp";
    char *text = need_memory(strlen(path) + 1, 1);
    strcpy(text, path);
    char *dot = strrchr(text, '.');
    if (strcmp(dot, ".gz") == 0) {
        *dot = '\0';
        dot = strrchr(text, '.');
    }
    memcpy(dot, ending, sizeof ending);
    return text;
}

/* The node of that number, or NULL. */
static const struct node *find_node(const struct nodes *all, size_t number)
{
    size_t low = 0, high = all->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (all->node[middle].number < number) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < all->count && all->node[low].number == number ? &all->node[low] : NULL;
}

void find_calculix_places(const char *path, struct degree *dof, size_t count)
{
    char *input = input_of(path);
    struct nodes all = read_nodes(input);
    for (size_t i = 0; i < count; i++) {
        const struct node *node = find_node(&all, dof[i].node);
        if (!node) {
            die("%s:%zu: node %zu has no place in %s (files that it includes are not read)", path, dof[i].line, dof[i].node,
                input);
        }
        memcpy(dof[i].at, node->at, sizeof dof[i].at);
    }
    free(all.node);
    free(input);
}
