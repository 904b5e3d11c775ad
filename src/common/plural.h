/* Messages that count: "1 contact", "2 contacts". */
#ifndef TRIBO_PLURAL_H
#define TRIBO_PLURAL_H

#include <stddef.h>

/* What follows the noun after a number. */
static inline const char *plural(size_t n)
{
    return n == 1 ? "" : "s";
}

#endif
