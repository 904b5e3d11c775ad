/* What is needed only while a modal structure is built (modal_build.c), and what the parts of that share. */
#ifndef TRIBO_MODAL_PARTS_H
#define TRIBO_MODAL_PARTS_H

#include "constraint.h"
#include "modal.h"

/* Vectors of the whole structure: [ndof], modes of it [modes][ndof]. */
struct modal_build {
    tribo_system *sys;
    struct modal *h;
    size_t n;
    size_t *rest;                             /* [h->rest] the contacts that hold */
    struct constraints ties;                  /* and what they tie together */
    const struct matrix *stiffness, *damping; /* K and C, or NULL */
    struct matrix own_stiffness, own_damping; /* where the system has only AK and AC */
    struct matrix slack;               /* [ndof][..] displacements that are free and have no mass: they follow the others, */
    struct cholesky slack_stiffness;   /* by this */
    double *phi, *psi, *k_phi, *c_phi; /* and M phi, K phi, C phi */
    double *yr, *yi;                   /* [given][ndof] */
    double *y0;                        /* [ndof] velocities from belts of constant speed */
    void *scratch;                     /* list of what is freed at the end */
    int status;                        /* of a failure other than of memory */
};

/* Zeroed memory that the structure keeps, or that is freed when it is built. NULL if there is none left. */
double *tribo_modal_keep(struct modal_build *b, size_t count);
size_t *tribo_modal_keep_indices(struct modal_build *b, size_t count);
unsigned char *tribo_modal_keep_bytes(struct modal_build *b, size_t count);
struct output *tribo_modal_keep_outputs(struct modal_build *b, size_t count);
struct forcing *tribo_modal_keep_forcing(struct modal_build *b, size_t count);
double *tribo_modal_scratch(struct modal_build *b, size_t count);
size_t *tribo_modal_scratch_indices(struct modal_build *b, size_t count);
void tribo_modal_give_back(void *list);

/* J_i phi_k. */
double tribo_modal_shape(const struct modal_build *b, size_t i, size_t k);

/* f [rest] = the forces J_I'f = force [ndof] of the contacts that hold. Takes out of force first what moves the modes. */
void tribo_modal_react(const struct modal_build *b, double *force, double *f);

/* modal_slack.c: takes out of the displacements z that constraints allow (without rows: all) those without mass, and lets them
 * follow the others. Returns a status. */
int tribo_modal_condense(struct modal_build *b, struct matrix *z);

/* Lets what has no mass and is free follow displacements y [ndof]. 0 if out of memory. */
int tribo_modal_relax(struct modal_build *b, double *y);

/* The exponents of eta. Returns a status. */
int tribo_modal_exponents(struct modal_build *b);

/* These return 0 if out of memory, or with the status of another failure in b. */
int tribo_modal_forcing(struct modal_build *b);
int tribo_modal_response(struct modal_build *b);
int tribo_modal_outputs(struct modal_build *b);

#endif
