/* SPDX-License-Identifier: BSD-3-Clause */
/* Normal modes, K phi = omega^2 M phi, the low ones as accurate as the high ones.
 *
 * QR finds every omega^2 to rounding of the largest: of a stiff frame on soft mounts QR finds the frame and loses the mounts. So
 * only omega^2 not far below the largest are accepted. The other modes are made orthogonal to the accepted ones, K is projected
 * on them again, where it is small, and QR finds the largest omega^2 of them; and so on. The result is the Rayleigh quotient
 * phi'K phi, compared with rounding of its terms, the limit of any method: if rounding explains all of phi'K phi, the mode is a
 * rigid-body motion; if rounding explains too much of phi'K phi, the mode is in doubt. */
#ifndef TRIBO_NORMAL_MODES_H
#define TRIBO_NORMAL_MODES_H

#include "dynamics/system/system.h"

/* Texts of a message about a mode in doubt. */
struct modes_text {
    char *message;            /* [TRIBO_MESSAGE] out, after an error other than TRIBO_ERR_MEMORY; NULL: not wanted */
    const char *circumstance; /* beginning of the message */
    const char *remedy;       /* end of the message: another way, for a mode that is mixed with others */
};

/* Finds the lowest modes, in the displacements q = Z y that constraints allow. omega^2 of rigid-body motions is exactly 0. An
 * indefinite K has modes with omega^2 < 0.
 * k       [n][n] in   symmetric
 * terms   [n] in      sizes of the terms of which k_ii is the sum, or NULL: |k_ii|
 * z       [n][m] in   without rows: the identity, m = n
 * mass    [m] in      factor of Z'MZ; n = 0: the identity
 * wanted  in          <= m, without other limit
 * omega2  [wanted] out     ascending
 * phi     [wanted][n] out  modal masses are 1, the first of the largest displacements is positive
 * text    in and out  message
 * Returns TRIBO_OK, TRIBO_ERR_MEMORY, TRIBO_ERR_NOT_FINITE (K over M overflows), TRIBO_ERR_UNSUPPORTED (omega^2 of a mode is
 * hardly more than rounding), TRIBO_ERR_NO_CONVERGENCE. */
int tribo_normal_modes(const struct matrix *k, const double *terms, const struct matrix *z, const struct cholesky *mass,
                       size_t wanted, double *omega2, double *phi, const struct modes_text *text);

#endif
