/* Derivative of a motion by its initial state, along events. The columns of v [n], n = tribo_system_energy(sys), are
 * perturbations of the state.
 *
 * In a phase v moves as the structure without loads and without sliding contacts; contacts at rest are held: the part of v that
 * would move a contact at rest is removed. If a sliding contact i stops or reverses, q'' jumps, in a perturbed motion earlier by
 * J_i du/v_i': S = I + (q''+ - q''-) J_i/v_i'. If several contacts stop at one instant by coincidence, each makes the jump of its
 * own force and of the forces at rest that it changes. But if contact i passes forces to another stopping contact, directly or
 * through contacts at rest, and one of these slides afterwards, the order of stops matters: there is no derivative.
 * If a contact breaks away, q'' is continuous, because the problem that decides slip has one solution: S = I. At a static limit
 * that drops at once, q'' jumps when the holding force f_i meets the limit: S = I + (q''+ - q''-) df_i/(limit' - f_i') for a
 * rising f_i. If several forces do so at one instant by coincidence, each contact makes its own jump, if its release changes
 * neither the other forces nor their rates; else, or if other contacts stop then, the order matters: there is no derivative.
 * Forces of elastic contacts are continuous; if contact i slides, df_i = 0, and massless parts follow from the other df. */
#ifndef TRIBO_VARIATION_H
#define TRIBO_VARIATION_H

#include "derivative.h"

struct variation {
    struct company company;
    struct events *events;
    tribo_system *sys;
    struct derivative *to; /* of the motion so far */
    size_t columns;
    double *v;            /* [n][columns] perturbations after the first `applied` steps of `to` */
    size_t applied;       /* all steps, if phases are not kept */
    int status;           /* of a failure in an event, its message on the system's context */
    double *rows;         /* [ncontact][n] row k: dv_i/dstate, i = stopped[k] */
    double *changes;      /* [ncontact][columns] workspace */
    double *slope;        /* [ncontact] v' at the end of the phase */
    double *acceleration; /* [ndof] q'' at the end of the phase */
    signed char *before;  /* [ncontact] slip in the phase that ends */
    size_t *stopped;      /* [ncontact] contacts that stop at the event */
    size_t *group;     /* [ncontact] 1, 2, ...: group of contacts, stopping or at rest, that pass forces to each other; 0: none */
    size_t *queue;     /* [ncontact] workspace */
    double *force;     /* [ncontact] friction forces at the end of the phase */
    size_t *met;       /* [ncontact] contacts with forces that meet static limits at the end of the phase */
    size_t count;      /* number of contacts in met */
    signed char *side; /* [ncontact] sign of the force of a contact in met, else 0 */
    double *pull;      /* [ncontact][n] row k: d(side f_i)/dstate, i = met[k] */
    double *rise;      /* [ncontact] d(side f_i - limit_i)/dt, contacts in met */
    size_t bond;       /* contact in met with a force that another one changes by its release; ncontact: none */
    size_t torn, other; /* two contacts because of which there is no derivative; ncontact: there is one */
    size_t jumps;       /* number of jumps of q'' at the event */
    double *row;        /* [jumps][n] row k: dt by which jump k comes earlier, per perturbation */
    double *jump;       /* [ndof][ncontact] column k: jump k of q'' */
    double *column;     /* [3 ndof] workspace */
    double *a, *f;      /* [ncontact] workspace */
};

/* Returns 1, or 0 if out of memory. Call tribo_variation_free also after a failure. */
int tribo_variation_create(struct variation *x, struct events *e, tribo_system *sys, size_t columns);
void tribo_variation_free(struct variation *x);

/* Call before the motion begins. v [n][columns]: perturbations that decide whether contacts stop at one time. `to`: a derivative
 * without steps, to which the steps of the motion are appended. */
void tribo_variation_begin(struct variation *x, const double *v, struct derivative *to);

/* row [columns] = J_i v, v [ndof][columns]: the rows of displacements or of velocities of perturbations. */
void tribo_contact_row(const tribo_system *sys, size_t i, const double *v, size_t columns, double *row);

#endif
