/* The friction element of bladed-disc and joint codes: a spring in series with a Coulomb slider (Jenkins 1922; Masing 1926), by
 * return mapping: the spring takes the displacement; where |f| is beyond the limit, the slider moves until it is not. */
#include "check.h"

/* TRIBO_OK, or what is wrong with count numbers. */
static int elastic_check(const double *x, size_t count, int nonnegative)
{
    if (!x && count) {
        return TRIBO_ERR_NULL;
    }
    if (!tribo_all_finite(x, count)) {
        return TRIBO_ERR_NOT_FINITE;
    }
    for (size_t i = 0; nonnegative && i < count; i++) {
        if (x[i] < 0.0) {
            return TRIBO_ERR_NEGATIVE;
        }
    }
    return TRIBO_OK;
}

/* Checks what n elements of 1 or 2 directions are given. */
static int check_all(size_t n, size_t directions, const double *dz, const double *stiffness, const double *limit, const double *f)
{
    if (n >= SIZE_MAX / 64) {
        return TRIBO_ERR_SIZE;
    }
    int status = elastic_check(dz, n * directions, 0);
    status = status ? status : elastic_check(stiffness, n, 1);
    status = status ? status : elastic_check(limit, n, 1);
    return status ? status : elastic_check(f, n * directions, 0);
}

int tribo_elastic_force(size_t n, const double *dz, const double *stiffness, const double *limit, double *f, double *df_dz)
{
    const int status = check_all(n, 1, dz, stiffness, limit, f);
    for (size_t i = 0; !status && i < n; i++) {
        const double to = cut(f[i]) - product(stiffness[i], dz[i]);
        f[i] = clamp(to, -limit[i], limit[i]);
        if (df_dz) {
            df_dz[i] = fabs(to) <= limit[i] ? -stiffness[i] : 0.0;
        }
    }
    return status;
}

int tribo_elastic_force_planar(size_t n, const double *dz, const double *stiffness, const double *limit, double *f, double *df_dz)
{
    const int status = check_all(n, 2, dz, stiffness, limit, f);
    for (size_t i = 0; !status && i < n; i++) {
        const double k = stiffness[i];
        const double to[2] = {cut(f[2 * i]) - product(k, dz[2 * i]), cut(f[2 * i + 1]) - product(k, dz[2 * i + 1])};
        const double most = greater(greater(fabs(to[0]), fabs(to[1])), DBL_MIN), x = to[0] / most, y = to[1] / most;
        const double length = sqrt(x * x + y * y), room = quotient(limit[i], most);
        const double direction[2] = {x / greater(length, DBL_MIN), y / greater(length, DBL_MIN)};
        const int slides = length > room;
        f[2 * i] = slides ? limit[i] * direction[0] : to[0];
        f[2 * i + 1] = slides ? limit[i] * direction[1] : to[1];
        if (df_dz && slides) {
            /* The derivative of limit to/|to|, to = f - stiffness dz. */
            const double rate = -k * (room / length);
            double *d = df_dz + 4 * i;
            d[0] = rate * direction[1] * direction[1];
            d[1] = d[2] = -rate * direction[0] * direction[1];
            d[3] = rate * direction[0] * direction[0];
        } else if (df_dz) {
            df_dz[4 * i] = df_dz[4 * i + 3] = -k;
            df_dz[4 * i + 1] = df_dz[4 * i + 2] = 0.0;
        }
    }
    return status;
}
