#include "matrix_market.h"

#include <ctype.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "lines.h"

struct entry {
    size_t row, column, line; /* row and column counted from 1 */
    double value;
};

struct entries {
    size_t count, room;
    struct entry *entry;
};

/* 1 if the header says symmetric, 0 if general. */
static int read_header(struct lines *l)
{
    char word[5][21] = {"", "", "", "", ""};
    if (!next_line(l)) {
        die("%s is empty", l->path);
    }
    const int words = sscanf(l->text, "%20s %20s %20s %20s %20s", word[0], word[1], word[2], word[3], word[4]);
    for (int i = 0; i < 5; i++) {
        for (char *c = word[i]; *c; c++) {
            *c = isprint((unsigned char)*c) ? (char)tolower((unsigned char)*c) : '?';
        }
    }
    if (words != 5 || strcmp(word[0], "%%matrixmarket") != 0 || strcmp(word[1], "matrix") != 0 ||
        strcmp(word[2], "coordinate") != 0) {
        die_at(l, "expected a header \"%%%%MatrixMarket matrix coordinate real symmetric\", found \"%s %s %s %s %s\"", word[0],
               word[1], word[2], word[3], word[4]);
    }
    if (strcmp(word[3], "real") != 0 && strcmp(word[3], "integer") != 0) {
        die_at(l, "values are \"%s\"; only real and integer ones will do", word[3]);
    }
    if (strcmp(word[4], "symmetric") != 0 && strcmp(word[4], "general") != 0) {
        die_at(l, "the matrix is \"%s\"; it must be symmetric or general", word[4]);
    }
    return strcmp(word[4], "symmetric") == 0;
}

/* The line with the sizes; returns the number of entries. */
static size_t read_sizes(struct lines *l, size_t expected)
{
    if (!next_data(l)) {
        die("%s ends before the line with its sizes", l->path);
    }
    const size_t rows = next_whole(l, "the number of rows", 1, INT_MAX),
                 columns = next_whole(l, "the number of columns", 1, INT_MAX),
                 entries = next_whole(l, "the number of entries", 0, INT_MAX);
    expect_end(l);
    if (rows != expected || columns != expected) {
        die_at(l, "%zu rows and %zu columns; the structure has %zu degrees of freedom", rows, columns, expected);
    }
    return entries;
}

static struct entry read_entry(struct lines *l, size_t rows, int symmetric)
{
    struct entry e = {.line = l->line};
    e.row = next_whole(l, "row", 1, rows);
    e.column = next_whole(l, "column", 1, rows);
    e.value = next_real(l, "value");
    expect_end(l);
    if (symmetric && e.column > e.row) {
        die_at(l, "row %zu, column %zu is above the diagonal; a symmetric file holds the lower triangle", e.row, e.column);
    }
    return e;
}

static int compare_places(const void *a, const void *b)
{
    const struct entry *x = a, *y = b;
    if (x->row != y->row) {
        return x->row < y->row ? -1 : 1;
    }
    if (x->column != y->column) {
        return x->column < y->column ? -1 : 1;
    }
    return (x->line > y->line) - (x->line < y->line);
}

static void refuse_doubles(const struct lines *l, const struct entries *all)
{
    for (size_t k = 1; k < all->count; k++) {
        const struct entry *e = &all->entry[k], *before = e - 1;
        if (e->row == before->row && e->column == before->column) {
            die("%s:%zu: row %zu, column %zu has been given in line %zu", l->path, e->line, e->row, e->column, before->line);
        }
    }
}

static struct entries read_entries(struct lines *l, size_t announced, size_t rows, int symmetric)
{
    struct entries all = {0, 0, NULL};
    while (next_data(l)) {
        if (all.count == announced) {
            die_at(l, "more entries than the %zu announced", announced);
        }
        all.entry = need_room(all.entry, all.count, &all.room, sizeof *all.entry);
        all.entry[all.count++] = read_entry(l, rows, symmetric);
    }
    if (all.count < announced) {
        die_at(l, "the file ends after %zu entries of %zu", all.count, announced);
    }
    if (all.count) {
        qsort(all.entry, all.count, sizeof *all.entry, compare_places);
    }
    refuse_doubles(l, &all);
    return all;
}

static gsl_spmatrix *make_matrix(const struct entries *all, size_t rows, int symmetric, const char *path)
{
    gsl_spmatrix *m = gsl_spmatrix_alloc_nzmax(rows, rows, (symmetric ? 2 : 1) * all->count + 1, GSL_SPMATRIX_TRIPLET);
    int failed = !m;
    for (size_t k = 0; !failed && k < all->count; k++) {
        const struct entry *e = &all->entry[k];
        failed = gsl_spmatrix_set(m, e->row - 1, e->column - 1, e->value) ||
                 (symmetric && gsl_spmatrix_set(m, e->column - 1, e->row - 1, e->value));
    }
    if (failed) {
        die("%s: out of memory for %zu entries", path, all->count);
    }
    return m;
}

gsl_spmatrix *read_matrix(const char *path, size_t rows)
{
    struct lines l = open_lines(path);
    const int symmetric = read_header(&l);
    const size_t announced = read_sizes(&l, rows);
    struct entries all = read_entries(&l, announced, rows, symmetric);
    close_lines(&l);
    gsl_spmatrix *matrix = make_matrix(&all, rows, symmetric, path);
    free(all.entry);
    return matrix;
}
