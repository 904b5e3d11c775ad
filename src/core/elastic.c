/* The friction element of bladed-disc and joint codes: a spring in series with a Coulomb slider (Jenkins 1922; Masing 1926), by
 * return mapping: the spring takes the displacement; where |f| is beyond the limit, the slider moves until it is not. */
#include "elastic.h"

/* Checks what n elements of 1 or 2 directions are given. */
static int check_all(size_t n, size_t directions, const double *dz, const double *stiffness, const double *limit, const double *f)
{
    int status = elastic_check_size(n);
    status = status ? status : tribo_check_finite(NULL, "dz", dz, n * directions);
    status = status ? status : tribo_check_nonnegative(NULL, "stiffness", stiffness, n);
    status = status ? status : tribo_check_nonnegative(NULL, "limit", limit, n);
    return status ? status : tribo_check_finite(NULL, "f", f, n * directions);
}

int tribo_elastic_force(size_t n, const double *dz, const double *stiffness, const double *limit, double *f, double *df_dz)
{
    const int status = check_all(n, 1, dz, stiffness, limit, f);
    for (size_t i = 0; !status && i < n; i++) {
        const double to = cut(f[i]) - product(stiffness[i], dz[i]);
        f[i] = clamp(to, -limit[i], limit[i]);
        if (df_dz) {
            df_dz[i] = fabs(to) <= limit[i] && limit[i] > 0.0 ? -stiffness[i] : 0.0;
        }
    }
    return status;
}

int tribo_elastic_force_planar(size_t n, const double *dz, const double *stiffness, const double *limit, double *f, double *df_dz)
{
    const int status = check_all(n, 2, dz, stiffness, limit, f);
    for (size_t i = 0; !status && i < n; i++) {
        const struct elastic_end end = elastic_return(dz + 2 * i, stiffness[i], limit[i], f + 2 * i);
        if (df_dz) {
            double *d = df_dz + 4 * i;
            d[0] = end.xx;
            d[1] = d[2] = end.xy;
            d[3] = end.yy;
        }
    }
    return status;
}
