/* SPDX-License-Identifier: BSD-3-Clause */
/* Energy: what is dissipated is what loads and moving bases put in, less what the structure keeps. */
#include <string.h>

#include "make.h"
#include "model.h"

/* Power into a structure, summed over the steps by the trapezoidal rule; forces come from a twin of the system, since an observer
 * must not disturb the one that moves. */
struct account {
    const struct model *m;
    tribo_system *twin;
    double t, power, work;
};

static double wave(const double *const part, const double *const quarter, size_t i, double phase)
{
    return part[i] * cos(phase) + quarter[i] * sin(phase);
}

/* p.u + f.b - u'Cu. */
static double power_at(const struct account *a, double t, const double *y)
{
    const struct model *m = a->m;
    const double *u = y + DOFS;
    double f[CONTACTS], power = -form(m->damping, u, u);
    assert_ok(tribo_system_contacts(a->twin, t, y, NULL, NULL, f));
    for (size_t i = 0; i < DOFS; i++) {
        power += u[i] * wave(m->load[0], m->load[1], i, m->load_omega * t);
    }
    for (size_t i = 0; i < CONTACTS; i++) {
        power += f[i] * wave(m->motion[0], m->motion[1], i, m->motion_omega * t);
    }
    return power;
}

static int add_up(const tribo_moment *moment, void *data)
{
    const double t = moment->t, *y = moment->y;
    struct account *a = data;
    const double power = power_at(a, t, y);
    a->work += 0.5 * (t - a->t) * (a->power + power);
    a->t = t;
    a->power = power;
    return 0;
}

static double mechanical(const struct model *m, const double *y)
{
    return 0.5 * form(m->mass, y + DOFS, y + DOFS) + 0.5 * form(m->stiffness, y, y);
}

/* Second order in the step, at 1e-3 a few 1e-5 of the 10 to 500 that are exchanged; first order with Karnopp's law, which jumps.
 */
TEST(balance_of_energy)
{
    struct random g = random_of(_i);
    const struct model m = model_create(&g, _i % 2);
    tribo_system *sys = model_system(&m, 1, 0, 0.05);
    struct account a = {&m, model_system(&m, 1, 0, 0.05), 0.0, 0.0, 0.0};
    double t = 0.0, y[DIMENSION] = {0};
    const int law = 1 + _i % 4, coupling = _i / 4 % 2; /* the twin would not know the reversal law's memory */
    tribo_system *const both[] = {sys, a.twin};
    for (size_t k = 0; k < 2; k++) {
        assert_ok(tribo_set_law(tribo_system_context(both[k]), law));
        assert_ok(tribo_set_coupling(tribo_system_context(both[k]), coupling));
    }
    y[0] = 1.0;
    const double before = mechanical(&m, y);
    a.power = power_at(&a, 0.0, y);
    tribo_driver *drv = driver_create(sys, "rk4/fixed", 1e-3, 0.0);
    assert_ok(tribo_driver_set_observer(drv, add_up, &a));
    driver_advance(drv, &t, 30.0, y);
    const double kept = mechanical(&m, y) - before, dissipated = y[2 * DOFS];
    ck_assert_double_gt(dissipated, 1.0);
    assert_close(dissipated + kept, a.work, law == TRIBO_KARNOPP ? 2e-2 : 5e-5);
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
    tribo_system_destroy(a.twin);
}

/* Left alone, the oscillator's whole energy goes: 1/2 (12^2 + 6^2) less what the spring keeps at rest, which is N times the way.
 */
TEST(free_oscillator)
{
    double y[3] = {12.0, 6.0, 0.0};
    tribo_system *sys = oscillator(TRIBO_QUINN, 0.0, 1.0);
    assert_ok(tribo_set_epsilon_all(tribo_system_context(sys), 0.002));
    run(sys, "rk4/fixed", 0.001, 0.0, 30.0, y);
    assert_close(y[2], 0.5 * (12.0 * 12.0 + 6.0 * 6.0) - 0.5 * y[0] * y[0], 1e-6); /* kinks leave dt^2 */
    tribo_system_destroy(sys);
}

/* No limit, no damping: nothing is dissipated, and rk4 keeps the energy to its order. */
TEST(open_contacts)
{
    struct random g = random_of(_i);
    const struct model m = model_create(&g, 1);
    double y[DIMENSION] = {1.0, 0.0, -1.0};
    const double before = mechanical(&m, y);
    tribo_system *sys;
    assert_ok(dense_system(&sys, DOFS, CONTACTS, m.mass, NULL, m.stiffness, m.direction, 0, NULL, 0));
    run(sys, "rk4/fixed", 1e-3, 0.0, 10.0, y);
    assert_exact(y[2 * DOFS], 0.0);
    assert_close(mechanical(&m, y) / before, 1.0, 1e-11);
    tribo_system_destroy(sys);
}

/* A limit far above all other forces stops one of two masses in no time, and takes its energy; so it is with damping and a limit
 * that swings, which leave an error that grows with the limit, but no faster. */
TEST(far_limits)
{
    static const char *const methods[] = {"exact", "event"};
    const double mass[] = {1.0, 0.0, 0.0, 1.0}, stiffness[] = {2.0, -1.0, -1.0, 2.0}, direction[] = {1.0, 0.0};
    const double damping[][4] = {{0.0, 0.0, 0.0, 0.0}, {0.3, -0.1, -0.1, 0.2}, {0.3, 0.0, 0.0, 0.05}, {0.0, 0.0, 0.0, 0.0}};
    const char *method = methods[_i % 2];
    const int kind = _i / 2;
    for (double limit = 1e2; limit < 1e11; limit *= 1e2) {
        const double half = 0.5 * limit, wave = kind == 3 ? half : 0.0, tolerance = kind ? 1e-14 + 1e-15 * limit : 1e-14;
        double y[5] = {0.3, -0.2, 1.0, 0.5, 0.0};
        tribo_system *sys;
        assert_ok(dense_system(&sys, 2, 1, mass, damping[kind], stiffness, direction, 0, NULL, 0));
        assert_ok(tribo_set_limit(tribo_system_context(sys), &limit));
        assert_ok(tribo_system_add_limit(sys, 2.0, NULL, &wave));
        run(sys, method, 0.1, 1e-15, 1e-1, y);
        assert_exact(y[2], 0.0);
        /* way: 1/2 v^2 over what stops it, force of the springs (0.3 * 2 + 0.2) and limit; what is next to that is (F/limit)^3 */
        require(fabs(2.0 * y[4] * (limit + 0.8) / limit - 1.0) < 3.0 * (kind ? 1.0 / limit : pow(limit, -2.0)) + tolerance,
                "%s, limit %g: %.17g", method, limit, y[4]);
        tribo_system_destroy(sys);
    }
}

TEST_MAIN("energy", {far_limits, 8}, {balance_of_energy, 16}, {free_oscillator, 1}, {open_contacts, 3})
