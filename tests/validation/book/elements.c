/* SPDX-License-Identifier: BSD-3-Clause */
/* Elements without a context. */
#include "book.h"

/* Dahl's law, stiffness 100, limit 2: energy of a steady loop of amplitude 0.05, by Simpson's rule. */
static double dahl(int variant)
{
    const double stiffness = 100.0, limit = 2.0;
    double energy = 0.0, f = 0.0;
    (void)variant;
    for (int cycle = 0; cycle < 8; cycle++) {
        energy = 0.0;
        for (int k = 0; k < 4000; k++) {
            const double h = (k < 2000 ? 1.0 : -1.0) * 0.1 / 4000.0, first = f;
            need(tribo_dahl_force(1, &h, &stiffness, &limit, &f, NULL), "dahl");
            const double middle = f;
            need(tribo_dahl_force(1, &h, &stiffness, &limit, &f, NULL), "dahl");
            energy -= (first + 4.0 * middle + f) * h / 3.0;
        }
    }
    return energy;
}

/* Segalman's form of Iwan's model: kt 2, limit 3, chi -0.1, beta 0.1: force after 0.5, or after 1. */
static double iwan(int variant)
{
    enum { ROOM = 2 };
    const double parameter[4] = {2.0, 3.0, -0.1, 0.1}, h = 0.5;
    double state[3 + 2 * ROOM] = {0.0}, f = 0.0;
    for (int k = 0; k <= variant; k++) {
        need(tribo_iwan_force(1, ROOM, &h, parameter, state, &f, NULL), "iwan");
    }
    return -f;
}

/* Jenkins' element, stiffness 2, limit 3: energy of a steady loop of amplitude 4. */
static double masing(int variant)
{
    const double stiffness = 2.0, limit = 3.0;
    double f = 0.0, energy = 0.0;
    (void)variant;
    for (int k = 0; k < 8 + 64; k++) {
        const double h = k < 8 || (k - 8) % 32 >= 16 ? 0.5 : -0.5, before = f;
        need(tribo_elastic_force(1, &h, &stiffness, &limit, &f, NULL), "elastic");
        energy -= k < 8 + 32 ? 0.0 : 0.5 * (before + f) * h;
    }
    return energy;
}

/* LuGre's force of a bristle with deflection z at the velocity v, and its derivative by v: over a step without length. */
static double lugre_at(double z, double v, double *slope)
{
    const double parameter[6] = {1e5, sqrt(1e5), 0.4, 1.0, 1.5, 1e-3}, dt = 1e-18, dz = v * dt;
    double f, df;
    need(tribo_lugre_force(1, dt, &dz, parameter, &z, &f, &df), "lugre");
    *slope = df * dt;
    return f;
}

/* A mass of 1 pulled by a spring of 2 whose end moves with 0.1 (Canudas de Wit and others 1995): displacement at t = 25.
 * Velocities stand half a step from displacements; a step moves the bristle at constant velocity. */
static double lugre_run(int steps)
{
    const double parameter[6] = {1e5, sqrt(1e5), 0.4, 1.0, 1.5, 1e-3}, dt = 25.0 / steps;
    double x = 0.0, v = 0.0, z = 0.0, f;
    for (int k = 0; k < steps; k++) {
        const double h = k ? dt : 0.5 * dt, pull = 2.0 * (0.1 * k * dt - x);
        double end = v;
        for (int turn = 0; turn < 8; turn++) {
            double slope;
            const double mean = k ? 0.5 * (v + end) : 0.0, force = lugre_at(z, mean, &slope);
            const double off = end - v - h * (pull + force), change = off / (1.0 - (k ? 0.5 * h * slope : 0.0));
            end -= change;
            if (fabs(change) < 1e-15) {
                break;
            }
        }
        v = end;
        const double dz = v * dt;
        x += dz;
        need(tribo_lugre_force(1, dt, &dz, parameter, &z, &f, NULL), "lugre");
    }
    return x;
}

/* Two step lengths, of which the error of second order is taken out. */
static double lugre(int variant)
{
    const double coarse = lugre_run(250000), fine = lugre_run(500000);
    (void)variant;
    return fine + (fine - coarse) / 3.0;
}

const struct row rows_elements[] = {
    {"dahl", dahl, 0}, {"iwan.1", iwan, 0}, {"iwan.2", iwan, 1}, {"masing", masing, 0}, {"lugre", lugre, 0}, {NULL, NULL, 0},
};
