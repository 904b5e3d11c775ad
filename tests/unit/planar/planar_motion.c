/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar contacts in motion: the order of what is integrated with them, closed forms, and what a pair of scalar contacts would
 * do. */
#include "support.h"

/* x'' + kx x = p sin 0.7 t + f, y'' + ky y = 1.2 cos(0.7 t + 0.4) + f, with one planar contact of limit 1; or, if turning, with
 * a load of size 1 that turns at that. */
struct oscillator {
    tribo_context *c;
    double kx, ky, p, turning;
};

enum { X, Y, U, W, D, STATE };

static void pulls(const struct oscillator *o, double t, const double *q, double *a)
{
    const int turns = o->turning > 0.0;
    a[0] = (turns ? cos(o->turning * t) : o->p * sin(0.7 * t)) - o->kx * q[X];
    a[1] = (turns ? sin(o->turning * t) : 1.2 * cos(0.7 * t + 0.4)) - o->ky * q[Y];
}

static void rates(const struct oscillator *o, double t, const double *y, double *dy)
{
    double a[2], f[2];
    pulls(o, t, y, a);
    assert_ok(tribo_balance(o->c, y + U, a, NULL, f));
    dy[X] = y[U];
    dy[Y] = y[W];
    dy[U] = a[0] + f[0];
    dy[W] = a[1] + f[1];
    dy[D] = -(f[0] * y[U] + f[1] * y[W]);
}

