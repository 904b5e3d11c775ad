/* SPDX-License-Identifier: BSD-3-Clause */
/* The LuGre law (Canudas de Wit, Olsson, Astrom, Lischinsky 1995): bristles of deflection z, z' = v - s0 |v| z/g(v),
 * f = -(s0 z + s1 z' + s2 v), g = fc + (fs - fc) exp(-(v/vs)^2). With v constant over a step z is an exponential function. */
#include "element.h"

#include "common/exponent.h"

/* Stiffness and damping of the bristles, viscosity; kinetic limit, static limit, Stribeck velocity. */
enum { S0, S1, S2, FC, FS, VS, PARAMETERS };

/* Moves z by a step dt. */
TRIBO_SIMD static void deflect(size_t n, double dt, const double *restrict dz, double (*restrict p)[TRIBO_CHUNK],
                               double *restrict z, double *restrict f, double *restrict df_dz)
{
    const double most_r = 30.0; /* |v|/vs; the Stribeck curve is flat there */
    for (size_t i = 0; i < n; i++) {
        const double s0 = p[S0][i], s1 = p[S1][i], s2 = p[S2][i], fc = p[FC][i], drop = p[FS][i] - fc;
        const double v = dz[i] / dt, sign = v > 0.0 ? 1.0 : -1.0, per_vs = 1.0 / p[VS][i], per_s0 = 1.0 / s0;
        const double limit = greater(fc, p[FS][i]), most = limit * per_s0, start = clamp(z[i], -most, most);
        const double r = lesser(fabs(v) * per_vs, most_r), fall = -tribo_expm1(-r * r);
        const double g = greater(p[FS][i] - drop * fall, ELEMENT_LEAST), per_g = 1.0 / g;
        const double steep = -2.0 * sign * drop * (1.0 - fall) * r * per_vs;                                   /* dg/dv */
        const double rate = s0 * fabs(v) * per_g, growth = s0 * per_g * (sign - r * p[VS][i] * steep * per_g); /* d rate/dv */
        const double way = -tribo_expm1(-rate * dt), left = 1.0 - way, to = sign * g * per_s0, dto = sign * steep * per_s0,
                     away = to - start, end = start + way * away;
        const double moving = -(s0 * end + s1 * rate * away * left + s2 * v);
        const double by_v =
            -(s0 * (away * left * growth * dt + dto * way) + s1 * left * (growth * away * (1.0 - rate * dt) + rate * dto) + s2);
        /* At v = 0 the mean of both sides. */
        const double force = v != 0.0 ? moving : -s0 * start, slope = v != 0.0 ? by_v : -(s0 * dt + s1 + s2);
        z[i] = limit > 0.0 ? (v != 0.0 ? end : start) : 0.0;
        f[i] = limit > 0.0 ? force : -s2 * v; /* open */
        df_dz[i] = (limit > 0.0 ? slope : -s2) / dt;
    }
}

int tribo_lugre_force(size_t n, double dt, const double *dz, const double *parameter, double *z, double *f, double *df_dz)
{
    static const int range[PARAMETERS] = {POSITIVE, NONNEGATIVE, NONNEGATIVE, NONNEGATIVE, NONNEGATIVE, POSITIVE};
    int status = element_check_size(n);
    status = status ? status : tribo_check_element(&dt, 1, POSITIVE);
    status = status ? status : tribo_check_element(dz, n, FINITE);
    status = status ? status : tribo_check_elements(parameter, n, PARAMETERS, range);
    status = status ? status : tribo_check_finite(NULL, "z", z, n);
    status = status ? status : n && !f ? TRIBO_ERR_NULL : TRIBO_OK;
    for (size_t i = 0; !status && i < n; i += TRIBO_CHUNK) {
        double ignored[TRIBO_CHUNK], column[PARAMETERS][TRIBO_CHUNK];
        const size_t count = tribo_chunk_from(n, i);
        element_columns(parameter + PARAMETERS * i, count, PARAMETERS, column);
        deflect(count, dt, dz + i, column, z + i, f + i, df_dz ? df_dz + i : ignored);
    }
    return status;
}
