/* Data and functions for building a structure with contacts held (create.c, build.c), shared by several files. */
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
    size_t rests, springs, *rest;      /* [rests + springs] rigid contacts that hold, then compliant contacts at rest */
    struct constraints ties;           /* constraints between degrees of freedom by the rigid contacts that hold */
    const struct matrix *stiffness;    /* K + J_A' G_AA^-1 J_A, A: compliant contacts at rest */
    struct matrix own_stiffness;       /* memory of stiffness if A is not empty */
    size_t rates;                      /* ncontact if A is not empty, else 0 */
    double *rate_r, *rate_i, *rate_0;  /* [given][rates] f' of A by harmonics of bases; rate_0 [rates]: by constant speeds */
    double *phi, *psi, *k_phi, *c_phi; /* phi; M phi; stiffness phi; C phi */
    double *yr, *yi;                   /* [given][ndof] velocities by harmonics of bases */
    double *y0;                        /* [ndof] velocities by bases of constant speed */
    int steady;                        /* 1: a base of constant speed moves a contact that holds */
    int status;                        /* of a failure other than out of memory; else 0 */
};

/* build.c: fills b->h, where only key is set. Returns a status. */
int tribo_modal_build(struct modal_build *b, const unsigned char *holds);

/* Returns a zeroed structure; NULL if out of memory. tribo_modal_free also takes NULL. */
struct modal *tribo_modal_alloc(void);

/* Return zeroed arrays: ..._keep: part of b->h; ..._scratch: workspace until b->h is built. NULL if out of memory.
 * tribo_modal_keep_all sets *array[k] to an array [count[k]], k < arrays; returns 0 if out of memory. */
double *tribo_modal_keep(struct modal_build *b, size_t count);
int tribo_modal_keep_all(struct modal_build *b, size_t arrays, double **const *array, const size_t *count);
size_t *tribo_modal_keep_indices(struct modal_build *b, size_t count);
unsigned char *tribo_modal_keep_bytes(struct modal_build *b, size_t count);
struct output *tribo_modal_keep_outputs(struct modal_build *b, size_t count);
struct forcing *tribo_modal_keep_forcing(struct modal_build *b, size_t count);
double *tribo_modal_scratch(struct modal_build *b, size_t count);
size_t *tribo_modal_scratch_indices(struct modal_build *b, size_t count);
unsigned char *tribo_modal_scratch_bytes(struct modal_build *b, size_t count);
void *tribo_modal_take(void **list, size_t *bytes, size_t count, size_t size); /* *bytes += new blocks */
void tribo_modal_give_back(void *list);
void tribo_modal_empty(void **list); /* frees the arrays; may keep one block of memory for reuse */

/* Returns (J phi_k + G f)_i, f: forces of the compliant contacts at rest per eta_k. */
double tribo_modal_shape(const struct modal_build *b, size_t i, size_t k);

/* force [ndof] -= M phi_k (phi_k'force) for all k; then f [rests]: J_I'f = force, I: the rigid contacts that hold. */
void tribo_modal_react(const struct modal_build *b, double *force, double *f);

/* pull [ndof] += by J_A'rate_A, rate [ncontact], A: compliant contacts at rest. */
void tribo_modal_add_springs(const struct modal_build *b, double by, const double *rate, double *pull);

/* Sets the exponents of eta, and a, b, r, owner. Returns a status. */
int tribo_modal_exponents(struct modal_build *b);

/* Return 1; 0 if out of memory, or on another failure, with b->status set. tribo_modal_hold sets by_q and by_u. */
int tribo_modal_hold(struct modal_build *b);
int tribo_modal_forcing(struct modal_build *b);
int tribo_modal_response(struct modal_build *b);
int tribo_modal_outputs(struct modal_build *b);

#endif
