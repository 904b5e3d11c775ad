/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_TEXT_H
#define DAMPER_TEXT_H

#include <stddef.h>

#include "output.h"

/* The bytes of a file, unpacked if its name ends with .gz and zlib was there when the program was built (source.c). */
struct source;

/* Ends the program if the file cannot be opened. */
struct source *open_source(const char *path);
void close_source(struct source *s);

/* The next byte, or -1: then there is no more, and *error says why, or is NULL at the end of the file. */
int next_byte(struct source *s, const char **error);

/* 1 if path ends in ending, or in ending and .gz. */
int is_named(const char *path, const char *ending);

/* Text that is read word by word: a value that the user gives, or the lines of a file. An error in it ends the program, with
 * place and value. */
struct text {
    const char *place; /* of the value, e.g. "option --force 1N"; or the path of the file */
    char *at;          /* the rest of the value or line, not read yet */
    char end;          /* behind the word read last: a separator; a blank; '\0': the text ends there */
    size_t line;       /* of the file, counted from 1; 0: a value */
    struct source *source;
    char bytes[1025]; /* the line, as long as Matrix Market allows */
};

struct text text_of(const char *place, char *value);
struct text open_text(const char *path);

/* The next line; 0 at the end of the file, which is closed then. */
int next_line(struct text *t);

/* The next line that is neither blank nor begins with #, or % as in Matrix Market; 0 at the end of the file. */
int next_data(struct text *t);

enum { MOST_COUNT = 1000000 /* of anything that the user may choose */ };

/* The next word, which ends before a blank or one of the separators; t->at is behind that. Without a blank among the separators,
 * blanks may stand beside separators and at the end only; "": the word is the last one. what: its name in messages. */
char *next_word(struct text *t, const char *what, const char *separators);

/* The same as a finite number, as one above 0, or as a whole one from least to most; exponents also as Fortran writes them:
 * 1.1D+03. */
double next_real(struct text *t, const char *what, const char *separators);
double next_positive(struct text *t, const char *what, const char *separators);
size_t next_whole(struct text *t, const char *what, const char *separators, size_t least, size_t most);

/* at [3] out: at least `least` coordinates; those that are not given are 0. separators behind the first two, last behind the
 * third. */
void next_coordinates(struct text *t, const char *separators, const char *last, int least, double *at);

/* Nothing but blanks may follow. */
void expect_end(struct text *t);

/* The rest of the text, without blanks at its ends. */
char *rest_of(const struct text *t);

/* For messages: characters that do not print become question marks. Returns text. */
char *make_printable(char *text);

/* die and die_if with "place: ..." or "path:line: ...". */
void die_at(const struct text *t, const char *format, ...) PRINTF_LIKE(2);
#define die_at_if(t, wrong, ...) ((wrong) ? die_at(t, __VA_ARGS__) : (void)0)

/* Reads a value into the object at to. */
typedef void reader(struct text *value, void *to);

/* "NUMBER,NUMBER,...", into a struct list. */
struct list {
    double *value;
    size_t count;
};
reader read_list;
void add_number(struct list *list, double value);

/* FROM:TO:N, or FROM alone with N = 1, into a struct range. FROM > 0, and ascending. */
struct range {
    double from, to;
    size_t points;
};
reader read_range;

#endif
