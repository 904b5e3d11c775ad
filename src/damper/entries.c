/* SPDX-License-Identifier: BSD-3-Clause */
#include "entries.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

static size_t next_index(struct lines *l, const char *what, const struct rows *rows)
{
    const size_t index = next_whole(l, what, 1, INT_MAX);
    if (index > rows->count) {
        die_at(l, "%s %zu, but the degrees of freedom in %s are %zu", what, index, rows->path, rows->count);
    }
    return index;
}

struct entry read_entry(struct lines *l, const struct rows *rows)
{
    struct entry e = {.line = l->line};
    e.row = next_index(l, "row", rows);
    e.column = next_index(l, "column", rows);
    e.value = next_real(l, "value");
    expect_end(l);
    return e;
}

void add_entry(struct entries *all, const struct entry *e)
{
    all->entry = need_room(all->entry, all->count, &all->room, sizeof *all->entry);
    all->entry[all->count++] = *e;
}

/* Moves the entries to `to`, those of the first row, or column, first, else in their order: a pass that takes time in proportion
 * to their number. next [rows + 2] is workspace. */
static void sort_pass(const struct entry *from, size_t count, size_t rows, int by_row, size_t *next, struct entry *to)
{
    for (size_t i = 0; i < rows + 2; i++) {
        next[i] = 0;
    }
    for (size_t k = 0; k < count; k++) {
        next[(by_row ? from[k].row : from[k].column) + 1]++;
    }
    for (size_t i = 1; i < rows + 2; i++) {
        next[i] += next[i - 1];
    }
    for (size_t k = 0; k < count; k++) {
        to[next[by_row ? from[k].row : from[k].column]++] = from[k];
    }
}

static void sort_entries(struct entries *all, size_t rows)
{
    struct entry *other = need_memory(all->count, sizeof *other);
    size_t *next = need_memory(rows + 2, sizeof *next);
    sort_pass(all->entry, all->count, rows, 0, next, other);
    sort_pass(other, all->count, rows, 1, next, all->entry);
    free(other);
    free(next);
}

static void refuse_doubles(const char *path, const struct entries *all)
{
    for (size_t k = 1; k < all->count; k++) {
        const struct entry *e = &all->entry[k], *before = e - 1;
        if (e->row == before->row && e->column == before->column) {
            die("%s:%zu: row %zu, column %zu has been given in line %zu", path, e->line, e->row, e->column, before->line);
        }
    }
}

static int is_mirrored(const struct entry *e, int symmetric)
{
    return symmetric && e->row != e->column;
}

/* first [rows + 1] in: zeros; out: where each row begins. */
static void count_rows(const struct entries *all, size_t rows, int symmetric, size_t *first)
{
    for (size_t k = 0; k < all->count; k++) {
        const struct entry *e = &all->entry[k];
        first[e->row] += e->value != 0.0;
        first[e->column] += e->value != 0.0 && is_mirrored(e, symmetric);
    }
    for (size_t i = 1; i <= rows; i++) {
        first[i] += first[i - 1];
    }
}

/* Entries come row by row, so that each row gets its lower triangle first, then the mirrored entries of later rows. */
static void fill_rows(const struct entries *all, int symmetric, size_t *next, struct sparse *m)
{
    for (size_t k = 0; k < all->count; k++) {
        const struct entry *e = &all->entry[k];
        for (int mirrored = 0; e->value != 0.0 && mirrored <= is_mirrored(e, symmetric); mirrored++) {
            const size_t at = next[(mirrored ? e->column : e->row) - 1]++;
            m->col[at] = (mirrored ? e->row : e->column) - 1;
            m->val[at] = e->value;
        }
    }
}

struct sparse make_matrix(const char *path, struct entries *all, size_t rows, int symmetric)
{
    sort_entries(all, rows);
    refuse_doubles(path, all);
    struct sparse m = {.rows = rows, .first = need_memory(rows + 1, sizeof *m.first)};
    size_t *next = need_memory(rows + 1, sizeof *next);
    count_rows(all, rows, symmetric, m.first);
    memcpy(next, m.first, (rows + 1) * sizeof *next);
    m.col = need_memory(m.first[rows] + 1, sizeof *m.col);
    m.val = need_memory(m.first[rows] + 1, sizeof *m.val);
    fill_rows(all, symmetric, next, &m);
    free(next);
    return m;
}

void free_sparse(struct sparse *m)
{
    free(m->first);
    free(m->col);
    free(m->val);
}
