/* SPDX-License-Identifier: BSD-3-Clause */
/* What legacy_systems.f does, by the functions of C. */
#include "../set_up_driver.h"
#include "structure.h"
#include "tape.h"

#define N 2
#define DIMENSION (2 * N + 1)

static void put_period(tribo_driver *drv, double *y)
{
    const double c[2 * N] = {1.0, -0.5, 0.25, 0.0};
    double re[2 * N], im[2 * N], a, b, at[2], each[N];
    size_t count = 0;
    put_one(tribo_driver_find_periodic(drv, 0.5, 7.853981633974483, y));
    put(DIMENSION, y);
    tribo_driver_get_multipliers(drv, re, im);
    put(2 * N, re);
    put(2 * N, im);
    tribo_driver_period_extremes(drv, c, &a, &b, &at[0], &at[1]);
    put_one(a);
    put_one(b);
    put(2, at);
    tribo_driver_period_harmonic(drv, c, 3, &a, &b);
    put_one(a);
    put_one(b);
    tribo_driver_period_dissipation(drv, each);
    put(N, each);
    tribo_driver_period_stick(drv, each);
    put(N, each);
    static const int kind[] = {TRIBO_PARAMETER_LIMIT, TRIBO_PARAMETER_FREQUENCY};
    const size_t index[] = {1, 0};
    double extremes[4], state[2 * DIMENSION];
    put_one(tribo_driver_period_derivatives(drv, 2, kind, index, c, extremes, NULL, NULL));
    put(4, extremes);
    put_one(tribo_driver_period_derivatives(drv, 2, kind, index, NULL, NULL, NULL, state));
    put(2 * DIMENSION, state);
    put_one(tribo_driver_period_derivatives(drv, 2, kind, index, NULL, NULL, each, NULL));
    put_one(tribo_driver_multiplier_derivatives(drv, 1, 2, kind, index, re, im));
    put(2, re);
    put(2, im);
    put_one(tribo_driver_set_ring(drv, 2, 1));
    put_one(tribo_driver_find_periodic(drv, 0.5, 7.853981633974483, y));
    put_one(tribo_driver_set_ring(drv, 0, 0));
    tribo_driver_count(drv, TRIBO_COUNT_PERIODS, &count);
    put_one((double)count);
}

void legacy_systems_play(void)
{
    const double mass[N * N] = {1.0, 0.0, 0.0, 2.0}, stiffness[N * N] = {3.0, -1.0, -1.0, 2.0};
    const double damping[N * N] = {0.3, -0.1, -0.1, 0.1}, direction[N * N] = {1.0, 0.0, -1.0, 1.0};
    const double cosine[N] = {1.0, -0.5}, sine[N] = {0.2, 0.7}, base[N] = {0.1, 0.0}, swing[N] = {0.05, 0.0};
    const double limit[N] = {0.3, 0.2}, zero[N] = {0.0, 0.0}, omega = 0.8;
    for (int damped = 0; damped < 2; damped++) {
        double y[DIMENSION] = {0.0}, t = 0.5;
        tribo_system *sys = NULL;
        tribo_driver *drv = NULL;
        structure_system(&sys, &(struct structure){N, N, mass, damped ? damping : NULL, stiffness, direction, 0}, 0, 0);
        tribo_set_limit(tribo_system_context(sys), limit);
        tribo_system_add_load(sys, omega, sine, cosine);
        tribo_system_clear_loads(sys);
        tribo_system_add_load(sys, omega, cosine, sine);
        tribo_system_add_base_motion(sys, omega, base, zero);
        tribo_system_add_limit(sys, 2.0 * omega, zero, swing);
        set_up_driver(&drv, sys, "event", 0.1, 1e-9, 1e-9);
        put_period(drv, y);
        tribo_driver_destroy(drv);
        set_up_driver(&drv, sys, "exact", 0.1, 0.0, 0.0);
        put_period(drv, y);
        put_one(tribo_driver_advance(drv, &t, 3.0, y));
        put_one(t);
        put(DIMENSION, y);
        tribo_driver_destroy(drv);
        tribo_system_destroy(sys);
    }
}
