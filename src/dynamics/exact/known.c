#include "known.h"
#include "modal.h"

#include <stdlib.h>
#include <string.h>

struct modal_piece {
    struct modal_piece *next; /* with the same first degree of freedom */
    struct modal *modal;
    size_t count, key[]; /* [count] */
};

struct modal *tribo_modal_recall(const struct modal_known *known, size_t count, const size_t *key)
{
    const struct modal_piece *p = known->piece[key[1]];
    while (p && (p->count != count || memcmp(p->key, key, count * sizeof *key) != 0)) {
        p = p->next;
    }
    return p ? p->modal : NULL;
}

int tribo_modal_remember(struct modal_known *known, size_t count, const size_t *key, struct modal *modal)
{
    const size_t bytes = sizeof(struct modal_piece) + count * sizeof *key;
    struct modal_piece *p = malloc(bytes);
    if (!p) {
        tribo_modal_free(modal);
        return TRIBO_ERR_MEMORY;
    }
    p->modal = modal;
    p->count = count;
    memcpy(p->key, key, count * sizeof *key);
    p->next = known->piece[key[1]];
    known->piece[key[1]] = p;
    known->bytes += bytes + modal->bytes;
    return TRIBO_OK;
}

void tribo_modal_forget(struct modal_known *known)
{
    for (size_t d = 0; known->piece && d < known->lists; d++) {
        for (struct modal_piece *p = known->piece[d]; p;) {
            struct modal_piece *next = p->next;
            tribo_modal_free(p->modal);
            free(p);
            p = next;
        }
        known->piece[d] = NULL;
    }
    known->bytes = 0;
}
