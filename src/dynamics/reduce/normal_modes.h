/* Normal modes, K phi = omega^2 M phi, the low ones as accurate as the high ones.
 *
 * The QR algorithm knows every omega^2 to rounding of the largest: of a stiff frame on soft mounts it finds the frame and loses
 * the mounts. So it only counts for what is not far below the largest. The rest is freed of what it still has of the modes found,
 * the stiffness is projected on it anew, which is small there, and the algorithm finds the largest of what is left; and so on.
 * What decides in the end is the Rayleigh quotient phi'K phi beside the rounding of its own terms, which no method gets below:
 * where that explains all of it, the mode is a rigid-body motion; where it explains too much of it, nobody can tell. */
#ifndef TRIBO_NORMAL_MODES_H
#define TRIBO_NORMAL_MODES_H

#include "numerics/linalg.h"

/* A mode that is not known well enough, and what rounding of the stiffness may do to its omega^2. */
struct doubt {
    size_t mode;
    double omega2, noise;
};

/* The lowest modes, in the displacements q = Z y that constraints allow. omega^2 of rigid-body motions is exactly 0. An
 * indefinite K has modes with omega^2 < 0.
 * k       [n][n] in   symmetric
 * terms   [n] in      sizes of the terms of which k_ii is the sum, or NULL: |k_ii|
 * z       [n][m] in   without rows: the identity, m = n
 * mass    [m] in      factor of Z'MZ; n = 0: the identity
 * wanted  in          <= m, but for that many there is no limit
 * omega2  [wanted] out     ascending
 * phi     [wanted][n] out  modal masses are 1, the first of the largest displacements is positive
 * doubt   out         on the last two errors
 * Returns TRIBO_OK, TRIBO_ERR_MEMORY, TRIBO_ERR_NOT_FINITE (K over M overflows), TRIBO_ERR_UNSUPPORTED (omega^2 of a mode is
 * hardly more than rounding), TRIBO_ERR_NO_CONVERGENCE. */
int tribo_normal_modes(const struct matrix *k, const double *terms, const struct matrix *z, const struct cholesky *mass,
                       size_t wanted, double *omega2, double *phi, struct doubt *doubt);

#endif
