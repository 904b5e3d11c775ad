/* The derivative of the motion by the state that it began with, along events: perturbations of the state in columns.
 *
 * In a phase they move as the structure does without loads and without what slides, contacts at rest being held: a perturbed
 * velocity that would move those is taken away. Where a contact that slides comes to rest or reverses, accelerations jump, for
 * perturbed motions a little earlier or later, by J_i du/v_i': S = I + (q''+ - q''-) J_i/v_i'. Where several do so at once
 * by coincidence, each makes the jump of its force and of those of contacts at rest that it pulls at; but if it passes forces to
 * another one, directly or through these, and any of them slides from there on, the order in which they stop changes when, and
 * there is no derivative. Where one breaks away accelerations are continuous, since the problem that decides about them has one
 * solution: S = I. But not by a static limit that drops at once: there they jump when the force that holds contact i meets it,
 * S = I + (q''+ - q''-) df_i/(limit' - f_i') for a force that rises. Where several forces meet theirs at once by coincidence,
 * each contact makes its own jump, if letting one go leaves the force of the other, and how fast that rises, what they are; else
 * who goes first decides, and there is no derivative, nor where others stop at that instant. Forces of elastic contacts are
 * continuous, too; but once one slides, its force stays, and what has no mass moves by the rest. */
#ifndef TRIBO_VARIATION_H
#define TRIBO_VARIATION_H

#include "derivative.h"

struct variation {
    struct company company;
    struct events *events;
    tribo_system *sys;
    struct derivative *to; /* of the motion so far */
    size_t columns;
    double *v;            /* [2 ndof][columns] perturbations, as the first `applied` steps of that leave them */
    size_t applied;       /* if phases are not kept: all of them */
    int status;           /* of a failure in an event, its message on the system's context */
    double *rows;         /* [ncontact][2 ndof] by how much a perturbation changes velocities where contacts stop */
    double *changes;      /* [ncontact][columns] workspace */
    double *slope;        /* [ncontact] v' where the phase ends, */
    double *acceleration; /* [ndof] and q'' */
    signed char *before;  /* [ncontact] slip in the phase that ends */
    size_t *stopped;      /* [ncontact] the contacts that stop there */
    size_t *group;     /* [ncontact] which of them, and of those at rest, pass forces to each other: 1, 2, ...; 0: none of them */
    size_t *queue;     /* [ncontact] workspace */
    double *force;     /* [ncontact] friction where the phase ends */
    size_t *met;       /* [ncontact] the contacts whose static limits their forces meet there, */
    size_t count;      /* how many they are, */
    signed char *side; /* [ncontact] the signs of these forces, */
    double *pull;      /* [ncontact][2 ndof] by how much a perturbation changes them, in the order of met, */
    double *rise;      /* [ncontact] and how fast they outgrow the limits */
    size_t bond;       /* one of them whose force changes if another one is let go; ncontact: there is none */
    size_t torn, other; /* two contacts that leave the motion without a derivative; ncontact: there are none */
    size_t jumps;       /* of q'' at the event: */
    double *row;        /* [ncontact][2 ndof] by how much earlier it is */
    double *jump;       /* [ndof][ncontact] times this */
    double *column;     /* [3 ndof] workspace; */
    double *a, *f;      /* [ncontact] and this */
};

/* 1, or 0 if out of memory; tribo_variation_free takes what failed too. */
int tribo_variation_create(struct variation *x, struct events *e, tribo_system *sys, size_t columns);
void tribo_variation_free(struct variation *x);

/* Before the motion begins: v [2 ndof][columns]: perturbations that are looked at where contacts stop at one time; steps go
 * `to` a derivative without any. */
void tribo_variation_begin(struct variation *x, const double *v, struct derivative *to);

/* row [columns] = J_i times rows of v, those of displacements (ndof rows) or of velocities. */
void tribo_contact_row(const tribo_system *sys, size_t i, const double *v, size_t columns, double *row);

#endif
