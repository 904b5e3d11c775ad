/* Coordinates of a state in which its length is the root of twice its energy: amplitudes of the modes of the free structure times
 * their frequencies, and the rates of these. Two motions of a structure with Coulomb friction and no negative damping or
 * stiffness never come further apart in it, whatever they do: forces of friction against each other do no work. Forces f of
 * compliant contacts are there by root'f, G = root root': f'G f is twice the energy of their springs. */
#ifndef TRIBO_ENERGY_NORM_H
#define TRIBO_ENERGY_NORM_H

#include "dynamics/system/system.h"

struct energy_norm {
    size_t n;
    double *phi;   /* [n][n] a mode in a column */
    double *psi;   /* [n][n] phi'M: inverse of phi */
    size_t springs;  /* compliant contacts */
    double *root;    /* [springs][springs] lower triangle */
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

/* x [2n + springs][columns] of states y [2n + springs][columns], and back; x and y are different. */
void tribo_energy_norm_of(const struct energy_norm *e, size_t columns, const double *y, double *x);
void tribo_energy_norm_state(const struct energy_norm *e, size_t columns, const double *x, double *y);

#endif
