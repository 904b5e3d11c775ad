/* A structure on its way from the caller's matrices to a system. */
#ifndef TRIBO_MODEL_H
#define TRIBO_MODEL_H

#include "system.h"

/* What a caller gives, and where the text of an error goes. */
struct model {
    size_t ndof, ncontact, nmode;
    int statics; /* beside the modes, what steady forces at the contacts do: TRIBO_STATICS_... */
    struct matrix mass, damping, stiffness, direction;
    const double *terms;      /* [ndof] sizes of the terms of which stiffness_ii is the sum; NULL: its own size */
    const double *compliance; /* [ncontact] of the springs before sliders, 0: a rigid contact; NULL: all are rigid */
    size_t sliders;           /* degrees of freedom without mass that stand for them, the last ones of ndof */
    char *message;
    size_t size;
};

/* Writes the message and returns status. */
int tribo_model_fail(const struct model *m, int status, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;
int tribo_model_no_memory(const struct model *m);
int tribo_model_too_large(const struct model *m); /* for a build without sparse factors */

/* structure.c: builds the system, and frees the matrices of the model in any case. */
int tribo_model_build(struct model *m, tribo_system **sys);
void tribo_model_free(struct model *m);

/* The Cholesky factor of the mass matrix, or an error. */
int tribo_model_factorize(const struct model *m, struct cholesky *c);

/* structure.c: the system of all degrees of freedom, of matrices that need no check. */
int tribo_model_build_whole(struct model *m, tribo_system **sys);

/* condense.c: adds a degree of freedom w without mass for each contact with compliance, a spring 1/compliance between w and the
 * displacement of the contact, and lets the contact act on w. Mass and damping have no rows of w. */
int tribo_model_add_sliders(struct model *m);

/* condense.c: a system by build_massive, which knows only degrees of freedom with mass; those without mass are its expansion. */
int tribo_model_condense(struct model *m, int (*build_massive)(struct model *, tribo_system **), tribo_system **sys);

/* Gives the context R = Z'Z, Z [n][ncontact], which is as symmetric and semidefinite as rounding lets it be. */
int tribo_model_set_operator(const struct model *m, tribo_system *sys, const double *z, size_t n);

/* Gives the context R = r. own: as in tribo_hidden; NULL: no check for hidden bodies. */
int tribo_model_give_operator(const struct model *m, tribo_system *sys, const double *r, const double *own);

/* reduction.c: the system of the lowest nmode modes. */
int tribo_model_reduce(struct model *m, tribo_system **sys);

/* What a structure is reduced to: motions that are orthonormal in M and orthogonal in K. */
struct reduced {
    size_t count;
    double *omega2, *phi; /* [count] ascending, [count][ndof] */
    struct truncation truncation;
    double *residual,
        *flexibility; /* [ncontact][ndof] what steady unit forces at contacts do beside the modes, [ncontact][ncontact]
                                       at the contacts; NULL without TRIBO_STATICS_COMPLIANCE */
};

/* low_modes.c: the lowest nmode modes, and if asked for the static ones. Allocates, also on failure. */
int tribo_model_find_modes(const struct model *m, struct reduced *r);
void tribo_reduced_free(struct reduced *r);

#endif
