#include "modal_parts.h"

#include <stdlib.h>
#include <string.h>

/* Arrays are many and short: blocks hold several, the first one this many bytes, the next ones twice as many as those before. An
 * emptied list keeps no block of more than LASTING. */
#define BLOCK 2048
#define LASTING ((size_t)1 << 20)

/* With room for arrays behind it, as it is aligned for. */
union block {
    struct {
        union block *next;
        size_t used, room;
    } has;
    double number;
};

static union block *add_block(void **list, size_t *bytes, size_t units)
{
    const union block *last = *list;
    const size_t least = last ? 2 * last->has.room : BLOCK / sizeof(union block), room = units > least ? units : least;
    union block *block = malloc((room + 1) * sizeof *block);
    if (block) {
        block->has.next = *list;
        block->has.used = 0;
        block->has.room = room;
        *list = block;
        *bytes += (room + 1) * sizeof *block;
    }
    return block;
}

void *tribo_modal_take(void **list, size_t *bytes, size_t count, size_t size)
{
    const size_t units = (count * size + sizeof(union block)) / sizeof(union block);
    union block *block = *list;
    if (!block || block->has.room - block->has.used < units) {
        block = add_block(list, bytes, units);
        if (!block) {
            return NULL;
        }
    }
    void *array = block + 1 + block->has.used;
    block->has.used += units;
    return memset(array, 0, count * size);
}

void tribo_modal_give_back(void *list)
{
    for (union block *block = list; block;) {
        union block *next = block->has.next;
        free(block);
        block = next;
    }
}

void tribo_modal_free(struct modal *h)
{
    if (h) {
        tribo_modal_give_back(h->memory);
        free(h);
    }
}

void tribo_modal_empty(void **list)
{
    union block *block = *list;
    if (block && block->has.room > LASTING / sizeof *block) {
        tribo_modal_give_back(block);
        *list = NULL;
    } else if (block) {
        tribo_modal_give_back(block->has.next);
        block->has.next = NULL;
        block->has.used = 0;
    }
}

double *tribo_modal_keep(struct modal_build *b, size_t count)
{
    return tribo_modal_take(&b->h->memory, &b->h->bytes, count, sizeof(double));
}

size_t *tribo_modal_keep_indices(struct modal_build *b, size_t count)
{
    return tribo_modal_take(&b->h->memory, &b->h->bytes, count, sizeof(size_t));
}

unsigned char *tribo_modal_keep_bytes(struct modal_build *b, size_t count)
{
    return tribo_modal_take(&b->h->memory, &b->h->bytes, count, 1);
}

struct output *tribo_modal_keep_outputs(struct modal_build *b, size_t count)
{
    return tribo_modal_take(&b->h->memory, &b->h->bytes, count, sizeof *b->h->output);
}

struct forcing *tribo_modal_keep_forcing(struct modal_build *b, size_t count)
{
    return tribo_modal_take(&b->h->memory, &b->h->bytes, count, sizeof *b->h->forcing);
}

double *tribo_modal_scratch(struct modal_build *b, size_t count)
{
    size_t ignored = 0;
    return tribo_modal_take(&b->whole->scratch, &ignored, count, sizeof(double));
}

size_t *tribo_modal_scratch_indices(struct modal_build *b, size_t count)
{
    size_t ignored = 0;
    return tribo_modal_take(&b->whole->scratch, &ignored, count, sizeof(size_t));
}

unsigned char *tribo_modal_scratch_bytes(struct modal_build *b, size_t count)
{
    size_t ignored = 0;
    return tribo_modal_take(&b->whole->scratch, &ignored, count, 1);
}

struct harmonic *tribo_modal_scratch_harmonics(struct modal_build *b, size_t count)
{
    size_t ignored = 0;
    return tribo_modal_take(&b->whole->scratch, &ignored, count, sizeof(struct harmonic));
}

/* ----------------------------------------------------------------------------------------------------- the contacts that hold */

double tribo_modal_shape(const struct modal_build *b, size_t i, size_t k)
{
    return tribo_matrix_row_dot(&b->sys->direction, i, b->phi + k * b->n);
}

void tribo_modal_react(const struct modal_build *b, double *force, double *f)
{
    for (size_t k = 0; k < b->h->modes; k++) {
        tribo_add(force, -tribo_dot(b->phi + k * b->n, force, b->n), b->psi + k * b->n, b->n);
    }
    tribo_constraints_react(&b->ties, force, f);
}
