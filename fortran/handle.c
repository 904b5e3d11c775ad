/* Contexts by number, for Fortran.
 *
 * A Fortran object cannot own a pointer. Compilers copy its bits without asking (allocate(source=), allocatable components,
 * temporaries), and finalize a component twice where its type has an assignment of its own (GCC bug 110626; flang and ifx do so
 * too). So it holds a number that is never given twice: when the context has gone, all that is left of the number finds nothing.
 *
 * A number is a place in a table, which grows by chunks that never move, and how often that place has been in use. Finding takes
 * no lock; a context belongs to one thread at a time anyway. */
#include <stdint.h>
#include <stdlib.h>

#include "handle.h"

#define PLACE_BITS 24
#define CHUNK_BITS 10
#define CHUNK ((uint32_t)1 << CHUNK_BITS)
#define PLACES ((uint32_t)1 << PLACE_BITS)

struct place {
    tribo_context *ctx;
    int64_t uses;
    uint32_t next; /* free place after this one; 0: none */
};

/* Place 0 is not used, so that 0 can be the end of the free places and never a context's number. */
static struct place *chunks[PLACES / CHUNK];
static uint32_t used = 1, free_place = 0, alive = 0;

/* Without these two, contexts are to be created, copied and destroyed by one thread at a time. */
static char busy = 0;

static void lock(void)
{
#if defined(__GNUC__)
    while (__atomic_test_and_set(&busy, __ATOMIC_ACQUIRE)) {
    }
#endif
}

static void unlock(void)
{
#if defined(__GNUC__)
    __atomic_clear(&busy, __ATOMIC_RELEASE);
#endif
}

static struct place *at(uint32_t i)
{
    struct place *chunk = chunks[i >> CHUNK_BITS];
    return chunk ? chunk + (i & (CHUNK - 1)) : NULL;
}

/* The place that a number stands for, if it still does. */
static struct place *find(int64_t number)
{
    struct place *p = number > 0 ? at((uint32_t)(number & (PLACES - 1))) : NULL;
    return p && p->ctx && p->uses == number >> PLACE_BITS ? p : NULL;
}

/* A free place, or 0. */
static uint32_t take_place(void)
{
    if (free_place) {
        const uint32_t i = free_place;
        free_place = at(i)->next;
        return i;
    }
    if (used == PLACES) {
        return 0;
    }
    if (!at(used)) {
        chunks[used >> CHUNK_BITS] = calloc(CHUNK, sizeof(struct place));
    }
    return at(used) ? used++ : 0;
}

int64_t tribo_handle_add(tribo_context *ctx)
{
    int64_t number = 0;
    lock();
    const uint32_t i = take_place();
    if (i) {
        struct place *p = at(i);
        p->ctx = ctx;
        p->uses++;
        alive++;
        number = p->uses << PLACE_BITS | i;
    }
    unlock();
    return number;
}

tribo_context *tribo_handle_get(int64_t number)
{
    const struct place *p = find(number);
    return p ? p->ctx : NULL;
}

tribo_context *tribo_handle_remove(int64_t number)
{
    tribo_context *ctx = NULL;
    lock();
    struct place *p = find(number);
    if (p) {
        ctx = p->ctx;
        p->ctx = NULL;
        alive--;
        p->next = free_place;
        free_place = (uint32_t)(number & (PLACES - 1));
    }
    unlock();
    return ctx;
}

uint32_t tribo_handle_count(void)
{
    lock();
    const uint32_t count = alive;
    unlock();
    return count;
}
