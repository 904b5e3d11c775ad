#include "modal_parts.h"

#include <stdlib.h>
#include <string.h>

/* Zeroed memory that belongs to a list. NULL if there is none left. */
static void *take(void **list, size_t *bytes, size_t count, size_t size)
{
    void **block = calloc(1, sizeof *block + (count + 1) * size);
    if (!block) {
        return NULL;
    }
    *block = *list;
    *list = block;
    *bytes += (count + 1) * size;
    return block + 1;
}

void tribo_modal_give_back(void *list)
{
    while (list) {
        void *next = *(void **)list;
        free(list);
        list = next;
    }
}

double *tribo_modal_keep(struct modal_build *b, size_t count)
{
    return take(&b->h->memory, &b->h->bytes, count, sizeof(double));
}

size_t *tribo_modal_keep_indices(struct modal_build *b, size_t count)
{
    return take(&b->h->memory, &b->h->bytes, count, sizeof(size_t));
}

unsigned char *tribo_modal_keep_bytes(struct modal_build *b, size_t count)
{
    return take(&b->h->memory, &b->h->bytes, count, 1);
}

struct output *tribo_modal_keep_outputs(struct modal_build *b, size_t count)
{
    return take(&b->h->memory, &b->h->bytes, count, sizeof *b->h->output);
}

struct forcing *tribo_modal_keep_forcing(struct modal_build *b, size_t count)
{
    return take(&b->h->memory, &b->h->bytes, count, sizeof *b->h->forcing);
}

double *tribo_modal_scratch(struct modal_build *b, size_t count)
{
    size_t ignored = 0;
    return take(&b->scratch, &ignored, count, sizeof(double));
}

size_t *tribo_modal_scratch_indices(struct modal_build *b, size_t count)
{
    size_t ignored = 0;
    return take(&b->scratch, &ignored, count, sizeof(size_t));
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
