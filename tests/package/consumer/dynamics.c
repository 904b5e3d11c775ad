/* SPDX-License-Identifier: BSD-3-Clause */
/* libtribo_dynamics by itself: no GSL. */
#include <stdio.h>

#include "tribo/tribo_dynamics.h"

int main(void)
{
    const double mass = 1.0, stiffness = 1.0, direction = 1.0, limit = 0.5, load = 1.0;
    tribo_model *model;
    tribo_system *sys = NULL;
    tribo_driver *drv = NULL;
    double y[3] = {0.0, 0.0, 0.0}, dydt[3];
    int ok = tribo_model_create(&model, 1, 1) == TRIBO_OK;
    ok = ok && tribo_model_set_mass_diagonal(model, &mass) == TRIBO_OK;
    ok = ok && tribo_model_set_stiffness(model, &stiffness) == TRIBO_OK;
    ok = ok && tribo_model_set_direction(model, &direction) == TRIBO_OK;
    ok = ok && tribo_system_create(&sys, model) == TRIBO_OK;
    tribo_model_destroy(model);
    ok = ok && tribo_set_limit(tribo_system_context(sys), &limit) == TRIBO_OK;
    ok = ok && tribo_system_add_load(sys, 0.5, NULL, &load) == TRIBO_OK;
    ok = ok && tribo_system_derivative(sys, 0.0, y, dydt) == TRIBO_OK;
    ok = ok && tribo_driver_create(&drv, sys, "exact") == TRIBO_OK;
    ok = ok && tribo_driver_find_periodic(drv, 0.0, 12.566370614359172, y) == TRIBO_OK;
    ok = ok && y[0] > -2.0 && y[0] < 2.0;
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    printf("%s\n", ok ? "ok" : "failed");
    return !ok;
}
