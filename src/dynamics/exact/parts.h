/* What is needed only while a structure with contacts held is built (create.c), and what the parts of that share. */
#ifndef TRIBO_MODAL_PARTS_H
#define TRIBO_MODAL_PARTS_H

#include "numerics/constraint.h"
#include "modal.h"

/* Vectors are [ndof], modes [modes][ndof]. */
struct modal_build {
    struct modal_shared *shared;
    size_t n; /* ndof */
    struct modal *h;
    const signed char *slip;           /* [ncontact] */
    size_t rests, springs, *rest;      /* [rests + springs] the rigid contacts that hold, and the compliant ones at rest */
    struct constraints ties;           /* between degrees of freedom, by the rigid contacts that hold */
    const struct matrix *stiffness;    /* K + J_A' G_AA^-1 J_A, A the compliant contacts at rest */
    struct matrix own_stiffness;       /* memory of it, if A is not empty */
    size_t rates;                      /* ncontact, if A is not empty, else 0 */
    double *rate_r, *rate_i, *rate_0;  /* [given][rates], [rates] f' of A by bases; by those of constant speed */
    double *phi, *psi, *k_phi, *c_phi; /* and M phi, K phi, C phi */
    double *yr, *yi;                   /* [given][ndof] */
    double *y0;                        /* [ndof] velocities from belts of constant speed, */
    int steady;                        /* if there are any */
    int status;                        /* of a failure other than of memory */
};

/* build.c: fills b->h, which is zero but for its key. Returns a status. */
int tribo_modal_build(struct modal_build *b, const unsigned char *holds);

/* A structure of zeros, or NULL if out of memory; tribo_modal_free takes both. */
struct modal *tribo_modal_alloc(void);

/* Zeroed memory that the structure keeps, or that is freed when it is built; tribo_modal_keep_all for several arrays of so many
 * numbers. NULL, or 0, if there is none left. */
double *tribo_modal_keep(struct modal_build *b, size_t count);
int tribo_modal_keep_all(struct modal_build *b, size_t arrays, double **const *array, const size_t *count);
size_t *tribo_modal_keep_indices(struct modal_build *b, size_t count);
unsigned char *tribo_modal_keep_bytes(struct modal_build *b, size_t count);
struct output *tribo_modal_keep_outputs(struct modal_build *b, size_t count);
struct forcing *tribo_modal_keep_forcing(struct modal_build *b, size_t count);
double *tribo_modal_scratch(struct modal_build *b, size_t count);
size_t *tribo_modal_scratch_indices(struct modal_build *b, size_t count);
unsigned char *tribo_modal_scratch_bytes(struct modal_build *b, size_t count);
void *tribo_modal_take(void **list, size_t *bytes, size_t count, size_t size); /* of a list, and adds to its bytes */
void tribo_modal_give_back(void *list);
void tribo_modal_empty(void **list); /* what is on the list is nobody's, but it may keep a block for what comes */

/* J_i phi_k. */
double tribo_modal_shape(const struct modal_build *b, size_t i, size_t k);

/* f [rests] = the forces J_I'f = force [ndof] of the contacts that hold. Takes out of force first what moves the modes. */
void tribo_modal_react(const struct modal_build *b, double *force, double *f);

/* pull [ndof] += by J'rate, rate [ncontact] of the compliant contacts at rest. */
void tribo_modal_add_springs(const struct modal_build *b, double by, const double *rate, double *pull);

/* The exponents of eta. Returns a status. */
int tribo_modal_exponents(struct modal_build *b);

/* These return 0 if out of memory, or with the status of another failure in b; tribo_modal_hold: by_q and by_u. */
int tribo_modal_hold(struct modal_build *b);
int tribo_modal_forcing(struct modal_build *b);
int tribo_modal_response(struct modal_build *b);
int tribo_modal_outputs(struct modal_build *b);

#endif
