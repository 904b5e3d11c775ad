/* SPDX-License-Identifier: BSD-3-Clause */
/* The lowest modes of a large structure, K phi = omega^2 M phi, by Lanczos' method in blocks (Grimes, Lewis and Simon 1994,
 * SIAM J. Matrix Anal. Appl. 15, 228, doi:10.1137/S0895479888151111) for shift (K + shift M)^-1 M. Its eigenvalues
 * theta = shift/(omega^2 + shift) are largest for these modes. All vectors are orthogonal in M. A full basis is replaced by its
 * best combinations (Wu and Simon 2000, doi:10.1137/S0895479898334605).
 *
 * Sylvester's law shows that no mode is missed, even if frequencies repeat: K - sigma M has as many negative eigenvalues as there
 * are modes with omega^2 < sigma. If modes are missing, the search restarts with vectors orthogonal to the modes found.
 *
 * ARPACK is not used: ARPACK has one vector instead of a block, and its state is in variables that all threads share. */
#ifndef TRIBO_LANCZOS_H
#define TRIBO_LANCZOS_H

#include "numerics/linalg.h"

#include <stdint.h>

struct low_modes {
    size_t count;  /* modes in phi: the wanted ones, and others close to the last one */
    double *phi;   /* [count][n] ascending omega^2, modal masses 1; freed by the caller */
    double above;  /* value of omega^2 at which modes are counted */
    size_t below;  /* modes with omega^2 < above: those in phi, or all but some of one frequency */
    double growth; /* `below` is certain if growth times the rounding of the stiffness moves no omega^2 across above */
};

/* k, m     [n][n] in   symmetric, m semidefinite
 * shift    in          > 0
 * shifted  in          the factor of K + shift M
 * wanted   in          > 0
 * Returns TRIBO_OK, TRIBO_ERR_MEMORY, TRIBO_ERR_NO_CONVERGENCE, or TRIBO_ERR_SIZE: only found->count modes exist, because the
 * mass matrix is singular. Needs CHOLMOD. */
int tribo_low_modes(const struct matrix *k, const struct matrix *m, double shift, const struct cholesky *shifted, size_t wanted,
                    struct low_modes *found);

/* Makes w [count][n] orthogonal in M to q [size][n], orthonormal in M, twice, because one pass is not exact. mw [count][n]: M W,
 * in and out. c [count][stride] += the coefficients of the parts removed; NULL: not wanted. */
void tribo_separate(const struct matrix *mass, size_t size, const double *q, size_t count, double *w, double *mw, size_t stride,
                    double *c);

/* x [n] = pseudo-random numbers of either sign, 1/2 <= |x_i| <= 1. */
void tribo_scatter(uint64_t *seed, size_t n, double *x);

#endif
