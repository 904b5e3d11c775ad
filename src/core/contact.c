/* The contact element of bladed-disc and joint codes (Yang and Menq 1998): a planar elastic element whose limit is mu times the
 * force of a normal spring that lifts off. */
#include "elastic.h"

int tribo_contact_force(size_t n, const double *dz, const double *depth, const double *tangential, const double *normal,
                        const double *mu, double *f, double *df)
{
    int status = elastic_check_size(n);
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
