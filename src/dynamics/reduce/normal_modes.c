/* SPDX-License-Identifier: BSD-3-Clause */
#include "normal_modes.h"
#include "common/layout.h"
#include "common/real.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tribo/tribo.h"

/* QR finds eigenvalues above this part of the largest to a dozen digits. */
#define FOUND 1e-4

/* Modes are not separated if the relative difference of their omega^2 is less: rounding of either decides their mixture. */
#define CLOSE 1e-6

/* Largest turn, a small correction: larger ones are between modes with omega^2 of rounding, and would mix them at random. */
#define SLIGHT 1e-5

/* Accepted |y_j'K y_k| over omega_j omega_k, the roots of the energies of modes j and k. */
#define SHARED 1e-6

/* Relative error of the displacements of a mode: the part of the stiffest mode adds up to ROUNDING^2 max omega^2. */
#define ROUNDING (4.0 * DBL_EPSILON)

/* |omega^2| <= NOTHING noise is taken as 0; omega^2 has at least two digits if |omega^2| >= CERTAIN noise. noise: rounding of the
 * terms of phi'K phi. */
#define NOTHING 2.0
#define CERTAIN 100.0

/* Bound of the rounding of y_j'K y_k over the rounding of its terms. */
#define EXPLAINED 8.0

struct spectrum {
    const struct modes_text *text;
    const struct matrix *stiffness, *z; /* K; Z, without rows: the identity */
    size_t n;                           /* number of displacements y */
    double *k;                          /* [n][n] Z'KZ */
    double *y, *value;                  /* [n][n] modes in rows, those to find again first; [n] their omega^2 so far */
    double *ky;                         /* [n][n] K y */
    double *block, *turn;               /* [n][n] workspace */
    double most;                        /* largest |omega^2| */
    double *root;                       /* [rows of K] square roots of the terms of the diagonal */
    double *force;                      /* [rows of K] workspace */
};

/* Moves those of the first `open` modes with |omega^2| < FOUND max |omega^2| to the front. Returns their number. */
static size_t set_apart(struct spectrum *s, size_t open)
{
    const double most = tribo_largest(s->value, open);
    size_t low = 0;
    for (size_t k = 0; k < open; k++) {
        if (!(fabs(s->value[k]) >= FOUND * most)) {
            tribo_exchange(&s->value[k], &s->value[low], 1, 1);
            tribo_exchange(s->y + k * s->n, s->y + low * s->n, s->n, 1);
            low++;
        }
    }
    s->most = greater(s->most, most);
    return low;
}

/* Sets ky = K y of modes first .. first + count - 1. */
static void stress(struct spectrum *s, size_t first, size_t count)
{
    memset(s->ky + first * s->n, 0, count * s->n * sizeof *s->ky);
    tribo_multiply_add(count, s->n, s->n, 1.0, s->y + first * s->n, s->k, s->ky + first * s->n);
}

/* Sets block [low][count] = y_k'K y_j, k < low, j = first .. first + count - 1, from ky of modes k. */
static void modes_share(struct spectrum *s, size_t low, size_t first, size_t count)
{
    tribo_transpose(count, s->n, s->y + first * s->n, s->turn);
    memset(s->block, 0, low * count * sizeof *s->block);
    tribo_multiply_add(low, s->n, count, 1.0, s->ky, s->turn, s->block);
}

/* Subtracts half of block (y of the others) from the first `low` modes. */
static void take_out(struct spectrum *s, size_t low)
{
    tribo_multiply_add(low, s->n - low, s->n, -0.5, s->block, s->y + low * s->n, s->y);
}

/* Finds all modes, omega^2 to rounding of the largest; then the low ones again, from K projected on these alone. Returns a
 * status. */
static int modes_find(struct spectrum *s, const struct cholesky *mass)
{
    const size_t n = s->n;
    memcpy(s->turn, s->k, n * n * sizeof *s->k);
    int status = tribo_symmetric_eigen_by(mass, s->turn, n, s->value, s->y);
    for (size_t open = n, low = 0; !status && (low = set_apart(s, open)) > 0; open = low) {
        const size_t others = n - low;
        if (low == open) {
            return TRIBO_ERR_NO_CONVERGENCE;
        }
        /* Sets block [low][others] = the turns of modes k and low + j after which y_j'K y_k = 0, to first order:
         * (y_j'K y_k)/(omega_j^2 - omega_k^2), or 0 by CLOSE and SLIGHT. */
        stress(s, 0, low);
        modes_share(s, low, low, others);
        for (size_t k = 0; k < low; k++) {
            const double value = tribo_dot(s->y + k * n, s->ky + k * n, n);
            for (size_t j = 0; j < others; j++) {
                const double gap = s->value[low + j] - value, least = CLOSE * greater(fabs(s->value[low + j]), fabs(value));
                double *turn = s->block + k * others + j;
                *turn = fabs(gap) > least && fabs(*turn) <= SLIGHT * fabs(gap) ? *turn / gap : 0.0;
            }
        }
        /* Half of the turn of the low modes before and half after that of the others makes the modes orthonormal except for a
         * quarter of turn^3. */
        take_out(s, low);
        tribo_transpose(low, others, s->block, s->turn);
        tribo_multiply_add(others, low, n, 1.0, s->turn, s->y, s->y + low * n);
        take_out(s, low);
        stress(s, 0, low);
        modes_share(s, low, 0, low);
        status = tribo_symmetric_eigen(s->block, low, s->value);
        memset(s->ky, 0, low * n * sizeof *s->ky);
        tribo_multiply_add(low, low, n, 1.0, s->block, s->y, s->ky);
        memcpy(s->y, s->ky, low * n * sizeof *s->y);
    }
    return status;
}

