#include "parts.h"
#include "common/layout.h"
#include "common/zeros.h"

#include <stdlib.h>
#include <string.h>

/* Arrays are many and short: a block holds several. The first block has BLOCK bytes, a size that allocators serve without a
 * search; each next block is at least twice as large as the block before. The first block is zeroed as a whole, since it is
 * small; in larger blocks tribo_modal_take zeroes each array. An emptied list keeps no block of more than LASTING bytes. */
#define BLOCK 992
#define LASTING ((size_t)1 << 20)

struct block {
    struct block *next;
    size_t used, room; /* units */
    union layout_unit unit[];
};

/* Returns 1 if a block of room units is larger than a first block. */
static int is_large(size_t room)
{
    return room > BLOCK / sizeof(union layout_unit);
}

static struct block *add_block(void **list, size_t *bytes, size_t units)
{
    struct block *last = *list;
    const size_t least = last ? 2 * last->room : BLOCK / sizeof *last->unit, room = units > least ? units : least;
    const size_t size = sizeof *last + room * sizeof *last->unit;
    struct block *block = is_large(room) ? malloc(size) : tribo_zeros(size, 1);
    if (block) {
        block->next = last;
        block->used = 0;
        block->room = room;
        *list = block;
        *bytes += size;
    }
    return block;
}

void *tribo_modal_take(void **list, size_t *bytes, size_t count, size_t size)
{
    struct block *block = *list;
    const size_t units = (count * size + sizeof *block->unit - 1) / sizeof *block->unit;
    if (!block || block->room - block->used < units) {
        block = add_block(list, bytes, units);
        if (!block) {
            return NULL;
        }
    }
    union layout_unit *array = block->unit + block->used;
    block->used += units;
    return is_large(block->room) ? memset(array, 0, units * sizeof *array) : array;
}

void tribo_modal_give_back(void *list)
{
    for (struct block *block = list; block;) {
        struct block *next = block->next;
        free(block);
        block = next;
    }
}

struct modal *tribo_modal_alloc(void)
{
    void *list = NULL;
    size_t bytes = 0;
    struct modal *h = tribo_modal_take(&list, &bytes, 1, sizeof *h);
    size_t *users = h ? tribo_modal_take(&list, &bytes, 1, sizeof *users) : NULL;
    if (!users) {
        tribo_modal_give_back(list);
        return NULL;
    }
    h->memory = list;
    h->bytes = bytes;
    h->users = users;
    return h;
}

void tribo_modal_free(const struct modal *h)
{
    if (h && (*h->users)-- == 0) {
        tribo_modal_free(h->base);
        tribo_modal_give_back(h->memory);
    }
}

const struct modal *tribo_modal_share(const struct modal *h)
{
    ++*h->users;
    return h;
}

void tribo_modal_empty(void **list)
{
    struct block *block = *list;
    if (block && block->room > LASTING / sizeof *block->unit) {
        tribo_modal_give_back(block);
        *list = NULL;
    } else if (block) {
        tribo_modal_give_back(block->next);
        memset(block->unit, 0, is_large(block->room) ? 0 : block->used * sizeof *block->unit);
        block->next = NULL;
        block->used = 0;
    }
}

double *tribo_modal_keep(struct modal_build *b, size_t count)
{
    return tribo_modal_take(&b->h->memory, &b->h->bytes, count, sizeof(double));
}

int tribo_modal_keep_all(struct modal_build *b, size_t arrays, double **const *array, const size_t *count)
{
    size_t all = 0;
    for (size_t k = 0; k < arrays; k++) {
        all += count[k];
    }
    double *numbers = tribo_modal_keep(b, all);
    for (size_t k = 0; numbers && k < arrays; k++) {
        *array[k] = numbers;
        numbers += count[k];
    }
    return numbers != NULL;
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
    return tribo_modal_take(&b->shared->scratch, &ignored, count, sizeof(double));
}

size_t *tribo_modal_scratch_indices(struct modal_build *b, size_t count)
{
    size_t ignored = 0;
    return tribo_modal_take(&b->shared->scratch, &ignored, count, sizeof(size_t));
}

unsigned char *tribo_modal_scratch_bytes(struct modal_build *b, size_t count)
{
    size_t ignored = 0;
    return tribo_modal_take(&b->shared->scratch, &ignored, count, 1);
}

/* ----------------------------------------------------------------------------------------------------- the contacts that hold */

double tribo_modal_shape(const struct modal_build *b, size_t i, size_t k)
{
    const tribo_system *sys = b->shared->sys;
    const size_t held = b->rests + b->springs;
    double sum = tribo_matrix_row_dot(&sys->direction, i, b->phi + k * b->n);
    for (size_t p = b->rests; tribo_is_compliant(&sys->compliance, i) && p < held; p++) {
        sum += tribo_compliance_entry(&sys->compliance, sys->ncontact, i, b->rest[p]) * b->h->held.by_q[k * held + p];
    }
    return sum;
}

void tribo_modal_react(const struct modal_build *b, double *force, double *f)
{
    for (size_t k = 0; k < b->h->modes; k++) {
        tribo_add(force, -tribo_dot(b->phi + k * b->n, force, b->n), b->psi + k * b->n, b->n);
    }
    tribo_constraints_react(&b->ties, force, f);
}
