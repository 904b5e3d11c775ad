/* SPDX-License-Identifier: BSD-3-Clause */
#include <string.h>

#include "tape.h"

static double *tape;
static size_t room, used;

void put(size_t n, const double *x)
{
    for (size_t i = 0; i < n; i++) {
        if (used < room) {
            tape[used] = x[i];
        }
        used++;
    }
}

void put_one(double x)
{
    put(1, &x);
}

void put_text(const char *text)
{
    const size_t n = text ? strlen(text) : 0;
    put_one((double)n);
    for (size_t i = 0; i < n; i++) {
        put_one((double)text[i]);
    }
}

/* Has play put its results into values[n]; returns how many there are. */
size_t tape_record(void (*play)(void), double *values, size_t n)
{
    tape = values;
    room = n;
    used = 0;
    play();
    return used;
}
