/* SPDX-License-Identifier: BSD-3-Clause */
/* Dahl's law (1968): a spring that softens towards the limit, df/dz = -stiffness (1 + f sgn(dz)/limit). f is the whole state. */
#include "element.h"

int tribo_dahl_force(size_t n, const double *dz, const double *stiffness, const double *limit, double *f, double *df_dz)
{
    int status = element_check_size(n);
    status = status ? status : tribo_check_element(dz, n, FINITE);
    status = status ? status : tribo_check_element(stiffness, n, NONNEGATIVE);
    status = status ? status : tribo_check_element(limit, n, NONNEGATIVE);
    status = status ? status : tribo_check_finite(NULL, "f", f, n);
    for (size_t i = 0; !status && i < n; i++) {
        /* f + limit sgn(dz) falls by exp(-stiffness |dz|/limit). */
        const double L = limit[i], to = dz[i] > 0.0 ? -L : L, from = clamp(f[i], -L, L);
        const double part = L > 0.0 ? exp(-stiffness[i] * fabs(dz[i]) / L) : 0.0;
        f[i] = dz[i] == 0.0 ? from : to + (from - to) * part;
        if (df_dz) {
            df_dz[i] = L == 0.0 ? 0.0 : dz[i] == 0.0 ? -stiffness[i] : -stiffness[i] * fabs(from - to) * part / L;
        }
    }
    return status;
}
