/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls of calls_core.c: elements without a context. Forces are finite, and within the limits of laws with a limit; on error
 * states and forces are unchanged. */
#include <math.h>
#include <string.h>

#include "calls_core.h"

enum { FEW = 4, ROOM = 2, VALUES = 9 * FEW };

/* f [n] are finite, and at most limit [n] in size. */
static void check_forces(const char *name, size_t n, const double *f, const double *limit)
{
    for (size_t i = 0; i < n; i++) {
        require(isfinite(f[i]), "%s: f[%zu] = %g", name, i, f[i]);
        require(!limit || fabs(f[i]) <= limit[i] * (1.0 + 1e-14), "%s: |%.17g| > %.17g", name, f[i], limit[i]);
    }
}

void elements(struct string *in)
{
    static const char *const names[] = {"elastic", "elastic in the plane", "contact", "dahl", "lugre", "bouc-wen", "iwan"};
    double dz[VALUES], depth[VALUES], a[VALUES], b[VALUES], mu[VALUES], f[VALUES], state[VALUES], df[VALUES], before[2][VALUES];
    int wild = 0, status;
    const size_t n = 1 + take(in) % FEW, which = take(in) % 7;
    numbers(in, dz, 2 * n, FINITE, &wild);
    numbers(in, depth, n, FINITE, &wild);
    numbers(in, a, 6 * n, POSITIVE, &wild);
    numbers(in, b, n, NONNEGATIVE, &wild);
    numbers(in, mu, n, NONNEGATIVE, &wild);
    memset(f, 0, sizeof f);
    memset(state, 0, sizeof state);
    for (int turn = 0; turn < 4; turn++) { /* there and back, from the state that the last step left */
        memcpy(before[0], f, sizeof f);
        memcpy(before[1], state, sizeof state);
        switch (which) {
        case 0:
            status = tribo_elastic_force(n, dz, a, b, f, df);
            break;
        case 1:
            status = tribo_elastic_force_planar(n, dz, a, b, f, df);
            break;
        case 2:
            status = tribo_contact_force(n, dz, depth, a, b, mu, f, df);
            break;
        case 3:
            status = tribo_dahl_force(n, dz, a, b, f, df);
            break;
        case 4:
            status = tribo_lugre_force(n, fabs(depth[0]), dz, a, state, f, df);
            break;
        case 5:
            status = tribo_bouc_wen_force(n, dz, a, state, f, df);
            break;
        default:
            status = tribo_iwan_force(n, ROOM, dz, a, state, f, df);
        }
        require(strcmp(tribo_strerror(status), tribo_strerror(-1)) != 0, "%s: status %d", names[which], status);
        if (status) {
            require(!memcmp(before[0], f, sizeof f) && !memcmp(before[1], state, sizeof state), "%s: outputs", names[which]);
            return;
        }
        check_forces(names[which], n, f, which == 0 || which == 3 ? b : NULL);
        for (size_t i = 0; i < 2 * n; i++) {
            dz[i] *= -1.5;
        }
    }
}
