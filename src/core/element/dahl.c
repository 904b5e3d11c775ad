/* SPDX-License-Identifier: BSD-3-Clause */
/* Dahl's law (1968): a spring that softens towards the limit, df/dz = -stiffness (1 + f sgn(dz)/limit). f is the whole state. */
#include "element.h"

#include "common/exponent.h"

/* f + limit sgn(dz) falls by exp(-stiffness |dz|/limit). */
TRIBO_SIMD static void move_dahl(size_t n, const double *restrict dz, const double *restrict stiffness,
                                 const double *restrict limit, double *restrict f, double *restrict df_dz)
{
    for (size_t i = 0; i < n; i++) {
        const double L = limit[i], to = dz[i] > 0.0 ? -L : L, from = clamp(f[i], -L, L), steep = stiffness[i],
                     scale = greater(L, ELEMENT_LEAST), part = tribo_exp(-steep * fabs(dz[i]) / scale),
                     after = to + (from - to) * part, slope = -steep * fabs(from - to) * part / scale;
        f[i] = dz[i] != 0.0 ? after : from;
        df_dz[i] = L > 0.0 ? (dz[i] != 0.0 ? slope : -steep) : 0.0;
    }
}

int tribo_dahl_force(size_t n, const double *dz, const double *stiffness, const double *limit, double *f, double *df_dz)
{
    int status = element_check_size(n);
    status = status ? status : tribo_check_element(dz, n, FINITE);
    status = status ? status : tribo_check_element(stiffness, n, NONNEGATIVE);
    status = status ? status : tribo_check_element(limit, n, NONNEGATIVE);
    status = status ? status : tribo_check_finite(NULL, "f", f, n);
    for (size_t i = 0; !status && i < n; i += TRIBO_CHUNK) {
        double ignored[TRIBO_CHUNK];
        move_dahl(tribo_chunk_from(n, i), dz + i, stiffness + i, limit + i, f + i, df_dz ? df_dz + i : ignored);
    }
    return status;
}
