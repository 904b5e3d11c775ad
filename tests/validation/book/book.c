/* SPDX-License-Identifier: BSD-3-Clause */
/* Writes the book of validation, or checks a row of it.
 *
 *     book TABLE                the page, on standard output
 *     book TABLE PAGE           checks that the page has the rows of the table, and no other one
 *     book TABLE PAGE KEY       computes a row, and checks digits and page
 *
 * A line of TABLE: key | quantity | theirs | digits | source | sentence, which a row of less than 9 digits must have. Digits are
 * those to which both agree, relative to theirs; a row fails where its number has fewer. */
#include "book.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { FIELDS = 6, MOST_ROWS = 256, LINE = 2048, LEAST_DIGITS = 9, MOST_DIGITS = 12 };

struct entry {
    char line[LINE];
    char *field[FIELDS]; /* key, quantity, theirs, digits, source, sentence; parts of line */
};

static struct entry table[MOST_ROWS];
static size_t entries;

void need(int status, const char *text)
{
    if (status) {
        fprintf(stderr, "%s: %s\n", tribo_strerror(status), text);
        exit(1);
    }
}

static void fail(const char *key, const char *text)
{
    fprintf(stderr, "%s: %s\n", key, text);
    exit(1);
}

/* Splits a line at |, without the blanks around. Returns the number of fields. */
static size_t split(char *line, char **field, size_t most)
{
    size_t n = 0;
    for (char *at = line; at && n < most; n++) {
        char *end = strchr(at, '|');
        at += strspn(at, " ");
        field[n] = at;
        char *last = end ? end : at + strlen(at);
        *last = '\0';
        while (last > at && strchr(" \n", last[-1])) {
            *--last = '\0';
        }
        at = end ? end + 1 : NULL;
    }
    return n;
}

static void read_table(const char *name)
{
    char line[LINE];
    FILE *file = fopen(name, "r");
    need(file ? TRIBO_OK : TRIBO_ERR_NAME, name);
    while (fgets(line, sizeof line, file)) {
        if (line[0] == '#' || line[0] == '\n') {
            continue;
        }
        if (entries == MOST_ROWS) {
            fail(name, "too many rows");
        }
        struct entry *e = &table[entries++];
        memcpy(e->line, line, sizeof line);
        if (split(e->line, e->field, FIELDS) != FIELDS) {
            fail(e->field[0], "a row has 6 fields");
        }
        if (atoi(e->field[3]) < LEAST_DIGITS && !e->field[5][0]) {
            fail(e->field[0], "less than 9 digits, and no sentence why");
        }
    }
    fclose(file);
}

static const struct row *find_row(const char *key)
{
    static const struct row *const files[] = {rows_oscillators, rows_periodic, rows_planar,
                                              rows_normals,     rows_bodies,   rows_elements};
    for (size_t k = 0; k < COUNT(files); k++) {
        for (const struct row *r = files[k]; r->key; r++) {
            if (!strcmp(r->key, key)) {
                return r;
            }
        }
    }
    fail(key, "no function computes it");
    return NULL;
}

/* Digits to which ours agrees with theirs. */
static int digits_of(double ours, double theirs)
{
    const double off = fabs(ours - theirs) / fabs(theirs);
    return off > 0.0 ? (int)fmin(floor(-log10(off)), MOST_DIGITS) : off == 0.0 ? MOST_DIGITS : 0;
}

/* Computes a row; time [us], of several runs the shortest. */
static double compute(const struct entry *e, double *time)
{
    const struct row *r = find_row(e->field[0]);
    double ours = 0.0;
    *time = HUGE_VAL;
    for (int k = 0; k < 5 && (k == 0 || *time < 2e4); k++) {
        const clock_t begin = clock();
        ours = r->compute(r->variant);
        *time = fmin(*time, 1e6 * (double)(clock() - begin) / CLOCKS_PER_SEC);
    }
    const int digits = digits_of(ours, atof(e->field[2]));
    if (digits < atoi(e->field[3])) {
        fprintf(stderr, "%s: %.15g, not %s: %d digits, not %s\n", e->field[0], ours, e->field[2], digits, e->field[3]);
        exit(1);
    }
    return ours;
}

/* Significant digits that a number is written with. */
static int written(const char *number)
{
    int n = 0, begun = 0;
    for (; *number && *number != 'e'; number++) {
        begun = begun || (*number >= '1' && *number <= '9');
        n += begun && *number >= '0' && *number <= '9';
    }
    return n;
}

