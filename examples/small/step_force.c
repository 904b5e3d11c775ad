/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction in an explicit code with fixed steps (central differences): the step form gives the force that leaves the contact in
 * Coulomb's law at the end of the step, so that it needs no epsilon and rests exactly. A mass on a spring, as in Quinn's
 * Fig. 5: from 2.75 it slides once, to -0.75, and stays. Core library only. */
#include <math.h>
#include <stdio.h>

#include "tribo/tribo.h"

int main(void)
{
    const double dt = 0.01, limit = 1.0, inverse_mass = 1.0;
    tribo_context *contact;
    int status = tribo_create(&contact, 1);
    if (status) {
        fprintf(stderr, "%s\n", tribo_strerror(status));
        return 1;
    }
    status = tribo_set_limit(contact, &limit);
    status = status ? status : tribo_set_operator_diagonal(contact, &inverse_mass);

    double x = 2.75, v = 0.0, dissipated = 0.0;
    for (int k = 0; !status && k < 1000; k++) {
        /* velocities at half steps, displacements and forces at full ones; the first kick leads to half a step */
        const double kick = k ? dt : 0.5 * dt, vfree = v - kick * x;
        double f;
        status = tribo_step_force(contact, kick, &vfree, &f);
        if (!status) {
            const double v_end = vfree + kick * f;
            dissipated -= kick * f * 0.5 * (v + v_end);
            v = v_end;
            x += dt * v;
        }
    }
    if (status) {
        fprintf(stderr, "%s: %s\n", tribo_strerror(status), tribo_message(contact));
    }
    tribo_destroy(contact);

    printf("rests at x = %.7f (exact -0.75) with v = %g; dissipated %.7f (exact 3.5)\n", x, v, dissipated);
    return status || v != 0.0 || fabs(x + 0.75) > 1e-4 || fabs(dissipated - 3.5) > 1e-4;
}
