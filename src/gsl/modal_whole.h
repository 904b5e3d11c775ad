/* What the decompositions of one structure with contacts held share; and the part of it that they have to look at.
 *
 * A contact with one degree of freedom, which no other one holds, takes that out: it moves as the base does, whatever the others
 * do, and parts the structure as a wall does. What stands behind the walls, is not loaded and has no moving base does nothing and
 * carries what it carried: modes, responses and forces are sought in the rest, as if that were all there is. */
#ifndef TRIBO_MODAL_WHOLE_H
#define TRIBO_MODAL_WHOLE_H

#include "system.h"

struct modal_whole {
    tribo_system *sys;
    const struct matrix *stiffness, *damping;   /* K and C, or NULL */
    struct matrix own_stiffness, own_damping;   /* where the system has only AK and AC */
    size_t *first, *beside;                     /* [ndof + 1], [..] who shares an entry of K, C or M with whom */
    size_t *alone;                              /* [ncontact] the only degree of freedom of a contact; ndof if it has others */
    unsigned char *always;                      /* [ndof] loaded, moved by a base, or beside such a one */
    void *scratch;                              /* memory for the next decomposition */
};

/* Returns a status; its message is on the system's context. tribo_modal_whole_free takes what failed, and zeros, too. */
int tribo_modal_whole_create(struct modal_whole *w, tribo_system *sys);
void tribo_modal_whole_free(struct modal_whole *w);

#endif
