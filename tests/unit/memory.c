#include "memory.h"

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

static int fails(void)
{
    return ++calls == fails_at;
}

static void *count(void *block)
{
    live += block != NULL;
    return block;
}

void *__wrap_malloc(size_t size)
{
    return fails() ? NULL : count(__real_malloc(size));
}

void *__wrap_calloc(size_t number, size_t size)
{
    return fails() ? NULL : count(__real_calloc(number, size));
}

void *__wrap_realloc(void *block, size_t size)
{
    if (fails()) {
        return NULL;
    }
    live -= block != NULL;
    return count(__real_realloc(block, size));
}

void __wrap_free(void *block)
{
    live -= block != NULL;
    __real_free(block);
}
