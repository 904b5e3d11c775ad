/* SPDX-License-Identifier: BSD-3-Clause */
/* Periodic motions of structures with many modes: no step makes a matrix, and what steps apply is what the matrix is. */
#include "make.h"
#include "dynamics/driver.h"
#include "dynamics/periodic/shooting.h"
#include "support.h"

#include <stdlib.h>
#include "../../set_up_driver.h"

enum { DOFS = 40, CONTACTS = 4, STATES = 2 * DOFS, LOADS = 5 };

/* Bodies in a row on springs, one of them with a damper, which couples the modes, or all alike; contacts between some of them,
 * and to the ground. */
static tribo_system *row(struct random *r, int coupled)
{
    static double mass[DOFS][DOFS], damping[DOFS][DOFS], stiffness[DOFS][DOFS], direction[CONTACTS][DOFS];
    tribo_system *sys;
    for (size_t i = 0; i < DOFS; i++) {
        for (size_t k = 0; k < DOFS; k++) {
            mass[i][k] = stiffness[i][k] = 0.0;
        }
    }
    for (size_t i = 0; i < DOFS; i++) {
        const double spring = uniform(r, 50.0, 200.0);
        mass[i][i] = uniform(r, 0.5, 2.0);
        stiffness[i][i] += 1.0 + spring;
        if (i + 1 < DOFS) {
            stiffness[i + 1][i + 1] += spring;
            stiffness[i][i + 1] = stiffness[i + 1][i] = -spring;
        }
    }
    for (size_t i = 0; i < DOFS; i++) {
        for (size_t k = 0; k < DOFS; k++) {
            damping[i][k] = 0.002 * stiffness[i][k];
        }
    }
    damping[3][3] += coupled ? 1.0 : 0.0;
    for (size_t i = 0; i < CONTACTS; i++) {
        for (size_t k = 0; k < DOFS; k++) {
            direction[i][k] = k == 9 * i + 2 ? 1.0 : k == 9 * i + 5 && i % 2 ? -1.0 : 0.0;
        }
    }
    assert_ok(dense_system(&sys, DOFS, CONTACTS, mass[0], damping[0], stiffness[0], direction[0], 0, NULL, 0));
    return sys;
}

/* The matrix, made now, times vectors is what steps have applied. */
static void compare(struct shooting *s, struct random *r)
{
    double x[STATES], applied[STATES];
    const double *matrix = NULL;
    for (size_t i = 0; i < STATES; i++) {
        x[i] = applied[i] = uniform(r, -1.0, 1.0);
    }
    assert_ok(tribo_period_map_apply(&s->map, s->best, applied));
    assert_ok(tribo_period_map_matrix(&s->map, s->best, &matrix));
    for (size_t i = 0; i < STATES; i++) {
        double sum = 0.0;
        for (size_t k = 0; k < STATES; k++) {
            sum += matrix[i * STATES + k] * x[k];
        }
        assert_close(applied[i], sum, 1e-11);
    }
}

static void compare_trace(tribo_driver *drv, struct shooting *s)
{
    double re[STATES], im[STATES], sum = 0.0, trace = 0.0;
    const double *d = NULL;
    assert_ok(tribo_driver_get_multipliers(drv, re, im));
    assert_ok(tribo_period_map_matrix(&s->map, s->best, &d));
    for (size_t i = 0; i < STATES; i++) {
        sum += re[i];
        for (size_t k = 0; s->best->odd && k < STATES; k++) {
            trace += d[i * STATES + k] * d[k * STATES + i];
        }
        trace += s->best->odd ? 0.0 : d[i * STATES + i];
    }
    assert_close(sum, trace, 1e-9);
}

/* The contacts that rest all the time: each may do so elsewhere. */
static size_t count_resting(tribo_driver *drv)
{
    double share[CONTACTS];
    size_t count = 0;
    assert_ok(tribo_driver_period_stick(drv, share));
    for (size_t i = 0; i < CONTACTS; i++) {
        count += share[i] > 1.0 - 1e-12;
    }
    return count;
}

/* Loads and limits that change; the last limits are so large that all contacts rest. */
TEST(many_modes)
{
    struct random r = random_of(_i);
    tribo_system *sys = row(&r, _i % 2);
    double y[STATES + 1] = {0.0}, load[DOFS] = {0.0};
    tribo_driver *drv;
    assert_ok(set_up_driver(&drv, sys, "exact", 1.0, 0.0, 0.0));
    load[DOFS - 1] = 1.0;
    for (int k = 0; k < LOADS; k++) {
        const double omega = 0.7 + 0.3 * k;
        size_t freedom = 0;
        assert_ok(tribo_system_clear_loads(sys));
        assert_ok(tribo_system_add_load(sys, omega, NULL, load));
        assert_ok(tribo_set_limit_all(tribo_system_context(sys), k == LOADS - 1 ? 1e3 : 0.02 * pow(0.5, k)));
        const int status = tribo_driver_find_periodic(drv, 0.0, 2.0 * PI / omega, y);
        require(!status, "load %d: %s", k, status ? tribo_driver_message(drv) : "");
        for (size_t p = 0; p < 3; p++) {
            ck_assert_ptr_null(drv->shooting->point[p].derivative.matrix);
        }
        compare(drv->shooting, &r);
        assert_ok(tribo_driver_get_freedom(drv, &freedom));
        ck_assert_uint_eq(freedom, count_resting(drv));
        compare_trace(drv, drv->shooting);
    }
    tribo_driver_destroy(drv);
    tribo_system_destroy(sys);
}

TEST_MAIN("derivative", {many_modes, 6})
