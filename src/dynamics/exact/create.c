/* Creates structures with contacts held, and the data that structures share. */
#include "parts.h"

#include <stdlib.h>
#include <string.h>

void tribo_modal_shared_free(struct modal_shared *shared)
{
    tribo_matrix_free(&shared->own_stiffness);
    tribo_matrix_free(&shared->own_damping);
    tribo_modal_give_back(shared->scratch);
    memset(shared, 0, sizeof *shared);
}

/* Returns K or C: given, if given has rows; else accelerates, if M = 1; else own = M accelerates. NULL if out of memory. */
static const struct matrix *force_matrix(const tribo_system *sys, const struct matrix *given, const struct matrix *accelerates,
                                         struct matrix *own)
{
    if (given->rows || !sys->mass.rows) {
        return given->rows ? given : accelerates;
    }
    double *mass = malloc(sys->ndof * sizeof *mass);
    for (size_t d = 0; mass && d < sys->ndof; d++) {
        mass[d] = tribo_matrix_get(&sys->mass, d, d);
    }
    const int done = mass && tribo_matrix_copy(own, accelerates);
    if (done) {
        tribo_matrix_scale_rows(own, mass);
    }
    free(mass);
    return done ? own : NULL;
}

int tribo_modal_shared_create(struct modal_shared *shared, tribo_system *sys)
{
    *shared = (struct modal_shared){.sys = sys};
    shared->stiffness = force_matrix(sys, &sys->k, &sys->stiffness, &shared->own_stiffness);
    shared->damping = sys->damping.rows ? force_matrix(sys, &sys->c, &sys->damping, &shared->own_damping) : NULL;
    if (shared->stiffness && (shared->damping || !sys->damping.rows)) {
        return TRIBO_OK;
    }
    tribo_modal_shared_free(shared);
    return tribo_system_fail(sys, TRIBO_ERR_MEMORY, "out of memory for the matrices of a structure to be held");
}

int tribo_modal_create(struct modal **modal, struct modal_shared *shared, const signed char *slip, const unsigned char *holds)
{
    const size_t contacts = shared->sys->ncontact;
    struct modal_build b = {.shared = shared, .n = shared->sys->ndof, .h = tribo_modal_alloc(), .slip = slip};
    signed char *key = b.h ? (signed char *)tribo_modal_keep_bytes(&b, contacts) : NULL;
    for (size_t i = 0; key && i < contacts; i++) {
        key[i] = (signed char)((slip[i] == TRIBO_SLIP_STUCK) + holds[i]);
    }
    int status = TRIBO_ERR_MEMORY;
    if (key) {
        b.h->key = key;
        status = tribo_modal_build(&b, holds);
        tribo_modal_empty(&shared->scratch);
    }
    if (status) {
        tribo_modal_free(b.h);
        return status == TRIBO_ERR_MEMORY
                   ? tribo_system_fail(shared->sys, status, "out of memory for the modes of a held structure")
                   : status;
    }
    *modal = b.h;
    return TRIBO_OK;
}
