/* A structure on its way from the caller's matrices to a system. */
#ifndef TRIBO_MODEL_H
#define TRIBO_MODEL_H

#include "system.h"

/* What a caller gives, and where the text of an error goes. */
struct model {
    size_t ndof, ncontact, nmode;
    struct matrix mass, damping, stiffness, direction;
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

/* structure.c: builds the system, and frees the matrices of the model in any case. */
int tribo_model_build(struct model *m, tribo_system **sys);
void tribo_model_free(struct model *m);

/* The Cholesky factor of the mass matrix, or an error. */
int tribo_model_factorize(const struct model *m, struct cholesky *c);

/* Gives the context R = Z'Z, Z [n][ncontact], which is as symmetric and semidefinite as rounding lets it be. */
int tribo_model_set_operator(const struct model *m, tribo_system *sys, double *z, size_t n);

/* reduction.c: the system of the lowest nmode modes. */
int tribo_model_reduce(struct model *m, tribo_system **sys);

#endif
