/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts that share a body: a block lies on another one, that lies on the ground, and a force pulls the upper one.
 * Contact 0: ground and lower block, contact 1: lower and upper block; v = (x1', x2' - x1').
 * Core library only. Units: kg, m, s, N. */
#include <math.h>
#include <stdio.h>

#include "tribo/tribo.h"

enum { GROUND, BETWEEN };

static const double lower = 2.0, upper = 1.0, limit[] = {6.0, 2.0};

static int pull(tribo_context *contacts, int coupling, double force, double *f)
{
    const double v[] = {0.0, 0.0}, a[] = {0.0, force / upper};
    int status = tribo_set_coupling(contacts, coupling);
    status = status ? status : tribo_balance(contacts, v, a, NULL, f);
    if (!status) {
        printf("pulled by %g N, %-10s: ground carries %5.2f N, the blocks %5.2f N; lower accelerates with %5.2f, upper with "
               "%5.2f m/s^2\n",
               force, coupling == TRIBO_CONSISTENT ? "consistent" : "partition", f[GROUND], f[BETWEEN],
               (f[GROUND] - f[BETWEEN]) / lower, (f[BETWEEN] + force) / upper);
    }
    return status;
}

int main(void)
{
    /* R = J M^-1 J' */
    const double r[] = {1.0 / lower, -1.0 / lower, -1.0 / lower, 1.0 / lower + 1.0 / upper};
    double gentle[2][2] = {{0.0}}, hard[2][2] = {{0.0}};
    tribo_context *contacts;
    int status = tribo_create(&contacts, 2);
    if (status) {
        fprintf(stderr, "%s\n", tribo_strerror(status));
        return 1;
    }
    status = tribo_set_limit(contacts, limit);
    status = status ? status : tribo_set_operator_dense(contacts, r);
    for (int coupling = TRIBO_CONSISTENT; !status && coupling <= TRIBO_PARTITION; coupling++) {
        status = pull(contacts, coupling, 1.0, gentle[coupling]);
        status = status ? status : pull(contacts, coupling, 5.0, hard[coupling]);
    }
    if (status) {
        fprintf(stderr, "%s: %s\n", tribo_strerror(status), tribo_message(contacts));
    }
    tribo_destroy(contacts);
    printf("The partition balances the ground against 5 N, which the upper contact cannot pass on: it carries 2 N.\n");

    /* gently: nothing moves in either coupling; hard: only the upper block moves */
    return status || fabs(gentle[0][GROUND] + 1.0) > 1e-12 || fabs(gentle[1][GROUND] + 1.0) > 1e-12 ||
           fabs(hard[0][BETWEEN] + 2.0) > 1e-12 || fabs(hard[0][GROUND] + 2.0) > 1e-12;
}
