/* SPDX-License-Identifier: BSD-3-Clause */
/* A sledge on a road of pads, with room for all contacts from the start: of 100 pads only those under the sledge press on it, and
 * the others have limit 0. The road ahead is less dense than behind, so that fewer pads brake as it goes. Core library only.
 * Units: kg, m, s, N. */
#include <math.h>
#include <stdio.h>

#include "tribo/tribo.h"

enum { PADS = 100 };

/* Distance between pad k and pad 0. */
static double place(int k)
{
    return k < 50 ? 0.1 * k : 5.0 + 0.2 * (k - 50);
}

int main(void)
{
    const double mass = 4.0, load = 40.0, mu = 0.3, length = 2.05, dt = 1e-3;
    double r[PADS * PADS], v[PADS], f[PADS], limit[PADS];
    for (int k = 0; k < PADS * PADS; k++) {
        r[k] = 1.0 / mass; /* each pad acts on the one body */
    }
    tribo_context *pads;
    int status = tribo_create(&pads, PADS);
    if (status) {
        fprintf(stderr, "%s\n", tribo_strerror(status));
        return 1;
    }
    status = tribo_set_operator_dense(pads, r);

    double x = 0.0, u = 5.0, away = 0.0;
    int most = 0, least = PADS;
    for (int step = 0; !status && step < 3000; step++) {
        int pressed = 0;
        for (int k = 0; k < PADS; k++) {
            pressed += place(k) >= x && place(k) <= x + length;
        }
        for (int k = 0; k < PADS; k++) {
            const int under = place(k) >= x && place(k) <= x + length;
            limit[k] = under ? mu * load / pressed : 0.0; /* 0: away */
        }
        most = pressed > most ? pressed : most;
        least = pressed < least ? pressed : least;
        status = tribo_set_limit(pads, limit);
        for (int k = 0; k < PADS; k++) {
            v[k] = u; /* at the end of the step, without friction */
        }
        status = status ? status : tribo_step_force(pads, dt, v, f);
        for (int k = 0; !status && k < PADS; k++) {
            u += dt * f[k] / mass;
            away += limit[k] > 0.0 ? 0.0 : fabs(f[k]);
        }
        x += dt * u;
    }
    if (status) {
        fprintf(stderr, "%s: %s\n", tribo_strerror(status), tribo_message(pads));
    }
    tribo_destroy(pads);

    /* the sum of the forces is mu load, whichever pads carry it */
    const double exact = 0.5 * 5.0 * 5.0 * mass / (mu * load);
    printf("stops at %.3f m (exact %.3f), %d to %d of %d pads in use, forces of the others %g N\n", x, exact, least, most, PADS,
           away);
    return status || fabs(x - exact) > 0.01 || fabs(u) > 1e-12 || away > 0.0 || least >= most;
}
