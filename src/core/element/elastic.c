/* SPDX-License-Identifier: BSD-3-Clause */
/* The friction element of bladed-disc and joint codes: a spring in series with a Coulomb slider (Jenkins 1922; Masing 1926), by
 * return mapping: the spring takes the displacement; where |f| is beyond the limit, the slider moves until it is not. */
#include "element.h"

/* A planar element, two equal springs that end in one Coulomb slider, after a displacement dz. slip is the unit vector of f where
 * the element slides, 0 where it sticks. */
struct elastic_end {
    double slip[2];
    double xx, xy, yy; /* df/dz */
};

/* Return mapping: f [2] becomes p = f - stiffness dz, or limit p/|p| where |p| > limit. With limit 0 f is 0, and so is df/dz.
 * A displacement so large that stiffness dz is beyond all forces keeps its direction. */
static struct elastic_end elastic_return(const double *dz, double stiffness, double limit, double *f)
{
    const double k = lesser(stiffness, TRIBO_FAR / greater(greater(fabs(dz[0]), fabs(dz[1])), 1.0));
    const double to[2] = {cut(f[0]) - k * dz[0], cut(f[1]) - k * dz[1]};
    const double most = greater(greater(fabs(to[0]), fabs(to[1])), DBL_MIN), x = to[0] / most, y = to[1] / most;
    const double length = greater(sqrt(x * x + y * y), DBL_MIN), room = quotient(limit, most);
    if (length <= room) {
        f[0] = to[0];
        f[1] = to[1];
        return (struct elastic_end){{0.0, 0.0}, -stiffness, 0.0, -stiffness};
    }
    /* The derivative of limit p/|p|. */
    const double slip[2] = {x / length, y / length}, rate = -k * (room / length);
    f[0] = limit * slip[0];
    f[1] = limit * slip[1];
    return (struct elastic_end){
        {slip[0], slip[1]}, rate * slip[1] * slip[1], -rate * slip[0] * slip[1], rate * slip[0] * slip[0]};
}

/* Checks what n elements of 1 or 2 directions are given. */
static int check_all(size_t n, size_t directions, const double *dz, const double *stiffness, const double *limit, const double *f)
{
    int status = element_check_size(n);
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

/* The contact element of bladed-disc and joint codes (Yang and Menq 1998): a planar elastic element with limit mu N; the normal
 * spring gives N >= 0, and N = 0 after lift-off. */
int tribo_contact_force(size_t n, const double *dz, const double *depth, const double *tangential, const double *normal,
                        const double *mu, double *f, double *df)
{
    int status = element_check_size(n);
    status = status ? status : tribo_check_finite(NULL, "dz", dz, 2 * n);
    status = status ? status : tribo_check_finite(NULL, "depth", depth, n);
    status = status ? status : tribo_check_nonnegative(NULL, "tangential", tangential, n);
    status = status ? status : tribo_check_nonnegative(NULL, "normal", normal, n);
    status = status ? status : tribo_check_nonnegative(NULL, "mu", mu, n);
    status = status ? status : tribo_check_finite(NULL, "f", f, 3 * n);
    for (size_t i = 0; !status && i < n; i++) {
        /* An open element is one of limit 0, without a normal spring. */
        const double spring = depth[i] > 0.0 ? normal[i] : 0.0, load = product(spring, greater(depth[i], 0.0));
        const struct elastic_end end = elastic_return(dz + 2 * i, tangential[i], product(mu[i], load), f + 3 * i);
        f[3 * i + 2] = -load;
        if (df) {
            const double growth = product(mu[i], spring); /* of the limit, by depth */
            double *d = df + 9 * i;
            d[0] = end.xx;
            d[1] = d[3] = end.xy;
            d[2] = growth * end.slip[0];
            d[4] = end.yy;
            d[5] = growth * end.slip[1];
            d[6] = d[7] = 0.0;
            d[8] = -spring;
        }
    }
    return status;
}
