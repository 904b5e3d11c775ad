/* SPDX-License-Identifier: BSD-3-Clause */
/* Oscillators and the reference systems of Quinn (2004), in time. */
#include "book.h"

/* m = k = 1, limit 1: where it rests. */
static double rest(int variant)
{
    struct motion m;
    double y[3] = {variant ? 12.0 : 2.75, variant ? 6.0 : 0.0};
    motion_begin(&m, oscillator(0.0, 1.0, 1.0, 0.0, 0.0, 1.0), "exact");
    motion_advance(&m, 60.0, y);
    motion_end(&m);
    return y[0];
}

/* Energy that friction takes between two times, from rest. */
static double energy_between(tribo_system *sys, double before, double end)
{
    double y[128] = {0.0};
    const size_t last = tribo_system_dimension(sys) - 1;
    struct motion m;
    motion_begin(&m, sys, "exact");
    motion_advance(&m, before, y);
    const double energy = y[last];
    motion_advance(&m, end, y);
    motion_end(&m);
    return y[last] - energy;
}

/* Cycle 50 of a forced oscillator. */
static double forced(int variant)
{
    const double omega = variant ? 2.0 : 0.5, cycle = 2.0 * PI / omega;
    return energy_between(oscillator(0.0, 1.0, 1.0, 0.0, variant ? 2.0 : 1.5, omega), 49.0 * cycle, 50.0 * cycle);
}

/* Cycle 4 of a chain of 32 blocks. */
static double chain(int variant)
{
    tribo_system *sys;
    (void)variant;
    need(tribo_system_chain(&sys, 32, 1.0, 0.25, 0.5), "chain");
    return energy_between(sys, 12.0 * PI, 16.0 * PI);
}

/* Two blocks on a belt at t = 60: x1, x2, x1', x2'. */
static double belt(int variant)
{
    double y[5] = {0.0};
    tribo_system *sys;
    struct motion m;
    need(tribo_system_belt(&sys, 2.0, 0.5, 0.25, 1.0, 0.5), "belt");
    motion_begin(&m, sys, "exact");
    motion_advance(&m, 60.0, y);
    motion_end(&m);
    return y[variant];
}

/* Friction pendulum of radius 2.235, mu 0.06, weight 1, released at 0.2: twice the time to its stop. */
static double pendulum(int variant)
{
    const double g = 9.81, radius = 2.235;
    double y[3] = {0.2};
    struct motion m;
    (void)variant;
    motion_begin(&m, oscillator(0.0, g / radius, 0.06 * g, 0.0, 0.0, 1.0), "exact");
    motion_advance(&m, 3.0, y);
    motion_end(&m);
    return m.count == 1 && m.kind[0] == TRIBO_MOMENT_STICK ? 2.0 * m.at[0] : 0.0;
}

/* Block on a belt of speed 0.2, static limit 1, kinetic limit 0.6. */
static tribo_system *dropping(void)
{
    const double belt_speed = 0.2, ratio = 1.0 / 0.6;
    tribo_system *sys = oscillator(0.0, 1.0, 0.6, 0.0, 0.0, 1.0);
    need(tribo_set_static(tribo_system_context(sys), &ratio, NULL), "static");
    need(tribo_system_add_base_motion(sys, 0.0, &belt_speed, NULL), "belt");
    return sys;
}

/* By marching: time from break-away to break-away, or of slip. */
static double drop(int variant)
{
    double y[3] = {0.0};
    struct motion m;
    motion_begin(&m, dropping(), "exact");
    motion_advance(&m, 40.0, y);
    motion_end(&m);
    const size_t k = m.kind[m.count - 1] == TRIBO_MOMENT_SLIP ? m.count - 1 : m.count - 2;
    return variant ? m.at[k - 1] - m.at[k - 2] : m.at[k] - m.at[k - 2];
}

/* Its period by shooting. */
static double drop_cycle(int variant)
{
    double y[3] = {0.0}, period = 0.0;
    struct motion m;
    (void)variant;
    motion_begin(&m, dropping(), "exact");
    need(tribo_driver_find_cycle(m.drv, 0.0, &period, y), tribo_driver_message(m.drv));
    motion_end(&m);
    return period;
}

/* A block on a belt of speed 0.2 whose limit falls with the sliding speed, 1/(1 + 3 |v|): the caller's own loop. While it sticks
 * it moves with the belt up to the limit 1; it slides by the method of Runge and Kutta until v = 0, which bisection locates. */

/* Acceleration of the block at x, u while it slides backwards, v < 0, by tribo_law_eval. */
static double belt_acceleration(double x, double u)
{
    const double v = fmin(u - 0.2, -1e-300);
    double f;
    need(tribo_law_eval(TRIBO_COULOMB, v, x, 1.0 / (1.0 - 3.0 * v), 1.0, &f, NULL, NULL, NULL), "law");
    return f - x;
}

static void slide_step(double h, double *x, double *u)
{
    const double a1 = belt_acceleration(*x, *u), u2 = *u + 0.5 * h * a1, a2 = belt_acceleration(*x + 0.5 * h * *u, u2);
    const double u3 = *u + 0.5 * h * a2, a3 = belt_acceleration(*x + 0.5 * h * u2, u3), u4 = *u + h * a3;
    const double a4 = belt_acceleration(*x + h * u3, u4);
    *x += h / 6.0 * (*u + 2.0 * u2 + 2.0 * u3 + u4);
    *u += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
}

/* variant 0: period; 1: x where the block sticks again. */
static double falling(int variant)
{
    const double h = 1e-3;
    double x = 1.0, u = 0.2, t = 0.0, x1 = x, u1 = u;
    do {
        x = x1;
        u = u1;
        slide_step(h, &x1, &u1);
        t += h;
    } while (u1 < 0.2);
    double lo = 0.0, hi = h;
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (lo + hi);
        x1 = x;
        u1 = u;
        slide_step(middle, &x1, &u1);
        *(u1 >= 0.2 ? &hi : &lo) = middle;
    }
    return variant ? x1 : t - h + hi + (1.0 - x1) / 0.2;
}

const struct row rows_oscillators[] = {
    {"rest", rest, 0},
    {"rest.siconos", rest, 1},
    {"forced.sticks", forced, 0},
    {"forced.turns", forced, 1},
    {"chain", chain, 0},
    {"belt.x1", belt, 0},
    {"belt.x2", belt, 1},
    {"belt.v", belt, 2},
    {"pendulum", pendulum, 0},
    {"drop.period", drop, 0},
    {"drop.slip", drop, 1},
    {"drop.cycle", drop_cycle, 0},
    {"leine.period", falling, 0},
    {"leine.stick", falling, 1},
    {NULL, NULL, 0},
};
