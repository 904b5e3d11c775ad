/* SPDX-License-Identifier: BSD-3-Clause */
/* Limits that follow the motion. */
#include "book.h"

/* A body with a tangential and a normal degree of freedom on a normal spring; compliance 1/kt of the tangential spring, or 0. */
static tribo_system *pressed(const double *mass, const double *damping, const double *stiffness, double compliance, double mu,
                             double normal, const double *load)
{
    const double direction[4] = {1.0, 0.0, 0.0, 1.0}, soft[2] = {compliance, 0.0};
    tribo_model *model;
    tribo_system *sys;
    need(tribo_model_create(&model, 2, 2), "model");
    need(tribo_model_set_mass_diagonal(model, mass), tribo_model_message(model));
    need(tribo_model_set_damping_diagonal(model, damping), tribo_model_message(model));
    need(tribo_model_set_stiffness(model, stiffness), tribo_model_message(model));
    need(tribo_model_set_direction(model, direction), tribo_model_message(model));
    need(tribo_model_set_compliance(model, soft), tribo_model_message(model));
    need(tribo_model_set_normal(model, 0, 1, mu, normal, 0.0), tribo_model_message(model));
    need(tribo_system_create(&sys, model), tribo_model_message(model));
    tribo_model_destroy(model);
    need(tribo_system_add_load(sys, 0.0, load, NULL), tribo_system_message(sys));
    return sys;
}

/* x'' + 0.1 sqrt(12) x' + 12 x + f = Fx cos wt, y'' + 2 y' + 21 y + N = 100 + Fy cos wt, N = 21 max(y, 0), kt = 5, mu = 0.85:
 * even variants largest x, odd ones energy of a period. */
static double shaken(int variant)
{
    static const double scene[][3] = {
        {80.0, 8.0, 3.6}, {80.0, 8.0, 3.0}, {100.0, 10.0, 3.6}, {60.0, 60.0, 5.0}, {60.0, 90.0, 5.5}};
    const double mass[2] = {1.0, 1.0}, damping[2] = {0.1 * sqrt(12.0), 2.0}, stiffness[4] = {12.0, 0.0, 0.0, 21.0};
    const double load[2] = {0.0, 100.0}, c[4] = {1.0}, *s = scene[variant / 2];
    double y[6], energy[2];
    struct motion m;
    tribo_system *sys = pressed(mass, damping, stiffness, 0.2, 0.85, 21.0, load);
    need(tribo_system_add_load(sys, s[2], s, NULL), tribo_system_message(sys));
    motion_begin(&m, sys, "event");
    motion_find(&m, 2.0 * PI / s[2], y);
    const double most = motion_most(&m, c);
    need(tribo_driver_period_dissipation(m.drv, energy), tribo_driver_message(m.drv));
    motion_end(&m);
    return variant % 2 ? energy[0] : most;
}

/* Squeal after Hoffmann and others (2002), on a belt. */
static tribo_system *squealing(double speed)
{
    const double mass[2] = {1.0, 1.0}, damping[2] = {0.1, 0.1}, load[2] = {0.0, 10.0}, belt[2] = {speed};
    const double xx = 11.0 * 0.75 + 20.0 * 0.75, yy = 11.0 * 0.25 + 20.0 * 0.25, xy = (20.0 - 11.0) * 0.25 * sqrt(3.0);
    const double stiffness[4] = {xx, xy, xy, yy};
    tribo_system *sys = pressed(mass, damping, stiffness, 0.0, 0.6, 11.0, load);
    need(tribo_system_add_base_motion(sys, 0.0, belt, NULL), tribo_system_message(sys));
    return sys;
}

