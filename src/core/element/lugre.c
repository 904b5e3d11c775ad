/* SPDX-License-Identifier: BSD-3-Clause */
/* The LuGre law (Canudas de Wit, Olsson, Astrom, Lischinsky 1995): bristles of deflection z, z' = v - s0 |v| z/g(v),
 * f = -(s0 z + s1 z' + s2 v), g = fc + (fs - fc) exp(-(v/vs)^2). With v constant over a step z is an exponential function. */
#include "element.h"

enum { PARAMETERS = 6 };

struct lugre {
    double s0, s1, s2; /* stiffness and damping of the bristles, viscosity */
    double fc, fs, vs; /* kinetic limit, static limit, Stribeck velocity */
};

/* 1 - exp(-x) to its own digits, x >= 0. */
static double fallen(double x)
{
    return x < 0.5 ? -expm1(-x) : 1.0 - exp(-x);
}

/* Moves *z by a step dt at velocity v != 0, and returns f; *df_dv: its derivative. */
static double deflect(const struct lugre *p, double dt, double v, double *z, double *df_dv)
{
    const double sign = v > 0.0 ? 1.0 : -1.0, r = lesser(fabs(v) / p->vs, 30.0), fall = fallen(r * r);
    const double g = greater(p->fs - (p->fs - p->fc) * fall, ELEMENT_LEAST);
    const double steep = -2.0 * sign * (p->fs - p->fc) * (1.0 - fall) * r / p->vs;                      /* dg/dv */
    const double rate = p->s0 * fabs(v) / g, growth = p->s0 * (sign / g - r * p->vs * steep / (g * g)); /* d rate/dv */
    const double way = fallen(rate * dt), left = 1.0 - way, to = sign * g / p->s0, dto = sign * steep / p->s0, away = to - *z;
    *z += way * away;
    *df_dv = -(p->s0 * (away * left * growth * dt + dto * way) + p->s1 * left * (growth * away * (1.0 - rate * dt) + rate * dto) +
               p->s2);
    return -(p->s0 * *z + p->s1 * rate * away * left + p->s2 * v);
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
    for (size_t i = 0; !status && i < n; i++) {
        const double *k = parameter + PARAMETERS * i, v = dz[i] / dt;
        const struct lugre p = {k[0], k[1], k[2], k[3], k[4], k[5]};
        double df_dv = -(p.s0 * dt + p.s1 + p.s2); /* at v = 0: the mean of both sides */
        if (p.fc == 0.0 && p.fs == 0.0) {
            z[i] = 0.0; /* open */
            f[i] = -p.s2 * v;
            df_dv = -p.s2;
        } else {
            const double most = greater(p.fc, p.fs) / p.s0;
            z[i] = clamp(z[i], -most, most);
            f[i] = v == 0.0 ? -p.s0 * z[i] : deflect(&p, dt, v, z + i, &df_dv);
        }
        if (df_dz) {
            df_dz[i] = df_dv / dt;
        }
    }
    return status;
}
