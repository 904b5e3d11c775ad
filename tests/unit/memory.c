/* SPDX-License-Identifier: BSD-3-Clause */
#include "memory.h"

#include <malloc.h>
#include <stdint.h>
#include <stdlib.h>

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
void __real_free(void *block);

void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);
void __wrap_free(void *block);

static size_t calls, fails_at;
static long live;

size_t memory_calls(void)
{
    return calls;
}

long memory_live(void)
{
    return live;
}

void memory_fail(size_t call)
{
    fails_at = call ? calls + call : 0;
}

/* Bytes of blocks not freed, as large as the C library made them; those that it frees itself for its own were never here. */
static long used, base, bound, missed;
static int bounded;

void memory_bound(size_t bytes)
{
    base = used;
    bound = (long)bytes;
    bounded = 1;
    missed = 0;
}

void memory_unbound(void)
{
    bounded = 0;
}

size_t memory_missed(void)
{
    return (size_t)missed;
}

static int fails(size_t size)
{
    const long wanted = used - base + (long)size;
    const int beyond = bounded && (size > SIZE_MAX / 4 || wanted > bound);
    if (beyond && (missed == 0 || wanted < missed)) {
        missed = wanted;
    }
    return ++calls == fails_at || beyond;
}

static void *count(void *block)
{
    live += block != NULL;
    used += block ? (long)malloc_usable_size(block) : 0;
    return block;
}

static void discount(void *block)
{
    live -= block != NULL;
    used -= block ? (long)malloc_usable_size(block) : 0;
}

void *__wrap_malloc(size_t size)
{
    return fails(size) ? NULL : count(__real_malloc(size));
}

void *__wrap_calloc(size_t number, size_t size)
{
    return fails(number * size) ? NULL : count(__real_calloc(number, size));
}

void *__wrap_realloc(void *block, size_t size)
{
    if (fails(size)) {
        return NULL;
    }
    discount(block);
    return count(__real_realloc(block, size));
}

void __wrap_free(void *block)
{
    discount(block);
    __real_free(block);
}
