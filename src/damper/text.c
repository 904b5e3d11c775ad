/* SPDX-License-Identifier: BSD-3-Clause */
#include "text.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static const char BLANK[] = " \t\r\n";

char *make_printable(char *text)
{
    for (char *c = text; *c; c++) {
        *c = (*c < ' ' && *c != '\t') || *c > '~' ? '?' : *c;
    }
    return text;
}

void die_at(const struct text *t, const char *format, ...)
{
    char text[300];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    die_if(t->line > 0, "%s:%zu: %s", t->place, t->line, make_printable(text));
    die("%s: %s", t->place, make_printable(text));
}

/* --------------------------------------------------------------------------------------------------------------- lines */

struct text text_of(const char *place, char *value)
{
    return (struct text){.place = place, .at = value};
}

struct text open_text(const char *path)
{
    return (struct text){.place = path, .source = open_source(path)};
}

/* A last line that does not end may be cut within a number. */
int next_line(struct text *t)
{
    static const char mark[] = "\xEF\xBB\xBF"; /* of UTF-8, with which some editors begin a file */
    const char *error;
    size_t length = 0;
    int c = next_byte(t->source, &error);
    if (c < 0 && !error) {
        close_source(t->source);
        return 0;
    }
    for (t->line++; c != '\n'; c = next_byte(t->source, &error)) {
        die_at_if(t, error != NULL, "cannot be read: %s", error);
        die_at_if(t, c < 0, "the file ends within this line: is it cut off? If it is whole, end the line");
        die_at_if(t, c == '\0', "byte %zu of the line is zero: this is no text", length + 1);
        die_at_if(t, length + 1 == sizeof t->bytes, "the line is longer than %zu characters", length);
        t->bytes[length++] = (char)c;
    }
    t->bytes[length] = '\0';
    t->at = t->bytes + (t->line == 1 && strncmp(t->bytes, mark, sizeof mark - 1) == 0 ? sizeof mark - 1 : 0);
    return 1;
}

int next_data(struct text *t)
{
    do {
        if (!next_line(t)) {
            return 0;
        }
        t->at += strspn(t->at, BLANK);
    } while (*t->at == '\0' || *t->at == '#' || *t->at == '%');
    return 1;
}

/* --------------------------------------------------------------------------------------------------------------- words */

void expect_end(struct text *t)
{
    const char *rest = t->at + strspn(t->at, BLANK);
    die_at_if(t, *rest, "\"%.40s\" is too much", rest);
}

char *next_word(struct text *t, const char *what, const char *separators)
{
    char *word = t->at + strspn(t->at, BLANK);
    const size_t to_blank = strcspn(word, BLANK), to_separator = strcspn(word, separators);
    char *end = word + (to_blank < to_separator ? to_blank : to_separator), *next = end + strspn(end, BLANK);
    die_at_if(t, end == word && *next == '\0', "the %s ends before %s", t->line ? "line" : "value", what);
    die_at_if(t, end == word, "%s is missing before \"%.40s\"", what, next);
    const int parted = *next && strchr(separators, *next);
    t->end = parted || !*next ? *next : ' ';
    t->at = next + parted;
    *end = '\0';
    if (!*separators) {
        expect_end(t);
    }
    die_at_if(t, t->end == ' ' && !strchr(separators, ' '), "expected \"%s\" before \"%.40s\"", separators, next);
    return word;
}

/* NaN if the word is no finite number. */
static double number_of(char *word)
{
    char *end;
    double value = strtod(word, &end);
    if (end > word && (*end == 'D' || *end == 'd')) {
        char *letter = end, as_it_is = *letter;
        *letter = 'e';
        value = strtod(word, &end);
        *letter = as_it_is;
    }
    return end > word && *end == '\0' && isfinite(value) ? value : (double)NAN;
}

double next_real(struct text *t, const char *what, const char *separators)
{
    char *word = next_word(t, what, separators);
    const double value = number_of(word);
    die_at_if(t, isnan(value), "%s \"%.40s\" is no finite number", what, word);
    return value;
}

double next_positive(struct text *t, const char *what, const char *separators)
{
    const double value = next_real(t, what, separators);
    die_at_if(t, value <= 0.0, "must be above 0");
    return value;
}

size_t next_whole(struct text *t, const char *what, const char *separators, size_t least, size_t most)
{
    char *word = next_word(t, what, separators);
    const double value = number_of(word);
    die_at_if(t, !(value == floor(value) && value >= (double)least && value <= (double)most),
              "%s \"%.40s\" is no whole number from %zu to %zu", what, word, least, most);
    return (size_t)value;
}

void next_coordinates(struct text *t, const char *separators, const char *last, int least, double *at)
{
    static const char *const what[] = {"coordinate x", "coordinate y", "coordinate z"};
    for (int i = 0; i < 3; i++) {
        at[i] = i < least || *rest_of(t) ? next_real(t, what[i], i < 2 ? separators : last) : 0.0;
    }
}

char *rest_of(const struct text *t)
{
    char *rest = t->at + strspn(t->at, BLANK), *end = rest + strlen(rest);
    while (end > rest && strchr(BLANK, end[-1])) {
        *--end = '\0';
    }
    return rest;
}

/* --------------------------------------------------------------------------------------------------- lists and ranges */

void add_number(struct list *list, double value)
{
    list->value = need_room(list->value, list->count, sizeof *list->value);
    list->value[list->count++] = value;
}

void read_list(struct text *t, void *list)
{
    ((struct list *)list)->count = 0;
    do {
        add_number(list, next_real(t, "number", ","));
    } while (t->end);
}

void read_range(struct text *t, void *range)
{
    struct range r = {.points = 1};
    r.from = r.to = next_positive(t, "number", ":");
    if (t->end) {
        r.to = next_real(t, "number", ":");
        r.points = next_whole(t, "number of points", "", 1, MOST_COUNT);
    }
    die_at_if(t, r.to < r.from || (r.to == r.from) != (r.points == 1), "a range must be positive and ascend");
    *(struct range *)range = r;
}
