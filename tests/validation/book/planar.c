/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar contacts. */
#include "book.h"

static const double ones[2] = {1.0, 1.0}, identity[4] = {1.0, 0.0, 0.0, 1.0};

/* A mass of 1 on two springs, with a planar contact; compliance 1/kt, or 0. */
static tribo_system *planar_mass(double k1, double k2, double limit, double compliance)
{
    const double stiffness[4] = {k1, 0.0, 0.0, k2}, soft[2] = {compliance, compliance};
    const size_t first = 0;
    tribo_system *sys = dense(2, 2, ones, NULL, stiffness, identity, compliance > 0.0 ? soft : NULL);
    need(tribo_set_planar(tribo_system_context(sys), 1, &first), "planar");
    need(tribo_set_limit_all(tribo_system_context(sys), limit), "limit");
    return sys;
}

/* SDND100 along 45 degrees, k = 1e4, limit 1, released 0.85 mm off: displacement along its way after half periods, mm. */
static double sdnd100(int variant)
{
    const double side = sqrt(0.5);
    double y[5] = {0.85e-3 * side, 0.85e-3 * side};
    struct motion m;
    motion_begin(&m, planar_mass(1e4, 1e4, 1.0, 0.0), "event");
    motion_advance(&m, (variant + 1) * PI / 100.0, y);
    motion_end(&m);
    return 1e3 * (y[0] + y[1]) * side;
}

/* x'' + x = p sin 0.7 t + f, y'' + 1.7 y = 1.2 cos(0.7 t + 0.4) + f at t = 60: dissipation, x, y; p = 1.6, then 2.5. */
static double two_loads(int variant)
{
    const double cosine[2] = {0.0, 1.2 * cos(0.4)}, sine[2] = {variant < 3 ? 1.6 : 2.5, -1.2 * sin(0.4)};
    double y[5] = {0.0};
    struct motion m;
    tribo_system *sys = planar_mass(1.0, 1.7, 1.0, 0.0);
    need(tribo_system_add_load(sys, 0.7, cosine, sine), tribo_system_message(sys));
    motion_begin(&m, sys, "event");
    motion_advance(&m, 60.0, y);
    motion_end(&m);
    return y[variant % 3 == 0 ? 4 : variant % 3 - 1];
}

/* A force that turns drives a mass on a circle. Rigid: radius, lag. From the circle of the closed form on, over ten turns. */
static double circle(int variant)
{
    const double w = 0.6, limit = 0.3, radius = sqrt(1.0 - limit * limit) / (1.0 - w * w), lag = asin(limit);
    const double t1 = 20.0 * PI / w;
    double y[5] = {radius * cos(lag), -radius * sin(lag), radius * w * sin(lag), radius * w * cos(lag)};
    struct motion m;
    tribo_system *sys = planar_mass(1.0, 1.0, limit, 0.0);
    need(tribo_system_add_load(sys, w, identity, identity + 2), tribo_system_message(sys));
    motion_begin(&m, sys, "event");
    motion_advance(&m, t1, y);
    motion_end(&m);
    return variant ? -atan2(y[1], y[0]) : hypot(y[0], y[1]);
}

/* The same with tangential springs before the slider, in the caller's own loop of central differences with
 * tribo_elastic_force_planar. Displacement of the slider rho e^(i a), of the mass (rho + i L/kt) e^(i a). radius, energy of a
 * turn: of the last turn. */
static void elastic_turns(double w, double limit, double kt, int steps, double *radius, double *energy)
{
    enum { TURNS = 40 };
    const double kappa = 1.0 - w * w, across = limit / kt, side = kappa * across + limit,
                 rho = sqrt(1.0 - side * side) / fabs(kappa);
    const double a = -atan2(side, kappa * rho), dt = 2.0 * PI / w / steps;
    double q[2] = {rho * cos(a) - across * sin(a), rho * sin(a) + across * cos(a)}, f[2] = {limit * sin(a), -limit * cos(a)};
    double v[2] = {-w * (q[1] - 0.5 * dt * w * q[0]), w * (q[0] + 0.5 * dt * w * q[1])};
    for (int k = 0; k < TURNS * steps; k++) {
        const double load[2] = {cos(w * k * dt), sin(w * k * dt)}, before[2] = {f[0], f[1]};
        double dz[2];
        for (int d = 0; d < 2; d++) {
            v[d] += (k ? dt : 0.0) * (load[d] - q[d] + f[d]);
            dz[d] = dt * v[d];
            q[d] += dz[d];
        }
        need(tribo_elastic_force_planar(1, dz, &kt, &limit, f, NULL), "elastic");
        if (k == (TURNS - 1) * steps) {
            *energy = *radius = 0.0;
        }
        *energy -= 0.5 * ((before[0] + f[0]) * dz[0] + (before[1] + f[1]) * dz[1]);
        *radius += hypot(q[0], q[1]) / steps;
    }
}

