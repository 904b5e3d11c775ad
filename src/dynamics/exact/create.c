/* A structure with contacts held: put together from its parts, or, where it has only one or they depend on each other, as a
 * whole. */
#include "parts.h"

#include <stdlib.h>

/* What a set is known by. */
static int find_key(struct modal_build *b, const signed char *slip, const unsigned char *holds)
{
    const size_t contacts = b->whole->sys->ncontact;
    signed char *key = b->h->key = (signed char *)tribo_modal_keep_bytes(b, contacts);
    for (size_t i = 0; key && i < contacts; i++) {
        key[i] = (signed char)((slip[i] == 0) + holds[i]);
    }
    return key != NULL;
}

/* Divides the structure, and says whether that leaves several parts, or one that is not all of it. */
static int falls_apart(struct modal_whole *w, const unsigned char *holds)
{
    if (!w->divides) {
        return 0;
    }
    tribo_modal_divide(w, holds);
    return w->parts != 1 || w->first_own[1] < w->sys->ndof;
}

static int build_whole(struct modal_build *b, const unsigned char *holds)
{
    tribo_modal_take_all(b->whole, holds);
    const int status = tribo_modal_list(b, 0, holds) ? tribo_modal_build(b, holds) : TRIBO_ERR_MEMORY;
    tribo_modal_unlist(b);
    tribo_modal_empty(&b->whole->scratch);
    return status;
}

static int build(struct modal_build *b, const unsigned char *holds)
{
    if (falls_apart(b->whole, holds)) {
        const int status = tribo_modal_from_pieces(b, holds);
        if (status || b->whole->divides) {
            return status;
        }
    }
    return build_whole(b, holds);
}

int tribo_modal_create(struct modal **modal, struct modal_whole *whole, const signed char *slip, const unsigned char *holds)
{
    struct modal_build b = {.whole = whole, .h = tribo_modal_alloc()};
    const int status = b.h && find_key(&b, slip, holds) ? build(&b, holds) : TRIBO_ERR_MEMORY;
    if (status) {
        tribo_modal_free(b.h);
        return status == TRIBO_ERR_MEMORY
                   ? tribo_system_fail(whole->sys, status, "out of memory for the modes of a held structure")
                   : status;
    }
    *modal = b.h;
    return TRIBO_OK;
}
