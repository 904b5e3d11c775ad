/* SPDX-License-Identifier: BSD-3-Clause */
/* Several bodies: clutches, masses that are pulled, blocks under noise. */
#include "book.h"

/* SDND106: two masses of 5 on a spring of 1e4, one with a limit of 2000, static 3000; 3000 on the other until t = 0.2. variant 0,
 * 1: displacements at 0.15; 2, 3: when and where the first stops. */
static double sdnd106(int variant)
{
    const double mass[2] = {5.0, 5.0}, stiffness[4] = {1e4, -1e4, -1e4, 1e4}, direction[2] = {1.0, 0.0}, load[2] = {0.0, 3000.0};
    const double ratio = 1.5;
    double y[5] = {0.0}, at[2];
    struct motion m;
    tribo_system *sys = dense(2, 1, mass, NULL, stiffness, direction, NULL);
    need(tribo_system_add_load(sys, 0.0, load, NULL), tribo_system_message(sys));
    need(tribo_set_limit_all(tribo_system_context(sys), 2000.0), "limit");
    need(tribo_set_static(tribo_system_context(sys), &ratio, NULL), "static");
    motion_begin(&m, sys, "exact");
    motion_advance(&m, 0.15, y);
    memcpy(at, y, sizeof at);
    motion_advance(&m, 0.2, y);
    need(tribo_system_clear_loads(sys), "loads");
    m.count = 0;
    motion_advance(&m, 0.32, y);
    motion_end(&m);
    return variant < 2 ? at[variant] : variant == 2 ? m.at[0] : m.q[0];
}

/* CoupledClutches, as in examples/clutches. variant 0, 1: speeds of the first and the second shaft at 1.5; beyond: moments. */
static double clutches(int variant)
{
    const double inertia[4] = {1.0, 1.0, 1.0, 1.0}, stiffness[16] = {0.0}, drive[4] = {10.0}, swing[3] = {10.0};
    const double direction[12] = {1.0, -1.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, 1.0, -1.0}, ratio[3] = {1.1, 1.1, 1.1};
    const double stop[3] = {0.4, 0.9, 1.5};
    double y[9] = {0.0, 0.0, 0.0, 0.0, 10.0}, limit[3] = {0.0};
    struct motion m;
    tribo_system *sys = dense(4, 3, inertia, NULL, stiffness, direction, NULL);
    need(tribo_system_add_load(sys, 10.0 * PI, NULL, drive), tribo_system_message(sys));
    need(tribo_system_add_limit(sys, 0.4 * PI, swing, NULL), tribo_system_message(sys));
    need(tribo_set_static(tribo_system_context(sys), ratio, NULL), "static");
    motion_begin(&m, sys, "exact");
    for (int k = 0; k < 3; k++) {
        if (k > 0) {
            limit[k] = 10.0;
        }
        need(tribo_set_limit(tribo_system_context(sys), limit), "limit");
        motion_advance(&m, stop[k], y);
    }
    motion_end(&m);
    return variant < 2 ? y[4 + variant] : m.at[variant - 2];
}

/* splitmix64 (Steele, Lea and Flood 2014): a number between 0 and 1. */
static double next_uniform(unsigned long long *state)
{
    unsigned long long z = *state += 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return ((double)((z ^ (z >> 31)) >> 11) + 0.5) / 9007199254740992.0;
}

/* Mean square of the velocity of blocks of mass 1 under white noise of intensity 2 G, limit D = G = 1, in steps of
 * tribo_step_force: fine steps, and coarse ones of four under the same noise. A control variate of mean 0, the noise times g(v) =
 * -v (|v| + 2) with g' - g sgn v = v^2 - 2, takes out most of the randomness. */
enum { BLOCKS = 4, FINE = 4 };
struct walk {
    tribo_context *ctx;
    double dt, v[BLOCKS], f[BLOCKS], sum;
};

static void walk_begin(struct walk *w, double dt)
{
    const double r[BLOCKS] = {1.0, 1.0, 1.0, 1.0};
    memset(w, 0, sizeof *w);
    w->dt = dt;
    need(tribo_create(&w->ctx, BLOCKS), "context");
    need(tribo_set_limit_all(w->ctx, 1.0), tribo_message(w->ctx));
    need(tribo_set_operator_diagonal(w->ctx, r), tribo_message(w->ctx));
}

static void walk_step(struct walk *w, const double *kick)
{
    for (int k = 0; k < BLOCKS; k++) {
        w->sum -= w->v[k] * (fabs(w->v[k]) + 2.0) * kick[k] / w->dt;
        w->v[k] += kick[k];
    }
    need(tribo_step_force(w->ctx, w->dt, w->v, w->f), tribo_message(w->ctx));
    for (int k = 0; k < BLOCKS; k++) {
        w->v[k] += w->dt * w->f[k];
        w->sum += w->v[k] * w->v[k];
    }
}

/* The error falls with the root of the step: from both steps to none. */
static double noise(int variant)
{
    const int steps = 1000000;
    const double dt = 0.00125, strength = sqrt(2.0 * dt);
    unsigned long long state = 1;
    struct walk fine, coarse;
    (void)variant;
    walk_begin(&fine, dt);
    walk_begin(&coarse, FINE * dt);
    for (int step = 0; step < steps; step++) {
        double whole[BLOCKS] = {0.0};
        for (int part = 0; part < FINE; part++) {
            double kick[BLOCKS];
            for (int k = 0; k < BLOCKS; k += 2) {
                const double size = strength * sqrt(-2.0 * log(next_uniform(&state))), angle = 2.0 * PI * next_uniform(&state);
                kick[k] = size * cos(angle);
                kick[k + 1] = size * sin(angle);
                whole[k] += kick[k];
                whole[k + 1] += kick[k + 1];
            }
            walk_step(&fine, kick);
        }
        walk_step(&coarse, whole);
    }
    tribo_destroy(fine.ctx);
    tribo_destroy(coarse.ctx);
    return (2.0 * fine.sum / FINE - coarse.sum) / ((double)BLOCKS * steps);
}

const struct row rows_bodies[] = {
    {"sdnd106.x1", sdnd106, 0},   {"sdnd106.x2", sdnd106, 1},
    {"sdnd106.stop", sdnd106, 2}, {"sdnd106.x1.stop", sdnd106, 3},
    {"clutches.w1", clutches, 0}, {"clutches.w2", clutches, 1},
    {"clutches.1", clutches, 2},  {"clutches.2", clutches, 3},
    {"clutches.3", clutches, 4},  {"clutches.4", clutches, 5},
    {"clutches.5", clutches, 6},  {"clutches.6", clutches, 7},
    {"noise", noise, 0},          {NULL, NULL, 0},
};
