/* SPDX-License-Identifier: BSD-3-Clause */
/* What systems.f90 does from Fortran, through the C interface: see tape.h. */
#include "../set_up_driver.h"
#include "structure.h"
#include "tape.h"

#define DOF 4
#define CONTACTS 3
#define KNOTS 3

static const double mass[DOF][DOF] = {{2.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}, {0.0, 0.0, 1.5, 0.0}, {0.0, 0.0, 0.0, 0.5}};
static const double stiffness[DOF][DOF] = {
    {3.0, -1.0, 0.0, 0.0}, {-1.0, 2.0, -1.0, 0.0}, {0.0, -1.0, 2.0, -1.0}, {0.0, 0.0, -1.0, 1.0}};
static const double damping[DOF][DOF] = {
    {0.3, -0.05, 0.0, 0.0}, {-0.1, 0.2, -0.1, 0.0}, {0.0, -0.1, 0.2, -0.1}, {0.0, 0.0, -0.1, 0.1}};
static const double direction[CONTACTS][DOF] = {{1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, -1.0, 0.0}, {0.0, 0.0, 0.0, 2.0}};
static const double cosine[DOF] = {1.0, 0.0, -0.5, 0.25}, sine[DOF] = {0.0, 0.75, 0.0, 0.5};
static const double limits[CONTACTS] = {0.2, 0.1, 0.05};
static const double motion[CONTACTS] = {0.1, 0.0, -0.2};
static const double times[KNOTS] = {0.0, 1.0, 3.0}, values[KNOTS] = {0.0, 1.0, 0.5};
static const double limit_table[KNOTS][CONTACTS] = {{0.2, 0.1, 0.05}, {0.3, 0.2, 0.1}, {0.1, 0.0, 0.15}};

static void put_size(size_t n)
{
    put_one((double)n);
}

struct sums {
    size_t dimension;
    double most, sum[5];
};

static int seen(const tribo_moment *moment, void *data)
{
    struct sums *s = data;
    s->sum[0] += 1.0;
    s->sum[1] += moment->t;
    s->sum[2] += moment->y[s->dimension - 1];
    s->sum[3] += moment->kind;
    s->sum[4] += moment->kind == TRIBO_MOMENT_STEP ? 0.0 : (double)moment->contact + 1.0;
    return s->sum[0] >= s->most ? 3 : 0;
}

static void state(tribo_system *sys)
{
    const size_t n = tribo_system_dimension(sys), m = tribo_system_ncontact(sys);
    double y[32], dydt[32], dfdy[32 * 32], dfdt[32], v[8], feq[8], f[8];
    for (size_t i = 0; i < n; i++) {
        y[i] = 0.1 * (double)(i + 1) - 0.35;
    }
    put_one(tribo_system_derivative(sys, 0.5, y, dydt));
    put(n, dydt);
    put_one(tribo_system_jacobian(sys, 0.5, y, dfdy, dfdt));
    put(n * n, dfdy);
    put(n, dfdt);
    put_one(tribo_system_contacts(sys, 0.5, y, v, feq, f));
    put(m, v);
    put(m, feq);
    put(m, f);
    put_one(tribo_system_accept(sys, 0.5, y));
}

