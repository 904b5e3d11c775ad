/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_LINES_H
#define DAMPER_LINES_H

#include <stddef.h>

#include "output.h"
#include "source.h"

/* A text file that is read line by line. Any error in it ends the program, with file, line and value. */
struct lines {
    const char *path;
    struct source *source;
    size_t line;     /* counted from 1 */
    char text[1025]; /* the line, as long as Matrix Market allows */
    char *at;        /* the rest of it, not read yet */
};

struct lines open_lines(const char *path);
void close_lines(struct lines *l);

/* The next line; 0 at the end of the file. */
int next_line(struct lines *l);

/* The next line that is neither blank nor begins with #, or % as in Matrix Market; 0 at the end of the file. */
int next_data(struct lines *l);

/* The number at the beginning of a text, *end behind it, as strtod has it; with exponents as Fortran may write them: 1.1D+03. */
double number_at(const char *at, char **end);

/* The next word of the line as a number, or as a whole one from least to most; what: its name in messages. */
double next_real(struct lines *l, const char *what);
size_t next_whole(struct lines *l, const char *what, size_t least, size_t most);

/* Replaces separator by blanks in the rest of the line. */
void part_at(struct lines *l, char separator);

/* The line must have been read to its end. */
void expect_end(struct lines *l);

/* Room for one element of that size more than the count that an array holds: the array, moved where that is needed. */
void *need_room(void *array, size_t count, size_t *room, size_t size);

/* For messages: characters that do not print become question marks. Returns text. */
char *make_printable(char *text);

/* Ends the program: "file:line: ..." */
void die_at(const struct lines *l, const char *format, ...) PRINTF_LIKE(2);

#endif
