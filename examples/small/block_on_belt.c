/* SPDX-License-Identifier: BSD-3-Clause */
/* A block on a spring and a moving belt, with the caller's own time stepping: friction speeds the block up until it
 * sticks to the belt and rides along. Core library only. Units: kg, m, s, N. */
#include <math.h>
#include <stdio.h>

#include "tribo/tribo.h"

int main(void)
{
    const double mass = 2.0, stiffness = 50.0, limit = 10.0, belt = 0.3, dt = 1e-4, end = 0.5;
    const double inverse_mass = 1.0 / mass;

    tribo_context *contact;
    int status = tribo_create(&contact, 1);
    if (status) {
        fprintf(stderr, "%s\n", tribo_strerror(status));
        return 1;
    }
    status = tribo_set_limit(contact, &limit);
    status = status ? status : tribo_set_operator_diagonal(contact, &inverse_mass);
    /* stuck contacts lose their velocity within a step */
    status = status ? status : tribo_set_epsilon_step(contact, dt, 1.0);

    double x = 0.0, u = 0.0, f = 0.0;
    signed char mode = 2;
    for (int k = 0; !status && k < (int)lround(end / dt); k++) {
        const double v = u - belt, a = -stiffness * x / mass;
        status = tribo_balance(contact, &v, &a, NULL, &f);
        u += dt * (a + f / mass);
        x += dt * u;
    }
    status = status ? status : tribo_get_slip(contact, &mode);
    if (status) {
        fprintf(stderr, "%s: %s\n", tribo_strerror(status), tribo_message(contact));
    }
    tribo_destroy(contact);

    /* sliding: x = limit/stiffness (1 - cos(omega t)), until x' is that of the belt; then x' stays so */
    const double omega = sqrt(stiffness / mass), reach = limit / stiffness;
    const double stick = asin(belt / (reach * omega)) / omega;
    const double exact = reach * (1.0 - cos(omega * stick)) + belt * (end - stick);
    printf("x(%g) = %.5f m (exact %.5f), x' = %.5f m/s, f = %.4f N (spring %.4f N), %s\n", end, x, exact, u, f, stiffness * x,
           mode == 0 ? "sticks" : "slides");
    return status || mode != 0 || fabs(x - exact) > 1e-4;
}
