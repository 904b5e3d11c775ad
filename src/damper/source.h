/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_SOURCE_H
#define DAMPER_SOURCE_H

/* The bytes of a file, unpacked if its name ends with .gz and zlib was there when the program was built. */
struct source;

/* Ends the program if the file cannot be opened. */
struct source *open_source(const char *path);
void close_source(struct source *s);

/* The next byte, or -1: then there is no more, and *error says why, or is NULL at the end of the file. */
int next_byte(struct source *s, const char **error);

/* 1 if path ends in ending, or in ending and .gz. */
int is_named(const char *path, const char *ending);

#endif
