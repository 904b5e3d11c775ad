/* SPDX-License-Identifier: BSD-3-Clause */
/* The tool tribo-damper from outside, for suites that run it. Works in the current folder. */
#ifndef TRIBO_TESTS_TOOL_H
#define TRIBO_TESTS_TOOL_H

#include <sys/types.h>

enum { TEXT = 8192 };

/* What a run left; what is longer than TEXT is cut. */
struct outcome {
    int status; /* -1 if a signal ended it */
    char out[TEXT], err[TEXT];
};

void read_text(const char *path, char *text);
void write_bytes(const char *path, const char *bytes, size_t length);
void write_text(const char *path, const char *text);

/* printf into a text that lives until the next call: options of a run. */
const char *form(const char *format, ...);

/* Begins a run, and waits for its end; options are parted by single blanks. */
pid_t begin_tool(const char *options);
struct outcome end_tool(pid_t child);
struct outcome run_tool(const char *options);

/* Status 1, and one line on stderr that prints. */
void assert_ends(const struct outcome *o, const char *what);

/* The same, and the line holds part. what: in messages; NULL: the options. */
void assert_refused(const char *options, const char *what, const char *part);

int has_no_number(const char *text);

/* Status 0, nothing on stderr, and no number that is none. */
struct outcome assert_runs(const char *options);

/* A value of values-damper.txt. */
double value_of(const char *key);

/* Column k, from 1, of the first line of a table. */
double column_of(const char *name, int k);

#endif
