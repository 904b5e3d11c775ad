/* SPDX-License-Identifier: BSD-3-Clause */
#include "matrix.h"

#include <ctype.h>
#include <limits.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "text.h"

/* Entries of a matrix as a file has them. */
struct entry {
    size_t row, column, line; /* row and column counted from 1 */
    double value;
};

struct entries {
    size_t count;
    struct entry *entry;
};

/* The two lines at the head of a Matrix Market file. Returns 1 if it is symmetric, 0 if general. */
static int read_head(struct text *t, const struct rows *expected, size_t *entries)
{
    char word[5][21] = {"", "", "", "", ""};
    die_if(!next_line(t), "%s is empty", t->place);
    const int words = sscanf(t->at, "%20s %20s %20s %20s %20s", word[0], word[1], word[2], word[3], word[4]);
    for (size_t i = 0; i < sizeof word; i++) {
        char *const c = &word[i / sizeof *word][i % sizeof *word];
        *c = (char)tolower((unsigned char)*c);
    }
    die_at_if(t,
              words != 5 || strcmp(word[0], "%%matrixmarket") != 0 || strcmp(word[1], "matrix") != 0 ||
                  strcmp(word[2], "coordinate") != 0,
              "expected a header \"%%%%MatrixMarket matrix coordinate real symmetric\", found \"%s %s %s %s %s\"", word[0],
              word[1], word[2], word[3], word[4]);
    die_at_if(t, strcmp(word[3], "real") != 0 && strcmp(word[3], "integer") != 0,
              "values are \"%s\"; only real and integer ones will do", word[3]);
    die_at_if(t, strcmp(word[4], "symmetric") != 0 && strcmp(word[4], "general") != 0,
              "the matrix is \"%s\"; it must be symmetric or general", word[4]);
    die_if(!next_data(t), "%s ends before the line with its sizes", t->place);
    const size_t rows = next_whole(t, "the number of rows", " ", 1, INT_MAX),
                 columns = next_whole(t, "the number of columns", " ", 1, INT_MAX);
    *entries = next_whole(t, "the number of entries", "", 0, INT_MAX);
    die_at_if(t, rows != expected->count || columns != expected->count,
              "%zu rows and %zu columns, but the degrees of freedom in %s are %zu", rows, columns, expected->path,
              expected->count);
    return strcmp(word[4], "symmetric") == 0;
}

static size_t next_index(struct text *t, const char *what, const struct rows *rows)
{
    const size_t index = next_whole(t, what, " ", 1, INT_MAX);
    die_at_if(t, index > rows->count, "%s %zu, but the degrees of freedom in %s are %zu", what, index, rows->path, rows->count);
    return index;
}

static void add_entry(struct entries *all, struct entry e)
{
    all->entry = need_room(all->entry, all->count, sizeof *all->entry);
    all->entry[all->count++] = e;
}

/* Row by row, column by column, line by line. */
static int compare_entries(const void *a, const void *b)
{
    const struct entry *x = a, *y = b;
    const int row = (x->row > y->row) - (x->row < y->row), column = (x->column > y->column) - (x->column < y->column);
    return row ? row : column ? column : (x->line > y->line) - (x->line < y->line);
}

/* Sorts the entries, and makes a matrix of those that are not zero. Of a symmetric matrix they hold the lower triangle. */
static struct sparse make_matrix(const char *path, struct entries *all, size_t rows, int symmetric)
{
    for (size_t k = 0, given = all->count; symmetric && k < given; k++) {
        const struct entry e = all->entry[k];
        if (e.row != e.column) {
            add_entry(all, (struct entry){e.column, e.row, e.line, e.value});
        }
    }
    if (all->count) {
        qsort(all->entry, all->count, sizeof *all->entry, compare_entries);
    }
    struct sparse m = {.rows = rows,
                       .first = need_memory(rows + 1, sizeof *m.first),
                       .col = need_memory(all->count, sizeof *m.col),
                       .val = need_memory(all->count, sizeof *m.val)};
    size_t count = 0;
    for (size_t i = 1, k = 0; i <= rows; i++) {
        for (; k < all->count && all->entry[k].row == i; k++) {
            const struct entry *e = &all->entry[k], *before = e - (k > 0);
            const int turned = symmetric && e->column > e->row;
            die_if(e != before && e->row == before->row && e->column == before->column,
                   "%s:%zu: row %zu, column %zu has been given in line %zu", path, e->line, turned ? e->column : e->row,
                   turned ? e->row : e->column, before->line);
            m.col[count] = e->column - 1;
            m.val[count] = e->value;
            count += e->value != 0.0;
        }
        m.first[i] = count;
    }
    return m;
}

struct sparse read_matrix(const char *path, const struct rows *rows)
{
    const int calculix = is_named(path, ".sti") || is_named(path, ".mas");
    struct text t = open_text(path);
    struct entries all = {0, NULL};
    size_t announced = SIZE_MAX;
    const int symmetric = calculix || read_head(&t, rows, &announced);
    char *diagonal = need_memory(rows->count, 1);
    while (next_data(&t)) {
        die_at_if(&t, all.count == announced, "more entries than the %zu announced", announced);
        struct entry e = {.line = t.line};
        e.row = next_index(&t, "row", rows);
        e.column = next_index(&t, "column", rows);
        e.value = next_real(&t, "value", "");
        if (symmetric && e.column > e.row) {
            die_at_if(&t, !calculix, "row %zu, column %zu is above the diagonal; a symmetric file holds the lower triangle",
                      e.row, e.column);
            e = (struct entry){e.column, e.row, e.line, e.value};
        }
        diagonal[e.row - 1] |= e.row == e.column;
        add_entry(&all, e);
    }
    die_at_if(&t, !calculix && all.count < announced, "the file ends after %zu entries of %zu", all.count, announced);
    /* CalculiX's format has no count of entries: a file that is cut off lacks entries on the diagonal */
    const char *missing = calculix ? memchr(diagonal, 0, rows->count) : NULL;
    die_if(missing,
           "%s: row %zu of %zu has no entry on the diagonal: is the file cut off, or does it belong to other degrees of freedom "
           "than those in %s?",
           path, (size_t)(missing - diagonal) + 1, rows->count, rows->path);
    const struct sparse matrix = make_matrix(path, &all, rows->count, symmetric);
    free(diagonal);
    free(all.entry);
    return matrix;
}

void free_sparse(struct sparse *m)
{
    free(m->first);
    free(m->col);
    free(m->val);
}
