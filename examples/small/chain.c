/* SPDX-License-Identifier: BSD-3-Clause */
/* Quinn's chain of blocks with the driver of libtribo_gsl: energy that friction dissipates in each cycle. */
#include <math.h>
#include <stdio.h>

#include "tribo/tribo_gsl.h"

enum { BLOCKS = 32, DIMENSION = 2 * BLOCKS + 1 };

int main(void)
{
    const double omega = 0.5, period = 2.0 * acos(-1.0) / omega, steps = 5000.0, dt = period / steps;
    tribo_system *chain = NULL;
    tribo_driver *driver = NULL;
    int status = tribo_system_chain(&chain, BLOCKS, 1.0, 0.25, omega);
    if (status) {
        fprintf(stderr, "%s\n", tribo_strerror(status));
        return 1;
    }
    tribo_context *contacts = tribo_system_context(chain);
    status = tribo_set_epsilon_step(contacts, dt, 0.4); /* the paper's epsilon = 10 omega dt */
    status = status ? status : tribo_driver_create(&driver, chain, "rk4/fixed");
    status = status ? status : tribo_driver_set_step(driver, dt);
    if (status) {
        fprintf(stderr, "%s: %s\n", tribo_strerror(status), tribo_system_message(chain));
    }

    double y[DIMENSION] = {0.0}, t = 0.0, dissipated = 0.0;
    for (int cycle = 1; !status && cycle <= 4; cycle++) {
        const double before = y[DIMENSION - 1];
        status = tribo_driver_advance(driver, &t, cycle * period, y);
        dissipated = y[DIMENSION - 1] - before;
        printf("cycle %d dissipates %.7f\n", cycle, dissipated);
        if (status) {
            fprintf(stderr, "%s: %s\n", tribo_strerror(status), tribo_driver_message(driver));
        }
    }
    tribo_driver_destroy(driver);
    tribo_system_destroy(chain);
    printf("exact, without epsilon: 0.0104950 in cycle 4\n");
    return status || fabs(dissipated / 0.0104949600025 - 1.0) > 1e-4;
}