/* Sets phi [rows of K] = Z y of mode k. */
static void modes_expand(const struct spectrum *s, size_t k, double *phi)
{
    if (s->z->rows) {
        tribo_matrix_multiply(s->z, s->y + k * s->n, phi);
    } else {
        memcpy(phi, s->y + k * s->n, s->n * sizeof *phi);
    }
}

/* Returns the share of phi'K phi, phi of mode k, of parts of other modes in it; *unexplained = 1 if a part is more than
 * rounding. */
static double find_impurity(struct spectrum *s, size_t k, const double *phi, int *unexplained)
{
    const size_t n = s->n;
    double energy = 0.0;
    stress(s, k, 1);
    const double *ky = s->ky + k * n, own = fabs(tribo_dot(s->y + k * n, ky, n));
    for (size_t j = 0; j < n; j++) {
        const double part = j == k ? 0.0 : fabs(tribo_dot(s->y + j * n, ky, n)), least = greater(own, fabs(s->value[j]));
        energy += part > 0.0 ? part * (part / least) : 0.0;
        if (part > SHARED * sqrt(own) * sqrt(least)) {
            modes_expand(s, j, s->force);
            *unexplained |= !(part <= EXPLAINED * tribo_matrix_noise(s->stiffness, s->root, phi, s->force));
        }
    }
    return energy;
}

/* Sets *omega2 = phi'K phi of mode k, or 0 if that is rounding. Returns a status. */
static int modes_judge(struct spectrum *s, size_t k, const double *phi, double *omega2)
{
    const size_t n = s->stiffness->rows;
    tribo_matrix_multiply(s->stiffness, phi, s->force);
    *omega2 = tribo_dot(phi, s->force, n);
    double noise = tribo_matrix_noise(s->stiffness, s->root, phi, phi) + ROUNDING * ROUNDING * s->most;
    if (fabs(*omega2) >= greater(FOUND * s->most, CERTAIN * noise)) {
        return TRIBO_OK;
    }
    int unexplained = 0;
    noise += find_impurity(s, k, phi, &unexplained);
    *omega2 = tribo_matrix_form(s->stiffness, phi, phi);
    if (fabs(*omega2) <= NOTHING * noise) {
        *omega2 = 0.0;
        return TRIBO_OK;
    }
    if (fabs(*omega2) >= CERTAIN * noise) {
        return unexplained ? tribo_error(s->text->message, TRIBO_ERR_NO_CONVERGENCE,
                                         "%somega^2 = %g of mode %zu does not come out pure: %s", s->text->circumstance, *omega2,
                                         k, s->text->remedy)
                           : TRIBO_OK;
    }
    return tribo_error(s->text->message, TRIBO_ERR_UNSUPPORTED,
                       "%somega^2 = %g of mode %zu is hardly more than rounding of the stiffness, which comes to %g: make the "
                       "stiffest parts softer, or rigid",
                       s->text->circumstance, *omega2, k, noise);
}

int tribo_normal_modes(const struct matrix *k, const double *terms, const struct matrix *z, const struct cholesky *mass,
                       size_t wanted, double *omega2, double *phi, const struct modes_text *text)
{
    const size_t n = k->rows, m = z->rows ? z->cols : n;
    struct spectrum s = {.text = text, .stiffness = k, .z = z, .n = m};
    int status = ALLOCATE(ARRAY(s.k, m * m), ARRAY(s.y, m * m), ARRAY(s.ky, m * m), ARRAY(s.block, m * m), ARRAY(s.turn, m * m),
                          ARRAY(s.value, m), ARRAY(s.root, n), ARRAY(s.force, n)) &&
                         tribo_matrix_congruent(k, z, s.k)
                     ? TRIBO_OK
                     : TRIBO_ERR_MEMORY;
    if (!status) {
        tribo_matrix_roots(k, terms, s.root);
        status = m ? modes_find(&s, mass) : TRIBO_OK;
        if (status == TRIBO_ERR_NOT_FINITE) {
            tribo_error(text->message, status, "stiffness over mass overflows");
        } else if (status && status != TRIBO_ERR_MEMORY) {
            tribo_error(text->message, status, "%smodes do not come out pure: %s", text->circumstance, text->remedy);
        }
    }
    for (size_t p = 0; !status && p < wanted; p++) {
        size_t lowest = p;
        for (size_t q = p + 1; q < m; q++) {
            lowest = s.value[q] < s.value[lowest] ? q : lowest;
        }
        tribo_exchange(&s.value[p], &s.value[lowest], 1, 1);
        tribo_exchange(s.y + p * m, s.y + lowest * m, m, 1);
        double *x = phi + p * n;
        modes_expand(&s, p, x);
        /* the first of the largest |x_i| is positive, because the sign of a mode would be chance */
        const double most = tribo_largest(x, n);
        size_t first = 0;
        while (first < n && fabs(x[first]) < 0.999 * most) {
            first++;
        }
        const int turns = first < n && x[first] < 0.0;
        for (size_t i = 0; turns && i < n; i++) {
            x[i] = -x[i];
        }
        status = modes_judge(&s, p, x, &omega2[p]);
        for (size_t q = p; !status && q > 0 && omega2[q] < omega2[q - 1]; q--) {
            tribo_exchange(&omega2[q], &omega2[q - 1], 1, 1);
            tribo_exchange(phi + q * n, phi + (q - 1) * n, n, 1);
        }
    }
    free(s.k);
    return status;
}
