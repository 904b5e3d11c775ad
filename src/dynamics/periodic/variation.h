/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivative of a motion by its initial state, along events. The columns of v [n], n = tribo_system_energy(sys), are
 * perturbations of the state.
 *
 * In a phase v moves as the structure without loads and without sliding contacts; contacts at rest are held: the part of v that
 * would move a contact at rest is removed. At an event a quantity g of a contact crosses zero: v_i of a sliding contact that
 * stops or reverses, or f_i - limit_i of a contact at rest with a static limit that drops at once. A perturbed motion is earlier
 * by dg/g', so that the jump of q'' acts earlier: S = I + (q''+ - q''-) (dg/dstate)/g'. If a contact breaks away without a static
 * limit, and for elastic contacts, forces are continuous, and S = I; but where an elastic contact breaks away and others, coupled
 * to it by G, stop, f' jumps likewise: S = I + (f'+ - f'-) (df_i/dstate)/f_i'.
 *
 * The force of a sliding planar contact turns with its velocity, which the method of the motion takes into account. Where it
 * stops g = f'v, f its force before, the acceleration is that of the phase before, and the jump is that of both directions.
 *
 * Where a normal lifts off or touches down, q'' is continuous, and f' of elastic contacts jumps: 
 *     S = I + (f'+ - f'-) J_n/(J_n q').
 *
 * If several quantities cross zero at one instant by coincidence, contacts are divided into groups that pass no forces to each
 * other, and each group makes the jump of its own forces. There is no derivative, because the order of the crossings matters, if
 * in a group they come apart in perturbed motions and a contact slides afterwards, or if the jump of one group changes g' of
 * another. Coupled contacts count as crossing at one instant if rounding may change the order of their crossings. */
#ifndef TRIBO_VARIATION_H
#define TRIBO_VARIATION_H

#include "dynamics/events/events.h"

/* A phase, or a jump [q'', f'] += column (row + lift times the derivative of the limit of contact). */
struct derivative_step {
    void *phase; /* of motion->keep; NULL: not kept */
    double tau;
    signed char *slip; /* [ncontact + normals] slip in the phase, then 1 for pressed normals; NULL: a jump */
    double *jump;      /* row [n], column [n - ndof] */
    size_t contact;
    double lift;
};

/* Perturbations [columns] that are derivatives by parameters: rise [ncontact][columns] of limits; moves [2][columns]: inertia,
 * then damping, as of struct source, or NULL. */
struct parameters {
    const double *rise, *moves;
};

/* The derivative as steps; applied to a few perturbations, or to n units for the matrix. */
struct derivative {
    struct events *events;
    const tribo_system *sys;
    size_t steps, room;
    struct derivative_step *step;
    size_t torn, other; /* two contacts because of which there is no derivative; ncontact: there is one */
    double *matrix;     /* [n][n] in coordinates of the energy norm (period_map.h); NULL until computed */
};

/* Removes all steps and the matrix; free: takes a zeroed d. */
void tribo_derivative_free(struct derivative *d);

/* Moves perturbations v [n][columns] by the steps from `first` on. p: NULL, or parameters by which v are derivatives; unless
 * p->moves = NULL these steps have no phase but that which ends, the motion of which is the source. Returns a status, its message
 * on the system's context. */
int tribo_derivative_apply(const struct derivative *d, size_t first, size_t columns, double *v, const struct parameters *p);

/* Returns 1 if a contact is at rest in all phases. */
int tribo_derivative_rests(const struct derivative *d);

/* Returns the time of the middle of the longest phase. */
double tribo_derivative_middle(const struct derivative *d);

struct variation {
    tribo_system *sys;
    struct derivative *to;       /* of the motion so far */
    size_t columns;              /* at most those of create */
    double *v;                   /* [n][columns] perturbations after the first `applied` steps of `to` */
    const struct parameters *by; /* parameters by which v are derivatives, set after begin, or NULL */
    size_t applied;              /* all steps, if phases are not kept, and with parameters */
    int status;                  /* of a failure in an event, its message on the system's context */

    /* at the end of a phase */
    const signed char *before; /* [ncontact + normals] slip in the phase, then 1 for pressed normals, of `to` */
    double *acceleration;      /* [ndof] q'' */
    double *force;             /* [ncontact] friction forces */
    double *rate;              /* [ncontact] v' */
    double *spring_rate;       /* [ncontact] f' of elastic contacts */
    size_t uncertain;          /* a contact in a plane that slides in a direction which is not known; ncontact: none */

    /* crossings, at most one a contact: of static limits, found before the decision, then of velocities */
    size_t count;
    size_t *contact; /* [ncontact] contact of crossing k */
    double *row;     /* [ncontact][n] (dg/dstate)/g': perturbed motions are earlier by row v */
    size_t *group;   /* [ncontact] 1, 2, ...: groups of contacts; 0: none */
    double clock;    /* time since begin */
    double *crossed; /* [ncontact] clock of the last crossing; -HUGE_VAL: none */

    double *a, *f;          /* [ncontact] workspace */
    double *change, *delay; /* [n - ndof], [2 columns] workspace */
};

/* Returns 1, or 0 if out of memory. columns: the most. Call tribo_variation_free also after a failure. */
int tribo_variation_create(struct variation *x, tribo_system *sys, size_t columns);
void tribo_variation_free(struct variation *x);

/* Call begin before a motion of e. v [n][columns]: perturbations that decide whether contacts stop at one time. `to`, of which
 * all steps are removed: the steps of the motion are appended to it: by tribo_variation_phase for a phase that lasted tau and
 * ended in the state y, before the decision (returns a status), and by tribo_variation_event after the decision at an event. */
void tribo_variation_begin(struct variation *x, struct events *e, const double *v, size_t columns, struct derivative *to);
int tribo_variation_phase(struct variation *x, double tau, double t, const double *y);
void tribo_variation_event(struct variation *x);

/* row [n] = derivative of c'[q', q''], c [2 ndof], by the state, contacts at rest held as at the end of the motion of e. Uses
 * acceleration, a and f. Returns a status. */
int tribo_variation_rate_row(struct variation *x, struct events *e, const double *c, double *row);

#endif
