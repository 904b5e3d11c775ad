/* SPDX-License-Identifier: BSD-3-Clause */
/* Shared by the files of calls_gsl: the string that chooses the calls, and the systems and drivers of the calls. */
#ifndef CALLS_GSL_H
#define CALLS_GSL_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "tribo/tribo_gsl.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

enum {
    SYSTEMS = 3,
    DRIVERS = 4,
    MOST_DOFS = 6,
    MOST_CONTACTS = 6,
    MOST_STATES = 2 * MOST_DOFS + MOST_CONTACTS + 1,
    MOST_CALLS = 80,
    PATIENCE = 200
};

extern const char *input; /* what is replayed, for messages */

#define demand(holds, ...)                                                                                                       \
    do {                                                                                                                         \
        if (!(holds)) {                                                                                                          \
            fprintf(stderr, "%s: line %d: %s: ", input, __LINE__, #holds);                                                       \
            fprintf(stderr, __VA_ARGS__);                                                                                        \
            fprintf(stderr, "\n");                                                                                               \
            abort();                                                                                                             \
        }                                                                                                                        \
    } while (0)

/* calls_gsl.c: the string. */
struct bytes {
    const uint8_t *at;
    size_t left;
};

/* Takes a choice from 0 to n - 1 off the string. */
size_t choose(struct bytes *b, size_t n);

/* Mostly of the order of 1; now and then what no argument may be, or what is far too large or small for the rest. */
double number(struct bytes *b);
double positive(struct bytes *b);
void fill(struct bytes *b, double *x, size_t n);

/* Returns 1 if a number is too large or small to look for events. */
int wild(const double *x, size_t n);

struct run {
    tribo_driver *drv;
    int events; /* exact, event or auto */
    size_t contacts;
    double t, y[MOST_STATES], stop, tolerance; /* tolerance 0: the method's own */
    /* what the observer knows */
    double from, to, last;
    size_t seen, patience;
};

struct scene {
    tribo_system *sys;
    size_t n, c, given, dimension;
    double omega; /* of the load that came last */
    int wild;
    struct run run[DRIVERS];
};

int are_finite(const double *y, size_t n);

/* Symmetric, and mostly so that it may be a mass or a stiffness. */
void fill_matrix(struct bytes *b, double *a, size_t n, double diagonal);

/* Returns 1 if a mass matrix [n][n] is nearly singular: then periods of the structure are far shorter than a motion. */
int light(const double *mass, size_t n);

/* Returns 1 if the events of a motion of length span may be looked for. */
int bearable(const struct scene *s, const struct run *r, double span);

/* calls_periods.c: a system whose contacts have springs and normals; periodic motions, and the questions about them. */
int create_pressed(struct bytes *b, struct scene *s);
void periods(struct bytes *b, struct scene *s, struct run *r);

#endif
