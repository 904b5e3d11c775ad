/* SPDX-License-Identifier: BSD-3-Clause */
#include "lines.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static const char BLANK[] = " \t\r\n";

struct lines open_lines(const char *path)
{
    return (struct lines){.path = path, .source = open_source(path)};
}

void close_lines(struct lines *l)
{
    close_source(l->source);
}

void die_at(const struct lines *l, const char *format, ...)
{
    char text[300];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    die("%s:%zu: %s", l->path, l->line, make_printable(text));
}

char *make_printable(char *text)
{
    for (char *c = text; *c; c++) {
        *c = (*c < ' ' && *c != '\t') || *c > '~' ? '?' : *c;
    }
    return text;
}

/* Some editors begin a file with the mark of UTF-8. */
static void skip_mark(struct lines *l, size_t length)
{
    static const char mark[] = "\xEF\xBB\xBF";
    const size_t marked = sizeof mark - 1;
    if (l->line == 1 && strncmp(l->text, mark, marked) == 0) {
        memmove(l->text, l->text + marked, length - marked + 1);
    }
}

/* A last line that does not end may be cut within a number. */
int next_line(struct lines *l)
{
    const char *error;
    size_t length = 0;
    int c = next_byte(l->source, &error);
    if (c < 0 && !error) {
        return 0;
    }
    for (l->line++; c != '\n'; c = next_byte(l->source, &error)) {
        if (error) {
            die_at(l, "cannot be read: %s", error);
        }
        if (c < 0) {
            die_at(l, "the file ends within this line: is it cut off? If it is whole, end the line");
        }
        if (c == '\0') {
            die_at(l, "byte %zu of the line is zero: this is no text", length + 1);
        }
        if (length + 1 == sizeof l->text) {
            die_at(l, "the line is longer than %zu characters", length);
        }
        l->text[length++] = (char)c;
    }
    l->text[length] = '\0';
    skip_mark(l, length);
    l->at = l->text;
    return 1;
}

int next_data(struct lines *l)
{
    do {
        if (!next_line(l)) {
            return 0;
        }
        l->at += strspn(l->at, BLANK);
    } while (*l->at == '\0' || *l->at == '#' || *l->at == '%');
    return 1;
}

/* Moves to the next word, and returns its length. */
static size_t next_word(struct lines *l)
{
    l->at += strspn(l->at, BLANK);
    return strcspn(l->at, BLANK);
}

/* As messages show a word. */
struct shown {
    char text[41];
};
static struct shown shown(const char *word, size_t length)
{
    struct shown s = {""};
    for (size_t i = 0; i < length && i + 1 < sizeof s.text; i++) {
        s.text[i] = word[i] < ' ' || word[i] > '~' ? '?' : word[i];
    }
    return s;
}

double number_at(const char *at, char **end)
{
    char word[64], *stop;
    const double value = strtod(at, end);
    const size_t mantissa = (size_t)(*end - at);
    if (mantissa == 0 || mantissa + 1 >= sizeof word || (**end != 'D' && **end != 'd')) {
        return value;
    }
    strncpy(word, at, sizeof word - 1);
    word[sizeof word - 1] = '\0';
    word[mantissa] = 'e';
    const double whole = strtod(word, &stop);
    *end += (stop - word) - (ptrdiff_t)mantissa;
    return whole;
}

double next_real(struct lines *l, const char *what)
{
    const size_t length = next_word(l);
    char *end;
    if (length == 0) {
        die_at(l, "the line ends before %s", what);
    }
    const double value = number_at(l->at, &end);
    if (end != l->at + length || !isfinite(value)) {
        const struct shown word = shown(l->at, length);
        die_at(l, "%s \"%s\" is no finite number", what, word.text);
    }
    l->at = end;
    return value;
}

size_t next_whole(struct lines *l, const char *what, size_t least, size_t most)
{
    const size_t length = next_word(l);
    const struct shown word = shown(l->at, length);
    const double value = next_real(l, what);
    if (value != floor(value) || value < (double)least || value > (double)most) {
        die_at(l, "%s \"%s\" is no whole number from %zu to %zu", what, word.text, least, most);
    }
    return (size_t)value;
}

void part_at(struct lines *l, char separator)
{
    for (char *c = l->text + (l->at - l->text); (c = strchr(c, separator)) != NULL;) {
        *c = ' ';
    }
}

void expect_end(struct lines *l)
{
    const size_t length = next_word(l);
    if (length) {
        const struct shown word = shown(l->at, length);
        die_at(l, "\"%s\" is too much", word.text);
    }
}

void *need_room(void *array, size_t count, size_t *room, size_t size)
{
    if (count < *room) {
        return array;
    }
    *room = 2 * *room + 256;
    void *more = *room <= SIZE_MAX / size ? realloc(array, *room * size) : NULL;
    if (!more) {
        die("out of memory for %zu times %zu bytes", *room, size);
    }
    return more;
}
