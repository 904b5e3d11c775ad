/* SPDX-License-Identifier: BSD-3-Clause */
#include "run.h"

#include <stdlib.h>
#include <string.h>
#include "../set_up_driver.h"

tribo_model *dense_model(size_t ndof, size_t ncontact, const double *mass, const double *damping, const double *stiffness,
                         const double *direction)
{
    tribo_model *model;
    assert_ok(tribo_model_create(&model, ndof, ncontact));
    assert_ok(tribo_model_set_mass(model, mass));
    if (damping) {
        assert_ok(tribo_model_set_damping(model, damping));
    }
    assert_ok(tribo_model_set_stiffness(model, stiffness));
    assert_ok(tribo_model_set_direction(model, direction));
    return model;
}

tribo_system *finish_model(tribo_model *model)
{
    tribo_system *sys;
    const int status = tribo_system_create(&sys, model);
    require(!status, "%s", tribo_model_message(model));
    tribo_model_destroy(model);
    return sys;
}

tribo_driver *driver_create(tribo_system *sys, const char *method, double dt, double tolerance)
{
    tribo_driver *drv = NULL;
    const int status = set_up_driver(&drv, sys, method, dt, tolerance, 0.0);
    require(status == TRIBO_OK, "%s: %s", method, tribo_system_message(sys));
    return drv;
}

void driver_advance(tribo_driver *drv, double *t, double t1, double *y)
{
    const int status = tribo_driver_advance(drv, t, t1, y);
    require(status == TRIBO_OK, "%d: %s", status, tribo_driver_message(drv));
    assert_exact(*t, t1);
}

size_t driver_count(const tribo_driver *drv, int which)
{
    size_t value;
    assert_ok(tribo_driver_count(drv, which, &value));
    return value;
}

size_t driver_freedom(const tribo_driver *drv)
{
    size_t value;
    assert_ok(tribo_driver_get_freedom(drv, &value));
    return value;
}

void run(tribo_system *sys, const char *method, double dt, double tolerance, double t1, double *y)
{
    tribo_driver *drv = driver_create(sys, method, dt, tolerance);
    double t = 0.0;
    driver_advance(drv, &t, t1, y);
    tribo_driver_destroy(drv);
}

double between(uint64_t *seed, double from, double to)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return from + (to - from) * (double)(*seed >> 11) / 9007199254740992.0;
}

double largest_difference(const double *x, const double *y, size_t n)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, fabs(x[i] - y[i]));
    }
    return most;
}

enum { MOST_MULTIPLIERS = 16 };

void assert_traces(tribo_driver *drv, size_t n, double t, double period, const double *y, double h, double error)
{
    double map[MOST_MULTIPLIERS][MOST_MULTIPLIERS], re[MOST_MULTIPLIERS], im[MOST_MULTIPLIERS], trace[2] = {0.0}, sum[2] = {0.0};
    require(n <= MOST_MULTIPLIERS, "%zu multipliers", n);
    assert_ok(tribo_driver_get_multipliers(drv, re, im));
    for (size_t j = 0; j < n; j++) {
        double end[2][MOST_MULTIPLIERS + 1];
        for (int side = 0; side < 2; side++) {
            double from = t;
            memcpy(end[side], y, (n + 1) * sizeof *y);
            end[side][j] += side ? h : -h;
            driver_advance(drv, &from, t + period, end[side]);
        }
        for (size_t i = 0; i < n; i++) {
            map[i][j] = (end[1][i] - end[0][i]) / (2.0 * h);
        }
    }
    for (size_t i = 0; i < n; i++) {
        trace[0] += map[i][i];
        sum[0] += re[i];
        sum[1] += re[i] * re[i] - im[i] * im[i];
        for (size_t j = 0; j < n; j++) {
            trace[1] += map[i][j] * map[j][i];
        }
    }
    require(fabs(sum[0] - trace[0]) < error && fabs(sum[1] - trace[1]) < error, "%.9g, %.9g; squares %.9g, %.9g", sum[0],
            trace[0], sum[1], trace[1]);
}

tribo_system *oscillator(int law, double alpha, double omega)
{
    tribo_system *sys;
    assert_ok(tribo_system_oscillator(&sys, 1.0, alpha, omega));
    assert_ok(tribo_set_law(tribo_system_context(sys), law));
    return sys;
}

double dissipation(tribo_system *sys, double omega, int cycles, double x0, double dt, double width)
{
    const double cycle = 2.0 * PI / omega, h = cycle / ceil(cycle / dt);
    const size_t last = tribo_system_dimension(sys) - 1;
    double *y = calloc(last + 1, sizeof *y), t = 0.0, before = 0.0;
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), width * h));
    tribo_driver *drv = driver_create(sys, "rk4/fixed", h, 0.0);
    y[0] = x0;
    for (int k = 1; k <= cycles; k++) {
        before = y[last];
        driver_advance(drv, &t, k * cycle, y);
    }
    const double d = y[last] - before;
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    free(y);
    return d;
}

double order_of(const double *dt, const double *error, size_t n)
{
    return log(error[0] / error[n - 1]) / log(dt[0] / dt[n - 1]);
}