static void run(tribo_system *sys, const char *method, double most)
{
    const size_t n = tribo_system_dimension(sys);
    struct sums sums = {n, most, {0.0}};
    double y[32] = {0.0}, t = 0.0;
    tribo_driver *drv = NULL;
    put_one(create_any_driver(&drv, sys, method));
    put_one(tribo_driver_set_step(drv, 0.05));
    put_one(tribo_driver_set_tolerance(drv, 1e-5, 1e-5));
    put_one(tribo_driver_set_output(drv, 0.05));
    put_text(tribo_driver_method(drv));
    put_one(tribo_driver_set_max_step(drv, 0.04));
    put_one(tribo_driver_advance(drv, &t, 0.5, y));
    put_one(tribo_driver_set_observer(drv, seen, &sums));
    put_one(tribo_driver_advance(drv, &t, 2.5, y));
    put_one(t);
    put(n, y);
    put(5, sums.sum);
    put_one(tribo_driver_set_observer(drv, NULL, NULL));
    put_one(tribo_driver_advance(drv, &t, 3.0, y));
    put(5, sums.sum);
    put(n, y);
    for (int which = TRIBO_COUNT_STEPS; which <= TRIBO_COUNT_RESTED; which++) {
        size_t count = 0;
        put_one(tribo_driver_count(drv, which, &count));
        put_size(count);
    }
    for (int which = TRIBO_REAL_EXCESS; which <= TRIBO_REAL_BACKSLIP; which++) {
        double value = -1.0;
        put_one(tribo_driver_real(drv, which, &value));
        put_one(value);
    }
    tribo_driver_destroy(drv);
}

static void sizes(const tribo_system *sys)
{
    put_size(tribo_system_ndof(sys));
    put_size(tribo_system_ncontact(sys));
    put_size(tribo_system_dimension(sys));
}

static void reference(tribo_system *sys)
{
    sizes(sys);
    put_one(tribo_set_epsilon_all(tribo_system_context(sys), 0.05));
    state(sys);
    for (int i = 0; i < any_method_count(); i++) {
        run(sys, any_method_name(i), 1e9);
    }
    tribo_system *copy = NULL;
    put_one(tribo_system_clone(sys, &copy));
    put_one(tribo_system_clear_loads(sys));
    run(sys, "central/fixed", 1e9);
    run(copy, "central/fixed", 1e9);
    tribo_system_destroy(copy);
    tribo_system_destroy(sys);
}

static void linear(tribo_system *sys, int reduced)
{
    sizes(sys);
    double omega[DOF], full[DOF], now[CONTACTS];
    signed char slip[CONTACTS];
    size_t stuck;
    const double amplitudes[2] = {0.25, -0.5};
    put_one(tribo_set_limit(tribo_system_context(sys), limits));
    put_one(tribo_set_epsilon_step(tribo_system_context(sys), 0.05, 1.0));
    put_one(tribo_system_add_load(sys, 1.25, cosine, sine));
    put_one(tribo_system_add_load(sys, 2.0, NULL, cosine));
    put_one(tribo_system_add_load(sys, 0.0, sine, NULL));
    put_one(tribo_system_add_base_motion(sys, 0.75, motion, NULL));
    put_one(tribo_system_add_base_motion(sys, 0.5, NULL, limits));
    put_one(tribo_system_add_limit(sys, 1.5, limits, motion));
    put_one(tribo_system_add_limit(sys, 0.5, NULL, limits));
    if (reduced) {
        put_one(tribo_system_set_damping_ratio(sys, 0.02));
        put_one(tribo_system_get_frequencies(sys, omega));
        put(2, omega);
        put_one(tribo_system_expand(sys, amplitudes, full));
        put(DOF, full);
    }
    state(sys);
    run(sys, "exact", 1e9);
    run(sys, "auto", 4.0);
    run(sys, "rk4/fixed", 7.0);
    put_one(tribo_system_add_load_table(sys, KNOTS, times, values, sine));
    put_one(tribo_system_add_base_table(sys, KNOTS, times, values, limit_table[0]));
    put_one(tribo_system_set_limit_table(sys, KNOTS, times, limit_table[0]));
    state(sys);
    run(sys, "event", 1e9);
    run(sys, "central/fixed", 1e9);
    put_one(tribo_system_get_limit(sys, 1.25, now));
    put(CONTACTS, now);
    put_one(tribo_system_get_slip(sys, slip));
    for (int i = 0; i < CONTACTS; i++) {
        put_one(slip[i]);
    }
    put_one(tribo_system_get_count(sys, TRIBO_COUNT_STUCK, &stuck));
    put_one((double)stuck);
    put_one(tribo_system_clear_limits(sys));
    put_one(tribo_system_clear_base_motion(sys));
    run(sys, "moreau/fixed", 1e9);
    tribo_system_destroy(sys);
}

