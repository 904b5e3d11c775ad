/* Returns memory of zeros, or NULL; not NULL for count 0. Small memory is best taken from what was just freed, where malloc looks
 * first, and calloc of the GNU C library does not; large memory comes from the system as zeros, which calloc makes use of. */
#ifndef TRIBO_ZEROS_H
#define TRIBO_ZEROS_H

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static inline void *tribo_zeros(size_t count, size_t size)
{
    enum { FRESH = 1024 };
    if (count > FRESH / size) {
        return calloc(count, size);
    }
    void *memory = malloc(count * size + 1);
    return memory ? memset(memory, 0, count * size) : NULL;
}

#endif
