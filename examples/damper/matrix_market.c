#include "matrix_market.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../common/output.h"

enum { LINE = 1024 /* gsl_spmatrix_fscanf reads no longer ones */ };

/* A file that is being checked. */
struct reader {
    const char *path;
    FILE *file;
    size_t line;
    char text[LINE];
};

static int next_line(struct reader *r)
{
    if (!fgets(r->text, LINE, r->file)) {
        if (ferror(r->file)) {
            die("cannot read %s: %s", r->path, strerror(errno));
        }
        return 0;
    }
    r->line++;
    if (!strchr(r->text, '\n') && strlen(r->text) == LINE - 1) {
        die("%s:%zu: the line is longer than %d characters", r->path, r->line, LINE - 1);
    }
    return 1;
}

/* The header's words; 1 if the matrix is symmetric. */
static int read_header(struct reader *r)
{
    char word[5][21] = {"", "", "", "", ""};
    if (!next_line(r)) {
        die("%s is empty", r->path);
    }
    const int words = sscanf(r->text, "%20s %20s %20s %20s %20s", word[0], word[1], word[2], word[3], word[4]);
    for (int i = 0; i < 5; i++) {
        for (char *c = word[i]; *c; c++) {
            *c = (char)tolower((unsigned char)*c);
        }
    }
    if (words != 5 || strcmp(word[0], "%%matrixmarket") != 0 || strcmp(word[1], "matrix") != 0 ||
        strcmp(word[2], "coordinate") != 0) {
        die("%s:1: expected a header \"%%%%MatrixMarket matrix coordinate real symmetric\"", r->path);
    }
    if (strcmp(word[3], "real") != 0 && strcmp(word[3], "integer") != 0) {
        die("%s:1: values are \"%s\"; only real and integer ones will do", r->path, word[3]);
    }
    if (strcmp(word[4], "symmetric") != 0 && strcmp(word[4], "general") != 0) {
        die("%s:1: matrix is \"%s\"; it must be symmetric or general", r->path, word[4]);
    }
    return strcmp(word[4], "symmetric") == 0;
}

/* Reads a count or index from *at on, which then points behind it. */
static size_t read_count(const struct reader *r, char **at, const char *what)
{
    char *end;
    *at += strspn(*at, " \t");
    errno = 0;
    const unsigned long long value = strtoull(*at, &end, 10);
    if (!isdigit((unsigned char)**at) || errno || value > 4294967295u || !isspace((unsigned char)*end)) {
        die("%s:%zu: expected %s, found \"%.*s\"", r->path, r->line, what, (int)strcspn(*at, " \t\r\n"), *at);
    }
    *at = end;
    return (size_t)value;
}

static void expect_end(const struct reader *r, const char *at)
{
    at += strspn(at, " \t\r\n");
    if (*at) {
        die("%s:%zu: \"%.*s\" is too much", r->path, r->line, (int)strcspn(at, "\r\n"), at);
    }
}

struct sizes {
    size_t rows, entries;
};

static struct sizes read_sizes(struct reader *r)
{
    do {
        if (!next_line(r)) {
            die("%s ends before the line with its sizes", r->path);
        }
    } while (r->text[0] == '%');
    char *at = r->text;
    const size_t rows = read_count(r, &at, "the number of rows"), columns = read_count(r, &at, "the number of columns"),
                 entries = read_count(r, &at, "the number of entries");
    expect_end(r, at);
    if (rows != columns || rows == 0) {
        die("%s:%zu: %zu rows and %zu columns; the matrix must be square", r->path, r->line, rows, columns);
    }
    return (struct sizes){rows, entries};
}

static int compare_keys(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a, y = *(const size_t *)b;
    return (x > y) - (x < y);
}

/* Checks one entry's line and returns a number that tells its place. */
static size_t check_entry(const struct reader *r, size_t rows, int symmetric)
{
    char *at = (char *)r->text, *end;
    const size_t i = read_count(r, &at, "a row"), j = read_count(r, &at, "a column");
    if (i < 1 || i > rows || j < 1 || j > rows) {
        die("%s:%zu: row %zu, column %zu of a matrix of %zu", r->path, r->line, i, j, rows);
    }
    if (symmetric && j > i) {
        die("%s:%zu: row %zu, column %zu is above the diagonal; a symmetric file holds the lower triangle", r->path, r->line, i,
            j);
    }
    const double value = strtod(at, &end);
    if (end == at || !isfinite(value)) {
        at += strspn(at, " \t");
        die("%s:%zu: \"%.*s\" is no finite number", r->path, r->line, (int)strcspn(at, " \t\r\n"), at);
    }
    expect_end(r, end);
    return (i - 1) * rows + j - 1;
}

/* Every line of entries, since what GSL would make of a bad one is less clear. */
static void check_entries(struct reader *r, struct sizes sizes, int symmetric)
{
    size_t count = 0, room = 0, *place = NULL;
    while (next_line(r)) {
        if (count == sizes.entries) {
            die("%s:%zu: more entries than the %zu announced", r->path, r->line, sizes.entries);
        }
        if (count == room) {
            room = 2 * room + 1024;
            place = realloc(place, room * sizeof *place);
            if (!place) {
                die("%s: out of memory for %zu entries", r->path, sizes.entries);
            }
        }
        place[count++] = check_entry(r, sizes.rows, symmetric);
    }
    if (count < sizes.entries) {
        die("%s: ends after %zu entries of %zu", r->path, count, sizes.entries);
    }
    if (count) {
        qsort(place, count, sizeof *place, compare_keys);
    }
    for (size_t k = 1; k < count; k++) {
        if (place[k] == place[k - 1]) {
            die("%s: row %zu, column %zu is given twice", r->path, place[k] / sizes.rows + 1, place[k] % sizes.rows + 1);
        }
    }
    free(place);
}

/* The whole matrix from its lower triangle. */
static gsl_spmatrix *mirrored(const gsl_spmatrix *lower, const char *path)
{
    gsl_spmatrix *whole = gsl_spmatrix_alloc_nzmax(lower->size1, lower->size2, 2 * lower->nz + 1, GSL_SPMATRIX_TRIPLET);
    int failed = !whole;
    for (size_t k = 0; !failed && k < lower->nz; k++) {
        const size_t i = (size_t)lower->i[k], j = (size_t)lower->p[k];
        failed = gsl_spmatrix_set(whole, i, j, lower->data[k]) || gsl_spmatrix_set(whole, j, i, lower->data[k]);
    }
    if (failed) {
        die("%s: out of memory for %zu entries", path, 2 * lower->nz);
    }
    return whole;
}

gsl_spmatrix *read_matrix(const char *path)
{
    struct reader r = {path, fopen(path, "r"), 0, ""};
    if (!r.file) {
        die("cannot open %s: %s", path, strerror(errno));
    }
    const int symmetric = read_header(&r);
    check_entries(&r, read_sizes(&r), symmetric);

    rewind(r.file);
    gsl_spmatrix *matrix = gsl_spmatrix_fscanf(r.file);
    fclose(r.file);
    if (!matrix) {
        die("%s: GSL cannot read it", path);
    }
    if (!symmetric) {
        return matrix;
    }
    gsl_spmatrix *whole = mirrored(matrix, path);
    gsl_spmatrix_free(matrix);
    return whole;
}
