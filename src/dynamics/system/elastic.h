/* Elastic contacts, as the state tells of them. With w for what has no mass and q for the others, the force of one is
 *     f = (J w - J follow q)/compliance,
 * and w' = follow q' + give f' as w = follow q + give f: where it slides f' = 0, and where it holds J w' + J q' = b. */
#ifndef TRIBO_ELASTIC_H
#define TRIBO_ELASTIC_H

#include "system.h"

/* force [ncontact] of the elastic contacts in places q [ndof], and size [ncontact] of the terms that these come from, or NULL.
 * Those of the others stay as they are. work [ndof]. */
void tribo_elastic_forces(const tribo_system *sys, const double *q, double *work, double *force, double *size);

/* w = follow q + give f, in x [ndof]; of f [ncontact] only those of elastic contacts count. */
void tribo_elastic_give(const tribo_system *sys, const double *f, double *x);

/* w' in u [ndof], and rate [ncontact] = f': elastic contacts with slip 0 hold, the others slide. */
void tribo_elastic_move(const tribo_system *sys, const signed char *slip, const double *base, double *u, double *rate);

/* For a motion that begins with y [2 ndof + 1]: force as above; but sliders that are beyond their limits [ncontact] go back to
 * them, and dissipate limit times way. All that has no mass then stands where it belongs. */
void tribo_elastic_enter(const tribo_system *sys, const double *limit, double *work, double *force, double *y);

/* Perturbations v [2 ndof][columns] of a state in which contacts do that: forces of those that slide stay what they are. What has
 * no mass has no velocity of its own, and its rows of these become 0. work [2 ndof + ncontact]. */
void tribo_elastic_perturb(const tribo_system *sys, const signed char *slip, size_t columns, double *v, double *work);

#endif
