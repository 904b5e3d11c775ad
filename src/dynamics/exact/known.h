/* Parts of a structure whose modes are known, each by its own degrees of freedom and its contacts: they decide all there is to
 * know of it. */
#ifndef TRIBO_MODAL_KNOWN_H
#define TRIBO_MODAL_KNOWN_H

#include <stddef.h>

struct modal;
struct modal_piece;

struct modal_known {
    struct modal_piece **piece; /* [lists] by the first degree of freedom; the array is its user's */
    size_t lists, bytes;        /* bytes: of all that is known */
};

/* The modes of the part with this key [count], whose key[1] is the first of its degrees of freedom; NULL if it is not known. */
struct modal *tribo_modal_recall(const struct modal_known *known, size_t count, const size_t *key);

/* Keeps the modes of a part, and owns them also on failure. Returns a status. */
int tribo_modal_remember(struct modal_known *known, size_t count, const size_t *key, struct modal *modal);
void tribo_modal_forget(struct modal_known *known);

#endif
