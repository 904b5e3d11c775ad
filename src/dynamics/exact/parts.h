/* SPDX-License-Identifier: BSD-3-Clause */
/* Data and functions for building a structure with contacts held, shared by several files. */
#ifndef TRIBO_MODAL_PARTS_H
#define TRIBO_MODAL_PARTS_H

#include "modal.h"

struct modal_build {
    tribo_system *sys;
    struct modal *h;
    struct forced *forced;
    const signed char *slip, *key;   /* [ncontact] */
    int powers;                      /* 1: no modes */
    const struct modal *like;        /* of tribo_modal_create; NULL if a rigid contact holds */
    struct modal_store scratch;      /* workspace until the structure is built */
    const struct matrix *k, *c;      /* K with pressed normals; C, or NULL without damping */
    const struct matrix *stiffness;  /* (K + K')/2 + J_A' G_AA^-1 J_A, A: compliant contacts that hold */
    struct matrix own_stiffness;     /* memory of stiffness if A is not empty, or K not symmetric */
    struct matrix pressed_stiffness; /* memory of k if a normal is pressed */
    int follows;                     /* 1: a contact slides at a limit that follows the motion, or K is not symmetric */
    double *push; /* [modes] force on the modes by the shape that tribo_modal_effects was called with last; if follows */
    double *shape, *inertia; /* [n][modes] Phi' and M Phi', of the degrees of freedom within */
    double *full;            /* [modes][ndof] modes */
    double complex *direct;  /* [harmonics][rests] forces of the rigid contacts that hold, by loads and limits at fixed eta */
    int status;              /* of a failure other than out of memory; else 0 */
};

/* Sets the exponents of eta, and a, b, r, owner. Returns a status. */
int tribo_modal_exponents(struct modal_build *b);

/* work [modes][columns] = -Phi'force, force [][columns] += M Phi work; then f [rests][columns]: J_I'f = force, I: the rigid
 * contacts that hold. rows: first and end of the degrees of freedom of force. */
void tribo_modal_react(const struct modal *h, const size_t *rows, size_t columns, double *force, double *f, double *work);

/* Sets on, in J y, and by_u or NULL, [ncontact][columns] by displacements y [n][columns], with J_I y = b_I, and inertia = M y,
 * of modes within, else of all degrees of freedom:
 * contacts that hold: force per eta, J_I'f = K y - inertia omega2 - J_A'f_A (A: compliant ones, f_A' = -G_AA^-1 (J_A y - b_A),
 * and those that slide at limits that follow), and per eta', J_I'f = C y; normals: N per eta; other contacts: velocity per eta'.
 * base [ncontact] = b, of one column, by which only the rest of the forces beside the modes counts; NULL: y are the modes, 0.
 * Sets b->scratch.failed = 1 if out of memory. */
void tribo_modal_effects(struct modal_build *b, size_t columns, const double *y, const double *inertia, const double *omega2,
                         const double *base, double *on, double *by_u);

/* rate [ncontact][columns] = rates of the forces of springs that hold, and of contacts that slide, by slide [ncontact][columns],
 * at velocities v; v as in tribo_compliance_rates. */
void tribo_modal_rates(const struct modal_build *b, size_t columns, const double *slide, double *v, double *rate);

/* Fill b->forced: shapes, forcing and response; then terms and outputs. Return 1; 0 if out of memory, or on another failure, with
 * b->status set. */
int tribo_forced_respond(struct modal_build *b);
int tribo_forced_outputs(struct modal_build *b);

/* follow.c. press: sets follows, and k with pressed normals. couple: sets stiff and give. ramps: sets constant from ramp. Return
 * 1; 0 if out of memory, or on another failure, with b->status set. */
int tribo_follow_press(struct modal_build *b);
int tribo_follow_couple(struct modal_build *b);
int tribo_follow_ramps(struct modal_build *b);

/* Returns a bound of the |lambda| of a structure without modes. */
double tribo_powers_fastest(const struct modal *h);

#endif
