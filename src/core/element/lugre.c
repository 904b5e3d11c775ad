/* SPDX-License-Identifier: BSD-3-Clause */
/* The LuGre law (Canudas de Wit, Olsson, Astrom, Lischinsky 1995): bristles of deflection z, z' = v - s0 |v| z/g(v),
 * f = -(s0 z + s1 z' + s2 v), g = fc + (fs - fc) exp(-(v/vs)^2). With v constant over a step z is an exponential function. */
#include "element.h"

enum { PARAMETERS = 6 };

struct lugre {
    double s0, s1, s2; /* stiffness and damping of the bristles, viscosity */
    double fc, fs, vs; /* kinetic limit, static limit, Stribeck velocity */
};

static int check_parameters(size_t n, const double *parameter)
{
    static const int range[PARAMETERS] = {POSITIVE, NONNEGATIVE, NONNEGATIVE, NONNEGATIVE, NONNEGATIVE, POSITIVE};
    int status = n && !parameter ? TRIBO_ERR_NULL : TRIBO_OK;
    for (size_t k = 0; !status && n && k < PARAMETERS; k++) {
        status = tribo_check_element(parameter + k, n, PARAMETERS, range[k]);
    }
    return status;
}

/* Moves *z by a step dt at velocity v != 0, and returns f; *df_dv: its derivative. g > 0. */
static double slide(const struct lugre *p, double dt, double v, double *z, double *df_dv)
{
    const double r = lesser(fabs(v) / p->vs, 30.0), bell = exp(-r * r), sign = v > 0.0 ? 1.0 : -1.0;
    const double g = greater(p->fs * bell - p->fc * expm1(-r * r), ELEMENT_LEAST),
                 steep = -2.0 * sign * (p->fs - p->fc) * bell * r / p->vs;                              /* dg/dv */
    const double rate = p->s0 * fabs(v) / g, growth = p->s0 * (sign / g - r * p->vs * steep / (g * g)); /* d rate/dv */
    const double left = exp(-rate * dt), to = sign * g / p->s0, away = to - *z;
    const double dto = sign * steep / p->s0, speed = rate * away * left; /* speed: z' at the end */
    *z = *z * left - to * expm1(-rate * dt);
    *df_dv = -(p->s0 * (away * left * growth * dt - dto * expm1(-rate * dt)) +
               p->s1 * left * (growth * away * (1.0 - rate * dt) + rate * dto) + p->s2);
    return -(p->s0 * *z + p->s1 * speed + p->s2 * v);
}

int tribo_lugre_force(size_t n, double dt, const double *dz, const double *parameter, double *z, double *f, double *df_dz)
{
    int status = element_check_size(n);
    status = status ? status : tribo_check_element(&dt, 1, 1, POSITIVE);
    status = status ? status : tribo_check_element(dz, n, 1, FINITE);
    status = status ? status : check_parameters(n, parameter);
    status = status ? status : tribo_check_element(z, n, 1, FINITE);
    status = status ? status : n && !f ? TRIBO_ERR_NULL : TRIBO_OK;
    for (size_t i = 0; !status && i < n; i++) {
        const double *k = parameter + PARAMETERS * i, v = dz[i] / dt;
        const struct lugre p = {k[0], k[1], k[2], k[3], k[4], k[5]};
        double df_dv = -(p.s0 * dt + p.s1 + p.s2); /* at v = 0: the mean of both sides */
        if (p.fc == 0.0 && p.fs == 0.0) {
            z[i] = 0.0; /* open */
            f[i] = -p.s2 * v;
            df_dv = -p.s2;
        } else {
            f[i] = v == 0.0 ? -p.s0 * z[i] : slide(&p, dt, v, z + i, &df_dv);
        }
        if (df_dz) {
            df_dz[i] = df_dv / dt;
        }
    }
    return status;
}
