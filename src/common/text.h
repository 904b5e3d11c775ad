/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TRIBO_TEXT_H
#define TRIBO_TEXT_H

#include <stddef.h>

/* Names of methods and steppers: returns 1 if text is name, in small or capital letters; name has no capitals. */
static inline int tribo_same_name(const char *name, const char *text)
{
    while (*name && *name == (*text >= 'A' && *text <= 'Z' ? *text - 'A' + 'a' : *text)) {
        name++;
        text++;
    }
    return *name == *text;
}

/* Returns the ending of a noun after the number n: "1 contact", "2 contacts". */
static inline const char *plural(size_t n)
{
    return n == 1 ? "" : "s";
}

#endif
