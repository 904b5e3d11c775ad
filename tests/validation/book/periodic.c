/* SPDX-License-Identifier: BSD-3-Clause */
/* Periodic motions. */
#include "book.h"

/* Den Hartog's oscillator, m = k = P = 1: amplitude. */
static double hartog(int variant)
{
    const double beta[] = {0.6, 0.7, 0.8}, limit[] = {0.3, 0.3, 0.4}, c[2] = {1.0};
    double y[3];
    struct motion m;
    motion_begin(&m, oscillator(0.0, 1.0, limit[variant], 1.0, 0.0, beta[variant]), "exact");
    motion_find(&m, 2.0 * PI / beta[variant], y);
    const double most = motion_most(&m, c);
    motion_end(&m);
    return most;
}

/* Its multipliers at beta 0.7, limit 0.3: real and imaginary part. */
static double hartog_multiplier(int variant)
{
    double y[3], re[2], im[2];
    struct motion m;
    motion_begin(&m, oscillator(0.0, 1.0, 0.3, 1.0, 0.0, 0.7), "exact");
    motion_find(&m, 2.0 * PI / 0.7, y);
    need(tribo_driver_get_multipliers(m.drv, re, im), tribo_driver_message(m.drv));
    motion_end(&m);
    return variant ? im[0] : re[0];
}

/* Derivatives of its amplitude there, by limit and by frequency. */
static double hartog_derivative(int variant)
{
    static const int kind[] = {TRIBO_PARAMETER_LIMIT, TRIBO_PARAMETER_FREQUENCY};
    static const size_t contact[] = {0, 0};
    const double c[2] = {1.0};
    double y[3], extremes[2][2];
    struct motion m;
    motion_begin(&m, oscillator(0.0, 1.0, 0.3, 1.0, 0.0, 0.7), "exact");
    motion_find(&m, 2.0 * PI / 0.7, y);
    need(tribo_driver_period_derivatives(m.drv, 2, kind, contact, c, extremes[0], NULL, NULL), tribo_driver_message(m.drv));
    motion_end(&m);
    return variant ? extremes[1][1] / 0.7 : extremes[0][1];
}

/* Damping ratio 0.05, omega 0.9, load 1.5, limit 1: amplitude. */
static double damped(int variant)
{
    const double c[2] = {1.0};
    double y[3];
    struct motion m;
    (void)variant;
    motion_begin(&m, oscillator(0.1, 1.0, 1.0, 1.5, 0.0, 0.9), "exact");
    motion_find(&m, 2.0 * PI / 0.9, y);
    const double most = motion_most(&m, c);
    motion_end(&m);
    return most;
}

/* x'' + 0.1 x' + x + f = cos 1.1 t, f of Jenkins' element of stiffness 1 and limit 0.5: amplitude. */
static double jenkins(int variant)
{
    const double one = 1.0, damping = 0.1, c[2] = {1.0};
    double y[4];
    struct motion m;
    tribo_system *sys = dense(1, 1, &one, &damping, &one, &one, &one);
    (void)variant;
    need(tribo_set_limit_all(tribo_system_context(sys), 0.5), "limit");
    need(tribo_system_add_load(sys, 1.1, &one, NULL), tribo_system_message(sys));
    motion_begin(&m, sys, "exact");
    motion_find(&m, 2.0 * PI / 1.1, y);
    const double most = motion_most(&m, c);
    motion_end(&m);
    return most;
}

/* Nonlinear modes of m = k = 1 with Jenkins' element: omega, then zeta, at the amplitudes 0.6, 1, 2. */
static double jenkins_mode(int variant)
{
    const double amplitude[] = {0.6, 1.0, 2.0}, one = 1.0, c[2] = {1.0};
    double y[4] = {0.0}, omega = 0.0, zeta = 0.0;
    struct motion m;
    tribo_system *sys = dense(1, 1, &one, NULL, &one, &one, &one);
    need(tribo_set_limit_all(tribo_system_context(sys), 0.5), "limit");
    motion_begin(&m, sys, "exact");
    need(tribo_driver_find_mode(m.drv, c, amplitude[variant / 2], &omega, &zeta, y), tribo_driver_message(m.drv));
    motion_end(&m);
    return variant % 2 ? zeta : omega;
}

/* A ring of 12 blades of mass and stiffness 1, springs of 0.5 between neighbours, a contact each to the ground, loads
 * cos(omega t - 2 pi r j/12): amplitude. */
static double ring(int variant)
{
    enum { N = 12 };
    static const struct {
        double c, omega, limit;
        int r;
    } scene[] = {{0.1, 0.9, 0.3, 2}, {0.1, 0.9, 0.3, 1}, {0.1, 1.0, 0.2, 5}, {0.0, 0.9, 0.3, 2}};
    double mass[N], damping[N * N] = {0.0}, stiffness[N * N] = {0.0}, direction[N * N] = {0.0}, cosine[N], sine[N];
    double y[2 * N + 1], c[2 * N] = {1.0};
    struct motion m;
    for (int i = 0; i < N; i++) {
        const double angle = 2.0 * PI * scene[variant].r * i / N;
        mass[i] = direction[i * N + i] = 1.0;
        damping[i * N + i] = scene[variant].c;
        stiffness[i * N + i] = 2.0;
        stiffness[i * N + (i + 1) % N] = stiffness[i * N + (i + N - 1) % N] = -0.5;
        cosine[i] = cos(angle);
        sine[i] = sin(angle);
    }
    tribo_system *sys = dense(N, N, mass, damping, stiffness, direction, NULL);
    need(tribo_set_limit_all(tribo_system_context(sys), scene[variant].limit), "limit");
    need(tribo_system_add_load(sys, scene[variant].omega, cosine, sine), tribo_system_message(sys));
    motion_begin(&m, sys, "exact");
    motion_find(&m, 2.0 * PI / scene[variant].omega, y);
    const double most = motion_most(&m, c);
    motion_end(&m);
    return most;
}

const struct row rows_periodic[] = {
    {"hartog.1", hartog, 0},
    {"hartog.2", hartog, 1},
    {"hartog.3", hartog, 2},
    {"hartog.multiplier.re", hartog_multiplier, 0},
    {"hartog.multiplier.im", hartog_multiplier, 1},
    {"hartog.by.limit", hartog_derivative, 0},
    {"hartog.by.frequency", hartog_derivative, 1},
    {"hartog.damped", damped, 0},
    {"jenkins.amplitude", jenkins, 0},
    {"jenkins.mode.1", jenkins_mode, 0},
    {"jenkins.mode.1.zeta", jenkins_mode, 1},
    {"jenkins.mode.2", jenkins_mode, 2},
    {"jenkins.mode.2.zeta", jenkins_mode, 3},
    {"jenkins.mode.3", jenkins_mode, 4},
    {"jenkins.mode.3.zeta", jenkins_mode, 5},
    {"ring.1", ring, 0},
    {"ring.2", ring, 1},
    {"ring.3", ring, 2},
    {"ring.4", ring, 3},
    {NULL, NULL, 0},
};