/* By marching. variant 0: period on a belt of 0.5; 1: on a belt of 1; 2: x at break-away. */
static double squeal(int variant)
{
    double y[5] = {0.1, 0.9};
    struct motion m;
    size_t seen = 0, at[2] = {0};
    motion_begin(&m, squealing(variant == 1 ? 1.0 : 0.5), "event");
    motion_advance(&m, 400.0, y);
    motion_end(&m);
    for (size_t k = m.count; seen < 2 && k > m.count - MOST_MOMENTS; k--) {
        if (m.kind[(k - 1) % MOST_MOMENTS] == TRIBO_MOMENT_SLIP) {
            at[seen++] = (k - 1) % MOST_MOMENTS;
        }
    }
    return variant == 2 ? m.q[at[0]] : m.at[at[0]] - m.at[at[1]];
}

/* By shooting, belt 0.5. variant 0: period; 1, 2: real and imaginary part of the multipliers beside 1 and 0. */
static double squeal_cycle(int variant)
{
    double y[5] = {0.1, 0.9}, period = 0.0, re[4], im[4];
    struct motion m;
    motion_begin(&m, squealing(0.5), "event");
    need(tribo_driver_find_cycle(m.drv, 0.0, &period, y), tribo_driver_message(m.drv));
    need(tribo_driver_get_multipliers(m.drv, re, im), tribo_driver_message(m.drv));
    motion_end(&m);
    return variant == 0 ? period : variant == 1 ? re[1] : im[1];
}

/* SDND101: a mass of 100 on a spring of 1e4 with speed 1 against a stop of 1e6. variant 0: how long they touch; 1: largest
 * force. */
static double shock(int variant)
{
    const double mass[2] = {1.0, 100.0}, damping[2] = {0.0}, stiffness[4] = {1.0, 0.0, 0.0, 1e4}, load[2] = {0.0};
    double y[5] = {0.0, 0.0, 0.0, 1.0}, f[2];
    struct motion m;
    motion_begin(&m, pressed(mass, damping, stiffness, 0.0, 0.0, 1e6, load), "event");
    motion_advance(&m, 0.1, y);
    const double length = m.at[m.count - 1];
    if (variant) {
        double start[5] = {0.0, 0.0, 0.0, 1.0};
        m.t = 0.0;
        motion_advance(&m, 0.5 * length, start);
        need(tribo_system_contacts(m.sys, m.t, start, NULL, NULL, f), tribo_system_message(m.sys));
    }
    motion_end(&m);
    return variant ? -f[1] : length;
}

/* A block of mass 1 falls on a floor of stiffness 1e4 from 0.05 at g = 10, with 5 along the floor, mu 0.1: its speed along the
 * floor after three bounces, each of which takes mu (2 v + g t), t the time it touches. */
static double bounces(int variant)
{
    const double mass[2] = {1.0, 1.0}, none[4] = {0.0}, load[2] = {0.0, 10.0};
    double y[5] = {0.0, -0.05, 5.0};
    struct motion m;
    (void)variant;
    motion_begin(&m, pressed(mass, none, none, 0.0, 0.1, 1e4, load), "event");
    motion_advance(&m, 0.64, y);
    motion_end(&m);
    return y[2];
}

const struct row rows_normals[] = {
    {"shaken.1.most", shaken, 0},
    {"shaken.1.energy", shaken, 1},
    {"shaken.2.most", shaken, 2},
    {"shaken.2.energy", shaken, 3},
    {"shaken.3.most", shaken, 4},
    {"shaken.3.energy", shaken, 5},
    {"shaken.4.most", shaken, 6},
    {"shaken.4.energy", shaken, 7},
    {"shaken.5.most", shaken, 8},
    {"shaken.5.energy", shaken, 9},
    {"squeal.period", squeal, 0},
    {"squeal.fast", squeal, 1},
    {"squeal.slip", squeal, 2},
    {"squeal.cycle", squeal_cycle, 0},
    {"squeal.multiplier.re", squeal_cycle, 1},
    {"squeal.multiplier.im", squeal_cycle, 2},
    {"sdnd101.time", shock, 0},
    {"sdnd101.force", shock, 1},
    {"bounces", bounces, 0},
    {NULL, NULL, 0},
};
