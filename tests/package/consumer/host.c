/* SPDX-License-Identifier: BSD-3-Clause */
/* A host in C90: a block on a rough plane, by semi-implicit Euler, comes to rest. */
#include <math.h>
#include <stdio.h>
#include <tribo/tribo.h>

int main(void)
{
    double limit = 3.0, r = 0.5, x = 0.2, v = 0.0, a, f, dt = 1e-3;
    tribo_context *contact;
    int k, status = tribo_create(&contact, 1);
    if (!status) {
        status = tribo_set_limit(contact, &limit);
    }
    if (!status) {
        status = tribo_set_operator_diagonal(contact, &r);
    }
    if (!status) {
        status = tribo_set_epsilon_step(contact, dt, 0.4);
    }
    for (k = 0; k < 5000 && !status; k++) {
        a = -50.0 * x;
        status = tribo_balance(contact, &v, &a, NULL, &f);
        v += dt * (a + r * f);
        x += dt * v;
    }
    printf("%s, rests at %.4f\n", tribo_strerror(status), x);
    tribo_destroy(contact);
    return status || fabs(x + 0.02) > 1e-3 || fabs(v) > 1e-3;
}
