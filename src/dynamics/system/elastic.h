/* Elastic contacts, as the state determines them. With w for what has no mass and q for the others, their forces are
 *     f = C^-1 (J w - J follow q),
 * and w' = follow q' + give f' as w = follow q + give f: f' = 0 of sliding contacts, and J w' + J q' = b of those that hold. */
#ifndef TRIBO_ELASTIC_H
#define TRIBO_ELASTIC_H

#include "system.h"

/* TRIBO_OK; or, with its message on the context, TRIBO_ERR_UNSUPPORTED if a contact is so stiff beside the structure and its loads
 * that the rounding of places hides its force. */
int tribo_elastic_check(const tribo_system *sys);

/* force [ncontact] of the elastic contacts in places q [ndof], 0 of the others, and size [ncontact] of the terms that these come
 * from, or NULL. work [ndof]. */
void tribo_elastic_forces(const tribo_system *sys, const double *q, double *work, double *force, double *size);

/* force [ncontact], way in, bounds of the sizes of forces out: |C^-1| way of the elastic contacts, 0 of the others. */
void tribo_elastic_sizes(const tribo_system *sys, double *force);

/* force [ncontact] by which elastic contacts with slip 0 answer displacements q [ndof], the forces of the others being constant: 0
 * for these. work [ndof]. */
void tribo_elastic_answer(const tribo_system *sys, const signed char *slip, const double *q, double *work, double *force);

/* Takes force [ncontact] of elastic contacts back within limits [ncontact], as their sliders slide back. Returns what that
 * dissipates. */
double tribo_elastic_bound(const tribo_system *sys, const double *limit, double *force);

/* w = follow q + give f, in x [ndof]; of f [ncontact] only those of elastic contacts count. */
void tribo_elastic_give(const tribo_system *sys, const double *f, double *x);

/* w' in u [ndof], and rate [ncontact] = f': elastic contacts with slip 0 hold, the others slide. */
void tribo_elastic_move(const tribo_system *sys, const signed char *slip, const double *base, double *u, double *rate);

/* For a motion that begins with y [2 ndof + 1]: force as above; but sliders that are beyond their limits [ncontact] go back to
 * them, and dissipate limit times way. All that has no mass then stands where it belongs. */
void tribo_elastic_enter(const tribo_system *sys, const double *limit, double *work, double *force, double *y);

/* A force is known to this part of what it is the sum of; it may go beyond its limit by so many times that. */
#define TRIBO_SPRING_NOISE 2e-14
#define TRIBO_SPRING_ALLOWED 8.0

/* v [n] of elastic contacts, in which none of the forces of c changes, become those with the rates of these forces: within c->lo
 * and c->hi, and 0 of contacts whose force changes. */
void tribo_elastic_share_rates(struct definite *c, double *v);

/* The velocities w' in the methods' state y, at the time set: where the force of its contact is at the limit and the slider goes
 * with it, that of sliding; else that of the base. */
void tribo_elastic_set_velocities(tribo_system *sys, double *y);

/* Perturbations v [2 ndof][columns] of a state in which contacts do that: forces of those that slide stay what they are. What has
 * no mass has no velocity of its own, and its rows of these become 0. work [ncontact][columns]. */
void tribo_elastic_perturb(const tribo_system *sys, const signed char *slip, size_t columns, double *v, double *work);

#endif
