/* SPDX-License-Identifier: BSD-3-Clause */
#include "matrix_market.h"

#include <ctype.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

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
static size_t read_sizes(struct lines *l, const struct rows *expected)
{
    if (!next_data(l)) {
        die("%s ends before the line with its sizes", l->path);
    }
    const size_t rows = next_whole(l, "the number of rows", 1, INT_MAX),
                 columns = next_whole(l, "the number of columns", 1, INT_MAX),
                 entries = next_whole(l, "the number of entries", 0, INT_MAX);
    expect_end(l);
    if (rows != expected->count || columns != expected->count) {
        die_at(l, "%zu rows and %zu columns, but the degrees of freedom in %s are %zu", rows, columns, expected->path,
               expected->count);
    }
    return entries;
}

static void read_entries(struct lines *l, size_t announced, const struct rows *rows, int symmetric, struct entries *all)
{
    while (next_data(l)) {
        if (all->count == announced) {
            die_at(l, "more entries than the %zu announced", announced);
        }
        const struct entry e = read_entry(l, rows);
        if (symmetric && e.column > e.row) {
            die_at(l, "row %zu, column %zu is above the diagonal; a symmetric file holds the lower triangle", e.row, e.column);
        }
        add_entry(all, &e);
    }
    if (all->count < announced) {
        die_at(l, "the file ends after %zu entries of %zu", all->count, announced);
    }
}

int read_matrix_market(const char *path, const struct rows *rows, struct entries *all)
{
    struct lines l = open_lines(path);
    const int symmetric = read_header(&l);
    const size_t announced = read_sizes(&l, rows);
    read_entries(&l, announced, rows, symmetric, all);
    close_lines(&l);
    return symmetric;
}
