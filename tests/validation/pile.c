/* SPDX-License-Identifier: BSD-3-Clause */
#include "make.h"
#include "pile.h"

#include <math.h>
#include <string.h>
#include "../set_up_driver.h"

int pile_create(tribo_system **sys, double ratio, int even)
{
    enum { N = PILE_BLOCKS };
    double mass[N * N] = {0.0}, stiffness[N * N] = {0.0}, direction[N * N] = {0.0}, limit[N];
    const double belt[N] = {1.0};
    for (size_t i = 0; i < N; i++) {
        const double height = (double)i / N;
        mass[i * N + i] = i % 2 ? 1.0 / ratio : 1.0;
        stiffness[i * N + i] = mass[i * N + i] * (1.0 + height);
        direction[i * N + i] = 1.0;
        if (i > 0) {
            direction[i * N + i - 1] = -1.0;
        }
        limit[i] = even ? 0.5 * (1.0 - height) : 0.5 * (1.0 - 0.5 * height - 0.3 * (double)(37 * i * i % 61) / 61.0);
    }
    int status = dense_system(sys, N, N, mass, NULL, stiffness, direction, 0, NULL, 0);
    if (!status) {
        status = tribo_set_limit(tribo_system_context(*sys), limit);
        status = status ? status : tribo_system_add_base_motion(*sys, 0.5, NULL, belt);
    }
    return status;
}

int pile_run(double ratio, int even, const char *method, int coupling, double dt, double tolerance, double *y)
{
    tribo_system *sys = NULL;
    tribo_driver *drv = NULL;
    double t = 0.0;
    memset(y, 0, PILE_STATES * sizeof *y);
    int status = pile_create(&sys, ratio, even);
    status = status ? status : tribo_set_coupling(tribo_system_context(sys), coupling);
    status = status ? status : tribo_set_epsilon_step(tribo_system_context(sys), dt, 1.0);
    status = status ? status : set_up_driver(&drv, sys, method, dt, tolerance, 0.0);
    status = status ? status : tribo_driver_advance(drv, &t, PILE_TIME, y);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    return status;
}

double pile_distance(const double *y, const double *want)
{
    double most = 0.0;
    for (size_t i = 0; i < 2 * PILE_BLOCKS; i++) {
        if (i < PILE_BLOCKS || i % 2 == 0) {
            most = fmax(most, fabs(y[i] - want[i]));
        }
    }
    return most;
}
