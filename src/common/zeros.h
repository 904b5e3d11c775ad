/* SPDX-License-Identifier: BSD-3-Clause */
/* Returns zeroed memory, or NULL; not NULL for count 0. Small blocks: malloc reuses memory just freed, calloc of the GNU C
 * library does not. Large blocks: memory from the system is zero already, and calloc does not clear it again. */
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
