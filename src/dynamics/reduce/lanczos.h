/* The lowest modes of a large structure, K phi = omega^2 M phi, by Lanczos' method in blocks (Grimes, Lewis and Simon 1994,
 * SIAM J. Matrix Anal. Appl. 15, 228, doi:10.1137/S0895479888151111) for shift (K + shift M)^-1 M, whose largest
 * eigenvalues shift/(omega^2 + shift) belong to them. Vectors are orthogonal in M, all to all; when there are many, the best
 * combinations of them stay (Wu and Simon 2000, doi:10.1137/S0895479898334605).
 *
 * That no mode is missed, though frequencies repeat, is seen by Sylvester's law: K - sigma M has as many negative eigenvalues as
 * there are modes with omega^2 < sigma. Where some are missing, the search goes on from other vectors, orthogonal to those found.
 *
 * ARPACK does it with one vector instead of a block, and keeps its state in variables that all threads share. */
#ifndef TRIBO_LANCZOS_H
#define TRIBO_LANCZOS_H

#include "numerics/linalg.h"

struct low_modes {
    size_t count;  /* those wanted, and more if they are close to the last of them */
    double *phi;   /* [count][n] in ascending order, modal masses are 1; the caller frees it */
    double above;  /* no other mode has omega^2 below this, */
    size_t below;  /* only these, all of them or all but some that have one frequency, */
    double growth; /* if rounding of the stiffness, times this, does not move any across it */
};

/* k, m     [n][n] in   symmetric, m semidefinite
 * shift    in          > 0
 * shifted  in          the factor of K + shift M
 * wanted   in          > 0
 * Returns TRIBO_OK, TRIBO_ERR_MEMORY, TRIBO_ERR_UNSUPPORTED (no CHOLMOD), TRIBO_ERR_NO_CONVERGENCE, or TRIBO_ERR_SIZE: there
 * are only found->count modes, the mass matrix being singular. */
int tribo_low_modes(const struct matrix *k, const struct matrix *m, double shift, const struct cholesky *shifted, size_t wanted,
                    struct low_modes *found);

#endif
