/* SPDX-License-Identifier: BSD-3-Clause */
/* The law of Bouc (1967) and Wen (1976): f = -stiffness z, dz/dx = a - |z|^m (gamma + beta sgn(z dx)). For m = 1 and 2 it has a
 * closed form over a step, in two parts where z changes its sign. */
#include "element.h"

enum { PARAMETERS = 5 };

static int check_bouc_wen(size_t n, const double *parameter)
{
    static const int range[PARAMETERS] = {NONNEGATIVE, POSITIVE, NONNEGATIVE, FINITE, POSITIVE};
    int status = tribo_check_elements(parameter, n, PARAMETERS, range);
    for (size_t i = 0; !status && i < n; i++) {
        const double *k = parameter + PARAMETERS * i;
        status = (k[4] != 1.0 && k[4] != 2.0) || k[2] + k[3] < 0.0 ? TRIBO_ERR_RANGE : TRIBO_OK;
    }
    return status;
}

/* T(s) = tanh(w s)/w, w = sqrt(b); s for b = 0, tan(w s)/w with w = sqrt(-b) for b < 0. */
static double tangent_of(double b, double s)
{
    const double w = sqrt(fabs(b));
    return w * s < 1e-9 ? s : b > 0.0 ? tanh(w * s) / w : tan(w * s) / w;
}

/* s of T(s) = t >= 0; HUGE_VAL if T stays below t. */
static double distance_of(double b, double t)
{
    const double w = sqrt(fabs(b));
    return w * t < 1e-9 ? t : b < 0.0 ? atan(w * t) / w : w * t < 1.0 ? atanh(w * t) / w : HUGE_VAL;
}

/* u after a distance s of du/ds = a - c u (m = 1) or a - c u^2 (m = 2). */
static double moved(double u, double s, double a, double c, double m)
{
    if (m == 1.0) {
        return fabs(c) * s < 1e-9 ? u + s * (a - c * u) : u * exp(-c * s) - a * expm1(-c * s) / c;
    }
    const double t = tangent_of(a * c, s);
    return (u + a * t) / (1.0 + c * t * u);
}

/* The distance after which u < 0 comes to 0; HUGE_VAL: never. */
static double distance_to_zero(double u, double a, double c, double m)
{
    if (m == 1.0) {
        const double x = c * u / a;
        return fabs(x) < 1e-9 ? -u / a : x < 1.0 ? log1p(-x) / c : HUGE_VAL;
    }
    return distance_of(a * c, -u / a);
}

/* z after a displacement dx; |z| is at most (a/(beta + gamma))^(1/m), at which it stays. */
static double end_of(double z, double dx, double a, double beta, double gamma, double m)
{
    const double sign = dx < 0.0 ? -1.0 : 1.0, c = m == 1.0 ? beta - gamma : gamma - beta;
    const double ratio = gamma + beta > 0.0 ? a / (gamma + beta) : ELEMENT_MOST * ELEMENT_MOST,
                 most_z = m == 1.0 ? ratio : sqrt(ratio);
    double u = sign * clamp(z, -most_z, most_z), s = fabs(dx);
    if (u < 0.0) { /* unloads, where |u| = -u */
        const double most = distance_to_zero(u, a, c, m);
        if (s <= most) {
            return sign * (most < HUGE_VAL ? lesser(moved(u, s, a, c, m), 0.0) : u);
        }
        s -= most;
        u = 0.0;
    }
    return sign * moved(u, s, a, gamma + beta, m);
}

int tribo_bouc_wen_force(size_t n, const double *dz, const double *parameter, double *z, double *f, double *df_dz)
{
    int status = element_check_size(n);
    status = status ? status : tribo_check_element(dz, n, FINITE);
    status = status ? status : check_bouc_wen(n, parameter);
    status = status ? status : tribo_check_finite(NULL, "z", z, n);
    status = status ? status : n && !f ? TRIBO_ERR_NULL : TRIBO_OK;
    for (size_t i = 0; !status && i < n; i++) {
        const double *k = parameter + PARAMETERS * i, m = k[4];
        z[i] = end_of(z[i], dz[i], k[1], k[2], k[3], m);
        f[i] = -k[0] * z[i];
        if (df_dz) {
            /* At dz = 0 the mean of both directions. */
            const double turn = z[i] * dz[i] > 0.0 ? 1.0 : z[i] * dz[i] < 0.0 ? -1.0 : 0.0, size = fabs(z[i]);
            df_dz[i] = -k[0] * (k[1] - (m == 1.0 ? size : size * size) * (k[3] + k[2] * turn));
        }
    }
    return status;
}