/* Extrapolated from steps of four lengths. */
static double elastic_circle(int variant)
{
    double w[2], limit[2] = {0.3, 0.4}, kt[2] = {2.0, 3.0}, table[4];
    w[0] = 0.6;
    w[1] = 1.3;
    for (int k = 0; k < 4; k++) {
        double radius = 0.0, energy = 0.0;
        elastic_turns(w[variant / 2], limit[variant / 2], kt[variant / 2], 1000 << k, &radius, &energy);
        table[k] = variant % 2 ? energy : radius;
        for (int j = k - 1; j >= 0; j--) {
            table[j] = table[j + 1] + (table[j + 1] - table[j]) / ((1 << (k - j)) - 1.0);
        }
    }
    return table[0];
}

/* A block kicked sideways on an incline of slope mu: v (1 + cos phi) at t = 4, which stays 1. */
static double incline(int variant)
{
    const double down[2] = {0.0, 1.0};
    double y[5] = {0.0, 0.0, 1.0, 0.0, 0.0};
    struct motion m;
    tribo_system *sys = planar_mass(0.0, 0.0, 1.0, 0.0);
    (void)variant;
    need(tribo_system_add_load(sys, 0.0, down, NULL), tribo_system_message(sys));
    motion_begin(&m, sys, "event");
    motion_advance(&m, 4.0, y);
    motion_end(&m);
    return hypot(y[2], y[3]) + y[3];
}

/* A box of 10 kg on the ground (mu 0.4) with 25 balls of 1 kg (mu 0.8), pushed by 150 N along x = y, g = 9.81: speed of the box
 * at t = 4. Degrees of freedom of a ball: its place, and how far its surface has turned (inertia 0.4 m). */
static double balls(int variant)
{
    enum { BALLS = 25, N = 2 + 4 * BALLS, C = 2 + 2 * BALLS };
    static double stiffness[N * N], direction[C * N], mass[N], limit[C], load[N], y[2 * N + 1];
    size_t first[1 + BALLS] = {0};
    struct motion m;
    (void)variant;
    memset(y, 0, sizeof y);
    for (int d = 0; d < 2; d++) {
        mass[d] = 10.0;
        load[d] = 150.0 * sqrt(0.5);
        direction[d * N + d] = 1.0;
        limit[d] = 0.4 * 9.81 * 35.0;
        for (int k = 0; k < BALLS; k++) {
            const int row = 2 + 2 * k + d, place = 2 + 4 * k + d;
            mass[place] = 1.0;
            mass[place + 2] = 0.4;
            direction[row * N + d] = 1.0;
            direction[row * N + place] = direction[row * N + place + 2] = -1.0;
            limit[row] = 0.8 * 9.81;
            first[1 + k] = (size_t)(2 + 2 * k);
        }
    }
    tribo_system *sys = dense(N, C, mass, NULL, stiffness, direction, NULL);
    need(tribo_set_planar(tribo_system_context(sys), 1 + BALLS, first), "planar");
    need(tribo_set_limit(tribo_system_context(sys), limit), "limit");
    need(tribo_system_add_load(sys, 0.0, load, NULL), tribo_system_message(sys));
    motion_begin(&m, sys, "event");
    motion_advance(&m, 4.0, y);
    motion_end(&m);
    return hypot(y[N], y[N + 1]);
}

const struct row rows_planar[] = {
    {"sdnd100.1", sdnd100, 0},
    {"sdnd100.2", sdnd100, 1},
    {"sdnd100.3", sdnd100, 2},
    {"sdnd100.rest", sdnd100, 5},
    {"planar.energy", two_loads, 0},
    {"planar.x", two_loads, 1},
    {"planar.y", two_loads, 2},
    {"planar.more.energy", two_loads, 3},
    {"circle.radius", circle, 0},
    {"circle.lag", circle, 1},
    {"circle.elastic.1.radius", elastic_circle, 0},
    {"circle.elastic.1.energy", elastic_circle, 1},
    {"circle.elastic.2.radius", elastic_circle, 2},
    {"circle.elastic.2.energy", elastic_circle, 3},
    {"incline", incline, 0},
    {"simbenchmark", balls, 0},
    {NULL, NULL, 0},
};
