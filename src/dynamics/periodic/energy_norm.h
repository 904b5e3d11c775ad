/* Coordinates of a state in which its length is the root of twice its energy: amplitudes of the modes of the free structure times
 * their frequencies, and the rates of these. Two motions of a structure with Coulomb friction and no negative damping or
 * stiffness never come further apart in it, whatever they do: forces of friction against each other do no work. What has no mass
 * has energy of springs only: there velocities do not count. */
#ifndef TRIBO_ENERGY_NORM_H
#define TRIBO_ENERGY_NORM_H

#include "dynamics/system/system.h"

struct energy_norm {
    size_t n;
    double *phi;   /* [n][n] a mode in a column */
    double *psi;   /* [n][n] phi'M, what has no mass having some: inverse of phi */
    double *rate;  /* [n][n] phi'M; the same, if all has mass */
    double *natural; /* [n] frequencies, */
    double *damping; /* [n] damping of the modes, without what they share, */
    double *omega;   /* [n] none below a small one */
};

/* Returns TRIBO_OK, or TRIBO_ERR_MEMORY or
 * TRIBO_ERR_NOT_FINITE with a message on the system's context. tribo_energy_norm_free takes what failed too. */
int tribo_energy_norm_create(struct energy_norm *e, const tribo_system *sys);
void tribo_energy_norm_free(struct energy_norm *e);

/* Of the system as it is: the damping; and 1 if no mode is without. */
void tribo_energy_norm_set_damping(struct energy_norm *e, const tribo_system *sys);
int tribo_energy_norm_is_damped(const struct energy_norm *e);

/* least > 0: the frequency that slower modes count with. */
void tribo_energy_norm_set_least(struct energy_norm *e, double least);

/* x [2n][columns] of states y [2n][columns], and back; x and y are different. */
void tribo_energy_norm_of(const struct energy_norm *e, size_t columns, const double *y, double *x);
void tribo_energy_norm_state(const struct energy_norm *e, size_t columns, const double *x, double *y);

#endif
