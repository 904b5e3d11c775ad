/* SPDX-License-Identifier: BSD-3-Clause */
/* Coordinates x of a state with |x|^2 = scale^2 times twice its energy: omega_k eta_k and eta_k', times scale, for modal
 * amplitudes eta of the free structure. If friction is Coulomb's, and no damping or stiffness is negative, the distance |x1 - x2|
 * of two motions under the same drives never grows, because (f1 - f2)'(v1 - v2) <= 0: differences of friction forces do no
 * positive work. Forces f of compliant contacts have the coordinates root'f, G = root root': f'G f is twice the energy of their
 * springs. */
#ifndef TRIBO_ENERGY_NORM_H
#define TRIBO_ENERGY_NORM_H

#include "dynamics/system/system.h"

struct energy_norm {
    size_t n;
    double *phi;     /* [n][n] modes in rows */
    double *psi;     /* [n][n] phi M, psi phi' = 1 */
    size_t springs;  /* number of compliant contacts */
    double *root;    /* [springs][springs] lower triangle, G = root root' */
    double *natural; /* [n] natural frequencies */
    double *damping; /* [n] modal damping, the diagonal of phi C phi' */
    double *omega;   /* [n] max(natural, least) */
    int damped;      /* 1: damping > 0 for every mode */
    double scale;    /* a power of two; 1 except for motions so small or large that squares of their sizes under- or overflow */
};

/* Sets phi, psi, natural, root. Returns a status, its message on the system's context. Call tribo_energy_norm_free also after a
 * failure. */
int tribo_energy_norm_create(struct energy_norm *e, const tribo_system *sys);
void tribo_energy_norm_free(struct energy_norm *e);

/* Sets scale = 1, omega by least > 0, and damping and damped from the present system. */
void tribo_energy_norm_set(struct energy_norm *e, const tribo_system *sys, double least);

/* x [2n + springs][columns] = coordinates of states y [2n + springs][columns], and back, which overwrites x too. */
void tribo_energy_norm_of(const struct energy_norm *e, size_t columns, const double *y, double *x);
void tribo_energy_norm_state(const struct energy_norm *e, size_t columns, double *x, double *y);

/* Linear modes of the structure with contacts that stick, sticks = 1, or slide, and with pressed normals: value [n] = omega^2,
 * ascending; states [n][2n + springs] = displacement q, q'M q = 1, velocity 0, forces of compliant contacts. Returns a status,
 * its message on the system's context. */
int tribo_energy_norm_modes(const struct energy_norm *e, const tribo_system *sys, int sticks, double *value, double *states);

/* Returns |x|, and |a - b|, of coordinates. */
double tribo_energy_length(const double *x, size_t n);
double tribo_energy_distance(const double *a, const double *b, size_t n);

#endif
