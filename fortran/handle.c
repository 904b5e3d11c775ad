/* SPDX-License-Identifier: BSD-3-Clause */
/* Objects by number, for Fortran.
 *
 * A Fortran object cannot own a pointer. Compilers copy its bits without its assignment (allocate(source=), allocatable
 * components, temporaries), and finalize a component twice if its type has an assignment of its own (GCC bug 110626; flang and
 * ifx do so too). So it holds a number that is never given twice: copies of the number of a destroyed object find nothing.
 *
 * A number is a place in a table and the uses of this place. The table grows by chunks that never move. A place is not used again
 * after the largest number of uses. Finding takes no lock: an object belongs to one thread at a
 * time, and a number of the past finds nothing at any time, since a place counts its use before it takes the object. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "handle.h"

#define PLACE_BITS 20
#define CHUNK_BITS 10
#define CHUNK ((uint32_t)1 << CHUNK_BITS)
#define PLACES ((uint32_t)1 << PLACE_BITS)

struct place {
    void *object, *owner;
    void (*destroy)(void *); /* of the owner */
    int64_t uses;
    uint32_t next; /* free place after this one; 0: none */
    char *message; /* [MESSAGE] of the object's last failure, or NULL */
};

/* Length of a message. Contexts keep the messages of the library's errors; places keep those of errors found by Fortran, and of
 * calls on const contexts. Places are locked while a message is read or written, so that no message mixes two threads. */
#define MESSAGE 300

/* Place 0 is not used, so that 0 can be the end of the free places and never an object's number. */
struct table {
    int64_t most_uses;
    uint32_t used, free_place, alive;
    struct place *chunks[PLACES / CHUNK];
};

/* The first gives positive numbers, the second negative ones. */
static struct table longs = {INT64_MAX >> PLACE_BITS, 1, 0, 0, {NULL}}, shorts = {INT32_MAX >> PLACE_BITS, 1, 0, 0, {NULL}};

/* Without these, objects are to be created, copied, found and destroyed by one thread at a time. */
#if defined(__GNUC__)
#define LOAD(object) __atomic_load_n(&(object), __ATOMIC_ACQUIRE)
#define STORE(object, value) __atomic_store_n(&(object), value, __ATOMIC_RELEASE)
#else
#define LOAD(object) (object)
#define STORE(object, value) ((object) = (value))
#endif

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

static struct place *at(const struct table *t, uint32_t i)
{
    struct place *chunk = LOAD(t->chunks[i >> CHUNK_BITS]);
    return chunk ? chunk + (i & (CHUNK - 1)) : NULL;
}

static struct table *table_of(int64_t number)
{
    return number > 0 ? &longs : &shorts;
}

static uint32_t place_of(int64_t number)
{
    return (uint32_t)((number > 0 ? number : -number) & (PLACES - 1));
}

/* The place of a number; NULL if its object is destroyed. */
static struct place *find(int64_t number)
{
    if (number == 0 || number < -INT32_MAX) {
        return NULL;
    }
    struct place *p = at(table_of(number), place_of(number));
    return p && LOAD(p->object) && LOAD(p->uses) == (number > 0 ? number : -number) >> PLACE_BITS ? p : NULL;
}

/* A free place, or 0. */
static uint32_t take_place(struct table *t)
{
    if (t->free_place) {
        const uint32_t i = t->free_place;
        t->free_place = at(t, i)->next;
        return i;
    }
    if (t->used == PLACES) {
        return 0;
    }
    if (!at(t, t->used)) {
        STORE(t->chunks[t->used >> CHUNK_BITS], (struct place *)calloc(CHUNK, sizeof(struct place)));
    }
    return at(t, t->used) ? t->used++ : 0;
}

static int64_t add(struct table *t, void *object, void *owner, void (*destroy)(void *))
{
    int64_t number = 0;
    lock();
    const uint32_t i = take_place(t);
    if (i) {
        struct place *p = at(t, i);
        STORE(p->uses, p->uses + 1);
        p->owner = owner;
        p->destroy = destroy;
        STORE(p->object, object);
        t->alive++;
        number = p->uses << PLACE_BITS | i;
    }
    unlock();
    return number;
}

static struct place take(int64_t number)
{
    struct place *p = find(number), taken = {NULL, NULL, NULL, 0, 0, NULL};
    if (p) {
        struct table *t = table_of(number);
        taken = *p;
        p->message = NULL;
        STORE(p->object, NULL);
        t->alive--;
        if (p->uses < t->most_uses) {
            p->next = t->free_place;
            t->free_place = place_of(number);
        }
    }
    return taken;
}

int64_t tribo_handle_add(void *object, void (*destroy)(void *))
{
    return add(&longs, object, object, destroy);
}

int64_t tribo_handle_add_short(void *object, void (*destroy)(void *))
{
    return -add(&shorts, object, object, destroy);
}

int64_t tribo_handle_add_part(void *object, void *owner, void (*destroy)(void *))
{
    return -add(&shorts, object, owner, destroy);
}

void *tribo_handle_find(int64_t number)
{
    struct place *p = find(number);
    return p ? LOAD(p->object) : NULL;
}

void *tribo_handle_owner(int64_t number)
{
    struct place *p = find(number);
    return p && p->owner != LOAD(p->object) ? p->owner : NULL;
}

void tribo_handle_drop(int64_t number)
{
    lock();
    const struct place taken = take(number);
    unlock();
    free(taken.message);
    if (taken.object && taken.destroy) {
        taken.destroy(taken.owner);
    }
}

uint32_t tribo_handle_count(void)
{
    lock();
    const uint32_t count = longs.alive + shorts.alive;
    unlock();
    return count;
}

/* A law in fixed form, and the arrays that it gets. Contexts that share it, copies among them, may be destroyed in any order. */
struct external_law {
    void (*law)(void);
    void *rpar, *ipar;
    struct external_law *next;
};

static struct external_law *external_laws = NULL;

void *tribo_handle_law(void (*law)(void), void *rpar, void *ipar)
{
    lock();
    struct external_law *p = external_laws;
    while (p && !(p->law == law && p->rpar == rpar && p->ipar == ipar)) {
        p = p->next;
    }
    if (!p) {
        p = malloc(sizeof *p);
        if (p) {
            *p = (struct external_law){law, rpar, ipar, external_laws};
            external_laws = p;
        }
    }
    unlock();
    return p;
}

/* The first place of an object, locked; NULL if it has none. */
static struct place *place_with(const void *object)
{
    struct table *const tables[] = {&longs, &shorts};
    for (size_t k = 0; k < 2; k++) {
        for (uint32_t i = 1; i < tables[k]->used; i++) {
            struct place *p = at(tables[k], i);
            if (p->object == object) {
                return p;
            }
        }
    }
    return NULL;
}

int tribo_handle_note(const void *object, int status, const char *text)
{
    lock();
    struct place *p = object ? place_with(object) : NULL;
    if (p && !p->message) {
        p->message = malloc(MESSAGE);
    }
    if (p && p->message) {
        snprintf(p->message, MESSAGE, "%s", text ? text : tribo_strerror(status));
    }
    unlock();
    return status;
}

void tribo_handle_noted(const void *object, size_t size, char *text)
{
    lock();
    const struct place *p = object ? place_with(object) : NULL;
    snprintf(text, size, "%s", p && p->message ? p->message : "");
    unlock();
}
