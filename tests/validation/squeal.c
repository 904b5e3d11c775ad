/* SPDX-License-Identifier: BSD-3-Clause */
#include "squeal.h"

#include "run.h"

tribo_system *squeal(double belt, double mu, double damped)
{
    const double a = 2.0 * PI * 150.0 / 360.0, b = 2.0 * PI * 30.0 / 360.0, xy = 11.0 * cos(a) * sin(a) + 20.0 * cos(b) * sin(b);
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, damping[] = {damped, 0.0, 0.0, damped}, direction[] = {1.0, 0.0, 0.0, 1.0};
    const double stiffness[] = {11.0 * cos(a) * cos(a) + 20.0 * cos(b) * cos(b), xy, xy,
                                11.0 * sin(a) * sin(a) + 20.0 * sin(b) * sin(b)};
    const double load[] = {0.0, 10.0}, base[] = {belt, 0.0};
    tribo_model *model = dense_model(2, 2, mass, damping, stiffness, direction);
    assert_ok(tribo_model_set_normal(model, 0, 1, mu, 11.0, 0.0));
    tribo_system *sys = finish_model(model);
    assert_ok(tribo_system_add_load(sys, 0.0, load, NULL));
    assert_ok(tribo_system_add_base_motion(sys, 0.0, base, NULL));
    return sys;
}
