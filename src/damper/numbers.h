/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef DAMPER_NUMBERS_H
#define DAMPER_NUMBERS_H

#include <stddef.h>

/* Numbers given by the user. origin is their place, e.g. "option --force 1N": any error ends the program with a message that
 * begins with origin. */

/* Reads a number that ends with the character end. Returns the text behind end. */
const char *read_number(const char *origin, const char *at, char end, double *value);

/* The whole text is a number, or a whole one up to 1000000. */
double read_real(const char *origin, const char *text, double smallest, int may_equal);
size_t read_whole(const char *origin, const char *text, size_t smallest);

/* "NUMBER,NUMBER,...": adds them to list. */
struct list {
    double *value;
    size_t count, room;
};
void add_number(struct list *list, double value);
void read_list(const char *origin, const char *text, struct list *list);

/* FROM:TO:N, or FROM alone with N = 1. FROM > 0, and ascending. */
struct range {
    double from, to;
    size_t points;
};
struct range read_range(const char *origin, const char *text);

#endif
