/* Memory full of zeros, or NULL if there is none; an array of nothing is something. What is small is most likely to be where
 * malloc looks first, in what has just been freed, which calloc of the GNU C library passes by; what is large comes fresh from
 * the system, and is zero when calloc gets it. */
#ifndef TRIBO_ZEROS_H
#define TRIBO_ZEROS_H

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static inline void *tribo_zeros(size_t count, size_t size)
{
    enum { SMALL = 1024 };
    if (count > SMALL / size) {
        return calloc(count, size);
    }
    void *memory = malloc(count * size + 1);
    return memory ? memset(memory, 0, count * size) : NULL;
}

#endif
