/* SPDX-License-Identifier: BSD-3-Clause */
/* The law of Bouc (1967) and Wen (1976): f = -stiffness z, dz/dx = a - |z|^m (gamma + beta sgn(z dx)). For m = 1 and 2 it has a
 * closed form over a step, in two parts where z changes its sign. */
#include "element.h"

#include "common/exponent.h"

enum { STIFFNESS, A, BETA, GAMMA, EXPONENT, PARAMETERS };

#define SMALL 1e-9         /* series of one term are exact to rounding below this argument */
#define NO_OVERFLOW 1e-200 /* parameters divided by this do not overflow */

/* u after a distance s of du/ds = a - c u; grown = exp(-c s) - 1. */
static inline double moved_linear(double u, double s, double a, double c, double grown)
{
    const double by = fabs(c) > DBL_MIN ? c : DBL_MIN;
    return fabs(c) * s < SMALL ? u + s * (a - c * u) : u * (1.0 + grown) - a * grown / by;
}

/* tanh(w s)/w; grown = exp(-2 w s) - 1. */
static inline double hyperbolic(double w, double s, double grown)
{
    return w * s < SMALL ? s : -grown / ((2.0 + grown) * greater(w, DBL_MIN));
}

/* u after du/ds = a - c u^2; t = tanh(w s)/w with w = sqrt(a c), tan(w s)/w with w = sqrt(-a c) where c < 0. */
static inline double moved_square(double u, double t, double a, double c)
{
    return (u + a * t) / greater(1.0 + c * t * u, ELEMENT_LEAST);
}

/* The distance after which u < 0 comes to 0; HUGE_VAL: never, since du/ds = 0: beta = 0, and u is at the bound of unloading. */
static double distance_to_zero(double u, double a, double c, double m)
{
    if (m == 1.0) {
        const double x = c * u / a;
        return fabs(x) < SMALL ? -u / a : x < 1.0 ? log1p(-x) / c : HUGE_VAL;
    }
    const double w = sqrt(fabs(a * c)), t = -u / a;
    return w * t < SMALL ? t : c < 0.0 ? atan(w * t) / w : w * t < 1.0 ? atanh(w * t) / w : HUGE_VAL;
}

/* Unloads: moves *u < 0, where |u| = -u, by *s but at most to 0; *s becomes the rest of the distance. */
static void unload(double *u, double *s, double a, double beta, double gamma, double m)
{
    const double far = 230.0; /* exp(far) is beyond all ratios of parameters */
    const double quarter_turn = 1.5707963267948966, way = *s, from = *u;
    const double c = m == 1.0 ? beta - gamma : gamma - beta, w = sqrt(fabs(a * c));
    const double t = m == 1.0                     ? 0.0
                     : w * way < SMALL || c > 0.0 ? hyperbolic(w, way, tribo_expm1(-2.0 * w * way))
                     : w * way < quarter_turn     ? tan(w * way) / w
                                                  : ELEMENT_MOST * ELEMENT_MOST;
    const double end = m == 1.0        ? moved_linear(from, way, a, c, tribo_expm1(lesser(-c * way, far)))
                       : a * t < -from ? moved_square(from, t, a, c)
                                       : 0.0;
    const int rests = m == 1.0 ? c * from / a >= 1.0 : c > 0.0 && w * (-from / a) >= 1.0;
    *u = rests ? from : clamp(end, from, 0.0);
    *s = rests || end < 0.0 ? 0.0 : greater(way - distance_to_zero(from, a, c, m), 0.0);
}

/* u = z and s = |dz|, with the sign of dz in u; |u| is at most (a/(beta + gamma))^(1/m), where loading ends. */
TRIBO_SIMD static void turn(size_t n, const double *restrict dz, double (*restrict p)[TRIBO_CHUNK], const double *restrict z,
                            double *restrict u, double *restrict s)
{
    for (size_t i = 0; i < n; i++) {
        const double ratio = p[A][i] / greater(p[GAMMA][i] + p[BETA][i], NO_OVERFLOW), root = sqrt(ratio),
                     most = p[EXPONENT][i] > 1.0 ? root : ratio, start = clamp(z[i], -most, most);
        u[i] = dz[i] < 0.0 ? -start : start;
        s[i] = fabs(dz[i]);
    }
}

/* Loads: moves u >= 0 by s; u < 0 has s = 0. */
TRIBO_SIMD static void load(size_t n, const double *restrict dz, double (*restrict p)[TRIBO_CHUNK], const double *restrict u,
                            const double *restrict s, double *restrict z, double *restrict f, double *restrict df_dz)
{
    for (size_t i = 0; i < n; i++) {
        const double stiffness = p[STIFFNESS][i], a = p[A][i], beta = p[BETA][i], gamma = p[GAMMA][i], c = gamma + beta;
        const int square = p[EXPONENT][i] > 1.0;
        const double w = sqrt(a * c), rate = square ? 2.0 * w : c, grown = tribo_expm1(-rate * s[i]);
        const double linear = moved_linear(u[i], s[i], a, c, grown),
                     end = square ? moved_square(u[i], hyperbolic(w, s[i], grown), a, c) : linear;
        const double after = dz[i] < 0.0 ? -end : end, size = fabs(after), power = square ? size * size : size;
        /* At dz = 0 the mean of both directions. */
        const double way = dz[i] != 0.0 ? beta : 0.0, turned = end > 0.0 ? way : end < 0.0 ? -way : 0.0;
        z[i] = after;
        f[i] = -stiffness * after;
        df_dz[i] = -stiffness * (a - power * (gamma + turned));
    }
}

int tribo_bouc_wen_force(size_t n, const double *dz, const double *parameter, double *z, double *f, double *df_dz)
{
    static const int range[PARAMETERS] = {NONNEGATIVE, POSITIVE, NONNEGATIVE, FINITE, POSITIVE};
    int status = element_check_size(n);
    status = status ? status : tribo_check_element(dz, n, FINITE);
    status = status ? status : tribo_check_elements(parameter, n, PARAMETERS, range);
    for (size_t i = 0; !status && i < n; i++) {
        const double *k = parameter + PARAMETERS * i;
        status = (k[EXPONENT] != 1.0 && k[EXPONENT] != 2.0) || k[BETA] + k[GAMMA] < 0.0 ? TRIBO_ERR_RANGE : TRIBO_OK;
    }
    status = status ? status : tribo_check_finite(NULL, "z", z, n);
    status = status ? status : n && !f ? TRIBO_ERR_NULL : TRIBO_OK;
    for (size_t i = 0; !status && i < n; i += TRIBO_CHUNK) {
        double ignored[TRIBO_CHUNK], p[PARAMETERS][TRIBO_CHUNK], u[TRIBO_CHUNK], s[TRIBO_CHUNK];
        const size_t count = tribo_chunk_from(n, i);
        element_columns(parameter + PARAMETERS * i, count, PARAMETERS, p);
        turn(count, dz + i, p, z + i, u, s);
        for (size_t k = 0; k < count; k++) {
            if (u[k] < 0.0) {
                unload(u + k, s + k, p[A][k], p[BETA][k], p[GAMMA][k], p[EXPONENT][k]);
            }
        }
        load(count, dz + i, p, u, s, z + i, f + i, df_dz ? df_dz + i : ignored);
    }
    return status;
}