static void truncation(tribo_system *sys)
{
    double error = -1.0;
    sizes(sys);
    put_one(tribo_system_get_truncation(sys, 0.25, &error));
    put_one(error);
    tribo_system_destroy(sys);
}

/* What the period of a forced oscillator holds. */
static void periodic(void)
{
    const double period = 8.975979010256552, c[] = {1.0, 0.5};
    double y[3] = {0.0}, re[2], im[2], a, b;
    size_t freedom = 0;
    tribo_system *sys = NULL;
    tribo_driver *drv = NULL;
    put_one(tribo_system_oscillator(&sys, 0.3, 1.0, 0.7));
    tribo_driver_create(&drv, sys, "exact");
    put_one(tribo_driver_get_multipliers(drv, re, im));
    put_one(tribo_driver_get_freedom(drv, &freedom));
    put_one(tribo_driver_find_periodic(drv, 0.5, period, y));
    put(3, y);
    tribo_driver_get_freedom(drv, &freedom);
    put_size(freedom);
    tribo_driver_get_multipliers(drv, re, im);
    put(2, re);
    put(2, im);
    put_one(tribo_driver_period_extremes(drv, c, &a, &b, NULL, NULL));
    put_one(a);
    put_one(b);
    double least, most;
    put_one(tribo_driver_period_extremes(drv, c, &least, &most, &a, &b));
    put_one(least);
    put_one(most);
    put_one(a);
    put_one(b);
    put_one(tribo_driver_period_harmonic(drv, c, 3, &a, &b));
    put_one(a);
    put_one(b);
    put_one(tribo_driver_period_dissipation(drv, &a));
    put_one(a);
    put_one(tribo_driver_period_stick(drv, &a));
    put_one(a);
    static const int kind[] = {TRIBO_PARAMETER_LIMIT, TRIBO_PARAMETER_LOADS, TRIBO_PARAMETER_FREQUENCY};
    const size_t index[3] = {0};
    double extremes[6], energy[3], by_y[9];
    put_one(tribo_driver_period_derivatives(drv, 3, kind, index, c, extremes, energy, by_y));
    put(6, extremes);
    put(3, energy);
    put(9, by_y);
    static const int kinds[] = {TRIBO_PARAMETER_LIMIT, TRIBO_PARAMETER_FREQUENCY};
    put_one(tribo_driver_multiplier_derivatives(drv, 0, 2, kinds, index, re, im));
    put(2, re);
    put(2, im);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

void systems_play(void)
{
    tribo_system *sys = NULL;
    put_one(any_method_count());
    for (int i = -1; i <= any_method_count(); i++) {
        put_text(any_method_name(i));
    }
    put_one(tribo_system_oscillator(&sys, 0.4, 1.0, 0.75));
    reference(sys);
    put_one(tribo_system_chain(&sys, 5, 0.1, 1.0, 0.5));
    reference(sys);
    put_one(tribo_system_belt(&sys, 1.5, 0.3, 0.2, 1.0, 0.8));
    reference(sys);
    struct structure full = {DOF, CONTACTS, mass[0], NULL, stiffness[0], direction[0], 0}, damped = full;
    damped.damping = damping[0];
    for (int sparse = 0; sparse < 2; sparse++) {
        full.sparse = damped.sparse = sparse;
        put_one(structure_system(&sys, &full, 0, 0));
        linear(sys, 0);
        put_one(structure_system(&sys, &damped, 0, 0));
        linear(sys, 0);
        put_one(structure_system(&sys, &full, 2, TRIBO_STATICS_NONE));
        linear(sys, 1);
    }
    put_one(structure_system(&sys, &full, 2, TRIBO_STATICS_NONE));
    linear(sys, 1);
    put_one(structure_system(&sys, &full, 1, TRIBO_STATICS_MASS));
    truncation(sys);
    periodic();
}