static void write_page(void)
{
    printf(
        "# A book of validation\n\n"
        "Numbers that others have published, or that have a closed form, beside those of tribo. `book.txt` in folder `book` has "
        "the\n"
        "table of cases, the files beside it the programs. Each row is a test, `validation/book/<key>`, which fails where tribo\n"
        "agrees to fewer digits than this page says; `cmake --build <build folder> --target book` writes this page anew.\n\n"
        "Digits: those to which both agree, relative to theirs, 12 at most; theirs often has no more. us: microseconds of one\n"
        "run with all that belongs to it, from model to number, on one core; not compared.\n\n"
        "| row | quantity | theirs | tribo | digits | us | source |\n|---|---|---|---|---|---|---|\n");
    for (size_t k = 0; k < entries; k++) {
        char *const *f = table[k].field;
        double time;
        const double ours = compute(&table[k], &time);
        printf("| `%s` | %s | %s | %.*g | %s | %.0f | %s |\n", f[0], f[1], f[2], (int)fmin(fmax(written(f[2]), 4.0), 13.0), ours,
               f[3], time, f[4]);
    }
    printf("\nRows of less than 9 digits:\n\n");
    for (size_t k = 0; k < entries; k++) {
        if (table[k].field[5][0]) {
            printf("- `%s`: %s\n", table[k].field[0], table[k].field[5]);
        }
    }
}

/* The cells of a row of the page: row, quantity, theirs, tribo, digits, us, source. Returns 1 if there is one row of that key. */
enum { CELLS = 8 };
static int find_cells(const char *page, const char *key, char *line, char **cell)
{
    char begin[LINE], seen[LINE];
    int found = 0;
    FILE *file = fopen(page, "r");
    need(file ? TRIBO_OK : TRIBO_ERR_NAME, page);
    snprintf(begin, sizeof begin, "| `%s` |", key);
    while (fgets(seen, sizeof seen, file)) {
        if (!strncmp(seen, begin, strlen(begin))) {
            memcpy(line, seen, sizeof seen);
            found++;
        }
    }
    fclose(file);
    return found == 1 && split(line + 1, cell, CELLS) >= 7;
}

static void check_row(const char *page, const struct entry *e)
{
    char line[LINE], *cell[CELLS], *const *f = e->field;
    double time;
    const double ours = compute(e, &time), theirs = atof(f[2]);
    if (!find_cells(page, f[0], line, cell)) {
        fail(f[0], "the page has no such row, or several");
    }
    if (strcmp(cell[1], f[1]) || strcmp(cell[2], f[2]) || strcmp(cell[4], f[3]) || strcmp(cell[6], f[4])) {
        fail(f[0], "the page is stale: cmake --build <build folder> --target book");
    }
    if (!(fabs(atof(cell[3]) - ours) <= fabs(theirs) * 2.0 * pow(10.0, -atof(f[3])))) {
        fail(f[0], "the page has another number for tribo");
    }
    printf("%s: %.15g, theirs %s\n", f[0], ours, f[2]);
}

/* Checks that the page has as many rows and sentences as the table. */
static void check_page(const char *page)
{
    char line[LINE], *cell[CELLS];
    size_t rows = 0, sentences = 0, reasons = 0;
    FILE *file = fopen(page, "r");
    need(file ? TRIBO_OK : TRIBO_ERR_NAME, page);
    while (fgets(line, sizeof line, file)) {
        rows += !strncmp(line, "| `", 3);
        for (size_t k = 0; !strncmp(line, "- `", 3) && k < entries; k++) {
            char want[LINE];
            const int n = snprintf(want, sizeof want, "- `%s`: %s\n", table[k].field[0], table[k].field[5]);
            sentences += n > 0 && !strcmp(line, want);
        }
    }
    fclose(file);
    for (size_t k = 0; k < entries; k++) {
        reasons += table[k].field[5][0] != '\0';
        if (!find_cells(page, table[k].field[0], line, cell)) {
            fail(table[k].field[0], "the page has no such row, or several");
        }
    }
    if (rows != entries || sentences != reasons || rows < 30) {
        fprintf(stderr, "%zu rows and %zu sentences on the page, %zu and %zu in the table\n", rows, sentences, entries, reasons);
        exit(1);
    }
}

int main(int argc, char **argv)
{
    if (argc < 2 || argc > 4) {
        fail("usage", "book TABLE [PAGE [KEY]]");
    }
    read_table(argv[1]);
    if (argc == 2) {
        write_page();
        return 0;
    }
    if (argc == 3) {
        check_page(argv[2]);
        return 0;
    }
    for (size_t k = 0; k < entries; k++) {
        if (!strcmp(table[k].field[0], argv[3])) {
            check_row(argv[2], &table[k]);
            return 0;
        }
    }
    fail(argv[3], "not in the table");
    return 1;
}