static void rk4_step(const struct oscillator *o, double t, double h, double *y)
{
    const double part[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    double k[STATE] = {0.0}, sum[STATE] = {0.0};
    for (int s = 0; s < 4; s++) {
        double at[STATE];
        for (int i = 0; i < STATE; i++) {
            at[i] = y[i] + part[s] * h * k[i];
        }
        rates(o, t + part[s] * h, at, k);
        for (int i = 0; i < STATE; i++) {
            sum[i] += weight[s] * k[i];
        }
    }
    for (int i = 0; i < STATE; i++) {
        y[i] += h * sum[i];
    }
}

static struct oscillator oscillator_create(double p, int law, double epsilon)
{
    struct oscillator o = {NULL, 1.0, 1.7, p, 0.0};
    assert_ok(tribo_create(&o.c, 2));
    assert_ok(tribo_set_law(o.c, law));
    assert_ok(tribo_set_planar(o.c, 1, (const size_t[]){0}));
    assert_ok(tribo_set_limit_all(o.c, 1.0));
    assert_ok(tribo_set_epsilon_all(o.c, epsilon));
    assert_ok(tribo_set_operator_diagonal(o.c, (const double[]){1.0, 1.0}));
    return o;
}

/* The largest error of dissipation, x and y at t = 60. */
static double error_of(const double *y, const double *want)
{
    return fmax(fabs(y[D] - want[0]), fmax(fabs(y[X] - want[1]), fabs(y[Y] - want[2])));
}

static double rk4_error(double p, int law, double dt, const double *want)
{
    const long steps = lround(60.0 / dt);
    const double h = 60.0 / (double)steps;
    struct oscillator o = oscillator_create(p, law, 2.0 * h);
    double y[STATE] = {0.0};
    for (long i = 0; i < steps; i++) {
        rk4_step(&o, (double)i * h, h, y);
    }
    tribo_destroy(o.c);
    return error_of(y, want);
}

/* Reference values, computed by another code; and errors of the step form along the mean velocity, in units of its dt^2. */
static const struct {
    double p, want[3], per_square;
} cases[] = {{1.6, {67.840627726, -0.794389645, -0.394078205}, 12.0}, {2.5, {122.943559967, -2.813421575, -0.353837684}, 18.0}};

/* The lens is of third order, and the values come out to all digits that are given. */
TEST(lens)
{
    const double *want = cases[_i].want, p = cases[_i].p;
    const double coarse = rk4_error(p, TRIBO_QUINN, 0.01, want), fine = rk4_error(p, TRIBO_QUINN, 1e-3, want);
    require(coarse < 1.7e-4, "error %g", coarse);
    require(fine < 1.3e-7, "error %g", fine);
    require(coarse > 800.0 * fine, "order %g", log10(coarse / fine));
    assert_close(rk4_error(p, TRIBO_QUINN, 2e-4, want), 0.0, 2e-9);
}

/* The velocity-limited law in the plane is not. */
TEST(limited)
{
    assert_close(rk4_error(1.6, TRIBO_VELOCITY_LIMITED, 0.01, cases[0].want), 0.013, 0.002);
    assert_close(rk4_error(1.6, TRIBO_VELOCITY_LIMITED, 1e-3, cases[0].want), 0.0013, 0.0002);
}

/* Central differences: velocities at half steps, forces at full ones. mean: along the mean velocity of a step. */
static double central_error(double p, double dt, int mean, const double *want)
{
    const long steps = lround(60.0 / dt);
    const double h = 60.0 / (double)steps;
    struct oscillator o = oscillator_create(p, TRIBO_QUINN, 1.0);
    double y[STATE] = {0.0};
    for (long i = 0; i <= steps; i++) {
        const double part = i == 0 || i == steps ? 0.5 * h : h;
        double a[2], f[2], end[2];
        pulls(&o, (double)i * h, y, a);
        for (int k = 0; k < 2; k++) {
            end[k] = y[U + k] + part * a[k];
        }
        if (mean) {
            assert_ok(tribo_step_force_mean(o.c, part, y + U, end, f));
        } else {
            assert_ok(tribo_step_force(o.c, part, end, f));
        }
        for (int k = 0; k < 2; k++) {
            end[k] += part * f[k];
            y[D] -= 0.5 * part * f[k] * (y[U + k] + end[k]);
            y[U + k] = end[k];
            y[X + k] += i < steps ? h * end[k] : 0.0;
        }
    }
    tribo_destroy(o.c);
    return error_of(y, want);
}

/* The step form is of first order, along the mean velocity of second. */
TEST(steps)
{
    const double *want = cases[_i].want, p = cases[_i].p;
    const double end = central_error(p, 0.01, 0, want), fine_end = central_error(p, 1e-3, 0, want);
    const double mean = central_error(p, 0.01, 1, want), fine_mean = central_error(p, 1e-3, 1, want);
    require(end > 8.0 * fine_end && end < 12.0 * fine_end, "order %g", log10(end / fine_end));
    require(mean > 80.0 * fine_mean, "order %g", log10(mean / fine_mean));
    require(mean < cases[_i].per_square * 1e-4 && fine_mean < cases[_i].per_square * 1e-6, "errors %g, %g", mean, fine_mean);
}

/* Scalar contacts that reverse without stick: the oscillator with alpha 2, omega 2, energy dissipated over cycle 50. */
static double reversal_error(long cycle, int mean)
{
    const double h = PI / (double)cycle;
    double x = 0.0, u = 0.0, dissipated = 0.0, before = 0.0;
    tribo_context *c;
    assert_ok(tribo_create(&c, 1));
    assert_ok(tribo_set_limit_all(c, 1.0));
    assert_ok(tribo_set_operator_diagonal(c, (const double[]){1.0}));
    for (long i = 0; i < 50 * cycle; i++) {
        const double part = i == 0 ? 0.5 * h : h, free = u + part * (2.0 * sin(2.0 * (double)i * h) - x);
        double f;
        before = i == 49 * cycle ? dissipated : before;
        assert_ok(mean ? tribo_step_force_mean(c, part, &u, &free, &f) : tribo_step_force(c, part, &free, &f));
        dissipated -= 0.5 * part * f * (u + free + part * f);
        u = free + part * f;
        x += h * u;
    }
    tribo_destroy(c);
    return fabs(dissipated - before - 1.763834207376);
}

TEST(reversals)
{
    const double end = reversal_error(800, 0), fine_end = reversal_error(3200, 0);
    const double mean = reversal_error(800, 1), fine_mean = reversal_error(3200, 1);
    require(end < 6.0 * fine_end, "order %g", log(end / fine_end) / log(4.0));
    require(mean > 14.0 * fine_mean, "order %g", log(mean / fine_mean) / log(4.0));
    require(fine_mean < 1.5e-6, "error %g", fine_mean);
}

/* ------------------------------------------------------------------------------------------------------ closed forms */

/* A force of constant size turning at w on an isotropic oscillator moves it on a circle: m = k = P = 1, w = 0.6, N = 0.3. */
TEST(circle)
{
    const double w = 0.6, limit = 0.3, h = 2e-3, radius = sqrt(1.0 - limit * limit) / fabs(1.0 - w * w);
    const double lag = asin(limit), first = -lag;
    struct oscillator o = oscillator_create(0.0, TRIBO_QUINN, 2.0 * h);
    double y[STATE] = {radius * cos(first), radius * sin(first), -w * radius * sin(first), w * radius * cos(first), 0.0};
    assert_close(radius, 1.4905300022, 1e-10);
    assert_close(lag, 0.3046926540, 1e-10);
    assert_ok(tribo_set_limit_all(o.c, limit));
    o.ky = 1.0;
    o.turning = w;
    for (long i = 0; i < 20000; i++) {
        rk4_step(&o, (double)i * h, h, y);
    }
    const double angle = w * 20000.0 * h;
    assert_close(y[X], radius * cos(angle - lag), 1e-9);
    assert_close(y[Y], radius * sin(angle - lag), 1e-9);
    tribo_destroy(o.c);
}

/* A block kicked sideways on an incline with mu = tan(slope): v (1 + cos phi) stays, phi from straight down, so that half of
 * the speed
 * is left in the end. Returns speed and sine of phi. */
static void slide_down(int planar, double *speed, double *across)
{
    const double h = 1e-2, pull = 0.3;
    double v[2] = {0.0, 1.0};
    tribo_context *c;
    assert_ok(tribo_create(&c, 2));
    assert_ok(tribo_set_planar(c, planar ? 1 : 0, (const size_t[]){0}));
    assert_ok(tribo_set_limit_all(c, pull));
    assert_ok(tribo_set_operator_diagonal(c, (const double[]){1.0, 1.0}));
    for (int i = 0; i < 20000; i++) {
        const double end[2] = {v[0] + h * pull, v[1]};
        double f[2];
        assert_ok(tribo_step_force_mean(c, h, v, end, f));
        v[0] = end[0] + h * f[0];
        v[1] = end[1] + h * f[1];
    }
    *speed = hypot(v[0], v[1]);
    *across = v[1] / *speed;
    tribo_destroy(c);
}

TEST(incline)
{
    double speed, across;
    slide_down(1, &speed, &across);
    assert_close(speed * (1.0 + sqrt(1.0 - across * across)), 1.0, 1e-5);
    assert_close(speed, 0.5, 1e-5);
    slide_down(0, &speed, &across); /* the pyramid lets it rest across, and nothing pulls it down */
    require(fabs(speed - 0.5) > 0.1, "speed %g", speed);
}

TEST_MAIN("planar_motion", {lens, 2}, {limited, 1}, {steps, 2}, {reversals, 1}, {circle, 1}, {incline, 1})
