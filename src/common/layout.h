/* SPDX-License-Identifier: BSD-3-Clause */
/* All arrays of an object in one block of memory. A function lays out the arrays twice: first with memory NULL, to add up the
 * sizes; then in the allocated memory. */
#ifndef TRIBO_LAYOUT_H
#define TRIBO_LAYOUT_H

#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Returns zeroed memory, or NULL; not NULL for count 0. Small blocks: malloc reuses memory just freed, calloc of the GNU C
 * library does not. Large blocks: memory from the system is zero already, and calloc does not clear it again. */
static inline void *tribo_zeros(size_t count, size_t size)
{
    enum { FRESH = 1024 };
    if (count > FRESH / size) {
        return calloc(count, size);
    }
    void *memory = malloc(count * size + 1);
    return memory ? memset(memory, 0, count * size) : NULL;
}

struct layout {
    char *memory; /* NULL in the first pass */
    size_t used;
};

/* The alignment of arrays. */
union layout_unit {
    double number;
    size_t index;
    void *pointer;
};

/* Returns an array [count] of elements; NULL in the first pass. If sizes overflow, their sum is too large to allocate. */
static inline void *tribo_layout_array(struct layout *b, size_t count, size_t size)
{
    enum { UNIT = sizeof(union layout_unit) };
    void *array = b->memory ? b->memory + b->used : NULL;
    const size_t most = SIZE_MAX / 4, bytes = count < most / size ? (count * size + UNIT - 1) / UNIT * UNIT : most;
    const size_t used = b->used + bytes;
    b->used = used < most ? used : most;
    return array;
}

/* Allocates the sum of the sizes as zeros, and restarts the layout at 0. Returns 0 if out of memory. */
static inline int tribo_layout_zeros(struct layout *b)
{
    b->memory = tribo_zeros(b->used + 1, 1);
    b->used = 0;
    return b->memory != NULL;
}

#endif
