/* SPDX-License-Identifier: BSD-3-Clause */
/* What the files of calls_core share: the string that says which calls to make, and the contexts that they are made on. */
#ifndef CALLS_CORE_H
#define CALLS_CORE_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "tribo/tribo.h"

enum { SLOTS = 3, MOST = 200, BODIES = 4, STAIN = 0xA5 };

extern char current[80]; /* file or seed */

#define require(holds, ...)                                                                                                      \
    do {                                                                                                                         \
        if (!(holds)) {                                                                                                          \
            fprintf(stderr, "%s:%d: %s: %s: ", __FILE__, __LINE__, current, #holds);                                             \
            fprintf(stderr, __VA_ARGS__);                                                                                        \
            fputc('\n', stderr);                                                                                                 \
            abort();                                                                                                             \
        }                                                                                                                        \
    } while (0)

/* calls_core.c: the string. */
struct string {
    const uint8_t *byte;
    size_t size, at;
};

unsigned take(struct string *s);

/* A number, mostly an ordinary one: then wild is left alone. */
double number(struct string *s, int *wild);

/* What a call may not do with values: 0, or the status that they ask for. */
enum { FINITE, NONNEGATIVE, POSITIVE };
int fault(const double *x, size_t n, int sign);

/* n values; most of the time of the sign that is asked for. */
void numbers(struct string *s, double *x, size_t n, int sign, int *wild);

/* A context, and what it should hold. own: a law of the caller that is the law. */
struct slot {
    tribo_context *c;
    size_t n;
    int law, own, coupling, sharing, operator, follows, wild_limit, wild_epsilon, wild_operator, linear;
    double limit[MOST], epsilon[MOST], *r;
};

/* The status that a call has and should have; returns it. */
int check(const struct slot *s, const char *call, int got, int want);

/* calls_settings.c */
void set_number(struct slot *s, struct string *in);
void set_limit(struct slot *s, struct string *in);
void set_epsilon(struct slot *s, struct string *in);
void set_operator(struct slot *s, struct string *in);

/* calls_forces.c */
int missing(const struct slot *s);
void balance(struct slot *s, struct string *in);
void step(struct slot *s, struct string *in);
void box(struct slot *s, struct string *in);
void tangents(struct slot *s, struct string *in);
void law(struct slot *s, struct string *in);

/* calls_elements.c */
void elements(struct string *in);

#endif
