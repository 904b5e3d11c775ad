/* What the decompositions of one structure with contacts held share, and how held contacts divide it.
 *
 * A contact with one degree of freedom, which no other one holds, takes that out: it moves as the base does, whatever the others
 * do, and parts the structure as a wall does. What is left falls into parts that know nothing of each other but the forces on the
 * walls, and each of them comes back in many sets: a set of held contacts is put together from parts that are known, and what
 * stands behind walls without a load is not looked at. Where bases move, limits swing, mass is shared or damping couples modes,
 * all that may change is one part. */
#ifndef TRIBO_MODAL_WHOLE_H
#define TRIBO_MODAL_WHOLE_H

#include "known.h"
#include "dynamics/system/system.h"

/* How degrees of freedom move: freely, as the base of the one contact that holds them, or as contacts make them that tie them
 * together, or are too many. */
enum { MOVES_FREELY, MOVES_HELD, MOVES_TIED };

struct modal_whole {
    tribo_system *sys;
    const struct matrix *stiffness, *damping; /* K and C, or NULL */
    struct matrix own_stiffness, own_damping; /* where the system has only AK and AC */
    size_t *first, *beside;                   /* [ndof + 1], [..] who shares an entry of K, C or M with whom */
    size_t *first_contact, *contact;          /* [ndof + 1], [..] the contacts of a degree of freedom */
    size_t *alone;                            /* [ncontact] the only degree of freedom of a contact; ndof if it has others */
    unsigned char *always;                    /* [ndof] what happens there changes forces whatever is held */
    int divides;                              /* whether parts are looked at one by one */

    unsigned char *how;                /* [ndof] of the set that is looked at: MOVES_.. */
    size_t parts, *first_own, *own;    /* its parts, [parts + 1], and the degrees of freedom of each, ascending */
    size_t *root;                      /* [ndof] trees of those that belong together */
    size_t *dof_place, *contact_place; /* [ndof], [ncontact] places in the part that is looked at; others NOWHERE */
    unsigned char *ours;               /* [ndof] 1: is of that part, and not only beside it */

    struct modal_known known; /* parts that have been looked at */
    struct modal_known *structures; /* the caller's, or NULL: what does not depend on loads, of all degrees of freedom */
    struct modal **found;     /* [ndof + 1] those of the set that is looked at */
    void *memory, *scratch;   /* of all arrays; for the next decomposition */
};

#define NOWHERE ((size_t)-1)

/* Returns a status; its message is on the system's context. tribo_modal_whole_free takes what failed, and zeros, too. */
int tribo_modal_whole_create(struct modal_whole *w, tribo_system *sys);
void tribo_modal_whole_free(struct modal_whole *w);

/* Divides the structure with these held into parts; or takes as one part all that moves or feels it. */
void tribo_modal_divide(struct modal_whole *w, const unsigned char *holds);
void tribo_modal_take_all(struct modal_whole *w, const unsigned char *holds);

#endif
