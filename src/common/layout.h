/* SPDX-License-Identifier: BSD-3-Clause */
/* All arrays of an object in one block of memory. */
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
    const size_t small = count > FRESH / size ? 0 : count * size;
    void *memory = count > FRESH / size ? calloc(count, size) : malloc(small + 1);
    return memory ? memset(memory, 0, small) : NULL;
}

/* The alignment of arrays. */
union layout_unit {
    double number;
    size_t index;
    void *pointer;
};

/* Bytes of a layout, from which on it is too large to allocate. */
#define TRIBO_LAYOUT_MOST (SIZE_MAX / 4)

/* Returns the bytes of an array [count] of elements of size, in whole units. A constant size costs no division. */
static inline size_t tribo_layout_bytes(size_t count, size_t size)
{
    enum { UNIT = sizeof(union layout_unit) };
    return count < TRIBO_LAYOUT_MOST / size ? (count * size + UNIT - 1) / UNIT * UNIT : TRIBO_LAYOUT_MOST;
}

/* The array *at. */
struct array {
    void *at;
    size_t bytes;
};

#define ARRAY(pointer, count)                                                                                                    \
    {                                                                                                                            \
        &(pointer), tribo_layout_bytes((count), sizeof *(pointer))                                                               \
    }

/* A block of memory for one layout of arrays after the other. */
struct room {
    void *block; /* owned; NULL: none */
    size_t size; /* bytes */
};

/* Makes room of bytes, all 0; allocates if room->size is less. Returns the block; NULL, and an empty room, if out of memory. */
static inline void *tribo_make_room(struct room *room, size_t bytes)
{
    if (room->block && bytes <= room->size) {
        return memset(room->block, 0, bytes);
    }
    free(room->block);
    room->block = tribo_zeros(bytes, 1);
    room->size = room->block ? bytes : 0;
    return room->block;
}

/* Lays out the arrays of list [length] as zeros in room, and sets their pointers. Returns the block; NULL, and sets all pointers
 * to NULL, if out of memory. */
static inline void *tribo_allocate_in(struct room *room, const struct array *list, size_t length)
{
    size_t used = 0;
    for (size_t k = 0; k < length; k++) {
        used = used + list[k].bytes < TRIBO_LAYOUT_MOST ? used + list[k].bytes : TRIBO_LAYOUT_MOST;
    }
    char *const block = tribo_make_room(room, used + 1), *at = block;
    for (size_t k = 0; k < length; k++) {
        void *const array = at;
        memcpy(list[k].at, &array, sizeof array); /* all pointers to objects have the representation of void * */
        at = block ? at + list[k].bytes : NULL;
    }
    return block;
}

/* Allocates the arrays of list [length] as zeros in one block, which the first array owns. Returns what tribo_allocate_in
 * returns. */
static inline void *tribo_allocate(const struct array *list, size_t length)
{
    struct room room = {0};
    return tribo_allocate_in(&room, list, length);
}

/* tribo_allocate, and tribo_allocate_in, of a list of ARRAY(pointer, count). */
#define ALLOCATE(...)                                                                                                            \
    tribo_allocate((const struct array[]){__VA_ARGS__}, sizeof((const struct array[]){__VA_ARGS__}) / sizeof(struct array))
#define ALLOCATE_IN(room, ...)                                                                                                   \
    tribo_allocate_in((room), (const struct array[]){__VA_ARGS__},                                                               \
                      sizeof((const struct array[]){__VA_ARGS__}) / sizeof(struct array))

#endif
