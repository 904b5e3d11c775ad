/* SPDX-License-Identifier: BSD-3-Clause */
/* Nouns after numbers in messages: "1 contact", "2 contacts". */
#ifndef TRIBO_PLURAL_H
#define TRIBO_PLURAL_H

#include <stddef.h>

/* Returns the ending of a noun after the number n. */
static inline const char *plural(size_t n)
{
    return n == 1 ? "" : "s";
}

#endif
