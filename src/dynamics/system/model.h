/* SPDX-License-Identifier: BSD-3-Clause */
/* The matrices of a structure, from which systems are built. */
#ifndef TRIBO_MODEL_H
#define TRIBO_MODEL_H

#include "system.h"

/* The caller's matrices. */
struct tribo_model {
    size_t ndof, ncontact, nmode; /* nmode: number of modes of a reduced system; 0: not reduced */
    int attachments;              /* 1: attachment modes: static responses to contact forces in addition to the modes */
    int flexible;                 /* 1: residual flexibility: the compliance that the modes lack at contacts */
    struct matrix mass, damping, stiffness, direction;
    double *compliance;          /* [ncontact] compliance of springs before sliders; 0: rigid contact; NULL: all rigid */
    size_t normals;              /* number of contacts with a normal */
    struct normal_input *normal; /* [normals] */
    char *message;               /* [TRIBO_MESSAGE] text of the last error; NULL: none */
};

int tribo_model_no_memory(const tribo_model *m);
int tribo_model_too_large(const tribo_model *m); /* for builds without sparse factors */

/* structure.c: builds the system of finite matrices. Frees the matrices of the model, also after an error. Returns a status;
 * writes the message of TRIBO_ERR_MEMORY, of the functions below, too. */
int tribo_model_build(tribo_model *m, tribo_system **sys);
void tribo_model_free(tribo_model *m);

/* c = Cholesky factor of the mass matrix. Returns a status. */
int tribo_model_factorize(const tribo_model *m, struct cholesky *c);

/* structure.c: builds a system of degrees of freedom that have mass, nmode > 0: of modes, from checked matrices. Contacts with
 * soft [ncontact] > 0 (NULL: none) have no part in R and M^-1 J'. Returns a status; after an error tribo_model_build destroys
 * *sys. */
int tribo_model_build_massive(tribo_model *m, const double *soft, tribo_system **sys);

/* structure.c: returns TRIBO_OK if a is symmetric to rounding, or has no rows; else TRIBO_ERR_NOT_SYMMETRIC. The message names
 * the entries and ends with `why`. */
int tribo_model_check_symmetric(const tribo_model *m, const char *name, const struct matrix *a, const char *why);

/* condense.c: builds the system of the degrees of freedom with mass, from checked matrices; the others, and the sliders of
 * contacts with springs, become its expansion. Returns a status. */
int tribo_model_condense(tribo_model *m, tribo_system **sys);

/* reduction.c: builds the system of the lowest nmode modes. Returns a status. */
int tribo_model_reduce(tribo_model *m, tribo_system **sys);

/* Basis of a reduced system: vectors orthonormal in M and orthogonal in K. */
struct reduced {
    size_t count;
    double *omega2, *phi; /* [count] ascending, owns the memory of all; [count][ndof] */
    struct truncation truncation;
    double *residual;    /* [ncontact][ndof] static displacements by unit contact forces, without the part of the modes */
    double *flexibility; /* [ncontact][ncontact] residual at contacts; both NULL without residual flexibility */
};

/* low_modes.c: finds the lowest nmode modes, and attachment modes or residual flexibility. Allocates r, also after an error. */
int tribo_model_find_modes(const tribo_model *m, struct reduced *r);

#endif
